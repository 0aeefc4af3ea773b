"use strict";
// Histogram, waveform and parade of A and B, and their numbers: of linear light in stops, or of what the display shows.
// Counted when the page is idle: of some rows while something moves, of all pixels at rest.

const scopeKinds = { histogram: "Histogram", waveform: "Waveform", parade: "RGB parade", luma: "Luma waveform" };
const scopeScales = { stops: "Stops", display: "Display" };
const scopeStops = { from: -10, to: 6 };  // over middle grey, of levels 0 to 255
const scopeColors = { rgb: [[255, 64, 64], [64, 224, 96], [80, 128, 255]], luma: [225, 225, 225] };
const roughPixels = 300000;  // counted while something moves

/** Levels of light, by the upper 17 bits of a float32. */
const stopLevels = new Uint8Array(131072);
{
  const light = new Float32Array(Uint32Array.from({ length: 131072 }, (_, i) => i << 15).buffer);
  const perStop = 256 / (scopeStops.to - scopeStops.from);
  for (let i = 0; i < 65536; ++i) stopLevels[i] = Math.min(255, Math.max(0, Math.floor((stopsOf(light[i]) - scopeStops.from) * perStop) || 0));
}

function levelOf(light) {
  curveBits.float[0] = light;
  return stopLevels[curveBits.uint[0] >>> 15];
}

/** How often each level comes: `histogram` [4 * 256], of R, G, B and luma; `waveform` [4 * 256][columns]. */
class ScopeCounts {
  constructor(region, stride) {
    const perColumn = Math.ceil(region.width / 400);
    Object.assign(this, { region, stride, columns: Math.ceil(region.width / perColumn), rows: Math.ceil(region.height / stride) });
    this.histogram = new Int32Array(4 * 256);
    this.waveform = new Int32Array(4 * this.columns * 256);
    this.columnOf = Uint32Array.from({ length: region.width }, (_, x) => Math.floor(x / perColumn));
  }

  /** `take(channel, start, levels)` gives the levels of pixels from `start` on, of R, G, B and then luma. */
  count(width, take) {
    const { region, stride, waveform, columnOf, columns } = this, levels = new Uint8Array(region.width);
    for (let y = region.y; y < region.y + region.height; y += stride) {
      for (let channel = 0; channel < 4; ++channel) {
        take(channel, y * width + region.x, levels);
        for (let x = 0, from = channel * 256; x < levels.length; ++x) ++waveform[(from + levels[x]) * columns + columnOf[x]];
      }
    }
    for (let i = 0; i < waveform.length; ++i) this.histogram[Math.floor(i / columns)] += waveform[i];
    return this;
  }

  static of(buffer, display, scale, region, stride) {
    const counts = new ScopeCounts(region, stride), { width, height } = buffer;
    if (scale === "stops") return counts.count(width, ScopeCounts.stopsTaker(buffer, display.look(), region.width));
    const { codes, isUpsideDown } = display.codes(buffer);
    return counts.count(width, (channel, start, levels) => {
      const row = Math.floor(start / width), from = 4 * (isUpsideDown ? start + (height - 1 - 2 * row) * width : start);
      for (let x = 0, i = from; x < levels.length; ++x, i += 4)
        levels[x] = channel < 3 ? codes[i + channel] : (54 * codes[i] + 183 * codes[i + 1] + 19 * codes[i + 2] + 128) >> 8;
    });
  }

  static stopsTaker(buffer, look, width) {
    const light = new FrameLight(buffer, look.tables), rows = Array.from({ length: 3 }, () => new Float32Array(width));
    const luma = new Float32Array(width), bits = new Uint32Array(luma.buffer), [red, green, blue] = lumaWeights, [r, g, b] = rows;
    const byHalf = light.isHalf ? Uint8Array.from(look.tables.light, (value) => levelOf(value)) : null;
    return (channel, start, levels) => {
      if (channel < 3) light.takeLight(channel, start, rows[channel]);
      if (channel < 3 && byHalf) {
        const plane = light.planes[channel];
        for (let x = 0; x < width; ++x) levels[x] = byHalf[plane[start + x]];
        return;
      }
      if (channel < 3) luma.set(rows[channel]);
      else for (let x = 0; x < width; ++x) luma[x] = red * r[x] + green * g[x] + blue * b[x];
      for (let x = 0; x < width; ++x) levels[x] = stopLevels[bits[x] >>> 15];
    };
  }
}

/** Draws counts on a canvas of its CSS size. */
class ScopePicture {
  constructor(canvas, counts, kind, scale) {
    const ratio = window.devicePixelRatio || 1;
    this.width = canvas.clientWidth;
    this.height = canvas.clientHeight;
    Object.assign(canvas, { width: Math.round(this.width * ratio), height: Math.round(this.height * ratio) });
    this.context = canvas.getContext("2d");
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.context.fillStyle = "#101113";
    this.context.fillRect(0, 0, this.width, this.height);
    const channels = kind === "luma" ? [3] : [0, 1, 2];
    if (kind === "histogram") this.histogram(counts);
    else if (kind === "parade") channels.forEach((channel, i) => this.waveform(counts, [channel], this.width * i / 3, this.width / 3 - 2));
    else this.waveform(counts, channels, 0, this.width);
    this.grid(kind === "histogram", scale);
  }

