"""The page that computes an impact by itself: its numbers are those of `impact`."""

import json
import math
import runpy
import shutil
import subprocess
from pathlib import Path

import pytest
from dentscope.core import Material, Pair
from dentscope.dynamics import Approach, Striker, scene_of, strike
from dentscope.models import LAWS
from dentscope.models.export.sources import NAME, javascript_source

ROOT = Path(__file__).resolve().parents[3]
SITE = ROOT / "tools" / "site"
LAW = LAWS["fitted"]
node = pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")


def asked(folder, code):
    (folder / f"{NAME}.js").write_text(javascript_source(LAW))
    shutil.copyfile(SITE / "try-it.js", folder / "try-it.js")
    script = (
        f"const law = require('./{NAME}.js'), {{ upright, outside }} = require('./try-it.js');"
        f"console.log(JSON.stringify({code}));"
    )
    done = subprocess.run(
        ["node", "-e", script], cwd=folder, capture_output=True, text=True, check=True, timeout=60
    )
    return json.loads(done.stdout)


def written(body):
    numbers = {name: getattr(body, name) for name in ("E", "nu", "Sy", "density")}
    return json.dumps(numbers)  # Infinity and NaN as JavaScript has them


@node
@pytest.mark.parametrize("speed", [0.02, 1.0, 20.0])
@pytest.mark.parametrize(
    ("ball", "plate"),
    [
        (Material(200e9, 0.3, 1.7e9, density=7800.0), Material(200e9, 0.3, 3.05e8, density=7870.0)),
        (Material(70e9, 0.33, 2e8, density=2700.0), Material(200e9, 0.3, 1.2e9, density=7870.0)),
        (Material(300e9, 0.24, density=3900.0), Material(193e9, 0.29, 5e8, density=8000.0)),
    ],
    ids=["dent in the plate", "dent in the ball", "elastic ball"],
)
def test_its_numbers_are_those_of_impact(tmp_path, ball, plate, speed):
    R = 5e-3
    found = asked(tmp_path, f"upright(law, {written(ball)}, {written(plate)}, {R}, {speed})")
    mass = 4.0 / 3.0 * math.pi * R**3 * ball.density
    ours = strike(
        scene_of(
            LAW, sphere=ball, flat=plate, gravity=0.0, striker=Striker(mass=mass, tip_radius=R),
            approach=Approach(speed),
        )
    )  # fmt: skip
    assert found["restitution"] == pytest.approx(ours.restitution, rel=1e-5)
    assert found["deepest"] == pytest.approx(ours.peak_depth_m, rel=1e-5)
    assert found["force"] == pytest.approx(ours.peak_force_N, rel=1e-5)
    assert found["residual"] == pytest.approx(ours.residual_m, rel=1e-5, abs=1e-12)
    assert found["time"] == pytest.approx(ours.contact_time_s, rel=1e-3)


@node
def test_two_elastic_bodies_meet_as_hertz_says(tmp_path):
    # Johnson, Contact Mechanics, 11.4: 2.94 times the approach over the speed
    body = Material(200e9, 0.3, density=7800.0)
    found = asked(tmp_path, f"upright(law, {written(body)}, {written(body)}, 0.005, 0.1)")
    assert found["restitution"] == pytest.approx(1.0, abs=1e-6)
    assert found["time"] == pytest.approx(2.9432 * found["deepest"] / 0.1, rel=1e-3)


@node
def test_a_line_says_where_no_pair_was_fitted(tmp_path):
    limits = json.dumps(LAW.limits)
    soft, hard = Material(200e9, 0.3, 3e8), Material(200e9, 0.3, 9e9)
    pair = f"{written(hard)}, {written(soft)}"
    said = asked(tmp_path, f"outside({limits}, {pair}, 0.01, 0.003)")
    assert len(said) == 2
    assert said[0].startswith("strength of the ball over that of the plate is 30;")
    assert said[1] == "depth over radius is 0.3; the law was fitted from 0 to 0.179"
    assert asked(tmp_path, f"outside({limits}, {written(soft)}, {written(soft)}, 0.01, 1e-4)") == []
    with pytest.warns(UserWarning, match="Sy_ratio"):  # as the law itself says
        LAW.loading(Pair(hard, soft, 0.01), 1e-4)


def test_the_page_has_every_metal_and_both_scripts():
    page = runpy.run_path(str(SITE / "gather.py"))["try_page"]()
    data = json.loads(page.split('type="application/json">')[1].split("</script>")[0])
    assert data["metals"]["steel-52100-hardened"]["E"] == pytest.approx(2.06e11, rel=0.05)
    for select in ("steel-52100-hardened", "steel-1018-hot-rolled"):
        assert f'data-first="{select}"' in page
        assert select in data["metals"]
    assert set(data["limits"]) >= {"Sy_ratio", "nu", "Delta_over_R"}
    for script in (f"{NAME}.js", "try-it.js"):
        assert f'<script src="{script}">' in page
