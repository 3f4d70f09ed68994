"""The one name of each kind of array."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Numbers: of lengths, forces, times in SI, in whatever shape the docstring says."""
Integers = NDArray[np.int64]
"""Counts and codes, and tables of places that are stored."""
Indices = NDArray[np.intp]
"""Places in other arrays."""
Mask = NDArray[np.bool_]
"""True where something holds."""
