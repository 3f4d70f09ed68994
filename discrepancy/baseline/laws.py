"""Contact laws of a recording set's strikers: what its metals are known to do.

Without more, the fitted law at the stated strength. Where a body comes with a flow curve, the law
of metals that harden; where the set's own pair was solved by finite elements, that. Both are known
at the stated numbers; around them the fitted law says how the contact changes (`AnchoredLaw`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Literal

from ...core.flow import Flow
from ...core.material import Material, Pair
from ...core.observables import OBSERVABLES
from ...core.rig import BodyTable, TargetTable
from ...models import LAWS
from ...models.anchored import anchored
from ...models.base import ContactLaw, remembering
from ...models.fitted import ClosedForm
from ...models.table import table_law
from ...recordings import RecordingSet
from .solve import solved_pair

# limit: strength stated beside a flow curve's own, over it, from which a note says so [-]; two
# digits of a sheet
_CURVE_APART = 0.02

Progress = Callable[[str], None]
LawChoice = Literal["fitted", "table"]
"""The fitted law, or finite elements of the set's own pair."""


def without_curves(target: TargetTable) -> ContactLaw:
    """Return the law of a set that says of its metals what a data sheet does."""
    return _shared("fitted" if target.yields else "hertz")


def measured_where_unknown(recordings: RecordingSet) -> tuple[RecordingSet, tuple[str, ...]]:
    """Return a set with the baseline that its sheet allows, and what a reader must know of it.

    Where the sheet says nothing of how stiff or strong a body is, and only motion was read, no law
    can foretell a restitution: it is taken as measured, and physics says how it changes.
    """
    setup = recordings.setup
    if "law" in setup.target.model_fields_set or any(
        OBSERVABLES[name].instrument != "motion" for name in recordings.observed
    ):
        return recordings, ()
    strikers = {s: setup.strikers[s] for s in recordings.trials.striker}
    if not (_unknown(setup.target) or all(map(_unknown, strikers.values()))):
        return recordings, ()
    target = setup.target.model_copy(update={"law": "measured-restitution"})
    bodies = {"target": setup.target} | {f"strikers.{s}": b for s, b in strikers.items()}
    whose = " and ".join(key for key, body in bodies.items() if _unknown(body))
    note = (
        f"neither modulus nor strength of {whose} is stated: the restitution is taken as measured, "
        'one at all speeds; law = "elastic-plastic" in [target] takes a metal instead'
    )
    return replace(recordings, setup=setup.model_copy(update={"target": target})), (note,)


def _unknown(body: BodyTable) -> bool:
    return body.E_Pa is None and body.strength is None


def laws_of(
    recordings: RecordingSet, pairs: Mapping[str, Pair], depths: Mapping[str, Sequence[float]],
    *, solve: bool, progress: Progress,
) -> tuple[dict[str, ContactLaw], tuple[str, ...]]:  # fmt: skip
    """Return the law of every striker's contact, and what a reader must know of it.

    - `recordings`: the set, with the flow curves that it came with.
    - `pairs`: striker to its two bodies as stated.
    - `depths`: striker to Delta/R of the peaks of its impacts.
    - `solve`: whether pairs are solved by finite elements.
    """
    target = recordings.setup.target
    plain = without_curves(target)
    if not isinstance(plain, ClosedForm):
        return dict.fromkeys(pairs, plain), ()
    notes = [line for key in recordings.flows for line in _apart(recordings, key)]
    if solve and target.Sy_Pa is None and target.hardness_Pa is None:
        solve = False
        notes.append("target.Sy_Pa is not stated: the pair was not solved by finite elements")
    alike: dict[tuple[Material, Material], list[str]] = {}
    for name, pair in pairs.items():
        metal = _metal(recordings, name, pair)
        alike.setdefault((metal.sphere, metal.flat), []).append(name)
    found: dict[str, ContactLaw] = {}
    for (sphere, flat), names in alike.items():
        stated = pairs[names[0]]
        metal = replace(stated, sphere=sphere, flat=flat)
        law: ContactLaw = plain
        if not metal.perfectly_plastic:
            law = _anchored(plain, LAWS["hardening"], metal, stated)
        if solve:
            reached = [d for name in names for d in depths[name]]
            table, told = solved_pair(recordings.name, metal, reached, progress)
            notes += told
            if table is not None:
                one = table_law([table], name="finite elements of the pair")
                law = _anchored(plain, one, metal, stated, deepest=float(table.curve.depth[-1]))
        found |= dict.fromkeys(names, law)
    return found, tuple(notes)


def _metal(recordings: RecordingSet, striker: str, pair: Pair) -> Pair:
    """The two bodies with the flow curves that the set came with."""
    setup, flows = recordings.setup, recordings.flows

    def body(key: str, table: BodyTable, plain: Material) -> Material:
        if key not in flows or table.Sy_Pa is None:
            return plain
        # what a sheet states is what the piece has; the curve gives the shape
        curve = flows[key].curve(plain.Sy)
        return plain.with_(Sy=curve.strength, flow=Flow(curve))

    key = f"strikers.{striker}"
    return replace(
        pair, sphere=body(key, setup.strikers[striker], pair.sphere),
        flat=body("target", setup.target, pair.flat),
    )  # fmt: skip


def _apart(recordings: RecordingSet, key: str) -> list[str]:
    body = recordings.setup.bodies[key]
    measured = recordings.flows[key].strength
    if body.Sy_Pa is None or abs(body.Sy_Pa.value / measured - 1.0) < _CURVE_APART:
        return []
    return [
        f"{key}.flow_curve reaches {measured / 1e6:.4g} MPa at 0.2 %: it is scaled to the stated "
        f"Sy_Pa of {body.Sy_Pa.value / 1e6:.4g} MPa"
    ]


def _anchored(
    plain: ClosedForm, anchor: ContactLaw, metal: Pair, stated: Pair, *, deepest: float = 0.6
) -> ContactLaw:
    weak = metal.sphere if stated.weaker is stated.sphere else metal.flat
    law = anchored(
        plain, anchor, at=metal, stated=stated, deepest=deepest,
        hardens=weak.flow is not None,
    )  # fmt: skip
    return remembering(law)


@cache
def _shared(name: str) -> ContactLaw:
    return remembering(LAWS[name])
