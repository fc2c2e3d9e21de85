/* Histograms of every measure, and how each wheel's load spreads over the study. */
import { sized } from "./canvas.js";
import { byId, element, fixed, number } from "./format.js";

const BINS = 48;

export class Plots {
  constructor(holder, state) {
    Object.assign(this, { holder, state });
    this.rows = state.cases.measures.map((measure) => this.row(measure));
    this.loads = byId("study-loads");
    holder.replaceChildren(...this.rows.map((row) => row.box));
    new ResizeObserver(() => this.spread()).observe(this.loads);
    new ResizeObserver(() => this.draw()).observe(holder);
  }

  row(measure) {
    const canvas = element("canvas");
    const title = element("button", "name", `${measure.title} [${measure.unit}]`);
    title.type = "button";
    title.title = `Colour the map by it. Better: ${measure.better}`;
    title.addEventListener("click", () => this.state.colourBy(measure.name));
    const { cases } = this.state;
    const say = (q) => number(cases.quantile(measure.name, q) * measure.factor);
    const figures = element("span", "dim", `p5 ${say(0.05)} · p50 ${say(0.5)}`);
    const ends = [element("span"), element("span")];
    const box = element("div", "plot", null, element("div", "head", null, title, figures), canvas, element("div", "ends dim", null, ...ends));
    return { measure, canvas, box, ends, title };
  }

  draw() {
    const width = this.holder.clientWidth - 2 * 10;
    if (width < 40) return;
    const height = Math.max(14, Math.min(40, (this.holder.clientHeight - 24) / this.rows.length - 34));
    for (const row of this.rows) this.histogram(row, width, height);
    this.spread();
  }

  histogram({ measure, canvas, ends, title }, width, height) {
    const { cases, chosen, measure: shown, scale } = this.state;
    const context = sized(canvas, width, height);
    const values = cases.sorted(measure.name);
    title.classList.toggle("on", shown === measure);
    if (!values.length) {
      ends[0].textContent = "no settled case has it";
      return;
    }
    let [low, high] = [values[0], values[values.length - 1]];
    const [q1, q99] = [cases.quantile(measure.name, 0.005), cases.quantile(measure.name, 0.995)];
    if (high - low > 3 * (q99 - q1)) [low, high] = [q1, q99];
    if (!(high > low)) [low, high] = [low - 0.5, high + 0.5];
    const counts = new Uint32Array(BINS);
    for (const value of values) {
      const bin = Math.floor((BINS * (value - low)) / (high - low));
      if (bin >= 0 && bin <= BINS) counts[Math.min(bin, BINS - 1)] += 1;
    }
    const most = Math.max(...counts);
    const x = (value) => ((value - low) / (high - low)) * width;
    for (let k = 0; k < BINS; k++) {
      const tall = ((height - 2) * counts[k]) / most;
      const middle = low + ((k + 0.5) / BINS) * (high - low);
      context.fillStyle = shown === measure ? scale.colour(middle) : "#87929d";
      context.fillRect((k * width) / BINS, height - 1 - tall, width / BINS - 0.6, tall);
    }
    context.fillStyle = "#5d6873";
    context.fillRect(0, height - 1, width, 1);
    if (low < 0 && high > 0) context.fillRect(x(0) - 0.5, 0, 1, height);
    const here = chosen === null ? NaN : cases.at(measure.name, chosen);
    if (Number.isFinite(here)) {
      context.fillStyle = "#d6007f";
      context.fillRect(Math.min(width - 2.5, Math.max(0, x(here) - 1.25)), 0, 2.5, height);
    }
    ends[0].textContent = number(low * measure.factor);
    ends[1].textContent = number(high * measure.factor);
  }

  /** Per wheel: 5 to 95 %, the quarters, the median; the chosen case's load. */
  spread() {
    const { cases, chosen } = this.state;
    const width = this.loads.clientWidth;
    if (width < 40) return;
    const { wheels } = cases.header;
    this.loads.replaceChildren();
    if (!wheels.length) return;
    const quantiles = wheels.map((wheel) => [0.05, 0.25, 0.5, 0.75, 0.95].map((q) => cases.quantile(`load_n/${wheel}`, q)));
    const most = 1.05 * Math.max(...quantiles.map((q) => q[4]).filter(Number.isFinite), 1e-9);
    const [line, left] = [13, 34];
    const canvas = element("canvas");
    const context = sized(canvas, width, line * wheels.length + 14);
    const x = (value) => left + (value / most) * (width - left - 4);
    context.font = "11px system-ui, sans-serif";
    wheels.forEach((wheel, k) => {
      const y = k * line + line / 2;
      const q = quantiles[k];
      context.fillStyle = "#1d242c";
      context.textAlign = "left";
      context.fillText(wheel, 0, y + 4, left - 4);
      if (!Number.isFinite(q[2])) return;
      context.fillStyle = "#cfd6dc";
      context.fillRect(x(q[0]), y - 1.5, x(q[4]) - x(q[0]), 3);
      context.fillStyle = "#87929d";
      context.fillRect(x(q[1]), y - 4, x(q[3]) - x(q[1]), 8);
      context.fillStyle = "#1d242c";
      context.fillRect(x(q[2]) - 1, y - 5, 2, 10);
      const here = chosen === null ? NaN : cases.at(`load_n/${wheel}`, chosen);
      if (Number.isFinite(here)) {
        context.fillStyle = "#d6007f";
        context.fillRect(Math.min(x(here), width - 2.5) - 1.25, y - 6, 2.5, 12);
      }
    });
    context.fillStyle = "#5d6873";
    context.textAlign = "left";
    context.fillText("0", left, line * wheels.length + 11);
    context.textAlign = "right";
    context.fillText(fixed(most, most < 10 ? 1 : 0), width - 2, line * wheels.length + 11);
    this.loads.append(canvas);
  }
}
