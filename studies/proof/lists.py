"""Which sets a run has: how many of each truth, and the seed of each."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np

from . import names
from .explicit.sets import available
from .generators.effects import EFFECTS

_SERIES_SETS = 12


@dataclass(frozen=True)
class Entry:
    """One set of a list: its number, kind, and the effect or series if it is fixed."""

    number: int
    kind: str
    effect: str = ""
    series: str = ""

    @property
    def name(self) -> str:
        """Name of the set; says nothing of what it conceals."""
        return f"set-{self.number:04d}"


def full() -> list[Entry]:
    """The published list: 150 nulls, 80 outside, 15 of each mechanism, 45 pairs, planted errors.

    Two sets or more of each complete series of the finite-element library are among them, at least
    twelve in all, and 30 sets whose mass is stated 5 % off, 20 whose strength is 14 % off.
    """
    wanted = [("null", "")] * 150 + [("outside", "")] * 80 + [("pair", "")] * 45
    wanted += [("single", name) for name in EFFECTS for _ in range(15)]
    wanted += [("mass-error", "")] * 30 + [("strength-error", "")] * 20
    series = available()
    each = max(2, -(-_SERIES_SETS // max(len(series), 1)))
    return _entries(wanted, [s.name for s in series for _ in range(each)])


def small() -> list[Entry]:
    """Twelve sets for every change of the source."""
    wanted = [("null", "")] * 4 + [("outside", "")] * 2 + [("pair", "")] + [("mass-error", "")]
    wanted += [
        ("single", "rod-longitudinal-waves"), ("single", "squeeze-film"),
        ("single", "velocity-dependent-friction"),
    ]  # fmt: skip
    return _entries(wanted, [s.name for s in available()][:1])


LISTS = dict(zip(names.LISTS, (full, small), strict=True))


def _entries(wanted: list[tuple[str, str]], series: list[str]) -> list[Entry]:
    plain = [("series", "", name) for name in series]
    rows = [(kind, effect, "") for kind, effect in wanted] + plain
    return [Entry(k, *row) for k, row in enumerate(rows)]


def seed_of(tree: str, entry: Entry) -> np.random.Generator:
    """Source of random numbers of one set: from the tool's tree and the set's number alone."""
    text = hashlib.sha256(
        f"{tree}/{entry.kind}/{entry.effect}/{entry.series}/{entry.number}".encode()
    )
    return np.random.default_rng(int.from_bytes(text.digest()[:16], "little"))


def shuffled(entries: list[Entry], tree: str) -> list[Entry]:
    """The order of a run, so that a part of it is a fair sample of the whole."""
    rng = np.random.default_rng(int(tree[:16], 16))
    return [entries[i] for i in rng.permutation(len(entries))]
