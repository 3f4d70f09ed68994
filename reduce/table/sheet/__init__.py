"""A laboratory's sheet: a row a drop or a press, headers in its own words, units there or in cells.

Every column and every cell that is not taken is told: nothing disappears without a line.
"""

from .file import read_balls, read_sheet
from .rows import Sheet

__all__ = ["Sheet", "read_balls", "read_sheet"]
