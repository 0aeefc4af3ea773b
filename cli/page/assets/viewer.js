"use strict";
// Two frames, A and B, on one canvas: wipe, blink, side by side, one of them or their difference; zoom, pan, overlays,
// and the pixel pointed at. viewer_input.js has mouse and touch.

/** The white pixels of an image, an overlay's outlines, in a colour on black: the frame below them is already there. */
function outlines(image, color) {
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  context.filter = "invert(1) brightness(255) grayscale(1) brightness(255) invert(1)";
  context.drawImage(image, 0, 0);
  context.filter = "none";
  context.globalCompositeOperation = "multiply";
  context.fillStyle = color;
  context.fillRect(0, 0, canvas.width, canvas.height);
  return canvas;
}

class Viewer {
  /** Calls onPixel(x, y) when the pixel changes, onChange() when zoom, mode or wipe do, and onSwipe(1 or -1). */
  constructor(canvas, { onPixel, onChange, onSwipe }) {
    Object.assign(this, { canvas, onPixel, onChange, onSwipe });
    this.a = document.createElement("canvas");
    this.b = document.createElement("canvas");
    this.difference = document.createElement("canvas");  // of A and B, for its mode
    this.changed = document.createElement("canvas");  // the pixels of which any bit differs, over clear ones
    this.names = { a: "A", b: "B", difference: "" };  // on the labels
    this.overlays = [];  // canvases of the size of the frame: outlines on black
    this.showsChanged = false;
    this.mode = "wipe";
    this.wipe = 0.5;  // of the view's width
    this.scale = 1;  // CSS pixels a pixel
    this.isFitted = true;
    this.center = { x: 0, y: 0 };  // the pixel in the middle of a panel
    this.pixel = null;
    this.marks = null;  // draws over each panel's image, given its place
    this.blinkShowsB = true;
    new ResizeObserver(() => this.resize()).observe(canvas);
    document.addEventListener("scheme", () => this.draw());
    setInterval(() => this.blink(), 600);
    this.input = new ViewerInput(this);
  }

  setMode(mode) {
    this.mode = mode;
    this.blinkShowsB = true;
    if (this.isFitted) this.fit();
    else this.change();
  }

  /** New contents of A, B, difference or overlays. Sized anew, the canvas forgets files that it showed. */
  refresh() {
    this.resize();
    if (this.isFitted) this.fit();
    else this.change();
  }

