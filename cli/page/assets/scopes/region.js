"use strict";
// Numbers of a region of two frames, or of all of them, and the tool that draws regions: Shift and drag, its button, or
// the key q at two corners.

const wholeFrame = ({ width, height }) => ({ x: 0, y: 0, width, height });

/** Of R, G, B and luma {min, mean, max}, of linear values as the frame has them; and how many pixels are `above` the
    display's white, `below` zero, `undefined`. `stride`: of every such row. */
function regionNumbers(buffer, look, region, stride = 1) {
  const light = new FrameLight(buffer, look.tables), { x, y, width, height } = region;
  const rows = Array.from({ length: 4 }, () => new Float32Array(width)), white = look.curve.white / look.gain;
  const sums = rows.map(() => ({ min: Infinity, sum: 0, max: -Infinity })), marks = { above: 0, below: 0, undefined: 0 };
  let pixels = 0;
  for (let row = y; row < y + height; row += stride) {
    for (let channel = 0; channel < 3; ++channel) light.takeValues(channel, row * buffer.width + x, rows[channel]);
    takeLuma(rows);
    countMarks(rows, white, marks);
    rows.forEach((values, channel) => addNumbers(values, sums[channel]));
    pixels += width;
  }
  const count = pixels - marks.undefined;
  return { channels: sums.map(({ min, sum, max }) => ({ min, mean: count > 0 ? sum / count : NaN, max })), marks, pixels };
}

/** The fourth row from the three others; of a pixel that is no number in one of them all become none. */
function takeLuma([r, g, b, luma]) {
  const [red, green, blue] = lumaWeights;
  for (let i = 0; i < luma.length; ++i) {
    luma[i] = red * r[i] + green * g[i] + blue * b[i];
    if (luma[i] !== luma[i] && (r[i] !== r[i] || g[i] !== g[i] || b[i] !== b[i])) r[i] = g[i] = b[i] = NaN;
  }
}

function countMarks([r, g, b], white, marks) {
  let above = 0, below = 0, none = 0;
  for (let i = 0; i < r.length; ++i) {
    if (r[i] !== r[i]) ++none;
    else if (r[i] < 0 || g[i] < 0 || b[i] < 0) ++below;
    else if (r[i] > white || g[i] > white || b[i] > white) ++above;
  }
  marks.above += above;
  marks.below += below;
  marks.undefined += none;
}

function addNumbers(values, sums) {
  let { min, sum, max } = sums;
  for (let i = 0; i < values.length; ++i) {
    const value = values[i];
    if (value < min) min = value;
    if (value > max) max = value;
    if (value === value) sum += value;
  }
  Object.assign(sums, { min, sum, max });
}

/** A number in a table. */
function shortNumber(value) {
  return Number.isFinite(value) ? String(Number(value.toPrecision(4))) : String(value);
}

/** Stops over middle grey of a luma, exposed. */
function stopsText(luma, gain) {
  const stops = stopsOf(luma * gain);
  return luma > 0 ? `${stops >= 0 ? "+" : "−"}${Math.abs(stops).toFixed(2)}` : "–";
}

/** Rows of two frames' numbers: `numbers`: {a, b}, either may be null. */
function numbersTable(caption, numbers, look) {
  const head = page.element("tr", {}, page.element("td"), ...["R", "G", "B", "Luma", "EV"].map((name) => page.element("th", { scope: "col" }, name)));
  const rows = [];
  for (const side of ["a", "b"]) {
    if (!numbers[side]) continue;
    for (const kind of ["min", "mean", "max"]) {
      const cells = numbers[side].channels.map((channel) => shortNumber(channel[kind]));
      cells.push(stopsText(numbers[side].channels[3][kind], look.gain));
      rows.push(page.element("tr", { "data-row": `${side}-${kind}` }, page.element("th", { scope: "row" }, `${side.toUpperCase()} ${kind}`),
        ...cells.map((text) => page.element("td", { className: "number" }, text))));
    }
  }
  return page.element("table", {}, page.element("caption", {}, caption), page.element("thead", {}, head), page.element("tbody", {}, ...rows));
}

