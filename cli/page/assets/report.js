"use strict";
// The report of a run: contact sheet, one frame against another, plots, the run itself. The address says what is shown
// (link.js).

function loadedImage(file) {
  return new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = () => reject(new Error(`${file} is not beside this page`));
    image.src = file;
  });
}

class RunReport {
  constructor() {
    this.report = page.data("report");
    const layout = page.data("layout");
    this.data = new RunData(this.report, page.data("rows"), page.data("pictures"), layout);
    this.details = new StepDetails(layout, page.data("details"));
    this.frames = new RunFrames(layout, page.data("pixels"), this.details);
    this.reviews = new Reviews(this.data);
    this.entry = this.data.order[Math.min(1, this.data.order.length - 1)] ?? 0;
    this.chosenA = "start";  // what it starts from, "before", or an entry that is pinned
    this.part = null;
    this.showing = null;  // done when the frame asked for last is painted
    this.view = page.kept("view") === "engineering" ? "engineering" : "review";
    this.pair = new PairView(layout, this.report.options?.exposure ?? 0,
      { onState: () => this.saveLink(), onSwipe: (by) => this.move(by), onPixels: () => this.onPixels() });
    page.byId("view").style.setProperty("--frame", `${layout.width} / ${layout.height}`);
    if (this.report.single?.scale > 1)
      this.pair.hint = `Point at a pixel: linear values of this page, which has pixels at 1/${this.report.single.scale}, means of those of the EXR files.`;
    this.viewer = this.pair.viewer;
    this.display = this.pair.display;
    this.sheet = new Sheet(this.data, this.reviews,
      { open: (entry) => this.goTo(entry), pin: (entry) => this.pin(entry), changed: () => this.saveLink() });
    this.plots = new Plots(page.byId("plots"), this.report, this.data.steps, this.data.labels, (entry) => this.goTo(entry));
    this.relight = new RelightPanel(page.byId("relight"), new RunLights(layout, page.data("relight-data")), this.pair, this.data);
    this.reviews.listeners.push(() => this.controls?.show());
  }

  start() {
    this.fillHeader();
    page.byId("run").append(...runParts(this.report));
    this.connect();
    addEventListener("hashchange", () => this.route());
    addEventListener("popstate", () => this.route());
    this.route();
    // After the first frame that shows it: milliseconds from the start of navigation.
    requestAnimationFrame(() => setTimeout(() => { document.documentElement.dataset.opened = performance.now(); }));
  }

  /** For what shows pixels beside the picture. */
  onPixels() {}

  route() {
    const { part, label, values, isWhole } = link.read(), entry = this.data.labels.indexOf(label);
    if (isWhole) {
      this.setView(values.get("view"), false);
      const a = values.get("a");
      this.chosenA = a === "before" || a === null ? a ?? "start" : Math.max(0, this.data.labels.indexOf(a));
      this.pair.fromLink(values);
      this.sheet.fromLink(values);
      this.sheet.setPinned(this.pinned());
    }
    if (part === "step" && entry >= 0) this.entry = entry;
    this.showPart(part);
  }

  showPart(part, before = this.part) {
    this.part = part === "step" && this.data.steps.length === 0 ? "sheet" : part;
    if (this.view === "review" && ["plots", "run"].includes(this.part)) this.setView("engineering", false);
    for (const name of link.parts) page.byId(name).hidden = name !== this.part;
    document.documentElement.dataset.part = this.part;
    for (const button of document.querySelectorAll("header nav button")) {
      if (button.dataset.part === this.part) button.setAttribute("aria-current", "page");
      else button.removeAttribute("aria-current");
    }
    this.axes?.stop();
    if (this.part === "sheet") this.sheet.mark(this.entry, before === null || before === "sheet");
    if (this.part === "plots") this.plots.draw();
    if (this.part === "step") this.showing = this.showStep();
    this.saveLink();
  }

  linkText() {
    const { labels } = this.data, a = this.chosenA;
    return link.text(this.part, this.part === "step" ? labels[this.entry] : null, {
      view: this.view, a: typeof a === "number" ? labels[a] : a === "start" ? null : a, ...this.pair.toLink(), ...this.sheet.toLink(),
    });
  }

  saveLink() {
    if (this.sheet) link.replace(() => this.linkText());
  }

  goToPart(part) {
    const isOther = part !== this.part;
    this.part = part;
    if (isOther) link.push(this.linkText());
    this.showPart(part, part);
    if (part === "sheet") this.sheet.mark(this.entry)?.focus({ preventScroll: true });
  }

  /** Shows an entry: at once, whatever is still loading. */
  goTo(entry) {
    this.entry = Math.min(this.data.steps.length - 1, Math.max(0, entry));
    if (this.part === "step") {
      this.showing = this.showStep();
      this.saveLink();
    } else {
      this.goToPart("step");
      page.byId("view").focus({ preventScroll: true });
    }
  }

