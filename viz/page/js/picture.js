/* The chosen case in 3D. */
import { byId } from "./format.js";
import { Viewer3d, explain } from "./viewer3d.js";
import { Labels } from "./labels.js";
import { Inside } from "./inside.js";
import { Robot } from "./robot.js";
import { Marks } from "./marks.js";
import { Landscape } from "./landscape.js";
import { tellInside } from "./insidekey.js";
import { limitingOf } from "./details.js";

export class Picture {
  constructor(state, segments) {
    Object.assign(this, { state, segments, robots: [] });
    const pane = byId("pane");
    try {
      this.view = new Viewer3d(pane);
    } catch (error) {
      explain(pane, error);
      return;
    }
    this.landscape = new Landscape(this.view, state.ground);
    this.view.groundAt = (x, y) => state.ground.at(x, y)[0];
    this.marks = new Marks(this.view);
    this.inside = new Inside(this.view);
    this.through = false;
    this.labels = new Labels(this.view, byId("labels"));
    this.view.buttons(byId("views"), (name) => this.view.look(name, 2.1));
    this.view.toggle(byId("views"), "See through", false, (on) => {
      this.through = on;
      this.view.seeThrough(this.inside.bands.mesh, on);
      for (const robot of this.robots) if (robot) this.view.seeThrough(robot.all, on);
    });
    this.coloured = byId("coloured");
    this.coloured.addEventListener("change", () => this.paint());
  }

  /** Paint the ground as the map is painted. */
  paint() {
    if (this.view) this.landscape.paint(this.state, this.coloured.checked);
  }

  robot(index) {
    if (!this.robots[index]) {
      this.robots[index] = new Robot(this.view, this.state.robots[index], index, this.segments);
      if (this.through) this.view.seeThrough(this.robots[index].all, true);
    }
    this.robots.forEach((robot, k) => (robot.all.visible = k === index));
    return this.robots[index];
  }

  /** Show the chosen case; returns the wheel that carries least, or null. */
  show() {
    const { cases, chosen, exact, ground, measure } = this.state;
    const known = exact[chosen];
    const posed = Number.isFinite(cases.at("z_m", chosen));
    byId("unposed").hidden = posed;
    byId("nominal").hidden = !posed || Boolean(known) || !cases.header.reshaped;
    if (!this.view) return lightestOf(cases, chosen);
    if (!posed) {
      this.marks.clear();
      this.inside.clear();
      this.labels.set([]);
      this.robots.forEach((robot) => (robot.all.visible = false));
      this.view.viewer.set_dirty();
      return null;
    }
    const robot = this.robot(known?.robot ?? 0);
    robot.pose(cases, chosen);
    const contacts = cases.settled(chosen) ? (known?.contacts ?? robot.contacts(cases, chosen, ground)) : [];
    const com = (this.com = known?.com ?? (cases.header.reweighed ? above(contacts, robot.com()) : robot.com()));
    const first = !this.shown;
    this.shown = true;
    this.landscape.around(com[0], com[1], robot.span);
    const drawn = (this.drawn = this.inside.draw(robot, cases, chosen, (x, y) => ground.at(x, y)[0]));
    tellInside(drawn);
    const { middle, corners } = this.view.extent([robot.all]);
    this.view.corners = corners;
    this.view.follow([com[0], com[1], middle[2]], cases.at("yaw_rad", chosen), robot.span);
    if (first) this.view.look("Iso", 2.1);
    const limiting = [measure.name, "tip", "polygon"].map((name) => limitingOf(cases, name, chosen));
    const labels = this.marks.draw({ contacts, com, limiting, span: robot.span, groundHeight: ground.at(com[0], com[1])[0] });
    for (const label of labels) label.text = `${label.name}  ${label.text}`;
    this.labels.set(labels);
    return this.marks.lightest;
  }
}

/** A centre of mass at the height of `com` over the middle of the loads: where masses vary, moments say so. */
function above(contacts, com) {
  const weight = contacts.reduce((sum, contact) => sum + contact[4], 0);
  if (!(weight > 0)) return com;
  return [...[1, 2].map((k) => contacts.reduce((sum, contact) => sum + contact[4] * contact[k], 0) / weight), com[2]];
}

function lightestOf(cases, i) {
  const loads = cases.header.wheels.map((name) => [name, cases.at(`load_n/${name}`, i)]);
  const least = Math.min(...loads.map(([, load]) => load));
  return loads.find(([, load]) => load === least)?.[0] ?? null;
}
