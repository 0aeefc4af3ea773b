"use strict";
// The viewer with its tools, for any two frames A and B: the page of a run shows entries of it, the page of a comparison
// pairs of files. viewer.html has its elements.
//
// A side is {label, name, file, fill(buffer), preview()}: `fill` puts the linear pixels into a FrameBuffer and says
// whether it could; where it could not, `preview` gives an image, and `file` says where the values are.

/** Marks the pixels of which any bit differs. */
function paintChanged(a, b, canvas) {
  Object.assign(canvas, { width: b.width, height: b.height });
  const context = canvas.getContext("2d"), image = context.createImageData(b.width, b.height);
  const pixels = new Uint32Array(image.data.buffer), planes = Object.keys(b.planes).map((name) => [a.planes[name], b.planes[name]]);
  for (const [before, after] of planes)
    for (let i = 0; i < pixels.length; ++i) if (before[i] !== after[i]) pixels[i] = 0xb0a51eff;
  context.putImageData(image, 0, 0);
}

/** |A - B| of linear values times 2^gain as sRGB; says what differs: {count, largest}. */
function paintDifference(a, b, gain, canvas) {
  Object.assign(canvas, { width: b.width, height: b.height });
  const context = canvas.getContext("2d"), image = context.createImageData(b.width, b.height);
  const { data } = image, names = Object.keys(b.planes), factor = 2 ** gain;
  let count = 0, largest = 0;
  for (let i = 0, y = 0; y < b.height; ++y) {
    for (let x = 0; x < b.width; ++x, ++i) {
      data[4 * i + 3] = 255;
      if (names.every((name) => a.planes[name][i] === b.planes[name][i])) continue;
      ++count;
      for (const [place, name] of ["R", "G", "B"].entries()) {
        const value = Math.abs(a.value(name, x, y) - b.value(name, x, y)), shown = value * factor;
        if (value > largest) largest = value;
        data[4 * i + place] = 255 * (shown <= 0.0031308 ? 12.92 * shown : 1.055 * Math.min(shown, 1) ** (1 / 2.4) - 0.055);
      }
    }
  }
  context.putImageData(image, 0, 0);
  return { count, largest };
}

/** The same of previews, whose display values are all that there is. */
function blendDifference(a, b, gain, canvas) {
  Object.assign(canvas, { width: b.width, height: b.height });
  const context = canvas.getContext("2d");
  context.filter = `brightness(${2 ** gain})`;
  const plain = document.createElement("canvas"), work = plain.getContext("2d");
  Object.assign(plain, { width: b.width, height: b.height });
  work.drawImage(a, 0, 0);
  work.globalCompositeOperation = "difference";
  work.drawImage(b, 0, 0);
  context.drawImage(plain, 0, 0);
}

class PairView {
  /** `layout`: of RunFrames. Calls onState() when what a link says has changed, onSwipe(1 or -1), onPixels() when the
      buffers or the pixel pointed at are others. */
  constructor(layout, ownExposure, { onState, onSwipe, onPixels = () => {} }) {
    Object.assign(this, { onState, onPixels });
    this.buffers = { a: new FrameBuffer(layout), b: new FrameBuffer(layout) };
    this.relit = null;  // a buffer that is shown in place of B's
    this.previews = { a: null, b: null };  // images that are shown instead of buffers
    this.isHalf = this.buffers.b.planes.R instanceof Uint16Array;
    this.display = new Display(this.isHalf, ownExposure);
    this.sides = null;  // those that are painted: {a, b}
    this.gain = 0;
    this.hint = "Point at a pixel: its linear values, as the EXR files have them.";
    this.overlays = {};  // {kind: {name, file, color}}: of B
    this.shownOverlays = new Set();
    this.painting = Promise.resolve();
    this.wanted = null;  // the sides asked for last
    this.viewer = new Viewer(page.byId("view"), { onSwipe, onPixel: () => this.showReadout(), onChange: () => this.showTools() });
    this.region = new RegionTool(this.viewer, (region, isDragging) => this.changeRegion(isDragging));
    this.scopes = page.byId("scopes") ? new Scopes(page.byId("scopes"), this.display, this.region) : null;
    this.connect();
  }

  /** Shows two sides, once those asked for before are done; of many asked for meanwhile the last. True: they are shown. */
  show(sides, overlays = {}) {
    this.wanted = sides;
    this.painting = this.painting.then(() => (this.wanted === sides ? this.paint(sides, overlays) : false)).catch((error) => {
      page.byId("readout").textContent = `This frame cannot be shown: ${error.message}`;
      return false;
    });
    return this.painting;
  }

