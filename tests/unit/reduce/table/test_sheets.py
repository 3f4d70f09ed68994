"""Sheets as laboratories have them: headers in words, units in headers or cells, nothing lost."""

import math

import pytest
from dentscope.cli import run
from dentscope.core.errors import InputError
from dentscope.recordings import read
from dentscope.reduce.table.file import read_columns
from dentscope.reduce.table.sheet import read_balls, read_sheet
from dentscope.reduce.table.sheet.kinds import kind_of
from dentscope.reduce.table.sheet.words import UNDERSTOOD
from made_records import workbook

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


def each(sheet, name):
    return [trial.observables[name].value for trial in sheet.trials]


def heights(sheet):
    return each(sheet, "drop_height_m")


def restitutions(sheet):
    return each(sheet, "restitution")


def read_text(tmp_path, text):
    file = tmp_path / "a.csv"
    file.write_text(text, encoding="utf-8")
    return read_sheet(file)


def test_a_german_sheet(tmp_path):
    path = tmp_path / "Fallversuche.csv"
    path.write_bytes(GERMAN.encode("cp1252"))
    found = read_sheet(path)
    assert [t.label for t in found.trials] == ["1", "2", "3", "4"]
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
        f"what a column may be named, with its unit: {UNDERSTOOD}",
    )


@pytest.mark.parametrize(
    "text",
    ["drop height (mm),Rebound [mm]\n500,180\n", "Fallhöhe (cm),Rückprall (cm)\n50,18\n",
     "v_in (m/s),v_out (m/s)\n2,1.2\n", "v_in (m/s),rebound (m/s)\n2,1.2\n",
     "v_in (ft/s),v_out [ft/s]\n2,1.2\n", "drop (ft),rebound (mil)\n1,4320\n",
     "drop,rebound\n1 ft,4.32 in\n"],
)  # fmt: skip
def test_a_rebound_is_a_height_or_a_speed_by_its_unit(tmp_path, text):
    assert restitutions(read_text(tmp_path, text)) == pytest.approx([0.6])


def test_the_command_makes_a_set(tmp_path, errs, prints):
    path = tmp_path / "Fallversuche.csv"
    path.write_bytes(GERMAN.encode("cp1252"))
    folder = tmp_path / "drops of May"
    command = ["recordings", "new", str(folder), "--from", str(path)]
    told = prints(*command, "--dry-run", "--column", "Datum=note")
    assert "schlecht zu sehen" in told
    assert "Fallversuche-3" in told
    assert "'Datum': note (5 cells)" in told
    assert not folder.exists()
    assert "no header 'datun' (allowed: Nr., Datum, " in errs(*command, "--column", "Datun=note")
    assert "allowed: HEADER=quantity unit" in errs(*command, "--column", "Datum=day")
    path.write_bytes(GERMAN.replace(";113;", ";311;").encode("cp1252"))
    assert errs(*command).startswith(f"{path}: row 3, column restitution: 1.2")
    path.write_bytes(GERMAN.encode("cp1252"))
    told = prints(*command)
    assert "'Fallhöhe (cm)': drop_height_m (4 cells)" in told
    assert "'k.A.' is no length" in told
    made = read(folder, unfinished=True)
    assert made.setup.name == "drops of May"
    assert f",{math.sqrt(0.426):.12g}," in (folder / "trials.csv").read_text()
    assert made.trials.note[2] == "schlecht zu sehen"
    assert list(made.setup.strikers) == ["ball"]
    assert "there is one already" in errs(*command)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("Fallhöhe (mm);Stoßzahl\n500;0,5\n1.000;0,45\n", [0.5, 1.0]),
        ("drop height (mm);e\n500;0.5\n1,000;0.45\n0.750;0.4\n", [0.5, 1.0, 0.00075]),
        ("Höhe in mm;Dellentiefe in µm\n500;55,1\n2.000;121,0\n", [0.5, 2.0]),
        ("Fallhöhe (m);Dellentiefe (µm)\n1,250;55\n2,500;80\n", [1.25, 2.5]),
        ("drop height (m);dent depth (um)\n1.250;55\n2.500;1080\n", [1.25, 2.5]),
        ("drop height (mm);e\n1,087;0,5\n0.797;0,4\n0,67;0,4\n", [0.001087, 0.000797, 0.00067]),
        ("Höhe (mm);Dellentiefe (µm)\n1.500;0.797\n200,0;0,67\n", [1.5, 0.2]),
        ("drop height (mm);dent depth (um)\n500;55\n1,000;80\n", [0.5]),
        ("drop height (in),dent depth (um)\n1.969,55\n3.937,80\n", [0.0500126, 0.0999998]),
    ],
)
def test_a_point_before_three_digits_is_what_the_other_numbers_say(tmp_path, text, found):
    assert heights(read_text(tmp_path, text)) == pytest.approx(found)


