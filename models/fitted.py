"""Our closed form as a contact law: one smooth expression over all strength ratios.

The arithmetic is in `closed_form`, the coefficients in data/coefficients/fitted.json, which
`dentscope fit` writes; formulas and reasons are in docs/closed-form.md.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from numba import float64, njit, types

from ..core.errors import InputError
from ..core.material import Material, Pair
from .base import (
    N_COMMON,
    VECTOR,
    ContactLaw,
    Depths,
    Domain,
    DomainWarning,
    E,
    Kernels,
    Pairs,
    R,
    Standing,
    branch_kernel,
    common_parameters,
    loading_kernel,
    residual_kernel,
)
from .closed_form import (
    COEFFICIENTS,
    PAIR_NUMBERS,
    arguments_of,
    contact,
    first_part_at,
    force_at,
    of_pair,
    plastic_depth,
    radius_at,
    small_radius_at,
    still_flat_at,
)

Floats = npt.NDArray[np.float64]

FORMAT = "dentscope-coefficients/8"
BOUNDS = ("Sy_ratio", "E_reduced_over_Sy_min", "nu", "elastic_share", "Delta_over_R", "a_over_R")
"""What the domain of validity is stated in; each has a smallest and a largest value."""

COEFFICIENTS_FILE = Path(__file__).resolve().parents[1] / "data" / "coefficients" / "fitted.json"
"""What the law in use reads; `dentscope fit --publish` writes it."""

_FINITE = 0.01  # Delta/R at which the law says how far finite elastic strain takes it from Hertz
_OF_BODIES = ("k_s", "k_f", "nu_s", "nu_f", "q_s", "q_f")
_OF_PAIR = arguments_of(of_pair)[len(_OF_BODIES) :]
_CONTACT = arguments_of(contact)[1:]

_ALL = types.UniTuple(float64, 6)(VECTOR, float64)
assert len(_CONTACT) == 51
_AT = {name: N_COMMON + k for k, name in enumerate(_CONTACT)}
# places in the parameter vector, for the kernels that need only some of the numbers
_X_S, _W, _P, _G_A, _G_B, _K, _M, _FIN, _EVEN = (
    _AT[k] for k in ("x_s", "W", "P", "g_a", "g_b", "k", "m", "fin", "even")
)
_J_S, _J_F, _L, _L_C, _A_T, _POWER = (_AT[k] for k in ("j_s", "j_f", "L", "L_C", "a_t", "p"))
_WY, _C, _B5, _Z, _C_S, _C_F, _T, _Y1, _C_M = (
    _AT[k] for k in ("wy", "c", "b5", "z", "c_s", "c_f", "t", "y1", "c_m")
)
_H, _B_S, _B_D, _B_F, _R_POWER, _B_E, _K3, _E0, _E2 = (
    _AT[k] for k in ("h", "B_s", "B_d", "B_f", "r", "B_e", "k3", "e0", "e2")
)
_G0, _G1, _G2, _G3, _G4 = (_AT[k] for k in ("g0", "g1", "g2", "g3", "g4"))


@njit(float64(VECTOR, float64), cache=True, _nrt=False)
def _radius_over_R(par, D):
    w = par[_W] * D
    y = plastic_depth(w, par[_WY])
    small = small_radius_at(D, y, par[_G_A], par[_G_B], par[_C], par[_B5])
    first = first_part_at(
        w, small, par[_X_S], par[_L], par[_L_C], par[_G0], par[_G1], par[_G2], par[_G3], par[_G4]
    )
    still = still_flat_at(small, par[_A_T], par[_POWER])
    return radius_at(
        D, small, y, first, still, par[_FIN], par[_Z], par[_C_S], par[_C_F], par[_T], par[_Y1],
        par[_C_M], par[_E2],
    )  # fmt: skip


@loading_kernel
def _loading(par, depth):
    D = depth / par[R]
    F = force_at(
        D, _radius_over_R(par, D), par[_P], par[_K], par[_M], par[_FIN], par[_EVEN], par[_J_S],
        par[_J_F], par[_H], par[_B_S], par[_B_D], par[_B_F], par[_R_POWER], par[_B_E], par[_K3],
        par[_E0],
    )  # fmt: skip
    return F * par[E] * par[R] * par[R]


@branch_kernel
def _radius(par, depth, _peak):
    return par[R] * _radius_over_R(par, depth / par[R])


@njit(_ALL, cache=True, _nrt=False)
def everything(par, depth):
    """All that `closed_form.contact` returns, from a parameter vector."""
    p = par[N_COMMON:]
    return contact(
        depth / par[R],
        p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8], p[9], p[10], p[11],
        p[12], p[13], p[14], p[15], p[16], p[17], p[18], p[19], p[20], p[21], p[22], p[23],
        p[24], p[25], p[26], p[27], p[28], p[29], p[30], p[31], p[32], p[33], p[34], p[35],
        p[36], p[37], p[38], p[39], p[40], p[41], p[42], p[43], p[44], p[45], p[46], p[47],
        p[48], p[49], p[50],
    )  # fmt: skip


@residual_kernel
def _residual(par, peak):
    _, _, _, left, phi, _ = everything(par, peak)
    left = max(left, 0.0) * peak  # round-off before first yield
    return phi * left, (1.0 - phi) * left


@branch_kernel
def _unloading(par, depth, peak):
    F, _, _, left, phi, N = everything(par, peak)
    force = F * par[E] * par[R] * par[R]
    left = max(left, 0.0) * peak
    residual = phi * left + (1.0 - phi) * left  # to the last bit what `_residual` answers
    if depth <= residual or peak <= residual:
        return 0.0
    if depth >= peak:
        return force
    return force * ((depth - residual) / (peak - residual)) ** N


_KERNELS = Kernels(_loading, _radius, _unloading, _residual)


@dataclass(frozen=True)
class Fitted(ContactLaw):
    """The fitted law with its coefficients.

    Parameters
    ----------
    coefficients
        Value of every name in `closed_form.COEFFICIENTS`.
    limits
        Smallest and largest value of each of `BOUNDS` in the data behind the coefficients.
    """

    coefficients: Mapping[str, float] = field(default_factory=dict)
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @property
    def kernels(self) -> Kernels:
        """The compiled functions."""
        return _KERNELS

    def parameters(self, pair: Pair) -> Floats:
        """Common numbers, then what `closed_form.contact` takes behind D, shape (n,)."""
        own = contact_numbers(self.coefficients, bodies_of([pair]))[0]
        return np.concatenate([common_parameters(pair), own])

    def share(self, pair: Pair, depth: Depths) -> Floats:
        """delta_s*, shape (...); the elastic share where the contact is open."""
        return self._each(pair, depth, 2, pair.elastic_share)

    def unloading_exponent(self, pair: Pair, peak: Depths) -> Floats:
        """Exponent N of F/F_m = ((Delta - Delta_r)/(Delta_m - Delta_r))^N, shape (...)."""
        return self._each(pair, peak, 5, 1.5)

    def gradient(self, pair: Pair, depth: Depths) -> dict[str, Floats]:
        """Derivatives of the loading force, exact to round-off (complex steps).

        Parameters
        ----------
        pair
            Two bodies, none of them rigid.
        depth
            Approach, shape (...) [m]; above zero.

        Returns
        -------
        dict
            dF/d(depth) [N/m], dF/d(E_s), dF/d(E_f), dF/d(Sy_s), dF/d(Sy_f) [N/Pa], dF/d(nu_s),
            dF/d(nu_f) [N] and dF/d(R) [N/m], each of shape (...).

        Raises
        ------
        InputError
            A rigid body, or a depth of zero or less.
        """
        d = np.asarray(depth, dtype=float)
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
        own = [self.coefficients[name] for name in _OF_PAIR]
        numbers = of_pair(k_s, k_f, nu_s, nu_f, 1.0 / Sy_s, 1.0 / Sy_f, *own)
        given = {**self.coefficients, **dict(zip(PAIR_NUMBERS, numbers, strict=True))}
        D = depth / R
        return contact(D, *(given[name] for name in _CONTACT))[0] * R**2 / (k_s + k_f)

    def _each(self, pair: Pair, depth: Depths, which: int, open_value: float) -> Floats:
        par, d = self.parameters(pair), np.asarray(depth, dtype=float)
        out = np.full(d.shape, open_value)
        closed = d > 0.0
        out[closed] = [everything(par, x)[which] for x in d[closed]]
        return out

    def _checked(self, out: Floats, pair: Pairs, depth: Depths) -> Floats:
        beyond = self._beyond(pair, depth) if self.limits else ""
        if beyond:
            warnings.warn(f"{self.name}: {beyond}", DomainWarning, stacklevel=3)
        return out

    def _beyond(self, pair: Pairs, depth: Depths) -> str:
        """Name the first bound that is left; empty inside."""
        pairs = [pair] if isinstance(pair, Pair) else list(pair)
        d = np.asarray(depth, dtype=float)
        each = len(pairs) > 1 and d.ndim > 0 and d.shape[0] == len(pairs)
        for number, p in enumerate(pairs):
            deepest = float(np.max(d[number] if each else d, initial=0.0))
            if math.isinf(p.Sy_min):
                continue  # elastic: Hertz
            found = {
                "Sy_ratio": (p.Sy_ratio,),
                "E_reduced_over_Sy_min": (p.E_reduced / p.Sy_min,),
                "nu": tuple(b.nu for b in (p.sphere, p.flat) if not b.rigid),
                "elastic_share": (p.elastic_share,),
                "Delta_over_R": (deepest / p.R,),
            }
            for key, values in found.items():
                low, high = self.limits.get(key, (-math.inf, math.inf))
                for value in values:
                    if not low * (1.0 - 1e-9) <= value <= high * (1.0 + 1e-9):
                        return f"{key} = {value:.4g} is outside {low:.4g} to {high:.4g}"
        return ""


def bodies_of(pairs: Sequence[Pair]) -> Floats:
    """k_s, k_f, nu_s, nu_f, q_s, q_f of each pair, shape (n_pairs, 6)."""
    return np.array([(*_body(p.sphere), *_body(p.flat)) for p in pairs])[:, [0, 3, 1, 4, 2, 5]]


def _body(body: Material) -> tuple[float, float, float]:
    if body.rigid:
        return 0.0, 0.0, 0.0
    return 1.0 / body.plane_strain_modulus, body.nu, 1.0 / body.Sy


def contact_numbers(coefficients: Mapping[str, float], bodies: Floats) -> Floats:
    """What `closed_form.contact` takes behind D for each pair, shape (n_pairs, 47)."""
    numbers = of_pair(*bodies.T, *(coefficients[name] for name in _OF_PAIR))
    given = {**coefficients, **dict(zip(PAIR_NUMBERS, numbers, strict=True))}
    columns = [np.broadcast_to(given[name], len(bodies)) for name in _CONTACT]
    return np.ascontiguousarray(np.stack(columns, axis=1))


def fitted_law(
    coefficients: Mapping[str, float], *, limits: Mapping[str, tuple[float, float]] | None = None
) -> Fitted:
    """Return the law with the given coefficients."""
    # the stiffer body may be either: its part counts in full
    strain = coefficients["e0"] * math.sqrt(_FINITE) + 0.5 * abs(coefficients["e1"]) * _FINITE
    finite = 100.0001 * math.expm1(strain)
    return Fitted(
        name="fitted",
        title="dentscope, fitted to finite elements",
        source="data/coefficients/fitted.json",
        equations="docs/closed-form.md",
        standing=Standing.OWN_SOURCE,
        domain=Domain(note=_note(limits or {})),
        breaks=((f"not Hertz: finite elastic strain, at Delta/R = {_FINITE:g}", finite),),
        coefficients=dict(coefficients),
        limits=dict(limits or {}),
    )


def _note(limits: Mapping[str, tuple[float, float]]) -> str:
    return ", ".join(f"{key} {low:.3g} to {high:.3g}" for key, (low, high) in limits.items())


def read_coefficients() -> dict[str, Any] | None:
    """Content of the shipped coefficients file; none if there is none yet."""
    file = COEFFICIENTS_FILE
    return json.loads(file.read_text("utf-8")) if file.is_file() else None


def law_from(content: Mapping[str, Any], *, source: str) -> Fitted:
    """Return the law of a coefficients file's content.

    Raises
    ------
    InputError
        The file belongs to another form, or lacks a coefficient.
    """
    found = content.get("format")
    if found != FORMAT:
        raise InputError(
            f"format {found!r}", source=source, key="format",
            allowed=f"{FORMAT}; make the file anew with `dentscope fit --publish`",
        )  # fmt: skip
    missing = sorted(set(COEFFICIENTS) - set(content["coefficients"]))
    if missing:
        raise InputError(
            f"no {', '.join(missing)}", source=source, key="coefficients",
            allowed="every coefficient of the form; make the file anew with `dentscope fit`",
        )  # fmt: skip
    values = {name: float(content["coefficients"][name]["value"]) for name in COEFFICIENTS}
    limits = {k: (float(v[0]), float(v[1])) for k, v in content["domain"]["limits"].items()}
    return fitted_law(values, limits=limits)


def shipped_law() -> Fitted | None:
    """The law with the shipped coefficients; none if they were never fitted."""
    content = read_coefficients()
    return None if content is None else law_from(content, source=str(COEFFICIENTS_FILE))


__all__ = [
    "BOUNDS",
    "COEFFICIENTS_FILE",
    "FORMAT",
    "Fitted",
    "fitted_law",
    "law_from",
    "shipped_law",
]
