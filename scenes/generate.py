"""Writes the scenes of this folder and the files that the journals add to them.

usage: python3 generate.py spheres|garden|product|journal-files FOLDER
       python3 generate.py garden FOLDER LEAVES    another number of leaves a tree than 275

Standard library only; the same bytes in every run.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True

import garden
import images
import product
import shapes
import spheres
from gltf import Gltf, write_glb


def write_journal_files(folder):
    """What table1.json adds to `spheres`: an image, a sky, and a small model."""
    images.write_png(os.path.join(folder, "files", "weave.png"), 64, lambda u, v: (
        (0.85, 0.75, 0.3) if (int(u * 8) + int(v * 8)) % 2 else (0.2, 0.3, 0.5)))
    images.write_sky(os.path.join(folder, "files", "evening.hdr"))
    gltf = Gltf("obelisk")
    copper = gltf.add_material("Copper", (0.95, 0.55, 0.35), 1.0, 0.2)
    needle = shapes.revolve([(0.22, 0.0), (0.16, 1.0), (0.16, 1.0), (0.0, 1.25)], 4)
    gltf.add_node("Needle", mesh=gltf.add_mesh("Needle", (gltf.add_geometry(needle), copper)))
    write_glb(gltf, os.path.join(folder, "files", "obelisk.glb"))


def main(arguments):
    writers = {"spheres": spheres.write, "garden": garden.write, "product": product.write,
               "journal-files": write_journal_files}
    if len(arguments) == 3 and arguments[0] == "garden" and arguments[2].isdigit():
        garden.write(arguments[1], int(arguments[2]))
        return 0
    if len(arguments) != 2 or arguments[0] not in writers:
        print("usage: python3 generate.py %s FOLDER, or garden FOLDER LEAVES" % "|".join(writers), file=sys.stderr)
        return 1
    writers[arguments[0]](arguments[1])
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
