"""The same cases in CalculiX, an independent code."""

from __future__ import annotations

import shutil
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .... import fem
from ....campaigns.case import Case
from ....campaigns.cases.pairs import pair_of
from ..bench import Bench, Effort, Solved
from ..calculix import Deck, Reference, load_reference, run_deck
from ..curves import inner, smoothed
from ..result import Measurement, Result, Table

Floats = npt.NDArray[np.float64]

_DEEPEST = 0.01


@dataclass(frozen=True)
class Twin:
    """A case that is solved by both codes."""

    name: str
    ratio: float
    element: str
    accuracy: fem.Accuracy
    steps: int

    @property
    def case(self) -> Case:
        """Our case; its depths are the steps of the deck."""
        pair = pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=self.ratio)
        depths = fem.geometric_depths(0.3 * fem.critical_depth(pair), _DEEPEST, self.steps)
        return Case(self.name, fem.ContactProblem(pair, depths), self.accuracy)

    @property
    def deck(self) -> Deck:
        """The same for CalculiX."""
        return Deck(self.case.problem, self.accuracy, element=self.element)


def twins_of(effort: Effort) -> tuple[Twin, ...]:
    """Return what both codes solve at an effort."""
    # as many steps as ours take: the radial return of CalculiX is first order in the step
    if effort is Effort.QUICK:
        accuracy, steps = fem.Accuracy.smoke(), 90
    else:
        accuracy, steps = fem.Accuracy.production(), 160
    return (
        Twin(f"equal-strengths-{accuracy.level}", 1.0, "CAX4", accuracy, steps),
        Twin(f"strong-sphere-{accuracy.level}", 10.0, "CAX4", accuracy, steps),
    )


def run(bench: Bench) -> Result:
    """Compare F, a and delta_s* on the same mesh; CalculiX runs where its results are not kept."""
    measurements: list[Measurement] = []
    tables, rows = [], []
    for twin in twins_of(bench.effort):
        name, case = twin.name, twin.case
        theirs = load_reference(twin.deck, name=name)
        if theirs is None:
            if shutil.which("ccx") is None:
                bench.say(f"  {name}: no results kept and CalculiX is not installed")
                continue
            bench.say(f"  {name}: running CalculiX")
            theirs = run_deck(twin.deck, name=name)
        ours = bench.solve(case)
        found, table = _compared(name, ours, theirs)
        measurements += found
        if len(theirs.delta) == twin.steps:
            ratio = theirs.cpu_s / ours.counters["cpu_s"]
            measurements.append(
                Measurement(f"{name}: processor time of CalculiX over ours", ratio, "", 5.0, None,
                            "requirement")
            )  # fmt: skip
        tables.append(table)
        rows.append(
            (name, f"{theirs.version}, {twin.element}", twin.accuracy.level, theirs.unknowns,
             f"{len(theirs.delta)} of {twin.steps}",
             f"{theirs.cpu_s:.0f}", f"{ours.counters['cpu_s']:.0f}",
             f"{theirs.cpu_s / ours.counters['cpu_s']:.1f}"
             if len(theirs.delta) == twin.steps else "stopped")
        )  # fmt: skip
    return Result(
        name="independent-code",
        title="An independent code: CalculiX",
        about=(
            "E = 200 GPa, nu = 0.3, weaker body 503 MPa. Our mesh written out as a deck: four-node "
            "elements (CAX4), face-to-face penalty contact without smoothing, isotropic "
            "plasticity, automatic sub-steps. Contact radius and shares are "
            "measured from the printed displacements in the same way as ours. Decks (`*.inp.gz`) "
            "and printed output (`*.dat.gz`) are in verification/calculix."
        ),
        measurements=tuple(measurements),
        tables=(
            *tables,
            Table(
                "Cost, processor seconds",
                ("case", "CalculiX", "mesh", "unknowns", "depths", "CalculiX", "ours", "ratio"),
                tuple(rows),
            ),
        ),
        notes=(
            "Rms differences are over all depths beyond first yield, ripple of both codes "
            "included (elements at the contact edge: `production` 0.025 a, `smoke` 0.1 a). "
            "The depths are the steps of both codes; CalculiX returns radially to the yield "
            "surface, which is of first order in the step. `ccx` of the Debian package solves "
            "with Spooles.",
        ),
    )


def _compared(name: str, ours: Solved, theirs: Reference) -> tuple[tuple[Measurement, ...], Table]:
    n = min(len(theirs.delta), len(ours["delta"]))
    R = ours.pair.R
    depth = theirs.delta[:n]
    force = theirs.force[:n] * 1e6 * R**2
    off_f = ours["force"][:n] / force - 1.0
    off_a = ours["radius"][:n] / R / theirs.radius[:n] - 1.0
    off_s = ours.share[:n] - theirs.share[:n]
    plastic = depth > fem.critical_depth(ours.pair)
    away = plastic & inner(depth)
    plain_f, plain_a = (smoothed(depth, np.log1p(off))[away] for off in (off_f, off_a))
    rows = tuple(
        (f"{depth[k]:.3e}", f"{ours['force'][k]:.4g}", f"{force[k]:.4g}",
         f"{100.0 * off_f[k]:+.2f} %", f"{ours['radius'][k] / R:.4f}", f"{theirs.radius[k]:.4f}",
         f"{100.0 * off_a[k]:+.2f} %", f"{ours.share[k]:.4f}", f"{theirs.share[k]:.4f}")
        for k in range(0, n, max(1, n // 9))
    )  # fmt: skip
    source = f"CalculiX, {theirs.version}, {theirs.element}"
    measurements = (
        Measurement(f"{name}: F, mean difference", 100.0 * float(off_f[plastic].mean()), "%", -1.0,
                    1.0, source),
        Measurement(f"{name}: F, largest difference, ripple smoothed out",
                    100.0 * float(np.abs(plain_f).max()), "%", None, 1.0, source),
        Measurement(f"{name}: a, largest difference, ripple smoothed out",
                    100.0 * float(np.abs(plain_a).max()), "%", None, 1.0, source),
        Measurement(f"{name}: F, rms difference", 100.0 * _rms(off_f[plastic]), "%", None, 1.0,
                    source),
        Measurement(f"{name}: a, rms difference", 100.0 * _rms(off_a[plastic]), "%", None, 1.0,
                    source),
        Measurement(f"{name}: delta_s*, rms difference", _rms(off_s[plastic]), "", None, 0.005,
                    source),
    )  # fmt: skip
    table = Table(
        f"{name}, ours against CalculiX {theirs.element}",
        ("Delta/R", "F [N]", "CalculiX", "difference", "a/R", "CalculiX", "difference",
         "delta_s*", "CalculiX"),
        rows,
    )  # fmt: skip
    return measurements, table


def _rms(x: Floats) -> float:
    return float(np.sqrt(np.mean(x**2)))
