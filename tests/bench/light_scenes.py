"""Writes the three scenes, and a journal for each, that `relook_bench light` measures:

usage: python3 light_scenes.py ASSETS FOLDER

  toycar        a product shot: an HDRI, two area lights
  home-theater  a room: an area light under the ceiling, an HDRI
  garden        sky and sun of an HDRI, a tree whose leaves let light through (build/scenes/garden and build/scenes/product are read, scenes/generate.py writes them)

ASSETS holds the folders toycar, webxr-home-theater and hdri. Steps are named by what they edit. Standard library only.
"""

import json
import math
import os
import shutil
import sys

PROJECT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
ENVIRONMENT = "/scene/extras/relook/environment"


def rotation_towards(eye, target):
    """The quaternion that turns -Z to the way from eye to target."""
    way = [t - e for t, e in zip(target, eye)]
    length = math.sqrt(sum(x * x for x in way))
    x, y, z = (c / length for c in way)
    if z > 0.9999:
        return [0.0, 1.0, 0.0, 0.0]
    q = [y, -x, 0.0, 1.0 - z]  # (0, 0, -1) cross the way, 1 + their product
    scale = math.sqrt(sum(c * c for c in q))
    return [c / scale for c in q]


def add_light(document, name, light, eye, target):
    lights = document.setdefault("extensions", {}).setdefault("EXT_lights_area", {}).setdefault("lights", [])
    document.setdefault("extensionsUsed", [])
    if "EXT_lights_area" not in document["extensionsUsed"]:
        document["extensionsUsed"].append("EXT_lights_area")
    lights.append({"name": name, **light})
    document["nodes"].append({"name": name, "translation": list(eye), "rotation": rotation_towards(eye, target),
                              "extensions": {"EXT_lights_area": {"light": len(lights) - 1}}})
    document["scenes"][document.get("scene", 0)]["nodes"].append(len(document["nodes"]) - 1)


def add_environment(document, folder, files, intensity):
    """files: (name, path), the first one lights."""
    for name, path in files:
        shutil.copyfile(path, os.path.join(folder, os.path.basename(path)))
        document.setdefault("images", []).append({"name": name, "uri": os.path.basename(path)})
    extras = document["scenes"][document.get("scene", 0)].setdefault("extras", {})
    extras["relook"] = {"environment": {"color": [1, 1, 1], "intensity": intensity, "image": files[0][0]}}


def replace(path, value):
    return {"op": "replace", "path": path, "value": value}


def light_steps(light, eye, size):
    """light: name of the light and its node. size: pointer below the light and another value."""
    moved = [eye[0] + 0.1 * max(map(abs, eye)), eye[1], eye[2]]
    return [("colour of a light", [replace(f"/lights/{light}/color", [1.0, 0.8, 0.6])]),
            ("intensity of a light", [replace(f"/lights/{light}/intensity", 3.0)]),
            ("exposure of the HDRI", [replace(f"{ENVIRONMENT}/intensity", 0.75)]),
            ("tint of the HDRI", [replace(f"{ENVIRONMENT}/color", [1.0, 0.9, 0.8])]),
            ("HDRI turned", [replace(f"{ENVIRONMENT}/rotation", 0.6)]),
            ("HDRI swapped", [replace(f"{ENVIRONMENT}/image", "Other")]),
            ("light moved", [replace(f"/nodes/{light}/translation", moved)]),
            ("light resized", [replace(f"/lights/{light}{size[0]}", size[1])]),
            ("light added", [{"op": "add", "path": "/nodes/Added", "value": {
                "translation": moved, "rotation": rotation_towards(moved, (0, 0, 0)),
                "extensions": {"EXT_lights_area": {"light": light}}}}])]


def colour_step(material, colour):
    return (f"base colour of {material}",
            [replace(f"/materials/{material}/pbrMetallicRoughness/baseColorFactor", colour)])


def material_steps(material, colour, roughness):
    """roughness: another one in the bucket of what the material has, or None, and one outside."""
    at = f"/materials/{material}/pbrMetallicRoughness"
    steps = [colour_step(material, colour)]
    if roughness[0] is not None:
        steps.append((f"roughness of {material} in its bucket", [replace(f"{at}/roughnessFactor", roughness[0])]))
    steps.append((f"roughness of {material} outside", [replace(f"{at}/roughnessFactor", roughness[1])]))
    return steps


