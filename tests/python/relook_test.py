"""cli/python/relook.py with the program ($RELOOK) on scenes/spheres: journals, verbs, progress, errors, cancelling.

python3 tests/python/relook_test.py, with $RELOOK set; tests/cli/python_test.cpp does that.
"""

import doctest
import json
import sys
import tempfile
import threading
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
SCENE = SOURCE / "scenes/spheres/spheres.gltf"
sys.path.insert(0, str(SOURCE / "cli/python"))
import relook  # noqa: E402

PAINT = "/materials/Paint/pbrMetallicRoughness/baseColorFactor"
LAMP = "/lights/Lamp/intensity"
VIEW = {"integrator": "whitted", "resolution": (48, 27)}


def looks():
    """A colour, a move and a wedge."""
    journal = relook.Journal()
    journal.edit("green", [relook.replace(PAINT, [0.1, 0.9, 0.1, 1])])
    journal.drag("slide", ["/nodes/CentralSphere"],
                 [[relook.replace("/nodes/CentralSphere/translation", [x / 10, 1, 0])] for x in (1, 2)])
    journal.wedge("lamp", relook.Axis(LAMP, span=relook.Span(50, 200, count=3)))
    return journal


class Journals(unittest.TestCase):
    def test_have_what_the_format_has(self):
        journal = relook.Journal(note="round one", author="mk", extras={"shot": 12})
        journal.edit("green", [relook.replace(PAINT, [0, 1, 0, 1])], from_="base", note="as asked")
        grid = [relook.Axis(LAMP, span=relook.Span(10, 1000, step=10, scale="log"), label="lamp"),
                relook.Axis(PAINT, values=[[1, 0, 0, 1], [0, 0, 1, 1]], labels=["red", "blue"])]
        journal.wedge("grid", grid, from_="green", keep=False, extras=[1])
        journal.drag("slide", ["/nodes/Cube"], [[relook.replace("/nodes/Cube/translation/0", 1)]], from_=0)
        content = journal.to_json()
        self.assertEqual({key: content[key] for key in ("relook", "note", "author", "extras")},
                         {"relook": "journal/1", "note": "round one", "author": "mk", "extras": {"shot": 12}})
        self.assertEqual(content["steps"][0], {"name": "green", "note": "as asked", "from": "base",
                                               "edit": [{"op": "replace", "path": PAINT, "value": [0, 1, 0, 1]}]})
        self.assertEqual(content["steps"][1]["wedge"][0],
                         {"path": LAMP, "range": {"from": 10, "to": 1000, "step": 10, "scale": "log"}, "label": "lamp"})
        self.assertEqual((content["steps"][1]["from"], content["steps"][1]["keep"]), ("green", False))
        self.assertEqual(content["steps"][2]["from"], 0)

    def test_refuse_what_no_scene_could_take(self):
        journal = relook.Journal()
        journal.edit("a", [])
        journal.edit("b", [])
        journal.edit("b", [])
        for start in ("c", "b", 4, -1):
            with self.assertRaisesRegex(ValueError, str(start)):
                journal.edit("d", [], from_=start)
        self.assertEqual(len(journal.steps), 3)
        with self.assertRaises(ValueError):
            journal.edit("base", [])
        for axis in (relook.Axis(LAMP), relook.Axis(LAMP, values=[1], span=relook.Span(0, 1, count=2)),
                     relook.Axis(LAMP, values=[1, 2], labels=["one"]), relook.Axis("lights", values=[1]),
                     relook.Axis(LAMP, span=relook.Span(0, 1))):
            with self.assertRaises(ValueError):
                journal.wedge("w", axis)
        with self.assertRaises(ValueError):
            journal.wedge("w", [])

    def test_are_the_same_after_writing_and_reading(self):
        with tempfile.TemporaryDirectory() as folder:
            path = looks().write(Path(folder) / "looks.json")
            self.assertEqual(relook.Journal.read(path).to_json(), looks().to_json())
            self.assertEqual([entry.name for entry in Path(folder).iterdir()], ["looks.json"])
            path.write_text("{}")
            with self.assertRaises(relook.InputError):
                relook.Journal.read(path)


