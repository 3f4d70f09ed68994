"""Craters and scars in scans rendered with a known depth, and measured surfaces."""

from pathlib import Path

import meshio
import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.scan.crater import reduce_scan
from dentscope.reduce.scan.file import Scan
from dentscope.reduce.scan.kind import reduce
from dentscope.reduce.scan.options import Options
from dentscope.studies.synthetic.scans import random_truth, render
from scipy.spatial import Delaunay

EXCERPTS = Path(__file__).resolve().parents[2] / "data" / "surface-scans"
REAL = Path(__file__).resolve().parents[4] / "shared" / "recordings" / "surface-scans"
measured = pytest.mark.skipif(not REAL.is_dir(), reason="the measured surfaces are not here")


@pytest.mark.parametrize("seed", [901, 902, 903])
def test_depth_of_a_crater_within_its_uncertainty(seed):
    truth = random_truth(seed)
    found = reduce_scan(render(truth))
    assert abs(found.depth.value - truth.depth) < 4.0 * found.depth.std
    assert found.depth.value == pytest.approx(truth.depth, rel=0.02)
    assert not found.is_scar


@pytest.mark.parametrize(("step", "noise"), [(1.5e-6, 1e-8), (2e-6, 1e-8), (2e-6, 2e-7)])
def test_a_narrow_rim_is_neither_flattened_nor_taken_for_spikes(step, noise):
    x = (np.arange(250) - 124.7) * step
    r = np.hypot(*np.meshgrid(x, x, indexing="ij")) / 6e-5
    z = np.where(r < 1.0, 1e-5 * (r**2 - 1.0), 0.0) + 2e-6 * np.exp(-(((r - 1.1) / 0.1) ** 2))
    z += noise * np.random.default_rng(0).standard_normal(z.shape)
    z[20, 30] += 5e-6
    found = reduce_scan(Scan(z, np.full(2, step), "rim"))
    assert found.surface.outliers == 1
    assert abs(found.pile_up.value - 2e-6) < 2.0 * found.pile_up.std < 6e-8


def test_a_scar_has_a_sliding_length():
    truth = random_truth(905, sliding=4e-4)
    found = reduce_scan(render(truth))
    assert found.is_scar
    assert found.sliding.value == pytest.approx(truth.sliding, rel=0.05)
    assert found.depth.value == pytest.approx(truth.depth, rel=0.02)


def test_radius_and_depth_in_excerpts_of_measured_surfaces():
    # 499 um and about 0.3 um with a raised rim: tests/data/surface-scans/SOURCE.md
    ball = Options(shows="ball", unit="um", step_m=8.98562e-7, reach_m=30e-6)
    radius = reduce(EXCERPTS / "ball.csv", ball).values["tip_radius_m"]
    assert radius.value == pytest.approx(499e-6, rel=0.01)
    crater = reduce(EXCERPTS / "crater.csv", Options(unit="um", step_m=6.25e-7)).values
    assert crater["permanent_depth_m"].value == pytest.approx(0.3e-6, abs=0.03e-6)
    assert crater["pile_up_m"].value > 0.0


@measured
def test_radius_of_a_measured_ball(tmp_path):
    # a paraboloid fitted within 30 um of the middle gives 499 um: SOURCE.md of the scans
    found = reduce(REAL / "mnt-2.mnt", Options(shows="ball", reach_m=30e-6))
    assert found.values["tip_radius_m"].value == pytest.approx(499e-6, rel=0.01)
    found.draw(tmp_path / "ball.png")
    assert (tmp_path / "ball.png").stat().st_size > 10_000


@measured
def test_depth_of_a_measured_crater():
    # about 0.3 um deep with a raised rim: SOURCE.md of the scans
    found = reduce(REAL / "nms-1.nms", Options(step_m=3.125e-7))
    assert found.values["permanent_depth_m"].value == pytest.approx(0.3e-6, abs=0.03e-6)
    assert found.values["pile_up_m"].value > 0.0


@measured
def test_a_scan_of_a_hundred_metres_is_refused():
    # the reader takes this header's unit for one a million times as large
    with pytest.raises(InputError, match=r"0\.312 m apart.*--step-m"):
        reduce(REAL / "nms-1.nms", Options())


def test_a_level_surface_has_no_crater(tmp_path, errs):
    path = tmp_path / "flat.csv"
    np.savetxt(path, np.random.default_rng(1).normal(0.0, 0.1, (80, 80)), delimiter=",")
    assert "no crater" in errs("reduce", "scan", path, "--unit", "um", "--step-m", "1e-6")


Y, X = np.mgrid[-1:1:48j, -1:1:40j]
DENT = -1e-5 * np.maximum(0.0, 0.3 - X**2 - Y**2)
DENT += np.random.default_rng(4).normal(0.0, 2e-8, DENT.shape)


@pytest.mark.parametrize(
    ("between", "comma", "end"),
    [(" ", ".", ""), ("\t", ".", "\t"), (";", ",", ""), (",", ".", ",")],
)
def test_a_grid_is_read_with_any_separator(tmp_path, between, comma, end):
    rows = [between.join(f"{v:.4e}".replace(".", comma) for v in row) + end for row in DENT]
    path = tmp_path / "grid.csv"
    path.write_text("\n".join(rows))
    found = reduce(path, Options(unit="m", step_m=1e-5)).values["permanent_depth_m"]
    assert abs(found.value - 3e-6) < 3.0 * found.std