  async paint(sides, overlays) {
    this.sides = null;
    this.relit = null;
    await Promise.all(["a", "b"].map(async (side) => {
      const hasPixels = await sides[side].fill(this.buffers[side]);
      this.previews[side] = hasPixels ? null : await sides[side].preview();
    }));
    this.sides = sides;
    this.overlays = overlays;
    this.viewer.names = { a: sides.a.name, b: sides.b.name, difference: "" };
    page.byId("view").setAttribute("aria-label", `A: ${sides.a.name}. B: ${sides.b.name}`);
    this.paintBuffers();
    if (this.hasPixels()) paintChanged(this.buffers.a, this.shown("b"), this.viewer.changed);
    else this.viewer.changed.width = 0;
    this.paintGain();
    this.fillOverlayButtons();
    this.showOverlays();
    this.viewer.refresh();
    this.showReadout();
    this.showScopes();
    return true;
  }

  /** `isMoving`: there is more to come soon. */
  showScopes(isMoving = false) {
    const buffer = (side) => (this.sides && !this.previews[side] ? this.shown(side) : null);
    const names = { a: this.sides?.a.name, b: this.sides?.b.name };
    this.scopes?.show({ a: buffer("a"), b: buffer("b"), region: this.region.region, names, isMoving });
  }

  changeRegion(isDragging) {
    this.showScopes(isDragging);
    if (!isDragging) this.onState();
  }

  /** The buffer that a side shows. */
  shown(side) {
    return (side === "b" ? this.relit : null) ?? this.buffers[side];
  }

  /** Shows a buffer in place of B's; null: B's again. */
  setRelit(buffer) {
    if (buffer === this.relit) return;
    this.relit = buffer;
    this.paintBuffers();
    if (this.hasPixels()) paintChanged(this.buffers.a, this.shown("b"), this.viewer.changed);
    this.paintGain();
    this.viewer.draw();
    this.showReadout();
    this.showScopes();
  }

  /** Whether the page has the linear pixels of both sides. */
  hasPixels() {
    return this.sides !== null && !this.previews.a && !this.previews.b;
  }

  paintBuffers() {
    for (const side of ["a", "b"]) {
      const canvas = this.viewer[side], preview = this.previews[side], { width, height } = this.buffers[side];
      if (!preview) {
        this.display.paint(this.shown(side), canvas);
        continue;
      }
      Object.assign(canvas, { width, height });
      canvas.getContext("2d").drawImage(preview, 0, 0, width, height);
    }
  }

  paintGain() {
    const { viewer } = this;
    if (viewer.mode !== "difference" || this.sides === null) return;
    const times = this.gain > 0 ? ` times ${2 ** this.gain}` : "";
    if (this.hasPixels()) {
      const { count, largest } = paintDifference(this.buffers.a, this.shown("b"), this.gain, viewer.difference);
      viewer.names.difference = count === 0 ? "A and B are equal, bit by bit"
        : `|A - B|${times}: ${page.count(count)} pixels differ, by ${Number(largest.toPrecision(3))} at most`;
    } else {
      blendDifference(viewer.a, viewer.b, this.gain, viewer.difference);
      viewer.names.difference = `|A - B|${times}, of previews`;
    }
  }

  setMode(mode) {
    this.viewer.mode = mode;
    this.paintGain();
    this.viewer.setMode(mode);
  }

  setGain(gain) {
    this.gain = Math.min(16, Math.max(0, Math.round(gain)));
    this.paintGain();
    this.viewer.draw();
    this.showTools();
  }

  /** After a change of the display's settings. */
  redisplay() {
    if (this.sides) this.paintBuffers();
    this.viewer.draw();
    this.onState();
    this.showReadout();
    this.showScopes(true);
  }

  fillOverlayButtons() {
    const add = (kind, name, color) => page.element("span", {}, page.button(name, () => this.toggleOverlay(kind),
      { "data-overlay": kind, className: `overlay ${color}`, disabled: kind === "changed" && this.sides !== null && !this.hasPixels() }));
    page.byId("overlay-buttons").replaceChildren(add("changed", "Changed pixels", "changed"),
      ...Object.entries(this.overlays).map(([kind, { name }]) => add(kind, name, kind)));
  }

  toggleOverlay(kind) {
    if (!this.shownOverlays.delete(kind)) this.shownOverlays.add(kind);
    this.showOverlays();
    this.showTools();
  }

  nextOverlay() {
    const kinds = Object.keys(this.overlays), shown = kinds.findIndex((kind) => this.shownOverlays.has(kind));
    for (const kind of kinds) this.shownOverlays.delete(kind);
    if (shown + 1 < kinds.length) this.shownOverlays.add(kinds[shown + 1]);
    this.showOverlays();
    this.showTools();
  }

