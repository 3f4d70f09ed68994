"""Tuned numbers of impacts: what each means [unit], and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class ImpactRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    fall_steps: int = rule(128, "steps of a fall with drag [-]")
    put_down: float = rule(
        4e-5, "v^2 over g times the depth of a weight at rest, from which there is a blow [-]",
        "a table's round-off of 5e-8 of the depth is then below 1 % of the energy",
    )  # fmt: skip
    same_strength: float = rule(
        1e-3, "difference of a stated strength from a curve's first stress that is none [-]",
        "three digits of a sheet",
    )  # fmt: skip
    slope_step: float = rule(
        1e-4, "step of differences of a force that is smooth between its borders [depth]"
    )
    strength_nodes: int = rule(121, "nodes of the table over ln(depth/R) [-]")
    partial_slip: float = rule(
        0.77, "part of Mindlin's stiffness that a single spring has which stands for slip from the "
        "edge inwards [-]",
        "rebound angles of the exact contact (test_impact_compliance.py): 0.03 rms, at 1 0.23; for "
        "stiffness ratios of 0.6 to 1.1 alike, for rods 0.71 to 0.86",
    )  # fmt: skip
    steepest_wall: float = rule(
        0.3, "width of a crater's wall over its radius at the least [-]",
        "chosen; a steeper wall catches the tip",
    )  # fmt: skip
    gravity_limit: float = rule(
        0.1, "largest work of gravity over that of a branch [-]",
        "the series is cut after its fourth power",
    )  # fmt: skip
    table_error: float = rule(
        1e-8,
        "error of a table: of F, a and energies over their own, of residual depths over the "
        "peak [-]",
        "restitution and times come out within ten times this of the integral",
    )
    hertz_error: float = rule(0.003, "error of Hertz's force in a shallow contact [-]")
    hertz_sphere: tuple[float, ...] = rule(
        (0.45, 1.2), "and what a sphere, no half-space, adds to it, over x = a/R and x^2 [-]",
        "finite elements of an elastic sphere on a rigid flat, nu 0.3 (0.49): 2.9 (2.2) % at a "
        "depth of 0.003 R, 5.8 (4.2) at 0.01, 25 (18) at 0.1, 72 (57) at 0.3; of an elastic flat "
        "under a rigid sphere 1.1 (0.1) to 7.4 (-2.1)",
    )  # fmt: skip
    band_step: float = rule(0.02, "step of a logarithm for the slopes [-]")
    held: tuple[float, ...] = rule(
        (1.0, 0.5, 0.25, 0.1),
        "parts of a standard deviation that are tried where a whole one leaves the range [-]",
    )
    visible: float = rule(
        5e-4, "smallest change of a speed that motion was ever read with [-]",
        "chosen: a camera over a hundred frames",
    )  # fmt: skip
    stopped: float = rule(0.8, "part of a speed that a fluid may take for a fall to be one [-]")
    by_eye: float = rule(5.0, "tolerance of an angle set by eye [degrees]", "as the thesis states")
    axial_modes: int = rule(6, "axial vibrations of a rod [-]")
    bending_modes: int = rule(9, "bending vibrations of a rod [-]")
    rod_loss: float = rule(
        1e-3, "loss factor of a rod [-]",
        "of steel rods; what it takes during a contact is below a thousandth",
    )  # fmt: skip
    rough_power: float = rule(
        1.25, "exponent of a recovery for the share of a layer of asperities alone [-]",
        "between Hertz's 3/2 and a flat punch's 1",
    )  # fmt: skip
    slowest: float = rule(
        0.2, "rate at the turning point, over that of the approach [-]",
        "ln 5 times C of Johnson and Cook, 0.01 to 0.03, is lost there",
    )  # fmt: skip
    rate_law_apart: float = rule(
        4.0, "chi-squared by which a rate law may be off flow curves at several rates [-]",
        "two standard deviations",
    )  # fmt: skip
    support_span: float = rule(
        10.0, "least span of the mass of a support [-]", "a block, and the bench that it stands on"
    )
    block_mass: float = rule(
        0.1, "lightest block that is taken for a half-space without a word [kg]"
    )
    hottest: float = rule(
        0.95, "way from the reference temperature to melting up to which a strength is known [-]",
        "chosen; nearer 1 - T*^m of Johnson and Cook is no strength any more",
    )  # fmt: skip
    wave_back: float = rule(
        0.15, "way of a wave through a plate and back up to which it moves as a whole [contact]",
        "explicit elastic plates of 3 to 100 mm (tools/benchmarks/wave_plate.py): 10 % of the loss",
    )  # fmt: skip
    size_largest: float = rule(
        3e-4, "contact radius beyond which hardness does not depend on size [m]",
        "ten times some tens of um",
    )  # fmt: skip


RULES = ImpactRules()
"""Every tuned number of the stage."""
