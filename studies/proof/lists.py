"""Which sets a run has: how many of each truth, and the seed of each."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np

from . import names
from .generators.effects import EFFECTS


@dataclass(frozen=True)
class Entry:
    """One set of a list: its number, kind, and the effect if it is fixed."""

    number: int
    kind: str
    effect: str = ""

    @property
    def name(self) -> str:
        """Name of the set; says nothing of what it conceals."""
        return f"set-{self.number:04d}"


def full() -> list[Entry]:
    """The published list: 150 nulls, 80 outside, 15 of each mechanism, 45 pairs, planted errors.

    Of the planted errors 30 are a mass stated 5 % off, 20 a strength 14 % off.
    """
    wanted = [("null", "")] * 150 + [("outside", "")] * 80 + [("pair", "")] * 45
    wanted += [("single", name) for name in EFFECTS for _ in range(15)]
    wanted += [("mass-error", "")] * 30 + [("strength-error", "")] * 20
    return _entries(wanted)


def small() -> list[Entry]:
    """Twelve sets for every change of the source."""
    wanted = [("null", "")] * 4 + [("outside", "")] * 2 + [("pair", "")] + [("mass-error", "")]
    wanted += [
        ("single", "rod-longitudinal-waves"), ("single", "squeeze-film"),
        ("single", "velocity-dependent-friction"),
    ]  # fmt: skip
    return _entries(wanted)


LISTS = dict(zip(names.LISTS, (full, small), strict=True))


def _entries(wanted: list[tuple[str, str]]) -> list[Entry]:
    return [Entry(k, *row) for k, row in enumerate(wanted)]


def seed_of(tree: str, entry: Entry) -> np.random.Generator:
    """Source of random numbers of one set: from the tool's tree and the set's number alone."""
    text = hashlib.sha256(f"{tree}/{entry.kind}/{entry.effect}/{entry.number}".encode())
    return np.random.default_rng(int.from_bytes(text.digest()[:16], "little"))


def shuffled(entries: list[Entry], tree: str) -> list[Entry]:
    """The order of a run, so that a part of it is a fair sample of the whole."""
    rng = np.random.default_rng(int(tree[:16], 16))
    return [entries[i] for i in rng.permutation(len(entries))]
