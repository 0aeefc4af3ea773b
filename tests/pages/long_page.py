"""Opens RUN/report.html of a long run in headless Chromium: how little it does at once, and whether it stays usable.

usage: long_page.py RUN EXPECTED SCREENSHOTS
EXPECTED: as of report_page.py, and "rows": of the entries, those in the page;
"words": what stands beside the last step;
"mixes": true when the page has the pixels of some frames of "pixels" and previews of the others, false: it has all of
them. Exit code 0; 1 with a line for each fault; 77 when there is no Chromium.
"""

import json
import pathlib
import sys

import browser
from report_page import BOX, ReportPage

# Runs before the page does: counts the cards that are there once the page's scripts have run, and the most that come at once
# later, between which the page answers.
COUNTER = """window.work = {atOnce: 0, most: 0};
const cardsIn = (nodes) => Array.from(nodes, (n) => n.classList?.contains('card') ? 1 : 0).reduce((a, b) => a + b, 0);
addEventListener('DOMContentLoaded', () => { work.atOnce = document.querySelectorAll('.card').length; });
new MutationObserver((changes) => {
  work.most = Math.max(work.most, changes.reduce((sum, change) => sum + cardsIn(change.addedNodes), 0));
}).observe(document, {childList: true, subtree: true});"""
WORK = """const scripts = performance.getEntriesByType('resource').filter((e) => e.name.includes('/pixels/')).length;
return document.documentElement.dataset.opened ? [work.atOnce, work.most, scripts] : null;"""
FIRST_CARDS, MORE_CARDS = 100, 250  # cli/page/assets/sheet/sheet.js
MARKED = """const e = document.querySelector('.card [aria-current=true]'), r = e.getBoundingClientRect();
return document.activeElement === e && r.top >= 0 && r.bottom <= innerHeight
  && e.querySelector('.name').textContent === arguments[0];"""
FILTER = """const e = document.getElementById(arguments[0]);
e.value = arguments[1]; e.dispatchEvent(new Event(arguments[2]));
return true;"""
COUNTED = "return [document.getElementById('sheet-count').textContent, document.querySelectorAll('.card').length]"
READ = "return Array.from(document.querySelectorAll('#readout tr:last-child *'), (e) => e.textContent.trim())"


class LongPage(ReportPage):
    def opens(self):
        self.window.before_pages(COUNTER)
        self.window.open(self.address)
        at_once, most, scripts = self.window.wait(WORK)
        opened = float(self.window.run("return document.documentElement.dataset.opened"))
        print(f"a page of {self.expected['rows']} frames shows its sheet after {opened / 1000:.2f} s")
        self.check(at_once == min(FIRST_CARDS, self.expected["rows"]), f"it opens with {at_once} cards")
        self.check(most <= MORE_CARDS, f"{most} cards come at once")
        self.check(scripts == 0, f"{scripts} files are loaded before a step is opened")

    def last_step_by_keys(self):
        rows = self.expected["rows"]
        last = self.title(rows - 1)
        self.window.key("End")
        self.window.wait(MARKED, last)
        self.window.screenshot(self.folder / f"long_{self.expected['rows']}_sheet.png")
        self.window.wait("return document.querySelector('.card [aria-current=true] img').naturalWidth > 0")
        self.window.key("Enter")
        self.wait_for(rows - 1)
        self.check(self.text("#step-name") == last, f"the last step is headed {self.text('#step-name')}")
        self.check(self.expected.get("words", "") in self.text("#side"), f"beside the last step stands {self.text('#side')}")
        self.window.key("Escape")

    def all_cards(self):
        self.window.wait("return document.querySelectorAll('.card').length === arguments[0]", self.expected["rows"])

    def filters(self):
        rows = self.expected["rows"]
        name = self.title(rows - 1)
        for control, value, event, wanted in (("search", name.upper(), "input", 1), ("search", "", "input", rows),
                                              ("class-filter", "base", "change", 1), ("class-filter", "", "change", rows)):
            self.window.run(FILTER, control, value, event)
            self.window.wait("return document.querySelectorAll('.card').length === arguments[0]", wanted)
            text, shown = self.window.run(COUNTED)
            self.check(text.startswith(f"{wanted:,} of {rows:,} "), f"{control} {value}: {text}, {shown} cards")

    def pixels(self):
        """Each value is that of the file, or the page says where it is."""
        previews = 0
        for pixel in self.expected["pixels"]:
            self.open_step(pixel["entry"])
            x, y, width, height = self.window.run(BOX, "#view")
            self.window.mouse(("move", x + width / 2 - 5, y + height / 2), ("move", x + width / 2, y + height / 2))
            place, *values = self.window.run(READ)
            here = [int(part) for part in place.replace(",", "").split()[1:]]
            for distance, less, more in ((pixel["x"] - here[0], "ArrowLeft", "ArrowRight"), (pixel["y"] - here[1], "ArrowUp", "ArrowDown")):
                for _ in range(abs(distance)):
                    self.window.key("Shift", less if distance < 0 else more)
            place, *values = self.window.run(READ)
            if len(values) == 1:
                previews += 1
                self.check(not pixel.get("must_be_there"), f"entry {pixel['entry']} has no pixels in the page")
                self.check(values[0].endswith(f"linear values are in {pixel['frame']}"), f"entry {pixel['entry']}: {values[0]}")
                continue
            found = [float(value.split()[1]) for value in values]
            self.check(all(abs(a - b) <= 1e-5 * abs(b) for a, b in zip(found, pixel["rgba"])),
                       f"entry {pixel['entry']}, {place}: reads {found}, the file has {pixel['rgba']}")
        if self.expected["mixes"]:
            self.check(0 < previews < len(self.expected["pixels"]), f"{previews} of {len(self.expected['pixels'])} are previews")
        else:
            self.check(previews == 0, f"{previews} previews instead of pixels")
        self.window.screenshot(self.folder / f"long_{self.expected['rows']}_step.png")

    def plots(self):
        self.window.run("location.hash = 'plots'")
        self.window.wait("return document.querySelectorAll('#plots canvas').length >= 4")
        self.window.screenshot(self.folder / f"long_{self.expected['rows']}_plots.png")


def main(run, expected_file, screenshots):
    if not browser.is_there():
        return 77
    window = browser.Browser()
    try:
        report = LongPage(window, run, json.loads(pathlib.Path(expected_file).read_text()))
        report.folder = pathlib.Path(screenshots)
        for use in (report.opens, report.last_step_by_keys, report.all_cards, report.filters, report.pixels, report.plots):
            use()
        report.faults += window.complaints([report.run.as_uri() + "/"])
    finally:
        window.close()
    for fault in report.faults:
        print(fault)
    return 1 if report.faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
