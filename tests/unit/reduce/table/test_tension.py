"""Tension tests whose rise is sparse, bent, or the machine's: within the error, or refused."""

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.gates import Refused
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.table.rise import elastic_rise
from dentscope.reduce.table.tension import reduce_tension

E = 195e9


def steel(stress):
    """Total strain of a metal that yields at 150 MPa and hardens to five times that."""
    return stress / E + np.maximum(stress - 150e6, 0.0) ** 2 / 2e17 / 10.0


def pulled(strain, stress, **given):
    return reduce_tension(
        strain, stress, **({"strain_is": "true", "E": None, "source": "test"} | given)
    )


@pytest.mark.parametrize(
    ("seen", "noise"), [(70e6, 3e-5), (95e6, 1e-5), (130e6, 0.0)], ids=["few", "fewer", "clean"]
)
def test_a_rise_that_was_thinned_out_does_not_take_yielding_for_it(seen, noise):
    """Every three seconds at first, once a minute then: four rows from the rise to a tenth."""
    stress = np.concatenate([np.linspace(0.0, seen, 20), [190e6, 250e6], np.linspace(3e8, 9e8, 60)])
    strain = steel(stress) + noise * np.random.default_rng(1).normal(size=stress.size)
    found = pulled(strain, stress)
    assert abs(found.modulus.value - E) < max(2.5 * found.modulus.std, 1e-3 * E)
    assert found.modulus.std < 0.3 * E
    assert abs(found.values["Sy_Pa"].value - proof()) < 3.0 * found.values["Sy_Pa"].std


def proof():
    stress = np.linspace(150e6, 400e6, 4000)
    return np.interp(2e-3, steel(stress) - stress / E, stress)


@pytest.mark.parametrize(
    ("give", "slack", "why"),
    [
        (5.0, 0.0, "no engineering metal"),
        (12.0, 0.01, "no engineering metal"),
        (25.0, 0.03, "metal does"),
    ],
    ids=["give", "slack and give", "a soft machine"],
)
def test_a_machine_that_is_read_as_strain_gives_no_modulus(give, slack, why):
    stress = np.linspace(0.0, 9e8, 400)
    strain = steel(stress) + give * stress / E + slack * np.minimum(stress / 2e8, 1.0) ** 0.5
    with pytest.raises(Refused, match=why):
        pulled(strain, stress)
    told = pulled(strain, stress, E=E)
    assert any("gives way" in note for note in told.notes)
    assert told.values["E_Pa"].std > 0.8 * E


@pytest.mark.parametrize("rows", [3, 4, 5])
def test_a_bent_rise_of_few_rows_needs_the_modulus(rows):
    stress = np.concatenate([np.linspace(100e6, 350e6, rows), np.linspace(400e6, 9e8, 60)])
    strain = steel(stress) + 2e-3 * (stress > 200e6)
    with pytest.raises(Refused, match="too short, bent or scattered"):
        pulled(strain, stress)
    assert pulled(strain, stress, E=E).values["E_Pa"].value == E


@pytest.mark.parametrize("rows", [3, 4, 5])
def test_a_handful_of_rows_hardly_tells_its_own_scatter(rows):
    """Those of a rise to 350 MPa, off by what a gauge is off; the metal then yields."""
    pulls = []
    for seed in range(60):
        stress = np.concatenate([np.linspace(110e6, 350e6, rows), np.linspace(400e6, 9e8, 60)])
        strain = stress / E + np.maximum(stress - 350e6, 0.0) ** 2 / 1e19
        strain += 2e-5 * np.random.default_rng(seed).normal(size=stress.size)
        found = elastic_rise(strain, stress, "test").modulus
        pulls.append((found.value - E) / found.std)
    assert np.abs(pulls).max() < 2.0
    stress = np.concatenate([[210e6, 332e6, 400e6], np.linspace(420e6, 1.05e9, 60)])
    strain = np.concatenate([[-1.16e-3, 0.47e-3, 1.25e-3], np.linspace(2e-3, 0.3, 60)])
    with pytest.raises(Refused, match="too short, bent or scattered"):
        pulled(strain, stress)


@pytest.mark.parametrize("part", [0.03, 0.06, 0.1])
def test_slack_at_the_start_is_not_the_metal(part):
    stress = np.linspace(0.0, 9e8, 900)
    strain = steel(stress) + 1e-3 * np.minimum(stress / (part * 9e8), 1.0) ** 0.5
    found = pulled(strain, stress)
    assert abs(found.modulus.value - E) < min(3.0 * found.modulus.std + 1.0, 0.1 * E)