ONE, OTHER = "drop height (cm),e,dent depth (um)\n", "drop height (cm),dent depth (um),e\n"
TOLD = {
    "a number that may be a thousand takes no height of another": (
        "drop height (mm);dent depth (um)\n500;55\n1.000;80\n2000;90\n",
        {"drop_height_m": [0.5, 2.0]},
        "row 3, drop height (mm): '1.000': of thousands, or of decimals? write 1000, or 1.0000",
        "row 3: left out, its drop height or speed is not read"),
    "an angle that is not read makes no normal impact": (
        "angle (Grad),v (m/s),e\n?,1,0.5\n95,1,0.6\n60,1,0.7\n", {"restitution": [0.7]},
        "row 3: left out, its angle is not read",
        "speeds beside angles are taken as those along the normal"),
    "another table below is not read by these headers": (
        f"{ONE}10,0.6,9\n{ONE}20,0.5,12\n{OTHER}10,9,0.6\n", {"restitution": [0.6, 0.5]},
        "row 5 and those below: left out, headers of another table"),
    "who measured sums nothing up": (
        "Prüfer;Fallhöhe (cm);Stoßzahl\nMax;50;0,61\nAnna;50;0,60\nMittelwert;50;0,605\n",
        {"restitution": [0.61, 0.6]}),
    "units in every cell hide no separator": (
        "Fallhöhe;Rückprallhöhe\n50 cm;21 cm\n1 m;0,40 m\n",
        {"drop_height_m": [0.5, 1.0], "restitution": pytest.approx([0.42**0.5, 0.4**0.5])}),
    "a unit may stand within a header": (
        "Fallhöhe (in cm);Rückprallhöhe [mm], 1. Messung;Rückprallhöhe in mm, 2. Messung\n"
        "10;43;44\n", {"restitution": pytest.approx([0.5 * (0.43**0.5 + 0.44**0.5)])}),
    "two diameters of one round are a dent's": (
        "Nr;Fallhöhe [cm];d1 [mm];d2 [mm];HBW\n1;50;0,85;0,87;182\n",
        {"dent_diameter_m": pytest.approx([8.6e-4])}, "HBW: left out: not understood"),
    "two diameters below a load": (
        "Load (N);d1 (mm);d2 (mm);HBW\n-1000;0,62;0,64;180\n",
        {"dent_diameter_m": pytest.approx([6.3e-4]), "load_N": [1000.0]}),
}  # fmt: skip


@pytest.mark.parametrize("what", TOLD)
def test_a_sheet_is_read_and_what_is_left_out_is_told(tmp_path, what):
    text, numbers, *told = TOLD[what]
    sheet = read_text(tmp_path, text)
    assert {name: each(sheet, name) for name in numbers} == numbers
    assert set(told) <= {*sheet.left_out, *map(": ".join, sheet.columns)}


@pytest.mark.parametrize(
    "header", ["v (m s⁻¹)", "v / m s^-1", "Geschwindigkeit in m/s", "speed (m/s)", "v [m/s]"]
)
def test_a_speed_by_its_bare_name_is_that_of_the_approach(tmp_path, header):
    (trial,) = read_text(tmp_path, f"{header};Diamètre empreinte (mm)\n2;1,5\n").trials
    assert trial.observables["impact_speed_m_s"].value == 2.0
    assert trial.observables["dent_diameter_m"].value == pytest.approx(1.5e-3)


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


@pytest.mark.parametrize(
    "word",
    ["mean", "Stdabw.", "Average (n = 2)", "Max", "Ø", "MW ± s", "Mittel Nr. 1-2", "10 cm 平均",
     "Desvio-padrão", "śr.", "Anzahl n", "N", "Variationskoeffizient [%]"],
)  # fmt: skip
def test_a_row_that_sums_up_others_is_no_trial(tmp_path, word):
    text = f"Nr.;Fallhöhe (cm);Stoßzahl;Bemerkung\n1;50;0,61;Mittel\n2;50;0,60;\n{word};50;0,605;\n"
    sheet = read_text(tmp_path, text)
    assert restitutions(sheet) == [0.61, 0.6]
    assert any(line.startswith(f"row 4: left out, {word!r} ") for line in sheet.left_out)


def test_a_row_of_words_is_told_with_its_words(tmp_path):
    sheet = read_text(tmp_path, "Fallhöhe (cm);Stoßzahl\n50;0,61\nKugel 20 mm;\n50;0,6\n")
    assert any("Kugel 20 mm" in line for line in sheet.left_out)


def test_rebounds_by_their_number_are_readings_of_one_trial_and_their_mean_none(tmp_path):
    """Where no height stands in three rows, their scatter is the noise."""
    head = "Drop (cm),Rebound 1 (mm),Rebound 2 (mm),Mean,SD"
    sheet = read_text(tmp_path, f"{head}\n50,320,330,325,5\n60,384,390,387,3\n70,450,448,449,1\n")
    first = 0.5 * (0.8 + math.sqrt(0.66))
    assert restitutions(sheet)[0] == pytest.approx(first)
    pairs = ((320, 330), (384, 390), (450, 448))
    squares = sum(0.5 * (math.sqrt(a / b) - 1.0) ** 2 for a, b in pairs)
    std = sheet.trials[0].observables["restitution"].std
    assert std == pytest.approx(first * math.sqrt(0.5 * squares), rel=0.01)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("drop height (cm),rebound height (cm),e\n100,64,0.81\n50,32,0.79\n", [0.8, 0.8]),
        ("drop height (cm),v [m/s],rebound height (cm),rebound speed (m/s)\n100,4,64,3.5\n", [0.8]),
        ("v [m/s],rebound height (cm),rebound speed (m/s)\n4,64,3\n", [0.75]),
    ],
)
def test_a_rebound_that_is_told_twice_is_one_trial(tmp_path, text, said):
    sheet = read_text(tmp_path, text)
    assert restitutions(sheet) == pytest.approx(said)
    assert not sheet.left_out
    for header, became in sheet.columns:
        assert ("where heights or speeds give none" in became) == (header == "e")


MEASURED_FIRST = [
    ("drop height (cm),rebound speed (m/s),e\n10,0.824,0.9\n25,,0.539\n", [0.588277, 0.539],
     "0.9, not 0.588"),
    ("drop height (cm),rebound height (cm),e\n10,3.46,0.9\n25,,0.539\n", [0.588218, 0.539],
     "0.9, not 0.588"),
    ("v [m/s],rebound height (cm),e\n4,64,0.8\n", [0.885889], "0.8, not 0.886"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "said", "told"), MEASURED_FIRST)
