/* One plot against time: its range, its ground, its lines. */
import { decimalsFor, fixed, nice, ticks } from "./format.js";

export const [GUTTER, EDGE, TOP] = [46, 12, 3];
export const CUT = 2; // times the limit

/** Ground of a panel: round values, changes of action, the limit. */
export function drawField(context, { low, high, y, height, width, limit, x, changes }) {
  const [left, right] = [GUTTER, width - EDGE];
  context.font = "11px system-ui, sans-serif";
  context.textAlign = "right";
  let count = Math.max(3, Math.min(5, height / 26));
  if (ticks(low, high, count).length < 2) count *= 2;
  const marks = ticks(low, high, count);
  const places = decimalsFor(nice((high - low) / count));
  for (const value of marks) {
    context.fillStyle = "#e7ebef";
    context.fillRect(left, Math.round(y(value)), right - left, 1);
    context.fillStyle = "#5d6873";
    context.fillText(fixed(value, places), left - 6, Math.min(height - 2, Math.max(9, y(value) + 4)));
  }
  if (limit !== null && limit >= low && limit <= high) {
    context.fillStyle = "rgba(217, 95, 2, .09)";
    context.fillRect(left, 0, right - left, y(limit));
    context.fillStyle = "#d95f02";
    context.fillRect(left, y(limit) - 0.75, right - left, 1.5);
  }
  context.fillStyle = "rgba(29, 36, 44, .13)";
  for (const from of changes) context.fillRect(x(from) - 0.5, 0, 1, height);
  context.fillStyle = "#9aa6b2";
  context.fillRect(left, 0, 1, height);
}

/** One line; it breaks at NaN, and a value alone is a dot. */
export function drawLine(context, { times, values }, x, y, colour, dash) {
  context.strokeStyle = colour;
  context.fillStyle = colour;
  context.lineWidth = 1.6;
  context.lineJoin = "round";
  context.setLineDash(dash);
  context.beginPath();
  values.forEach((value, k) => {
    if (Number.isNaN(value)) return;
    const [px, py] = [x(times[k]), y(value)];
    const begins = k === 0 || Number.isNaN(values[k - 1]);
    if (begins) context.moveTo(px, py);
    else context.lineTo(px, py);
    if (begins && (k + 1 === values.length || Number.isNaN(values[k + 1]))) context.fillRect(px - 2, py - 2, 4, 4);
  });
  context.stroke();
  context.setLineDash([]);
}

/** Values that a panel shows: from 0 where they do not go below, a little room above, cut where a limit would drown. */
export function rangeOf(lines, limit) {
  let [low, high] = [Infinity, -Infinity];
  for (const { values } of lines) {
    for (const value of values) {
      if (!Number.isFinite(value)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (!(high >= low)) return { low: 0, high: 1, cut: 0 };
  if (limit !== null) {
    const top = Math.max(1.12 * limit, 1.04 * high);
    return { low: 0, high: Math.min(top, CUT * limit), cut: top > CUT * limit ? high : 0 };
  }
  const least = Math.max(0.02 * Math.max(Math.abs(low), Math.abs(high)), 1);
  if (low >= 0 && low < 0.6 * high) return { low: 0, high: Math.max(1.06 * high, least), cut: 0 };
  const room = Math.max(0.08 * (high - low), least / 2);
  return { low: low - room, high: high + room, cut: 0 };
}
