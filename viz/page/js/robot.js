/* The robot of the page, posed case by case: base and joints are set, the scene's tree composes the rest. */
import { commandsOf } from "./pack.js";

export class Robot {
  /** Draws robot `index` from its recorded commands. */
  constructor(view, about, index, segments) {
    Object.assign(this, about);
    this.view = view;
    view.replay(commandsOf(segments.get(`robot/${index}`)));
    this.things = about.nodes.map((node) => view.node(node.path).object);
    this.all = view.node(`robot${index}`).object;
    this.rootMatrix = new view.THREE.Matrix4().fromArray(about.root);
  }

  /** Set base and joints of a case. */
  pose(cases, i) {
    const { THREE } = this.view;
    const euler = new THREE.Euler(cases.at("roll_rad", i), cases.at("pitch_rad", i), cases.at("yaw_rad", i), "ZYX");
    const place = new THREE.Vector3(cases.at("x_m", i), cases.at("y_m", i), cases.at("z_m", i));
    const base = new THREE.Matrix4().compose(place, new THREE.Quaternion().setFromEuler(euler), new THREE.Vector3(1, 1, 1));
    base.premultiply(this.rootMatrix).decompose(this.things[0].position, this.things[0].quaternion, this.things[0].scale);
    this.nodes.forEach((node, k) => {
      if (k === 0) return;
      const value = cases.at(`joint_rad/${node.name}`, i);
      const held = Number.isFinite(value) ? value : 0;
      const axis = new THREE.Vector3(...node.axis);
      if (node.slides) this.things[k].position.copy(axis.multiplyScalar(held));
      else this.things[k].quaternion.setFromAxisAngle(axis, held);
    });
    this.all.updateWorldMatrix(true, true);
    const inverse = this.view.viewer.scene.matrixWorld.clone().invert();
    this.world = this.things.map((thing) => inverse.clone().multiply(thing.matrixWorld));
  }

  /** Centre of mass of the posed robot, without a payload of the study's. */
  com() {
    const sum = new this.view.THREE.Vector3();
    let mass = 0;
    this.nodes.forEach((node, k) => {
      sum.addScaledVector(new this.view.THREE.Vector3(...node.lever).applyMatrix4(this.world[k]), node.mass);
      mass += node.mass;
    });
    return sum.divideScalar(mass || 1).toArray();
  }

  /** Where each wheel is nearest to the plane of the ground under it: [[name, x, y, z, load]]. */
  contacts(cases, i, ground) {
    const { THREE } = this.view;
    return this.wheels.map((wheel) => {
      const center = new THREE.Vector3(...wheel.center).applyMatrix4(this.world[wheel.node]);
      const axis = new THREE.Vector3(...wheel.axis).transformDirection(this.world[wheel.node]);
      const point = center.clone();
      for (let round = 0; round < 3; round++) {
        const [, hx, hy] = ground.at(point.x, point.y);
        const normal = new THREE.Vector3(-hx, -hy, 1).normalize();
        const down = normal.clone().addScaledVector(axis, -normal.dot(axis)).negate();
        if (down.lengthSq() > 1e-12) down.normalize();
        point.copy(center).addScaledVector(down, wheel.ring).addScaledVector(normal, -wheel.tread);
      }
      return [wheel.name, point.x, point.y, point.z, cases.at(`load_n/${wheel.name}`, i)];
    });
  }
}