  /** Along the frames; in the sheet along its cards. */
  move(by) {
    const { order, placeOf } = this.data;
    if (this.part === "step") {
      this.axes?.stop();
      this.goTo(order[Math.min(order.length - 1, Math.max(0, placeOf[this.entry] + by))]);
    } else if (this.part === "sheet") {
      this.focusOn(this.sheet.along(by));
    }
  }

  moveRow(by) {
    if (this.part === "sheet") this.focusOn(this.sheet.alongColumn(by));
  }

  focusOn(button) {
    if (!button) return;
    this.entry = Number(button.dataset.entry);
    button.focus({ preventScroll: true });
    this.sheet.mark(this.entry);
  }

  openMarked() {
    if (this.part === "sheet") this.sheet.button(this.entry)?.click();
    else this.goTo(this.entry);
  }

  /** The entry that keys are about: the one shown, or the one whose card has the focus. */
  current() {
    const button = this.part === "sheet" ? document.activeElement?.closest?.("li, .cell")?.querySelector("[data-entry]") : null;
    const own = document.activeElement?.dataset?.entry ?? button?.dataset.entry;
    return this.part === "sheet" && own !== undefined ? Number(own) : this.entry;
  }

  pinned() {
    return typeof this.chosenA === "number" ? this.chosenA : null;
  }

  /** The entry that A is. */
  a() {
    if (typeof this.chosenA === "number") return this.chosenA;
    const { order, placeOf } = this.data;
    return this.chosenA === "before" ? order[Math.max(0, placeOf[this.entry] - 1)] : this.data.start(this.entry);
  }

  /** Makes an entry A for all frames to come; again lets it go. */
  pin(entry) {
    this.chooseA(this.chosenA === entry ? "start" : entry);
  }

  chooseA(a) {
    this.chosenA = a;
    this.sheet.setPinned(this.pinned());
    if (this.part === "step") this.showStep();
    this.saveLink();
  }

  swap() {
    const b = this.entry;
    if (this.part !== "step") return;
    this.entry = this.a();
    this.chooseA(b);
  }

  side(entry) {
    return {
      label: this.data.labels[entry], name: this.data.title(entry), file: this.data.steps[entry].frame,
      fill: (buffer) => this.frames.fill(buffer, entry), preview: () => loadedImage(this.data.whole(entry)),
    };
  }

  async showStep() {
    const { entry } = this, a = this.a();
    this.fillSide(entry, null);
    const details = await this.details.of(entry).catch(() => null);  // without its file: the picture says so, too
    if (entry !== this.entry || a !== this.a()) return;
    const isShown = await this.pair.show({ a: this.side(a), b: this.side(entry) }, this.overlays(entry, details));
    if (!isShown || entry !== this.entry || a !== this.a()) return;
    this.fillEngineering(entry, details);
    this.relight.show(entry);
    Object.assign(document.documentElement.dataset, { hasDifference: this.pair.hasPixels(), painted: this.data.labels[entry] });
  }

  /** Outlines over a frame, for engineering. */
  overlays(entry, details) {
    const found = Object.entries(RunReport.overlays).filter(([kind]) => this.view === "engineering" && details?.overlays?.includes(kind));
    return Object.fromEntries(found.map(([kind, about]) => {
      const file = `overlays/${this.data.steps[entry].stem}_${kind}.png`;
      return [kind, { ...about, file: this.data.pictures[file] ?? file }];
    }));
  }

  fillSide(entry, details) {
    const { data } = this, { order, placeOf } = data, place = placeOf[entry];
    const go = (text, by) => page.button(text, () => this.move(by), { disabled: order[place + by] === undefined });
    const pager = page.element("div", { className: "pager" }, go("‹ Previous", -1), page.element("span", {}, `${place + 1} of ${order.length}`), go("Next ›", 1));
    this.stepOpen = entry;
    page.byId("side-step").replaceChildren(pager, ...stepParts(data, entry, details, (other) => this.goTo(other)));
    this.controls = reviewControls(this.reviews, entry);
    page.byId("side-review").replaceChildren(page.element("h3", {}, "Review"), this.controls);
    this.fillChoices();
    this.fillAxes(entry);
  }

  fillEngineering(entry, details) {
    const step = page.byId("side-step"), { data } = this, pager = step.firstElementChild;
    step.replaceChildren(pager, ...stepParts(data, entry, details, (other) => this.goTo(other)));
    page.byId("side-engineering").replaceChildren(...engineeringParts(data.steps[entry], details, this.report));
  }

  /** Sliders below the picture, for the frames of a wedge or drag. */
  fillAxes(entry) {
    const item = this.data.items[this.data.itemOf[entry]], place = Math.max(0, item.frames.indexOf(entry));
    const element = page.byId("axes");
    element.hidden = item.is === "step";
    if (element.hidden) {
      this.axes?.stop();
      this.axes = null;
    } else {
      if (this.axes?.item !== item) {
        this.axes?.stop();
        this.axes = new AxisBar(this.data, item, (chosen) => {
          this.goTo(item.frames[chosen]);
          return this.showing;
        });
        element.replaceChildren(this.axes.element);
      }
      this.axes.show(item.frames.includes(entry) ? place : item.frames.length - 1);
    }
  }

