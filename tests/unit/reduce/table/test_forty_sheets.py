"""Forty sheets as laboratories of eight languages keep them: how many are read right.

Another number than the one written is wrong in silence; what is refused or told is not.
"""

import csv
import io
import math

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.table.sheet import read_sheet
from made_records import workbook

# trial, drop height, rebound height, dent diameter, note, operator, mean, standard deviation
ONE_ROW = {
    "de": ("Versuch Nr.", "Fallhöhe", "Rücksprunghöhe", "Abdruckdurchmesser", "Bemerkungen",
           "Prüfer", "Mittelwert", "Std.-Abw.", "cp1252"),
    "fr": ("Essai n°", "Hauteur de chute", "Hauteur de rebond", "Diamètre de l'empreinte",
           "Observations", "Opérateur", "Moyenne", "Écart-type", "utf-8-sig"),
    "es": ("Ensayo", "Altura de caída", "Altura de rebote", "Diámetro de huella", "Comentarios",
           "Operario", "Promedio", "Desv. est.", "utf-16"),
    "it": ("Prova", "Altezza di caduta", "Altezza di rimbalzo", "Diametro impronta", "Note",
           "Operatore", "Media", "Dev. std.", "cp1252"),
    "pt": ("Ensaio", "Altura de queda", "Altura de ressalto", "Diâmetro da mossa", "Observações",
           "Operador", "Média", "Desvio padrão", "utf-8"),
    "pl": ("Lp.", "Wysokość spadku", "Wysokość odbicia", "Średnica odcisku", "Uwagi",
           "Wykonał", "Średnia", "Odch. stand.", "cp1250"),
    "zh": ("序号", "下落高度", "回弹高度", "压痕直径", "备注", "操作员", "平均值", "标准差", "gbk"),
    "ja": ("試験番号", "落下高さ", "跳ね返り高さ", "圧痕直径", "備考", "測定者", "平均", "標準偏差",
           "cp932"),
}  # fmt: skip

# trial, height of fall, title of the rebounds, note, mean
NUMBERED = {
    "de": ("Probe", "Abwurfhöhe [cm]", "Rückprallhöhe [mm]", "Anmerkung", "Mittel"),
    "fr": ("Éprouvette", "Hauteur de lâcher (cm)", "Rebond (mm)", "Remarque", "moyenne"),
    "es": ("Probeta", "Altura de lanzamiento (cm)", "Rebote (mm)", "Nota", "media"),
    "it": ("Campione", "Altezza di lancio (cm)", "Rimbalzo (mm)", "Osservazioni", "media"),
    "pt": ("Amostra", "Altura de lançamento (cm)", "Altura do rebote (mm)", "Nota", "média"),
    "pl": ("Próbka", "Wysokość zrzutu [cm]", "Wysokość odskoku [mm]", "Uwaga", "średnia"),
    "zh": ("试样编号", "跌落高度（cm）", "反弹高度（mm）", "说明", "平均"),
    "ja": ("試料", "落下高 [cm]", "反発高さ [mm]", "コメント", "平均値"),
}

# test, fall, dent as a title, its two diameters and its depth below it, remark
THREE_ROWS = {
    "de": ("Nr.", "Fallhöhe", "Eindruck", "d1", "d2", "Tiefe", "Bemerkung"),
    "fr": ("Essai", "Hauteur de chute", "Empreinte", "diamètre 1", "diamètre 2", "profondeur",
           "Remarque"),
    "es": ("N.º", "Altura de caída", "Huella", "diámetro 1", "diámetro 2", "profundidad",
           "Observaciones"),
    "it": ("N.", "Altezza caduta", "Impronta", "Ø 1", "Ø 2", "profondità", "Note"),
    "pt": ("Nº", "Altura da queda", "Impressão", "diâmetro 1", "diâmetro 2", "profundidade",
           "Notas"),
    "pl": ("Nr próby", "Wysokość upadku", "Wgniecenie", "średnica 1", "średnica 2", "głębokość",
           "Uwagi"),
    "zh": ("编号", "落下高度", "凹坑", "直径1", "直径2", "深度", "备注"),
    "ja": ("番号", "落下高さ", "くぼみ", "直径1", "直径2", "深さ", "備考"),
}  # fmt: skip

