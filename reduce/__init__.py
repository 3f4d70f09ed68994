"""Stage reduce: from raw files of an instrument to trials with uncertainties.

A reader of one's own is a module with `ABOUT`, one line; `Options`, an `InputTable` whose fields
are the options of its command; and `reduce(path, options)`, which returns a `Reduced`: `Trial`s of
`Measured` numbers.
"""

from ..core.inputs.toml_input import InputTable
from .measured import Measured, Trial
from .reduced import Reduced

__all__ = ["InputTable", "Measured", "Reduced", "Trial"]
