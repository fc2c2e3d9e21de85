/* The page of motions: which run, which moment, and who is told. */
import { byId, fixed } from "./format.js";
import { unpack } from "./pack.js";
import { Frames } from "./frames.js";
import { Stage } from "./stage.js";
import { TimePlots } from "./timeplots.js";
import { Transport, tellMoment } from "./transport.js";
import { filmStrip } from "./film.js";

const VIEW_KEYS = { 1: "Iso", 2: "Side", 3: "Front", 4: "Top" };

/* What the address asks for: `#run=2&t=12.5&view=Side`, or `#film=0,5,10`; times count from the run's first. */
function asked(count) {
  const words = new URLSearchParams(location.hash.slice(1));
  const run = Number(words.get("run") ?? 0);
  const t = Number(words.get("t") ?? 0);
  return {
    run: Number.isInteger(run) && run >= 0 && run < count ? run : 0,
    t: Number.isFinite(t) ? t : 0,
    view: Object.values(VIEW_KEYS).find((name) => name === words.get("view")) ?? null,
    film: words.get("film")?.split(",").map(Number).filter(Number.isFinite) ?? [],
  };
}

/* What a run is, and what of it the page leaves out. */
function tellRun(frames, ground) {
  byId("terrain").textContent = `on ${frames.terrain} · ${fixed(frames.samples, 0)} sample${frames.samples > 1 ? "s" : ""} in ${fixed(frames.length, 1)} s`;
  const chip = byId("status");
  chip.textContent = frames.status.replace(/_/g, " ");
  chip.className = `chip ${frames.status === "done" ? "good" : "bad"}`;
  byId("reason").textContent = frames.reason;
  const notes = [];
  if (frames.count < frames.samples) notes.push(`The picture has ${fixed(frames.count, 0)} of the ${fixed(frames.samples, 0)} samples and goes straight between them; the plots keep the extremes of all.`);
  byId("notes").textContent = notes.join(" ");
  byId("notes").hidden = !notes.length;
  const loaded = frames.heaviest > 0;
  for (const mark of document.querySelectorAll(".needs-loads")) mark.hidden = !loaded;
  byId("net").textContent = `fields of ${fixed(ground.grid, ground.grid < 0.1 ? 2 : ground.grid < 1 ? 1 : 0)} m`;
}

function keys(state) {
  const { transport, stage } = state;
  const set = (id, on) => {
    byId(id).checked = on;
    byId(id).dispatchEvent(new Event("change"));
  };
  const does = {
    " ": () => transport.toggle(),
    ArrowRight: (event) => (event.shiftKey ? transport.seek(state.frames.change(transport.t, 1)) : transport.step(1)),
    ArrowLeft: (event) => (event.shiftKey ? transport.seek(state.frames.change(transport.t, -1)) : transport.step(-1)),
    Home: () => transport.seek(0),
    End: () => transport.seek(state.frames.length),
    "+": () => transport.faster(1),
    "-": () => transport.faster(-1),
    f: () => set("follow", !byId("follow").checked),
    l: () => set("marks", !byId("marks").checked),
    "?": () => byId("keys").showModal(),
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT" || byId("keys").open) return;
    const key = VIEW_KEYS[event.key] ? () => stage.view && stage.look(VIEW_KEYS[event.key]) : does[event.key];
    if (!key) return;
    event.preventDefault();
    key(event);
  });
  byId("follow").addEventListener("change", (event) => {
    stage.follows = event.target.checked;
    state.redraw();
  });
  byId("marks").addEventListener("change", (event) => {
    stage.marked = event.target.checked;
    state.redraw();
  });
  byId("keys-button").addEventListener("click", () => byId("keys").showModal());
  byId("keys-close").addEventListener("click", () => byId("keys").close());
}

function start({ header, segments }) {
  const { runs } = header;
  const state = { frames: null };
  const kept = new Map();
  const stage = new Stage(header, segments);
  const plots = new TimePlots(byId("plots"), header, (t) => {
    transport.pause();
    transport.seek(t);
  });
  let due = 0;
  const remember = () => {
    clearTimeout(due);
    due = setTimeout(() => history.replaceState(null, "", `#run=${state.run}&t=${transport.t.toFixed(3)}`), 300);
  };
  const moment = (t) => {
    stage.draw(t);
    plots.moment(t);
    tellMoment(state.frames, t);
    remember();
  };
  const transport = new Transport(moment);
  state.redraw = () => moment(transport.t);
  state.choose = (k, t = 0, view = null) => {
    if (!kept.has(k)) kept.set(k, new Frames(runs[k], k, header.robots[runs[k].robot], segments));
    Object.assign(state, { run: k, frames: kept.get(k) });
    byId("run").value = k;
    tellRun(state.frames, header.grounds[runs[k].ground]);
    stage.show(state.frames);
    transport.show(state.frames);
    plots.show(state.frames);
    transport.seek(t);
    if (view && stage.view) stage.look(view);
  };
  Object.assign(state, { transport, stage, plots });
  byId("title").textContent = header.title;
  byId("run").replaceChildren(...runs.map((run, k) => new Option(run.name, k)));
  byId("run").addEventListener("change", (event) => state.choose(Number(event.target.value)));
  byId("run-label").hidden = runs.length < 2;
  keys(state);
  const { run, t, view, film } = asked(runs.length);
  state.choose(run, t, view);
  window.addEventListener("hashchange", () => {
    const now = asked(runs.length);
    if (now.run !== state.run) state.choose(now.run, now.t, now.view);
    else transport.seek(now.t);
  });
  if (film.length) filmStrip(stage, state.frames, film, view);
  byId("loading").remove();
}

unpack()
  .then(start)
  .catch((error) => {
    byId("loading").textContent = `This page cannot be shown: ${error.message}`;
    throw error;
  });
