"""The same cases in CalculiX, an independent code."""

from __future__ import annotations

import shutil
from dataclasses import dataclass, replace

import numpy as np

from .... import fem
from ....campaigns.case import Case
from ....campaigns.cases.hardening import power_law
from ....campaigns.cases.pairs import pair_of
from ....campaigns.cases.plateau import ASTM_1016, measured
from ....core.arrays import Array
from ....core.flow import Flow
from ....core.material import Pair
from ..bench import Bench, Effort, Solved
from ..calculix.deck import Deck
from ..calculix.output import Reference, load_reference, run_deck
from ..curves import inner, smoothed
from ..result import Cell, Measurement, Result, Table

_DEEPEST = 0.1
_RADII = 0.01  # Delta/R up to which the faceted surfaces of both codes show where they part
_FINER = 3  # times as many increments


@dataclass(frozen=True)
class Twin:
    """A case that is solved by both codes; CalculiX solves it with two sizes of increment."""

    name: str
    pair: Pair
    accuracy: fem.Accuracy
    increments: int

    @property
    def case(self) -> Case:
        """Our case; its depths are the coarser increments."""
        return Case(self.name, fem.ContactProblem(self.pair, self._depths(1)), self.accuracy)

    def deck(self, finer: int) -> Deck:
        """The same for CalculiX, `finer` times as many increments."""
        problem = fem.ContactProblem(self.pair, self._depths(finer))
        return Deck(problem, self.accuracy)

    def _depths(self, finer: int) -> tuple[float, ...]:
        first = 0.3 * self.pair.first_yield
        return fem.geometric_depths(first, _DEEPEST, finer * self.increments + 1)


@dataclass(frozen=True)
class Theirs:
    """What CalculiX gave at the depths of the coarser increments.

    - `force`, `radius`, `share`: [MPa R^2], [R], [-], shape (n,): its first-order error in the
      increment taken off.
    - `increment`: what the finer increments still miss of F, relative, shape (n,).
    - `runs`: the two runs.
    """

    force: Array
    radius: Array
    share: Array
    increment: Array
    runs: tuple[Reference, Reference]


def twins_of(effort: Effort) -> tuple[Twin, ...]:
    """Return what both codes solve at an effort."""
    accuracy = fem.Accuracy.smoke() if effort is Effort.QUICK else fem.Accuracy.quick()
    equal, strong = (
        pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=ratio) for ratio in (1.0, 10.0)
    )
    both = replace(equal, sphere=power_law(equal.sphere, 0.2), flat=power_law(equal.flat, 0.2))
    flat = replace(strong, flat=power_law(strong.flat, 0.35))
    steel = measured(ASTM_1016)
    plateau = replace(strong, flat=replace(strong.flat, Sy=steel.strength, flow=Flow(steel)))
    return tuple(
        Twin(f"{name}-{accuracy.level}", pair, accuracy, 80)
        for name, pair in (
            ("equal-strengths", equal), ("strong-sphere", strong),
            ("both-harden", both), ("flat-hardens", flat), ("flat-has-a-plateau", plateau),
        )
    )  # fmt: skip


def run(bench: Bench) -> Result:
    """Compare F, a and delta_s* on the same mesh; CalculiX runs where its results are not kept."""
    measurements: list[Measurement] = []
    tables: list[Table] = []
    rows: list[tuple[Cell, ...]] = []
    for twin in twins_of(bench.effort):
        theirs = _theirs(bench, twin)
        if theirs is None:
            continue
        ours = bench.solve(twin.case)
        found, table = _compared(twin, ours, theirs)
        measurements += found
        tables.append(table)
        cost = ours.counters["cpu_s"]
        rows.append(
            (twin.name, twin.accuracy.level, theirs.runs[0].unknowns,
             *(f"{len(r.delta)} increments, {r.cpu_s:.0f} s" for r in theirs.runs),
             f"{cost:.0f} s", f"{theirs.runs[0].cpu_s / cost:.1f}")
        )  # fmt: skip
        measurements.append(
            Measurement(f"{twin.name}: processor time of CalculiX, coarser, over ours",
                        theirs.runs[0].cpu_s / cost, "", 5.0, None, "requirement")
        )  # fmt: skip
    return Result(
        title="An independent code: CalculiX",
        about=(
            "E = 200 GPa, nu = 0.3, weaker body 503 MPa, to Delta/R = 0.1: perfectly plastic "
            "pairs of equal strengths and with a sphere ten times as strong, the same with "
            "hardening S = Sy (1 + E p/Sy)^n, and a flat of steel, ASTM 1016, whose tension "
            "curve has a plateau, under the strong sphere. Our mesh, fine all along the path, "
            "written out as a deck: four-node elements (CAX4), face-to-face penalty contact. "
            "Decks (`*.inp.gz`) and printed output (`*.dat.gz`) are in data/reference/calculix."
        ),
        measurements=tuple(measurements),
        tables=(
            *tables,
            Table(
                "Cost, processor seconds",
                ("case", "mesh", "unknowns", "CalculiX", "CalculiX", "ours", "ratio"),
                tuple(rows),
            ),
        ),
        notes=(
            "CalculiX returns radially to the yield surface, which is of first order in the "
            f"increment: what it gives is extrapolated from increments and {_FINER} times as many, "
            "and what the finer ones still miss is stated. Ripple of both codes (elements at the "
            "contact edge: `quick` 0.05 a, `smoke` 0.1 a) is smoothed out; all depths beyond first "
            "yield count. The radius is compared up to Delta/R = "
            f"{_RADII:g}: further on the edge of a dent is steeper than what tells a touching node "
            "from another in CalculiX's displacements. `ccx` of the Debian package solves with "
            "Spooles.",
        ),
    )


