"""What a newcomer writes after `import dentscope as ds`."""

import inspect
import math
import pickle
import pydoc
import re
from dataclasses import replace
from pathlib import Path

import dentscope as ds
import numpy as np
import pandas
import pytest
from dentscope import dynamics
from dentscope.core import InputError
from dentscope.core import Material as Body
from dentscope.core.flow import Flow, tabulated
from dentscope.core.inputs.templates import template
from dentscope.dynamics.files.setup import ImpactTable, read_setup
from dentscope.dynamics.files.sweep import SweepTable
from dentscope.recordings import read
from dentscope.recordings.shipped import set_folder
from made_processes import python

HARD = ds.Material(E=210e9, nu=0.3, Sy=2e9, density=7800.0)
SOFT = ds.Material(E=200e9, nu=0.3, Sy=3e8)
CURVE = tabulated(np.array([0.0, 0.2]), np.array([3e8, 6e8]))


def test_importing_loads_nothing_heavy_and_everything_is_there():
    program = (
        "import sys, dentscope as ds; print('numpy' in sys.modules); print(*dir(ds));"
        "print(ds.models.LAWS is ds.LAWS, 'fem' in dir(ds))"
    )
    first, names, last = python("-c", program, check=True).stdout.splitlines()
    assert first == "False"
    shown = {"LAWS", "Material", "Pair", "case", "diagnose", "impact", "models"}
    assert shown <= set(names.split())
    assert last == "True True"
    with pytest.raises(AttributeError, match="nonsense"):
        _ = ds.nonsense


def test_a_blow_of_a_template_with_changes():
    blow = ds.impact("ball", law=["fitted", "hertz"], speed=2.0)
    # elastic: all is given back; Hertz's time 2.943 d/v of a ball of 4.0841e-3 kg, 5 mm
    mass, v = 4.0 / 3.0 * math.pi * 5e-3**3 * 7800, 2.0
    stiffness = 4.0 / 3.0 * 2e11 / 0.91 / 2.0 * 5e-3**0.5
    deepest = (1.25 * mass * v**2 / stiffness) ** 0.4
    assert blow["hertz"].restitution == pytest.approx(1.0, abs=1e-6)
    assert blow["hertz"].contact_time_s == pytest.approx(2.943 * deepest / v, rel=1e-3)
    assert 0.3 < blow["fitted"].restitution < 0.7
    frame = blow.frame()
    assert list(frame["law"]) == ["fitted", "hertz"]
    assert frame["restitution"][1] == pytest.approx(blow["hertz"].restitution, abs=1e-8)
    # columns never touch, however wide
    many = repr(ds.impact("ball", law=["hertz", "jackson-green"])).splitlines()
    assert all(re.fullmatch(r"\S.*?(  +\S.*?){2}", line) for line in many)
    assert "<td>hertz</td>" not in blow._repr_html_()
    assert "<th>hertz</th>" in blow._repr_html_()
    figure = blow.plot()
    assert "depth [um]" in {axes.get_xlabel() for axes in figure.axes}
    assert figure._repr_png_().startswith(b"\x89PNG")  # as a notebook shows it
    with pytest.raises(InputError, match=r"no screen .*savefig"):
        figure.show()


def test_the_laws_show_themselves_as_a_table():
    lines = repr(ds.LAWS).splitlines()
    assert len(lines) == 1 + len(ds.LAWS)
    assert lines[1].startswith("hertz ")
    assert all(len(repr(law).splitlines()) == 1 for law in ds.LAWS.values())
    assert ds.LAWS._repr_html_().count("<tr>") == len(lines)


def test_laws_side_by_side_lead_with_those_to_use(tmp_path):
    found = ds.compare_laws(ds.Pair(HARD, SOFT, 10e-3))
    assert found.best[0] == "fitted"
    lines = repr(found).splitlines()
    assert lines[0].startswith("use: fitted (within 1 %)")
    assert [line.split()[0] for line in lines[3:5]] == ["fitted", "hardening"]
    assert all("within" in line or "off by" in line or "knows no" in line for line in lines[3:])
    assert found._repr_html_().count("<tr>") == 1 + len(ds.LAWS)
    # Hertz over Hertz is one at every depth
    figure = found.plot()
    (one,) = (line for line in figure.axes[0].lines if line.get_color() == "0.75"
              and abs(line.get_ydata()[-1] - 1.0) < 1e-9)  # fmt: skip
    assert one.get_ydata() == pytest.approx(1.0)
    assert figure.axes[0].get_legend_handles_labels()[1][-1] == "fitted"
    (title,) = (text for text in figure.texts if text.get_text() == figure.get_suptitle())
    assert 0.0 < title.get_window_extent().x0 < title.get_window_extent().x1 < figure.bbox.width
    with pytest.raises(InputError, match="max_delta_over_R"):
        ds.compare_laws(found.pair, max_delta_over_R=0.7)


