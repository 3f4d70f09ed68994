"""Reduce made-up presses of load against depth, and records that are none; compare with the truth.

    python tools/benchmarks/validate_reduce_press.py [COUNT]

COUNT presses: loadings of drawn powers (spheres to blunt pyramids) after an approach or from a
preload, one cycle or eight, unloadings of drawn powers to nothing or to a rest, a hold that creeps,
a machine that gives way (stated, or seen in the cycles), noise, units and headers of four makers.
COUNT records that should be refused: without unloading, of a load cell at its end, with a hole at
the top, noise, a few rows, a machine that gives way more than all.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np
from dentscope.core.errors import InputError
from dentscope.reduce.kinds import load_kind
from honesty import judge

HEADS = (
    "Prüfzeit;Standardweg;Standardkraft\ns;mm;N\n", '"Time (s)","Extension (mm)","Load (N)"\n',
    "Time Displacement Into Surface Load On Sample".replace(" D", "\tD").replace(" L", "\tL")
    + "\ns\tnm\tmN\n", "Time [s];Pd [nm];Fn [mN]\n",
)  # fmt: skip


def course(rng, cycles, rest, held):
    """Load over the largest at each instant, and which cycle each row is in."""
    peaks = np.linspace(0.25, 1.0, cycles) if cycles > 1 else np.ones(1)
    parts, below = [], 0.0
    for k, peak in enumerate(peaks):
        last = rest if k == len(peaks) - 1 else 0.4 * peak
        n = rng.integers(80, 300)
        parts += [(np.linspace(below, peak, n), k), (np.full(held, peak), k)]
        parts += [(np.linspace(peak, last, n), k)]
        below = last
    return np.concatenate([p for p, _ in parts]), np.concatenate([0 * p + k for p, k in parts])


def press(rng):
    """Load [N], depth [m], and the truth by name."""
    deep, top = 10 ** rng.uniform(-7.0, -3.5), 10 ** rng.uniform(-3.0, 4.0)
    power, m = rng.uniform(1.0, 2.0), rng.uniform(1.1, 1.6)
    meyer = rng.uniform(2.0, 2.4)
    cycles = int(rng.choice([1, 1, 8]))
    rest = float(rng.choice([0.0, 0.0, 0.1]))
    held = int(rng.choice([0, 50]))
    load, which = course(rng, cycles, rest, held)
    back = rng.uniform(0.05, 0.4)  # of the largest depth
    creep = 0.02 * deep * rng.random() if held else 0.0
    blunt = rng.uniform(0.0, 0.05) * (power > 1.5)
    depth = np.empty(load.size)
    reached, crept = 0.0, 0.0
    at = lambda p: deep * ((p + blunt**power) ** (1.0 / power) - blunt)  # noqa: E731
    for k in range(cycles):
        rows = np.flatnonzero(which == k)
        peak = load[rows].max()
        up = rows[: int(np.argmax(load[rows])) + 1]
        given = back * deep * peak ** (1.0 - 1.0 / meyer)
        # up: elastic as far as it was loaded before, then on the curve
        old = reached
        elastic = up[load[up] < old]
        if old:
            g0 = back * deep * old ** (1.0 - 1.0 / meyer)
            top_old = at(old) + crept
            depth[elastic] = top_old - g0 * (1.0 - (load[elastic] / old) ** (1.0 / m))
        on = up[load[up] >= old]
        depth[on] = at(load[on]) + crept
        after = rows[up.size :]
        hold = after[load[after] == peak]
        depth[hold] = at(peak) + crept + creep * np.linspace(0.0, 1.0, hold.size)
        crept += creep if hold.size else 0.0
        down = after[hold.size :]
        depth[down] = at(peak) + crept - given * (1.0 - (load[down] / peak) ** (1.0 / m))
        reached = peak
    truth = {
        "load_N": top, "press_depth_m": at(1.0) + crept, "recovered_depth_m": given,
        "permanent_depth_m": at(1.0) + crept - given, "unloading_stiffness_N_m": m * top / given,
    }  # fmt: skip
    load = load * top
    if rng.random() < 0.7:  # an approach
        n = rng.integers(20, 100)
        load = np.concatenate([np.zeros(n), load])
        depth = np.concatenate([np.linspace(-0.1 * deep, 0.0, n), depth])
    else:
        keep = np.arange(load.size) >= np.argmax(load > 0.05 * top)
        load, depth = load[keep], depth[keep]
    noise = 10 ** rng.uniform(-4.0, -2.7)
    depth = depth + rng.normal(0.0, noise * deep, depth.size) + rng.uniform(-1.0, 1.0) * deep
    load = load + rng.normal(0.0, noise * top, load.size)
    machine = rng.uniform(0.1, 0.6) * given / (m * top)
    stated = cycles == 1 or rng.random() < 0.3
    return load, depth + machine * load, truth, machine if stated else None


def written(rng, load, depth, path):
    """Write a record as a maker does, of either sign."""
    sign = rng.choice([1, -1])
    head = str(rng.choice(HEADS))
    size = (1e3, 1.0) if "mm" in head else (1e9, 1e3)
    between = "," if '"' in head else "\t" if "\t" in head else ";"
    rows = [
        between.join(f"{v:.9g}" for v in row)
        for row in zip(np.arange(load.size) * 0.1, sign * size[0] * depth, sign * size[1] * load,
                       strict=True)
    ]  # fmt: skip
    text = head + "\n".join(rows) + "\n"
    path.write_text(text.replace(".", ",") if between == ";" else text)


def refused(rng):
    """A record that shows no whole press."""
    load, depth, _truth, machine = press(rng)
    kind = rng.choice(["no unloading", "cell", "hole", "noise", "rows", "machine"])
    top = int(np.argmax(load))
    if kind == "no unloading":
        load, depth = load[: top + 1], depth[: top + 1]
    if kind == "cell":
        load = np.minimum(load, rng.uniform(0.5, 0.85) * load.max())
    if kind == "hole":
        reach = max(int(0.03 * load.size), 3)
        load[max(top - reach, 0) : top + reach] = np.nan
    if kind == "noise":
        load = rng.normal(0.0, 1.0, load.size)
    if kind == "rows":
        load, depth = load[:: load.size // 8], depth[:: load.size // 8]
    if kind == "machine":
        machine = 1.0
    return kind, load, depth, machine


def main(count, path):
    def reduced(rng, load, depth, machine):
        written(rng, load, depth, path)
        given = {} if machine is None else {"machine_compliance_m_N": machine}
        return load_kind("press").run(path, given, source="benchmark")

    errors, lost = {}, []
    for seed in range(count):
        rng = np.random.default_rng(seed)
        load, depth, truth, machine = press(rng)
        kind = "cycles" if machine is None else "stated"
        try:
            found = reduced(rng, load, depth, machine)
        except InputError as error:
            lost.append(f"{seed} {error}")
            continue
        for name, true in truth.items():
            if (one := found.values.get(name)) is not None:
                error = one.value / true - 1.0, 0.01 if name == "load_N" else one.std / true
                errors.setdefault(f"{kind} {name}, relative", []).append(error)
    print(f"{count} presses, {len(lost)} refused", *lost[:9], sep="\n  ")
    for name, each in sorted(errors.items()):
        judge(name, *np.array(each).T)
    wrong = {}
    for seed in range(count):
        rng = np.random.default_rng(10_000 + seed)
        kind, load, depth, machine = refused(rng)
        try:
            reduced(rng, load, depth, machine)
            wrong.setdefault(str(kind), []).append(seed)
        except InputError:
            pass
    given = sum(map(len, wrong.values()))
    print(f"{count} records that are no whole press, {given} give a number: {wrong}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        main(int(sys.argv[1]) if len(sys.argv) > 1 else 300, Path(made) / "record.csv")
