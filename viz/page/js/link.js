/* The page's address: `#case=123&measure=tip&cell=median&sort=-x_m&tip.range=0.2..0.5&status=tips`, SI units. */

/** What the address asks for. A case that is not in the study is told as `missing`. */
export function asked(cases) {
  const words = new URLSearchParams(location.hash.slice(1));
  const given = words.get("case");
  const chosen = given !== null && /^\d+$/.test(given) && Number(given) < cases.count ? Number(given) : null;
  const ranges = new Map();
  for (const { name } of cases.measures) {
    const ends = (words.get(`${name}.range`) ?? "").split("..").map((end, k) => (end === "" ? [-Infinity, Infinity][k] : Number(end)));
    if (words.has(`${name}.range`) && ends.length === 2 && ends[0] <= ends[1]) ranges.set(name, ends);
  }
  const sort = (words.get("sort") ?? "").replace(/^-/, "");
  const cell = words.get("cell");
  return {
    chosen,
    missing: given !== null && chosen === null ? given : null,
    measure: cases.measure.get(words.get("measure")) ?? null,
    statistic: ["worst", "median", "best"].includes(cell) ? cell : "worst",
    sort: sort === "case" || cases.has(sort) ? { name: sort, reversed: words.get("sort").startsWith("-") } : null,
    ranges,
    statuses: new Set((words.get("status") ?? "").split(",").filter((word) => cases.header.columns.status.words.includes(word))),
  };
}

/** Put what is shown into the address, without a step in the browser's history. */
export function remember({ chosen, measure, statistic, selection }, sort) {
  const words = [`case=${chosen}`, `measure=${measure.name}`];
  if (statistic !== "worst") words.push(`cell=${statistic}`);
  if (sort) words.push(`sort=${sort.reversed ? "-" : ""}${encodeURIComponent(sort.name)}`);
  const end = (value) => (Number.isFinite(value) ? Number(value.toPrecision(8)) : "");
  for (const [name, [low, high]] of selection.ranges) words.push(`${name}.range=${end(low)}..${end(high)}`);
  if (selection.statuses.size) words.push(`status=${[...selection.statuses].map(encodeURIComponent).join(",")}`);
  history.replaceState(null, "", `#${words.join("&")}`);
}