# title, meta, trial, ball's diameter and mass, speeds before and after, temperature
BALLS = {
    "de": ("Kugelfallversuche Mai", "Bearbeiter: Anna", "Versuch", "Kugeldurchmesser",
           "Kugelmasse", "Aufprallgeschwindigkeit", "Rückprallgeschwindigkeit", "Temperatur"),
    "fr": ("Chutes de billes, mai", "Opératrice: Anne", "Essai", "Diamètre de bille",
           "Masse de la bille", "Vitesse d'impact", "Vitesse de rebond", "Température"),
    "es": ("Caída de bolas, mayo", "Operadora: Ana", "Ensayo n.º", "Diámetro de la bola",
           "Masa de la bola", "Velocidad de impacto", "Velocidad de rebote", "Temperatura"),
    "it": ("Caduta di sfere, maggio", "Operatrice: Anna", "Prova n.", "Diametro della sfera",
           "Massa della sfera", "Velocità d'impatto", "Velocità di rimbalzo", "Temperatura"),
    "pt": ("Queda de esferas, maio", "Operadora: Ana", "Ensaio n.º", "Diâmetro da esfera",
           "Massa da esfera", "Velocidade de impacto", "Velocidade após impacto", "Temperatura"),
    "pl": ("Zrzuty kulek, maj", "Operator: Anna", "Nr pomiaru", "Średnica kulki",
           "Masa kulki", "Prędkość uderzenia", "Prędkość odbicia", "Temperatura"),
    "zh": ("五月落球试验", "试验员：王", "试验编号", "钢球直径", "钢球质量", "冲击速度", "回弹速度",
           "温度"),
    "ja": ("五月の落球試験", "担当者：佐藤", "No.", "鋼球直径", "鋼球質量", "衝突速度", "反発速度",
           "温度"),
}  # fmt: skip

# trial, speed, restitution, its error, contact as a title, duration, title of force, peak, note,
# mean
PULSES = {
    "de": ("Messung", "Auftreffgeschwindigkeit", "Stoßzahl", "Unsicherheit", "Kontakt", "Dauer",
           "Kraft", "Spitze", "Kommentar", "Mittelwert"),
    "fr": ("Mesure", "Vitesse avant choc", "Coefficient de restitution", "Incertitude", "Contact",
           "durée", "Force", "maximum", "Commentaire", "Moyenne"),
    "es": ("Medida", "Velocidad antes del choque", "Coeficiente de restitución", "Incertidumbre",
           "Contacto", "duración", "Fuerza", "máxima", "Comentario", "Media"),
    "it": ("Misura", "Velocità prima dell'urto", "Coefficiente di restituzione", "Incertezza",
           "Contatto", "durata", "Forza", "massima", "Commento", "Media"),
    "pt": ("Medição", "Velocidade antes do impacto", "Coeficiente de restituição", "Incerteza",
           "Contato", "duração", "Força", "máxima", "Comentário", "Média"),
    "pl": ("Pomiar", "Prędkość przed zderzeniem", "Współczynnik restytucji", "Niepewność",
           "Kontakt", "czas", "Siła", "maksymalna", "Komentarz", "Średnia"),
    "zh": ("测试编号", "碰撞速度", "恢复系数", "不确定度", "接触", "时间", "力", "峰值", "备注",
           "平均值"),
    "ja": ("測定番号", "衝突速度", "反発係数", "不確かさ", "接触", "時間", "力", "最大", "備考",
           "平均値"),
}  # fmt: skip

HEIGHTS = np.repeat([10.0, 40.0, 90.0], 3)  # cm
LANGUAGES = tuple(ONE_ROW)


def written(value, digits, lang):
    text = f"{value:.{digits}f}"
    return text if lang in ("zh", "ja") else text.replace(".", ",")


def text_table(path, rows, coding, lang):
    out = io.StringIO()
    csv.writer(out, delimiter="," if lang in ("zh", "ja") else ";").writerows(rows)
    path.write_bytes(out.getvalue().encode(coding))


