/* Tracks that the wheels leave: ribbons on the ground, up to the time that is shown. */

const STEPS = 420;

export class Trails {
  /** One ribbon a wheel, worked out once a run by posing it along the way. */
  constructor(view, robot, frames, ground) {
    const { THREE } = view;
    const count = Math.min(STEPS, 4 * frames.count);
    this.times = Array.from({ length: count }, (_, k) => (frames.length * k) / Math.max(count - 1, 1));
    const wheels = robot.wheels.map(() => []);
    for (const t of this.times) {
      robot.pose(frames, frames.place(t));
      const held = new Set(frames.liftedAt(t));
      robot.wheels.forEach((wheel, k) => wheels[k].push(this.mark(THREE, robot, wheel, held)));
    }
    this.meshes = wheels.map((marks) => ribbon(THREE, marks, ground));
    this.group = new THREE.Group();
    this.group.add(...this.meshes);
    view.viewer.scene.add(this.group);
  }

  /** The two edges of a wheel's track under its centre, or null while it is lifted. */
  mark(THREE, robot, wheel, held) {
    if (held.has(wheel.name)) return null;
    const world = robot.world[wheel.node];
    const center = new THREE.Vector3(...wheel.center).applyMatrix4(world);
    const axis = new THREE.Vector3(...wheel.axis).transformDirection(world);
    const half = 1.1 * wheel.tread / Math.max(Math.hypot(axis.x, axis.y), 0.3);
    return [1, -1].map((side) => [center.x + side * half * axis.x, center.y + side * half * axis.y]);
  }

  /** Show what was left until a time. */
  until(t) {
    let k = 0;
    while (k + 1 < this.times.length && this.times[k + 1] <= t) k += 1;
    for (const mesh of this.meshes) mesh.geometry.setDrawRange(0, 6 * k);
  }
}

function ribbon(THREE, marks, ground) {
  const position = new Float32Array(6 * marks.length);
  marks.forEach((mark, k) => {
    (mark ?? marks[k - 1] ?? [[0, 0], [0, 0]]).forEach(([x, y], side) => position.set([x, y, ground.at(x, y)[0] + 2e-3], 6 * k + 3 * side));
  });
  const index = [];
  for (let k = 0; k + 1 < marks.length; k++) {
    const a = marks[k] && marks[k + 1] ? 2 * k : null;
    index.push(...(a === null ? [0, 0, 0, 0, 0, 0] : [a, a + 2, a + 1, a + 1, a + 2, a + 3]));
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
  geometry.setIndex(index);
  const material = new THREE.MeshBasicMaterial({ color: 0x4a3f30, transparent: true, opacity: 0.3, depthWrite: false, side: THREE.DoubleSide });
  Object.assign(material, { polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}
