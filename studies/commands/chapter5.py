"""Chapter 5 of the thesis: tables of `dentscope inverse`."""

from __future__ import annotations

import math
from typing import Any

from ...cli.laws import laws_named
from ...cli.shared.terminal import show_table


def thesis_rows() -> Any:
    """Return the thesis's rod and its trials, inferred."""
    from ..thesis import chapter5

    return chapter5.thesis_rows()


def tables(console: Any, names: list[str]) -> None:
    """Tables 5.2-5.4: our rigid impacts at the stated mass and at the mass that fits."""
    from ...core.inputs.toml_input import read_toml
    from ..thesis.chapter3 import REFERENCE
    from ..thesis.chapter5 import simulate_experiment, thesis_rod

    data = read_toml(REFERENCE / "chapter45.toml")
    masses = (data["rod"]["mass_kg"], data["mass_that_fits"]["value_kg"])
    angles = data["simulation"][0]["angle_deg"]
    for place, (angle, experiment) in enumerate(zip(angles, data["experiment"], strict=True)):
        head = (
            "", "dent\n[um]", "e", "contact\n[ms]", "back at\nsurface [ms]", "mean\nforce [N]",
            "sliding\n[um]", "later\n[um]",
        )  # fmt: skip
        rows = [
            (
                "measured", f"{-experiment['depth_m'] * 1e6:.0f}",
                f"{experiment['restitution']:.2f}", "-", "-", "-",
                f"{-experiment['sliding_m'] * 1e6:.0f}", "-",
            )
        ]  # fmt: skip
        for row in data["simulation"]:
            rows.append((
                f"thesis: {row['law']}", f"{-row['depth_m'][place] * 1e6:.0f}",
                f"{row['restitution'][place]:.2f}", "-", f"{row['duration_s'][place] * 1e3:.2f}",
                f"{row['mean_force_N'][place]:.0f}", "-",
                f"{-row['sliding_m'][place] * 1e6:.0f}",
            ))  # fmt: skip
        for law in laws_named(names):
            for mass in masses:
                i = simulate_experiment(experiment, law, mass=mass)
                arm = thesis_rod(mass=mass).arm(math.radians(angle))[1]
                leaving = abs(i.tangential_rebound_m_s + i.rebound_spin_rad_s * arm)
                later = i.sliding_length_m + leaving * (i.return_time_s - i.contact_time_s)
                rows.append((
                    f"{law.name}, {mass:g} kg", f"{i.residual_flat_m * 1e6:.0f}",
                    f"{i.restitution:.2f}", f"{i.contact_time_s * 1e3:.3f}",
                    f"{i.return_time_s * 1e3:.3f}", f"{i.mean_force_N:.0f}",
                    f"{i.sliding_length_m * 1e6:.0f}", f"{later * 1e6:.0f}",
                ))  # fmt: skip
        show_table(
            console, head, rows,
            title=f"table 5.{place + 2}: {angle} degrees, rigid rod",
        )  # fmt: skip
    console.print(
        f"The stated {masses[0]:g} kg is 20 % below the rod's size times its density "
        f"({masses[1]:g} kg), which the thesis's own dents need.\n"
        "The thesis's durations and sliding lengths end with the tip back at the surface (later), "
        "its mean forces\nwith the last parting; its Ghaednia row at 45 degrees repeats the dent "
        "and sliding length of 20 degrees.",
        soft_wrap=True,
    )
