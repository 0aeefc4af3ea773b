"""Makes the Blender scene that blender_test.cpp exports. Run by Blender: --python blender_scene.py -- FOLDER.

Numbers are chosen so that what the test expects of them can be said in a word; they stand there.
"""

import math
import os
import sys

import bpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scenes"))
sys.dont_write_bytecode = True

import images


def put(name, data, parent=None, collection=None, **values):
    thing = bpy.data.objects.new(name, data)
    (collection or bpy.context.scene.collection).objects.link(thing)
    thing.parent = parent
    for key, value in values.items():
        setattr(thing, key, value)
    return thing


def lamp(name, kind, watts, **values):
    light = bpy.data.lights.new(name, kind)
    light.energy = watts
    for key, value in values.items():
        setattr(light, key, value)
    return light


def square(name, size, material):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(-size, -size, 0), (size, -size, 0), (size, size, 0), (-size, size, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    return mesh


def add_objects():
    glow = bpy.data.materials.new("Glow")
    glow.use_nodes = True
    shader = glow.node_tree.nodes["Principled BSDF"]
    shader.inputs["Emission"].default_value = (1, 0.5, 0.25, 1)
    shader.inputs["Emission Strength"].default_value = 5
    put("Floor", square("Floor", 4, bpy.data.materials.new("Grey")))
    put("Sign", square("Sign", 0.2, glow), location=(2, 2, 1))


def add_area_lamps():
    put("Square", lamp("Square", "AREA", 100, shape="SQUARE", size=2), location=(0, 0, 4))
    put("Panel", lamp("Panel", "AREA", 60, shape="RECTANGLE", size=2, size_y=0.5, color=(1, 0.5, 0.25)),
        scale=(1.5, 2, 1), rotation_euler=(0.3, 0.5, 0.7), location=(3, 0, 3), visible_camera=True)
    put("Disc", lamp("Disc", "AREA", 50, shape="DISK", size=1), location=(0, 3, 3))
    oval = lamp("Oval/~", "AREA", 50, shape="ELLIPSE", size=2, size_y=0.5)
    put("Oval/~", oval, location=(0, -3, 3))
    put("Oval too", oval, location=(1, -3, 3))
    group = bpy.data.collections.new("Group")
    put("Small", lamp("Small", "AREA", 8, shape="SQUARE", size=0.5), collection=group)
    for name, scale in (("One", 1), ("Two", 2)):
        put(name, None, scale=(scale,) * 3, instance_type="COLLECTION", instance_collection=group)
    put("Hidden", lamp("Hidden", "AREA", 1), hide_render=True)


def add_other_lamps():
    put("Bulb", lamp("Bulb", "POINT", 40 * math.pi, shadow_soft_size=0.25), location=(1, 1, 2), visible_camera=True)
    put("Beam", lamp("Beam", "SPOT", 80 * math.pi, shadow_soft_size=0, spot_size=1.2, spot_blend=0.5), location=(2, 1, 2))
    put("Sun", lamp("Sun", "SUN", 3, angle=0.01))
    warm = lamp("Warm", "POINT", 4 * math.pi, shadow_soft_size=0.5)
    warm.use_nodes = True
    nodes, links = warm.node_tree.nodes, warm.node_tree.links
    body = nodes.new("ShaderNodeBlackbody")
    body.inputs["Temperature"].default_value = 3000
    emission = nodes["Emission"]
    emission.inputs["Strength"].default_value = 7
    links.new(body.outputs[0], emission.inputs["Color"])
    put("Warm", warm)
    narrow = lamp("Narrow", "AREA", 1, size=1, spread=1)
    put("Narrow", narrow, location=(0, 0, 5))


def add_world(folder):
    """An image times (0.5, 1, 1) and 2, turned; the camera sees blue."""
    os.makedirs(os.path.join(folder, "sky"), exist_ok=True)
    images.write_sky(os.path.join(folder, "sky", "evening.hdr"))
    world = bpy.data.worlds.new("Evening")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    sky = nodes["Background"]
    sky.inputs["Strength"].default_value = 2
    image = nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(os.path.join(folder, "sky", "evening.hdr"))
    mapping = nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value = (0, 0, 0.5)
    place = nodes.new("ShaderNodeTexCoord")
    product = nodes.new("ShaderNodeMixRGB")
    product.blend_type = "MULTIPLY"
    product.inputs[0].default_value = 1
    product.inputs[2].default_value = (0.5, 1, 1, 1)
    links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs[0], image.inputs["Vector"])
    links.new(image.outputs[0], product.inputs[1])
    links.new(product.outputs[0], sky.inputs["Color"])
    blue = nodes.new("ShaderNodeBackground")
    blue.inputs["Color"].default_value = (0, 0, 1, 1)
    mix = nodes.new("ShaderNodeMixShader")
    links.new(nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"], mix.inputs[0])
    links.new(sky.outputs[0], mix.inputs[1])
    links.new(blue.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], nodes["World Output"].inputs["Surface"])


def main(folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_objects()
    add_area_lamps()
    add_other_lamps()
    add_world(folder)
    camera = put("Shot 1", bpy.data.cameras.new("Shot 1"), location=(0, -8, 3), rotation_euler=(1.3, 0, 0))
    camera.data.lens = 50
    camera.data.dof.use_dof, camera.data.dof.focus_distance, camera.data.dof.aperture_fstop = True, 8, 2.5
    scene = bpy.context.scene
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 640, 480, 50
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "scene.blend"))


main(sys.argv[sys.argv.index("--") + 1])
