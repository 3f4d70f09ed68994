"""Posterior calibration at shipped recordings: where truths lie that the data themselves allow.

`python -m dentscope.studies.at_data data/proof/ranks-at-data.jsonl`

The parameters, the stated numbers and the errors of law and form are drawn from the posterior of
the explanation that leads at a set. From each draw its recordings are made again, of the same
conditions and noise, and both are fitted together: the share of that posterior below the draw is
uniform where the fit is right (Sailynoja, Schmitt, Buerkner, Vehtari, arXiv:2502.03279).
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.special import logsumexp

from ..core.arrays import Array
from ..core.processes.threads import in_one_thread
from ..discrepancy.choice.pairs import pair_effect, with_pairs
from ..discrepancy.comparison.forward import Simulator
from ..discrepancy.comparison.problem import Problem, problem_of
from ..discrepancy.inference.derivatives import FORMS, derivatives
from ..discrepancy.inference.fit import Fit, fit, fit_anchored
from ..discrepancy.inference.linear import Mixture
from ..discrepancy.rank import rank, screen, sharpened_leading
from ..discrepancy.unknowns.lawerror import SIZES
from ..dynamics.mechanisms import MECHANISMS, NAMELESS
from ..recordings import read
from ..recordings.shipped import FOLDER
from .calibration import append, shares
from .proof.ranks import read_ranks

LEADING = {
    "kharaz-2001-oblique": ("tangential-compliance",),
    "liquidmetal-bounces": ("support-compliance",),
    "thesis-chapter-5": ("strain-rate-hardening", "rod-flexural-vibration"),
}
"""Shipped sets, and what has the most probability of what is in the library there."""


class Drawn(NamedTuple):
    """A draw from a posterior, and recordings that it makes.

    `place`, `z`: (axes,) places in the priors and (n_z,) unknowns; `value`: (m,) cells.
    """

    place: Array
    z: Array
    value: Array


def fitted(simulator: Simulator, leading: Fit) -> Fit:
    """Fit an explanation as a diagnosis does, a pair from where it leads.

    `leading`: the explanation's fit to the set itself.
    """
    base = fit(simulator, ())
    screened = [screen(simulator, base, m) for m in leading.mechanisms]
    found = [
        fit(simulator, (s.mechanism,), start=base, place=s.place, rounds=3, effect=s.effect)
        for s in screened
    ]
    if len(found) == 1:
        return sharpened_leading(simulator, found, base)[0]
    both = pair_effect(simulator, *screened)
    start = max(found, key=lambda f: f.log_evidence)
    pair = fit_anchored(simulator, leading.mechanisms, both, z=start.z, place=leading.place)
    return sharpened_leading(simulator, [pair], base, rounds=5)[0]


def twice(problem: Problem) -> Problem:
    """Return a problem whose cells are means of two sets of recordings: of half the variance."""
    cells, half = problem.cells, math.sqrt(0.5)
    conditions = tuple(
        replace(
            c, speed_spread=half * c.speed_spread, angle_spread=half * c.angle_spread,
            setting_spread=half * c.setting_spread,
        )
        for c in problem.conditions
    )  # fmt: skip
    return replace(problem, cells=replace(cells, std=half * cells.std), conditions=conditions)


def draw(simulator: Simulator, found: Fit, rng: np.random.Generator) -> Drawn:
    """Draw from the posterior of a fit, and make recordings.

    Noise is drawn anew; what the law, the form and a scale are off stays, as drawn from its
    posterior.
    """
    problem, grid = simulator.problem, found.grid
    chosen = int(rng.choice(len(found.weight), p=found.weight))
    width = np.array([f[1] - f[0] for f in grid.fine])
    place = grid.places()[chosen] + width * (rng.random(len(width)) - 0.5)
    values = grid.values(place)
    here, linear = derivatives(simulator, found.mechanisms, values, found.z)
    _, halved = derivatives(simulator.of(twice(problem)), found.mechanisms, values, found.z)
    # what no repeat averages away stands in both
    noise = 2.0 * (linear.noise - halved.noise)
    scale = _root(linear.noise - noise)
    r = problem.cells.value - here + linear.J @ found.z
    mixture = Mixture.of(linear, problem.n_nuisances, SIZES, FORMS)
    each = mixture.each(r)
    part = mixture.parts[int(rng.choice(len(each), p=np.exp(each - logsumexp(each))))]
    columns = np.hstack([part.scaled, part.form, scale])
    gain = np.linalg.solve(noise + columns @ columns.T, columns).T
    unit = gain @ r + _root(np.eye(len(gain)) - gain @ columns) @ rng.normal(size=len(gain))
    z = part.prior * unit[: problem.n_z]
    made, _ = derivatives(simulator, found.mechanisms, values, z)
    made = made + columns[:, problem.n_z :] @ unit[problem.n_z :]
    return Drawn(place, z, made + _root(noise) @ rng.normal(size=len(r)))


def _root(covariance: Array) -> Array:
    """Symmetric root of a covariance (m, m)."""
    size, shape = np.linalg.eigh(0.5 * (covariance + covariance.T))
    return np.asarray((shape * np.sqrt(np.maximum(size, 0.0))) @ shape.T)


def ranks(simulator: Simulator, found: Fit, rng: np.random.Generator) -> dict[str, float]:
    """Return the share of the posterior of both recordings below a draw, by parameter."""
    one = draw(simulator, found, rng)
    both = twice(simulator.problem)
    mean = 0.5 * (simulator.problem.cells.value + one.value)
    both = replace(both, cells=replace(both.cells, value=mean))
    return shares(both, fitted(simulator.of(both), found), one.place, one.z)


@in_one_thread
def lines(out: Path, draws: int, sets: Mapping[str, tuple[str, ...]]) -> Iterator[dict[str, Any]]:
    """Go on with the draws at each set where a file of lines stopped; yield each line.

    `out`: a line of JSON for each draw: `set`, `mechanism`, `draw`, `shares`; `draws`: at each set;
    `sets`: of `LEADING`.
    """
    known = {(x["set"], x["draw"]) for x in read_ranks(out)}
    for name, mechanisms in sets.items():
        todo = [k for k in range(draws) if (name, k) not in known]
        if not todo:
            continue
        simulator = Simulator(problem_of(read(FOLDER / name)))
        ranking = rank(simulator, (*MECHANISMS, *NAMELESS, *simulator.problem.wrong_numbers))
        simulator = simulator.of(ranking.problem)
        ranking = with_pairs(simulator, ranking)
        found = next(f for f in ranking.fits if f.names == mechanisms)
        for number in todo:
            rng = np.random.default_rng([list(LEADING).index(name), number])
            yield {
                "set": name, "mechanism": found.name, "draw": number,
                "shares": ranks(simulator, found, rng),
            }  # fmt: skip


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--draws", type=int, default=100)
    parser.add_argument("--only", nargs="*", choices=LEADING, default=())
    given = parser.parse_args()
    sets = {k: v for k, v in LEADING.items() if not given.only or k in given.only}
    append(lines(given.out, given.draws, sets), given.out)


if __name__ == "__main__":
    main()