def test_what_was_measured_comes_before_a_restitution_that_differs(tmp_path, text, said, told):
    sheet = read_text(tmp_path, text)
    assert restitutions(sheet) == pytest.approx(said, rel=1e-5)
    line = f"row 2: the restitution written is {told} of the rebound measured"
    assert [x for x in sheet.left_out if "written" in x] == [line]
    assert columns(sheet)["e"].startswith("restitution, where heights or speeds give none")


def test_a_rebound_that_gives_no_restitution_is_told(tmp_path):
    text = "drop height (cm),v [m/s],rebound height (cm),rebound speed (m/s)\n100,4,64,3.5\n"
    became = columns(read_text(tmp_path, text))
    assert became["rebound speed (m/s)"] == "restitution, where heights give none (1 cell)"
    assert became["rebound height (cm)"].startswith("restitution, the root of rebound")


@pytest.mark.parametrize("wrong", ["0", "-100"])
def test_a_height_that_can_not_be_is_told(tmp_path, wrong):
    text = f"drop height (cm),rebound height (cm),rebound speed (m/s)\n{wrong},64,\n100,,3.5\n"
    sheet = read_text(tmp_path, text)
    assert heights(sheet) == [1.0]
    assert f"row 2, drop height (cm): {wrong!r} is too little" in sheet.left_out
    sheet = read_text(tmp_path, "drop height (cm),rebound height (cm)\n100,0\n100,-64\n")
    assert restitutions(sheet) == [0.0]
    assert "row 3, rebound height (cm): '-64' is too little" in sheet.left_out


@pytest.mark.parametrize(
    "head",
    [
        "Height of drop (cm),Height of rebound (mm),Diameter of dent (mm),Depth of the crater (um),"
        "Duration of contact (us),Force peak (N),Remark",
        "drop_height_cm,rebound_height_mm,dent_diameter_mm,dent_depth_um,contact_time_us,"
        "peak_force_N,note",
        "Fallhoehe cm,Rueckprallhoehe mm,Eindruck Ø mm,Kratertiefe µm,Kontaktzeit µs,Kraftspitze N,"
        "Bemerkung",
    ],
)
def test_words_stand_in_any_order_and_units_without_brackets(tmp_path, head):
    sheet = read_text(tmp_path, f"{head}\n10,43,0.61,9.5,55,920,first\n20,80,0.72,12,52,1300,\n")
    seen = {k: v.value for k, v in sheet.trials[0].observables.items()}
    assert seen == pytest.approx({
        "drop_height_m": 0.1, "restitution": math.sqrt(0.43), "dent_diameter_m": 6.1e-4,
        "permanent_depth_m": 9.5e-6, "contact_time_s": 5.5e-5, "peak_force_N": 920.0,
    })  # fmt: skip
    assert sheet.trials[0].note == "first"


OF_LABORATORIES = {
    "en": ("Specimen;Drop height (cm);Rebound height (cm);;;;;Notes\n;;1st;2nd;3rd;Avg;St Dev;\n"
           "S1;20;8,1;8,3;8,0;8,13;0,15;\nS2;40;14,9;15,2;15,0;15,03;0,15;edge\n"
           "S3;60;21,0;21,4;21,1;21,17;0,2;\nS4;80;27,1;27,0;27,6;27,2;0,3;\n",
           {"drop_height_m": 0.4, "restitution": math.sqrt(15.033 / 40)}),
    "fr": ("Essais de choc;;;\n;Vi;Vr;e = Vr/Vi\n;(m/s);(m/s);\nEssai 1;1,02;0,66;0,647\n"
           "Essai 2;2,05;1,24;0,605\nMoyenne;;;0,626\nCV;3;4;0,1\n",
           {"impact_speed_m_s": 2.05, "restitution": 1.24 / 2.05}),
    "es": ("Bola;Altura inicial;;Rebote;;Tc\n;valor (m);± (m);valor (m);± (m);(µs)\n"
           "acero;0,30;0,002;0,112;0,003;52\nacero;0,60;0,002;0,208;0,003;50\n",
           {"drop_height_m": 0.6, "restitution": math.sqrt(0.208 / 0.6), "contact_time_s": 5e-5}),
    "pt": ("Vel. de impacto (m/s);u(v) (m/s);Vel. de retorno (m/s);Fmax (daN);Temp. (°C)\n"
           "1,05;0,01;0,67;85;22\n2,10;0,01;1,25;193;22\n",
           {"impact_speed_m_s": 2.1, "restitution": 1.25 / 2.1, "peak_force_N": 1930.0,
            "temperature_K": 295.15}),
    "us": ("v (ft/s),e,Plate temperature (°F)\n10,.65,68\n20,.60,212 °F\n",
           {"impact_speed_m_s": 6.096, "restitution": 0.6, "temperature_K": 373.15}),
    "pl": ("Pomiar;Obciążenie [N];Średnica odcisku [mm];;\n;;d1;d2;dśr\n"
           "1;1000;0,62;0,64;0,63\n2;2000;0,87;0,89;0,99\n",
           {"load_N": 2000.0, "dent_diameter_m": 8.8e-4}),
    "tabs": ("prędkość normalna (m/s)\te ± s\tF pico (kN)\tt contato (µs)\n"
             "1,02 ± 0,01\t0,647 ± 0,005\t0,82\t55\n2,04 ± 0,01\t0,603 ± 0,004\t1,85\t49,6\n",
             {"impact_speed_m_s": 2.04, "restitution": 0.603, "peak_force_N": 1850.0,
              "contact_time_s": 4.96e-5}),
    "zh": ("落高(cm),第一次回弹(cm),第二次回弹(cm),平均(cm)\n20,7.6,7.4,7.5\n40,14.3,14.1,14.2\n",
           {"drop_height_m": 0.4, "restitution": math.sqrt(14.2 / 40)}),
    "ja": ("落下高さ,跳返り,,\n(cm),1 (cm),2 (cm),平均 (cm)\n20,7.6,7.4,7.5\n40,14.3,14.1,14.2\n",
           {"drop_height_m": 0.4, "restitution": math.sqrt(14.2 / 40)}),
}  # fmt: skip


