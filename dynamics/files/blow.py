"""A blow by several laws beside each other, as `dentscope.impact(...)` returns it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ...core.tables import frame, html_table, text_table
from ...models.base import ContactLaw
from ...models.choose import demand, objection
from ...models.shelf import UnknownLaw
from ...models.turned import as_made
from ..integrate import Trace, strike, traced
from ..report.band import PRESSURE, Band, band_of, compared, idle, vague
from ..report.checks import checks, lacks_of, outside, reason_above_one
from ..report.effect import ATOM
from ..report.flow import Lack
from ..report.onset import largest_mean_pressure
from ..result import Impact
from .setup import Setup
from .tables import EXACT, SHOWN, impact_row

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# limit: relative standard deviation below which none is shown [-]; round-off of the slopes
_SURE = 1e-6

# limit: numbers below this part of the largest of their unit are shown as 0 [-]: round-off of the
# integral
_SHOWN_ROUND_OFF = 1e-7

# limit: points of a history that is written [-]: a figure's width
_HISTORY_POINTS = 200

_TOO_DEEP = (
    "so deep no law was compared with finite elements; the numbers have no standard deviation"
)


@dataclass(frozen=True)
class Blow:
    """One blow, by every law that was asked for.

    `name`: of the set-up; `traces`: history of the last repeat, by law; `rows`: observables of
    every repeat by every law, SI, units in the names; `setup`, `laws`: what was asked for.
    """

    name: str
    traces: dict[str, Trace]
    rows: tuple[dict[str, Any], ...]
    setup: Setup
    laws: tuple[ContactLaw, ...]

    @cached_property
    def bands(self) -> dict[str, Band]:
        """How sure the last repeat's numbers are, by law; worked out when first asked for."""
        return {law.name: band_of(self.setup, law) for law in self.laws}

    @cached_property
    def lacks(self) -> dict[str, dict[str, Lack]]:
        """What the set-up leaves open, by law and name, with the blow that it would be."""
        return {
            law.name: lacks_of(self.setup, law, self[law.name]) for law in self.laws
            if law.name in self.sure and self[law.name].restitution > 0.0
        }  # fmt: skip

    def checks(self) -> list[str]:
        """Return what speaks against the set-up by the first law, and restitutions above 1."""
        first = self.laws[0]
        ended = [law for law in self.laws if self[law.name].outcome.completed]
        outer = (
            outside(law, self.setup.scene(law), self[law.name])
            for law in ended if law.name not in self.doubts
        )  # fmt: skip
        unsure = ", ".join(law.name for law in ended if law.name not in self.sure)
        above = {law.name: reason_above_one(self.setup.scene(law), self[law.name]) for law in ended}
        return [
            *(line for line in outer if line),
            *([f"{unsure}: {_TOO_DEEP}"] if unsure else []),
            *checks(self.setup, first, self[first.name], self.lacks.get(first.name, {})),
            *self._not_by_all(),
            *(f"{name}: {reason}" for name, reason in above.items() if reason),
        ]

    def _not_by_all(self) -> list[str]:
        """Say which mechanism that acts by the first law does not by another."""
        asked, without = self.setup.asked, dict[tuple[str, str], list[str]]()
        for law in self.laws if asked else ():
            for name, reason in asked.idle([self.setup.plain(law)]).items():
                without.setdefault((name, reason), []).append(law.name)
        return [
            f"{name} does not act by {', '.join(laws)}: {reason}"
            for (name, reason), laws in without.items() if self.laws[0].name not in laws
        ]  # fmt: skip

    @cached_property
    def sure(self) -> frozenset[str]:
        """Laws by which the blow came to an end, at a depth where their error is known."""
        return frozenset(
            law.name for law in self.laws if self[law.name].outcome.completed
            and compared(law, self.setup.scene(law).pair, self[law.name].peak_depth_m)
        )  # fmt: skip

    def rules(self) -> list[str]:
        """Return what rules the bands of restitution and dent, by the first law."""
        first = self.laws[0].name
        if first not in self.sure:
            return []
        band = self.bands[first]
        (found,) = _shown([self[first]])
        told = (("restitution", 1.0, "restitution"), ("residual_flat_m", 1e6, "crater depth [um]"))
        lost = [part for part, changes in band.parts.items() if "restitution" not in changes]
        without, of = "the standard deviations are without the part of", "the standard deviation of"
        lines = [f"{without} {part}: a blow for it did not end" for part in lost]
        for name, scale, words in told:
            if band.std(name) > _SURE * found[name] > 0.0:
                cell = _cell(scale * found[name], scale * band.std(name))
                lines.append(f"{words} {cell}: {band.rules(name)} of the variance")
        for key, share in idle(self.setup, band):
            lines.append(f"{of} {key}, {share:.2g} of it, changes nothing here")
        for key, times in vague(self.setup):
            lines.append(
                f"{of} {key} is {times:.2g} times its value: the bands have the slope at the "
                "value, and do not go through that spread"
            )
        return lines

    @cached_property
    def doubts(self) -> dict[str, str]:
        """What speaks against a law at the depth of its blow, by its name."""
        told = {}
        for law in self.laws:
            scene = self.setup.scene(law)
            need = demand(as_made(scene.law, scene.pair)[1], self[law.name].peak_depth_m)
            if against := objection(law, need):
                told[law.name] = against
        return told

    @property
    def impacts(self) -> dict[str, Impact]:
        """Observables of the last repeat, by law."""
        return {law: trace.impact for law, trace in self.traces.items()}

    def __getitem__(self, law: str) -> Impact:
        if law not in self.traces:
            raise UnknownLaw(f"no law {law!r} in this blow; it has {', '.join(self.traces)}")
        return self.traces[law].impact

    def table(self, *, exact: bool = False) -> list[tuple[str, ...]]:
        """Return the observables in units for people, a law a column; what is nothing is left out.

        Name with unit, then the value by each law, with its standard deviation unless `exact`; of a
        law by which the blow did not end nothing.
        """
        ended = [law for law, one in self.impacts.items() if one.outcome.completed]
        shown = dict(zip(ended, _shown([self[law] for law in ended]), strict=True))

        def cell(law: str, key: str, scale: float) -> str:
            if law not in shown:
                return "unfinished" * (key == "restitution")
            far = (*self._interval(law, key, exact=exact), *_reach(key, self[law]))
            return _cell(scale * shown[law][key], *(scale * x for x in far))

        def row(label: str, key: str, scale: float, unit: str) -> tuple[str, ...]:
            cells = (cell(law, key, scale) for law in self.traces)
            return (f"{label} [{unit}]" if unit != "-" else label, *cells)

        rows = [
            row(label, key, scale, unit) for label, key, scale, unit in SHOWN
            if key == "restitution" or any(abs(values[key]) > 0.0 for values in shown.values())
        ]  # fmt: skip
        last = {row["law"]: row[PRESSURE] for row in self.rows}
        for law, values in shown.items():
            values[PRESSURE] = last[law]
        return [*rows, row("largest mean pressure", PRESSURE, 1e-6, "MPa")]

    def _interval(self, law: str, key: str, *, exact: bool) -> tuple[float, float, float]:
        """Standard deviation, and how far what is not stated may move a number up and down."""
        if exact or key in EXACT or law not in self.sure:
            return 0.0, 0.0, 0.0
        lacks = self.lacks.get(law, {}).values() if hasattr(self[law], key) else ()
        moved = [lack.moved(key, self[law]) for lack in lacks]
        up, down = (sum(by) for by in zip(*moved, strict=True)) if moved else (0.0, 0.0)
        return self.bands[law].std(key), up, down

    def written(self, *, exact: bool = False) -> list[dict[str, Any]]:
        """Return the rows with standard deviations, of the last repeat alone."""
        if exact:
            return list(self.rows)
        last = {row["law"]: row["repeat"] for row in self.rows}
        named = [*(key for _, key, _, _ in SHOWN if key not in EXACT), PRESSURE]

        def stds(law: str, repeat: int) -> dict[str, Any]:
            known = repeat == last[law] and law in self.sure
            return {f"{key}_std": self.bands[law].std(key) if known else "" for key in named}

        return [{**row, **stds(row["law"], row["repeat"])} for row in self.rows]

    def frame(self) -> Any:
        """Return a pandas data frame: a row a law and repeat, a column an observable [SI]."""
        return frame(self.rows)

    def plot(self) -> Figure:
        """Return the rig and what stays, to scale, force over depth, and what moves over time."""
        from ..report.picture import picture  # the published craters: not before they are drawn

        return picture(self)

    def __repr__(self) -> str:
        return text_table([(self.name, *self.traces), *self.table()], numbers=True)

    def _repr_html_(self) -> str:
        return html_table(("", *self.traces), self.table(), title=self.name)


