/* Springs and belts of a posed robot: see rover_pin/viz/inside.py, whose sizes and colours these are. */
import { Buffers } from "./buffers.js";
import { taut, wayOf } from "./cable.js";

const RUBBER = [0.16, 0.17, 0.19];
const GRIP = [0.337, 0.706, 0.914];
const [WEAK, STRONG] = [[0.98, 0.84, 0.3], [0.5, 0.04, 0.49]];
const [THICK, PROUD, GRIPS, STEP] = [0.01, 0.002, 0.005, 0.03];
const [COIL, WIRE, TURNS, SHOWN] = [0.022, 0.0045, 9, 0.12];

export class Inside {
  constructor(view) {
    this.THREE = view.THREE;
    [this.coils, this.bands] = [0, 1].map(() => new Buffers(view.THREE, view.viewer.scene, { lit: true }));
  }

  /** Draw a posed robot's; `cases.at` gives joints, `height(x, y)` the ground. Returns what was drawn:
   * {springs: [{name, unit, force, ends}], belts: [{name, slack, points, grips}]}. */
  draw(robot, cases, i, height) {
    for (const buffers of [this.coils, this.bands]) buffers.begin();
    const springs = robot.springs.map((spring) => this.springOf(robot, spring, cases, i));
    for (const { line, force, unit } of springs) {
      const most = Math.max(...springs.filter((other) => other.unit === unit).map((other) => Math.abs(other.force)), 1e-12);
      const share = Math.abs(force) / most;
      this.coils.rope(line, WIRE * robot.span, WEAK.map((weak, k) => weak + share * (STRONG[k] - weak)));
    }
    const belts = robot.tracks.map((track) => this.beltOf(robot, track, height)).filter(Boolean);
    for (const buffers of [this.coils, this.bands]) buffers.end();
    return { springs, belts };
  }

  clear() {
    for (const buffers of [this.coils, this.bands]) {
      buffers.begin();
      buffers.end();
    }
  }

  world(robot, { node, point }) {
    return new this.THREE.Vector3(...point).applyMatrix4(robot.world[node]);
  }

  springOf(robot, spring, cases, i) {
    const { Vector3 } = this.THREE;
    const { span } = robot;
    const about = { name: spring.name, unit: spring.unit };
    if (spring.ends) {
      const [a, b] = spring.ends.map((end) => this.world(robot, end));
      const force = spring.preload + spring.stiffness * (spring.length_max - a.distanceTo(b));
      return { ...about, force, ends: [a.toArray(), b.toArray()], line: this.coil(a, b, COIL * span) };
    }
    const held = cases.at(`joint_rad/${spring.joint}`, i);
    const value = Number.isFinite(held) ? held : 0;
    const force = spring.preload - spring.stiffness * (value - spring.rest);
    const origin = this.world(robot, { node: spring.node, point: [0, 0, 0] });
    const [u, v, axis] = spring.frame.map((way) => new Vector3(...way).transformDirection(robot.world[spring.node]));
    if (spring.slides) {
      const far = origin.clone().addScaledVector(axis, spring.side * SHOWN * span - (value - spring.rest));
      return { ...about, force, ends: [far.toArray(), origin.toArray()], line: this.coil(far, origin, COIL * span) };
    }
    const line = Array.from({ length: 73 }, (_, k) => {
      const t = k / 72;
      const [radius, angle] = [COIL * span * (0.4 + 1.6 * t), t * (6 * Math.PI - value)];
      return origin.clone().addScaledVector(u, radius * Math.cos(angle)).addScaledVector(v, radius * Math.sin(angle));
    });
    return { ...about, force, ends: [line[0].toArray(), line[72].toArray()], line };
  }

  /** A helix from a to b. */
  coil(a, b, radius) {
    const { Vector3 } = this.THREE;
    const along = b.clone().sub(a);
    const helper = new Vector3(...[0, 1, 2].map((k) => (Math.abs(along.toArray()[k]) <= Math.min(...along.toArray().map(Math.abs)) ? 1 : 0)));
    const u = helper.clone().cross(along).normalize();
    const v = along.clone().cross(u).normalize();
    return Array.from({ length: 12 * TURNS + 1 }, (_, k) => {
      const t = k / (12 * TURNS);
      const wide = radius * Math.min(1, Math.min(t, 1 - t) / 0.1);
      const angle = 2 * Math.PI * TURNS * t;
      return a.clone().addScaledVector(along, t).addScaledVector(u, wide * Math.cos(angle)).addScaledVector(v, wide * Math.sin(angle));
    });
  }

  beltOf(robot, track, height) {
    const { Vector3 } = this.THREE;
    const { span } = robot;
    const [u, v, axis] = track.axes.map((way) => new Vector3(...way).transformDirection(robot.world[track.node]));
    const centers = track.circles.map((circle) => this.world(robot, { node: circle.node, point: circle.center }));
    const [origin] = centers;
    const places = centers.map((center) => [center.clone().sub(origin).dot(u), center.clone().sub(origin).dot(v)]);
    const cable = taut(places, track.circles.map((circle) => circle.rho));
    if (!cable) return null;
    const way = wayOf(cable, STEP * span);
    const points = way.map(([x, y]) => origin.clone().addScaledVector(u, x).addScaledVector(v, y));
    const outward = way.map(([, , x, y]) => u.clone().multiplyScalar(x).addScaledVector(v, y).normalize());
    const grips = points.map((p) => p.z - height(p.x, p.y) < GRIPS * span);
    const rows = points.map((point, k) =>
      [[0.5, PROUD], [-0.5, PROUD], [-0.5, PROUD - THICK], [0.5, PROUD - THICK], [0.5, PROUD]].map(([across, rise]) =>
        point.clone().addScaledVector(axis, across * track.width).addScaledVector(outward[k], rise * span).toArray(),
      ),
    );
    rows.slice(1).forEach((row, k) => {
      for (let n = 0; n < 4; n++) {
        const colour = grips[k] && grips[k + 1] ? GRIP : RUBBER;
        this.bands.triangle(rows[k][n], rows[k][n + 1], row[n], colour);
        this.bands.triangle(rows[k][n + 1], row[n + 1], row[n], colour);
      }
    });
    return { name: track.name, slack: track.length - cable.length, points: points.map((p) => p.toArray()), grips };
  }
}
