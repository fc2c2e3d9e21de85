/* A taut cable around circles of a plane: rover_pin/mechanism/cable.py, which says how, once more. */

/** Places [[u, v]], signed radii: {length, following, spans: [[u, v, length]], turns}; null where there is none. */
export function taut(places, rho) {
  const count = rho.length;
  const following = rho.map((_, i) => (i + 1) % count);
  const spans = rho.map(() => [0, 0, 0]);
  const turns = rho.map(() => 0);
  const cable = { places, rho, following, spans, turns };
  for (let round = 0; round < 6 * count + 6; round++) {
    const blocked = spanAll(cable);
    if (blocked >= 0) {
      if (!swallow(cable, blocked)) return null;
      continue;
    }
    const wrong = turnAll(cable);
    if (wrong >= 0) {
      leave(following, wrong);
      continue;
    }
    if (!rejoin(cable)) return { ...cable, length: lengthOf(cable) };
  }
  return null;
}

function spanAll({ places, rho, following, spans }) {
  for (let i = 0; i < rho.length; i++) {
    const j = following[i];
    if (j < 0) continue;
    const [dx, dy] = [places[j][0] - places[i][0], places[j][1] - places[i][1]];
    const off = rho[j] - rho[i];
    const apart = dx * dx + dy * dy;
    const square = apart - off * off;
    if (!(square > 0)) return i;
    const s = Math.sqrt(square);
    spans[i] = [(s * dx + off * dy) / apart, (s * dy - off * dx) / apart, s];
  }
  return -1;
}

function swallow({ rho, following }, i) {
  const j = following[i];
  if (rho[i] * rho[j] < 0 || j === i) return false;
  if (following.filter((k) => k >= 0).length <= 2) return false;
  leave(following, Math.abs(rho[i]) < Math.abs(rho[j]) ? i : j);
  return true;
}

function leave(following, i) {
  for (let j = 0; j < following.length; j++) if (following[j] === i) following[j] = following[i];
  following[i] = -1;
}

function turnAll({ rho, following, spans, turns }) {
  const on = rho.map((_, i) => i).filter((i) => following[i] >= 0);
  turns.fill(0);
  let total = 0;
  for (const i of on) {
    const [a, b] = [spans[i], spans[following[i]]];
    turns[following[i]] = Math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    total += turns[following[i]];
  }
  const inner = on.filter((i) => rho[i] > 0);
  while (total < Math.PI && inner.length) {
    const least = inner.reduce((best, i) => (turns[i] < turns[best] ? i : best), inner[0]);
    turns[least] += 2 * Math.PI;
    total += 2 * Math.PI;
  }
  let [wrong, worst] = [-1, 0];
  for (const i of on.length > 2 ? on : []) {
    const against = rho[i] >= 0 ? turns[i] : -turns[i];
    if (against < worst) [wrong, worst] = [i, against];
  }
  return wrong;
}

function rejoin({ places, rho, following, spans }) {
  const count = rho.length;
  let [deepest, before, worst] = [-1, -1, 1e-12];
  for (let i = 0; i < count; i++) {
    if (following[i] >= 0) continue;
    let a = (i + count - 1) % count;
    while (following[a] < 0) a = (a + count - 1) % count;
    const [dx, dy] = [places[i][0] - places[a][0], places[i][1] - places[a][1]];
    const along = spans[a][0] * dx + spans[a][1] * dy;
    if (!(along > 0 && along < spans[a][2])) continue;
    const over = spans[a][0] * dy - spans[a][1] * dx + rho[a] - rho[i];
    const deep = rho[i] >= 0 ? -over : over;
    if (deep > worst) [deepest, before, worst] = [i, a, deep];
  }
  if (deepest < 0) return false;
  following[deepest] = following[before];
  following[before] = deepest;
  return true;
}

function lengthOf({ rho, following, spans, turns }) {
  return rho.reduce((sum, r, i) => (following[i] < 0 ? sum : sum + spans[i][2] + r * turns[i]), 0);
}

/** The way as a closed polygon [[u, v, nu, nv]] with its outward directions, in pieces of `step` at most. */
export function wayOf({ places, rho, following, spans, turns }, step) {
  const start = following.findIndex((j) => j >= 0);
  const points = [];
  let i = start;
  do {
    const j = following[i];
    const out = Math.atan2(spans[j][1], spans[j][0]);
    const last = points[points.length - 1];
    const arc = 2 + Math.ceil((Math.abs(turns[j]) * Math.max(Math.abs(rho[j]) / step, 24 / Math.PI)));
    for (let k = 0; k < arc; k++) {
      const angle = out - turns[j] * (1 - k / (arc - 1));
      const right = [Math.sin(angle), -Math.cos(angle)];
      const point = [places[j][0] + rho[j] * right[0], places[j][1] + rho[j] * right[1], ...right];
      if (k === 0 && last) straight(points, last, point, step);
      points.push(point);
    }
    i = j;
  } while (i !== start);
  straight(points, points[points.length - 1], points[0], step);
  points.push(points[0]);
  return points;
}

function straight(points, from, to, step) {
  const pieces = Math.ceil(Math.hypot(to[0] - from[0], to[1] - from[1]) / step);
  for (let k = 1; k < pieces; k++) points.push(from.map((value, n) => value + ((to[n] - value) * k) / pieces));
}
