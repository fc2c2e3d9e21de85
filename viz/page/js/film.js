/* A film strip: several moments of a run beside each other, for a picture. */
import { byId, element, fixed } from "./format.js";

/** Fill the page with the moments `times`, seen from `view`. */
export function filmStrip(stage, frames, times, view) {
  document.body.classList.add("film");
  const columns = Math.ceil(Math.sqrt(times.length));
  const rows = Math.ceil(times.length / columns);
  const strip = byId("film");
  strip.hidden = false;
  strip.style.gridTemplateColumns = `repeat(${columns}, 1fr)`;
  strip.style.gridTemplateRows = `repeat(${rows}, minmax(0, 1fr))`;
  const cells = times.map((t) => cell(frames, t));
  strip.replaceChildren(...cells.map(({ box }) => box));
  if (stage.view) new ResizeObserver(() => shoot(stage, cells, times, view)).observe(strip);
}

function shoot(stage, cells, times, view) {
  const { clientWidth: width, clientHeight: height } = cells[0].box;
  Object.assign(byId("pane").style, { width: `${width}px`, height: `${height}px`, inset: "auto" });
  stage.view.viewer.set_3d_pane_size();
  const { domElement } = stage.view.viewer.renderer;
  cells.forEach(({ canvas, labels }, k) => {
    stage.draw(times[k], view ?? "Iso");
    stage.view.viewer.render();
    canvas.width = domElement.width;
    canvas.height = domElement.height;
    canvas.getContext("2d").drawImage(domElement, 0, 0);
    labels.replaceChildren(...[...byId("labels").children].map((label) => label.cloneNode(true)));
  });
}

function cell(frames, t) {
  const canvas = element("canvas");
  const labels = element("div", "labels");
  const lifted = frames.liftedAt(t);
  const words = [frames.action(t), lifted.length ? `${lifted.join(", ")} lifted` : ""];
  const caption = element("figcaption", "", null, element("b", "", `${fixed(frames.start + t, 1)} s`), ` ${words.filter(Boolean).join(" · ")}`);
  return { box: element("figure", "", null, canvas, labels, caption), canvas, labels };
}
