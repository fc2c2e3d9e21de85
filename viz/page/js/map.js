/* The map: cells coloured by the worst, median or best of their cases; crosses where there is no answer. */
import { element, fixed, inUnit, nice, ticks, decimalsFor } from "./format.js";

const MARGIN = { left: 46, right: 10, top: 8, bottom: 34 };

/** Paint cells and contours with the context's transform in metres, y up. */
export function paintCells(context, cells, values, scale, { pixel, alpha = 1 }) {
  const { wide, tall, shown } = cells;
  for (let k = 0; k < values.length; k++) {
    if (!shown[k]) continue;
    const x = cells.x0 + (k % cells.nx) * wide;
    const y = cells.y0 + Math.floor(k / cells.nx) * tall;
    const none = Number.isNaN(values[k]);
    context.globalAlpha = alpha;
    context.fillStyle = none ? "#c9d0d6" : scale.colour(values[k]);
    context.fillRect(x, y, wide + 0.3 * pixel, tall + 0.3 * pixel);
    if (none) {
      const arm = Math.min(0.22 * wide, 0.22 * tall, 3.5 * pixel);
      const [cx, cy] = [x + wide / 2, y + tall / 2];
      context.strokeStyle = "#7b8792";
      context.lineWidth = 0.9 * pixel;
      context.beginPath();
      context.moveTo(cx - arm, cy - arm);
      context.lineTo(cx + arm, cy + arm);
      context.moveTo(cx - arm, cy + arm);
      context.lineTo(cx + arm, cy - arm);
      context.stroke();
    }
  }
  context.globalAlpha = 1;
}

/** Paint the contour lines. */
export function paintContours(context, ground, width, colour) {
  context.lineWidth = width;
  context.strokeStyle = colour;
  context.stroke(ground.contours());
}

/** A canvas's context that draws on the processor: a path as long as the contours takes a software GPU ten seconds. */
export function plainContext(canvas) {
  return canvas.getContext("2d", { willReadFrequently: true });
}

export class MapView {
  constructor(canvas, tip, state) {
    Object.assign(this, { canvas, tip, state });
    canvas.addEventListener("click", (event) => this.pick(event));
    canvas.addEventListener("mousemove", (event) => this.hover(event));
    canvas.addEventListener("mouseleave", () => (tip.hidden = true));
    new ResizeObserver(() => this.draw()).observe(canvas.parentElement);
  }

  /** Where metres lie on the canvas. */
  fit() {
    const { ground } = this.state;
    const box = this.canvas.parentElement;
    const [w, h] = [box.clientWidth, box.clientHeight];
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(w * ratio);
    this.canvas.height = Math.round(h * ratio);
    Object.assign(this.canvas.style, { width: `${w}px`, height: `${h}px` });
    const [iw, ih] = [w - MARGIN.left - MARGIN.right, h - MARGIN.top - MARGIN.bottom];
    const k = Math.min(iw / (ground.x1 - ground.x0), ih / (ground.y1 - ground.y0));
    const left = MARGIN.left + (iw - k * (ground.x1 - ground.x0)) / 2;
    const top = MARGIN.top + (ih - k * (ground.y1 - ground.y0)) / 2;
    this.view = { w, h, k, ratio, px: (x) => left + k * (x - ground.x0), py: (y) => top + k * (ground.y1 - y), left, top };
  }

  draw() {
    this.fit();
    const { w, h, k, ratio, px, py } = this.view;
    if (w < 60 || h < 60) return;
    const context = plainContext(this.canvas);
    context.drawImage(this.still(), 0, 0);
    context.setTransform(ratio * k, 0, 0, -ratio * k, ratio * px(0), ratio * py(0));
    this.footprint(context, 1 / k);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    if (!this.state.selection.count) message(context, "No case passes the filter: clear it to see them again.", w / 2, h / 2);
  }

  /** Cells, contours and axes, drawn once a size and colouring: another case moves none of them. */
  still() {
    const { width, height } = this.canvas;
    const { ground, cells, values, scale } = this.state;
    if (this.kept?.values === values && this.kept.canvas.width === width && this.kept.canvas.height === height) return this.kept.canvas;
    const { k, ratio, px, py } = this.view;
    const canvas = element("canvas");
    Object.assign(canvas, { width, height });
    const context = plainContext(canvas);
    const frame = [px(ground.x0), py(ground.y1), k * (ground.x1 - ground.x0), k * (ground.y1 - ground.y0)];
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = "#eef1f3";
    context.fillRect(...frame);
    context.save();
    context.setTransform(ratio * k, 0, 0, -ratio * k, ratio * px(0), ratio * py(0));
    paintCells(context, cells, values, scale, { pixel: 1 / k });
    this.contours(context);
    context.restore();
    context.strokeStyle = "#9aa6b2";
    context.strokeRect(...frame);
    this.axes(context);
    this.kept = { values, canvas };
    return canvas;
  }

