/* Charts of a sweep: lines over one quantity, maps over two; a click chooses the case. */
import { sized } from "./canvas.js";
import { decimalsFor, element, fixed, nice, number, ticks } from "./format.js";
import { scaleOf } from "./colours.js";

const LINES = ["#0b57a4", "#d95f02", "#d6007f", "#3f8f5b", "#6b4fa0", "#7a6a2b", "#2b8fa3", "#87929d"];
const [LEFT, RIGHT, TOP, BOTTOM] = [46, 16, 6, 32];
const FONT = "11px system-ui, sans-serif";

export class Sweep {
  constructor(holder, state) {
    Object.assign(this, { holder, state, sweep: state.cases.header.sweep });
    const { cases } = state;
    this.at = this.sweep.axes.map((axis) => cases.column(axis.name));
    this.values = this.at.map((column) => [...new Set(column)].sort((a, b) => a - b));
    this.order = Array.from({ length: cases.count }, (_, i) => i).sort((a, b) => this.at[0][a] - this.at[0][b]);
    const maps = this.sweep.axes.length === 2;
    const wanted = maps ? this.sweep.charts.flatMap((chart) => chart.lines.map((line) => ({ ...chart, lines: [line] }))) : this.sweep.charts;
    this.charts = wanted.map((chart) => this.chart(chart, maps));
    const note = maps ? "× no answer; lines part fields with different wheels in contact" : "dashed: a wheel lifts or lands; × no answer";
    holder.replaceChildren(element("div", "row dim", null, element("span", "", `${note}; click to see the case`)), element("div", "charts", null, ...this.charts.map((c) => c.box)));
    new ResizeObserver(() => this.draw()).observe(holder);
  }

  chart(chart, map) {
    const canvas = element("canvas");
    const name = map && chart.lines[0].label ? `${chart.title}, ${chart.lines[0].label}` : chart.title;
    const said = element("span", "dim");
    const head = element("div", "head", null, element("b", "", name + (chart.unit ? ` [${chart.unit}]` : "")), said);
    canvas.addEventListener("click", (event) => {
      const i = this.near(event, canvas, map);
      if (i !== null) this.state.choose(i);
    });
    return { ...chart, canvas, said, map, box: element("div", "plot", null, head, canvas) };
  }

  draw() {
    const room = this.holder.clientWidth - 24;
    if (room < 120) return;
    const count = Math.max(1, Math.floor(room / 250));
    const wide = Math.floor(room / count) - 12;
    for (const chart of this.charts) {
      const context = sized(chart.canvas, wide, chart.map ? 200 : 142);
      if (chart.map) this.map(chart, context, wide, 200);
      else this.lines(chart, context, wide, 142);
      const here = chart.lines.map((line) => this.state.cases.at(line.name, this.state.chosen) * chart.factor);
      chart.said.textContent = chart.lines.length === 1 ? number(here[0]) : "";
    }
  }

  frame(w, h, [xs, ys]) {
    const x = (v) => LEFT + ((v - xs[0]) / (xs[1] - xs[0])) * (w - LEFT - RIGHT);
    const y = (v) => h - BOTTOM - ((v - ys[0]) / (ys[1] - ys[0])) * (h - TOP - BOTTOM);
    return { x, y };
  }

  axis(context, w, h, { x, y }, [low, high], factor, title, [ylow, yhigh], yfactor) {
    context.font = FONT;
    context.fillStyle = "#5d6873";
    context.textAlign = "center";
    let places = decimalsFor(nice(((high - low) * factor) / 5));
    for (const t of ticks(low * factor, high * factor, 5)) context.fillText(fixed(t, places), x(t / factor), h - BOTTOM + 14);
    context.fillText(title, (LEFT + w - RIGHT) / 2, h - 4);
    context.textAlign = "right";
    places = decimalsFor(nice(((yhigh - ylow) * yfactor) / 4));
    for (const t of ticks(ylow * yfactor, yhigh * yfactor, 4)) {
      context.fillText(fixed(t, places), LEFT - 5, y(t / yfactor) + 4);
      if (!this.at[1]) {
        context.fillStyle = "#e6eaed";
        context.fillRect(LEFT, y(t / yfactor), w - LEFT - RIGHT, 1);
        context.fillStyle = "#5d6873";
      }
    }
  }

