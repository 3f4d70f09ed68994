"""Words of laboratories' sheets for what there is, in nine languages, and nothing else.

English, German, French, Spanish, Italian, Portuguese, Polish, Chinese, Japanese; stems, as regular
expressions. Letters are compared small and without accents (`bare`): `oe?` is ö or oe.
"""

from __future__ import annotations

import re
import unicodedata
from functools import cache
from typing import NamedTuple

from ....core.observables import LOAD


def letters(text: str) -> str:
    """Return a text without accents, with single blanks."""
    spread = unicodedata.normalize("NFKD", text.replace("ß", "ss").translate(_STROKES))
    return " ".join("".join(c for c in spread if not unicodedata.combining(c)).split())


def bare(text: str) -> str:
    """Return a header in small letters without accents, signs and line ends."""
    return letters(text).lower()


_STROKES = str.maketrans(
    "łŁ編號彈壓徑註備試樣測質衝擊鋼時間觸復係數溫驗記錄說標準誤員釋轉寬長載負",
    "lL编号弹压径注备试样测质冲击钢时间触复系数温验记录说标准误员释转宽长载负",
)
"""Strokes that are no accents; signs as Taiwan and Japan write them as in the mainland."""

HEIGHT = r"height|hoe?he|hauteur|altezza|altura|wysokosc|\b(h|ht|haut|alt|quota|wys)\b|高"
DROPS = (
    r"drop|fall|release|chute|lacher|caduta|lancio|caida|lanzam|queda|lancam|abwurf|spad|zrzut|upad|"
    r"upuszcz|initial|anfang|start|ausgangs|inizial|inicial|poczatk|落|跌|初始|释放"
)
"""Words of a drop height."""
REBOUND = (
    r"rebound|bounce|return|rue?ck(prall|sprung|kehr)|abprall|(sprung|steig)hoe?he|rebond|remontee|"
    r"retour|risalita|弹起|跳ね上|"
    r"rimbalz|ritorno|rebote|retorno|ressalt|repiqu|ricochet|odbici|\bodb\b|odskok|powrot|回弹|反弹|跳ね?返|"
    r"はね返|反発"
)
SPEED = r"speed|\bvel(oc|\b)|geschw|\bvit(esse|\b)|predk|速度|速さ"
_AFTER = (
    rf"{REBOUND}|\bafter\b|\bnach\b|\bapres\b|\bdopo\b|despues|\bapos\b|\bpo\b|后|後|"
    r"\bpost(\b|impa|coll)|outgoing|outbound|separation|ausfall|salida|sortie|uscita|saida|出射"
)
_BEFORE = (
    r"impact|approach|(auf|an)prall|auftreff|stoss|choc|choque|urto|impatto|uderz|zderz|before|"
    r"incid|incoming|inbound|einschlag|einfall|entrada|entree|ingresso|\bvor\b|avant|prima|antes|"
    r"przed|冲击|碰撞|碰前|撞击|入射|衝突|衝撃"
)
_DENT = (
    r"\bdent|dimple|crater|indent(?!er|eur|ador|atore)|imprint|impress|abdruck|eindruck|krater|delle|"
    r"empreint|impront|huella|mella|mossa|odcisk|wgniec|wglebieni|\bpit\b|压痕|凹痕|坑|圧痕|くぼみ|"
    r"窪み|へこみ"
)
CONTACT_TIME = r"\bt_?[Kk]\b"
"""By its symbol as it is written: T_K is a temperature."""
OF = r"^(of|von|de|di|da|do|du|sur)\b|[的の]$"
"""Between a spread and what it is of."""
_SCAR = r"\bscar|scratch|kratzspur|kratzer|rayure|rasguno|arranh|graffio|zarysow|划痕|擦伤|擦過痕"
BALL = r"\b(ball|sphere|bille|sfer|bola|esfer|kul)|kugel|球|ボール"
NO_BALL = (
    rf"{HEIGHT}|{DROPS}|radius|rayon|raggio|radio|raio|promien|半径|plate|target|thick|platte|dick|blech|"
    r"plaque|epais|tole|piastra|lastra|spess|placa|chapa|espes|plyt|grub|板|厚"
)
"""Of lengths and masses in a line above that are not a ball's diameter or mass."""
DIAMETER = r"diam|\bdia\b|durchm|ø|⌀|srednic|\bsr\b|直径|(?<!半)径"
_WIDTH = r"wid|breit|largeur|largh|ancho|largura|szerok|宽|幅"
_LENGTH = r"length|laenge|lange|longueur|lunghezza|longitud|comprimento|dlugosc|长|長さ"
_DEPTH = r"depth|tief|profond|profund|\bprof\b|glebok|深"
_SINK = r"indent|eindring|penetr|press"
_MASS = r"mass|masa|weight|gewicht|poids|peso|ciezar|质量|質量|重量"
_BLOW = r"contact|kontakt|stoss|impact|beruhr|contatto|contat|zderz|uderz|接触|碰撞|衝突"
_TIME = r"time|duration|zeit|dauer|temps|duree|tempo|tiempo|durat|durac|czas|时间|時間"
_MOST = r"peak|max|massim|maks|spitze|crete|pico|picco|szczyt|stoss|impact|最大|峰值|衝撃|冲击"
_FORCE = r"force|kraft|forza|fuerza|forca|\bsila|(?<![应応圧压])力|荷重"
_SWING = r"auslenk|ausschlag|deflec|swing|pend[eou]l|lacher|release|oscil|wychyl|wahad|摆|振"
"""Of the angle to which a pendulum is drawn."""
_ANGLE = r"angle|winkel|angolo|angulo|\bkat\b|角(?!速)"
_HIGH = "(height|hoe?he|hauteur|altezza|altura|wysokosc)"
_EARLY = "before|vor(her)?|avant|prima|antes|przed"
_BACK = "(out|reb(ound)?|r|ab|rue?ck|nach|post|')"
_LATE = "after|nach(her)?|apres|dopo|despues|apos|po"
_SPIN = r"\bspin\b|\bgiro\b|drall|drehzahl|rotation|rotacion|rotazion|obrot|转速|自旋|回転"

