"""Sheets as laboratories have them: headers in words, units in headers or cells, nothing lost."""

import math

import pytest
from dentscope.core.errors import InputError
from dentscope.recordings import read
from dentscope.reduce.table.sheet import read_sheet

GERMAN = """Nr.;Datum;Fallhöhe (cm);Rückprallhöhe (mm);Eindruckdurchmesser (mm);Bemerkung
1;12.03.2025;5,0;34;0,515;
2;12.03.2025;20,0;113;752 µm;
3;12.03.2025;2,00 m;852;;schlecht zu sehen
4;12.03.2025;;850;k.A.;
5;12.03.2025;60,0;;;
"""


def columns(sheet):
    return dict(sheet.columns)


def value(sheet, row, name):
    return sheet.trials[row].observables[name].value


def test_a_german_sheet(tmp_path):
    path = tmp_path / "Fallversuche.csv"
    path.write_bytes(GERMAN.encode("cp1252"))
    found = read_sheet(path)
    assert [t.label for t in found.trials] == ["002", "003", "004", "005"]
    assert value(found, 1, "dent_diameter_m") == pytest.approx(752e-6)
    assert value(found, 2, "drop_height_m") == 2.0
    assert value(found, 2, "restitution") == pytest.approx(math.sqrt(0.426))
    assert value(found, 3, "drop_height_m") == 2.0
    assert found.trials[2].note == "schlecht zu sehen"
    assert columns(found)["Datum"] == "left out: not understood"
    assert found.left_out == (
        "row 5, Eindruckdurchmesser (mm): 'k.A.' is no length",
        "row 6: nothing measured",
        "row 5: the approach is that of the row above",
    )


def test_an_english_sheet_with_titles_units_below_and_repeats(tmp_path):
    path = tmp_path / "drops.csv"
    path.write_text(
        "Steel on brass,,,,\n,,,,\n"
        "Impact velocity,Rebound velocity,Rebound velocity,Crater depth,Temperature\n"
        "m/s,m/s,m/s,um,°C\n"
        '1.0,0.62,0.61,"1,012.5",20\n2.0,0.55,,29.7,20\n'
    )
    found = read_sheet(path)
    assert [t.label for t in found.trials] == ["005-1", "005-2", "006"]
    assert [value(found, k, "restitution") for k in range(3)] == [0.62, 0.61, 0.275]
    assert value(found, 0, "permanent_depth_m") == pytest.approx(1012.5e-6)
    assert value(found, 0, "temperature_K") == 293.15
    assert "permanent_depth_m" not in found.trials[1].observables


@pytest.mark.parametrize(
    ("header", "name"),
    [("Drop height [m]", "drop_height_m"), ("Hauteur de chute (cm)", "drop_height_m"),
     ("Altezza di caduta, cm", "drop_height_m"), ("Fallhöhe in mm", "drop_height_m"),
     ("Aufprallgeschwindigkeit (m/s)", "impact_speed_m_s")],
)  # fmt: skip
def test_approaches_in_several_languages(tmp_path, header, name):
    path = tmp_path / "a.csv"
    path.write_text(f'"{header}";"Stoßzahl";"Kraterdurchmesser (mm)"\n10;0,6;0,5\n20;0,5;0,6\n')
    found = read_sheet(path)
    assert columns(found)[header].startswith(name)
    assert value(found, 0, "restitution") == 0.6
    assert value(found, 0, "dent_diameter_m") == pytest.approx(5e-4)


