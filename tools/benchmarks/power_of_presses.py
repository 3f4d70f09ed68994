"""What twelve quasi-static presses beside the impacts bring: concealed sets with and without them.

    python tools/benchmarks/power_of_presses.py build/presses --count 120
    python tools/benchmarks/power_of_presses.py build/presses --count 0     # the table alone
    python tools/benchmarks/power_of_presses.py build/metal --count 20 --metal --seed 78

A quarter each of the sets conceals a rate effect, hardening, both, or nothing. Bodies, metals and
effects come from the proof's generators; the presses are made by the same ones at zero rate: four
loads three times each, errors of 0.5 % in load, 1 % in diameter, 2 % in depth. With `--metal` it is
`dentscope metal` that reads the rate, in sets with presses. One file a set, so that it may be
stopped.
"""

import argparse
import csv
import json
import math
from pathlib import Path

import numpy as np
from dentscope.discrepancy import diagnose
from dentscope.discrepancy.metal import metal_of
from dentscope.recordings import read
from dentscope.studies.proof.generators import cavity, flow, foundation
from dentscope.studies.proof.generators import parameters as at
from dentscope.studies.proof.generators.effects import EFFECTS
from dentscope.studies.proof.generators.folder import write_set
from dentscope.studies.proof.generators.simulate import results_of, rows_of, size_of
from dentscope.studies.proof.generators.truth import FAMILIES, Truth, draw
from dentscope.studies.proof.same_meaning import comparable

RATE, HARDENING = "strain-rate-hardening", "work-hardening"
RISE = "rise_at_1000_per_s"
KINDS = {"rate": (RATE,), "hardening": (HARDENING,), "both": (RATE, HARDENING), "nothing": ()}
SEED = 20261126
KEPT = ("verdict", "mechanisms", "alternatives", "probabilities", "parameters", "next_experiment")
ERRORS = {"load_N": 0.005, "dent_diameter_m": 0.01, "permanent_depth_m": 0.02}


def usable(truth: Truth) -> bool:
    """Whether its bench's impacts are upright and leave a measured dent."""
    rig = truth.rig
    return (
        rig.law == "elastic-plastic"
        and bool(np.all(rig.angle > 0.5 * np.pi - 1e-9))
        and not np.any(rig.tangential)
        and "permanent_depth_m" in rig.noise
        and np.ptp(rig.temperature) == 0.0
        and rig.bench in ("rods-normal", "balls-normal", "balls-drops")
    )


def truth_of(kind: str, number: int, seed: int = SEED) -> Truth:
    """The concealed case of one number."""
    rng = np.random.default_rng([seed, list(KINDS).index(kind), number])
    names = KINDS[kind]
    while True:
        truth = draw(rng, "single" if names else "null", name=names[0] if names else "")
        if usable(truth):
            return truth if len(names) < 2 else with_hardening(rng, truth)


def with_hardening(rng: np.random.Generator, truth: Truth) -> Truth:
    """The same with hardening beside its rate effect."""
    family = FAMILIES[truth.family]
    effects = (*truth.effects, EFFECTS[HARDENING].draw(rng, truth.rig, family))
    sizes = tuple(
        size_of(truth.rig, [e], family=family, z=truth.z, keep=[o for o in effects if o is not e])
        for e in effects
    )
    return Truth(
        "pair", truth.rig, effects, sizes, truth.family, truth.z, truth.instrument, truth.more
    )


def contact_radius(row: np.ndarray, depth: float) -> float:
    """Radius of the contact at a depth, as the generator's own law has it [m]."""
    strength = flow.strength(row, depth)
    if row[at.LAW] == at.CAVITY:
        law = row[at.CAVITY_LAW : at.ROW_LAW]
        return cavity.dent(depth, row[at.MODULUS], row[at.TIP], strength, row[at.FLAT], law)[1]
    law = row[at.ROW_LAW : at.N_PARAMETERS]
    yielded = depth / row[at.TIP] * (row[at.MODULUS] / strength) ** 2
    return math.sqrt(foundation.spread(yielded, law) * row[at.TIP] * depth)


def add_presses(truth: Truth, folder: Path, rng: np.random.Generator) -> None:
    """Add presses of the middle striker, as deep as four of its impacts went."""
    rig, which = truth.rig, len(truth.rig.strikers) // 2
    table = static_rows(truth)
    own = np.flatnonzero(rig.which == which)
    speeds = np.unique(rig.speed[own])
    chosen = speeds[np.linspace(0, len(speeds) - 1, 4).round().astype(int)]
    rows = [int(own[np.flatnonzero(rig.speed[own] == v)[0]]) for v in chosen]
    marks = [
        mark_of(row, out) for row, out in zip(table[rows], results_of(table[rows]), strict=True)
    ]
    write_presses(folder, rig.strikers[which].name, marks, rng)


def static_rows(truth: Truth) -> np.ndarray:
    """The numbers of every impact, without a rate: a press goes along their force."""
    table = rows_of(truth.rig, truth.effects, family=FAMILIES[truth.family], z=truth.z)
    table[:, at.RATE_KIND] = 0.0
    return np.asarray(table)


def mark_of(row: np.ndarray, out: np.ndarray) -> dict[str, float]:
    """Load and mark of a press, from the impact that goes as deep."""
    return {
        "load_N": out[at.PEAK_FORCE],
        "permanent_depth_m": out[at.DEPTH],
        "dent_diameter_m": 2.0 * contact_radius(row, out[at.PEAK_DEPTH]),
    }


