"""Measured tension curves as truths: what `dentscope metal` makes of presses into such metals.

    python tools/benchmarks/curves_from_presses.py build/curves

A ball of tungsten carbide, 3 mm, is pressed by finite elements (production) into a plate of each
metal and taken off from four depths; no curve is in the fit of a law. Three readings of each: 0.5 %
in load, 1 % in diameter, 2 % in depth; 15 % in the strength. Three metals are struck too: finite
elements whose metal has a rate law in every point, pressed at the speed of a ball that slows down.
One file a metal, so that it may be stopped.
"""

import argparse
import csv
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
from dentscope import fem
from dentscope.campaigns.cases.plateau import ASTM_1016, ASTM_1055, STAINLESS_304L
from dentscope.core import Material, Pair
from dentscope.core.flow import Flow, Rate, tabulated
from dentscope.discrepancy.metal import metal_of
from dentscope.recordings import read
from dentscope.studies.verification.checks.impact_strength import clock

# true stress [MPa] at the plastic strains P of tension tests whose data are public: 6061-T6 of
# github.com/sandialabs/matcal (BSD), the next three of github.com/bezborodow/stress-strain (public
# domain), the last of github.com/a-hilhorst/Tensile-test-Analysis (MIT)
P = (0.0, 0.002, 0.005, 0.01, 0.02, 0.03, 0.05, 0.08, 0.1, 0.15)
STRESSES = {
    "aluminium 6061-T6": (278, 300, 307.6, 312.8, 322.3, 329.8, 341.1, 352.5),
    "aluminium 5005": (110, 145.8, 154.2, 163.1, 180.4, 191.4, 202.6),
    "steel 1594": (260, 327.2, 342.9, 364.9, 402.9, 433.5, 467.9, 503.2, 524.4, 569.8),
    "steel 1595": (110, 141.2, 153.1, 167.0, 189.8, 208.3, 230.0, 251.9, 265.2, 293.5),
    "316L": (250, 292.8, 299.8, 315.9, 345.8, 373.8, 425.6, 499.7, 547.2, 655.7),
    "quenched and partitioned": (900, 1049.8, 1083.8, 1110.0, 1156.6, 1198.6, 1263.0, 1322.3),
    "medium manganese": (660, 686.3, 689.1, 699.3, 758.3, 834.4, 1030.0, 1246.9, 1350.2, 1485.3),
}
CURVES = {"ASTM 1016": ASTM_1016, "ASTM 1055": ASTM_1055, "304L": STAINLESS_304L}
CURVES |= {name: tuple(zip(P, stress, strict=False)) for name, stress in STRESSES.items()}
# rise at 1000 1/s and its exponent: mild and stainless steel of Cowper and Symonds (Jones), a weak
RATES = {"ASTM 1016": (1.90, 0.2), "316L": (1.26, 0.1), "aluminium 6061-T6": (0.2, 0.1)}
R, BALL, DENSITY = 1.5e-3, Material(E=630e9, nu=0.21), 15600.0
DEPTHS, STRUCK = (0.005, 0.015, 0.04, 0.09), (0.01, 0.03)
ERRORS = {"load_N": 0.005, "dent_diameter_m": 0.01, "permanent_depth_m": 0.02}
STATED = 0.15  # error of the strength
FINE = fem.Accuracy.production()


def pair_of(name: str) -> Pair:
    """The ball on a metal; past its last row a power law goes on."""
    p, S = np.array(CURVES[name], dtype=float).T
    n = math.log(S[-1] / S[-2]) / math.log(p[-1] / p[-2])
    more = np.array([x for x in (0.5, 1.0) if x > p[-1]])
    curve = tabulated(np.append(p, more), 1e6 * np.append(S, S[-1] * (more / p[-1]) ** n))
    E, nu = (70e9, 0.33) if "aluminium" in name else (200e9, 0.29)
    return Pair(BALL, Material(E=E, nu=nu, Sy=curve.strength, flow=Flow(curve)), R)


def marks_of(name: str) -> list[dict[str, float]]:
    """What perfect instruments would read of the presses, then of the impacts."""
    pair = pair_of(name)
    depths = fem.geometric_depths(1.2 * pair.first_yield, DEPTHS[-1], 48)
    problem = fem.ContactProblem(pair, tuple(sorted({*depths, *DEPTHS})), unload_from=DEPTHS)
    found = fem.solve(problem, accuracy=FINE)
    marks = [
        {"load_N": float(u.curve.force[0]), "permanent_depth_m": u.residual_flat,
         "dent_diameter_m": 2.0 * float(u.curve.radius[0])} for u in found.unloadings
    ]  # fmt: skip
    return [*marks, *struck(name, marks)] if name in RATES else marks