  /** The contours, drawn once a size. */
  contours(context) {
    const { width, height } = this.canvas;
    const transform = context.getTransform();
    const key = `${width} ${height} ${transform}`;
    if (this.lines?.key !== key) {
      const canvas = element("canvas");
      Object.assign(canvas, { width, height });
      const own = plainContext(canvas);
      own.setTransform(transform);
      paintContours(own, this.state.ground, 0.7 / this.view.k, "rgba(40, 48, 56, 0.36)");
      this.lines = { key, canvas };
    }
    context.save();
    context.resetTransform();
    context.drawImage(this.lines.canvas, 0, 0);
    context.restore();
  }

  axes(context) {
    const { ground } = this.state;
    const { px, py, left, top, k } = this.view;
    const [bottom, right] = [py(ground.y0), px(ground.x1)];
    context.fillStyle = "#5d6873";
    context.font = "11px system-ui, sans-serif";
    context.strokeStyle = "#9aa6b2";
    const step = nice(70 / k);
    const places = decimalsFor(step);
    context.textAlign = "center";
    for (const x of ticks(ground.x0, ground.x1, (ground.x1 - ground.x0) / step)) {
      line(context, px(x), bottom, px(x), bottom + 4);
      context.fillText(fixed(x, places), px(x), bottom + 15);
    }
    context.fillText("x [m]", (left + right) / 2, bottom + 28);
    context.textAlign = "right";
    for (const y of ticks(ground.y0, ground.y1, (ground.y1 - ground.y0) / step)) {
      line(context, left - 4, py(y), left, py(y));
      context.fillText(fixed(y, places), left - 7, py(y) + 4);
    }
    context.save();
    context.translate(left - 34, (top + bottom) / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText("y [m]", 0, 0);
    context.restore();
  }

  /** The chosen case: the wheels' outline to scale, an arrow ahead; a ring where that would be too small. */
  footprint(context, pixel) {
    const { cases, chosen, robots, exact } = this.state;
    if (chosen === null) return;
    const outline = robots[exact[chosen]?.robot ?? 0].outline;
    const [a, b, c, d] = outline;
    context.save();
    context.translate(cases.at("x_m", chosen), cases.at("y_m", chosen));
    if (Math.max(b - a, d - c) < 16 * pixel) {
      ring(context, 11 * pixel, pixel);
    }
    context.rotate(cases.at("yaw_rad", chosen));
    for (const [colour, width] of [["#ffffff", 4.5], ["#d6007f", 2.2]]) {
      context.strokeStyle = colour;
      context.lineWidth = width * pixel;
      context.strokeRect(a, c, b - a, d - c);
      const nose = b + Math.max(0.25 * (b - a), 7 * pixel);
      const wing = Math.max(0.08 * (b - a), 3.5 * pixel);
      context.beginPath();
      context.moveTo((a + b) / 2, (c + d) / 2);
      context.lineTo(nose, (c + d) / 2);
      context.moveTo(nose - 1.3 * wing, (c + d) / 2 - wing);
      context.lineTo(nose, (c + d) / 2);
      context.lineTo(nose - 1.3 * wing, (c + d) / 2 + wing);
      context.stroke();
    }
    context.restore();
  }

  cellAt(event) {
    const { cells } = this.state;
    const box = this.canvas.getBoundingClientRect();
    const { px, py, k } = this.view;
    const x = (event.clientX - box.left - px(0)) / k;
    const y = (py(0) - (event.clientY - box.top)) / k;
    const [i, j] = [Math.floor((x - cells.x0) / cells.wide), Math.floor((y - cells.y0) / cells.tall)];
    return i >= 0 && j >= 0 && i < cells.nx && j < cells.ny ? j * cells.nx + i : null;
  }

  /** Choose the case that the cell shows. */
  pick(event) {
    const cell = this.cellAt(event);
    if (cell !== null && this.state.cells.picks[cell] >= 0) this.state.choose(this.state.cells.picks[cell]);
  }

  hover(event) {
    const { cells, values, measure, statistic } = this.state;
    const cell = this.cellAt(event);
    const count = cell === null ? 0 : cells.shown[cell];
    this.tip.hidden = !count;
    if (!count) return;
    const value = Number.isNaN(values[cell]) ? "no answer" : `${statistic} ${inUnit(measure, values[cell])} ${measure.unit}`;
    this.tip.textContent = `${value} · ${fixed(count, 0)} case${count > 1 ? "s" : ""}`;
    const box = this.canvas.getBoundingClientRect();
    this.tip.style.left = `${Math.min(event.clientX - box.left + 12, this.view.w - this.tip.offsetWidth - 4)}px`;
    this.tip.style.top = `${event.clientY - box.top + 14}px`;
  }
}

function message(context, text, x, y) {
  context.font = "13px system-ui, sans-serif";
  context.textAlign = "center";
  const wide = context.measureText(text).width + 24;
  context.fillStyle = "rgba(255, 255, 255, .92)";
  context.fillRect(x - wide / 2, y - 18, wide, 30);
  context.fillStyle = "#1d242c";
  context.fillText(text, x, y + 2);
}

function line(context, x0, y0, x1, y1) {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}

function ring(context, radius, pixel) {
  for (const [colour, width] of [["#ffffff", 4.5], ["#d6007f", 2.2]]) {
    context.strokeStyle = colour;
    context.lineWidth = width * pixel;
    context.beginPath();
    context.arc(0, 0, radius, 0, 2 * Math.PI);
    context.stroke();
  }
}
