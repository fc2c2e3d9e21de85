/* Histograms of every measure: a drag keeps a range of it, in all that the page shows. */
import { sized } from "./canvas.js";
import { element, inUnit, number } from "./format.js";
import { Spread } from "./spread.js";

const BINS = 48;
const LEAST = 4; // px of a drag; less is a click, which takes the range away

export class Plots {
  constructor(holder, state) {
    Object.assign(this, { holder, state });
    const one = (measure) => state.cases.spread(measure.name).least === state.cases.spread(measure.name).most;
    this.alike = state.cases.measures.filter(one);
    this.rows = state.cases.measures.filter((measure) => !one(measure)).map((measure) => this.row(measure));
    this.foot = element("div", "foot dim");
    holder.replaceChildren(...this.rows.map((row) => row.box), this.foot);
    this.respread();
    new ResizeObserver(() => this.draw()).observe(holder);
  }

  row(measure) {
    const canvas = element("canvas");
    canvas.dataset.measure = measure.name;
    canvas.title = "Drag to keep a range; click to let it go";
    const title = element("button", "name", `${measure.title} [${measure.unit}]`);
    title.type = "button";
    title.title = `Colour the map by it. Better: ${measure.better}`;
    title.addEventListener("click", () => this.state.colourBy(measure.name));
    const figures = element("span", "dim");
    const ends = [element("span"), element("button", "range"), element("span")];
    ends[1].type = "button";
    ends[1].title = "Let this range go";
    ends[1].addEventListener("click", () => this.state.filter(measure.name, null));
    const row = { measure, canvas, ends, title, figures };
    row.box = element("div", "plot", null, element("div", "head", null, title, figures), canvas, element("div", "ends dim", null, ...ends));
    Object.assign(row, this.window(measure.name));
    this.drags(row);
    return row;
  }

  /* What the histogram shows: all values, or without the last half per cent where these are far away. */
  window(name) {
    const all = this.state.cases.spread(name);
    let [low, high] = [all.least, all.most];
    const [q1, q99] = [all.quantile(0.005), all.quantile(0.995)];
    if (high - low > 3 * (q99 - q1)) [low, high] = [q1, q99];
    if (!(high > low)) [low, high] = [low - 0.5, high + 0.5];
    return { low, high };
  }

  drags(row) {
    const { canvas, measure } = row;
    let from = null;
    const place = (event) => event.clientX - canvas.getBoundingClientRect().left;
    const kept = (event, done) => {
      const [a, b] = [from, place(event)].sort((p, q) => p - q);
      if (b - a >= LEAST) this.state.filter(measure.name, this.range(row, a, b), done);
      else if (done) this.state.filter(measure.name, null);
    };
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !row.all?.length) return;
      from = place(event);
      canvas.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    canvas.addEventListener("pointermove", (event) => {
      if (from === null || row.waits) return;
      row.waits = requestAnimationFrame(() => {
        row.waits = 0;
        if (from !== null) kept(event, false);
      });
    });
    canvas.addEventListener("pointerup", (event) => {
      if (from !== null) kept(event, true);
      from = null;
    });
    canvas.addEventListener("pointercancel", () => (from = null));
  }

  /* From pixels to values; a drag that leaves the plot is open on that side. */
  range({ low, high, canvas }, a, b) {
    const value = (x) => low + (x / canvas.clientWidth) * (high - low);
    return [a <= 0 ? -Infinity : value(a), b >= canvas.clientWidth - 1 ? Infinity : value(b)];
  }

  /** Take in another selection: counts and quantiles of what is left. */
  respread() {
    const { cases, selection } = this.state;
    for (const row of this.rows) {
      const all = cases.spread(row.measure.name);
      const kept = selection.active ? new Spread(cases, row.measure.name, selection.mask) : all;
      row.all = all.total ? all.bins(row.low, row.high, BINS) : null;
      row.kept = kept.bins(row.low, row.high, BINS);
      const say = (q) => inUnit(row.measure, kept.quantile(q));
      row.figures.textContent = `p5 ${say(0.05)} · p50 ${say(0.5)}`;
    }
  }

  draw() {
    const width = this.holder.clientWidth - 2 * 10;
    if (width < 40) return;
    const height = Math.max(14, Math.min(40, (this.holder.clientHeight - 44 - 14 * this.alike.length) / Math.max(1, this.rows.length) - 34));
    for (const row of this.rows) this.histogram(row, width, height);
    const how = this.state.selection.active ? "grey behind: all cases, drawn to the same height" : "drag on a histogram to keep a range of it";
    this.foot.replaceChildren(element("div", "", how), ...this.alike.map((measure) => element("div", "", this.said(measure))));
  }

  /* A measure with one value has no histogram. */
  said(measure) {
    const value = this.state.cases.spread(measure.name).least;
    return `${measure.title}: ${inUnit(measure, value)} ${measure.unit} in every settled case`;
  }

  histogram(row, width, height) {
    const { measure, canvas, ends, title, low, high, all, kept } = row;
    const { cases, chosen, measure: shown, scale, selection } = this.state;
    const context = sized(canvas, width, height);
    title.classList.toggle("on", shown === measure);
    ends[1].textContent = "";
    if (!all) {
      ends[0].textContent = "no settled case has it";
      return;
    }
    const x = (value) => Math.min(width, Math.max(0, ((value - low) / (high - low)) * width));
    const bars = (counts, colour) => {
      const most = Math.max(...counts, 1);
      counts.forEach((count, k) => {
        const tall = ((height - 2) * count) / most;
        context.fillStyle = colour(low + ((k + 0.5) / BINS) * (high - low));
        context.fillRect((k * width) / BINS, height - 1 - tall, width / BINS - 0.6, tall);
      });
    };
    if (selection.active) bars(all, () => "#dde2e6");
    bars(kept, shown === measure ? scale.colour : () => "#87929d");
    context.fillStyle = "#5d6873";
    context.fillRect(0, height - 1, width, 1);
    if (low < 0 && high > 0) context.fillRect(x(0) - 0.5, 0, 1, height);
    const range = selection.ranges.get(measure.name);
    if (range) brush(context, range.map(x), width, height);
    const here = chosen === null ? NaN : cases.at(measure.name, chosen);
    if (Number.isFinite(here)) {
      context.fillStyle = "#d6007f";
      context.fillRect(Math.min(width - 2.5, Math.max(0, x(here) - 1.25)), 0, 2.5, height);
    }
    ends[0].textContent = inUnit(measure, low);
    ends[1].textContent = range ? `${rangeSaid(range, measure)} ×` : "";
    ends[1].hidden = !range;
    ends[2].textContent = inUnit(measure, high);
  }
}

/** A range in words. */
export function rangeSaid([low, high], measure) {
  const [from, to] = [low, high].map((end) => number(end * measure.factor));
  if (low === -Infinity) return `up to ${to}`;
  return high === Infinity ? `from ${from}` : `${from} to ${to}`;
}

/* What the range leaves out is veiled, its ends are drawn. */
function brush(context, [a, b], width, height) {
  context.fillStyle = "rgba(255, 255, 255, .6)";
  context.fillRect(0, 0, a, height - 1);
  context.fillRect(b, 0, width - b, height - 1);
  context.fillStyle = "rgba(11, 87, 164, .12)";
  context.fillRect(a, 0, b - a, height - 1);
  context.fillStyle = "#0b57a4";
  for (const end of [a, b]) context.fillRect(Math.min(width - 1.5, Math.max(0, end - 0.75)), 0, 1.5, height);
}
