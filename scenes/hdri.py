"""Four computed surroundings, 1024 x 512, linear light: two studios and two skies, as Radiance RGBE with runs.

An image's middle looks along -z, its right half along +x, +y is up: as relook reads it. The skies are Preetham, Shirley
and Smits, "A Practical Analytic Model for Daylight" (SIGGRAPH 1999), appendix A.2, over a ground of one colour, with
the sun as a disc of its own. Each image is scaled to a mean over the sphere; a sun's peak is 20,000 times that mean, as
those of measured skies that were kept without clipping are.
"""

import math
import os
import re
import struct

WIDTH, HEIGHT = 1024, 512
SUN_RADIUS = math.radians(0.53)  # twice the sun's, so that texels of 0.35 degrees hold its light
SUN_PEAK = 20000.0


def _encoded(values, scale):
    """Four planes of RGBE of a row, `values` being its reds, greens and blues."""
    planes = [bytearray(len(values[0])) for _ in range(4)]
    red, green, blue, exponents = planes
    for k, (r, g, b) in enumerate(zip(*values)):
        most = max(r, g, b) * scale
        if most > 1e-32:
            fraction, exponent = math.frexp(most)
            factor = fraction * 256 / most * scale
            red[k], green[k], blue[k] = int(r * factor), int(g * factor), int(b * factor)
            exponents[k] = exponent + 128
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


def _mean(rows):
    """Of the luminance, by solid angle."""
    total = weights = 0.0
    for y, (reds, greens, blues) in enumerate(rows):
        weight = math.cos(math.pi * (0.5 - (y + 0.5) / len(rows)))
        total += weight * (0.2126 * sum(reds) + 0.7152 * sum(greens) + 0.0722 * sum(blues)) / len(reds)
        weights += weight
    return total / weights


def _elevation(y):
    return math.pi * (0.5 - (y + 0.5) / HEIGHT)


def _azimuth(x):
    return 2 * math.pi * ((x + 0.5) / WIDTH - 0.5)


def _smooth(x):
    x = min(max(x, 0.0), 1.0)
    return x * x * (3 - 2 * x)


# --- studios

def _room(low, middle, high):
    """Rows of a room that is one grey at each height: below, at eye level, above."""
    rows = []
    for y in range(HEIGHT):
        s = math.sin(_elevation(y))
        end = low if s < 0 else high
        t = _smooth(abs(s) * 1.3)
        rows.append(tuple([middle[i] + (end[i] - middle[i]) * t] * WIDTH for i in range(3)))
    return rows


def _add_panel(rows, azimuth, elevation, width, height, color, edge=0.12, glow=0.25, replace=False):
    """A flat panel that faces the middle: angles in degrees, sizes as tangents of half angles; `edge` is how much of it
    fades out, `glow` how much brighter its middle is. `replace` puts it before what is there, else it adds to it."""
    a, e = math.radians(azimuth), math.radians(elevation)
    front = (math.sin(a) * math.cos(e), math.sin(e), -math.cos(a) * math.cos(e))
    right = (math.cos(a), 0.0, math.sin(a))
    up = (-math.sin(a) * math.sin(e), math.cos(e), math.cos(a) * math.sin(e))
    around = [(math.sin(_azimuth(x)), -math.cos(_azimuth(x))) for x in range(WIDTH)]
    reach = math.cos(math.atan(math.hypot(width, height)))
    for y in range(HEIGHT):
        c, s = math.cos(_elevation(y)), math.sin(_elevation(y))
        if math.cos(_elevation(y) - e) < reach:
            continue
        row = rows[y]
        for x, (dx, dz) in enumerate(around):
            depth = c * (dx * front[0] + dz * front[2]) + s * front[1]
            if depth < reach:
                continue
            across = abs(c * (dx * right[0] + dz * right[2])) / depth / width
            along = abs(c * (dx * up[0] + dz * up[2]) + s * up[1]) / depth / height
            if across < 1 and along < 1:
                inside = _smooth((1 - across) / edge * width / max(width, height)
                                 if width > height else (1 - across) / edge) * _smooth((1 - along) / edge)
                light = 1 + glow * (1 - across * across) * (1 - along * along)
                for i in range(3):
                    before = row[i][x]
                    row[i][x] = before * (1 - inside) + color[i] * light * inside if replace else before + color[i] * light * inside
    return rows


