"""What stands beside the watch in the product shot: bottle, plinth, folded cloth, ring and sweep, in millimetres."""

import math

import images
import solids
from shapes import Shape
from solids import bevelled, flipped, lathe, rectangle, rounded_line, slab

LEVEL = 43.0  # of the liquid


def bottle_parts():
    """(node, material, shape); y = 0 is what the bottle stands on. One block of glass with a hollow for the air; the
    liquid fills the rest of the hollow, and touches the glass: its index of refraction is relative to it."""
    walls = rectangle(50, 27, 8, 8)
    glass = slab(walls, rounded_line([(-3.0, 0.0, 0), (0.0, 0.0, 2.5), (0.0, 58.0, 5.5), (-7.4, 63.0, 1.0),
                                      (-7.8, 63.0, 0)]))
    hollow = rectangle(41, 18.5, 4.5, 8)
    air = slab(hollow, rounded_line([(-1e-3, LEVEL, 0), (0.0, LEVEL, 0), (0.0, 55.0, 3.5), (-3.9, 56.5, 0.5),
                                     (-4.0, 56.5, 0)]))
    glass.add(flipped(air))
    top = LEVEL - 0.02
    liquid = slab(hollow, rounded_line([(-3.6, 9.0, 0), (0.0, 9.0, 3.5), (0.0, top, 0), (-1e-3, top, 0)]))
    label = slab(rectangle(33, 22, 0.8, 3), bevelled(0.0, 0.12, 0.0, 0.05, 2))
    label = solids.framed(label, (0, 32.0, 13.53), (1, 0, 0), (0, 0, 1), (0, -1, 0))
    collar = lathe(rounded_line([(9.6, 62.6, 0), (9.6, 64.6, 0.4), (8.2, 64.6, 0.1), (8.2, 66.2, 0)]), 96)
    cap = lathe(rounded_line([(10.0, 65.8, 0), (11.6, 65.8, 0.4), (11.6, 89.0, 1.2), (9.8, 89.0, 0.5), (9.3, 88.4, 0.4),
                              (0.0, 88.4, 0)]), 128)
    tube = lathe(rounded_line([(0.0, 11.0, 0), (0.9, 11.0, 0.2), (0.9, 62.9, 0)]), 24)
    return [("Bottle", "Bottle", glass), ("Liquid", "Liquid", liquid), ("Label", "Label", label),
            ("Collar", "Collar", collar), ("Cap", "Cap", cap), ("Tube", "Tube", tube)]


def plinth():
    return lathe(rounded_line([(29.0, 0.0, 0), (30.0, 0.0, 0.8), (30.0, 8.0, 1.4), (0.0, 8.0, 0)], False, 8), 160)


def ring():
    """A bangle that lies on y = 0."""
    section = rounded_line([(10.5, 0.0, 2.6), (16.0, 0.0, 2.6), (16.0, 7.5, 2.7), (10.5, 7.5, 2.7)], True, 10)
    return lathe(section + section[:1], 128)


def sweep():
    """Floor and wall in one sheet with a wide bend between; faces up and forward."""
    line = rounded_line([(-700.0, 0.0, 0), (320.0, 0.0, 240.0), (320.0, 620.0, 0)], False, 40)
    rows = []
    for k, (a, b, na, nb) in enumerate(line):
        rows.append([((x, b, -a), (0.0, -nb, na), (1.0, 0.0, 0.0), (x / 1400 + 0.5, 1 - k / (len(line) - 1)))
                     for x in (-600.0, -200.0, 200.0, 600.0)])
    return solids.net(rows, False)


def _layers(half):
    """The cloth's section, three layers `half` thick on each side: one line along both its faces."""
    corners = [(-47.0, 0.8, 0), (46.0, 0.8, 1.75), (46.0, 4.3, 1.75), (-43.0, 4.3, 1.75), (-43.0, 7.8, 1.75),
               (37.0, 7.8, 0)]
    rounded = rounded_line(corners, False, 8)
    line = []
    for p, q in zip(rounded, rounded[1:]):
        count = max(1, round(math.hypot(q[0] - p[0], q[1] - p[1]) / 2.5))
        for k in range(count):
            line.append(tuple(x + (y - x) * k / count for x, y in zip(p, q)))
    line.append(rounded[-1])
    forth = [(x + nx * half, y + ny * half) for x, y, nx, ny in line]
    back = [(x - nx * half, y - ny * half) for x, y, nx, ny in reversed(line)]
    end, start = ((p[0], p[1]) for p in (line[-1], line[0]))
    return forth + [(end[0] + half * 0.9, end[1])] + back + [(start[0] - half * 0.9, start[1])]


def cloth(repeats=(54, 17)):
    """A folded cloth on y = 0, with waves that let its layers part a little."""
    rows, count = [], 48
    for j in range(count + 1):
        t = 2 * j / count - 1
        edge = max(0.0, abs(t) - 0.97) / 0.03
        z = 34.0 * (math.copysign(1 - (1 - abs(t)) ** 1.3, t))
        row = []
        for x, y in _layers(0.62 * math.sqrt(max(1 - edge * edge, 0.003))):
            wave = images.noise(x / 19 + 40, z / 15 + 40, 997) - 0.5
            part = images.noise(x / 31 + 20, z / 23 + y / 5 + 60, 991)
            lift = y / 8.0
            row.append((x + 1.8 * math.sin(z / 16 + y * 0.4) * lift + 0.05 * z * lift,
                        y * (1 + 0.28 * wave) + 1.1 * part * lift,
                        z + 1.6 * math.sin(x / 21 + y * 0.7) + 0.06 * x * lift))
        rows.append(row)
    shape = Shape()
    width = len(rows[0]) + 1
    for j, row in enumerate(rows):
        for i in range(width):
            shape.positions.append(row[i % len(row)])
            shape.uvs.append((i / (width - 1) * repeats[0], (1 - j / count) * repeats[1]))
    for j in range(count):
        for i in range(width - 1):
            a = j * width + i
            shape.triangles += [(a, a + 1, a + width + 1), (a, a + width + 1, a + width)]
    shape.smooth()
    for j in range(count + 1):
        for i in range(width):
            n = shape.normals[j * width + i]
            row = rows[j]
            after, before = row[(i + 1) % len(row)], row[(i - 1) % len(row)]
            along = tuple(p - q for p, q in zip(after, before))
            lean = sum(p * q for p, q in zip(along, n))
            shape.tangents.append(solids.unit(tuple(p - lean * q for p, q in zip(along, n)), (1.0, 0.0, 0.0)) + (1.0,))
    return shape
