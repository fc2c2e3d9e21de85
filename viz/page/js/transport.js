/* Play, pause, step, speed: the moment that is shown, and the strip of what is done. */
import { sized } from "./canvas.js";
import { byId, element, fixed } from "./format.js";
import { placeOf } from "./frames.js";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, 100];
const TINTS = ["#cfe0f1", "#e9dcc3", "#cfe6da", "#e3d8ec", "#f4dccb", "#dde2e7", "#d6e7ec", "#ece5c8"];
const WATCH = 20; // s that a run should take on the screen

export class Transport {
  /** `tell(t)` is called at every new moment. */
  constructor(tell) {
    Object.assign(this, { tell, t: 0, playing: false });
    this.slider = byId("time");
    this.speed = byId("speed");
    this.strip = byId("strip");
    this.speed.replaceChildren(...SPEEDS.map((speed) => new Option(`${speed}×`, speed)));
    byId("play").addEventListener("click", () => this.toggle());
    byId("back").addEventListener("click", () => this.step(-1));
    byId("on").addEventListener("click", () => this.step(1));
    this.slider.addEventListener("input", () => this.seek(Number(this.slider.value)));
    this.strip.addEventListener("pointerdown", (event) => this.seek(this.pointed(event)));
    this.strip.addEventListener("pointermove", (event) => {
      const t = this.pointed(event);
      this.strip.title = this.frames.action(t);
      if (event.buttons) this.seek(t);
    });
    new ResizeObserver(() => this.draw()).observe(this.strip.parentElement);
  }

  show(frames) {
    this.pause();
    this.frames = frames;
    Object.assign(this.slider, { min: 0, max: frames.length, step: "any" });
    this.speed.value = SPEEDS.find((speed) => speed >= 1 && frames.length / speed <= WATCH) ?? SPEEDS[SPEEDS.length - 1];
    for (const id of ["play", "back", "on", "time"]) byId(id).disabled = !(frames.length > 0);
    this.draw();
  }

  seek(t) {
    this.t = Math.min(this.frames.length, Math.max(0, t));
    this.slider.value = this.t;
    this.tell(this.t);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (!(this.frames.length > 0)) return;
    if (this.t >= this.frames.length) this.t = 0;
    this.playing = true;
    this.button();
    let before = null;
    const tick = (now) => {
      if (!this.playing) return;
      const passed = before === null ? 0 : Math.min(0.1, (now - before) / 1000);
      before = now;
      this.seek(this.t + passed * Number(this.speed.value));
      if (this.t >= this.frames.length) this.pause();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  pause() {
    this.playing = false;
    this.button();
  }

  button() {
    byId("play").textContent = this.playing ? "❚❚" : "▶";
    byId("play").setAttribute("aria-label", this.playing ? "Pause" : "Play");
  }

  /** To the next frame or the one before. */
  step(by) {
    this.pause();
    const { times } = this.frames;
    let k = placeOf(times, this.t + 1e-9);
    if (by > 0 || Math.abs(times[k] - this.t) < 1e-9) k += by;
    this.seek(times[Math.min(times.length - 1, Math.max(0, k))]);
  }

  faster(by) {
    this.speed.selectedIndex = Math.min(SPEEDS.length - 1, Math.max(0, this.speed.selectedIndex + by));
  }

  pointed(event) {
    const box = this.strip.getBoundingClientRect();
    return Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)) * this.frames.length;
  }

  /** One coloured stretch an action, with its name where there is room. */
  draw() {
    const width = this.strip.parentElement.clientWidth;
    if (!this.frames || width < 60) return;
    const context = sized(this.strip, width, 20);
    const { actions, length } = this.frames;
    const words = [...new Set(actions.map((action) => action.word))];
    context.font = "11px system-ui, sans-serif";
    actions.forEach(({ word, from }, k) => {
      const [a, b] = [from, actions[k + 1]?.from ?? length].map((t) => (length ? (t / length) * width : 0));
      const wide = length ? b - a : width;
      context.fillStyle = TINTS[words.indexOf(word) % TINTS.length];
      context.fillRect(a, 0, Math.max(wide - 1, 1), 20);
      context.fillStyle = "#1d242c";
      const text = fitting(context, word, wide - 10);
      if (text) context.fillText(text, a + 5, 14);
    });
  }
}

function fitting(context, text, wide) {
  if (context.measureText(text).width <= wide) return text;
  for (let n = text.length - 1; n > 2; n--) {
    if (context.measureText(`${text.slice(0, n)}…`).width <= wide) return `${text.slice(0, n)}…`;
  }
  return "";
}

/** The words beside the picture: time, action, lifted wheels, pose. */
export function tellMoment(frames, t) {
  const places = frames.length < 20 ? 2 : 1;
  byId("clock").textContent = `${fixed(frames.start + t, places)} s`;
  byId("action").textContent = frames.action(t) || "–";
  const lifted = frames.liftedAt(t);
  byId("lifted").textContent = lifted.length ? `${lifted.join(", ")} lifted` : "no wheel lifted";
  byId("lifted").classList.toggle("bad", lifted.length > 0);
  const place = frames.place(t);
  const turn = 180 / Math.PI;
  const told = [["x", "x_m", 1, 3, "m"], ["y", "y_m", 1, 3, "m"], ["z", "z_m", 1, 3, "m"], ["roll", "roll_rad", turn, 1, "°"], ["pitch", "pitch_rad", turn, 1, "°"], ["yaw", "yaw_rad", turn, 1, "°"]];
  byId("pose").replaceChildren(
    ...told.map(([name, column, factor, digits, unit]) => element("span", "", `${name} `, element("b", "", `${fixed(factor * frames.at(column, place), digits)} ${unit}`))),
  );
}
