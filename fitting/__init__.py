"""Stage fitting: closed forms fitted to a campaign, their errors and report; see `refit.py`."""

from __future__ import annotations

from .fit import FormFit, fit_tables
from .laws import FittedLaws, fit_laws
from .prediction import Errors
from .table import ResidualTable, Table, read_sources, tables_of

__all__ = [
    "Errors",
    "FormFit",
    "FittedLaws",
    "ResidualTable",
    "Table",
    "fit_laws",
    "fit_tables",
    "read_sources",
    "tables_of",
]
