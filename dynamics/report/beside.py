"""How far off a law is: as it states, or as far as it is from the fitted law."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.material import Pair
from ...models import law_named
from ...models.base import ContactLaw, unwarned
from ...models.fitted import ClosedForm
from ...models.turned import as_made
from ...models.uncertainty import Uncertainty


def error_of(law: ContactLaw, pair: Pair, depth: Array) -> Uncertainty:
    """How far `law` may be off, by itself or, where it states no error, by the fitted law."""
    law, pair = as_made(law, pair)
    with unwarned(), np.errstate(all="ignore"):
        try:
            return law.uncertainty(pair, depth)
        except InputError:  # a published law
            return beside_fitted(law, pair, depth)


def beside_fitted(law: ContactLaw, pair: Pair, depth: npt.ArrayLike) -> Uncertainty:
    """How far `law` may be off: its distance from the fitted law, and that law's own error.

    A law without a share of its own is taken to divide the approach as elastic bodies do.
    """
    fitted = law_named("fitted")
    assert isinstance(fitted, ClosedForm)
    d = np.asarray(depth, dtype=float)
    own = fitted.uncertainty(pair, d)
    ours, theirs = (_answers(one, pair, d) for one in (fitted, law))
    away = [np.abs(np.log(a / b)) for a, b in zip(theirs, ours, strict=True)]
    split = getattr(law, "share", None)
    share = split(pair, d) if split else np.full(d.shape, pair.elastic_share)
    away.insert(2, np.abs(share - fitted.share(pair, d)))
    return Uncertainty(*(np.hypot(a, b) for a, b in zip(away, own, strict=True)))


_X, _W = np.polynomial.legendre.leggauss(12)


def _answers(law: ContactLaw, pair: Pair, d: Array) -> tuple[Array, Array, Array, Array]:
    """Force, radius, dent and energy given back over force and depth: above zero, or NaN."""
    closed = np.maximum(d, 1e-12 * pair.R)
    force = law.loading(pair, closed)
    left = np.asarray(sum(law.residual(pair, closed)))
    from_ = np.where(np.isfinite(left), left, closed)  # far beyond its range a law says nothing
    back = np.zeros_like(closed)
    for x, w in zip(0.5 * (_X + 1.0), 0.5 * _W, strict=True):
        back += w * law.unloading(pair, from_ + x * (closed - from_), closed)
    back *= (closed - left) / (force * closed)
    # a dent below a hundredth of a per mille of the depth is none
    return (
        force, law.contact_radius(pair, closed), np.maximum(left, 1e-5 * closed),
        np.maximum(back, 1e-9),
    )  # fmt: skip
