/* The page of a study: what is shown, and who is told when it changes. */
import { byId, element, fixed } from "./format.js";
import { unpack } from "./pack.js";
import { Cases } from "./columns.js";
import { Ground } from "./ground.js";
import { MapView, cellValues, cellsOf } from "./map.js";
import { scaleOf } from "./colours.js";
import { drawLegend } from "./legend.js";
import { Plots } from "./plots.js";
import { Sweep } from "./sweep.js";
import { Table } from "./table.js";
import { Picture } from "./picture.js";
import { showDetails } from "./details.js";
import { addMatters } from "./matters.js";

function heading(state, table) {
  const { header } = state.cases;
  const { about } = header;
  byId("title").textContent = header.title;
  const apart = [`${fixed(header.cases, 0)} cases`];
  if (about.seed !== undefined) apart.push(`seed ${about.seed}`);
  if (about.gravity !== undefined) apart.push(`g ${about.gravity} m/s²`);
  if (about.created) apart.push(String(about.created).slice(0, 10));
  byId("subtitle").textContent = apart.join(" · ");
  const words = header.columns.status.words;
  const counts = words.map(() => 0);
  for (const code of state.cases.column("status")) counts[code] += 1;
  const order = words.map((_, k) => k).sort((a, b) => counts[b] - counts[a]);
  byId("counts").replaceChildren(
    ...order.map((k) => {
      const chip = element("button", "chip", null, element("b", "", fixed(counts[k], 0)), ` ${header.status_words[words[k]] ?? words[k]}`);
      chip.type = "button";
      chip.title = "Show only these in the table";
      chip.addEventListener("click", () => {
        table.only(words[k]);
        for (const other of byId("counts").children) other.classList.toggle("on", other === chip && table.status !== null);
      });
      return chip;
    }),
  );
}

function about(header) {
  const rows = Object.entries(header.about).filter(([key, value]) => key !== "study" && value !== "");
  byId("about-table").replaceChildren(...rows.map(([key, value]) => element("tr", "", null, element("td", "", key.replace(/_/g, " ")), element("td", "", String(value)))));
  byId("about-study").textContent = header.about.study ?? "";
  byId("about-button").addEventListener("click", () => byId("about").showModal());
  byId("about-close").addEventListener("click", () => byId("about").close());
}

function choices(state) {
  const measure = byId("measure");
  measure.replaceChildren(...state.cases.measures.map((m) => new Option(`${m.title} [${m.unit}]`, m.name)));
  measure.value = state.measure.name;
  measure.addEventListener("change", () => state.colourBy(measure.value));
  byId("statistic").addEventListener("change", (event) => {
    state.statistic = event.target.value;
    state.recolour();
  });
}

function save(name, text) {
  const link = element("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function keys(state, table) {
  const step = (by) => {
    const order = table.order();
    const at = order.indexOf(state.chosen);
    state.choose(order[Math.min(order.length - 1, Math.max(0, at + by))] ?? state.chosen);
  };
  byId("next").addEventListener("click", () => step(1));
  byId("previous").addEventListener("click", () => step(-1));
  byId("csv").addEventListener("click", () => save("cases.csv", table.csv()));
  byId("print").addEventListener("click", () => window.print());
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
    if (event.key === "w") state.choose(state.cases.order(state.measure.name)[0]);
    else if (event.key === "n" || event.key === "ArrowRight") step(1);
    else if (event.key === "p" || event.key === "ArrowLeft") step(-1);
  });
}

/* What the address asks for: `#case=123&measure=tip`. */
function asked(cases) {
  const words = new URLSearchParams(location.hash.slice(1));
  const chosen = words.has("case") ? Number(words.get("case")) : NaN;
  return {
    chosen: Number.isInteger(chosen) && chosen >= 0 && chosen < cases.count ? chosen : null,
    measure: cases.measure.get(words.get("measure")) ?? null,
  };
}

function start({ header, segments }) {
  const cases = new Cases(header, segments);
  const state = { cases, ground: new Ground(header.ground, segments.get("ground")), cells: cellsOf(cases) };
  Object.assign(state, { robots: header.robots, exact: header.exact, statistic: "worst", measure: asked(cases).measure ?? cases.measure.get(header.first) });
  state.chosen = asked(cases).chosen ?? cases.order(state.measure.name)[0];
  const colour = () => {
    state.scale = scaleOf(cases, state.measure);
    state.values = cellValues(cases, state.cells, state.measure, state.statistic);
    drawLegend(state);
  };
  colour();
  const map = new MapView(byId("map"), byId("map-tip"), state);
  const table = new Table(byId("table"), state);
  const plots = new Plots(byId("plots"), state);
  const sweep = header.sweep ? new Sweep(byId("sweep"), state) : null;
  for (const id of ["map-card", "plots"]) byId(id).hidden = sweep !== null;
  byId("sweep").hidden = sweep === null;
  let picture = null;
  const chosen = () => showDetails(state, picture.show());
  state.recolour = () => {
    colour();
    map.draw();
    plots.draw();
    sweep?.draw();
    table.draw();
    picture.paint();
    chosen();
  };
  const remember = () => history.replaceState(null, "", `#case=${state.chosen}&measure=${state.measure.name}`);
  state.colourBy = (name) => {
    state.measure = cases.measure.get(name);
    remember();
    table.sort = null;
    byId("measure").value = name;
    state.recolour();
  };
  state.choose = (i) => {
    state.chosen = i;
    remember();
    map.draw();
    plots.draw();
    sweep?.draw();
    table.draw();
    chosen();
  };
  window.addEventListener("hashchange", () => {
    const { chosen: i, measure } = asked(cases);
    if (i !== null && i !== state.chosen) state.choose(i);
    if (measure && measure !== state.measure) state.colourBy(measure.name);
  });
  picture = new Picture(state, segments);
  heading(state, table);
  about(header);
  addMatters(header, byId("csv").parentNode);
  choices(state);
  keys(state, table);
  state.recolour();
  byId("loading").remove();
}

unpack()
  .then(start)
  .catch((error) => {
    byId("loading").textContent = `This page cannot be shown: ${error.message}`;
    throw error;
  });
