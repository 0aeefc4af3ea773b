"""Blender's glTF exporter, called and read: which node is made of which object, and what relook's look document calls
what is in the file (unique printable names, as src/scene/look/look.cpp forms them).
"""

import importlib.util
import json
import struct
import sys

import bpy
from mathutils import Matrix, Quaternion, Vector

from .common import Unsupported


def is_reordering(c):
    return c in "\u061c\u200e\u200f" or "\u2028" <= c <= "\u202e" or "\u2066" <= c <= "\u2069"


def printable(text):
    return "".join("?" if is_reordering(c) else c for c in text if not (c < " " or "\x7f" <= c < "\xa0"))


def unique(wanted, taken):
    name, i = wanted, 1
    while name in taken:
        i += 1
        name = "%s_%d" % (wanted, i)
    taken.add(name)
    return name


def names_of(items, noun):
    """The names of a glTF array in the look document; `noun`: of those without one."""
    taken = set()
    return [unique(printable(item.get("name") or "") or "%s_%d" % (noun, i), taken) for i, item in enumerate(items)]


def pointer(*tokens):
    return "".join("/" + token.replace("~", "~0").replace("/", "~1") for token in tokens)


class Exported:
    """A glTF file's JSON, and the Blender object of each node: {index: object}."""

    def __init__(self, path, sources):
        with open(path, "rb") as file:
            data = file.read()
        if data[:4] == b"glTF":
            data = data[20:20 + struct.unpack_from("<I", data, 12)[0]]
        self.gltf = json.loads(data)
        self.nodes = self.gltf.get("nodes", [])
        self.sources = sources
        self.node_names = names_of(self.nodes, "node")
        self.parents = {child: i for i, node in enumerate(self.nodes) for child in node.get("children", [])}
        self.lights = self.gltf.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])
        self.light_names = names_of(self.lights, "light")

    def light_of(self, node):
        """The index of its punctual light, or None."""
        return self.nodes[node].get("extensions", {}).get("KHR_lights_punctual", {}).get("light")

    def axes(self, node):
        """The lengths of the world transform's columns."""
        world = Matrix.Identity(4)
        while node is not None:
            value = self.nodes[node]
            x, y, z, w = value.get("rotation", (0, 0, 0, 1))
            local = (Matrix.Translation(Vector(value.get("translation", (0, 0, 0)))) @
                     Quaternion((w, x, y, z)).to_matrix().to_4x4() @
                     Matrix.Diagonal(Vector(value.get("scale", (1, 1, 1)))).to_4x4())
            world = local @ world
            node = self.parents.get(node)
        return [world.col[i].to_3d().length for i in range(3)]


def export(path, lighting):
    """Calls Blender's exporter, and notes through its hooks which object each node is made of. `lighting`: its mode."""
    pairs, sources = [], {}

    class Notes:
        def gather_node_hook(self, node, blender_object, export_settings):
            pairs.append((node, blender_object))

        def gather_gltf_extensions_hook(self, gltf, export_settings):
            index = {id(node): i for i, node in enumerate(gltf.nodes or [])}
            sources.update((index[id(node)], source) for node, source in pairs if id(node) in index)

    addon = sys.modules.get("io_scene_gltf2")
    if addon is None or not hasattr(bpy.types, "EXPORT_SCENE_OT_gltf"):
        raise Unsupported("Blender's add-on glTF 2.0 (io_scene_gltf2) is not enabled")
    if importlib.util.find_spec("numpy") is None:
        raise Unsupported("Blender's glTF exporter needs numpy: apt-get install python3-numpy")
    wanted = {"filepath": path, "export_format": "GLB" if path.endswith(".glb") else "GLTF_SEPARATE",
              "use_active_scene": True, "use_renderable": True, "export_cameras": True, "export_lights": True,
              "export_apply": True, "export_yup": True, "export_current_frame": True, "export_extras": False,
              "convert_lighting_mode": lighting, "export_import_convert_lighting_mode": lighting}
    known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
    addon.glTF2ExportUserExtension = Notes
    try:
        bpy.ops.export_scene.gltf(**{key: value for key, value in wanted.items() if key in known})
    except RuntimeError as error:
        lines = [line.strip() for line in str(error).splitlines()]
        named = [line for line in lines if line.split(":")[0].endswith("Error") and " " in line[:-1]]
        raise Unsupported("Blender's glTF exporter: " + (named or lines or ["fails"])[-1 if named else 0])
    finally:
        del addon.glTF2ExportUserExtension
    return Exported(path, sources)