def _studio():
    rows = _room((0.012, 0.012, 0.013), (0.030, 0.031, 0.034), (0.050, 0.052, 0.056))
    _add_panel(rows, -128, 34, 0.62, 0.50, (7.2, 7.0, 6.7))             # large softbox, camera left
    _add_panel(rows, 122, 26, 0.34, 0.62, (4.2, 4.4, 4.8))              # large softbox, camera right
    _add_panel(rows, 78, 20, 0.07, 0.75, (11.0, 11.0, 11.4), 0.3)       # strip, right
    _add_panel(rows, -30, 80, 0.55, 0.45, (3.0, 3.0, 3.1), 0.3)         # overhead
    return rows, 0.3


def _studio_high_key():
    rows = _room((0.55, 0.54, 0.53), (0.80, 0.80, 0.80), (1.25, 1.26, 1.28))
    _add_panel(rows, -125, 40, 0.75, 0.60, (3.6, 3.6, 3.5), 0.4)
    _add_panel(rows, 125, 40, 0.75, 0.60, (3.2, 3.25, 3.3), 0.4)
    _add_panel(rows, 0, 85, 0.80, 0.80, (2.4, 2.4, 2.4), 0.5)
    for side in (-88, 88):                                              # black cards draw the edges of glass and metal
        _add_panel(rows, side, 8, 0.16, 0.80, (0.012, 0.012, 0.012), 0.08, 0.0, True)
    _add_panel(rows, 178, 2, 0.30, 0.22, (0.02, 0.02, 0.02), 0.2, 0.0, True)
    return rows, 1.1


# --- skies: coefficients A to E of the luminance and of x and y, each a line in the turbidity

_DISTRIBUTION = (
    ((0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)),
    ((-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)),
    ((-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529)))
_ZENITH_X = ((0.00166, -0.00375, 0.00209, 0.0), (-0.02903, 0.06377, -0.03202, 0.00394), (0.11693, -0.21196, 0.06052, 0.25886))
_ZENITH_Y = ((0.00275, -0.00610, 0.00317, 0.0), (-0.04214, 0.08970, -0.04153, 0.00516), (0.15346, -0.26756, 0.06670, 0.26688))


def _zenith(turbidity, sun):
    """Luminance, x and y straight up; `sun` is the sun's angle from there."""
    chi = (4 / 9 - turbidity / 120) * (math.pi - 2 * sun)
    luminance = (4.0453 * turbidity - 4.9710) * math.tan(chi) - 0.2155 * turbidity + 2.4192

    def chromaticity(table):
        return sum(t * sum(c * s for c, s in zip(row, (sun ** 3, sun ** 2, sun, 1.0)))
                   for row, t in zip(table, (turbidity ** 2, turbidity, 1.0)))
    return max(luminance, 0.02), chromaticity(_ZENITH_X), chromaticity(_ZENITH_Y)


def _rgb(luminance, x, y):
    """Linear Rec.709; never negative."""
    cx, cz = luminance * x / y, luminance * (1 - x - y) / y
    return (max(3.2406 * cx - 1.5372 * luminance - 0.4986 * cz, 0.0),
            max(-0.9689 * cx + 1.8758 * luminance + 0.0415 * cz, 0.0),
            max(0.0557 * cx - 0.2040 * luminance + 1.0570 * cz, 0.0))


