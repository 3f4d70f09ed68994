"""The metal's files: a flow curve that a recording set takes, its covariance, a picture."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import norm

from ...core.inputs.flow_curve import COLUMNS
from ...core.output import csv_text, figure, write_figure, write_file
from ..correction import LEVEL
from .estimate import Metal
from .flow import REACH, STRAINS
from .next_mark import TOLD

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# limit: rows of an inferred curve in a file [-]: a screen
_CURVE_ROWS = 12


def curve_strains(metal: Metal) -> np.ndarray:
    """Return the plastic strains of the written curve: none, then 0.2 % to what a mark reaches."""
    last = REACH * max(metal.covered[1], STRAINS[0])
    return np.append(0.0, np.geomspace(STRAINS[0], last, _CURVE_ROWS))


def content_of(metal: Metal) -> dict[str, Any]:
    """Return the content of metal.json."""
    rise = metal.rise if metal.rated else None
    return {
        "format": "metal/1", "set": metal.name, "body": metal.body, "level": LEVEL,
        "stress_Pa": {
            f"{x:g}": dict(zip(("value", "low", "high"), metal.stress_at(x), strict=True))
            for x in TOLD
        },
        "rise_at_1000_per_s": rise and dict(zip(("value", "low", "high"), rise, strict=True)),
        "strains_of_marks": list(metal.covered), "notes": list(metal.notes),
        "next_mark": metal.next and {
            "striker": metal.next.striker, "load_N": metal.next.load,
            "error_before": list(metal.next.before), "error_after": list(metal.next.after),
        },
    }  # fmt: skip


def write_metal(metal: Metal, out: Path) -> list[Path]:
    """Write flow_curve.csv, flow_curve_covariance.csv, metal.json and metal.png.

    The covariance is of ln stress, a row a strain of the curve.
    """
    strains = curve_strains(metal)
    mean, cov = metal.log_stress(strains)
    rows = [[f"{x:.6g}", f"{math.exp(y):.6g}"] for x, y in zip(strains, mean, strict=True)]
    head = [f"{x:.6g}" for x in strains]
    return [
        write_file(out / "flow_curve.csv", csv_text(rows, header=COLUMNS[:2])),
        write_file(
            out / "flow_curve_covariance.csv",
            csv_text([[f"{x:.15g}" for x in row] for row in cov], header=head),
        ),
        write_file(out / "metal.json", json.dumps(content_of(metal), indent=1) + "\n"),
        write_figure(picture_of(metal), out / "metal.png", dpi=150),
    ]


def picture_of(metal: Metal) -> Figure:
    """Return the curve with its band, and where the marks lie on it."""
    strains = np.geomspace(STRAINS[0], STRAINS[-1], 60)
    mean, cov = metal.log_stress(strains)
    reach = norm.ppf(0.5 + 0.5 * LEVEL) * np.sqrt(np.diag(cov))
    made, ((axis,),) = figure(1, 1, size=(5.6, 4.2))
    percent = 100.0 * strains
    low, high = (1e-6 * np.exp(mean + k * reach) for k in (-1.0, 1.0))
    axis.fill_between(percent, low, high, alpha=0.2, lw=0.0, label=f"{LEVEL:.0%} band")
    axis.plot(percent, 1e-6 * np.exp(mean), label="flow curve")
    for pressed, marker, label in ((True, "o", "presses"), (False, "s", "impacts, at their rate")):
        here = metal.press == pressed
        if here.any():
            axis.errorbar(
                100.0 * metal.strain[here], 1e-6 * metal.stress[here],
                1e-6 * metal.stress[here] * metal.error[here], fmt=marker, ms=4, label=label,
            )  # fmt: skip
    for end in metal.covered:
        axis.axvline(100.0 * end, color="0.6", lw=0.8, ls=":")
    axis.set(
        xscale="log", xlabel="representative plastic strain [%]", ylabel="true stress [MPa]",
        ylim=(0.0, None), title=f"{metal.name}: {metal.body}",
    )  # fmt: skip
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)
    return made