class Picks(unittest.TestCase):
    def test_are_what_the_page_exports(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "notes.json"
            exported = {"relook": "reviews/1", "scene": {"file": "s.glb", "hash": "1"},
                        "journal": {"file": "j", "hash": "2"},
                        "steps": [{"label": "1", "name": "gold", "stars": 2, "verdict": "approved", "note": "ü"},
                                  {"label": "2_01", "name": "key", "stars": 5, "verdict": "approved", "note": ""},
                                  {"label": "2_02", "name": "key", "stars": 5, "verdict": "rejected", "note": ""}]}
            path.write_text(json.dumps(exported), encoding="utf-8")
            reviews = relook.Reviews.read(path)
            self.assertEqual([review.label for review in reviews.approved()], ["2_01", "1"])
            reviews.write(path)
            self.assertEqual(json.loads(path.read_text(encoding="utf-8")), exported)
            path.write_text("[]")
            with self.assertRaises(relook.InputError):
                relook.Reviews.read(path)


class Program(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        cls.cache, cls.journal = cls.folder / "cache", cls.folder / "looks.json"
        cls.made = relook.preprocess(SCENE, cls.cache, **VIEW)
        looks().write(cls.journal)
        cls.events = []
        cls.report = relook.replay(cls.cache, cls.journal, cls.folder / "run", verify=True, progress=cls.events.append)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_reports_are_read(self):
        report = relook.Report.read(self.folder / "run" / "report.json")
        self.assertEqual(report, self.report)
        self.assertTrue(report.is_exact)
        self.assertEqual(report.resolution, (48, 27))
        self.assertEqual([entry.label for entry in report.frames()], ["0", "1", "2_01", "2_02", "3_01", "3_02", "3_03"])
        self.assertTrue(all(entry.frame.is_file() and entry.preview.is_file() for entry in report.steps))
        self.assertEqual([report.step(which).kind for which in ("green", 2, "3_01")], ["color", "geometric", "color"])
        self.assertGreater(report.step("green").pixels_changed, 0)
        with self.assertRaises(KeyError):
            report.step("grene")
        with self.assertRaises(relook.FileError):
            relook.Report.read(self.folder)
        with self.assertRaises(relook.InputError):
            relook.Report.read(self.looks_as_report())

    def looks_as_report(self):
        folder = self.folder / "other"
        folder.mkdir(exist_ok=True)
        (folder / "report.json").write_bytes(self.journal.read_bytes())
        return folder

    def test_progress_is_told(self):
        steps = [event.step for event in self.events if event.step]
        self.assertEqual(steps[:2], ["step 0 base", "step 1 green"])
        percents = [event.percent for event in self.events if event.percent is not None]
        self.assertEqual(percents, sorted(percents))
        self.assertIn(100, [event.stage_percent for event in self.events])
        self.assertTrue(any(event.message and "verified: 0 of" in event.message for event in self.events))

    def test_every_verb_answers(self):
        self.assertEqual(relook.inspect(self.cache)["content"]["integrator"], "whitted")
        self.assertEqual([step["class"] for step in relook.check(looks(), SCENE, integrator="whitted")][0], "color")
        self.assertEqual(len(relook.check(self.journal, self.cache)), 6)
        self.assertEqual(relook.plan(self.cache, self.journal)["relook"], "plan/1")
        self.assertEqual(relook.chunks(relook.plan(self.cache, self.journal), 1e9), ["0-3"])
        frame = relook.render(SCENE, self.folder / "one.exr", journal=self.journal, step=1, **VIEW)
        self.assertEqual(frame["resolution"], [48, 27])
        self.assertTrue(relook.compare(self.folder / "one.exr", self.report.step(1).frame)[0])
        self.assertFalse(relook.compare(self.folder / "one.exr", self.report.step(0).frame, exact=True)[0])
        self.assertIn("changes", relook.blame(self.folder / "run", 24, 13))
        made = relook.journal_from("wedge", SCENE, LAMP, "1..9:3", out=self.folder / "wedge.json")
        self.assertEqual(made["frames"], 3)
        look = relook.Look.of(SCENE)
        self.assertIn(PAINT, look)
        self.assertEqual(dict(look.paths("/lights/*/intensity")), {LAMP: 150.0})
        self.assertTrue(relook.run("check", self.cache, json=True).json["sound"])

    def test_warnings_are_kept(self):
        with_idle = relook.Journal()
        with_idle.edit("as it is", [relook.replace(LAMP, 150)])
        result = relook.run("inspect", "-", stdin=json.dumps(with_idle.to_json()), scene=SCENE, json=True)
        self.assertIn("changes nothing", " ".join(result.warnings))

    def test_errors_name_file_and_place(self):
        wrong = looks()
        wrong.edit("gold", [relook.replace("/materials/Pant/alphaMode", "OPAQUE")])
        wrong.edit("red", [relook.replace("/lights/Lmp/intensity", 1)])
        path = wrong.write(self.folder / "wrong.json")
        with self.assertRaises(relook.InputError) as caught:
            relook.replay(self.cache, path, self.folder / "none")
        error = caught.exception
        self.assertEqual((error.exit_code, error.file, error.place), (2, str(path), "/steps/3/edit/0/path"))
        self.assertIn('did you mean "Paint"?', error.message)
        self.assertEqual(len(error.errors), 2)
        with self.assertRaises(relook.UsageError) as usage:
            relook.run("replay", self.cache, self.journal)
        self.assertIn("--output", usage.exception.message)
        with self.assertRaises(relook.UsageError):
            relook.run("render", SCENE, output=self.folder / "f.exr", sampels=3)
        with self.assertRaises(relook.CacheMismatch):
            relook.replay(self.cache, self.journal, self.folder / "none", integrator="path")
        with self.assertRaises(relook.InputError) as missing:
            relook.preprocess(self.folder / "no.glb", self.folder / "none")
        self.assertEqual(missing.exception.file, str(self.folder / "no.glb"))

    def test_a_callback_that_throws_ends_the_program(self):
        def stop(event):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            relook.preprocess(SCENE, self.folder / "stopped", resolution=(1920, 1080), progress=stop)
        self.assertFalse((self.folder / "stopped").exists())

    def test_cancelling_raises_and_the_same_call_goes_on(self):
        long = relook.Journal()
        long.wedge("turn", relook.Axis("/nodes/CentralSphere/translation/0", span=relook.Span(0, 1, count=200)))
        path = long.write(self.folder / "long.json")
        process = relook.Process("replay", self.cache, path, output=self.folder / "long", baseline=True)
        seen = threading.Event()

        def watch(event):
            if event.step and "1_1" in event.step and not seen.is_set():
                seen.set()
                threading.Thread(target=process.cancel).start()

        with self.assertRaises(relook.Cancelled) as caught:
            process.wait(watch)
        self.assertEqual(caught.exception.exit_code, 128 + 15)
        frames = len(list((self.folder / "long/frames").iterdir()))
        self.assertGreater(frames, 5)
        self.assertLess(frames, 201)
        report = relook.replay(self.cache, path, self.folder / "long")
        self.assertEqual(len(report.frames()), 201)


def load_tests(loader, tests, pattern):
    tests.addTests(doctest.DocTestSuite(relook))
    return tests


if __name__ == "__main__":
    unittest.main()
