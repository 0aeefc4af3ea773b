"""The world as relook's environment and background: a colour or a lat-long image, turned about the vertical. A world
that says more than that is rendered to an image.
"""

import math
import os
import shutil

import bpy
from mathutils import Matrix, Vector

from .common import Unsupported, active_output, constant, rounded, source_of, warn
from .exported import pointer, unique

LINEAR = ("Linear", "Linear Rec.709", "Non-Color", "Raw", "scene_linear")


def turn_of(socket):
    """The angle about Blender's +Z by which a Vector input turns a direction before the lookup."""
    matrix = Matrix.Identity(3)
    node = source_of(socket)
    while node is not None and node.type == "MAPPING":
        turn = Matrix.Identity(3)
        rotation = constant(node.inputs["Rotation"])
        for axis, angle in zip("XYZ", rotation):
            turn = Matrix.Rotation(angle, 3, axis) @ turn
        scale = Matrix.Diagonal(Vector(constant(node.inputs["Scale"])))
        if node.vector_type != "VECTOR" and node.vector_type != "NORMAL" and any(constant(node.inputs["Location"])):
            raise Unsupported("a Mapping moves the directions")
        matrix = matrix @ ((turn @ scale).inverted_safe() if node.vector_type == "TEXTURE" else turn @ scale)
        socket = node.inputs["Vector"]
        node = source_of(socket)
    if node is not None and not (node.type == "TEX_COORD" and socket.links[0].from_socket.name == "Generated"):
        raise Unsupported("its directions come from \"%s\"" % node.name)
    angle = math.atan2(matrix[1][0], matrix[0][0])
    turned = Matrix.Rotation(angle, 3, "Z")
    if any(abs(a - b) > 1e-5 for row, other in zip(matrix, turned) for a, b in zip(row, other)):
        raise Unsupported("a Mapping does more than turn it about Z")
    return angle


def sky_of(shader):
    """A Background as {color, intensity, image (or None), rotation}."""
    if shader is None:
        return {"color": [0.0, 0.0, 0.0], "intensity": 1.0, "image": None, "rotation": 0.0}
    if shader.type != "BACKGROUND":
        raise Unsupported("\"%s\" is no Background" % shader.name)
    color, node = [1.0, 1.0, 1.0], source_of(shader.inputs["Color"])
    sky = {"color": color, "intensity": constant(shader.inputs["Strength"]), "image": None, "rotation": 0.0}
    while node is not None and node.type in ("MIX_RGB", "MIX"):
        inputs = [socket for socket in node.inputs if socket.enabled]
        factor, a, b = inputs[0], inputs[1], inputs[2]
        if node.blend_type != "MULTIPLY" or a.type != "RGBA" or constant(factor) != 1.0 or a.is_linked == b.is_linked:
            raise Unsupported("\"%s\" is no product of an image and a colour" % node.name)
        color = [x * y for x, y in zip(color, constant(b if a.is_linked else a))]
        node = source_of(a if a.is_linked else b)
    if node is None:
        sky["color"] = constant(shader.inputs["Color"])
        return sky
    if node.type != "TEX_ENVIRONMENT" or node.projection != "EQUIRECTANGULAR" or node.image is None:
        raise Unsupported("\"%s\" is no lat-long Environment Texture" % node.name)
    # The image's middle is at Blender's +X, which is glTF's +X; relook has it at -Z, and turns it about +Y.
    angle = -turn_of(node.inputs["Vector"]) - math.pi / 2
    return dict(sky, color=color, image=node.image, rotation=math.remainder(angle, 2 * math.pi))


def skies_of(world):
    """What lights the scene, and what the camera sees (None: the same)."""
    if not world.use_nodes:
        return {"color": list(world.color), "intensity": 1.0, "image": None, "rotation": 0.0}, None
    shader = source_of(active_output(world.node_tree, "OUTPUT_WORLD").inputs["Surface"])
    if shader is not None and shader.type == "MIX_SHADER":
        factor = source_of(shader.inputs[0])
        is_path = factor is not None and factor.type == "LIGHT_PATH"
        if not is_path or shader.inputs[0].links[0].from_socket.name != "Is Camera Ray":
            raise Unsupported("\"%s\" mixes by something else than Is Camera Ray" % shader.name)
        return sky_of(source_of(shader.inputs[1])), sky_of(source_of(shader.inputs[2]))
    return sky_of(shader), None


