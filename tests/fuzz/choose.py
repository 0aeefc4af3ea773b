"""Fills a folder of the kept corpus: choose.py FOUND KEPT takes the files of FOUND, which libFuzzer's -merge=1 has left,
most telling first as it orders them by size, until they are 48 or 96 KB."""

import hashlib
import os
import sys

MOST_FILES, MOST_BYTES = 48, 96 * 1024


def main(found, kept):
    files = []
    for name in os.listdir(found):
        with open(os.path.join(found, name), "rb") as file:
            files.append(file.read())
    files.sort(key=lambda data: (len(data), data))
    if len(files) > MOST_FILES:  # of all sizes
        files = [files[i * len(files) // MOST_FILES] for i in range(MOST_FILES)]
    for name in os.listdir(kept):
        os.remove(os.path.join(kept, name))
    total = 0
    for data in files:
        total += len(data)
        if total > MOST_BYTES:
            break
        with open(os.path.join(kept, hashlib.sha1(data).hexdigest()[:16]), "wb") as file:
            file.write(data)


if __name__ == "__main__":
    main(*sys.argv[1:])
