"""The images of the product shot: dial, bezel scale and label (printed with lettering.py), leather and weave."""

import math
import os

import images
from lettering import Mask

DIAL = 1024


def _mixed(background, layers):
    """Rows of RGB bytes: background(x, y) under (mask, colour) layers."""
    width, height = layers[0][0].width, layers[0][0].height
    data = bytearray()
    for y in range(height):
        row = background(y, width)
        for mask, color in layers:
            covers = mask.bytes[y * width:(y + 1) * width]
            if not any(covers):
                continue
            for x, cover in enumerate(covers):
                if cover:
                    for i in range(3):
                        k = 3 * x + i
                        row[k] += (color[i] - row[k]) * cover // 255
        data += row
    return data


def _plain(color):
    return lambda y, width: bytearray(bytes(color) * width)


def _dial_masks():
    print_, accent = Mask(DIAL, DIAL), Mask(DIAL, DIAL)
    middle, unit = DIAL / 2, DIAL / 2 / 15.4  # the dial's radius is 15.4 mm
    for k in range(300):
        angle = 2 * math.pi * k / 300
        s, c = math.sin(angle), -math.cos(angle)
        length, half = ((1.15, 0.085) if k % 5 == 0 else (0.55, 0.035))
        outer = 15.0
        print_.line(middle + s * outer * unit, middle + c * outer * unit, middle + s * (outer - length) * unit,
                    middle + c * (outer - length) * unit, half * unit)
    print_.text("RELOOK", middle, middle - 6.9 * unit, 1.5 * unit, 0.13 * unit, 2.2)
    print_.text("AUTOMATIC", middle, middle - 5.0 * unit, 0.62 * unit, 0.055 * unit, 2.4)
    print_.text("LOOK DEVELOPMENT", middle, middle + 5.6 * unit, 0.62 * unit, 0.055 * unit, 2.2)
    accent.text("100 M", middle, middle + 7.1 * unit, 0.72 * unit, 0.07 * unit, 2.2)
    return print_, accent


def _smoked(y, width):
    """Blue that darkens towards the rim, in sRGB bytes."""
    half = width / 2
    row = bytearray(3 * width)
    for x in range(width // 2):
        r = min(math.hypot(x + 0.5 - half, y + 0.5 - half) / half, 1.0)
        fade = 1 - r * r * r * 0.72
        color = bytes((int(28 * fade), int(84 * fade), int(150 * fade + 6)))
        row[3 * x:3 * x + 3] = color
        mirrored = width - 1 - x
        row[3 * mirrored:3 * mirrored + 3] = color
    return row


def _scale():
    """The bezel's sixty minutes, unrolled clockwise: 12 o'clock in the middle, outside on top."""
    width = 2048
    mask = Mask(width, 112)
    for k in range(61):
        x, minute = k * width / 60, (k + 30) % 60
        if minute % 10 == 0 and minute:
            mask.text(str(minute), x, 58, 58, 4.4, 1.7)
        elif minute % 5 == 0 and minute:
            mask.line(x, 26, x, 88, 5)
        elif minute % 10 not in (1, 9):
            mask.line(x, 22, x, 42, 2.6)
    for inset in (0, 5, 10, 15, 20, 25):
        left, right, top, tip = width / 2 - 32 + inset, width / 2 + 32 - inset, 28 + inset * 0.5, 88 - inset * 1.4
        mask.path([(left, top), (right, top), (width / 2, tip), (left, top)], 5)
    return mask


def _label():
    ink, gold = Mask(768, 512), Mask(768, 512)
    gold.frame(22, 3.0)
    gold.frame(34, 1.2)
    gold.text("RELOOK", 384, 190, 88, 8.5, 2.6)
    gold.line(250, 278, 518, 278, 1.8)
    ink.text("EAU DE LUMIERE", 384, 328, 34, 2.5, 3.0)
    ink.text("NO. 26", 384, 92, 28, 2.2, 3.2)
    ink.text("15 ML - 0.5 FL. OZ.", 384, 424, 22, 1.7, 2.6)
    return ink, gold


def _normals(height, size, strength):
    """pixel(u, v) of a tangent-space map of a height that repeats, a table of size x size."""
    def pixel(u, v):
        x, y = int(u * size), int(v * size)
        row = height[y]
        dx = (row[(x + 1) % size] - row[x - 1]) * strength
        dy = (height[(y + 1) % size][x] - height[y - 1][x]) * strength
        length = math.sqrt(dx * dx + dy * dy + 1)
        return (0.5 - 0.5 * dx / length, 0.5 + 0.5 * dy / length, 0.5 + 0.5 / length)
    return pixel


def _leather(size=256, cells=22):
    """Grains between creases: distances to the two nearest of jittered points."""
    points = {}
    for j in range(cells):
        for i in range(cells):
            points[i, j] = (images.noise(i * 7 + 3, j * 13 + 1, 997), images.noise(i * 11 + 5, j * 5 + 9, 991))
    table = []
    for y in range(size):
        row = []
        for x in range(size):
            px, py = x * cells / size, y * cells / size
            i, j = int(px), int(py)
            near = []
            for n in (j - 1, j, j + 1):
                for m in (i - 1, i, i + 1):
                    ox, oy = points[m % cells, n % cells]
                    near.append(math.hypot(m + ox - px, n + oy - py))
            near.sort()
            crease = min((near[1] - near[0]) * 2.6, 1.0)
            row.append(crease * (2 - crease) - 0.15 * near[0] + 0.12 * images.noise(px * 4, py * 4, cells * 4))
        table.append(row)
    return table


def _weave(size=128, threads=16):
    """Plain weave: threads over and under in turn."""
    table = []
    for y in range(size):
        row = []
        for x in range(size):
            a, b = x * threads / size, y * threads / size
            i, j = int(a), int(b)
            warp = math.sin(math.pi * (a - i))
            weft = math.sin(math.pi * (b - j))
            over = (i + j) % 2 == 0
            row.append(warp * (0.55 + 0.45 * weft) if over else weft * (0.55 + 0.45 * warp))
        table.append(row)
    return table


def write(folder):
    """Writes the PNG files of the product shot to FOLDER; returns {texture name: file name}."""
    def path(name):
        return os.path.join(folder, name)
    ink, accent = _dial_masks()
    images.write_rows(path("dial.png"), DIAL, DIAL,
                      _mixed(_smoked, [(ink, (236, 238, 240)), (accent, (232, 120, 62))]))
    metal, print_ = (255, 84, 255), (255, 130, 0)  # occlusion, roughness, metallic
    images.write_rows(path("dial-surface.png"), DIAL, DIAL, _mixed(_plain(metal), [(ink, print_), (accent, print_)]))
    scale = _scale()
    images.write_rows(path("scale.png"), scale.width, scale.height,
                      _mixed(_plain((9, 12, 18)), [(scale, (225, 224, 214))]))
    ink, gold = _label()
    images.write_rows(path("label.png"), ink.width, ink.height,
                      _mixed(_plain((238, 231, 214)), [(gold, (226, 170, 82)), (ink, (38, 34, 32))]))
    images.write_rows(path("label-surface.png"), ink.width, ink.height,
                      _mixed(_plain((255, 168, 0)), [(gold, (255, 70, 255)), (ink, (255, 120, 0))]))
    images.write_png(path("leather.png"), 256, _normals(_leather(), 256, 1.1))
    images.write_png(path("weave.png"), 128, _normals(_weave(), 128, 1.6))
    return {"Dial": "dial", "DialSurface": "dial-surface", "Scale": "scale", "LabelPrint": "label",
            "LabelSurface": "label-surface", "Leather": "leather", "Weave": "weave"}
