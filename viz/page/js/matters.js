/* What matters: probabilities in words, and Sobol indices of a chosen figure as bars, in a dialog of its own. */
import { element } from "./format.js";

const INDEX_WIDE = 320;
const INDEX_HIGH = 34;
const INDEX_LEFT = 150;
const INDEX_RIGHT = 110;

function indexShape(name, attributes) {
  const maker = document.createElement("template");
  maker.innerHTML = "<svg></svg>";
  const node = document.createElementNS(maker.content.firstChild.namespaceURI, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  return node;
}

function indexText(words, x, y, anchor = "start") {
  const node = indexShape("text", { x, y, "text-anchor": anchor, "font-size": 12, fill: "currentColor" });
  node.textContent = words;
  return node;
}

/* One row an input: first order above, total below, a line for each interval. */
function indexBars(rows) {
  const height = INDEX_HIGH * rows.length + 24;
  const at = (share) => INDEX_LEFT + INDEX_WIDE * Math.min(Math.max(share, 0), 1);
  const chart = indexShape("svg", { width: INDEX_LEFT + INDEX_WIDE + INDEX_RIGHT, height, role: "img", "aria-label": "Sobol indices, first and total order" });
  for (const tick of [0, 0.25, 0.5, 0.75, 1]) {
    chart.append(indexShape("line", { x1: at(tick), x2: at(tick), y1: 0, y2: height - 20, stroke: "#d5dbe1" }), indexText(String(tick), at(tick), height - 6, "middle"));
  }
  rows.forEach(([name, first, firstBy, total, totalBy], k) => {
    const top = INDEX_HIGH * k + 4;
    chart.append(indexText(name.replace(/[_/]/g, " "), INDEX_LEFT - 8, top + 17, "end"));
    [[first, firstBy, "var(--load)", 0], [total, totalBy, "var(--limit)", 13]].forEach(([value, by, fill, down]) => {
      const y = top + down;
      chart.append(indexShape("rect", { x: INDEX_LEFT, y, width: at(value) - INDEX_LEFT, height: 11, fill, opacity: 0.85 }));
      chart.append(indexShape("line", { x1: at(value - by), x2: at(value + by), y1: y + 5.5, y2: y + 5.5, stroke: "#1d242c", "stroke-width": 1.5 }));
      chart.append(indexText(`${value.toFixed(3)} ± ${by.toFixed(3)}`, INDEX_LEFT + INDEX_WIDE + 8, y + 10));
    });
  });
  return chart;
}

export function addMatters({ matters }, tools) {
  if (!matters) return;
  const dialog = element("dialog", "matters");
  dialog.id = "matters";
  dialog.append(element("h1", "", matters.figures.length ? "What matters" : "How often"), ...matters.said.map((line) => element("p", "", line)));
  if (matters.figures.length) {
    const choice = element("select");
    choice.id = "matters-figure";
    choice.replaceChildren(...matters.figures.map((figure, k) => new Option(figure.title, k)));
    const box = element("div");
    const show = () => box.replaceChildren(indexBars(matters.figures[Number(choice.value)].rows));
    choice.addEventListener("change", show);
    const legend = element("div", "legend");
    legend.innerHTML = '<span style="--mark: var(--load)">first order: alone</span><span style="--mark: var(--limit)">total: with all it acts with</span>';
    dialog.append(element("h2", "", "Share of the variance (Sobol indices; black: 95 % interval)"), choice, legend, box);
    show();
  }
  const close = element("button", "", "Close");
  close.addEventListener("click", () => dialog.close());
  dialog.append(close);
  const open = element("button", "", matters.figures.length ? "What matters" : "How often");
  open.id = "matters-button";
  open.type = close.type = "button";
  open.title = "Probabilities and Sobol indices";
  open.addEventListener("click", () => dialog.showModal());
  tools.prepend(open);
  document.body.append(dialog);
}
