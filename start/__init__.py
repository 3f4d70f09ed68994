"""What a newcomer calls: one's own pair by finite elements, a diagnosis.

Each takes the file that the command of the same name takes, and returns something that shows
itself in a notebook, plots itself and gives a data frame; so does `dentscope.impact(...)`.
"""

from __future__ import annotations

from .diagnosis import Diagnosis, diagnose
from .pair import Solved, case

__all__ = ["Diagnosis", "Solved", "case", "diagnose"]