def test_points_that_were_not_seen_are_left_out_of_a_file_and_not_of_the_volume(tmp_path):
    seen = np.random.default_rng(5).random(DENT.shape) < 0.9
    points = [f"{10 * k} {10 * i} {1e6 * DENT[i, k]:.4f}" for i, k in np.argwhere(seen)]
    (tmp_path / "a.xyz").write_text("\n".join(points))
    found = reduce(tmp_path / "a.xyz", Options(unit="um")).values
    assert abs(found["permanent_depth_m"].value - 3e-6) < 3.0 * found["permanent_depth_m"].std
    whole = -1e-10 * DENT[DENT < -1e-7].sum()
    assert found["crater_volume_m3"].value == pytest.approx(whole, rel=0.03)


V, U = np.mgrid[-1:1:200j, -1:1:200j]
RANGE = np.hypot(U, V)
ROUGH = np.random.default_rng(7).normal(0.0, 2e-8, U.shape)
CUT = ROUGH - 1e-5 * ((U > 0.8) & (np.abs(V) < 0.3))
RING = ROUGH + 3e-6 * (RANGE < 0.2) - 1e-6 * np.exp(-(((RANGE - 0.32) / 0.06) ** 2))


@pytest.mark.parametrize(("z", "said"), [(CUT, "leaves the scan"), (RING, "surrounds a hill")])
def test_what_is_no_crater_is_none(tmp_path, errs, z, said):
    np.savetxt(tmp_path / "a.csv", z, delimiter=",")
    assert said in errs("reduce", "scan", tmp_path / "a.csv", "--unit", "m", "--step-m", "1e-5")


def test_lines_of_an_instrument_above_a_grid_and_units_of_columns_are_read(tmp_path):
    said = '"Model","VK-X"\n"XY calibration","10","um"\n"Horizontal","40"\n""\n"Height"\n'
    rows = [",".join(f'"{v:.4e}"' for v in row) for row in DENT]
    (tmp_path / "grid.csv").write_text(said + "\n".join(rows))
    points = [f"{10 * i},{10 * k},{1e9 * DENT[k, i]:.2f}" for i in range(40) for k in range(48)]
    (tmp_path / "points.csv").write_text("\n".join(["x [um],y [um],z [nm]", *points]))
    for name, given in (("grid", Options(unit="m", step_m=1e-5)), ("points", Options())):
        found = reduce(tmp_path / f"{name}.csv", given).values["permanent_depth_m"]
        assert abs(found.value - 3e-6) < 3.0 * found.std


BESIDE = ROUGH - 1e-5 * np.maximum(0.0, 0.04 - (U - 0.4) ** 2 - (V - 0.4) ** 2)
BESIDE -= 0.7e-5 * np.maximum(0.0, 0.04 - (U + 0.4) ** 2 - (V + 0.4) ** 2)


def test_other_craters_are_told_and_no_roughness(tmp_path):
    np.savetxt(tmp_path / "a.csv", BESIDE, delimiter=",")
    found = reduce(tmp_path / "a.csv", Options(unit="m", step_m=1e-5))
    depth = found.values["permanent_depth_m"]
    assert abs(depth.value - 4e-7) < 4.0 * depth.std < 0.05 * depth.value
    assert any("of 2 craters the deepest" in note for note in found.notes)


def test_a_number_that_fills_what_was_not_seen_is_no_height(tmp_path):
    seen = np.random.default_rng(5).random(DENT.shape) < 0.9
    found = []
    for name, filling in (("a", np.nan), ("b", -9999.0), ("c", 1e9)):
        z = np.where(seen, 1e6 * DENT, filling)
        np.savetxt(tmp_path / f"{name}.csv", z, delimiter=",")
        given = Options(unit="m", height_unit="um", step_m=1e-5)
        found.append(reduce(tmp_path / f"{name}.csv", given))
    depths = [one.values["permanent_depth_m"] for one in found]
    assert depths[0] == depths[1] == depths[2]
    assert found[0].notes == found[1].notes == found[2].notes


def test_a_crater_that_leaves_the_scan_has_no_volume(tmp_path):
    np.savetxt(tmp_path / "a.csv", BESIDE[:, :150], delimiter=",")
    found = reduce(tmp_path / "a.csv", Options(unit="m", step_m=1e-5))
    assert np.isnan(found.values["crater_volume_m3"].value)
    assert any("within the scan" in note for note in found.notes)


@pytest.mark.parametrize("form", ["stl", "ply", "xyz"])
def test_points_of_a_mesh_or_a_cloud_are_read(tmp_path, form):
    rng = np.random.default_rng(2)
    at = rng.uniform(-1.0, 1.0, (9000, 2)) if form == "xyz" else np.c_[U.ravel(), V.ravel()][::3]
    z = -0.03 * np.maximum(0.0, 0.3 - (at**2).sum(axis=1)) + rng.normal(0.0, 1e-5, len(at))
    points, path = np.c_[at, z], tmp_path / f"a.{form}"
    if form == "xyz":
        np.savetxt(path, points, fmt="%.7f")
    else:
        meshio.Mesh(points, [("triangle", Delaunay(at).simplices)]).write(path)
    depth = reduce(path, Options(unit="mm")).values["permanent_depth_m"]
    assert depth.value == pytest.approx(9e-6, rel=0.01)
    assert abs(depth.value - 9e-6) < 4.0 * depth.std


def test_a_curve_is_no_cloud_of_points(tmp_path, errs):
    t = np.linspace(0.0, 1.0, 2000)
    np.savetxt(tmp_path / "a.csv", np.c_[t, t**2, np.sin(t)], delimiter=",")
    assert "cover no area" in errs("reduce", "scan", tmp_path / "a.csv", "--unit", "mm")
    (tmp_path / "a.stl").write_bytes(b"solid")
    assert "a whole STL or PLY file" in errs("reduce", "scan", tmp_path / "a.stl")
