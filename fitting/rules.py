"""Tuned numbers of the fits: what each means [unit], and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class FittingRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    element_noise: float = rule(
        2e-3, "relative error of the finite elements beside a law's own [-]"
    )
    before_yield: tuple[float, float] = rule(
        (0.5, 4.0), "bounds of the power with which a law's error vanishes before yield [-]"
    )
    feature_ridge: float = rule(0.02, "penalty of the features' weights, the constant's aside [-]")
    pairs_a_bump: float = rule(6.5, "pairs for each bump of the correction [-]")
    shift_prior: float = rule(
        2.0, "weight of the prior against the misfit's squares, of one shift by one unit [-]"
    )
    every_depth: int = rule(
        4, "of so many depths one is looked at [-]", "neighbours say nearly the same"
    )
    farthest_shift: float = rule(1.5, "change of a shift in one step [units]")
    regression_settled: float = rule(
        2e-3, "relative change of the objective at which the regression ends [-]"
    )
    outlier: float = rule(4.0, "misfit from which on it counts linearly [units]")
    unit: float = rule(0.003, "a misfit of one in F, a and share [-]")
    unit_left: tuple[float, ...] = rule(
        (4e-4, 6e-3), "a misfit of one in the permanent approach: of Delta_m, and of itself [-]"
    )
    unit_exponent: float = rule(0.015, "a misfit of one in the exponent of unloading [-]")
    unit_back: float = rule(0.008, "a misfit of one in the energy given back [-]")
    form_unit: float = rule(0.01, "a residual of one in F, a and the shares [-]")
    form_unit_exponent: float = rule(
        0.03, "a residual of one in the exponent [-]", "about 1 % of F_m on unloading"
    )
    form_unit_back: float = rule(
        0.02, "a residual of one in the energy given back [-]", "1 % of a restitution"
    )
    form_settled: float = rule(
        1e-5, "relative change of the misfit at which a fit for comparison ends [-]"
    )
    hardening_prior: float = rule(
        300.0, "weight of the prior against squares of a misfit of 1 % [-]", "thirty does as well"
    )
    path_points: int = rule(64, "points of a pair's path [-]")
    hardening_every: int = rule(
        3, "of so many depths one is looked at [-]", "neighbours say nearly the same"
    )
    hardening_radius: float = rule(
        0.5, "largest a/R that is fitted [-]", "beyond it the sphere's shape counts"
    )
    folds: int = rule(8, "folds of the cross-validation [-]")
    relative_from: float = rule(
        5.0, "depth from which residual depths are judged relatively [critical depths]",
        "before it they vanish",
    )  # fmt: skip
    smooth_reach: float = rule(
        1.0, "half-width of the neighbourhood in ln Delta [-]", "several periods of a coarse mesh"
    )
    smooth_points: int = rule(
        6, "points from which a neighbourhood is smoothed [-]", "a cubic and two more"
    )
    form_radius: float = rule(
        0.55, "largest a/R that the form is fitted to [-]", "its domain, with a margin"
    )


RULES = FittingRules()
"""Every tuned number of the stage."""
