"use strict";
// The panel of relighting beside a frame: for each light exposure, colour, solo and mute; the journal step that makes the
// same look. Frame B is shown as it is lit here; layers are loaded once the panel is open.

const srgb = {
  encoded(value) {
    return value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;
  },
  linear(value) {
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  },
  /** "#rrggbb" of linear values, as bright as fits; and back, to four digits. */
  text(color) {
    const most = Math.max(1, ...color);
    return `#${color.map((value) => Math.round(255 * srgb.encoded(value / most)).toString(16).padStart(2, "0")).join("")}`;
  },
  color(text) {
    return [1, 3, 5].map((at) => Number(srgb.linear(parseInt(text.slice(at, at + 2), 16) / 255).toPrecision(4)));
  },
};

class RelightPanel {
  /** `pair`: a PairView whose B is lit. `hint(entry)`: why a frame cannot be, as nodes, where the run has no layers. */
  constructor(element, lights, pair, data) {
    Object.assign(this, { element, lights, pair, data, relights: new Map(), entry: -1, relight: null, frame: 0, rows: [] });
    this.box = page.element("details", { id: "relight-box" }, page.element("summary", {}, page.element("h3", {}, "Relight"), this.note = page.element("span", { className: "soft", role: "status" })));
    this.body = page.element("div", { className: "relight-body" });
    this.box.append(this.body);
    this.box.addEventListener("toggle", () => this.load());
    element.replaceChildren(this.box);
    element.hidden = false;
  }

  toggle() {
    this.box.open = !this.box.open;
    if (this.box.open) this.box.querySelector("summary").focus();
  }

  /** A frame is shown as B, as it is. */
  show(entry) {
    this.entry = entry;
    this.relight = null;
    this.pair.relit = null;
    this.note.textContent = this.relights.has(entry) && !this.relights.get(entry).isAtRest() ? "changed" : "";
    return this.load();
  }

  async load() {
    const { entry } = this;
    if (!this.box.open || entry < 0 || this.relight?.entry === entry) return;
    if (!this.lights.has(entry)) {
      this.body.replaceChildren(...this.hint());
      return;
    }
    this.body.replaceChildren(page.element("p", { className: "soft" }, "Loading the layers of light…"));
    try {
      const lights = await this.lights.of(entry);
      if (entry !== this.entry) return;
      const relight = this.relights.get(entry) ?? new Relight(lights);
      this.relights.set(entry, Object.assign(relight, { lights }));
      this.relight = relight;
      this.fill();
      this.update();
    } catch (error) {
      if (entry === this.entry) this.body.replaceChildren(page.element("p", { className: "warning" }, `These lights cannot be shown: ${error.message}`));
    }
  }

  hint() {
    const { report } = this.data, code = (text) => page.element("code", {}, text);
    if (report.options.integrator !== "path")
      return [page.element("p", { className: "soft" }, "Only frames of the path integrator are sums of their lights; these are not.")];
    return [page.element("p", { className: "soft" }, "Lights can be turned here once the run has their layers. ", code("relook replay"), " with the same cache, journal and run, and ",
      code("--relight"), ", adds them.")];
  }

  fill() {
    const { relight } = this;
    this.rows = relight.controls.map((control, i) => (control.kind === "fixed" ? null : this.row(control, i)));
    const has = (kind) => relight.controls.some((control) => control.kind === kind);
    const lines = [];
    if (this.pair.previews.b) lines.push("This page has no pixels of this frame, only its preview: lights cannot be turned here.");
    if (has("fixed")) lines.push("Unlit surfaces stay as they are.");
    this.text = page.element("textarea", { readOnly: true, rows: 8, spellcheck: false, "aria-label": "The journal step" });
    this.saved = page.element("span", { className: "soft", role: "status" });
    this.stepButtons = [page.button("Copy", () => this.copy()), page.button("Download", () => this.download())];
    this.resetButton = page.button("Reset all", () => this.set(() => relight.reset()));
    this.step = page.element("details", { className: "relight-step" }, page.element("summary", {}, "Save as journal step"),
      page.element("p", { className: "soft" }, "Add it to the journal's steps; replay then makes this look."), this.text,
      page.element("div", { className: "relight-buttons" }, ...this.stepButtons, this.saved));
    this.body.replaceChildren(...lines.map((line) => page.element("p", { className: "soft" }, line)),
      page.element("ul", { className: "relight-lights" }, ...this.rows.filter((row) => row).map((row) => row.element)),
      page.element("div", { className: "relight-buttons" }, this.resetButton), this.step);
  }

  /** What is said of a control: its name, and what it is. */
  static words({ kind, name, settings }) {
    const names = { environment: "Environment", ambient: "Ambient light", background: "Background" };
    const kinds = { light: "light", emission: "emission", shared: `${settings.length} ${settings.length === 1 ? "light" : "lights"} together` };
    return { name: names[kind] ?? name, kind: kinds[kind] ?? "" };
  }

