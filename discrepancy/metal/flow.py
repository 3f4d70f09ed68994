"""A flow curve as what a fit moves: stresses at a few strains, straight between over logarithms.

A mark is compared with the contact of a metal of that curve (`models.hardening`): one that hardens
sinks in where another piles up, so that a depth under load says less of it than a diameter.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, cast

import numpy as np

from ...core.arrays import Array
from ...core.flow import Flow, tabulated
from ...core.material import Pair
from ...dynamics import Scene
from ...dynamics.mechanisms.base import Mechanism, Parameter, Surroundings, Values
from ...models import LAWS
from ...models.anchored import anchored
from ...models.base import ContactLaw, remembering
from ...models.rules import RULES as MODELS

if TYPE_CHECKING:
    from ...models.fitted import ClosedForm

STRAINS = np.geomspace(0.002, 0.15, 7)
"""Representative strains of the curve's nodes: the proof strain's, to where a ball is half sunk."""

REACH = MODELS.mean_span
"""Strain at the axis of a contact over the representative one."""

_FITTED = cast("ClosedForm", LAWS["fitted"])
_NAMES = tuple(f"log_stress_{k}" for k in range(len(STRAINS)))


class FlowCurveOfMarks(Mechanism):
    """The flow curve that marks are fitted with; no explanation of a diagnosis."""

    name = "flow-curve"
    title = "the metal follows a flow curve of its own"
    equations = "S(p), straight between nodes over logarithms, in the body that yields first"
    # infinite at neutral: the curve always acts
    parameters = tuple(
        Parameter(name, "-", -2.0, 3.0, "linear", math.inf, "a node of the curve")
        for name in _NAMES
    )
    static = True

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Give the body that yields first the curve, and the contact its law."""
        logs = tuple(values[name] for name in _NAMES)
        # lengths are in R: strikers of one metal share the law, whatever their radius
        return scene.with_(law=_law_of(replace(scene.pair, R=1.0), logs))


@lru_cache(maxsize=256)
def _law_of(pair: Pair, logs: tuple[float, ...]) -> ContactLaw:
    """The law of a pair whose weaker body follows the curve; a rate moves it as the fitted law."""
    in_flat = pair.weaker is pair.flat
    plain = pair.flat if in_flat else pair.sphere
    p = np.concatenate([[0.0], STRAINS, STRAINS[-1] * np.array([math.sqrt(REACH), REACH])])
    curve = tabulated(p, plain.Sy * np.exp(weights(p) @ logs))
    body = plain.with_(Sy=curve.strength, flow=Flow(curve))
    metal = replace(pair, flat=body) if in_flat else replace(pair, sphere=body)
    law = anchored(
        _FITTED, LAWS["hardening"], at=metal, stated=pair, deepest=MODELS.law_last, hardens=True
    )
    return remembering(law)


def weights(strains: Sequence[float] | Array) -> Array:
    """Return what makes logarithms at strains (k,) of those at the nodes, (k, nodes).

    Below the first node the stress stays; beyond the last one the power law before it goes on.
    """
    x, nodes = np.log(np.maximum(strains, STRAINS[0])), np.log(STRAINS)
    here = np.clip(np.searchsorted(nodes, x) - 1, 0, len(nodes) - 2)
    part = (x - nodes[here]) / (nodes[here + 1] - nodes[here])
    eye = np.eye(len(nodes))
    return np.asarray((1.0 - part)[:, None] * eye[here] + part[:, None] * eye[here + 1])


def curve_values(logs: Array) -> Values:
    """Return the numbers of `FlowCurveOfMarks` for logarithms (nodes,) of relative stress."""
    return dict(zip(_NAMES, logs.tolist(), strict=True))
