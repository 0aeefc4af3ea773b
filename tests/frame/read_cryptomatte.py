# Do Cryptomatte layers work in Blender's compositor? By hand: FRAME.exr of `relook render --aovs`; each NAME is looked
# for among the objects, and their mattes are added up as OUT0001.exr:
#   blender -b -P tests/frame/read_cryptomatte.py -- FRAME.exr OUT NAME...
# With the names of all objects that are seen, OUT0001.exr is the frame's alpha:
#   oiiotool OUT0001.exr --ch R FRAME.exr --ch A --chnames R --diff
import os
import sys

import bpy

frame, out, *names = sys.argv[sys.argv.index("--") + 1 :]
image = bpy.data.images.load(os.path.abspath(frame))
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y = image.size
scene.render.resolution_percentage = 100
scene.use_nodes = True
tree = scene.node_tree
tree.nodes.clear()

total = None
for name in names:
    matte = tree.nodes.new("CompositorNodeCryptomatteV2")
    matte.source = "IMAGE"
    matte.image = image
    matte.layer_name = "CryptoObject"
    matte.matte_id = name
    socket = matte.outputs["Matte"]
    if total is not None:
        add = tree.nodes.new("CompositorNodeMath")
        add.operation = "ADD"
        tree.links.new(total, add.inputs[0])
        tree.links.new(socket, add.inputs[1])
        socket = add.outputs[0]
    total = socket

files = tree.nodes.new("CompositorNodeOutputFile")
files.base_path = os.path.dirname(os.path.abspath(out))
files.format.file_format = "OPEN_EXR"
files.format.color_depth = "32"
files.format.color_mode = "RGB"
files.file_slots.clear()
files.file_slots.new(os.path.basename(out))
tree.links.new(total, files.inputs[0])
tree.links.new(total, tree.nodes.new("CompositorNodeComposite").inputs[0])
bpy.ops.render.render()
