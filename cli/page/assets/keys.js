"use strict";
// The keyboard of a run's report.

/** Keys, what they do in words, and the work, given the report and the event. */
const keys = [
  [["ArrowLeft", "ArrowRight"], "the frame before, the next one",
    (report, event) => report.move(event.key === "ArrowLeft" ? -1 : 1)],
  [["ArrowUp", "ArrowDown"], "in the contact sheet: a row up or down",
    (report, event) => report.moveRow(event.key === "ArrowUp" ? -1 : 1)],
  [["Home", "End"], "the first frame, the last one",
    (report, event) => report.move(event.key === "Home" ? -Infinity : Infinity)],
  [["Enter"], "open the marked frame", (report) => report.goTo(report.entry)],
  [["Escape"], "back to the contact sheet", () => { location.hash = "sheet"; }],
  [["p"], "plots", () => { location.hash = "plots"; }],
  [["i"], "the run", () => { location.hash = "run"; }],
  [["w"], "wipe", (report) => report.viewer.setMode("wipe")],
  [["b"], "blink", (report) => report.viewer.setMode("blink")],
  [["s"], "side by side", (report) => report.viewer.setMode("side")],
  [["1", "2"], "before, after", (report, event) => report.viewer.setMode(event.key === "1" ? "before" : "after")],
  [["[", "]"], "wipe to the left, to the right",
    (report, event) => report.viewer.setWipe(report.viewer.wipe + (event.key === "[" ? -0.05 : 0.05))],
  [["+", "=", "-"], "zoom in, in, out",
    (report, event) => report.viewer.zoom(report.viewer.scale * (event.key === "-" ? 0.5 : 2))],
  [["0", "9"], "the whole frame, one to one",
    (report, event) => (event.key === "0" ? report.viewer.fit() : report.viewer.zoom(1))],
  [["e", "E"], "half a stop brighter, darker",
    (report, event) => report.setExposure(report.exposure + (event.key === "e" ? 0.5 : -0.5))],
  [["r"], "exposure as it was", (report) => report.setExposure(0)],
  [["c"], "changed pixels", (report) => report.toggleOverlay("changed")],
  [["o"], "the next overlay of regions, groups or tunnels", (report) => report.nextOverlay()],
  [["d"], "light or dark", () => page.setScheme(page.scheme() === "dark" ? "light" : "dark")],
  [["?"], "these keys", () => page.byId("help").showModal()],
];

/** Shift and arrows: the pixel that is read out; by 10 with Alt, too. */
function movePixel(report, event) {
  const { viewer } = report, by = event.altKey ? 10 : 1;
  const from = viewer.pixel ?? { x: viewer.after.width >> 1, y: viewer.after.height >> 1 };
  const steps = { ArrowLeft: [-by, 0], ArrowRight: [by, 0], ArrowUp: [0, -by], ArrowDown: [0, by] };
  const [dx, dy] = steps[event.key];
  viewer.setPixel(from.x + dx, from.y + dy);
}

function connectKeys(report) {
  const rows = keys.map(([names, text]) => page.element("tr", {},
    page.element("th", {}, ...names.map((name) => page.element("kbd", {}, name.replace("Arrow", "")))), page.element("td", {}, text)));
  rows.push(page.element("tr", {}, page.element("th", {}, page.element("kbd", {}, "Shift + arrows")),
    page.element("td", {}, "the pixel that is read out; with Alt ten pixels")));
  const close = page.element("button", { type: "button" }, "Close");
  close.addEventListener("click", () => page.byId("help").close());
  page.byId("help").append(page.element("h2", {}, "Keys"), page.element("table", {}, page.element("tbody", {}, ...rows)), close);

  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || page.byId("help").open) return;
    if (event.target.matches("select, input")) return;
    if (event.shiftKey && event.key.startsWith("Arrow")) {
      if (report.part !== "step") return;
      movePixel(report, event);
    } else {
      const found = event.altKey ? null : keys.find(([names]) => names.includes(event.key));
      if (!found || (event.key === "Enter" && event.target.matches("button"))) return;
      found[2](report, event);
    }
    event.preventDefault();
  });
}
