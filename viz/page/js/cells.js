/* Cells of the map: which cases lie in each, and the one value that each shows. */

/** Cells that just cover the cases: {wide, tall, nx, ny, x0, y0, starts, cases}; those of cell k are
 *  cases[starts[k]] to cases[starts[k + 1] - 1]. */
export function cellsOf(cases) {
  const [x, y] = [cases.column("x_m"), cases.column("y_m")];
  let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let i = 0; i < cases.count; i++) {
    [x0, x1] = [Math.min(x0, x[i]), Math.max(x1, x[i])];
    [y0, y1] = [Math.min(y0, y[i]), Math.max(y1, y[i])];
  }
  const area = Math.max((x1 - x0) * (y1 - y0), 1e-6);
  const wanted = Math.min(cases.count / 5, 4000);
  const size = Math.max(Math.sqrt(area / Math.max(wanted, 1)), Math.max(x1 - x0, y1 - y0) / 160, 1e-3);
  const nx = Math.max(1, Math.round((x1 - x0) / size));
  const ny = Math.max(1, Math.round((y1 - y0) / size));
  const [wide, tall] = [(x1 - x0) / nx || size, (y1 - y0) / ny || size];
  const cellOf = new Uint32Array(cases.count);
  const starts = new Uint32Array(nx * ny + 1);
  for (let i = 0; i < cases.count; i++) {
    const column = Math.min(nx - 1, Math.floor((x[i] - x0) / wide));
    cellOf[i] = Math.min(ny - 1, Math.floor((y[i] - y0) / tall)) * nx + column;
    starts[cellOf[i] + 1] += 1;
  }
  for (let k = 0; k < nx * ny; k++) starts[k + 1] += starts[k];
  const next = starts.slice();
  const sorted = new Uint32Array(cases.count);
  for (let i = 0; i < cases.count; i++) sorted[next[cellOf[i]]++] = i;
  return { wide, tall, nx, ny, x0, y0, starts, cases: sorted };
}

/** Per cell the value it shows (NaN: no answer), the case that has it (or one without an answer; -1: none
 *  is shown) and how many cases are shown. */
export function cellValues(cases, cells, measure, statistic, mask) {
  const column = cases.column(measure.name);
  const status = cases.column("status");
  const sign = measure.better === "low" ? -1 : 1;
  const count = cells.nx * cells.ny;
  const found = { values: new Float64Array(count).fill(NaN), picks: new Int32Array(count).fill(-1), shown: new Uint32Array(count) };
  for (let k = 0; k < count; k++) {
    const known = [];
    for (let at = cells.starts[k]; at < cells.starts[k + 1]; at++) {
      const i = cells.cases[at];
      if (mask !== null && !mask[i]) continue;
      if (!found.shown[k]++) found.picks[k] = i;
      if (status[i] === cases.settledWord && !Number.isNaN(column[i])) known.push(i);
    }
    if (!known.length) continue;
    found.picks[k] = placed(known, statistic, (i) => sign * column[i]);
    found.values[k] = column[found.picks[k]];
  }
  return found;
}

/* The case whose key is least, in the middle (the lower of two) or greatest. */
function placed(known, statistic, key) {
  if (statistic === "median") {
    known.sort((a, b) => key(a) - key(b) || a - b);
    return known[(known.length - 1) >> 1];
  }
  const best = statistic === "best";
  return known.reduce((a, b) => ((best ? key(b) > key(a) : key(b) < key(a)) ? b : a));
}
