"""Stage fitting: closed forms fitted to a campaign."""

from __future__ import annotations

from .coefficients import coefficients_content, write_coefficients
from .fit import Errors, Fit, fit_tables
from .table import ResidualTable, Table, read_tables

__all__ = [
    "Errors",
    "Fit",
    "ResidualTable",
    "Table",
    "coefficients_content",
    "fit_tables",
    "read_tables",
    "write_coefficients",
]
