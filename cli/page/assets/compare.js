"use strict";
// The page of a comparison: A against B for each frame that differs, the worst first, in the viewer that runs have.

function imageOf(url) {
  return new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = () => reject(new Error("a preview cannot be read"));
    image.src = url;
  });
}

class Comparison {
  constructor(frames, exposure) {
    this.frames = frames;
    this.number = 0;
    page.byId("compare").hidden = false;
    document.querySelector("#stage .pair").hidden = true;  // A and B are what was compared
    this.pair = new PairView(frames[0].layout, exposure, { onState: () => this.saveLink(), onSwipe: (by) => this.show(this.number + by) });
    this.buttons = frames.map(({ title, verdict }, i) => page.button(`${title}: ${verdict}`, () => this.show(i)));
    page.byId("compare-list").append(...this.buttons);
    addEventListener("keydown", (event) => this.press(event));
    addEventListener("hashchange", () => this.readLink());
    this.readLink();
  }

  readLink() {
    const values = new URLSearchParams(location.hash.slice(1)), number = this.frames.findIndex(({ title }) => title === values.get("frame"));
    this.pair.fromLink(values);
    this.show(Math.max(0, number));
  }

  saveLink() {
    if (!this.pair) return;
    link.replace(() => link.text("frame", this.frames[this.number].title, this.pair.toLink()));
  }

  /** The linear pixels of a side: tiles as in the page of a run, all from one record. */
  side(frame, number) {
    const key = number === 0 ? "a" : "b", { layout, pixels } = frame;
    frame.frames ??= pixels && new RunFrames(layout, pixels.map(([count, sizes, base64], i) => [i, [0, count], sizes, base64]),
      { sources: async (entry, count) => new Int32Array(count).fill(entry) });
    return {
      label: key.toUpperCase(), name: frame.names[number], file: frame.names[number],
      fill: (buffer) => (pixels ? frame.frames.fill(buffer, number) : false), preview: () => imageOf(frame.previews[number]),
    };
  }

  show(number) {
    this.number = Math.min(this.frames.length - 1, Math.max(0, number));
    const frame = this.frames[this.number], { pair } = this;
    this.buttons.forEach((button, i) => button.setAttribute("aria-pressed", String(i === this.number)));
    page.byId("compare-name").textContent = frame.title;
    page.byId("compare-facts").replaceChildren(page.table(frame.facts));
    page.byId("compare-errors").src = frame.errors;
    page.byId("compare-missing").hidden = frame.pixels !== null;
    page.byId("view").style.setProperty("--frame", `${frame.layout.width} / ${frame.layout.height}`);
    pair.buffers = { a: new FrameBuffer(frame.layout), b: new FrameBuffer(frame.layout) };  // frames differ in size
    pair.isHalf = pair.buffers.b.planes.R instanceof Uint16Array;
    pair.display.isHalf = pair.isHalf;
    pair.show({ a: this.side(frame, 0), b: this.side(frame, 1) }).then((isShown) => {
      if (isShown) Object.assign(document.documentElement.dataset, { painted: String(this.number), hasDifference: pair.hasPixels() });
    });
    this.saveLink();
  }

  press(event) {
    const { key, target, ctrlKey, altKey, metaKey } = event, modes = { w: "wipe", b: "blink", s: "side", 1: "a", 2: "b", f: "difference" };
    if (ctrlKey || altKey || metaKey || ["INPUT", "SELECT", "TEXTAREA"].includes(target.tagName)) return;
    if (modes[key]) this.pair.setMode(modes[key]);
    else if (key === "ArrowDown") this.show(this.number + 1);
    else if (key === "ArrowUp") this.show(this.number - 1);
    else return;
    event.preventDefault();
  }
}

page.startScheme();
{
  const { frames, exposure } = page.data("compared");
  if (frames.length > 0) globalThis.comparison = new Comparison(frames, exposure);
}
