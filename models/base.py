"""The one contract of every contact law.

A law is a frozen object without material numbers. Its physics are four scalar kernels compiled by
numba with fixed signatures, written once; everything else is the driver below, which broadcasts
over depths and pairs. The same kernels go, as function values, into the compiled impact integrator,
which therefore needs no recompilation for another law.

    loading(par, depth)         -> F          normal force on first loading [N]
    radius(par, depth, peak)    -> a          contact radius; depth = peak on loading [m]
    unloading(par, depth, peak) -> F          force after the peak [N]
    residual(par, peak)         -> (s, f)     permanent depth of sphere and flat [m]

Kernels are called with 0 < depth <= peak only; the driver answers for an open contact.
"""

from __future__ import annotations

import math
import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Any

import numpy as np
import numpy.typing as npt
from numba import float64, njit, types

from ..core.errors import InputError
from ..core.material import Pair

Floats = npt.NDArray[np.float64]
Depths = npt.ArrayLike
Pairs = Pair | Sequence[Pair]

VECTOR = types.Array(types.float64, 1, "C")
LOADING_SIGNATURE = float64(VECTOR, float64)
BRANCH_SIGNATURE = float64(VECTOR, float64, float64)
RESIDUAL_SIGNATURE = types.UniTuple(float64, 2)(VECTOR, float64)

# Places in every law's parameter vector; a law's own numbers follow from N_COMMON on.
R, E, S, RATIO, SHARE, E_WEAK, NU_WEAK, C, ONSET, CRITICAL, K_HERTZ = range(11)
N_COMMON = 11

# error_model: no check for a division by zero, which costs as much as the division.
# _nrt: no reference counts, which cost as much as the arithmetic; a kernel allocates nothing.
loading_kernel = njit(LOADING_SIGNATURE, cache=True, _nrt=False, error_model="numpy")
branch_kernel = njit(BRANCH_SIGNATURE, cache=True, _nrt=False, error_model="numpy")
residual_kernel = njit(RESIDUAL_SIGNATURE, cache=True, _nrt=False, error_model="numpy")


CLAUSES = (
    "force falls", "force jumps", "radius falls", "radius jumps", "residual jumps", "not Hertz",
)  # fmt: skip
"""What a declared breach of the contract can begin with: force or radius fall as the depth grows;
force, radius or residual depth jump up; the law without a yield strength is not exactly Hertz's."""


class DomainWarning(UserWarning):
    """A law was evaluated outside the range that its source gives."""


@dataclass(frozen=True)
class Kernels:
    """The four compiled functions of a law."""

    loading: Any
    radius: Any
    unloading: Any
    residual: Any


@dataclass(frozen=True)
class Domain:
    """Range in which a law's source supports it, in w = delta/delta_c and a/R."""

    w_max: float = math.inf
    a_over_R_max: float = math.inf
    note: str = ""


class Standing(IntEnum):
    """Where a law's equations were read, from nowhere to its own source.

    `PARTLY` means: one branch in a text or code that names the paper, the other in the thesis only.
    """

    OUR_READING = 0
    THESIS = 1
    PARTLY = 2
    SECOND_HAND = 3
    OWN_SOURCE = 4

    @property
    def verified(self) -> bool:
        """Whether the whole law was found outside the thesis."""
        return self >= Standing.SECOND_HAND

    @property
    def told(self) -> str:
        """The standing in words, beginning with "verified" or "unverified"."""
        return {
            Standing.OUR_READING: "unverified, words only",
            Standing.THESIS: "unverified, thesis only",
            Standing.PARTLY: "unverified in part",
            Standing.SECOND_HAND: "verified second hand",
            Standing.OWN_SOURCE: "verified, own source",
        }[self]


