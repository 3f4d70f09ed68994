"""A law in a file: the table of one pair, or the coefficients that `dentscope fit` wrote."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..core.errors import InputError
from ..core.inputs.json_input import read_json
from .base import ContactLaw
from .coefficients import hardening_correction, laws_from
from .hardening import hardening_law
from .table_file import MOST_BYTES, table_from

KINDS = ("compact", "fitted", "hardening")
"""Laws that a file of coefficients holds."""

_ALLOWED = "law.json of `dentscope case`, or fitted.json of `dentscope fit`"


def is_file(name: str) -> bool:
    """Whether a law's name is that of a file or folder."""
    return name.partition(".json:")[0] != name or name.endswith(".json") or "/" in name


def read_law(name: str) -> ContactLaw:
    """Read a law by the name of its file, or refuse one that is missing or damaged.

    law.json of `dentscope case`, or the folder that holds it; or a file of coefficients, whose law
    is `fitted` unless the name ends in `:compact` or `:hardening`.
    """
    base, chosen, kind = name.partition(".json:")
    path = Path(f"{base}.json" if chosen else name)
    file = path / "law.json" if path.is_dir() else path
    content = read_json(file, most=MOST_BYTES, allowed=_ALLOWED)
    if isinstance(content, dict) and "coefficients" in content:
        return _closed_form(content, kind or "fitted", name=name, source=str(file))
    if chosen:
        raise InputError(f"no file of coefficients: it has no {kind!r}", source=str(file))
    return table_from(content, source=str(file), name=name)


def _closed_form(content: Mapping[str, Any], kind: str, *, name: str, source: str) -> ContactLaw:
    if kind not in KINDS:
        raise InputError(f"{kind!r}", source=source, key="law", allowed=", ".join(KINDS))
    try:
        compact, fitted = laws_from(content, source=source)
        if kind == "hardening":
            hard = hardening_law(fitted, hardening_correction(content, source=source))
            return replace(hard, name=name)
    except InputError:
        raise
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        raise InputError(
            f"damaged ({' '.join(str(error).split())[:200]})", source=source, allowed=_ALLOWED
        ) from None
    return replace(compact if kind == "compact" else fitted, name=name, source=source)
