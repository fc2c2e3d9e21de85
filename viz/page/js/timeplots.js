/* Plots against time, one under the other: lines, their values at the shown moment, a cursor through all. */
import { sized } from "./canvas.js";
import { decimalsFor, element, fixed, nice, number, ticks } from "./format.js";
import { valueAt } from "./frames.js";
import { CUT, EDGE, GUTTER, TOP, drawField, drawLine, rangeOf } from "./panel.js";

const MANY = ["#0b57a4", "#d95f02", "#1b9e77", "#7b3294", "#a6761d", "#d6007f", "#3f9fd8", "#4d5a66", "#8c2d04", "#00665e", "#b15fb5"];
const LEFT = ["#08417c", "#2f7fcc", "#8dbbe8"];
const RIGHT = ["#00573f", "#189b74", "#86cdb6"];

export class TimePlots {
  /** `seek(t)` is called where somebody points at a time. */
  constructor(holder, header, seek) {
    Object.assign(this, { holder, header, seek, panels: [], alone: new Map() });
    this.stack = element("div", "stack");
    this.axis = element("canvas", "axis");
    this.cursor = element("i", "cursor");
    holder.replaceChildren(this.stack, this.axis, this.cursor);
    new ResizeObserver(() => this.draw()).observe(holder);
    const point = (event) => this.seek(this.timeAt(event.clientX));
    holder.addEventListener("pointerdown", (event) => {
      if (event.target.tagName !== "CANVAS") return;
      holder.setPointerCapture(event.pointerId);
      this.dragged = true;
      point(event);
    });
    holder.addEventListener("pointermove", (event) => this.dragged && point(event));
    for (const end of ["pointerup", "pointercancel"]) holder.addEventListener(end, () => (this.dragged = false));
  }

  show(frames) {
    this.frames = frames;
    this.span = frames.length || 1;
    this.sides = new Map(this.header.robots[frames.robot].wheels.map((wheel, k) => [wheel.name, this.header.robots[frames.robot].sides[k]]));
    this.panels = this.header.panels
      .map((about) => ({ ...about, lines: frames.lines.filter((line) => line.panel === about.key) }))
      .filter((panel) => panel.lines.length);
    for (const panel of this.panels) this.build(panel);
    this.stack.replaceChildren(...this.panels.map((panel) => panel.box));
    this.draw();
  }

  build(panel) {
    panel.names = [...new Set(panel.lines.map((line) => line.name))];
    panel.chips = panel.names.map((name) => {
      const style = this.style(panel, name);
      const value = element("b", "");
      const chip = element("button", "key", null, element("i", style.dash.length ? "dashed" : ""), `${name.replace(/_/g, " ")} `, value);
      chip.type = "button";
      chip.title = "Show only this line, or all again";
      chip.style.setProperty("--mark", style.colour);
      chip.addEventListener("click", () => {
        this.alone.set(panel.key, this.alone.get(panel.key) === name ? null : name);
        this.draw();
      });
      return { chip, name, value, line: panel.lines.find((line) => line.name === name && line.part === -1) };
    });
    panel.canvas = element("canvas");
    panel.space = element("div", "space", null, panel.canvas);
    panel.note = element("small", "", panel.unit);
    const keys = element("div", "keys", null, ...panel.chips.map(({ chip }) => chip));
    panel.box = element("section", `panel ${panel.key}`, null, element("h2", "", `${panel.title} `, panel.note), keys, panel.space);
  }

  /** Colour and dashes of a line: wheels by side and place, others one after the other. */
  style(panel, name) {
    const side = panel.key === "loads" || panel.key === "drift" ? this.sides.get(name) : null;
    if (side) return { colour: (side.left ? LEFT : RIGHT)[Math.min(side.rank, 2)], dash: side.left ? [] : [6, 5] };
    const k = panel.names.indexOf(name);
    return { colour: MANY[k % MANY.length], dash: k < MANY.length ? [] : [6, 5] };
  }

  x(t) {
    return GUTTER + (t / this.span) * (this.width - GUTTER - EDGE);
  }

  timeAt(clientX) {
    const left = this.holder.getBoundingClientRect().left + this.stack.offsetLeft;
    const t = ((clientX - left - GUTTER) / (this.width - GUTTER - EDGE)) * this.span;
    return Math.min(this.frames.length, Math.max(0, t));
  }

  draw() {
    this.width = this.stack.clientWidth;
    if (!this.frames || this.width < 120) return;
    for (const panel of this.panels) this.panel(panel);
    this.times();
    if (this.shown !== undefined) this.moment(this.shown);
  }

  panel(panel) {
    const alone = panel.names.includes(this.alone.get(panel.key)) ? this.alone.get(panel.key) : null;
    const lines = panel.lines.filter((line) => (alone ? line.name === alone : line.part === -1));
    for (const { chip, name } of panel.chips) chip.classList.toggle("off", alone !== null && name !== alone);
    const height = Math.max(24, panel.space.clientHeight);
    const context = sized(panel.canvas, this.width, height);
    const { low, high, cut } = rangeOf(lines, panel.limit);
    panel.note.textContent = panel.unit + (cut ? `; cut at ${CUT}, highest ${number(cut)}` : "");
    const y = (v) => TOP + (1 - (v - low) / (high - low)) * (height - 2 * TOP);
    const x = (t) => this.x(t);
    const changes = this.frames.actions.slice(1).map(({ from }) => from);
    drawField(context, { low, high, y, height, width: this.width, limit: panel.limit, x, changes });
    const parts = lines.filter((line) => line.part >= 0);
    for (const line of lines) {
      const { colour, dash } = this.style(panel, line.name);
      const faint = line.part === -1 && parts.length > 0;
      if (!faint) drawLine(context, line, x, (v) => y(Math.min(high, Math.max(low, v))), colour, line.part > 0 ? [2, 3] : dash);
    }
  }

  times() {
    const context = sized(this.axis, this.width, 30);
    const { start } = this.frames;
    context.font = "11px system-ui, sans-serif";
    context.fillStyle = "#9aa6b2";
    context.fillRect(GUTTER, 0, this.width - GUTTER - EDGE, 1);
    context.fillStyle = "#5d6873";
    const marks = ticks(start, start + this.span, 6);
    const places = decimalsFor(nice(this.span / 6));
    for (const value of marks) {
      const at = this.x(value - start);
      context.fillRect(at - 0.5, 0, 1, 4);
      context.textAlign = at > this.width - 30 ? "right" : "center";
      context.fillText(fixed(value, places), context.textAlign === "right" ? at + 8 : at, 15);
    }
    context.textAlign = "center";
    context.fillText("time [s]", (GUTTER + this.width - EDGE) / 2, 28);
  }

  /** Move the cursor; say every line's value there. */
  moment(t) {
    this.shown = t;
    this.cursor.style.transform = `translateX(${this.stack.offsetLeft + this.x(t) - 0.75}px)`;
    for (const panel of this.panels) {
      for (const { chip, value, line } of panel.chips) {
        const now = line ? valueAt(line, t) : NaN;
        value.textContent = panel.limit === null ? said(now) : index(now);
        chip.classList.toggle("over", panel.limit !== null && now > panel.limit);
      }
    }
  }
}

function index(value) {
  return Number.isFinite(value) ? fixed(value, 2) : number(value);
}

function said(value) {
  return Number.isFinite(value) ? fixed(value, Math.abs(value) < 9.95 ? 1 : 0) : "–";
}
