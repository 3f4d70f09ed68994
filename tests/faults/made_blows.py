"""A file of a blow for the tests, a hard steel ball on iron, and what comes of it."""

import tomllib

from dentscope.dynamics.files.blow import blow_of
from dentscope.dynamics.files.setup import setup_of
from dentscope.models import LAWS

BALL = """
[target]
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = 3.05e8
density_kg_m3 = 7870
[strikers.ball]
shape = "sphere"
tip_radius_m = 0.005
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = 1.7e9
density_kg_m3 = 7800
[impact]
impact_speed_m_s = 1.0
laws = ["fitted"]
"""


def setup(given):
    content = tomllib.loads(given) if isinstance(given, str) else given
    return setup_of(content, source="ball.toml")


def ball_setup(*, target, ball, radius=5e-3, law="hertz", speed=1.0, **tables):
    """A ball on a target without gravity; `impact` and other tables beside, or in place."""
    met = {"laws": [law], **({"impact_speed_m_s": speed} if speed else {})}
    return setup({
        "gravity_m_s2": 0.0, "target": dict(target),
        "strikers": {"ball": {"shape": "sphere", "tip_radius_m": radius, **ball}},
        **tables, "impact": met | tables.get("impact", {}),
    })  # fmt: skip


def blow(given, *laws):
    return blow_of(setup(given), [LAWS[name] for name in laws or ("fitted",)])
