"""Solids with bevelled edges for the product shot: lathes, slabs and sweeps whose normals and tangents are exact.

Lines are lists of (x, y, nx, ny), their normals to the right of the way: `rounded_line` makes them from corners with
radii; flats keep flat normals, so that highlights stay on the bevels. Lengths are millimetres; a scene in metres scales
what it packs. Tangents are those of glTF, along rising u, with w = 1.
"""

import math

from shapes import Shape


def _minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def _times(a, s):
    return tuple(x * s for x in a)


def _plus(*vectors):
    return tuple(map(sum, zip(*vectors)))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v, otherwise=(0.0, 1.0, 0.0)):
    length = math.sqrt(sum(x * x for x in v))
    return _times(v, 1 / length) if length > 1e-12 else otherwise


def _corner(before, corner, after, steps):
    """The points that round one corner (x, y, radius) of a line; two at one place where the radius is 0."""
    (x0, y0), (x1, y1), (x2, y2) = before[:2], corner[:2], after[:2]
    in_length, out_length = math.hypot(x1 - x0, y1 - y0), math.hypot(x2 - x1, y2 - y1)
    dx, dy = (x1 - x0) / in_length, (y1 - y0) / in_length
    ex, ey = (x2 - x1) / out_length, (y2 - y1) / out_length
    turn = math.atan2(dx * ey - dy * ex, dx * ex + dy * ey)
    if abs(turn) < 1e-6:
        return [(x1, y1, dy, -dx)]
    radius = corner[2]
    if radius <= 0:
        return [(x1, y1, dy, -dx), (x1, y1, ey, -ex)]
    way = radius * math.tan(abs(turn) / 2)
    side = math.copysign(radius, turn)
    sx, sy = x1 - dx * way - dy * side, y1 - dy * way + dx * side  # the centre of the arc
    points = []
    for k in range(steps + 1):
        c, s = math.cos(turn * k / steps), math.sin(turn * k / steps)
        nx, ny = dy * c + dx * s, dy * s - dx * c
        points.append((sx + nx * side, sy + ny * side, nx, ny))
    return points


def rounded_line(corners, closed=False, steps=5):
    """The line through `corners` (x, y, radius). A closed one runs counter-clockwise, and has outward normals."""
    points = []
    last = len(corners) - 1
    for k, corner in enumerate(corners):
        if not closed and k in (0, last):
            x, y = (corners[1][i] - corner[i] if k == 0 else corner[i] - corners[k - 1][i] for i in (0, 1))
            length = math.hypot(x, y)
            points.append((corner[0], corner[1], y / length, -x / length))
        else:
            points += _corner(corners[k - 1], corner, corners[(k + 1) % (last + 1)], steps)
    return points


def rectangle(width, height, radius, steps=5):
    """A closed line about the origin."""
    w, h = width / 2, height / 2
    return rounded_line([(-w, -h, radius), (w, -h, radius), (w, h, radius), (-w, h, radius)], True, steps)


def circle(radius, steps=48):
    return [(radius * math.cos(a), radius * math.sin(a), math.cos(a), math.sin(a))
            for a in (2 * math.pi * k / steps for k in range(steps))]


def net(rows, closed):
    """A sheet through rows of (position, normal, tangent, (u, v)), rows upwards, each row to the right; v downwards.
    `closed` joins each row's end to its start, for which the first point is repeated with u = 1."""
    shape = Shape()
    width = len(rows[0]) + (1 if closed else 0)
    for row in rows:
        for k in range(width):
            position, normal, tangent, uv = row[k % len(row)]
            shape.positions.append(position)
            shape.normals.append(normal)
            shape.tangents.append(tangent + (1.0,))
            shape.uvs.append(uv if k < len(row) else (1.0, uv[1]))
    for j in range(len(rows) - 1):
        for i in range(width - 1):
            a = j * width + i
            b, c, d = a + 1, a + width, a + width + 1
            for triangle in ((a, b, d), (a, d, c)):
                p, q, r = (tuple(round(x, 4) for x in shape.positions[k]) for k in triangle)
                if p != q and q != r and r != p:
                    shape.triangles.append(triangle)
    return shape


def _heights(line):
    """How far along its length each point of a line is, from 0 to 1."""
    ways = [0.0]
    for p, q in zip(line, line[1:]):
        ways.append(ways[-1] + math.hypot(q[0] - p[0], q[1] - p[1]))
    return [way / ways[-1] for way in ways]


def lathe(profile, columns=96, ripple=None):
    """Turns a line of (radius, height) about +y, body on its left: upwards outside, inwards on top. `ripple(angle,
    height)` is added to the radius, and only leans the normals. u runs around, the tangent with it."""
    rows = []
    for (radius, height, nr, ny), v in zip(profile, _heights(profile)):
        row = []
        for i in range(columns):
            angle = 2 * math.pi * i / columns
            s, c = math.sin(angle), math.cos(angle)
            r, lean = radius, 0.0
            if ripple and radius > 0:
                r += ripple(angle, height)
                lean = -(ripple(angle + 1e-4, height) - ripple(angle - 1e-4, height)) / 2e-4 / radius * nr
            normal = unit((nr * s + lean * c, ny, nr * c - lean * s))
            across = c * normal[0] - s * normal[2]
            tangent = unit(_minus((c, 0.0, -s), _times(normal, across)))
            row.append(((r * s, height, r * c), normal, tangent, (i / columns, 1 - v)))
        rows.append(row)
    return net(rows, True)


