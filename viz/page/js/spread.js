/* How a column's finite values spread over the settled cases: quantiles, percentiles, bins. */
import { MINUS } from "./codes.js";

export class Spread {
  /** Takes the column's name, and a mask of the cases that count (null: all). */
  constructor(cases, name, mask) {
    const about = cases.header.columns[name];
    const status = cases.column("status");
    const counts = (i) => status[i] === cases.settledWord && (mask === null || mask[i] === 1);
    if (about.kind === "f32") {
      const values = cases.column(name);
      this.set(Float32Array.from(values.filter((value, i) => counts(i) && Number.isFinite(value))).sort(), null);
      return;
    }
    const codes = cases.codes(name);
    const tally = new Uint32Array(65536);
    for (let i = 0; i < codes.length; i++) if (counts(i)) tally[codes[i]] += 1;
    const [values, below] = [[], [0]];
    for (let code = 0; code < MINUS; code++) {
      if (!tally[code]) continue;
      values.push(about.low + about.step * code);
      below.push(below[below.length - 1] + tally[code]);
    }
    this.set(Float64Array.from(values), Uint32Array.from(below));
  }

  /* Distinct values that rise; `below[k]` values are less than the k-th (null: k are). */
  set(values, below) {
    Object.assign(this, { values, below, total: below ? below[values.length] : values.length });
  }

  under(k) {
    return this.below ? this.below[k] : k;
  }

  get least() {
    return this.total ? this.values[0] : NaN;
  }

  get most() {
    return this.total ? this.values[this.values.length - 1] : NaN;
  }

  quantile(q) {
    if (!this.total) return NaN;
    const place = Math.min(this.total - 1, Math.floor(q * this.total));
    return this.values[firstWhere(this.values.length, (k) => this.under(k + 1) > place)];
  }

  /** Share with less than this value, in per cent. */
  percentile(value) {
    if (!this.total) return NaN;
    return (100 * this.under(firstWhere(this.values.length, (k) => this.values[k] >= value))) / this.total;
  }

  /** How many lie in each of `count` equal parts from `low` to `high`; what lies outside is left out. */
  bins(low, high, count) {
    const out = new Uint32Array(count);
    for (let k = 0; k < this.values.length; k++) {
      const value = this.values[k];
      if (value < low || value > high) continue;
      out[Math.min(count - 1, Math.floor((count * (value - low)) / (high - low)))] += this.under(k + 1) - this.under(k);
    }
    return out;
  }
}

/* The first of 0 ... count - 1 where a rising condition holds, else count. */
function firstWhere(count, holds) {
  let [low, high] = [0, count];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(middle)) high = middle;
    else low = middle + 1;
  }
  return low;
}
