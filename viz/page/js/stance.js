/* The page of one stance. */
import { byId, element, fixed, number } from "./format.js";
import { commandsOf, unpack } from "./pack.js";
import { Viewer3d, explain } from "./viewer3d.js";
import { Labels } from "./labels.js";
import { loadBars } from "./bars.js";
import { tellInside } from "./insidekey.js";

function fillFacts(stance) {
  byId("robot").textContent = stance.robot;
  byId("terrain").textContent = `on ${stance.terrain}`;
  const chip = byId("status");
  chip.textContent = stance.status_words;
  chip.classList.add(stance.status === "settled" ? "good" : "bad");
  byId("reason").textContent = stance.reason || "";
  loadBars(byId("bars"), stance.loads, stance.lightest);
  byId("loads-card").hidden = !stance.loads.length;
  const extra = stance.redundant ? `, redundant: ${stance.redundant}` : "";
  byId("weight").textContent = `weight ${fixed(stance.weight_n, stance.weight_n < 100 ? 2 : 0)} N${extra}`;
  byId("margins-card").hidden = !stance.margins.length;
  byId("margins").replaceChildren(...stance.margins.map(marginRow));
  byId("pose").replaceChildren(
    ...stance.pose.map((row) =>
      element("tr", "", null, element("td", "", row.name), element("td", "value", fixed(row.value, row.unit === "m" ? 3 : 1)), element("td", "unit", row.unit)),
    ),
  );
  byId("springs-card").hidden = !stance.springs.length;
  byId("springs").replaceChildren(
    ...stance.springs.map((row) => element("tr", "", null, element("td", "", row.name), element("td", "value", number(row.value)), element("td", "unit", row.unit))),
  );
  byId("region").hidden = stance.region.length < 3 || !stance.loads.length;
  tellInside({
    springs: stance.springs.filter((row) => !stance.slack.some((track) => track.name === row.name)).map((row) => ({ ...row, force: row.value })),
    belts: stance.slack,
  });
  byId("residuals").textContent = stance.residuals.map((row) => `${row.name.replace(/_m$/, " [m]")} ${row.value === null ? "–" : row.value.toExponential(0)}`).join(" · ");
  byId("unread").textContent = stance.unread.length ? `not drawn, unreadable: ${stance.unread.join(", ")}` : "";
  byId("contours").hidden = !stance.contour_m;
  byId("contours").textContent = `contours every ${Math.round(1000 * stance.contour_m)} mm`;
  for (const mark of document.querySelectorAll(".needs-loads")) mark.hidden = !stance.loads.length;
}

function marginRow(margin) {
  const row = element(
    "tr",
    "",
    null,
    element("td", "", margin.title),
    element("td", "value", margin.value === null ? "none" : number(margin.value)),
    element("td", "unit", margin.unit),
    element("td", "unit", margin.better === "high" ? "↑" : "↓"),
    element("td", "unit", margin.limiting || ""),
  );
  row.title = [`better: ${margin.better}`, margin.limiting, margin.note].filter(Boolean).join(". ");
  if (margin.value === null || (margin.better === "high" && margin.value < 0)) row.className = "poor";
  return row;
}

function draw(stance, segments) {
  const view = new Viewer3d(byId("pane"));
  view.replay(commandsOf(segments.get("commands")));
  view.shadowless(["loads", "support", "com"]);
  const [robot, belts, region] = ["rover", "tracks", "support/region"].map((path) => view.node(path).object);
  view.node("ground").object.traverse((thing) => (thing.castShadow = false));
  const { middle, corners } = view.extent([robot]);
  view.corners = corners;
  view.follow([stance.target[0], stance.target[1], middle[2]], stance.yaw, stance.span);
  const wide = () => window.innerWidth > 900;
  const look = (name) => view.look(name, 2.05, wide() ? -0.09 : 0);
  view.buttons(byId("views"), look);
  look("Iso");
  view.toggle(byId("views"), "See through", false, (on) => [robot, belts].forEach((thing) => view.seeThrough(thing, on)));
  if (!byId("region").hidden) {
    view.toggle(byId("views"), "Region", true, (on) => {
      region.visible = on;
      view.viewer.set_dirty();
    });
  }
  keepCamera(view);
  const labels = new Labels(view, byId("labels"));
  const small = stance.weight_n < 60;
  const texts = stance.labels.map((l) => ({ at: l.at, light: l.light, text: `${l.name}  ${fixed(l.load, small ? 2 : 0)} N` }));
  if (stance.edge) texts.push({ at: stance.edge.at, light: true, text: `limiting edge  ${stance.edge.name}` });
  labels.set(texts);
}

/* A served page loads itself anew when another stance is shown; the camera stays. */
function keepCamera(view) {
  if (!document.body.dataset.live) return;
  const { camera, controls } = view.viewer;
  const kept = JSON.parse(sessionStorage.getItem("camera") || "null");
  sessionStorage.removeItem("camera");
  if (kept) {
    camera.position.copy(controls.target).add(new view.THREE.Vector3(...kept));
    controls.update();
  }
  let mark = null;
  setInterval(async () => {
    const answer = await fetch("mark").then((reply) => reply.text()).catch(() => mark);
    if (mark !== null && answer !== mark) {
      sessionStorage.setItem("camera", JSON.stringify(camera.position.clone().sub(controls.target).toArray()));
      location.reload();
    }
    mark = answer;
  }, 1000);
}

unpack()
  .then(({ header, segments }) => {
    fillFacts(header.stance);
    try {
      draw(header.stance, segments);
    } catch (error) {
      explain(byId("pane"), error);
    }
  })
  .catch((error) => explain(byId("pane"), error));
