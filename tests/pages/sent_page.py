"""Pages to send and to choose from, in a browser: python3 sent_page.py FOLDER SCREENSHOTS. FOLDER has one.html (a single file at 1/2),
all.html (several runs), runs/index.html and compare.html, as tests/report/report_verb_test.cpp makes them."""

import base64
import pathlib
import sys

import browser


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def main(folder, shots):
    window = browser.Browser()
    try:
        def open_page(name, ready):
            window.open((folder / name.split("?")[0].split("#")[0]).as_uri() + name[len(name.split("?")[0].split("#")[0]):])
            window.wait(ready)
            stem = "".join(c if c.isalnum() else "_" for c in name)
            picture = window.command("Page.captureScreenshot", format="png")["data"]
            (shots / f"sent_{stem}.png").write_bytes(base64.b64decode(picture))

        painted = "return document.documentElement.dataset.painted"
        cards = "return document.querySelectorAll('.runs > li').length"
        open_page("one.html#step=1", painted)
        check("pixels at 1/2" in window.run("return document.querySelector('#facts').textContent"), "the scale is said")
        check("Not in this page" in window.run("return document.querySelector('#side').textContent"), "what is not there is said")
        check(window.run("return document.querySelectorAll('#side .links a').length") == 0, "no link to what is not there")
        open_page("runs/index.html", cards)
        check(window.run(cards) == 2, "a card a run")
        check(window.run("return [...document.images].every((image) => image.naturalWidth > 0 && image.alt)"), "pictures, with text")
        window.click(".runs h2 a")
        window.wait("return document.querySelectorAll('#sheet-list li').length")
        check(window.run("return location.pathname.endsWith('/j/report.html')"), "to the run's own page")
        open_page("all.html", cards)
        check(window.run("return document.querySelector('#one-run').hidden"), "cards alone")
        window.click(".runs > li:nth-child(2) h2 a")
        window.wait("return document.querySelectorAll('#sheet-list li').length")
        check(window.run("return document.querySelector('#title').textContent") == "k", "the second run")
        check(window.run("return document.querySelector('#runs').hidden"), "no cards beside it")
        open_page("compare.html", painted)
        check(window.run("return document.documentElement.dataset.hasDifference") == "true", "linear pixels of both")
        count = window.run("return document.querySelectorAll('#compare-list button').length")
        check(count > 1, "several frames")
        means = window.run("return page.data('compared').frames.map(({facts}) => Number(facts.find(([name]) => name === 'FLIP, mean')[1]))")
        check(means == sorted(means, reverse=True), f"the worst first: {means}")
        window.key("ArrowDown")
        window.wait("return document.documentElement.dataset.painted === '1'")
        window.key("f")
        check("differ" in window.wait("return comparison.pair.viewer.names.difference"), "the difference is counted")
        check(window.run("return location.hash.startsWith('#frame=')") or window.wait("return location.hash.startsWith('#frame=')"), "a link")
    finally:
        window.close()


if __name__ == "__main__":
    if not browser.is_there():
        sys.exit(77)
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
