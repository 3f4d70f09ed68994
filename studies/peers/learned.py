"""A learner without contact laws: extra trees on what a set shows by hand formulas.

    python -m dentscope.studies.peers.learned MADE... --on JUDGED [--sheets]

trains on folders of sets with truths and judges it on another; `--sheets` gives it everything but
the readings, so that what it knows then is what the sheets give away. The hand formulas are those
of a fully plastic blow at the mean pressure 2.8 Sy (Johnson, Contact Mechanics, 1985, 11.5).
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from sklearn.ensemble import ExtraTreesClassifier
from sklearn.feature_extraction import DictVectorizer

from ...core.arrays import Array
from ...core.inputs.toml_input import read_toml
from ...core.observables import OBSERVABLES
from ...recordings import RecordingSet, read
from ..proof.rivals import BASELINE, LEAST
from .compare import asked_of

_UNSEEN = {"format", "name", "description", "source", "licence"}
_TREES, _LEAF = 600, 2

Features = dict[str, float | str]


class Judged(NamedTuple):
    """How a learner, and the commonest answers of each rig, did on sets that neither was shown.

    `front` is the share of truths in front, `ln_p` the mean ln p of the truth; `chance` and
    `chance_ln_p` the same of how often each truth was on a rig of that kind.
    """

    sets: int
    front: float
    ln_p: float
    chance: float
    chance_ln_p: float


def features(recordings: RecordingSet, *, sheets: bool = False) -> Features:
    """Return what a learner is shown of a set; with `sheets` nothing that was read off."""
    found = dict(_sheet(recordings)) | dict(_inputs(recordings))
    return found if sheets else found | dict(_readings(recordings))


def kind_of(recordings: RecordingSet) -> str:
    """Return what a rig is for whoever draws sets: its bodies, how they meet, what is measured."""
    t, setup = recordings.trials, recordings.setup
    shapes = sorted({s.shape for s in setup.strikers.values()})
    aslant = bool(np.min(t.angle_deg) < 89.0)
    return " ".join([
        *shapes, setup.target.law, "aslant" * aslant, "pressed" * bool(t.pressed.any()),
        "falls" * bool(np.isfinite(t.drop_height_m).any()), *recordings.observed,
        f"{len(setup.strikers)}",
    ])  # fmt: skip


def _sheet(recordings: RecordingSet) -> Iterator[tuple[str, float | str]]:
    """Every entry of set.toml; of several strikers mean and spread."""
    assert recordings.folder is not None
    content = read_toml(recordings.folder / "set.toml")
    strikers: dict[str, list[float]] = {}
    for body in content.pop("strikers", {}).values():
        for key, value in _leaves(body, ""):
            if isinstance(value, float):
                strikers.setdefault(key, []).append(value)
    for key, values in strikers.items():
        yield f"striker{key}", float(np.mean(values))
        yield f"spread{key}", float(np.ptp(values))
    for key, value in content.items():
        if key not in _UNSEEN:
            yield from _leaves(value, key)


def _leaves(value: Any, key: str) -> Iterator[tuple[str, float | str]]:
    if isinstance(value, dict):
        for name, part in value.items():
            yield from _leaves(part, f"{key}.{name}")
    elif isinstance(value, str):
        yield key, value
    else:
        yield key, float(value)
        yield f"{key}?", 1.0  # that it is told at all


def _inputs(recordings: RecordingSet) -> Iterator[tuple[str, float | str]]:
    """What was set in the trials: how many, how fast, at which angles and temperatures."""
    t, speed = recordings.trials, recordings.approach.normal
    yield "kind", kind_of(recordings)
    yield "trials", float(len(t.angle_deg))
    yield "conditions", float(len(set(recordings.conditions.tolist())))
    for name, column in {"speed": speed, "angle": t.angle_deg, "temperature": t.temperature_K,
                         "load": t.load_N}.items():  # fmt: skip
        known = column[np.isfinite(column)]
        if known.size:
            yield f"{name} low", float(known.min())
            yield f"{name} high", float(known.max())


def _readings(recordings: RecordingSet) -> Iterator[tuple[str, float | str]]:
    """Each observable over its hand formula: level, slopes, what they leave, in noise too."""
    struck = recordings.impacts
    speed, body = struck.approach.normal, struck.strikers()
    tip = np.array([s.tip_radius_m.value for s in body])
    mass = np.array([s.mass_kg.value for s in body])
    order = np.asarray(struck.trials.order, dtype=float)
    varied = {
        "speed": np.log(speed), "tip": np.log(tip), "mass": np.log(mass),
        "angle": np.radians(struck.trials.angle_deg), "heat": struck.trials.temperature_K / 1e3,
        "order": order / max(np.nanmax(order), 1.0), "curvature": np.log(speed) ** 2,
    }  # fmt: skip
    for name in struck.observed:
        value, std = struck.values(name), struck.std(name)
        by_hand = _by_hand(name, struck, speed, tip, mass)
        log = OBSERVABLES[name].log or name == "restitution"
        with np.errstate(all="ignore"):
            y = np.log(value / by_hand) if log else value / by_hand
            noise = std / np.abs(value if log else by_hand)
        there = np.isfinite(y) & np.isfinite(noise) & (noise > 0.0)
        if there.sum() < 4:
            continue
        yield f"{name} level", float(np.average(y[there], weights=noise[there] ** -2.0))
        yield from _regressed(name, y[there], noise[there],
                              {k: x[there] for k, x in varied.items()})  # fmt: skip


def _by_hand(name: str, s: RecordingSet, speed: Array, tip: Array, mass: Array) -> Array:
    """The usual formula of an observable at a constant mean pressure; 1 where there is none."""
    flat = s.setup.target
    E = flat.E_Pa.value if flat.E_Pa else 2e11
    Sy = flat.Sy_Pa.value if flat.Sy_Pa else 0.0
    modulus = E / (1.0 - (flat.nu.value if flat.nu else 0.3) ** 2)
    if not 0.0 < Sy < math.inf:
        hertz = (mass / (modulus * np.sqrt(tip))) ** 0.4 * speed**-0.2
        return {"contact_time_s": 3.2 * hertz}.get(name, np.ones_like(speed))
    pressure = 2.8 * Sy
    spring = 2.0 * math.pi * tip * pressure
    depth = speed * np.sqrt(mass / spring)
    found: dict[str, Array] = {
        "restitution": 1.7 * (Sy / modulus) ** 0.5 * (mass * speed**2 / (Sy * tip**3)) ** -0.125,
        "permanent_depth_m": depth, "dent_diameter_m": 2.0 * np.sqrt(2.0 * tip * depth),
        "contact_time_s": 0.5 * math.pi * np.sqrt(mass / spring),
        "peak_force_N": speed * np.sqrt(mass * spring),
    }  # fmt: skip
    return found.get(name, np.ones_like(speed))


def _regressed(
    name: str, y: Array, noise: Array, varied: dict[str, Array]
) -> Iterator[tuple[str, float]]:
    """Slopes over all that varies, how sure each is, and the rms that they leave."""
    columns = {k: x - x.mean() for k, x in varied.items() if np.ptp(x) > 1e-9}
    A = np.stack([np.ones_like(y), *columns.values()], axis=1) / noise[:, None]
    # a ridge so weak that it acts only where two columns are one
    inverse = np.linalg.inv(A.T @ A + 1e-6 * np.trace(A.T @ A) * np.eye(A.shape[1]))
    slopes = inverse @ A.T @ (y / noise)
    for k, b, v in zip(columns, slopes[1:], np.diag(inverse)[1:], strict=True):
        yield f"{name} over {k}", float(b)
        yield f"{name} over {k}, z", float(b / math.sqrt(v))
    left = y / noise - A @ slopes
    yield f"{name} left", float(np.sqrt(np.mean(left**2)))


def sets_of(folders: Sequence[Path], *, sheets: bool) -> tuple[list[Features], list[str]]:
    """Return the features and the true label of every set of some folders."""
    asked = [a for folder in folders for a in asked_of(folder)]
    shown = [features(read(a.place), sheets=sheets) for a in asked]
    return shown, ["+".join(a.truth) or BASELINE for a in asked]


def judged(made: Sequence[Path], on: Sequence[Path], *, sheets: bool = False) -> Judged:
    """Train on some folders, judge on others.

    `made`, `on`: folders with sets/ and truths/; `sheets`: whether the readings are kept from it.
    """
    (seen, labels), (asked, truths) = (sets_of(f, sheets=sheets) for f in (made, on))
    turn = DictVectorizer(sparse=False)
    trees = ExtraTreesClassifier(_TREES, min_samples_leaf=_LEAF, random_state=0, n_jobs=1)
    trees.fit(turn.fit_transform(seen), labels)
    p = trees.predict_proba(turn.transform(asked))
    odds = [dict(zip(trees.classes_, row, strict=True)) for row in p]
    by_kind = [_shares(str(one["kind"]), seen, labels) for one in asked]
    return Judged(len(truths), *_scored(odds, truths), *_scored(by_kind, truths))


def _shares(kind: str, seen: Sequence[Features], labels: Sequence[str]) -> dict[str, float]:
    """How often each truth was behind rigs of a kind; behind all, where the kind is new."""
    same = [y for x, y in zip(seen, labels, strict=True) if x["kind"] == kind] or list(labels)
    return {name: same.count(name) / len(same) for name in set(same)}


def _scored(odds: Sequence[dict[str, float]], truths: Sequence[str]) -> tuple[float, float]:
    front = [max(o, key=lambda k: o[k]) == t for o, t in zip(odds, truths, strict=True)]
    ln_p = [math.log(max(o.get(t, 0.0), LEAST)) for o, t in zip(odds, truths, strict=True)]
    return float(np.mean(front)), float(np.mean(ln_p))


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("made", type=Path, nargs="+")
    parser.add_argument("--on", type=Path, nargs="+", required=True)
    parser.add_argument("--sheets", action="store_true", help="without the readings")
    given = parser.parse_args()
    found = judged(given.made, given.on, sheets=given.sheets)
    sys.stdout.write(json.dumps(found._asdict()) + "\n")


if __name__ == "__main__":
    main()
