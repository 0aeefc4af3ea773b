"""Surroundings as lat-long images in linear light, 1024 x 512, and their files: Radiance RGBE with runs.

Rows are (reds, greens, blues), row 0 on top. An image's middle looks along -z, its right half along +x, +y is up: as
relook reads it.
"""

import math
import os
import re
import struct

WIDTH, HEIGHT = 1024, 512


def elevation(y):
    return math.pi * (0.5 - (y + 0.5) / HEIGHT)


def azimuth(x):
    return 2 * math.pi * ((x + 0.5) / WIDTH - 0.5)


def mean(rows):
    """Of the luminance, by solid angle."""
    total = weights = 0.0
    for y, (reds, greens, blues) in enumerate(rows):
        weight = math.cos(math.pi * (0.5 - (y + 0.5) / len(rows)))
        total += weight * (0.2126 * sum(reds) + 0.7152 * sum(greens) + 0.0722 * sum(blues)) / len(reds)
        weights += weight
    return total / weights


def _encoded(values, scale):
    """Four planes of RGBE of a row, `values` being its reds, greens and blues."""
    planes = [bytearray(len(values[0])) for _ in range(4)]
    red, green, blue, exponents = planes
    before = texel = None
    for k, color in enumerate(zip(*values)):
        if color == before:
            red[k], green[k], blue[k], exponents[k] = texel
            continue
        r, g, b = before = color
        texel = (0, 0, 0, 0)
        most = max(color) * scale
        if most > 1e-32:
            fraction, exponent = math.frexp(most)
            factor = fraction * 256 / most * scale
            texel = int(r * factor), int(g * factor), int(b * factor), exponent + 128
        red[k], green[k], blue[k], exponents[k] = texel
    return planes


def _runs(plane):
    """One plane of a row: runs of four and more as (128 + count, byte), the rest as (count, bytes)."""
    data, at = bytearray(), 0

    def literal(end):
        for first in range(at, end, 128):
            part = plane[first:min(first + 128, end)]
            data.append(len(part))
            data.extend(part)
    for run in re.finditer(rb"(.)\1{3,126}", plane, re.DOTALL):
        literal(run.start())
        data.append(128 + run.end() - run.start())
        data.extend(run.group(1))
        at = run.end()
    literal(len(plane))
    return data


def write_hdr(path, rows, scale):
    """Writes rows of (reds, greens, blues), row 0 on top, times `scale`."""
    width = len(rows[0][0])
    data = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (len(rows), width))
    for row in rows:
        data += struct.pack(">BBH", 2, 2, width)
        for plane in _encoded(row, scale):
            data += _runs(bytes(plane))
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(data)