def test_a_pair_and_a_set_show_themselves():
    shown = ds.Pair(SOFT, ds.Material(rigid=True), 10e-3)._repr_html_()
    assert "R = 10 mm" in shown
    # Young's modulus over 1 - nu^2 beside a rigid body
    assert "219.8 GPa" in shown
    assert shown.count("<td>rigid</td>") == 3
    found = read(set_folder(Path("kharaz-2001-oblique")))
    lines = found._repr_html_()
    assert f"kharaz-2001-oblique: {len(found.trials)} trials" in lines
    assert lines.count("<tr>") == 1 + min(len(found.trials), 12)
    figure = found.plot()
    assert len(figure.axes) == len(found.observed)
    # one speed at many angles
    assert figure.axes[0].get_xlabel() == "angle [deg]"


def test_a_pair_is_struck_at_one_speed_or_several():
    pair = ds.Pair(HARD, SOFT, 5e-3)
    one = ds.impact(pair, speed=2, law="fitted")
    assert one.impacts["fitted"].kinetic_before_J == pytest.approx(
        0.5 * 7800.0 * 4.0 / 3.0 * math.pi * 5e-3**3 * 4.0
    )
    several = ds.sweep(pair, speed=[1.0, 2.0], law=["fitted", "hertz"])
    assert several["restitution"][1] == pytest.approx(one["fitted"].restitution, rel=1e-6)
    assert several["restitution"][2:] == pytest.approx([1.0, 1.0])
    assert len(repr(several).splitlines()) == several._repr_html_().count("<tr>") + 1 == 6
    lines = several.plot().axes[0].get_lines()
    assert [line.get_label() for line in lines] == ["fitted", "hertz"]
    assert lines[0].get_ydata() == pytest.approx(several["restitution"][:2])
    heavier = ds.impact(pair, speed=2.0, law="fitted", mass=0.01)["fitted"]
    assert heavier.restitution < one["fitted"].restitution
    hardens = ds.Pair(HARD, SOFT.with_(flow=Flow(CURVE)), 5e-3)
    blow = ds.impact(hardens, speed=2.0, law="hardening")
    assert blow["hardening"].restitution > one["fitted"].restitution
    with pytest.raises(InputError, match="none of fitted follows it"):
        ds.impact(hardens, speed=2.0, law="fitted")
    with pytest.raises(InputError, match="mass: missing"):
        ds.impact(ds.Pair(SOFT, HARD, 5e-3), speed=1.0)
    with pytest.raises(InputError, match="over: with a pair"):
        ds.sweep(pair, over={"target.nu": [0.2, 0.3]})
    with pytest.raises(InputError, match=r"over: \[0.3\] .*'target.nu': "):
        ds.sweep("ball", over=[0.3])
    for wrong in ([], [1.0, math.nan], "2", -1.0, 0.0):
        for call in (ds.impact, ds.sweep):
            with pytest.raises(InputError):
                call(pair, speed=wrong)


