"""Load against depth of a machine, read, measured and drawn."""

from __future__ import annotations

from pathlib import Path

from ..measured import Measured, labelled, labels
from ..pictures import drawn_if_refused
from ..reduced import Reduced
from .columns import read_press
from .options import PressOptions
from .picture import draw_press
from .reduction import reduce_press


def reduce(path: Path, options: PressOptions) -> Reduced:
    """Measure the presses of a record."""
    record = read_press(path, options)
    given, std = options.machine_compliance_m_N, options.machine_compliance_m_N_std
    with drawn_if_refused(1e6 * record.depth, record.load, axes=("depth [um]", "load [N]")):
        found = reduce_press(
            record, load_std=options.load_std_N,
            compliance=None if given is None else Measured(given, std),
        )  # fmt: skip
    rows = [p for p in found.presses if p.cycle.beyond and p.cycle.least < 1.0]
    rows = rows if options.cycles == "each" else [found.largest]
    names = labels(len(rows), "press")
    values = labelled(zip(names, (p.values() for p in rows), strict=True))
    values["contact_zero_m"] = found.zero
    if found.compliance is not None:
        values["machine_compliance_m_N"] = found.compliance
    notes = found.notes
    if len(rows) > 1:
        notes += ("the rows have the zero of contact and the machine's compliance in common",)
    return Reduced(
        source=path, values=values, notes=notes,
        trials=tuple(found.trial(p, n) for p, n in zip(rows, names, strict=True)),
        draw=lambda to: draw_press(found, to),
    )  # fmt: skip
