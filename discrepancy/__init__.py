"""Stage discrepancy: what physics is missing in a simulation that recordings do not match."""

from .mechanisms import MECHANISMS, Mechanism, Parameter
from .verdict import Verdict, diagnose

__all__ = ["MECHANISMS", "Mechanism", "Parameter", "Verdict", "diagnose"]