def test_magnitudes_that_no_body_has_are_asked_back():
    steel = ds.Material(E=200e9, nu=0.3)
    assert isinstance(steel, ds.Material)
    assert isinstance(ds.Pair(steel, steel, R=0.01), ds.Pair)
    assert type(steel).__module__ == "dentscope.core.material"
    for call, said in (
        (lambda: ds.Material(E=200, nu=0.3), r"E_Pa: 200.0 .*200 GPa would be 2e\+11"),
        (lambda: ds.Material(200e9, 0.3, 300), "300 MPa would be 3e"),
        (lambda: ds.Material(200e9, 0.3, density=7.8), r"density_kg_m3.*7.8 g/cm\^3 would be 7800"),
        (lambda: ds.Pair(steel, steel, 10), r"R: 10 .*10 mm would be 0.01"),
        (lambda: ds.Pair(0.01, steel, steel), r"sphere: 0\.01"),
        (lambda: steel.with_(E=200), "Material: E_Pa: 200 .*200 GPa would be 2e"),
        (lambda: steel.with_(Sy=300), "Material: Sy_Pa: 300 .*300 MPa would be 3e"),
        (lambda: steel.with_(density=7.8), r"density_kg_m3: 7.8 .*g/cm\^3 would be 7800"),
        (lambda: steel.with_(Sy="300 MPa"), "Sy_Pa: '300 MPa'"),
        (lambda: steel.with_(rigid="yes"), "rigid: 'yes' .*True or False"),
        (lambda: steel.with_(flow="curve.csv"), "flow: 'curve.csv' .*core.flow.Flow"),
        (lambda: ds.Pair(steel, Body(200.0, 0.3), 0.01), "Pair: flat: E_Pa: 200.0 .*GPa"),
    ):
        with pytest.raises(InputError, match=said):
            call()
    assert steel.with_(Sy=300e6, density=math.nan).with_(Sy=math.inf) == steel
    # a body in N, mm and MPa knows no units; of one in SI a soft metal is none in another unit
    assert Body(200e3, 0.3, 250.0).with_(Sy=300.0).Sy == 300.0
    assert steel.with_(E=2e17).with_(E=2e5).E == 2e5


def test_a_law_that_is_not_known_says_what_comes_near():
    with pytest.raises(KeyError, match="did you mean 'fitted'"):
        ds.LAWS["fited"]
    with pytest.raises(InputError, match="did you mean 'fitted'"):
        ds.compare_laws(ds.Pair(SOFT, SOFT, 1e-3), law="fited")
    assert ds.LAWS.get("fited") is None


def test_several_speeds_keep_the_angle_of_the_set_up():
    # tan(60 degrees) = v_n/|v_t| at every speed
    many = ds.sweep("oblique-ball", law="hertz", angle_deg=60.0, speed=[1.0, 2.0])
    along = many["impact_speed_m_s"] / np.tan(np.radians(60.0))
    assert many["approach_tangential_m_s"] == pytest.approx(-along, rel=1e-12)
    assert many["angle_deg"] == pytest.approx([60.0, 60.0], rel=1e-12)
    one = ds.impact("oblique-ball", law="hertz", angle_deg=60.0, speed=2.0)["hertz"]
    assert many["rebound_spin_rad_s"][1] == pytest.approx(one.rebound_spin_rad_s, rel=1e-6)


def test_a_law_is_given_by_name_or_as_it_is():
    hertz = ds.LAWS["hertz"]
    for given in (hertz, ["hertz"], "hertz"):
        (found,) = ds.impact("ball", speed=1.0, law=given).impacts.items()
        assert (found[0], found[1].restitution) == ("hertz", pytest.approx(1.0, abs=1e-6))
    both = ds.impact("ball", speed=1.0, law=["hertz", hertz, "compact"])
    assert list(both.impacts) == ["hertz", "compact"]
    with pytest.raises(InputError, match="two laws 'hertz'"):
        ds.impact("ball", law=[hertz, replace(ds.LAWS["compact"], name="hertz")])
    with pytest.raises(InputError, match="law: 3"):
        ds.impact("ball", law=3)


@pytest.mark.parametrize("wrong", [1j, "2", "20 um", True, [1.0, 2.0], pandas.Series([1.0])])
def test_a_number_is_one_number_and_what_is_none_is_named(wrong):
    pair = ds.Pair(SOFT, SOFT, R=0.01)
    calls = {
        "speed": lambda: ds.impact("ball", speed=wrong),
        "mass": lambda: ds.impact("ball", mass=wrong),
        "friction": lambda: ds.impact("ball", friction=wrong),
        "E_Pa": lambda: ds.Material(E=wrong, nu=0.3),
        "R": lambda: ds.Pair(SOFT, SOFT, R=wrong),
        "max_delta_over_R": lambda: ds.compare_laws("nowhere.toml", max_delta_over_R=wrong),
        "speed_m_s": lambda: ds.case(pair, speed_m_s=wrong),
        "seed": lambda: ds.diagnose("leeb-steel-800hv", seed=wrong),
        "mass_kg": lambda: dynamics.Striker(mass=wrong, tip_radius=0.01),
        "impact_speed_m_s": lambda: dynamics.Approach(wrong),
    }
    if np.ndim(wrong) == 0:
        calls |= {
            "depth": lambda: ds.LAWS["fitted"].loading(pair, wrong),
            "angle_deg": lambda: ds.sweep("ball", angle_deg=wrong),
            "setup": lambda: ds.impact(3.0),
        }
    for key, call in calls.items():
        with pytest.raises(InputError, match=rf"\b{key}: "):
            call()