def _cap(shape, ring, height, up):
    """Closes a slab with a fan about the middle of `ring`, points (a, b) that see it."""
    first = len(shape.positions)
    low = [min(p[i] for p in ring) for i in (0, 1)]
    size = [max(p[i] for p in ring) - low[i] for i in (0, 1)]
    middle = tuple(sum(p[i] for p in ring) / len(ring) for i in (0, 1))
    for a, b in [middle] + list(ring):
        shape.positions.append((a, height, -b))
        shape.normals.append((0.0, up, 0.0))
        shape.tangents.append((1.0, 0.0, 0.0, 1.0))
        u = (a - low[0]) / size[0]
        shape.uvs.append((u if up > 0 else 1 - u, 1 - (b - low[1]) / size[1]))
    if up < 0:
        shape.tangents[first:] = [(-1.0, 0.0, 0.0, 1.0)] * (len(ring) + 1)
    for k in range(len(ring)):
        i, j = first + 1 + k, first + 1 + (k + 1) % len(ring)
        if ring[k] != ring[(k + 1) % len(ring)]:
            shape.triangles.append((first, i, j) if up > 0 else (first, j, i))


def slab(outline, profile):
    """A solid of constant section: the closed line `outline` in (x, -z), moved outwards along its normals and up as the
    open line `profile` of (offset, height) says. Closed below and above."""
    rows = []
    around = _heights(outline + outline[:1])
    for (offset, height, no, ny), v in zip(profile, _heights(profile)):
        row = []
        for (a, b, na, nb), u in zip(outline, around):
            row.append(((a + na * offset, height, -(b + nb * offset)), (na * no, ny, -nb * no), (-nb, 0.0, -na),
                        (u, 1 - v)))
        rows.append(row)
    shape = net(rows, True)
    for end, up in ((profile[0], -1.0), (profile[-1], 1.0)):
        _cap(shape, [(a + na * end[0], b + nb * end[0]) for a, b, na, nb in outline], end[1], up)
    return shape


def bevelled(low, high, bottom, top, steps=4):
    """The profile of a slab with rounded edges; radii of the lower and of the upper one."""
    corners = [(-bottom - 1e-3, low, 0), (0, low, bottom), (0, high, top), (-top - 1e-3, high, 0)]
    return rounded_line(corners, False, steps)


def sweep(frames, sections, repeats, closed=True):
    """Moves a line along a path: `frames` of (place, side, up), sections[k] in (side, up); the way
    goes along side x up. `repeats`: how often the texture repeats around and along."""
    ways = [0.0]
    for a, b in zip(frames, frames[1:]):
        ways.append(ways[-1] + math.dist(a[0], b[0]))
    rows = []
    for (place, side, up), section, way in zip(frames, sections, ways):
        around = _heights(section + section[:1]) if closed else _heights(section)
        row = []
        for (a, b, na, nb), u in zip(section, around):
            row.append((_plus(place, _times(side, a), _times(up, b)), _plus(_times(side, na), _times(up, nb)),
                        _plus(_times(side, -nb), _times(up, na)), (u * repeats[0], 1 - way / ways[-1] * repeats[1])))
        rows.append(row)
    shape = net(rows, closed)
    if closed:  # the seam's u is a whole repeat, not 1
        width = len(rows[0]) + 1
        for j in range(len(rows)):
            shape.uvs[(j + 1) * width - 1] = (repeats[0], shape.uvs[(j + 1) * width - 1][1])
    return shape


def capsule(length, radius, columns=8, steps=3):
    """Along x, about the origin; coarse, for threads."""
    half = length / 2 - radius
    ends = [(k * math.pi / 2 / steps, half) for k in range(steps, -1, -1)]
    rows = []
    for angle, x in [(-a, -x) for a, x in ends] + [(a, x) for a, x in reversed(ends)]:
        row = []
        for i in range(columns):
            turn = 2 * math.pi * i / columns
            c, s = math.cos(turn), math.sin(turn)
            across = (math.sin(angle), math.cos(angle) * c, math.cos(angle) * s)
            row.append(((x + radius * across[0], radius * across[1], radius * across[2]), across, (0.0, -s, c),
                        (i / columns, 0.5 - x / length)))
        rows.append(row)
    return net(rows, True)


def facets(corners, triangles):
    """Flat faces between `corners`."""
    shape = Shape()
    for triangle in triangles:
        p, q, r = (corners[k] for k in triangle)
        normal = unit(cross(_minus(q, p), _minus(r, p)))
        first = len(shape.positions)
        shape.positions += [p, q, r]
        shape.normals += [normal] * 3
        shape.tangents += [unit(_minus(q, p)) + (1.0,)] * 3
        shape.uvs += [(0.0, 1.0), (1.0, 1.0), (0.5, 0.0)]
        shape.triangles.append((first, first + 1, first + 2))
    return shape


def flipped(shape):
    """The same surface seen from its other side: the wall of a hollow."""
    result = Shape()
    result.positions, result.uvs = list(shape.positions), list(shape.uvs)
    result.normals = [_times(n, -1.0) for n in shape.normals]
    result.tangents = [t[:3] + (-t[3],) for t in shape.tangents]
    result.triangles = [(a, c, b) for a, b, c in shape.triangles]
    return result


def framed(shape, place, x, y, z):
    """The shape in a frame of three unit vectors at `place`."""
    def turned(v):
        return _plus(_times(x, v[0]), _times(y, v[1]), _times(z, v[2]))
    result = Shape()
    result.positions = [_plus(place, turned(p)) for p in shape.positions]
    result.normals = [turned(n) for n in shape.normals]
    result.tangents = [turned(t) + (t[3],) for t in shape.tangents]
    result.uvs, result.triangles = list(shape.uvs), list(shape.triangles)
    return result


def scaled(shape, factor):
    result = framed(shape, (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
    result.positions = [_times(p, factor) for p in result.positions]
    return result
