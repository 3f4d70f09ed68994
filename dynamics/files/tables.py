"""Results as rows: what the commands print, and CSV and HDF5 files with units in every name."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from ...core.observables import OBSERVABLES
from ...core.output import write_file
from ...core.provenance import environment
from ..integrate import Trace
from ..result import Impact
from ..stepping.layout import HISTORY

SHOWN = (
    *((o.label, o.simulated, o.scale, o.unit) for o in OBSERVABLES.values() if o.simulated),
    ("kinetic restitution", "kinetic_restitution", 1.0, "-"),
    ("energetic restitution", "energetic_restitution", 1.0, "-"),
    ("tangential restitution", "tangential_restitution", 1.0, "-"),
    ("residual depth, tip", "residual_sphere_m", 1e6, "um"),
    ("mean force", "mean_force_N", 1e-3, "kN"),
    ("travel on the flat", "scar_travel_m", 1e6, "um"),
    ("kept by the contact", "contact_work_J", 1e3, "mJ"),
    ("lost to friction", "friction_work_J", 1e3, "mJ"),
    ("in vibration", "modal_energy_J", 1e3, "mJ"),
    ("given to the support", "support_energy_J", 1e3, "mJ"),
    ("contacts", "contacts", 1.0, "-"),
    ("energy balance", "energy_residual", 1.0, "-"),
    ("momentum balance", "momentum_residual", 1.0, "-"),
)

EXACT = ("contacts", "energy_residual", "momentum_residual")
"""What has no standard deviation: counts, and what a balance leaves over."""


def impact_row(impact: Impact) -> dict[str, Any]:
    """Return one impact as a row: observables, nan where a budget ended it, counts and ending."""
    numbers = {**impact.observables, "mean_force_N": impact.mean_force_N}
    return {
        **(numbers if impact.outcome.completed else dict.fromkeys(numbers, math.nan)),
        "contacts": impact.contacts,
        "stuck": impact.stuck,
        "outcome": impact.outcome.ending.value,
    }


def write_hdf5(
    path: Path, traces: Mapping[str, Trace], *, about: Mapping[str, str] | None = None
) -> None:
    """Write histories and observables, a group for each law, units in names; `about`: texts."""
    stream = io.BytesIO()
    with h5py.File(stream, "w") as store:
        store.attrs.update({**environment(), **(about or {})})
        for law, trace in traces.items():
            group = store.create_group(law)
            for i, name in enumerate(HISTORY):
                group.create_dataset(name, data=np.ascontiguousarray(trace.history[:, i]))
            group.attrs.update(impact_row(trace.impact))
    write_file(path, stream.getvalue())
