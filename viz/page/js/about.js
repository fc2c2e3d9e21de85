/* What the page says about itself: provenance, the study file, how far each column is rounded. */
import { byId, element } from "./format.js";

/** Fill the dialogs and their buttons. */
export function dialogs(header) {
  const rows = Object.entries(header.about).filter(([key, value]) => key !== "study" && value !== "");
  byId("about-table").replaceChildren(...rows.map(([key, value]) => aboutRow(key.replace(/_/g, " "), String(value))));
  byId("about-rounding").replaceChildren(
    ...Object.entries(header.columns)
      .filter(([, column]) => column.kind !== "words")
      .map(([name, { rounding, unit }]) => aboutRow(name, rounding ? `± ${roundedUp(rounding)} ${unit}`.trim() : "exact")),
  );
  byId("about-study").textContent = header.about.study ?? "";
  for (const name of ["about", "keys"]) {
    byId(`${name}-button`).addEventListener("click", () => byId(name).showModal());
    byId(`${name}-close`).addEventListener("click", () => byId(name).close());
  }
}

function aboutRow(name, text) {
  return element("tr", "", null, element("td", "", name), element("td", "", text));
}

/* Two digits, never less than it is. */
function roundedUp(value) {
  const unit = 10 ** (Math.floor(Math.log10(value)) - 1);
  return String(Number((Math.ceil(value / unit - 1e-9) * unit).toPrecision(2)));
}
