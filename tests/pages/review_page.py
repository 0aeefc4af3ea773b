"""Uses RUN/report.html as people do who choose a look: by mouse, by keyboard and by touch, in both themes and on paper.

usage: review_page.py RUN EXPECTED SCREENSHOTS
The run is that of tests/report/review_page_test.cpp. Exit code 0; 1 with a line for each fault; 77 when there is no
Chromium. $RELOOK_AXE: the file of axe-core (axe.min.js), which then judges every part of the page.
"""

import json
import os
import pathlib
import sys

import browser
from report_page import BOX, CANVAS, ReportPage, SHEET_IS_THERE

STEP_IS_THERE = "return document.documentElement.dataset.part === 'step'"
VIEW = "return document.getElementById('view').getAttribute('aria-label')"
CARDS = "return Array.from(document.querySelectorAll('#sheet-list .card .name'), (e) => e.textContent)"
SMALL = """return Array.from(document.querySelectorAll('button, select, input, a'), (e) => [e, e.getBoundingClientRect()])
.filter(([e, r]) => r.width > 0 && e.type !== 'file' && e.offsetParent !== null && (r.width < 43.5 || r.height < 43.5))
.map(([e, r]) => `${e.id || e.textContent || e.className}: ${Math.round(r.width)} x ${Math.round(r.height)}`);"""
FOCUS = """const e = document.activeElement, s = getComputedStyle(e);
return [e.tagName + ' ' + (e.id || e.textContent.slice(0, 20)), s.outlineStyle !== 'none' && parseFloat(s.outlineWidth) >= 1];"""
EXPORTED = "window.exported = ''; URL.createObjectURL = (blob) => { blob.text().then((text) => { exported = text; }); return 'data:,'; };"


