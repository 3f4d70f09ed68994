"""Tuned numbers of the contact laws: what each means [unit], and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class ModelRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    mean_span: float = rule(
        3.0, "strain at the axis over the representative one [-]",
        "by the errors of pairs left out of the fit; 2.5 to 4 do as well",
    )  # fmt: skip
    mean_fall: float = rule(
        1.7, "power with which strains fall to the elastic border [-]",
        "by the errors of pairs left out of the fit; 1.7 to 2.2 do as well",
    )  # fmt: skip
    mean_strains: int = rule(60, "strains of a mean [-]")
    mean_table: int = rule(400, "means of a table [-]")
    least_strain: float = rule(1e-8, "first representative strain of the table [-]")
    largest_strain: float = rule(5.0, "last representative strain of the table [-]")
    bend_apart: float = rule(
        1.0, "distance in ln p of the strains whose exponents make the bend [-]"
    )
    fades: float = rule(
        0.3, "part of a coordinate's width over which the correction fades beyond the data [-]"
    )
    correction_degree: int = rule(2, "degree of the correction [-]")
    least_step: float = rule(
        0.01, "step of ln Delta from point to point at the least [-]", "a quarter of the mean one"
    )
    law_first: float = rule(0.01, "first depth of such a law [critical depths]", "elastic")
    law_last: float = rule(0.6, "its last depth [R]")
    rounded: float = rule(2e-3, "width in ln F where it comes down to the least force [-]")
    flow_rounds: int = rule(14, "rounds for the sphere's part of the flow [-]")
    radius_rounds: int = rule(
        3, "rounds of the contact radius in each [-]", "they go on from the last"
    )
    points: int = rule(240, "points of a law that is a table, even in ln depth [-]")
    joining_depths: tuple[float, ...] = rule(
        (0.02, 0.05, 0.1, 0.2, 0.4, 0.5, 0.6),
        "depths over the critical one at which such a law may leave Hertz's [-]",
        "yield begins at 1",
    )
    joined: float = rule(
        0.8, "depth over the critical one from which the solve alone counts [-]",
        "yield begins at 1",
    )  # fmt: skip
    least_error: float = rule(1e-3, "standard deviation that no law goes below [-]")
    exponent_error: float = rule(0.02, "standard deviation of the recovery's exponent [-]")
    metal_error: tuple[tuple[str, float], ...] = rule(
        (("force", 0.03), ("recovery", 0.07), ("recovery exponent", 0.05), ("crater", 0.05),
         ("radius", 0.02)),
        "relative standard deviations of elastic-perfect plasticity to a metal [-]",
        "finite elements with measured flow curves (`models/uncertainty.py`)",
    )  # fmt: skip
    metal_error_with_curve: tuple[tuple[str, float], ...] = rule(
        (("force", 0.015), ("recovery", 0.05), ("recovery exponent", 0.05), ("crater", 0.025),
         ("radius", 0.01)),
        "the same where the flow curve is known [-]",
        "shape of the yield surface and modulus of unloading are left (the same)",
    )  # fmt: skip


RULES = ModelRules()
"""Every tuned number of the stage."""
