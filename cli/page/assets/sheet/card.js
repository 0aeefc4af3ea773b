"use strict";
// A card of the contact sheet: the picture of a step, or of a wedge with its values. What others do with it, pinning and
// marking, appears when it is pointed at or focused, so that a long sheet stays light.

class Card {
  /** `does`: {open(entry), unfold(item), pin(entry)}. */
  constructor(data, reviews, item, does) {
    Object.assign(this, { data, reviews, item, does, controls: null });
    const { entry } = item, step = data.steps[entry];
    this.picture = data.image(item.is === "step" ? entry : item.frames[item.frames.length >> 1]);
    this.marks = page.element("span", { className: "marks" });
    this.button = page.button("", () => (item.is === "step" ? does.open(entry) : does.unfold(item)),
      { className: "open", "data-entry": entry, title: step.note ?? "" });
    this.button.append(this.frames(), page.element("span", { className: "name" }, data.name(entry)), ...this.lines());
    this.bar = page.element("div", { className: "bar" }, page.element("span", { className: "hint", "aria-hidden": "true" }, "★★★★★"));
    this.element = page.element("li", { className: `card ${item.is}${data.isUnchanged(item) ? " unchanged" : ""}`, "data-item": item.number }, this.button, this.bar);
    if (item.is !== "step") this.button.setAttribute("aria-expanded", "false");
    for (const kind of ["pointerenter", "focusin"]) this.element.addEventListener(kind, () => this.showControls());
    this.showMarks();
  }

  /** The picture; of several a stack with their number. */
  frames() {
    const { item } = this, parts = [this.picture];
    if (item.is !== "step") {
      const axes = this.data.axes(item), size = axes.length === 2 ? axes.map(({ texts }) => texts.length).join(" × ") : item.frames.length;
      parts.push(page.element("span", { className: "badge" }, item.is === "drag" ? `${size} frames` : `${size} values`));
    }
    return page.element("span", { className: "frames" }, ...parts, this.marks);
  }

  lines() {
    const { data, item } = this, step = data.steps[item.entry], lines = [];
    const add = (className, text) => text && lines.push(page.element("span", { className }, text));
    add("words", data.summary(item));
    add("journal-words", step.note);
    lines.push(page.element("span", { className: "line engineering" }, page.element("span", { className: `chip ${step.class}` }, step.class),
      page.element("span", {}, `${page.count(step.pixels_changed)} px`), page.element("span", {}, page.seconds(step.seconds.total))));
    return lines;
  }

  /** The entry whose marks it shows: of a wedge those of its own entry. */
  showMarks() {
    const { reviews, item } = this, entries = new Set([item.entry, ...item.frames]), marks = reviews.of(item.entry);
    const texts = [reviewText(marks)];
    const within = item.is === "step" ? 0 : item.frames.filter((entry) => entry !== item.entry && reviews.of(entry) !== Reviews.none).length;
    if (within > 0) texts.push(`${within} marked within`);
    const isRejected = marks.verdict === "rejected";
    this.element.classList.toggle("approved", [...entries].some((entry) => reviews.of(entry).verdict === "approved"));
    this.element.classList.toggle("rejected", isRejected);
    this.marks.textContent = texts.filter((text) => text).join("  ");
    this.note?.remove();
    this.note = marks.note ? page.element("span", { className: "own-note" }, marks.note) : null;
    if (this.note) this.button.append(this.note);
    this.controls?.show();
  }

  showControls() {
    if (this.controls) return;
    this.controls = reviewControls(this.reviews, this.item.entry, true);
    this.pinButton = page.button("Pin A", () => this.does.pin(this.item.entry), { className: "pin", title: "Compare others with this (a)",
      "aria-label": `Pin ${this.data.name(this.item.entry)} as A` });
    this.bar.replaceChildren(this.pinButton, this.controls);
  }

  setPinned(isPinned) {
    this.element.classList.toggle("pinned", isPinned);
  }
}
