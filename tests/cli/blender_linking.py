"""Light linking as Blender 4 has it, in stand-ins for Blender's objects: prints the nodes that a lamp excludes, a line a
case. Run by blender_test.cpp with any Python; argument: the folder `scenes`.
"""

import sys
from types import SimpleNamespace as Thing

sys.path.insert(0, sys.argv[1])
sys.dont_write_bytecode = True

from blender.linking import excluded_nodes


def scene(parents):
    """Meshes A, B, ... and their parents (None: a root), as exported.Exported has them."""
    names = [chr(ord("A") + i) for i in range(len(parents))]
    nodes = [{"mesh": 0, "children": [i for i, parent in enumerate(parents) if parent == name]} for name in names]
    return Thing(nodes=nodes, node_names=["node " + name for name in names],
                 sources={i: Thing(name_full=name) for i, name in enumerate(names)},
                 parents={child: i for i, node in enumerate(nodes) for child in node["children"]})


def state(word):
    return Thing(light_linking=Thing(link_state=word))


def lamp(objects, collections=()):
    """`objects`: {name: link state}; `collections`: (names, link state)."""
    receivers = Thing(collection_objects=[state(word) for word in objects.values()],
                      objects=[Thing(name_full=name) for name in objects],
                      collection_children=[state(word) for _, word in collections],
                      children=[Thing(all_objects=[Thing(name_full=name) for name in names]) for names, _ in collections])
    return Thing(name="Lamp", light_linking=Thing(receiver_collection=receivers))


flat, family = scene([None, None, None]), scene([None, "A", "A"])
print(excluded_nodes(flat, Thing(name="Lamp")))  # a Blender without linking
print(excluded_nodes(flat, lamp({"B": "EXCLUDE"})))
print(excluded_nodes(flat, lamp({"B": "INCLUDE"})))
print(excluded_nodes(flat, lamp({}, [("AB", "INCLUDE"), ("B", "EXCLUDE")])))
print(excluded_nodes(family, lamp({"A": "EXCLUDE", "B": "EXCLUDE", "C": "EXCLUDE"})))  # all below A: A says it
print(excluded_nodes(family, lamp({"A": "EXCLUDE", "C": "EXCLUDE"})))  # B is below A, and lit
