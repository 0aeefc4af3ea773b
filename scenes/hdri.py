"""The four HDRIs of the product shot."""

import os

import skies
import studios
from radiance import mean, write_hdr

# Image name: file name, what makes it, and its mean luminance over the sphere.
SURROUNDINGS = {"Studio": ("studio", studios.studio, 0.18), "StudioHighKey": ("studio-high-key", studios.high_key, 1.1),
                "Sky": ("sky", skies.clear, 0.55), "Dusk": ("dusk", skies.dusk, 0.40)}


def write(folder):
    """Writes FOLDER/*.hdr; returns {image name: file name}."""
    for file, make, brightness in SURROUNDINGS.values():
        rows = make()
        write_hdr(os.path.join(folder, file + ".hdr"), rows, brightness / mean(rows))
    return {name: file for name, (file, *_) in SURROUNDINGS.items()}
