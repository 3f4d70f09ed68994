"""Reading JSON files that may come from somebody else."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..errors import InputError
from .input_file import read_bytes


def read_json(path: Path, *, most: int, allowed: str) -> Any:
    """Return the content of a JSON file, checked as `checked_file` does."""
    content = read_bytes(path, most=most, allowed=allowed)
    try:
        return json.loads(content.decode())
    except RecursionError:
        raise InputError("nested too deep", source=str(path), allowed=allowed) from None
    except ValueError as error:  # also of text that is not UTF-8, and of numbers of 5000 digits
        raise InputError(f"not valid JSON ({error})", source=str(path), allowed=allowed) from None
