"""The display of RUN/report.html in headless Chromium: curves, marks, scopes and regions against known numbers, WebGL
against the canvas, both against the previews.

usage: display_page.py RUN EXPECTED SCREENSHOTS
EXPECTED: as of report_page.py, and "previews": {"entry", "file", "within": codes of 255} of frames that the page's first
display shows; "light": of entry 1 {"whole", "region"}, each {"region": [x, y, width, height], "rows": {"b-mean": [R, G, B,
luma, EV]}}; "marks": of entry 1, pixels {"above", "below", "undefined"}; "codes": of entry 1 [{"x", "y", "display": as a
link has it, "code": [R, G, B]}]; "levels": of its histogram [{"channel", "level", "count"}]. Exit code 0; 1 with a line
for each fault; 77 when there is no Chromium.
"""

import base64
import json
import math
import pathlib
import sys

import browser
from report_page import BOX, ReportPage

# Frames of the page's own, as window.frames, and displays for both painters; takes a while.
SET_UP = """window.faults = []; window.isReady = false;
const layout = page.data('layout'), exposure = page.data('report').options.exposure ?? 0;
const frames = new RunFrames(layout, page.data('pixels'), new StepDetails(layout, page.data('details')));
window.buffers = arguments[0].map(() => new FrameBuffer(layout));
const isHalf = buffers[0].planes.R instanceof Uint16Array;
window.displays = ['canvas', 'webgl'].map((painter) => new Display(isHalf, exposure, painter));
Promise.all([...arguments[0].map((entry, i) => frames.fill(buffers[i], entry)), ...displays.map((display) => display.ready)])
  .then(() => { window.isReady = true; });"""
PIXELS = """window.pixelsOf = (display, buffer) => {
  const canvas = document.createElement('canvas');
  canvas.getContext('2d', {willReadFrequently: true});
  display.paint(buffer, canvas);
  return canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
};
window.largest = (a, b) => {
  let most = 0;
  for (let i = 0; i < a.length; ++i) most = Math.max(most, Math.abs(a[i] - b[i]));
  return most;
};"""
PREVIEW = """window.preview = null;
const image = new Image();
image.onload = () => {
  const canvas = document.createElement('canvas');
  Object.assign(canvas, {width: image.naturalWidth, height: image.naturalHeight});
  const context = canvas.getContext('2d', {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  window.preview = context.getImageData(0, 0, canvas.width, canvas.height).data;
};
image.src = arguments[0];"""
BOTH = """const found = [], [canvas, webgl] = displays, [buffer, curve, channel] = arguments;
for (const [falseColor, clipping] of [[false, false], [false, true], [true, false], [true, true]])
  for (const exposure of clipping === falseColor ? [-2.37] : [0, 1.5]) {
    for (const display of displays) display.set({curve, channel, falseColor, clipping, exposure});
    const most = largest(pixelsOf(canvas, buffers[buffer]), pixelsOf(webgl, buffers[buffer]));
    if (most > 1) found.push([curve, channel, falseColor, clipping, exposure, most].join(' '));
  }
for (const display of displays) display.set({...display.standard});
return found;"""
COUNTS = """const counts = ScopeCounts.of(buffers[1], displays[0], 'stops', wholeFrame(buffers[1]), 1);
return [Array.from(counts.histogram), counts.columns, Array.from({length: 256}, (_, level) => counts.waveform[level * counts.columns + 10])];"""
ROW = "return Array.from(document.querySelectorAll(`[data-row=\"${arguments[0]}\"] td`), (e) => e.textContent)"
IS_EXACT = "return document.getElementById('scopes').dataset.state === 'exact'"
ENTER = """const e = document.getElementById(arguments[0]); e.focus(); e.value = arguments[1];
e.dispatchEvent(new Event('input')); e.dispatchEvent(new Event('change')); e.blur();"""
SHOWN = """const canvas = document.createElement('canvas');
Object.assign(canvas, {width: 1, height: 1});
const context = canvas.getContext('2d', {willReadFrequently: true});
context.drawImage(document.getElementById('view'), -arguments[0], -arguments[1]);
return Array.from(context.getImageData(0, 0, 1, 1).data.slice(0, 3));"""
OWN_LINK = "return new URLSearchParams(location.hash.slice(1)).get(arguments[0])"


