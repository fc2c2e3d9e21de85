/* The colour bar under the map, with its unit and which end is worse. */
import { byId, decimalsFor, element, fixed, nice, ticks } from "./format.js";

/** Draw it for the shown measure. */
export function drawLegend({ measure, scale, ground, statistic }) {
  const better = measure.better === "low" ? "high is worse" : "low is worse";
  byId("legend-title").replaceChildren(
    element("b", "", `${measure.title} [${measure.unit}]`),
    element("span", "", `${statistic} of each cell's cases, ${better}`),
  );
  const bar = byId("legend-bar");
  const stops = Array.from({ length: 33 }, (_, k) => scale.colour(scale.low + (k / 32) * (scale.high - scale.low)));
  bar.style.background = `linear-gradient(to right, ${stops.join(",")})`;
  const [low, high] = [scale.low * measure.factor, scale.high * measure.factor];
  const places = decimalsFor(nice((high - low) / 4));
  byId("legend-ticks").replaceChildren(
    ...ticks(low, high, 4).map((value) => {
      const mark = element("span", "", fixed(value, places));
      mark.style.left = `${(100 * (value - low)) / (high - low)}%`;
      return mark;
    }),
  );
  byId("legend-more").replaceChildren(
    element("span", "", "× no answer"),
    element("span", "", ground.contour ? `— contours, ${fixed(ground.contour, decimalsFor(ground.contour))} m` : ""),
  );
}