  lines(chart, context, w, h) {
    const { cases, chosen } = this.state;
    const [axis] = this.sweep.axes;
    const xs = [this.values[0][0], this.values[0][this.values[0].length - 1]];
    const known = chart.lines.flatMap((line) => [...cases.sorted(line.name)]);
    let [low, high] = known.length ? [Math.min(...known), Math.max(...known)] : [0, 1];
    const least = 1e-3 / Math.abs(chart.factor) * 1e-3;
    if (high - low < least) [low, high] = [low - 0.5 * Math.max(Math.abs(low) * 0.1, least), high + 0.5 * Math.max(Math.abs(high) * 0.1, least)];
    const pad = 0.06 * (high - low);
    const ys = [low - pad, high + pad];
    const place = this.frame(w, h, [xs, ys]);
    this.axis(context, w, h, place, xs, axis.factor, axisTitle(axis), ys, chart.factor);
    context.setLineDash([3, 3]);
    for (const at of this.changes()) stroke(context, "#9aa6b2", 1, [[place.x(at), TOP], [place.x(at), h - BOTTOM]]);
    context.setLineDash([]);
    chart.lines.forEach((line, k) => {
      const column = cases.column(line.name);
      context.fillStyle = LINES[k % LINES.length];
      let run = [];
      for (const i of this.order) {
        const there = cases.settled(i) && Number.isFinite(column[i]);
        if (there) run.push([place.x(this.at[0][i]), place.y(column[i])]);
        else {
          stroke(context, context.fillStyle, 1.6, run);
          run = [];
        }
        if (there && this.order.length <= 60) context.fillRect(run[run.length - 1][0] - 1.5, run[run.length - 1][1] - 1.5, 3, 3);
      }
      stroke(context, context.fillStyle, 1.6, run);
    });
    for (const i of this.order) if (!cases.settled(i)) cross(context, place.x(this.at[0][i]), h - BOTTOM - 5);
    this.names(chart, context, w);
    const x = place.x(this.at[0][chosen]);
    stroke(context, "#d6007f", 1, [[x, TOP], [x, h - BOTTOM]]);
    stroke(context, "#9aa6b2", 1, [[LEFT, TOP], [LEFT, h - BOTTOM], [w - RIGHT, h - BOTTOM]]);
  }

  names(chart, context, w) {
    context.textAlign = "right";
    let right = w - RIGHT;
    if (chart.lines.length === 1) return;
    for (let k = chart.lines.length - 1; k >= 0; k--) {
      context.fillStyle = LINES[k % LINES.length];
      context.fillText(chart.lines[k].label, right, TOP + 6);
      right -= context.measureText(chart.lines[k].label).width + 8;
    }
  }

  /** Where along the axis the number of wheels in contact, or whether it stands, changes. */
  changes() {
    const state = (i) => (this.state.cases.settled(i) ? Math.round(this.state.cases.at("touching", i)) : -1);
    const out = [];
    for (let k = 1; k < this.order.length; k++) {
      const [a, b] = [this.order[k - 1], this.order[k]];
      if (state(a) !== state(b)) out.push(0.5 * (this.at[0][a] + this.at[0][b]));
    }
    return out;
  }