  panels() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (this.mode !== "side") return [{ x: 0, width, height }];
    const half = Math.floor(width / 2);
    return [{ x: 0, width: half - 1, height }, { x: half + 1, width: width - half - 1, height }];
  }

  fit() {
    const panel = this.panels()[0];
    this.isFitted = true;
    this.center = { x: this.b.width / 2, y: this.b.height / 2 };
    this.scale = Math.min(panel.width / this.b.width, panel.height / this.b.height) || 1;
    this.change();
  }

  /** Keeps the pixel under a point of the view, the middle without one. */
  zoom(scale, point = null) {
    const panel = this.panels()[0], limited = Math.min(64, Math.max(0.05, scale));
    const from = point ? this.panelAt(point.x) : panel;
    const dx = point ? point.x - from.x - from.width / 2 : 0, dy = point ? point.y - from.height / 2 : 0;
    this.center.x += dx / this.scale - dx / limited;
    this.center.y += dy / this.scale - dy / limited;
    this.scale = limited;
    this.isFitted = false;
    this.change();
  }

  setWipe(wipe) {
    this.wipe = Math.min(1, Math.max(0, wipe));
    this.change();
  }

  /** Selects a pixel and, when it is out of view, brings it there. */
  setPixel(x, y) {
    this.pixel = {
      x: Math.min(this.b.width - 1, Math.max(0, x)),
      y: Math.min(this.b.height - 1, Math.max(0, y)),
    };
    const panel = this.panels()[0];
    const reach = { x: panel.width / 2 / this.scale, y: panel.height / 2 / this.scale };
    for (const axis of ["x", "y"]) {
      if (this.isFitted) continue;
      this.center[axis] = Math.max(this.pixel[axis] + 1 - reach[axis], Math.min(this.pixel[axis] + reach[axis], this.center[axis]));
    }
    this.draw();
    this.onPixel(this.pixel.x, this.pixel.y);
  }

  change() {
    this.draw();
    this.onChange();
  }

  blink() {
    if (this.mode !== "blink" || this.canvas.clientWidth === 0) return;
    this.blinkShowsB = !this.blinkShowsB;
    this.draw();
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(this.canvas.clientWidth * ratio);
    this.canvas.height = Math.round(this.canvas.clientHeight * ratio);
    if (this.isFitted && this.canvas.clientWidth > 0) this.fit();
    else this.draw();
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || this.b.width === 0) return;
    const context = this.canvas.getContext("2d"), ratio = this.canvas.width / width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const panels = this.panels(), line = this.wipe * width;
    if (this.mode === "side") {
      for (const [i, side] of ["a", "b"].entries()) {
        this.drawImage(context, this[side], panels[i], 0, panels[i].width);
        this.label(context, side, panels[i].x, panels[i].x + panels[i].width, "left");
      }
    } else if (this.mode === "wipe") {
      this.drawImage(context, this.a, panels[0], 0, line);
      this.drawImage(context, this.b, panels[0], line, width);
      this.drawLine(context, line, height);
      this.label(context, "a", 0, line, "right");
      this.label(context, "b", line, width, "left");
    } else {
      const side = this.mode === "blink" ? (this.blinkShowsB ? "b" : "a") : this.mode;
      this.drawImage(context, this[side], panels[0], 0, width);
      this.label(context, side, 0, width, "left");
    }
  }

  /** The wipe's line, with a handle for fingers. */
  drawLine(context, line, height) {
    context.fillStyle = "#000";
    context.fillRect(line - 1.5, 0, 3, height);
    context.fillStyle = "#fff";
    context.fillRect(line - 0.5, 0, 1, height);
    context.beginPath();
    context.arc(line, height - 24, 9, 0, 2 * Math.PI);
    context.fill();
    context.fillStyle = "#000";
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "center";
    context.fillText("\u2194", line, height - 20);
  }

  /** A panel's image, between two places of the panel. */
  drawImage(context, image, panel, from, to) {
    const x = panel.x + panel.width / 2 - this.center.x * this.scale;
    const y = panel.height / 2 - this.center.y * this.scale;
    const width = this.b.width * this.scale, height = this.b.height * this.scale;
    context.save();
    context.beginPath();
    context.rect(panel.x + from, 0, to - from, panel.height);
    context.clip();
    context.imageSmoothingEnabled = this.scale < 1;
    context.imageSmoothingQuality = "high";
    context.drawImage(image, x, y, width, height);
    context.globalCompositeOperation = "lighten";
    for (const overlay of this.overlays) context.drawImage(overlay, x, y, width, height);
    context.globalCompositeOperation = "source-over";
    if (this.showsChanged) context.drawImage(this.changed, x, y, width, height);
    if (this.pixel) this.markPixel(context, x, y);
    this.marks?.(context, x, y);
    context.restore();
  }

  markPixel(context, x, y) {
    const size = Math.max(this.scale, 7), middle = this.scale / 2 - size / 2;
    const left = x + this.pixel.x * this.scale + middle, top = y + this.pixel.y * this.scale + middle;
    context.lineWidth = 1;
    context.strokeStyle = "#000";
    context.strokeRect(left - 1.5, top - 1.5, size + 3, size + 3);
    context.strokeStyle = "#fff";
    context.strokeRect(left - 0.5, top - 0.5, size + 1, size + 1);
  }

  /** The name of a side, in the strip from one place of the view to another, as far as it has room there. */
  label(context, side, from, to, align) {
    const prefix = side === "difference" ? "" : `${side.toUpperCase()}  `;
    context.font = "12px system-ui, sans-serif";
    let text = prefix + this.names[side];
    const room = to - from - 26;
    while (text.length > 1 && context.measureText(text).width > room) text = `${text.slice(0, -2).trimEnd()}\u2026`;
    if (text.length <= 2 && room < 20) return;
    const width = context.measureText(text).width + 12, left = align === "left" ? from + 6 : to - 6 - width;
    context.fillStyle = "rgb(0 0 0 / 70%)";
    context.fillRect(left, 6, width, 20);
    context.fillStyle = "#fff";
    context.textAlign = "left";
    context.fillText(text, left + 6, 20);
  }

  panelAt(x) {
    const panels = this.panels();
    return panels.find((panel) => x < panel.x + panel.width) ?? panels[panels.length - 1];
  }

  /** The pixel under a point of the view, or null. */
  pixelAt(point) {
    const panel = this.panelAt(point.x);
    const x = Math.floor(this.center.x + (point.x - panel.x - panel.width / 2) / this.scale);
    const y = Math.floor(this.center.y + (point.y - panel.height / 2) / this.scale);
    return x >= 0 && y >= 0 && x < this.b.width && y < this.b.height ? { x, y } : null;
  }

  isOnWipe(point, reach = 7) {
    return this.mode === "wipe" && Math.abs(point.x - this.wipe * this.canvas.clientWidth) < reach;
  }

  /** Moves the view along with a pointer. */
  pan(dx, dy) {
    this.center.x -= dx / this.scale;
    this.center.y -= dy / this.scale;
    if (dx !== 0 || dy !== 0) this.isFitted = false;
    this.draw();
  }

  point(pixel) {
    if (!pixel) return;
    this.pixel = pixel;
    this.draw();
    this.onPixel(pixel.x, pixel.y);
  }
}
