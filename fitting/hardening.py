"""Regression of what the law for metals with a flow curve adds to Tabor's equivalence.

Linear and held back by a prior: first the depth, by the contact radius, then what else is asked of
the law at that depth. Whole pairs are left out in turn.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from ..campaigns.records import CaseRecord, scaled
from ..core.arrays import Array
from ..core.material import Pair
from ..models import critical_depth
from ..models.fitted import ClosedForm
from ..models.hardening import (
    CORRECTED,
    Equivalent,
    HardeningCorrection,
    HardeningLaw,
    coordinates_of,
    corrected,
    equivalent,
    features_of,
    hardening_size,
    least_force,
)
from ..models.table import energy_exponent
from ..models.uncertainty import Uncertainty
from .calibrate import SIGMAS, shares_within
from .prediction import size_of
from .rules import RULES
from .table import Sources, is_current, is_held_out


class _Case(NamedTuple):
    """One pair: its path, and what finite elements say; rows of loading, rows of unloading."""

    pair: Pair
    path: Equivalent
    depth: Array  # ln(Delta/R) of loading
    loading: Array  # ln F, ln a, share; shape (n, 3)
    turn: Array  # ln(Delta/R) of unloading
    unloading: Array  # permanent part, the sphere's part of it, N; shape (m, 3)


@dataclass(frozen=True)
class HardeningFit:
    """Result of the regression.

    `correction`: what the law adds; `left_out`: mean and largest error on pairs left out, by name
    as in `fitting.Errors`; `combinations`: how many pairs.
    """

    correction: HardeningCorrection
    left_out: dict[str, tuple[float, float]]
    combinations: int


def hardening_records(sources: Sources, *, held_out: bool = False) -> list[CaseRecord]:
    """Cases of metals with a flow curve that no rate and no heat changes, made by this solver.

    Those that are kept out of every fit where `held_out`, else the others.
    """
    found: dict[str, CaseRecord] = {}
    for record in itertools.chain.from_iterable(sources.values()):
        flows = [b.flow for b in (record.case.pair.sphere, record.case.pair.flat) if b.flow]
        plain = all(f.rate is None and f.heating is None for f in flows)
        if flows and plain and is_held_out(record) == held_out and is_current(record):
            found[record.id] = record
    return list(found.values())


def judged_designs(law: HardeningLaw, sources: Sources) -> dict[str, dict[str, Any]]:
    """Errors and shares within the stated deviations, by the design that no fit reads."""
    designs: dict[str, list[CaseRecord]] = {}
    for record in hardening_records(sources, held_out=True):
        designs.setdefault(record.case.name.rsplit("-", 1)[0], []).append(record)
    found = {}
    for name, records in sorted(designs.items()):
        errors, within = judge_hardening(law, records)
        found[name] = {"combinations": len(records), "errors": errors, "within": within}
    return found


def fit_hardening(fitted: ClosedForm, records: Sequence[CaseRecord]) -> HardeningFit:
    """Fit the correction of the law of perfectly plastic bodies, and judge it on pairs left out."""
    cases = [_case(fitted, record) for record in records]
    fold = np.random.default_rng(1).permutation(len(cases)) % min(RULES.folds, len(cases))
    found: list[dict[str, _Off]] = []
    for number in np.unique(fold):
        without = _regress([c for c, k in zip(cases, fold, strict=True) if k != number])
        out = [c for c, k in zip(cases, fold, strict=True) if k == number]
        found += [_off(fitted, case, without) for case in out]
    every = {name: _Off(*map(np.concatenate, zip(*(f[name] for f in found), strict=True)))
             for name in Uncertainty._fields}  # fmt: skip
    spread = {name: _spread(off) for name, off in every.items()}
    errors = {name: size_of(off.error) for name, off in every.items()}
    return HardeningFit(replace(_regress(cases), spread=spread), errors, len(cases))


def judge_hardening(
    law: HardeningLaw, records: Sequence[CaseRecord]
) -> tuple[dict[str, tuple[float, float]], dict[str, tuple[float, float]]]:
    """A law's errors on pairs held out, mean and largest; shares within one and two deviations."""
    assert law.correction is not None
    found = [_off(law.fitted, _case(law.fitted, r), law.correction) for r in records]
    errors, within = {}, {}
    for name in Uncertainty._fields:
        off = _Off(*map(np.concatenate, zip(*(f[name] for f in found), strict=True)))
        errors[name] = size_of(off.error)
        stated = np.hypot(off.own, law.correction.spread[name] * off.hardens)
        within[name] = shares_within(off.error, stated)
    return errors, within


class _Off(NamedTuple):
    """Errors of one quantity, the fitted law's own deviation there, how much the points harden."""

    error: Array
    own: Array
    hardens: Array


def _case(fitted: ClosedForm, record: CaseRecord) -> _Case:
    pair, c = record.case.pair, record.curve
    onset = critical_depth(pair)
    seen = (
        (c["delta"] >= onset)
        & (c["radius"] <= RULES.hardening_radius * pair.R)
        & (c["radius"] != c["radius_last_node"])
    )
    rows = np.flatnonzero(seen)[:: -RULES.hardening_every]
    D, F, a, share = scaled(record)
    loading = np.stack([np.log(F), np.log(a), share], axis=-1)
    turns = []
    for u in record.unloadings:
        total, depth = u.residual_sphere + u.residual_flat, u.depth * pair.R
        if (
            depth >= RULES.relative_from * onset
            and u.curve["radius"][0] <= RULES.hardening_radius * pair.R
        ):
            N = energy_exponent(u.curve["delta"], u.curve["force"], total)
            turns.append((np.log(u.depth), total / depth, u.residual_sphere / total, N))
    turned = np.array(turns).reshape(-1, 4)
    return _Case(
        pair, equivalent(fitted, pair, points=RULES.path_points), np.log(D[rows]),
        loading[rows], turned[:, 0], turned[:, 1:],
    )  # fmt: skip


