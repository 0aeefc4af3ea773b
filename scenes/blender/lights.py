"""Lamps as patch operations: what the exporter drops (area lights, sizes, linking), or has otherwise than Cycles.

Cycles 3.4 computes from a lamp's watts W (measured): point and spot W / (4 pi) W/sr, sun W/m2 as it is, area
W / (4 area) W/(m2 sr), which is pi/4 of what a Lambertian emitter of so many watts gives.
"""

import json
import math

from .common import Unsupported, active_output, constant, rounded, source_of, warn
from .exported import pointer, printable, unique
from .linking import excluded_nodes


def emission(lamp):
    """Its colour, its watts and its temperature (None without one), as Cycles sees them."""
    color, watts = list(lamp.color), lamp.energy * 2.0 ** getattr(lamp, "exposure", 0.0)
    temperature = lamp.temperature if getattr(lamp, "use_temperature", False) else None
    if lamp.use_nodes and lamp.node_tree:
        node = source_of(active_output(lamp.node_tree, "OUTPUT_LIGHT").inputs["Surface"])
        if node is None or node.type != "EMISSION":
            raise Unsupported("its nodes are not one Emission")
        of_color, of_strength = source_of(node.inputs["Color"]), source_of(node.inputs["Strength"])
        if of_color is not None and of_color.type == "BLACKBODY":
            temperature = constant(of_color.inputs["Temperature"])
        else:
            color = [a * b for a, b in zip(color, constant(node.inputs["Color"]))]
        if of_strength is not None and of_strength.type == "LIGHT_FALLOFF":
            quadratic = node.inputs["Strength"].links[0].from_socket.name == "Quadratic"
            if not quadratic or constant(of_strength.inputs["Smooth"]) != 0:
                raise Unsupported("its falloff is not the quadratic one")
            watts *= constant(of_strength.inputs["Strength"])
        else:
            watts *= constant(node.inputs["Strength"])
    if watts < 0 or min(color) < 0:
        raise Unsupported("it takes light away")
    return color, watts, temperature


def area_light(lamp, emitted, axes):
    """An area lamp as EXT_lights_area has it, and whether it is an ellipse, which becomes a disk of the same area.
    `axes`: as Exported.axes() has them.
    """
    color, watts, temperature = emitted
    is_rect = lamp.shape in ("SQUARE", "RECTANGLE")
    width = lamp.size * axes[0]
    height = (lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size) * axes[1]
    if width * height == 0:
        raise Unsupported("it has no area")
    area = width * height * (1 if is_rect else math.pi / 4)
    scale = max(axes)  # the extension lets the largest count for both sides
    light = {"type": "rect" if is_rect else "disk", "color": rounded(color), "intensity": rounded(watts / (4 * area)),
             "size": rounded((height if is_rect else math.sqrt(width * height)) / scale)}
    if is_rect:
        light["rect"] = {"aspect": rounded(width / height)}
    extras = extras_of(lamp, temperature)
    if extras:
        light["extras"] = extras
    return light, not is_rect and abs(width - height) > 1e-4 * width


def punctual_intensity(lamp, watts):
    return watts if lamp.type == "SUN" else watts / (4 * math.pi)


def extras_of(lamp, temperature):
    relook = {}
    if lamp.type == "SUN" and lamp.angle > 0:
        relook["angle"] = rounded(lamp.angle)
    if lamp.type in ("POINT", "SPOT") and lamp.shadow_soft_size > 0:
        relook["radius"] = rounded(lamp.shadow_soft_size)
    if temperature is not None:
        relook["temperature"] = rounded(min(max(temperature, 1000.0), 40000.0))
    return {"relook": relook} if relook else None


