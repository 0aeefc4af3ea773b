"""Writes glTF 2.0: a small builder that packs meshes into one buffer and prints one JSON object per line.

Called by the scene modules beside it. The same calls give the same bytes on every machine.
"""

import json
import math
import os
import struct


def rounded(values, digits=5):
    """Numbers short enough to read, without negative zeros."""
    return [round(value, digits) + 0.0 for value in values]


def quaternion(axis, angle):
    """A rotation of `angle` radians about `axis`, as glTF's x, y, z, w."""
    length = math.sqrt(sum(a * a for a in axis))
    s = math.sin(angle / 2) / length
    return rounded([axis[0] * s, axis[1] * s, axis[2] * s, math.cos(angle / 2)], 6)


def look_at(eye, target):
    """The rotation that turns -z from `eye` to `target` with +y up, as a quaternion."""
    dx, dy, dz = (t - e for t, e in zip(target, eye))
    yaw = math.atan2(-dx, -dz)
    pitch = math.atan2(dy, math.hypot(dx, dz))
    cy, sy, cp, sp = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
    return rounded([cy * sp, sy * cp, -sy * sp, cy * cp], 6)


class Gltf:
    """One glTF file under construction. `add_*` returns the index of what it added."""

    def __init__(self, name):
        self.name = name
        self.binary = bytearray()
        self.document = {"asset": {"version": "2.0", "generator": "relook scenes/generate.py"},
                         "scene": 0, "scenes": [{"name": name, "nodes": []}]}

    def add(self, section, value):
        items = self.document.setdefault(section, [])
        items.append(value)
        return len(items) - 1

    def use_extension(self, name):
        used = self.document.setdefault("extensionsUsed", [])
        if name not in used:
            used.append(name)
            used.sort()

    def _view(self, data, target):
        while len(self.binary) % 4:
            self.binary.append(0)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), "target": target}
        self.binary += data
        return self.add("bufferViews", view)

    def _floats(self, rows, kind, bounds=False):
        width = len(rows[0])
        data = struct.pack("<%df" % (len(rows) * width), *[x for row in rows for x in row])
        accessor = {"bufferView": self._view(data, 34962), "componentType": 5126, "count": len(rows), "type": kind}
        if bounds:
            stored = struct.unpack("<%df" % (len(rows) * width), data)
            accessor["min"] = [min(stored[i::width]) for i in range(width)]
            accessor["max"] = [max(stored[i::width]) for i in range(width)]
        return self.add("accessors", accessor)

    def add_geometry(self, shape, digits=6):
        """Packs a shape once, its places to `digits` decimals; meshes with different materials may share the result."""
        attributes = {"POSITION": self._floats([rounded(p, digits) for p in shape.positions], "VEC3", bounds=True),
                      "NORMAL": self._floats([rounded(n, 6) for n in shape.normals], "VEC3"),
                      "TEXCOORD_0": self._floats([rounded(t, 6) for t in shape.uvs], "VEC2")}
        if shape.tangents:
            attributes["TANGENT"] = self._floats([rounded(t, 6) for t in shape.tangents], "VEC4")
        wide = len(shape.positions) > 65535
        flat = [index for triangle in shape.triangles for index in triangle]
        data = struct.pack("<%d%s" % (len(flat), "I" if wide else "H"), *flat)
        indices = self.add("accessors", {"bufferView": self._view(data, 34963), "componentType": 5125 if wide else 5123,
                                         "count": len(flat), "type": "SCALAR"})
        return {"attributes": attributes, "indices": indices}

    def add_mesh(self, name, *primitives):
        """`primitives`: pairs of (geometry, material index)."""
        return self.add("meshes", {"name": name,
                                   "primitives": [dict(geometry, material=material) for geometry, material in primitives]})

    def add_material(self, name, color, metallic=0.0, roughness=0.8, **more):
        pbr = {"baseColorFactor": list(color) + [1.0], "metallicFactor": metallic, "roughnessFactor": roughness}
        pbr.update(more.pop("pbr", {}))
        for extension in more.get("extensions", {}):
            self.use_extension(extension)
        return self.add("materials", dict({"name": name, "pbrMetallicRoughness": pbr}, **more))

    def add_node(self, name, parent=None, **more):
        index = self.add("nodes", dict({"name": name}, **more))
        if parent is None:
            self.document["scenes"][0]["nodes"].append(index)
        else:
            self.document["nodes"][parent].setdefault("children", []).append(index)
        return index

    def add_light(self, name, kind, color, intensity, **node):
        """A light without size and the node of the same name that places it."""
        return self._add_light("KHR_lights_punctual",
                               {"name": name, "type": kind, "color": color, "intensity": intensity}, node)

    def add_area_light(self, name, kind, color, intensity, size, aspect=1.0, **node):
        """A "rect" (`size` high, `aspect` times as wide) or a "disk" (`size` across) that shines along -z, in nits."""
        light = {"name": name, "type": kind, "color": color, "intensity": intensity, "size": size}
        if kind == "rect":
            light["rect"] = {"aspect": aspect}
        return self._add_light("EXT_lights_area", light, node)

    def _add_light(self, extension, light, node):
        self.use_extension(extension)
        lights = self.document.setdefault("extensions", {}).setdefault(extension, {"lights": []})["lights"]
        lights.append(light)
        return self.add_node(light["name"], extensions={extension: {"light": len(lights) - 1}}, **node)

    def add_camera(self, name, eye, target, yfov_degrees):
        camera = self.add("cameras", {"name": name, "type": "perspective",
                                      "perspective": {"yfov": round(math.radians(yfov_degrees), 6), "znear": 0.05,
                                                      "zfar": 200.0}})
        self.add_node(name, camera=camera, translation=list(eye), rotation=look_at(eye, target))

    def set_surroundings(self, ambient, color, intensity):
        self.document["scenes"][0]["extras"] = {"relook": {
            "ambient": ambient, "environment": {"color": color, "intensity": intensity, "rotation": 0.0}}}

    def write(self, folder):
        """Writes FOLDER/<name>.gltf and .bin."""
        self.document["buffers"] = [{"uri": self.name + ".bin", "byteLength": len(self.binary)}]
        lines = []
        for section, value in self.document.items():
            if isinstance(value, list):
                items = ",\n  ".join(json.dumps(item, separators=(", ", ": ")) for item in value)
                lines.append("%s: [\n  %s\n]" % (json.dumps(section), items))
            else:
                lines.append("%s: %s" % (json.dumps(section), json.dumps(value)))
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, self.name + ".gltf"), "w", encoding="utf-8", newline="\n") as file:
            file.write("{\n" + ",\n".join(lines) + "\n}\n")
        with open(os.path.join(folder, self.name + ".bin"), "wb") as file:
            file.write(self.binary)


def write_glb(gltf, path):
    """Writes one self-contained binary glTF file."""
    document = dict(gltf.document, buffers=[{"byteLength": len(gltf.binary)}])
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary = bytes(gltf.binary) + b"\0" * (-len(gltf.binary) % 4)
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)
