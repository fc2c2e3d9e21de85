/* The page of a study: what is shown, and who is told when it changes. */
import { byId } from "./format.js";
import { unpack } from "./pack.js";
import { Cases } from "./columns.js";
import { Selection } from "./selection.js";
import { Ground } from "./ground.js";
import { cellValues, cellsOf } from "./cells.js";
import { MapView } from "./map.js";
import { scaleOf } from "./colours.js";
import { drawLegend } from "./legend.js";
import { Plots } from "./plots.js";
import { Loads } from "./loads.js";
import { Sweep } from "./sweep.js";
import { Table } from "./table.js";
import { Picture } from "./picture.js";
import { Heading } from "./heading.js";
import { dialogs } from "./about.js";
import { listen, notice } from "./keys.js";
import { asked, remember } from "./link.js";
import { showDetails } from "./details.js";
import { addMatters } from "./matters.js";

function choices(state) {
  const measure = byId("measure");
  measure.replaceChildren(...state.cases.measures.map((m) => new Option(`${m.title} [${m.unit}]`, m.name)));
  measure.addEventListener("change", () => state.colourBy(measure.value));
  byId("statistic").addEventListener("change", (event) => {
    state.statistic = event.target.value;
    state.recolour();
    state.remember();
  });
}

/* The parts of the page that are drawn anew. */
function parts(state, segments) {
  const { header } = state.cases;
  const made = { map: new MapView(byId("map"), byId("map-tip"), state), table: new Table(byId("table"), state) };
  made.heading = new Heading(state);
  made.plots = new Plots(byId("plots"), state);
  made.loads = new Loads(byId("study-loads"), state);
  made.sweep = header.sweep ? new Sweep(byId("sweep"), state) : null;
  for (const id of ["map-card", "plots"]) byId(id).hidden = made.sweep !== null;
  byId("sweep").hidden = made.sweep === null;
  made.picture = new Picture(state, segments);
  return made;
}

/* What the state can be told: choose a case, colour by a measure, filter. */
function deeds(state, { map, table, heading, plots, loads, sweep, picture }) {
  const { cases, selection } = state;
  const draw = () => [map, plots, sweep].forEach((part) => part?.draw());
  const chosen = () => {
    loads.draw();
    showDetails(state, picture.show());
  };
  state.remember = () => remember(state, table.sort);
  state.recolour = () => {
    state.recount();
    drawLegend(state);
    draw();
    table.renew();
    picture.paint();
    chosen();
  };
  state.colourBy = (name) => {
    state.measure = cases.measure.get(name);
    table.sort = null;
    byId("measure").value = name;
    state.recolour();
    state.remember();
  };
  state.choose = (i) => {
    state.chosen = i;
    state.remember();
    draw();
    table.reveal();
    chosen();
  };
  state.refilter = (done) => {
    state.recount();
    plots.respread();
    heading.draw();
    draw();
    table.renew();
    if (!done) return;
    picture.paint();
    chosen();
    state.remember();
  };
  state.filter = (name, ends, done = true) => {
    selection.range(name, ends);
    state.refilter(done);
  };
  state.clear = () => {
    selection.clear();
    state.refilter(true);
  };
  state.follow = (wanted) => {
    if (wanted.missing !== null) notice(`There is no case ${wanted.missing} here: give one from 0 to ${cases.count - 1}.`, 15);
    if (wanted.measure) state.measure = wanted.measure;
    state.chosen = wanted.chosen ?? state.chosen;
    Object.assign(state, { statistic: wanted.statistic });
    [byId("measure").value, byId("statistic").value] = [state.measure.name, state.statistic];
    table.sort = wanted.sort;
    Object.assign(selection, { ranges: wanted.ranges, statuses: wanted.statuses });
    selection.apply();
    plots.respread();
    heading.draw();
    state.recolour();
    table.reveal();
  };
}

function start({ header, segments }) {
  const cases = new Cases(header, segments);
  const state = { cases, selection: new Selection(cases), ground: new Ground(header.ground, segments.get("ground")), cells: cellsOf(cases) };
  const wanted = asked(cases);
  Object.assign(state, { robots: header.robots, exact: header.exact, statistic: "worst", measure: wanted.measure ?? cases.measure.get(header.first) });
  state.chosen = wanted.chosen ?? cases.order(state.measure.name).order[0];
  state.recount = () => {
    state.scale = scaleOf(cases, state.measure);
    const { values, picks, shown } = cellValues(cases, state.cells, state.measure, state.statistic, state.selection.within);
    Object.assign(state.cells, { picks, shown });
    state.values = values;
  };
  state.recount();
  const made = parts(state, segments);
  deeds(state, made);
  dialogs(header);
  addMatters(header, byId("csv").parentNode);
  choices(state);
  listen(state, made.table);
  state.follow(wanted);
  window.addEventListener("hashchange", () => state.follow(asked(cases)));
  const { picture } = made;
  window.roverPin = { state, picture, ready: performance.now() }; // for scripts and the browser's console
  byId("loading").remove();
}

window.pageStarted = true;
unpack()
  .then(start)
  .catch((error) => {
    byId("loading").textContent = `This page cannot be shown: ${error.message}`;
    throw error;
  });
