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
        "tools/benchmarks/validate_reduce_pulse.py: levels of feet and of slow transducers",
    )  # fmt: skip
    foot_reach: int = rule(
        6, "half-widths of the pulse over which a lower level before a foot is looked for [-]",
        "felt under a drop table: a foot of 1.2 widths (Dataset-11 of the High-Rate SHM group)",
    )  # fmt: skip
    foot_part: float = rule(
        0.005, "area before the flank, as a part of the pulse's, that is a foot [-]",
        "tools/benchmarks/validate_reduce_pulse.py: clean half-sines stay below",
    )  # fmt: skip
    ring_reach: float = rule(
        20.0, "durations after a pulse over which a ringing is averaged [-]",
        "drop table on felt: the change of speed is level from there on",
    )  # fmt: skip
    whole_flank: int = rule(
        8, "samples above half of the peak from which on a flank has samples too [-]",
        "of a half-sine 13 % lie on a flank between 6 and 45 %, 67 % above the half",
    )  # fmt: skip
    form: float = rule(
        1e-3, "error of peak and area by the form of a pulse, in themselves [-]",
        "tools/benchmarks/validate_reduce_pulse.py: powers of a sine from 1 to 1.5",
    )  # fmt: skip
    hole: float = rule(
        0.1, "longest hole in a pulse or a press, in its duration; under a press's top, in it [-]",
        "a half-sine loses 1 % of its area there at most",
    )  # fmt: skip
    pulse_over_noise: float = rule(
        8.0, "peak of a pulse over the noise before it [-]",
        "of a million samples of normal noise none is higher than 5",
    )  # fmt: skip
    flat_samples: int = rule(
        4, "equal samples at the top that are more than chance [-]",
        "chance; 3 where steps are fine",
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
    own_error: float = rule(
        0.5, "standard deviation of a contact time, a crater's depth, a restitution, in itself [-]",
        "beyond it nothing is measured",
    )  # fmt: skip
    swing: float = rule(
        0.33, "level after a pulse, half-wave or pulse beside it, that counts, in the peak [-]",
        "tools/benchmarks/validate_reduce_pulse.py",
    )  # fmt: skip
    swings: int = rule(
        6, "other half-waves of that height [-]", "tools/benchmarks/validate_reduce_pulse.py",
    )  # fmt: skip
    beside: float = rule(8.0, "durations before and after a pulse in which they are counted [-]")
    ringing: float = rule(
        0.01, "half-wave of the other sign that a ringing has, in the peak [-]",
        "tools/benchmarks/validate_reduce_pulse.py: a sensor that rings through the pulse",
    )  # fmt: skip
    train: int = rule(
        2, "other pulses of more than half of the peak that do not fade as bounces do [-]",
        "steps of a walk and taps: tools/benchmarks/validate_reduce_pulse.py",
    )  # fmt: skip
    by_chance: float = rule(
        3.0, "standard deviations between two values that may be one by chance [-]",
        "normal errors: one in 370; scales within them: their scatter widens the error (Birge)",
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
    shortest_contact: float = rule(
        3e-5, "shortest contact of a body that bounces [s]",
        "steel on steel at a few metres a second (H. Hertz, 1882)",
    )  # fmt: skip
    hard_contact: float = rule(
        4e-3, "longest contact of a hard body, any order of magnitude below as likely [s]",
        "a marble on a stack of paper at a few metres a second",
    )  # fmt: skip
    soft_rarer: float = rule(
        4.0, "power by which longer ones, of soft balls, are rarer, once a track [-]",
        "tools/benchmarks/validate_reduce_tracks.py: with 3 errors of hard balls grow by a tenth",
    )  # fmt: skip
    longest_contact: float = rule(
        0.02, "longest contact of a body that bounces [s]", "a basketball: 0.009 to 0.016",
    )  # fmt: skip
    cycle_depth: float = rule(
        0.05, "fall of the load that ends a cycle, in the largest load [-]",
        "partial unloadings take off a third and more (ISO 14577-1); controls swing by 1 %",
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
        "tools/benchmarks/validate_reduce_press.py; of a blunt pyramid the first tenth is a sphere",
    )  # fmt: skip
    zero_span: float = rule(
        2.5, "largest in least load of that flank [-]", "tools/benchmarks/validate_reduce_press.py",
    )  # fmt: skip
    preload_part: float = rule(
        0.1, "error of the zero that a preload hides, in the depth that is made up [-]",
        "tools/benchmarks/validate_reduce_press.py",
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
    chain_off: float = rule(
        0.2, "change of an interval off the steady factor at most [ln]",
        "restitution changes by some per cent; a missed bounce halves or doubles",
    )  # fmt: skip
    missed_bounce: float = rule(
        0.75, "instants that a run gains before a missed bounce in it is believed [-]",
        "chosen: one more instant is no chance",
    )  # fmt: skip
    sudden: float = rule(
        0.1, "change of the factor from the flights next to an end of the run at most [ln]",
        "restitution changes by some per cent from one bounce to the next, not by a tenth",
    )  # fmt: skip
    stray: float = rule(
        8.0,
        "distance from the course of the others, in their scatter, that no real bounce has [-]",
        "one in 10^15 by chance",
    )  # fmt: skip
    contact_rounds: int = rule(3, "rounds between the heights of contacts and the flights [-]")
    same_flat: float = rule(
        0.05, "difference of the contacts' heights in the largest height at most [-]"
    )
    flight_samples: int = rule(
        5, "samples of a flight at least [-]", "a parabola and two that can contradict it"
    )
    uneven_fall: float = rule(
        0.02, "change of the acceleration over a span without samples, in the fall [-]",
        "chosen: what drag of a light ball may do",
    )  # fmt: skip
    flight_core: int = rule(12, "samples with which a flight begins [-]")
    flight_far: float = rule(
        3.5, "standard deviations of a block of samples off a flight, far from its core [-]",
        "one in 2000: the curve is less sure there",
    )  # fmt: skip
    flight_block: float = rule(0.25, "part of a flight that is taken in at once [-]")
    stray_blocks: int = rule(
        2, "blocks off a flight that are passed over where the next one lies on it again [-]"
    )
    trim_rounds: int = rule(4, "rounds in which a contact's samples are cut off [-]")
    straight: float = rule(
        0.1, "change of a flight's speed, in the speed, below which it is straight [-]"
    )
    flight_noise: float = rule(
        3.0, "spread of a flight's samples, in that of the track, that is believed [-]"
    )
    mostly: float = rule(0.6, "part of a block that lies on the flight [-]")
    flight_reach: int = rule(
        2, "lengths of a flight's first part within which it is looked for next to the contact [-]"
    )
    no_chance: float = rule(4.0, "standard deviations that are no chance [-]", "one in 15 000")
    doubtful: float = rule(
        2.5,
        "standard deviations from which a sample next to a contact, or a frame of a flight, "
        "is left out, and a pixel counts less [-]",
        "one in 80",
    )  # fmt: skip
    pooled: int = rule(8, "samples for which the spread of all flights counts in that of one [-]")
    drag_speed: float = rule(
        0.75, "speed at which the drag coefficient is taken, in that of the launch [-]",
        "mean over a flight up and down",
    )  # fmt: skip
    fall_known: float = rule(0.1, "relative error of a fall from which it gives no scale [-]")
    drift_widths: tuple[float, ...] = rule(
        (1e-4, 1e-3, 1e-2), "widths of what is believed of a drift [speeds of a fall over a second]"
    )
    missing_frame: float = rule(
        0.02, "part of the contacts in which a frame is missing without a word [-]"
    )
    missing_told: float = rule(0.1, "belief in a missing frame that counts [-]")
    coarse: float = rule(
        0.01, "spread of a flight over its height that is no reason to doubt it [-]"
    )
    stated_size: float = rule(
        0.02, "relative error of the fall that a stated size of the unit is trusted for [-]"
    )
    free_drag: float = rule(
        0.1, "square of the fastest over the terminal speed of a body not known, at most [-]",
        "a table-tennis ball after a fall of a metre",
    )  # fmt: skip
    drift_height: float = rule(
        0.1, "height of a track over which the whole drift of a scale is possible [m]",
        "a metre's tenth, a usual picture",
    )  # fmt: skip
    drift_time: float = rule(
        1.0, "time over which the whole drift of a scale is possible [s]", "a usual clip"
    )
    resolved: int = rule(
        4, "samples within a contact from which its two ends are told apart [-]",
        "a curve and one that can contradict it",
    )  # fmt: skip
    soft_bend: tuple[float, float] = rule(
        (0.85, 1.3), "bend of a soft contact over that of a spring, least and most [-]",
        "0.88 of elastic spheres, 1.2 of a spring with as much damping as lets back half the speed",
    )  # fmt: skip
    touch_stray: float = rule(
        12.0, "what one of these samples may say at most [ln likelihood]",
        "five standard deviations",
    )  # fmt: skip
    soft_ends: float = rule(
        0.5, "part of what shows of a contact by which both ends reach farther [-]",
        "force sets in softly",
    )  # fmt: skip
    contacts_alike: float = rule(
        1.3, "ratio of the durations of a track's contacts [-]",
        "v^(-1/5) of Hertz, for speeds to a quarter of the first one",
    )  # fmt: skip
    impossible: float = rule(
        3.0, "speed between two samples, in the nine tenths quantile of all, that no body has [-]"
    )
    repeated: float = rule(
        0.35,
        "change of a frame, in that of its neighbours, below which it may repeat the one before "
        "[-]",
    )
    often_repeated: float = rule(
        0.2, "part of the frames that do so before they count as repeated [-]"
    )
    edge_settled: float = rule(
        1e-4, "move at which it ends [pixel]", "a tenth of the floor of a position"
    )
    edge_last: float = rule(0.02, "move of the last round that is still a fit [pixel]")
    cap: float = rule(
        0.75, "part of the half-width of a rod from which the cap is read [-]",
        "the edge of the cap is chamfered",
    )  # fmt: skip
    own_level: float = rule(
        1.3, "contrast of a ball, in that of the clip, from which its own grey level is used [-]"
    )
    motion_settled: float = rule(
        1e-3, "part of the misfit that a step may still promise when it ends [-]",
        "a thirtieth of a standard deviation",
    )  # fmt: skip
    window: int = rule(
        8,
        "frames in which a flight is looked for; contacts closer are not told apart, and two "
        "flights farther apart may have one between them [-]",
    )
    clean: float = rule(3.0, "usual residuals below which a window fits free flight [-]")
    stands_out: float = rule(1.5, "usual residuals of the worst window at which a span is cut [-]")
    broken: float = rule(5.0, "limits of the span as one flight at which it is cut [-]")
    drag_even: float = rule(
        0.15, "time next to the contact in which drag and lift count as even [s]"
    )
    fewest: int = rule(
        6, "samples from which a piece is judged by itself, or a contact by those beside it [-]",
        "a parabola and three that can contradict it",
    )  # fmt: skip
    collinear: float = rule(
        0.01, "second over first extent of a shape below which its markers lie on one line [-]",
        "no turn about it is then read",
    )  # fmt: skip
    sectors: int = rule(
        8, "sectors of a shape that are left out in turn, or in which walls are read [-]",
        "one that is not round shows in their spread",
    )  # fmt: skip
    bottom_large: float = rule(
        0.75, "larger of two fits at the bottom of a crater, in half-widths [-]"
    )
    bottom_small: float = rule(
        0.5, "the smaller [-]", "their difference tells the error of the form"
    )
    foreign: float = rule(
        6.0, "robust standard deviations of what belongs to something else [-]",
        "one in 10^9 by chance",
    )  # fmt: skip
    clearance: float = rule(
        1.9, "part around a crater that levelling leaves out [crater radii, half-widths of a line]",
        "the rim decays within it",
    )  # fmt: skip
    level_points: float = rule(0.05, "part of the points that is left to level on [-]")
    lag_pairs: int = rule(
        30, "pairs of points that a lag of the autocovariance needs [-]", "tell it to a fifth"
    )
    wall: tuple[float, float] = rule(
        (0.08, 0.45), "depths, in the whole, between which a wall is followed to the surface [-]"
    )
    wall_end: float = rule(
        0.14, "what a wall's end misses [steps of the scan]",
        "rendered craters without noise: its parabola, and interpolation",
    )  # fmt: skip
    onset_after: float = rule(1e-3, "time after an onset in which its rise is fitted [s]")
    onset_before: float = rule(15e-3, "time before it in which the level is taken [s]")
    onset_search: tuple[float, float] = rule(
        (6e-3, 2e-3), "time before and after the steepest rise in which the onset is sought [s]"
    )
    table_rows: int = rule(
        20, "rows of a record against time, of a press or a tensile test, at least [-]",
        "a zero, a turn and a slope of six each",
    )  # fmt: skip
    flank: tuple[float, float] = rule(
        (0.06, 0.45), "parts of the peak between which flanks tell the ends of a pulse [-]",
        "above the noise and the foot; half-sines and elastic spheres part above it",
    )  # fmt: skip
    flank_powers: tuple[float, ...] = rule(
        (1.5, 1.2, 1.0), "powers of time that a flank may rise with [-]",
        "1.5 of elastic spheres to 1 of plastic ones",
    )  # fmt: skip
    round_top: float = rule(
        0.1, "part of the peak below it within which a top is a parabola [-]",
        "a half-sine's next term is 1 % of that",
    )  # fmt: skip
    same_time: float = rule(1.05, "a flight in the one before it that is alike [-]", "bounces fade")
    same_height: float = rule(
        0.1, "difference of peaks, in the largest, that are alike [-]", "bounces fade"
    )
    elastic_parts: tuple[float, ...] = rule(
        (0.4, 0.3, 0.22, 0.16, 0.12, 0.09, 0.06),
        "parts of the largest stress up to which the modulus may be read [-]",
    )
    elastic_straight: float = rule(
        0.7, "slope of the upper half of an elastic rise in that of the lower [-]"
    )
    elastic_from: tuple[float, ...] = rule(
        (0.25, 0.5, 0.7), "stress from which on it is read, in that up to which [-]",
        "slack bends the first part",
    )  # fmt: skip
    metal_moduli: tuple[float, float] = rule(
        (40e9, 600e9), "moduli between which a metal's lies [Pa]",
        "magnesium: 45 GPa, osmium: 560; lead and indium, below, need theirs stated",
    )  # fmt: skip
    elastic_strain: float = rule(
        0.02, "strain at which a metal yields at most [-]",
        "piano wire: 0.015, a metallic glass: 0.02",
    )  # fmt: skip
    edge_step: float = rule(0.25, "step along an edge [pixel]")
    lean_frames: int = rule(20, "frames from which the lean of a rod is read [-]")
    same_rate: float = rule(
        0.01, "part by which a container's mean rate differs from the camera's and is its own [-]",
        "rates of 29.97 and 30",
    )  # fmt: skip
    position_floor: float = rule(
        1e-3, "error of a position at least [pixel]", "none in a picture is believed better"
    )
    position_trend: float = rule(
        5e-3, "move from one end of a flight to the other [pixel]",
        "uneven light, and a blur that is not the same everywhere",
    )  # fmt: skip
    mirror_reach: float = rule(
        3.5, "blurs above the flat within which a rod's reflection moves its tip [-]",
        "rendered clips",
    )  # fmt: skip
    mirror_move: float = rule(0.1, "by how much it does [pixel]", "rendered clips")
    shape_frames: int = rule(15, "frames from which the shape of a tip is read [-]")
    mirror_least: float = rule(
        1.0, "blurs above the flat from which on a tip is told from its reflection [-]"
    )
    mirror_frames: int = rule(12, "frames from which a reflection's light is read [-]")
    dull: float = rule(0.02, "part of its light below which a reflection does not count [-]")
    mostly_found: float = rule(
        0.8, "part of the frames in which a ball's edge is found, else its light is used [-]"
    )
    scale_widths: tuple[tuple[float, float], ...] = rule(
        ((1e-2, 1.0), (3e-2, 1.0), (1e-1, 0.05)),
        "widths of a camera's drift, and how much each is believed beforehand [-]",
        "one that nobody calibrated drifts by a per cent or so; a tenth is rare",
    )  # fmt: skip
    press_powers: tuple[float, ...] = rule(
        (2.0, 1.5, 1.2, 1.0), "powers of depth that a loading or an unloading may have [-]",
        "2 of a pyramid, 1.5 of Hertz's sphere, 1 of a flat punch",
    )  # fmt: skip
    press_bins: int = rule(
        60, "means of rows alike in load that tell where it meets zero, at most [-]"
    )


RULES = ReductionRules()
