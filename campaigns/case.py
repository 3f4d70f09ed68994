"""One finite-element case: a frozen specification and the identity that follows from it.

The problem is scale-free: length enters only through Delta/R and stress only through ratios. A case
is therefore identified by the six groups E_s/E', nu_s, nu_f, Sy_s/E', Sy_f/E' and which body is
rigid, (E_f/E' follows from the others), together with the depths and the numerical settings. Two
specifications with equal groups are one case, whatever their units. A metal that hardens adds its
flow law over E', one that feels the rate its rates over speed/R, and the speeds over the first.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import fem
from ..core.errors import InputError
from ..core.flow import Flow
from ..core.material import Material, Pair
from ..core.provenance import content_id
from ..core.rig import MaterialTable, material_keys

_GROUP_DIGITS = 12
"""Significant digits of the groups that identify a case; changing it changes every id."""

# limit: depths at which pressure and surfaces are kept [-]: as many curves as a figure shows
# apart
_PROFILE_DEPTHS = 10


@dataclass(frozen=True)
class Case:
    """What one solve is asked to do, by a short name that is unique within a design.

    The full fields at the problem's `snapshots` are written beside the file.
    """

    name: str
    problem: fem.ContactProblem
    accuracy: fem.Accuracy

    @property
    def pair(self) -> Pair:
        """The two bodies and the radius [SI]."""
        return self.problem.pair

    @property
    def depths(self) -> tuple[float, ...]:
        """Recorded Delta/R."""
        return self.problem.depths

    @property
    def groups(self) -> dict[str, Any]:
        """The dimensionless groups that identify the physics."""
        return dimensionless_groups(self.pair)

    @property
    def id(self) -> str:
        """SHA-256 of the groups, the depths, the settings and the numerics version."""
        p = self.problem
        more: dict[str, Any] = dict(_flow_groups(p))
        if p.snapshots:
            more["snapshots"] = [_rounded(d) for d in p.snapshots]
        if p.friction:
            more["friction"] = _rounded(p.friction)
        return content_id(
            {
                "groups": self.groups,
                "depths": [_rounded(d) for d in p.depths],
                "unload_from": [_rounded(d) for d in p.unload_from],
                "radius_at_least": p.radius_at_least,
                "profiles": [_rounded(d) for d in p.profiles],
                "accuracy": {k: v for k, v in self.accuracy.as_dict().items() if k != "level"},
                "numerics_version": fem.NUMERICS_VERSION,
                **more,
            }
        )

    def refined(self) -> Case:
        """Return the same case with smaller steps and elements, for another try."""
        a = self.accuracy
        finer = a.with_(
            level=f"{a.level}, finer",
            coarse=0.8 * a.coarse,
            fine=0.8 * a.fine,
            step_ratio=a.step_ratio**0.5,
        )
        return replace(self, accuracy=finer)

    def specification(self) -> dict[str, Any]:
        """Return everything that `from_specification` needs, as plain values."""
        p = self.problem
        return {
            "name": self.name,
            "R_m": p.pair.R,
            "sphere": material_keys(p.pair.sphere),
            "flat": material_keys(p.pair.flat),
            "depths": list(p.depths),
            "unload_from": list(p.unload_from),
            "radius_at_least": p.radius_at_least,
            "profiles": list(p.profiles),
            "snapshots": list(p.snapshots),
            "accuracy": self.accuracy.as_dict(),
            **({"friction": p.friction} if p.friction else {}),
            **_flow_keys(p),
        }

    @classmethod
    def from_specification(cls, spec: dict[str, Any]) -> Case:
        """Rebuild a case from `specification()`."""
        sphere, flat = (_metal(spec, body) for body in ("sphere", "flat"))
        problem = fem.ContactProblem(
            pair=Pair(sphere, flat, spec["R_m"]),
            depths=tuple(spec["depths"]),
            unload_from=tuple(spec["unload_from"]),
            radius_at_least=spec["radius_at_least"],
            profiles=tuple(spec.get("profiles", ())),
            snapshots=tuple(spec.get("snapshots", ())),
            friction=spec.get("friction", 0.0),
            speeds=tuple(tuple(row) for row in spec.get("speeds", ())),
        )
        return cls(spec["name"], problem, fem.Accuracy(**spec["accuracy"]))


def dimensionless_groups(pair: Pair) -> dict[str, Any]:
    """Return what identifies a pair whatever its units and size."""
    unit = pair.E_reduced
    return {"sphere": _body(pair.sphere, unit), "flat": _body(pair.flat, unit)}


def standard_case(
    name: str,
    pair: Pair,
    *,
    deepest: float,
    n_depths: int,
    unload_w: tuple[float, ...] = (),
    unload_depths: tuple[float, ...] = (),
    radius_at_least: float = 0.0,
    through: float = 0.0,
    fields: bool = False,
    accuracy: fem.Accuracy,
) -> Case:
    """Make a case with `n_depths` geometric depths from below first yield to `deepest`, a Delta/R.

    It unloads from `unload_w`, in units of the critical depth, and `unload_depths`, Delta/R.
    `through`, a Delta/R, takes the place of the geometric depth nearest to it (0: none), and with
    `fields` the full fields there are written.
    """
    onset = pair.first_yield
    if not math.isfinite(onset):
        onset = 1e-4 * deepest
    first = 0.3 * onset
    if first >= deepest:
        raise InputError(
            f"first yield at Delta/R = {onset:.3g}", key=name, allowed=f"below {deepest:g}"
        )
    unload = sorted(
        d for d in {*(w * onset for w in unload_w), *unload_depths} if first < d <= deepest
    )
    depths = _through(fem.geometric_depths(first, deepest, n_depths), through)
    kept = np.unique(np.linspace(0, n_depths - 1, _PROFILE_DEPTHS).round().astype(int))
    problem = fem.ContactProblem(
        pair=pair,
        depths=depths,
        unload_from=tuple(unload),
        radius_at_least=radius_at_least,
        profiles=tuple(depths[k] for k in kept),
        snapshots=(through,) if fields else (),
    )
    return Case(name, problem, accuracy)


def _through(depths: tuple[float, ...], wanted: float) -> tuple[float, ...]:
    """Move the nearest of the inner depths to a wanted one between them."""
    if not depths[0] < wanted < depths[-1]:
        return depths
    nearest = min(range(1, len(depths) - 1), key=lambda k: abs(math.log(depths[k] / wanted)))
    return (*depths[:nearest], wanted, *depths[nearest + 1 :])


def _body(body: Material, unit: float) -> Any:
    if body.rigid:
        return "rigid"
    strength = None if math.isinf(body.Sy) else _rounded(body.Sy / unit)
    return {"E": _rounded(body.E / unit), "nu": _rounded(body.nu), "Sy": strength}


def _rounded(x: float) -> float:
    return float(f"{x:.{_GROUP_DIGITS}g}")


def _flow_keys(problem: fem.ContactProblem) -> dict[str, Any]:
    """What a specification says of flow laws and speeds; nothing where there are none."""
    bodies = {"sphere_flow": problem.pair.sphere.flow, "flat_flow": problem.pair.flat.flow}
    keys: dict[str, Any] = {name: flow.as_dict() for name, flow in bodies.items() if flow}
    if problem.speeds:
        keys["speeds"] = [list(row) for row in problem.speeds]
    return keys


def _metal(spec: dict[str, Any], body: str) -> Material:
    plain = MaterialTable.model_validate(spec[body]).to_material()
    flow = spec.get(f"{body}_flow")
    return plain.with_(flow=Flow.from_dict(flow)) if flow else plain


def _flow_groups(problem: fem.ContactProblem) -> dict[str, Any]:
    """Flow laws and speeds without units: what they add to the identity."""
    pair = problem.pair
    laws = {"sphere": pair.sphere.flow, "flat": pair.flat.flow}
    hurried = [flow for flow in laws.values() if flow and flow.rate]
    first = problem.speeds[0][1] if hurried else math.nan
    groups: dict[str, Any] = {
        f"{body}_flow": _flow(flow, unit=pair.E_reduced, seconds=pair.R / first)
        for body, flow in laws.items()
        if flow
    }
    if hurried:
        groups["speeds"] = [[_rounded(d), _rounded(v / first)] for d, v in problem.speeds]
    return groups


def _flow(flow: Flow, *, unit: float, seconds: float) -> dict[str, Any]:
    out: dict[str, Any] = {}
    if (c := flow.curve) is not None:
        stress = [_rounded(x / unit) for x in c.stress]
        # slopes are differences: fewer of their digits are free of round-off
        out["curve"] = [
            [_rounded(p) for p in c.strain],
            stress,
            [f"{x / unit:.7g}" for x in c.slope],
        ]
    if (r := flow.rate) is not None:
        numbers = (r.reference * seconds, r.number, r.stress / unit)
        out["rate"] = [r.law, *(_rounded(x) for x in numbers)]
    if (h := flow.heating) is not None:
        rise = h.fraction * unit / (h.capacity * h.range)
        out["heating"] = [_rounded(rise), _rounded(h.exponent)]
    return out