LAID_OUT = [
    "Probe;Prüfer;Fallhöhe (cm);Rückprall (cm);Notiz\nA1;Kim;50;18;gut\nA2;Kim;60;21,6;gut\n",
    "Probe;;Fallhöhe;Rückprallhöhe\nA1;1E-1;0,5 m;1,8E+2 mm\nA2;1E-1;0,6 m;2,16E+2 mm\n",
    ";cm;mm\nNr.;Fallhöhe;Rückprallhöhe\n1;50;180\n2;60;216\n",
    "Nr.;Fallhöhe;;Rückprallhöhe;Einheit\n1;50;cm;180;mm\n2;60;cm;216;mm\n",
    "| no | drop (cm) | rebound (cm) |\n|---|---:|---|\n| 1 | 50 | 18 |\n| 2 | 60 | 21.6 |\n",
    "Lab 3, steel\n\nno  drop height (cm)  rebound height (mm)  note\n"
    "--  ----------------  -------------------  ----\n"
    "1   50                180                  left edge\n2   60                216\n",
    "v_in (m/s),v_out (m/s),h (m)\n-3.1321,1.8792,0.5\n-3.4310,2.0586,0.6\nmean,1.97,\n",
    "Fallhöhe (cm);Rückprallhöhe (cm);;;\n;1;2;MW;s\n50;18,2;17,8;18;0,3\n60;21,5;21,7;21,6;0,1\n",
    "drop (cm),rebound mean (cm),min rebound (cm),max rebound (cm)\n50,18,16,19\n60,21.6,20,23",
    "drop (cm),rebound (cm),rebound (FEM) (cm)\n50,18,25\n60,21.6,30\n",
    "drop (cm),rebound (cm),e calculated,rebound SD (cm)\n50,18,.6,.1\n60,21.6,.6,.1\n",
]  # fmt: skip


@pytest.mark.parametrize("coding", ["utf-8", "utf-16", "utf-16-le", "utf-16-be", "mac_roman"])
@pytest.mark.parametrize("text", LAID_OUT)
def test_two_drops_are_read_however_they_are_laid_out(tmp_path, text, coding):
    (tmp_path / "a.txt").write_bytes(text.encode(coding))
    sheet = read_sheet(tmp_path / "a.txt")
    assert heights(sheet) == [0.5, 0.6]
    assert restitutions(sheet) == pytest.approx([0.6, 0.6], rel=1e-4)


def test_a_column_of_units_is_told_as_that(tmp_path):
    assert columns(read_text(tmp_path, LAID_OUT[3]))["column 3"] == "units of 'Fallhöhe'"


@pytest.mark.parametrize("lang", OF_LABORATORIES)
def test_names_sub_names_and_short_words_of_laboratories(tmp_path, lang):
    text, second = OF_LABORATORIES[lang]
    sheet = read_text(tmp_path, text)
    seen = {k: v.value for k, v in sheet.trials[1].observables.items()}
    assert seen == pytest.approx(second, rel=1e-4)
    assert len(sheet.trials) == (4 if lang == "en" else 2)


def test_standard_deviations_are_none_of_the_readings(tmp_path):
    head = "drop height (cm),e,e std,dent diameter (mm),± (mm),rebound height (mm),Std. dev. (mm)"
    sheet = read_text(tmp_path, f"{head}\n10,,,0.61,0.005,43,0.5\n20,0.63,0.01,,,,\n")
    first, second = (t.observables for t in sheet.trials)
    assert (first["dent_diameter_m"].std, second["restitution"].std) == pytest.approx((5e-6, 0.01))
    assert first["restitution"].std == pytest.approx(math.sqrt(0.43) * 0.5 * 0.5 / 43.0)
    text = "drop height,dent diameter (mm)\n10 ± 1 cm,0.61 ± 0.01\n20 cm,720+/-10 um\n"
    sheet = read_text(tmp_path, text)
    assert [t.observables["dent_diameter_m"].std for t in sheet.trials] == pytest.approx([1e-5] * 2)
    assert sheet.trials[0].observables["drop_height_m"].std == pytest.approx(0.01)
    sheet = read_text(
        tmp_path, "Höhe (cm);e1;e2;Mittelwert e;Stdabw. e\n10;0,65;0,66;0,655;0,007\n"
    )
    assert restitutions(sheet) == [0.655]
    assert columns(sheet)["Stdabw. e"] == "left out: sums up its neighbours"
    head = "drop height (cm),crater depth (um),depth error (um)"  # of the depth beside it
    (trial,) = read_text(tmp_path, f"{head}\n10,30,2\n").trials
    assert trial.observables["permanent_depth_m"].std == pytest.approx(2e-6)