  histogram({ histogram }) {
    const { context, width, height } = this, inner = [0, 1, 2, 3].flatMap((channel) => [...histogram.subarray(channel * 256 + 1, channel * 256 + 255)]);
    const most = Math.max(1, ...inner, inner.some((count) => count > 0) ? 1 : Math.max(...histogram));
    const outline = (channel) => {
      context.beginPath();
      context.moveTo(0, height);
      for (let level = 0; level < 256; ++level) {
        const y = height - Math.min(1, Math.sqrt(histogram[channel * 256 + level] / most)) * (height - 16);
        context.lineTo(width * level / 256, y);
        context.lineTo(width * (level + 1) / 256, y);
      }
      context.lineTo(width, height);
    };
    context.globalCompositeOperation = "lighter";
    for (const channel of [0, 1, 2]) {
      outline(channel);
      context.fillStyle = `rgb(${scopeColors.rgb[channel].join(" ")} / 42%)`;
      context.fill();
    }
    context.globalCompositeOperation = "source-over";
    outline(3);
    context.strokeStyle = `rgb(${scopeColors.luma.join(" ")} / 75%)`;
    context.stroke();
  }

  /** Channels over each other, in a part of the picture. */
  waveform(counts, channels, left, width) {
    const { columns } = counts, image = new ImageData(columns, 256), { data } = image;
    const perColumn = counts.rows * counts.region.width / columns;
    for (const channel of channels) {
      const color = channel === 3 ? scopeColors.luma : scopeColors.rgb[channel];
      for (let level = 0; level < 256; ++level) {
        for (let column = 0; column < columns; ++column) {
          const count = counts.waveform[(channel * 256 + level) * columns + column];
          if (count === 0) continue;
          const bright = Math.min(1, 0.15 + Math.sqrt(24 * count / perColumn)), place = 4 * ((255 - level) * columns + column);
          for (let k = 0; k < 3; ++k) data[place + k] += bright * color[k];
        }
      }
    }
    for (let i = 3; i < data.length; i += 4) data[i] = 255;
    const canvas = document.createElement("canvas");
    Object.assign(canvas, { width: columns, height: 256 });
    canvas.getContext("2d").putImageData(image, 0, 0);
    this.context.globalCompositeOperation = "lighter";
    this.context.drawImage(canvas, left, 0, width, this.height);
    this.context.globalCompositeOperation = "source-over";
  }

  grid(isAcross, scale) {
    const { context, width, height } = this, { from, to } = scopeStops;
    const lines = scale === "stops" ? [-8, -6, -4, -2, 0, 2, 4].map((stops) => [(stops - from) / (to - from), stops > 0 ? `+${stops}` : String(stops)])
      : [0.25, 0.5, 0.75].map((part) => [part, `${100 * part} %`]);
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "left";
    for (const [place, text] of lines) {
      const isMiddle = text === "0";
      context.fillStyle = `rgb(255 255 255 / ${isMiddle ? 45 : 18}%)`;
      if (isAcross) context.fillRect(Math.round(width * place), 0, 1, height);
      else context.fillRect(0, Math.round(height * (1 - place)), width, 1);
      context.fillStyle = "#d8d8d8";
      context.fillText(text, isAcross ? Math.round(width * place) + 3 : 3, isAcross ? 11 : Math.round(height * (1 - place)) - 2);
    }
  }
}

class Scopes {
  constructor(element, display, regionTool = null) {
    Object.assign(this, { element, display, regionTool, sides: { a: null, b: null, region: null }, names: {} });
    this.isOpen = false;
    this.kind = "histogram";
    this.scale = "stops";
    this.timer = 0;
    this.frame = 0;
    element.hidden = false;
    this.build();
    this.observer = new ResizeObserver(() => this.schedule(true));
    this.observer.observe(this.pair);
  }

  build() {
    const select = (setting, name, names) => {
      const options = Object.entries(names).map(([value, text]) => page.element("option", { value }, text));
      const control = page.element("select", { id: `scope-${setting}`, "aria-label": name }, ...options);
      control.addEventListener("change", () => {
        this[setting] = control.value;
        this.schedule(true);
      });
      return control;
    };
    this.toggleButton = page.element("button", { type: "button", id: "scopes-button", title: "Scopes (h)" }, "Scopes");
    this.toggleButton.addEventListener("click", () => this.toggle());
    this.controls = page.element("div", {}, select("kind", "Scope", scopeKinds), select("scale", "Scale", scopeScales));
    this.regionButton = page.element("button", { type: "button", id: "region-button", title: "Drag a region (or Shift and drag, or q at two corners)" }, "Region");
    this.regionButton.addEventListener("click", () => this.useRegion(!this.regionTool.isActive));
    this.wholeButton = page.element("button", { type: "button", id: "region-clear" }, "Whole frame");
    this.wholeButton.addEventListener("click", () => this.regionTool.set(null));
    this.canvases = {};
    this.captions = {};
    const figure = (side) => {
      this.canvases[side] = page.element("canvas", { role: "img", id: `scope-${side}` });
      this.captions[side] = page.element("figcaption", {});
      return page.element("figure", {}, this.captions[side], this.canvases[side]);
    };
    this.pair = page.element("div", { className: "scope-pair" }, figure("a"), figure("b"));
    this.numbers = page.element("div", { id: "scope-numbers", role: "group", "aria-label": "Numbers", tabIndex: 0 });  // it scrolls
    this.element.append(page.element("div", { className: "tools" }, this.toggleButton, this.controls, this.regionButton, this.wholeButton),
      this.pair, this.numbers);
    this.showControls();
  }