  row(control, i) {
    const { name, kind } = RelightPanel.words(control), state = () => this.relight.states[i];
    const toggle = (letter, what, key) => page.button(letter, () => this.set(() => { state()[key] = !state()[key]; }), { title: what, "aria-label": `${what} ${name}` });
    const solo = toggle("S", "Solo", "isSolo"), mute = toggle("M", "Mute", "isMuted");
    const slider = page.element("input", { type: "range", min: -Relight.mostStops, max: Relight.mostStops, step: 0.05, "aria-label": `Exposure of ${name}, stops` });
    const stops = page.element("input", { type: "number", min: -Relight.mostStops, max: Relight.mostStops, step: 0.25, "aria-label": `Stops of ${name}` });
    const swatch = page.element("input", { type: "color", "aria-label": `Colour of ${name}`, title: "Colour" });
    const numbers = ["red", "green", "blue"].map((channel) => page.element("input", { type: "number", min: 0, step: 0.01, "aria-label": `Linear ${channel} of ${name}`, title: `linear ${channel}` }));
    const reset = page.button("↺", () => this.set(() => { this.relight.states[i] = new LightState(control); }), { title: "Reset", "aria-label": `Reset ${name}` });
    const setStops = (input) => input.addEventListener("input", () => {
      const value = input.valueAsNumber;
      if (Number.isFinite(value)) this.set(() => { state().stops = Math.min(Relight.mostStops, Math.max(-Relight.mostStops, value)); }, input);
    });
    setStops(slider);
    setStops(stops);
    swatch.addEventListener("input", () => this.set(() => { state().color = srgb.color(swatch.value); }, swatch));
    numbers.forEach((input, k) => input.addEventListener("input", () => {
      const value = input.valueAsNumber;
      if (Number.isFinite(value) && value >= 0) this.set(() => { state().color[k] = Math.min(value, Math.max(1, state().base.color[k])); }, input);
    }));
    const element = page.element("li", { "data-light": name }, page.element("div", { className: "relight-name" }, page.element("span", {}, page.element("strong", {}, name), ` ${kind}`), solo, mute, reset),
      page.element("div", { className: "relight-stops" }, slider, stops, page.element("span", { className: "soft" }, "EV")),
      page.element("div", { className: "relight-color" }, swatch, ...numbers, page.element("span", { className: "soft" }, control.kind === "shared" ? "tint" : "RGB")));
    const show = (active) => {
      const now = state();
      solo.setAttribute("aria-pressed", String(now.isSolo));
      mute.setAttribute("aria-pressed", String(now.isMuted));
      element.classList.toggle("off", !this.relight.isOn(i));
      reset.disabled = now.isAtRest();
      const put = (input, value) => { if (input !== active) input.value = value; };
      put(slider, now.stops);
      put(stops, Number(now.stops.toFixed(2)));
      put(swatch, srgb.text(now.color));
      numbers.forEach((input, k) => put(input, Number(now.color[k].toPrecision(4))));
    };
    return { element, show };
  }

  /** Changes the settings and shows the frame by them, soon. `active`: the control that is being used. */
  set(change, active = null) {
    change();
    this.active = active;
    if (this.frame === 0) this.frame = requestAnimationFrame(() => { this.frame = 0; this.update(this.active); });
  }

  update(active = null) {
    const { relight, pair } = this;
    if (!relight || relight.lights.entry !== relight.entry) return;
    for (const row of this.rows) row?.show(active);
    const isAtRest = relight.isAtRest();
    this.note.textContent = isAtRest ? "" : "changed";
    this.resetButton.disabled = isAtRest;
    this.saved.textContent = "";
    this.step.hidden = isAtRest;
    if (!isAtRest) this.fillStep();
    if (pair.sides?.b.label === this.data.labels[this.entry] && !pair.previews.b) {
      const start = performance.now(), relit = relight.applyTo(pair.buffers.b);
      document.documentElement.dataset.relightMs = (performance.now() - start).toFixed(1);
      pair.setRelit(relit === pair.buffers.b ? null : relit);
    }
    document.documentElement.dataset.relit = isAtRest ? "" : String(this.entry);
  }

  fillStep() {
    const step = this.relight.step(`${this.data.steps[this.entry].name}, relit`);
    for (const button of this.stepButtons) button.disabled = step === null;
    this.text.value = step === null ? "The way to this frame of a drag has too many edits: relight the drag's last frame." : words.json(step);
  }

  async copy() {
    try {
      await navigator.clipboard.writeText(this.text.value);
      this.saved.textContent = "copied";
    } catch {
      this.text.select();
      this.saved.textContent = document.execCommand("copy") ? "copied" : "selected: copy it by hand";
    }
  }

  download() {
    const url = URL.createObjectURL(new Blob([`${this.text.value}\n`], { type: "application/json" }));
    const link = page.element("a", { href: url, download: `${this.data.steps[this.entry].stem}_relit.json` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
    this.saved.textContent = `downloaded as ${link.download}`;
  }
}
Relight.mostStops = 8;