def test_what_is_missing_is_asked_for(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("drop height;rebound height (mm)\n10;5\n20;9\n")
    with pytest.raises(InputError, match=r"drop height: the header names no unit .*allowed: m, cm"):
        read_sheet(path)
    path.write_text("a;b\n10;5\n20;9\n")
    with pytest.raises(InputError, match="no row of headers is understood"):
        read_sheet(path)


def test_the_command_makes_a_set(tmp_path, capsys):
    from dentscope.cli import run

    path = tmp_path / "Fallversuche.csv"
    path.write_bytes(GERMAN.encode("cp1252"))
    folder = tmp_path / "drops of May"
    assert run(["recordings", "new", str(folder), "--sphere", "--from", str(path)]) == 0
    told = capsys.readouterr().out
    assert "'Fallhöhe (cm)': drop_height_m (4 cells)" in told
    assert "'k.A.' is no length" in told
    made = read(folder, unfinished=True)
    assert made.setup.name == "drops of May"
    assert made.trials.note[2] == "schlecht zu sehen"
    assert run(["recordings", "new", str(folder), "--sphere", "--from", str(path)]) == 2
    assert "there is one already" in capsys.readouterr().err


def heights(sheet):
    return [t.observables["drop_height_m"].value for t in sheet.trials]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("Fallhöhe (mm);Stoßzahl\n500;0,5\n1.000;0,45\n", [0.5, 1.0]),
        ("drop height (mm);e\n500;0.5\n1,000;0.45\n0.750;0.4\n", [0.5, 1.0, 0.00075]),
        ("Höhe in mm;Dellentiefe in µm\n500;55,1\n2.000;121,0\n", [0.5, 2.0]),
    ],
)
def test_a_point_before_three_digits_is_what_the_other_numbers_say(tmp_path, text, found):
    file = tmp_path / "a.csv"
    file.write_text(text, encoding="utf-8")
    assert heights(read_sheet(file)) == pytest.approx(found)


def test_a_number_that_may_be_a_thousand_is_told_and_its_row_left_out(tmp_path):
    """Nothing says so: the row takes no height of another."""
    file = tmp_path / "a.csv"
    file.write_text("drop height (mm);dent depth (um)\n500;55\n1.000;80\n2000;90\n")
    sheet = read_sheet(file)
    assert heights(sheet) == [0.5, 2.0]
    assert "row 3, drop height (mm): '1.000': of thousands, or of decimals?" in sheet.left_out
    assert "row 3: left out, its drop height or speed is not read" in sheet.left_out


