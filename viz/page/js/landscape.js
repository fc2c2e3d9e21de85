/* The ground in 3D: one mesh, close-meshed at the rover and wide away from it, painted like the map. */
import { paintCells, paintContours, plainContext } from "./map.js";

const SIDE = 90;
const SAND = "#cbc1af";

/** Coordinates close together near `at`, reaching from `low` to `high`; always 2 SIDE + 1 of them. */
function stretched(at, near, low, high) {
  const middle = Math.min(Math.max(at, low), high);
  const out = new Float32Array(2 * SIDE + 1);
  for (let k = 0; k <= SIDE; k++) {
    const t = k / SIDE;
    const way = (reach) => {
      const inner = Math.min(1.4 * near, reach);
      return inner * t + (reach - inner) * t ** 5;
    };
    out[SIDE - k] = middle - way(middle - low);
    out[SIDE + k] = middle + way(high - middle);
  }
  return out;
}

export class Landscape {
  constructor(view, ground) {
    Object.assign(this, { view, ground });
    const { THREE } = view;
    const n = 2 * SIDE + 1;
    this.geometry = new THREE.BufferGeometry();
    for (const [name, size] of [["position", 3], ["normal", 3], ["uv", 2]]) {
      this.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(size * n * n), size));
    }
    const index = new Uint32Array(6 * (n - 1) * (n - 1));
    let at = 0;
    for (let j = 0; j + 1 < n; j++) {
      for (let i = 0; i + 1 < n; i++) {
        const a = j * n + i;
        index.set([a, a + 1, a + n, a + 1, a + n + 1, a + n], at);
        at += 6;
      }
    }
    this.geometry.setIndex(new THREE.BufferAttribute(index, 1));
    this.canvas = document.createElement("canvas");
    const long = Math.max(ground.x1 - ground.x0, ground.y1 - ground.y0);
    this.scale = 2048 / long;
    this.canvas.width = Math.max(2, Math.round(this.scale * (ground.x1 - ground.x0)));
    this.canvas.height = Math.max(2, Math.round(this.scale * (ground.y1 - ground.y0)));
    this.texture = new THREE.CanvasTexture(this.canvas);
    this.texture.anisotropy = view.viewer.renderer.capabilities.getMaxAnisotropy();
    this.mesh = new THREE.Mesh(this.geometry, new THREE.MeshLambertMaterial({ map: this.texture, side: THREE.DoubleSide }));
    this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
    view.viewer.scene.add(this.mesh);
  }

  /** Lay the mesh anew around a place. */
  around(x, y, near) {
    const { ground } = this;
    const xs = stretched(x, near, ground.x0, ground.x1);
    const ys = stretched(y, near, ground.y0, ground.y1);
    const { position, normal, uv } = this.geometry.attributes;
    let k = 0;
    for (const v of ys) {
      for (const u of xs) {
        const [h, hx, hy] = ground.at(u, v);
        const length = Math.hypot(hx, hy, 1);
        position.setXYZ(k, u, v, h);
        normal.setXYZ(k, -hx / length, -hy / length, 1 / length);
        uv.setXY(k, (u - ground.x0) / (ground.x1 - ground.x0), (v - ground.y0) / (ground.y1 - ground.y0));
        k += 1;
      }
    }
    for (const attribute of [position, normal, uv]) attribute.needsUpdate = true;
  }

  /** Paint sand, the map's cells where wanted, and contours. */
  paint({ cells, values, scale }, coloured) {
    const { ground, canvas } = this;
    const context = plainContext(canvas);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = SAND;
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.setTransform(this.scale, 0, 0, -this.scale, -this.scale * ground.x0, this.scale * ground.y1);
    if (coloured) paintCells(context, cells, values, scale, { pixel: 1 / this.scale, alpha: 0.42 });
    paintContours(context, ground, Math.max(1.3 / this.scale, 0.012), "rgba(40, 40, 40, 0.38)");
    this.texture.needsUpdate = true;
    this.view.viewer.set_dirty();
  }
}