MEANS = (
    r"mean|average|avg|median\w*|mittel\w*|durchschn\w*|mw|moyenne?|moy|media|promedio|prom|"
    r"srednia|d?sr|平均[値值]?|均值"
)
SPREADS = (
    r"stdev\w*|(std|st|stand\w*)\.?[- ]?(dev|abw)\w*|s\.?d|std|ecart[- ]?types?|"
    r"(desv|dev|odch)\w*\.?[- ]?(est|pad|tip|st|stand)\w*|desviacion|deviazione|streuung|"
    r"标准偏?差|標準偏差"
)
ERRORS = (
    r"sem|sigma|σ|error|unc|inc|uncertainty|fehler|unsicherheit|erreur|incertitude|incertezza|incertidumbre|"
    r"incerteza|niepewnosc|不确定度|误差|不確かさ|誤差"
)
LEAST, MOST = r"minim\w*|min|最小[値值]?", r"maxim\w*|max|最大[値值]?"
EXTREMES = rf"{LEAST}|{MOST}|sum|total|summe|suma|somme|合计|合計|ø|n ?="
LATER = (
    r"\b([2-9](nd|rd|th|eme|[eoa]|\.)|second[oa]?|third|fourth|zweite\w*|dritte\w*|deuxieme|troisieme|terz[oa]|"
    r"segund[oa]|tercer\w*|drugi\w*|trzeci\w*)\b|第[二三四2-4]"
)
FROM_NORMAL = (
    r"(from|to)( the)? (normal|vertical)|\blot\b|senkrecht|incidence|einfall|incidenza|incidencia|"
    r"padania|入射角|inclin|nachyl|(plate|target) angle|plattenwinkel|倾|傾"
)
"""Of an angle: where the fall is upright, the plate's own is one."""
ALONG = r"tangent|tangenc|horizont|styczn|切向|接線|水平"
RANGE = r"\b(range|spannweite|varian[cz]\w*|varianza|cv|rsd|zakres)\b|\w{4} (n|anzahl|count)$"
THEORY = (
    r"theor|teor|predict|vorherge|s[iy]mul|expected|\bfe[ma]\b|hertz|erwart|"
    "理论|仿真|模拟|预测"
)
"""Of numbers that nobody measured."""
DERIVED = r"calc|berechn|comput|oblicz|wylicz|计算|計算"
_SQUARED = r"square|quadrat|cuadrado|carre\b|kwadrat|energ|平方"
_LESS = (
    r"loss|verlust|perte|perdid|perdit|strat[ay]|损失|^1 ?[-–−]|^(ln|log)\b|differen|\bref(er|\b)"
)
"""Of a restitution: its loss, its logarithm, its difference to another."""
_LATER_BLOW = (
    rf"({LATER}) ?({REBOUND}|contact|kontakt|impact|stoss(?!z)|choc|choque|urto|collision|hit\b)"
)
"""Such as restitution 2nd bounce, second contact time."""
_NO_WHOLE = (
    r"\bhalf|halb|\bdemi|mitad|\bmeta\b|polow|/ ?2$|radius|rayon|raggio|\bradio|\braio|promien|"
    "半径|perimet|umfang|circumf"
)
NOT_NEARLY = (
    rf"{_NO_WHOLE}|\bflight|\brise|\blost|\bloss|pile|\brim\b|energ|elastic|preload|\bvalid|"
    r"\bdate"
)
"""Of what no proposal comes near."""
CORRECTED = r"corr|korr|korygow|补正|補正|修正"
ROD = r"\b(rod|stab|stange|barre|tige|barra|asta|varilla|haste|pret)\b|棒"
"""Of a striker that is no ball."""

