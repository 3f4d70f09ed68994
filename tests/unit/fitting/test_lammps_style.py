"""The exported normal model of LAMMPS, compiled with its headers (LAMMPS_SOURCE) and tried."""

import math
import os
import shutil
import subprocess
from pathlib import Path

import pytest
from dentscope.core import Material, Pair
from dentscope.dynamics import Approach, Striker, scene_of, strike
from dentscope.models import LAWS
from dentscope.models.export import STYLE, write_sources

SOURCE = Path(os.environ.get("LAMMPS_SOURCE", "no-such-folder"))
FLAGS = ["-std=c++17", "-O1", "-Wall", "-Wextra", "-Werror"]

pytestmark = pytest.mark.skipif(shutil.which("g++") is None, reason="g++ is not installed")

INTERFACE = """
#pragma once
#include <stdexcept>
#define FLERR __FILE__, __LINE__
namespace LAMMPS_NS {
struct Error {
  void all(const char *, int, const char *what) { throw std::runtime_error(what); }
};
struct LAMMPS { Error *error; };
namespace Granular_NS {
struct GranularModel { double *history; int history_update; double delta, Reff; };
class GranSubModNormal {
 public:
  GranSubModNormal(GranularModel *model, LAMMPS *lmp) : gm(model), error(lmp->error) {}
  virtual ~GranSubModNormal() { delete[] transfer_history_factor; }
  virtual void coeffs_to_local() = 0;
  virtual void mix_coeffs(double *, double *) = 0;
  virtual double calculate_contact_radius() = 0;
  virtual double calculate_forces() = 0;
  int num_coeffs, size_history, nondefault_history_transfer, history_index;
  double *coeffs, *transfer_history_factor;
 protected:
  GranularModel *gm;
  Error *error;
  double damp;
};
}
}
"""

DRIVER = f"""
#include "{STYLE}.h"
#include <cstdio>
#include <cstdlib>
using namespace LAMMPS_NS;
using namespace Granular_NS;

/* One head-on collision by velocity Verlet: mass, speed, time step, radius, six coefficients. */
int main(int argc, char **argv)
{{
  double in[10], kept[6] = {{-7.0}};
  for (int k = 1; k < argc; k++) in[k - 1] = atof(argv[k]);
  const double mass = in[0], dt = in[2];
  Error error;
  LAMMPS lmp = {{&error}};
  GranularModel model = {{kept, 0, 0.0, in[3]}};
  GranSubModNormalDentscope normal(&model, &lmp);
  normal.coeffs = in + 4;
  normal.history_index = 1;
  try {{
    normal.coeffs_to_local();
  }} catch (const std::exception &refused) {{
    puts(refused.what());
    return 1;
  }}
  double v = in[1], x = 0.0, f = 0.0, deepest = 0.0, largest = 0.0, wide = 0.0;
  do {{
    v -= 0.5 * dt * f / mass;
    model.delta = x += dt * v;
    normal.calculate_forces();  // as in a set-up, which must leave no trace
    model.history_update = 1;
    const double a = normal.calculate_contact_radius();
    f = normal.calculate_forces();
    model.history_update = 0;
    v -= 0.5 * dt * f / mass;
    if (x > deepest) deepest = x;
    if (f > largest) largest = f;
    if (a > wide) wide = a;
  }} while (f > 0.0);
  printf("%.17g %.17g %.17g %.17g %.17g %.17g\\n", v, deepest, largest, kept[3], wide, kept[0]);
  return 0;
}}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("lammps")
    write_sources(LAWS["fitted"], made)
    return made


@pytest.mark.skipif(not (SOURCE / "GRANULAR").is_dir(), reason="LAMMPS_SOURCE names no LAMMPS")
def test_it_compiles_with_the_headers_of_lammps(folder):
    ours = ["-I", str(folder), str(folder / f"{STYLE}.cpp")]
    theirs = [f"-isystem{SOURCE / name}" for name in ("GRANULAR", ".", "STUBS")]
    command = ["g++", *FLAGS, "-fsyntax-only", *theirs, *ours]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    listed = (folder / f"{STYLE}.h").read_text()
    assert "GranSubModStyle(dentscope,GranSubModNormalDentscope,NORMAL);" in listed


@pytest.fixture(scope="module")
def program(folder):
    for name in ("gran_sub_mod_normal.h", "granular_model.h", "error.h"):
        (folder / name).write_text(INTERFACE)
    (folder / "driver.cpp").write_text(DRIVER)
    made = folder / "driver"
    files = [folder / "driver.cpp", folder / f"{STYLE}.cpp"]
    subprocess.run(["g++", *FLAGS, "-o", made, *files], check=True, timeout=120)
    return made


def collided(program, *inputs):
    done = subprocess.run([program, *map(repr, inputs)], timeout=60, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    return [float(x) for x in done.stdout.split()]


STEEL, ALUMINIUM = Material(193e9, 0.29, 7e8, density=8000.0), Material(68.9e9, 0.33, 2.76e8)
RIGID = Material(E=math.nan, nu=math.nan, rigid=True)
R = 3e-3
MASS = 4.0 / 3.0 * math.pi * R**3 * STEEL.density


def coefficients(body):
    return (-1.0, -1.0, -1.0) if body.rigid else (body.E, body.nu, body.Sy)


@pytest.mark.parametrize(
    ("flat", "radius", "mass", "speed"),
    [(ALUMINIUM, R, MASS, 0.1), (ALUMINIUM, R, MASS, 10.0), (RIGID, R, MASS, 1.0),
     (STEEL, 0.5 * R, 0.5 * MASS, 2.0)],
    ids=["just yielding", "deep", "rigid wall", "two balls"],
)  # fmt: skip
def test_one_collision_by_it_is_ours(program, flat, radius, mass, speed):
    """Restitution, depth, force, dent and contact radius, in 5000 steps."""
    scene = scene_of(
        LAWS["fitted"], sphere=STEEL, flat=flat, gravity=0.0,
        striker=Striker(mass=mass, tip_radius=radius), approach=Approach(speed),
    )  # fmt: skip
    ours = strike(scene)
    step = ours.contact_time_s / 5000.0
    back, deepest, largest, residual, wide, untouched = collided(
        program, mass, speed, step, radius, *coefficients(STEEL), *coefficients(flat)
    )
    assert -back / speed == pytest.approx(ours.restitution, rel=1e-3)
    assert deepest == pytest.approx(ours.peak_depth_m, rel=1e-3)
    assert largest == pytest.approx(ours.peak_force_N, rel=1e-3)
    assert residual == pytest.approx(ours.residual_m, rel=1e-3)
    at_peak = LAWS["fitted"].contact_radius(Pair(STEEL, flat, radius), deepest)
    assert wide == pytest.approx(float(at_peak), rel=1e-6)
    assert untouched == -7.0


@pytest.mark.parametrize(
    ("bodies", "said"),
    [((RIGID, RIGID), "both bodies are rigid"), ((STEEL, None), "nu below 0.5")],
)
def test_what_is_no_body_is_refused(program, bodies, said):
    given = [x for b in bodies for x in ((70e9, 0.5, 1e8) if b is None else coefficients(b))]
    command = [program, *map(repr, (MASS, 1.0, 1e-9, R, *given))]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 1
    assert said in done.stdout
