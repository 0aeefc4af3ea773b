"use strict";
// How frames are shown: exposure, curve, channel, false colours, clipping marks. By WebGL (display_gl.js) where there is
// a graphics processor, else by CanvasPainter; both show the same, and with the settings of the previews their bytes.

/** Shows linear frames on canvases without WebGL. `look`: {curve, gain, channel, falseColor, clipping, tables, lut}. */
class CanvasPainter {
  paint(buffer, look, canvas) {
    Object.assign(canvas, { width: buffer.width, height: buffer.height });
    const context = canvas.getContext("2d"), image = context.createImageData(buffer.width, buffer.height);
    CanvasPainter.fill(buffer, look, image.data);
    context.putImageData(image, 0, 0);
  }

  /** Codes of R, G, B and 255 of a frame's pixels. */
  codes(buffer, look) {
    const codes = new Uint8ClampedArray(4 * buffer.width * buffer.height);
    CanvasPainter.fill(buffer, look, codes);
    return { codes, isUpsideDown: false };
  }

  static fill(buffer, look, codes) {
    const { R, G, B } = buffer.planes, isPlain = !look.falseColor && !look.clipping && look.channel === "rgb";
    if (!isPlain || !look.curve.shown || !(R instanceof Uint16Array)) {
      new PixelPainter(buffer, look).fill(codes);
      return;
    }
    const pixels = new Uint32Array(codes.buffer), { exposed } = look.tables;
    for (let i = 0; i < pixels.length; ++i) pixels[i] = 0xff000000 | (exposed[B[i]] << 16) | (exposed[G[i]] << 8) | exposed[R[i]];
  }
}

/** Pixels of a frame of any kind, a row at a time: short loops over one kind of table are quick. */
class FrameLight {
  constructor(buffer, tables) {
    this.planes = ["R", "G", "B"].map((name) => buffer.planes[name]);
    this.isHalf = this.planes[0] instanceof Uint16Array;
    this.tables = tables;
    if (!this.isHalf) this.floats = this.planes.map((plane) => new Float32Array(plane.buffer));
  }

  /** The values of a channel, as the frame has them. */
  takeValues(channel, start, out) {
    if (!this.isHalf) {
      out.set(this.floats[channel].subarray(start, start + out.length));
      return;
    }
    const plane = this.planes[channel];
    for (let i = 0; i < out.length; ++i) out[i] = halfValues[plane[start + i]];
  }

  /** The same, exposed and bounded. */
  takeLight(channel, start, out) {
    const { gain, light } = this.tables;
    const plane = this.planes[channel], values = this.isHalf ? null : this.floats[channel];
    if (this.isHalf) for (let i = 0; i < out.length; ++i) out[i] = light[plane[start + i]];
    else for (let i = 0; i < out.length; ++i) out[i] = boundedLight(Math.fround(values[start + i] * gain));
  }

  /** Codes of a channel by a curve that needs no other; `light`: what takeLight() has given. */
  takeCodes(channel, start, light, out) {
    const { exposed, plain } = this.tables, plane = this.planes[channel];
    if (this.isHalf) for (let i = 0; i < out.length; ++i) out[i] = exposed[plane[start + i]];
    else for (let i = 0; i < out.length; ++i) out[i] = plain[halfBitsOf(light[i])];
  }
}

/** Row by row, by all settings; display_gl.js has the same in GLSL. */
class PixelPainter {
  constructor(buffer, look) {
    Object.assign(this, { buffer, look, light: new FrameLight(buffer, look.tables), color: new Float64Array(3) });
    const rows = () => Array.from({ length: 3 }, () => new Float32Array(buffer.width));
    Object.assign(this, { exposed: rows(), shown: rows(), values: rows() });
  }

