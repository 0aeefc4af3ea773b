"""Two skies as surroundings: Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight" (SIGGRAPH 1999),
appendix A.2, over a ground of one colour, with the sun as a disc of its own: its peak is 20,000 times the mean of all,
as in measured skies that were kept without clipping."""

import math

from radiance import HEIGHT, WIDTH, azimuth, elevation, mean

SUN_RADIUS = math.radians(0.53)  # twice the sun's, so that texels of 0.35 degrees hold its light
SUN_PEAK = 20000.0

# Coefficients A to E of the luminance and of x and y, each a line in the turbidity.
_DISTRIBUTION = (
    ((0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)),
    ((-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)),
    ((-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529)))
_ZENITH_X = ((0.00166, -0.00375, 0.00209, 0.0), (-0.02903, 0.06377, -0.03202, 0.00394),
             (0.11693, -0.21196, 0.06052, 0.25886))
_ZENITH_Y = ((0.00275, -0.00610, 0.00317, 0.0), (-0.04214, 0.08970, -0.04153, 0.00516),
             (0.15346, -0.26756, 0.06670, 0.26688))


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
    """Rows of the sky and the ground, and the share of each texel that the sun's disc covers: {(x, y): share}. The sun
    stands between two columns of texels."""
    sun_azimuth = 2 * math.pi * round(sun_azimuth / 2 / math.pi * WIDTH) / WIDTH
    sun = math.pi / 2 - sun_elevation
    tables = [[slope * turbidity + base for slope, base in table] for table in _DISTRIBUTION]
    zenith = _zenith(turbidity, sun)
    at_zenith = [(1 + a * math.exp(b)) * (1 + c * math.exp(d * sun) + e * math.cos(sun) ** 2)
                 for a, b, c, d, e in tables]
    turns = [round(math.cos(azimuth(x) - sun_azimuth), 9) for x in range(WIDTH)]
    sides = sorted(set(turns))  # the two sides of the sun are alike
    places = [sides.index(turn) for turn in turns]
    rows = []
    for y in range(HEIGHT // 2):
        up = math.sin(elevation(y))
        c, s = math.cos(elevation(y)) * math.sin(sun), up * math.cos(sun)
        heights = [(1 + a * math.exp(b / max(up, 0.02))) * z / n for (a, b, *_), z, n in zip(tables, zenith, at_zenith)]
        colors = []
        for turn in sides:
            cosine = min(max(c * turn + s, -1.0), 1.0)
            angle, square = math.acos(cosine), cosine * cosine
            colors.append(_rgb(*[h * (1 + t[2] * math.exp(t[3] * angle) + t[4] * square)
                                 for h, t in zip(heights, tables)]))
        rows.append(tuple([colors[place][i] for place in places] for i in range(3)))
    light = sum(sum(row[1]) / WIDTH * math.sin(elevation(y)) * math.cos(elevation(y)) for y, row in enumerate(rows)) * (
        2 * math.pi * math.pi / HEIGHT)
    horizon = [sum(rows[-1][i]) / WIDTH for i in range(3)]
    for y in range(HEIGHT // 2, HEIGHT):
        far = math.exp(-12 * -math.sin(elevation(y)))
        rows.append(tuple([ground[i] * light / math.pi * 1.4 * (1 - far) + horizon[i] * 0.5 * far] * WIDTH
                          for i in range(3)))
    return rows, _sun_disc(sun_azimuth, sun_elevation), sun_color


def _sun_disc(turn, lift):
    middle_x = (turn / 2 / math.pi + 0.5) * WIDTH
    middle_y = (0.5 - lift / math.pi) * HEIGHT
    shares = {}
    front = (math.sin(turn) * math.cos(lift), math.sin(lift), -math.cos(turn) * math.cos(lift))
    reach = SUN_RADIUS / math.pi * HEIGHT + 1
    wide = reach / math.cos(lift)
    for y in range(int(middle_y - reach), int(middle_y + reach) + 1):
        for x in range(int(middle_x - wide), int(middle_x + wide) + 1):
            inside = 0
            for k in range(64):
                a, e = azimuth(x + (k % 8 - 3.5) / 8), elevation(y + (k // 8 - 3.5) / 8)
                d = (math.sin(a) * math.cos(e), math.sin(e), -math.cos(a) * math.cos(e))
                inside += math.hypot(*(p - q for p, q in zip(d, front))) < SUN_RADIUS
            if inside:
                shares[x % WIDTH, y] = inside / 64
    return shares


def _with_sun(rows, shares, color):
    """Adds a sun whose peak is SUN_PEAK times the mean of all, the sun included."""
    texels = sum(share * math.cos(elevation(y)) for (x, y), share in shares.items())
    solid_angle = texels * 2 * math.pi * math.pi / WIDTH / HEIGHT
    peak = SUN_PEAK * mean(rows) / (1 - SUN_PEAK * solid_angle / 4 / math.pi)
    tint = peak / (0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2])
    for (x, y), share in shares.items():
        for i in range(3):
            rows[y][i][x] += color[i] * tint * share
    return rows


def clear():
    return _with_sun(*_sky(2.6, math.radians(-142), math.radians(38), (0.34, 0.31, 0.27), (1.0, 0.93, 0.82)))


def dusk():
    return _with_sun(*_sky(4.5, math.radians(-128), math.radians(5), (0.20, 0.18, 0.17), (1.0, 0.48, 0.16)))
