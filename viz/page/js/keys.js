/* Buttons and keys: the worst, the next, the previous case; link, CSV, print. */
import { csvOf } from "./csv.js";
import { byId, element } from "./format.js";

/** Say something for a moment. */
export function notice(text, seconds = 6) {
  const box = byId("notice");
  box.textContent = text;
  box.hidden = false;
  clearTimeout(box.timer);
  box.timer = setTimeout(() => (box.hidden = true), 1000 * seconds);
}

async function saveCsv(state, table) {
  const button = byId("csv");
  button.disabled = true;
  try {
    const blob = await csvOf(state.cases, table.order(), (share) => (button.textContent = `${Math.round(100 * share)} %`));
    const link = element("a");
    link.href = URL.createObjectURL(blob);
    link.download = "cases.csv";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  } catch (error) {
    notice(`No CSV: ${error.message}. Filter to fewer cases, or take the study's netCDF file.`);
  }
  button.textContent = "CSV";
  button.disabled = false;
}

async function copyLink() {
  try {
    await navigator.clipboard.writeText(location.href);
    notice("The link to this case, with filter and order, is on the clipboard.");
  } catch {
    notice(`The browser keeps the clipboard shut. The link: ${location.href}`, 20);
  }
}

/** Listen to buttons and keys. */
export function listen(state, table) {
  const step = (by) => {
    const order = table.order();
    if (order.length) state.choose(order[Math.min(order.length - 1, Math.max(0, order.indexOf(state.chosen) + by))]);
  };
  const worst = () => {
    const i = state.selection.first(state.cases.order(state.measure.name));
    if (i !== null) state.choose(i);
  };
  const actions = { next: () => step(1), previous: () => step(-1), worst, csv: () => saveCsv(state, table), link: copyLink, print: () => window.print() };
  for (const [id, act] of Object.entries(actions)) byId(id).addEventListener("click", act);
  const byKey = { w: worst, n: actions.next, ArrowRight: actions.next, p: actions.previous, ArrowLeft: actions.previous, c: () => state.clear(), "?": () => byId("keys").showModal() };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
    if (document.querySelector("dialog[open]")) return;
    byKey[event.key]?.();
  });
}
