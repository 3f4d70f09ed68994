"""The one contract of every contact law.

A law is a frozen object without material numbers. Its physics are four scalar kernels compiled by
numba with fixed signatures (`kernel`), written once; one driver (`driver`) broadcasts them over
depths and pairs. The same kernels go, as function values, into the compiled impact integrator,
which therefore needs no recompilation for another law.

    loading(par, depth)         -> F          normal force on first loading [N]
    radius(par, depth, peak)    -> a          contact radius; depth = peak on loading [m]
    unloading(par, depth, peak) -> F          force after the peak [N]; exactly 0 at and below
                                              the residual depth
    residual(par, peak)         -> (s, f)     permanent depth of sphere and flat [m]

Kernels are called with 0 < depth <= peak only; the driver answers for an open contact.
"""

from __future__ import annotations

import copy
import math
import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields
from enum import IntEnum
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numba import njit

from ..core.arrays import Array, numbers
from ..core.errors import InputError
from ..core.material import Pair
from .driver import Depths, Pairs, map_branch, map_loading, map_residual, rows_of
from .kernel import (
    BRANCH_SIGNATURE,
    LOADING_SIGNATURE,
    RESIDUAL_SIGNATURE,
    Common,
    common_parameters,
)
from .uncertainty import Uncertainty

CLAUSES = (
    "force falls", "force jumps", "radius falls", "radius jumps", "residual jumps", "not Hertz",
)  # fmt: skip
"""What a declared breach of the contract can begin with: force or radius fall as the depth grows;
force, radius or residual depth jump up; the law without a yield strength is not exactly Hertz's."""


class DomainWarning(UserWarning):
    """A law was evaluated outside the range that its source gives."""


@contextmanager
def unwarned() -> Iterator[None]:
    """Evaluate laws without `DomainWarning`, where the doubt is told otherwise or is on purpose."""
    with warnings.catch_warnings(action="ignore", category=DomainWarning):
        yield


class Kernels(NamedTuple):
    """The four compiled functions of a law."""

    loading: Any
    radius: Any
    unloading: Any
    residual: Any


@dataclass(frozen=True)
class Domain:
    """Range in which a law's source supports it."""

    a_over_R_max: float = math.inf
    note: str = ""

    @classmethod
    def down_to(cls, deepest: float, *, note: str) -> Domain:
        """Return the range of a law known to this Delta/R; a/R there is (2 Delta/R)^(1/2)."""
        return cls(math.sqrt(2.0 * deepest), note)


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
    def told(self) -> str:
        """The standing in words, beginning with "verified" or "unverified"."""
        return {
            Standing.OUR_READING: "unverified, words only",
            Standing.THESIS: "unverified, thesis only",
            Standing.PARTLY: "unverified in part",
            Standing.SECOND_HAND: "verified second hand",
            Standing.OWN_SOURCE: "verified, own source",
        }[self]


