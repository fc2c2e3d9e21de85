/* The table of cases: the worst ten of the shown measure until asked for more; any column sorts it. */
import { element, fixed, number } from "./format.js";

const MORE = 190;

/** What the table shows, in order. */
export function tableColumns(cases) {
  const angle = 180 / Math.PI;
  const place = [
    { name: "x_m", title: "x", unit: "m", show: (v) => fixed(v, 2) },
    { name: "y_m", title: "y", unit: "m", show: (v) => fixed(v, 2) },
    { name: "yaw_rad", title: "Yaw", unit: "°", show: (v) => fixed(v * angle, 0) },
  ];
  const asked = cases.header.varied.map((name) => ({ name, title: titled(name), unit: "", show: shown }));
  const measures = cases.measures.map((m) => ({ ...m, show: (v) => number(v * m.factor) }));
  return [{ name: "case", title: "Case", unit: "", show: String }, ...place, { name: "status", title: "Status", unit: "", show: shown }, ...asked, ...measures];
}

function titled(name) {
  const words = name.replace(/_/g, " ");
  return words[0].toUpperCase() + words.slice(1);
}

function shown(value) {
  return typeof value === "string" ? value.replace(/_/g, " ") : number(value, 4);
}

export class Table {
  constructor(holder, state) {
    Object.assign(this, { holder, state, count: 10, sort: null, status: null });
    this.columns = tableColumns(state.cases);
    holder.addEventListener("click", (event) => {
      const row = event.target.closest("tr[data-case]");
      if (row) state.choose(Number(row.dataset.case));
    });
  }

  /** Case numbers in the table's order. */
  order() {
    const { cases, measure } = this.state;
    const name = this.sort?.name ?? measure.name;
    let order;
    if (cases.measure.has(name)) order = Array.from(cases.order(name));
    else order = Array.from({ length: cases.count }, (_, i) => i).sort((a, b) => this.compare(name, a, b));
    if (this.sort?.reversed) order.reverse();
    if (this.status !== null) order = order.filter((i) => cases.at("status", i) === this.status);
    return order;
  }

  compare(name, a, b) {
    if (name === "case") return a - b;
    const [x, y] = [this.state.cases.column(name)[a], this.state.cases.column(name)[b]];
    return x - y || a - b;
  }

  draw() {
    const { cases, chosen, measure } = this.state;
    const order = this.order();
    const sorted = this.sort?.name ?? measure.name;
    const head = element("tr");
    for (const column of this.columns) {
      const arrow = column.name === sorted ? (this.sort?.reversed ? " ▼" : " ▲") : "";
      const button = element("button", "name", column.title + arrow);
      button.type = "button";
      button.addEventListener("click", () => this.sortBy(column.name));
      const cell = element("th", "", null, button, element("small", "", column.unit));
      if (arrow) cell.setAttribute("aria-sort", this.sort?.reversed ? "descending" : "ascending");
      head.append(cell);
    }
    const rows = order.slice(0, this.count).map((i) => {
      const row = element("tr", i === chosen ? "chosen" : "");
      row.dataset.case = i;
      for (const column of this.columns) {
        const value = column.name === "case" ? i : cases.at(column.name, i);
        row.append(element("td", typeof value === "string" ? "word" : "", column.show(value)));
      }
      return row;
    });
    const table = element("table", "", null, element("thead", "", null, head), element("tbody", "", null, ...rows));
    this.holder.replaceChildren(table);
    if (order.length > this.count) {
      const more = element("button", "more", `Show ${Math.min(MORE, order.length - this.count)} more of ${order.length}`);
      more.type = "button";
      more.addEventListener("click", () => {
        this.count += MORE;
        this.draw();
      });
      this.holder.append(more);
    }
  }

  sortBy(name) {
    const same = (this.sort?.name ?? this.state.measure.name) === name;
    this.sort = { name, reversed: same ? !this.sort?.reversed : false };
    this.draw();
  }

  /** Only cases of this status, or all. */
  only(status) {
    this.status = this.status === status ? null : status;
    this.count = 10;
    this.draw();
  }

  /** The cases of the table's filter, in its order, as CSV in SI units. */
  csv() {
    const { cases } = this.state;
    const names = ["case", ...Object.keys(cases.header.columns)];
    const lines = [names.join(",")];
    for (const i of this.order()) {
      lines.push(names.map((name) => quoted(name === "case" ? i : cases.at(name, i))).join(","));
    }
    return lines.join("\n") + "\n";
  }
}

function quoted(value) {
  const text = typeof value === "number" ? (Number.isNaN(value) ? "" : String(Number(value.toPrecision(7)))) : value;
  return /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}
