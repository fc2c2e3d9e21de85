/* Meshcat's viewer in a pane of the page: its size, its light, its camera. */

/** World (z up) to the camera's axes (y up). */
export function cameraAxes([x, y, z]) {
  return [x, z, -y];
}

/** Parts of the picture's height and width that what is drawn may fill, beside panels and legend. */
const FILLS = { height: 0.84, width: 0.72 };

const VIEWS = { Iso: [-0.62, -0.70, 0.50], Side: [0, -1, 0.16], Front: [1, 0, 0.16], Top: [-0.001, 0, 1] };

export class Viewer3d {
  /** Takes the pane; throws where the browser has no WebGL. */
  constructor(pane) {
    this.pane = pane;
    const probe = document.createElement("canvas");
    if (!(probe.getContext("webgl2") || probe.getContext("webgl"))) throw new Error("no WebGL");
    const kept = window.onload;
    this.viewer = new MeshCat.Viewer(pane);
    window.onload = kept;
    this.viewer.gui.domElement.style.display = "none";
    this.listeners = [];
    const plain = Object.getPrototypeOf(this.viewer).set_3d_pane_size;
    this.viewer.set_3d_pane_size = () => plain.call(this.viewer, Math.max(pane.clientWidth, 1), Math.max(pane.clientHeight, 1));
    new ResizeObserver(() => this.viewer.set_3d_pane_size()).observe(pane);
    const render = this.viewer.render.bind(this.viewer);
    this.viewer.render = () => {
      render();
      for (const tell of this.listeners) tell();
    };
    this.viewer.renderer.debug.checkShaderErrors = false; // asking waits for each shader
    this.setting();
    this.viewer.camera.fov = 42;
    this.viewer.camera.near = 0.02;
    this.viewer.camera.far = 400;
    this.viewer.set_3d_pane_size();
    this.target = [0, 0, 0];
    this.span = 1;
    this.corners = [];
    this.yaw = 0;
  }

  get THREE() {
    return MeshCat.THREE;
  }

  /** Quiet background, no grid, a sun that goes with the rover and casts shadows. */
  setting() {
    const { viewer, THREE } = this;
    viewer.set_property(["Background"], "top_color", [0.80, 0.87, 0.94]);
    viewer.set_property(["Background"], "bottom_color", [0.97, 0.98, 0.99]);
    for (const name of ["Grid", "Axes"]) viewer.set_property([name], "visible", false);
    for (const name of ["PointLightNegativeX", "PointLightPositiveX", "FillLight", "SpotLight"]) {
      viewer.set_property(["Lights", name], "visible", false);
    }
    viewer.scene_tree.find(["Lights", "AmbientLight", "<object>"]).object.intensity = 0.0;
    this.sky = new THREE.HemisphereLight(0xffffff, 0xc4b9ab, 0.68);
    this.sky.position.set(0, 0, 1);
    this.sun = new THREE.DirectionalLight(0xfff6e8, 0.42);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0006;
    this.sun.shadow.radius = 3;
    viewer.scene.add(this.sky, this.sun, this.sun.target);
  }

  /** Replay recorded commands. */
  replay(commands) {
    for (const command of commands) this.viewer.handle_command_bytearray(command);
  }

  /** Nodes under a path that cast no shadow and are drawn last (marks). */
  shadowless(paths) {
    for (const path of paths) {
      this.node(path).object.traverse((thing) => {
        thing.castShadow = false;
        thing.receiveShadow = false;
        thing.renderOrder = 10;
      });
    }
  }

  /** Let things be looked through, or not. */
  seeThrough(thing, on) {
    thing.traverse(({ material }) => {
      if (!material?.color) return;
      material.userData.plain ??= { transparent: material.transparent, opacity: material.opacity, depthWrite: material.depthWrite };
      Object.assign(material, on ? { transparent: true, opacity: 0.25, depthWrite: false } : material.userData.plain);
      material.needsUpdate = true;
    });
    this.viewer.set_dirty();
  }

  /** Middle (world) of what is drawn under some objects, and the corners of its box in the camera's axes. */
  extent(things) {
    const { THREE } = this;
    const box = new THREE.Box3();
    const turn = this.viewer.scene.matrixWorld.clone().invert();
    for (const thing of things) {
      thing.updateWorldMatrix(true, true);
      box.expandByObject(thing);
    }
    const { min, max } = box;
    const corners = [min, max].flatMap((a) => [min, max].flatMap((b) => [min, max].map((c) => new THREE.Vector3(a.x, b.y, c.z))));
    return { middle: box.getCenter(new THREE.Vector3()).applyMatrix4(turn).toArray(), corners };
  }

  node(path) {
    return this.viewer.scene_tree.find(["meshcat", ...path.split("/")]);
  }