def one_row(path, lang, rng):
    """A header with its units, decimal commas, an own unit in a cell, a mean and std a height."""
    trial, fall, up, dent, note, person, mean, std, coding = ONE_ROW[lang]
    rows = [[trial, f"{fall} (cm)", f"{up} (mm)", f"{dent} [mm]", note, person]]
    truth = {}
    for k, h in enumerate(HEIGHTS, start=1):
        back, width = round(h * 3.6 * rng.normal(1, 0.02)), 0.4 * h**0.25 * rng.normal(1, 0.01)
        micro = "μm" if lang in ("zh", "ja") else "µm"
        size = f"{written(1e3 * width, 0, lang)} {micro}" if k == 5 else ""
        rows.append([f"V{k}", written(h, 1, lang), str(back), size or written(width, 3, lang),
                     "x!" if k == 2 else "", "Kim"])  # fmt: skip
        truth[f"V{k}"] = {"drop_height_m": 0.01 * h, "restitution": math.sqrt(0.1 * back / h),
                          "dent_diameter_m": 1e-3 * width}  # fmt: skip
        if k % 3 == 0:
            rows += [[word, written(h, 1, lang), "33", written(0.7, 3, lang), "", ""]
                     for word in (mean, std)]  # fmt: skip
    text_table(path.with_suffix(".csv"), rows, coding, lang)
    return path.with_suffix(".csv"), truth, {"V2": ("x!", "Kim")}, {}, {}


def numbered(path, lang, rng):
    """A workbook: three rebounds below a merged title, numbered; mean beside them and below."""
    trial, fall, up, note, mean = NUMBERED[lang]
    rows = [[trial, fall, up, None, None, mean, note], [None, None, 1, 2, 3, None, None]]
    truth, parts = {}, []
    for k, h in enumerate(HEIGHTS[:6:1], start=1):
        h += 3.0 * k  # no two drops alike
        back = np.round(h * 3.6 * rng.normal(1, 0.02, 3), 1)
        rows.append([f"P-{k}", h, *map(float, back), float(back.mean()), "ok" if k == 3 else None])
        e = np.sqrt(0.1 * back / h)
        parts.append(e / e.mean() - 1.0)
        truth[f"P-{k}"] = {"drop_height_m": 0.01 * h, "restitution": e.mean()}
    rows.append([mean, None, *[40.0] * 4, None])
    workbook(path.with_suffix(".xlsx"), rows, ("A1:A2", "B1:B2", "C1:E1", "F1:F2", "G1:G2"))
    freedom = 2 * len(parts)  # Student's distribution of so many is wider by (n / (n - 2))^1/2
    pooled = math.sqrt(np.square(parts).sum() / (freedom - 2) / 3.0)
    return path.with_suffix(".xlsx"), truth, {"P-3": ("ok",)}, {"restitution": pooled}, {}


def three_rows(path, lang, rng):
    """Names, sub-names below one of them, units in a row of their own."""
    trial, fall, dent, d1, d2, depth, note = THREE_ROWS[lang]
    rows = [[trial, fall, dent, "", "", note], ["", "", d1, d2, depth, ""],
            ["", "[cm]", "[mm]", "[mm]", "[µm]", ""]]  # fmt: skip
    truth = {}
    for k, h in enumerate(HEIGHTS, start=1):
        one, two = 0.4 * h**0.25 * rng.normal(1, 0.01, 2).round(4)
        deep = 9.0 * math.sqrt(h) * rng.normal(1, 0.01)
        rows.append([k, written(h, 0, lang), written(one, 4, lang), written(two, 4, lang),
                     written(deep, 2, lang), "?" if k == 4 else ""])  # fmt: skip
        truth[str(k)] = {"drop_height_m": 0.01 * h, "dent_diameter_m": 0.5e-3 * (one + two),
                         "permanent_depth_m": 1e-6 * deep}  # fmt: skip
    text_table(path.with_suffix(".csv"), rows, "utf-8", lang)
    return path.with_suffix(".csv"), truth, {"4": ("?",)}, {}, {}


