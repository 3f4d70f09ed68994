"""The input of LAMMPS: the softened Hertz law at each speed, in drops that print restitutions."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ...core.inputs.second_sphere import StruckSphere
from ...core.material import Pair
from .discrete_elements import SOFTENED, ExportedRow, two_balls


def tangential_stiffness(pair: Pair) -> float:
    """Mindlin's stiffness over the contact radius, 8 G* [Pa]; 1/G* = sum of (2 - nu)/G.

    R. D. Mindlin, J. Appl. Mech. 16 (1949) 259. K. L. Johnson, Contact Mechanics (1985), 7.2.
    """
    bodies = (b for b in (pair.sphere, pair.flat) if not b.rigid)
    return 8.0 / sum((2.0 - b.nu) * 2.0 * (1.0 + b.nu) / b.E for b in bodies)


LAMMPS = """\
# `lmp -in lammps.in`: {what}, at each speed v [m/s]; the log has the restitutions.
# Into an input of your own go pair_style granular and, of the speed of your impacts, `flat` (the
# ball on the flat) or `balls` ({whose}).
# tangential: {tangential}
{told}
variable v index {speeds}
variable dt index {steps}
variable steps index {counts}
variable flat index {flat}
variable balls index {balls}
label drop
clear
units si
atom_style sphere
atom_modify map array
newton off
boundary f f f
region box block {box}
create_box 2 box
{atoms}
neighbor {skin:g} bin
comm_modify vel yes
pair_style granular
pair_coeff * * ${{balls}}
{fixes}
fix move all nve/sphere
timestep ${{dt}}
run ${{steps}}
print "v = ${{v}} m/s: restitution {printed}"
next v dt steps flat balls
jump SELF drop
"""


def lammps_lines(
    rows: Sequence[ExportedRow], pair: Pair, *, mass: float, friction: float = 0.0,
    of_balls: Sequence[ExportedRow] = (), second: StruckSphere | None = None,
) -> str:  # fmt: skip
    """An input of LAMMPS that runs as it is: the softened Hertz law at each speed.

    `mass` [kg] and Coulomb's `friction` are those of the ball on the flat, or of both spheres where
    it strikes `second`; `of_balls` are two balls, from `two_balls`, at the same speeds.
    """
    told: list[str] = []
    given: list[tuple[str, str, float, float, int]] = []
    for k, row in enumerate(rows):
        other = of_balls[k] if of_balls else row
        with_two = two_balls(pair, 1.0)[0] if of_balls else pair
        ours = _law(row, pair, friction, "" if second else ", the flat", told)
        theirs = _law(other, with_two, friction, ", two balls", told if of_balls else [])
        if ours and theirs:
            times = [one.named(SOFTENED).blow.time for one in (row, other)]  # type: ignore[union-attr]
            # steps of the shorter contact, until the longer one is over
            step = min(times) / 1000.0
            given.append((ours, theirs, row.law.speed, step, round(2.0 * max(times) / step)))
    lines = [f"# {line}" for line in told]
    if not given:
        return "\n".join(lines) + "\n"
    flat, balls, speeds, steps, counts = zip(*given, strict=True)
    tangential = "none, for the file states no friction.coefficient"
    if friction > 0.0:
        tangential = (
            f"Mindlin's spring and Coulomb's {friction:g}, softened as the normal one; our own law "
            "has no viscous part"
        )
    scene = _spheres(pair.R, mass, second) if second else _balls(pair.R, mass, bool(of_balls))
    return LAMMPS.format(
        told="\n".join(lines), tangential=tangential, **scene,
        speeds=" ".join(f"{v:g}" for v in speeds), steps=" ".join(f"{t:.4e}" for t in steps),
        counts=" ".join(map(str, counts)),
        flat=" ".join(f'&\n "{one}"' for one in flat),
        balls=" ".join(f'&\n "{one}"' for one in balls),
    )  # fmt: skip


def _law(row: ExportedRow, pair: Pair, friction: float, where: str, told: list[str]) -> str:
    """The softened law's words, and into `told` what it misses; empty where there is none."""
    own, soft = row.named("hertz-tsuji"), row.named(SOFTENED)
    if own is None or soft is None:
        told.append(row.without(SOFTENED))
        return ""
    told.append(f"{row.law.speed:g} m/s{where}: {soft.told(row.law)}")
    # LAMMPS multiplies by the root of the effective radius
    k = soft.stiffness / math.sqrt(pair.R)
    tangential = "linear_nohistory 0.0 0.0"
    if friction > 0.0:
        # softened as the normal stiffness, so that their ratio stays Mindlin's
        kt = tangential_stiffness(pair) * soft.stiffness / own.stiffness
        tangential = f"mindlin_rescale {kt:.6e} 0.0 {friction:g}"
    return f"hertz {k:.6e} {soft.entered:.6f} tangential {tangential} damping tsuji"


def _balls(R: float, mass: float, two: bool) -> dict[str, str | float]:
    """A ball above the flat, and two that meet far from it."""
    apart = R * (1.0 + 1e-9)
    atoms = [_atom(1, R, mass, 0.0, apart, "-${v}")]
    if two:
        atoms.append(_atom(2, R, mass, 6.0 * R, 10.0 * R - apart, "$(0.5*v_v)"))
        atoms.append(_atom(3, R, mass, 6.0 * R, 10.0 * R + apart, "$(-0.5*v_v)"))
    return {
        "what": "a ball drops on the flat" + ", two such balls meet" * two,
        "whose": "two such balls",
        "box": _box(20.0 * R), "skin": 0.2 * R, "atoms": "\n".join(atoms),
        "fixes": "fix flat all wall/gran granular ${flat} zplane 0.0 NULL",
        "printed": "$(vz[1]/v_v:%.4f)" + ", of two balls $((vz[3]-vz[2])/v_v:%.4f)" * two,
    }  # fmt: skip


def _spheres(R: float, mass: float, second: StruckSphere) -> dict[str, str | float]:
    """A ball that strikes another one; `R` and `mass` are those of both."""
    own, other = 1.0 / (1.0 / R - 1.0 / second.radius), second.radius
    weight = second.mass if second.free else mass
    atoms = [
        _atom(1, own, 1.0 / (1.0 / mass - 1.0 / second.mass), 0.0, own + 1e-9 * R, "-${v}"),
        _atom(2, other, weight, 0.0, -other, "0.0"),
    ]
    held = "group held id 2\nfix held held freeze"
    return {
        "what": "the two spheres of the file meet", "whose": "the two spheres",
        "box": _box(5.0 * max(own, other)), "skin": 0.2 * min(own, other),
        "atoms": "\n".join(atoms), "fixes": "" if second.free else held,
        "printed": "$((vz[1]-vz[2])/v_v:%.4f)",
    }  # fmt: skip


def _atom(k: int, radius: float, mass: float, x: float, z: float, speed: str) -> str:
    density = mass / (4.0 / 3.0 * math.pi * radius**3)
    return (
        f"create_atoms 1 single {x:.12g} 0 {z:.12g}\n"
        f"set atom {k} diameter {2.0 * radius:.10g} density {density:.10g} vz {speed}"
    )


def _box(half: float) -> str:
    return " ".join([f"{-half:g} {half:g}"] * 3)
