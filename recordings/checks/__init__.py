"""Audit of a recording set: whether its numbers agree with each other and with mechanics."""

from __future__ import annotations

from .findings import Finding, Severity
from .report import Audit, audit

__all__ = ["Audit", "Finding", "Severity", "audit"]
