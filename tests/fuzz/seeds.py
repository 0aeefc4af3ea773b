"""Writes small files for the fuzzers to begin with: seeds.py FOLDER fills FOLDER/TARGET (tests/fuzz.sh)."""

import base64
import json
import os
import random
import struct
import sys
import tempfile
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scenes"))
sys.dont_write_bytecode = True

import shapes
from gltf import Gltf, write_glb


# Images ---------------------------------------------------------------------------------------------------------------
def png(width, height, depth, color, extra=(), interlaced=False):
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[color]
    line = b"\0" + bytes((i * 37) % 251 for i in range((width * depth * channels + 7) // 8))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    passes = ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2))
    rows = b""
    if interlaced:
        for x, y, dx, dy in passes:
            columns = max(0, (width - x + dx - 1) // dx)
            if columns:
                row = b"\0" + bytes((columns * depth * channels + 7) // 8)
                rows += row * max(0, (height - y + dy - 1) // dy)
    else:
        rows = line * height
    header = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, int(interlaced))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + b"".join(chunk(*one) for one in extra) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def jpeg(width, height, components=1, progressive=False):
    """Grey blocks: a code of one bit for "no difference" and one for "end of block"."""
    def segment(marker, data):
        return b"\xff" + bytes([marker]) + struct.pack(">H", len(data) + 2) + data
    sampling = [0x11] if components == 1 else [0x21, 0x11, 0x11]
    frame = struct.pack(">BHHB", 8, height, width, components)
    frame += b"".join(bytes([i + 1, s, 0]) for i, s in enumerate(sampling))
    table = bytes([1] + [0] * 15 + [0])
    scan = bytes([components]) + b"".join(bytes([i + 1, 0]) for i in range(components))
    blocks = ((width + 7) // 8) * ((height + 7) // 8) * 4
    data = b"\0" * (blocks // 4 + 1)
    return (b"\xff\xd8" + segment(0xDB, bytes([0]) + bytes([1] * 64)) + segment(0xC2 if progressive else 0xC0, frame) +
            segment(0xC4, b"\x00" + table) + segment(0xC4, b"\x10" + table) +
            segment(0xDA, scan + (b"\0\0\0" if progressive else b"\0\x3f\0")) + data + b"\xff\xd9")


def hdr(width, height, runs=False):
    head = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width)
    if not runs:
        return head + bytes([128, 64, 32, 129]) * (width * height)
    line = b"\x02\x02" + struct.pack(">H", width) + b"".join(bytes([128 + width, value]) for value in (9, 8, 7, 129))
    return head + line * height


def exr(width, height, channels="RGB", kind=1, compression=0, tile=None):
    """Zeros and ones; kind 1: half, 2: float; compression 0: none, 2: ZIPS."""
    def attribute(name, type_, value):
        return name.encode() + b"\0" + type_.encode() + b"\0" + struct.pack("<I", len(value)) + value
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    listed = b"".join(c.encode() + b"\0" + struct.pack("<IIII", kind, 0, 1, 1) for c in sorted(channels)) + b"\0"
    head = attribute("channels", "chlist", listed) + attribute("compression", "compression", bytes([compression]))
    head += attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    head += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    if tile:
        head += attribute("tiles", "tiledesc", struct.pack("<IIB", tile, tile, 0))
    start = struct.pack("<II", 20000630, 2 | (0x200 if tile else 0)) + head + b"\0"
    value = struct.pack("<e", 1) if kind == 1 else struct.pack("<f", 1)

    def packed(count):
        raw = value * count
        if compression == 0:
            return raw
        mixed = raw[0::2] + raw[1::2]
        deltas = mixed[:1] + bytes((mixed[i] - mixed[i - 1] + 128) & 255 for i in range(1, len(mixed)))
        small = zlib.compress(deltas)
        return small if len(small) < len(raw) else raw
    blocks = []
    if tile:
        for y in range(0, height, tile):
            for x in range(0, width, tile):
                data = packed(min(tile, width - x) * min(tile, height - y) * len(channels))
                blocks.append(struct.pack("<5i", x // tile, y // tile, 0, 0, len(data)) + data)
    else:
        for y in range(height):
            data = packed(width * len(channels))
            blocks.append(struct.pack("<ii", y, len(data)) + data)
    offset, offsets = len(start) + 8 * len(blocks), b""
    for block in blocks:
        offsets += struct.pack("<Q", offset)
        offset += len(block)
    return start + offsets + b"".join(blocks)


def image_files():
    palette, clear = (b"PLTE", bytes(range(48))), (b"tRNS", b"\0\x40\x80")
    yield from (png(8, 8, 8, 2), png(5, 7, 8, 6), png(9, 3, 1, 0), png(8, 8, 4, 3, (palette, clear)), png(4, 4, 16, 2),
                png(4, 4, 16, 4), png(3, 5, 8, 4), png(9, 9, 8, 2, interlaced=True), png(6, 6, 2, 3, (palette,)),
                png(4, 4, 8, 2, ((b"tEXt", b"Title\0x"), (b"gAMA", struct.pack(">I", 45455)))), png(1, 1, 8, 0))
    yield from (jpeg(8, 8), jpeg(17, 9), jpeg(16, 16, 3), jpeg(16, 8, 3, True), jpeg(8, 8, 1, True))
    yield from (hdr(4, 2), hdr(16, 4, True), hdr(8, 1, True))
    yield from (exr(4, 3), exr(3, 3, "RGBA", 2), exr(8, 4, "RGB", 1, 2), exr(5, 5, "Y"), exr(6, 6, "RGBA", 1, 0, 4),
                exr(4, 4, "BGRZ", 2, 2))


# Scenes ---------------------------------------------------------------------------------------------------------------
def floats(gltf, rows, kind):
    return gltf._floats(rows, kind)


def embed(gltf, name, data, mime):
    while len(gltf.binary) % 4:
        gltf.binary.append(0)
    view = gltf.add("bufferViews", {"buffer": 0, "byteOffset": len(gltf.binary), "byteLength": len(data)})
    gltf.binary += data
    return gltf.add("images", {"name": name, "bufferView": view, "mimeType": mime})


def basic(name):
    gltf = Gltf(name)
    gltf.add_camera("Main", (0.0, 1.5, 4.0), (0.0, 0.5, 0.0), 40.0)
    gltf.add_light("Lamp", "point", [1.0, 0.9, 0.8], 60.0, translation=[2.0, 3.0, 2.0])
    gltf.set_surroundings([0.1, 0.1, 0.1], [0.3, 0.4, 0.5], 1.0)
    return gltf


def textured():
    gltf = basic("textured")
    for name, data, mime in (("A", png(4, 4, 8, 6), "image/png"), ("B", jpeg(8, 8, 3), "image/jpeg")):
        gltf.add("textures", {"name": name, "source": embed(gltf, name, data, mime), "sampler": 0})
    gltf.add("samplers", {"magFilter": 9728, "minFilter": 9987, "wrapS": 33071, "wrapT": 33648})
    move = {"KHR_texture_transform": {"offset": [0.1, 0.2], "rotation": 0.3, "scale": [2, 2], "texCoord": 0}}
    gltf.use_extension("KHR_texture_transform")
    material = gltf.add_material("M", (1, 1, 1), 0.2, 0.4, pbr={
        "baseColorTexture": {"index": 0, "extensions": move}, "metallicRoughnessTexture": {"index": 1}},
        normalTexture={"index": 1, "scale": 0.5}, emissiveTexture={"index": 0}, emissiveFactor=[0.1, 0.2, 0.3],
        occlusionTexture={"index": 1, "strength": 0.5}, alphaMode="MASK", alphaCutoff=0.4, doubleSided=True)
    gltf.add_node("N", mesh=gltf.add_mesh("P", (gltf.add_geometry(shapes.plane(2.0, 2.0, 1.0)), material)))
    return gltf


def extended():
    gltf = basic("extended")
    glass = gltf.add_material("Glass", (1, 1, 1), 0, 0, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 0.9}, "KHR_materials_ior": {"ior": 1.5},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationColor": [1, 0.5, 0.5], "attenuationDistance": 2}})
    coat = gltf.add_material("Coat", (0.5, 0.2, 0.1), 1, 0.1, extensions={
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1},
        "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 0], "sheenRoughnessFactor": 0.5},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.6, "anisotropyRotation": 1},
        "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.6, "iridescenceThicknessMaximum": 500},
        "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 1]},
        "KHR_materials_emissive_strength": {"emissiveStrength": 3}})
    flat = gltf.add_material("Flat", (0, 1, 0), extensions={"KHR_materials_unlit": {}})
    phong = gltf.add_material("Phong", (1, 1, 1), extras={"relook": {
        "model": "blinn-phong", "diffuse": [1, 0, 0], "reflection": 0.3, "refraction": 0.2, "transparency": 0.4}})
    box, plane = gltf.add_geometry(shapes.box(0.6, 0.6, 0.6)), gltf.add_geometry(shapes.plane(4.0, 4.0, 1.0))
    gltf.use_extension("KHR_materials_variants")
    gltf.document.setdefault("extensions", {})["KHR_materials_variants"] = {"variants": [{"name": "Day"}, {"name": "Night"}]}
    mesh = gltf.add_mesh("Box", (box, coat))
    gltf.document["meshes"][mesh]["primitives"][0]["extensions"] = {"KHR_materials_variants": {
        "mappings": [{"material": glass, "variants": [0]}, {"material": phong, "variants": [1]}]}}
    gltf.add_node("Floor", mesh=gltf.add_mesh("Floor", (plane, phong)))
    parent = gltf.add_node("Group", translation=[0, 0.2, 0])
    gltf.add_node("Box", parent, mesh=mesh, rotation=[0, 0.3826834, 0, 0.9238795])
    gltf.add_node("Ghost", parent, mesh=gltf.add_mesh("G", (box, flat)), matrix=[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1],
                  extensions={"KHR_node_visibility": {"visible": False}})
    gltf.use_extension("KHR_node_visibility")
    lights = gltf.document["extensions"]["KHR_lights_punctual"]["lights"]
    lights[0].update(type="spot", range=20, spot={"innerConeAngle": 0.2, "outerConeAngle": 0.6})
    return gltf


def moving():
    gltf = basic("moving")
    material = gltf.add_material("M", (1, 0.5, 0.2))
    node = gltf.add_node("N", mesh=gltf.add_mesh("B", (gltf.add_geometry(shapes.box(1, 1, 1)), material)))
    times = gltf._floats([(0,), (0.5,), (1,)], "SCALAR", True)
    places = floats(gltf, [(0, 0, 0), (1, 0, 0), (1, 1, 0)], "VEC3")
    turns = floats(gltf, [(0, 0, 0, 1), (0, 0.7071068, 0, 0.7071068), (0, 1, 0, 0)], "VEC4")
    colors = floats(gltf, [(1, 0, 0, 1), (0, 1, 0, 1), (0, 0, 1, 1)], "VEC4")
    gltf.use_extension("KHR_animation_pointer")
    gltf.add("animations", {"name": "Go", "samplers": [
        {"input": times, "output": places}, {"input": times, "output": turns, "interpolation": "STEP"},
        {"input": times, "output": colors}],
        "channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}},
                     {"sampler": 1, "target": {"node": node, "path": "rotation"}},
                     {"sampler": 2, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {
                         "pointer": "/materials/0/pbrMetallicRoughness/baseColorFactor"}}}}]})
    return gltf


def instanced():
    gltf = basic("instanced")
    material = gltf.add_material("M", (1, 0.5, 0.2))
    places = floats(gltf, [(0, 0, 0), (1, 0, 0), (-1, 1, 0)], "VEC3")
    sizes = floats(gltf, [(1, 1, 1), (0.5, 0.5, 0.5), (1, -1, 1)], "VEC3")
    gltf.use_extension("EXT_mesh_gpu_instancing")
    gltf.add_node("N", mesh=gltf.add_mesh("B", (gltf.add_geometry(shapes.box(0.4, 0.4, 0.4)), material)), extensions={
        "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places, "SCALE": sizes}}})
    return gltf


def procedural():
    gltf = basic("procedural")
    for kind in ("marble", "wood", "checker", "noise"):
        gltf.add("textures", {"name": kind, "extras": {"relook": {"procedural": {
            "kind": kind, "scale": 2, "turbulence": 1, "octaves": 3, "color1": [0, 0, 0], "color2": [1, 1, 1]}}}})
    maps = [gltf.add_material("M%d" % i, (1, 1, 1), pbr={"baseColorTexture": {"index": i, "extras": {"relook": {
        "mapping": {"kind": kind, "axis": "y"}}}}}) for i, kind in enumerate(("solid", "planar", "spherical", "cylindrical"))]
    geometry = gltf.add_geometry(shapes.plane(2.0, 2.0, 1.0, 2))
    for i, material in enumerate(maps):
        gltf.add_node("N%d" % i, mesh=gltf.add_mesh("P%d" % i, (geometry, material)), translation=[i - 1.5, 0, 0], extras={
            "relook": {"displacement": {"texture": "marble", "scale": 0.2, "midlevel": 0.5, "subdivide": 1}}})
    return gltf


def sparse():
    gltf = basic("sparse")
    mesh = gltf.add_mesh("P", (gltf.add_geometry(shapes.plane(2.0, 2.0, 1.0)), gltf.add_material("M", (1, 1, 1))))
    gltf.add_node("N", mesh=mesh)
    position = gltf.document["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"]
    indices, values = gltf._view(struct.pack("<2H", 0, 2), 0), gltf._view(struct.pack("<6f", 0, 1, 0, 1, 1, 1), 0)
    for view in (indices, values):
        del gltf.document["bufferViews"][view]["target"]
    gltf.document["accessors"][position]["sparse"] = {
        "count": 2, "indices": {"bufferView": indices, "componentType": 5123}, "values": {"bufferView": values}}
    return gltf


def scene_files():
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "s.glb")
        for make in (textured, extended, moving, instanced, procedural, sparse):
            gltf = make()
            write_glb(gltf, path)
            with open(path, "rb") as file:
                yield file.read()
            uri = "data:application/octet-stream;base64," + base64.b64encode(bytes(gltf.binary)).decode()
            yield json.dumps(dict(gltf.document, buffers=[{"byteLength": len(gltf.binary), "uri": uri}])).encode()


# Edits of the scene of tests/support/look_fixture.h ---------------------------------------------------------------------------
EDITS = (
    [{"op": "replace", "path": "/materials/Gold/pbrMetallicRoughness/baseColorFactor", "value": [0.1, 0.2, 0.3, 1]}],
    [{"op": "test", "path": "/lights/Bulb/intensity", "value": 10},
     {"op": "replace", "path": "/lights/Bulb/intensity", "value": 20}],
    [{"op": "add", "path": "/nodes/New", "value": {"mesh": "Ball", "translation": [1, 0, 0]}}],
    [{"op": "add", "path": "/nodes/Brought", "value": {"asset": "square.glb"}}],
    [{"op": "remove", "path": "/nodes/Window"}],
    [{"op": "copy", "from": "/materials/Gold", "path": "/materials/Gold2"},
     {"op": "replace", "path": "/meshes/Pair/primitives/1/material", "value": "Gold2"}],
    [{"op": "move", "from": "/nodes/Both", "path": "/nodes/Both2"}],
    [{"op": "add", "path": "/nodes/Floor/extras/relook", "value": {"displacement": {"texture": "Wood", "scale": 0.2}}}],
    [{"op": "replace", "path": "/textures/Marble/extras/relook/procedural/kind", "value": "noise"}],
    [{"op": "add", "path": "/nodes/Sphere/extensions/KHR_node_visibility/visible", "value": False}],
    [{"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_ior/ior", "value": 1.2}],
    [{"op": "add", "path": "/images/Other", "value": {"uri": "broken.png"}}],
    [{"op": "add", "path": "/nodes/Group/children/-", "value": "Floor"}],
    [{"op": "replace", "path": "/materials/Cut/alphaMode", "value": "BLEND"}],
    [{"op": "add", "path": "/scene/extras/relook/environment", "value": {"color": [1, 0, 0], "intensity": 2}}],
    [{"op": "replace", "path": "/nodes/Hand/rotation", "value": [0, 1, 0, 0]},
     {"op": "replace", "path": "/nodes/Arm/scale", "value": [1, 2, -1]}],
)


def patch_files():
    for edit in EDITS:
        yield json.dumps(edit).encode()


def journal_files():
    def journal(*steps):
        return json.dumps({"relook": "journal/1", "steps": list(steps)}).encode()
    for i in range(0, len(EDITS), 4):
        yield journal(*({"name": "s%d" % k, "edit": edit} for k, edit in enumerate(EDITS[i:i + 4])))
    yield journal({"name": "w", "wedge": {"path": "/lights/Bulb/intensity", "range": {"from": 1, "to": 9, "count": 5}}})
    yield journal({"wedge": {"path": "/materials/Gold/pbrMetallicRoughness/baseColorFactor", "values": [[1, 0, 0, 1], [0, 1, 0, 1]]}},
                  {"wedge": {"path": "/materials/Phong/extras/relook/model", "values": ["unlit", "blinn-phong"]}})
    yield journal({"select": ["/nodes/Sphere", "/nodes/Lamp"], "drag": [
        [{"op": "replace", "path": "/nodes/Sphere/translation", "value": [k, 0, 0]}] for k in range(3)]})
    grow = [{"op": "copy", "from": "/materials/Gold", "path": "/materials/Gold/extras/a"}] * 6
    yield journal({"edit": grow})


# What earlier commands left -------------------------------------------------------------------------------------------
def entry(step, **more):
    stem = "%04d" % 0
    moves = {"ray_trees": 0, "sample_colors": 0, "light_sums": 0, "color_trees": 0, "tunnels": 0, "total": 0}
    return dict({
        "step": step, "name": "s%d" % step, "class": "color" if step else "base", "reasons": ["r"], "drag_frame": None,
        "wedge_frame": None, "frame": "frames/%s.exr" % stem, "frame_hash": "0" * 32, "preview": "previews/%s.png" % stem,
        "pixels_changed": 1, "samples_affected": 1, "regions_visited": 1, "regions_culled": 0, "ray_tests": 0,
        "ray_tests_culled": 0, "ray_updates": 0, "shadow_updates": 0, "color_trees_evaluated": 2, "edits": "e%d" % step,
        "command": "c", "verify": None, "verify_percent": None, "overlays": False, "resumed": False,
        "files": {"frames/%s.exr" % stem: {"hash": "h", "bytes": 300, "modified": 5}},
        "seconds": {key: 0.1 for key in ("classify", "select", "test", "update", "evaluate", "write", "total")},
        "resident": {key: 9 for key in ("ray_paths", "ray_trees", "sample_colors", "light_sums", "color_trees", "groups", "tunnels", "total")},
        "evicted": moves, "rebuilt": moves, "reloaded": moves}, **more)


HEAD = {"program": "0", "scene": {"file": "s.gltf", "hash": "5"}, "journal": {"file": "j.json", "hash": "6"},
        "camera": "Main", "resolution": [2, 1], "samples": 1, "options": {"max_depth": 6}, "cache": "c.cache",
        "machine": {"threads": 1, "cpu": "x"}, "full_render_seconds": 0.5, "cache_bytes": {"total": 10},
        "cache_damage": [], "interrupted": False, "source": {"scene": "5", "camera": {"width": 2, "height": 1}},
        "places": {"journal": ["../j.json", "/j.json"], "cache": ["../c.cache", "/c.cache"]}, "parts": ["0-2"]}


def report(entries):
    lines = ["{", '  "relook": "report/1",'] + ["  %s: %s," % (json.dumps(k), json.dumps(v)) for k, v in HEAD.items()]
    lines += ['  "steps": ['] + ["    %s%s" % (json.dumps(e), "," if e is not entries[-1] else "") for e in entries]
    return "\n".join(lines + ["  ],", '  "frames": {"frames/0000.exr": "%s"}' % ("0" * 32), "}", ""])


def progress(entries, **head):
    first = dict({"relook": "progress/2", "source": HEAD["source"], "steps_edits": "e", "steps_first": 0,
                  "steps_fresh": False, "steps_last": 2}, **head)
    return "progress\n" + "".join(json.dumps(e, separators=(",", ":")) + "\n" for e in [first] + entries)


def note_files():
    kinds = ("ray_trees", "sample_colors", "light_sums", "color_trees", "tunnels")
    for count, tiles in ((6, 2), (40, 5), (120, 9)):
        lines = ["%d %s %d %d %g %g" % (i // 4, kinds[i % 4], i * 7 % tiles, 100 + i * 13 % 900, 0.001 * (i % 5), 1 + i % 3)
                 for i in range(count)]
        yield ("access\nrelook-access/1\n" + "\n".join(lines) + "\n").encode()
    few = [entry(0), entry(1), entry(2, drag_frame=1), entry(2)]
    yield ("run\n" + report(few)).encode()
    yield ("run\n" + progress(few)).encode()
    yield ("run\n" + report(few[:2]) + progress([entry(2, wedge_frame=3)], steps_fresh=True)).encode()
    yield ("run\n" + report([entry(0, verify={"pixels_compared": 2, "pixels_different": 0}, verify_percent=50)])).encode()


# Compressed meshes ----------------------------------------------------------------------------------------------------
def draco(indices, points, columns):
    """The sequential method, nothing compressed. columns: (Draco's semantic, its data type, width, bytes), ids 0, 1, ..."""
    data = b"DRACO" + bytes([2, 2, 1, 0, 0, 0, len(indices) // 3, points, 1]) + bytes(indices) + bytes([1, len(columns)])
    data += b"".join(bytes([semantic, kind, width, 0, i]) for i, (semantic, kind, width, _) in enumerate(columns))
    return data + bytes(len(columns)) + b"".join(column[3] for column in columns)


def packed_files():
    """Eight bytes that choose what the file says (fuzz_packed.cpp), then the data."""
    corners = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5)
    uvs = struct.pack("<8f", 0, 0, 1, 0, 0, 1, 1, 1)
    yield bytes([1, 3, 0, 1, 0, 0, 0, 0]) + draco([0, 1, 2, 2, 1, 3], 4, [(0, 9, 3, corners)])
    yield bytes([1, 3, 0, 1, 0, 4, 0, 0]) + draco([0, 1, 2, 2, 1, 3], 4, [(0, 9, 3, corners), (3, 9, 2, uvs)])
    yield bytes([1, 3, 0, 1, 0, 9, 1, 0]) + draco([0, 1, 2, 2, 1, 3], 4,
                                                  [(0, 3, 3, bytes(24)), (2, 2, 4, bytes(range(16)))])
    yield bytes([0, 1, 2, 0, 0, 0, 0, 0]) + b"\xe1" + bytes(18)
    yield bytes([0, 2, 2, 0, 1, 0, 1, 0]) + b"\xd1" + bytes(9)


def numbers(seed, sizes):
    generator = random.Random(seed)
    for size in sizes:
        yield bytes(generator.randrange(256) for _ in range(size))


def main(folder):
    targets = {"scene": scene_files(), "packed": packed_files(), "patch": patch_files(), "journal": journal_files(), "image": image_files(),
               "notes": note_files(), "cache": numbers(1, range(3, 24)), "replay": numbers(2, range(16, 272, 16))}
    for target, files in targets.items():
        os.makedirs(os.path.join(folder, target), exist_ok=True)
        for i, data in enumerate(files):
            with open(os.path.join(folder, target, "seed_%02d" % i), "wb") as file:
                file.write(data)


if __name__ == "__main__":
    main(sys.argv[1])
