#!/usr/bin/env python3
"""Reads the layers of a frame (--aovs) with OpenImageIO's Python, as Gaffer and others that use OpenImageIO see them.

usage: read_layers.py FRAME.exr [--gain NAME=FACTOR]... [-o MIXED.exr]

Lists the layers, and adds up those of the lights as the header says: of a frame of the path integrator that is the frame
with --float, bit for bit. --gain mixes the lights anew without rendering. Needs python3-openimageio.
"""

import argparse
import sys

try:
    import numpy
    import OpenImageIO as oiio
except ImportError as error:
    sys.exit(f"read_layers.py: {error}; Debian's package is python3-openimageio")


def layers_of(spec):
    """Layer names in the order of the file, and the places of their channels: what stands before the last "."."""
    layers = {}
    for place, name in enumerate(spec.channelnames):
        layer, _, channel = name.rpartition(".")
        layers.setdefault(layer, {})[channel] = place
    return layers


def color(pixels, channels):
    return pixels[:, :, [channels[name] for name in "RGB"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("frame")
    parser.add_argument("--gain", action="append", default=[], metavar="NAME=FACTOR")
    parser.add_argument("-o", "--output")
    arguments = parser.parse_args()
    image = oiio.ImageInput.open(arguments.frame)
    if not image:
        sys.exit(f"{arguments.frame}: {oiio.geterror()}")
    spec = image.spec()
    pixels = numpy.asarray(image.read_image(oiio.FLOAT), numpy.float32).reshape(spec.height, spec.width, spec.nchannels)
    layers = layers_of(spec)
    lights = str(spec.getattribute("relook:lights") or "").split()
    for layer, channels in layers.items():
        print(f"{layer or 'RGBA'}: {' '.join(channels)}{'  (a light)' if layer in lights else ''}")
    if not lights:
        sys.exit(f"{arguments.frame}: no layers of lights: it was rendered without --aovs")
    gains = dict(gain.rsplit("=", 1) for gain in arguments.gain)
    unknown = [name for name in gains if name not in lights]
    if unknown:
        sys.exit(f"no light {unknown[0]}; there are {', '.join(lights)}")
    total = numpy.zeros_like(color(pixels, layers[""]))
    for light in lights:  # in this order, as float32
        layer = color(pixels, layers[light])
        total += layer * numpy.float32(gains[light]) if light in gains else layer
    if not gains:
        half = spec.channelformat(layers[""]["R"]) == oiio.HALF if spec.channelformats else spec.format == oiio.HALF
        rounded = total.astype(numpy.float16).astype(numpy.float32) if half else total
        different = int((rounded != color(pixels, layers[""])).any(axis=2).sum())
        print(f"{len(lights)} lights, added up: {different} pixels differ from the frame")
    if arguments.output:
        out = oiio.ImageBuf(oiio.ImageSpec(spec.width, spec.height, 4, oiio.FLOAT))
        alpha = pixels[:, :, layers[""]["A"]]
        out.set_pixels(oiio.ROI(), numpy.ascontiguousarray(numpy.dstack([total, alpha])))
        if not out.write(arguments.output):
            sys.exit(f"{arguments.output}: {out.geterror()}")


if __name__ == "__main__":
    main()
