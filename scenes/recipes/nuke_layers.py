#!/usr/bin/env python3
"""Writes a Nuke script that mixes a frame's lights: a Grade for each layer of --aovs, summed up.

usage: nuke_layers.py FRAME.exr COMP.nk

Every light has a Shuffle2 that takes its layer, a Grade whose multiply is its gain (1: the frame), and a Merge that adds
it. The layer names are those of the frame's header, which is read here without any library.
"""

import struct
import sys
from pathlib import Path

CHANNELS = (("R", "red"), ("G", "green"), ("B", "blue"))


def header_of(path):
    """Name -> (type, bytes) of an EXR file's attributes, its first part's: OpenEXR's file layout."""
    with open(path, "rb") as file:
        if file.read(4) != b"\x76\x2f\x31\x01":
            sys.exit(f"{path}: no OpenEXR file")
        file.read(4)

        def text():
            characters = bytearray()
            while (byte := file.read(1)) not in (b"\0", b""):
                characters += byte
            return characters.decode()

        attributes = {}
        while name := text():
            kind, size = text(), struct.unpack("<i", file.read(4))[0]
            attributes[name] = (kind, file.read(size))
        return attributes


def channels_of(value):
    """Names in a `chlist`: each is followed by 16 bytes."""
    names, place = [], 0
    while value[place]:
        end = value.index(b"\0", place)
        names.append(value[place:end].decode())
        place = end + 17
    return names


def knob(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("[", "\\[").replace("$", "\\$") + '"'


def script(frame, lights):
    """The text of a .nk file: its nodes take their inputs from a stack, the last one first."""
    lines = [f"add_layer {{{light} {' '.join(f'{light}.{color}' for _, color in CHANNELS)}}}" for light in lights]
    lines += ["Read {", " inputs 0", f" file {knob(str(frame))}", " raw true", " name frame", "}",
              "set frame [stack 0]"]
    for number, light in enumerate(lights):
        pairs = " ".join(f"{{0 {place} {light}.{name} rgba.{name}}}"
                         for place, (_, name) in enumerate(CHANNELS))
        lines += ["push $frame", "Shuffle2 {", f" fromInput1 {{{{0}} B}}", f" in1 {light}",
                  f" mappings 3 {pairs}", f" name pick_{number}", f" label {knob(light)}", "}",
                  "Grade {", " multiply 1", " black_clamp false", f" name gain_{number}", f" label {knob(light)}", "}"]
        if number > 0:
            lines += ["Merge2 {", " inputs 2", " operation plus", " output rgb", f" name sum_{number}", "}"]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.split("\n\n")[1])
    frame, out = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    attributes = header_of(frame)
    lights = attributes.get("relook:lights", ("", b""))[1].decode().split()
    channels = channels_of(attributes["channels"][1])
    missing = [f"{light}.{end}" for light in lights for end, _ in CHANNELS if f"{light}.{end}" not in channels]
    if missing or not lights:
        reason = f"no channel {missing[0]}" if missing else "no layers of lights: render it with --aovs"
        sys.exit(f"{frame}: {reason}")
    out.write_text(script(frame, lights), encoding="utf-8")
    print(f"{out}: {len(lights)} lights: {', '.join(lights)}")


if __name__ == "__main__":
    main()
