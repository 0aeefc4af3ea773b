"""A bust with unruly hair, and its pedestal: a deformed sphere for the head, swept rings for neck and shoulders."""

import math

import shapes
from shapes import smoothstep

# (azimuth, elevation, width, height, amount): bumps and hollows of the face; azimuth 0 looks along +z. Those off the
# middle are mirrored.
FACE = [
    (0.0, -0.02, 0.085, 0.17, 0.10),     # bridge of the nose
    (0.0, -0.20, 0.10, 0.075, 0.13),     # tip
    (0.11, -0.22, 0.06, 0.05, 0.05),     # nostrils
    (0.36, 0.06, 0.15, 0.09, -0.095),    # eye sockets
    (0.36, 0.045, 0.075, 0.05, 0.05),    # eyes
    (0.30, 0.20, 0.22, 0.055, 0.055),    # brows
    (0.62, -0.16, 0.18, 0.14, 0.04),     # cheekbones
    (0.0, -0.335, 0.04, 0.04, -0.02),    # below the nose
    (0.0, -0.405, 0.17, 0.035, 0.04),    # upper lip
    (0.0, -0.455, 0.20, 0.02, -0.045),   # mouth
    (0.0, -0.51, 0.15, 0.04, 0.045),     # lower lip
    (0.0, -0.60, 0.20, 0.04, -0.03),     # below the lips
    (0.0, -0.74, 0.22, 0.11, 0.07),      # chin
    (1.55, -0.02, 0.10, 0.16, 0.10),     # ears
]


def _head(u, v):
    azimuth = 0.0 if u == 1 else 2 * math.pi * u - math.pi
    elevation = math.pi * (v - 0.5)
    azimuth = -math.pi if u == 1 else azimuth
    radius = 1.0
    for center, height, width, tall, amount in FACE:
        for side in ((center, -center) if center else (0.0,)):
            radius += amount * math.exp(-((azimuth - side) / width) ** 2 / 2 - ((elevation - height) / tall) ** 2 / 2)
    back = smoothstep(0.95, 1.35, abs(azimuth)) * smoothstep(-0.75, -0.45, elevation)
    top = smoothstep(0.42, 0.62, elevation + 0.12 * math.cos(2 * azimuth))
    hair = max(back, top)
    waves = (math.sin(9 * azimuth + 4 * math.sin(5 * elevation)) * math.cos(elevation) +
             0.7 * math.sin(13 * elevation + 3 * math.sin(6 * azimuth)))
    radius += hair * (0.13 + 0.045 * waves)
    ring = 0.0 if v in (0, 1) else math.cos(elevation)
    low = smoothstep(0.1, -0.75, math.sin(elevation))
    x = 0.80 * (1 - 0.22 * low) * radius * ring * math.sin(azimuth)
    z = (0.92 - 0.06 * low) * radius * ring * math.cos(azimuth) + 0.05 * low
    return (x, 1.06 * radius * math.sin(elevation), z)


# Rings of neck and shoulders, lowest first: height, half width, half depth, forward shift.
TORSO = [(-3.05, 0.0, 0.0, 0.0), (-3.05, 0.42, 0.34, 0.0), (-2.95, 0.60, 0.42, 0.02), (-2.75, 1.00, 0.56, 0.05),
         (-2.50, 1.32, 0.66, 0.07), (-2.20, 1.50, 0.70, 0.06), (-1.95, 1.52, 0.66, 0.02), (-1.75, 1.38, 0.58, -0.03),
         (-1.58, 1.05, 0.50, -0.06), (-1.42, 0.68, 0.46, -0.08), (-1.25, 0.50, 0.46, -0.08), (-1.00, 0.44, 0.45, -0.06),
         (-0.70, 0.43, 0.44, -0.04), (-0.45, 0.42, 0.42, -0.02)]


def _torso(u, v):
    place = v * (len(TORSO) - 1)
    k = min(int(place), len(TORSO) - 2)
    height, width, depth, shift = (a + (b - a) * (place - k) for a, b in zip(TORSO[k], TORSO[k + 1]))
    azimuth = 0.0 if u == 1 else 2 * math.pi * u
    folds = 1 + 0.035 * math.sin(14 * azimuth + 5 * height) * smoothstep(-1.3, -1.8, height) * smoothstep(-3.0, -2.7, height)
    return (width * folds * math.sin(azimuth), height, depth * folds * math.cos(azimuth) + shift)


def bust():
    """About 2 m tall, standing on y = 0, facing +z."""
    scale, lift = 0.48, 3.05 * 0.48 + 0.20
    shape = shapes.Shape().add(shapes.grid(128, 96, _head), move=(0, lift, 0), scale=(scale,) * 3)
    shape.add(shapes.grid(64, 39, _torso), move=(0, lift, 0), scale=(scale,) * 3)
    socle = [(0.34, 0.0), (0.34, 0.06), (0.24, 0.11), (0.20, 0.17), (0.24, 0.25)]
    return shape.add(shapes.revolve(socle, 32))


def pedestal():
    """A square pillar 1.15 m tall with a base and a cap."""
    shape = shapes.Shape().add(shapes.box(1.10, 0.16, 1.10)).add(shapes.box(0.86, 0.83, 0.86), move=(0, 0.16, 0))
    return shape.add(shapes.box(1.02, 0.10, 1.02), move=(0, 0.99, 0)).add(shapes.box(0.94, 0.06, 0.94), move=(0, 1.09, 0))
