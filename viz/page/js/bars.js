/* Wheel loads as bars with a line at their mean. */
import { element, fixed, number } from "./format.js";

/** Fill `holder` with one bar a wheel: [{name, value}], the lightest orange. */
export function loadBars(holder, loads, lightest) {
  const known = loads.filter((load) => Number.isFinite(load.value));
  const most = Math.max(...known.map((load) => load.value), 1e-9);
  const mean = known.reduce((sum, load) => sum + load.value, 0) / Math.max(known.length, 1);
  const small = most < 10;
  holder.style.setProperty("--who", `${0.5 + 0.62 * Math.max(...loads.map(({ name }) => name.length), 0)}em`);
  holder.replaceChildren(
    ...loads.map(({ name, value }) => {
      const fill = element("i", name === lightest ? "fill light" : "fill");
      fill.style.width = `${Number.isFinite(value) ? (100 * value) / (1.12 * most) : 0}%`;
      const line = element("i", "mean");
      line.style.left = `${(100 * mean) / (1.12 * most)}%`;
      line.title = `mean ${number(mean)} N`;
      const text = Number.isFinite(value) ? `${fixed(value, small ? 2 : 0)} N` : "–";
      return element("div", "bar", null, element("span", "who", name), element("span", "rail", null, fill, line), element("b", "", text));
    }),
  );
}
