"""Load against depth of machines: depths and stiffness of presses whose truth is known."""

import math

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.recordings import read
from dentscope.reduce.gates import Refused
from dentscope.reduce.kinds import load_kind
from made_records import workbook

TOP, DEEP, BACK, POWER = 800.0, 6e-5, 9e-6, 1.4  # N, m, m, of unloading
SLOPE = POWER * TOP / BACK


def record(*, cycles=1, noise=1e-3, preload=0.0, machine=0.0, seed=0):
    """Rows time [s], depth [m], load [N]; loading as h^1.2, unloading as a power."""
    rng = np.random.default_rng(seed)
    parts = [(np.linspace(-5e-6, 0.0, 40), np.zeros(40))]
    peaks = np.linspace(0.2, 1.0, cycles) if cycles > 1 else [1.0]
    old = 0.0
    for k, peak in enumerate(peaks):
        up = np.linspace(0.4 * old, peak, 150)
        last = 0.0 if k == len(peaks) - 1 else 0.4 * peak
        down = np.linspace(peak, last, 120)
        depth = np.where(up < old, DEEP * old ** (1 / 1.2) - _back(old, up), DEEP * up ** (1 / 1.2))
        parts += [(depth, up), (DEEP * peak ** (1 / 1.2) - _back(peak, down), down)]
        old = peak
    h, p = (np.concatenate(x) for x in zip(*parts, strict=True))
    keep = np.arange(p.size) >= (np.argmax(p > preload) if preload else 0)
    h, p = h[keep], TOP * p[keep]
    h = h + machine * p + rng.normal(0.0, noise * DEEP, p.size) + 2e-6
    return np.stack([0.05 * np.arange(p.size), h, p + rng.normal(0.0, noise * TOP, p.size)])


def _back(peak, load):
    """What has come back at a load [m]: the contact is as stiff as the root of its load."""
    return 0.0 if not peak else BACK * math.sqrt(peak) * (1.0 - (load / peak) ** (1.0 / POWER))


def text(rows, head="time_s,depth_um,load_N\n", sizes=(1.0, 1e6, 1.0), between=",", comma="."):
    lines = (
        between.join(f"{s * v:.7g}" for s, v in zip(sizes, row, strict=True)) for row in rows.T
    )
    return head + "\n".join(lines).replace(".", comma) + "\n"


def reduced(path, content, **options):
    path.write_text(content)
    return load_kind("press").run(path, options, source="test")


def test_what_was_hardly_taken_off_is_as_unsure_as_its_power(tmp_path):
    rows = record()
    top = int(np.argmax(rows[2]))
    rest = rows[:, top:]
    whole = np.concatenate([rows[:, :top], rest[:, rest[2] > 0.74 * TOP]], axis=1)
    left = reduced(tmp_path / "a.csv", text(whole)).values["permanent_depth_m"]
    assert abs(left.value - (DEEP - BACK)) < 2.0 * left.std < 0.5 * BACK * 2.0


MAKERS = {
    "zwick": dict(
        head="Probe 1\nPrüfzeit;Standardweg;Standardkraft\ns;mm;N\n", sizes=(1, -1e3, -1),
        between=";", comma=",",
    ),
    "instron": dict(head='"Time (s)","Extension (mm)","Load (kN)"\n', sizes=(1, 1e3, 1e-3)),
    "agilent": dict(
        head="Time On Sample\tDisplacement Into Surface\tLoad On Sample\ns\tnm\tmN\n",
        sizes=(1, 1e9, 1e3), between="\t",
    ),
    "anton paar": dict(head="Time [s];Pd [nm];Fn [mN]\n", sizes=(1, 1e9, 1e3), between=";"),
    "in spanish": dict(head="Tiempo (s);Profundidad (µm);Carga (kN)\n", sizes=(1, 1e6, 1e-3),
                       between=";", comma=","),
    "in french": dict(head="Temps (s);Déplacement (µm);Effort (kN)\n", sizes=(1, 1e6, 1e-3),
                      between=";", comma=","),
    "sunk in, in french": dict(head="Temps (s);Enfoncement (µm);Charge (N)\n", sizes=(1, 1e6, 1),
                               between=";", comma=","),
    "a stroke in french": dict(head="Temps (s);Course (mm);Force (N)\n", sizes=(1, 1e3, 1),
                               between=";", comma=","),
    "hysitron": dict(head="Number of Points = 310\nTime (s)\tDepth (nm)\tLoad (µN)\n",
                     sizes=(1, 1e9, 1e6), between="\t"),
}  # fmt: skip


