/* Numbers and small elements as people read them. */

/** A number with `digits` significant ones, a true minus sign and thousands apart; a word where there is none. */
export function number(value, digits = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (value === Infinity) return "∞";
  if (value === -Infinity) return "none";
  const size = Math.abs(value);
  if (size < 1e-6) return "0";
  let decimals = size === 0 ? 0 : Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  if (decimals > 6) decimals = 6;
  return fixed(value, decimals);
}

/** A measure's value (SI) in its unit; counts have no decimals. */
export function inUnit(measure, value) {
  return measure.whole && Number.isFinite(value) ? fixed(value * measure.factor, 0) : number(value * measure.factor);
}

/** A number with so many decimals. */
export function fixed(value, decimals) {
  if (!Number.isFinite(value)) return number(value);
  const text = Math.abs(value).toFixed(decimals);
  const [whole, rest] = text.split(".");
  const apart = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, " ") : whole;
  const minus = value < 0 && Number(text) !== 0 ? "−" : "";
  return minus + apart + (rest ? `.${rest}` : "");
}

/** How many decimals show steps of this size. */
export function decimalsFor(step) {
  return step > 0 ? Math.min(6, Math.max(0, Math.ceil(-Math.log10(step) - 1e-9))) : 0;
}

/** The 1-2-5 number nearest above `x`. */
export function nice(x) {
  if (!(x > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(x));
  for (const f of [1, 2, 5, 10]) if (f * power >= x * 0.9999) return f * power;
  return 10 * power;
}

/** Round values from `low` to `high`, about `count` of them. */
export function ticks(low, high, count = 5) {
  if (!(high > low)) return [low];
  const step = nice((high - low) / count);
  const out = [];
  for (let i = Math.ceil(low / step - 1e-6); i * step <= high + 1e-6 * step; i++) out.push(i * step);
  return out;
}

/** A new element with a class, a text and children. */
export function element(tag, name = "", text = null, ...children) {
  const made = document.createElement(tag);
  if (name) made.className = name;
  if (text !== null) made.textContent = text;
  made.append(...children);
  return made;
}

/** The element of this id. */
export function byId(id) {
  return document.getElementById(id);
}
