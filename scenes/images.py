"""Small images computed from formulas: PNG for materials, Radiance HDR for the sky."""

import math
import os
import struct
import zlib


def noise(x, y, period):
    """Smooth value noise in [0, 1] on an integer lattice that repeats after `period` cells."""
    def corner(i, j):
        n = (i % period) * 374761393 + (j % period) * 668265263
        n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
        return ((n ^ (n >> 16)) & 0xFFFF) / 65535
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    low = corner(i, j) * (1 - u) + corner(i + 1, j) * u
    high = corner(i, j + 1) * (1 - u) + corner(i + 1, j + 1) * u
    return low * (1 - v) + high * v


def write_png(path, size, pixel):
    """8-bit RGB, size x size; pixel(u, v) -> three numbers in [0, 1], v downwards."""
    data = bytearray()
    for y in range(size):
        for x in range(size):
            data += bytes(min(max(round(c * 255), 0), 255) for c in pixel((x + 0.5) / size, (y + 0.5) / size))
    write_rows(path, size, size, data)


def write_rows(path, width, height, data):
    """An 8-bit PNG of RGB bytes, row 0 on top."""
    rows = bytearray()
    for y in range(height):
        rows.append(0)
        rows += data[y * width * 3:(y + 1) * width * 3]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


def stone_tiles(u, v):
    """A checker of light and dark stone with joints: four tiles across."""
    i, j = int(u * 4), int(v * 4)
    s, t = u * 4 - i, v * 4 - j
    grain = 0.7 * noise(u * 32, v * 32, 32) + 0.3 * noise(u * 64, v * 64, 64)
    if min(s, t, 1 - s, 1 - t) < 0.02:
        return (0.35, 0.33, 0.30)
    base = (0.86, 0.80, 0.68) if (i + j) % 2 else (0.42, 0.27, 0.22)
    return tuple(c * (0.82 + 0.25 * grain) for c in base)


def wood_planks(u, v):
    """Planks along u, eight across, each with its own tone and grain."""
    plank = int(v * 8)
    tone = 0.75 + 0.25 * noise(plank * 1.7, plank * 2.3, 64)
    rings = noise(u * 8, v * 64 + plank * 5, 64)
    grain = 0.5 + 0.5 * math.sin(40 * (v * 2 + 0.15 * rings))
    joint = 0.5 if v * 8 - plank < 0.04 else 1.0
    return tuple(c * tone * joint * (0.8 + 0.2 * grain) for c in (0.80, 0.55, 0.32))


def dents(u, v):
    """A tangent-space normal map: soft dents between the joints of eight by eight tiles."""
    def height(x, y):
        return 0.5 * noise(x * 8, y * 8, 8) + 0.25 * noise(x * 16, y * 16, 16)
    step = 1 / 128
    dx = (height(u + step, v) - height(u - step, v)) / (2 * step)
    dy = (height(u, v + step) - height(u, v - step)) / (2 * step)
    x, y, z = -0.25 * dx, 0.25 * dy, 1.0
    length = math.sqrt(x * x + y * y + z * z)
    return tuple(0.5 + 0.5 * c / length for c in (x, y, z))


def write_sky(path, width=64, height=32):
    """A lat-long evening sky with a low bright sun: uncompressed Radiance RGBE."""
    data = bytearray()
    for row in range(height):
        elevation = math.pi * (0.5 - (row + 0.5) / height)
        for column in range(width):
            azimuth = 2 * math.pi * (column + 0.5) / width
            up = math.sin(elevation)
            glow = math.exp(-20 * ((azimuth - 2.0) ** 2 + (elevation - 0.25) ** 2))
            sky = ((0.35, 0.22, 0.30), (0.10, 0.16, 0.42)) if up > 0 else ((0.10, 0.08, 0.07), (0.05, 0.04, 0.04))
            t = abs(up) ** 0.5
            color = [a * (1 - t) + b * t + g * glow for a, b, g in zip(sky[0], sky[1], (6.0, 3.2, 1.2))]
            fraction, exponent = math.frexp(max(color))
            data += bytes([min(int(c * fraction * 256 / max(color)), 255) for c in color] + [exponent + 128])
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + data)
