/* Small texts that stay with points of the scene and do not cover each other. */

export class Labels {
  constructor(view3d, holder) {
    this.view3d = view3d;
    this.holder = holder;
    this.items = [];
    view3d.listeners.push(() => this.place());
  }

  /** Show these: [{at: [x, y, z], text, light}]. */
  set(labels) {
    this.holder.replaceChildren();
    this.items = labels.map((label) => {
      const box = document.createElement("span");
      box.className = label.light ? "label light" : "label";
      box.textContent = label.text;
      this.holder.append(box);
      return { box, at: label.at };
    });
    this.place();
  }

  /** Each above its point; one that would cover another goes higher. */
  place() {
    const placed = [];
    const seen = this.items.map((item) => ({ ...item, spot: this.view3d.project(item.at) }));
    seen.sort((a, b) => (b.spot ? b.spot[1] : 0) - (a.spot ? a.spot[1] : 0));
    for (const { box, spot } of seen) {
      box.hidden = !spot;
      if (!spot) continue;
      const [w, h] = [box.offsetWidth, box.offsetHeight];
      const x = spot[0] - w / 2;
      let y = spot[1] - h - 4;
      for (const other of placed) {
        const beside = x + w + 3 < other.x || other.x + other.w + 3 < x;
        if (!beside && y + h + 2 > other.y && y < other.y + other.h + 2) y = other.y - h - 2;
      }
      placed.push({ x, y, w, h });
      box.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
    }
  }
}
