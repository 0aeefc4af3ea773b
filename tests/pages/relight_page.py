"""Opens RUN/report.html in headless Chromium and turns the lights of its frames, as people do.

usage: relight_page.py RUN EXPECTED SCREENSHOTS
EXPECTED: {"entries": [{"label", "preview", "turns": [[light, what, value], ...]}], "without": a label without layers, or
null}. What is "stops", "red", "green", "blue", "solo" or "mute". Of entry i the relit pixels go to SCREENSHOTS/relit_i.bin,
as halves, R, G, B, one plane after the other, and the journal step to relit_i.json. Exit code 0; 1 with a line for each
fault; 77 when there is no Chromium.
"""

import base64
import json
import pathlib
import sys
import zlib

import browser

PAINTED = "return document.documentElement.dataset.painted === arguments[0] && !document.getElementById('step').hidden"
# The page's own objects, told as they work.
CATCH = """window.addEventListener('DOMContentLoaded', () => {
  const paint = PairView.prototype.paintBuffers;
  PairView.prototype.paintBuffers = function () { window.pair = this; return paint.call(this); };
});"""
SHOWN = """const c = window.pair.viewer.b, s2 = document.createElement('canvas'); s2.width = c.width; s2.height = c.height;
const g = s2.getContext('2d', {willReadFrequently: true}); g.drawImage(c, 0, 0); const d = g.getImageData(0, 0, c.width, c.height).data;
let s = ''; for (let i = 0; i < d.length; i += 4096) s += String.fromCharCode(...d.subarray(i, i + 4096)); return btoa(s);"""
PLANES = """let s = ''; for (const n of ['R', 'G', 'B']) { const p = window.pair.shown('b').planes[n];
if (!(p instanceof Uint16Array)) return null;
const d = new Uint8Array(p.buffer, p.byteOffset, p.byteLength);
for (let i = 0; i < d.length; i += 4096) s += String.fromCharCode(...d.subarray(i, i + 4096)); } return btoa(s);"""
SET = """const [name, what, value] = arguments, row = document.querySelector(`[data-light="${name}"]`);
const labels = {stops: 'Stops of ', red: 'Linear red of ', green: 'Linear green of ', blue: 'Linear blue of ', solo: 'Solo ', mute: 'Mute '};
const control = row.querySelector(`[aria-label="${labels[what]}${name}"]`);
if (control.matches('button')) { control.click(); return true; }
control.value = value; control.dispatchEvent(new Event('input', {bubbles: true})); return true;"""


