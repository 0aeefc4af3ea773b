"""Light linking (Blender 4.0 and later): the receivers of a lamp as the nodes that get nothing from it."""

from .common import warn


def linked_objects(collection):
    """(included, excluded): names of the objects in a receiver collection, with those of collections in it."""
    found = {"INCLUDE": set(), "EXCLUDE": set()}
    for entry, child in zip(collection.collection_objects, collection.objects):
        found[entry.light_linking.link_state].add(child.name_full)
    for entry, child in zip(collection.collection_children, collection.children):
        found[entry.light_linking.link_state].update(o.name_full for o in child.all_objects)
    return found["INCLUDE"], found["EXCLUDE"]


def excluded_nodes(exported, source):
    """The topmost nodes at and below which no mesh gets light from a lamp."""
    linking = getattr(source, "light_linking", None)
    if linking is None or linking.receiver_collection is None:
        return []
    included, excluded = linked_objects(linking.receiver_collection)

    def is_dark(node):
        name = exported.sources[node].name_full if node in exported.sources else ""
        return name in excluded or bool(included) and name not in included

    def dark_parts(node):
        """(is all below dark, are there meshes, topmost dark nodes)"""
        parts = [dark_parts(child) + (child,) for child in exported.nodes[node].get("children", [])]
        has_mesh = "mesh" in exported.nodes[node]
        dark = (not has_mesh or is_dark(node)) and all(part[0] for part in parts)
        if dark:
            return True, has_mesh or any(part[1] for part in parts), []
        if has_mesh and is_dark(node):
            warn("light \"%s\": reaches \"%s\", as it reaches objects below it" %
                 (source.name, exported.node_names[node]))
        names = [exported.node_names[part[3]] for part in parts if part[0] and part[1]]
        return False, True, names + [name for part in parts for name in part[2]]

    roots = [node for node in range(len(exported.nodes)) if node not in exported.parents]
    names = []
    for root in roots:
        dark, has_mesh, below = dark_parts(root)
        names += [exported.node_names[root]] if dark and has_mesh else below
    return sorted(names)