def _regress(cases: Sequence[_Case]) -> HardeningCorrection:
    """Regress on these pairs; how far off it is remains to be said."""
    both = np.concatenate([side for case in cases for side in coordinates_of(case.path)])
    low, high = both.min(axis=0), both.max(axis=0)
    features = [features_of(case.path, low, high) for case in cases]
    shown, asked = [], []
    for case, X in zip(cases, features, strict=True):
        a = PchipInterpolator(np.log(case.path.D), np.log(case.path.at.a))
        there = PchipInterpolator(np.log(case.path.D), X)(case.depth)
        shown.append(there * a(case.depth, 1)[:, None])
        asked.append(a(case.depth) - case.loading[:, 1])
    weights = np.zeros((features[0].shape[1], len(CORRECTED)))
    weights[:, 0] = _solved(np.concatenate(shown), np.concatenate(asked))
    for quantity in range(1, len(CORRECTED)):
        found = [
            _missing(case, X, weights, quantity) for case, X in zip(cases, features, strict=True)
        ]
        shown, asked = ([f[k] for f in found] for k in (0, 1))
        weights[:, quantity] = _solved(np.concatenate(shown), np.concatenate(asked))
    return HardeningCorrection(low, high, weights, {})


def _missing(case: _Case, X: Array, weights: Array, quantity: int) -> tuple[Array, Array]:
    """Features and what is missing of a quantity at a case's rows, both times the rows' weight."""
    x, at = corrected(case.path, X @ weights)
    x = np.maximum.accumulate(x + 1e-9 * np.arange(len(x)))
    if quantity in (1, 2):
        rows, data = case.depth, case.loading[:, 0 if quantity == 1 else 2]
        law = np.log(at.F) if quantity == 1 else at.share
    else:
        rows, data = case.turn, case.unloading[:, (1, 0, 2)[quantity - 3]]
        law = (at.phi, at.left, np.log(at.N + 1.0))[quantity - 3]
    there, features = PchipInterpolator(x, law)(rows), PchipInterpolator(x, X)(rows)
    if quantity == 1:
        weight, off = np.ones_like(rows), data - there
    elif quantity in (2, 3):
        weight, off = data * (1.0 - data), _odds(data) - _odds(there)
    elif quantity == 4:
        weight, off = np.maximum((1.0 - data) / data, 1.0), np.log((1.0 - data) / (1.0 - there))
    else:
        weight, off = np.ones_like(rows), np.log(data + 1.0) - there
    known = np.isfinite(off) & np.isfinite(weight)
    return (features * weight[:, None])[known], (off * weight)[known]


def _odds(share: Array) -> Array:
    inside = np.clip(share, 1e-4, 1.0 - 1e-4)
    return np.asarray(np.log(inside / (1.0 - inside)))


def _solved(features: Array, off: Array) -> Array:
    matrix = features.T @ features / RULES.form_unit**2 + RULES.hardening_prior * np.eye(
        features.shape[1]
    )
    return np.asarray(np.linalg.solve(matrix, features.T @ off / RULES.form_unit**2))


def _off(fitted: ClosedForm, case: _Case, correction: HardeningCorrection) -> dict[str, _Off]:
    """Errors of a correction on one case, by the names of `Uncertainty`."""
    path = case.path
    X = features_of(path, correction.low, correction.high)
    x, at = corrected(path, X @ correction.weights)
    x = np.maximum.accumulate(x + 1e-9 * np.arange(len(x)))
    at = at._replace(F=np.maximum(at.F, least_force(path, x)))
    assert fitted.calibration is not None
    own = fitted.calibration.of(path.numbers, path.D / path.deeper)
    hardens = hardening_size(path)
    loaded = PchipInterpolator(x, np.stack([np.log(at.F), np.log(at.a), at.share], axis=-1))
    turned = PchipInterpolator(x, np.stack([at.left, at.N], axis=-1))
    F, a, share = (loaded(case.depth) - case.loading).T
    left, N = turned(case.turn).T
    was, N_was = case.unloading[:, 0], case.unloading[:, 2]
    back = (1.0 - left) / (1.0 - was) * (N_was + 1.0) / (N + 1.0) - 1.0
    values = (np.expm1(F), np.expm1(a), share, left / was - 1.0, back)
    result = {}
    for k, (name, value) in enumerate(zip(Uncertainty._fields, values, strict=True)):
        rows = case.depth if k < 3 else case.turn
        good = np.isfinite(value)
        size, more = np.interp(rows, x, own[k]), np.interp(rows, x, hardens)
        result[name] = _Off(value[good], size[good], more[good])
    return result


def _spread(off: _Off) -> float:
    """How much hardening adds, so that the shares of the errors within it are `SIGMAS`."""

    def beyond(more: float) -> float:
        ratio = np.abs(off.error) / np.hypot(off.own, more * off.hardens)
        return sum(
            float(np.mean(ratio <= k)) - share for k, share in zip((1, 2), SIGMAS, strict=True)
        )

    return 0.0 if beyond(0.0) >= 0.0 else float(brentq(beyond, 0.0, 1.0, xtol=1e-5))
