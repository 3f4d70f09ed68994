"""Simulation-based calibration of a diagnosis's fits: where truths lie in their own posteriors.

`python -m dentscope.studies.calibration challenge/open data/proof/ranks.jsonl`

Unknowns are drawn from their priors and put on the bench of a set, its readings from the simulation
with the law's error, the error of the mechanism's form and the noise; the mechanism is fitted as a
diagnosis does it, and the share of the posterior below the true value is kept. Where the fit is
right these are uniform (Talts and others, arXiv:1804.06788). simuk has the same for PyMC, Bambi and
NumPyro models alone.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import norm

from ..core.arrays import Array
from ..core.processes.threads import in_one_thread
from ..discrepancy.comparison.forward import Simulator
from ..discrepancy.comparison.problem import Problem, problem_of
from ..discrepancy.inference.derivatives import FORMS, derivatives
from ..discrepancy.inference.fit import Fit, fit, grid_of
from ..discrepancy.rank import sharpened_leading
from ..discrepancy.unknowns.lawerror import SIZES
from ..dynamics.mechanisms import MECHANISMS
from ..recordings import read
from .proof.ranks import read_ranks

BENCHES = {
    "strain-rate-hardening": "open-001", "work-hardening": "open-003", "adhesion": "open-006",
    "support-compliance": "open-007", "truncated-tip": "open-008", "impact-speed-loss": "open-005",
    "velocity-dependent-friction": "open-010", "tilt": "open-011", "contact-damping": "open-014",
    "rod-flexural-vibration": "open-015", "ploughing-friction": "open-016",
    "squeeze-film": "open-018", "hardened-layer": "open-020", "half-space-waves": "open-024",
    "size-effect": "open-026", "tangential-compliance": "open-033",
    "thermal-softening": "open-040", "rod-longitudinal-waves": "open-043", "roughness": "open-053",
}  # fmt: skip
"""Open sets of the challenge whose benches show a mechanism: the first that conceals it alone."""

STRENGTH = "target.Sy_Pa"
"""The stated number that is looked at beside the parameters, where it has an error."""


@in_one_thread
def ranks(simulator: Simulator, name: str, rng: np.random.Generator) -> dict[str, float]:
    """Return the share of the posterior below the truth, for one draw, by parameter.

    `simulator`: of the set whose bench it is; `name`: of the mechanism; `rng`: of the draw.
    """
    problem = simulator.problem
    chosen = next(m for m in MECHANISMS if m.name == name)
    grid = grid_of(problem, (chosen,))
    place = rng.random(len(grid.axes))
    z = rng.normal(size=problem.n_z)
    z[problem.n_nuisances :] *= rng.choice(SIZES.factors, p=SIZES.weights)
    right, linear = derivatives(simulator, (chosen,), grid.values(place), z)
    value = right + np.linalg.cholesky(linear.noise) @ rng.normal(size=len(right))
    if linear.form.size:
        times = rng.choice(FORMS.factors, p=FORMS.weights)
        value += times * linear.form @ rng.normal(size=linear.form.shape[1])
    read_off = replace(problem, cells=replace(problem.cells, value=value))
    here = simulator.of(read_off)
    (found,) = sharpened_leading(here, [fit(here, (chosen,))], fit(here, ()))
    return shares(problem, found, place, z)


def shares(problem: Problem, found: Fit, place: Array, z: Array) -> dict[str, float]:
    """Return the share of a posterior below the truth, by parameter.

    `problem`: what was fitted; `found`: its fit; `place`, `z`: the truth: (axes,) places in the
    priors, (n_z,) unknowns.
    """
    below = {}
    for k, label in enumerate(found.grid.labels):
        edges, weight = found.grid.marginal(found.weight, k)
        reach = np.concatenate([[0.0], np.cumsum(weight)])
        below[label] = float(np.interp(place[k], edges, reach / reach[-1]))
    for k, n in enumerate(problem.nuisances):
        if n.name == STRENGTH:
            spread = math.sqrt(max(float(found.covariance[k, k]), 1e-12))
            below[n.name] = float(norm.cdf((z[k] - found.z[k]) / spread))
    return {label: round(share, 4) for label, share in below.items()}


def drawn(
    folder: Path, out: Path, draws: int, only: Sequence[str] = ()
) -> Iterator[dict[str, Any]]:
    """Go on with the draws of each mechanism where a file of lines stopped; yield each line.

    `folder`: part `open` of the challenge; `out`: a line of JSON for each draw: `mechanism`,
    `draw`, `shares`; `draws`: of each mechanism; `only`: these mechanisms; none for all.
    """
    known = {(x["mechanism"], x["draw"]) for x in read_ranks(out)}
    for name in only or BENCHES:
        simulator = Simulator(problem_of(read(folder / "sets" / BENCHES[name])))
        for number in range(draws):
            if (name, number) not in known:
                rng = np.random.default_rng([list(BENCHES).index(name), number])
                yield {"mechanism": name, "draw": number, "shares": ranks(simulator, name, rng)}


def append(lines: Iterable[dict[str, Any]], out: Path) -> None:
    """Write lines at the end of a file, each as soon as it is there."""
    with out.open("a", encoding="utf-8") as stream:
        for line in lines:
            stream.write(json.dumps(line) + "\n")
            stream.flush()


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--draws", type=int, default=100)
    parser.add_argument("--only", nargs="*", choices=BENCHES, default=())
    given = parser.parse_args()
    append(drawn(given.folder, given.out, given.draws, given.only), given.out)


if __name__ == "__main__":
    main()
