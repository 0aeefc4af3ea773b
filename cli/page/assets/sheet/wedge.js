"use strict";
// Wedges, grids and drags: sliders for their axes that play like a flip book, and the grid that a card unfolds to.

/** One slider an axis, and a button that plays. `choose(place)`: asked for a frame of the item; may give a promise, which
    playing waits for. */
class AxisBar {
  constructor(data, item, choose) {
    Object.assign(this, { data, item, choose, axes: data.axes(item), place: 0, timer: 0, sliders: [] });
    this.play = page.button("Play", () => this.toggle(), { className: "play", title: "Play (space)" });
    const sliders = this.axes.map((axis, i) => this.slider(axis, i));
    this.element = page.element("div", { className: "axes" }, this.play, ...sliders);
  }

  slider({ label, texts }, i) {
    const input = page.element("input", { type: "range", min: 0, max: texts.length - 1, step: 1, value: 0, "aria-label": label });
    const text = page.element("output", { className: "value" });
    input.addEventListener("input", () => {
      this.stop();
      const [row, column] = this.sliders.map((slider) => Number(slider.input.value));
      this.go(column === undefined ? row : row * this.axes[1].texts.length + column);
    });
    this.sliders[i] = { input, text, texts };
    return page.element("label", {}, page.element("span", { className: "axis" }, label), input, text);
  }

  /** Shows a place that is chosen otherwise. */
  show(place) {
    this.place = place;
    const columns = this.axes[1]?.texts.length ?? 1, places = this.axes.length === 2 ? [Math.floor(place / columns), place % columns] : [place];
    for (const [i, { input, text, texts }] of this.sliders.entries()) {
      input.value = places[i];
      input.setAttribute("aria-valuetext", texts[places[i]]);
      text.textContent = texts[places[i]];
    }
  }

  go(place) {
    this.show(place);
    return this.choose(place);
  }

  isPlaying() {
    return this.timer !== 0;
  }

  toggle() {
    if (this.isPlaying()) {
      this.stop();
      return;
    }
    this.play.textContent = "Pause";
    const turn = async () => {
      const { timer } = this;
      await this.go((this.place + 1) % this.item.frames.length);
      if (this.timer === timer) this.timer = setTimeout(turn, AxisBar.wait);
    };
    this.timer = setTimeout(turn, AxisBar.wait);
  }

  stop() {
    clearTimeout(this.timer);
    this.timer = 0;
    this.play.textContent = "Play";
  }
}
AxisBar.wait = 220;  // milliseconds of a frame, at the least

/** What a card unfolds to: all frames at one size, with the values on the axes, or one large with sliders. */
class Unfolded {
  constructor(data, reviews, item, { open, fold }) {
    Object.assign(this, { data, reviews, item, open, cells: new Map() });
    const step = data.steps[item.entry];
    this.book = this.flipBook();
    this.grid = data.axes(item).length === 2 ? this.table() : this.row();
    this.switch = page.button("Flip book", () => this.toggleBook(), { "aria-pressed": "false", className: "flip" });
    this.element = page.element("li", { className: "unfolded", "data-item": item.number },
      page.element("div", { className: "unfolded-head" }, page.element("h2", {}, data.name(item.entry)),
        page.element("span", { className: "soft" }, data.summary(item)), this.switch, page.button("Fold", fold)),
      this.grid, this.book);
    this.book.hidden = true;
  }

  cell(entry, text) {
    const marks = page.element("span", { className: "marks" });
    const button = page.button("", () => this.open(entry), { className: "cell open", "data-entry": entry });
    button.append(page.element("span", { className: "frames" }, this.data.image(entry), marks), page.element("span", { className: "value" }, text));
    if (this.data.steps[entry].pixels_changed === 0) button.append(page.element("span", { className: "soft" }, "no pixel changes"));
    this.cells.set(entry, { button, marks });
    this.showMarks(entry);
    return button;
  }

  row() {
    const [{ label, texts }] = this.data.axes(this.item);
    return page.element("div", { className: "wedge-row" }, page.element("p", { className: "axis" }, label),
      page.element("div", { className: "cells" }, ...this.item.frames.map((entry, i) => this.cell(entry, texts[i]))));
  }

  /** The first axis has rows, the second columns. */
  table() {
    const [rows, columns] = this.data.axes(this.item), { frames } = this.item;
    const head = page.element("tr", {}, page.element("th", { className: "corner" }, page.element("span", {}, `${columns.label} →`), page.element("span", {}, `${rows.label} ↓`)),
      ...columns.texts.map((text) => page.element("th", { scope: "col" }, text)));
    const body = rows.texts.map((text, row) => page.element("tr", {}, page.element("th", { scope: "row" }, text),
      ...columns.texts.map((other, column) => page.element("td", {}, this.cell(frames[row * columns.texts.length + column], "")))));
    return page.element("div", { className: "wedge-grid" }, page.element("table", {}, page.element("thead", {}, head), page.element("tbody", {}, ...body)));
  }

  flipBook() {
    const picture = page.element("img", { className: "page" });
    this.bar = new AxisBar(this.data, this.item, (place) => {
      const entry = this.item.frames[place];
      picture.alt = `Frame ${this.data.title(entry)}`;
      picture.dataset.entry = entry;
      picture.src = this.data.steps[entry].preview;
      return picture.decode().catch(() => { picture.src = this.data.picture(entry); });
    });
    this.bar.element.append(page.button("Open this frame", () => this.open(this.item.frames[this.bar.place])));
    return page.element("div", { className: "flip-book" }, this.bar.element, picture);
  }

  toggleBook() {
    const isBook = this.book.hidden;
    this.book.hidden = !isBook;
    this.grid.hidden = isBook;
    this.switch.setAttribute("aria-pressed", String(isBook));
    if (isBook) {
      this.bar.go(this.bar.place);
      this.bar.toggle();
      this.element.scrollIntoView({ block: "nearest" });
    } else {
      this.bar.stop();
    }
  }

  showMarks(entry) {
    const cell = this.cells.get(entry), marks = this.reviews.of(entry);
    if (!cell) return;
    cell.marks.textContent = [reviewText(marks), marks.note ? "✎" : null].filter((text) => text).join(" ");
    cell.button.classList.toggle("rejected", marks.verdict === "rejected");
  }

  stop() {
    this.bar.stop();
  }
}
