"""What the design `robustness` shows: how many random pairs are solved, and how well balanced.

    dentscope campaign run --design robustness --out build/robustness
    .venv/bin/python tools/benchmarks/robustness.py [build/robustness [robustness-hardening]]

Pairs of a scrambled Sobol sequence with a fixed seed over the solver's stated range, at the level
`quick`. Printed: how many reach Delta/R = 0.1, how the others end, the largest defect of each
path's energy, and contact force against reaction from Delta/R = 1e-3 on and below it.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from dentscope.campaigns import design_named, read_curves, status_of
from dentscope.campaigns.store import Store

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "build/robustness")
store = Store(folder)
design = sys.argv[2] if len(sys.argv) > 2 else "robustness"
status = status_of(design_named(design), store)
records = read_curves(folder)
rows = []
for record in records:
    c = record.curve
    D = c["delta"] / record.case.pair.R
    off = np.abs(c["force_defect"])
    rows.append(
        (
            D[-1], 100.0 * np.max(np.abs(c["energy_defect"])),
            np.max(off[D >= 1e-3], initial=0.0), np.max(off[D < 1e-3], initial=0.0),
        )
    )  # fmt: skip
depth, energy, force, floor = np.array(rows).T
cpu = np.array([s.cpu_s for s in store.summaries()])
lines = [
    f"{status.done} of {status.designed} done, {status.failed} failed, {status.missing} missing; "
    f"{np.sum(depth > 0.1 - 1e-9)} reach Delta/R = 0.1",
    f"energy defect: median {np.median(energy):.2f} %, 90 % of the cases below "
    f"{np.quantile(energy, 0.9):.2f} %, largest {energy.max():.2f} %, above 0.5 % in "
    f"{np.sum(energy > 0.5)}",
    f"contact force against reaction: from Delta/R = 1e-3 on median {np.median(force):.1e}, "
    f"largest {force.max():.1e}, above 1e-6 in {np.sum(force > 1e-6)}; below, "
    f"largest {floor.max():.1e}",
    f"processor time: median {np.median(cpu):.0f} s a case, {cpu.sum() / 3600.0:.1f} h in all",
    *(f"{r.case.name}: {r.message}" for r in records if r.message),
]
sys.stdout.write("\n".join(lines) + "\n")
