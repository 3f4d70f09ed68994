"""Stage fitting: closed forms fitted to a campaign, their errors and report; see `refit.py`."""

from __future__ import annotations

from .fit import fit_tables
from .table import read_sources, tables_of

__all__ = ["fit_tables", "read_sources", "tables_of"]
