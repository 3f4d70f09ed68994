"""Legal but extreme files to every command: no hang, no traceback, no nan with exit code 0.

`python tools/benchmarks/fuzz_keys.py --inputs 4000` makes that many files by a seed from the
grammar of keys below, each value within what `dentscope keys` allows, runs the command in a child
that stays, and prints for each command how many were answered, refused with a line, ended with exit
code 3, and what else happened. A child that takes more than 30 s of its processor over one file is
ended (tests/faults/watched.py): a hang. `--first 2000` goes on at that file, `--only 17` shows one.
The seeded short form is `tests/faults/test_faults.py`.
"""

import argparse
import contextlib
import io
import json
import math
import random
import re
import sys
import tempfile
import time
import traceback
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "faults"))
import watched

SLOW_S = 30.0
DRAWN = 0.15
"""Share of the inputs whose pictures are drawn."""
_NAN = re.compile(r"(?<![a-z_])[-+]?(nan|inf)(?![a-z_])", re.IGNORECASE)
_UNSAID = re.compile(r"not a number|(?<![a-z_])[-+]?(nan|inf)(?![a-z_])", re.IGNORECASE)
"""A refusal that blames what no file says: no legal file holds such a number."""
LAWS = (
    "fitted", "hertz", "jackson-green", "ghaednia", "compact", "johnson", "ceb", "thornton",
    "stronge", "brake-2012", "brake-2015", "kogut-etsion", "ye-komvopoulos", "hardening",
    "kogut-komvopoulos", "sinclair-follansbee", "zhao-maietta-chang", "brizmer-stick",
    "jackson-green+ghaednia",
)  # fmt: skip


def some(draw, low, high, *more):
    """A number of a range: an end, one of `more`, or any, even in the logarithm."""
    way = draw.random()
    if way < 0.08:
        return low
    if way < 0.16:
        return high
    if more and way < 0.35:
        return draw.choice(more)
    first, last = math.log(low if low > 0.0 else 1e-12 * high), math.log(high)
    return min(math.exp(first + (last - first) * draw.random()), high)


def quantity(draw, *given):
    """A number, mostly exact; some with a standard deviation, of which some are huge."""
    value = some(draw, *given)
    if draw.random() < 0.75:
        return value
    std = abs(value) * draw.choice((0.0, 1e-3, 0.05, 0.3, 2.0))
    return {"value": value, "std": std}


def body(draw, *, of_case=False):
    if draw.random() < 0.07:
        return {"rigid": True}
    table = {
        "E_Pa": quantity(draw, 1e3, 2e12, 2e11, 7e10, 1e6),
        "nu": some(draw, 0.0, 0.4999, 0.3, 0.3, 0.3, 0.25, 0.45),
    }
    modulus = table["E_Pa"]["value"] if isinstance(table["E_Pa"], dict) else table["E_Pa"]
    way = draw.random()
    if way < 0.7 and modulus > 1e4:
        share = draw.choice((1e-6, 1e-4, 1e-3, 2e-3, 5e-3, 0.02, 0.1, 0.5))
        table["Sy_Pa"] = min(max(share * modulus, 1e3), 5e11)
    elif way < 0.8 and not of_case:
        table["hardness_Pa"] = quantity(draw, 1e3, min(2.5 * modulus, 5e11), 1e9)
    if draw.random() < 0.6:
        table["density_kg_m3"] = quantity(draw, 25.0, 25e3, 7800.0)
    if "Sy_Pa" in table and draw.random() < 0.15:
        table["hardening"] = hardening(draw, table["Sy_Pa"])
    return table


def hardening(draw, strength):
    law = draw.choice(("swift", "ludwik", "voce", "johnson-cook"))
    size = strength * draw.choice((1e-3, 0.3, 1.5, 10.0, 1e3))
    if law == "swift":
        size = max(size, 1.001 * strength)  # it has to begin at the strength
    if law == "voce":
        return {"law": law, "Q_Pa": size, "b": some(draw, 1e-6, 1e6, 10.0)}
    name = "B_Pa" if law == "johnson-cook" else "K_Pa"
    return {"law": law, name: size, "n": some(draw, 1e-6, 1.0, 0.2, 0.5)}


