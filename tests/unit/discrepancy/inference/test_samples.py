"""Draws of a verdict: their moments, what is read again, and the file."""

import h5py
import numpy as np
import pytest
from dentscope.core import InputError
from dentscope.discrepancy import diagnose
from dentscope.recordings import read
from dentscope.recordings.shipped import FOLDER


@pytest.fixture(scope="module")
def verdict():
    return diagnose(read(FOLDER / "kharaz-2001-oblique"))


def test_draws_have_the_bounds_that_the_verdict_tells(verdict) -> None:
    found = verdict.samples(4000)
    assert list(found.parameters) == list(verdict.parameters)
    for name, told in verdict.parameters.items():
        low, high = np.quantile(found.parameters[name], [0.05, 0.95])
        wide = told["high"] - told["low"]
        assert low == pytest.approx(told["low"], abs=0.1 * wide), name
        assert high == pytest.approx(told["high"], abs=0.1 * wide), name


def test_what_is_shown_is_a_screen(verdict) -> None:
    told = repr(verdict).splitlines()
    assert told[0].split() == ["kharaz-2001-oblique:", "missing-physics", "probability"]
    assert told[1].split() == ["tangential-compliance", "0.95"]
    rows = repr(verdict.samples(100)).splitlines()
    assert len(rows) == 1 + len(verdict.parameters)
    assert all(len(line) < 100 for line in (*told, *rows))


def test_what_is_read_again_scatters_about_what_was_read(verdict) -> None:
    """As wide as posterior and noise together: never narrower than the noise of the means."""
    found, cells = verdict.samples(2000), verdict.problem.cells
    for name, again in found.predicted.items():
        at = [k for k, one in enumerate(cells.observable) if one == name]
        spread = np.log(again).std(0) if cells.is_log[at].all() else again.std(0)
        noise = np.sqrt(np.diag(verdict.best.linear.noise))[at]
        assert (spread > 0.93 * noise).all()
        assert (np.abs(found.measured[name] - again.mean(0)) < 4.0 * again.std(0)).all()
    # with nothing missing the spins of this set are not met
    nothing = verdict.samples(2000, explanation="baseline")
    off = [np.abs(x.measured["rebound_spin_rad_s"] / x.predicted["rebound_spin_rad_s"].mean(0) - 1)
           for x in (nothing, found)]  # fmt: skip
    assert off[0].max() > 3.0 * off[1].max()
    with pytest.raises(InputError, match=r"'magic' .*baseline"):
        verdict.samples(explanation="magic")


def test_the_file_has_the_groups_and_dimensions_that_arviz_reads(verdict, tmp_path) -> None:
    found = verdict.samples(100)
    with h5py.File(found.to_netcdf(tmp_path / "samples.nc")) as file:
        assert set(file) == {"posterior", "posterior_predictive", "observed_data"}
        sizes = file["posterior/target.E_Pa"]
        assert sizes.shape == (4, 25)
        assert [d[0].name for d in sizes.dims] == ["/posterior/chain", "/posterior/draw"]
        assert sizes.attrs["units"] == "Pa"
        again = file["posterior_predictive/restitution"]
        assert again.dims[2][0][:].tolist() == found.condition["restitution"].tolist()
        assert np.ravel(again) == pytest.approx(np.ravel(found.predicted["restitution"]))
        assert file["observed_data/restitution"][:] == pytest.approx(found.measured["restitution"])
