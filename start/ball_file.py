"""The ball on the flat that a discrete-element code is given: from either file that names one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..core.approach import speeds_at_touch
from ..core.errors import InputError
from ..core.inputs.toml_input import read_toml
from ..core.inputs.unused_keys import unused_keys
from ..core.material import Pair
from ..core.rig import value_of
from ..dynamics.files.scenes import curves_in
from ..dynamics.files.second import SecondSphere
from ..dynamics.files.setup import FOLLOWING, Setup, setup_of
from ..dynamics.mechanisms.asked import NONE_ASKED, Asked
from ..dynamics.report.band import last_blow
from ..dynamics.report.flow import lacking
from ..dynamics.scene import Approach
from ..models import LAWS
from ..models.base import ContactLaw
from .case_file import metal_keys, read_pair

_STRIKER = ("shape", "tip_radius_m", "mass_kg", "radius_m", "density_kg_m3", "hardness_Pa")
_OF_A_RANGE = ("", ".from", ".to", ".count", ".spacing")
_OF_IMPACT = (
    metal_keys("target") | metal_keys("strikers.NAME") | {f"strikers.NAME.{k}" for k in _STRIKER}
    | {"target.shape", "target.law", "target.hardness_Pa", "friction.coefficient"}
    | {"impact.striker", "impact.impact_speed_m_s", "impact.drop_height_m", "gravity_m_s2"}
    | {f"sweep.{one}{k}" for one in ("impact_speed_m_s", "drop_height_m") for k in _OF_A_RANGE}
)  # fmt: skip
_OF_CASE = (
    metal_keys("sphere") | metal_keys("flat")
    | {"sphere.density_kg_m3", "radius_m", "friction.coefficient"}
)  # fmt: skip


class ExportedBall(NamedTuple):
    """A ball, the flat or sphere that it meets, and what a file says of their blow."""

    pair: Pair
    mass: float  # [kg]
    friction: float  # [-]
    speeds: tuple[float, ...]  # [m/s]; empty where the file says none
    law: str  # of ours that knows these metals
    unused: list[str]  # what the file says beyond this
    second: SecondSphere | None = None  # in place of the flat; pair and mass are those of both
    asked: Asked = NONE_ASKED  # mechanisms that act
    setup: Setup | None = None  # of `dentscope impact`

    def left_open(self, law: ContactLaw) -> Iterator[str]:
        """Yield what rate and hardening would change of the file's blow where it says nothing."""
        if self.setup is not None:
            found = last_blow(self.setup, law)
            for what, lack in lacking(self.setup, self.setup.scene(law), found).items():
                yield f"no {what} is stated; {lack.told(found)}"

    def by(self, law: ContactLaw) -> ContactLaw:
        """Return the law as `impact` has it: the smaller of two spheres is the law's."""
        return law if self.second is None else self.second.faced(law, self.pair)


def read_ball(file: Path, *, mass: float | None = None) -> ExportedBall:
    """Read a set-up of `dentscope impact` or a CASE.toml; `mass` [kg] in place of the file's.

    Every mistake is a line; refused is what strikes and is no ball, or has no known mass.
    """
    content = read_toml(file)
    of_impact = "strikers" in content or "impact" in content
    found = _of_setup(content, file) if of_impact else _of_case(content, file)
    weight = found.mass if mass is None else mass
    if mass is not None and found.second is not None:
        raise InputError(
            f"{mass:g}", source="command line", key="--mass",
            allowed="strikers.NAME.mass_kg and target.mass_kg of two spheres, in the file",
        )  # fmt: skip
    if mass is None and math.isnan(weight):
        raise InputError(
            "missing", source=str(file), key="sphere.density_kg_m3", allowed="a number, or --mass"
        )
    if not (weight > 0.0 and math.isfinite(weight)):
        raise InputError(
            f"{weight:g}", source="command line", key="--mass", allowed="a number above 0"
        )
    return found._replace(mass=weight)


def _of_setup(content: Mapping[str, Any], file: Path) -> ExportedBall:
    setup = setup_of(dict(content), source=str(file))
    name = setup.file.striker
    ball = setup.file.strikers[name]
    if ball.shape != "sphere":
        raise InputError(
            "a rod", source=str(file), key=f"strikers.{name}.shape", allowed='"sphere"'
        )
    law = FOLLOWING if curves_in(setup.file) else "fitted"
    scene = setup.plain(LAWS[law])
    heights, of = setup.sweep.drop_height_m, setup.stated
    fallen, _ = speeds_at_touch(math.nan, heights, of.angle, False, gravity=of.gravity)
    speeds = setup.sweep.impact_speed_m_s or tuple(fallen.tolist()) or (scene.approach.speed,)
    falls = heights or setup.file.impact.drop_height_m is not None
    used = _OF_IMPACT if falls else _OF_IMPACT - {"gravity_m_s2"}
    if setup.second is not None:
        used = used | {"target.radius_m", "target.mass_kg", "target.density_kg_m3"}
    asked = setup.acting(scene.with_(approach=Approach(scene.approach.speed)))
    acting = tuple(f"mechanisms.{m.name}" for m in asked.mechanisms)
    unused = [line for line in unused_keys(content, used) if not line.startswith(acting)]
    radius = ball.radius_m
    if radius is not None and not math.isclose(radius.value, ball.tip_radius_m.value):
        # rounder or flatter at its tip than itself, it is one sphere to these codes
        unused.append(f"strikers.{name}.radius_m = {radius.value:g} beside tip_radius_m")
    return ExportedBall(
        scene.pair, scene.striker.mass, scene.friction.mu, tuple(speeds), law,
        unused, setup.second, asked, setup,
    )  # fmt: skip


def _of_case(content: Mapping[str, Any], file: Path) -> ExportedBall:
    found, pair = read_pair(file)
    law = "fitted" if pair.perfectly_plastic else FOLLOWING
    friction = value_of(found.friction.coefficient, 0.0)
    return ExportedBall(pair, found.ball_mass, friction, (), law, unused_keys(content, _OF_CASE))
