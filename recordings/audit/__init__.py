"""Audit of a recording set: whether its numbers agree with each other and with mechanics."""

from __future__ import annotations

from .audit import Audit, audit
from .findings import Finding, Severity

__all__ = ["Audit", "Finding", "Severity", "audit"]
