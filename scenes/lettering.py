"""Drawing on masks of 8 bits: lines, rings and letters of our own, all of strokes with round ends."""

import math

# Strokes on a grid 6 high: lists of points, or arcs (centre x, y, radius x, y, from, to) in degrees. The number is the
# letter's width.
_LETTERS = {
    "A": (4.4, [(0, 0), (2.2, 6), (4.4, 0)], [(0.75, 2), (3.65, 2)]),
    "B": (4, [(2.3, 0), (0, 0), (0, 6), (2.3, 6)], (2.3, 4.6, 1.4, 1.4, 90, -90), [(0, 3.2), (2.3, 3.2)],
          (2.3, 1.6, 1.65, 1.6, 90, -90)),
    "C": (4.2, (2.5, 3, 2.5, 3, 48, 312)),
    "D": (4.3, [(1.6, 0), (0, 0), (0, 6), (1.6, 6)], (1.6, 3, 2.7, 3, 90, -90)),
    "E": (3.4, [(3.4, 6), (0, 6), (0, 0), (3.4, 0)], [(0, 3.1), (2.9, 3.1)]),
    "F": (3.3, [(3.3, 6), (0, 6), (0, 0)], [(0, 3), (2.8, 3)]),
    "G": (4.9, (2.5, 3, 2.5, 3, 48, 360), [(5.0, 3), (3.0, 3)]),
    "H": (4, [(0, 0), (0, 6)], [(4, 0), (4, 6)], [(0, 3.1), (4, 3.1)]),
    "I": (0, [(0, 0), (0, 6)]),
    "J": (2.8, [(2.8, 6), (2.8, 1.4)], (1.4, 1.4, 1.4, 1.4, 0, -180)),
    "K": (3.9, [(0, 0), (0, 6)], [(3.7, 6), (0, 2.3)], [(1.4, 3.7), (3.9, 0)]),
    "L": (3.2, [(0, 6), (0, 0), (3.2, 0)]),
    "M": (4.8, [(0, 0), (0, 6), (2.4, 1.8), (4.8, 6), (4.8, 0)]),
    "N": (4.1, [(0, 0), (0, 6), (4.1, 0), (4.1, 6)]),
    "O": (5.2, (2.6, 3, 2.6, 3, 0, 360)),
    "P": (3.8, [(0, 0), (0, 6), (2.1, 6)], (2.1, 4.3, 1.7, 1.7, 90, -90), [(0, 2.6), (2.1, 2.6)]),
    "Q": (5.2, (2.6, 3, 2.6, 3, 0, 360), [(3.2, 1.6), (5.0, -0.3)]),
    "R": (3.9, [(0, 0), (0, 6), (2.1, 6)], (2.1, 4.35, 1.65, 1.65, 90, -90), [(0, 2.7), (2.1, 2.7), (3.9, 0)]),
    "S": (3.7, (1.85, 4.5, 1.7, 1.5, 35, 270), (1.85, 1.5, 1.85, 1.5, 90, -148)),
    "T": (4, [(0, 6), (4, 6)], [(2, 6), (2, 0)]),
    "U": (4, [(0, 6), (0, 2)], (2, 2, 2, 2, 180, 360), [(4, 2), (4, 6)]),
    "V": (4.2, [(0, 6), (2.1, 0), (4.2, 6)]),
    "W": (6.2, [(0, 6), (1.6, 0), (3.1, 5), (4.6, 0), (6.2, 6)]),
    "X": (4, [(0, 0), (4, 6)], [(0, 6), (4, 0)]),
    "Y": (4.2, [(0, 6), (2.1, 2.8), (4.2, 6)], [(2.1, 2.8), (2.1, 0)]),
    "Z": (3.8, [(0, 6), (3.8, 6), (0, 0), (3.8, 0)]),
    "0": (3.8, (1.9, 3, 1.9, 3, 0, 360)),
    "1": (1.6, [(0, 4.7), (1.6, 6), (1.6, 0)]),
    "2": (3.6, (1.8, 4.3, 1.75, 1.7, 165, -38), [(3.18, 3.25), (0, 0), (3.6, 0)]),
    "3": (3.6, (1.7, 4.5, 1.55, 1.5, 150, -90), (1.7, 1.55, 1.85, 1.5, 90, -150)),
    "4": (4, [(3, 0), (3, 6), (0, 1.7), (4, 1.7)]),
    "5": (3.6, [(3.3, 6), (0.6, 6), (0.3, 3.3)], (1.7, 1.95, 1.9, 1.95, 130, -145)),
    "6": (3.8, (1.9, 1.9, 1.9, 1.9, 0, 360), [(0.3, 2.9), (2.5, 6)]),
    "7": (3.6, [(0, 6), (3.6, 6), (1.1, 0)]),
    "8": (3.7, (1.85, 4.5, 1.5, 1.5, 0, 360), (1.85, 1.5, 1.85, 1.5, 0, 360)),
    "9": (3.8, (1.9, 4.1, 1.9, 1.9, 0, 360), [(3.5, 3.1), (1.3, 0)]),
    ".": (0, [(0, 0), (0, 0)]),
    "-": (2, [(0, 2.8), (2, 2.8)]),
    " ": (2,),
}


