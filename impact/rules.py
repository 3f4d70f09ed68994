"""Tuned numbers of impacts: what each means [unit], and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class ImpactRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    fall_steps: int = rule(
        128, "steps of a fall with drag [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    history_points: int = rule(
        200, "points of a history that is written [-]",
        "a figure's width",
    )  # fmt: skip
    sure: float = rule(
        1e-6, "relative standard deviation below which none is shown [-]",
        "round-off of the slopes",
    )  # fmt: skip
    shown_round_off: float = rule(
        1e-7, "numbers below this part of the largest of their unit are shown as 0 [-]",
        "round-off of the integral",
    )  # fmt: skip
    same_strength: float = rule(
        1e-3, "difference of a stated strength from a curve's first stress that is none [-]",
        "three digits of a sheet",
    )  # fmt: skip
    combinations: int = rule(
        10_000_000, "largest number of combinations [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    slope_step: float = rule(
        1e-4, "step of differences of a force that is smooth between its borders [depth]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    history_rows: int = rule(
        4000, "rows of a history beside those asked for [-]",
        "memory of a long vibration",
    )  # fmt: skip
    strength_nodes: int = rule(
        41, "nodes of the table over ln(depth/R) [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    imprints: int = rule(
        24, "imprints that are kept apart [-]",
        "beyond it the two nearest become one",
    )  # fmt: skip
    steepest_wall: float = rule(
        0.3, "width of a crater's wall over its radius at the least [-]",
        "chosen; a steeper wall catches the tip",
    )  # fmt: skip
    cells: int = rule(
        4000, "cells that are tried, halved ones counted [-]",
        "the smooth laws of this package take 1120 at most",
    )  # fmt: skip
    cells_at_once: int = rule(
        256, "cells that are tried together [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    gravity_limit: float = rule(
        0.1, "largest work of gravity over that of a branch [-]",
        "the series is cut after its fourth power",
    )  # fmt: skip
    energy_error: float = rule(
        1e-8, "error of the table [-]",
        "restitution and times come out within ten times this of the integral",
    )  # fmt: skip
    energy_shallowest: float = rule(
        1e-8, "least peak depth that the route answers for [R]",
        "dust",
    )  # fmt: skip
    energy_deepest: float = rule(
        0.5, "largest peak depth that the route answers for [R]",
        "the finite elements' own limit",
    )  # fmt: skip
    energy_tables: int = rule(
        200, "tables that are kept [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    law_error: float = rule(
        1e-8,
        "error of a law's table: of F and a over their own, of residual depths over the peak [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    law_shallowest: float = rule(
        1e-9, "least depth that is tabulated [R]",
        "below it a law is Hertz's",
    )  # fmt: skip
    law_deepest: float = rule(
        1.0, "largest depth that is tabulated [R]",
        "beyond it a law goes on as Hertz's",
    )  # fmt: skip
    law_tables: int = rule(
        200, "tables that are kept [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    hertz_error: float = rule(
        0.003, "error of Hertz's force, which leaves out the finite depth [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    band_step: float = rule(
        0.02, "step of a logarithm for the slopes [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    scan_samples: float = rule(
        1e6, "most samples of a scan across a dent [-]",
        "3 m at the usual step; a law that is far out of its range may give a dent without end",
    )  # fmt: skip
    band_steps: int = rule(
        4000, "most steps of a blow that is made for a band alone [-]",
        "usual blows take some 200, a vibrating rod 2000; benchmarks/fuzz_keys.py ended in no "
        "30 s with five times that",
    )  # fmt: skip
    largest_error: float = rule(
        1.0, "largest error of a law, of a logarithm [-]",
        "beyond it a law is off by a factor",
    )  # fmt: skip
    held: tuple[float, ...] = rule(
        (1.0, 0.5, 0.25, 0.1),
        "parts of a standard deviation that are tried where a whole one leaves the range [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    thick: float = rule(
        8.0, "thickness over the depth of a dent that counts as thick [-]",
        "ISO 6506-1, 6.3",
    )  # fmt: skip
    indentation_rate: float = rule(
        0.4, "strain rate of an indentation over v/a [-]",
        "Tabor 1951",
    )  # fmt: skip
    worth_a_line: float = rule(
        1e-3, "relative effect that is worth a line [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    mass_off: float = rule(
        0.01, "departure from a solid sphere's mass that is told [-]",
        "three digits of a sheet",
    )  # fmt: skip
    pressure_points: int = rule(
        60, "depths at which the mean pressure is looked at [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    impacts_at_once: int = rule(
        200, "impacts of one compiled call, which Ctrl-C has to wait for [-]",
        "a second where they vibrate",
    )  # fmt: skip
    break_gap: float = rule(
        1e-13, "depth to either side of a border of the law [depth]",
        "round-off",
    )  # fmt: skip
    looks: int = rule(
        100_000, "looks at the gap in one flight [-]",
        "beyond it the flight ends unfinished",
    )  # fmt: skip
    bites: int = rule(
        40, "trials of a landing step [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    may_matter: float = rule(
        0.25, "part of the dent that one specimen or the next moves, from which it is told [-]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    band_conditions: int = rule(
        400, "conditions up to which a sweep has a band [-]",
        "each takes some ten impacts in steps",
    )  # fmt: skip


RULES = ImpactRules()
"""Every tuned number of the stage."""