def balls(path, lang, rng):
    """Titles above, one row of names, one of units; what the ball is in each row."""
    title, meta, trial, size, mass, before, after, heat = BALLS[lang]
    rows = [[title], [meta], [], [trial, size, mass, before, after, heat],
            [None, "(mm)", "(g)", "(m/s)", "(m/s)", "(°C)"]]  # fmt: skip
    truth = {}
    for k in range(1, 7):
        v = 0.5 * k
        back = round(v * rng.uniform(0.5, 0.7), 3)
        rows.append([f"{lang}{k}", 10, 4.08, v, back, 21.5])
        truth[f"{lang}{k}"] = {"impact_speed_m_s": v, "restitution": back / v,
                               "temperature_K": 294.65}  # fmt: skip
    workbook(path.with_suffix(".xlsx"), rows)
    ball = {"tip_radius_m": 5e-3, "mass_kg": 4.08e-3}
    return path.with_suffix(".xlsx"), truth, {}, {}, ball


def pulses(path, lang, rng):
    """Titles and sub-names in merged cells, units in a row, an error beside, a mean at the end."""
    trial, v, e, error, contact, time, force, peak, note, mean = PULSES[lang]
    rows = [[trial, v, e, None, contact, force, note],
            [None, None, None, error, time, peak, None],
            [None, "m/s", "-", "-", "µs", "N", None]]  # fmt: skip
    truth = {}
    for k in range(1, 7):
        speed, back, lasts, most = 0.4 * k, rng.uniform(0.5, 0.7), 60.0 - k, 100.0 * k
        rows.append([f"M{k}", speed, back, 0.01, lasts, most, "late" if k == 1 else None])
        truth[f"M{k}"] = {"impact_speed_m_s": speed, "restitution": back,
                          "contact_time_s": 1e-6 * lasts, "peak_force_N": most}  # fmt: skip
    rows.append([mean, 1.4, 0.6, 0.01, 56.5, 350.0, None])
    workbook(path.with_suffix(".xlsx"), rows, ("A1:A3", "C1:D1", "G1:G3"))
    return path.with_suffix(".xlsx"), truth, {"M1": ("late",)}, {"restitution": 0.01}, {}


LAYOUTS = (one_row, numbered, three_rows, balls, pulses)


def judged(made):
    path, truth, notes, noise, ball = made
    try:
        sheet = read_sheet(path)
    except InputError as error:
        return f"told: {error}"
    seen = {t.label: t for t in sheet.trials}
    wrong, missing = [], [k for k in truth if k not in seen]
    wrong += [f"trial {k}" for k in seen if k not in truth]
    for label in truth.keys() & seen.keys():
        got = seen[label].observables
        for name, value in truth[label].items():
            if name not in got:
                missing.append(f"{label} {name}")
            elif got[name].value != pytest.approx(value, rel=2e-3):
                wrong.append(f"{label} {name} {got[name].value:.4g} for {value:.4g}")
            stated = noise.get(name, 0.0) * (value if made[0].stem.startswith("numbered") else 1.0)
            if name in got and got[name].std != pytest.approx(stated, rel=0.01):
                wrong.append(f"{label} {name} std {got[name].std:.4g} for {stated:.4g}")
        wrong += [f"{label} {name}" for name in got if name not in truth[label]]
        missing += [n for n in notes.get(label, ()) if n not in seen[label].note]
    size = {k: v.value for k, v in sheet.striker.items()}
    if size != pytest.approx(ball):
        missing.append(f"ball {size}")
    if wrong:
        return f"wrong: {'; '.join(wrong[:4])}"
    told = " | ".join((*(f"{h}: {b}" for h, b in sheet.columns), *sheet.left_out))
    return f"told: {'; '.join(missing[:4])} of {told}" if missing else "right"


def test_of_forty_sheets_38_are_read_right_and_none_wrong_in_silence(tmp_path):
    rng = np.random.default_rng(4)
    found = {}
    for layout in LAYOUTS:
        for lang in LANGUAGES:
            name = f"{layout.__name__}-{lang}"
            found[name] = judged(layout(tmp_path / name, lang, rng))
    others = {name: said for name, said in found.items() if said != "right"}
    assert len(found) == 40
    assert not {name: said for name, said in others.items() if said.startswith("wrong")}
    assert len(others) <= 2, others
