"""One bit flipped, or a block of zeros, anywhere in the file of a case or a published part.

`python tests/faults/bit_flips.py` flips 2000 bits and blanks 400 blocks of each of: the file of a
case, a part of a data set, and the lists of digests beside the parts. It prints how many were
refused with one line, how many left everything as it was, and how many gave a wrong number or lost
a case without a word.
"""

import argparse
import random
import sys
import tempfile
from collections import Counter
from pathlib import Path

import disk_faults as faults
import numpy as np
from dentscope.campaigns import Design, Store, publish, read_curves
from dentscope.core import InputError

_BLOCK = 512
ROOT = Path(__file__).resolve().parents[2]


def damaged(image, draw, *, bits, blocks):
    """Yield copies of a file's bytes with one bit flipped, then with one block of zeros."""
    for _ in range(bits):
        changed = bytearray(image)
        at = draw.randrange(8 * len(image))
        changed[at // 8] ^= 1 << at % 8
        yield bytes(changed)
    for _ in range(blocks):
        at = draw.randrange(max(1, len(image) - _BLOCK))
        blank = image[:at] + bytes(min(_BLOCK, len(image) - at)) + image[at + _BLOCK :]
        if blank != image:
            yield blank


def same(found, expected):
    """Whether every case is there with every number."""
    one, other = ({r.id: r for r in records} for records in (found, expected))
    return one.keys() == other.keys() and all(_equal(one[k], other[k]) for k in one)


def _equal(a, b):
    def arrays(r):
        yield r.curve
        yield r.profiles
        for unloading in r.unloadings:
            yield unloading.curve
            yield unloading.profiles

    return (
        (a.case, a.status, a.message, a.counters, a.environment, a.accuracy, a.mesh)
        == (b.case, b.status, b.message, b.counters, b.environment, b.accuracy, b.mesh)
        and all(
            x.keys() == y.keys() and all(np.array_equal(x[k], y[k], equal_nan=True) for k in x)
            for x, y in zip(arrays(a), arrays(b), strict=True)
        )
        and [(u.depth, u.residual_sphere, u.residual_flat) for u in a.unloadings]
        == [(u.depth, u.residual_sphere, u.residual_flat) for u in b.unloadings]
    )


def inspect(read, path, expected, draw, *, bits, blocks):
    """Read each damaged copy; return counts of what happened.

    Parameters
    ----------
    read
        What reads the records.
    path
        The file that is damaged.
    expected
        What it gives undamaged; several states may be right.
    """
    image, counts = path.read_bytes(), Counter()
    for changed in damaged(image, draw, bits=bits, blocks=blocks):
        path.write_bytes(changed)
        try:
            found = read()
        except InputError as error:
            counts["refused with a line" if "\n" not in str(error) else "many lines"] += 1
            continue
        right = any(same(found, records) for records in expected)
        counts["all as it was" if right else "WRONG OR LOST"] += 1
    path.write_bytes(image)
    return counts


def targets(folder):
    """What is damaged: words, reader, file, what it may give."""
    run = folder / "run"
    for case in faults.CASES[:3]:
        Store(run).put(case, faults.solved(case))
    old = Store(run).read_all()
    yield "case of a run", Store(run).read_all, Store(run).files()[1], [old]

    data = folder / "data"
    publish(Design("trial", "", lambda: faults.CASES[:3]), run, data)
    part = data / "trial-1.h5"
    records = read_curves(part)
    yield "sealed part", lambda: read_curves(part), part, [records]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bits", type=int, default=2000)
    parser.add_argument("--blocks", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    draw = random.Random(chosen.seed)
    with tempfile.TemporaryDirectory() as folder:
        for words, read, path, expected in targets(Path(folder)):
            found = inspect(read, path, expected, draw, bits=chosen.bits, blocks=chosen.blocks)
            sys.stdout.write(f"{words} ({path.stat().st_size} bytes): {dict(found)}\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
