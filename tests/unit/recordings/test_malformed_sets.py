"""Malformed recording sets: each kind gives its line with file and place, never a traceback."""

import re
from pathlib import Path

import pytest
from dentscope.core.errors import InputError
from dentscope.recordings import read

SET = """format = "recording-set/1"
name = "rod"
gravity_m_s2 = 9.81
[target]
E_Pa = { value = 2.0e11, std = 4.0e9 }
nu = 0.3
[strikers.rod]
shape = "rod"
tip_radius_m = 0.01
mass_kg = 0.5
radius_m = 0.01
length_m = 0.3
[noise]
restitution = 0.01
"""
TRIALS = """trial,striker,angle_deg,impact_speed_m_s,restitution,restitution_std
a,rod,90,1.0,0.5,0.01
b,rod,45,2.0,0.4,
"""
TRACE = "time_s,tip_height_m\n0,1e-3\n1e-3,0\n"
PROFILE = "x_m,z_m\n0,0\n1e-6,-1e-6\n"


def write(folder, *, toml=SET, trials=TRIALS, trace=TRACE, profile=PROFILE):
    for name, content in (
        ("set.toml", toml), ("trials.csv", trials), ("traces/a.csv", trace),
        ("profiles/a.csv", profile),
    ):  # fmt: skip
        if content is not None:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            data = content if isinstance(content, bytes) else content.encode()
            (folder / name).write_bytes(data)
    return folder


PRESSES = """trial,striker,angle_deg,impact_speed_m_s,load_N,restitution,permanent_depth_m
a,rod,90,1.0,,0.5,1e-5
p,rod,,,400,,2e-5
"""


def presses(old, new):
    assert old in PRESSES
    noise = SET + "permanent_depth_m = 1e-6\n"
    return {"toml": noise, "trials": PRESSES.replace(old, new), "trace": None, "profile": None}


def toml(old, new):
    assert old in SET
    return {"toml": SET.replace(old, new)}


def trials(old, new):
    assert old in TRIALS
    return {"trials": TRIALS.replace(old, new)}


