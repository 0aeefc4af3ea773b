"use strict";
// The contact sheet: a card for each item, searched, filtered and sorted; wedges unfold below their card, steps that
// change nothing are folded. Cards of long runs are made a few hundred at a time, so that the page is there at once;
// whoever asks for one gets it.

class Sheet {
  /** `does`: {open(entry), pin(entry), changed()}. */
  constructor(data, reviews, does) {
    Object.assign(this, { data, reviews, does });
    this.list = page.byId("sheet-list");
    this.cards = new Map();  // by item
    this.unfolded = new Map();  // by item
    this.openFolds = new Set();  // the first item of each
    this.settings = { search: "", verdict: "all", kind: "", sort: "order", layout: data.hasTree ? "tree" : "cards" };
    this.marked = null;  // an entry
    this.pinned = null;
    this.controls();
    this.refresh();
  }

  controls() {
    const fill = (id, name, options) => {
      const select = page.byId(id);
      select.append(...options.map(([value, text]) => page.element("option", { value }, text)));
      select.addEventListener("change", () => this.change({ [name]: select.value }));
    };
    fill("verdict-filter", "verdict", Object.entries(Sheet.verdicts).map(([value, { text }]) => [value, text]));
    fill("sort", "sort", Object.entries(Sheet.sorts).map(([value, { text }]) => [value, text]));
    fill("class-filter", "kind", [["", "all"], ...[...new Set(this.data.steps.map((step) => step.class))].map((name) => [name, name])]);
    page.byId("search").addEventListener("input", (event) => this.change({ search: event.target.value }));
    page.byId("layouts").hidden = !this.data.hasTree;
    for (const button of document.querySelectorAll("#layouts button"))
      button.addEventListener("click", () => this.change({ layout: button.dataset.layout }));
    const file = page.byId("import-file");
    page.byId("export-reviews").addEventListener("click", () => this.reviews.download());
    page.byId("import-reviews").addEventListener("click", () => file.click());
    file.addEventListener("change", async () => {
      if (file.files.length > 0) page.byId("sheet-count").textContent = this.reviews.imported(await file.files[0].text());
      file.value = "";
    });
    this.reviews.listeners.push((entry) => this.showMarks(entry));
  }

  change(settings) {
    Object.assign(this.settings, settings);
    this.refresh();
    this.does.changed();
  }

  /** Items that search and filters leave, in their order. */
  matches() {
    const { data, reviews, settings } = this, search = settings.search.trim().toLowerCase();
    const verdict = Sheet.verdicts[settings.verdict], sort = Sheet.sorts[settings.sort];
    const matches = data.items.filter((item) => {
      const entries = new Set([item.entry, ...item.frames]), marks = [...entries].map((entry) => reviews.of(entry));
      return marks.some(verdict.holds) && (settings.kind === "" || [...entries].some((entry) => data.steps[entry].class === settings.kind))
        && (search === "" || `${data.text(item)} ${marks.map(({ note }) => note.toLowerCase()).join(" ")}`.includes(search));
    });
    if (sort.key) {
      const keys = new Map(matches.map((item) => [item, sort.key(item, this)]));
      matches.sort((a, b) => keys.get(b) - keys.get(a) || a.number - b.number);
    }
    return matches;
  }

  refresh() {
    const { data, settings } = this;
    this.matching = this.matches();
    const isTree = settings.layout === "tree" && data.hasTree && settings.sort === "order";
    for (const [id, value] of [["search", settings.search], ["verdict-filter", settings.verdict], ["class-filter", settings.kind], ["sort", settings.sort]])
      if (page.byId(id).value !== value) page.byId(id).value = value;
    for (const button of document.querySelectorAll("#layouts button"))
      button.setAttribute("aria-pressed", String((button.dataset.layout === "tree") === isTree));
    this.list.classList.toggle("tree", isTree);
    this.list.replaceChildren();
    this.rows = isTree ? [] : this.foldedRows();
    this.made = 0;
    if (isTree) this.list.append(...new Tree(this).elements());
    else this.makeSome(Sheet.first);
    this.showCount();
  }

  showCount() {
    const { data } = this, left = data.report.entries - data.steps.length, { length } = this.matching;
    const frames = this.matching.reduce((sum, item) => sum + item.frames.length, 0);
    page.byId("sheet-count").textContent = `${page.count(length)} of ${page.count(data.items.length)} steps, ${page.count(frames)} frames`
      + (left > 0 ? `; ${page.count(left)} more are only in report.json` : "")
      + (this.reviews.isKept ? "" : "; this browser does not keep notes: export them");
  }