  /** The lists of A and B. */
  fillChoices() {
    const { data } = this, [a, b] = [page.byId("choose-a"), page.byId("choose-b")];
    if (a.options.length === 0) {
      const option = (value, text) => page.element("option", { value }, text);
      const entries = () => data.order.map((entry) => option(entry, data.title(entry)));
      a.append(option("start", "what it starts from"), option("before", "the frame before"), ...entries());
      b.append(...entries());
    }
    a.value = String(typeof this.chosenA === "number" ? data.order[data.placeOf[this.chosenA]] : this.chosenA);
    b.value = String(data.order[data.placeOf[this.entry]]);
    page.byId("pin").setAttribute("aria-pressed", String(this.chosenA === this.entry));
  }

  play() {
    if (this.part === "step") this.axes?.toggle();
  }

  lean(by) {
    if (this.viewer.mode === "difference") this.pair.setGain(this.pair.gain + by);
    else this.viewer.setWipe(this.viewer.wipe + 0.05 * by);
  }

  writeNote() {
    if (this.part !== "step") this.goTo(this.current());
    page.byId("review-note").focus();
  }

  search() {
    this.goToPart("sheet");
    page.byId("search").focus();
  }

  setView(view, isChosen = true) {
    this.view = view === "engineering" ? "engineering" : "review";
    document.documentElement.dataset.view = this.view;
    for (const button of document.querySelectorAll("#views button")) button.setAttribute("aria-pressed", String(button.dataset.view === this.view));
    if (!isChosen) return;
    page.keep("view", this.view);
    if (this.view === "review" && ["plots", "run"].includes(this.part)) this.goToPart("sheet");
    else if (this.part === "step") this.showStep();
    this.saveLink();
  }

  fillHeader() {
    const { report } = this, name = (file) => file.split("/").pop();
    page.byId("title").textContent = name(report.journal.file).replace(/\.json$/, "");
    document.title = `relook: ${name(report.journal.file)}`;
    const facts = [name(report.scene.file), `camera ${report.camera}`, report.resolution.join(" × "), `${page.count(this.data.items.length)} steps`,
      `${page.count(report.entries)} frames`], engineering = [`${report.options.integrator}, ${report.samples} samples a pixel`, ...page.noise(report)];
    if (report.single?.scale > 1) facts.push(`pixels at 1/${report.single.scale}`);
    if (report.verified.frames > 0)
      engineering.push(`verified: ${page.count(report.verified.pixels_different)} pixels differ from full renders`);
    page.byId("facts").replaceChildren(facts.join(" · "), page.element("span", { className: "engineering" }, ` · ${engineering.join(" · ")}`));
    if (report.interrupted)
      page.byId("facts").append(" ", page.element("span", { className: "warning" }, "interrupted: later steps are missing"));
    const { note, author } = report.journal;
    page.byId("journal-note").hidden = !note && !author;
    page.byId("journal-note").textContent = [note, author ? `— ${author}` : null].filter((text) => text).join(" ");
  }

  connect() {
    for (const button of document.querySelectorAll("header nav button"))
      button.addEventListener("click", () => (button.dataset.part === "step" ? this.goTo(this.entry) : this.goToPart(button.dataset.part)));
    for (const button of document.querySelectorAll("#views button"))
      button.addEventListener("click", () => this.setView(button.dataset.view));
    page.byId("scheme").addEventListener("click", () => page.setScheme(page.scheme() === "dark" ? "light" : "dark"));
    page.byId("help-button").addEventListener("click", () => page.byId("help").showModal());
    page.byId("pin").addEventListener("click", () => this.pin(this.entry));
    page.byId("swap").addEventListener("click", () => this.swap());
    page.byId("choose-a").addEventListener("change", ({ target }) => this.chooseA(["start", "before"].includes(target.value) ? target.value : Number(target.value)));
    page.byId("choose-b").addEventListener("change", ({ target }) => this.goTo(Number(target.value)));
    addEventListener("beforeprint", () => this.sheet.makeSome(Infinity));
    this.setView(this.view, false);
    connectKeys(this);
  }
}

RunReport.overlays = {
  dependent: { name: "Depends on the edit", color: "#ffffff" },
  touched: { name: "Tunnels touched", color: "#ffd24a" },
  groups: { name: "Groups", color: "#6ad0ff" },
};

/** In a page of several runs: one of them instead of the cards. */
function openRun() {
  const cards = page.byId("runs");
  if (!cards) return;
  cards.hidden = true;
  page.byId("one-run").hidden = false;
  document.querySelector("header .switches").prepend(page.element("a", { href: "?" }, "All runs"));
}

page.startScheme();
if (page.suffix !== null) {
  openRun();
  new RunReport().start();
}
