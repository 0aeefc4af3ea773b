"use strict";
// The report of a run: contact sheet, one step, plots, the run itself. The address says what is shown: #step=3_01.

/** The steps from their rows: {step: 3, seconds: {total: ...}, ...} as in report.json, as far as rows go. */
function stepsOf({ columns, rows }) {
  const places = columns.map((pointer) => pointer.split("/").slice(1));
  return rows.map(([stem, isWithin, name, kind, ...values]) => {
    const step = { name, class: kind, frame: `frames/${stem}.exr`, preview: `previews/${stem}.png`, stem };
    places.forEach(([key, inner], i) => {
      if (inner === undefined) step[key] = values[i];
      else (step[key] ??= {})[inner] = values[i];
    });
    step.label = isWithin ? `${step.step}${stem.replace(/^[0-9]+/, "")}` : String(step.step);
    return step;
  });
}

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
    this.steps = stepsOf(page.data("rows"));
    this.labels = this.steps.map((step) => step.label);
    this.pictures = page.data("pictures");
    const layout = page.data("layout");
    this.details = new StepDetails(layout, page.data("details"));
    this.frames = new RunFrames(layout, page.data("pixels"), this.details);
    this.buffers = { before: new FrameBuffer(layout), after: new FrameBuffer(layout) };
    this.previews = { before: null, after: null };  // images that are shown instead of buffers
    this.isHalf = this.buffers.after.planes.R instanceof Uint16Array;
    this.entry = Math.min(1, this.steps.length - 1);
    this.shown = null;  // the entries that are painted: { before, after }
    this.stepDetails = null;  // of the entry, once they are there
    this.ownExposure = this.report.options?.exposure ?? 0;  // of the previews
    this.exposure = 0;  // beside it
    this.shownOverlays = new Set();
    this.painting = Promise.resolve();
    this.viewer = new Viewer(page.byId("view"), { onPixel: () => this.showReadout(), onChange: () => this.showTools() });
    const open = (entry) => this.goTo(entry);
    this.plots = new Plots(page.byId("plots"), this.report, this.steps, this.labels, open);
    this.sheet = new Sheet({ report: this.report, steps: this.steps, labels: this.labels, pictures: this.pictures, layout, open });
  }

  start() {
    this.fillHeader();
    page.byId("run").append(...runParts(this.report));
    this.connect();
    addEventListener("hashchange", () => this.route());
    this.route();
    // After the first frame that shows it: milliseconds from the start of navigation.
    requestAnimationFrame(() => setTimeout(() => { document.documentElement.dataset.opened = performance.now(); }));
  }

  route() {
    const [part, label] = location.hash.slice(1).split("=");
    const known = ["sheet", "step", "plots", "run"], entry = this.labels.indexOf(decodeURIComponent(label ?? ""));
    this.part = known.includes(part) && (part !== "step" || this.steps.length > 0) ? part : "sheet";
    if (this.part === "step" && entry >= 0) this.entry = entry;
    for (const name of known) page.byId(name).hidden = name !== this.part;
    for (const button of document.querySelectorAll("header nav button")) {
      if (button.dataset.part === this.part) button.setAttribute("aria-current", "page");
      else button.removeAttribute("aria-current");
    }
    if (this.part === "sheet") this.sheet.mark(this.entry);
    if (this.part === "plots") this.plots.draw();
    if (this.part === "step") this.showStep();
  }

  goTo(entry) {
    location.hash = `step=${this.labels[Math.min(this.steps.length - 1, Math.max(0, entry))]}`;
  }

  /** Along the steps: in the contact sheet the marked one, else the one that is shown. */
  move(by) {
    if (this.part === "step") {
      this.goTo(this.entry + by);
    } else if (this.part === "sheet") {
      this.entry = this.sheet.along(by);
      this.sheet.mark(this.entry);
      this.sheet.cards[this.entry]?.focus();
    }
  }

  moveRow(by) {
    if (this.part === "sheet") this.move(by * this.sheet.columns());
  }

  nextOverlay() {
    const kinds = this.overlayNames().map(([kind]) => kind), shown = kinds.findIndex((kind) => this.shownOverlays.has(kind));
    for (const kind of kinds) this.shownOverlays.delete(kind);
    if (shown + 1 < kinds.length) this.shownOverlays.add(kinds[shown + 1]);
    this.showOverlays();
    this.showTools();
  }

  fillHeader() {
    const { report } = this, name = (file) => file.split("/").pop();
    page.byId("title").textContent = name(report.journal.file);
    document.title = `relook: ${name(report.journal.file)}`;
    const facts = [`scene ${name(report.scene.file)}`, `camera ${report.camera}`, report.resolution.join(" x "),
      `${report.options.integrator}, ${report.samples} samples a pixel`, ...page.noise(report), `${page.count(report.entries)} frames`];
    if (report.verified.frames > 0)
      facts.push(`verified: ${page.count(report.verified.pixels_different)} pixels differ from full renders`);
    page.byId("facts").textContent = facts.join(", ");
    if (report.interrupted)
      page.byId("facts").append(" ", page.element("span", { className: "warning" }, "interrupted: later steps are missing"));
  }

  reference() {
    return page.byId("reference").value === "first" ? 0 : Math.max(0, this.entry - 1);
  }

  showStep() {
    this.stepDetails = null;
    this.fillSide();
    this.fillOverlayButtons();
    this.showTools();
    // One after the other: a frame is taken into the buffers of the last one.
    const entry = this.entry;
    this.painting = this.painting.then(() => (entry === this.entry ? this.paint() : null))
      .catch((error) => { page.byId("readout").textContent = `This step cannot be shown: ${error.message}`; });
    return this.painting;
  }

  async paint() {
    const entry = this.entry, shown = { before: this.reference(), after: entry };
    const details = await this.details.of(entry);
    if (entry !== this.entry) return;
    this.stepDetails = details;
    this.fillSide();
    this.shown = null;
    await Promise.all(["before", "after"].map((side) => this.take(side, shown[side])));
    this.shown = shown;
    this.paintBuffers();
    if (this.hasDifference()) paintDifference(this.buffers.before, this.buffers.after, this.viewer.difference);
    else this.viewer.difference.width = 0;
    this.fillOverlayButtons();
    this.showOverlays();
    this.viewer.refresh();
    this.showReadout();
    Object.assign(document.documentElement.dataset, { hasDifference: this.hasDifference(), painted: this.labels[entry] });
  }

  /** Makes one side the frame of an entry: its pixels, or its preview when the page does not have them. */
  async take(side, entry) {
    const hasPixels = await this.frames.fill(this.buffers[side], entry);
    this.previews[side] = hasPixels ? null : await loadedImage(this.steps[entry].preview);
  }

  hasDifference() {
    return this.shown !== null && !this.previews.before && !this.previews.after;
  }

  paintBuffers() {
    const table = new DisplayTable(this.ownExposure + this.exposure, this.isHalf);
    for (const side of ["before", "after"]) {
      const canvas = this.viewer[side], preview = this.previews[side], { width, height } = this.buffers[side];
      if (!preview) {
        table.paint(this.buffers[side], canvas);
        continue;
      }
      Object.assign(canvas, { width, height });
      canvas.getContext("2d").drawImage(preview, 0, 0, width, height);
    }
  }

  setExposure(stops) {
    this.exposure = Math.min(8, Math.max(-8, stops));
    if (this.shown) this.paintBuffers();
    this.viewer.draw();
    this.showTools();
  }

  overlayNames() {
    const names = { dependent: "depends on the edit", touched: "tunnels touched", groups: "groups" };
    return Object.entries(names).filter(([kind]) => this.stepDetails?.overlays?.includes(kind));
  }

  fillOverlayButtons() {
    const add = (kind, name) => {
      const button = page.element("button", { type: "button", "data-overlay": kind }, name);
      button.addEventListener("click", () => this.toggleOverlay(kind));
      return button;
    };
    const changed = add("changed", "changed pixels");
    changed.disabled = this.shown !== null && !this.hasDifference();
    page.byId("overlay-buttons").replaceChildren(changed,
      ...this.overlayNames().map(([kind, name]) => add(kind, name)));
  }

  toggleOverlay(kind) {
    if (!this.shownOverlays.delete(kind)) this.shownOverlays.add(kind);
    this.showOverlays();
    this.showTools();
  }

  showOverlays() {
    this.viewer.showsDifference = this.shownOverlays.has("changed") && this.hasDifference();
    const overlays = [];
    this.viewer.overlays = overlays;  // of this step only: an image that comes late has its own list
    for (const [kind] of this.overlayNames().filter(([name]) => this.shownOverlays.has(name))) {
      const image = new Image();
      image.onload = () => {
        overlays.push(whiteParts(image));
        this.viewer.draw();
      };
      const file = `overlays/${this.steps[this.entry].stem}_${kind}.png`;
      image.src = this.pictures[file] ?? file;
    }
    this.viewer.draw();
  }

  showTools() {
    for (const button of document.querySelectorAll("#modes button"))
      button.setAttribute("aria-pressed", String(button.dataset.mode === this.viewer.mode));
    for (const button of document.querySelectorAll("#overlay-buttons button"))
      button.setAttribute("aria-pressed", String(this.shownOverlays.has(button.dataset.overlay)));
    page.byId("zoom-text").textContent = `${Number((this.viewer.scale * 100).toPrecision(3))} %`;
    page.byId("exposure").value = this.exposure;
    const stops = this.ownExposure + this.exposure;
    page.byId("exposure-text").textContent = `${stops >= 0 ? "+" : ""}${stops} EV`;
  }

  showReadout() {
    const { pixel } = this.viewer, readout = page.byId("readout");
    if (!pixel || !this.shown) {
      readout.replaceChildren("Point at a pixel: its linear values, as the EXR files have them.");
      return;
    }
    const text = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(this.isHalf ? 6 : 9))) : String(value));
    const values = (side) => (this.previews[side]
      ? [page.element("td", { colSpan: 4 }, `a preview: its linear values are in ${this.steps[this.shown[side]].frame}`)]
      : ["R", "G", "B", "A"].map((channel) => page.element("td", { className: "number" },
        `${channel} ${text(this.buffers[side].value(channel, pixel.x, pixel.y)).padEnd(12)}`)));
    const row = (side) => page.element("tr", {},
      page.element("th", { scope: "row" }, `${side.padEnd(7)} ${pixel.x}, ${pixel.y}`), ...values(side));
    readout.replaceChildren(page.element("table", {}, page.element("tbody", {}, row("before"), row("after"))));
  }

  fillSide() {
    const step = this.steps[this.entry], { length } = this.steps;
    const move = (text, by) => {
      const button = page.element("button", { type: "button", disabled: !this.steps[this.entry + by] }, text);
      button.addEventListener("click", () => this.goTo(this.entry + by));
      return button;
    };
    page.byId("side").replaceChildren(
      page.element("div", { className: "pager" }, move("Previous", -1), `${this.entry + 1} of ${length}`, move("Next", 1)),
      page.element("h2", { id: "step-name" }, `${this.labels[this.entry]} ${step.name}`),
      ...stepParts(step, this.stepDetails, this.report.full_render_seconds));
  }

  connect() {
    const { viewer } = this, on = (id, work) => page.byId(id).addEventListener("click", work);
    for (const button of document.querySelectorAll("header nav button"))
      button.addEventListener("click", () => {
        if (button.dataset.part === "step") this.goTo(this.entry);
        else location.hash = button.dataset.part;
      });
    for (const button of document.querySelectorAll("#modes button"))
      button.addEventListener("click", () => viewer.setMode(button.dataset.mode));
    on("zoom-in", () => viewer.zoom(viewer.scale * 2));
    on("zoom-out", () => viewer.zoom(viewer.scale / 2));
    on("zoom-fit", () => viewer.fit());
    on("zoom-full", () => viewer.zoom(1));
    on("scheme", () => page.setScheme(page.scheme() === "dark" ? "light" : "dark"));
    on("help-button", () => page.byId("help").showModal());
    page.byId("exposure").addEventListener("input", (event) => this.setExposure(Number(event.target.value)));
    page.byId("reference").addEventListener("change", () => this.showStep());
    connectKeys(this);
  }
}

page.followSystemScheme();
new RunReport().start();
