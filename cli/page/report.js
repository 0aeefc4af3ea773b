"use strict";
// The report of a run: contact sheet, one step, plots, the run itself. The address says what is shown: #step=3_01.

class RunReport {
  constructor() {
    this.report = page.data("report");
    this.edits = page.data("edits");
    this.thumbnails = page.data("thumbnails");
    this.overlays = page.data("overlays");
    const layout = page.data("layout");
    this.frames = new RunFrames(layout, page.data("pixels"));
    this.buffers = { before: new FrameBuffer(layout), after: new FrameBuffer(layout) };
    this.isHalf = this.buffers.after.planes.R instanceof Uint16Array;
    this.steps = this.report.steps;
    this.labels = this.steps.map((step) => {
      const frame = step.drag_frame ?? step.wedge_frame;
      return frame === null ? String(step.step) : `${step.step}_${String(frame).padStart(2, "0")}`;
    });
    this.entry = Math.min(1, this.steps.length - 1);
    this.exposure = 0;
    this.shownOverlays = new Set();
    this.painting = Promise.resolve();
    this.viewer = new Viewer(page.byId("view"), { onPixel: () => this.showReadout(), onChange: () => this.showTools() });
    this.plots = new Plots(page.byId("plots"), this.report, this.labels, (entry) => this.goTo(entry));
  }

  start() {
    this.fillHeader();
    this.fillSheet();
    this.fillRun();
    this.connect();
    addEventListener("hashchange", () => this.route());
    this.route();
  }

  route() {
    const [part, label] = location.hash.slice(1).split("=");
    const known = ["sheet", "step", "plots", "run"], entry = this.labels.indexOf(decodeURIComponent(label ?? ""));
    this.part = known.includes(part) ? part : "sheet";
    if (this.part === "step" && entry >= 0) this.entry = entry;
    for (const name of known) page.byId(name).hidden = name !== this.part;
    for (const button of document.querySelectorAll("header nav button")) {
      if (button.dataset.part === this.part) button.setAttribute("aria-current", "page");
      else button.removeAttribute("aria-current");
    }
    if (this.part === "sheet") this.markCard();
    if (this.part === "plots") this.plots.draw();
    if (this.part === "step") this.showStep();
  }

  goTo(entry) {
    location.hash = `step=${this.labels[Math.min(this.steps.length - 1, Math.max(0, entry))]}`;
  }

  /** Along the steps: in the contact sheet the marked one, else the one that is shown. */
  move(by) {
    const entry = Math.min(this.steps.length - 1, Math.max(0, this.entry + by));
    if (this.part === "step") {
      this.goTo(entry);
    } else if (this.part === "sheet") {
      this.entry = entry;
      this.markCard();
      this.cards[entry].focus();
    }
  }