# eq: a law that holds arrays is itself alone, whatever its name; one of kernels equals its like
@dataclass(frozen=True, eq=False, repr=False)
class ContactLaw(ABC):
    """A contact law; concrete laws fill in the kernels and say where they come from.

    - `name`: key in `LAWS`.
    - `title`: author and year.
    - `source`: publication.
    - `equations`: equation numbers in the thesis, and in the source where it was read.
    - `standing`: where the equations were read.
    - `domain`: range of validity.
    - `breaks`: clauses of the contract that the published form breaks, with the size in percent;
      each begins with one of `CLAUSES`.
    - `regime`: which body the law lets deform: "flattening", "indentation" or "either".
    - `read`: the sources read, and for which equations.
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

    def __repr__(self) -> str:
        return f"{self.name}: {self.title}; {self.regime}; {self.standing.told}"

    @property
    def about(self) -> dict[str, Any]:
        """What is said of the law, by the names of these fields."""
        return {f.name: getattr(self, f.name) for f in fields(ContactLaw)}

    @property
    @abstractmethod
    def kernels(self) -> Kernels:
        """The compiled functions."""

    def parameters(self, pair: Pair) -> Array:
        """Return the numbers that the kernels take, shape (n,)."""
        return np.array(common_parameters(pair))

    def loading(self, pair: Pairs, depth: Depths) -> Array:
        """Force on first loading.

        `pair`: one pair, or one for each entry of the first axis of `depth`; `depth`: approach,
        shape (...) [m]; zero or less is an open contact.

        Returned: force, shape (...) [N].
        """
        rows = rows_of(self.parameters, pair, depth)
        out = np.zeros(rows.depth.size)
        map_loading(self.kernels.loading, *rows[:3], out)
        found = rows.shaped(out)
        self.warn_outside(pair, depth)
        return found

    def contact_radius(self, pair: Pairs, depth: Depths, peak: Depths | None = None) -> Array:
        """Contact radius, shape (...) [m]; `peak` defaults to `depth`, which means loading."""
        return self._branch(self.kernels.radius, pair, depth, depth if peak is None else peak)

    def unloading(self, pair: Pairs, depth: Depths, peak: Depths) -> Array:
        """Force [N] at `depth` after a largest approach of `peak`, (...) of both together."""
        return self._branch(self.kernels.unloading, pair, depth, peak)

    def residual(self, pair: Pairs, peak: Depths) -> tuple[Array, Array]:
        """Permanent depth of sphere and flat after a largest approach of `peak` [m]."""
        rows = rows_of(self.parameters, pair, peak)
        sphere, flat = np.zeros(rows.depth.size), np.zeros(rows.depth.size)
        map_residual(self.kernels.residual, *rows[:3], sphere, flat)
        return rows.shaped(sphere), rows.shaped(flat)

    def hardness(self, pair: Pairs, depth: Depths) -> Array:
        """Mean pressure F/(pi a^2) on loading, shape (...) [Pa]; zero when open."""
        force, a = self.loading(pair, depth), self.contact_radius(pair, depth)
        area = np.pi * a**2
        return np.divide(force, area, out=np.zeros_like(force), where=area > 0.0)

    def uncertainty(self, pair: Pair, depth: Depths) -> Uncertainty:
        """How far off the law may be at a depth of first loading: standard deviations.

        `pair`: the two bodies; `depth`: approach, shape (...) [m]; for dent and energy the depth of
        the turning point.

        Returned: of force, contact radius, dent and energy given back relative, of the sphere's
        share of the approach absolute; each of shape (...). They are those of the law against
        finite elements of the same bodies, elastic and perfectly plastic: that a real metal is not
        such a body comes on top. Errors of one pair go together over the depth.

        Raises `InputError`: the law states none, as published ones:
        `dynamics.report.beside.beside_fitted` says by how much such a law misses the fitted one.
        """
        raise InputError(
            f"{self.name} states no error", key="law", allowed="compact, fitted or a solved pair"
        )

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

    def _branch(self, kernel: Any, pair: Pairs, depth: Depths, peak: Depths) -> Array:
        if isinstance(pair, Pair):
            depth, peak = np.broadcast_arrays(depth, peak)
        rows = rows_of(self.parameters, pair, depth)
        p = numbers(peak, key="peak", allowed="depths in m")
        p = np.ascontiguousarray(np.broadcast_to(p, rows.shape).ravel())
        if not np.all(np.isfinite(p)):
            raise InputError("a peak is not a number", key="peak", allowed="finite depths in m")
        out = np.zeros(rows.depth.size)
        peaks = np.maximum(p, rows.depth)
        map_branch(kernel, *rows[:3], peaks, out)
        return rows._replace(depth=peaks).shaped(out)

    def warn_outside(self, pair: Pairs, depth: Depths) -> None:  # noqa: B027
        """Warn with `DomainWarning` if the law knows its range in numbers; most do not."""


Law = TypeVar("Law", bound=ContactLaw)
# limit: pairs whose numbers a law keeps [-]: a sweep's chunk
_REMEMBERED = 4096


def remembering(law: Law) -> Law:
    """Return a copy of a law that keeps the numbers of the pairs it was asked for.

    A fit asks for the same pair once a condition and point; working them out anew costs more than
    the impact.
    """
    if hasattr(law.parameters, "cache_info"):
        return law
    kept = copy.copy(law)
    object.__setattr__(kept, "parameters", lru_cache(maxsize=_REMEMBERED)(law.parameters))
    return kept


@dataclass(frozen=True, kw_only=True, repr=False)
class PublishedLaw(ContactLaw):
    """A law given by its four kernels and, where they need some, numbers of its own.

    `own`: the kernels; `numbers`: the law's own numbers from the pair's common ones, placed behind
    these.
    """

    own: Kernels
    numbers: Callable[[Common], Sequence[float]] | None = None

    @property
    def kernels(self) -> Kernels:
        """The compiled functions."""
        return self.own

    def parameters(self, pair: Pair) -> Array:
        """Common numbers and the law's own, shape (n,)."""
        common = common_parameters(pair)
        return np.array([*common, *(self.numbers(common) if self.numbers else ())], dtype=float)


@dataclass(frozen=True, kw_only=True, repr=False)
class CombinedLaw(ContactLaw):
    """The loading of one law with the residual depth and the recovery of another."""

    first: ContactLaw
    second: ContactLaw

    @property
    def kernels(self) -> Kernels:
        """Loading and radius of the first law, residual and recovery of the second."""
        return _combined_kernels(self.first, self.second)

    def parameters(self, pair: Pair) -> Array:
        """Both laws' numbers, the first law's first, and where the second's start."""
        one, two = self.first.parameters(pair), self.second.parameters(pair)
        return np.concatenate([one, two, [float(len(one))]])


_COMBINED: dict[tuple[Kernels, Kernels], Kernels] = {}
# by the kernels themselves: a law of one's own that is written anew may keep its name


def _combined_kernels(first: ContactLaw, second: ContactLaw) -> Kernels:
    key = one, other = (first.kernels, second.kernels)
    if key not in _COMBINED:
        loading, radius = one.loading, one.radius
        residual_of, unloading_of = other.residual, other.unloading

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
