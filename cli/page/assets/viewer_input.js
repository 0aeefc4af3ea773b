"use strict";
// Mouse and touch on the viewer: pan, wipe, zoom by wheel or with two fingers; a swipe over a fitted frame asks for the
// next one or the one before.

class ViewerInput {
  constructor(viewer) {
    Object.assign(this, { viewer, canvas: viewer.canvas, drag: null, pinch: null, fingers: new Map() });
    const { canvas } = this;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event, true));
    canvas.addEventListener("pointercancel", (event) => this.up(event, false));
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      viewer.zoom(viewer.scale * 2 ** (-event.deltaY / 240), this.place(event));
    }, { passive: false });
    canvas.addEventListener("dblclick", (event) => {
      if (viewer.isFitted) viewer.zoom(1, this.place(event));
      else viewer.fit();
    });
  }

  /** In the view; the pointer may have been captured. */
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return { x: event.clientX - box.x, y: event.clientY - box.y };
  }

  down(event) {
    const point = this.place(event), isTouch = event.pointerType === "touch";
    this.canvas.setPointerCapture(event.pointerId);
    if (isTouch) this.fingers.set(event.pointerId, point);
    if (this.fingers.size === 2) {
      this.pinch = { span: this.span(), scale: this.viewer.scale };
      this.drag = null;
      return;
    }
    const isWipe = this.viewer.isOnWipe(point, isTouch ? 24 : 7);
    this.drag = { ...point, start: point, time: event.timeStamp, isWipe, isSwipe: isTouch && !isWipe && this.viewer.isFitted };
  }

  move(event) {
    const { viewer, drag, canvas } = this, point = this.place(event);
    if (this.fingers.has(event.pointerId)) this.fingers.set(event.pointerId, point);
    if (this.pinch) {
      const [first, second] = [...this.fingers.values()];
      viewer.zoom(this.pinch.scale * this.span() / this.pinch.span, { x: (first.x + second.x) / 2, y: (first.y + second.y) / 2 });
      return;
    }
    canvas.classList.toggle("on-wipe", drag ? drag.isWipe : viewer.isOnWipe(point));
    canvas.classList.toggle("panning", drag !== null && !drag.isWipe);
    if (!drag) {
      viewer.point(viewer.pixelAt(point));
    } else if (drag.isWipe) {
      viewer.setWipe(point.x / canvas.clientWidth);
    } else if (!drag.isSwipe) {
      viewer.pan(point.x - drag.x, point.y - drag.y);
      Object.assign(drag, point);
    }
  }

  up(event, isDone) {
    const { viewer, drag } = this, point = this.place(event);
    this.fingers.delete(event.pointerId);
    this.canvas.classList.remove("panning");
    if (this.fingers.size < 2) this.pinch = null;
    this.drag = null;
    if (!drag || !isDone) return;
    const dx = point.x - drag.start.x, dy = point.y - drag.start.y;
    if (drag.isSwipe && Math.abs(dx) > 40 && Math.abs(dx) > 1.5 * Math.abs(dy)) viewer.onSwipe(dx < 0 ? 1 : -1);
    else if (drag.isSwipe && Math.hypot(dx, dy) < 10) viewer.point(viewer.pixelAt(point));
    else if (!drag.isSwipe) viewer.onChange();
  }

  /** Pixels between two fingers, not 0. */
  span() {
    const [first, second] = [...this.fingers.values()];
    return Math.max(1, Math.hypot(first.x - second.x, first.y - second.y));
  }
}
