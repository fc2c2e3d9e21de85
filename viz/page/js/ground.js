/* The ground's heights: read, interpolated, and its contour lines. */
import { unplaned } from "./columns.js";

export class Ground {
  constructor(about, bytes) {
    Object.assign(this, about);
    const steps = unplaned(bytes, Uint16Array);
    this.heights = new Float32Array(steps.length);
    for (let row = 0; row < this.ny; row++) {
      let code = 0;
      for (let k = row * this.nx; k < (row + 1) * this.nx; k++) {
        code = (code + steps[k]) & 65535;
        this.heights[k] = this.low + this.step * code;
      }
    }
    this.x1 = this.x0 + (this.nx - 1) * this.dx;
    this.y1 = this.y0 + (this.ny - 1) * this.dy;
  }

  /** Height and slopes [h, hx, hy] at a place, bilinear; beyond the edge those of the edge. */
  at(x, y) {
    const u = Math.min(Math.max((x - this.x0) / this.dx, 0), this.nx - 1.000001);
    const v = Math.min(Math.max((y - this.y0) / this.dy, 0), this.ny - 1.000001);
    const [i, j] = [Math.floor(u), Math.floor(v)];
    const [s, t] = [u - i, v - j];
    const k = j * this.nx + i;
    const [a, b, c, d] = [this.heights[k], this.heights[k + 1], this.heights[k + this.nx], this.heights[k + this.nx + 1]];
    return [
      (1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * c + s * d),
      ((1 - t) * (b - a) + t * (d - c)) / this.dx,
      ((1 - s) * (c - a) + s * (d - b)) / this.dy,
    ];
  }

  /** All contour lines as one Path2D in metres (kept). */
  contours() {
    if (this.path) return this.path;
    this.path = new Path2D();
    if (!this.contour) return this.path;
    for (let j = 0; j + 1 < this.ny; j++) for (let i = 0; i + 1 < this.nx; i++) this.crossings(i, j);
    return this.path;
  }

  /* Lines through one cell, its middle splitting it in four triangles. */
  crossings(i, j) {
    const k = j * this.nx + i;
    const h = [this.heights[k], this.heights[k + 1], this.heights[k + this.nx + 1], this.heights[k + this.nx]];
    const [low, high] = [Math.min(...h), Math.max(...h)];
    const first = Math.ceil(low / this.contour);
    if (first * this.contour > high) return;
    const [x, y] = [this.x0 + i * this.dx, this.y0 + j * this.dy];
    const corners = [[x, y], [x + this.dx, y], [x + this.dx, y + this.dy], [x, y + this.dy]];
    const middle = [x + this.dx / 2, y + this.dy / 2];
    const mean = (h[0] + h[1] + h[2] + h[3]) / 4;
    for (let level = first * this.contour; level <= high; level += this.contour) {
      for (let a = 0; a < 4; a++) {
        const b = (a + 1) % 4;
        const cuts = [];
        cut(cuts, corners[a], h[a], corners[b], h[b], level);
        cut(cuts, corners[b], h[b], middle, mean, level);
        cut(cuts, middle, mean, corners[a], h[a], level);
        if (cuts.length === 2) {
          this.path.moveTo(...cuts[0]);
          this.path.lineTo(...cuts[1]);
        }
      }
    }
  }
}

function cut(out, p, hp, q, hq, level) {
  if (hp < level === hq < level) return;
  const t = (level - hp) / (hq - hp);
  out.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
}
