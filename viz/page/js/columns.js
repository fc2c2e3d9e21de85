/* The study's columns, decoded when they are first asked for. */
import { MINUS, NOTHING, PLUS } from "./codes.js";
import { orderOf } from "./order.js";
import { Spread } from "./spread.js";

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

function valueOf({ low, step }, code) {
  if (code < MINUS) return low + step * code;
  return { [NOTHING]: NaN, [PLUS]: Infinity, [MINUS]: -Infinity }[code];
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

  kept(key, make) {
    if (!this.known.has(key)) this.known.set(key, make());
    return this.known.get(key);
  }

  /** The 16-bit codes of a column of kind `u16` or `words` (kept). */
  codes(name) {
    return this.kept(`codes of ${name}`, () => unplaned(this.segments.get(`column/${name}`), Uint16Array));
  }

  /** All values of a column: numbers (SI), or for words their numbers (kept). */
  column(name) {
    const about = this.header.columns[name];
    if (about.kind === "words") return this.codes(name);
    return this.kept(name, () => {
      if (about.kind === "f32") return unplaned(this.segments.get(`column/${name}`), Float32Array);
      const codes = this.codes(name);
      const values = new Float64Array(codes.length);
      for (let i = 0; i < codes.length; i++) values[i] = codes[i] < MINUS ? about.low + about.step * codes[i] : valueOf(about, codes[i]);
      return values;
    });
  }

  /** A number, a word, or NaN where there is no such column; decodes no more than this value. */
  at(name, i) {
    const about = this.header.columns[name];
    if (!about) return NaN;
    if (about.kind === "f32") return this.column(name)[i];
    const bytes = this.segments.get(`column/${name}`);
    const code = bytes[i] | (bytes[this.count + i] << 8);
    return about.kind === "words" ? about.words[code] : valueOf(about, code);
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

  /** {order, known}: all case numbers, the worst of a measure or the least of a column first (kept);
   *  the first `known` have a value, the rest have none. */
  order(name) {
    return this.kept(`order of ${name}`, () => orderOf(this, name));
  }

  /** How the settled cases spread (kept). */
  spread(name) {
    return this.kept(`spread of ${name}`, () => new Spread(this, name, null));
  }

  /** Sorted finite values of the settled cases (kept). */
  sorted(name) {
    return this.kept(`sorted ${name}`, () => {
      const values = this.column(name);
      const finite = [];
      for (let i = 0; i < this.count; i++) if (this.settled(i) && Number.isFinite(values[i])) finite.push(values[i]);
      return Float64Array.from(finite).sort();
    });
  }

  quantile(name, q) {
    return this.spread(name).quantile(q);
  }

  /** Share of the settled cases with less than this value, in per cent. */
  percentile(name, value) {
    return this.spread(name).percentile(value);
  }
}
