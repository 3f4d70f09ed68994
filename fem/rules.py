"""Tuned numbers of the finite elements: what each means [unit], and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class FemRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    core_radius: float = rule(
        0.12, "radius of the innermost block over that where the fine zone begins [-]"
    )
    linear_beyond: float = rule(
        4.0, "distance beyond which the half-space is linear [R]",
        "strains stay below 1e-4 there at a/R = 0.5; round-off of 1 + grad u would rule the "
        "residual",
    )  # fmt: skip
    bending: float = rule(
        0.5, "factor on the part of the gradients that varies within an element [-]",
        "at 1 a light elastic contact is 0.1 % too stiff; far below a half shapes cost no energy",
    )  # fmt: skip
    forcing: float = rule(0.005, "relative correction that a direction may lack [-]")
    krylov_residual: float = rule(0.2, "relative residual that a direction may leave [-]")
    refactor_after: int = rule(
        5, "steps of GMRES after which the next matrix is factorised anew [-]"
    )
    pattern_reach: int = rule(
        3, "master nodes beyond the segments in use that the matrix already couples [-]"
    )
    regrowth: tuple[tuple[int, float], tuple[int, float]] = rule(
        ((5, 1.5), (8, 1.15)),
        "Newton iterations of a step, and the power of its length that the next may have [-]",
    )
    elastic_until: float = rule(
        0.8, "elastic step ratio up to this part of the critical depth [-]",
        "first yield is then met by a step of its own",
    )  # fmt: skip
    lead_in: float = rule(
        0.75, "beginning of the path, as a part of the first depth [-]",
        "makes the smooth curve there two-sided",
    )  # fmt: skip
    soft_start: tuple[float, ...] = rule(
        (0.03, 1.0), "contact stiffness on the way to the first equilibrium, over its own [-]"
    )
    zone_behind: float = rule(
        0.85, "inner end of the fine zone over the contact radius it is made for [-]"
    )
    zone_ahead: float = rule(
        1.6, "outer end of the fine zone over the contact radius it is made for [-]"
    )
    zone_serves: float = rule(1.35, "growth of the contact radius for which a mesh serves [-]")
    last_mesh: float = rule(
        0.2, "contact radius beyond which the mesh is changed no more [R]",
        "strains of the order of one: a change drops the force by 1 to 2 %",
    )  # fmt: skip
    inner_rings: int = rule(3, "rings within the innermost block [-]")
    inside_zone: tuple[float, ...] = rule(
        (1.5, 4.0),
        "distances from the fine zone, over its radius, up to which rings are twice as wide, and "
        "coarse [-]",
    )
    ring_divisions: int = rule(4, "divisions of a fine ring [-]")
    ring_growth: float = rule(
        1.25, "widths of neighbouring rings [-]", "an abrupt change shows in the contact pressure"
    )
    residual: float = rule(
        1e-4, "accepted sum of residual forces over the contact force [-]",
        "a hundredth of it moves no force by 0.01 % and costs a quarter more",
    )  # fmt: skip
    still_correction: float = rule(
        1e-8,
        "largest accepted next correction over the approach, where round-off rules the residual "
        "[-]",
        "Newton's corrections fall faster than it is estimated",
    )
    hopeless_after: int = rule(
        8, "iterations after which a residual that has not halved will not converge [-]"
    )
    step_cut: float = rule(0.4, "part of its logarithm with which a failed step is tried again [-]")
    stretch: float = rule(2.5, "largest factor by which the last increment is extrapolated [-]")
    outwards: float = rule(
        0.2,
        "power of the approach by which the last increment moves outwards with the contact [-]",
        "the radius grows by the power 0.5, but values between rings cost what they bring: fewest "
        "iterations",
    )
    gap_edges: int = rule(5, "open surface elements that the fit of the gap looks at [-]")
    edge_candidates: int = rule(161, "places of the contact edge that the fit of the gap tries [-]")
    steps_beyond: int = rule(4, "steps past the last depth [-]", "the fit there is then two-sided")
    ripple_reach: float = rule(0.36, "reach of the fit to either side in ln approach [-]")
    ripple_degree: int = rule(3, "degree of the curve within the reach [-]")
    harmonics: int = rule(2, "harmonics of the part that repeats from ring to ring [-]")
    ripple_prior: float = rule(
        1.0, "weight of a ripple of nothing [steps]",
        "where a step takes the edge half a ring on, a ripple could be anything",
    )  # fmt: skip
    least_dent: float = rule(
        1e-3, "part of the permanent approach below which a body keeps nothing [-]",
        "a thousandth shows in no figure",
    )  # fmt: skip


RULES = FemRules()
"""Every tuned number of the stage."""