def copied(image, stem):
    """The name of an image's file beside the exported scene, where it is put if need be. `stem`: of its path."""
    suffix = os.path.splitext(image.filepath)[1].lower()
    if suffix not in (".hdr", ".exr") or image.source != "FILE":
        raise Unsupported("image \"%s\" is neither .hdr nor .exr" % image.name)
    if image.colorspace_settings.name not in LINEAR:
        raise Unsupported("image \"%s\" has the colour space %s" % (image.name, image.colorspace_settings.name))
    path = bpy.path.abspath(image.filepath, library=image.library)
    target = stem + suffix
    if image.packed_file is not None:
        with open(target, "wb") as file:
            file.write(image.packed_file.data)
    elif not os.path.isfile(path):
        raise FileNotFoundError("the world's image %s is missing" % path)
    elif os.path.dirname(os.path.realpath(path)) == os.path.dirname(os.path.realpath(stem)):
        return os.path.basename(os.path.realpath(path))
    else:
        shutil.copyfile(path, target)
    return os.path.basename(target)


def baked(world, stem, by_camera):
    """Renders what the world shows in all directions to stem.exr, the middle along Blender's +Y, which is glTF's -Z;
    returns its name. `by_camera`: as camera rays see it, else as all others do.
    """
    if not hasattr(world, "cycles"):
        raise Unsupported("world \"%s\" would be rendered by Cycles, which is not enabled" % world.name)
    shown = world.copy()
    shown.cycles.sampling_method = "NONE"
    for node in [node for node in shown.node_tree.nodes if node.type == "LIGHT_PATH"]:
        for output in node.outputs:
            value = float(by_camera) if output.name == "Is Camera Ray" else 0.0
            for link in list(output.links):
                socket = link.to_socket
                shown.node_tree.links.remove(link)
                socket.default_value = value if isinstance(socket.default_value, float) else [value] * 3
    scene = bpy.data.scenes.new("relook world")
    camera = bpy.data.cameras.new("relook world")
    eye = bpy.data.objects.new("relook world", camera)
    scene.collection.objects.link(eye)
    scene.world, scene.camera, scene.render.engine = shown, eye, "CYCLES"
    eye.rotation_euler = (math.pi / 2, 0, 0)
    camera.type = "PANO"
    (camera if hasattr(camera, "panorama_type") else camera.cycles).panorama_type = "EQUIRECTANGULAR"
    render, cycles = scene.render, scene.cycles
    render.resolution_x, render.resolution_y, render.resolution_percentage = 2048, 1024, 100
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = 16, False, False
    cycles.pixel_filter_type, cycles.sample_clamp_direct = "BOX", 0
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.image_settings.color_mode = "RGB"
    render.filepath, render.use_file_extension, render.film_transparent = stem + ".exr", False, False
    bpy.ops.render.render(write_still=True, scene=scene.name)
    bpy.data.scenes.remove(scene)
    bpy.data.objects.remove(eye)
    bpy.data.cameras.remove(camera)
    bpy.data.worlds.remove(shown)
    return os.path.basename(stem + ".exr")


def environment_edits(world, unit, stem, images):
    """Patch operations for the world. `stem`: of the paths of images to write; `images`: names that are taken."""
    if world is None:
        return []
    edits, files = [], {}

    def place(sky, word):
        value = {"color": rounded(sky["color"]), "intensity": rounded(sky["intensity"] * unit),
                 "rotation": rounded(sky["rotation"])}
        if value["intensity"] < 0 or min(value["color"]) < 0:
            raise Unsupported("it takes light away")
        if sky["image"] is not None:
            key = sky["image"] if isinstance(sky["image"], str) else sky["image"].name_full
            if key not in files:
                uri = key if isinstance(sky["image"], str) else copied(sky["image"], stem + "_" + word)
                files[key] = unique(word, images)
                edits.append({"op": "add", "path": pointer("images", files[key]), "value": {"uri": uri}})
            value["image"] = files[key]
        return value

    def rendered(word, by_camera):
        return {"color": [1.0, 1.0, 1.0], "intensity": 1.0, "rotation": 0.0,
                "image": baked(world, stem + "_" + word, by_camera)}

    try:
        lighting, seen = skies_of(world)
        value = place(lighting, "world")
        if seen is not None:
            value["background"] = place(seen, "background")
    except Unsupported as error:
        warn("world \"%s\": %s; it is rendered to an image, 2048 x 1024" % (world.name, error))
        edits.clear()
        files.clear()
        value = place(rendered("world", False), "world")
        if any(node.type == "LIGHT_PATH" for node in world.node_tree.nodes):
            value["background"] = place(rendered("background", True), "background")
    return edits + [{"op": "add", "path": "/scene/extras/relook/environment", "value": value}]