@dataclass(frozen=True)
class ContactLaw(ABC):
    """A contact law; concrete laws fill in the kernels and say where they come from.

    Parameters
    ----------
    name
        Key in `LAWS`.
    title
        Author and year.
    source
        Publication.
    equations
        Equation numbers in the thesis, and in the source where it was read.
    standing
        Where the equations were read.
    domain
        Range of validity.
    breaks
        Clauses of the contract that the published form breaks, with the size in percent; each
        begins with one of `CLAUSES`.
    regime
        Which body the law lets deform: "flattening", "indentation" or "either".
    read
        The sources read, and for which equations.
    """

    name: str
    title: str
    source: str
    equations: str
    standing: Standing
    domain: Domain
    breaks: tuple[tuple[str, float], ...] = ()
    regime: str = "either"
    read: str = ""

    @property
    @abstractmethod
    def kernels(self) -> Kernels:
        """The compiled functions."""

    @property
    def verified(self) -> bool:
        """Whether a source other than the thesis was read for the whole law."""
        return self.standing.verified

    def parameters(self, pair: Pair) -> Floats:
        """Return the numbers that the kernels take, shape (n,)."""
        return common_parameters(pair)

    def allowance(self, clause: str) -> float:
        """Largest declared breach of `clause` (one of `CLAUSES`), as a fraction."""
        sizes = (size for text, size in self.breaks if text.startswith(clause))
        return max(sizes, default=0.0) / 100.0

    def loading(self, pair: Pairs, depth: Depths) -> Floats:
        """Force on first loading.

        Parameters
        ----------
        pair
            One pair, or one for each entry of the first axis of `depth`.
        depth
            Approach, shape (...) [m]; zero or less is an open contact.

        Returns
        -------
        ndarray
            Force, shape (...) [N].
        """
        par, row, d, shape = _flatten(self, pair, depth)
        out = np.zeros(d.size)
        _map_loading(self.kernels.loading, par, row, d, out)
        return self._checked(out, pair, depth).reshape(shape)

    def contact_radius(self, pair: Pairs, depth: Depths, peak: Depths | None = None) -> Floats:
        """Contact radius, shape (...) [m]; `peak` defaults to `depth`, which means loading."""
        return self._branch(self.kernels.radius, pair, depth, depth if peak is None else peak)

    def unloading(self, pair: Pairs, depth: Depths, peak: Depths) -> Floats:
        """Force at `depth` after a largest approach of `peak`, shape (...) [N]."""
        return self._branch(self.kernels.unloading, pair, depth, peak)

    def residual(self, pair: Pairs, peak: Depths) -> tuple[Floats, Floats]:
        """Permanent depth of sphere and flat after a largest approach of `peak` [m]."""
        par, row, d, shape = _flatten(self, pair, peak)
        sphere, flat = np.zeros(d.size), np.zeros(d.size)
        _map_residual(self.kernels.residual, par, row, d, sphere, flat)
        return sphere.reshape(shape), flat.reshape(shape)

    def hardness(self, pair: Pairs, depth: Depths) -> Floats:
        """Mean pressure F/(pi a^2) on loading, shape (...) [Pa]; zero when open."""
        force, a = self.loading(pair, depth), self.contact_radius(pair, depth)
        area = np.pi * a**2
        return np.divide(force, area, out=np.zeros_like(force), where=area > 0.0)

    def with_unloading(self, other: ContactLaw) -> ContactLaw:
        """Return this law's loading with the residual depth and the recovery of `other`."""
        return CombinedLaw(
            name=f"{self.name}+{other.name}",
            title=f"{self.title}, residual depth of {other.title}",
            source=f"{self.source}; {other.source}",
            equations=f"{self.equations}; {other.equations}",
            standing=min(self.standing, other.standing),
            domain=self.domain,
            breaks=(*self.breaks, *(b for b in other.breaks if b[0].startswith("residual"))),
            regime=self.regime,
            first=self,
            second=other,
        )

    def _branch(self, kernel: Any, pair: Pairs, depth: Depths, peak: Depths) -> Floats:
        par, row, d, shape = _flatten(self, pair, depth)
        p = np.ascontiguousarray(np.broadcast_to(np.asarray(peak, float), shape).ravel())
        out = np.zeros(d.size)
        _map_branch(kernel, par, row, d, np.maximum(p, d), out)
        return out.reshape(shape)

    def _checked(self, out: Floats, pair: Pairs, depth: Depths) -> Floats:
        if math.isfinite(self.domain.w_max):
            pairs = [pair] if isinstance(pair, Pair) else list(pair)
            onset = min(critical_depth(p) for p in pairs)
            w = float(np.max(np.asarray(depth, float), initial=0.0)) / onset
            if w > self.domain.w_max:
                warnings.warn(
                    f"{self.name}: delta/delta_c = {w:.3g} is beyond {self.domain.w_max:g}",
                    DomainWarning,
                    stacklevel=3,
                )
        return out


