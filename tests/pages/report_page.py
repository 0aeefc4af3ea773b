"""Opens RUN/report.html in headless Chromium and uses it as people do, by mouse and by keyboard.

usage: report_page.py RUN EXPECTED SCREENSHOTS
EXPECTED: a JSON file, what the run has, worked out without the page: {"labels": [...], "names": [...], "pixels": [{"entry",
"x", "y", "rgba", "frame"}], "by_change": entries, those that changed most first, "overlays": of each entry}. Exit code 0;
1 with a line for each fault; 77 when there is no Chromium.
"""

import json
import pathlib
import sys

import browser

PAINTED = "return document.documentElement.dataset.painted === arguments[0] && !document.getElementById('step').hidden"
# What the canvas shows, as a hash, as the bytes of a column, as the first column in which two canvases differ, as a mean.
# Overlays that lie beside the page may not be read back.
READ = """const v = document.getElementById('view'), s = document.createElement('canvas');
s.width = v.width; s.height = v.height;
const g = s.getContext('2d', {willReadFrequently: true}); g.drawImage(v, 0, 0);
const read = (x, w) => g.getImageData(x, 40, w, s.height - 40).data, d = read(0, s.width);"""
CANVAS = READ + "let h = 0; for (let i = 0; i < d.length; ++i) h = (h * 31 + d[i]) | 0; return h;"
COLUMN = READ + "return read(Math.round(s.width * arguments[0]), 1).join();"
KEEP = READ + "window.kept = d; return true;"
DIFFERING = READ + """for (let x = Math.round(s.width * 0.15); x < s.width * 0.85; ++x)
  for (let y = 0; y < s.height - 40; ++y) {
    const i = (y * s.width + x) * 4;
    if (Math.abs(d[i] - kept[i]) + Math.abs(d[i + 1] - kept[i + 1]) > 8) return (x + 0.2) / s.width;
  }
return 0;"""
SHEET_IS_THERE = "return document.documentElement.dataset.part === 'sheet'"
MEAN = READ + "let t = 0; for (let i = 0; i < d.length; ++i) t += d[i]; return t / d.length;"
BOX = "const r = document.querySelector(arguments[0]).getBoundingClientRect(); return [r.x, r.y, r.width, r.height];"