@pytest.mark.parametrize(
    ("text", "header"),
    [
        ("v (m/s),E (J),e\n1,0.5,0.65\n", "E (J)"),
        ("Indenter diameter (mm),v (m/s),e\n10,1,0.65\n", "Indenter diameter (mm)"),
        ("v (m/s),e,Max. indentation depth (um)\n1,0.65,9\n", "Max. indentation depth (um)"),
        ("v (m/s),rebound speed (m/s),tangential rebound speed (m/s)\n1,0.65,0.9\n",
         "tangential rebound speed (m/s)"),
        ("v (m/s),1st rebound speed (m/s),2nd rebound speed (m/s)\n1,0.65,0.4\n",
         "2nd rebound speed (m/s)"),
        ("v (m/s),1er rebond (m/s),2e rebond (m/s)\n1,0.65,0.4\n", "2e rebond (m/s)"),
        ("v (m/s),e,Ball no,inc. (deg)\n1,0.65,1,3\n", "inc. (deg)"),
        ("v (m/s),e,h1 (mm),± (mm)\n1,0.65,1,3\n", "± (mm)"),
        ("v (m/s),e,dent diameter (mm),± (%)\n1,0.65,1,3\n", "± (%)"),
        ("v_n (m/s),e_n,e_t,Rebound angle (deg)\n1,0.65,0.5,30\n", "Rebound angle (deg)"),
        ("v (m/s),e,Time of impact (s)\n1,0.65,3.2\n", "Time of impact (s)"),
        ("v (m/s),e,e range\n1,0.65,0.02\n", "e range"),
        ("v (m/s),e,rebound (%)\n1,0.65,36\n", "rebound (%)"),
        ("v (m/s),e,T (ms)\n1,0.65,36\n", "T (ms)"),
        ("v (m/s),e,Zeit nach Aufprall (s)\n1,0.65,36\n", "Zeit nach Aufprall (s)"),
        ("v (m/s),e,Plate temperature (°C),Ball temperature (°C)\n1,0.65,20,25\n",
         "Ball temperature (°C)"),
        *((f"v (m/s),e,{header}\n1,0.65,0.4\n", header) for header in (
            "tangential restitution", "restitution 2nd bounce", "restitution squared", "1 - e_n",
            "energy restitution", "restitution loss", "ln restitution", "restitution difference",
            "time to second impact (s)", "time at impact (ms)", "second contact time (us)",
            "durée avant le deuxième impact (ms)", "peak force of second impact (N)",
            "half dent diameter (mm)", "crater diameter/2 (mm)", "dent radius (mm)",
            "ball flat diameter (mm)", "dynamic indentation depth (um)",
        )),
    ],
)  # fmt: skip
def test_what_sounds_like_a_reading_is_none(tmp_path, text, header):
    sheet = read_text(tmp_path, text)
    (trial,) = sheet.trials
    assert trial.observables["restitution"].value == 0.65
    assert columns(sheet)[header].startswith("left out: ")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Fallhöhe soll (cm);Fallhöhe ist (cm);e\n10;10,3;0,6\n",
         r"Fallhöhe ist \(cm\): drop_height_m stands in 'Fallhöhe soll \(cm\)' already"),
        ("Angle from normal (deg),v (m/s),e\n0,1,0.6\n", "an angle from the normal"),
        ("Einfallswinkel (Grad),v (m/s),e\n0,1,0.6\n", "an angle from the normal"),
        ("drop height;rebound height (mm)\n10;5\n20;9\n",
         r"drop height: the header names no unit .*allowed: m, cm"),
        ("a;b\n10;5\n20;9\n", "no row of headers is understood"),
        ("trial,impact energy (J),dent diameter (mm)\n1,1,0.9\n",
         r"one of 'impact energy \(J\)'; --column 'HEADER"),
        ("C (GPa),hm\n10,5\n20,9\n", "no row of headers is understood"),
        ("Fallhöhe (cm);Abdruck (mm)\n10;5\n", "dent diameter\\? --column 'Abdruck=dent diameter'"),
        ("Hauteur;Rebond\n100;10\n", "rebound height\\? --column 'Rebond=rebound height UNIT'"),
        ("Drop (cm),Rebound 1 (cm),Rebound 2 (cm)\n100,64,41\n50,31,20\n",
         "as the next bounce does"),
        ("v (m/s),dent depth (um),dent depth SD (%)\n1,9,2\n", "'%' is no unit of length"),
        ("v (mph),e\n1,0.6\n", "'mph' is no unit of speed that is known"),
        ("rebound height (mm),dent depth (um)\n43,9\n", "no column such as drop height"),
        ("drop height (cm),h1 (cm),#\n10,4,1\n", r"a name for one of 'h1 \(cm\)'"),
        ("drop height (cm),Stoßzahl (%)\n10,0.65\n", "'0.65': a part of 1, or of 100?"),
        ("drop height (cm),dent depth (um)\n10,-9\n", "'-9' is too little"),
        ("drop height (cm),e\n10,65\n", "'65' is too much"),
        ("Plate angle (deg),v (m/s),e\n30,1,0.6\n", "an angle from the normal"),
        ("drop height (cm),rebound (cm),rebound corrected (cm)\n50,18,17\n",
         r"stands in 'rebound \(cm\)' already .*--column 'rebound corrected \(cm\)=note'"),
        ("v (m/s),dent diameter (mm),ball dent diameter (mm)\n1,0.9,0.4\n",
         r"stands in 'dent diameter \(mm\)' already"),
        ("No.,1,2\nDrop height (cm),50,60\nRebound height (cm),18,21\n",
         "headers stand in a column, not a row"),
        ("drop height (m);e\n1,0;0,6\n400,0;0,6\n",
         r"row 3, drop height \(m\): '400,0' is too much .* is it in m\?"),
        ("#,drop height (mm),rebound height (mm)\n1,100,0,44,1\n", "5 cells below 3 headers"),
        ("#,drop height (mm),e,note\n1,100,0,6,\n", "5 cells below 4 headers"),
        ("Drop (cm),Rebound (cm),note\n10,44,\n20,80,a\n30,108,b\n",
         r"'Drop \(cm\)' and 'Rebound \(cm\)': restitution 2, the median of 3 rows"),
    ],
)  # fmt: skip
def test_a_sheet_that_would_be_misread_is_refused(tmp_path, text, said):
    with pytest.raises(InputError, match=said):
        read_text(tmp_path, text)