@pytest.mark.parametrize("part", [0.3, 0.6])
def test_a_specimen_that_slips_is_refused_and_one_that_yields_with_a_fall_is_not(part):
    stress = np.linspace(0.0, 9e8, 900)
    again = np.linspace(1.0 - part, 1.0, 15) * stress[200]
    gone = steel(stress[200]) + 2e-3 - (stress[200] - again) / E
    slipped = np.insert(steel(stress) + 2e-3 * (stress > stress[200]), 201, gone)
    with pytest.raises(Refused, match="rises again as the metal does elastically"):
        pulled(slipped, np.insert(stress, 201, again))
    # slowly back, as grips take hold again: a steel loses a third by yielding, no metal 0.6
    slow = steel(stress[200]) + 2e-3 + 4.0 * (again - again[0]) / E
    gone_by = 2e-3 + 4.0 * part * stress[200] / E
    later = np.insert(steel(stress) + gone_by * (stress > stress[200]), 201, slow)
    if part > 0.5:
        with pytest.raises(Refused, match="falls by 60% at a strain of"):
            pulled(later, np.insert(stress, 201, again))
    else:
        assert pulled(later, np.insert(stress, 201, again)).modulus.value == pytest.approx(E, 0.01)
    strain = np.concatenate([np.linspace(0.0, 3e8, 100) / E, np.linspace(2e-3, 0.2, 400)])
    level = np.interp(strain[100:], [2e-3, 0.02, 0.2], [2.6e8, 2.6e8, 5e8])
    found = pulled(strain, np.concatenate([np.linspace(0.0, 3e8, 100), level]))
    assert found.modulus.value == pytest.approx(E, rel=0.01)
    # partial unloadings: the strain goes back with the load
    down = np.linspace(0.0, part, 15)
    loop = np.concatenate([1.0 - down, 1.0 - down[::-1]]) * stress[400]
    back = steel(stress[400]) - (stress[400] - loop) / E
    whole = [np.insert(a, 401, b) for a, b in ((steel(stress), back), (stress, loop))]
    assert pulled(*whole).modulus.value == pytest.approx(E, rel=0.01)


def test_a_travel_is_told_and_a_refused_test_is_drawn(tmp_path):
    stress = np.linspace(0.0, 900.0, 400)
    for give, name in ((0.0, "a"), (15.0, "b")):
        travel = 50.0 * (steel(1e6 * stress) + give * 1e6 * stress / E)
        rows = (f"{x:.6f},{s:.4f}" for x, s in zip(travel, stress, strict=True))
        (tmp_path / f"{name}.csv").write_text("\n".join(["Extension (mm),Stress (MPa)", *rows]))
    given = {"holds": "tension", "gauge_length_mm": 50.0}
    kind = load_kind("table")
    found = kind.run(tmp_path / "a.csv", given, source="test")
    assert any("state E_Pa" in note for note in found.notes)
    stated = kind.run(tmp_path / "a.csv", given | {"E_Pa": E}, source="test")
    assert not any("state E_Pa" in note for note in stated.notes)
    with pytest.raises(Refused) as refused:
        kind.run(tmp_path / "b.csv", given, source="test")
    refused.value.draw(tmp_path / "b.png")
    assert (tmp_path / "b.png").stat().st_size > 5000


def yielding(to=0.222):
    """A plateau at 280 MPa, then K e^n, n = 0.2: it necks at a plastic strain of 0.198."""
    plastic = np.linspace(0.0, 0.25, 1200)
    true = np.maximum(280e6, 612.28e6 * plastic**0.2)
    strain = np.concatenate([np.linspace(0.0, 280e6 / E, 40)[:-1], plastic + true / E])
    true = np.concatenate([np.linspace(0.0, 280e6, 40)[:-1], true])
    stretch = np.exp(strain)
    kept = stretch - 1.0 < to
    return (stretch - 1.0)[kept], (true / stretch)[kept]


def test_a_curve_ends_where_the_specimen_necks():
    strain, stress = yielding()
    top = stress.argmax()
    found = pulled(strain, stress, strain_is="engineering")
    largest = stress[top] * (1.0 + strain[top])
    assert found.values["largest_stress_Pa"].value == pytest.approx(largest, rel=1e-3)
    at = np.log(1.0 + strain[top]) - largest / E
    assert found.values["largest_plastic_strain"].value == pytest.approx(at, rel=1e-3)
    assert found.flow.strain[-1] == pytest.approx(at, rel=1e-3)