def write(folder, name, document, steps):
    with open(os.path.join(folder, name + ".gltf"), "w") as file:
        json.dump(document, file)
    with open(os.path.join(folder, name + ".json"), "w") as file:
        json.dump({"relook": "journal/1", "steps": [{"name": n, "edit": e} for n, e in steps]}, file, indent=1)


def open_copy(source, folder):
    os.makedirs(folder, exist_ok=True)
    for name in os.listdir(os.path.dirname(source)):
        path = os.path.join(os.path.dirname(source), name)
        if os.path.isfile(path) and not name.endswith(".gltf"):
            shutil.copyfile(path, os.path.join(folder, name))
    with open(source) as file:
        return json.load(file)


def toycar(assets, folder):
    document = open_copy(os.path.join(assets, "toycar", "ToyCar.gltf"), folder)
    key, rim = (0.06, 0.09, 0.05), (-0.07, 0.05, -0.05)
    add_light(document, "Key", {"type": "rect", "intensity": 8.0, "size": 0.05, "rect": {"aspect": 1.5}}, key, (0, 0, 0))
    add_light(document, "Rim", {"type": "disk", "intensity": 12.0, "size": 0.03}, rim, (0, 0, 0))
    hdri = os.path.join(assets, "hdri")
    add_environment(document, folder, [("Studio", f"{hdri}/pmndrs-studio.exr"), ("Other", f"{hdri}/forest.exr")], 1.0)
    steps = light_steps("Key", key, ("/size", 0.03))
    steps += material_steps("Fabric", [0.9, 0.4, 0.3, 1.0], (0.95, 0.4))
    steps += material_steps("ToyCar", [0.6, 0.9, 0.6, 1.0], (None, 0.5))
    steps.append(colour_step("Glass", [0.8, 0.3, 0.3, 1.0]))
    steps.append(("toy car moved", [replace("/nodes/ToyCar/translation", [0.001, 0, 0])]))
    write(folder, "toycar", document, steps)


def home_theater(assets, folder):
    document = open_copy(os.path.join(assets, "webxr-home-theater", "home-theater.gltf"), folder)
    key = (0.0, 1.5, 0.0)
    add_light(document, "Key", {"type": "rect", "intensity": 12.0, "size": 1.0}, key, (0.0, 0.0, 0.001))
    hdri = os.path.join(assets, "hdri")
    add_environment(document, folder, [("Sky", f"{hdri}/interior.exr"), ("Other", f"{hdri}/city.exr")], 0.5)
    steps = light_steps("Key", key, ("/size", 0.6))
    steps += material_steps("mat1", [0.9, 0.4, 0.3, 1.0], (None, 0.4))
    write(folder, "home-theater", document, steps)


def garden(folder):
    document = open_copy(os.path.join(PROJECT, "build", "scenes", "garden", "garden.gltf"), folder)
    hdri = os.path.join(PROJECT, "build", "scenes", "product", "hdri")
    add_environment(document, folder, [("Sky", f"{hdri}/sky.hdr"), ("Other", f"{hdri}/dusk.hdr")], 1.0)
    for material in document["materials"]:
        if material["name"] == "LeavesFurthest":  # lets light through, so that its colours tint it
            material.update({"alphaMode": "BLEND", "doubleSided": True})
            material["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.75
    key = (3.0, 4.0, 3.0)
    add_light(document, "Key", {"type": "disk", "intensity": 20.0, "size": 1.0}, key, (0, 0, 0))
    steps = light_steps("Key", key, ("/size", 0.6))
    steps += material_steps("Marble", [0.9, 0.4, 0.3, 1.0], (None, 0.3))
    steps += material_steps("Ground", [0.9, 0.4, 0.3, 1.0], (None, 0.3))
    steps.append(colour_step("Glass", [0.8, 0.95, 0.9, 1.0]))
    steps.append(colour_step("LeavesFurthest", [0.5, 0.2, 0.05, 0.75]))
    steps.append(("cow moved", [replace("/nodes/CowFar/translation", [3.0, 0.0, -4.4])]))
    write(folder, "garden", document, steps)


def main(arguments):
    if len(arguments) != 3:
        sys.exit(__doc__)
    assets, folder = arguments[1:]
    toycar(assets, os.path.join(folder, "toycar"))
    home_theater(assets, os.path.join(folder, "home-theater"))
    garden(os.path.join(folder, "garden"))


main(sys.argv)