REBOUNDS = REBOUND_HEIGHT, REBOUND_SPEED = "rebound_height", "rebound_speed"
REBOUND_ANGLE = "rebound_angle"
BODY = BALL_DIAMETER, BALL_MASS = "ball_diameter", "ball_mass"
APPROACHES = ("drop_height_m", "impact_speed_m_s", LOAD)
SIGNED = (*APPROACHES[1:], REBOUND_SPEED, "peak_force_N", "restitution")
"""What some write with the sign of an axis."""
DENTS = ("dent_diameter_m", "permanent_depth_m", "scar_width_m", "scar_length_m")
"""Of one mark several readings are one."""


class SheetKind(NamedTuple):
    """What a column may become, and the words that say so.

    `name` is as in trials.csv, or of `REBOUNDS`, `BODY`, `note`, `person`, `ball`; `quantity` of
    `UNITS`, or `text`. All of `parts` say it, in any order (the height of fall, the fall's height),
    or `also` alone, but not with `never`.
    """

    name: str
    quantity: str
    parts: tuple[str, ...]
    also: str = ""
    never: str = ""

    def is_said(self, words: str) -> bool:
        """Whether the words of a header, as `bare` gives them, say this."""
        whole = all(_compiled(part).search(words) for part in self.parts)
        return (whole or has(self.also, words)) and not has(self.never, words)

    @property
    def said(self) -> str:
        """Its name in words."""
        return _UNIT_AT_END.sub("", self.name).replace("_", " ")


_ENDINGS = {
    "_per_s": "number", "_rad_s": "spin", "_m_s": "speed", "_m": "length", "_s": "time",
    "_N": "force", "_deg": "angle", "_K": "temperature",
}  # fmt: skip
_UNIT_AT_END = re.compile(f"({'|'.join(_ENDINGS)})$")


def plain_kind(column: str) -> SheetKind:
    """Return what a column of trials.csv is, said by its own name in words."""
    quantity = next((q for end, q in _ENDINGS.items() if column.endswith(end)), "number")
    words = _UNIT_AT_END.sub("", column).replace("_", " ")
    return SheetKind(column, quantity, (f"^{words}$",))


@cache
def _compiled(pattern: str) -> re.Pattern[str]:
    return re.compile(letters(pattern))


def has(pattern: str, words: str) -> bool:
    """Whether words, as `bare` gives them, hold one of a pattern; none is in an empty one."""
    return bool(pattern) and _compiled(pattern).search(words) is not None


