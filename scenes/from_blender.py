"""Exports a Blender scene for relook: glTF by Blender's own exporter, beside it a look patch with what that drops.

usage: blender -b SCENE.blend --python scenes/from_blender.py -- OUT.glb [--units watts|lumens]

Writes OUT.glb (or .gltf), OUT.look.json for `relook --look`, and OUT_world.hdr or .exr if the world has an image.
Prints how to go on. What neither of the files can say is warned of on stderr, a line each. Blender 3.4 or later.

Units: Cycles computes W/sr, W/m2 and W/(m2 sr) from a lamp's watts (blender/lights.py says how), and takes the world's
and materials' strengths as W/(m2 sr). `watts`, the default, writes these numbers for candela, lux and nits, as the
exporter's mode "Unitless" does: a pixel then has the value that it has in Blender. `lumens` multiplies all of them by
683, as the exporter's mode "Standard" does with lamps alone. (Its mode "Raw" writes watts where candela belong.)
"""

import json
import math
import os
import sys

try:
    import bpy
except ImportError:
    sys.exit("from_blender.py: runs inside Blender: blender -b SCENE.blend --python from_blender.py -- OUT.glb")

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True

from blender.common import Unsupported, rounded, warn
from blender.exported import export, names_of, pointer
from blender.lights import light_edits
from blender.world import environment_edits

UNITS = {"watts": 1.0, "lumens": 683.0}
LOST_TYPES = ("META", "VOLUME", "GPENCIL", "GREASEPENCIL", "CURVES", "POINTCLOUD")
USAGE = "usage: blender -b SCENE.blend --python scenes/from_blender.py -- OUT.glb [--units watts|lumens]"


def parsed(arguments):
    """(path, unit) of the arguments after --."""
    units, files = "watts", []
    words = list(arguments)
    while words:
        word = words.pop(0)
        if word == "--units" and words:
            units = words.pop(0)
        else:
            files.append(word)
    if len(files) != 1 or units not in UNITS or files[0].startswith("-"):
        raise Unsupported(USAGE)
    path = os.path.abspath(files[0])
    if os.path.splitext(path)[1] not in (".glb", ".gltf"):
        raise Unsupported("%s: must end in .glb or .gltf" % files[0])
    if not os.path.isdir(os.path.dirname(path)):
        raise Unsupported("%s: there is no such folder" % os.path.dirname(path))
    return path, UNITS[units]


def emission_edits(exported, unit):
    """Emitting materials in the lamps' unit."""
    if unit == 1:
        return []
    materials, edits = exported.gltf.get("materials", []), []
    for name, material in zip(names_of(materials, "material"), materials):
        if any(material.get("emissiveFactor", ())):
            strength = material.get("extensions", {}).get("KHR_materials_emissive_strength", {})
            where = ("extensions", "KHR_materials_emissive_strength", "emissiveStrength")
            edits.append({"op": "add", "path": pointer("materials", name, *where),
                          "value": rounded(unit * strength.get("emissiveStrength", 1.0))})
    return edits


def warn_of_objects(scene):
    lost = sorted(o.name for o in scene.objects if o.type in LOST_TYPES and not o.hide_render)
    for name in lost[:10]:
        warn("object \"%s\": Blender's exporter leaves out objects of its type" % name)
    if len(lost) > 10:
        warn("and %d objects more" % (len(lost) - 10))


def view_of(scene, exported, unit):
    """The flags of relook that show what the scene's camera shows."""
    words = []
    cameras = exported.gltf.get("cameras", [])
    names = names_of(cameras, "camera")
    for node, source in sorted(exported.sources.items()):
        if source == scene.camera and "camera" in exported.nodes[node]:
            words += ["--camera", names[exported.nodes[node]["camera"]]]
            break
    share = scene.render.resolution_percentage / 100
    words += ["--resolution", "%dx%d" % (scene.render.resolution_x * share, scene.render.resolution_y * share)]
    stops = scene.view_settings.exposure - math.log2(unit)
    if abs(stops) > 1e-6:
        words += ["--exposure", "%.3g" % stops]
    return words


def lens_of(camera):
    """RADIUS:FOCUS in metres of a camera with depth of field, or None."""
    dof = camera.data.dof if camera is not None and camera.type == "CAMERA" else None
    if dof is None or not dof.use_dof or dof.aperture_fstop <= 0 or camera.data.type != "PERSP":
        return None
    focus = dof.focus_distance
    if dof.focus_object is not None:
        local = camera.matrix_world.normalized().inverted() @ dof.focus_object.matrix_world.translation
        focus = -local.z
    return "%.6g:%.6g" % (camera.data.lens / 1000 / (2 * dof.aperture_fstop), focus)


def quoted(word):
    return word if all(c.isalnum() or c in "-_./:,x" for c in word) else "'%s'" % word.replace("'", "'\\''")


def main(arguments):
    path, unit = parsed(arguments)
    scene = bpy.context.scene
    exported = export(path, "COMPAT" if unit == 1 else "SPEC")
    warn_of_objects(scene)
    stem = os.path.splitext(path)[0]
    images = set(names_of(exported.gltf.get("images", []), "image"))
    edits = (environment_edits(scene.world, unit, stem, images) + light_edits(exported, unit) +
             emission_edits(exported, unit))
    patch = stem + ".look.json"
    with open(patch, "w", encoding="utf-8") as file:
        file.write("[\n%s\n]\n" % ",\n".join("  " + json.dumps(edit, ensure_ascii=False) for edit in edits) if edits
                   else "[]\n")
    words = ["relook", "render", path, "-o", stem + ".exr", "--look", patch] + view_of(scene, exported, unit)
    lens = lens_of(scene.camera)
    if lens is not None:
        words += ["--lens", lens]
    print("from_blender.py: wrote %s and %s (%d edits)" % (path, patch, len(edits)))
    print("from_blender.py: " + " ".join(quoted(word) for word in words))


if __name__ == "__main__":
    try:
        main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    except (Unsupported, OSError) as error:
        sys.exit("from_blender.py: " + str(error))
