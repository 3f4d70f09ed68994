"""Origins of results, and the question whether pictures can be rendered."""

import math
import subprocess
import sys

import pytest
from dentscope.core import Material, Pair, provenance, rendering


def test_digest_of_a_file_is_the_published_one(tmp_path):
    path = tmp_path / "abc"
    path.write_bytes(b"abc")
    # FIPS 180-2, appendix B.1
    expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert provenance.file_digest(path) == expected


def test_environment_names_what_influences_numbers():
    found = provenance.environment()
    assert {"dentscope", "python", "numpy", "scipy", "gmsh", "commit"} <= set(found)
    assert found["python"] == sys.version.split()[0]


def test_an_edited_source_is_another_one(tmp_path, monkeypatch):
    monkeypatch.setattr(provenance, "__file__", str(tmp_path / "core" / "provenance.py"))
    (tmp_path / "fem").mkdir()
    sources = set()
    for text in ("a = 1\n", "a = 2\n", "a = 1\n"):
        (tmp_path / "fem" / "solve.py").write_text(text)
        sources.add(provenance._source())
    assert len(sources) == 2


def test_numbers_that_are_not_finite_have_an_identity():
    assert provenance.content_id(math.inf) != provenance.content_id(-math.inf)
    assert provenance.content_id(math.nan) == provenance.content_id(math.nan)


def test_rigid_partner_leaves_the_whole_approach_to_the_other_body():
    rigid = Material(E=math.nan, nu=math.nan, rigid=True)
    steel = Material(E=200e9, nu=0.3, Sy=1e9)
    assert Pair(steel, rigid, 1e-3).elastic_share == 1.0
    assert Pair(rigid, steel, 1e-3).elastic_share == 0.0
    assert Pair(rigid, steel, 1e-3).Sy_ratio == math.inf
    assert Pair(rigid, steel, 1e-3).weaker is steel


@pytest.mark.parametrize(("code", "expected"), [(0, True), (1, False), (-11, False)])
def test_a_crash_of_the_probe_is_a_no(monkeypatch, code, expected):
    monkeypatch.setattr(
        rendering.subprocess, "run", lambda *a, **k: subprocess.CompletedProcess(a, code)
    )
    assert rendering.offscreen_available.__wrapped__() is expected


def test_a_probe_that_hangs_is_a_no(monkeypatch):
    def hang(*arguments, **options):
        raise subprocess.TimeoutExpired("probe", options["timeout"])

    monkeypatch.setattr(rendering.subprocess, "run", hang)
    assert rendering.offscreen_available.__wrapped__() is False