@pytest.mark.parametrize("maker", MAKERS)
def test_a_press_is_read_as_each_maker_writes_it(maker, tmp_path):
    found = reduced(tmp_path / "a.txt", text(record(), **MAKERS[maker]), machine_compliance_m_N=0.0)
    truth = {"press_depth_m": DEEP, "recovered_depth_m": BACK, "permanent_depth_m": DEEP - BACK,
             "unloading_stiffness_N_m": SLOPE}  # fmt: skip
    assert found.values["load_N"].value == pytest.approx(TOP, rel=0.005)
    for name, true in truth.items():
        one = found.values[name]
        assert abs(one.value - true) < 3.0 * one.std, name
        assert one.std < 0.08 * true, name
    assert abs(found.values["contact_zero_m"].value - 2e-6) < 1e-6
    (row,) = found.trials
    assert set(row.observables) == {
        "load_N", "permanent_depth_m", "press_depth_m", "recovered_depth_m"
    }  # fmt: skip


def test_an_unknown_machine_keeps_depths_under_load_out_of_the_row(tmp_path):
    found = reduced(tmp_path / "a.csv", text(record(machine=2e-9)))
    assert set(found.trials[0].observables) == {"load_N", "permanent_depth_m"}
    assert any("compliance is not known" in note for note in found.notes)
    left = found.values["permanent_depth_m"]
    assert abs(left.value - (DEEP - BACK)) < 3.0 * left.std


def test_several_cycles_show_the_machines_compliance(tmp_path):
    content = text(record(cycles=8, machine=3e-9))
    found = reduced(tmp_path / "a.csv", content)
    machine = found.values["machine_compliance_m_N"]
    assert abs(machine.value - 3e-9) < 2.0 * machine.std
    assert machine.std < 2e-9
    deepest = found.values["press_depth_m"]
    assert abs(deepest.value - DEEP) < 2.0 * deepest.std
    each = reduced(tmp_path / "a.csv", content, cycles="each")
    assert len(each.trials) == 8
    loads = [t.observables["load_N"].value for t in each.trials]
    assert loads == pytest.approx(list(TOP * np.linspace(0.2, 1.0, 8)), rel=0.01)
    assert any("in common" in note for note in each.notes)


def test_a_preload_makes_the_zero_as_unsure_as_what_it_hides(tmp_path):
    seen, hidden = (
        reduced(tmp_path / "a.csv", text(record(preload=p)), machine_compliance_m_N=0.0)
        for p in (0.0, 0.1)
    )
    zero, unsure = (f.values["contact_zero_m"] for f in (seen, hidden))
    assert unsure.std > 3.0 * zero.std
    assert abs(unsure.value - 2e-6) < 2.0 * unsure.std


def test_a_load_cell_that_was_not_tared_is(tmp_path):
    """Its 30 N are seen in the air; a preload that is held there has no air before it."""
    rows = record()
    found = reduced(tmp_path / "a.csv", text(rows), machine_compliance_m_N=0.0)
    off = np.array([[0.0], [0.0], [30.0]])
    tared = reduced(tmp_path / "b.csv", text(rows + off), machine_compliance_m_N=0.0)
    for name, value in found.values.items():
        assert tared.values[name].value == pytest.approx(value.value, rel=0.01, abs=2e-7)
    assert any("N in the air: taken off" in note for note in tared.notes)
    assert not any("in the air" in note for note in found.notes)


def test_what_the_header_says_of_the_machine_is_taken_off_or_doubted(tmp_path):
    head = "Machine Comp: {} nm/N\nTip: ball\ntime_s,depth_um,load_N\n"
    fits = reduced(tmp_path / "a.csv", text(record(machine=2e-9), head=head.format(2)))
    assert fits.values["machine_compliance_m_N"].value == pytest.approx(2e-9)
    deepest = fits.values["press_depth_m"]
    assert abs(deepest.value - DEEP) < 3.0 * deepest.std
    beyond = reduced(tmp_path / "a.csv", text(record(machine=2e-9), head=head.format(900)))
    assert "machine_compliance_m_N" not in beyond.values
    assert any("not in it, or wrong" in note for note in beyond.notes)
    with pytest.raises(InputError, match="machine_compliance_m_N: 9e-07 m/N, and all"):
        reduced(tmp_path / "a.csv", text(record()), machine_compliance_m_N=9e-7)