def test_a_number_of_any_kind_and_a_series_of_depths_are_taken():
    pair = ds.Pair(SOFT, SOFT, R=0.01)
    one = ds.impact("ball", law="hertz", speed=np.float32(2.0))["hertz"]
    assert one.contact_time_s == ds.impact("ball", law="hertz", speed=2)["hertz"].contact_time_s
    rows = pandas.Series([1e-6, 2e-6])
    assert len(ds.LAWS["fitted"].loading(pair, rows)) == 2


def test_a_wrong_word_and_what_a_file_would_not_take_are_refused():
    pair, fitted = ds.Pair(SOFT, SOFT, 0.01), ds.LAWS["fitted"]
    calls = {
        "nonsense: no such file": lambda: ds.impact("nonsense", speed=2.0),
        "hertz": lambda: ds.impact("ball", law="nonsense"),
        "kharaz-2001-oblique": lambda: ds.diagnose("nonsense"),
        "no such file": lambda: ds.case("nonsense.toml"),
        "rigid": lambda: ds.Material(2e11, 0.3, rigid="no"),
        "seed": lambda: ds.diagnose("leeb-steel-800hv", seed=-1),
        "seed: 1.9": lambda: ds.diagnose("leeb-steel-800hv", seed=1.9),
        "law: 3": lambda: ds.compare_laws(pair, law=["hertz", 3]),
        "law: hertz: .*would pass for phys": lambda: ds.diagnose(
            "leeb-steel-800hv", law=ds.LAWS["hertz"]
        ),
        "assume: air-drag": lambda: ds.diagnose("leeb-steel-800hv", assume="air-drag"),
        "pair: Material": lambda: fitted.loading(SOFT, 1e-6),
        "pair: 3": lambda: fitted.residual(3, 1e-6),
        "depth: 3 depths of 2 pairs": lambda: fitted.loading([pair, pair], [1e-6, 2e-6, 3e-6]),
    }
    for key, call in calls.items():
        with pytest.raises(InputError, match=key):
            call()
    for method in (fitted.uncertainty, fitted.share, fitted.unloading_exponent):
        with pytest.raises(InputError, match="depth: a depth is not a number"):
            method(pair, math.nan)


def test_a_blow_aslant_takes_its_friction():
    pair = ds.Pair(SOFT.with_(density=7800.0), SOFT, 0.01)
    smooth, rough = (
        ds.impact(pair, law="hertz", speed=1.0, angle_deg=45.0, friction=mu)["hertz"]
        for mu in (None, 0.1)
    )
    # sliding throughout, the impulse along the flat is mu times that across it, m v (1 + e)
    assert smooth.rebound_spin_rad_s == 0.0
    assert rough.rebound_spin_rad_s == pytest.approx(0.1 * 2.0 / (0.4 * 0.01), rel=1e-3)


def test_a_flow_curve_is_given_as_file_array_or_rows(tmp_path):
    file = tmp_path / "curve.csv"
    file.write_text("plastic_strain,stress_Pa\n0,3e8\n0.2,6e8\n")
    for given in (file, str(file), ([0.0, 0.2], [3e8, 6e8]), np.array([[0.0, 3e8], [0.2, 6e8]]),
                  CURVE, Flow(CURVE)):  # fmt: skip
        body = ds.Material(2e11, 0.3, flow=given)
        assert (body.Sy, body.flow) == (3e8, Flow(CURVE))
    with pytest.raises(InputError, match=r"flow: 300 .*300 MPa would be 3e\+08"):
        ds.Material(2e11, 0.3, flow=([0.0, 0.2], [300, 600]))
    with pytest.raises(InputError, match=r"flow: shape \(3,\) .*strains, stresses"):
        ds.Material(2e11, 0.3, flow=[1.0, 2.0, 3.0])
    with pytest.raises(InputError, match="the flow curve's first stress, 3e"):
        ds.Material(2e11, 0.3, Sy=4e8, flow=CURVE)