# the first that is said
KINDS = (
    SheetKind("note", "text",
        (r"\bnot(e|es|a|as|iz\w*)\b|remark|comment|coment|\bbem(erk|\b)|kommentar|komentarz|"
         r"\banm(erk|\b)|remarque|osservaz|commento|observa[ct]|\bobs\b|uwag|记录$|备注|说明|備考|コメント|メモ",)),
    SheetKind("person", "text",
        (r"operator|observer|experimente?[ar]|\btester\b|student|te[ck]hni[ck]|tecnic|"
         r"(measured|tested|done) by|prue?fer|bediener|bearbeiter|operateur|operatrice|operatore|"
         r"operari|operador|wykonal|badajac|"
         r"操作[员者]|试验员|测试人|測定者|担当|試験者",)),
    SheetKind("ball", "text",
        (r"^(ball|striker|indenter|projectile|kugel|bille|bola|esfera|sfera|kul[ak]a?|钢球|鋼球|球)"
         r"([ -]?(type|material|no|nr|id|nummer|number))?\.?$|n[or°]?\.? (bille|kul[ik]i)",)),
    SheetKind("spot", "text",
        (r"^((impact )?spot|(mess|treff|aufschlag)?stelle|point d impact|punto d[i e]* ?impacto?|"
         r"ponto de impacto)( ?(no|nr|n))?\.?$",)),
    SheetKind("temperature_K", "temperature", (r"temperatur|\btemp\b|温度|室温",), r"^t$"),
    SheetKind(REBOUND_ANGLE, "angle", (_ANGLE, _AFTER),
        never=f"{_SWING}|contact|kontakt|tilt|neigung"),
    SheetKind("angle_deg", "angle", (_ANGLE,),
        never=f"{REBOUND}|{_SWING}|contact|kontakt|tilt|neigung"),
    SheetKind("restitution", "number",
        ("restitu[tczi]|restytuc|stoss?zahl|stossziffer|恢复系数|反発係数|はね返り係数",),
        r"^e ?n? ?\d*$|^cor ?\d*$", f"{ALONG}|{_SQUARED}|{_LESS}|{_LATER_BLOW}"),
    SheetKind("rebound_spin_rad_s", "spin", (_SPIN, _AFTER)),
    SheetKind(REBOUND_HEIGHT, "length", (REBOUND, HEIGHT),
        rf"^h ?{_BACK}$|^{_HIGH} ({_LATE})\b", "drop height|fallhoe?he"),
    SheetKind(REBOUND_SPEED, "speed", (_AFTER, SPEED), rf"^v ?{_BACK}$",
        rf"{ALONG}|before|\bvor\b|avant|prima|antes|przed|前"),
    SheetKind("drop_height_m", "length", (DROPS, HEIGHT),
        rf"^(h ?0?|h ?drop|({_HIGH}|高[度さ])( h)?)$|^{_HIGH} ({_EARLY})\b|^dropped|"
        "fall(weg|strecke)"),
    SheetKind("impact_speed_m_s", "speed", (_BEFORE, SPEED),
        "^(v( ?n)?|v ?(in?|imp(act)?|auf|an|vor|pre)|speed|velocity|geschwindigkeit|vitesse|"
        r"velocita|velocidade?|predkosc|速度)( normal\w*)?$", ALONG),
    SheetKind("dent_diameter_m", "length",
        (_DENT, rf"{DIAMETER}|dm\b|{_WIDTH}|\bd ?[\dxy]?$|^d\b"), never=_NO_WHOLE),
    SheetKind("scar_width_m", "length", (_SCAR, _WIDTH)),
    SheetKind("scar_length_m", "length", (_SCAR, _LENGTH)),
    # the largest depth under load is not what stays
    SheetKind("permanent_depth_m", "length", (f"{_DENT}|residu|permanent|bleibend", _DEPTH),
        "^h ?bl$|^(depth|tiefe)$|eindring(tiefe|ung)|profond|profund|głębokość|深[度さ]",
        rf"^(?=.*\bma[xk])(?=.*({_SINK}))|^press|^recovered|dynam"),
    SheetKind("contact_time_s", "time", (_BLOW, _TIME),
        r"duree|durata|duracion|duracao|^t ?(c$|[ck]ont)",
        rf"between|zwischen|entre|miedzy|time of|zeitpunkt|\bbis\b|until|before|{_AFTER}|{DROPS}|"
        rf"{_LATER_BLOW}|time (to|at)\b|avant|hasta|antes|przed|hh:mm|"
        r"\b(vol|volo|voo)\b|vuelo|essai|ensa[iy]o|\bprova\b|\btest|versuch|prue?f"),
    SheetKind("peak_force_N", "force", (_MOST, _FORCE), rf"^f ?({_MOST})", _LATER_BLOW),
    SheetKind(LOAD, "force",
        (r"^(load|last|charge|carico|carga|obciazenie|载荷|负荷)(?![a-z])|荷重|"
         "(test|applied) (force|load)|force appliquee|fuerza aplicada|forza applicata|"
         "forca aplicada|prue?f(kraft|last)|试验力|試験力",)),
    SheetKind(BALL_DIAMETER, "length", (BALL, DIAMETER), never=rf"\bflat|abplatt|meplat|{_DENT}"),
    SheetKind(BALL_MASS, "mass", (BALL, _MASS), "^(mass[ae]?|masa|质量|質量)$"),
    SheetKind("trial", "text",
        (r"^#|^(nr|no|n|n\.?o|num|number|numero|test|trial|versuchs?|messung|probe|shot|run|id|"
         r"sample|specimen|drop (no|number)|essai|mesure|eprouvette|prova|misura|campione|ensayo|"
         r"medida|probeta|ensaio|medicao|amostra|proba|probka|pomiar|lp|lfd|vers)\b|"
         r"^drop( ?#)?$|^n°|编号|序号|番号|试样|試料|試番|試験 ?no",)),
    *map(plain_kind, (
        "approach_tangential_m_s", "approach_spin_rad_s", "tangential_rebound_m_s",
        "friction_impulse_ratio", "sliding_length_m", "scar_excess_m", "press_depth_m",
        "recovered_depth_m", "order",
    )),
)  # fmt: skip

NOTE = KINDS[0]
UNDERSTOOD = ", ".join(kind.said for kind in KINDS if kind.name not in ("person", "ball"))
"""Names that a header may have, for people."""
