/* The study's columns, decoded when they are first asked for. */

const [NOTHING, PLUS, MINUS] = [65535, 65534, 65533];

function unplane(bytes, size) {
  const count = bytes.length / size;
  const out = new Uint8Array(bytes.length);
  for (let plane = 0; plane < size; plane++) {
    const from = plane * count;
    for (let i = 0; i < count; i++) out[i * size + plane] = bytes[from + i];
  }
  return out.buffer;
}

/** Values of byte planes: `type` is a typed array's class. */
export function unplaned(bytes, type) {
  return new type(unplane(bytes, type.BYTES_PER_ELEMENT));
}

export class Cases {
  constructor(header, segments) {
    this.header = header;
    this.count = header.cases;
    this.segments = segments;
    this.known = new Map();
    this.measures = header.measures;
    this.measure = new Map(header.measures.map((m) => [m.name, m]));
    this.settledWord = this.wordNumber("status", "settled");
  }

  has(name) {
    return name in this.header.columns;
  }

  /** All values of a column: numbers (SI), or for words their numbers. */
  column(name) {
    if (this.known.has(name)) return this.known.get(name);
    const about = this.header.columns[name];
    const bytes = this.segments.get(`column/${name}`);
    let values;
    if (about.kind === "f32") values = unplaned(bytes, Float32Array);
    else {
      const codes = unplaned(bytes, Uint16Array);
      values = codes;
      if (about.kind === "u16") {
        values = new Float64Array(codes.length);
        for (let i = 0; i < codes.length; i++) {
          const code = codes[i];
          if (code === NOTHING) values[i] = NaN;
          else if (code === PLUS) values[i] = Infinity;
          else if (code === MINUS) values[i] = -Infinity;
          else values[i] = about.low + about.step * code;
        }
      }
    }
    this.known.set(name, values);
    return values;
  }

  /** A number, a word, or NaN where there is no such column. */
  at(name, i) {
    const about = this.header.columns[name];
    if (!about) return NaN;
    const value = this.column(name)[i];
    return about.kind === "words" ? about.words[value] : value;
  }

  wordNumber(name, word) {
    return this.header.columns[name].words.indexOf(word);
  }

  settled(i) {
    return this.column("status")[i] === this.settledWord;
  }

  /** Whether a column of numbers has one value only. */
  constant(name) {
    const about = this.header.columns[name];
    return about.kind === "u16" && about.rounding === 0;
  }

  /** How much worse first: negative where a is worse than b; what has no value comes last. */
  worseFirst(name) {
    const values = this.column(name);
    const sign = this.measure.get(name)?.better === "low" ? -1 : 1;
    return (a, b) => {
      const [x, y] = [values[a], values[b]];
      const [none, other] = [Number.isNaN(x) || !this.settled(a), Number.isNaN(y) || !this.settled(b)];
      if (none || other) return none - other || a - b;
      return x === y ? a - b : sign * (x - y);
    };
  }

  /** All case numbers, the worst of a measure first (kept). */
  order(name) {
    const key = `order of ${name}`;
    if (!this.known.has(key)) {
      const all = Uint32Array.from({ length: this.count }, (_, i) => i);
      this.known.set(key, all.sort(this.worseFirst(name)));
    }
    return this.known.get(key);
  }

  /** Sorted finite values of the settled cases (kept). */
  sorted(name) {
    const key = `sorted ${name}`;
    if (!this.known.has(key)) {
      const values = this.column(name);
      const kept = [];
      for (let i = 0; i < this.count; i++) if (this.settled(i) && Number.isFinite(values[i])) kept.push(values[i]);
      this.known.set(key, Float64Array.from(kept).sort());
    }
    return this.known.get(key);
  }

  quantile(name, q) {
    const all = this.sorted(name);
    return all.length ? all[Math.min(all.length - 1, Math.floor(q * all.length))] : NaN;
  }

  /** Share of the settled cases with less than this value, in per cent. */
  percentile(name, value) {
    const all = this.sorted(name);
    let [low, high] = [0, all.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (all[middle] < value) low = middle + 1;
      else high = middle;
    }
    return all.length ? (100 * low) / all.length : NaN;
  }
}
