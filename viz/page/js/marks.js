/* Loads, support polygon and centre of mass: two meshes whose buffers are rewritten in place. */

const LOAD = [0.043, 0.341, 0.643];
const LIMIT = [0.851, 0.373, 0.008];
const COM = [0.839, 0.0, 0.498];
const ROOM = 6000;

class Buffers {
  constructor(THREE, parent, opacity) {
    this.THREE = THREE;
    const geometry = new THREE.BufferGeometry();
    for (const name of ["position", "color"]) geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * ROOM), 3));
    const material = new THREE.MeshBasicMaterial({ vertexColors: true, transparent: true, opacity, depthTest: false, depthWrite: false, side: THREE.DoubleSide });
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    parent.add(this.mesh);
    this.used = 0;
  }

  begin() {
    this.used = 0;
  }

  triangle(a, b, c, colour) {
    if (this.used + 3 > ROOM) return;
    const { position, color } = this.mesh.geometry.attributes;
    for (const corner of [a, b, c]) {
      position.setXYZ(this.used, ...corner);
      color.setXYZ(this.used, ...colour);
      this.used += 1;
    }
  }

  end() {
    const { geometry } = this.mesh;
    geometry.setDrawRange(0, this.used);
    for (const name of ["position", "color"]) geometry.attributes[name].needsUpdate = true;
  }

  /** A profile of [radius, way] turned about the line from `start` to `end`. */
  turned(profile, start, end, colour, segments) {
    const { Vector3, Quaternion } = this.THREE;
    const along = new Vector3(...end).sub(new Vector3(...start));
    if (along.lengthSq() < 1e-12) return;
    const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), along.normalize());
    const at = ([radius, way], k) => {
      const angle = (2 * Math.PI * k) / segments;
      const v = new Vector3(radius * Math.cos(angle), radius * Math.sin(angle), way).applyQuaternion(turn);
      return [v.x + start[0], v.y + start[1], v.z + start[2]];
    };
    for (let p = 0; p + 1 < profile.length; p++) {
      for (let k = 0; k < segments; k++) {
        this.triangle(at(profile[p], k), at(profile[p], k + 1), at(profile[p + 1], k), colour);
        this.triangle(at(profile[p], k + 1), at(profile[p + 1], k + 1), at(profile[p + 1], k), colour);
      }
    }
  }

  bar(start, end, radius, colour) {
    const length = Math.hypot(...end.map((v, k) => v - start[k]));
    this.turned([[radius, 0], [radius, length]], start, end, colour, 8);
  }

  arrow(start, tall, radius, colour) {
    const neck = Math.max(tall - 6.5 * radius, 0);
    const end = [start[0], start[1], start[2] + tall];
    this.turned([[0, 0], [radius, 0], [radius, neck], [2.6 * radius, neck], [0, tall]], start, end, colour, 12);
  }

  ball(center, radius, colour) {
    const profile = Array.from({ length: 11 }, (_, k) => {
      const angle = (Math.PI * k) / 10 - Math.PI / 2;
      return [radius * Math.cos(angle), radius * Math.sin(angle)];
    });
    this.turned(profile, center, [center[0], center[1], center[2] + 1], colour, 16);
  }
}

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
    this.area = new Buffers(view.THREE, parent, 0.14);
    this.solid = new Buffers(view.THREE, parent, 0.95);
  }

  /** Draw a case's marks; returns labels for the loads. `limiting`: words, the first that is an edge counts.
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
    this.polygon(bearing, com, limiting, span, apart);
    const labels = [];
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
    if (ring.length < 3) return;
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
  }

  clear() {
    for (const buffers of [this.area, this.solid]) {
      buffers.begin();
      buffers.end();
    }
  }
}
