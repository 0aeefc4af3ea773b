"""Fills a folder of the kept corpus: choose.py FOUND KEPT puts files of FOUND there, which libFuzzer's set cover has
left, instead of what KEPT holds: all, or, where they are too many, some of every size."""

import hashlib
import os
import sys

MOST_FILES, MOST_BYTES = 64, 96 * 1024


def main(found, kept):
    files = []
    for name in os.listdir(found):
        with open(os.path.join(found, name), "rb") as file:
            files.append(file.read())
    files.sort(key=lambda data: (len(data), data))
    while len(files) > MOST_FILES or sum(map(len, files)) > MOST_BYTES:
        excess = max(len(files) / MOST_FILES, sum(map(len, files)) / MOST_BYTES)
        count = min(len(files) - 1, int(len(files) / excess))
        files = [files[i * len(files) // count] for i in range(count)]
    for name in os.listdir(kept):
        os.remove(os.path.join(kept, name))
    for data in files:
        with open(os.path.join(kept, hashlib.sha1(data).hexdigest()[:16]), "wb") as file:
            file.write(data)


if __name__ == "__main__":
    main(*sys.argv[1:])