def blow_of(setup: Setup, laws: Sequence[ContactLaw]) -> Blow:
    """Return the blow of a set-up by these laws, every repeat on the spot of the one before.

    A body with a flow curve is refused where none of the laws follows one.
    """
    setup.check_laws(laws)
    traces: dict[str, Trace] = {}
    rows: list[dict[str, Any]] = []
    for law in laws:
        scene = setup.scene(law)
        for number in range(1, setup.repeats + 1):
            struck = strike(scene, setup.settings)
            found = setup.read(law, struck)
            pressure = largest_mean_pressure(scene, struck) if found.peak_depth_m > 0.0 else 0.0
            one = {"law": law.name, "repeat": number}
            rows.append({**one, **impact_row(found), PRESSURE: pressure})
            history = traced(scene, setup.settings, points=_HISTORY_POINTS)
            traces[law.name] = replace(history, impact=setup.read(law, history.impact))
            # the next blow falls on the same spot: hardened crater, flattened tip
            scene = scene.with_(spot=struck.spot)
    return Blow(setup.name, traces, tuple(rows), setup, tuple(laws))


_LEFT = ("residual_flat_m", "residual_sphere_m")


def _shown(impacts: Sequence[Impact]) -> list[dict[str, float]]:
    """What is shown of each; 0 for what rounding alone has left and a dent below an atom."""
    columns = [{key: float(getattr(one, key)) for _, key, _, _ in SHOWN} for one in impacts]
    largest = {"mJ": max((one.kinetic_before_J for one in impacts), default=0.0)}
    # a spin beside the rebound over a metre
    largest["rad/s"] = max((abs(one.rebound_speed_m_s) for one in impacts), default=0.0)
    for _, key, _, unit in SHOWN if columns else ():
        largest[unit] = max([largest.get(unit, 0.0), *(abs(values[key]) for values in columns)])

    def shown(key: str, unit: str, value: float) -> float:
        least = max(_SHOWN_ROUND_OFF * largest[unit], ATOM if key in _LEFT else 0.0)
        return 0.0 if key not in EXACT and abs(value) <= least else value

    return [{key: shown(key, unit, one[key]) for _, key, _, unit in SHOWN} for one in columns]


