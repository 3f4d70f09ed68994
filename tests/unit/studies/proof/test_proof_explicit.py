"""The dynamic finite elements against Hertz, and their library against its own balances."""

import math
from dataclasses import replace

import h5py
import numpy as np
import pytest
from dentscope.studies.proof.explicit import (
    catalogue as explicit_library,
)
from dentscope.studies.proof.explicit import (
    mesh as explicit_mesh,
)
from dentscope.studies.proof.explicit import (
    sets as explicit_sets,
)
from dentscope.studies.proof.explicit.catalogue import Series


def test_mesh_has_no_turned_element():
    mesh = explicit_mesh.make_mesh(
        tip_radius=9e-3, bar_radius=6e-3, bar_length=0.02, tip_flat=0.0, block_radius=0.03,
        block_thickness=0.03, pad=0.004, fine=5e-5, reach=6e-4,
    )  # fmt: skip
    a, b, c, d = (mesh.x[mesh.quads[:, k]] for k in range(4))
    diagonal, other = c - a, d - b
    area = 0.5 * (diagonal[:, 0] * other[:, 1] - diagonal[:, 1] * other[:, 0])
    assert area.min() > 0.0
    assert mesh.x[mesh.tip[0]] == pytest.approx([0.0, 0.0])
    # the tip is the sphere's near the axis
    r, z = mesh.x[mesh.tip[5]]
    assert z == pytest.approx(r * r / (2 * 9e-3), rel=1e-3)


@pytest.mark.fe
def test_elastic_impact_is_hertz_within_the_block():
    hard = replace(explicit_library.MILD_STEEL, Sy=math.inf)
    (striker, *_) = explicit_library._SLUGS
    series = Series("elastic", hard, (striker,), (0.5,), "null")
    found = explicit_library.compute(series, striker, 0.5, divisions=6)
    R, m = striker.tip_radius, float(found["mass_kg"])
    E = 1.0 / ((1.0 - 0.3**2) / 208e9 + (1.0 - 0.29**2) / 206e9)
    depth = (15.0 * m * 0.25 / (16.0 * math.sqrt(R) * E)) ** 0.4
    assert found["restitution"] == pytest.approx(1.0, abs=0.01)
    # a block of 30 mm, a slug that is no sphere, six elements over the contact
    assert found["contact_time_s"] == pytest.approx(2.9432 * depth / 0.5, rel=0.03)
    force = 4.0 / 3.0 * E * math.sqrt(R) * depth**1.5
    assert found["peak_force_N"] == pytest.approx(force, rel=0.03)
    assert found["momentum"] == pytest.approx(1.0, abs=1e-9)


def test_library_keeps_momentum_and_parts():
    with h5py.File(explicit_library.FILE, "r") as store:
        assert len(store) >= 100
        for key in store:
            kept = store[key].attrs
            assert kept["momentum"] == pytest.approx(1.0, abs=1e-6)
            assert kept["parted"] == 1.0
            assert 0.0 < kept["restitution"] < 1.0
            assert kept["vibration"] < 0.3


def test_restitution_falls_with_speed_in_every_null_series():
    for series in explicit_sets.available():
        if series.kind != "null":
            continue
        for speeds, values in explicit_sets._table(series).values():
            assert np.all(np.diff(speeds) > 0.0)
            assert np.all(np.diff(values[:, 0]) < 0.0)
            assert np.all(np.diff(values[:, 1]) > 0.0)


def test_sets_follow_the_computed_impacts():
    series = explicit_sets.available()[0]
    truth = explicit_sets.draw_explicit(np.random.default_rng(1), series)
    exact = explicit_sets.readings_at(series, truth.rig, truth.rig.speed)
    table = explicit_sets._table(series)
    for i, number in enumerate(truth.rig.which):
        speeds, values = table[truth.rig.strikers[number].name]
        row = values[np.argmin(np.abs(speeds - truth.rig.speed[i]))]
        assert exact["restitution"][i] == pytest.approx(row[0], rel=1e-9)