def struck(name: str, presses: list[dict[str, float]]) -> list[dict[str, float]]:
    """Impacts on a metal that has a rate of `RATES` in every point, to depths of `STRUCK`."""
    pair, (rise, n) = pair_of(name), RATES[name]
    assert pair.flat.flow is not None
    rate = Rate("cowper-symonds", 1000.0 * rise ** (-1.0 / n), 1.0 / n)
    quick = Pair(BALL, pair.flat.with_(flow=replace(pair.flat.flow, rate=rate)), R)
    power, scale = np.polyfit(np.log(DEPTHS), np.log([x["load_N"] for x in presses]), 1)
    marks = []
    for depth in STRUCK:
        slow = _speed(math.exp(scale) * depth ** (power + 1.0) * R / (power + 1.0))
        stronger = 1.0 + rise * (0.4 * slow / math.sqrt(2.0 * depth) / R / 1000.0) ** n
        problem = fem.ContactProblem(
            quick, fem.geometric_depths(1e-2 * depth, depth, 48), unload_from=(depth,),
            speeds=clock(depth, slow * math.sqrt(stronger)),
        )  # fmt: skip
        found = fem.solve(problem, accuracy=FINE)
        delta, force = (np.append(0.0, x) for x in (found.loading.delta, found.loading.force))
        turn = found.unloadings[0]
        # the clock's speed was a guess; what was spent says whose impact this is
        marks.append({"impact_speed_m_s": _speed(float(np.trapezoid(force, delta))),
                      "permanent_depth_m": turn.residual_flat,
                      "dent_diameter_m": 2.0 * float(turn.curve.radius[0])})  # fmt: skip
    return marks


def _speed(energy: float) -> float:
    return math.sqrt(2.0 * energy / (4.0 / 3.0 * math.pi * R**3 * DENSITY))


def told(name: str, marks: list[dict[str, float]], folder: Path) -> dict[str, list[float]]:
    """What `metal` says of noisy readings of the marks, and its interval, over the truth."""
    rng, pair = np.random.default_rng([20261126, list(CURVES).index(name)]), pair_of(name)
    p, S = np.array(CURVES[name], dtype=float).T
    Sy = 1e6 * np.interp(0.002, p, S) * math.exp(STATED * rng.normal())
    folder.mkdir(exist_ok=True)
    with (folder / "trials.csv").open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(
            stream, ("trial", "striker", "angle_deg", "impact_speed_m_s", *ERRORS)
        )
        writer.writeheader()
        for k, mark in enumerate(3 * marks):
            noisy = {h: v * (1.0 + ERRORS.get(h, 0.0) * rng.normal()) for h, v in mark.items()}
            writer.writerow({"trial": k, "striker": "ball", "angle_deg": 90, **noisy})
    noise = "\n".join(f"{k}_relative = {v}" for k, v in ERRORS.items())
    (folder / "set.toml").write_text(
        f'format = "recording-set/1"\nname = "{name}"\n[target]\nE_Pa = {pair.flat.E}\n'
        f"nu = {pair.flat.nu}\nSy_Pa = {{ value = {Sy:.6g}, std = {STATED * Sy:.6g} }}\n"
        f'density_kg_m3 = 7800\n[strikers.ball]\nshape = "sphere"\ntip_radius_m = {R}\n'
        f"E_Pa = 630e9\nnu = 0.21\ndensity_kg_m3 = {DENSITY}\n[noise]\n{noise}\n",
        encoding="utf-8",
    )
    metal = metal_of(read(folder))
    truth = {x: 1e6 * np.interp(x, p, S) for x in (0.02, 0.05, 0.1) if x <= p[-1]}
    found = {f"{x:g}": [s / S for s in metal.stress_at(x)] for x, S in truth.items()}
    return found | {"rise": [x / RATES[name][0] for x in metal.rise]} if name in RATES else found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    stresses: list[list[float]] = []
    for name in CURVES:
        if not (path := out / f"{name}.json").exists():
            path.write_text(json.dumps(marks_of(name)) + "\n", encoding="utf-8")
        found = told(name, json.loads(path.read_text(encoding="utf-8")), out / name)
        text = (f"{k}: {v:.3f} ({low:.2f} to {high:.2f})" for k, (v, low, high) in found.items())
        print(f"{name:25s} {'   '.join(text)}", flush=True)
        stresses += [x for k, x in found.items() if k != "rise"]
    near = sum(abs(value - 1.0) <= 0.07 for value, *_ in stresses)
    inside = sum(low <= 1.0 <= high for _, low, high in stresses)
    print(f"stresses within 7 %: {near}; in the interval: {inside}; of {len(stresses)}")


if __name__ == "__main__":
    main()
