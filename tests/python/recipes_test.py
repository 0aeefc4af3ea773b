"""The recipes of scenes/recipes, as files: a farm's chunks add up, layers are those that frames have, two saves of a
Blender file become a journal. python3 tests/python/recipes_test.py [CASE], with $RELOOK set; tests/cli/python_test.cpp
does that. Exit code 77: what the recipe is for is not installed.
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
RECIPES = SOURCE / "scenes/recipes"
SCENE = SOURCE / "scenes/spheres/spheres.gltf"
sys.path.insert(0, str(SOURCE / "cli/python"))
import relook  # noqa: E402

SYSTEM_PYTHON = "/usr/bin/python3"  # the one that Debian's packages are for
BLENDER_SCENE = """
import bpy, sys
folder, scene = sys.argv[-1], bpy.context.scene
lamp = bpy.data.lights.new("Key", "AREA")
lamp.energy, place = 100, bpy.data.objects.new("Key", lamp)
scene.collection.objects.link(place)
place.location, place.rotation_euler = (2, -2, 3), (0.6, 0.5, 0.3)
bpy.ops.wm.save_as_mainfile(filepath=folder + "/before.blend")
bpy.data.objects["Cube"].location.x = 0.5
lamp.energy = 250
bpy.data.objects.remove(bpy.data.objects["Light"])
bpy.ops.wm.save_as_mainfile(filepath=folder + "/after.blend")
"""


def recipe(name, *arguments, python=sys.executable):
    result = subprocess.run([python, str(RECIPES / name), *map(str, arguments)], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)
    return result.returncode, result.stdout


class Recipe(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def run_recipe(self, *words, **options):
        code, output = recipe(*words, **options)
        self.assertEqual(code, 0, output)
        return output


class Farm(Recipe):
    def test_chunks_add_up_to_a_whole_run(self):
        cache, journal = self.folder / "cache", self.folder / "looks.json"
        relook.preprocess(SCENE, cache, integrator="whitted", resolution=(64, 36))
        looks = relook.Journal()
        for step in range(6):
            looks.edit(f"lamp {step}", [relook.replace("/lights/Lamp/intensity", 20 + step)])
        looks.write(journal)
        whole = relook.replay(cache, journal, self.folder / "whole")
        output = self.run_recipe("farm.py", cache, journal, self.folder / "run", "--seconds", 1e-9, "--local", 2)
        self.assertIn("6 tasks: 0-1 2-2", output)
        report = relook.Report.read(self.folder / "run")
        self.assertEqual([step.frame.read_bytes() for step in report.frames()],
                         [step.frame.read_bytes() for step in whole.frames()])
        self.run_recipe("farm.py", cache, journal, self.folder / "run", "--seconds", 1e-9)
        script = self.folder / "run.sbatch"
        self.assertEqual(subprocess.run(["bash", "-n", str(script)]).returncode, 0)
        self.assertIn("#SBATCH --array=0-5\n", script.read_text())
        once = subprocess.run(["bash", str(script)], env={**os.environ, "SLURM_ARRAY_TASK_ID": "3"})
        self.assertEqual(once.returncode, 0)


class Layers(Recipe):
    def setUp(self):
        super().setUp()
        self.frame = self.folder / "frame.exr"
        relook.render(SCENE, self.frame, aovs=True, resolution=(48, 27), samples=2)

    def test_of_a_nuke_script_are_those_of_the_frame(self):
        output = self.run_recipe("nuke_layers.py", self.frame, self.folder / "comp.nk")
        self.assertIn("light_Lamp", output)
        text = (self.folder / "comp.nk").read_text()
        self.assertEqual(text.count("{"), text.count("}"))
        named = set(re.findall(r"^ in1 (\S+)$", text, re.M))
        self.assertEqual(named, set(re.findall(r"^add_layer \{(\S+) ", text, re.M)))
        header = subprocess.run(["exrheader", str(self.frame)], stdout=subprocess.PIPE, text=True).stdout
        lights = re.search(r'relook:lights .*: "(.*)"', header)[1].split()
        self.assertEqual(named, set(lights))
        for light in lights:
            for channel in "RGB":
                self.assertRegex(header, rf"\n +{light}\.{channel}, ")
        self.assertEqual(text.count("Merge2 {"), len(lights) - 1)
        relook.render(SCENE, self.folder / "plain.exr", resolution=(48, 27), samples=1)
        code, output = recipe("nuke_layers.py", self.folder / "plain.exr", self.folder / "none.nk")
        self.assertEqual((code, "--aovs" in output), (1, True))

    def test_add_up_to_the_frame(self):
        if subprocess.run([SYSTEM_PYTHON, "-c", "import OpenImageIO, numpy"], stderr=subprocess.DEVNULL).returncode:
            sys.exit(skip("python3-openimageio is not installed: read_layers.py is NOT tried"))
        output = self.run_recipe("read_layers.py", self.frame, python=SYSTEM_PYTHON)
        self.assertIn("added up: 0 pixels differ from the frame", output)
        self.assertIn("light_Lamp: R G B  (a light)", output)
        mixed = self.folder / "mixed.exr"
        self.run_recipe("read_layers.py", self.frame, "--gain", "light_Lamp=0.5", "-o", mixed, python=SYSTEM_PYTHON)
        dimmed = relook.Journal()
        dimmed.edit("half", [relook.replace("/lights/Lamp/intensity", 75)])
        path = dimmed.write(self.folder / "half.json")
        relook.render(SCENE, self.folder / "half.exr", journal=path, float=True, resolution=(48, 27), samples=2)
        self.run_recipe("read_layers.py", self.frame, python=SYSTEM_PYTHON)
        figures = relook.compare(self.folder / "half.exr", mixed)[1]["frames"]["mixed.exr"]
        self.assertLess(figures["max_error"], 1e-4)


class Blender(Recipe):
    def test_two_saves_become_a_journal(self):
        (self.folder / "make.py").write_text(BLENDER_SCENE)
        words = ["blender", "-b", "--factory-startup", "--python", str(self.folder / "make.py"), "--", str(self.folder)]
        try:
            subprocess.run(words, stdout=subprocess.DEVNULL, check=True)
        except (OSError, subprocess.CalledProcessError):
            sys.exit(skip("Blender is not installed: blender_rounds.py is NOT tried"))
        small = ("--resolution", "48x27", "--samples", 2)
        saves = [self.folder / name for name in ("before.blend", "after.blend")]
        code, output = recipe("blender_rounds.py", *saves, self.folder / "rounds", *small)
        if "needs numpy" in output:
            sys.exit(skip("Blender's Python has no numpy, which its glTF exporter needs"))
        self.assertEqual(code, 0, output)
        rounds = self.folder / "rounds"
        relook.render(rounds / "after.glb", rounds / "after.exr", look=rounds / "after.look.json", resolution=(48, 27),
                      samples=2)
        last = relook.Report.read(rounds / "run").steps[-1]
        self.assertTrue(relook.compare(last.frame, rounds / "after.exr", exact=True)[0], output)
        output = self.run_recipe("blender_rounds.py", saves[0], saves[0], self.folder / "same", *small)
        self.assertIn("nothing has changed", output)


def skip(reason):
    print(reason)
    return 77


if __name__ == "__main__":
    unittest.main()
