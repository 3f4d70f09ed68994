"""What chapter 2 of the thesis says of its finite elements, each claim tested on a campaign.

Claims on one case over Sy* are in `campaign_claims`; here are those that compare cases, formulas
and laws, and the whole list in the order of the text.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...campaigns import CaseRecord
from ...campaigns.cases.pairs import pair_of, table_2_1
from ...models import LAWS
from ...models.base import unwarned
from ..thesis.figures.quantities import DEPTH, force, model_share, pressure, radius
from .claims import CLAIMS, FEWEST, Finding
from .sweep import Sweep, at_depth, by_pair, groups_of, sweeps

Findings = dict[str, Finding]


@dataclass(frozen=True)
class Trend:
    """One claim of the text and what the finite elements say to it.

    `section`: of the thesis; `claim`: what the text says, with the tolerance that it is tested
    with; `findings`: for each case or pair: whether it holds, and the number.
    """

    section: str
    claim: str
    findings: Findings

    @property
    def verdict(self) -> str:
        """In a word: agrees, contradicts, partly, not computed."""
        holds = [good for good, _ in self.findings.values()]
        if not holds:
            return "not computed"
        if all(holds):
            return "agrees"
        return "partly" if any(holds) else "contradicts"


def trends(records: Sequence[CaseRecord]) -> list[Trend]:
    """Test every claim, in the order of the text."""
    found = sweeps(records)
    out = [Trend(section, claim, _each(found, test)) for section, claim, test in CLAIMS]
    out[_AFTER_SWEEPS:_AFTER_SWEEPS] = [_order(found, *row) for row in _ORDERS]
    stored = by_pair(records)
    formulas = [_formula(found, *row) for row in _FORMULAS]
    last = [*_fully_plastic(stored), *formulas, _other_laws(stored)]
    return [*_elastic_partner(records), *out, *last]


def _each(found: Mapping[int, Sweep], test: Callable[[Sweep], Finding | None]) -> Findings:
    told = {f"case {number}": test(sweep) for number, sweep in found.items()}
    return {name: finding for name, finding in told.items() if finding is not None}


_AFTER_SWEEPS = len(CLAIMS) - 1


def _order(found: Mapping[int, Sweep], name: str, words: str) -> Trend:
    """Compare the order of the five cases with that of the thesis's own formulas."""
    findings: Findings = {}
    for ratio in (0.1, 1.0, 10.0):
        places = {number: sweep.at(ratio) for number, sweep in found.items()}
        there = [number for number, k in places.items() if k is not None]
        if len(there) < FEWEST:
            continue
        ours = {n: float(getattr(found[n], name)[places[n]]) for n in there}
        theirs = {n: _of_the_thesis(n, ratio, name) for n in there}
        mine, its = (sorted(there, key=values.__getitem__) for values in (ours, theirs))
        words_of = [" < ".join(map(str, order)) for order in (mine, its)]
        note = words_of[0] if mine == its else f"{words_of[0]}, in the thesis {words_of[1]}"
        findings[f"Sy* = {ratio:g}"] = (mine == its, note)
    return Trend("2.2", f"the order of the cases in {words} (by the thesis's formulas)", findings)


_ORDERS = (
    ("share", "delta_s*"),
    ("radius", "a/R"),
    ("pressure", "p/Sy_min"),
    ("force", "F/(E' R^2)"),
)


_FORMULAS = (
    ("2.5.2", "radius", (5,), 0.01, "Eqs. 2.20-2.31 give a of case 5 within 1 %"),
    ("2.5.3", "pressure", (1, 2, 3, 4, 5), 0.05, "Eq. 2.34 gives the mean pressure within 5 %"),
    ("2.5.4", "force", (1, 2, 3, 4, 5), 0.05, "Eqs. 2.37-2.38 give F within 5 %"),
)


def _formula(
    found: Mapping[int, Sweep],
    section: str,
    name: str,
    numbers: tuple[int, ...],
    within: float,
    claim: str,
) -> Trend:
    """How far the thesis's formulas, as corrected, are from the finite elements."""
    findings: Findings = {}
    for number in numbers:
        sweep = found.get(number)
        if sweep is None or len(sweep.ratio) < FEWEST:
            continue
        theirs = np.array([_of_the_thesis(number, ratio, name) for ratio in sweep.ratio])
        off = np.abs(theirs / getattr(sweep, name) - 1.0)
        worst = int(np.argmax(off))
        note = f"mean {off.mean():.1%}, at most {off[worst]:.1%} (Sy* = {sweep.ratio[worst]:g})"
        findings[f"case {number}"] = (bool(off[worst] <= within), note)
    return Trend(section, claim, findings)


