"""The scene `garden`: a meadow with sixty trees whose every leaf is an object of its own, a marble bust, a boat on a
pond, cows, and three spheres. About 16,600 objects; see README.md for what is where."""

import math
import random

import shapes
import statue
from gltf import Gltf, quaternion, rounded

TREES, LEAVES_PER_TREE = 60, 275  # the usual garden; generate.py takes another number of leaves
CAMERA_EYE, CAMERA_TARGET = (0.0, 3.4, 15.0), (0.0, 1.75, 0.0)


def _leaf():
    shape = shapes.Shape()
    shape.positions = [(0.0, 0.0, 0.0), (0.15, 0.22, 0.05), (0.0, 0.5, 0.0), (-0.15, 0.22, 0.05)]
    shape.uvs = [(0.5, 1.0), (1.0, 0.5), (0.5, 0.0), (0.0, 0.5)]
    shape.triangles = [(0, 1, 2), (0, 2, 3)]
    return shape.smooth()


def _trunk():
    trunk = shapes.revolve([(0.24, 0.0), (0.15, 0.5), (0.12, 1.6), (0.09, 2.4), (0.0, 3.4)], 8)
    branch = shapes.revolve([(0.07, 0.0), (0.0, 1.1)], 5)
    for k in range(3):
        angle = 2.1 * k
        tilted = shapes.Shape().add(branch)
        tilted.positions = [(x + y * math.sin(angle) * 0.8, y, z + y * math.cos(angle) * 0.8) for x, y, z in branch.positions]
        trunk.add(tilted.smooth(), move=(0.0, 1.5 + 0.25 * k, 0.0))
    return trunk


def _boat():
    """A hull 3 m long, open on top: outside and inside are the two faces of one sheet."""
    def hull(u, v):
        along, around = 2 * u - 1, math.pi * (v - 0.5)
        width = 0.62 * (1 - abs(along) ** 2.4) ** 0.7 if abs(along) < 1 else 0.0
        side = math.sin(around)
        depth = 0.5 * (1 - abs(along) ** 4)
        sheer = 0.5 + 0.28 * along * along
        return (1.5 * along, sheer - (depth + 0.28 * along * along * math.cos(around)) * math.cos(around), width * side)
    shape = shapes.grid(32, 16, hull)
    for x in (-0.5, 0.55):
        shape.add(shapes.box(0.25, 0.04, 1.0), move=(x, 0.36, 0.0))
    return shape


def _cow():
    """Ellipsoids for the body, neck, head and udder, cones for legs, horns and tail."""
    ball = shapes.sphere(20, 12)
    leg = shapes.revolve([(0.09, 0.0), (0.07, 0.35), (0.13, 0.8)], 8)
    horn = shapes.revolve([(0.04, 0.0), (0.03, 0.1), (0.0, 0.22)], 6)
    cow = shapes.Shape().add(ball, move=(0.0, 1.02, 0.0), scale=(0.85, 0.42, 0.38))
    cow.add(ball, move=(0.75, 1.12, 0.0), scale=(0.38, 0.30, 0.22)).add(ball, move=(1.12, 1.22, 0.0), scale=(0.30, 0.18, 0.16))
    cow.add(ball, move=(-0.4, 0.65, 0.0), scale=(0.2, 0.14, 0.16))
    for x in (-0.55, 0.5):
        for z in (-0.22, 0.22):
            cow.add(leg, move=(x, 0.0, z))
    for z in (-0.13, 0.13):
        cow.add(horn, move=(0.98, 1.36, z)).add(ball, move=(0.95, 1.3, 1.9 * z), scale=(0.04, 0.06, 0.13))
    return cow.add(shapes.revolve([(0.07, 0.0), (0.02, 0.2), (0.02, 0.75)], 6), move=(-0.88, 0.4, 0.0))


def _tree_places(generator):
    """(name, x, z, size) of every tree: the left one, the furthest one at the end of a gap, the others in rows."""
    places = [("Left", -4.1, 3.6, 1.0), ("Furthest", -0.9, -27.0, 1.9)]
    row, number = 0, 1
    while len(places) < TREES:
        z = -4.0 - 2.6 * row
        count = 6 + row // 2
        for k in range(count):
            side = (k + 0.5) / count * 2 - 1
            x = side * (9.5 - 0.62 * z) + generator.uniform(-0.7, 0.7)
            size = generator.uniform(0.8, 1.25)
            jitter = generator.uniform(-0.8, 0.8)
            gap = -0.9 * (CAMERA_EYE[2] - z) / (CAMERA_EYE[2] + 27.0)
            if abs(x - gap) > 1.9 and not (z > -8 and -6.5 < x < 3.5) and len(places) < TREES:
                places.append(("%02d" % number, x, z + jitter, size))
                number += 1
        row += 1
    return places


