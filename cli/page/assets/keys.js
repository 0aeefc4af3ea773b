"use strict";
// The keyboard of a run's report.

/** Keys, what they do in words, and the work, given the report and the event. */
const keys = [
  [["ArrowLeft", "ArrowRight"], "the frame before, the next one",
    (report, event) => report.move(event.key === "ArrowLeft" ? -1 : 1)],
  [["ArrowUp", "ArrowDown"], "in the sheet: a row up or down",
    (report, event) => report.moveRow(event.key === "ArrowUp" ? -1 : 1)],
  [["Home", "End"], "the first frame, the last one",
    (report, event) => report.move(event.key === "Home" ? -Infinity : Infinity)],
  [["Enter"], "open the marked frame, unfold a wedge", (report) => report.openMarked()],
  [["Escape"], "back to the sheet", (report) => report.goToPart("sheet")],
  [["a"], "pin this frame as A", (report) => report.pin(report.current())],
  [["x"], "swap A and B", (report) => report.swap()],
  [["w", "b", "s", "f"], "wipe, blink, side by side, difference",
    (report, { key }) => report.pair.setMode({ w: "wipe", b: "blink", s: "side", f: "difference" }[key])],
  [["1", "2"], "A alone, B alone", (report, event) => report.pair.setMode(event.key === "1" ? "a" : "b")],
  [["[", "]"], "wipe to the left, to the right; half or twice the difference",
    (report, event) => report.lean(event.key === "[" ? -1 : 1)],
  [["+", "=", "-"], "zoom in, in, out",
    (report, event) => report.viewer.zoom(report.viewer.scale * (event.key === "-" ? 0.5 : 2))],
  [["0", "9"], "the whole frame, one to one",
    (report, event) => (event.key === "0" ? report.viewer.fit() : report.viewer.zoom(1))],
  [["e", "E"], "half a stop brighter, darker",
    (report, event) => report.display.setExposure(report.display.settings.exposure + (event.key === "e" ? 0.5 : -0.5))],
  [["r"], "exposure as it was", (report) => report.display.setExposure(0)],
  [["v", "l"], "the next curve, the next channel or luma", (report, { key }) => report.display.next(key === "v" ? "curve" : "channel")],
  [["z", "k"], "false colours by stops, clipping marks", (report, { key }) => report.display.toggle(key === "z" ? "falseColor" : "clipping")],
  [["h"], "scopes", (report) => report.pair.scopes.toggle()],
  [["q"], "a corner of a region at the pixel read out, the other corner, no region", (report) => report.pair.region.markCorner()],
  [[" "], "play the wedge", (report) => report.play()],
  [["y", "n"], "approve, reject", (report, event) => report.reviews.toggle(report.current(), event.key === "y" ? "approved" : "rejected")],
  [["m"], "write a note", (report) => report.writeNote()],
  [["/"], "search", (report) => report.search()],
  [["t"], "cards or tree", (report) => report.sheet.change({ layout: report.sheet.settings.layout === "tree" ? "cards" : "tree" })],
  [["u"], "relight", (report) => report.relight.toggle()],
  [["c"], "changed pixels", (report) => report.pair.toggleOverlay("changed")],
  [["g"], "review or engineering", (report) => report.setView(report.view === "review" ? "engineering" : "review")],
  [["o"], "engineering: the next overlay of regions, groups or tunnels", (report) => report.pair.nextOverlay()],
  [["p"], "engineering: plots", (report) => report.goToPart("plots")],
  [["i"], "engineering: the run", (report) => report.goToPart("run")],
  [["d"], "light or dark", () => page.setScheme(page.scheme() === "dark" ? "light" : "dark")],
  [["?"], "these keys", () => page.byId("help").showModal()],
];

/** Shift and arrows: the pixel that is read out; by 10 with Alt, too. Shift and digits: stars. */
function withShift(report, event) {
  const digit = /^Digit([0-5])$/.exec(event.code)?.[1];
  if (digit !== undefined) {
    report.reviews.set(report.current(), { stars: Number(digit) });
    return true;
  }
  if (!event.key.startsWith("Arrow") || report.part !== "step") return false;
  const { viewer } = report, by = event.altKey ? 10 : 1;
  const from = viewer.pixel ?? { x: viewer.b.width >> 1, y: viewer.b.height >> 1 };
  const steps = { ArrowLeft: [-by, 0], ArrowRight: [by, 0], ArrowUp: [0, -by], ArrowDown: [0, by] };
  const [dx, dy] = steps[event.key];
  viewer.setPixel(from.x + dx, from.y + dy);
  return true;
}

/** Whether a key belongs to the control that has the focus. */
function isOfControl({ key, target }) {
  if (target.matches("textarea, select, input:not([type=range])")) return true;
  if (target.matches("input[type=range]")) return /^(Arrow|Home|End|Page)/.test(key);
  return target.matches("button, a, summary") && (key === "Enter" || key === " ");
}

function connectKeys(report) {
  const names = { " ": "Space" };
  const row = (shown, text) => page.element("tr", {}, page.element("th", { scope: "row" }, ...shown.map((name) => page.element("kbd", {}, name))),
    page.element("td", {}, text));
  const rows = keys.map(([shown, text]) => row(shown.map((name) => names[name] ?? name.replace("Arrow", "")), text));
  rows.push(row(["Shift + 0 to 5"], "stars"), row(["Shift + drag"], "a region"), row(["Shift + arrows"], "the pixel that is read out; with Alt ten pixels"));
  const close = page.button("Close", () => page.byId("help").close());
  page.byId("help").append(page.element("h2", {}, "Keys"), close, page.element("table", {}, page.element("tbody", {}, ...rows)));

  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || page.byId("help").open) return;
    if (event.key === "Escape" && event.target.matches("textarea, input, select")) {
      event.target.blur();
      return;
    }
    if (isOfControl(event)) return;
    if (!event.shiftKey || !withShift(report, event)) {
      const found = event.altKey ? null : keys.find(([shown]) => shown.includes(event.key));
      if (!found) return;
      found[2](report, event);
    }
    event.preventDefault();
  });
}