def _no_numbers(common: Floats) -> Sequence[float]:
    return ()


@dataclass(frozen=True, kw_only=True)
class PublishedLaw(ContactLaw):
    """A law given by its four kernels and, where they need some, numbers of its own.

    Parameters
    ----------
    own
        The kernels.
    numbers
        The law's own numbers from the pair's common ones, placed behind these.
    """

    own: Kernels
    numbers: Callable[[Floats], Sequence[float]] = _no_numbers

    @property
    def kernels(self) -> Kernels:
        """The compiled functions."""
        return self.own

    def parameters(self, pair: Pair) -> Floats:
        """Common numbers and the law's own, shape (n,)."""
        common = common_parameters(pair)
        return np.concatenate([common, np.asarray(self.numbers(common), dtype=float)])


@dataclass(frozen=True)
class CombinedLaw(ContactLaw):
    """The loading of one law with the residual depth and the recovery of another."""

    first: ContactLaw | None = None
    second: ContactLaw | None = None

    @property
    def kernels(self) -> Kernels:
        """Loading and radius of the first law, residual and recovery of the second."""
        assert self.first is not None
        assert self.second is not None
        return _combined_kernels(self.first, self.second)

    def parameters(self, pair: Pair) -> Floats:
        """Both laws' numbers, the first law's first, and where the second's start."""
        assert self.first is not None
        assert self.second is not None
        one, two = self.first.parameters(pair), self.second.parameters(pair)
        return np.concatenate([one, two, [float(len(one))]])


_COMBINED: dict[tuple[str, str], Kernels] = {}


def _combined_kernels(first: ContactLaw, second: ContactLaw) -> Kernels:
    key = (first.name, second.name)
    if key not in _COMBINED:
        loading, radius = first.kernels.loading, first.kernels.radius
        residual_of, unloading_of = second.kernels.residual, second.kernels.unloading

        @njit(LOADING_SIGNATURE, _nrt=False)
        def combined_loading(par, depth):
            return loading(par[: int(par[-1])], depth)

        @njit(BRANCH_SIGNATURE, _nrt=False)
        def combined_radius(par, depth, peak):
            return radius(par[: int(par[-1])], depth, peak)

        @njit(RESIDUAL_SIGNATURE, _nrt=False)
        def combined_residual(par, peak):
            return residual_of(par[int(par[-1]) : len(par) - 1], peak)

        @njit(BRANCH_SIGNATURE, _nrt=False)
        def combined_unloading(par, depth, peak):
            # the second law gives the shape of the recovery, the first its height
            theirs = par[int(par[-1]) : len(par) - 1]
            height = unloading_of(theirs, peak, peak)
            if height <= 0.0:
                return 0.0
            return combined_loading(par, peak) * (unloading_of(theirs, depth, peak) / height)

        _COMBINED[key] = Kernels(
            combined_loading, combined_radius, combined_unloading, combined_residual
        )
    return _COMBINED[key]


def common_parameters(pair: Pair) -> Floats:
    """Numbers that every law starts from, shape (11,).

    R, E', Sy_min, Sy*, elastic share, plane-strain modulus, nu and C of the weaker body, the
    critical approach (1.16) and force (1.19, corrected), and Hertz's (4/3) E' sqrt(R).
    """
    weak = pair.weaker
    nu = 0.0 if weak.rigid else weak.nu
    modulus, strength, C = pair.E_reduced, pair.Sy_min, yield_constant(nu)
    slope = math.pi * C * strength / (2.0 * modulus)
    return np.array(
        [
            pair.R,
            modulus,
            strength,
            pair.Sy_ratio,
            pair.elastic_share,
            weak.plane_strain_modulus,
            nu,
            C,
            slope * slope * pair.R,
            4.0 / 3.0 * modulus * pair.R**2 * slope**3 if slope < math.inf else math.inf,
            4.0 / 3.0 * modulus * math.sqrt(pair.R),
        ]
    )