def _theirs(bench: Bench, twin: Twin) -> Theirs | None:
    """Run both sizes of increment where they are not kept; nothing without CalculiX."""
    runs = []
    for finer in (1, _FINER):
        deck, name = twin.deck(finer), f"{twin.name}-{finer * twin.increments}"
        found = load_reference(deck, name=name)
        if found is None:
            if shutil.which("ccx") is None:
                bench.say(f"  {name}: no results kept and CalculiX is not installed")
                return None
            bench.say(f"  {name}: running CalculiX")
            found = run_deck(deck, name=name)
        runs.append(found)
    coarse, fine = runs
    n = min(len(coarse.delta), (len(fine.delta) - 1) // _FINER + 1)

    def limit(values: str) -> Array:
        few, many = getattr(coarse, values)[:n], getattr(fine, values)[::_FINER][:n]
        return np.asarray(many + (many - few) / (_FINER - 1.0))

    force = limit("force")
    missed = fine.force[::_FINER][:n] / force - 1.0
    return Theirs(force, limit("radius"), limit("share"), missed, (coarse, fine))


def _compared(twin: Twin, ours: Solved, theirs: Theirs) -> tuple[tuple[Measurement, ...], Table]:
    name, R = twin.name, ours.pair.R
    n = min(len(theirs.force), len(ours["delta"]))
    depth = ours["delta"][:n] / R
    force = theirs.force[:n] * 1e6 * R**2
    off_f = ours["force"][:n] / force - 1.0
    off_a = ours["radius"][:n] / R / theirs.radius[:n] - 1.0
    off_s = ours.share[:n] - theirs.share[:n]
    plastic = depth > ours.pair.first_yield
    away = plastic & inner(depth)
    plain_f, plain_a, missed = (
        100.0 * np.abs(smoothed(depth, values))
        for values in (np.log1p(off_f), np.log1p(off_a), theirs.increment[:n])
    )
    rows = tuple(
        (f"{depth[k]:.3e}", f"{ours['force'][k]:.4g}", f"{force[k]:.4g}",
         f"{100.0 * off_f[k]:+.2f} %", f"{100.0 * theirs.increment[k]:+.2f} %",
         f"{ours['radius'][k] / R:.4f}", f"{theirs.radius[k]:.4f}",
         f"{ours.share[k]:.4f}", f"{theirs.share[k]:.4f}")
        for k in range(0, n, max(1, n // 9))
    )  # fmt: skip
    source = f"CalculiX, {theirs.runs[0].version}, CAX4"
    measurements = (
        Measurement(f"{name}: F, mean difference", 100.0 * float(off_f[plastic].mean()), "%", -1.0,
                    1.0, source),
        Measurement(f"{name}: F, largest difference, ripple smoothed out",
                    float(plain_f[away].max()), "%", None, 1.0, source),
        Measurement(f"{name}: what CalculiX's finer increments still miss of F, largest",
                    float(missed[away].max()), "%", None, None, source),
        Measurement(f"{name}: a, largest difference, ripple smoothed out",
                    float(plain_a[away & (depth <= _RADII)].max()), "%", None, 1.0, source),
        Measurement(f"{name}: delta_s*, rms difference",
                    float(np.sqrt(np.mean(off_s[plastic] ** 2))), "", None, 0.005, source),
    )  # fmt: skip
    table = Table(
        f"{name}, ours against CalculiX",
        ("Delta/R", "F [N]", "CalculiX", "difference", "finer increments miss", "a/R", "CalculiX",
         "delta_s*", "CalculiX"),
        rows,
    )  # fmt: skip
    return measurements, table
