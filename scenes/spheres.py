"""The scene `spheres`: a textured floor, a mirror sphere on the left, an opaque one in the middle, a glass one on the
right and one point light, with a few small objects for the rows of Table 1 that these do not cover."""

import os

import images
import shapes
from gltf import Gltf, quaternion


def _textures(gltf, folder):
    images.write_png(os.path.join(folder, "textures", "stone.png"), 256, images.stone_tiles)
    images.write_png(os.path.join(folder, "textures", "planks.png"), 256, images.wood_planks)
    images.write_png(os.path.join(folder, "textures", "dents.png"), 128, images.dents)
    for name in ("Stone", "Planks", "Dents"):
        gltf.add("images", {"name": name, "uri": "textures/%s.png" % name.lower(), "mimeType": "image/png"})
    gltf.add("samplers", {"name": "Repeat", "magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497})
    textures = {name: gltf.add("textures", {"name": name, "source": source, "sampler": 0})
                for source, name in enumerate(("Stone", "Planks", "Dents"))}
    procedurals = {"Marble": {"kind": "marble", "scale": 3.0, "turbulence": 1.5, "octaves": 5,
                              "color1": [0.25, 0.28, 0.33], "color2": [0.92, 0.90, 0.86]},
                   "Bumps": {"kind": "noise", "scale": 3.0, "turbulence": 1.0, "octaves": 3,
                             "color1": [0.0, 0.0, 0.0], "color2": [1.0, 1.0, 1.0]}}
    for name, procedural in procedurals.items():
        textures[name] = gltf.add("textures", {"name": name, "extras": {"relook": {"procedural": procedural}}})
    return textures


def _phong(**fields):
    return {"relook": dict({"model": "blinn-phong", "ambient": [1.0, 1.0, 1.0], "diffuse": [0.8, 0.8, 0.8],
                            "specular": [0.4, 0.4, 0.4], "shininess": 48.0}, **fields)}


def _materials(gltf, textures):
    solid = {"relook": {"mapping": {"kind": "solid"}}}
    materials = {
        "Floor": gltf.add_material("Floor", (0.9, 0.9, 0.9), 0.0, 0.9,
                                   pbr={"baseColorTexture": {"index": textures["Stone"]}},
                                   normalTexture={"index": textures["Dents"], "scale": 0.4}),
        "Mirror": gltf.add_material("Mirror", (0.92, 0.92, 0.94), 1.0, 0.0),
        "Paint": gltf.add_material("Paint", (0.75, 0.10, 0.06), 0.0, 0.7),
        "Glass": gltf.add_material("Glass", (1.0, 1.0, 1.0), 0.0, 0.0, extensions={
            "KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_ior": {"ior": 1.5},
            "KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationDistance": 3.0,
                                     "attenuationColor": [0.72, 0.92, 0.82]}}),
        "Marble": gltf.add_material("Marble", (1.0, 1.0, 1.0), 0.0, 0.8,
                                    pbr={"baseColorTexture": {"index": textures["Marble"], "extras": solid}}),
        "Varnish": gltf.add_material("Varnish", (0.15, 0.35, 0.75), extras=_phong(reflection=0.25)),
        "Crystal": gltf.add_material("Crystal", (0.95, 0.85, 0.55), extras=_phong(
            diffuse=[0.1, 0.1, 0.1], reflection=0.15, refraction=0.7), extensions={"KHR_materials_ior": {"ior": 1.3}}),
        "Veil": gltf.add_material("Veil", (0.35, 0.75, 0.45), doubleSided=True,
                                  extras=_phong(diffuse=[0.5, 0.5, 0.5], transparency=0.6))}
    return materials


def write(folder):
    """Writes FOLDER/spheres.gltf, spheres.bin and textures/*.png."""
    gltf = Gltf("spheres")
    materials = _materials(gltf, _textures(gltf, folder))
    ball = gltf.add_geometry(shapes.sphere())
    pedestal = shapes.Shape()
    for radius, low, high in ((0.85, 0.0, 0.07), (0.72, 0.07, 0.24), (0.8, 0.24, 0.3)):
        pedestal.add(shapes.revolve([(radius, low), (radius, high)], 64))
        pedestal.add(shapes.disc(64), move=(0, high, 0), scale=(radius, 1, radius))
    pane = shapes.grid(1, 1, lambda u, v: (u - 0.5, v, 0.0))
    meshes = {"Floor": gltf.add_mesh("Floor", (gltf.add_geometry(shapes.plane(28.0, 28.0, 10.0)), materials["Floor"])),
              "Pedestal": gltf.add_mesh("Pedestal", (gltf.add_geometry(pedestal), materials["Marble"])),
              "Cube": gltf.add_mesh("Cube", (gltf.add_geometry(shapes.box(0.6, 0.6, 0.6)), materials["Varnish"])),
              "Pane": gltf.add_mesh("Pane", (gltf.add_geometry(pane), materials["Veil"]))}
    for name in ("Mirror", "Paint", "Glass", "Crystal"):
        meshes[name] = gltf.add_mesh(name + "Ball", (ball, materials[name]))

    gltf.add_node("Floor", mesh=meshes["Floor"])
    gltf.add_node("LeftSphere", mesh=meshes["Mirror"], translation=[-2.15, 1.0, -0.2])
    gltf.add_node("Pedestal", mesh=meshes["Pedestal"], translation=[0.0, 0.0, -0.9])
    gltf.add_node("CentralSphere", mesh=meshes["Paint"], translation=[0.0, 1.15, -0.9], scale=[0.85, 0.85, 0.85])
    gltf.add_node("RightSphere", mesh=meshes["Glass"], translation=[2.05, 1.0, 0.1])
    gltf.add_node("Cube", mesh=meshes["Cube"], translation=[-0.85, 0.0, 1.35], rotation=quaternion((0, 1, 0), 0.55))
    gltf.add_node("SmallSphere", mesh=meshes["Crystal"], translation=[0.45, 0.3, 1.75], scale=[0.3, 0.3, 0.3])
    gltf.add_node("Pane", mesh=meshes["Pane"], translation=[1.1, 0.0, -2.4], rotation=quaternion((0, 1, 0), -0.4),
                  scale=[1.6, 2.2, 1.0])
    gltf.add_light("Lamp", "point", [1.0, 0.95, 0.86], 150.0, translation=[-2.6, 5.2, 3.4])
    gltf.add_camera("Main", (0.0, 2.3, 7.0), (0.0, 0.8, 0.0), 38.0)
    gltf.set_surroundings([0.12, 0.13, 0.15], [0.42, 0.55, 0.75], 1.0)
    gltf.write(folder)
