/* The selection as CSV: SI units, in the table's order, to the page's rounding. */

const CHUNK = 20000;

/** Promise of a Blob; `told` hears the share done, so that a long table does not look like a dead page. */
export async function csvOf(cases, order, told = () => {}) {
  const names = ["case", ...Object.keys(cases.header.columns)];
  const write = names.map((name) => (name === "case" ? String : writer(cases.header.columns[name])));
  const parts = [names.map(quoted).join(",") + "\n"];
  for (let from = 0; from < order.length; from += CHUNK) {
    let text = "";
    for (const i of order.subarray(from, from + CHUNK)) {
      text += names.map((name, k) => write[k](name === "case" ? i : cases.at(name, i))).join(",") + "\n";
    }
    parts.push(text);
    told(Math.min(1, (from + CHUNK) / order.length));
    await new Promise((go) => setTimeout(go));
  }
  return new Blob(parts, { type: "text/csv" });
}

/* How a column's values are written: with the digits that its rounding leaves, and one more. */
function writer({ kind, rounding }) {
  if (kind === "words") return quoted;
  const decimals = Math.min(20, Math.max(0, Math.ceil(-Math.log10(rounding)) + 1));
  const digits = kind === "f32" ? (v) => v.toPrecision(9) : rounding > 0 ? (v) => v.toFixed(decimals) : (v) => v;
  return (value) => (Number.isNaN(value) ? "" : Number.isFinite(value) ? String(Number(digits(value))) : value > 0 ? "inf" : "-inf");
}

function quoted(text) {
  return /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}