  map(chart, context, w, h) {
    const { cases, chosen } = this.state;
    const bar = h - 36;
    const [ax, ay] = this.sweep.axes;
    const edges = this.values.map(edgesOf);
    const ends = edges.map((e) => [e[0], e[e.length - 1]]);
    const place = this.frame(w, bar, ends);
    this.axis(context, w, bar, place, ends[0], ax.factor, axisTitle(ax), ends[1], ay.factor);
    context.save();
    context.translate(9, (TOP + bar - BOTTOM) / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(axisTitle(ay), 0, 0);
    context.restore();
    const name = chart.lines[0].name;
    const scale = scaleOf(cases, { name, better: chart.better || "high" });
    const grid = this.grid();
    const touch = (i) => (i === undefined ? null : cases.settled(i) ? Math.round(cases.at("touching", i)) : -1);
    for (const [key, i] of grid) {
      const [a, b] = key.split(",").map(Number);
      const [x0, x1, y0, y1] = [place.x(edges[0][a]), place.x(edges[0][a + 1]), place.y(edges[1][b + 1]), place.y(edges[1][b])];
      const value = cases.at(name, i);
      const none = !cases.settled(i) || Number.isNaN(value);
      context.fillStyle = none ? "#c9d0d6" : scale.colour(value);
      context.fillRect(x0, y0, x1 - x0 + 0.4, y1 - y0 + 0.4);
      if (none) cross(context, (x0 + x1) / 2, (y0 + y1) / 2);
    }
    for (const [key, i] of grid) {
      const [a, b] = key.split(",").map(Number);
      const [x1, y0, x0, y1] = [place.x(edges[0][a + 1]), place.y(edges[1][b + 1]), place.x(edges[0][a]), place.y(edges[1][b])];
      const [right, up] = [touch(grid.get(`${a + 1},${b}`)), touch(grid.get(`${a},${b + 1}`))];
      if (right !== null && right !== touch(i)) stroke(context, "#1d242c", 1.2, [[x1, y0], [x1, y1]]);
      if (up !== null && up !== touch(i)) stroke(context, "#1d242c", 1.2, [[x0, y0], [x1, y0]]);
      if (i === chosen) {
        context.strokeStyle = "#d6007f";
        context.lineWidth = 2;
        context.strokeRect(x0, y0, x1 - x0, y1 - y0);
      }
    }
    this.bar(context, w, h, scale, chart);
  }

  bar(context, w, h, scale, chart) {
    const wide = w - LEFT - RIGHT;
    for (let k = 0; k < wide; k++) {
      context.fillStyle = scale.colour(scale.low + (k / wide) * (scale.high - scale.low));
      context.fillRect(LEFT + k, h - 28, 1.5, 9);
    }
    const [low, high] = [scale.low * chart.factor, scale.high * chart.factor];
    const places = decimalsFor(nice((high - low) / 4));
    context.fillStyle = "#5d6873";
    context.textAlign = "center";
    for (const t of ticks(low, high, 4)) context.fillText(fixed(t, places), LEFT + ((t - low) / (high - low)) * wide, h - 6);
    context.textAlign = "left";
    context.fillText(chart.unit, 4, h - 20);
  }

  /** Case numbers by the place of their values: "a,b" to i. */
  grid() {
    if (!this.known) {
      const rank = this.values.map((all) => new Map(all.map((value, k) => [value, k])));
      this.known = new Map(this.order.map((i) => [`${rank[0].get(this.at[0][i])},${rank[1].get(this.at[1][i])}`, i]));
    }
    return this.known;
  }

  near(event, canvas, map) {
    const box = canvas.getBoundingClientRect();
    const share = [(event.clientX - box.left - LEFT) / (box.width - LEFT - RIGHT)];
    const tall = map ? box.height - 36 : box.height;
    share.push(1 - (event.clientY - box.top - TOP) / (tall - TOP - BOTTOM));
    if (map && share[1] < -0.05) return null;
    const place = this.values.map((all, d) => {
      const ends = map ? ((e) => [e[0], e[e.length - 1]])(edgesOf(all)) : [all[0], all[all.length - 1]];
      const value = ends[0] + share[d] * (ends[1] - ends[0]);
      return all.reduce((best, each, k) => (Math.abs(each - value) < Math.abs(all[best] - value) ? k : best), 0);
    });
    return map ? (this.grid().get(place.join(",")) ?? null) : this.order[place[0]];
  }
}

function axisTitle(axis) {
  return axis.title + (axis.unit ? ` [${axis.unit}]` : "");
}

function edgesOf(values) {
  const middle = values.slice(1).map((v, k) => 0.5 * (v + values[k]));
  const n = values.length;
  return [1.5 * values[0] - 0.5 * values[1], ...middle, 1.5 * values[n - 1] - 0.5 * values[n - 2]];
}

function stroke(context, colour, width, points) {
  if (points.length < 2) return;
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.beginPath();
  points.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
}

function cross(context, x, y) {
  for (const d of [-1, 1]) stroke(context, "#7b8792", 1, [[x - 3, y - 3 * d], [x + 3, y + 3 * d]]);
}