def test_a_title_above_the_headers_is_told(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("Fallversuche;\nHöhe (cm);Stoßzahl\n50;0,5\n", encoding="utf-8")
    assert ("Fallversuche", "row 1, left out: above the headers") in read_sheet(file).columns


@pytest.mark.parametrize(
    "header", ["Geschwindigkeit in m/s", "speed (m/s)", "v [m/s]", "Aufprallgeschwindigkeit (m/s)"]
)
def test_a_speed_by_its_bare_name_is_that_of_the_approach(tmp_path, header):
    file = tmp_path / "a.csv"
    file.write_text(f"{header};Diamètre empreinte (mm)\n2;1,5\n", encoding="utf-8")
    (trial,) = read_sheet(file).trials
    assert trial.observables["impact_speed_m_s"].value == 2.0
    assert trial.observables["dent_diameter_m"].value == pytest.approx(1.5e-3)


def read_text(tmp_path, text):
    file = tmp_path / "a.csv"
    file.write_text(text, encoding="utf-8")
    return read_sheet(file)


def restitutions(sheet):
    return [t.observables["restitution"].value for t in sheet.trials]


def test_a_rebound_is_read_beside_the_other_kind_of_approach(tmp_path):
    """v^2 = 2 g h, and it is told; like over like where the row has both."""
    sheet = read_text(tmp_path, "v [m/s];Rückprallhöhe [mm];Kratertiefe [um]\n2,0;90;10\n")
    assert restitutions(sheet) == pytest.approx([math.sqrt(2 * 9.81 * 0.09) / 2.0])
    assert "row 2: restitution with v^2 = 2 g h, g = 9.81 m/s^2" in sheet.left_out
    sheet = read_text(tmp_path, "Fallhöhe [m];rebound velocity [m/s]\n0,5;2,0\n1,0;2,7\n")
    assert restitutions(sheet) == pytest.approx([2 / math.sqrt(9.81), 2.7 / math.sqrt(19.62)])
    both = "drop height (mm),impact speed (m/s),rebound height (mm)\n204,1.9,80\n459,3.0,160\n"
    sheet = read_text(tmp_path, both)
    assert restitutions(sheet) == pytest.approx([math.sqrt(80 / 204), math.sqrt(160 / 459)])
    assert value(sheet, 0, "impact_speed_m_s") == 1.9
    assert value(sheet, 0, "drop_height_m") == pytest.approx(0.204)
    assert not sheet.left_out


@pytest.mark.parametrize("word", ["mean", "SD", "Mittelwert", "Stdabw.", "Average (n = 2)", "Max"])
def test_a_row_that_sums_up_others_is_no_trial(tmp_path, word):
    text = f"Nr.;Fallhöhe (cm);Stoßzahl;Bemerkung\n1;50;0,61;Mittel\n2;50;0,60;\n{word};50;0,605;\n"
    sheet = read_text(tmp_path, text)
    assert restitutions(sheet) == [0.61, 0.6]
    assert f"row 4: left out, {word!r} sums up other rows" in sheet.left_out


def test_headers_in_two_rows_are_read_with_their_titles(tmp_path):
    """Heights below a title of the rebound are no drop heights."""
    head = "Versuch;Fallhöhe;Rückprall;Eindruck;\nNr.;in cm;Höhe in mm;Ø in mm;Tiefe in µm\n"
    sheet = read_text(tmp_path, f"{head}1;10;43;0,61;9,5\n2;20;84;0,7;\n")
    assert heights(sheet) == pytest.approx([0.1, 0.2])
    assert restitutions(sheet) == pytest.approx([math.sqrt(0.43), math.sqrt(0.42)])
    assert value(sheet, 0, "dent_diameter_m") == pytest.approx(6.1e-4)
    assert value(sheet, 0, "permanent_depth_m") == pytest.approx(9.5e-6)
    assert columns(sheet)["Eindruck Tiefe in µm"] == "permanent_depth_m (1 cells)"


def test_a_row_of_words_is_told_with_its_words(tmp_path):
    sheet = read_text(tmp_path, "Fallhöhe (cm);Stoßzahl\n50;0,61\nKugel 20 mm;\n50;0,6\n")
    assert any("Kugel 20 mm" in line for line in sheet.left_out)


def test_units_in_every_cell_hide_no_separator(tmp_path):
    sheet = read_text(tmp_path, "Fallhöhe;Rückprallhöhe\n50 cm;21 cm\n1 m;0,40 m\n")
    assert heights(sheet) == [0.5, 1.0]
    assert restitutions(sheet) == pytest.approx([math.sqrt(0.42), math.sqrt(0.4)])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("drop height (cm),rebound height (cm),e\n100,64,0.81\n50,32,0.79\n", [0.8, 0.8]),
        ("drop height (cm),v [m/s],rebound height (cm),rebound speed (m/s)\n100,4,64,3.5\n", [0.8]),
        ("v [m/s],rebound height (cm),rebound speed (m/s)\n4,64,3\n", [0.75]),
        ("v [m/s],rebound height (cm),e\n4,64,0.9\n", [0.9]),
    ],
)
def test_a_rebound_that_is_told_twice_is_one_trial(tmp_path, text, said):
    sheet = read_text(tmp_path, text)
    assert restitutions(sheet) == pytest.approx(said)
    assert not any("v^2" in line for line in sheet.left_out)


@pytest.mark.parametrize("wrong", ["0", "-100"])
def test_a_height_that_can_not_be_is_told(tmp_path, wrong):
    text = f"drop height (cm),rebound height (cm),rebound speed (m/s)\n{wrong},64,\n100,,3.5\n"
    sheet = read_text(tmp_path, text)
    assert heights(sheet) == [1.0]
    assert f"row 2, drop height (cm): {wrong!r} is too little" in sheet.left_out
    sheet = read_text(tmp_path, "drop height (cm),rebound height (cm)\n100,0\n100,-64\n")
    assert restitutions(sheet) == [0.0]
    assert "row 3, rebound height (cm): '-64' is too little" in sheet.left_out


def test_who_measured_sums_nothing_up(tmp_path):
    text = "Prüfer;Fallhöhe (cm);Stoßzahl\nMax;50;0,61\nAnna;50;0,60\nMittelwert;50;0,605\n"
    sheet = read_text(tmp_path, text)
    assert restitutions(sheet) == [0.61, 0.6]