def _add_tree(gltf, generator, place, leaf, trunk, leaves):
    name, x, z, size = place
    color = ((0.10, 0.34, 0.06) if name == "Left" else
             (generator.uniform(0.08, 0.30), generator.uniform(0.26, 0.42), generator.uniform(0.03, 0.10)))
    material = gltf.add_material("Leaves" + name, rounded(color, 3), 0.0, 0.8, doubleSided=True)
    mesh = gltf.add_mesh("Leaf" + name, (leaf, material))
    tree = gltf.add_node("Tree" + name, translation=rounded([x, 0.0, z], 3), scale=rounded([size] * 3, 3),
                         rotation=quaternion((0, 1, 0), generator.uniform(0, 2 * math.pi)))
    gltf.add_node("Trunk" + name, parent=tree, mesh=trunk)
    for k in range(leaves):
        height = generator.uniform(-1, 1)
        angle = generator.uniform(0, 2 * math.pi)
        radius = generator.uniform(0.25, 1.0) ** 0.5
        ring = math.sqrt(1 - height * height) * radius
        position = (1.35 * ring * math.sin(angle), 3.1 + 1.5 * height * radius, 1.35 * ring * math.cos(angle))
        axis = [generator.uniform(-1, 1) for _ in range(3)]
        axis[0] += 0.01
        gltf.add_node("Leaf%s_%03d" % (name, k), parent=tree, mesh=mesh, translation=rounded(position, 3),
                      rotation=quaternion(axis, generator.uniform(0, 2 * math.pi)))


def _procedural(gltf, name, kind, scale, turbulence, octaves, color1, color2):
    texture = gltf.add("textures", {"name": name, "extras": {"relook": {"procedural": {
        "kind": kind, "scale": scale, "turbulence": turbulence, "octaves": octaves, "color1": color1, "color2": color2}}}})
    return {"baseColorTexture": {"index": texture, "extras": {"relook": {"mapping": {"kind": "solid"}}}}}


def _materials(gltf):
    grass = _procedural(gltf, "Grass", "noise", 0.5, 1.0, 5, [0.55, 0.55, 0.5], [1.0, 1.0, 1.0])
    marble = _procedural(gltf, "Marble", "marble", 1.6, 2.2, 5, [0.42, 0.44, 0.50], [0.93, 0.91, 0.87])
    planks = _procedural(gltf, "Planks", "wood", 6.0, 0.5, 4, [0.24, 0.12, 0.05], [0.58, 0.34, 0.16])
    hide = _procedural(gltf, "Hide", "noise", 2.2, 6.0, 2, [0.10, 0.07, 0.05], [0.95, 0.92, 0.86])
    phong = {"model": "blinn-phong", "ambient": [0.3, 0.3, 0.3], "diffuse": [0.15, 0.15, 0.15],
             "specular": [0.6, 0.6, 0.6], "shininess": 60.0, "reflection": 0.75}
    return {
        "Ground": gltf.add_material("Ground", (0.22, 0.36, 0.10), 0.0, 0.95, pbr=grass),
        "Marble": gltf.add_material("Marble", (1.0, 1.0, 1.0), 0.0, 0.7, pbr=marble),
        "Hull": gltf.add_material("Hull", (1.0, 1.0, 1.0), 0.0, 0.7, pbr=planks, doubleSided=True),
        "Sail": gltf.add_material("Sail", (0.88, 0.84, 0.74), 0.0, 0.9, doubleSided=True),
        "Bark": gltf.add_material("Bark", (0.26, 0.17, 0.10), 0.0, 0.9),
        "Cow": gltf.add_material("Cow", (1.0, 1.0, 1.0), 0.0, 0.8, pbr=hide),
        "Water": gltf.add_material("Water", (0.02, 0.06, 0.08), 0.0, 0.0),
        "Mirror": gltf.add_material("Mirror", (0.95, 0.95, 0.97), extras={"relook": phong}),
        "Paint": gltf.add_material("Paint", (0.72, 0.12, 0.08), 0.0, 0.65),
        "Glass": gltf.add_material("Glass", (1.0, 1.0, 1.0), 0.0, 0.0, extensions={
            "KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_ior": {"ior": 1.5},
            "KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationDistance": 6.0,
                                     "attenuationColor": [0.8, 0.92, 0.95]}})}


