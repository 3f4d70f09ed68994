"""The error of the baseline's contact law, as unknowns inside the law, in parts stated apart.

* of the law to the finite elements that it was fitted to; none for a table of them;
* of elastic-perfect plasticity to a metal: in force, in the crater, and in the recovery a share of
  what is not given back; none where nothing yields.

The loading force is multiplied by exp(s_F g), the elastic recovery by exp(s_r r) and the crater's
depth by exp(s_c c), with g, r, c smooth random functions of ln(depth/R) of unit variance (squared-
exponential covariance, kept to their leading components) and s the two parts' standard deviations
together, which follow each contact's own depth. How large all this is, is not known either: one
factor on it has a prior (`SIZES`) that a recording set may move. What a data sheet leaves open is
no part of it: those are the nuisances.

References
----------
K. Sargsyan, X. Huan, H. N. Najm, Int. J. Uncertain. Quantif. 9 (2019) 365: embedded model error.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ...core.arrays import Array
from ...dynamics import ForceTransform, Scene
from ...dynamics.files.second import SecondSphere
from ...dynamics.force import LOG_DEPTH_FIRST, LOG_DEPTH_LAST
from ...dynamics.mechanisms.arithmetic import deepest
from ...dynamics.strength import NODES, strength_table
from ...models.anchored import AnchoredLaw
from ...models.base import unwarned
from ...models.uncertainty import METAL, RECOVERY_EXPONENT, WITH_CURVE
from ..inference.linear import Sizes
from ..rules import RULES

SIZES = Sizes.normal(RULES.size_spread)
"""Of the law's error."""
FREE = dict(RULES.free_law)
_KINDS = ("force", "recovery", "recovery exponent", "crater", "radius")
_GRID = np.linspace(LOG_DEPTH_FIRST, LOG_DEPTH_LAST, NODES)
# Depths that impacts reach; outside, the components stay at their end values.
_FIRST, _LAST = math.log(3e-5), math.log(0.2)


@dataclass(frozen=True, eq=False)
class Spread:
    """How unsure the law of one striker's contact is.

    - `law`, `metal`: kind to standard deviations over the depth nodes, (NODES,): of the law to the
      finite elements, and of perfect plasticity to a metal.
    - `reached`: ln(depth/R) of the peaks of this striker's impacts, (n,).
    """

    law: Mapping[str, Array]
    metal: Mapping[str, Array]
    reached: Array

    @cached_property
    def total(self) -> dict[str, Array]:
        """Kind to the standard deviations of both parts together, (NODES,)."""
        return {k: np.hypot(self.law[k], self.metal[k]) for k in _KINDS}

    @cached_property
    def exponent(self) -> float:
        """Standard deviation of the recovery's exponent, the mean over the peaks."""
        return float(np.mean(self.at_peaks(self.total, "recovery exponent")))

    def at_peaks(self, part: Mapping[str, Array], kind: str) -> Array:
        """Return the standard deviations of a part at the peaks, (n,)."""
        return np.asarray(np.interp(self.reached, _GRID, part[kind]))