def test_the_table_with_load_and_depth_is_found_among_several(tmp_path):
    first = "Approach Points: 3\nTime_s\tMotor_mm\n0.1\t0.2\n0.2\t0.3\n0.3\t0.4\nTest Points: 310\n"
    head = first + "Time_s\tDisp_nm\tForce_µN\tDisp_V\n"
    rows = record()
    content = text(np.vstack([rows, rows[1]]), head=head, sizes=(1, 1e9, 1e6, 1e5), between="\t")
    found = reduced(tmp_path / "a.hld", content, machine_compliance_m_N=0.0)
    assert found.values["press_depth_m"].value == pytest.approx(DEEP, rel=0.03)


def test_a_workbook_without_a_load_on_its_first_sheet_names_the_others(tmp_path):
    rows = [["Segment", "Displacement Into Surface", "Load On Sample", "Stiffness"],
            ["", "nm", "mN", "N/m"]]  # fmt: skip
    rows += [["", 1e9 * row[1], 1e3 * row[2], 1.0] for row in record().T]
    path = workbook(
        tmp_path / "a.xlsx", [["Test", "Hardness"], [1, 6.7]], title="Results", **{"Test 001": rows}
    )
    kind = load_kind("press")
    with pytest.raises(InputError, match=r"load: no column .* --sheet, one of Results, Test 001"):
        kind.run(path, {}, source="test")
    found = kind.run(path, {"sheet": "Test 001", "machine_compliance_m_N": 0.0}, source="test")
    assert found.values["load_N"].value == pytest.approx(TOP, rel=0.005)


def _hole(rows):
    rows = rows.copy()
    top = int(np.argmax(rows[2]))
    rows[2, top - 6 : top + 6] = np.nan
    return rows


@pytest.mark.parametrize(
    ("look", "spoil"),
    [
        ("equal loads", lambda r: np.stack([r[0], r[1], np.minimum(r[2], 0.8 * TOP)])),
        ("rows without a number", _hole),
        ("the load falls to", lambda r: r[:, : 1 + np.argmax(r[2])]),
        ("rows with a load", lambda r: r[:, ::30]),
        ("times the noise",
         lambda r: np.stack([r[0], r[1], np.sin(7.0 * np.arange(r[0].size) ** 2)])),
    ],
)  # fmt: skip
def test_what_is_no_whole_press_is_refused_for_its_look(look, spoil, tmp_path):
    with pytest.raises(Refused, match=look) as refused:
        reduced(tmp_path / "a.csv", text(spoil(record())), machine_compliance_m_N=0.0)
    refused.value.draw(tmp_path / "refused.png")
    assert (tmp_path / "refused.png").stat().st_size > 10_000


def test_loads_out_of_range_beside_depths_are_no_heading(tmp_path):
    cells = [
        (f"{1e6 * h:.5f}", "9.9E37" if p > 0.8 * TOP else f"{p:.5f}") for _, h, p in record().T
    ]
    content = "\n".join([",".join(row) for row in [("Depth (um)", "Load (N)"), *cells]])
    with pytest.raises(Refused, match="rows without a number"):
        reduced(tmp_path / "a.csv", content, machine_compliance_m_N=0.0)


def test_presses_become_rows_of_a_set(tmp_path, prints):
    (tmp_path / "a.csv").write_text(text(record()))
    command = ("reduce", "press", tmp_path / "a.csv", "--machine-compliance-m-N", "0")
    where = tmp_path / "set"
    assert "rows of" in prints(*command, "--tip-radius-m", "0.0025", "--into", where)
    found = read(where, unfinished=True)
    assert found.trials.pressed.tolist() == [True]
    assert found.trials.load_N[0] == pytest.approx(TOP, rel=0.005)
    assert found.setup.strikers["ball"].tip_radius_m.value == 0.0025
    assert {p.suffix for p in (where / "reduced").iterdir()} == {".json", ".png"}
