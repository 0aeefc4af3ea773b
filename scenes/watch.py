"""The wrist watch of the product shot. Lengths in millimetres; the dial looks along +y, -z is 12 o'clock, +x 3 o'clock.

`parts()` says which shape belongs to which node and material; the strap is closed round a cushion that lies behind it.
"""

import math

import solids
from shapes import Shape
from solids import bevelled, circle, framed, lathe, rectangle, rounded_line, slab

DIAL_RADIUS, DIAL_HEIGHT = 15.4, 1.2
LOOP_ACROSS, LOOP_DEEP, LOOP_CENTER = 29.0, 25.5, -24.0  # half axes of the strap's ellipse, and its height


def _case():
    body = lathe(rounded_line([(0.0, -6.3, 0), (14.5, -6.3, 0.4), (15.2, -5.6, 0.4), (18.2, -5.2, 1.0),
                               (20.0, -3.4, 0.5), (20.0, 1.7, 0.7), (19.1, 2.6, 0.3), (16.2, 2.6, 0.1),
                               (15.3, DIAL_HEIGHT - 0.1, 0)]), 160)
    side = rounded_line([(11.0, -4.6, 0.8), (19.5, -5.6, 2.0), (23.6, -9.0, 0.7), (25.0, -8.2, 1.0), (23.4, -3.2, 6.0),
                         (16.0, 1.7, 3.0), (11.0, 1.7, 0.5)], True, 7)
    lug = slab(side, bevelled(0.0, 3.0, 0.35, 0.45))
    for x in (10.2, -13.2):
        body.add(framed(lug, (x, 0, 0), (0, 0, -1), (1, 0, 0), (0, -1, 0)))
        body.add(framed(lug, (-x, 0, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0)))
    return body


def _bezel():
    def coin_edge(angle, height):
        return 0.11 * math.cos(90 * angle) if 2.9 < height < 4.3 else 0.0
    return lathe(rounded_line([(18.0, 2.7, 0), (20.1, 2.7, 0.25), (20.5, 3.1, 0.2), (20.5, 4.0, 0.3), (19.35, 5.0, 0.2),
                               (19.2, 4.6, 0), (16.7, 5.0, 0), (16.65, 5.45, 0.15), (16.35, 5.45, 0.12),
                               (16.3, 3.2, 0)]),
                 540, coin_edge)


def _insert():
    ring = lathe(rounded_line([(19.15, 4.4, 0), (19.15, 5.0, 0.12), (16.8, 5.42, 0.12), (16.8, 4.6, 0)], False, 4), 160)
    ring.uvs = [(1 - u, 1 - v) for u, v in ring.uvs]  # letters stand on the inner edge
    ring.tangents = [(-x, -y, -z, w) for x, y, z, w in ring.tangents]
    return ring


def _crystal():
    dome = [(r, 5.35 + 0.95 * (1 - (r / 16.15) ** 2), 6.0) for r in (12.9, 9.7, 6.4, 3.2)]
    return lathe(rounded_line([(0.0, 3.7, 0), (16.15, 3.7, 0.1), (16.15, 5.45, 0.3)] + dome + [(0.0, 6.3, 0)]), 128)


def _dial():
    disc = lathe([(r, DIAL_HEIGHT, 0.0, 1.0) for r in (DIAL_RADIUS, 11.0, 6.0, 2.0, 0.0)], 128)
    disc.uvs = [(0.5 + x / 2 / DIAL_RADIUS, 0.5 + z / 2 / DIAL_RADIUS) for x, y, z in disc.positions]
    return disc


def _turned(shape, angle, radius=0.0, lift=0.0):
    """Clockwise from 12 o'clock, seen from above, `radius` away from the middle."""
    s, c = math.sin(angle), math.cos(angle)
    return framed(shape, (radius * s, lift, -radius * c), (c, 0, s), (0, 1, 0), (-s, 0, c))