def impact(draw, *, rods=0.3):
    """A set-up of `dentscope impact`; a share of the strikers are rods."""
    rod = draw.random() < rods
    target = body(draw) | maybe(draw, 0.3, thickness_m=quantity(draw, 1e-9, 10.0, 0.01))
    striker = body(draw) | {"shape": "rod" if rod else "sphere"}
    striker["tip_radius_m"] = quantity(draw, 1e-9, 3.0, 5e-3, 5e-3, 1e-3)
    heavy = rod or "density_kg_m3" not in striker or draw.random() < 0.3
    striker |= maybe(draw, float(heavy), mass_kg=quantity(draw, 1e-18, 1e6, 4e-3, 0.5))
    if rod:
        striker["radius_m"] = some(draw, 1e-9, 3.0, 5e-3)
        striker["length_m"] = some(draw, 1e-9, 10.0, 0.1, 0.3)
    tip = striker["tip_radius_m"]
    tip = tip["value"] if isinstance(tip, dict) else tip
    striker |= maybe(draw, 0.1, tip_flat_radius_m=some(draw, 0.0, 0.9 * tip, 0.1 * tip))
    striker |= maybe(draw, 0.1, inertia_kg_m2=some(draw, 1e-30, 1e6, 1e-6))
    blow = {"laws": draw.sample(LAWS, draw.choice((1, 1, 2)))}
    fall = draw.random() < 0.3
    blow |= (
        {"drop_height_m": quantity(draw, 1e-9, 200.0, 0.5)}
        if fall
        else {"impact_speed_m_s": quantity(draw, 1e-9, 2e4, 1.0, 1.0, 10.0)}
    )
    blow |= maybe(draw, 0.3, angle_deg=some(draw, 1e-6, 90.0, 45.0, 60.0))
    blow |= maybe(draw, 0.15, approach_tangential_m_s=draw.choice((-1e3, -1.0, 0.0, 1e-9, 5.0)))
    blow |= maybe(draw, 0.15, approach_spin_rad_s=draw.choice((-1e4, 0.0, 1e-9, 300.0)))
    blow |= maybe(draw, 0.1, repeats=draw.choice((2, 3)))
    blow |= maybe(draw, 0.1, max_steps=draw.choice((10, 100, 20000)))
    blow |= maybe(draw, 0.1, max_contacts=draw.choice((1, 5)))
    blow |= maybe(draw, 0.1, flight_s=some(draw, 0.0, 1.0, 1e-3))
    support = draw.choice(("rigid",) * 6 + ("sprung", "plate", "half-space"))
    if target.get("rigid") and striker.get("rigid"):
        del striker["rigid"]
        striker |= {"E_Pa": 2e11, "nu": 0.3}
    if support in ("plate", "half-space") and target.get("rigid"):
        support = "rigid"
    if support in ("plate", "half-space"):
        target.setdefault("density_kg_m3", 7800.0)
        target.setdefault("thickness_m", 0.01)
    if "hardening" in target or "hardening" in striker:
        blow["laws"] = ["hardening", *blow["laws"][:1]]
    blow["support"] = support
    if support == "sprung":
        target["support_mass_kg"] = some(draw, 1e-18, 1e6, 1.0)
        target |= maybe(draw, 0.7, support_stiffness_N_m=some(draw, 0.0, 1e12, 1e6))
        blow |= maybe(draw, 0.3, support_damping_N_s_m=some(draw, 0.0, 1e6, 100.0))
    if rod and draw.random() < 0.3:
        blow["modes"] = draw.choice((1, 2, 5))
        striker.setdefault("density_kg_m3", 7800.0)
        blow |= maybe(draw, 0.3, loss_factor=some(draw, 0.0, 0.99, 0.01))
    content = {
        "target": target, "strikers": {"ball": striker}, "impact": blow,
        "friction": {"coefficient": quantity(draw, 0.0, 20.0, 0.1, 0.3)},
    }  # fmt: skip
    content |= maybe(draw, 0.3, gravity_m_s2=some(draw, 0.0, 1e3, 0.0))
    if draw.random() < 0.2:
        content["sweep"] = sweep(draw)
    return content


def sweep(draw):
    """A table of a sweep: few values of one or two conditions."""
    ranges = {
        "impact_speed_m_s": (1e-9, 2e4, 1.0), "angle_deg": (1e-3, 90.0, 45.0),
        "friction": (0.0, 20.0, 0.1), "mass_kg": (1e-18, 1e6, 1e-3),
    }  # fmt: skip
    names = draw.sample(list(ranges), draw.choice((1, 1, 2)))
    return {name: [some(draw, *ranges[name]) for _ in range(3)] for name in names}


def maybe(draw, share, **keys):
    return keys if draw.random() < share else {}