def _points(stroke):
    if isinstance(stroke, list):
        return stroke
    x, y, rx, ry, start, end = stroke
    count = max(3, round(abs(end - start) / 12))
    angles = [math.radians(start + (end - start) * k / count) for k in range(count + 1)]
    return [(x + rx * math.cos(a), y + ry * math.sin(a)) for a in angles]


class Mask:
    """Coverage in bytes, row 0 on top; what is drawn covers what it overlaps no further."""

    def __init__(self, width, height):
        self.width, self.height, self.bytes = width, height, bytearray(width * height)

    def line(self, x0, y0, x1, y1, half):
        """A stroke between two points in pixels, `half` wide on each side."""
        dx, dy = x1 - x0, y1 - y0
        square = dx * dx + dy * dy or 1.0
        reach = half + 1
        left, right = max(int(min(x0, x1) - reach), 0), min(int(max(x0, x1) + reach) + 1, self.width)
        for y in range(max(int(min(y0, y1) - reach), 0), min(int(max(y0, y1) + reach) + 1, self.height)):
            py = y + 0.5 - y0
            for x in range(left, right):
                px = x + 0.5 - x0
                t = min(max((px * dx + py * dy) / square, 0.0), 1.0)
                cover = half + 0.5 - math.hypot(px - t * dx, py - t * dy)
                if cover > 0:
                    value = 255 if cover >= 1 else int(cover * 255)
                    if value > self.bytes[y * self.width + x]:
                        self.bytes[y * self.width + x] = value

    def path(self, points, half):
        for (x0, y0), (x1, y1) in zip(points, points[1:]):
            self.line(x0, y0, x1, y1, half)

    def ring(self, x, y, radius, half):
        count = max(24, int(radius))
        turns = [2 * math.pi * k / count for k in range(count + 1)]
        self.path([(x + radius * math.cos(a), y + radius * math.sin(a)) for a in turns], half)

    def frame(self, inset, half):
        """A rectangle along the mask's edge."""
        x, y = self.width - inset, self.height - inset
        self.path([(inset, inset), (x, inset), (x, y), (inset, y), (inset, inset)], half)

    def text(self, words, x, y, height, half, spacing=1.8, turn=0.0):
        """Letters centred at (x, y), `height` pixels tall, turned by `turn` radians clockwise; `spacing` in sixths."""
        scale = height / 6
        total = sum(_LETTERS[letter][0] + spacing for letter in words) - spacing
        at = -total / 2
        c, s = math.cos(turn), math.sin(turn)
        for letter in words:
            width, *strokes = _LETTERS[letter]
            for stroke in strokes:
                flat = [((at + px) * scale, (3 - py) * scale) for px, py in _points(stroke)]
                self.path([(x + c * px - s * py, y + s * px + c * py) for px, py in flat], half)
            at += width + spacing
