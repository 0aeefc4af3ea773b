"use strict";
// Two frames on one canvas: wipe, blink, side by side or one of them; zoom, pan, overlays, and the pixel pointed at.

/** The white pixels of an image, an overlay's outlines, on black: the frame below them is already there. */
function whiteParts(image) {
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  context.filter = "invert(1) brightness(255) grayscale(1) brightness(255) invert(1)";
  context.drawImage(image, 0, 0);
  return canvas;
}

class Viewer {
  /** Calls onPixel(x, y) when the pixel changes, and onChange() when zoom, mode or wipe do. */
  constructor(canvas, { onPixel, onChange }) {
    Object.assign(this, { canvas, onPixel, onChange });
    this.before = document.createElement("canvas");
    this.after = document.createElement("canvas");
    this.difference = document.createElement("canvas");
    this.overlays = [];  // canvases of the size of the frame: white outlines on black
    this.showsDifference = false;
    this.mode = "wipe";
    this.wipe = 0.5;  // of the view's width
    this.scale = 1;  // CSS pixels a pixel
    this.isFitted = true;
    this.center = { x: 0, y: 0 };  // the pixel in the middle of a panel
    this.pixel = null;
    this.blinkShowsAfter = true;
    new ResizeObserver(() => this.resize()).observe(canvas);
    document.addEventListener("scheme", () => this.draw());
    setInterval(() => this.blink(), 600);
    this.listen();
  }

  setMode(mode) {
    this.mode = mode;
    this.blinkShowsAfter = true;
    if (this.isFitted) this.fit();
    else this.changed();
  }

  /** New contents of before, after, difference or overlays. Sized anew, the canvas forgets files that it showed. */
  refresh() {
    this.resize();
    if (this.isFitted) this.fit();
    else this.changed();
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
    this.center = { x: this.after.width / 2, y: this.after.height / 2 };
    this.scale = Math.min(panel.width / this.after.width, panel.height / this.after.height) || 1;
    this.changed();
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
    this.changed();
  }

  setWipe(wipe) {
    this.wipe = Math.min(1, Math.max(0, wipe));
    this.changed();
  }

  /** Selects a pixel and, when it is out of view, brings it there. */
  setPixel(x, y) {
    this.pixel = {
      x: Math.min(this.after.width - 1, Math.max(0, x)),
      y: Math.min(this.after.height - 1, Math.max(0, y)),
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

  changed() {
    this.draw();
    this.onChange();
  }

  blink() {
    if (this.mode !== "blink" || this.canvas.clientWidth === 0) return;
    this.blinkShowsAfter = !this.blinkShowsAfter;
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
    if (width === 0 || this.after.width === 0) return;
    const context = this.canvas.getContext("2d"), ratio = this.canvas.width / width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const panels = this.panels(), line = this.wipe * width;
    if (this.mode === "side") {
      this.drawImage(context, this.before, panels[0], 0, panels[0].width);
      this.drawImage(context, this.after, panels[1], 0, panels[1].width);
      this.label(context, "before", panels[0].x + 8, "left");
      this.label(context, "after", panels[1].x + 8, "left");
    } else if (this.mode === "wipe") {
      this.drawImage(context, this.before, panels[0], 0, line);
      this.drawImage(context, this.after, panels[0], line, width);
      context.fillStyle = "#000";
      context.fillRect(line - 1.5, 0, 3, height);
      context.fillStyle = "#fff";
      context.fillRect(line - 0.5, 0, 1, height);
      this.label(context, "before", line - 8, "right");
      this.label(context, "after", line + 8, "left");
    } else {
      const isAfter = this.mode === "after" || (this.mode === "blink" && this.blinkShowsAfter);
      this.drawImage(context, isAfter ? this.after : this.before, panels[0], 0, width);
      this.label(context, isAfter ? "after" : "before", 8, "left");
    }
  }

  /** A panel's image, between two places of the panel. */
  drawImage(context, image, panel, from, to) {
    const x = panel.x + panel.width / 2 - this.center.x * this.scale;
    const y = panel.height / 2 - this.center.y * this.scale;
    const width = this.after.width * this.scale, height = this.after.height * this.scale;
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
    if (this.showsDifference) context.drawImage(this.difference, x, y, width, height);
    if (this.pixel) this.markPixel(context, x, y);
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

  label(context, text, x, align) {
    context.font = "12px system-ui, sans-serif";
    context.textAlign = align;
    const width = context.measureText(text).width + 10;
    context.fillStyle = "rgb(0 0 0 / 65%)";
    context.fillRect(align === "left" ? x - 5 : x - width + 5, 6, width, 20);
    context.fillStyle = "#fff";
    context.fillText(text, x, 20);
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
    return x >= 0 && y >= 0 && x < this.after.width && y < this.after.height ? { x, y } : null;
  }

  isOnWipe(point) {
    return this.mode === "wipe" && Math.abs(point.x - this.wipe * this.canvas.clientWidth) < 7;
  }

  listen() {
    const { canvas } = this;
    const place = (event) => ({ x: event.offsetX, y: event.offsetY });
    let drag = null;
    canvas.addEventListener("pointerdown", (event) => {
      const point = place(event);
      drag = { ...point, isWipe: this.isOnWipe(point) };
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      const point = place(event);
      canvas.classList.toggle("on-wipe", drag ? drag.isWipe : this.isOnWipe(point));
      canvas.classList.toggle("panning", drag !== null && !drag.isWipe);
      if (drag?.isWipe) {
        this.setWipe(point.x / canvas.clientWidth);
      } else if (drag) {
        this.center.x -= (point.x - drag.x) / this.scale;
        this.center.y -= (point.y - drag.y) / this.scale;
        if (point.x !== drag.x || point.y !== drag.y) this.isFitted = false;
        Object.assign(drag, point);
        this.draw();
      } else {
        const pixel = this.pixelAt(point);
        if (pixel) {
          this.pixel = pixel;
          this.draw();
          this.onPixel(pixel.x, pixel.y);
        }
      }
    });
    const end = () => {
      drag = null;
      canvas.classList.remove("panning");
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(this.scale * 2 ** (-event.deltaY / 240), place(event));
    }, { passive: false });
    canvas.addEventListener("dblclick", (event) => {
      if (this.isFitted) this.zoom(1, place(event));
      else this.fit();
    });
  }
}