def yield_constant(nu: float) -> float:
    """C = 1.295 exp(0.736 nu), from the onset of yield below the contact (Eq. 1.17, corrected).

    Examples
    --------
    >>> round(yield_constant(0.3), 3)
    1.615
    """
    return 1.295 * math.exp(0.736 * nu)


def critical_depth(pair: Pair) -> float:
    """Approach at first yield of the weaker body, delta_c = (pi C Sy/(2 E'))^2 R [m] (Eq. 1.16)."""
    return float(common_parameters(pair)[ONSET])


def critical_force(pair: Pair) -> float:
    """F_c = (4/3) (R/E')^2 (pi C Sy/2)^3 [N] (Eq. 1.19, corrected)."""
    return float(common_parameters(pair)[CRITICAL])


@loading_kernel
def hertz_force(par, depth):
    """F = (4/3) E' sqrt(R) delta^(3/2) (Eqs. 1.3-1.6)."""
    return par[K_HERTZ] * depth * math.sqrt(depth)


@loading_kernel
def onset(par, _depth):
    """Critical approach delta_c [m] (Eq. 1.16); infinite without yield."""
    return par[ONSET]


@njit(float64(float64, float64, float64, float64), cache=True, _nrt=False)
def hertz_recovery(force_peak, depth, peak, residual):
    """Elastic recovery about the residual depth, F_m ((d - d_r)/(d_m - d_r))^(3/2) (3.5-3.6)."""
    if depth <= residual or peak <= residual:
        return 0.0
    if depth >= peak:
        return force_peak
    x = (depth - residual) / (peak - residual)
    return force_peak * x * math.sqrt(x)


@njit(
    types.void(
        types.FunctionType(LOADING_SIGNATURE), float64[:, ::1], types.int64[::1], float64[::1],
        float64[::1],
    ),
    cache=True, _nrt=False,
)  # fmt: skip
def _map_loading(kernel, par, row, depth, out):
    for i in range(depth.size):
        if depth[i] > 0.0:
            out[i] = kernel(par[row[i]], depth[i])


@njit(
    types.void(
        types.FunctionType(BRANCH_SIGNATURE), float64[:, ::1], types.int64[::1], float64[::1],
        float64[::1], float64[::1],
    ),
    cache=True, _nrt=False,
)  # fmt: skip
def _map_branch(kernel, par, row, depth, peak, out):
    for i in range(depth.size):
        if depth[i] > 0.0:
            out[i] = kernel(par[row[i]], depth[i], peak[i])


@njit(
    types.void(
        types.FunctionType(RESIDUAL_SIGNATURE), float64[:, ::1], types.int64[::1], float64[::1],
        float64[::1], float64[::1],
    ),
    cache=True, _nrt=False,
)  # fmt: skip
def _map_residual(kernel, par, row, peak, sphere, flat):
    for i in range(peak.size):
        if peak[i] > 0.0:
            s, f = kernel(par[row[i]], peak[i])
            sphere[i] = s
            flat[i] = f


def _flatten(
    law: ContactLaw, pair: Pairs, depth: Depths
) -> tuple[Floats, npt.NDArray[np.int64], Floats, tuple[int, ...]]:
    """Parameter table, its row for each entry, flat depths and the result's shape."""
    d = np.asarray(depth, dtype=float)
    if not np.all(np.isfinite(d)):
        raise InputError("a depth is not a number", key="depth", allowed="finite depths in m")
    if isinstance(pair, Pair):
        table = law.parameters(pair)[None, :]
        row = np.zeros(d.size, dtype=np.int64)
    else:
        table = np.stack([law.parameters(p) for p in pair])
        if d.ndim == 0 or d.shape[0] != len(table):
            d = np.broadcast_to(d, (len(table), *d.shape))
        row = np.repeat(np.arange(len(table)), d.size // len(table))
    return np.ascontiguousarray(table), row, np.ascontiguousarray(d.ravel()), d.shape


def renamed(law: ContactLaw, *, name: str, title: str) -> ContactLaw:
    """Return a law under another name, for a combination that has one of its own."""
    return replace(law, name=name, title=title)
