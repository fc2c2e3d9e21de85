/* The motion in 3D: robots, grounds, tracks, loads; one moment at a time. */
import { byId } from "./format.js";
import { Viewer3d, explain } from "./viewer3d.js";
import { Labels } from "./labels.js";
import { Lattice } from "./lattice.js";
import { Marks } from "./marks.js";
import { Inside } from "./inside.js";
import { tellInside } from "./insidekey.js";
import { Robot } from "./robot.js";
import { Trails } from "./trails.js";

const FAR = 2.0;

export class Stage {
  constructor(header, segments) {
    Object.assign(this, { header, segments, robots: [], grounds: [], trails: new Map(), follows: true, marked: true });
    const pane = byId("pane");
    try {
      this.view = new Viewer3d(pane);
    } catch (error) {
      explain(pane, error);
      return;
    }
    this.marks = new Marks(this.view);
    this.inside = new Inside(this.view);
    this.through = false;
    this.labels = new Labels(this.view, byId("labels"));
    this.view.buttons(byId("views"), (name) => this.look(name));
    this.view.toggle(byId("views"), "See through", false, (on) => {
      this.through = on;
      this.view.seeThrough(this.inside.bands.mesh, on);
      for (const robot of this.robots) if (robot) this.view.seeThrough(robot.all, on);
    });
    this.view.groundAt = (x, y) => this.ground.at(x, y)[0];
  }

  /** Take up a run; the camera goes to it. */
  show(frames) {
    if (!this.view) return;
    this.frames = frames;
    const { robot, ground } = frames;
    this.robots[robot] ??= new Robot(this.view, this.header.robots[robot], robot, this.segments);
    this.grounds[ground] ??= new Lattice(this.view, this.header.grounds[ground], ground, this.segments);
    this.view.seeThrough(this.robots[robot].all, this.through);
    this.robots.forEach((other, k) => (other.all.visible = k === robot));
    this.grounds.forEach((other, k) => (other.group.visible = k === ground));
    [this.robot, this.ground] = [this.robots[robot], this.grounds[ground]];
    if (!this.trails.has(frames)) this.trails.set(frames, new Trails(this.view, this.robot, frames, this.ground));
    for (const [other, trails] of this.trails) trails.group.visible = other === frames;
    this.settled = false;
  }

  look(name) {
    this.view.follow(this.target, this.yaw, this.robot.span);
    this.view.look(name, FAR);
  }

  /** Show a moment. */
  draw(t, view) {
    if (!this.view) return;
    const { frames, robot } = this;
    const place = frames.place(t);
    robot.pose(frames, place);
    const contacts = robot.contacts(frames, place, this.ground);
    this.drawn = this.inside.draw(robot, frames, place, (x, y) => this.ground.at(x, y)[0]);
    tellInside(this.drawn);
    this.aim(contacts, frames.at("yaw_rad", place));
    if (!this.settled || view) this.look(view ?? "Iso");
    this.settled = true;
    this.trails.get(frames).until(t);
    const labels = this.label(contacts, new Set(frames.liftedAt(t)));
    this.labels.set(this.marked ? labels : []);
    this.view.viewer.set_dirty();
  }

  /** The camera's point goes with the wheels, not with the body, so that the body is seen to rise. */
  aim(contacts, yaw) {
    const middle = [1, 2, 3].map((k) => contacts.reduce((sum, contact) => sum + contact[k], 0) / contacts.length);
    this.target = [middle[0], middle[1], middle[2] + 0.22 * this.robot.span];
    this.yaw = yaw;
    if (this.follows && this.settled) this.view.follow(this.target, yaw, this.robot.span);
    else this.view.light(this.target, yaw, this.robot.span);
  }

  /** Loads, support polygon and centre of mass; labels at wheels. */
  label(contacts, lifted) {
    const { robot, frames, ground } = this;
    const com = robot.com();
    const standing = contacts.filter(([name]) => !lifted.has(name));
    const labels = this.marks.draw({
      contacts: this.marked ? standing : [],
      com,
      limiting: [],
      span: robot.span,
      groundHeight: ground.at(com[0], com[1])[0],
      heaviest: frames.heaviest,
      apart: 0.02,
    });
    for (const label of labels) label.text = `${label.name}  ${label.text}`;
    for (const [name, x, y, z] of contacts) {
      if (lifted.has(name)) labels.push({ at: [x, y, z + 0.3 * robot.span], text: `${name} lifted`, light: true });
    }
    return labels;
  }
}
