"""Two photographer's studios as surroundings: rooms of one grey at each height, with panels that shine."""

import math

from radiance import HEIGHT, WIDTH, azimuth, elevation
from shapes import smoothstep


def _room(low, middle, high):
    """Rows of a room that is one grey at each height: below, at eye level, above."""
    rows = []
    for y in range(HEIGHT):
        s = math.sin(elevation(y))
        end = low if s < 0 else high
        t = smoothstep(0.0, 1.0, abs(s) * 1.3)
        rows.append(tuple([middle[i] + (end[i] - middle[i]) * t] * WIDTH for i in range(3)))
    return rows


def _add_panel(rows, turn, lift, width, height, color, edge=0.12, glow=0.25, replace=False):
    """A flat panel that faces the middle, `turn` degrees to the right of -z and `lift` up; sizes as tangents of half
    angles; `edge` is how much of it fades out, `glow` how much brighter its middle is. `replace` puts it before what is
    there, else it adds to it."""
    a, e = math.radians(turn), math.radians(lift)
    front = (math.sin(a) * math.cos(e), math.sin(e), -math.cos(a) * math.cos(e))
    right = (math.cos(a), 0.0, math.sin(a))
    up = (-math.sin(a) * math.sin(e), math.cos(e), math.cos(a) * math.sin(e))
    around = [(math.sin(azimuth(x)), -math.cos(azimuth(x))) for x in range(WIDTH)]
    reach = math.cos(math.atan(math.hypot(width, height)))
    for y in range(HEIGHT):
        c, s = math.cos(elevation(y)), math.sin(elevation(y))
        if math.cos(elevation(y) - e) < reach:
            continue
        row = rows[y]
        for x, (dx, dz) in enumerate(around):
            depth = c * (dx * front[0] + dz * front[2]) + s * front[1]
            if depth < reach:
                continue
            across = abs(c * (dx * right[0] + dz * right[2])) / depth / width
            along = abs(c * (dx * up[0] + dz * up[2]) + s * up[1]) / depth / height
            if across < 1 and along < 1:
                inside = smoothstep(0.0, edge, 1 - across) * smoothstep(0.0, edge, 1 - along)
                light = 1 + glow * (1 - across * across) * (1 - along * along)
                for i in range(3):
                    kept = 1 - inside if replace else 1.0
                    row[i][x] = row[i][x] * kept + color[i] * light * inside
    return rows


def studio():
    rows = _room((0.012, 0.012, 0.013), (0.030, 0.031, 0.034), (0.050, 0.052, 0.056))
    _add_panel(rows, -128, 34, 0.62, 0.50, (7.2, 7.0, 6.7))             # large softbox, camera left
    _add_panel(rows, 122, 26, 0.34, 0.62, (4.2, 4.4, 4.8))              # large softbox, camera right
    _add_panel(rows, 78, 20, 0.07, 0.75, (11.0, 11.0, 11.4), 0.3)       # strip, right
    _add_panel(rows, -70, 18, 0.06, 0.75, (9.0, 9.0, 9.2), 0.3)         # strip, left
    _add_panel(rows, -30, 80, 0.55, 0.45, (3.0, 3.0, 3.1), 0.3)         # overhead
    return rows


def high_key():
    rows = _room((0.55, 0.54, 0.53), (0.80, 0.80, 0.80), (1.25, 1.26, 1.28))
    _add_panel(rows, -125, 40, 0.75, 0.60, (3.6, 3.6, 3.5), 0.4)
    _add_panel(rows, 125, 40, 0.75, 0.60, (3.2, 3.25, 3.3), 0.4)
    _add_panel(rows, 0, 85, 0.80, 0.80, (2.4, 2.4, 2.4), 0.5)
    for side in (-88, 88):                                              # black cards draw the edges of glass and metal
        _add_panel(rows, side, 8, 0.16, 0.80, (0.012, 0.012, 0.012), 0.08, 0.0, True)
    _add_panel(rows, 178, 2, 0.30, 0.22, (0.02, 0.02, 0.02), 0.2, 0.0, True)
    return rows