def _add_boat(gltf, materials):
    sail = shapes.grid(6, 8, lambda u, v: (-0.95 * (1 - v) * u, 2.3 * v, 0.28 * math.sin(math.pi * u) * (1 - v)))
    mast = shapes.revolve([(0.045, 0.0), (0.03, 2.9), (0.0, 2.95)], 8)
    boat = gltf.add_node("Boat", translation=[-2.5, -0.06, -1.2], rotation=quaternion((0, 1, 0), 0.3))
    for name, shape, material, move in (("Hull", _boat(), "Hull", [0.0, 0.0, 0.0]), ("Mast", mast, "Bark", [0.2, 0.1, 0.0]),
                                        ("Sail", sail, "Sail", [0.14, 0.75, 0.0])):
        mesh = gltf.add_mesh(name, (gltf.add_geometry(shape), materials[material]))
        gltf.add_node(name, parent=boat, mesh=mesh, translation=move)


def write(folder, leaves=LEAVES_PER_TREE):
    """Writes FOLDER/garden.gltf and garden.bin. `leaves`: of each of the sixty trees."""
    generator = random.Random(1996)
    gltf = Gltf("garden")
    materials = _materials(gltf)
    ball = gltf.add_geometry(shapes.sphere(64, 32))

    def mesh(name, shape, material):
        return gltf.add_mesh(name, (gltf.add_geometry(shape), materials[material]))

    gltf.add_node("Ground", mesh=mesh("Ground", shapes.plane(160.0, 160.0, 40.0, 16), "Ground"))
    gltf.add_node("Water", mesh=mesh("Water", shapes.disc(), "Water"), translation=[-2.6, 0.02, -1.2], scale=[2.7, 1.0, 1.7])
    gltf.add_node("Statue", mesh=gltf.add_mesh("Statue", (gltf.add_geometry(statue.bust()), materials["Marble"])),
                  translation=[1.35, 1.15, 0.6], rotation=quaternion((0, 1, 0), -0.25))
    gltf.add_node("Pedestal", mesh=mesh("Pedestal", statue.pedestal(), "Marble"), translation=[1.35, 0.0, 0.6])
    _add_boat(gltf, materials)
    cow = mesh("Cow", _cow(), "Cow")
    gltf.add_node("CowNear", mesh=cow, translation=[4.1, 0.0, 0.4], rotation=quaternion((0, 1, 0), 2.7))
    gltf.add_node("CowFar", mesh=cow, translation=[3.2, 0.0, -4.5], rotation=quaternion((0, 1, 0), -0.4))
    for name, material, place in (("LeftSphere", "Mirror", [-2.0, 0.85, 5.6]), ("CentralSphere", "Paint", [0.0, 0.7, 6.0]),
                                  ("RightSphere", "Glass", [2.05, 0.85, 5.4])):
        gltf.add_node(name, mesh=gltf.add_mesh(name, (ball, materials[material])), translation=place,
                      scale=[place[1]] * 3)
    leaf, trunk = gltf.add_geometry(_leaf()), mesh("Trunk", _trunk(), "Bark")
    for place in _tree_places(generator):
        _add_tree(gltf, generator, place, leaf, trunk, leaves)
    gltf.add_light("Sun", "directional", [1.0, 0.94, 0.82], 2.6, rotation=quaternion((-0.9, -0.55, -0.2), 1.0))
    gltf.add_light("Sky", "directional", [0.65, 0.78, 1.0], 0.7, rotation=quaternion((-0.9, 0.6, 0.2), 1.1))
    gltf.add_light("Lantern", "point", [1.0, 0.85, 0.6], 30.0, translation=[1.5, 4.5, 6.0])
    gltf.add_camera("Main", CAMERA_EYE, CAMERA_TARGET, 40.0)
    gltf.set_surroundings([0.10, 0.12, 0.15], [0.50, 0.66, 0.92], 1.0)
    gltf.write(folder)
