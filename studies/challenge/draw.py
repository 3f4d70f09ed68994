"""Draw the sets of the challenge, seal them and pack them: for whoever publishes it.

`python -m dentscope.studies.challenge.draw WORK` goes on where it stopped; WORK lies outside the
repository, since it holds the truths of the sealed sets. Each set has a secret seed of 128 bits,
which its truth keeps: it salts the seal, and whoever has the truths can draw the set again.
"""

from __future__ import annotations

import argparse
import json
import secrets
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...core.output import write_file
from ..proof.generators.effects import EFFECTS, OUTSIDE
from ..proof.generators.folder import write_set
from ..proof.generators.truth import Truth, draw
from ..proof.seal import digest_of
from .archive import DATA, PARTS, SEALS, SUMS, TRUTHS, seal_truths

SIXTY = [("null", "")] * 12 + [("pair", "")] * 4
SIXTY += [("single", name) for name in EFFECTS for _ in range(2)]
SIXTY += [("outside", name) for name in OUTSIDE]
"""Kind and effect of sixty sets, a tenth with what no list has; each part has some sixties."""

_SIXTIES = {"open": 1, "sealed": 6}
_EDITION = 2
"""Thousands of the sets' numbers: no two editions have a name in common."""
_DATE = (2026, 11, 29, 0, 0, 0)


def entries() -> dict[str, dict[str, str]]:
    """Name of every set to its kind, effect and a new secret seed.

    The order of each sixty says nothing.
    """
    found = {}
    for part in PARTS:
        for sixty in range(_SIXTIES[part]):
            order = np.random.default_rng(secrets.randbits(128)).permutation(len(SIXTY))
            for place, k in enumerate(order, start=1):
                kind, effect = SIXTY[k]
                number = 1000 * _EDITION + sixty * len(SIXTY) + place
                found[f"{part}-{number}"] = {
                    "kind": kind, "effect": effect, "seed": secrets.token_hex(16)
                }  # fmt: skip
    return found


def drawn(kind: str, effect: str, seed: str) -> Truth:
    """Return a set of the proof's generators, its noise from a longer seed."""
    rng = np.random.default_rng(int(seed, 16))
    truth = draw(rng, kind, name=effect)
    return replace(truth, instrument=replace(truth.instrument, seed=int(rng.integers(2**62))))


def redrawn(record: dict[str, Any]) -> Truth:
    """Return the set that a truth belongs to, drawn again."""
    one = record["kind"] in ("single", "outside")
    return drawn(record["kind"], record["effects"][0]["name"] if one else "", record["seed"])


def make(work: Path) -> None:
    """Draw what is missing of the sets, their truths beside them."""
    plan = work / "entries.json"
    if not plan.exists():
        write_file(plan, json.dumps(entries(), indent=1))
    for name, entry in json.loads(plan.read_text(encoding="utf-8")).items():
        place = work / "truths" / f"{name}.json"
        if not place.exists():
            truth = drawn(entry["kind"], entry["effect"], entry["seed"])
            write_set(truth, work / "sets" / name, name=name)
            record = truth.record() | {"seed": entry["seed"]}
            write_file(place, json.dumps(record, indent=1) + "\n")


def publish(work: Path, to: Path = DATA) -> None:
    """Pack and seal what is drawn; sealed truths go to `work/sealed-truths.json`.

    Once these lie encrypted in `to`, asked again it writes the digest of that file too.
    """
    truths = {
        path.stem: json.loads(path.read_text(encoding="utf-8"))
        for path in sorted((work / "truths").glob("*.json"))
    }
    (to / SEALS).unlink(missing_ok=True)
    to.mkdir(parents=True, exist_ok=True)
    seal_truths(to / SEALS, truths, work / "sets")
    for part in PARTS:
        names = [name for name in truths if name.startswith(part)]
        files = {
            f"{part}/sets/{name}/{file}": work / "sets" / name / file
            for name in names
            for file in ("set.toml", "trials.csv")
        }
        if part == "open":
            files |= {
                f"{part}/truths/{name}.json": work / "truths" / f"{name}.json" for name in names
            }
        _pack(to / f"{part}.zip", files)
    published = [*(f"{part}.zip" for part in PARTS), SEALS]
    published += [TRUTHS] * (to / TRUTHS).exists()
    sums = [f"{digest_of(to / name)}  {name}" for name in published]
    write_file(to / SUMS, "\n".join(sums) + "\n")
    secret = {name: record for name, record in truths.items() if name.startswith("sealed")}
    write_file(work / "sealed-truths.json", json.dumps(secret, indent=1) + "\n")


def _pack(path: Path, files: dict[str, Path]) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, file in files.items():
            archive.writestr(
                zipfile.ZipInfo(name, _DATE), file.read_bytes(), zipfile.ZIP_DEFLATED, 9
            )


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("work", type=Path)
    parser.add_argument("--publish", action="store_true", help="draw nothing more")
    given = parser.parse_args()
    if not given.publish:
        make(given.work)
    publish(given.work)


if __name__ == "__main__":
    main()
