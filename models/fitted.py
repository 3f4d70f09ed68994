"""Our closed forms as contact laws: compact, and fitted with its correction.

The arithmetic is in `closed_form` and `correction`, the numbers come by `coefficients`; formulas
and reasons are in docs/closed-form.md.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numba import njit

from ..core.arrays import Array
from ..core.errors import InputError
from ..core.material import Material, Pair
from .base import ContactLaw, Domain, DomainWarning, Kernels, Standing
from .closed_form import (
    COEFFICIENTS,
    Bodies,
    Coefficients,
    PairNumbers,
    contact,
    force_at,
    of_pair,
    spread_at,
)
from .correction import PairCorrection
from .driver import Depths, Pairs, depths_of
from .kernel import N_COMMON, E, R, common_parameters, kernel, power_recovery, reader
from .uncertainty import Calibration, Uncertainty

# limit: depth at which the law says how far finite elastic strain takes it from Hertz [R]
_FINITE = 0.01


_pair_numbers = reader(PairNumbers, N_COMMON)  # behind the common numbers


@kernel
def _loading(par, depth):
    D, pair = depth / par[R], _pair_numbers(par)
    return force_at(D, spread_at(D, pair).a, pair) * par[E] * par[R] * par[R]


@kernel
def _radius(par, depth, _peak):
    return par[R] * spread_at(depth / par[R], _pair_numbers(par)).a


@njit(cache=True, _nrt=False)
def contact_of(par, depth):
    """The contact at `depth`, from a parameter vector."""
    return contact(depth / par[R], _pair_numbers(par))


@njit(_nrt=False, inline="always")
def _left_by(at, peak):
    left = max(at.left, 0.0) * peak  # round-off before first yield
    return at.phi * left, (1.0 - at.phi) * left


@kernel
def _residual(par, peak):
    return _left_by(contact_of(par, peak), peak)


@kernel
def _unloading(par, depth, peak):
    at = contact_of(par, peak)
    force = at.F * par[E] * par[R] * par[R]
    sphere, flat = _left_by(at, peak)
    return power_recovery(force, depth, peak, sphere + flat, at.N)


_KERNELS = Kernels(_loading, _radius, _unloading, _residual)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ClosedForm(ContactLaw):
    """One of our closed forms with its numbers; equal to itself alone.

    - `coefficients`: value of every name in `closed_form.COEFFICIENTS`.
    - `correction`: what is added to the compact law; none for that law itself.
    - `limits`: smallest and largest value of each quantity of the domain in the data behind them.
    - `calibration`: how far pairs that no fit had seen lay away; none if not stated.
    """

    coefficients: Mapping[str, float] = field(default_factory=dict)
    correction: PairCorrection | None = None
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    calibration: Calibration | None = None

    kernels = _KERNELS

    def parameters(self, pair: Pair) -> Array:
        """Common numbers, then those of the pair; shape (n,)."""
        own = np.ravel(self.numbers(bodies_of([pair])))
        return np.array([*common_parameters(pair), *own])

    def numbers(self, bodies: Bodies) -> PairNumbers:
        """Numbers of pairs, every field of shape (n,); real or complex."""
        compact = of_pair(bodies, Coefficients(**self.coefficients))
        shape = np.shape(compact.x_s)
        whole = PairNumbers(*(x if np.shape(x) == shape else np.full(shape, x) for x in compact))
        return whole if self.correction is None else self.correction.of(bodies, whole)

    def share(self, pair: Pair, depth: Depths) -> Array:
        """delta_s*, shape (...); the elastic share where the contact is open."""
        return self._each(pair, depth, "share", pair.elastic_share)

    def unloading_exponent(self, pair: Pair, peak: Depths) -> Array:
        """Exponent N of F/F_m = ((Delta - Delta_r)/(Delta_m - Delta_r))^N, shape (...)."""
        return self._each(pair, peak, "N", 1.5)

    def uncertainty(self, pair: Pair, depth: Depths) -> Uncertainty:
        """How far off the law may be, as pairs left out of the fit were; see `ContactLaw`."""
        if self.calibration is None:
            return super().uncertainty(pair, depth)
        numbers = PairNumbers(*(x[0] for x in self.numbers(bodies_of([pair]))))
        return self.calibration.of(numbers, depths_of(depth) / pair.R)

    def gradient(self, pair: Pair, depth: Depths) -> dict[str, Array]:
        """Derivatives of the loading force, exact to round-off (complex steps).

        `pair`: two bodies, none of them rigid; `depth`: approach, shape (...) [m]; above zero.

        Returned: dF/d(depth) [N/m], dF/d(E_s), dF/d(E_f), dF/d(Sy_s), dF/d(Sy_f) [N/Pa],
        dF/d(nu_s), dF/d(nu_f) [N] and dF/d(R) [N/m], each of shape (...).

        Raises `InputError`: a rigid body, or a depth of zero or less.
        """
        d = depths_of(depth)
        if pair.sphere.rigid or pair.flat.rigid:
            raise InputError("a rigid body has no modulus", key="rigid", allowed="two that deform")
        if not np.all(d > 0.0):
            raise InputError("no contact", key="depth", allowed="depths above 0")
        s, f = pair.sphere, pair.flat
        values: dict[str, Any] = {
            "depth": d, "E_s": s.E, "E_f": f.E, "nu_s": s.nu, "nu_f": f.nu,
            "Sy_s": s.Sy, "Sy_f": f.Sy, "R": pair.R,
        }  # fmt: skip
        result = {}
        for name, value in values.items():
            step = 1e-30 * np.max(np.abs(value)) if np.all(np.isfinite(value)) else 0.0
            if step == 0.0:
                result[name] = np.zeros_like(d)
                continue
            moved = {**values, name: value + 1j * step}
            result[name] = np.asarray(np.imag(self._force_of(**moved)) / step)
        return result

    def _force_of(
        self, *, depth: Any, E_s: Any, E_f: Any, nu_s: Any, nu_f: Any, Sy_s: Any, Sy_f: Any, R: Any
    ) -> Any:
        k_s, k_f = (1.0 - nu_s**2) / E_s, (1.0 - nu_f**2) / E_f
        one = (k_s, k_f, nu_s, nu_f, 1.0 / Sy_s, 1.0 / Sy_f)
        numbers = self.numbers(Bodies(*(np.array([x]) for x in one)))
        alone = PairNumbers(*(x[0] for x in numbers))
        return contact(depth / R, alone).F * R**2 / (k_s + k_f)

    def _each(self, pair: Pair, depth: Depths, which: str, open_value: float) -> Array:
        par, d = self.parameters(pair), depths_of(depth)
        out = np.full(d.shape, open_value)
        closed = d > 0.0
        out[closed] = [getattr(contact_of(par, x), which) for x in d[closed]]
        return out

    def warn_outside(self, pair: Pairs, depth: Depths) -> None:
        """Warn with `DomainWarning` that names the first bound that is left."""
        beyond = self._beyond(pair, depth) if self.limits else ""
        if beyond:
            warnings.warn(f"{self.name}: {beyond}", DomainWarning, stacklevel=3)

    def _beyond(self, pair: Pairs, depth: Depths) -> str:
        """Name the first bound that is left; empty inside."""
        pairs = [pair] if isinstance(pair, Pair) else list(pair)
        d = depths_of(depth)
        each = len(pairs) > 1 and d.ndim > 0 and d.shape[0] == len(pairs)
        for number, p in enumerate(pairs):
            deepest = float(np.max(d[number] if each else d, initial=0.0))
            if math.isinf(p.Sy_min):
                continue  # elastic: Hertz
            if p.sphere.flow is not None or p.flat.flow is not None:
                return "knows the strength of first yield only; `hardening` follows a flow curve"
            found: dict[str, tuple[str, *tuple[float, ...]]] = {
                "Sy_ratio": ("yield strength of the sphere over that of the flat", p.Sy_ratio),
                "E_reduced_over_Sy_min": (
                    "reduced modulus over the lesser yield strength", p.E_reduced / p.Sy_min
                ),
                "nu": ("Poisson's ratio", *(b.nu for b in (p.sphere, p.flat) if not b.rigid)),
                "elastic_share": ("sphere's share of the elastic approach", p.elastic_share),
                "Delta_over_R": ("approach over the radius", deepest / p.R),
            }  # fmt: skip
            for key, (words, *values) in found.items():
                low, high = self.limits.get(key, (-math.inf, math.inf))
                for value in values:
                    if not low * (1.0 - 1e-9) <= value <= high * (1.0 + 1e-9):
                        told = f"{words} ({key}) = {value:.4g}"
                        return f"{told} is outside {low:.4g} to {high:.4g}"
        return ""


def bodies_of(pairs: Sequence[Pair]) -> Bodies:
    """What the closed form needs of the bodies of each pair, every field of shape (n_pairs,)."""
    columns = np.array([(*_body(p.sphere), *_body(p.flat)) for p in pairs]).T
    k_s, nu_s, q_s, k_f, nu_f, q_f = columns
    return Bodies(k_s, k_f, nu_s, nu_f, q_s, q_f)


def _body(body: Material) -> tuple[float, float, float]:
    if body.rigid:
        return 0.0, 0.0, 0.0
    return 1.0 / body.plane_strain_modulus, body.nu, 1.0 / body.Sy


def closed_form_law(
    coefficients: Mapping[str, float],
    *,
    correction: PairCorrection | None = None,
    limits: Mapping[str, tuple[float, float]] | None = None,
    calibration: Calibration | None = None,
) -> ClosedForm:
    """Return the law with the given numbers: compact, or fitted where there is a correction."""
    # the stiffer body may be either: its part counts in full
    finite = 100.0001 * math.expm1(0.31 * math.sqrt(_FINITE) + 1.25 * _FINITE)
    count, known = f"{len(COEFFICIENTS)} coefficients", dict(limits or {})
    return ClosedForm(
        name="compact" if correction is None else "fitted",
        title=f"dentscope, {count}"
        if correction is None
        else "dentscope, fitted to finite elements",
        source="data/coefficients/fitted.json",
        equations="docs/closed-form.md",
        standing=Standing.OWN_SOURCE,
        domain=Domain.down_to(
            known.get("Delta_over_R", (0.0, math.inf))[1],
            note=", ".join(f"{k} {low:.3g} to {high:.3g}" for k, (low, high) in known.items()),
        ),
        breaks=((f"not Hertz: finite elastic strain, at Delta/R = {_FINITE:g}", finite),),
        coefficients=dict(coefficients),
        correction=correction,
        limits=known,
        calibration=calibration,
    )
