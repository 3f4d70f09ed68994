"""A metal from its marks: the flow curve of what is dented, and its rate, with their errors."""

from __future__ import annotations

from .estimate import Metal, metal_of
from .files import write_metal
from .text import lines

__all__ = ["Metal", "lines", "metal_of", "write_metal"]