def _other_laws(stored: Mapping[str, CaseRecord]) -> Trend:
    """Figure 2.20: other laws beside the finite elements of a dent in a soft flat."""
    pair = pair_of(E_s=300.0, E_f=300.0, Sy_min=100.0, ratio=10.0)
    record, depth = stored.get(groups_of(pair)), 0.05
    values = at_depth(record, depth) if record is not None else None
    findings: Findings = {}
    for name, low, high in (
        ("jackson-green", -0.35, -0.25),
        ("kogut-komvopoulos", -0.25, -0.15),
        ("kogut-etsion", 0.0, np.inf),
    ):
        if values is None:
            break
        with unwarned():
            off = float(force(LAWS[name], pair, np.array([depth]))[0]) / values[3] - 1.0
        findings[name] = (low <= off <= high, f"{off:+.0%}")
    claim = (
        "figure 2.20, at Delta/R = 0.05: Jackson and Green about 30 % low, Kogut and Komvopoulos "
        "about 20 % low (within 5 points), Kogut and Etsion high"
    )
    return Trend("2.5.4", claim, findings)


def _of_the_thesis(number: int, ratio: float, name: str) -> float:
    pair = table_2_1(number, ratio)
    if name == "share":
        return model_share(pair)
    with unwarned():
        return float(_QUANTITIES[name](LAWS["ghaednia"], pair, np.array([DEPTH]))[0])


_QUANTITIES = {"radius": radius, "pressure": pressure, "force": force}


def _elastic_partner(records: Sequence[CaseRecord]) -> list[Trend]:
    """Figures 2.2 to 2.4: which body stays elastic."""
    stored = by_pair(records)
    out = []
    for figure, ratio, body, claim in (
        ("2.2", 0.1, "flat", "Sy* = 0.1: the flat stays elastic (its residual depth below 0.1 %)"),
        ("2.4", 10.0, "sphere", "Sy* = 10: the sphere stays elastic (residual below 0.1 %)"),
    ):
        findings: Findings = {}
        for number in (0, *range(1, 6)):
            pair = pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=ratio)
            record = stored.get(groups_of(table_2_1(number, ratio) if number else pair))
            if record is None or not record.unloadings:
                continue
            last = record.unloadings[-1]
            whole = last.residual_sphere + last.residual_flat
            part = abs(getattr(last, f"residual_{body}")) / whole
            name = f"figure {figure}" if number == 0 else f"case {number}"
            findings[name] = (part < 1e-3, f"{part:.2g} of the residual depth")
        out.append(Trend("2.2.1", claim, findings))
    return out


def _fully_plastic(stored: Mapping[str, CaseRecord]) -> list[Trend]:
    """Figure 2.14: where the mean pressure peaks along the loading, and how high it is."""
    peaks: Findings = {}
    tops: dict[float, list[float]] = {}
    for ratio in (0.1, 1.0, 10.0):
        chosen = [r for r in stored.values() if abs(np.log(r.case.pair.Sy_ratio / ratio)) < 1e-6]
        found = [_peak(record) for record in chosen]
        told = [(w, p) for w, p in found if np.isfinite(w)]
        if len(told) >= FEWEST:
            middle = float(np.median([w for w, _ in told]))
            tops[ratio] = [p for _, p in told]
            good = 55.0 <= middle <= 220.0
            peaks[f"Sy* = {ratio:g}"] = (good, f"median {middle:.0f} of {len(told)} pairs")
    higher: Findings = {}
    if 1.0 in tops and 0.1 in tops:
        one, flat = float(np.mean(tops[1.0])), float(np.mean(tops[0.1]))
        higher["Sy* = 1 below 0.1"] = (one < flat, f"{one:.2f} and {flat:.2f} Sy_min")
    if 10.0 in tops and 0.1 in tops:
        dent, flat = float(np.mean(tops[10.0])), float(np.mean(tops[0.1]))
        higher["Sy* = 10 above 0.1"] = (dent > flat, f"{dent:.2f} and {flat:.2f} Sy_min")
    return [
        Trend("2.4.3", "the mean pressure peaks near delta_n = 110 (within a factor 2)", peaks),
        Trend("2.4.3", "its peak is slightly lower at Sy* = 1 and higher in indentation", higher),
    ]


def _peak(record: CaseRecord) -> tuple[float, float]:
    """delta/delta_c and p/Sy_min where the mean pressure is largest; nan at the curve's end."""
    pair, curve = record.case.pair, record.curve
    w = curve["delta"] / (pair.first_yield * pair.R)
    plastic = w > 5.0
    if plastic.sum() < 5:
        return np.nan, np.nan
    pressure = curve["hardness"][plastic] / pair.Sy_min
    best = int(np.argmax(pressure))
    if best == len(pressure) - 1:
        return np.nan, float(pressure[best])
    return float(w[plastic][best]), float(pressure[best])
