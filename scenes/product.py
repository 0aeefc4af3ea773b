"""The scene `product`: a wrist watch on a folded cloth, a perfume bottle on a plinth and a plastic ring on a sweep, in
true size (metres), under a studio HDRI and three area lights. See README.md for what is where."""

import math
import os

import hdri
import printing
import solids
import still_life
import watch
from gltf import Gltf, look_at, rounded

EYE, TARGET, YFOV_DEGREES = (-0.008, 0.084, 0.312), (0.002, 0.0365, 0.0), 19.4  # 34 degrees across at 16:9
WATCH_TILT, WATCH_YAW = math.radians(60.0), math.radians(13.0)
CLOTH_HEIGHT = 0.0086
WATCH_UNIT, BOTTLE_UNIT = 0.00108, 0.00086  # metres for a millimetre of their drawings: a case of 43 mm, 15 ml


def _textures(gltf, folder):
    """{name: index} of the printed and the normal maps."""
    gltf.add("samplers", {"name": "Repeat", "magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497})
    textures = {}
    for name, file in printing.write(os.path.join(folder, "textures")).items():
        image = gltf.add("images", {"name": name, "uri": "textures/%s.png" % file, "mimeType": "image/png"})
        textures[name] = gltf.add("textures", {"name": name, "source": image, "sampler": 0})
    for name, file in hdri.write(os.path.join(folder, "hdri")).items():
        gltf.add("images", {"name": name, "uri": "hdri/%s.hdr" % file})
    return textures


def _anisotropy(strength, rotation=0.0):
    return {"KHR_materials_anisotropy": {"anisotropyStrength": strength, "anisotropyRotation": round(rotation, 6)}}


def _coat(factor, roughness):
    return {"KHR_materials_clearcoat": {"clearcoatFactor": factor, "clearcoatRoughnessFactor": roughness}}


def _sheen(color, roughness):
    return {"KHR_materials_sheen": {"sheenColorFactor": color, "sheenRoughnessFactor": roughness}}


def _glass(ior, thickness, distance, color):
    return {"KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_ior": {"ior": ior},
            "KHR_materials_volume": {"thicknessFactor": thickness, "attenuationDistance": distance,
                                     "attenuationColor": color}}


def _metals(gltf, textures):
    steel, gold = (0.72, 0.71, 0.69), (0.93, 0.70, 0.40)
    printed = {"baseColorTexture": {"index": textures["Dial"]},
               "metallicRoughnessTexture": {"index": textures["DialSurface"]}}
    return {"Case": gltf.add_material("Case", steel, 1.0, 0.14),
            "Bezel": gltf.add_material("Bezel", steel, 1.0, 0.28, extensions=_anisotropy(0.6)),
            "Hands": gltf.add_material("Hands", (0.86, 0.86, 0.85), 1.0, 0.12),
            "Dial": gltf.add_material("Dial", (1.0, 1.0, 1.0), 1.0, 1.0, pbr=printed, extensions=_anisotropy(0.75)),
            "Cap": gltf.add_material("Cap", gold, 1.0, 0.26, extensions=_anisotropy(0.7, math.pi / 2)),
            "Collar": gltf.add_material("Collar", gold, 1.0, 0.12)}


def _plastics(gltf, textures):
    return {"Insert": gltf.add_material("Insert", (1.0, 1.0, 1.0), 0.0, 0.35, extensions=_coat(1.0, 0.06),
                                        pbr={"baseColorTexture": {"index": textures["Scale"]}}),
            "Paint": gltf.add_material("Paint", (0.85, 0.87, 0.80), 0.0, 0.5),
            "SecondHand": gltf.add_material("SecondHand", (0.80, 0.16, 0.04), 0.0, 0.3),
            "Tube": gltf.add_material("Tube", (0.85, 0.85, 0.83), 0.0, 0.4),
            "Plinth": gltf.add_material("Plinth", (0.62, 0.13, 0.055), 0.0, 0.5, extensions=_coat(1.0, 0.05)),
            "Ring": gltf.add_material("Ring", (0.90, 0.42, 0.06), 0.0, 0.32),
            "Label": gltf.add_material("Label", (1.0, 1.0, 1.0), 1.0, 1.0, pbr={
                "baseColorTexture": {"index": textures["LabelPrint"]},
                "metallicRoughnessTexture": {"index": textures["LabelSurface"]}})}


def _glasses(gltf):
    return {"Glass": gltf.add_material("Glass", (1.0, 1.0, 1.0), 0.0, 0.0, extensions=dict(
                _glass(1.5, 0.0015, 0.2, [0.96, 0.98, 1.0]), KHR_materials_specular={"specularFactor": 0.3})),
            "Bottle": gltf.add_material("Bottle", (1.0, 1.0, 1.0), 0.0, 0.0,
                                        extensions=_glass(1.5, 0.005, 0.4, [0.90, 0.97, 0.94])),
            "Liquid": gltf.add_material("Liquid", (1.0, 1.0, 1.0), 0.0, 0.0,
                                        extensions=_glass(1.0, 0.018, 0.022, [0.95, 0.62, 0.26]))}


def _cloths(gltf, textures):
    def weave(scale):
        return {"index": textures["Weave"], "scale": scale}
    leather = {"index": textures["Leather"], "scale": 0.55}
    return {"Strap": gltf.add_material("Strap", (0.20, 0.062, 0.022), 0.0, 0.48, normalTexture=leather),
            "Thread": gltf.add_material("Thread", (0.72, 0.62, 0.45), 0.0, 0.8,
                                        extensions=_sheen([0.2, 0.2, 0.2], 0.5)),
            "Cushion": gltf.add_material("Cushion", (0.055, 0.047, 0.042), 0.0, 0.9,
                                         extensions=_sheen([0.10, 0.09, 0.085], 0.4)),
            "Cloth": gltf.add_material("Cloth", (0.022, 0.075, 0.092), 0.0, 0.85, normalTexture=weave(0.7),
                                       extensions=_sheen([0.12, 0.20, 0.22], 0.4)),
            "Sweep": gltf.add_material("Sweep", (0.075, 0.078, 0.085), 0.0, 0.7, doubleSided=True)}


def _facing(yaw, tilt):
    """A rotation by `tilt` about +x, then by `yaw` about +y."""
    sx, cx, sy, cy = math.sin(tilt / 2), math.cos(tilt / 2), math.sin(yaw / 2), math.cos(yaw / 2)
    return rounded([cy * sx, sy * cx, -sy * sx, cy * cx], 6)


def _needs_tangents(material):
    return "normalTexture" in material or "KHR_materials_anisotropy" in material.get("extensions", {})


def write(folder):
    """Writes FOLDER/product.gltf, product.bin, textures/*.png and hdri/*.hdr."""
    gltf = Gltf("product")
    textures = _textures(gltf, folder)
    materials = {**_metals(gltf, textures), **_plastics(gltf, textures), **_glasses(gltf), **_cloths(gltf, textures)}

    def add(name, material, shape, parent=None, unit=0.001, **node):
        shape = solids.scaled(shape, unit)
        if not _needs_tangents(gltf.document["materials"][materials[material]]):
            shape.tangents = []
        geometry = gltf.add_geometry(shape, 7)
        return gltf.add_node(name, parent, mesh=gltf.add_mesh(name, (geometry, materials[material])), **node)

    add("Sweep", "Sweep", still_life.sweep())
    add("Cloth", "Cloth", still_life.cloth(), translation=[-0.027, 0.0, 0.022], rotation=_facing(0.24, 0.0))
    lift = CLOTH_HEIGHT - watch.lowest(WATCH_TILT) * WATCH_UNIT
    timepiece = gltf.add_node("Watch", translation=rounded([-0.029, lift, 0.022]),
                              rotation=_facing(WATCH_YAW, WATCH_TILT))
    for name, material, shape in watch.parts():
        add(name, material, shape, timepiece, WATCH_UNIT)
    add("Plinth", "Plinth", still_life.plinth(), translation=[0.041, 0.0, -0.036])
    perfume = gltf.add_node("Perfume", translation=[0.041, 0.0081, -0.036], rotation=_facing(-0.22, 0.0))
    for name, material, shape in still_life.bottle_parts():
        add(name, material, shape, perfume, BOTTLE_UNIT)
    add("Ring", "Ring", still_life.ring(), translation=[0.048, 0.0, 0.028])

    for name, kind, color, nits, size, aspect, eye, target in (
            ("Key", "rect", [1.0, 0.97, 0.92], 8.0, 0.30, 1.2, (-0.36, 0.38, 0.26), (-0.01, 0.04, 0.0)),
            ("Rim", "disk", [0.86, 0.93, 1.0], 22.0, 0.2, 1.0, (0.34, 0.34, -0.16), (0.02, 0.04, 0.0)),
            ("Backdrop", "disk", [1.0, 0.88, 0.74], 90.0, 0.06, 1.0, (0.035, 0.055, -0.10), (0.015, 0.13, -0.30))):
        gltf.add_area_light(name, kind, color, nits, size, aspect, translation=list(eye), rotation=look_at(eye, target))
    gltf.add_camera("Main", EYE, TARGET, YFOV_DEGREES)
    gltf.document["cameras"][0]["perspective"].update(znear=0.01, zfar=10.0)
    gltf.document["scenes"][0]["extras"] = {"relook": {"environment": {
        "color": [1.0, 1.0, 1.0], "intensity": 1.0, "rotation": 0.0, "image": "Studio"}}}
    gltf.write(folder)