def _indices():
    """Applied markers and the stripes of paint on them."""
    markers, paint = Shape(), Shape()
    for hour in range(12):
        angle = math.pi * hour / 6
        long, wide = (4.0, 1.5) if hour % 3 == 0 else (3.4, 1.1)
        for side in ((-0.95, 0.95) if hour == 0 else (0.0,)):
            def place(shape, lift, side=side, radius=13.2 - long / 2):
                return _turned(framed(shape, (side, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)), angle, radius, lift)
            markers.add(place(slab(rectangle(wide, long, 0.22, 3), bevelled(0.0, 0.62, 0.0, 0.2)), DIAL_HEIGHT))
            paint.add(place(slab(rectangle(wide * 0.48, long - 0.62, 0.2, 3), bevelled(0.0, 0.09, 0.0, 0.06)),
                            DIAL_HEIGHT + 0.6))
    return markers, paint


def _hand(length, tail, width, low, ridge):
    """A sword of four flats: widest a fourth from the middle."""
    wide = -0.28 * length
    half = width / 2
    corners = [(-0.3, low, tail), (0.3, low, tail), (half, low, wide), (0.0, low, -length), (-half, low, wide),
               (0.0, low + ridge, tail), (0.0, low + ridge, wide), (0.0, low + ridge * 0.4, -length)]
    top = [(0, 5, 6), (0, 6, 4), (5, 1, 2), (5, 2, 6), (4, 6, 7), (4, 7, 3), (6, 2, 3), (6, 3, 7), (0, 1, 5)]
    bottom = [(0, 4, 2), (0, 2, 1), (4, 3, 2)]
    return solids.facets(corners, top + bottom)


def _second_hand():
    hand = slab(rectangle(0.3, 18.6, 0.12, 2), bevelled(0.0, 0.14, 0.0, 0.05))
    hand = framed(hand, (0, 0, -4.5), (1, 0, 0), (0, 1, 0), (0, 0, 1))
    return hand.add(slab(circle(0.95, 32), bevelled(0.0, 0.16, 0.0, 0.06)), move=(0, 0, 3.6)).add(
        slab(circle(0.8, 32), bevelled(0.0, 0.3, 0.0, 0.1)))


def _crown():
    def knurl(angle, height):
        return 0.13 * math.cos(30 * angle) if 0.5 < height < 3.2 else 0.0
    crown = lathe(rounded_line([(1.4, -1.0, 0), (1.4, 0.2, 0.1), (2.9, 0.2, 0.25), (3.15, 0.8, 0.3), (3.15, 3.1, 0.3),
                                (2.8, 3.7, 0.3), (0.0, 3.9, 0)]), 240, knurl)
    return framed(crown, (20.2, -0.6, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0))


def _loop(angle, out=0.0):
    """(place, side, up) on the strap's ellipse; `angle` from the dial's side, past 12 o'clock and round."""
    s, c = math.sin(angle), math.cos(angle)
    up = solids.unit((0.0, c / LOOP_DEEP, -s / LOOP_ACROSS))
    along = solids.unit((0.0, -s * LOOP_DEEP, -c * LOOP_ACROSS))
    place = (0.0, LOOP_CENTER + LOOP_DEEP * c + up[1] * out, -LOOP_ACROSS * s + up[2] * out)
    return place, solids.cross(up, along), up


STRAP_START = math.asin(19.2 / LOOP_ACROSS)


def _strap_size(angle):
    """Width and thickness: padded at the lugs, thinner and narrower behind."""
    far = min(angle - STRAP_START, 2 * math.pi - STRAP_START - angle)
    thin = min(max(far / 1.5, 0.0), 1.0)
    thin = thin * thin * (3 - 2 * thin)
    return 19.8 - 2.2 * thin, 4.3 - 1.9 * thin