  toggle() {
    this.isOpen = !this.isOpen;
    this.showControls();
    this.schedule(true);
  }

  /** Whether dragging in the frame draws a region. */
  useRegion(isActive) {
    this.regionTool.isActive = isActive;
    this.regionTool.viewer.canvas.classList.toggle("region", isActive);
    this.showControls();
  }

  showControls() {
    this.toggleButton.textContent = `${this.isOpen ? "▾" : "▸"} Scopes`;
    this.toggleButton.setAttribute("aria-expanded", String(this.isOpen));
    this.controls.hidden = this.pair.hidden = !this.isOpen;
    this.regionButton.hidden = !this.regionTool;
    this.regionButton.setAttribute("aria-pressed", String(this.regionTool?.isActive ?? false));
    this.wholeButton.hidden = !this.sides.region;
    this.numbers.hidden = !this.isOpen && !this.sides.region;
  }

  /** `a`, `b`: FrameBuffers, or null where the page has no pixels; `region`: {x, y, width, height}, or null. `isMoving`:
      more calls follow soon. `names`: of the sides. */
  show({ a = null, b = null, region = null, names = this.names, isMoving = false }) {
    this.sides = { a, b, region };
    this.names = names;
    this.showControls();
    this.schedule(!isMoving);
  }

  /** Some rows now, all of them when nothing has come for a while. */
  schedule(isAtRest) {
    cancelAnimationFrame(this.frame);
    clearTimeout(this.timer);
    if (this.numbers.hidden) return;
    this.element.dataset.state = "waiting";
    this.frame = requestAnimationFrame(() => {
      const [isExact] = [...this.draw(false)].slice(-1);
      if (!isExact) this.timer = setTimeout(() => this.continue(this.draw(true)), isAtRest ? 60 : 250);
    });
  }

  /** One side after the other, so that the page answers between them. */
  continue(steps) {
    if (!steps.next().done) this.timer = setTimeout(() => this.continue(steps));
  }

  /** Yields false after parts of its work, at last whether it has counted all pixels. */
  * draw(isExact) {
    const { a, b, region } = this.sides, buffer = b ?? a, look = this.display.look(), numbers = { a: null, b: null };
    if (!buffer || this.element.clientWidth === 0) {
      yield true;
      return;
    }
    const place = region ?? wholeFrame(buffer), pixels = place.width * place.height;
    const stride = isExact ? 1 : Math.max(1, Math.min(place.height, Math.ceil(pixels / roughPixels)));
    for (const side of ["a", "b"]) {
      if (this.sides[side]) numbers[side] = regionNumbers(this.sides[side], look, place, stride);
      if (this.isOpen) this.drawSide(side, numbers[side], place, stride);
      yield false;
    }
    const where = region ? `Region at ${region.x}, ${region.y}, ${region.width} × ${region.height} pixels` : "Whole frame";
    this.numbers.replaceChildren(numbersTable(`${where}: linear values, EV as exposed`, numbers, look),
      page.element("p", {}, ["a", "b"].filter((side) => numbers[side]).map((side) => marksText(side, numbers[side], look)).join(". ")));
    this.element.dataset.state = stride === 1 ? "exact" : "rough";
    yield stride === 1;
  }

  drawSide(side, numbers, region, stride) {
    const canvas = this.canvases[side], buffer = this.sides[side], name = this.names[side] ? ` ${this.names[side]}` : "";
    this.captions[side].textContent = `${side.toUpperCase()}${name}${buffer ? "" : ": its pixels are not in this page"}`;
    canvas.hidden = !buffer;
    if (!buffer) return;
    this.counts ??= {};
    this.counts[side] = ScopeCounts.of(buffer, this.display, this.scale, region, stride);
    new ScopePicture(canvas, this.counts[side], this.kind, this.scale);
    const { mean, max } = numbers.channels[3], gain = this.display.gain();
    canvas.setAttribute("aria-label", `${scopeKinds[this.kind]} of ${side.toUpperCase()}: luma ${shortNumber(mean)} on average `
      + `(${stopsText(mean, gain)} EV), ${shortNumber(max)} at most; ${marksText(side, numbers, this.display.look())}`);
  }
}