  showOverlays() {
    this.viewer.showsChanged = this.shownOverlays.has("changed") && this.hasPixels();
    const overlays = [];
    this.viewer.overlays = overlays;  // of these sides only: an image that comes late has its own list
    for (const [kind, { file, color }] of Object.entries(this.overlays)) {
      if (!this.shownOverlays.has(kind)) continue;
      const image = new Image();
      image.onload = () => {
        overlays.push(outlines(image, color));
        this.viewer.draw();
      };
      image.src = file;
    }
    this.viewer.draw();
  }

  showTools() {
    const { viewer } = this;
    for (const button of document.querySelectorAll("#modes button"))
      button.setAttribute("aria-pressed", String(button.dataset.mode === viewer.mode));
    for (const button of document.querySelectorAll("#overlay-buttons button"))
      button.setAttribute("aria-pressed", String(this.shownOverlays.has(button.dataset.overlay)));
    page.byId("zoom-text").textContent = `${Number((viewer.scale * 100).toPrecision(3))} %`;
    page.byId("gain-label").hidden = viewer.mode !== "difference";
    page.byId("gain").value = this.gain;
    page.byId("gain-text").textContent = this.gain;
    viewer.canvas.classList.toggle("fitted", viewer.isFitted);
    this.onState();
  }

  showReadout() {
    const { pixel } = this.viewer, readout = page.byId("readout");
    this.onPixels();
    if (!pixel || !this.sides) {
      readout.replaceChildren(this.hint);
      return;
    }
    const text = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(this.isHalf ? 6 : 9))) : String(value));
    const luma = (side) => {
      const value = lumaWeights.reduce((sum, weight, i) => sum + weight * this.shown(side).value("RGB"[i], pixel.x, pixel.y), 0);
      return page.element("td", { className: "number" }, `Y ${shortNumber(value)} (${stopsText(value, this.display.gain())} EV)`);
    };
    const values = (side) => (this.previews[side]
      ? [page.element("td", { colSpan: 5 }, `a preview: its linear values are in ${this.sides[side].file}`)]
      : ["R", "G", "B", "A"].map((channel) => page.element("td", { className: "number" },
        `${channel} ${text(this.shown(side).value(channel, pixel.x, pixel.y)).padEnd(12)}`)).concat(luma(side)));
    const row = (side) => page.element("tr", {},
      page.element("th", { scope: "row" }, `${side.toUpperCase()}  ${pixel.x}, ${pixel.y}`), ...values(side));
    readout.replaceChildren(page.element("table", {}, page.element("tbody", {}, row("a"), row("b"))));
  }

  connect() {
    const { viewer } = this, on = (id, work) => page.byId(id).addEventListener("click", work);
    for (const button of document.querySelectorAll("#modes button"))
      button.addEventListener("click", () => this.setMode(button.dataset.mode));
    on("zoom-in", () => viewer.zoom(viewer.scale * 2));
    on("zoom-out", () => viewer.zoom(viewer.scale / 2));
    on("zoom-fit", () => viewer.fit());
    on("zoom-full", () => viewer.zoom(1));
    page.byId("gain").addEventListener("input", (event) => this.setGain(Number(event.target.value)));
    this.display.tools(page.byId("display-tools"), () => this.redisplay());
  }

  /** Its settings, for a link; null for what is as at first. */
  toLink() {
    const { viewer } = this, short = (value) => Number(value.toPrecision(5));
    return {
      mode: viewer.mode,
      wipe: viewer.wipe === 0.5 ? null : short(viewer.wipe),
      zoom: viewer.isFitted ? null : [viewer.scale, viewer.center.x, viewer.center.y].map(short).join(),
      gain: this.gain === 0 ? null : this.gain,
      display: this.display.toLink() || null,
      region: this.region.toLink() || null,
      overlays: [...this.shownOverlays].join() || null,
    };
  }

  /** From the parameters of a link (URLSearchParams), all of it. */
  fromLink(values) {
    const { viewer } = this, number = (name, standard) => (Number.isFinite(Number(values.get(name) ?? NaN)) ? Number(values.get(name)) : standard);
    const modes = ["wipe", "blink", "side", "a", "b", "difference"], mode = values.get("mode");
    const [scale, x, y] = (values.get("zoom") ?? "").split(",").map(Number);
    this.gain = Math.min(16, Math.max(0, Math.round(number("gain", 0))));
    viewer.wipe = Math.min(1, Math.max(0, number("wipe", 0.5)));
    viewer.isFitted = !(scale > 0 && Number.isFinite(x) && Number.isFinite(y));
    if (!viewer.isFitted) Object.assign(viewer, { scale: Math.min(64, Math.max(0.05, scale)), center: { x, y } });
    this.shownOverlays = new Set((values.get("overlays") ?? "").split(",").filter((kind) => kind));
    this.display.fromLink(values.get("display") ?? "");
    this.region.fromLink(values.get("region") ?? "", this.buffers.b);
    this.setMode(modes.includes(mode) ? mode : "wipe");
    this.showOverlays();
  }
}
