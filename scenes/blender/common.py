"""What the modules beside it share: warnings, numbers, and how the values of Blender's node trees are read."""

import sys


class Unsupported(Exception):
    """What the scene says and the look document has no place for, or what stops the export; a sentence."""


def warn(text):
    print("from_blender.py: warning: " + text, file=sys.stderr)


def rounded(value):
    """Six digits: Blender's floats hold seven, less what its matrices lose."""
    return [rounded(v) for v in value] if isinstance(value, (list, tuple)) else float("%.6g" % value)


def active_output(tree, kind):
    for node in tree.nodes:
        if node.type == kind and node.is_active_output:
            return node
    raise Unsupported("there is no output node")


def source_of(socket):
    """The node that a socket is linked to, or None; the way goes through reroutes."""
    while socket.is_linked:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


def constant(socket):
    """The value of a socket that is not linked: a number or three."""
    if socket.is_linked:
        raise Unsupported("what is linked to \"%s\" of \"%s\" has no place in the look document" %
                          (socket.name, socket.node.name))
    value = socket.default_value
    return value if isinstance(value, float) else list(value)[:3]
