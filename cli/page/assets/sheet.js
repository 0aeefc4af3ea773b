"use strict";
// The contact sheet: a card for each frame. Those of long runs are made a few hundred at a time, so that the page is
// there at once; whoever asks for one gets it.

class Sheet {
  /** `open(entry)` is called for the card that is clicked. */
  constructor({ report, steps, labels, pictures, layout, open }) {
    Object.assign(this, { report, steps, labels, pictures, layout, open });
    this.list = page.byId("sheet-list");
    this.cards = [];
    this.marked = 0;
    this.texts = steps.map((step, entry) => `${labels[entry]} ${step.name}`.toLowerCase());
    const classes = page.byId("class-filter");
    classes.append(page.element("option", { value: "" }, "all"));
    for (const name of new Set(steps.map((step) => step.class))) classes.append(page.element("option", { value: name }, name));
    classes.addEventListener("change", () => this.filter());
    page.byId("name-filter").addEventListener("input", () => this.filter());
    this.filter();
    this.makeSome(Sheet.first);
  }

  /** Those that the filters leave, by number. */
  matches() {
    const name = page.byId("name-filter").value.trim().toLowerCase(), wanted = page.byId("class-filter").value;
    return this.steps.map((step, entry) => entry)
      .filter((entry) => (wanted === "" || this.steps[entry].class === wanted) && this.texts[entry].includes(name));
  }

  filter() {
    this.shown = this.matches();
    this.isShown = new Uint8Array(this.steps.length);
    for (const entry of this.shown) this.isShown[entry] = 1;
    this.cards.forEach((card, entry) => { card.hidden = !this.isShown[entry]; });
    const left = this.report.entries - this.steps.length;
    page.byId("sheet-count").textContent = `${this.shown.length} of ${this.steps.length} frames; `
      + `${page.seconds(this.report.seconds)} altogether${left > 0 ? `; ${page.count(left)} more are only in report.json` : ""}`;
  }

  /** Makes cards up to an entry, and the next ones soon. */
  makeSome(end) {
    const cards = [];
    for (let entry = this.cards.length; entry < Math.min(end, this.steps.length); ++entry) {
      cards.push(this.card(entry));
      this.cards.push(cards[cards.length - 1]);
    }
    this.list.append(...cards);
    clearTimeout(this.next);
    if (this.cards.length < this.steps.length)
      this.next = setTimeout(() => this.makeSome(this.cards.length + Sheet.more), 20);
  }

  card(entry) {
    const step = this.steps[entry], { width, height } = this.layout;
    const picture = page.element("img", { alt: "", loading: "lazy", decoding: "async", width, height,
      src: this.pictures[step.preview] ?? step.preview });
    const card = page.element("button", { className: "card", type: "button", hidden: !this.isShown[entry],
      "aria-current": String(entry === this.marked) }, picture,
    page.element("span", { className: "name" }, `${this.labels[entry]} ${step.name}`),
    page.element("span", { className: "line" }, page.element("span", { className: `chip ${step.class}` }, step.class),
      page.element("span", {}, page.seconds(step.seconds.total))),
    page.element("span", { className: "line" }, `${page.count(step.pixels_changed)} pixels changed`));
    card.addEventListener("click", () => this.open(entry));
    return card;
  }

  mark(entry) {
    if (this.cards.length <= entry) this.makeSome(entry + 1);
    this.cards[this.marked]?.setAttribute("aria-current", "false");
    this.marked = entry;
    this.cards[entry]?.setAttribute("aria-current", "true");
    this.keepInView(entry, Sheet.settlingFrames);
  }

  /** Cards that come into view for the first time get their real sizes, which moves those below. */
  keepInView(entry, frames) {
    if (entry !== this.marked) return;
    this.cards[entry]?.scrollIntoView({ block: "nearest" });
    if (frames > 0) requestAnimationFrame(() => this.keepInView(entry, frames - 1));
  }

  /** The entry some cards on, among those that the filters leave. */
  along(by) {
    if (this.shown.length === 0) return this.marked;
    let place = this.shown.findIndex((entry) => entry >= this.marked);
    if (place < 0) place = this.shown.length - 1;
    return this.shown[Math.min(this.shown.length - 1, Math.max(0, place + by))];
  }

  /** Cards in a row. */
  columns() {
    return getComputedStyle(this.list).gridTemplateColumns.split(" ").length;
  }
}
Sheet.first = 100;  // cards that the page opens with
Sheet.more = 250;
Sheet.settlingFrames = 12;
