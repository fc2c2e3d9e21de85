/* Loads, support polygon and centre of mass: two meshes whose buffers are rewritten in place. */
import { Buffers } from "./buffers.js";

const LOAD = [0.043, 0.341, 0.643];
const LIMIT = [0.851, 0.373, 0.008];
const COM = [0.839, 0.0, 0.498];
/** Indices of the convex hull of [[name, x, y, z, load]], counterclockwise. */
export function hullOf(points) {
  const order = points.map((_, i) => i).sort((a, b) => points[a][1] - points[b][1] || points[a][2] - points[b][2]);
  const half = (list) => {
    const chain = [];
    for (const i of list) {
      while (chain.length > 1) {
        const [p, q] = [points[chain[chain.length - 2]], points[chain[chain.length - 1]]];
        const cross = (q[1] - p[1]) * (points[i][2] - p[2]) - (q[2] - p[2]) * (points[i][1] - p[1]);
        if (cross > 1e-12) break;
        chain.pop();
      }
      chain.push(i);
    }
    return chain.slice(0, -1);
  };
  return [...half(order), ...half([...order].reverse())];
}

export class Marks {
  constructor(view) {
    this.view = view;
    const parent = view.viewer.scene;
    this.area = new Buffers(view.THREE, parent, { opacity: 0.14 });
    this.solid = new Buffers(view.THREE, parent, { opacity: 0.95 });
  }

  /** Draw a case's marks; returns labels for the loads and for the limiting edge, where it is one. `limiting`: words, the first that is an edge counts.
   * `heaviest`: the load whose arrow is longest; this case's where it is 0. `apart`: share of it by which the
   * lightest wheel must be lighter to be marked; edges as near as half that share of the span are marked alike. */
  draw({ contacts, com, limiting, span, groundHeight, heaviest = 0, apart = 0 }) {
    const { solid, area } = this;
    solid.begin();
    area.begin();
    const bearing = contacts.filter((contact) => contact[4] > 0);
    const most = heaviest || Math.max(...bearing.map((contact) => contact[4]), 1e-9);
    const totals = new Map();
    for (const [name, , , , load] of contacts) totals.set(name, (totals.get(name) ?? 0) + (load || 0));
    const least = Math.min(...totals.values());
    const told = Math.max(...totals.values()) - least >= apart * most;
    this.lightest = (told && [...totals].find(([, load]) => load === least)?.[0]) || null;
    const labels = this.polygon(bearing, com, limiting, span, apart);
    this.arrows = bearing.map(([name, x, y, z, load]) => ({ name, at: [x, y, z], load }));
    for (const [name, x, y, z, load] of bearing) {
      const tall = (0.4 * span * load) / most;
      const light = name === this.lightest;
      solid.arrow([x, y, z], tall, 0.0095 * span, light ? LIMIT : LOAD);
      labels.push({ name, at: [x, y, z + tall], text: `${load < 10 ? load.toFixed(2) : Math.round(load)} N`, light });
    }
    const foot = [com[0], com[1], groundHeight];
    solid.ball(com, 0.022 * span, COM);
    solid.ball(foot, 0.009 * span, COM);
    solid.bar(com, foot, 0.004 * span, COM);
    solid.end();
    area.end();
    return labels;
  }

  polygon(bearing, com, limiting, span, apart) {
    const ring = bearing.length > 2 ? hullOf(bearing).map((i) => bearing[i]) : [];
    if (ring.length < 3) return [];
    const edges = ring.map((a, k) => [a, ring[(k + 1) % ring.length]]);
    const named = (word) => edges.findIndex(([a, b]) => word === `${a[0]}-${b[0]}` || word === `${b[0]}-${a[0]}`);
    const limit = limiting.map(named).find((k) => k >= 0) ?? -1;
    let limits = [limit];
    if (limit < 0) {
      const away = edges.map(([a, b]) => ((b[1] - a[1]) * (com[1] - a[2]) - (b[2] - a[2]) * (com[0] - a[1])) / Math.hypot(b[1] - a[1], b[2] - a[2]));
      const nearest = Math.min(...away);
      limits = apart ? away.flatMap((way, k) => (way <= nearest + 0.5 * apart * span ? [k] : [])) : [away.indexOf(nearest)];
    }
    const middle = [1, 2, 3].map((k) => ring.reduce((sum, point) => sum + point[k], 0) / ring.length);
    edges.forEach(([a, b], k) => {
      this.area.triangle(a.slice(1, 4), b.slice(1, 4), middle, LOAD);
      this.solid.bar(a.slice(1, 4), b.slice(1, 4), (limits.includes(k) ? 0.006 : 0.0035) * span, limits.includes(k) ? LIMIT : LOAD);
    });
    if (limits.length > 1) return [];
    const [a, b] = edges[limits[0]];
    return [{ name: "limiting edge", at: [1, 2, 3].map((k) => (a[k] + b[k]) / 2), text: `${a[0]}–${b[0]}`, light: true, edge: true }];
  }

  clear() {
    for (const buffers of [this.area, this.solid]) {
      buffers.begin();
      buffers.end();
    }
  }
}