  /** What the list shows: items, and lists of items that change nothing, one after the other, which are folded. */
  foldedRows() {
    const rows = [];
    for (const item of this.matching) {
      const last = rows[rows.length - 1];
      if (!this.data.isUnchanged(item) || this.settings.search !== "") rows.push(item);
      else if (Array.isArray(last)) last.push(item);
      else rows.push([item]);
    }
    return rows.flatMap((row) => (Array.isArray(row) && this.openFolds.has(row[0].number) ? row : [row]));
  }

  /** Makes rows up to one, and the next ones soon. */
  makeSome(end) {
    const elements = [];
    for (; this.made < Math.min(end, this.rows.length); ++this.made) {
      const row = this.rows[this.made];
      if (Array.isArray(row)) {
        elements.push(this.fold(row));
        continue;
      }
      elements.push(this.card(row).element);
      if (this.unfolded.has(row.number)) elements.push(this.unfolded.get(row.number).element);
    }
    this.list.append(...elements);
    clearTimeout(this.next);
    if (this.made < this.rows.length) this.next = setTimeout(() => this.makeSome(this.made + Sheet.more), 20);
  }

  card(item) {
    if (!this.cards.has(item.number)) {
      const card = new Card(this.data, this.reviews, item,
        { open: this.does.open, pin: this.does.pin, unfold: (wedge) => this.toggle(wedge) });
      card.setPinned(this.isPinned(item));
      this.cards.set(item.number, card);
    }
    return this.cards.get(item.number);
  }

  fold(items) {
    const names = items.slice(0, 3).map((item) => this.data.name(item.entry)).join(", ") + (items.length > 3 ? ", …" : "");
    const button = page.button(`${items.length} ${items.length === 1 ? "step changes" : "steps change"} no pixel: ${names}`, () => {
      this.openFolds.add(items[0].number);
      this.refresh();
      this.list.querySelector(`[data-item="${items[0].number}"] button`)?.focus();
    }, { className: "unchanged open", "data-entry": items[0].entry });
    return page.element("li", { className: "fold" }, button);
  }

  /** Unfolds a wedge, or folds it. */
  toggle(item, isOpen = !this.unfolded.has(item.number)) {
    const card = this.card(item);
    card.button.setAttribute("aria-expanded", String(isOpen));
    card.element.classList.toggle("open-card", isOpen);
    if (isOpen && !this.unfolded.has(item.number)) {
      const unfolded = new Unfolded(this.data, this.reviews, item, { open: this.does.open, fold: () => this.toggle(item, false) });
      this.unfolded.set(item.number, unfolded);
      card.element.after(unfolded.element);
      if (this.list.offsetParent !== null) unfolded.element.scrollIntoView({ block: "nearest" });
    } else if (!isOpen && this.unfolded.has(item.number)) {
      const unfolded = this.unfolded.get(item.number), hadFocus = unfolded.element.contains(document.activeElement);
      unfolded.stop();
      unfolded.element.remove();
      this.unfolded.delete(item.number);
      if (hadFocus) card.button.focus();
    }
    this.does.changed();
  }

  showMarks(entry) {
    if (entry === null) {
      this.refresh();
      for (const card of this.cards.values()) card.showMarks();
      for (const unfolded of this.unfolded.values()) for (const cell of unfolded.cells.keys()) unfolded.showMarks(cell);
      return;
    }
    const number = this.data.itemOf[entry];
    this.cards.get(number)?.showMarks();
    this.unfolded.get(number)?.showMarks(entry);
  }

  isPinned(item) {
    return this.pinned === item.entry || item.frames.includes(this.pinned);
  }

  setPinned(entry) {
    this.pinned = entry;
    for (const card of this.cards.values()) card.setPinned(this.isPinned(card.item));
  }

  /** The button of an entry, if one shows it: its own, or the card of its wedge. */
  button(entry) {
    const item = this.data.items[this.data.itemOf[entry]], place = this.rows.findIndex((row) => row === item);
    if (place >= this.made) this.makeSome(place + 1);
    return this.list.querySelector(`.cell[data-entry="${entry}"]`) ?? this.cards.get(item.number)?.button ?? null;
  }

  /** Marks an entry and brings it into view, unless the sheet `stays` where it is. */
  mark(entry, stays = false) {
    this.list.querySelector("[aria-current=true]")?.removeAttribute("aria-current");
    this.marked = entry;
    const button = this.button(entry);
    button?.setAttribute("aria-current", "true");
    if (!stays) this.keepInView(entry, Sheet.settlingFrames);
    return button;
  }

