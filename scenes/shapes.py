"""Shapes as indexed triangles with normals and texture coordinates: the raw material of the scenes.

A shape is right-handed, +y up, counter-clockwise seen from outside. Smooth normals are averaged over equal positions,
so that the seam of a grid does not show.
"""

import math


def _sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _unit(v, otherwise=(0.0, 1.0, 0.0)):
    length = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    return tuple(x / length for x in v) if length > 1e-12 else otherwise


class Shape:
    """positions, normals (unit), uvs: one per vertex; tangents (x, y, z, w) as well, or none; triangles: three vertex
    indices each."""

    def __init__(self):
        self.positions, self.normals, self.tangents, self.uvs, self.triangles = [], [], [], [], []

    def add(self, other, move=(0, 0, 0), scale=(1, 1, 1), turn=0.0):
        """Appends `other`, scaled, turned by `turn` radians about +y, then moved. Returns self."""
        first = len(self.positions)
        c, s = math.cos(turn), math.sin(turn)
        for p in other.positions:
            x, y, z = p[0] * scale[0], p[1] * scale[1], p[2] * scale[2]
            self.positions.append((c * x + s * z + move[0], y + move[1], c * z - s * x + move[2]))
        for n in other.normals:
            x, y, z = n[0] / scale[0], n[1] / scale[1], n[2] / scale[2]
            self.normals.append(_unit((c * x + s * z, y, c * z - s * x)))
        for t in other.tangents:
            x, y, z = t[0] * scale[0], t[1] * scale[1], t[2] * scale[2]
            self.tangents.append(_unit((c * x + s * z, y, c * z - s * x)) + (t[3],))
        self.uvs += other.uvs
        self.triangles += [tuple(first + i for i in triangle) for triangle in other.triangles]
        return self

    def smooth(self):
        """Sets every normal to the area-weighted mean over the triangles at its position. Returns self."""
        sums = {}
        keys = [tuple(round(x, 6) for x in p) for p in self.positions]
        for a, b, c in self.triangles:
            p, q, r = self.positions[a], self.positions[b], self.positions[c]
            n = _cross(_sub(q, p), _sub(r, p))
            for i in (a, b, c):
                s = sums.get(keys[i], (0.0, 0.0, 0.0))
                sums[keys[i]] = (s[0] + n[0], s[1] + n[1], s[2] + n[2])
        self.normals = [_unit(sums.get(key, (0.0, 1.0, 0.0))) for key in keys]
        return self


def grid(columns, rows, surface):
    """A smooth sheet: surface(u, v) -> position, u and v in [0, 1]; front where du x dv points."""
    shape = Shape()
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            shape.positions.append(surface(u, v))
            shape.uvs.append((u, 1 - v))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 1, a + columns + 2
            for triangle in ((a, b, d), (a, d, c)):
                p, q, r = (tuple(round(x, 6) for x in shape.positions[k]) for k in triangle)
                if p != q and q != r and r != p:
                    shape.triangles.append(triangle)
    return shape.smooth()


def sphere(columns=96, rows=48):
    """Unit radius about the origin."""
    def surface(u, v):
        angle, height = 2 * math.pi * u, math.pi * (v - 0.5)
        ring = 0.0 if v in (0, 1) else math.cos(height)
        angle = 0.0 if u == 1 else angle
        return (ring * math.sin(angle), math.sin(height), ring * math.cos(angle))
    shape = grid(columns, rows, surface)
    shape.normals = [_unit(p) for p in shape.positions]
    return shape


def revolve(profile, columns=32):
    """Turns a polyline of (radius, height), lowest point first, about +y."""
    last = len(profile) - 1

    def surface(u, v):
        radius, height = profile[round(v * last)]
        angle = 0.0 if u == 1 else 2 * math.pi * u
        return (radius * math.sin(angle), height, radius * math.cos(angle))
    return grid(columns, last, surface)


def plane(width, depth, tiles=1.0, cells=1):
    """A horizontal rectangle about the origin, facing +y; the texture repeats `tiles` times across."""
    shape = grid(cells, cells, lambda u, v: ((u - 0.5) * width, 0.0, (0.5 - v) * depth))
    shape.uvs = [(u * tiles, v * tiles) for u, v in shape.uvs]
    return shape


def disc(columns=48):
    """A horizontal unit disc about the origin, facing +y."""
    return revolve([(1.0, 0.0), (0.0, 0.0)], columns)


def box(width, height, depth):
    """Sits on y = 0, centred in x and z, with flat faces."""
    shape = Shape()
    w, h, d = width / 2, height / 2, depth / 2
    for axis in range(3):
        for sign in (1.0, -1.0):
            normal = [0.0, 0.0, 0.0]
            normal[axis] = sign
            first = len(shape.positions)
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                corner = [0.0, 0.0, 0.0]
                corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3] = sign, s * sign, float(t)
                shape.positions.append((corner[0] * w, corner[1] * h + h, corner[2] * d))
                shape.normals.append(tuple(normal))
                shape.uvs.append(((s + 1) / 2, (1 - t) / 2))
            shape.triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return shape


def smoothstep(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)