@pytest.mark.parametrize(("unloading", "within"), [(0, 1e-3), (15, 0.02)])
def test_scatter_and_unloading_leave_the_end_where_it_is(unloading, within):
    stress = np.linspace(0.0, 9e8, 900)
    noise = 2e6 * np.random.default_rng(2).normal(size=stress.size)
    back = np.linspace(9e8, 0.0, unloading)
    strain = np.concatenate([steel(stress), steel(9e8) - (9e8 - back) / E])
    found = pulled(strain, np.concatenate([stress + noise, back]))
    assert found.flow.stress[-1] == pytest.approx(9e8, rel=within)


@pytest.mark.parametrize(("typed", "unit"), [(210000.0, "MPa"), (210.0, "GPa")])
def test_a_modulus_in_another_unit_is_refused(typed, unit):
    with pytest.raises(InputError, match=rf"E_Pa: {typed:g} .*{typed:g} {unit} would be"):
        pulled(*yielding(), E=typed)
    pulled(*yielding(), E=16e9)  # lead


def test_no_machine_makes_a_curve_steeper():
    (note,) = pulled(*yielding(), E=0.5 * E).notes
    assert "no machine makes it steeper" in note
    assert "gives way" not in note


def test_a_cell_without_a_number_is_told(tmp_path):
    strain, stress = yielding()
    cells = [[f"{100.0 * x:.6f}", f"{1e-6 * s:.4f}"] for x, s in zip(strain, stress, strict=True)]
    cells[300][1] = "nan"
    cells[400] = ["", ""]
    rows = "\n".join(map(",".join, cells))
    (tmp_path / "a.csv").write_text(f"Strain (%),Stress (MPa)\n{rows}\n")
    notes = load_kind("table").run(tmp_path / "a.csv", {"holds": "tension"}, source="test").notes
    assert [note for note in notes if "number" in note] == [
        "1 cells hold no number but 'nan': their rows are left out"
    ]


def test_a_flow_curve_of_a_known_metal_comes_back():
    """Swift's law K (e0 + p)^n in true values, pulled and necked, as engineering values."""
    K, n, E, Sy = 600e6, 0.2, 70e9, 200e6
    p = np.linspace(0.0, 0.35, 4000)
    true = np.maximum(K * ((Sy / K) ** (1.0 / n) + p) ** n, Sy)
    elastic = np.linspace(0.0, Sy / E, 200)
    strain = np.concatenate([elastic, true[1:] / E + p[1:]])
    stress = np.concatenate([E * elastic, true[1:]])
    nominal = np.expm1(strain)
    found = pulled(nominal, stress / np.exp(strain), strain_is="engineering")
    assert found.modulus.value == pytest.approx(E, rel=0.005)
    expected = K * ((Sy / K) ** (1.0 / n) + found.flow.strain[1:]) ** n
    assert found.flow.stress[1:] == pytest.approx(expected, rel=0.01)
    # Considere: a specimen of this law necks at a plastic strain of about n - e0
    assert found.flow.strain[-1] == pytest.approx(n - (Sy / K) ** (1.0 / n), abs=0.02)
    assert any("necks" in note for note in found.notes)


def pull(E=70e9, Sy=300e6, rises=500e6, to=0.1, rows=200):
    """Strain and stress of a metal that hardens in a straight line."""
    p, rise = np.linspace(0.0, to, rows), np.linspace(0.0, Sy / E, 40)
    true = Sy + rises * p
    return np.append(rise, true[1:] / E + p[1:]), np.append(E * rise, true[1:])


def test_a_metal_that_hardens_to_four_times_its_strength_keeps_its_modulus():
    strain, stress = pull(190e9, 200e6, 1500e6, 0.4, 300)
    found = pulled(strain + 0.02, stress)  # the machine's own zero
    assert found.modulus.value == pytest.approx(190e9, rel=0.01)
    assert found.flow.strength == pytest.approx(200e6, rel=0.03)


def test_a_gauge_that_comes_off_at_fracture_takes_nothing_from_the_curve():
    strain, true = pull()
    whole, lost = pulled(strain, true), pulled(np.append(strain, 0.0), np.append(true, true[-1]))
    assert lost.flow.strain[-1] == pytest.approx(whole.flow.strain[-1], rel=1e-3)
    assert lost.flow.stress == pytest.approx(whole.flow.stress, rel=1e-3)


@pytest.mark.parametrize(("stated", "kept"), [(68.9e9, 68.9e9), (200e9, 70e9)])
def test_a_stated_modulus_stays_and_one_that_the_curve_denies_does_not(stated, kept):
    found = pulled(*pull(), E=stated)
    assert found.values["E_Pa"].value == pytest.approx(kept, rel=0.01)
    assert any("gives way" in note for note in found.notes) == (stated != kept)
