"""Draws from what a diagnosis leaves possible, in memory and as a file that ArviZ reads."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from ..core.arrays import Array, Integers
from ..core.output import write_file
from ..core.tables import text_table
from .comparison.problem import Problem
from .inference.fit import Fit


@dataclass(frozen=True, eq=False)
class Samples:
    """Equally probable draws of one explanation.

    - `explanation`: its name, as the scores know it.
    - `parameters`: mechanisms' parameters and the numbers of set.toml by name, (draws,) each.
    - `predicted`: by observable, what the same trials would read again: the mean of each
      condition's readings, (draws, readings), SI.
    - `measured`: by observable, what they did read, (readings,).
    - `condition`: by observable, number of each reading's condition, from 1.
    """

    explanation: str
    parameters: Mapping[str, Array]
    predicted: Mapping[str, Array]
    measured: Mapping[str, Array]
    condition: Mapping[str, Integers]
    units: Mapping[str, str]

    def __repr__(self) -> str:
        told = [f"draws of {self.explanation}", "5 %", "median", "95 %"]
        bounds = ((f"{k} [{self.units[k]}]", *np.quantile(x, [0.05, 0.5, 0.95]))
                  for k, x in self.parameters.items())  # fmt: skip
        rows = [[name, *(f"{x:.4g}" for x in three)] for name, *three in bounds]
        return text_table([told, *rows], numbers=True)

    def to_netcdf(self, path: Path | str) -> Path:
        """Write a netCDF-4 file: `arviz.from_netcdf(path)` has the groups of ArviZ's schema.

        `posterior`, `posterior_predictive` and `observed_data`; the draws, which are independent,
        are told as four chains where their number allows.
        """
        stream = io.BytesIO()
        with h5py.File(stream, "w", track_order=True) as file:
            scales = {k: {f"{k}_condition": c} for k, c in self.condition.items()}
            n = len(next(iter(self.predicted.values())))
            chains = 1 if n % 4 else 4

            def chained(x: Array) -> Array:
                return x.reshape(chains, -1, *x.shape[1:])

            draws = {"chain": np.arange(chains), "draw": np.arange(n // chains)}
            none: dict[str, Integers] = {}
            of_draws = {name: (chained(x), none) for name, x in self.parameters.items()}
            again = {name: (chained(x), scales[name]) for name, x in self.predicted.items()}
            read = {name: (x, scales[name]) for name, x in self.measured.items()}
            _group(file, "posterior", of_draws, draws, self.units)
            _group(file, "posterior_predictive", again, draws, self.units)
            _group(file, "observed_data", read, {}, self.units)
        return write_file(Path(path), stream.getvalue())


def _group(
    file: h5py.File, name: str, variables: Mapping[str, tuple[Array, Mapping[str, Integers]]],
    first: Mapping[str, Integers], units: Mapping[str, str],
) -> None:  # fmt: skip
    """Write variables and the dimensions along which they run, those of all `first`."""
    group = file.create_group(name, track_order=True)
    own = {key: values for _, more in variables.values() for key, values in more.items()}
    for key, places in {**first, **own}.items():
        group[key] = places
        group[key].make_scale(key)
    for key, (values, more) in variables.items():
        group[key] = values
        group[key].attrs["units"] = units.get(key, "")
        for axis, along in enumerate((*first, *more)):
            group[key].dims[axis].attach_scale(group[along])


def drawn(problem: Problem, fitted: Fit, draws: int, rng: np.random.Generator) -> Samples:
    """Draw from the posterior of an explanation.

    `problem`, `fitted`: what was compared, and the fit of the explanation.

    A draw takes a cell of the refined grid by its weight and a size of the model's errors by what
    the residuals there say, then the unknowns u (stated numbers, the law's error, the form's) from
    their normal distribution given these; what is read again is data - residual + A u + noise.
    """
    rows = rng.choice(len(fitted.weight), draws, p=fitted.weight)
    n = problem.n_z
    z, noise = np.zeros((draws, n)), np.linalg.cholesky(fitted.linear.noise)
    again = rng.standard_normal((draws, len(noise))) @ noise.T
    for row in np.unique(rows):
        r, here = fitted.residuals[row], np.flatnonzero(rows == row)
        each = fitted.mixture.each(r)
        odds = np.exp(each - each.max())
        sizes = rng.choice(len(odds), len(here), p=odds / odds.sum())
        for size in np.unique(sizes):
            at, part = here[sizes == size], fitted.mixture.parts[size]
            A = np.hstack([part.scaled, part.form])
            half = part.whitening.T @ A
            u = rng.multivariate_normal(
                half.T @ part.white(r), np.eye(A.shape[1]) - half.T @ half, len(at), method="eigh"
            )
            z[at] = u[:, :n] * part.prior
            again[at] += problem.cells.value - r + u @ A.T
    found, units = _own(fitted, rows, rng)
    for k, q in enumerate(problem.nuisances):
        found[q.name], units[q.name] = np.array([q.at(x) for x in z[:, k]]), q.unit
    return Samples(fitted.name, found, *_by_observable(problem, again), units)


def _own(
    fitted: Fit, rows: Integers, rng: np.random.Generator
) -> tuple[dict[str, Array], dict[str, str]]:
    """Values of the mechanisms' parameters in these cells, flat within each, and their units."""
    grid = fitted.grid
    places = grid.places()[rows] if grid.axes else np.zeros((len(rows), 0))
    found, units = {}, {}
    for k, (label, (_, p)) in enumerate(zip(grid.labels, grid.axes, strict=True)):
        low, high = grid.window[k] if grid.window else (0.0, 1.0)
        cell = (high - low) / len(grid.fine[k])
        at = places[:, k] + cell * (rng.random(len(rows)) - 0.5)
        found[label], units[label] = np.array([float(p.value(x)) for x in at]), p.unit
    return found, units


def _by_observable(
    problem: Problem, again: Array
) -> tuple[dict[str, Array], dict[str, Array], dict[str, Integers]]:
    """Split predictions (draws, m), the readings and their conditions, out of logarithms."""
    cells = problem.cells
    logs = np.where(cells.is_log, 1.0, 0.0)
    value, again = (np.where(logs, np.exp(logs * x), x) for x in (cells.value, again))
    predicted: dict[str, Array] = {}
    measured: dict[str, Array] = {}
    condition: dict[str, Integers] = {}
    for name in dict.fromkeys(cells.observable):
        at = np.flatnonzero([one == name for one in cells.observable])
        predicted[name], measured[name] = again[:, at], value[at]
        condition[name] = np.asarray(cells.condition[at] + 1, dtype=np.int64)
    return predicted, measured, condition