  fill(codes) {
    const { width, height } = this.buffer, fillRow = this.look.channel === "A" ? this.alphaRow : this.row;
    for (let y = 0; y < height; ++y) {
      fillRow.call(this, y);
      const [r, g, b] = this.shown;
      for (let x = 0, place = 4 * y * width; x < width; ++x, place += 4) {
        codes[place] = r[x];
        codes[place + 1] = g[x];
        codes[place + 2] = b[x];
        codes[place + 3] = 255;
      }
    }
  }

  alphaRow(y) {
    for (let x = 0; x < this.buffer.width; ++x) {
      const alpha = this.buffer.value("A", x, y);
      for (const row of this.shown) row[x] = alpha > 0 ? Math.floor(255 * Math.min(1, alpha) + 0.5) : 0;
    }
  }

  /** Makes `shown` the codes of a row. */
  row(y) {
    const { light, look, exposed, shown } = this, single = "RGB".indexOf(look.channel), start = y * this.buffer.width;
    exposed.forEach((row, k) => light.takeLight(single >= 0 ? single : k, start, row));
    if (look.falseColor) this.eachColor(single >= 0, (color) => falseColor(color[0], color));
    else if (look.curve.shown && look.channel !== "luma") shown.forEach((row, k) => light.takeCodes(single >= 0 ? single : k, start, exposed[k], row));
    else if (look.curve === curves.view) this.eachColor(look.channel !== "luma", (color) => this.showView(color));
    else this.eachColor(look.channel !== "luma", (color) => this.showTables(color));
    if (look.clipping) this.mark(start, single);
  }

  /** Has `work` replace each pixel's light, of three channels or of luma, by its codes. */
  eachColor(hasChannels, work) {
    const { color } = this, [r, g, b] = this.exposed, [red, green, blue] = this.shown, [ofR, ofG, ofB] = lumaWeights;
    for (let x = 0; x < r.length; ++x) {
      if (hasChannels && !this.look.falseColor) {
        color[0] = r[x];
        color[1] = g[x];
        color[2] = b[x];
      } else {
        color[0] = color[1] = color[2] = hasChannels ? r[x] : ofR * r[x] + ofG * g[x] + ofB * b[x];
      }
      work(color);
      red[x] = color[0];
      green[x] = color[1];
      blue[x] = color[2];
    }
  }

  showView(color) {
    this.look.lut.show(color);
    for (let k = 0; k < 3; ++k) color[k] = color[k] > 0 ? Math.floor(255 * Math.min(1, color[k]) + 0.5) : 0;
  }

  showTables(color) {
    const { plain } = this.look.tables;
    if (this.look.curve === curves.neutral) neutralShown(color);
    for (let k = 0; k < 3; ++k) color[k] = plain[halfBitsOf(color[k])];
  }

  /** Where a view has no white by its light, its codes tell. */
  mark(start, single) {
    const { exposed, shown, values, look, light } = this, isView = look.curve === curves.view && !look.falseColor;
    values.forEach((row, k) => light.takeValues(single >= 0 ? single : k, start, row));
    const [r, g, b] = exposed, { white } = look.curve;
    for (let x = 0; x < r.length; ++x) {
      const isWhite = isView ? Math.max(shown[0][x], shown[1][x], shown[2][x]) >= 255 : Math.max(r[x], g[x], b[x]) > white;
      const mark = Number.isNaN(values[0][x] + values[1][x] + values[2][x]) && values.some((row) => Number.isNaN(row[x])) ? "undefined"
        : Math.min(r[x], g[x], b[x]) < 0 ? "below" : isWhite ? "above" : null;
      if (mark) for (let k = 0; k < 3; ++k) shown[k][x] = clippingMarks[mark].color[k];
    }
  }
}

const channelNames = { rgb: "RGB", luma: "Luma", R: "Red", G: "Green", B: "Blue", A: "Alpha" };

