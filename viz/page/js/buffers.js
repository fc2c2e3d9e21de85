/* A mesh of coloured triangles whose buffers are rewritten in place. */

const ROOM = 6000;

export class Buffers {
  /** Flat colours that hide behind nothing, or `lit` as the robot is. */
  constructor(THREE, parent, { opacity = 1, lit = false } = {}) {
    this.THREE = THREE;
    this.geometry = new THREE.BufferGeometry();
    const look = { vertexColors: true, side: THREE.DoubleSide };
    const material = lit
      ? new THREE.MeshPhongMaterial({ ...look, flatShading: true, shininess: 8 })
      : new THREE.MeshBasicMaterial({ ...look, transparent: true, opacity, depthTest: false, depthWrite: false });
    this.mesh = new THREE.Mesh(this.geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = lit;
    this.mesh.renderOrder = lit ? 0 : 10;
    parent.add(this.mesh);
    this.make(ROOM);
    this.used = 0;
  }

  /** Room for so many vertices; what is written stays. */
  make(room) {
    const { THREE, geometry } = this;
    for (const name of ["position", "color"]) {
      const values = new Float32Array(3 * room);
      values.set(geometry.attributes[name]?.array ?? []);
      geometry.setAttribute(name, new THREE.BufferAttribute(values, 3));
    }
    this.room = room;
  }

  begin() {
    this.used = 0;
  }

  triangle(a, b, c, colour) {
    if (this.used + 3 > this.room) this.make(2 * this.room);
    const { position, color } = this.geometry.attributes;
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

  /** A round bar along a polyline of Vector3. */
  rope(line, radius, colour) {
    const { Vector3 } = this.THREE;
    const ways = line.map((_, k) => line[Math.min(k + 1, line.length - 1)].clone().sub(line[Math.max(k - 1, 0)]).normalize());
    let side = new Vector3(Math.abs(ways[0].x) < 0.9 ? 1 : 0, Math.abs(ways[0].x) < 0.9 ? 0 : 1, 0);
    const rings = line.map((point, k) => {
      side = side.clone().addScaledVector(ways[k], -side.dot(ways[k])).normalize();
      const up = ways[k].clone().cross(side);
      return Array.from({ length: 7 }, (_, n) => {
        const angle = (Math.PI * n) / 3;
        return point.clone().addScaledVector(side, radius * Math.cos(angle)).addScaledVector(up, radius * Math.sin(angle)).toArray();
      });
    });
    for (let k = 0; k + 1 < rings.length; k++) {
      for (let n = 0; n < 6; n++) {
        this.triangle(rings[k][n], rings[k][n + 1], rings[k + 1][n], colour);
        this.triangle(rings[k][n + 1], rings[k + 1][n + 1], rings[k + 1][n], colour);
      }
    }
  }
}
