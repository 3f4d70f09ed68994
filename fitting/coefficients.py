"""The coefficients file: values, standard errors, covariance, domain and where they come from.

`fitting` writes it and `models.coefficients` reads it as data; nothing else carries a coefficient.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from ..campaigns import digest_of_source
from ..core.arrays import Array
from ..core.output import write_file
from ..core.provenance import environment
from ..fem import NUMERICS_VERSION
from ..models.closed_form import COEFFICIENTS
from ..models.coefficients import FORMAT
from ..models.correction import CHANNELS, GROUPS
from ..models.hardening import CORRECTED
from .hardening import HardeningFit
from .laws import FittedLaws
from .table import Sources, Table


def coefficients_content(laws: FittedLaws, table: Table, campaigns: Sources) -> dict[str, Any]:
    """Return the content of the file: the laws, the rows and campaigns that they are from."""
    fit, correction = laws.fit, laws.correction
    judged = {"compact": laws.compact, "fitted": laws.fitted}
    return {
        "format": FORMAT,
        "form": "docs/closed-form.md",
        "coefficients": {
            name: {"value": value, "standard_error": error}
            for name, value, error in zip(
                COEFFICIENTS, fit.values.tolist(), fit.standard_errors.tolist(), strict=True
            )
        },
        "covariance": _digits(fit.covariance),
        "correction": {
            "groups": list(GROUPS),
            "channels": list(CHANNELS),
            "reaches": correction.reaches.tolist(),
            "centres": _digits(correction.centres),
            "weights": _digits(correction.weights),
        },
        "errors": {
            name: {"fitted": asdict(law.errors), "left_out": asdict(law.held_out)}
            for name, law in judged.items()
        },
        "uncertainty": {
            name: {**law.calibration.content(), "within": law.within}
            for name, law in judged.items()
        },
        "domain": {"limits": limits_of(table), "combinations": len(table.pairs)},
        "provenance": _made_from(campaigns),
    }


def _made_from(campaigns: Sources) -> dict[str, Any]:
    return {
        "campaigns": [
            {
                "sha256": digest_of_source(path),
                "accuracy": sorted({record.case.accuracy.level for record in records}),
            }
            for path, records in campaigns.items()
        ],
        "numerics_version": NUMERICS_VERSION,
        "environment": environment(),
    }


def hardening_content(
    fit: HardeningFit, campaigns: Sources, *, judged: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the part of the coefficients file on metals that harden.

    `judged` is, by design that no fit reads, errors and shares within the stated deviations.
    """
    found = fit.correction
    return {
        "combinations": fit.combinations,
        "corrected": list(CORRECTED),
        "low": found.low.tolist(),
        "high": found.high.tolist(),
        "weights": _digits(found.weights),
        "spread": {name: float(f"{size:.3g}") for name, size in found.spread.items()},
        "left_out": fit.left_out,
        "judged": judged,
        "provenance": _made_from(campaigns),
    }


def _digits(rows: Array) -> list[list[float]]:
    return [[float(f"{x:.6g}") for x in row] for row in rows]


def limits_of(table: Table) -> dict[str, list[float]]:
    """Smallest and largest value of what the domain is stated in, over the fitted rows."""
    nus = [b.nu for p in table.pairs for b in (p.sphere, p.flat) if not b.rigid]
    columns = {
        "Sy_ratio": [p.Sy_ratio for p in table.pairs],
        "E_reduced_over_Sy_min": [p.E_reduced / p.Sy_min for p in table.pairs],
        "nu": nus,
        "elastic_share": [p.elastic_share for p in table.pairs],
        "Delta_over_R": [0.0, float(table.D.max())],
        "a_over_R": [0.0, float(table.radius.max())],
    }
    return {k: [float(np.min(v)), float(np.max(v))] for k, v in columns.items()}


def write_coefficients(content: dict[str, Any], path: Path) -> Path:
    """Write the file as a whole or not at all; return it."""
    return write_file(path, _rows_on_one_line(json.dumps(content, indent=1)) + "\n")


def _rows_on_one_line(text: str) -> str:
    """Put each innermost list of numbers on a line of its own."""
    return re.sub(
        r"\[\s+([-+0-9.eE,\s]+?)\s+\]",
        lambda m: "[" + ", ".join(m.group(1).replace(",", " ").split()) + "]",
        text,
    )