def case(draw):
    last = some(draw, 1e-7, 0.5, 0.01, 1e-3, 1e-6)
    load = {"max_delta_over_R": last}
    load |= maybe(draw, 0.4, unload_from=[last * draw.choice((0.1, 0.5, 1.0))])
    bodies = {k: body(draw, of_case=True) for k in ("sphere", "flat")}
    if all(table.get("rigid") for table in bodies.values()):
        bodies["flat"] = {"E_Pa": 2e11, "nu": 0.3, "Sy_Pa": 3e8}
    if not bodies["sphere"].get("rigid"):
        bodies["sphere"].setdefault("density_kg_m3", 7800.0)
    return {
        "radius_m": some(draw, 1e-9, 3.0, 5e-3), **bodies, "load": load,
        "accuracy": {"level": "smoke"}, **maybe(draw, 0.2, friction={"coefficient": 0.2}),
    }  # fmt: skip


def inverse(draw):
    rod = {
        "tip_radius_m": quantity(draw, 1e-9, 3.0, 8.8e-3),
        "mass_kg": quantity(draw, 1e-18, 1e6, 0.5), "length_m": quantity(draw, 1e-9, 10.0, 0.3),
    }  # fmt: skip
    rod |= maybe(draw, 0.5, radius_m=quantity(draw, 1e-9, 3.0, 8.8e-3))
    rod |= maybe(draw, 0.3, inertia_kg_m2=quantity(draw, 1e-300, 1e300, 1e-3))
    trial = {
        "angle_deg": some(draw, 1e-9, 89.999999, 45.0, 70.0),
        "impact_speed_m_s": some(draw, 1e-9, 2e4, 1.0),
        "friction_impulse_ratio": some(draw, 0.0, draw.choice((0.3, 20.0)), 0.1, 0.0),
        "restitution": some(draw, 0.0, 2.0, 0.5, 1.0),
        "permanent_depth_m": some(draw, 1e-12, 0.1, 1e-5),
        "sliding_length_m": some(draw, 1e-12, 1.0, 1e-3),
        **maybe(draw, 0.3, rebound_m_s=some(draw, 1e-9, 1e4, 0.5)),
    }  # fmt: skip
    return {"striker": rod, "trial": [trial]}


def recordings(draw):
    """A recording set: what a file of an impact says, and some trials."""
    content = impact(draw)
    for key in ("impact", "sweep"):
        content.pop(key, None)
    for table in (content["target"], *content["strikers"].values()):
        table.pop("rigid", None)
        table.pop("hardening", None)
    ball = content["strikers"]["ball"]
    ball.setdefault("mass_kg", some(draw, 1e-18, 1e6, 4e-3))
    content |= {"format": "recording-set/1", "name": "fuzz"}
    content["noise"] = {
        "restitution": some(draw, 1e-12, 1.0, 0.01),
        "permanent_depth_m": some(draw, 1e-12, 1e-3, 1e-7),
    }
    rows = [
        f"{k},ball,{some(draw, 1e-6, 90.0, 90.0, 45.0)!r},{some(draw, 1e-9, 2e4, 1.0)!r},"
        f"{some(draw, 0.0, 1.0, 0.5, 0.0)!r},"
        f"{some(draw, 0.0, 0.1, 1e-5)!r}"
        for k in range(draw.choice((1, 3, 8)))
    ]
    head = "trial,striker,angle_deg,impact_speed_m_s,restitution,permanent_depth_m"
    return content, "\n".join([head, *rows]) + "\n"


def toml(content):
    lines = []

    def value(x):
        if isinstance(x, dict):
            return "{ " + ", ".join(f"{k} = {value(v)}" for k, v in x.items()) + " }"
        if isinstance(x, list):
            return "[" + ", ".join(map(value, x)) + "]"
        return json.dumps(x) if isinstance(x, str | bool) else repr(x)

    for key, part in content.items():
        if isinstance(part, list) and part and isinstance(part[0], dict):
            for one in part:
                lines += [f"[[{key}]]", *(f"{k} = {value(v)}" for k, v in one.items())]
        elif isinstance(part, dict):
            lines += [f"[{key}]", *(f"{k} = {value(v)}" for k, v in part.items())]
        else:
            lines.insert(0, f"{key} = {value(part)}")
    return "\n".join(lines) + "\n"


KINDS = ("impact", "impact", "laws", "export", "inverse", "case", "recordings")
"""What is asked, in turn; a case is read and not solved."""


