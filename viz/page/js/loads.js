/* How each wheel's load spreads over the study, and the chosen case's. */
import { sized } from "./canvas.js";
import { element, fixed } from "./format.js";

const [LINE, NAMES] = [13, 34];

export class Loads {
  constructor(holder, state) {
    Object.assign(this, { holder, state });
    new ResizeObserver(() => this.draw()).observe(holder);
  }

  /** Per wheel: 5 to 95 %, the quarters, the median; the chosen case's load. */
  draw() {
    const { cases, chosen } = this.state;
    const width = this.holder.clientWidth;
    if (width < 40) return;
    const { wheels } = cases.header;
    this.holder.replaceChildren();
    if (!wheels.length) return;
    const quantiles = wheels.map((wheel) => [0.05, 0.25, 0.5, 0.75, 0.95].map((q) => cases.quantile(`load_n/${wheel}`, q)));
    const most = 1.05 * Math.max(...quantiles.map((q) => q[4]).filter(Number.isFinite), 1e-9);
    const canvas = element("canvas");
    const context = sized(canvas, width, LINE * wheels.length + 14);
    const x = (value) => NAMES + (value / most) * (width - NAMES - 4);
    context.font = "11px system-ui, sans-serif";
    wheels.forEach((wheel, k) => {
      const y = k * LINE + LINE / 2;
      const q = quantiles[k];
      context.fillStyle = "#1d242c";
      context.textAlign = "left";
      context.fillText(wheel, 0, y + 4, NAMES - 4);
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
    context.fillText("0", NAMES, LINE * wheels.length + 11);
    context.textAlign = "right";
    context.fillText(fixed(most, most < 10 ? 1 : 0), width - 2, LINE * wheels.length + 11);
    this.holder.append(canvas);
  }
}
