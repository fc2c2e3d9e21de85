/* Case numbers in the order of a column, by counting: a million in some hundredths of a second. */
import { MINUS, NOTHING, PLUS } from "./codes.js";

const DIGIT = 65536;

/** {order, known} as `Cases.order` says. Ties stay in the order of the case numbers. */
export function orderOf(cases, name) {
  const count = cases.count;
  if (name === "case") return { order: Uint32Array.from({ length: count }, (_, i) => i), known: count };
  const measure = cases.measure.get(name);
  const { key, digits, none } = keyed(cases, name, measure?.better === "low");
  let known = [];
  const rest = [];
  for (let i = 0; i < count; i++) (none(i) || (measure && !cases.settled(i)) ? rest : known).push(i);
  known = Uint32Array.from(known);
  for (let digit = 0; digit < digits; digit++) known = counted(known, (i) => (key(i) >>> (16 * digit)) & 65535);
  const order = new Uint32Array(count);
  order.set(known);
  order.set(rest, known.length);
  return { order, known: known.length };
}

/* A whole number a case that rises as the order wants it, and how many 16-bit digits it has. */
function keyed(cases, name, falling) {
  const { kind, words } = cases.header.columns[name];
  if (kind === "f32") {
    const values = cases.column(name);
    const bits = new Uint32Array(values.buffer);
    const turn = falling ? 0xffffffff : 0;
    const rising = (b) => (b >>> 31 ? ~b : b | 0x80000000) ^ turn;
    return { key: (i) => rising(bits[i]), digits: 2, none: (i) => Number.isNaN(values[i]) };
  }
  const codes = cases.codes(name);
  const rank = new Uint16Array(DIGIT);
  if (kind === "words") {
    const byName = words.map((_, k) => k).sort((a, b) => (words[a] < words[b] ? -1 : 1));
    byName.forEach((code, place) => (rank[code] = place));
    return { key: (i) => rank[codes[i]], digits: 1, none: () => false };
  }
  for (let code = 0; code < DIGIT; code++) {
    const rising = code === PLUS ? PLUS : code === MINUS ? 0 : code + 1;
    rank[code] = falling ? 65535 - rising : rising;
  }
  return { key: (i) => rank[codes[i]], digits: 1, none: (i) => codes[i] === NOTHING };
}

/* Stable counting sort of case numbers by one 16-bit digit. */
function counted(numbers, digit) {
  const starts = new Uint32Array(DIGIT + 1);
  for (const i of numbers) starts[digit(i) + 1] += 1;
  for (let k = 0; k < DIGIT; k++) starts[k + 1] += starts[k];
  const out = new Uint32Array(numbers.length);
  for (const i of numbers) out[starts[digit(i)]++] = i;
  return out;
}