class DisplayPage(ReportPage):
    def start(self):
        self.window.open(self.address)
        self.open_step(1)
        self.window.run(PIXELS)
        self.window.run(SET_UP, [0, 1])
        self.window.wait("return window.isReady")
        self.check(self.window.run("return displays[1].glPainter !== null"), "there is no WebGL to compare with")

    def previews(self):
        """With the settings at first both painters show the previews' bytes, or a view's as far as its lattice holds."""
        for preview in self.expected["previews"]:
            data = base64.b64encode((self.run / preview["file"]).read_bytes()).decode()
            self.window.run(PREVIEW, "data:image/png;base64," + data)
            self.window.wait("return window.preview !== null")
            for painter, name in enumerate(("canvas", "WebGL")):
                most = self.window.run("return largest(pixelsOf(displays[arguments[0]], buffers[arguments[1]]), preview)", painter, preview["entry"])
                self.check(most <= preview["within"], f"{name} is {most} codes off {preview['file']}")

    def painters_agree(self):
        curves, channels = self.window.run("return [Object.keys(displays[0].curveNames()), Object.keys(channelNames)]")
        self.check(curves == ["srgb", "filmic", "neutral"] + ["view"] * bool(self.expected.get("hasView")), f"the curves are {curves}")
        for curve in curves:
            for channel in channels:
                for fault in self.window.run(BOTH, 0, curve, channel):
                    self.check(False, f"WebGL and canvas differ: {fault}")

    def counts(self):
        histogram, columns, column = self.window.run(COUNTS)
        for level in self.expected["levels"]:
            found = histogram[level["channel"] * 256 + level["level"]]
            self.check(found == level["count"], f"histogram at {level}: {found}")
        self.check(sum(column) == 256 and columns == 256, f"a column of the waveform has {sum(column)} pixels")

    def link_to(self, **values):
        rest = "".join(f"&{name}={value}" for name, value in values.items())
        self.window.run("location.hash = arguments[0]", f"step={self.expected['labels'][1]}&view=review&mode=b{rest}")
        self.wait_for(1)

    def numbers(self):
        self.link_to()
        self.window.key("h")
        for name, region in self.expected["light"].items():
            self.link_to(**({"region": ",".join(map(str, region["region"]))} if name == "region" else {}))
            self.window.wait(IS_EXACT)
            self.check((name == "region") == self.text("#scope-numbers caption").startswith("Region at "), f"{name}: the wrong heading")
            for row, wanted in region["rows"].items():
                found = [float(text.replace("−", "-").replace("–", "nan")) for text in self.window.run(ROW, row)]
                holds = len(found) == 5 and all(abs(a - b) <= 6e-4 * abs(b) + 1e-9 for a, b in zip(found[:4], wanted[:4])) and abs(found[4] - wanted[4]) <= 0.0051
                self.check(holds, f"{name}, {row}: {found}, not {wanted}")
        self.link_to()
        self.window.wait(IS_EXACT)
        pixels = 256 * 256
        for kind, words in (("above", "above display white"), ("below", "below zero"), ("undefined", "no number")):
            share, said = 100 * self.expected["marks"][kind] / pixels, self.text("#scope-numbers p")
            found = [float(part.split(" %")[0].split()[-1]) for part in said.split("B: ")[-1].split(", ") if part.endswith(words)]
            self.check(len(found) == (1 if share else 0) and all(abs(part - share) <= 0.05 * share for part in found), f"{said}: not {share} % {words}")
        self.check(self.window.run("return document.querySelector('#scope-b').getAttribute('aria-label')").startswith("Histogram of B: luma 0."), "the scope has no text")

    def scopes_look_different(self):
        """Each scope and scale, none empty."""
        seen = set()
        for kind in ("histogram", "waveform", "parade", "luma"):
            for scale in ("stops", "display"):
                self.window.run(ENTER, "scope-kind", kind)
                self.window.run(ENTER, "scope-scale", scale)
                self.window.wait(IS_EXACT)
                seen.add(self.window.run("return document.getElementById('scope-b').toDataURL()"))
        self.check(len(seen) == 8, f"8 scopes have {len(seen)} pictures")

    def codes(self):
        """What stands at pixels of the view, with the display of a link."""
        for code in self.expected["codes"]:
            self.link_to(display=code["display"])
            self.window.key("9")
            x, y, width, height = self.window.run(BOX, "#view")
            found = self.window.run(SHOWN, round(width / 2) + code["x"] - 128, round(height / 2) + code["y"] - 128)
            self.check(found == code["code"], f"{code}: shows {found}")
            self.window.key("0")

    def controls(self):
        self.link_to()
        for key, control, value in (("v", "curve", "filmic"), ("v", "curve", "neutral"), ("l", "channel", "luma"), ("l", "channel", "R")):
            self.window.key(key)
            found = self.window.run("return document.getElementById(arguments[0]).value", control)
            self.check(found == value or self.expected.get("hasView"), f"{key}: the {control} is {found}")
        for key, button in (("z", "#falseColor"), ("k", "#clipping")):
            self.window.key(key)
            self.check(self.pressed(button), f"{key} does not press {button}")
        self.check(self.window.run("return document.querySelectorAll('#display-legend li').length") == 18, "the legend has no 15 colours and 3 marks")
        self.window.run(ENTER, "exposure-number", "1.37")
        self.window.wait("return /1.37,/.test(("  + OWN_LINK[7:].replace("arguments[0]", "'display'") + " ?? ''))")
        kept = self.window.run(OWN_LINK, "display")
        self.check(kept.startswith("1.37,") and kept.endswith(",R,false,clip"), f"the link says {kept}")
        self.window.click("#display-reset")
        self.check(not self.pressed("#clipping") and self.window.run("return document.getElementById('exposure-number').value") == "0", "Reset resets nothing")
        self.window.wait("return !/display=/.test(location.hash)")
        self.link_to(display=kept)
        self.check(self.pressed("#falseColor") and self.window.run("return document.getElementById('exposure').value") == "1.35", "a link brings back another display")
        self.link_to(display="nonsense,1e99,constructor,-0.5")
        self.check(self.window.run("return document.getElementById('exposure-number').value") == "-0.5", "a link of nonsense is not read as far as it goes")
        self.window.run(ENTER, "exposure-number", "")
        self.check(self.window.run("return document.getElementById('exposure-number').value") == "-0.5", "an empty number is taken")

    def wait_for_region(self, region):
        try:
            self.window.wait("return " + OWN_LINK.removeprefix("return ").replace("arguments[0]", "'region'") + " === arguments[0]", region, seconds=10)
        except AssertionError:
            self.check(False, f"the region is {self.window.run(OWN_LINK, 'region')}, not {region}")

    def region_by_mouse_and_keys(self):
        self.link_to()
        self.window.key("9")
        x, y, width, height = self.window.run(BOX, "#view")
        left, top = round(x + width / 2) - 20, round(y + height / 2) - 10
        pixel = [math.floor(128 + left - x - width / 2), math.floor(128 + top - y - height / 2)]
        shift = {"type": "key", "id": "keys", "actions": [{"type": "keyDown", "value": browser.KEYS["Shift"]}]}
        self.window._call("POST", f"{self.window.session}/actions", {"actions": [shift]})
        self.window.mouse(("move", left, top), ("down",), ("move", left + 9, top + 3), ("move", left + 39, top + 19), ("up",))
        shift["actions"] = [{"type": "keyUp", "value": browser.KEYS["Shift"]}]
        self.window._call("POST", f"{self.window.session}/actions", {"actions": [shift]})
        self.wait_for_region(f"{pixel[0]},{pixel[1]},40,20")
        self.window.key("q")
        self.wait_for_region(None)
        self.window.mouse(("move", left, top))
        self.window.key("q")
        for _ in range(4):
            self.window.key("Shift", "ArrowRight")
        self.window.key("q")
        self.wait_for_region(f"{pixel[0]},{pixel[1]},5,1")
        self.window.click("#region-clear")
        self.wait_for_region(None)
        self.window.click("#region-button")
        self.window.mouse(("move", left + 5, top + 5), ("down",), ("move", left, top), ("up",))
        self.wait_for_region(f"{pixel[0]},{pixel[1]},6,6")
        self.window.click("#region-button")
        self.window.key("q")
        self.wait_for_region(None)
        self.window.key("0")

    def screenshots(self, folder):
        self.link_to(display="false,clip", region="48,8,32,16")
        self.window.wait(IS_EXACT)
        self.window.screenshot(pathlib.Path(folder) / "display.png")


def main(run, expected_file, screenshots):
    if not browser.is_there():
        return 77
    window = browser.Browser()
    try:
        report = DisplayPage(window, run, json.loads(pathlib.Path(expected_file).read_text()))
        for use in (report.start, report.previews, report.painters_agree, report.counts, report.numbers, report.scopes_look_different,
                    report.codes, report.controls, report.region_by_mouse_and_keys):
            use()
        report.screenshots(screenshots)
        # Reading WebGL's pixels back is what this test does on purpose.
        report.faults += [said for said in window.complaints([report.run.as_uri() + "/"]) if "ReadPixels" not in said]
    finally:
        window.close()
    for fault in report.faults:
        print(fault)
    return 1 if report.faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
