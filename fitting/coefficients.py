"""The coefficients file: values, standard errors, covariance, domain and where they come from.

`fitting` writes it and `models.fitted` reads it as data; nothing else carries a coefficient.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..core.provenance import environment, file_digest
from ..fem import NUMERICS_VERSION
from ..models.fitted import NAMES
from .fit import Fit
from .table import Table

FORMAT = "dentscope-coefficients/1"


def coefficients_content(fit: Fit, table: Table, campaign: Path) -> dict[str, Any]:
    """Return the content of the coefficients file."""
    ratios, moduli = table.ratio, table.modulus
    return {
        "format": FORMAT,
        "form": "docs/closed-form.md",
        "coefficients": {
            name: {"value": value, "standard_error": error}
            for name, value, error in zip(
                NAMES, fit.values.tolist(), fit.standard_errors.tolist(), strict=True
            )
        },
        "covariance": fit.covariance.tolist(),
        "errors": {"fitted": asdict(fit.errors), "held_out": asdict(fit.held_out)},
        "domain": {
            "Sy_ratio": [float(ratios.min()), float(ratios.max())],
            "E_reduced_over_Sy_min": [float(moduli.min()), float(moduli.max())],
            "Delta_over_R_max": float(table.D.max()),
            "combinations": len(table.pairs),
            "note": f"Sy* {ratios.min():.3g} to {ratios.max():.3g}, E'/Sy_min {moduli.min():.0f} "
            f"to {moduli.max():.0f}, Delta/R up to {table.D.max():.3g}",
        },
        "provenance": {
            "campaign_sha256": file_digest(campaign),
            "numerics_version": NUMERICS_VERSION,
            "accuracy": sorted({record for record in _levels(campaign)}),
            "environment": environment(),
        },
    }


def write_coefficients(content: dict[str, Any], path: Path) -> None:
    """Write the file as a whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_suffix(".tmp")
    draft.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    draft.replace(path)


def _levels(campaign: Path) -> list[str]:
    from ..campaigns import read_curves

    return [record.case.accuracy.level for record in read_curves(campaign)]
