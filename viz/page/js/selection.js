/* Which cases are shown: those within every range that was drawn, and of the statuses that were picked. */

export class Selection {
  constructor(cases) {
    Object.assign(this, { cases, ranges: new Map(), statuses: new Set() });
    this.mask = new Uint8Array(cases.count);
    this.apply();
  }

  get active() {
    return this.ranges.size > 0 || this.statuses.size > 0;
  }

  /** The mask for functions that take null for all. */
  get within() {
    return this.active ? this.mask : null;
  }

  /** Keep a measure within [low, high] (SI); null takes the range away. */
  range(name, ends) {
    if (ends) this.ranges.set(name, ends);
    else this.ranges.delete(name);
    this.apply();
  }

  /** Pick a status (its word), or let it go again; none picked means all. */
  toggle(status) {
    if (!this.statuses.delete(status)) this.statuses.add(status);
    this.apply();
  }

  clear() {
    this.ranges.clear();
    this.statuses.clear();
    this.apply();
  }

  /* The mask, how many pass, and how many of each status pass the ranges alone. */
  apply() {
    const { cases, mask } = this;
    const status = cases.column("status");
    mask.fill(1);
    for (const [name, [low, high]] of this.ranges) {
      const values = cases.column(name);
      for (let i = 0; i < mask.length; i++) {
        if (!(values[i] >= low && values[i] <= high) || status[i] !== cases.settledWord) mask[i] = 0;
      }
    }
    const { words } = cases.header.columns.status;
    this.byStatus = new Uint32Array(words.length);
    for (let i = 0; i < mask.length; i++) if (mask[i]) this.byStatus[status[i]] += 1;
    this.count = 0;
    const picked = words.map((word) => !this.statuses.size || this.statuses.has(word));
    for (let i = 0; i < mask.length; i++) this.count += mask[i] &= picked[status[i]] ? 1 : 0;
  }

  /** The first of an order that passes; null where none does. */
  first({ order }) {
    return order.find((i) => this.mask[i]) ?? null;
  }

  /** Those of an order (`Cases.order`) that pass; `reversed` turns those with a value round. */
  pick({ order, known }, reversed = false) {
    const out = new Uint32Array(this.count);
    let at = 0;
    for (let k = 0; k < order.length; k++) {
      const i = order[reversed && k < known ? known - 1 - k : k];
      if (this.mask[i]) out[at++] = i;
    }
    return out;
  }
}