/** "A: 2.1 % above display white, 0.3 % below zero" */
function marksText(side, { marks, pixels }, look) {
  const part = (count) => `${Number((100 * count / pixels).toPrecision(2))} %`;
  const isKnown = Number.isFinite(look.curve.white);
  const parts = Object.entries(clippingMarks).filter(([key]) => marks[key] > 0 && (key !== "above" || isKnown))
    .map(([key, { name }]) => `${part(marks[key])} ${name}`);
  return `${side.toUpperCase()}: ${parts.join(", ") || "nothing clipped"}`;
}

class RegionTool {
  /** Calls onRegion(region or null, isDragging). */
  constructor(viewer, onRegion) {
    Object.assign(this, { viewer, onRegion, region: null, start: null, isActive: false });
    const listen = (kind, work) => viewer.canvas.addEventListener(kind, work, { capture: true });
    listen("pointerdown", (event) => this.down(event));
    listen("pointermove", (event) => this.move(event));
    listen("pointerup", (event) => this.up(event));
    listen("pointercancel", (event) => this.up(event));
    viewer.marks = (context, x, y) => this.draw(context, x, y);
  }

  /** The pixel under a pointer, or the nearest one. */
  pixel(event) {
    const box = this.viewer.canvas.getBoundingClientRect(), { viewer } = this;
    const panel = viewer.panelAt(event.clientX - box.x), { width, height } = viewer.b;
    const place = (offset, middle, center) => Math.floor(center + (offset - middle) / viewer.scale);
    return {
      x: Math.min(width - 1, Math.max(0, place(event.clientX - box.x, panel.x + panel.width / 2, viewer.center.x))),
      y: Math.min(height - 1, Math.max(0, place(event.clientY - box.y, panel.height / 2, viewer.center.y))),
    };
  }

  down(event) {
    if (!(event.shiftKey || this.isActive) || event.button !== 0 || !event.isPrimary) return;
    event.stopImmediatePropagation();
    this.viewer.canvas.setPointerCapture(event.pointerId);
    this.start = this.pixel(event);
    this.isMoved = false;
  }

  move(event) {
    if (!this.start) return;
    event.stopImmediatePropagation();
    this.isMoved = true;
    this.set(RegionTool.between(this.start, this.pixel(event)), true);
  }

  /** A click without a move takes the region away. */
  up(event) {
    if (!this.start) return;
    event.stopImmediatePropagation();
    this.start = null;
    this.set(this.isMoved ? this.region : null);
  }

  static between(first, second) {
    const x = Math.min(first.x, second.x), y = Math.min(first.y, second.y);
    return { x, y, width: Math.abs(first.x - second.x) + 1, height: Math.abs(first.y - second.y) + 1 };
  }

  set(region, isDragging = false) {
    this.region = region;
    this.viewer.draw();
    this.onRegion(region, isDragging);
  }

  /** By keys: one corner, the other, none. */
  markCorner() {
    const corner = this.viewer.pixel ?? { x: this.viewer.b.width >> 1, y: this.viewer.b.height >> 1 };
    if (this.corner) this.set(RegionTool.between(this.corner, corner));
    else this.set(this.region ? null : { ...corner, width: 1, height: 1 });
    this.corner = this.corner || !this.region ? null : corner;
  }

  draw(context, x, y) {
    if (!this.region) return;
    const { scale } = this.viewer, { region } = this;
    context.lineWidth = 1;
    for (const [color, grow] of [["#000", 1.5], ["#fff", 0.5]]) {
      context.strokeStyle = color;
      context.strokeRect(x + region.x * scale - grow, y + region.y * scale - grow, region.width * scale + 2 * grow, region.height * scale + 2 * grow);
    }
  }

  /** "12,30,40,20", or "". */
  toLink() {
    return this.region ? [this.region.x, this.region.y, this.region.width, this.region.height].join() : "";
  }

  fromLink(text, { width, height }) {
    const [x, y, w, h] = text.split(",").map(Number);
    const holds = [x, y, w, h].every(Number.isInteger) && x >= 0 && y >= 0 && w > 0 && h > 0 && x + w <= width && y + h <= height;
    this.corner = null;
    this.set(holds ? { x, y, width: w, height: h } : null);
  }
}