class ReportPage:
    def __init__(self, window, run, expected):
        self.window, self.run, self.expected = window, pathlib.Path(run).resolve(), expected
        self.address = (self.run / "report.html").as_uri()
        self.faults = []
        labels = self.expected["labels"]
        self.items = {}  # entries by the number of their step, its own last
        for entry, label in enumerate(labels):
            self.items.setdefault(label.split("_")[0], []).append(entry)
        # A step of several frames has none of its own.
        self.order = [entry for entries in self.items.values() for entry in (entries[:-1] if len(entries) > 1 else entries)]

    def title(self, entry):
        return f"{self.expected['labels'][entry]} {self.expected['names'][entry]}"

    def check(self, holds, what):
        if not holds:
            self.faults.append(what)

    def text(self, selector):
        return self.window.run("return document.querySelector(arguments[0]).textContent", selector)

    def pressed(self, selector):
        return self.window.run("return document.querySelector(arguments[0]).getAttribute('aria-pressed')", selector) == "true"

    def wait_for(self, entry):
        self.window.wait(PAINTED, self.expected["labels"][entry])

    def open_step(self, entry):
        self.window.run("location.hash = 'step=' + arguments[0]", self.expected["labels"][entry])
        self.wait_for(entry)

    def contact_sheet(self):
        seconds = self.window.open(self.address + "#sheet&view=review&layout=cards")
        print(f"{self.address}: loaded in {seconds:.2f} s")
        cards = self.window.run("return Array.from(document.querySelectorAll('.card .name'), (e) => e.textContent)")
        wanted = [self.title(entries[-1]) for entries in self.items.values()]
        self.check(cards == wanted, f"the contact sheet names {cards[:3]}..., not {wanted[:3]}...")
        self.window.wait("return document.querySelector('.card img').naturalWidth > 0")
        missing = self.window.run("return Array.from(document.images, (e) => e.alt).filter((text) => !text).length")
        self.check(missing == 0, f"{missing} images have no text")
        self.window.click(".card:nth-child(2) .open")
        self.wait_for(1)
        self.check(self.title(1) == self.text("#step-name"), f"step 1 is headed {self.text('#step-name')}")

    def choose_changed(self):
        """The entry that changed most, of those of which the page has the pixels: of long runs it does not have all."""
        for entry in self.expected["by_change"]:
            self.open_step(entry)
            if self.window.run("return document.documentElement.dataset.hasDifference") == "true":
                self.changed = entry
                return
        raise AssertionError("no entry has its pixels in the page")

    def selection_by_keys(self):
        order = self.order
        for key, entry in (("End", order[-1]), ("ArrowLeft", order[-2]), ("Home", order[0]), ("ArrowRight", order[1])):
            self.window.key(key)
            self.wait_for(entry)
        self.window.key("Escape")
        self.window.wait(SHEET_IS_THERE)
        first = list(self.items.values())[min(2, len(self.items) - 1)]
        if len(self.items) > 2:
            self.window.key("ArrowRight")
        self.window.key("Enter")
        if len(first) > 1:  # a card of several frames, which it unfolds to
            self.window.key("ArrowRight")
            self.window.key("Enter")
        self.wait_for(first[0])

    def many_presses(self):
        """Each moves a frame on, whatever is still loading."""
        times = min(10, len(self.order) - 1)
        self.open_step(self.order[0])
        self.window.press_quickly("ArrowRight", times)
        self.wait_for(self.order[times])
        self.check(self.title(self.order[times]) == self.text("#step-name"), f"{times} presses end at {self.text('#step-name')}")

    def wipe(self):
        """On both sides of the line stands what the key 1 or 2 shows there."""
        self.open_step(self.changed)
        self.window.key("1")
        self.window.run(KEEP)
        self.window.key("2")
        place = self.window.run(DIFFERING)
        self.check(place > 0, "A and B look alike")
        column = lambda: self.window.run(COLUMN, place)
        after = column()
        self.window.key("1")
        before = column()
        self.window.click("[data-mode=wipe]")
        x, y, width, height = self.window.run(BOX, "#view")
        middle = y + height / 2
        self.window.mouse(("move", x + width / 2, middle), ("down",), ("move", x + width * 0.9, middle), ("up",))
        self.check(column() == before, "left of the wipe is not A")
        self.window.mouse(("move", x + width * 0.9, middle), ("down",), ("move", x + width * 0.5, middle),
                          ("move", x + width * (place - 0.08), middle), ("up",))
        self.check(column() == after, "the wipe does not follow the mouse")
        for _ in range(4):
            self.window.key("]")
        self.check(column() == before, "the wipe does not follow the keys")

    def modes(self):
        self.open_step(self.changed)
        seen = set()
        for key, mode in (("s", "side"), ("b", "blink"), ("f", "difference"), ("w", "wipe")):
            self.window.key(key)
            self.check(self.pressed(f"[data-mode={mode}]"), f"{key} does not choose {mode}")
            seen.add(self.window.run(CANVAS))
        self.check(len(seen) == 4, "modes look alike")
        self.window.key("b")
        first = self.window.run(CANVAS)
        self.window.wait(CANVAS.replace("return h;", "return h !== arguments[0];"), first)
        self.window.key("w")

    def readout(self):
        """Values are those of the EXR files; exposure does not change them. Mouse, then keys."""
        for pixel in self.expected["pixels"]:
            self.open_step(pixel["entry"])
            self.window.key("9")
            x, y, width, height = self.window.run(BOX, "#view")
            self.window.mouse(("move", x + width / 2, y + height / 2))
            self.window.wait("return document.querySelectorAll('#readout tr').length === 2")
            here = self.window.run("return document.querySelector('#readout tr:last-child th').textContent.match(/[0-9]+/g)")
            # From there by keys: no window is that large.
            dx, dy = pixel["x"] - int(here[0]), pixel["y"] - int(here[1])
            for distance, less, more in ((dx, "ArrowLeft", "ArrowRight"), (dy, "ArrowUp", "ArrowDown")):
                for _ in range(abs(distance)):
                    self.window.key("Shift", less if distance < 0 else more)
            read = "return Array.from(document.querySelectorAll('#readout tr:last-child *'), (e) => e.textContent.trim())"
            for _ in range(2):
                place, *values = self.window.run(read)
                if len(values) == 1:
                    self.check(values[0].endswith(f"linear values are in {pixel['frame']}"), f"{place}: {values[0]}")
                    continue
                found = [float(value.split()[1]) for value in values]
                self.check(place.split()[1:] == [f"{pixel['x']},", str(pixel["y"])], f"readout at {place}")
                self.check(all(abs(a - b) <= 1e-5 * abs(b) for a, b in zip(found, pixel["rgba"])),
                           f"entry {pixel['entry']}, {place}: reads {found}, the file has {pixel['rgba']}")
                self.window.key("e")
            self.window.key("r")
            self.window.key("0")

    def exposure(self):
        self.open_step(self.changed)
        before = self.window.run(MEAN)
        self.window.key("E")
        self.check(self.window.run(MEAN) < before, "half a stop darker is not darker")
        self.window.key("r")
        self.check(self.window.run(MEAN) == before, "r does not bring the exposure back")

    def overlays(self):
        self.open_step(self.changed)
        self.window.key("g")
        self.check(self.pressed("#views [data-view=engineering]"), "g does not show engineering")
        self.open_step(self.changed)
        plain = self.window.run(CANVAS)
        self.window.click("[data-overlay=changed]")
        self.check(self.pressed("[data-overlay=changed]") and self.window.run(CANVAS) != plain, "changed pixels do not show")
        self.window.key("c")
        self.check(self.window.run(CANVAS) == plain, "changed pixels do not go away")
        overlays = self.expected["overlays"][self.changed]
        self.window.wait("return document.querySelectorAll('[data-overlay]').length === arguments[0]", 1 + len(overlays))
        kinds = self.window.run("return Array.from(document.querySelectorAll('[data-overlay]'), (e) => e.dataset.overlay)")
        self.check(kinds[1:] == overlays, f"overlays {kinds[1:]}, not {overlays}")
        for kind in overlays:
            self.window.key("o")
            self.check(self.pressed(f"[data-overlay={kind}]"), f"o does not show {kind}")
        if overlays:
            self.window.key("o")
        self.window.key("g")

    def others(self):
        self.window.key("p")
        charts = self.window.wait("return document.querySelectorAll('#plots canvas').length")
        self.check(charts >= 4, f"only {charts} plots")
        scheme = self.window.run("return page.scheme()")
        self.window.key("d")
        self.check(self.window.run("return page.scheme()") != scheme, "d does not change the scheme")
        self.window.key("d")
        self.window.key("i")
        self.window.wait("return document.querySelectorAll('#run tr').length > 10")
        self.window.key("?")
        self.check(self.window.run("return document.getElementById('help').open"), "? shows no keys")
        self.window.key("Escape")

    def names_are_text(self):
        """No element that the page did not make itself, and no script that ran."""
        for entry in range(min(4, len(self.expected["labels"]))):
            self.open_step(entry)
            foreign = self.window.run("return document.querySelectorAll('main b, main script, main iframe, main svg, "
                                      "#side img, [onerror], [onload]').length + (window.pwned ? 1 : 0)")
            self.check(foreign == 0, f"entry {entry}: a name has become an element")

    def screenshots(self, folder):
        folder = pathlib.Path(folder)
        for part in ("sheet", "step=" + self.expected["labels"][1], "plots", "run"):
            self.window.run("location.hash = arguments[0]", part)
            self.window.wait("return !document.getElementById(arguments[0]).hidden", part.split("=")[0])
            if part.startswith("step"):
                self.wait_for(1)
            self.window.screenshot(folder / f"{part.split('=')[0]}.png")


def main(run, expected_file, screenshots):
    if not browser.is_there():
        return 77
    expected = json.loads(pathlib.Path(expected_file).read_text())
    window = browser.Browser()
    try:
        report = ReportPage(window, run, expected)
        for use in (report.contact_sheet, report.selection_by_keys, report.many_presses, report.choose_changed, report.wipe, report.modes,
                    report.readout, report.exposure, report.overlays, report.others, report.names_are_text):
            use()
        report.screenshots(screenshots)
        report.faults += window.complaints([report.run.as_uri() + "/"])
    finally:
        window.close()
    for fault in report.faults:
        print(fault)
    return 1 if report.faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
