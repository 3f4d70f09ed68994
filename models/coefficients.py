"""The laws of data/coefficients/fitted.json, which `dentscope fit` writes."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputError
from ..core.provenance import file_digest
from .base import ContactLaw
from .closed_form import COEFFICIENTS
from .correction import CHANNELS, GROUPS, PairCorrection
from .fitted import ClosedForm, closed_form_law
from .hardening import CORRECTED, HardeningCorrection, hardening_law
from .uncertainty import Calibration

FORMAT = "dentscope-coefficients/12"
COEFFICIENTS_FILE = Path(__file__).resolve().parents[1] / "data" / "coefficients" / "fitted.json"
"""What the laws in use read; `dentscope fit --publish` writes it."""


def read_coefficients() -> dict[str, Any] | None:
    """Content of the shipped coefficients file; none if there is none yet."""
    file = COEFFICIENTS_FILE
    return json.loads(file.read_text("utf-8")) if file.is_file() else None


def drawn_from() -> str:
    """Checksum by which the coefficients of perfectly plastic bodies draw pairs that judge them.

    The file's own; a fit of metals that harden alone leaves those coefficients and keeps theirs.
    """
    kept = (read_coefficients() or {}).get("drawn_from")
    return str(kept) if kept else file_digest(COEFFICIENTS_FILE)


def laws_from(content: Mapping[str, Any], *, source: str) -> tuple[ClosedForm, ClosedForm]:
    """Return the compact and the fitted law of a coefficients file's content.

    One of another form, or that lacks a number, is refused.
    """
    found = content.get("format")
    if found != FORMAT:
        raise InputError(
            f"format {found!r}", source=source, key="format",
            allowed=f"{FORMAT}; make the file anew with `dentscope fit --publish`",
        )  # fmt: skip
    missing = sorted(set(COEFFICIENTS) - set(content["coefficients"]))
    if missing:
        raise InputError(
            f"no {', '.join(missing)}", source=source, key="coefficients",
            allowed="every coefficient of the form; make the file anew with `dentscope fit`",
        )  # fmt: skip
    values = {name: float(content["coefficients"][name]["value"]) for name in COEFFICIENTS}
    limits = {k: (float(v[0]), float(v[1])) for k, v in content["domain"]["limits"].items()}
    spread = content["uncertainty"]
    return (
        closed_form_law(
            values, limits=limits, calibration=Calibration.from_content(spread["compact"])
        ),
        closed_form_law(
            values, correction=_correction(content["correction"], source), limits=limits,
            calibration=Calibration.from_content(spread["fitted"]),
        ),
    )  # fmt: skip


def _correction(content: Mapping[str, Any], source: str) -> PairCorrection:
    for key, names in (("channels", tuple(CHANNELS)), ("groups", GROUPS)):
        _check_names(content[key], names, key=f"correction.{key}", source=source)
    return PairCorrection(
        *(np.array(content[key], dtype=float) for key in ("centres", "reaches", "weights"))
    )


def _check_names(found: Sequence[str], names: tuple[str, ...], *, key: str, source: str) -> None:
    if tuple(found) != names:
        raise InputError(
            ", ".join(found), source=source, key=key,
            allowed=f"{', '.join(names)}; make the file anew with `dentscope fit`",
        )  # fmt: skip


def shipped_laws() -> tuple[ContactLaw, ...]:
    """Compact, fitted and hardening, with the shipped numbers; none if they were never fitted."""
    content = read_coefficients()
    if content is None:
        return ()
    source = str(COEFFICIENTS_FILE)
    compact, fitted = laws_from(content, source=source)
    return compact, fitted, hardening_law(fitted, hardening_correction(content, source=source))


def hardening_correction(content: Mapping[str, Any], *, source: str) -> HardeningCorrection | None:
    """Return what a coefficients file adds for metals that harden; none if it knows none.

    One that corrects other quantities than this law does is refused.
    """
    found = content.get("hardening")
    if found is None:
        return None
    _check_names(found["corrected"], CORRECTED, key="hardening.corrected", source=source)
    return HardeningCorrection(
        np.array(found["low"]), np.array(found["high"]), np.array(found["weights"]),
        {name: float(size) for name, size in found["spread"].items()},
    )  # fmt: skip
