/* The ground under a motion: heights on a lattice that is closer along the path, its mesh and its lines. */
import { placeOf } from "./frames.js";

const SAND = [0.8, 0.76, 0.69];

export class Lattice {
  /** Reads ground `index` and adds it to the scene. */
  constructor(view, about, index, segments) {
    Object.assign(this, { view, ...about });
    const part = (name) => segments.get(`ground/${index}/${name}`).slice();
    [this.xs, this.ys, this.heights] = ["xs", "ys", "heights"].map((name) => new Float32Array(part(name).buffer));
    this.group = new view.THREE.Group();
    this.group.add(this.mesh(part("tones")), this.lines());
    view.viewer.scene.add(this.group);
  }

  /** Height and slopes [h, hx, hy] at a place, bilinear; beyond the edge those of the edge. */
  at(x, y) {
    const { xs, ys, nx, ny, heights } = this;
    const i = Math.min(placeOf(xs, x), nx - 2);
    const j = Math.min(placeOf(ys, y), ny - 2);
    const [dx, dy] = [xs[i + 1] - xs[i], ys[j + 1] - ys[j]];
    const s = Math.min(1, Math.max(0, (x - xs[i]) / dx));
    const t = Math.min(1, Math.max(0, (y - ys[j]) / dy));
    const k = j * nx + i;
    const [a, b, c, d] = [heights[k], heights[k + 1], heights[k + nx], heights[k + nx + 1]];
    return [
      (1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * c + s * d),
      ((1 - t) * (b - a) + t * (d - c)) / dx,
      ((1 - s) * (c - a) + s * (d - b)) / dy,
    ];
  }

  mesh(codes) {
    const { THREE } = this.view;
    const { xs, ys, nx, ny, heights } = this;
    const [position, color] = [new Float32Array(3 * nx * ny), new Float32Array(3 * nx * ny)];
    for (let k = 0; k < nx * ny; k++) {
      position.set([xs[k % nx], ys[Math.floor(k / nx)], heights[k]], 3 * k);
      color.set(SAND.map((part) => (part * codes[k]) / this.tone), 3 * k);
    }
    const index = new Uint32Array(6 * (nx - 1) * (ny - 1));
    let at = 0;
    for (let j = 0; j + 1 < ny; j++) {
      for (let i = 0; i + 1 < nx; i++) {
        const a = j * nx + i;
        index.set([a, a + 1, a + nx, a + 1, a + nx + 1, a + nx], at);
        at += 6;
      }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(color, 3));
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    geometry.computeVertexNormals();
    const material = new THREE.MeshPhongMaterial({ vertexColors: true, shininess: 8, side: THREE.DoubleSide });
    Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.receiveShadow = true;
    return mesh;
  }

  /** A net of square fields laid on the ground, along edges of its mesh. */
  lines() {
    const { THREE } = this.view;
    const { xs, ys, nx, ny, heights, grid } = this;
    const points = [];
    const put = (i, j) => points.push(xs[i], ys[j], heights[j * nx + i]);
    const on = (v) => Math.abs(v / grid - Math.round(v / grid)) < 1e-3;
    for (let i = 0; i < nx; i++) {
      if (on(xs[i])) for (let j = 0; j + 1 < ny; j++) [j, j + 1].forEach((k) => put(i, k));
    }
    for (let j = 0; j < ny; j++) {
      if (on(ys[j])) for (let i = 0; i + 1 < nx; i++) [i, i + 1].forEach((k) => put(k, j));
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
    return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0x5b5040, transparent: true, opacity: 0.22, depthWrite: false }));
  }
}
