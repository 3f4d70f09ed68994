"""What the text says of figures 4.4-4.15, judged by our own numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ....core.arrays import Array
from ....dynamics.result import Impact
from .claims import judged, ranked

Ends = Mapping[str, Impact]
"""By law, one impact at 45 degrees and 1 m/s."""
Swept = Mapping[str, Sequence[Impact]]
"""By law, an impact at each speed."""
Values = dict[str, Array]
"""By law, one quantity over the speeds."""

_JG, _OWN, _KE, _KK, _YK = (
    "jackson-green-2007", "ghaednia", "kogut-etsion-continued", "kogut-komvopoulos",
    "ye-komvopoulos",
)  # fmt: skip
_SIX = (_JG, _OWN, _KE, _KK, _YK, "stronge")
_BRAKES = ("brake-2012", "brake-2015")
_NOT_OURS = "fitted"


def _of(ends: Ends, read: Callable[[Impact], float]) -> dict[str, float]:
    """The thesis's nine laws."""
    return {name: read(impact) for name, impact in ends.items() if name != _NOT_OURS}


def _told(ends: Ends, read: Callable[[Impact], float], form: str) -> str:
    """Smallest and largest of all laws; the curves are in the picture."""
    found = sorted((read(impact), name) for name, impact in ends.items())
    (low, first), (high, last) = found[0], found[-1]
    return f"from {low:{form}} ({first}) to {high:{form}} ({last})"


def _tip_height(ends: Ends) -> str:
    loading = _of(ends, lambda i: 1e3 * i.loading_time_s)
    lasts = _of(ends, lambda i: 1e3 * i.contact_time_s)
    dent = _of(ends, lambda i: 1e6 * i.residual_m)
    others = [loading[name] for name in _SIX]
    return (
        f"Loading lasts [ms] {_told(ends, lambda i: 1e3 * i.loading_time_s, '.3f')}. "
        + judged(
            ("loading lasts about 0.11 ms for six laws", _near(others, 0.11, 0.008)),
            (f"longer for Brake's two and Thornton's than for the others (Brake 2012 "
             f"{loading['brake-2012']:.3f})",
             min(loading[n] for n in (*_BRAKES, "thornton")) > max(others)),
            ranked(dent, "stronge", first="smallest", form=".0f"),
            ranked(dent, "thornton", first="largest", form=".0f"),
            ("Thornton's contact lasts longest", lasts["thornton"] == max(lasts.values())),
            ("Brake's come next", min(lasts[n] for n in _BRAKES)
             > max(v for n, v in lasts.items() if n not in (*_BRAKES, "thornton"))),
        )
    )  # fmt: skip


def _near(values: Sequence[float], middle: float, within: float) -> bool:
    return all(abs(v - middle) <= within for v in values)


def _slid(ends: Ends) -> str:
    slid = _of(ends, lambda i: 1e6 * i.sliding_length_m)
    return (
        f"Slid at the end [um] {_told(ends, lambda i: 1e6 * i.sliding_length_m, '.0f')}. "
        + judged(
            ranked(slid, "brake-2012", first="largest", form=".0f"),
            ("Thornton's and Brake's stand apart", min(slid[n] for n in (*_BRAKES, "thornton"))
             > max(v for n, v in slid.items() if n not in (*_BRAKES, "thornton"))),
        )
    )  # fmt: skip


def _rebound(ends: Ends) -> str:
    e = _of(ends, lambda i: i.restitution)
    three = [e[n] for n in (*_BRAKES, _KE)]
    gap = sorted(e.values())
    return f"Rebound [m/s] {_told(ends, lambda i: i.restitution, '.3f')}. " + judged(
        ranked(e, "stronge", first="largest", form=".3f"),
        ("Brake's two and Kogut and Etsion are nearly alike", max(three) - min(three) < 0.05),
        ranked(e, "thornton", first="smallest", form=".3f"),
        ("Thornton's differs much", gap[1] - gap[0] > 0.1),
    )


def _tangential(ends: Ends) -> str:
    return _after(
        ends, lambda i: abs(i.tangential_rebound_m_s), "Tangential velocity of the centre [m/s]",
        ".4f",
    )  # fmt: skip


def _spin(ends: Ends) -> str:
    return _after(ends, lambda i: abs(i.rebound_spin_rad_s), "Spin without its sign [rad/s]", ".2f")


def _after(ends: Ends, read: Callable[[Impact], float], what: str, form: str) -> str:
    found, lasts = _of(ends, read), _of(ends, lambda i: i.contact_time_s)
    lowest = sorted(found, key=lambda name: found[name])[:3]
    longest = sorted(lasts, key=lambda name: -lasts[name])[:4]
    return (
        f"{what} at the end {_told(ends, read, form)}. "
        + judged(
            ranked(found, "stronge", first="largest", form=form),
            (f"beside Thornton, Kogut and Komvopoulos and Ye and Komvopoulos are smallest (here "
             f"{', '.join(lowest)})", set(lowest) == {"thornton", _KK, _YK}),
            (f"Thornton, Brake and Stronge last longest (here {', '.join(longest)})",
             set(longest) == {"thornton", "stronge", *_BRAKES}),
        )
    )  # fmt: skip


