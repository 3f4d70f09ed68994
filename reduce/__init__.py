"""Stage reduce: from raw files of an instrument to trials with uncertainties.

A reader of one's own returns a `Reduced`, of `Row`s of `Trial`s of `Measured` numbers.
"""

from .measured import Measured, Trial
from .output.row import Row
from .reduced import Reduced

__all__ = ["Measured", "Reduced", "Row", "Trial"]
