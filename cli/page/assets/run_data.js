"use strict";
// The entries of a run: steps from their rows; items of the contact sheet, of which a drag, a wedge or a grid is one;
// what each starts from, which makes the tree of options; words and texts to search.

/** The steps from their rows: {step: 3, seconds: {total: ...}, ...} as in report.json, as far as rows go. */
function stepsOf({ columns, rows }) {
  const places = columns.map((pointer) => pointer.split("/").slice(1));
  return rows.map(([stem, name, kind, marks, ...values]) => {
    const { frame: place = 0, ...others } = marks;
    const step = { ...others, place, name, class: kind, stem, frame: `frames/${stem}.exr`, preview: `previews/${stem}.png` };
    places.forEach(([key, inner], i) => {
      if (inner === undefined) step[key] = values[i];
      else (step[key] ??= {})[inner] = values[i];
    });
    step.label = place > 0 ? `${step.step}${stem.replace(/^[0-9]+/, "")}` : String(step.step);
    return step;
  });
}

class RunData {
  constructor(report, rows, pictures, layout) {
    Object.assign(this, { report, pictures, layout, steps: stepsOf(rows) });
    this.labels = this.steps.map((step) => step.label);
    this.items = this.itemsOf();
    this.itemOf = new Int32Array(this.steps.length);  // by entry
    this.items.forEach((item) => [...item.frames, item.entry].forEach((entry) => { this.itemOf[entry] = item.number; }));
    this.byStep = new Map(this.items.map((item) => [this.steps[item.entry].step, item]));
    this.grow();
    // The frames one after the other: the step of a wedge shows what its last frame does, and has no place of its own.
    this.order = this.items.flatMap((item) => item.frames);
    this.placeOf = new Int32Array(this.steps.length);
    this.items.forEach((item) => { this.placeOf[item.entry] = -1; });
    this.order.forEach((entry, place) => { this.placeOf[entry] = place; });
    for (const item of this.items)
      if (this.placeOf[item.entry] < 0) this.placeOf[item.entry] = this.placeOf[item.frames[item.frames.length - 1]];
    this.texts = new Map();  // to search, by item
  }

  itemsOf() {
    const items = [];
    let open = null;
    this.steps.forEach((step, entry) => {
      const isOfOpen = open !== null && this.steps[open.entry].step === step.step;
      if (isOfOpen) {
        open.entry = entry;
        if (step.place > 0) open.frames.push(entry);
        else open = null;
        return;
      }
      const item = { number: items.length, entry, frames: [entry], is: step.place > 0 ? step.is : "step" };
      items.push(item);
      open = step.place > 0 ? item : null;
    });
    return items;
  }

  /** Parents and children of items, by what they start from. */
  grow() {
    for (const item of this.items) Object.assign(item, { parent: null, children: [] });
    for (const item of this.items.slice(1)) {
      item.parent = this.items[this.itemOf[this.start(item.entry)]];
      if (item.parent.number >= item.number) item.parent = this.items[item.number - 1];
      item.parent.children.push(item);
    }
    this.hasTree = this.items.some((item) => item.number > 0 && item.parent.number !== item.number - 1);
  }

  /** The entry whose state the step of an entry starts from. */
  start(entry) {
    let { step, from } = this.steps[entry], item = null;
    do {
      if (step === 0) return 0;
      item = this.byStep.get(from ?? step - 1);
      if (!item || item.entry >= entry) return Math.max(0, entry - 1);
      ({ step, from } = this.steps[item.entry]);
    } while (this.steps[item.entry].keep === false);
    return item.entry;
  }

  name(entry) {
    const step = this.steps[entry];
    return `${this.labels[entry]} ${step.name}`;
  }

  /** Its number and name, and the values where a wedge has some. */
  title(entry) {
    const values = this.values(entry);
    return values.length > 0 ? `${this.name(entry)}: ${values.join(", ")}` : this.name(entry);
  }

  picture(entry) {
    return this.pictures[this.steps[entry].preview] ?? this.steps[entry].preview;
  }

  /** Its preview; in a page of one file as much as there is of it. */
  whole(entry) {
    return this.report.single ? this.picture(entry) : this.steps[entry].preview;
  }

  /** An image of an entry, with its name as text for those who do not see it. */
  image(entry, properties = {}) {
    const { width, height } = this.layout;
    return page.element("img", { alt: `Frame ${this.title(entry)}`, loading: "lazy", decoding: "async", width, height,
      src: this.picture(entry), ...properties });
  }

  /** The texts of a frame's values, by axis; of an old wedge from its edit. */
  values(entry) {
    const step = this.steps[entry];
    if (step.values) return step.values;
    const value = step.is === "wedge" && step.place > 0 ? step.edit?.[0]?.[2] : undefined;
    return value === undefined ? [] : [words.short(value)];
  }

  /** The axes of a wedge's item: {label, texts}; of a drag its frames by number; [] for a step. */
  axes(item) {
    if (item.is === "step") return [];
    const known = this.steps[item.entry].axes, values = item.frames.map((entry) => this.values(entry));
    if (item.is === "drag" || values.some((list) => list.length === 0))
      return [{ label: "frame", texts: item.frames.map((entry) => String(this.steps[entry].place)) }];
    const [rows, columns] = known ?? [];
    if (columns && rows.count * columns.count === item.frames.length) {
      return [{ label: words.axis(rows), texts: Array.from({ length: rows.count }, (_, i) => values[i * columns.count][0]) },
        { label: words.axis(columns), texts: values.slice(0, columns.count).map((list) => list[1] ?? "") }];
    }
    const path = rows?.path ?? this.steps[item.frames[0]].edit?.[0]?.[1] ?? "";
    return [{ label: words.axis({ path, label: rows?.label }), texts: values.map((list) => list.join(", ")) }];
  }

  /** What a step changes, in words that `say` makes of an operation. */
  changes(entry, say = (operation) => words.operation(operation, words.short)) {
    return (this.steps[entry].edit ?? []).map((operation) => (typeof operation === "number"
      ? `and ${operation} more` : say({ op: operation[0], path: operation[1], value: operation[2], from: "" })));
  }

  /** One line for an item: of a wedge what it varies, of a step its first changes. */
  summary(item) {
    const axes = this.axes(item);
    if (item.is === "drag") return `${item.frames.length} frames`;
    if (axes.length > 0)
      return axes.map(({ label, texts }) => `${label}: ${texts.length > 6 ? `${texts[0]} to ${texts[texts.length - 1]}` : texts.join(", ")}`).join("; ");
    if (item.number === 0 && this.steps[item.entry].step === 0) return "the scene before any step";
    return this.changes(item.entry, words.brief).join("; ");
  }

  isUnchanged(item) {
    return item.number > 0 && item.frames.every((entry) => this.steps[entry].pixels_changed === 0);
  }

  /** All that can be searched for, in small letters. */
  text(item) {
    if (!this.texts.has(item)) this.texts.set(item, this.searchText(item));
    return this.texts.get(item);
  }

  searchText(item) {
    const own = this.steps[item.entry], texts = [this.name(item.entry), own.class, own.note ?? "", own.author ?? ""];
    for (const entry of new Set([item.entry, ...item.frames])) {
      texts.push(this.steps[entry].note ?? "", this.values(entry).join(" "), this.changes(entry).join(" "));
      for (const operation of this.steps[entry].edit ?? []) if (operation[1]) texts.push(operation[1]);
    }
    for (const { label } of this.axes(item)) texts.push(label);
    return texts.join(" ").toLowerCase();
  }
}