  moveRow(by) {
    if (this.part !== "sheet") return;
    const columns = getComputedStyle(page.byId("sheet-list")).gridTemplateColumns.split(" ").length;
    this.move(by * columns);
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
      `${report.samples} samples a pixel`, `${this.steps.length} frames`];
    const verified = this.steps.filter((step) => step.verify);
    const different = verified.reduce((sum, step) => sum + step.verify.pixels_different, 0);
    if (verified.length > 0) facts.push(`verified: ${page.count(different)} pixels differ from full renders`);
    page.byId("facts").textContent = facts.join(", ");
    if (report.interrupted)
      page.byId("facts").append(" ", page.element("span", { className: "warning" }, "interrupted: later steps are missing"));
  }

  fillSheet() {
    const filter = page.byId("class-filter"), classes = new Set(this.steps.map((step) => step.class));
    filter.append(page.element("option", { value: "" }, "all"));
    for (const name of classes) filter.append(page.element("option", { value: name }, name));
    filter.addEventListener("change", () => this.filterCards());
    const { width, height } = this.frames.layout;
    this.cards = this.steps.map((step, entry) => {
      const picture = page.element("img", { alt: "", loading: "lazy", decoding: "async", width, height, src: this.thumbnails[entry] });
      const card = page.element("button", { className: "card", type: "button" }, picture,
        page.element("span", { className: "name" }, `${this.labels[entry]} ${step.name}`),
        page.element("span", { className: "line" }, page.element("span", { className: `chip ${step.class}` }, step.class),
          page.element("span", {}, page.seconds(step.seconds.total))),
        page.element("span", { className: "line" }, `${page.count(step.pixels_changed)} pixels changed`));
      card.addEventListener("click", () => this.goTo(entry));
      return card;
    });
    page.byId("sheet-list").append(...this.cards);
    this.filterCards();
  }

  filterCards() {
    const wanted = page.byId("class-filter").value;
    let shown = 0;
    this.cards.forEach((card, entry) => {
      card.hidden = wanted !== "" && this.steps[entry].class !== wanted;
      if (!card.hidden) ++shown;
    });
    const total = this.steps.reduce((sum, step) => sum + step.seconds.total, 0);
    page.byId("sheet-count").textContent = `${shown} of ${this.steps.length} frames; ${page.seconds(total)} altogether`;
  }

  markCard() {
    this.cards.forEach((card, entry) => card.setAttribute("aria-current", String(entry === this.entry)));
    this.cards[this.entry]?.scrollIntoView({ block: "nearest" });
  }

  reference() {
    return page.byId("reference").value === "first" ? 0 : Math.max(0, this.entry - 1);
  }

  showStep() {
    this.fillSide();
    this.fillOverlayButtons();
    this.showTools();
    // One after the other: a frame is taken into the buffers of the last one.
    const entry = this.entry;
    this.painting = this.painting.then(() => (entry === this.entry ? this.paint() : null))
      .catch((error) => { page.byId("readout").textContent = `The pixels cannot be shown: ${error.message}`; });
    return this.painting;
  }

  async paint() {
    const entry = this.entry, { before, after } = this.buffers;
    await Promise.all([this.frames.fill(before, this.reference()), this.frames.fill(after, entry)]);
    this.shown = entry;
    this.paintBuffers();
    paintDifference(before, after, this.viewer.difference);
    this.showOverlays();
    this.viewer.refresh();
    this.showReadout();
    document.documentElement.dataset.painted = this.labels[entry];
  }

  paintBuffers() {
    const table = new DisplayTable(this.exposure, this.isHalf);
    table.paint(this.buffers.before, this.viewer.before);
    table.paint(this.buffers.after, this.viewer.after);
  }

  setExposure(stops) {
    this.exposure = Math.min(8, Math.max(-8, stops));
    if (this.shown !== undefined) this.paintBuffers();
    this.viewer.draw();
    this.showTools();
  }

  overlayNames() {
    const names = { dependent: "depends on the edit", touched: "tunnels touched", groups: "groups", tunnels: "tunnels" };
    return Object.entries(names).filter(([kind]) => kind in this.overlays[this.entry]);
  }

  fillOverlayButtons() {
    const add = (kind, name) => {
      const button = page.element("button", { type: "button", "data-overlay": kind }, name);
      button.addEventListener("click", () => this.toggleOverlay(kind));
      return button;
    };
    page.byId("overlay-buttons").replaceChildren(add("changed", "changed pixels"),
      ...this.overlayNames().map(([kind, name]) => add(kind, name)));
  }

  toggleOverlay(kind) {
    if (!this.shownOverlays.delete(kind)) this.shownOverlays.add(kind);
    this.showOverlays();
    this.showTools();
  }

  showOverlays() {
    this.viewer.showsDifference = this.shownOverlays.has("changed");
    const overlays = [];
    this.viewer.overlays = overlays;  // of this step only: an image that comes late has its own list
    for (const [kind] of this.overlayNames().filter(([name]) => this.shownOverlays.has(name))) {
      const image = new Image();
      image.onload = () => {
        overlays.push(whiteParts(image));
        this.viewer.draw();
      };
      image.src = this.overlays[this.entry][kind];
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
    page.byId("exposure-text").textContent = `${this.exposure >= 0 ? "+" : ""}${this.exposure} EV`;
  }

  showReadout() {
    const { pixel } = this.viewer, readout = page.byId("readout");
    if (!pixel || this.shown === undefined) {
      readout.replaceChildren("Point at a pixel: its linear values, as the EXR files have them.");
      return;
    }
    const text = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(this.isHalf ? 6 : 9))) : String(value));
    const row = (name, buffer) => page.element("tr", {}, page.element("th", { scope: "row" }, name),
      ...["R", "G", "B", "A"].map((channel) => page.element("td", { className: "number" },
        `${channel} ${text(buffer.value(channel, pixel.x, pixel.y)).padEnd(12)}`)));
    readout.replaceChildren(page.element("table", {}, page.element("tbody", {},
      row(`before  ${pixel.x}, ${pixel.y}`, this.buffers.before), row(`after   ${pixel.x}, ${pixel.y}`, this.buffers.after))));
  }

  fillSide() {
    const step = this.steps[this.entry], edit = this.edits[this.entry];
    const move = (text, by) => {
      const button = page.element("button", { type: "button", disabled: !this.steps[this.entry + by] }, text);
      button.addEventListener("click", () => this.goTo(this.entry + by));
      return button;
    };
    const list = (texts) => page.element("ul", {}, ...texts.map((text) => page.element("li", {}, text)));
    const parts = [
      page.element("div", { className: "pager" }, move("Previous", -1), `${this.entry + 1} of ${this.steps.length}`, move("Next", 1)),
      page.element("h2", { id: "step-name" }, `${this.labels[this.entry]} ${step.name}`),
      page.element("p", {}, page.element("span", { className: `chip ${step.class}` }, step.class)),
    ];
    const add = (heading, ...content) => parts.push(page.element("h3", {}, heading), ...content);
    if (step.reasons.length > 0) add("Why this class", list(step.reasons));
    if (edit?.select.length > 0) add("Selection", list(edit.select));
    if (edit?.edit) {
      add("The edit in words", list(edit.edit.map(words.operation)));
      add("The edit", page.element("pre", {}, words.json(edit.edit)));
    }
    add("Cost", page.table(this.costs(step)));
    this.addFiles(add, step);
    page.byId("side").replaceChildren(...parts);
  }

  costs(step) {
    const full = this.report.full_render_seconds, rows = [["seconds, total", page.seconds(step.seconds.total)]];
    if (full && step.step > 0 && step.seconds.total > 0)
      rows.push(["full render / step", `${Number((full / step.seconds.total).toPrecision(3))} x`]);
    for (const stage of ["classify", "select", "test", "update", "evaluate", "write"])
      rows.push([stage, page.seconds(step.seconds[stage])]);
    for (const [key, name] of [["pixels_changed", "pixels changed"], ["samples_affected", "samples affected"],
      ["regions_visited", "regions visited"], ["regions_culled", "regions culled"], ["ray_tests", "ray tests"],
      ["ray_tests_culled", "ray tests culled"], ["ray_updates", "ray updates"], ["shadow_updates", "shadow updates"],
      ["color_trees_evaluated", "colour trees evaluated"]]) rows.push([name, page.count(step[key])]);
    rows.push(["resident", page.bytes(step.resident.total)]);
    if (step.verify)
      rows.push(["verified, pixels that differ", `${page.count(step.verify.pixels_different)} of ${page.count(step.verify.pixels_compared)}`]);
    return rows;
  }

  addFiles(add, step) {
    add("Files", page.element("div", {}, page.element("code", {}, step.frame)), page.element("div", {}, page.element("code", {}, step.preview)));
    if (step.resumed) add("Resumed", "This frame was kept from an earlier run of the same inputs.");
  }

  fillRun() {
    const { report } = this, section = page.byId("run");
    const rows = [["scene", report.scene.file], ["scene hash", report.scene.hash], ["journal", report.journal.file],
      ["journal hash", report.journal.hash], ["program", `relook ${report.program}`], ["camera", report.camera],
      ["resolution", report.resolution.join(" x ")], ["samples a pixel", report.samples],
      ["machine", `${report.machine.threads} threads, ${report.machine.cpu}`],
      ["full render", report.full_render_seconds ? page.seconds(report.full_render_seconds) : "not measured"]];
    for (const [name, value] of Object.entries(report.options)) rows.push([`option ${name}`, JSON.stringify(value)]);
    for (const [name, value] of Object.entries(report.cache_bytes)) rows.push([`cache, ${name}`, page.bytes(value)]);
    section.append(page.table(rows));
    if (report.cache_damage.length > 0)
      section.append(page.element("h3", {}, "Parts of the cache that were traced again"),
        page.element("ul", {}, ...report.cache_damage.map((text) => page.element("li", {}, text))));
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
