/* The chosen case in words: margins with their place in the study, loads, pose. */
import { byId, element, fixed, inUnit, number } from "./format.js";
import { loadBars } from "./bars.js";

/** What limits a case by a measure: an edge, wheel, joint or link; empty where it does not say. */
export function limitingOf(cases, name, i) {
  const word = cases.has(`${name}_limiting`) ? cases.at(`${name}_limiting`, i) : "";
  return word === "None" ? "" : word;
}

function said(state, i) {
  const { cases, measure } = state;
  const status = cases.at("status", i);
  const parts = [cases.header.status_words[status] ?? status];
  const why = cases.has("reason") ? cases.at("reason", i) : "";
  if (why && why !== "None") parts.push(why);
  const limit = limitingOf(cases, measure.name, i);
  if (limit && cases.settled(i)) parts.push(`${measure.title.toLowerCase()} limited by ${limit}`);
  if (!state.selection.mask[i]) parts.push("left out by the filter");
  return parts.join(" · ");
}

/** Fill the case's card. */
export function showDetails(state, lightest) {
  const { cases, chosen } = state;
  byId("case-name").textContent = `Case ${chosen}`;
  byId("case-said").textContent = said(state, chosen);
  byId("case-margins").replaceChildren(
    ...cases.measures.map((m) => {
      const value = cases.at(m.name, chosen);
      const place = Number.isFinite(value) ? `p${Math.round(cases.percentile(m.name, value))}` : "";
      const row = element("tr", "", null, element("td", "", m.title), element("td", "value", inUnit(m, value)), element("td", "unit", `${m.unit} ${place}`));
      row.title = `better: ${m.better}`;
      return row;
    }),
  );
  const loads = cases.header.wheels.map((name) => ({ name, value: cases.at(`load_n/${name}`, chosen) }));
  loadBars(byId("case-loads"), loads, lightest);
  const angle = 180 / Math.PI;
  const rows = [];
  for (const name of ["x", "y", "z"]) rows.push([name, fixed(cases.at(`${name}_m`, chosen), 3), "m"]);
  for (const name of ["roll", "pitch", "yaw"]) rows.push([name, fixed(cases.at(`${name}_rad`, chosen) * angle, 1), "°"]);
  for (const name of cases.header.varied) {
    const value = cases.at(name, chosen);
    rows.push([name.replace(/_/g, " "), typeof value === "string" ? value : number(value), ""]);
  }
  const slides = new Map(state.robots[0].nodes.map((node) => [node.name, node.slides]));
  const held = cases.header.joints.filter((name) => cases.constant(`joint_rad/${name}`));
  for (const name of cases.header.joints) {
    const value = cases.at(`joint_rad/${name}`, chosen);
    if (held.includes(name)) continue;
    rows.push(slides.get(name) ? [name, fixed(1000 * value, 1), "mm"] : [name, fixed(angle * value, 1), "°"]);
  }
  if (held.length) rows.push([`${held.length} held joint${held.length > 1 ? "s" : ""}`, "", ""]);
  byId("case-pose").replaceChildren(
    ...rows.map(([name, value, unit]) => element("tr", "", null, element("td", "", name), element("td", "value", value), element("td", "unit", unit))),
  );
}
