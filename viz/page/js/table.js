/* The table of cases, any column sorts it; only the rows in sight exist, so a million cost no more than ten. */
import { element, fixed, inUnit, number } from "./format.js";

const [ROW, TALLEST] = [25, 8e6]; // px: a row; what every browser lays out. A longer table scrolls by shares.
const WIDE = 82; // px: a column

/** What the table shows, in order. */
export function tableColumns(cases) {
  const angle = 180 / Math.PI;
  const place = [
    { name: "x_m", title: "x", unit: "m", wide: 56, show: (v) => fixed(v, 2) },
    { name: "y_m", title: "y", unit: "m", wide: 56, show: (v) => fixed(v, 2) },
    { name: "yaw_rad", title: "Yaw", unit: "°", wide: 46, show: (v) => fixed(v * angle, 0) },
  ];
  const asked = cases.header.varied.map((name) => ({ name, title: titled(name), unit: "", show: shown }));
  const measures = cases.measures.map((m) => ({ ...m, show: (v) => inUnit(m, v) }));
  return [{ name: "case", title: "Case", unit: "", wide: 68, show: String }, ...place, { name: "status", title: "Status", unit: "", wide: 84, show: shown }, ...asked, ...measures];
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
    Object.assign(this, { holder, state, sort: null, kept: null });
    this.columns = tableColumns(state.cases);
    this.table = element("table", "rows");
    this.table.style.minWidth = `${this.columns.reduce((sum, { wide }) => sum + (wide ?? WIDE), 0)}px`;
    this.spacer = element("div", "spacer", null, this.table);
    holder.replaceChildren(this.spacer);
    holder.addEventListener("scroll", () => this.rows());
    holder.addEventListener("click", (event) => {
      const row = event.target.closest("tr[data-case]");
      if (row) state.choose(Number(row.dataset.case));
    });
    new ResizeObserver(() => this.rows()).observe(holder);
  }

  /** Case numbers in the table's order: those of the selection. */
  order() {
    const { cases, measure, selection } = this.state;
    const name = this.sort?.name ?? measure.name;
    this.kept ??= selection.pick(cases.order(name), this.sort?.reversed);
    return this.kept;
  }

  /** Take in another selection, measure or order, from the top. */
  renew() {
    this.kept = null;
    this.holder.scrollTop = 0;
    this.head();
    this.rows();
  }

  head() {
    const sorted = this.sort?.name ?? this.state.measure.name;
    const head = element("tr");
    for (const column of this.columns) {
      const arrow = column.name === sorted ? (this.sort?.reversed ? " ▼" : " ▲") : "";
      const button = element("button", "name", column.title + arrow);
      button.type = "button";
      button.dataset.sort = column.name;
      button.title = column.better ? `Better: ${column.better}` : "Sort by it";
      button.addEventListener("click", () => this.sortBy(column.name));
      const cell = element("th", "", null, button, element("small", "", column.unit));
      cell.style.width = `${column.wide ?? WIDE}px`;
      if (arrow) cell.setAttribute("aria-sort", this.sort?.reversed ? "descending" : "ascending");
      head.append(cell);
    }
    this.table.replaceChildren(element("thead", "", null, head), element("tbody"));
  }

  /* How the rows lie: how many fit, and which is first when scrolled so far. */
  layout() {
    const count = this.order().length;
    const head = this.table.tHead?.offsetHeight ?? 0;
    const room = Math.max(ROW, this.holder.clientHeight - head);
    const fits = Math.floor(room / ROW);
    const tall = Math.min(count * ROW, TALLEST);
    const way = Math.max(1e-9, tall - room);
    return { count, head, fits, tall, perRow: Math.max(1e-9, way / Math.max(1, count - fits)) };
  }

  /** Draw the rows in sight. */
  rows() {
    if (!this.table.tBodies.length) return;
    const { cases, chosen } = this.state;
    const { count, head, fits, tall, perRow } = this.layout();
    this.spacer.style.height = `${head + tall}px`;
    const first = Math.max(0, Math.min(count - fits, Math.round(this.holder.scrollTop / perRow)));
    const rows = [...this.order().subarray(first, first + fits + 1)].map((i) => {
      const row = element("tr", i === chosen ? "chosen" : "");
      row.dataset.case = i;
      for (const column of this.columns) {
        const value = column.name === "case" ? i : cases.at(column.name, i);
        row.append(element("td", typeof value === "string" ? "word" : "", column.show(value)));
      }
      return row;
    });
    if (!count) rows.push(element("tr", "", null, element("td", "none", "No case passes the filter.")));
    this.table.tBodies[0].replaceChildren(...rows);
  }

  /** Bring the chosen case into sight, where the selection has it. */
  reveal() {
    const at = this.order().indexOf(this.state.chosen);
    const { fits, perRow } = this.layout();
    const first = Math.round(this.holder.scrollTop / perRow);
    if (at >= 0 && (at < first || at >= first + fits)) this.holder.scrollTop = Math.max(0, at - Math.floor(fits / 2)) * perRow;
    this.rows();
  }

  sortBy(name) {
    const same = (this.sort?.name ?? this.state.measure.name) === name;
    this.sort = { name, reversed: same ? !this.sort?.reversed : false };
    this.renew();
    this.state.remember();
  }
}
