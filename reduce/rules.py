"""Every tuned number of the stage: its unit, what it means, and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class ReductionRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    fewest_level_samples: int = rule(
        10, "samples without change that tell the level before a pulse [-]",
        "a tenth of the noise as the level's error at most a third of it",
    )  # fmt: skip
    level_trend: float = rule(
        0.01, "change over such a stretch, as a part of the pulse's height [-]",
        "benchmarks/validate_reduce_pulse.py: levels of feet and of slow transducers",
    )  # fmt: skip
    foot_reach: int = rule(
        6, "half-widths of the pulse over which a lower level before a foot is looked for [-]",
        "felt under a drop table: a foot of 1.2 widths (Dataset-11 of the High-Rate SHM group)",
    )  # fmt: skip
    foot_part: float = rule(
        0.005, "area before the flank, as a part of the pulse's, that is a foot [-]",
        "benchmarks/validate_reduce_pulse.py: clean half-sines stay below",
    )  # fmt: skip
    ring_reach: float = rule(
        20.0, "durations after a pulse over which a ringing is averaged [-]",
        "drop table on felt: the change of speed is level from there on",
    )  # fmt: skip
    most_given_up: float = rule(
        0.5, "part of a run's instants that may be given up at its ends [-]",
        "a knock before and after a run of five is two of seven",
    )  # fmt: skip
    most_elastic: float = rule(
        0.998, "median restitution of a run above which nothing bounces: a clock [-]",
        "hardened steel on steel, glass on glass: 0.99 at most in air",
    )  # fmt: skip
    least_of_all: float = rule(
        0.5, "part of all instants that the run must hold: fewer hang together by chance [-]",
        "a ball with an echo of every bounce: a half",
    )  # fmt: skip
    run_scatter: float = rule(
        2.0, "scatter of a run's intervals in the error of an instant, above which it counts [-]",
        "six flights tell a scatter to a third: twice the error is no chance",
    )  # fmt: skip
    whole_flank: int = rule(
        8, "samples above half of the peak from which on a flank has samples too [-]",
        "of a half-sine 13 % lie on a flank between 6 and 45 %, 67 % above the half",
    )  # fmt: skip
    form: float = rule(
        1e-3, "error of peak and area by the form of a pulse, in themselves [-]",
        "benchmarks/validate_reduce_pulse.py: powers of a sine from 1 to 1.5",
    )  # fmt: skip
    hole: float = rule(
        0.1, "longest time between two samples of a pulse, in its duration [-]",
        "a half-sine loses 1 % of its area there at most",
    )  # fmt: skip
    pulse_over_noise: float = rule(
        8.0, "peak of a pulse over the noise before it [-]",
        "of a million samples of normal noise none is higher than 5",
    )  # fmt: skip
    flat_samples: int = rule(
        4, "equal samples at the top that are more than chance [-]", "chance: one in 10 000",
    )  # fmt: skip
    flat_top: float = rule(
        1.7, "equal samples at the top, in those within a converter's step of a round one [-]",
        "a half-sine of 8 bits cut at 90 % with noise before the converter: 1.8",
    )  # fmt: skip
    plateau: float = rule(
        0.65, "width at 95 % of the peak, in that at half of it, of a cut pulse [-]",
        "0.30 of a half-sine, 0.27 of elastic spheres; a half-sine cut at 78 %: 0.65",
    )  # fmt: skip
    fewest_above_half: int = rule(
        3, "samples above half of the peak [-]", "fewer do not tell a pulse from a disturbance",
    )  # fmt: skip
    lopsided: float = rule(
        12.0, "time of a flank in that of the other [-]",
        "the flanks of an impact are as 1 to its restitution or less: 0.1 at least",
    )  # fmt: skip
    duration_error: float = rule(
        0.5, "standard deviation of a contact time, in itself [-]", "beyond it nothing is measured",
    )  # fmt: skip
    step: float = rule(
        0.33, "level after a pulse, in its peak [-]", "benchmarks/validate_reduce_pulse.py",
    )  # fmt: skip
    swings: int = rule(
        6, "other half-waves above a third of the peak [-]", "benchmarks/validate_reduce_pulse.py",
    )  # fmt: skip
    ringing: float = rule(
        0.1, "half-wave of the other sign, in the peak [-]", "benchmarks/validate_reduce_pulse.py",
    )  # fmt: skip
    train: int = rule(
        2, "other pulses of more than half of the peak that do not fade as bounces do [-]",
        "steps of a walk and taps: benchmarks/validate_reduce_pulse.py",
    )  # fmt: skip
    outside_restitution: float = rule(
        3.0, "standard deviations below 0 or above 1 [-]", "normal errors: one in 700",
    )  # fmt: skip
    fall_off: float = rule(
        0.3, "acceleration in flight off gravity, in gravity [-]",
        "drag and buoyancy of a table-tennis ball at its terminal speed are less",
    )  # fmt: skip
    not_rigid: float = rule(
        0.05, "distance of markers from one rigid shape, in its extent [-]",
        "an acrylic cube: 0.002; a walking person: 0.1",
    )  # fmt: skip
    full_scale: float = rule(
        0.2, "part of a sound's samples at full scale [-]",
        "contacts of a bouncing ball fill less of a record: it is cut between them too",
    )  # fmt: skip
    depth_error: float = rule(
        0.5, "standard deviation of a crater's depth, in itself [-]",
        "beyond it nothing is measured",
    )  # fmt: skip
    shortest_contact: float = rule(
        3e-5, "shortest contact of a body that bounces [s]",
        "steel on steel at a few metres a second (H. Hertz, 1882)",
    )  # fmt: skip
    hard_contact: float = rule(
        4e-3, "longest contact of a hard body, any order of magnitude below as likely [s]",
        "a marble on a stack of paper at a few metres a second",
    )  # fmt: skip
    soft_rarer: float = rule(
        2.0, "power by which longer ones, of soft balls, are rarer [-]",
        "benchmarks/validate_reduce_tracks.py: with 1 errors of hard balls at 120 frames a second "
        "grow by a quarter",
    )  # fmt: skip
    longest_contact: float = rule(
        0.02, "longest contact of a body that bounces [s]", "a basketball: 0.009 to 0.016",
    )  # fmt: skip
    largest_number: float = rule(
        1e20, "largest number of a column [its unit]", "no record in any unit: a damaged file",
    )  # fmt: skip
    farthest_marker: float = rule(
        1e3, "distance of a marker from the origin [m]", "a stadium: millimetres taken for metres",
    )  # fmt: skip
    fewest_press_rows: int = rule(
        20, "rows of a press with a load and a depth [-]", "a zero, a turn and a slope of six each",
    )  # fmt: skip
    cycle_depth: float = rule(
        0.05, "fall of the load that ends a cycle, in the largest load [-]",
        "partial unloadings take off a third and more (ISO 14577-1); controls swing by 1 %",
    )  # fmt: skip
    held: float = rule(
        0.01, "part of the load by which it may vary in a hold [-]",
        "class 1 of ISO 7500-1",
    )  # fmt: skip
    clipped_depth: float = rule(
        0.03, "depth that grows under a load that is equal to the last digit, in the whole [-]",
        "creep of a metal in a hold: 1 to 2 %, and a load cell's last digit moves",
    )  # fmt: skip
    least_unloaded: float = rule(
        0.8, "least load after the largest one, in it, that still shows unloading [-]",
        "ISO 14577-1 fits the upper half; less than a fifth does not tell a slope",
    )  # fmt: skip
    zero_reach: tuple[float, ...] = rule(
        (0.05, 0.1, 0.2, 0.45, 1.0), "loads up to which a flank tells its zero, in the largest [-]",
        "benchmarks/validate_reduce_press.py; of a blunt pyramid the first tenth is a sphere",
    )  # fmt: skip
    zero_span: float = rule(
        2.5, "largest in least load of that flank [-]", "benchmarks/validate_reduce_press.py",
    )  # fmt: skip
    preload_part: float = rule(
        0.1, "error of the zero that a preload hides, in the depth that is made up [-]",
        "benchmarks/validate_reduce_press.py",
    )  # fmt: skip
    stiffness_from: tuple[float, ...] = rule(
        (0.5, 0.7), "loads down to which the slope of unloading is read, in the largest [-]",
        "ISO 14577-1, A.4: from 98 % down to 50 or 70 %",
    )  # fmt: skip
    stiffness_to: float = rule(
        0.98, "load from which on it is [-]", "ISO 14577-1, A.4",
    )  # fmt: skip
    fewest_cycles: int = rule(
        4, "cycles that tell the machine's compliance [-]", "two unknowns and their error",
    )  # fmt: skip
    cycle_ratio: float = rule(
        2.0, "largest in smallest load of these cycles [-]",
        "the contact's own compliance changes by a third",
    )  # fmt: skip
    meyer: tuple[float, ...] = rule(
        (2.0, 2.4), "Meyer's index between which a metal's lies [-]",
        "2 of cold-worked, 2.2 to 2.4 of annealed metals (D. Tabor, The Hardness of Metals, 1951)",
    )  # fmt: skip


RULES = ReductionRules()
