"""Stage discrepancy: what physics is missing in a simulation that recordings do not match.

`from dentscope.discrepancy import diagnose`; the main path is in `verdict.py`.
"""

from __future__ import annotations

from ..dynamics.mechanisms import MECHANISMS, Mechanism, Parameter, Surroundings
from .findings import Verdict
from .verdict import diagnose

__all__ = ["MECHANISMS", "Mechanism", "Parameter", "Surroundings", "Verdict", "diagnose"]