class ReviewPage(ReportPage):
    def open(self, link=""):
        self.window.open("about:blank")
        self.window.open(self.address + link)
        self.window.wait("return document.documentElement.dataset.opened")

    def cards(self, count):
        self.window.wait("return document.querySelectorAll('#sheet-list .card').length === arguments[0]", count)
        return self.window.run(CARDS)

    def choose(self, control, value, event="change"):
        self.window.run("const e = document.getElementById(arguments[0]); e.value = arguments[1]; e.dispatchEvent(new Event(arguments[2]));",
                        control, value, event)

    def marks(self, label):
        return self.window.run("const b = document.querySelector(`[data-entry='${arguments[0]}']`); return b.closest('li').textContent", label)

    def views(self):
        self.open()
        self.check(self.pressed("#views [data-view=review]"), "review is not the first view")
        for link in ("#sheet", "#step=5"):
            self.open(link)
            text = self.window.run("return document.body.innerText")
            self.check("secret" not in text, f"{link}: a path of the server stands in review")
            self.check("For the launch." in text or link != "#sheet", "the journal's note is not in the sheet")
        self.wait_for(5)
        text = self.text("#side")
        self.check("Bolder, as the client asked." in text and "Bo" in text, "the step's note is not beside it")
        self.check("roughness becomes 0.05" in text, f"no words of the change in {text}")
        self.window.key("g")
        self.window.key("i")
        self.check("secret" in self.window.run("return document.body.innerText"), "engineering does not say where the scene is")
        self.open()
        self.check(self.pressed("#views [data-view=engineering]"), "the view is not remembered")
        self.window.key("g")

    def tree(self):
        self.open()
        self.check(self.pressed("#layouts [data-layout=tree]"), "options are not drawn as a tree")
        options = self.window.run("return Array.from(document.querySelector('.branches').children, (e) => e.querySelector('.name').textContent)")
        self.check([name.split()[0] for name in options] == [*map(str, range(1, 11)), "12"], f"from the base start {options}")
        below = self.window.run("return document.querySelectorAll('.branches .branches').length")
        self.check(below == 0, "a wedge alone after a step is no branch")  # it stands in the row of step 3
        row = self.window.run("const e = document.querySelector('.card.wedge').closest('.chain'); return Array.from(e.children, (c) => c.querySelector('.name').textContent)")
        self.check([name.split()[0] for name in row] == ["3", "11"], f"in the row of step 3 stand {row}")
        self.window.key("t")
        self.check(not self.window.run("return document.querySelector('.branches')"), "t does not show cards")
        cards = self.cards(67)
        self.check(len(cards) == 67, f"{len(cards)} cards")  # 70 items, three of them folded

    def folded(self):
        self.check("3 steps change no pixel" in self.text(".fold"), "unchanged steps are not folded")
        self.window.click(".fold button")
        self.cards(70)

    def wedges(self):
        """One card, which unfolds to frames with their values, by mouse and by keyboard, and plays."""
        self.open("#sheet&view=review&layout=cards")
        wedge = ".card[data-item='11'] .open"
        self.window.click(wedge)
        values = self.window.run("return Array.from(document.querySelectorAll('.unfolded .cell .value'), (e) => e.textContent)")
        self.check(values == ["1", "2", "4", "8", "16"], f"the wedge unfolds to {values}")
        self.window.key("ArrowRight")
        self.window.key("ArrowRight")
        self.window.key("Enter")
        self.wait_for(self.expected["labels"].index("11_02"))
        self.check(self.text("#axes output") == "2" and "Key intensity" in self.text("#axes"), f"its slider says {self.text('#axes')}")
        self.window.key(" ")
        for label in ("11_03", "11_05", "11_01"):  # it plays, and begins anew
            self.window.wait("return document.getElementById('step-name').textContent.startsWith(arguments[0])", label)
        self.window.key(" ")
        self.window.key("Escape")
        self.window.wait(SHEET_IS_THERE)
        self.check(self.window.run("return document.activeElement.dataset.entry"), "the focus is lost on the way back")
        self.window.click(wedge)
        self.check(not self.window.run("return document.querySelector('.unfolded')"), "a second click does not fold it")
        self.window.click(".card[data-item='12'] .open")
        columns, rows = (self.window.run(f"return Array.from(document.querySelectorAll('.wedge-grid th[scope={scope}]'), (e) => e.textContent)")
                         for scope in ("col", "row"))
        self.check((columns, rows) == (["warm", "white", "cool", "night"], ["0.1", "0.4", "0.8"]), f"the grid has {columns} and {rows}")
        corner = self.text(".wedge-grid .corner")
        self.check("Case roughness" in corner and "Key colour" in corner, f"its axes are called {corner}")
        sizes = self.window.run("return Array.from(new Set(Array.from(document.querySelectorAll('.wedge-grid img'), (e) => Math.round(e.clientWidth))))")
        self.check(len(sizes) == 1, f"its frames are of sizes {sizes}")
        last = "return document.querySelector('.wedge-grid tbody tr:nth-child(2) td:nth-child(4) button').dataset.entry"
        self.check(int(self.window.run(last)) == self.expected["labels"].index("12_07"), "row 2, column 3 is another frame")
        self.window.screenshot(self.folder / "grid.png")
        self.window.click(".unfolded .flip")
        shown = "return document.querySelector('.flip-book .page').dataset.entry"
        first = self.window.run(shown)
        self.window.wait(shown.replace("entry;", "entry") + " !== arguments[0]", first)
        self.window.click(".unfolded .flip")

    def pairs(self):
        """A pinned, B chosen, swapped; all of it in the link."""
        self.open("#step=5")
        self.wait_for(5)
        self.check(self.window.run(VIEW).startswith("A: 0 "), f"an option is not held against the base: {self.window.run(VIEW)}")
        self.window.key("a")
        self.window.key("ArrowRight")
        self.wait_for(6)
        self.check(self.window.run(VIEW) == f"A: {self.title(5)}. B: {self.title(6)}", f"pinned: {self.window.run(VIEW)}")
        self.window.key("x")
        self.wait_for(5)
        self.check(self.window.run(VIEW) == f"A: {self.title(6)}. B: {self.title(5)}", f"swapped: {self.window.run(VIEW)}")
        self.choose("choose-b", "9")
        self.wait_for(9)
        self.window.key("f")
        plain = self.window.run(CANVAS)
        for _ in range(3):
            self.window.key("]")
        self.check(self.window.run(CANVAS) != plain, "the difference times 8 is not brighter")
        self.window.key("+")
        self.window.key("e")
        self.window.wait("return /gain=3/.test(location.hash) && /display=/.test(location.hash)")
        link, shown = self.window.run("return location.hash"), self.window.run(CANVAS)
        for part in ("step=9", "a=6", "mode=difference", "gain=3", "zoom=", "view=review"):
            self.check(part in link, f"the link {link} lacks {part}")
        self.window.run("localStorage.clear()")
        self.open(link)
        self.wait_for(9)
        self.check(self.window.run(CANVAS) == shown, "the link shows something else")
        self.check(self.pressed("[data-mode=difference]") and self.text("#gain-text") == "3", "the link's mode is another one")
        self.open("#step=9&view=review&mode=difference&a=9")
        self.wait_for(9)
        self.open("#sheet&view=review&layout=cards")
        self.window.run("document.querySelector('.card[data-item=\"4\"] .open').focus()")
        self.window.key("a")
        self.check(self.window.run("return document.querySelector('.pinned .name').textContent") == self.title(4), "a does not pin in the sheet")
        self.window.click(".card[data-item='8'] .open")
        self.wait_for(8)
        self.check(self.window.run(VIEW) == f"A: {self.title(4)}. B: {self.title(8)}", f"from the sheet: {self.window.run(VIEW)}")

    def notes(self):
        """Kept by the browser, sent as a file."""
        self.open("#step=7")
        self.wait_for(7)
        self.window.key("Shift", "4")
        self.window.key("y")
        self.window.key("m")
        self.window.type("#review-note", "warmer, a <b>little</b>")
        self.window.key("Escape")
        self.window.key("ArrowRight")
        self.wait_for(8)
        self.window.click("#side-review [data-stars='2']")
        self.window.click("#side-review [data-verdict=rejected]")
        self.open("#sheet&view=review&layout=cards")
        self.check("★★★★" in self.marks(7) and "approved" in self.marks(7) and "warmer, a <b>little</b>" in self.marks(7), f"7 has {self.marks(7)}")
        self.check("rejected" in self.marks(8), f"8 has {self.marks(8)}")
        for value, wanted in (("approved", [7]), ("rejected", [8]), ("starred", [7, 8]), ("noted", [7])):
            self.choose("verdict-filter", value)
            self.check(self.cards(len(wanted)) == [self.title(entry) for entry in wanted], f"{value}: {self.window.run(CARDS)}")
        self.choose("verdict-filter", "all")
        self.choose("sort", "stars")
        self.check(self.cards(67)[:2] == [self.title(7), self.title(8)], f"by stars: {self.window.run(CARDS)[:3]}")
        self.choose("sort", "order")
        self.window.run(EXPORTED)
        self.window.click("#export-reviews")
        file = self.folder / "notes.json"
        file.write_text(self.window.wait("return exported"))
        said = json.loads(file.read_text())
        self.check([(step["label"], step["stars"], step["verdict"]) for step in said["steps"]] == [("7", 4, "approved"), ("8", 2, "rejected")], f"the file says {said}")
        self.check("secret" not in file.read_text(), "a path of the server stands in the file")
        said["steps"].append({"label": "9", "name": self.expected["names"][9], "stars": 5, "verdict": "", "note": ""})
        said["steps"].append({"label": "900", "name": "of another run", "stars": 5, "verdict": "", "note": ""})
        file.write_text(json.dumps(said))
        self.window.run("localStorage.clear()")
        self.open("#sheet&view=review&layout=cards")
        self.check("approved" not in self.marks(7), "notes are not kept by the browser alone")
        self.window.type("#import-file", str(file))
        self.window.wait("return document.getElementById('sheet-count').textContent.startsWith('3 frames have their notes from the file; 1 ')")
        self.check("★★★★" in self.marks(7) and "★★★★★" in self.marks(9), "a file's notes do not show")

    def finds(self):
        for search, wanted in (("velvet", ["17"]), ("client ASKED", ["5"]), ("key colour", ["12"]), ("night", ["12"]), ("warmer", ["7"]), ("nowhere", [])):
            self.choose("search", search, "input")
            found = [name.split()[0] for name in self.cards(len(wanted))]
            self.check(found == wanted, f"{search}: {found}")
        self.choose("search", "", "input")
        self.choose("sort", "pixels")
        steps = json.loads((self.run / "report.json").read_text())["steps"]
        most = max((step for step in steps), key=lambda step: step["pixels_changed"])
        self.check(self.cards(67)[0].split()[0] == str(most["step"]), f"most pixels: {self.window.run(CARDS)[0]}")
        self.choose("sort", "order")

    def theme(self):
        scheme = self.window.run("return page.scheme()")
        self.window.key("d")
        self.open()
        self.check(self.window.run("return page.scheme()") != scheme, "the theme is not remembered")

    def focus(self):
        for link, count in (("#sheet", 14), ("#step=11_02", 30)):
            self.open(link)
            seen = set()
            for _ in range(count):
                self.window.key("Tab")
                name, is_visible = self.window.run(FOCUS)
                seen.add(name)
                self.check(is_visible or name.startswith("BODY"), f"{link}: the focus is not to be seen on {name}")
            self.check(len(seen) >= count * 0.6, f"{link}: Tab reaches {sorted(seen)} only")

    def phone(self):
        self.window.size(390, 844, True)
        self.open("#sheet&view=review&layout=cards")
        columns = self.window.run("return getComputedStyle(document.getElementById('sheet-list')).gridTemplateColumns.split(' ').length")
        self.check(columns == 2, f"a phone's sheet has {columns} columns")
        self.check(self.window.run("return document.documentElement.scrollWidth") <= 390, "a phone's sheet is too wide")
        self.faults += [f"phone: too small for a finger: {what}" for what in self.window.run(SMALL)]
        self.window.screenshot(self.folder / "phone_sheet.png")
        self.open("#step=5")
        self.wait_for(5)
        x, y, width, height = self.window.run(BOX, "#view")
        self.check(y < 70 and width > 380 and height > 200, f"a phone's picture is at {x}, {y}, {width} x {height}")
        self.check(self.window.run("return document.documentElement.scrollWidth") <= 390, "a phone's step is too wide")
        self.faults += [f"phone: too small for a finger: {what}" for what in self.window.run(SMALL)]
        swipe = lambda start, end: self.window.touch(*[(x + width * (start + (end - start) * i / 4), y + height * 0.3) for i in range(5)])
        swipe(0.35, 0.05)
        self.wait_for(6)
        swipe(0.65, 0.95)
        self.wait_for(5)
        plain = self.window.run(CANVAS)
        swipe(0.5, 0.2)  # the wipe's line
        self.check(self.text("#step-name") == self.title(5) and self.window.run(CANVAS) != plain, "a finger does not move the wipe")
        self.window.screenshot(self.folder / "phone_step.png")
        self.window.size(1440, 900)

    def paper(self):
        self.open("#sheet")
        self.window.command("Emulation.setEmulatedMedia", media="print")
        columns = self.window.run("return getComputedStyle(document.getElementById('sheet-list')).gridTemplateColumns.split(' ').length")
        self.check(columns == 3, f"paper has {columns} columns")
        widths = self.window.run("return Array.from(new Set(Array.from(document.querySelectorAll('.card'), (e) => Math.round(e.getBoundingClientRect().width / 4))))")
        self.check(len(widths) == 1, f"cards on paper are {widths} wide")
        controls = self.window.run("return Array.from(document.querySelectorAll('select, input, header button, .tools button, .bar button'))"
                                   ".filter((e) => e.getBoundingClientRect().width > 0).length")
        self.check(controls == 0, f"{controls} controls on paper")
        self.check("looks" in self.window.run("return document.querySelector('header').innerText"), "no title on paper")
        self.window.screenshot(self.folder / "paper.png")
        self.window.command("Emulation.setEmulatedMedia", media="")

    def axe(self):
        file = os.environ.get("RELOOK_AXE")
        if not file:
            print("RELOOK_AXE names no axe.min.js: the page is NOT tried with axe-core")
            return
        axe = pathlib.Path(file).read_text()
        for is_phone in (False, True):
            self.window.size(*((390, 844) if is_phone else (1440, 900)), is_phone)
            for scheme in ("light", "dark"):
                self.window.run("page.setScheme(arguments[0])", scheme)
                for link in ("#sheet&view=review&unfolded=11,12", "#sheet&view=engineering&layout=cards", "#step=12_02&view=review",
                             "#step=7&view=engineering&mode=difference", "#plots&view=engineering", "#run&view=engineering"):
                    self.open(link)
                    self.faults += [f"axe-core, {scheme}, {link}: {fault}" for fault in self.window.serious_faults(axe)]
        self.window.size(1440, 900)


def main(run, expected_file, screenshots):
    if not browser.is_there():
        return 77
    window = browser.Browser()
    try:
        report = ReviewPage(window, run, json.loads(pathlib.Path(expected_file).read_text()))
        report.folder = pathlib.Path(screenshots)
        for use in (report.views, report.tree, report.folded, report.wedges, report.pairs, report.notes, report.finds, report.theme,
                    report.focus, report.phone, report.paper, report.axe):
            use()
        report.faults += window.complaints([report.run.as_uri() + "/"])
    finally:
        window.close()
    for fault in report.faults:
        print(fault)
    return 1 if report.faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
