"""The one name of each kind of array, and numbers as a program gives them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InputError, shortened

Array = NDArray[np.float64]
"""Numbers: of lengths, forces, times in SI, in whatever shape the docstring says."""
Integers = NDArray[np.int64]
"""Counts and codes, and tables of places that are stored."""
Indices = NDArray[np.intp]
"""Places in other arrays."""
Mask = NDArray[np.bool_]
"""True where something holds."""


def numbers(given: ArrayLike, *, key: str, allowed: str, source: str = "") -> Array:
    """Return numbers, one or several, as an array of their shape.

    Raises `InputError`: text such as "20 um", `True`, a masked value, or what else is no number.

    Examples
    --------
    >>> numbers("20 um", key="depth", allowed="depths [m]")
    Traceback (most recent call last):
    dentscope.core.errors.InputError: depth: '20 um' (allowed: depths [m])
    """
    masked = any(map(np.ma.is_masked, given if isinstance(given, list | tuple) else (given,)))
    try:
        found = np.asarray(None if masked else given)  # numpy would take what a mask hides
        right = found.dtype.kind in "iuf"
    except ValueError:  # rows of several lengths
        right = False
    if not right:
        raise InputError(shortened(repr(given), 80), key=key, allowed=allowed, source=source)
    return found.astype(float)  # a copy: a series of pandas cannot be written to


def one_number(given: object, *, key: str, allowed: str = "one number", source: str = "") -> float:
    """Return one number; refuse several, and what `numbers` refuses."""
    found = numbers(given, key=key, allowed=allowed, source=source)  # type: ignore[arg-type]
    if found.ndim:
        raise InputError(shortened(repr(given), 80), key=key, allowed=allowed, source=source)
    return float(found)