def _strap():
    steps = 120
    frames, sections = [], []
    for k in range(steps + 1):
        angle = STRAP_START + (2 * math.pi - 2 * STRAP_START) * k / steps
        width, thick = _strap_size(angle)
        frames.append(_loop(angle, -0.2))
        edge = 0.95
        sections.append(rounded_line([(-width / 2, -thick / 2, 0.5), (width / 2, -thick / 2, 0.5),
                                      (width / 2, thick / 2 - 0.9, edge), (width / 2 - 2.6, thick / 2 - 0.12, 0.5),
                                      (width / 2 - 4.4, thick / 2 + 0.3, 3), (-width / 2 + 4.4, thick / 2 + 0.3, 3),
                                      (-width / 2 + 2.6, thick / 2 - 0.12, 0.5), (-width / 2, thick / 2 - 0.9, edge)],
                                     True, 4))
    return solids.sweep(frames, sections, (4, 12))


def _stitches():
    """Two rows of thread on the outer side, as far as they can be seen."""
    thread, stitches = solids.capsule(2.1, 0.33), Shape()
    for start, end in ((STRAP_START + 0.24, 2.9), (2 * math.pi - STRAP_START - 0.24, 3.4)):
        angle, step = start, math.copysign(1.0, end - start)
        while (end - angle) * step > 0:
            width, thick = _strap_size(angle)
            place, side, up = _loop(angle, thick / 2 - 0.3)
            along = solids.cross(side, up)
            for across in (-1, 1):
                at = tuple(p + s * across * (width / 2 - 2.35) for p, s in zip(place, side))
                stitches.add(framed(thread, at, along, up, solids.cross(along, up)))
            angle += step * 3.0 / math.hypot(LOOP_ACROSS * math.cos(angle), LOOP_DEEP * math.sin(angle))
    return stitches


def _cushion():
    outline = []
    for k in range(96):
        angle = 2 * math.pi * k / 96
        a, b = (LOOP_ACROSS - 2.0) * math.cos(angle), (LOOP_DEEP - 2.0) * math.sin(angle)
        na, nb = math.cos(angle) / LOOP_ACROSS, math.sin(angle) / LOOP_DEEP
        length = math.hypot(na, nb)
        outline.append((a, LOOP_CENTER + min(b, 14.0), na / length, nb / length))
    roll = slab(outline, bevelled(-14.0, 14.0, 6.0, 6.0, 10))
    return framed(roll, (0, 0, 0), (0, 0, -1), (1, 0, 0), (0, -1, 0))


def parts():
    """(node, material, shape) of each part."""
    markers, paint = _indices()
    hour, minute = math.radians(304.5), math.radians(54.0)
    hands = ((_hand(8.6, 2.0, 2.0, DIAL_HEIGHT + 0.85, 0.34), hour),
             (_hand(12.9, 2.4, 1.7, DIAL_HEIGHT + 1.3, 0.3), minute))
    return [("Case", "Case", _case()), ("Bezel", "Bezel", _bezel()), ("Insert", "Insert", _insert()),
            ("Crown", "Case", _crown()), ("Dial", "Dial", _dial()), ("Indices", "Hands", markers),
            ("Paint", "Paint", paint),
            ("HourHand", "Hands", _turned(*hands[0])), ("MinuteHand", "Hands", _turned(*hands[1])),
            ("SecondHand", "SecondHand", _turned(_second_hand(), math.radians(214.0), 0.0, DIAL_HEIGHT + 1.75)),
            ("Glass", "Glass", _crystal()), ("Strap", "Strap", _strap()), ("Stitches", "Thread", _stitches()),
            ("Cushion", "Cushion", _cushion())]


def lowest(tilt):
    """How far below the watch's origin the strap reaches when the dial is tilted forward by `tilt`, in millimetres."""
    steps = [_loop(2 * math.pi * k / 720, 1.2)[0] for k in range(720)]
    return min(y * math.cos(tilt) - z * math.sin(tilt) for x, y, z in steps)