def test_speeds_beside_both_angles_are_those_along_the_path(tmp_path):
    head = "impact velocity (m/s),impact angle (deg),rebound velocity (m/s),rebound angle (deg)"
    sheet = read_text(tmp_path, f"{head}\n10,30,6,25\n,60,6,50\n10,60,6,\n10,,6,\n")
    assert each(sheet, "impact_speed_m_s") == pytest.approx([5.0, 75.0**0.5, 10.0])
    assert restitutions(sheet) == pytest.approx([0.507142, 0.530727, 0.6], rel=1e-5)
    assert value(sheet, 0, "tangential_rebound_m_s") == pytest.approx(-5.437847)
    assert any("along the path" in line for line in sheet.left_out)
    assert "row 4: rebound speed left out, it has no angle" in sheet.left_out


@pytest.mark.parametrize("blank", [" ", "\u00a0", "\u202f", "'"])
def test_blanks_that_part_thousands(tmp_path, blank):
    sheet = read_text(
        tmp_path, f"Höhe{blank}mm;e\n1{blank}000,5;0,6\n20;0,5\n".replace("'mm", " mm")
    )
    assert heights(sheet) == [1.0005, 0.02]


def test_presses_are_rows_too(tmp_path):
    text = "Prüfkraft (kN);Fallhöhe (cm);Eindruckdurchmesser (mm)\n1;;0,6\n2;;0,85\n;10;0,61\n"
    seen = [t.observables for t in read_text(tmp_path, text).trials]
    assert [s["load_N"].value for s in seen[:2]] == [1e3, 2e3]
    assert "load_N" not in seen[2]
    kiloponds = read_text(tmp_path, text.replace("(kN)", "(kp)"))
    assert value(kiloponds, 1, "load_N") == pytest.approx(2 * 9.80665)
    assert seen[2]["drop_height_m"].value == pytest.approx(0.1)


def test_rows_are_counted_as_the_file_has_them(tmp_path):
    head = "#,drop height (cm),rebound height (mm),\n"
    sheet = read_text(tmp_path, f"Tuesday\n\n{head}1,10,43,44\n\n2,20,oops,\n3,−5,9,\n")
    assert [t.label for t in sheet.trials] == ["1"]
    assert "row 6, rebound height (mm): 'oops' is no length" in sheet.left_out
    assert "row 7, drop height (cm): '-5' is too little" in sheet.left_out
    assert columns(sheet)["column 4"] == "left out: no header"


def test_the_sheet_of_a_workbook_is_that_with_headers_and_the_others_are_told(tmp_path):
    one = [[], [None, "drop height (cm)", "e"], [None, 10, 0.6]]
    found = read_sheet(workbook(tmp_path / "a.xlsx", [["Operator", "Jane"]], Brass=one, Steel=one))
    assert [t.label for t in found.trials] == ["003"]
    assert [line.split(":")[0] for line in found.left_out] == ["sheet 'Sheet'", "sheet 'Steel'"]
    assert "--sheet 'Steel' takes it" in found.left_out[1]
    assert "--sheet 'Brass' takes it" in read_sheet(tmp_path / "a.xlsx", sheet="Steel").left_out[1]


def test_an_empty_workbook_is_called_so(tmp_path):
    path = workbook(tmp_path / "a.xlsx", [])
    with pytest.raises(InputError, match=r"a\.xlsx: empty"):
        read_sheet(path)


def test_numbers_of_a_workbook_say_nothing_of_the_commas_in_its_texts(tmp_path):
    rows = [["Fallhöhe (cm)", "Eindruck Ø (mm)", "Bemerkung"], [2.5, "0,722", 5],
            [10, "1,089", ""], [20, 1.234, ""]]  # fmt: skip
    sheet = read_sheet(workbook(tmp_path / "a.xlsx", rows))
    assert each(sheet, "dent_diameter_m") == pytest.approx([7.22e-4, 1.089e-3, 1.234e-3])
    assert sheet.trials[0].note == "5"


def test_errors_of_a_spreadsheet_are_told(tmp_path):
    rows = [[], ["drop height (cm)", "rebound height (cm)"]]
    rows += [[30, height] for height in (20, 21, "#DIV/0!", 22, "=B3+1")]
    path = workbook(tmp_path / "a.xlsx", rows, title="a & b")
    found = read_sheet(path)
    assert len(found.trials) == 3
    assert any("row 5" in line and "'#DIV/0!'" in line for line in found.left_out)
    assert any("row 7" in line and "without a stored" in line for line in found.left_out)
    assert read_columns(path).cells[2][1] == "#DIV/0!"


def test_a_row_that_stands_twice_is_told(tmp_path):
    text = "drop height (cm),rebound height (cm),dent diameter (mm)\n30,20,0.61\n40,26,0.70\n"
    found = read_text(tmp_path, text + "30,20,0.61\n30,20,0.62\n")
    assert len(found.trials) == 4
    assert [line for line in found.left_out if "copied" in line] == [
        "row 4: taken, though each cell is that of row 2: copied?"
    ]