def _sky(turbidity, sun_azimuth, sun_elevation, ground, sun_color):
    """Rows of the sky and the ground, and of the share of each texel that the sun's disc covers: {(x, y): share}."""
    sun = math.pi / 2 - sun_elevation
    tables = [[slope * turbidity + base for slope, base in table] for table in _DISTRIBUTION]
    zenith = _zenith(turbidity, sun)
    at_zenith = [(1 + a * math.exp(b)) * (1 + c * math.exp(d * sun) + e * math.cos(sun) ** 2) for a, b, c, d, e in tables]
    turns = [math.cos(_azimuth(x) - sun_azimuth) for x in range(WIDTH)]
    rows = []
    for y in range(HEIGHT // 2):
        up = math.sin(_elevation(y))
        c, s = math.cos(_elevation(y)) * math.sin(sun), up * math.cos(sun)
        heights = [(1 + a * math.exp(b / max(up, 0.02))) * z / n for (a, b, *_), z, n in zip(tables, zenith, at_zenith)]
        row, known = ([], [], []), {}
        for turn in turns:
            key = round(turn, 9)  # the two sides of the sun are alike
            color = known.get(key)
            if color is None:
                cosine = min(max(c * turn + s, -1.0), 1.0)
                angle, square = math.acos(cosine), cosine * cosine
                color = _rgb(*[h * (1 + t[2] * math.exp(t[3] * angle) + t[4] * square) for h, t in zip(heights, tables)])
                known[key] = color
            for values, value in zip(row, color):
                values.append(value)
        rows.append(row)
    light = sum(sum(row[1]) / WIDTH * math.sin(_elevation(y)) * math.cos(_elevation(y)) for y, row in enumerate(rows)) * (
        2 * math.pi * math.pi / HEIGHT)
    horizon = [sum(rows[-1][i]) / WIDTH for i in range(3)]
    for y in range(HEIGHT // 2, HEIGHT):
        far = math.exp(-12 * -math.sin(_elevation(y)))
        rows.append(tuple([ground[i] * light / math.pi * 1.4 * (1 - far) + horizon[i] * 0.5 * far] * WIDTH for i in range(3)))
    return rows, _sun_disc(sun_azimuth, sun_elevation), sun_color


def _sun_disc(azimuth, elevation):
    middle_x = (azimuth / 2 / math.pi + 0.5) * WIDTH
    middle_y = (0.5 - elevation / math.pi) * HEIGHT
    shares = {}
    front = (math.sin(azimuth) * math.cos(elevation), math.sin(elevation), -math.cos(azimuth) * math.cos(elevation))
    reach = SUN_RADIUS / math.pi * HEIGHT + 1
    wide = reach / math.cos(elevation)
    for y in range(int(middle_y - reach), int(middle_y + reach) + 1):
        for x in range(int(middle_x - wide), int(middle_x + wide) + 1):
            inside = 0
            for k in range(64):
                a, e = _azimuth(x + (k % 8 - 3.5) / 8), _elevation(y + (k // 8 - 3.5) / 8)
                d = (math.sin(a) * math.cos(e), math.sin(e), -math.cos(a) * math.cos(e))
                inside += math.hypot(*(p - q for p, q in zip(d, front))) < SUN_RADIUS
            if inside:
                shares[x % WIDTH, y] = inside / 64
    return shares


def _with_sun(rows, shares, color):
    """Adds a sun whose peak is SUN_PEAK times the mean of all, the sun included."""
    solid_angle = sum(share * math.cos(_elevation(y)) for (x, y), share in shares.items()) * 2 * math.pi * math.pi / WIDTH / HEIGHT
    peak = SUN_PEAK * _mean(rows) / (1 - SUN_PEAK * solid_angle / 4 / math.pi)
    tint = peak / (0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2])
    for (x, y), share in shares.items():
        for i in range(3):
            rows[y][i][x] += color[i] * tint * share
    return rows


def _clear_sky():
    return _with_sun(*_sky(2.6, math.radians(-142), math.radians(38), (0.34, 0.31, 0.27), (1.0, 0.93, 0.82))), 0.55


def _dusk():
    return _with_sun(*_sky(4.5, math.radians(-128), math.radians(5), (0.20, 0.18, 0.17), (1.0, 0.48, 0.16))), 0.40


SURROUNDINGS = {"Studio": ("studio", _studio), "StudioHighKey": ("studio-high-key", _studio_high_key),
                "Sky": ("sky", _clear_sky), "Dusk": ("dusk", _dusk)}


def write(folder):
    """Writes FOLDER/*.hdr; returns {image name: file name}."""
    for file, make in SURROUNDINGS.values():
        rows, mean = make()
        write_hdr(os.path.join(folder, file + ".hdr"), rows, mean / _mean(rows))
    return {name: file for name, (file, make) in SURROUNDINGS.items()}
