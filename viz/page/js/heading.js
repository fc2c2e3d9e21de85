/* The page's head: what the study is, how its cases ended and how many of them pass the filter. */
import { byId, element, fixed } from "./format.js";

export class Heading {
  constructor(state) {
    this.state = state;
    const { header } = state.cases;
    const { about } = header;
    byId("title").textContent = header.title;
    this.apart = [];
    if (about.seed !== undefined) this.apart.push(`seed ${about.seed}`);
    if (about.gravity !== undefined) this.apart.push(`g ${about.gravity} m/s²`);
    if (about.created) this.apart.push(String(about.created).slice(0, 10));
    this.chips();
    byId("clear").addEventListener("click", () => state.clear());
    const head = document.querySelector("header"); // chips may take two lines; the rest of the window is the page's
    new ResizeObserver(() => document.documentElement.style.setProperty("--head", `${head.offsetHeight}px`)).observe(head);
  }

  chips() {
    const { cases, selection } = this.state;
    const { words } = cases.header.columns.status;
    this.totals = words.map(() => 0);
    for (const code of cases.column("status")) this.totals[code] += 1;
    const order = words.map((_, k) => k).sort((a, b) => this.totals[b] - this.totals[a]);
    this.words = new Map();
    byId("counts").replaceChildren(
      ...order.map((k) => {
        const count = element("b");
        const chip = element("button", "chip", null, count, ` ${cases.header.status_words[words[k]] ?? words[k]}`);
        chip.type = "button";
        chip.dataset.status = words[k];
        chip.title = "Show only these; several may be picked";
        chip.addEventListener("click", () => {
          selection.toggle(words[k]);
          this.state.refilter(true);
        });
        this.words.set(k, { chip, count });
        return chip;
      }),
    );
  }

  /** Say what passes. */
  draw() {
    const { cases, selection } = this.state;
    const all = fixed(cases.count, 0);
    const count = selection.active ? `${fixed(selection.count, 0)} of ${all} cases` : `${all} cases`;
    byId("subtitle").textContent = [count, ...this.apart].join(" · ");
    for (const [k, { chip, count: box }] of this.words) {
      const here = selection.byStatus[k];
      box.textContent = here === this.totals[k] ? fixed(here, 0) : `${fixed(here, 0)} of ${fixed(this.totals[k], 0)}`;
      const on = selection.statuses.has(chip.dataset.status);
      chip.classList.toggle("on", on);
      chip.setAttribute("aria-pressed", String(on));
    }
    byId("clear").hidden = !selection.active;
  }
}
