"""Fills a folder of the kept corpus: choose.py FOUND SEEDS KEPT puts the SEEDS there and files of FOUND, which libFuzzer's
set cover has left, instead of what KEPT holds: all, or, where they are too many, some of every size."""

import hashlib
import os
import sys

MOST_FILES, MOST_BYTES = 64, 64 * 1024


def contents(folder):
    for name in os.listdir(folder):
        with open(os.path.join(folder, name), "rb") as file:
            yield file.read()


def main(found, seeds, kept):
    files = sorted(contents(found), key=lambda data: (len(data), data))
    while len(files) > MOST_FILES or sum(map(len, files)) > MOST_BYTES:
        excess = max(len(files) / MOST_FILES, sum(map(len, files)) / MOST_BYTES)
        count = min(len(files) - 1, int(len(files) / excess))
        files = [files[i * len(files) // count] for i in range(count)]
    for name in os.listdir(kept):
        os.remove(os.path.join(kept, name))
    for data in files + list(contents(seeds)):
        with open(os.path.join(kept, hashlib.sha1(data).hexdigest()[:16]), "wb") as file:
            file.write(data)


if __name__ == "__main__":
    main(*sys.argv[1:])