def test_signatures_say_what_is_taken_and_one_thing_is_returned():
    for call in (ds.impact, ds.sweep, ds.case, ds.compare_laws, ds.diagnose, ds.material,
                 ds.Material, ds.Pair):  # fmt: skip
        told = inspect.signature(call)
        kinds = {p.kind for p in told.parameters.values()}
        assert not kinds & {inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD}
        assert all(p.annotation not in ("Any", p.empty) for p in told.parameters.values())
        assert "|" not in str(told.return_annotation)
    # every key of [impact] and of [sweep] is a keyword, speed and mass by their short names
    names = {"impact_speed_m_s": "speed", "mass_kg": "mass"}
    for call, table in ((ds.impact, ImpactTable), (ds.sweep, SweepTable)):
        taken = set(inspect.signature(call).parameters) - {"setup", "law", "over"}
        keys = {names.get(k, k) for k in table.model_fields} - {"laws"}
        assert keys - taken == set()
        assert taken - keys == ({"mass", "friction"} if call is ds.impact else set())
    assert "nu: 'float'" in pydoc.render_doc(ds.Material)


def test_what_is_computed_goes_to_another_process_and_back():
    blow = ds.impact("ball", law="fitted", speed=1.0)
    back = pickle.loads(pickle.dumps(blow))
    assert back["fitted"].restitution == blow["fitted"].restitution
    assert back.checks() == blow.checks()
    pair = ds.Pair(SOFT, SOFT, 5e-3)
    for name, law in pickle.loads(pickle.dumps(ds.LAWS)).items():
        assert law.loading(pair, 1e-5) == ds.LAWS[name].loading(pair, 1e-5)
        assert law == law
        assert isinstance(hash(law), int)


def test_the_mechanisms_of_a_set_up_go_there_as_well(tmp_path):
    file = tmp_path / "rate.toml"
    file.write_text(template("ball") + "\n[mechanisms]\nhalf-space-waves = true\n")
    asked = pickle.loads(pickle.dumps(read_setup(file))).asked
    assert [m.name for m in asked.mechanisms] == ["half-space-waves"]


USER = """
from collections.abc import Mapping
from pathlib import Path

import dentscope as ds
import numpy as np
from dentscope.discrepancy import Mechanism, Parameter, Surroundings
from dentscope.dynamics import Scene

hard: ds.Material = ds.Material(E=210e9, nu=0.3, Sy=2e9, density=7800)
soft: ds.Material = ds.Material(205e9, 0.29, flow=([0.0, 0.1], [250e6, 400e6]))
known: ds.Material = ds.material("aluminium-6061-t6")
pair: ds.Pair = ds.Pair(sphere=hard, flat=soft, R=5e-3)
force = ds.LAWS["fitted"].loading(pair, np.linspace(0.0, 1e-5, 5)) + 1.0
best: tuple[str, ...] = ds.compare_laws(pair, law=["fitted", "hertz"]).best
e: float = ds.impact(pair, speed=2.0, law="hardening")["hardening"].restitution
mean = ds.sweep("ball", speed=[1.0, 2.0], angle_deg=60.0)["restitution"].mean()
ds.case(pair, level="smoke").plot().savefig("case.png")
ds.case(pair).plot_fields().savefig("fields.png")
drawn: list[Path] = ds.case(pair).draw_fields("fields", cut=True)
raised: type[ValueError] = ds.core.InputError


class Mine(Mechanism):
    name, title, equations = "mine", "of my own", ""
    parameters = (Parameter("work", "J/kg", 1e-3, 1.0, "log", 0.0, "a guess"),)

    def attach(self, scene: Scene, values: Mapping[str, float], around: Surroundings) -> Scene:
        return scene.with_(approach=scene.approach)


told: str = ds.diagnose("leeb-steel-800hv", mechanisms=[Mine()]).finding
# what is wrong is found
ds.impact(pair, sped=2.0)
ds.impact(pair, speed="2 m/s")
ds.Material(210e9, 0.3, Sy="300 MPa")
ds.case(pair, level="fine")
ds.compere_laws(pair)
"""


def test_a_users_own_file_finds_the_types(tmp_path):
    (tmp_path / "mine.py").write_text(USER)
    answer = python("-m", "mypy", "--strict", "--no-incremental", "mine.py", cwd=tmp_path)
    first = USER.splitlines().index("ds.impact(pair, sped=2.0)") + 1
    mistakes = [line for line in answer.stdout.splitlines() if ": error:" in line]
    assert [int(line.split(":")[1]) for line in mistakes] == list(range(first, first + 5)), mistakes