  /** Take the sun along, and the camera by the same way, so that the view stays as it was turned. */
  follow(target, yaw, span) {
    const { viewer } = this;
    const to = cameraAxes(target);
    const from = viewer.controls.target.toArray();
    const step = new this.THREE.Vector3(...to.map((value, i) => value - from[i]));
    viewer.camera.position.add(step);
    viewer.controls.target.add(step);
    this.light(target, yaw, span);
  }

  /** Take the sun along; the camera stays. */
  light(target, yaw, span) {
    Object.assign(this, { target, yaw, span });
    this.shine();
    const box = this.sun.shadow.camera;
    Object.assign(box, { left: -1.6 * span, right: 1.6 * span, top: 1.6 * span, bottom: -1.6 * span });
    Object.assign(box, { near: 0.5 * span, far: 9 * span });
    box.updateProjectionMatrix();
    this.viewer.set_dirty();
  }

  /** Put the sun high over the looker's left shoulder, so that what is seen is lit. */
  shine() {
    const { camera, controls } = this.viewer;
    const away = camera.position.clone().sub(controls.target);
    const turn = Math.atan2(-away.z, away.x) - 0.9;
    const [x, y, z] = this.target;
    this.sun.position.set(x + 2.2 * this.span * Math.cos(turn), y + 2.2 * this.span * Math.sin(turn), z + 4 * this.span);
    this.sun.target.position.set(x, y, z);
  }

  /** How far away along a unit vector (camera's axes) the camera sees all corners. */
  clear(away) {
    const { camera } = this.viewer;
    const { THREE } = this;
    const target = new THREE.Vector3(...cameraAxes(this.target));
    const right = new THREE.Vector3(0, 1, 0).cross(away).normalize();
    const up = away.clone().cross(right);
    const slope = Math.tan((camera.fov * Math.PI) / 360);
    const needs = this.corners.map((corner) => {
      const to = corner.clone().sub(target);
      const high = Math.abs(to.dot(up)) / FILLS.height;
      const wide = Math.abs(to.dot(right)) / (FILLS.width * camera.aspect);
      return to.dot(away) + Math.max(high, wide) / slope;
    });
    return Math.max(0, ...needs);
  }

  /** Look from one of the named sides, in the rover's heading; `distance` in spans, and never so near that one of
   * `corners` is cut; `aside` moves the picture by parts of the width. */
  look(name, distance = 2.5, aside = 0) {
    const [x, y, z] = VIEWS[name];
    const turned = this.yaw + (name === "Iso" ? 2.75 : 0);
    const [c, s] = [Math.cos(turned), Math.sin(turned)];
    const { camera, controls } = this.viewer;
    const away = new this.THREE.Vector3(...cameraAxes([c * x - s * y, s * x + c * y, z])).normalize();
    away.multiplyScalar(Math.max(distance * this.span, this.clear(away)));
    const target = new this.THREE.Vector3(...cameraAxes(this.target));
    controls.target.copy(target);
    camera.position.copy(target).add(away);
    const floor = this.groundAt?.(camera.position.x, -camera.position.z) ?? -Infinity;
    camera.position.y = Math.max(camera.position.y, floor + 0.4 * this.span);
    if (aside) camera.setViewOffset(1000, 1000 / camera.aspect, 1000 * aside, 0, 1000, 1000 / camera.aspect);
    controls.update();
    this.shine();
    this.viewer.set_dirty();
  }

  /** World point to pixels of the pane; null behind the camera. Meshcat turns its whole scene to y up. */
  project(point) {
    const { camera, renderer } = this.viewer;
    camera.updateWorldMatrix(true, false);
    camera.matrixWorldInverse.copy(camera.matrixWorld).invert();
    const v = new this.THREE.Vector3(...cameraAxes(point)).project(camera);
    if (v.z > 1) return null;
    const { clientWidth: w, clientHeight: h } = renderer.domElement;
    return [((v.x + 1) / 2) * w, ((1 - v.y) / 2) * h];
  }

  /** A switch beside the view buttons; `change(on)` now and when it is used. */
  toggle(holder, text, on, change) {
    const box = document.createElement("input");
    box.type = "checkbox";
    box.checked = on;
    box.addEventListener("change", () => change(box.checked));
    const label = document.createElement("label");
    label.className = "switch";
    label.append(box, ` ${text}`);
    holder.append(label);
    change(on);
    return box;
  }

  /** The row of view buttons. */
  buttons(holder, again) {
    for (const name of Object.keys(VIEWS)) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = name;
      button.title = `Look from: ${name.toLowerCase()}`;
      button.addEventListener("click", () => again(name));
      holder.append(button);
    }
  }
}

/** Say in the pane why there is no picture. */
export function explain(pane, error) {
  const box = document.createElement("div");
  box.className = "message";
  box.textContent =
    error.message === "no WebGL"
      ? "No 3D here: this browser has WebGL switched off. Everything else on the page works."
      : `No 3D here: ${error.message}`;
  pane.replaceChildren(box);
}
