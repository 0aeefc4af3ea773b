#!/usr/bin/env python3
"""Two saves of a Blender file: what was changed between them becomes a step, and a frame.

usage: blender_rounds.py BEFORE.blend AFTER.blend FOLDER [--resolution WxH] [--samples N] [--blender PROGRAM]

Exports both (../from_blender.py), writes FOLDER/before.cache and FOLDER/changes.json, and replays it with --verify into
FOLDER/run. What glTF cannot hold (area lights, the world) is in the look patches beside the exports: what differs
between these is a step of its own.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "cli/python"), str(HERE.parents[2] / "python")]  # sources; as installed
import relook  # noqa: E402


def exported(blender, scene, out):
    """Exports a .blend to a .glb; its look patch, which may be empty."""
    program = shutil.which(blender) or sys.exit(f"{blender}: no such program")
    words = [program, "-b", str(scene), "--python-exit-code", "3", "--python", str(HERE.parent / "from_blender.py")]
    # Debian's Blender takes the modules of the first python3 on PATH for its own.
    plain = {**os.environ, "PATH": f"{os.path.dirname(program)}:{os.defpath}"}
    result = subprocess.run([*words, "--", str(out)], env=plain, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            text=True)
    patch = out.with_suffix(".look.json")
    if result.returncode != 0 or not out.exists():
        sys.exit(f"{scene}: not exported:\n{result.stdout}")
    return json.loads(patch.read_text()) if patch.exists() else []


def difference(before, after, steps):
    """The operations that make one look patch of the other, each of which gives a place one value; `steps`: what the
    journal does before, so that what is deleted there is not deleted again."""
    old, new = ({edit["path"]: edit for edit in patch} for patch in (before, after))
    gone = tuple(edit["path"] + "/" for step in steps for edit in step["edit"] if edit["op"] == "remove")
    changed = [edit for path, edit in new.items() if old.get(path) != edit]
    return changed + [relook.remove(path) for path in old if path not in new and not (path + "/").startswith(gone)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--resolution", default="960x540")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--blender", default="blender")
    arguments = parser.parse_args()
    folder = arguments.folder
    folder.mkdir(parents=True, exist_ok=True)
    a, b = folder / "before.glb", folder / "after.glb"
    patches = [exported(arguments.blender, scene, out) for scene, out in ((arguments.before, a), (arguments.after, b))]
    look = folder / "before.look.json" if patches[0] else None
    relook.preprocess(a, folder / "before.cache", look=look, resolution=arguments.resolution, samples=arguments.samples)

    drafted, path = folder / "geometry.json", folder / "changes.json"
    relook.journal_from("diff", a, b, out=drafted)
    journal = relook.Journal()
    journal.steps = [{**step, "name": "objects and materials"} for step in relook.Journal.read(drafted).steps
                     if step["edit"]]
    operations = difference(*patches, journal.steps)
    if operations:
        journal.edit("lights and world", operations)
    if not journal.steps:
        print("nothing has changed")
        return
    journal.write(path)
    report = relook.replay(folder / "before.cache", path, folder / "run", verify=True)
    for entry in report.steps[1:]:
        print(f"{entry.label} {entry.name}: {entry.pixels_changed} pixels changed; {'; '.join(entry.reasons[:3])}")


if __name__ == "__main__":
    try:
        main()
    except relook.RelookError as error:
        sys.exit(f"relook: {error}")