def png_pixels(path):
    """Width, height and the rows of an 8-bit RGB or RGBA PNG as RGBA."""
    data, place, packed = path.read_bytes(), 8, b""
    while place < len(data):
        size, kind = int.from_bytes(data[place:place + 4], "big"), data[place + 4:place + 8]
        body = data[place + 8:place + 8 + size]
        if kind == b"IHDR":
            width, height, channels = int.from_bytes(body[:4], "big"), int.from_bytes(body[4:8], "big"), {2: 3, 6: 4}[body[9]]
        elif kind == b"IDAT":
            packed += body
        place += size + 12
    raw, stride, before, out = zlib.decompress(packed), width * channels, bytes(width * channels), bytearray()
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b = (row[i - channels] if i >= channels else 0), before[i]
            c = before[i - channels] if i >= channels else 0
            guess = a + b - c
            paeth = min((abs(guess - a), 0, a), (abs(guess - b), 1, b), (abs(guess - c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
        for i in range(0, stride, channels):
            out += row[i:i + 3] + b"\xff"
        before = row
    return width, height, bytes(out)


class RelightPage:
    def __init__(self, window, run, expected, folder):
        self.window, self.run, self.expected, self.folder = window, pathlib.Path(run).resolve(), expected, pathlib.Path(folder)
        self.faults = []

    def check(self, holds, what):
        if not holds:
            self.faults.append(what)

    def open_entry(self, label):
        self.window.run("location.hash = 'step=' + arguments[0]", label)
        self.window.wait(PAINTED, label)

    def shows_preview(self, entry, when):
        _, _, preview = png_pixels(self.run / entry["preview"])
        shown = base64.b64decode(self.window.run(SHOWN))
        # Previews are made of float32, what is shown of halves: a code apart where these round across its border.
        apart = sum(abs(a - b) > 1 for a, b in zip(preview, shown))
        self.check(len(preview) == len(shown) and apart == 0, f"{entry['label']}, {when}: {apart} bytes are not the preview's")
        frame = self.window.run("return window.pair.shown('b') === window.pair.buffers.b")
        self.check(frame, f"{entry['label']}, {when}: it is not the frame that is shown")

    def relit(self):
        return self.window.run("return document.documentElement.dataset.relit")

    def entry(self, number, entry):
        self.open_entry(entry["label"])
        self.window.wait("return document.querySelector('.relight-lights') !== null")
        self.window.wait("return document.documentElement.dataset.relit === ''")
        self.shows_preview(entry, "at rest")
        for turn in entry["turns"]:
            self.window.run(SET, *turn)
        self.window.wait("return document.documentElement.dataset.relit !== ''")
        self.window.run("return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")
        planes = self.window.run(PLANES)
        self.check(planes is not None, "the frame is not of halves")
        (self.folder / f"relit_{number}.bin").write_bytes(base64.b64decode(planes or ""))
        (self.folder / f"relit_{number}.json").write_text(self.window.run("return document.querySelector('.relight-step textarea').value"))
        self.window.run("document.querySelector('.relight-lights').scrollIntoView()")
        self.window.screenshot(self.folder / f"relight_{number}.png")
        print(f"{entry['label']}: lit otherwise in {self.window.run('return document.documentElement.dataset.relightMs')} ms")
        self.window.run("[...document.querySelectorAll('.relight-buttons button')].find((b) => b.textContent === 'Reset all').click()")
        self.window.wait("return document.documentElement.dataset.relit === ''")
        self.shows_preview(entry, "reset")

    def use(self):
        self.window.before_pages(CATCH)
        self.window.open((self.run / "report.html").as_uri())
        entries = self.expected["entries"]
        self.open_entry(entries[0]["label"] if entries else self.expected["without"])
        self.window.run("document.activeElement.blur()")
        twice = self.window.run("const all = keys.flatMap(([names]) => names); return all.filter((name, i) => all.indexOf(name) !== i)")
        self.check(twice == [], f"keys that mean two things: {twice}")
        self.window.key("u")
        self.check(self.window.run("return document.getElementById('relight-box').open"), "u does not open the panel")
        for number, entry in enumerate(entries):
            self.entry(number, entry)
        if entries:
            self.keeps(entries)
        if self.expected["without"] is not None:
            self.open_entry(self.expected["without"])
            self.window.wait("return document.querySelector('.relight-body').textContent.includes('--relight')")
        unlabelled = self.window.run("return [...document.querySelectorAll('#relight input, #relight button, #relight textarea')]"
                                     ".filter((e) => !e.getAttribute('aria-label') && !e.textContent.trim()).length")
        self.check(unlabelled == 0, f"{unlabelled} controls have no name")
        self.faults += self.window.complaints(allowed=(self.run.as_uri(),))

    def keeps(self, entries):
        """What was turned is there again when one comes back to a frame."""
        first, turn = entries[0], entries[0]["turns"][0]
        self.open_entry(first["label"])
        self.window.wait("return document.querySelector('.relight-lights') !== null")
        self.window.run(SET, *turn)
        self.window.wait("return document.documentElement.dataset.relit !== ''")
        other = next((entry for entry in entries if entry["label"] != first["label"]), None)
        if other:
            self.open_entry(other["label"])
            self.window.wait("return document.documentElement.dataset.relit === ''")
            self.open_entry(first["label"])
        self.window.wait("return document.documentElement.dataset.relit !== ''")


def main(run, expected, folder):
    if not browser.is_there():
        return 77
    window = browser.Browser()
    try:
        relight_page = RelightPage(window, run, json.loads(pathlib.Path(expected).read_text()), folder)
        relight_page.use()
    finally:
        window.close()
    for fault in relight_page.faults:
        print(fault)
    return 1 if relight_page.faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:4]))