def warn_of_settings(source):
    """What of a lamp has no place in the look document."""
    lamp, cycles = source.data, getattr(source.data, "cycles", None)
    lost = []
    if lamp.type == "AREA" and getattr(lamp, "spread", math.pi) < math.pi - 1e-4:
        lost.append("its spread")
    if lamp.type == "SPOT" and lamp.use_square:
        lost.append("its square cone")
    if not getattr(cycles, "cast_shadow", True) or not getattr(lamp, "use_shadow", True):
        lost.append("that it casts no shadow")
    if not getattr(lamp, "normalize", True):
        lost.append("that its watts are not shared out over its area")
    hidden = [word for word in ("diffuse", "glossy", "transmission") if not getattr(source, "visible_" + word, True)]
    if hidden:
        lost.append("that it is hidden from %s rays" % ", ".join(hidden))
    linking = getattr(source, "light_linking", None)
    if linking is not None and linking.blocker_collection is not None:
        lost.append("which objects cast its shadows")
    if lost:
        warn("light \"%s\": %s is not exported" % (source.name, "; ".join(lost)))


def light_edits(exported, unit):
    """Patch operations for all lights: what of punctual ones differs, area lights, who sees them."""
    edits, taken, done, areas = [], set(exported.light_names), set(), {}
    for node in sorted(exported.sources):
        source = exported.sources[node]
        if source.type != "LIGHT":
            continue
        lamp, index, name = source.data, exported.light_of(node), exported.node_names[node]
        try:
            if lamp.type == "AREA" and getattr(getattr(lamp, "cycles", None), "is_portal", False):
                continue  # a portal guides sampling and gives no light
            color, watts, temperature = emission(lamp)
            if lamp.type == "AREA":
                edits += area_edits(exported, node, lamp, (color, watts * unit, temperature), taken, areas)
            elif index is None:
                raise Unsupported("lights of type %s are not supported" % lamp.type)
            elif index not in done:
                done.add(index)
                edits += punctual_edits(exported, index, lamp, (color, watts * unit, temperature))
        except Unsupported as error:
            warn("light \"%s\": %s; it %s" % (source.name, error, "is left out" if index is None else
                                              "is as the exporter writes it"))
            continue
        warn_of_settings(source)
        relook = {}
        if source.visible_camera and (lamp.type == "AREA" or lamp.type != "SUN" and lamp.shadow_soft_size > 0):
            relook["visible"] = True
        excludes = excluded_nodes(exported, source)
        if excludes:
            relook["excludes"] = excludes
        if relook:
            edits.append({"op": "add", "path": pointer("nodes", name, "extras"), "value": {"relook": relook}})
    return edits


def punctual_edits(exported, index, lamp, emitted):
    color, watts, temperature = emitted
    path = ("lights", exported.light_names[index])
    light, edits = exported.lights[index], []
    wanted = {"color": rounded(color), "intensity": rounded(punctual_intensity(lamp, watts))}
    for key, value in wanted.items():
        given = light.get(key, 1.0 if key == "intensity" else [1.0, 1.0, 1.0])
        pairs = zip(given, value) if key == "color" else [(given, value)]
        if any(abs(a - b) > 1e-5 * max(abs(a), abs(b)) for a, b in pairs):
            edits.append({"op": "add", "path": pointer(*path, key), "value": value})
    extras = extras_of(lamp, temperature)
    return edits + ([{"op": "add", "path": pointer(*path, "extras"), "value": extras}] if extras else [])


def area_edits(exported, node, lamp, emitted, taken, areas):
    """The node's reference, after the light itself unless a node before has the same. `areas`: {(lamp, light): name}"""
    light, is_ellipse = area_light(lamp, emitted, exported.axes(node))
    key, edits = (lamp.name_full, json.dumps(light)), []
    if key not in areas:
        if is_ellipse:
            warn("light \"%s\": an ellipse becomes a disk of the same area" % lamp.name)
        areas[key] = unique(printable(lamp.name) or "area", taken)
        edits.append({"op": "add", "path": pointer("lights", areas[key]), "value": light})
    return edits + [{"op": "add", "path": pointer("nodes", exported.node_names[node], "extensions", "EXT_lights_area"),
                     "value": {"light": areas[key]}}]