class Display {
  /** `ownExposure`: stops of the previews; exposure is beside it. `painter`: "webgl" also where that is slow, "canvas",
      or what is quick. `view`: the lattice of the previews' view in the page, or null. */
  constructor(isHalf, ownExposure, painter = "quick", view = page.byId("display-view" + page.suffix) && page.data("display-view")) {
    Object.assign(this, { isHalf, ownExposure, view, lut: null, onChange: () => {}, tables: new LightTables() });
    this.standard = { exposure: 0, curve: view ? "view" : "srgb", channel: "rgb", falseColor: false, clipping: false };
    this.settings = { ...this.standard };
    this.canvasPainter = new CanvasPainter();
    this.glPainter = painter === "canvas" ? null : GlPainter.make(painter === "webgl");
    this.ready = view ? ViewLut.of(view).then((lut) => { this.lut = lut; this.onChange(); }) : Promise.resolve();
  }

  /** What the painters need to know; `settings`: others than its own. */
  look(settings = {}) {
    const look = { ...this.settings, ...settings }, curve = curves[look.curve === "view" && !this.lut ? "srgb" : look.curve];
    this.tables.update(curve, this.gain());
    return Object.assign(look, { curve, gain: this.gain(), tables: this.tables, lut: this.lut });
  }

  /** What light is multiplied by. */
  gain() {
    return Math.fround(2 ** this.stops());
  }

  stops() {
    return Number((this.ownExposure + this.settings.exposure).toFixed(4));
  }

  paint(buffer, canvas) {
    const look = this.look();
    if (!this.glPainter?.paint(buffer, look, canvas)) this.canvasPainter.paint(buffer, look, canvas);
  }

  /** The codes of a frame by exposure and curve alone, for scopes: {codes, isUpsideDown}. */
  codes(buffer) {
    const look = this.look({ channel: "rgb", falseColor: false, clipping: false });
    return this.glPainter?.codes(buffer, look) ?? this.canvasPainter.codes(buffer, look);
  }

  /** The curves that this page has, by key. */
  curveNames() {
    const { view } = this, names = Object.entries(curves).filter(([key]) => key !== "view" || view);
    return Object.fromEntries(names.map(([key, { name }]) => [key, key === "view" ? view.name : name]));
  }

  /** Puts its controls into an element; `onChange` is called when one has changed. */
  tools(element, onChange) {
    this.onChange = onChange;
    this.controls = new DisplayControls(this, element);
    this.controls.show();
  }

  set(settings) {
    Object.assign(this.settings, settings);
    this.controls?.show();
    this.onChange();
  }

  setExposure(stops) {
    this.set({ exposure: Number.isFinite(stops) ? Math.min(8, Math.max(-8, Number(stops.toFixed(4)))) : 0 });
  }

  toggle(setting) {
    this.set({ [setting]: !this.settings[setting] });
  }

  /** To the next curve or channel. */
  next(setting) {
    const names = Object.keys(setting === "curve" ? this.curveNames() : channelNames);
    this.set({ [setting]: names[(names.indexOf(this.settings[setting]) + 1) % names.length] });
  }

  /** "0.5,filmic,luma,false,clip": what is not as at first. */
  toLink() {
    const { settings, standard } = this, parts = [];
    if (settings.exposure !== 0) parts.push(String(settings.exposure));
    for (const key of ["curve", "channel"]) if (settings[key] !== standard[key]) parts.push(settings[key]);
    if (settings.falseColor) parts.push("false");
    if (settings.clipping) parts.push("clip");
    return parts.join();
  }

  /** What it does not know it leaves out. */
  fromLink(text) {
    const settings = { ...this.standard }, names = this.curveNames();
    for (const part of text.split(",")) {
      if (part !== "" && Number.isFinite(Number(part))) settings.exposure = Math.min(8, Math.max(-8, Number(Number(part).toFixed(4))));
      else if (Object.hasOwn(names, part)) settings.curve = part;
      else if (Object.hasOwn(channelNames, part)) settings.channel = part;
      else if (part === "false") settings.falseColor = true;
      else if (part === "clip") settings.clipping = true;
    }
    this.set(settings);
  }
}

