/* A run as the page holds it: frames for the picture, lines for the plots, spans of actions and lifted wheels. */

const floats = (bytes, Kind = Float32Array) => new Kind(bytes.slice().buffer);

/** The last place in rising `times` that is not after `t`; 0 where all are. */
export function placeOf(times, t) {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

const BASE = { x_m: "base_x", y_m: "base_y", z_m: "base_z", yaw_rad: "base_yaw", pitch_rad: "base_pitch", roll_rad: "base_roll" };

export class Frames {
  constructor(about, index, robot, segments) {
    Object.assign(this, about);
    const part = (name) => segments.get(`run/${index}/${name}`);
    this.times = floats(part("time"), Float64Array);
    this.count = this.times.length;
    this.length = this.times[this.count - 1];
    this.q = floats(part("q"));
    this.loads = floats(part("loads"));
    this.rows = new Map();
    about.columns.forEach((name, k) => this.rows.set(name, this.q.subarray(k * this.count, (k + 1) * this.count)));
    for (const [name, column] of Object.entries(BASE)) this.rows.set(name, this.rows.get(column));
    for (const { name } of robot.nodes) this.rows.set(`joint_rad/${name}`, this.rows.get(name));
    this.wheels = robot.wheels.map((wheel) => wheel.name);
    this.wheels.forEach((name, k) => this.rows.set(`load_n/${name}`, this.loads.subarray(k * this.count, (k + 1) * this.count)));
    this.heaviest = this.loads.reduce((most, load) => (load > most ? load : most), 0);
    this.lines = linesOf(about.curves, floats(part("curves")));
  }

  /** Frame at a time, with its part of the way to the next. */
  place(t) {
    const k = placeOf(this.times, t);
    const next = this.times[k + 1];
    return next > this.times[k] ? k + Math.min(1, Math.max(0, (t - this.times[k]) / (next - this.times[k]))) : k;
  }

  /** A column between frames; a load is that of the frame before. */
  at(name, place) {
    const row = this.rows.get(name);
    if (!row) return NaN;
    const k = Math.floor(place);
    const part = place - k;
    return part > 0 && !name.startsWith("load_n/") ? row[k] + part * (row[k + 1] - row[k]) : row[k];
  }

  /** What is done and what is lifted at a time. */
  action(t) {
    return this.actions[spanAt(this.actions, t)].word;
  }

  liftedAt(t) {
    return this.lifted[spanAt(this.lifted, t)].word;
  }

  /** Start of the action before or after the one at a time. */
  change(t, by) {
    const k = spanAt(this.actions, t);
    if (by < 0 && t > this.actions[k].from + 1e-9) return this.actions[k].from;
    return this.actions[Math.min(this.actions.length - 1, Math.max(0, k + by))].from;
  }
}

function spanAt(spans, t) {
  return placeOf(spans.map((span) => span.from), t + 1e-9);
}

/** Lines with their points: {panel, name, part, highest, times, values}. */
function linesOf(curves, points) {
  let at = 0;
  return curves.map((curve) => {
    const times = points.subarray(at, at + curve.count);
    const values = points.subarray(at + curve.count, at + 2 * curve.count);
    at += 2 * curve.count;
    return { ...curve, times, values };
  });
}

/** A line's value at a time: that of the last kept point before it. */
export function valueAt(line, t) {
  return line.values[placeOf(line.times, t + 1e-6)];
}