@pytest.mark.parametrize(
    ("rows", "labels", "became"),
    [
        ("A1,10,0.6\nA2,20,0.5\n", ["A1", "A2"], "names of the trials"),
        ("A1,10,0.6\na1,20,0.5\n", ["002", "003"], "in the notes"),
        ("A1,10,0.6\n,20,0.5\n", ["002", "003"], "in the notes"),
        ("1/2,10,0.6\n1/3,20,0.5\n", ["002", "003"], "in the notes"),
        ("A1,10,0.6\nA1,20,\n", ["A1"], "names of the trials"),  # of what is taken
    ],
)
def test_trials_are_named_by_a_column_whose_entries_differ(tmp_path, rows, labels, became):
    sheet = read_text(tmp_path, f"Test,drop height (cm),e\n{rows}")
    assert [t.label for t in sheet.trials] == labels
    assert columns(sheet)["Test"].startswith(became)
    twice = "'Test' does not name the trials: 'A1' is in rows 2 and 3"
    assert (twice in sheet.left_out) == ("a1" in rows)


def test_of_two_columns_that_one_names_the_trials_whose_entries_differ(tmp_path):
    text = "Probe,Drop no.,drop height (cm),e1,e2\nP,7,10,0.6,0.61\nP,8,20,0.5,\n"
    sheet = read_text(tmp_path, text)
    assert [(t.label, t.note) for t in sheet.trials] == [("7", "Probe P"), ("8", "Probe P")]


@pytest.mark.parametrize(
    "above",
    ["# ball drops, lab 3, plate S235", "Fallversuche", "Lab: 3,by:", "Ball diameter (mm),ca. 8"],
)
def test_what_stands_above_the_headers_is_no_title_of_theirs(tmp_path, above):
    sheet = read_text(tmp_path, f"{above}\nDrop no.,drop height (cm),e (n=3)\n1,10,0.6\n")
    *headers, told = sheet.columns
    assert [header for header, _ in headers] == ["Drop no.", "drop height (cm)", "e (n=3)"]
    assert told == (
        " ".join(c.strip() for c in above.split(",")),
        "row 1, left out: above the headers",
    )


@pytest.mark.parametrize(
    ("head", "cells"),
    [("Ball diameter (mm),Ball mass (g)", "10,4.08"),
     ("Kugel-Ø in cm,Kugelmasse (kg)", "1,4.08e-3"),
     ("Diamètre de la bille (mm),Poids de la bille (mg)", "10,4080")],
)  # fmt: skip
def test_a_ball_that_is_the_same_in_all_rows_is_that_of_the_set(tmp_path, head, cells):
    sheet = read_text(tmp_path, f"drop height (cm),e,{head}\n10,0.6,{cells}\n20,0.5,\n")
    assert {k: v.value for k, v in sheet.striker.items()} == pytest.approx(
        {"tip_radius_m": 5e-3, "mass_kg": 4.08e-3}
    )
    file = str(tmp_path / "a.csv")
    assert run(["recordings", "new", str(tmp_path / "set"), "--sphere", "--from", file]) == 0
    made = read(tmp_path / "set", unfinished=True)
    assert "strikers.ball.mass_kg" not in made.to_fill
    assert made.setup.strikers["ball"].mass_kg.value == pytest.approx(4.08e-3)


@pytest.mark.parametrize(
    "above",
    ["Kugel Ø 10,5 mm;Messing\nKugelmasse [g]:;4,08;", "球径：10.5mm  球重：4.08g",
     "Ball: AISI 52100, 10.5 mm dia., 4.08 g",
     "Plate 20 mm, from 0.5 m; 10.5 mm steel ball (4.08 g)\nBall radius 5 mm, plate 3 kg",
     "Kulka: średnica 10,5 mm, masa 4,08 g", "Kugelmasse;4,08;g\nKugeldurchmesser [mm];10,5"],
)  # fmt: skip
@pytest.mark.parametrize("between", ["\n", ""])
def test_a_ball_above_the_headers_is_that_of_the_set(tmp_path, above, between):
    table = "Nr.;Fallhöhe (cm);e\n1;10;0,6\n2;20;0,5\n"
    sheet = read_text(tmp_path, f"{above}\n{between}{table}")
    assert [trial.label for trial in sheet.trials] == ["1", "2"]
    assert {k: v.value for k, v in sheet.striker.items()} == pytest.approx(
        {"tip_radius_m": 5.25e-3, "mass_kg": 4.08e-3}
    )
    assert any("ball mass 4" in became and "striker's" in became for _, became in sheet.columns)


def test_a_ball_in_merged_cells_above_is_told_once(tmp_path):
    rows = [["Steel ball 10 mm, 4.08 g"], ["drop height (cm)", "e", "dent (mm)"], [10, 0.6, 0.5]]
    sheet = read_sheet(workbook(tmp_path / "a.xlsx", rows, merged=["A1:C1"]))
    told = "row 1: ball diameter 10 mm, ball mass 4.08 g, the striker's"
    assert columns(sheet)["Steel ball 10 mm, 4.08 g"] == told


def test_formulas_in_notes_are_text_in_the_set_and_come_back(tmp_path):
    (tmp_path / "a.csv").write_text("drop height (cm);e;note\n10;0,6;=1+1\n20;0,5;'-x\n30;0,5;-3\n")
    made = tmp_path / "set"
    assert run(["recordings", "new", str(made), "--from", str(tmp_path / "a.csv")]) == 0
    written = (made / "trials.csv").read_text()
    assert all(note in written for note in (",'=1+1\n", ",''-x\n", ",-3\n"))
    assert read(made, unfinished=True).trials.note == ("=1+1", "'-x", "-3")