@dataclass(frozen=True, eq=False)
class LawError:
    """Components of the law's error.

    - `force`, `recovery`, `crater`, `radius`: (k, NODES) unit components over the depth nodes; none
      of the radius where no dent's diameter was measured.
    - `spreads`: striker to how unsure its contact is.
    """

    force: Array
    recovery: Array
    crater: Array
    spreads: Mapping[str, Spread] = field(default_factory=dict)
    radius: Array = field(default_factory=lambda: np.zeros((0, NODES)))

    @cached_property
    def rows(self) -> dict[str, slice]:
        """Kind to its places among the unknowns."""
        counts = (len(self.force), len(self.recovery), int(len(self.recovery) > 0),
                  len(self.crater), len(self.radius))  # fmt: skip
        ends = np.cumsum(counts)
        return {k: slice(int(e - n), int(e)) for k, n, e in zip(_KINDS, counts, ends, strict=True)}

    @cached_property
    def count(self) -> int:
        """Number of unknowns."""
        return int(self.rows["radius"].stop)

    @cached_property
    def parts(self) -> dict[str, tuple[float, float]]:
        """Kind to the rms of the law's and of the metal's part over the peaks of all impacts."""
        return {
            kind: (self._typical("law", kind), self._typical("metal", kind))
            for kind, rows in self.rows.items()
            if rows.stop > rows.start
        }

    def _typical(self, part: str, kind: str) -> float:
        at = [s.at_peaks(getattr(s, part), kind) for s in self.spreads.values()]
        return float(np.sqrt(np.mean(np.concatenate(at) ** 2)))

    @cached_property
    def sizes(self) -> dict[str, float]:
        """Kind to the rms of both parts together over the peaks of all impacts."""
        return {kind: math.hypot(*two) for kind, two in self.parts.items()}

    @cached_property
    def freedom(self) -> Array:
        """Factor on each unknown that makes the law free, shape (count,)."""
        factor = np.ones(self.count)
        for kind, size in self.sizes.items():
            factor[self.rows[kind]] = FREE[kind] / max(size, 1e-4)
        return factor

    def curves(self, kind: str) -> Array:
        """Logarithmic change over the depth nodes per unknown of a kind, over all strikers."""
        mean = np.mean([s.total[kind] for s in self.spreads.values()], axis=0)
        return np.asarray(mean * getattr(self, kind))

    def transform(self, b: Array, striker: str) -> ForceTransform:
        """Return the force seam of a striker's contact at the unknowns b, shape (count,)."""
        if not np.any(b):
            return ForceTransform()
        spread = self.spreads[striker]
        loading = np.exp(spread.total["force"] * (b[self.rows["force"]] @ self.force))
        recovery = np.exp(spread.total["recovery"] * (b[self.rows["recovery"]] @ self.recovery))
        shape = spread.exponent * float(np.sum(b[self.rows["recovery exponent"]]))
        return ForceTransform(
            factors=tuple(loading.tolist()), recovery_factors=tuple(recovery.tolist()),
            shape=max(shape, -0.45),
        )  # fmt: skip

    def crater_change(self, b: Array, strikers: Sequence[str], depth_over_R: Array) -> Array:
        """Return the logarithmic change of the craters of impacts with these peak depths, (n,)."""
        curve = b[self.rows["crater"]] @ self.crater
        return self._along(lambda s: s.total["crater"] * curve, strikers, depth_over_R)

    def radius_change(self, b: Array, strikers: Sequence[str], depth_over_R: Array) -> Array:
        """Return the logarithmic change of the contact's radius at these depths, (n,).

        A contact that piles up more carries more at a depth, at the same pressure: half of the
        force's change is the radius's; what is left is an error of the pressure.
        """
        force, own = b[self.rows["force"]] @ self.force, b[self.rows["radius"]] @ self.radius
        return self._along(
            lambda s: 0.5 * s.total["force"] * force + s.total["radius"] * own,
            strikers, depth_over_R,
        )  # fmt: skip

    def _along(
        self, curve: Callable[[Spread], Array], strikers: Sequence[str], depth_over_R: Array
    ) -> Array:
        """Read each striker's curve over the depth nodes at its own peak depths, (n,)."""
        x = np.log(np.maximum(depth_over_R, 1e-9))
        change = np.zeros(len(x))
        for name in set(strikers):
            here = np.array([s == name for s in strikers])
            change[here] = np.interp(x[here], _GRID, curve(self.spreads[name]))
        return change


