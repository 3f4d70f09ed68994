"""Hardening, rate and heat: exact paths of one point, and the balance of a sphere that hardens."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..... import fem
from .....campaigns.case import Case
from .....campaigns.cases.pairs import pair_of
from .....core.flow import Flow, FlowCurve, Heating, Rate, ludwik, swift, voce
from .....core.material import Material
from .....fem.material import EXACT, RADIAL
from ...bench import Bench
from ...material_point import MaterialPoint, stretched
from ...result import Cell, Measurement, Result, Table

_E, _NU, _SY = 200e9, 0.3, 400e6
_SPEED, _SECONDS, _STEPS = 30.0, 1e-3, 40
_START = (_SY / 900e6) ** 5.0
_HARDENING: dict[str, tuple[FlowCurve | None, Callable[[float], float]]] = {
    "none": (None, lambda p: _SY),
    "Swift": (swift(Sy=_SY, K=900e6, n=0.2), lambda p: 900e6 * (_START + p) ** 0.2),
    "Ludwik": (ludwik(Sy=_SY, K=500e6, n=0.5), lambda p: _SY + 500e6 * math.sqrt(p)),
    "Voce": (voce(Sy=_SY, Q=300e6, b=12.0), lambda p: _SY - 300e6 * math.expm1(-12.0 * p)),
}
# each with its factor and its overstress at the rate _SPEED
_RATES: dict[str, tuple[Rate | None, float, float]] = {
    "none": (None, 1.0, 0.0),
    "Cowper-Symonds": (Rate("cowper-symonds", 40.0, 5.0), 1.0 + (_SPEED / 40.0) ** 0.2, 0.0),
    "Johnson-Cook": (Rate("johnson-cook", 1.0, 0.03), 1.0 + 0.03 * math.log(_SPEED), 0.0),
    "overstress": (Rate("overstress", 10.0, 0.5, 50e6), 1.0, 50e6 * math.sqrt(_SPEED / 10.0)),
}


def run(bench: Bench) -> Result:
    """Walk the exact paths, then press one hardening sphere into a hardening flat."""
    rows: list[tuple[Cell, ...]] = []
    worst = 0.0
    for name, (curve, law) in _HARDENING.items():
        for kind, (rate, factor, more) in _RATES.items():
            if curve is None and rate is None:
                continue
            off = max(
                _tension(Flow(curve, rate), lambda p, f=law, a=factor, b=more: f(p) * a + b, rule)  # type: ignore[misc]
                for rule in (RADIAL, EXACT)
            )
            rows.append((name, kind, f"{off:.1e}"))
            worst = max(worst, off)
    defect = _balance(bench)
    return Result(
        name="flow-laws",
        title="Hardening, rate and heat",
        about=(
            f"Tension of one point at a constant rate of plastic strain, {_SPEED:g} 1/s, in "
            f"{_STEPS} steps to a strain of {_SPEED * _SECONDS * _STEPS:g}, where the stress is "
            "the law's own; adiabatic tension without hardening, T = D (1 - exp(-b S p/D)); a "
            "sphere and a flat that harden (Swift, n = 0.2 and 0.1) to Delta/R = 0.1, level "
            "`quick`."
        ),
        measurements=(
            Measurement("stress at a constant rate, largest relative error", worst, "", None, 1e-6,
                        "exact"),
            Measurement("stress of an adiabatic tension to p = 1 in 400 steps", _heated(), "", None,
                        1e-5, "exact"),
            Measurement("energy balance of the hardening sphere, largest defect", 100.0 * defect,
                        "%", None, 0.5, "work = stored + dissipated"),
        ),
        tables=(Table("Error by law", ("hardening", "rate", "relative error"), tuple(rows)),),
        notes=(
            "What is left is the cubic between the 200 rows of a written law's table.",
        ),
    )  # fmt: skip


def _tension(flow: Flow, stress: Callable[[float], float], rule: int) -> float:
    """Largest relative error of the stress where p = r t: the strain is p + stress/(3 G)."""
    point = MaterialPoint.of(Material(_E, _NU, _SY, flow=flow), seconds=_SECONDS, rule=rule)
    worst = 0.0
    for k in range(1, _STEPS + 1):
        p = _SPEED * _SECONDS * k
        exact = stress(p)
        done = point.walk(stretched(p + exact / (3.0 * point.G * _E)))
        worst = max(worst, abs(point.mises(done) / exact - 1.0))
    return worst


def _heated() -> float:
    heat = Heating(0.9, 3.6e6, 500.0)
    point = MaterialPoint.of(Material(_E, _NU, _SY, flow=Flow(heating=heat)), seconds=math.inf)
    for strain in np.linspace(0.0, 1.0, 400)[1:]:
        done = point.walk(stretched(float(strain)))
    exact = _SY * math.exp(-heat.fraction * _SY * point.strain / (heat.capacity * heat.range))
    return abs(point.mises(done) / exact - 1.0)


def _balance(bench: Bench) -> float:
    plain = pair_of(E_s=200.0, E_f=200.0, Sy_min=300.0, ratio=1.5)
    sphere, flat = (
        body.with_(flow=Flow(swift(Sy=body.Sy, K=body.Sy * (body.E / body.Sy) ** n, n=n)))
        for body, n in ((plain.sphere, 0.2), (plain.flat, 0.1))
    )
    pair = replace(plain, sphere=sphere, flat=flat)
    depths = fem.geometric_depths(0.3 * pair.first_yield, 0.1, 40)
    problem = fem.ContactProblem(pair, depths)
    solved = bench.solve(Case("hardening-balance", problem, fem.Accuracy.quick()))
    return float(np.abs(solved["energy_defect"]).max()) if solved.completed else math.nan
