"""What is said of chapter 5's tables: an experiment like the laws, and one unlike them."""

from types import SimpleNamespace

from dentscope.studies.thesis.figures.tables import _said

LAW = SimpleNamespace(
    residual_flat_m=60e-6, sliding_length_m=60e-6, restitution=0.45, return_time_s=0.25e-3,
    mean_force_N=2500.0,
)  # fmt: skip


def said(angle, depth, sliding, e, duration, force):
    experiment = {
        "angle_deg": angle, "depth_m": -depth, "sliding_m": -sliding, "restitution": e,
    }  # fmt: skip
    scar = SimpleNamespace(duration=duration, mean_force=force)
    return _said(experiment, scar, [LAW])


def test_a_shallow_blow_that_slides_far_and_long_is_as_the_text_says():
    told = said(20.0, 22e-6, 1400e-6, 0.5, 4.3e-3, 79.0)
    assert told == "All 5 statements of the text hold."
    told = said(20.0, 22e-6, 100e-6, 0.5, 4.3e-3, 79.0)
    assert told.endswith("not: what was measured slid much farther (twice at least).")


def test_a_steep_blow_of_the_laws_own_force_is_not():
    told = said(70.0, 105e-6, 200e-6, 0.05, 0.1e-3, 17672.0)
    assert told == "All 4 statements of the text hold."
    told = said(70.0, 105e-6, 200e-6, 0.05, 0.1e-3, 2400.0)
    assert "not: its mean force is larger (the laws' 1.04 to 1.04 of it)" in told