@pytest.mark.parametrize(
    ("ball", "said"),
    [("Ball diameter (mm)", ("10", "20", "20")), ("Kugel", ("Stahl", "WC", "WC")),
     ("Masse (g)", ("4.08", "10", "10"))],
)  # fmt: skip
def test_a_set_has_one_ball_and_a_sheet_of_several_is_asked_which(tmp_path, ball, said):
    rows = "".join(f"{k}0,0.{k},{one}\n" for k, one in enumerate(said, start=4))
    with pytest.raises(InputError, match=r"several balls: .*--select") as refused:
        read_text(tmp_path, f"drop height (cm),e,{ball}\n{rows}")
    assert f"--select '{ball}={said[0]}' --into SET" in str(refused.value)
    only = read_sheet(tmp_path / "a.csv", select=f"{ball}={said[1]}")
    assert restitutions(only) == [0.5, 0.6]


def test_each_ball_of_a_sheet_becomes_a_striker(tmp_path, errs, prints):
    file, folder = tmp_path / "drops.csv", tmp_path / "set"
    rows = "K1;1;20;5\nK2;1;20;10\nK1;2;40;9\nK2;2;40;20\n"
    file.write_text(f"Kugel;Nr.;Fallhöhe (cm);Rückprallhöhe (cm)\n{rows}", encoding="utf-8")
    told = prints("recordings", "new", folder, "--from", file)
    assert "2 trials of K1" in told
    assert told.count("to fill in:") == 1
    made = read(folder, unfinished=True)
    assert list(made.setup.strikers) == ["K1", "K2"]
    assert made.trials.striker == ("K1", "K1", "K2", "K2")
    assert made.trials.observables["restitution"] ** 2 == pytest.approx([0.25, 0.225, 0.5, 0.5])
    # a height that is written once is that of the row above, whatever its ball
    file.write_text(file.read_text(encoding="utf-8").replace("K2;2;40", "K2;2;"), encoding="utf-8")
    assert "several balls: K1, K2" in errs("recordings", "new", tmp_path / "other", "--from", file)


@pytest.mark.parametrize("header", ["Kugel", "striker"])
def test_a_ball_that_is_written_once_holds_for_the_rows_below(tmp_path, header):
    rows = "K1;20;5\n;40;9\nMittel;;7\nK2;20;10\n;40;20\n"
    file = tmp_path / "a.csv"
    file.write_text(f"{header};Fallhöhe (cm);Rückprallhöhe (cm)\n{rows}", encoding="utf-8")
    found = {ball: restitutions(sheet) for ball, sheet in read_balls(file).items()}
    assert found["K1"] == pytest.approx([0.5, math.sqrt(0.225)])
    assert found["K2"] == pytest.approx([math.sqrt(0.5)] * 2)


def test_one_ball_may_be_weighed_again_and_each_drop_have_its_own(tmp_path):
    text = "drop height (cm),e,Ball mass (g),Ball no\n10,0.6,4.08,1\n20,0.5,4.09,2\n"
    sheet = read_text(tmp_path, text)
    assert not sheet.striker
    assert columns(sheet)["Ball mass (g)"] == "left out: not one ball's (2 cells)"
    assert [t.note for t in sheet.trials] == ["Ball no 1", "Ball no 2"]


def test_what_a_column_may_be_named_is_said_once_and_true(tmp_path):
    text = "drop height (cm),e,d1 [mm],Depth (um)\n10,0.6,0.85,18\n"
    lines = [line for line in read_text(tmp_path, text).left_out if "may be named" in line]
    assert lines == [f"what a column may be named, with its unit: {UNDERSTOOD}"]
    plain = UNDERSTOOD.replace(" (of two: dent d1, dent d2)", ", dent d1, dent d2")
    assert all(kind_of(name.strip()) for part in plain.split(";") for name in part.split(","))
    assert not read_text(tmp_path, "drop height (cm),e\n1,0.6\n").left_out


@pytest.mark.parametrize(
    ("header", "name"),
    [
        ("t_K [µs]", "contact_time_s"), ("t_K / ms", "contact_time_s"), ("T_K", "temperature_K"),
        ("v_an / (m/s)", "impact_speed_m_s"), ("v_ab / (m/s)", "rebound_speed"),
        ("h_bl [µm]", "permanent_depth_m"), ("試験No.", "trial"), ("Anm.", "note"),
        ("e的标准差", "restitution"), ("Écart-type de e", "restitution"),
        ("Auslenkwinkel [°]", None), ("Auftreffwinkel [°]", "angle_deg"), ("e²", None),
        ("Post-impact velocity (m/s)", "rebound_speed"), ("v_vor [m/s]", "impact_speed_m_s"),
        ("Rebound height after drop (cm)", "rebound_height"), ("Starthöhe (cm)", "drop_height_m"),
        ("Höhe nach Aufprall (cm)", "rebound_height"), ("反彈高度(cm)", "rebound_height"),
        ("Durée de chute (s)", None), ("Duração do ensaio (s)", None), ("Kugel-Nr.", "ball"),
        ("Rebound height predicted (cm)", None), ("Stoßzahl (Simulation)", None),
    ],
)  # fmt: skip
def test_symbols_and_short_words_say_what_they_are(header, name):
    assert getattr(kind_of(header), "name", None) == name


def test_no_question_offers_what_a_header_is_not(tmp_path):
    """The angle from which a pendulum falls is none of the approach."""
    head = "v_an (m/s);v_ab (m/s);Auslenkwinkel (°);Impronta (mm)"
    sheet = read_text(tmp_path, f"{head}\n2;1;60;1,1\n")
    assert columns(sheet)["Auslenkwinkel (°)"] == "left out: not understood"
    assert "angle_deg" not in sheet.trials[0].observables
    assert ": dent diameter? --column" in columns(sheet)["Impronta (mm)"]