class DisplayControls {
  constructor(display, element) {
    this.display = display;
    const input = (type, step, name, id) => {
      const control = page.element("input", { type, min: -8, max: 8, step, value: 0, id, "aria-label": name });
      control.addEventListener("input", () => {
        if (type === "range" || (control.value !== "" && control.validity.valid)) display.setExposure(control.valueAsNumber);
      });
      return control;
    };
    const select = (setting, name, names) => {
      const options = Object.entries(names).map(([value, text]) => page.element("option", { value }, text));
      const control = page.element("select", { id: setting }, ...options);
      control.addEventListener("change", () => display.set({ [setting]: control.value }));
      return [control, page.element("label", {}, name, control)];
    };
    const toggle = (setting, name, key) => {
      const button = page.element("button", { type: "button", id: setting, title: `${name} (${key})` }, name);
      button.addEventListener("click", () => display.toggle(setting));
      return button;
    };
    this.slider = input("range", 0.05, "Exposure", "exposure");
    this.number = input("number", "any", "Exposure in stops", "exposure-number");
    this.number.addEventListener("change", () => this.show(true));
    this.text = page.element("span", { className: "number", id: "exposure-text" });
    let curve, channel;
    [this.curve, curve] = select("curve", "Curve", display.curveNames());
    [this.channel, channel] = select("channel", "Channel", channelNames);
    this.falseColor = toggle("falseColor", "False colour", "z");
    this.clipping = toggle("clipping", "Clipping", "k");
    this.reset = page.element("button", { type: "button", id: "display-reset", title: "As the previews are" }, "Reset");
    this.reset.addEventListener("click", () => display.set({ ...display.standard }));
    this.legend = page.element("figure", { id: "display-legend" });
    element.append(page.element("label", {}, "Exposure", this.slider), this.number, this.text, curve, channel,
      page.element("div", { role: "group", "aria-label": "Marks", className: "marks" }, this.falseColor, this.clipping), this.reset, this.legend);
  }

  /** `isEntered`: the number that is being typed is done. */
  show(isEntered = false) {
    const { display } = this, { settings, standard } = display, stops = display.stops();
    this.slider.value = settings.exposure;
    if (isEntered || document.activeElement !== this.number) this.number.value = settings.exposure;
    this.text.textContent = display.ownExposure === 0 ? "EV" : `EV, in all ${stops >= 0 ? "+" : ""}${stops} EV`;
    this.curve.value = settings.curve;
    this.channel.value = settings.channel;
    for (const key of ["falseColor", "clipping"]) this[key].setAttribute("aria-pressed", String(settings[key]));
    this.reset.disabled = Object.entries(standard).every(([key, value]) => settings[key] === value);
    this.showLegend();
  }

  showLegend() {
    const { falseColor: hasColors, clipping, curve } = this.display.settings, { view } = this.display, rows = [];
    const list = (name, entries) => page.element("ul", { "aria-label": name }, ...entries.map(([color, text]) => {
      const patch = page.element("span", { className: "patch", "aria-hidden": "true" });
      patch.style.backgroundColor = `rgb(${color.join()})`;
      return page.element("li", {}, patch, text);
    }));
    if (curve === "view" && !hasColors) {
      const codes = (value) => Number(value.toPrecision(2));
      const { mean, most, points } = view.error;
      rows.push(page.element("figcaption", {}, `Off the previews by ${codes(mean)} of 255 codes on average, by ${codes(most)} at most (${points} colours measured)`));
    }
    if (hasColors) {
      const text = (stops) => (Math.abs(stops) === 7 ? `${stops < 0 ? "≤ −" : "≥ +"}7` : stops > 0 ? `+${stops}` : String(stops).replace("-", "−"));
      rows.push(page.element("figcaption", {}, "Stops over middle grey (0.18), as exposed"),
        list("False colours", falseColors.map((color, i) => [color, text(i - 7)])));
    }
    if (clipping) rows.push(list("Clipping marks", Object.values(clippingMarks).map(({ color, name }) => [color, name])));
    this.legend.hidden = rows.length === 0;
    this.legend.replaceChildren(...rows);
  }
}