def components(length: float) -> Array:
    """Leading components (k, NODES) of a smooth random function of ln(depth/R), of unit variance.

    `length`: correlation length in ln(depth/R). 97 % of the variance are kept.
    """
    x = np.clip(_GRID, _FIRST, _LAST)
    inner = np.linspace(_FIRST, _LAST, 60)
    cov = np.exp(-0.5 * ((inner[:, None] - inner[None, :]) / length) ** 2)
    size, shape = np.linalg.eigh(cov)
    order = np.argsort(size)[::-1]
    size, shape = size[order], shape[:, order]
    n = int(np.searchsorted(np.cumsum(size) / np.sum(size), 0.97)) + 1
    curves = (shape[:, :n] * np.sqrt(size[:n])).T
    return np.stack([np.interp(x, inner, curve) for curve in curves])


_NONE = np.zeros((0, NODES))
NO_ERROR = LawError(_NONE, _NONE, _NONE)


def law_error(
    scenes: Mapping[str, Sequence[Scene]], *, dents: bool = False,
    second: SecondSphere | None = None,
) -> LawError:  # fmt: skip
    """Return the error of the law that the baseline rests on.

    `scenes`: striker to the scenes of its impacts as stated; `dents`: whether the contact's radius
    is compared; `second`: what is struck, where that is a sphere: what the flat in its place adds.
    """
    spreads = {name: _spread(found, second) for name, found in scenes.items()}
    smooth = components(RULES.law_length)
    lost = max(float(np.max(s.metal["recovery"])) for s in spreads.values())
    back = smooth if lost else _NONE
    return LawError(smooth, back, back, spreads, smooth if dents else _NONE)


def _spread(scenes: Sequence[Scene], second: SecondSphere | None) -> Spread:
    law, pair = scenes[0].law, scenes[0].pair
    lost = not_given_back(scenes[0])
    peaks = np.log([deepest(s) / pair.R for s in scenes])
    sizes = WITH_CURVE if isinstance(law, AnchoredLaw) and law.hardens else METAL
    metal = {kind: size * lost for kind, size in sizes.items()}
    # a crater is all of what does not come back, however little that is
    metal["crater"] = np.where(lost > 0.0, sizes["crater"], 0.0)
    law_part = _of_law(scenes[0], lost)
    if second is not None:
        depth = pair.R * np.exp(np.clip(_GRID, _FIRST, _LAST))
        law_part["force"] = np.hypot(law_part["force"], second.departure(law, pair, depth))
        law_part["crater"] = np.hypot(law_part["crater"], second.crater_departure(pair, depth))
    return Spread(law_part, metal, peaks)


def not_given_back(scene: Scene) -> Array:
    """Share of the work of loading that a contact keeps, over the depth nodes, (NODES,).

    The recovery gives back F (delta - delta_p)/(n + 1), n as Hertz's 3/2.
    """
    table = strength_table(scene.law, scene.pair)
    back = np.exp(table.stated.force + table.stated.recovery) / 2.5
    share = scene.force.given_back * back / np.maximum(table.work, 1e-300)
    kept = np.clip(1.0 - share, 0.0, 1.0)
    return np.where(kept < 1e-6, 0.0, kept)


def _of_law(scene: Scene, lost: Array) -> dict[str, Array]:
    """Errors of the law to finite elements of the same two bodies, (NODES,) each."""
    law, pair = scene.law, scene.pair
    if law.name == "hertz":
        # exact but for what Hertz leaves out: the finite depth of the contact
        return dict.fromkeys(_KINDS, np.zeros(NODES)) | {"force": np.full(NODES, 0.003)}
    with unwarned():
        # the nodes' ends reach beyond what an impact will ask for
        known = law.uncertainty(pair, pair.R * np.exp(_GRID))
    return {
        "force": known.force,
        # no more can be wrong of what comes back than does not
        "recovery": np.minimum(known.given_back, lost),
        "recovery exponent": RECOVERY_EXPONENT * lost,
        "crater": np.minimum(known.dent, METAL["crater"]),
        # what the force's own error leaves
        "radius": np.minimum(known.radius, METAL["radius"]),
    }