  /** Cards that come into view for the first time get their real sizes, which moves those below. */
  keepInView(entry, frames) {
    if (entry !== this.marked) return;
    this.button(entry)?.closest(".cell, li").scrollIntoView({ block: "nearest" });
    if (frames > 0) requestAnimationFrame(() => this.keepInView(entry, frames - 1));
  }

  /** Moves the focus some buttons on, along the sheet; null: there is none. */
  along(by) {
    if (Math.abs(by) === Infinity) this.makeSome(this.rows.length);
    const buttons = [...this.list.querySelectorAll("button.open")].filter((button) => button.closest("[hidden]") === null);
    if (buttons.length === 0) return null;
    const here = buttons.indexOf(document.activeElement?.closest?.("button.open") ?? this.button(this.marked));
    return buttons[Math.min(buttons.length - 1, Math.max(0, here + by))];
  }

  /** The button above or below, by where they are. */
  alongColumn(by) {
    const here = document.activeElement?.closest?.("button.open") ?? this.button(this.marked);
    if (!here) return this.along(by);
    const place = (button) => (button.matches(".cell") ? button : button.closest("li")).getBoundingClientRect();  // what is out of view is not laid out within
    const box = place(here), middle = box.x + box.width / 2;
    let best = null, least = Infinity;
    for (const button of this.list.querySelectorAll("button.open")) {
      const other = place(button), down = by > 0 ? other.top - box.bottom : box.top - other.bottom;
      if (other.width === 0 || down < -1) continue;
      const cost = down * 4 + Math.abs(other.x + other.width / 2 - middle);
      if (cost < least) [best, least] = [button, cost];
    }
    return best ?? here;
  }

  toLink() {
    const { search, verdict, kind, sort, layout } = this.settings;
    return {
      q: search || null, show: verdict === "all" ? null : verdict, class: kind || null, sort: sort === "order" ? null : sort,
      layout: layout === (this.data.hasTree ? "tree" : "cards") ? null : layout,
      unfolded: [...this.unfolded.keys()].map((number) => this.data.steps[this.data.items[number].entry].step).join() || null,
    };
  }

  fromLink(values) {
    const known = (table, name, standard) => (Object.hasOwn(table, values.get(name) ?? "") ? values.get(name) : standard);
    const layout = values.get("layout"), before = JSON.stringify(this.settings);
    Object.assign(this.settings, {
      search: values.get("q") ?? "", verdict: known(Sheet.verdicts, "show", "all"), sort: known(Sheet.sorts, "sort", "order"),
      kind: this.data.steps.some((step) => step.class === values.get("class")) ? values.get("class") : "",
      layout: ["cards", "tree"].includes(layout) ? layout : (this.data.hasTree ? "tree" : "cards"),
    });
    const wanted = new Set((values.get("unfolded") ?? "").split(",").map((step) => this.data.byStep.get(Number(step || NaN))));
    for (const item of this.data.items)
      if (item.is !== "step" && wanted.has(item) !== this.unfolded.has(item.number)) this.toggle(item, wanted.has(item));
    if (JSON.stringify(this.settings) !== before) this.refresh();
  }
}
Sheet.first = 100;  // cards that the page opens with
Sheet.more = 250;
Sheet.settlingFrames = 12;

/** Which marks of a frame each choice leaves. */
Sheet.verdicts = {
  all: { text: "all", holds: () => true },
  starred: { text: "★ starred", holds: ({ stars }) => stars > 0 },
  approved: { text: "✓ approved", holds: ({ verdict }) => verdict === "approved" },
  rejected: { text: "✕ rejected", holds: ({ verdict }) => verdict === "rejected" },
  undecided: { text: "not decided", holds: ({ verdict }) => verdict === "" },
  noted: { text: "with a note", holds: ({ note }) => note !== "" },
};

/** What items are sorted by, the largest first; the order of the journal without. */
Sheet.sorts = {
  order: { text: "journal's order" },
  stars: { text: "stars", key: (item, { reviews }) => Math.max(...[item.entry, ...item.frames].map((entry) => reviews.of(entry).stars)) },
  pixels: { text: "pixels changed", key: (item, { data }) => Math.max(...item.frames.map((entry) => data.steps[entry].pixels_changed ?? 0)) },
  time: { text: "time", key: (item, { data }) => data.steps[item.entry].seconds.total ?? 0 },
};
