"""Tuned numbers of the diagnosis: what each means [unit], and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class DiagnosisRules:
    """The register; `dataclasses.fields` tells the meaning and the source of each."""

    wrong_most: float = rule(
        4.0, "largest factor by which a number of the sheet is wrong [-]",
        "Brinell and Vickers numbers for a strength are 3; more is a unit, refused by the reader",
    )  # fmt: skip
    guessed: float = rule(
        0.3, "relative standard deviation from which a stated number is a guess [-]",
        "a strength by the class of the metal alone",
    )  # fmt: skip
    temper: float = rule(
        0.7, "part of a gain in ln evidence that counts [-]",
        "0.5 to 0.8 tried on 103 sets of three makes: mean ln p -0.90, -0.82, -0.81, -0.81",
    )  # fmt: skip
    by_ratio: float = rule(
        10000.0, "gain in ln evidence beyond which another counts by its share of it [nat]",
        "of 213 sets of two makes mean ln p is -1.29 with 3000, -1.24 with it, -1.24 without",
    )  # fmt: skip
    said: float = rule(
        0.5, "probability from which what leads is said [-]",
        "more likely than not",
    )  # fmt: skip
    cautious: float = rule(
        0.8, "the same where a reader asks for caution [-]",
        "four of five",
    )  # fmt: skip
    together: float = rule(
        0.8, "probability that explanations, or a family, have together once they are said [-]",
        "four of five",
    )  # fmt: skip
    supported: float = rule(
        0.002, "probability below which, or nearer to 1 than which, none is printed [-]",
        "one of the 500 sets with nothing missing that are drawn",
    )  # fmt: skip
    derived: float = rule(
        0.2, "rms of a column less what others give, in its noise, below which it is derived [-]",
        "two instruments differ by their noise: of four trials one in a thousand agrees so well",
    )  # fmt: skip
    derived_trials: int = rule(
        3, "trials from which a column may be called derived [-]",
        "by chance one in a hundred of three agrees so well",
    )  # fmt: skip
    solve_deeper: float = rule(
        1.3, "depth of the solve over the deepest impact [-]",
        "room for a stated number that is off",
    )  # fmt: skip
    solve_turns: int = rule(
        5, "unloadings of the solve [-]",
        "chosen: a law needs three, two between show the bend",
    )  # fmt: skip
    solve_depths: int = rule(60, "depths of the solve [-]")
    fewest_readings: int = rule(
        6, "readings below which a set says nothing [-]",
        "a mechanism's size, and five that can contradict it",
    )  # fmt: skip
    fewest_conditions: int = rule(
        2, "conditions below which a set says nothing [-]",
        "one has no trend",
    )  # fmt: skip
    alike: int = rule(
        3, "explanations that are reported as indistinguishable at most [-]",
        "with more the set says too little",
    )  # fmt: skip
    nameless: float = rule(
        1.0 / 3.0, "part of what is outside that is known physics without a name [-]",
        "chosen: as much as each of a free law and a free departure",
    )  # fmt: skip
    sure: float = rule(
        0.91, "probability of something missing from which that is said, though not what [-]",
        "ten to one",
    )  # fmt: skip
    amplitudes: tuple[float, ...] = rule(
        (0.03, 0.1, 0.3), "departures that no law is behind, as logarithms [-]",
        "from what four observables just show to the gross",
    )  # fmt: skip
    misjudged: float = rule(
        0.5, "standard deviation of the logarithm of a stated noise [-]",
        "by so much do laboratories misjudge it",
    )  # fmt: skip
    widest: float = rule(
        5.0, "logarithm of the largest scatter over the stated noise by something varied [-]",
        "e^5, 150 times the noise, is a gross departure",
    )  # fmt: skip
    smooth: float = rule(
        1.0, "correlation length of what is outside [standard deviations of each covariate]",
        "a trend over the set, not a wiggle from one condition to the next",
    )  # fmt: skip
    second: float = rule(
        3.0, "nats behind the most probable single within which a pair is fitted [nat]",
        "screening is off by as much: further behind it has a twentieth",
    )  # fmt: skip
    paired: int = rule(
        6, "pairs that are fitted, if they lead by the sum of their effects [-]",
        "of 172 sets of three makes as many truths lead as with eleven",
    )  # fmt: skip
    pair_step: float = rule(
        0.12,
        "step at which the mutual effect of two mechanisms is simulated [widths of the prior]",
        "beyond the round-off of two simulations, within what is straight",
    )  # fmt: skip
    gauge_floor: float = rule(
        0.004, "part of a value that repeats cannot average away [-]",
        "gauges and definitions: three digits",
    )  # fmt: skip
    noise_floor: float = rule(
        0.5, "part of one reading's noise that repeats cannot average away [-]",
        "four repeats are worth as many; more are not",
    )  # fmt: skip
    wild: float = rule(
        0.1, "part of all repeats beyond which those far off their median are no slips [-]",
        "one in ten is a slip, more are the noise",
    )  # fmt: skip
    own_scatter: int = rule(
        8, "repeats beyond the first from which their own scatter is trusted [-]",
        "eight degrees of freedom tell a scatter to a quarter",
    )  # fmt: skip
    same_speed: float = rule(0.05, "width in ln speed within which impacts are one condition [-]")
    speed_measured: float = rule(
        0.003, "systematic relative error of a measured speed where none is stated [-]"
    )
    speed_from_height: float = rule(
        0.005, "the same of a speed from a height [-]",
        "a hundredth of the height: a millimetre of ten centimetres",
    )  # fmt: skip
    load_repeats: float = rule(
        0.003, "relative scatter of a load where none is stated [-]",
        "half of class 1 of ISO 7500-1",
    )  # fmt: skip
    trace_copies: int = rule(
        40, "copies of a curve with fresh noise [-]",
        "tell a standard deviation to a tenth",
    )  # fmt: skip
    trace_scale: float = rule(
        0.01, "relative error of a length's scale without a column of its own [-]",
        "a ruler in a picture",
    )  # fmt: skip
    reduction_left: float = rule(
        0.25, "share of a reduction's error that its correction leaves [-]"
    )
    reduction_least: float = rule(
        0.003, "least relative error of a reduction [-]",
        "three digits",
    )  # fmt: skip
    reduction_most: float = rule(
        0.25, "largest relative error of a reduction that is corrected [-]",
        "beyond it the number says nothing",
    )  # fmt: skip
    instants: tuple[float, ...] = rule(
        (-0.4, -0.2, 0.0, 0.2, 0.4), "touch before or after the one found [samples]",
        "a trace does not know it better",
    )  # fmt: skip
    speeds_tried: int = rule(
        5, "speeds over the tested range [-]",
        "both ends, the middle and between",
    )  # fmt: skip
    angles_tried: int = rule(
        4, "angles over the tested range [-]",
        "both ends and two between",
    )  # fmt: skip
    build_ratio: float = rule(
        2.0, "size of a body to be built over that of the one there is, and one over it [-]",
        "chosen: one size up or down makes a difference",
    )  # fmt: skip
    bench: tuple[float, float] = rule(
        (20.0, 5000.0), "loads of a bench press or a small testing machine [N]",
        "hand lever to 5 kN, the usual frame",
    )  # fmt: skip
    press_loads: int = rule(
        4, "loads of a series of presses [-]",
        "chosen: both ends and two between",
    )  # fmt: skip
    press_each: int = rule(
        3, "presses at each load [-]",
        "two repeats tell the scatter",
    )  # fmt: skip
    press_wide: float = rule(
        1.5, "ratio of loads from which a series is worth it [-]",
        "chosen: the depths then differ by half",
    )  # fmt: skip
    press_beyond: float = rule(
        3.0, "loads over those that a striker was pressed to, and one over them [-]",
        "half a decade",
    )  # fmt: skip
    noise_draws: int = rule(
        256, "draws of the noise of a proposed trial [-]",
        "an expected entropy to 6 %",
    )  # fmt: skip
    rival: float = rule(
        0.02, "probability from which an explanation is a rival [-]",
        "less is told apart already",
    )  # fmt: skip
    rivals: int = rule(
        4, "rivals that are told apart [-]",
        "a verdict lists three, and one behind them",
    )  # fmt: skip
    worth_less: float = rule(
        0.9,
        "part of an uncertainty that is left from which a measurement is not worth it [-]",
        "a tenth is no reason to go back to the rig",
    )  # fmt: skip
    session: float = rule(
        120.0, "length of a session where none is stated [min]",
        "a morning at the rig",
    )  # fmt: skip
    worth: float = rule(
        0.05, "gain from which a session is worth it [nat]",
        "a hundredth of what two even explanations share, seven times over",
    )  # fmt: skip
    doubt: float = rule(
        0.1, "probability that is shared evenly by those told apart, as a session is chosen [-]",
        "of 120 sets that nothing was chosen on 0.86 was said and 0.78 true",
    )  # fmt: skip
    worth_more: float = rule(
        0.01, "gain from which one more thing is done in a session [nat]",
        "a fifth of what makes a session worth it",
    )  # fmt: skip
    minutes: tuple[tuple[str, float], ...] = rule(
        (("strike", 5.0), ("press", 5.0), ("change", 10.0), ("hardness", 30.0), ("weigh", 10.0),
         ("calliper", 10.0), ("instrument", 60.0), ("build", 600.0)),
        "how long each takes where it is not stated [min]",
        "chosen; `[rig.minutes]` of set.toml states them",
    )  # fmt: skip
    settled: tuple[tuple[str, float], ...] = rule(
        (("hardness", 0.1), ("weigh", 0.001), ("calliper", 0.005)),
        "relative error of a number of the sheet that is measured again [-]",
        "hardness over strength (core's tabor_spread); a balance; 0.02 mm of 5 mm",
    )  # fmt: skip
    dent_law_error: float = rule(
        0.02, "relative error of a dent's diameter where the law's error has none [-]"
    )
    step: float = rule(
        0.3, "step of derivatives [standard deviations]",
        "straight within it, beyond the round-off of simulations",
    )  # fmt: skip
    setting_step: float = rule(
        0.01,
        "step of a speed in itself [-], and of an angle [rad]",
        "beyond round-off, within the errors of both",
    )  # fmt: skip
    form_spread: float = rule(
        0.8, "standard deviation of the logarithm of how far forms differ [-]",
        "a quarter of it or four times",
    )  # fmt: skip
    form_length: float = rule(
        2.0, "correlation length of a form's error [standard deviations of each covariate]",
        "longer than that of what is outside",
    )  # fmt: skip
    form_rough: float = rule(
        0.1, "part of a form's error without correlation [-]",
        "a tenth, so that no covariance is singular",
    )  # fmt: skip
    jumps: tuple[float, ...] = rule(
        (0.02, 0.05, 0.1), "how near a jump makes a cell unsure, in the parameter [-]",
        "three sizes: a jump has no derivative",
    )  # fmt: skip
    fit_rounds: int = rule(
        4, "rounds of linearising [-]",
        "the last moves little; beyond it the fit stands where it is",
    )  # fmt: skip
    fit_settled: float = rule(
        0.15, "change of the unknowns at which a fit ends [standard deviations]",
        "no probability that is printed hangs on less",
    )  # fmt: skip
    fit_turned: float = rule(
        0.08, "the same of places in the priors [-]",
        "no probability that is printed hangs on less",
    )  # fmt: skip
    fit_farthest: float = rule(
        2.0, "change of the unknowns within one round [standard deviations]",
        "as far as a response is nearly straight",
    )  # fmt: skip
    fit_parts: tuple[float, ...] = rule(
        (0.0, 0.1, 0.25, 0.5, 1.0), "parts of a step that are tried [-]",
        "halving, and none",
    )  # fmt: skip
    fit_little: float = rule(
        0.1, "fall of chi2 that is none [-]",
        "no verdict hangs on it",
    )  # fmt: skip
    outlier: float = rule(
        4.0, "distance from which a value may be a slip [standard deviations]",
        "one in 15 000",
    )  # fmt: skip
    outlier_share: float = rule(
        1.0 / 16.0, "part of all values that may be slips [-]",
        "one in sixteen; more are no slips",
    )  # fmt: skip
    outlier_wider: float = rule(
        30.0, "factor on the deviation of a slip [-]",
        "it then says nothing",
    )  # fmt: skip
    press_apart: float = rule(
        10.0, "distance between presses and impacts [standard deviations of each covariate]",
        "no neighbours",
    )  # fmt: skip
    alone: float = rule(
        2.0, "deviations by which a neighbour to the same side speaks for a value [-]",
        "one in forty by chance",
    )  # fmt: skip
    tensor: int = rule(
        4, "parameters of a pair up to which all nodes of both are simulated [-]",
        "beyond it thousands of scenes",
    )  # fmt: skip
    resolved: float = rule(
        2.0, "places of a refined grid in a standard deviation that need no window [-]"
    )
    window: float = rule(
        4.0, "half width of a window [standard deviations]",
        "beyond it one in 15 000",
    )  # fmt: skip
    node_apart: float = rule(
        0.25, "part of a prior's range between nodes from which a response counts as bent [-]",
        "nodes farther apart stand for one that is nearly straight",
    )  # fmt: skip
    exponent: float = rule(
        0.12, "prior mean of d ln stress/d ln strain [-]",
        "none of cold-worked metals to 0.4 of annealed copper and 304",
    )  # fmt: skip
    exponent_spread: float = rule(
        0.12, "its standard deviation [-]",
        "the same metals",
    )  # fmt: skip
    exponent_length: float = rule(
        1.5, "correlation length of the exponent [ln strain]",
        "a plateau or a knee within a factor of four in strain",
    )  # fmt: skip
    vague: float = rule(
        0.15,
        "standard deviation of ln stress and ln(1 + rise) from which a set does not identify it "
        "[-]",
        "a handbook knows as much",
    )  # fmt: skip
    rate_form: float = rule(
        0.25, "by how much laws of a rate differ in a dent, over its effect, for `metal` [-]",
        "finite elements with a rate in every point up to 0.16, the proof's simulators to 0.28",
    )  # fmt: skip
    metal_step: float = rule(
        0.1, "step of derivatives [prior deviations]",
        "straight within it",
    )  # fmt: skip
    metal_farthest: float = rule(
        2.5, "change within one round [prior deviations]",
        "as far as a response is nearly straight",
    )  # fmt: skip
    metal_settled: float = rule(0.03, "change at which it ends [prior deviations]")
    metal_near: float = rule(
        0.4, "change below which the derivatives stay [prior deviations]",
        "straight within it",
    )  # fmt: skip
    full: int = rule(
        3, "mechanisms that are fitted in full at the least [-]",
        "of 55 sets of another make mean ln p is -1.394 with 3 and 3 nats, -1.397 with 4 and 12",
    )  # fmt: skip
    hidden: float = rule(
        0.2, "part of the leader's gain from whose screening on they are, too [-]",
        "of 163 sets of two makes four truths were not even fitted; costs a tenth of the time",
    )  # fmt: skip
    invisible: float = rule(
        1.0, "largest effect, in standard deviations, of what cannot be seen [-]",
        "chi2 changes by one",
    )  # fmt: skip
    clear: float = rule(
        10.0, "nats over the baseline from which a fit is sharpened [-]",
        "one in 20 000",
    )  # fmt: skip
    near_leader: float = rule(0.6, "part of the leading gain from which a fit is sharpened [-]")
    leads: float = rule(
        3.0, "nats from which outliers are judged under the leading mechanism [-]",
        "twenty to one",
    )  # fmt: skip
    false_alarms: float = rule(
        1e-3, "part of sets in which a drift, or an effect of a column, is seen by chance [-]",
        "one in a thousand: it changes the noise of all",
    )  # fmt: skip
    drift_freedom: int = rule(
        6, "degrees of freedom beside the slope from which a drift is told [-]"
    )
    size_spread: float = rule(
        0.4, "standard deviation of the logarithm of the size of a law's error [-]",
        "a metal's 3 % may be 1.5 or 6",
    )  # fmt: skip
    law_length: float = rule(2.5, "correlation length of a law's error [ln(depth/R)]")
    nulls: int = rule(
        500, "sets with nothing missing, drawn for the threshold of where a baseline misses [-]",
        "of one in twenty within a sixth",
    )  # fmt: skip
    rim: float = rule(
        1.05, "diameter of a dent's rim over that of its contact circle [-]",
        "within what finite elements of metals from perfectly plastic to n = 0.3 give",
    )  # fmt: skip
    rim_spread: float = rule(
        0.03, "standard deviation of the same [-]",
        "within what those finite elements give",
    )  # fmt: skip
    assumed_modulus: float = rule(
        2e11, "modulus of a body of which the set says nothing [Pa]",
        "steel's",
    )  # fmt: skip
    assumed_poisson: float = rule(
        0.3, "its Poisson's ratio [-]",
        "steel's",
    )  # fmt: skip
    priors: tuple[tuple[str, float], ...] = rule(
        (
            ("baseline", 0.6), ("inputs", 0.19), ("mechanisms", 0.19), ("outside-library", 0.02),
            ("second", 0.08),
        ),
        "probabilities before the comparison, shared alike within each kind; of a second one [-]",
        "near the largest mean ln p over 172 sets; those hold no wrong number: as probable",
    )  # fmt: skip
    every_metal: float = rule(
        3.0, "times that a metal hardens or feels the rate, over any other mechanism [-]",
        "every metal does; 0.1 nats over 68 sets of strengths and nulls in two worlds",
    )  # fmt: skip
    acts: float = rule(
        0.9, "probability that a ball which falls from a stated height is braked by the air [-]",
        "it is; one in ten for heights that were corrected and not said to be",
    )  # fmt: skip
    shows: float = rule(
        3.0, "standard errors of its least effect from which that counts [-]",
        "below, whether it acts makes no difference that a set could show",
    )  # fmt: skip
    strength_wrong: float = rule(
        5.0, "times that the strength of what is struck is rather wrong than another kind [-]",
        "tempers of one metal differ by 2, and no other number of a sheet is as rarely measured",
    )  # fmt: skip
    thickness_wrong: float = rule(
        0.5, "times that a plate's thickness is rather wrong than another kind [-]",
        "waves act by it too: of 40 plates stated wrong it leads in 11, of 20 right ones in none",
    )  # fmt: skip
    contradicted: float = rule(
        50.0, "times that a mass or radius is wrong where it contradicts the density; a mass that "
        "agrees is by this less [-]",
        "of fifty sheets one has the density of another ball, or a hollow one",
    )  # fmt: skip
    grid_places: tuple[tuple[int, int], ...] = rule(
        ((1, 241), (2, 49), (3, 17), (4, 11), (5, 7)),
        "places per parameter of a refined grid, by the number of parameters [-]",
        "chosen: some thousands in all",
    )  # fmt: skip
    window_nodes: tuple[tuple[int, int], ...] = rule(
        ((1, 5), (2, 5), (3, 3), (4, 3)),
        "least nodes per parameter of a grid over a part of the prior [-]",
        "over a window the response is nearly straight",
    )  # fmt: skip
    free_law: tuple[tuple[str, float], ...] = rule(
        (("force", 0.16), ("recovery", 0.5), ("recovery exponent", 0.5), ("crater", 0.24),
         ("radius", 0.1)),
        "relative standard deviations of a contact law that is free [-]",
        "chosen: what something unknown may make of it",
    )  # fmt: skip
    press_reading: tuple[tuple[str, float], ...] = rule(
        (("permanent_depth_m", 0.02), ("dent_diameter_m", 0.01)),
        "relative error of one reading of a proposed press [-]",
        "a stylus or a microscope, and a microscope with a scale",
    )  # fmt: skip
    rate_priors: tuple[tuple[str, tuple[float, float]], ...] = rule(
        (("rise_at_1000_per_s", (0.4, 0.35)), ("rate_exponent", (0.15, 0.08))),
        "priors of the rate law, mean and standard deviation, of the rise as ln(1 + rise) [-]",
        "rises of 0.1 to 0.4 by C of Johnson and Cook, 0.6 to 1.9 by Cowper and Symonds",
    )  # fmt: skip


RULES = DiagnosisRules()