def _reach(key: str, found: Impact) -> tuple[float, float]:
    """How far up and down a number can go at all: nothing below 0 but motion along the flat.

    No restitution rises above 1, nor the rebound above the approach, as far as they have not.
    """
    value = float(getattr(found, key, math.inf))
    # a leaning rod's centre may go on downwards as its tip comes back
    if key.startswith(("tangential", "rebound_spin")) or value < 0.0:
        return math.inf, math.inf
    most = math.inf
    if key.endswith("restitution"):
        most = 1.0
    elif key == "rebound_speed_m_s" and found.restitution > 0.0:
        most = value / found.restitution
    return max(most - value, 0.0), value


def _cell(
    value: float, std: float = 0.0, up: float = 0.0, down: float = 0.0, rise: float = math.inf,
    fall: float = math.inf,
) -> str:  # fmt: skip
    """A number with its interval: what may move it by more than `std` stands on its own side.

    No side is longer than `rise` or `fall`.
    """
    # a tip that comes straight down has no tangential speed to be given back
    if math.isnan(value):
        return "none"
    least = _SURE * abs(value)
    if value != 0.0 and max(up, down) > max(std, least):
        sides = (min(math.hypot(std, x), most) for x, most in ((up, rise), (down, fall)))
        above, below = (_number(float(f"{x:.1e}") if x > least else 0.0) for x in sides)
        return f"{value:.4g} +{above} -{below}"
    if value != 0.0 and std > least:
        return f"{value:.4g} ± {_number(float(f'{std:.1e}'))}"
    return _number(value)


def _number(value: float) -> str:
    return f"{value:.4g}" if value == 0.0 or abs(value) >= 1e-3 else f"{value:.1e}"