CASES = {
    # set.toml
    "no set.toml": ({"toml": None}, r"set\.toml: no such file"),
    "not TOML": ({"toml": "format = \n"}, r"set\.toml: not valid TOML"),
    "decimal comma": (toml("mass_kg = 0.5", "mass_kg = 0,5"), r"not valid TOML .*a point in a num"),
    "a fraction for a std": (
        toml("std = 4.0e9", "std = 0.02"), r"target.E_Pa: .*0, or a std from 1e-07 times",
    ),
    "Brinell's number": (
        toml("nu = 0.3", "nu = 0.3\nhardness_Pa = 120"), r"120 HBW or HV would be 1.17\d+e\+09",
    ),
    "a sphere of two radii": (
        toml('"rod"\ntip_radius_m = 0.01', '"sphere"\ntip_radius_m = 0.02'),
        r"rod.radius_m: 0.01 .*a sphere's is that of its tip, 0.02",
    ),
    "empty TOML": ({"toml": ""}, r"set\.toml: format: missing"),
    "binary": ({"toml": b"\xff\xfe\x00"}, r"set\.toml: cannot be read"),
    "other format": (toml("set/1", "set/2"), r"format: 'recording-set/2' .*recording-set/1"),
    "unknown key": (toml("name =", "nmae ="), r"nmae: unknown key.*name"),
    "no gravity, and a height of fall": (
        {
            "toml": SET.replace("9.81", "0.0"),
            "trials": TRIALS.replace("impact_speed_m_s", "drop_height_m"),
        },
        r"gravity_m_s2: 0 .*height of fall and no speed, as a",
    ),
    "negative std": (toml("std = 4.0e9", "std = -1.0"), r"target\.E_Pa\.std: -1\.0"),
    "infinite": (toml("mass_kg = 0.5", "mass_kg = inf"), r"mass_kg\.value: inf .*finite"),
    "quantity without value": (toml("value = 2.0e11, ", ""), r"target\.E_Pa\.value: missing"),
    "rigid target": (toml("[target]", "[target]\nrigid = true"), r"target\.rigid: true .*gives"),
    "no target": (toml("[target]", "[targets]"), r"target: missing"),
    "other law": (toml("[target]", '[target]\nlaw = "plastic"'), r"target\.law: 'plastic'"),
    "no striker": (
        {"toml": SET.split("[strikers")[0]}, r"strikers: missing"
    ),
    "striker without a name": (
        toml("[strikers.rod]", "[strikers]"),
        r"^[^\n]*strikers: no table of a name \(allowed: \[strikers\.NAME\]\)$",
    ),
    "number for a table": (
        toml("[target]", "friction = 0.3\n[target]"),
        r"friction: 0\.3 \(allowed: a table, \[friction\]\)",
    ),
    "shape left out": (toml('shape = "rod"\n', ""), r"strikers\.rod\.shape: missing"),
    "modulus in GPa": (
        toml("value = 2.0e11", "value = 200"),
        r"target\.E_Pa: .*200 GPa would be 2e\+11",
    ),
    "density in g/cm^3": (
        toml("nu = 0.3", "nu = 0.3\ndensity_kg_m3 = 7.85"),
        r"density_kg_m3: .*7\.85 g/cm\^3 would be 7850",
    ),
    "true for a number": (toml("mass_kg = 0.5", "mass_kg = true"), r"mass_kg: True .*a number"),
    "400 digits": (toml("mass_kg = 0.5", f"mass_kg = {'9' * 400}"), r"mass_kg.*: 9+\.\.\.9"),
    "5000 digits": (toml("mass_kg = 0.5", f"mass_kg = {'9' * 5000}"), r"too many digits"),
    "mass 0": (toml("mass_kg = 0.5", "mass_kg = 0"), r"mass_kg: 0 .*from 1e-18 to"),
    "noise 0": (toml("restitution = 0.01", "restitution = 0"), r"noise\.restitution: 0 "),
    "no noise at all": (
        {"toml": SET.replace("restitution = 0.01", "")},
        r"noise\.restitution: .*fewer than 3 repeats",
    ),
    "repeats that do not differ": (
        {"toml": SET.replace("restitution = 0.01", ""),
         "trials": TRIALS.split("\n")[0].replace(",restitution_std", "")
         + "".join(f"\n{k},rod,90,1,0.5" for k in "abc"), "trace": None, "profile": None},
        r"noise\.restitution: .*fewer than 3 repeats that differ",
    ),
    # trials.csv
    "no trials.csv": ({"trials": None}, r"trials\.csv: no such file"),
    "empty trials": ({"trials": ""}, r"trials\.csv: empty"),
    "only a header": ({"trials": TRIALS.split("\n")[0]}, r"trials\.csv: no trial"),
    "not UTF-8": ({"trials": TRIALS.encode() + b"\xe9,rod"}, r"trials\.csv: not UTF-8"),
    "NUL byte": ({"trials": TRIALS + "c\0,rod,90,1,,\n"}, r"trials\.csv: "),
    "open quote": ({"trials": TRIALS + 'c,"rod,90,1,,\n'}, r"trials\.csv: not comma"),
    "semicolons": ({"trials": TRIALS.replace(",", ";")}, r"row 1: columns are not separated"),
    "unknown column": (trials("restitution,", "restituion,"), r"restituion: unknown column .*mean"),
    "column twice": (trials("restitution_std", "restitution"), r"column restitution: given twice"),
    "column without name": (trials("restitution_std", ""), r"row 1: column 6 has no name"),
    "no trial column": (trials("trial,", "note,"), r"row 1, column trial: missing"),
    "no angle column": (trials("angle_deg,", "order,"), r"row 1, column angle_deg: missing"),
    "no approach": (trials("impact_speed_m_s", "order"), r"row 1: no approach"),
    "approach empty": (trials("90,1.0", "90,"), r"row 2: no approach"),
    "angle empty": (trials("rod,90,", "rod,,"), r"row 2, column angle_deg: empty"),
    "angle 0": (trials("rod,45", "rod,0"), r"row 3, column angle_deg: 0 .*up to 90"),
    "number with unit": (
        trials("2.0,0.4", "2 m/s,0.4"), r"row 3, column impact_speed_m_s: '2 m/s'"
    ),
    "negative speed": (trials("2.0,0.4", "-2.0,0.4"), r"column impact_speed_m_s: -2 .*above"),
    "nan cell": (trials("2.0,0.4", "2.0,nan"), r"row 3, column restitution: 'nan'"),
    "std 0": (trials("0.5,0.01", "0.5,0"), r"row 2, column restitution_std: 0 .*above 0"),
    "std without value": (trials("0.5,0.01", ",0.01"), r"restitution_std: restitution is empty"),
    "std without column": (
        trials("restitution_std", "peak_force_N_std"), r"peak_force_N_std: there is no column"
    ),
    "dent in mm": (
        {"toml": SET + "dent_diameter_m = 1e-5\n",
         "trials": TRIALS.replace("restitution,restitution_std", "dent_diameter_m,note")},
        r"trial a, column dent_diameter_m: 0\.5 .*the tip's own diameter, 0\.02",
    ),
    "too many cells": (trials("0.4,", "0.4,,7"), r"row 3: 7 cells under 6 columns"),
    "trial twice": (trials("b,rod", "a,rod"), r"row 3, column trial: 'a' is also in row 2"),
    "trial empty": (trials("b,rod", ",rod"), r"row 3, column trial: empty"),
    "trial is a path": (trials("b,rod", "../b,rod"), r"trial: '\.\./b' .*can name a file"),
    "other striker": (trials("b,rod", "b,ball"), r"row 3, column striker: no striker 'ball' .*rod"),
    # quasi-static presses
    "load beside a speed": (presses("90,1.0,,", "90,1.0,400,"), r"row 2, column load_N: .*a speed"),
    "press with a restitution": (
        presses("400,,", "400,0.5,"), r"row 3, column restitution: '0\.5' of a press .*shows perm"
    ),
    "press that leans": (presses("p,rod,,", "p,rod,45,"), r"column angle_deg: 45 .*90 or empty"),
    "depth under load of an impact": (
        presses("permanent_depth_m", "press_depth_m"), r"row 2, column press_depth_m: .*an impact"
    ),
    "neither load nor speed": (presses("400", ""), r"row 3: no approach .*load_N"),
    "gauge of nothing": ({"toml": SET + "[gauge]\ncraters = 0.01\n"}, r"gauge\.craters: unknown"),
    "gauge in percent": (
        {"toml": SET + "[gauge]\nrestitution = 5.0\n"}, r"gauge\.restitution: 5\.0 .*0\.5"
    ),
    "other edge of a dent": ({"toml": SET + 'dent_edge = "crest"\n'}, r"dent_edge: 'crest' .*rim"),
    "edge of a dent by itself": ({"toml": 'dent_edge = "rim"\n' + SET}, r"stands in \[noise\]"),
    # traces and profiles
    "trace without time": ({"trace": "tip_height_m\n0\n1\n"}, r"a\.csv: row 1, column time_s"),
    "trace without curve": ({"trace": "time_s\n0\n1\n"}, r"traces/a\.csv: row 1: no curve"),
    "trace goes back": (
        {"trace": "time_s,force_N\n0,1\n2,1\n1,1\n"}, r"row 4, column time_s: 1 after 2"
    ),
    "trace of one point": ({"trace": "time_s,force_N\n0,1\n"}, r"traces/a\.csv: 1 points"),
    "profile with gap": ({"profile": "x_m,z_m\n0,0\n1e-6,\n"}, r"row 3, column z_m: empty"),
    "profile with other column": (
        {"profile": "x_m,y_m\n0,0\n1,1\n"}, r"profiles/a\.csv: row 1, column y_m: unknown"
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", CASES)
def test_each_kind_of_mistake_gives_its_line(kind, tmp_path):
    changes, line = CASES[kind]
    with pytest.raises(InputError) as caught:
        read(write(tmp_path, **changes))
    lines = str(caught.value).splitlines()
    assert any(re.search(line, text) for text in lines), lines
    assert all(text.startswith(str(tmp_path)) for text in lines)


@pytest.mark.parametrize("wrong", ["format = \n", SET.split("[strikers")[0], None])
def test_rows_are_not_blamed_for_what_set_toml_lacks(wrong, tmp_path):
    with pytest.raises(InputError) as caught:
        read(write(tmp_path, toml=wrong))
    assert "trials.csv" not in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "note"),
    [(",90,", ",1.5708,", "no angle_deg is above 1.5708: are they in radians?"),
     ("restitution_std", "temperature_K", "temperature_K 0.01: is it in degrees Celsius?"),
     ("impact_speed_m_s,restitution,restitution_std\na,rod,90,1.0",
      "drop_height_m,restitution,restitution_std\na,rod,90,100",
      "drop_height_m 100: is it in another unit?"),
     ("restitution = 0.01", "restitution = 1",
      "noise.restitution 1 is above every reading: in another unit?")],
)  # fmt: skip
def test_a_slip_of_the_unit_that_may_be_true_is_a_note(old, new, note, tmp_path):
    rows = TRIALS.replace("rod,45,", "rod,90,").replace(old, new)
    assert note in read(write(tmp_path, toml=SET.replace(old, new), trials=rows)).notes


def test_trace_of_no_trial_and_missing_folder(tmp_path):
    write(tmp_path)
    (tmp_path / "traces" / "z.csv").write_text(TRACE)
    with pytest.raises(InputError, match=r"traces/z\.csv: there is no trial 'z'"):
        read(tmp_path)
    with pytest.raises(InputError, match="no such folder"):
        read(tmp_path / "nothing")


def test_all_mistakes_come_at_once(tmp_path):
    write(
        tmp_path, **toml("nu = 0.3", "nu = 0.7") | trials("b,rod,45", "b,ball,145"),
        trace="time_s,force_N\n0,x\n",
    )  # fmt: skip
    with pytest.raises(InputError) as caught:
        read(tmp_path)
    lines = str(caught.value).splitlines()
    assert len(lines) == 5
    assert [Path(text.split(": ")[0]).name for text in lines] == [
        "set.toml", "trials.csv", "trials.csv", "a.csv", "a.csv",
    ]  # fmt: skip