def write_presses(
    folder: Path, striker: str, marks: list[dict[str, float]], rng: np.random.Generator
) -> None:
    """Add three noisy readings of each mark to a set."""
    with (folder / "trials.csv").open(encoding="utf-8") as stream:
        trials = list(csv.DictReader(stream))
    head = [*trials[0], "load_N", "permanent_depth_m_std", "dent_diameter_m"]
    for place, right in enumerate(marks):
        for repeat in range(3):
            read_off = {k: f"{v * (1.0 + ERRORS[k] * rng.normal()):.6g}" for k, v in right.items()}
            std = f"{ERRORS['permanent_depth_m'] * right['permanent_depth_m']:.4g}"
            trials.append(
                {"trial": f"press-{place}-{repeat}", "striker": striker,
                 "permanent_depth_m_std": std, **read_off}
            )  # fmt: skip
    with (folder / "trials.csv").open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, head, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(trials)
    with (folder / "set.toml").open("a", encoding="utf-8") as stream:
        for column in ("dent_diameter_m", "load_N"):  # the file ends with its table [noise]
            stream.write(f"{column}_relative = {ERRORS[column]}\n")


def rise_of(truth: Truth) -> float | None:
    """The rise of the strength at 1000 1/s, of a truth with a rate effect."""
    rises = [comparable(vars(e))[RISE] for e in truth.effects if e.name == RATE]
    return rises[0] if rises else None


def measure(kind: str, number: int, out: Path) -> dict[str, object]:
    """Diagnose one concealed case without and with presses."""
    truth = truth_of(kind, number)
    record: dict[str, object] = {
        "kind": kind, "truth": truth.mechanisms, "sizes": truth.sizes, "rise": rise_of(truth),
    }  # fmt: skip
    for which in ("without", "with"):
        folder = out / f"{kind}-{number:02d}-{which}"
        write_set(truth, folder, name=folder.name)
        if which == "with":
            add_presses(truth, folder, np.random.default_rng([SEED, 99, number]))
        found = diagnose(read(folder), seed=0).to_dict()
        record[which] = {k: found[k] for k in KEPT}
    return record


def rise_read(kind: str, number: int, out: Path, seed: int) -> dict[str, object]:
    """What `metal` says of the rise in a case with presses."""
    truth, folder = truth_of(kind, number, seed), out / f"{kind}-{number:02d}"
    write_set(truth, folder, name=folder.name)
    add_presses(truth, folder, np.random.default_rng([seed, 99, number]))
    return {"kind": kind, "rise": rise_of(truth) or 0.0, "read": metal_of(read(folder)).rise}


def told_of_metal(records: list[dict]) -> list[str]:
    """Every rise, and how many lie in their intervals."""
    lines, inside = [], 0
    for r in records:
        value, low, high = r["read"]
        inside += low <= r["rise"] <= high
        lines.append(f"{r['kind']:10s} {r['rise']:.3f}: {value:.3f} ({low:.3f} to {high:.3f})")
    return [*lines, f"in the interval {inside} of {len(records)}"]


def told(records: list[dict], which: str) -> list[str]:
    """Lines of the table for the sets without or with presses."""
    lines = []
    for kind, names in KINDS.items():
        of = [r for r in records if r["kind"] == kind]
        exact = sum(set(r[which]["mechanisms"]) == set(names) for r in of)
        held = sum(set(names) <= set_of(r[which]) for r in of) if names else 0
        false = sum(bool(set(r[which]["mechanisms"]) - set(names)) for r in of)
        lines.append(
            f"{which:8s} {kind:10s} sets {len(of):3d}   named exactly {exact:3d}   "
            f"in the set {held:3d}   a wrong name {false:3d}"
        )
    sizes = [dict(zip(r["truth"], r["sizes"], strict=True)).get(RATE, 0.0) for r in records]
    large = [r for r, size in zip(records, sizes, strict=True) if size >= 10.0]
    rises = [(r["rise"], r[which]["parameters"].get(RISE)) for r in records if r["rise"]]
    inside = [x["low"] <= true <= x["high"] for true, x in rises if x]
    return [
        *lines,
        f"{which:8s} rate, size 10 and more: in the set "
        f"{sum(RATE in set_of(r[which]) for r in large)} of {len(large)}; "
        f"its rise in the interval {sum(inside)} of {len(inside)}",
    ]


def set_of(found: dict) -> set[str]:
    """Every mechanism that a verdict names, or cannot tell from what it names."""
    return set(found["mechanisms"]).union(*found["alternatives"])


def main() -> None:
    """Go on with the sets, then print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--count", type=int, default=120)
    parser.add_argument("--metal", action="store_true", help="what `dentscope metal` reads instead")
    parser.add_argument("--seed", type=int, default=SEED, help="of the sets, with --metal")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    for job in range(given.count):
        kind, number = list(KINDS)[job % len(KINDS)], job // len(KINDS)
        path = given.out / f"{kind}-{number:02d}.json"
        if not path.exists():
            if given.metal:
                found = rise_read(kind, number, given.out, given.seed)
            else:
                found = measure(kind, number, given.out)
            path.write_text(json.dumps(found) + "\n", encoding="utf-8")
            print(f"{job + 1} of {given.count}: {kind} {number}", flush=True)
    records = [json.loads(p.read_text(encoding="utf-8")) for p in sorted(given.out.glob("*.json"))]
    if given.metal:
        print("\n".join(told_of_metal(records)))
        return
    print("\n".join(line for which in ("without", "with") for line in told(records, which)))


if __name__ == "__main__":
    main()