HISTORY_SAID: dict[str, Callable[[Ends], str]] = {
    "4.4": _tip_height, "4.5": _slid, "4.6": _rebound, "4.7": _tangential, "4.8": _spin,
}  # fmt: skip
"""By figure, from the impacts at 1 m/s."""


def _nine(values: Values, at: int) -> dict[str, float]:
    return {name: float(v[at]) for name, v in values.items() if name != _NOT_OURS}


def _depth(values: Values, _sweep: Mapping[str, Any]) -> str:
    here = _nine(values, 2)
    return "At 1.5 m/s, in um. " + judged(
        ("every law's depth rises with the speed", all(np.all(np.diff(v) > 0.0)
                                                       for v in values.values())),
        ranked(here, "thornton", first="largest", form=".0f"),
        ranked(here, "brake-2015", first="largest", form=".0f", without=("thornton",)),
        ranked(here, "stronge", first="smallest", form=".0f", without=("thornton",)),
    )  # fmt: skip


def _restitution_45(values: Values, sweep: Mapping[str, Any]) -> str:
    e, first, last = sweep["restitution"], _nine(values, 0), _nine(values, -1)
    falling = [n for n in first if n != _OWN]
    flat = [n for n in falling if first[n] - last[n] < 0.02]
    small, large = (_JG, _YK, _KK), (_KE, *_BRAKES, "stronge")
    own = values[_OWN]
    return judged(
        ("all but the thesis's own model fall with the speed"
         + (f" ({', '.join(flat)} does not)" if flat else ""), not flat),
        (f"the thesis's own agrees (it gives {own.min():.2f} to {own.max():.2f})",
         float(np.max(np.abs(own - e))) < 0.04),
        ("Kogut and Etsion, Brake's two and Stronge begin above it",
         min(first[n] for n in large) > e),
        (f"they come down to it ({', '.join(f'{n} {last[n]:.2f}' for n in large)} at 4 m/s)",
         _near([last[n] for n in large], e, 0.03)),
        (f"Jackson and Green, Ye and Komvopoulos and Kogut and Komvopoulos lie below it (here "
         f"{_JG} {values[_JG].mean():.2f}, {_YK} {values[_YK].mean():.2f}, {_KK} "
         f"{values[_KK].mean():.2f} in the mean)", all(np.mean(values[n]) < e for n in small)),
        _largest_mean(values, "stronge"),
        _smallest_mean(values, "thornton"),
    )  # fmt: skip


def _mean(values: Values) -> dict[str, float]:
    return {n: float(np.mean(np.abs(v))) for n, v in values.items() if n != _NOT_OURS}


def _largest_mean(values: Values, law: str) -> tuple[str, bool]:
    told, holds = ranked(_mean(values), law, first="largest")
    return f"in the mean over the speeds {told}", holds


def _smallest_mean(values: Values, law: str) -> tuple[str, bool]:
    return ranked(_mean(values), law, first="smallest")


def _spin_45(values: Values, _sweep: Mapping[str, Any]) -> str:
    return judged(
        ("the spin grows with the speed", _grows(values)),
        ("Jackson and Green, Kogut and Komvopoulos, Ye and Komvopoulos and Thornton have less than "
         "the others", max(_mean(values)[n] for n in (_JG, _KK, _YK, "thornton"))
         < min(v for n, v in _mean(values).items() if n not in (_JG, _KK, _YK, "thornton"))),
    )  # fmt: skip


def _grows(values: Values) -> bool:
    return all(bool(np.all(np.diff(np.abs(v)) > 0.0)) for v in values.values())


def _restitution_17(values: Values, sweep: Mapping[str, Any]) -> str:
    e = sweep["restitution"]
    over = [n for n, v in values.items() if n != _NOT_OURS and float(v.max()) > e]
    nearest = min(values, key=lambda n: float(np.max(np.abs(values[n] - e))))
    own = values[_OWN]
    return judged(
        (f"none matches (nearest {nearest}, off by at most "
         f"{np.max(np.abs(values[nearest] - e)):.2f})",
         all(float(np.max(np.abs(v - e))) > 0.05 for v in values.values())),
        (f"the thesis's own is as constant, and smaller ({own.min():.2f} to {own.max():.2f})",
         float(np.ptp(own)) < 0.03 and own.max() < e),
        ("all laws give less" + (f" (at low speed more: {', '.join(over)})" if over else ""),
         not over),
        _largest_mean(values, "stronge"),
        _smallest_mean(values, "thornton"),
    )  # fmt: skip


def _spin_17(values: Values, _sweep: Mapping[str, Any]) -> str:
    return judged(
        ("the spin grows with the speed", _grows(values)),
        _largest_mean(values, "stronge"),
        _smallest_mean(values, "thornton"),
    )


def _dents(values: Values, _sweep: Mapping[str, Any]) -> str:
    deep = _nine(values, 2).values()
    return (
        "As the text says, every law's dent is much deeper than the measured ones: at 1.5 m/s "
        f"{min(deep):.0f} to {max(deep):.0f} um."
    )


SWEEP_SAID: dict[str, Callable[[Values, Mapping[str, Any]], str]] = {
    "4.9": _depth, "4.10": _restitution_45, "4.11": _spin_45, "4.12": _restitution_17,
    "4.13": _spin_17, "4.14": _dents, "4.15": _dents,
}  # fmt: skip
"""By figure, from one quantity over the speeds and what was measured."""
