"""A law with sphere and flat in each other's place: the body that is struck is its sphere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numba import njit

from ..core.arrays import Array
from ..core.material import Pair
from .anchored import AnchoredLaw
from .base import ContactLaw, Kernels
from .driver import Depths, Pairs
from .kernel import RESIDUAL_SIGNATURE
from .table import TableLaw
from .uncertainty import Uncertainty

_REGIMES = {"flattening": "indentation", "indentation": "flattening"}


@dataclass(frozen=True, kw_only=True, repr=False)
class TurnedLaw(ContactLaw):
    """Another law whose sphere is the pair's flat; force, radius and recovery are of both."""

    law: ContactLaw

    @property
    def kernels(self) -> Kernels:
        """Those of the law, what stays given to the other body."""
        return _kernels(self.law.kernels)

    def parameters(self, pair: Pair) -> Array:
        """Return the law's numbers of the pair turned round, shape (n,)."""
        return self.law.parameters(pair.turned)

    def share(self, pair: Pair, depth: Depths) -> Array:
        """Share of the approach that the pair's sphere takes, shape (...)."""
        split = getattr(self.law, "share", None)
        if split is None:
            return np.full(np.shape(depth), pair.elastic_share)
        return np.asarray(1.0 - split(pair.turned, depth))

    def uncertainty(self, pair: Pair, depth: Depths) -> Uncertainty:
        """How far off the law may be; as `ContactLaw.uncertainty`."""
        return self.law.uncertainty(pair.turned, depth)

    def warn_outside(self, pair: Pairs, depth: Depths) -> None:
        """Warn where the law itself would."""
        one = isinstance(pair, Pair)
        self.law.warn_outside(pair.turned if one else [p.turned for p in pair], depth)  # type: ignore[union-attr]


def as_made(law: ContactLaw, pair: Pair) -> tuple[ContactLaw, Pair]:
    """Return the law itself, and the pair as that has it: of a turned law turned back."""
    return (law.law, pair.turned) if isinstance(law, TurnedLaw) else (law, pair)


@lru_cache(maxsize=64)
def turned(law: ContactLaw) -> ContactLaw:
    """Return the law with sphere and flat in each other's place.

    A law of one solved pair stays as it is, for that pair was solved as its bodies stand; so does
    one that is turned.

    Examples
    --------
    >>> from dentscope.core import Material
    >>> from dentscope.models import LAWS
    >>> soft, hard = Material(E=200e9, nu=0.3, Sy=4e8), Material(E=200e9, nu=0.3, Sy=2e9)
    >>> law, pair = LAWS["fitted"], Pair(soft, hard, 5e-3)
    >>> float(turned(law).loading(pair.turned, 1e-5) / law.loading(pair, 1e-5))
    1.0
    """
    if isinstance(law, AnchoredLaw | TableLaw | TurnedLaw):
        return law
    regime = _REGIMES.get(law.regime, law.regime)
    return TurnedLaw(**{**law.about, "regime": regime}, law=law)


@lru_cache(maxsize=64)
def _kernels(own: Kernels) -> Kernels:
    residual: Any = own.residual

    @njit(RESIDUAL_SIGNATURE, _nrt=False)
    def other_residual(par, peak):  # type: ignore[no-untyped-def]
        sphere, flat = residual(par, peak)
        return flat, sphere

    return own._replace(residual=other_residual)