def written(kind, draw, folder):
    """Write an input; return the arguments of the command."""
    file, out = folder / "a.toml", str(folder / "out")
    if kind == "recordings":
        content, trials = recordings(draw)
        (folder / "set").mkdir()
        (folder / "set" / "set.toml").write_text(toml(content))
        (folder / "set" / "trials.csv").write_text(trials)
        command = draw.choice(("check", "audit"))
        return ["recordings", command, str(folder / "set")]
    if kind == "export" and draw.random() < 0.5:
        file.write_text(toml(impact(draw, rods=0.05)))
        return ["export", "dem", str(file), "--out", out]
    makes = {"impact": impact, "inverse": inverse, "laws": case, "export": case, "case": case}
    file.write_text(toml(makes[kind](draw)))
    speed = draw.choice(("0.1,10", "1e-9", "2e4"))
    ending = {
        "impact": ["impact", str(file), "--out", out],
        "inverse": ["inverse", str(file), "--out", out],
        "laws": ["laws", "compare", str(file), "--out", out],
        "export": ["export", "dem", str(file), "--out", out, "--speed", speed],
        "case": ["case", str(file)],
    }  # fmt: skip
    return ending[kind]


@contextlib.contextmanager
def undrawn():
    """Leave pictures blank: drawing them takes three quarters of the time."""
    from matplotlib.figure import Figure

    drawing = Figure.savefig
    Figure.savefig = lambda _, file, **_how: (
        file.write(b"") if hasattr(file, "write") else Path(file).write_bytes(b"")
    )
    try:
        yield
    finally:
        Figure.savefig = drawing


def answered(arguments):
    """Run a command in this process; return exit code and all that it printed."""
    from dentscope.cli import run

    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        if arguments[0] == "case":
            from dentscope.core import InputError
            from dentscope.start.case_file import read_case

            try:
                read_case(Path(arguments[1]))
                code = 0
            except InputError as error:
                code = 2
                sys.stderr.write(f"{error}\n")
        else:
            code = run(arguments)
    return code, out.getvalue(), err.getvalue()


def judged(kind, code, out, err):
    """What came of an input: `answered`, `refused`, `not ended`, or a fault in capitals."""
    text = out + err
    if "Traceback" in text:
        return "TRACEBACK"
    if "Warning" in text:
        return "WARNING"
    if code == 0:
        shown = out.split("not in these parameters:")[0]
        return "NAN" if _NAN.search(shown) else "answered"
    if code == 2:
        return "refused" if err.strip() and not _UNSAID.search(err) else "UNSAID"
    return "not ended" if code == 3 else f"EXIT {code}"


def one(number, seed, kinds=KINDS):
    """Make and run input `number`; the same for the same seed."""
    draw = random.Random(f"{seed}-{number}")
    kind = kinds[number % len(kinds)]
    with tempfile.TemporaryDirectory() as folder:
        arguments = written(kind, draw, Path(folder))
        text = "".join(p.read_text() for p in sorted(Path(folder).rglob("*.toml")))
        try:
            with contextlib.nullcontext() if draw.random() < DRAWN else undrawn():
                code, out, err = answered(arguments)
            told, where = judged(kind, code, out, err), (out + err)[-1500:]
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            told, where = f"EXCEPTION {type(error).__name__}", traceback.format_exc()[-1500:]
    return {"number": number, "kind": kind, "told": told, "where": where, "text": text}


def child(seed, first, last):
    """Run inputs first to last; a line of JSON before and after each."""
    tell = watched.teller()
    for number in range(len(KINDS)):  # what is imported or compiled once is then no input's time
        one(number, 0)
    for number in range(first, last):
        tell({"number": number, "reader": KINDS[number % len(KINDS)]})
        watched.forget_peak()
        started = time.process_time()
        found = one(number, seed)
        seconds = time.process_time() - started
        where = f"\n{found['text']}{found['where']}" if found["told"][0].isupper() else ""
        tell({"told": found["told"], "where": where, "seconds": seconds, "MB": watched.peak_mb()})


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--inputs", type=int, default=4000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--child", type=int)
    parser.add_argument("--only", type=int, help="run one input here and show it")
    chosen = parser.parse_args()
    if chosen.child is not None:
        child(chosen.seed, chosen.child, chosen.inputs)
        return
    if chosen.only is not None:
        found = one(chosen.only, chosen.seed)
        sys.stdout.write(f"{found['text']}\n{found['where']}\n{found['told']}\n")
        return

    def say(line):
        sys.stdout.write(f"{line}\n")
        sys.stdout.flush()

    counts, faults, most, longest = watched.run(
        chosen.inputs,
        chosen.seed,
        script=__file__,
        first=chosen.first,
        slow_s=SLOW_S,
        memory_mb=math.inf,
        say=say,
    )
    for kind, found in counts.items():
        say(f"{kind}: {dict(found)}, at most {longest[kind]:.1f} s")
    say(f"{len(faults)} faults; most memory {most:.0f} MB")


if __name__ == "__main__":
    main()
