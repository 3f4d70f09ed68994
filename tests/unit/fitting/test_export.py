"""The exported law is compiled or run in each language, LAMMPS included, and equals the law."""

import ctypes
import math
import os
import re
import runpy
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.dynamics import Approach, Striker, scene_of, strike
from dentscope.models import LAWS
from dentscope.models.export import INPUTS, NAME, OUTPUTS, STYLE, write_sources

INF = math.inf
STEEL, ALUMINIUM = Material(193e9, 0.29, 7e8, density=8000.0), Material(68.9e9, 0.33, 2.76e8)
RIGID = Material(E=math.nan, nu=math.nan, rigid=True)
R = 3e-3
MASS = 4.0 / 3.0 * math.pi * R**3 * STEEL.density


def draws():
    u = np.random.default_rng(4).random((60, 8))
    rows = [
        (
            50e9 + 250e9 * a, 0.1 + 0.35 * b, 50e6 * 22.0**c, 50e9 + 250e9 * d, 0.1 + 0.35 * e,
            50e6 * 22.0**f, 10.0 ** (-4 + 3 * g), 0.0,
        )
        for a, b, c, d, e, f, g, _ in u
    ]  # fmt: skip
    rows = [
        (*row[:-1], row[-2] * 10.0 ** (-7 + 6.2 * x[-1])) for row, x in zip(rows, u, strict=True)
    ]
    rows += [
        (200e9, 0.3, 3e8, INF, 0.0, INF, 1e-3, 1e-5),
        (INF, 0.0, INF, 70e9, 0.33, 1e8, 1e-3, 1e-5),
        (200e9, 0.3, INF, 70e9, 0.33, 1e8, 1e-3, 1e-5),
        (200e9, 0.3, INF, 70e9, 0.33, INF, 1e-3, 1e-6),
        (200e9, 0.3, 3e8, 70e9, 0.33, 1e8, 1e-3, -1e-6),
    ]
    return rows


def body(E, nu, Sy):
    return RIGID if E == INF else Material(E, nu, Sy)


def expected(rows, name):
    law = replace(LAWS[name], limits={})
    found = []
    for *bodies, size, d in rows:
        pair = Pair(body(*bodies[:3]), body(*bodies[3:]), size)
        numbers = (law.loading, law.contact_radius, law.share, law.unloading_exponent)
        force, radius, share, exponent = (float(number(pair, d)) for number in numbers)
        found.append((force, radius, share, *map(float, law.residual(pair, d)), exponent))
    return np.array(found)


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    folder = tmp_path_factory.mktemp("export")
    write_sources(LAWS["fitted"], folder)
    return folder


def needs(program):
    return pytest.mark.skipif(shutil.which(program) is None, reason=f"{program} is not installed")


ROWS = draws()


def compare(found, rows=ROWS, *, law="fitted"):
    found, want = np.array(found), expected(rows, law)
    depth = np.abs([r[-1] for r in rows])
    for k, name in enumerate(OUTPUTS):
        # a residual depth is what two nearly equal numbers leave: it counts against the approach
        scale = depth if name.startswith("residual") else np.abs(want[:, k])
        assert np.all(np.abs(found[:, k] - want[:, k]) <= 1e-12 * scale), name


def written(folder):
    path = folder / "rows.txt"
    text = "\n".join(" ".join(f"{x:.17g}" for x in row) for row in ROWS)
    path.write_text(text.replace("inf", "Inf") + "\n")
    return path


def answers(command, folder, **given):
    """The numbers that a program prints, a line a row."""
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=True, timeout=180, **given
    )
    return [[float(x) for x in line.split()] for line in done.stdout.splitlines() if line.strip()]


C_FLAGS = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror"]


def built(folder, name, *command):
    """A program or a library that a compiler makes of files in the folder."""
    subprocess.run([*command, "-o", name], cwd=folder, check=True, timeout=120)
    return folder / name


@pytest.mark.parametrize(("law", "longest"), [("fitted", math.inf), ("compact", 250)])
def test_python(tmp_path, law, longest):
    write_sources(LAWS[law], tmp_path)
    source = tmp_path / f"{NAME}.py"
    contact = runpy.run_path(str(source))["contact"]
    compare([contact(*row) for row in ROWS], law=law)
    assert len(source.read_text().splitlines()) < longest


@needs("gcc")
def test_c(sources):
    library = built(sources, "law.so", "gcc", *C_FLAGS, "-shared", "-fPIC", f"{NAME}.c", "-lm")

    class Result(ctypes.Structure):
        _fields_ = [(name, ctypes.c_double) for name in OUTPUTS]

    function = getattr(ctypes.CDLL(str(library)), NAME)
    function.restype, function.argtypes = Result, [ctypes.c_double] * 8
    compare([[getattr(function(*row), name) for name in OUTPUTS] for row in ROWS])


@needs("gfortran")
def test_fortran(sources):
    (sources / "main.f90").write_text(
        "program main\n"
        f"  use {NAME}_law\n"
        "  implicit none\n"
        "  real(8) :: x(8), y(6)\n"
        "  integer :: status\n"
        "  do\n"
        "    read (*, *, iostat=status) x\n"
        "    if (status /= 0) exit\n"
        f"    call {NAME}(x(1), x(2), x(3), x(4), x(5), x(6), x(7), x(8), &\n"
        "      y(1), y(2), y(3), y(4), y(5), y(6))\n"
        "    write (*, '(6es26.17e3)') y\n"
        "  end do\n"
        "end program main\n"
    )
    flags = ["-std=f2008", "-O2", "-Wall", "-Werror"]
    main = built(sources, "main", "gfortran", *flags, f"{NAME}.f90", "main.f90")
    with written(sources).open() as stream:
        compare(answers([main], sources, stdin=stream))


@needs("octave")
def test_octave(sources):
    written(sources)
    columns = ", ".join(f"x(:, {k})" for k in range(1, 9))
    script = (
        f"x = dlmread('rows.txt'); [a, b, c, d, e, f] = {NAME}({columns}); "
        "printf('%.17g %.17g %.17g %.17g %.17g %.17g\\n', [a, b, c, d, e, f]');"
    )
    compare(answers(["octave", "--no-gui", "--norc", "--quiet", "--eval", script], sources))


@needs("node")
def test_javascript(sources):
    written(sources)
    (sources / "main.js").write_text(
        f"const law = require('./{NAME}.js');\n"
        "const text = require('fs').readFileSync('rows.txt', 'ascii');\n"
        "for (const row of text.trim().split('\\n')) {\n"
        "  const given = row.split(' ').map((x) => (x === 'Inf' ? Infinity : Number(x)));\n"
        "  console.log(Object.values(law(...given)).join(' '));\n"
        "}\n"
    )
    compare(answers(["node", "main.js"], sources))


def test_modelica(sources):
    """Its algorithm, statement by statement: no Modelica tool is at hand that could run it."""
    text = (sources / f"{NAME}.mo").read_text()
    head, body = text.split("\nalgorithm\n")
    first, rest = body.split("  if D <= 0.0 then\n")
    when_open, last = rest.split("    return;\n  end if;\n")
    last, end = last.rsplit("\nend ", 1)
    assert end == f"{NAME};\n"
    declared = set(re.findall(r"^  (?:input |output )?Real (\w+);$", head, re.MULTILINE))
    code = [
        compile(re.sub(r"^ +(\w+) := (.*);$", r"\1 = \2", part.replace("^", "**"), flags=re.M),
                NAME, "exec")
        for part in (first, when_open, last)
    ]  # fmt: skip
    rows = [row for row in ROWS if INF not in (row[0], row[3])]
    found = []
    for row in rows:
        at = {**dict(zip(INPUTS, row, strict=True)), "exp": math.exp, "log": math.log,
              "sqrt": math.sqrt, "max": max}  # fmt: skip
        exec(code[0], at)
        exec(code[1] if at["D"] <= 0.0 else code[2], at)
        found.append([at[f"out_{name}"] for name in OUTPUTS])
    used = {name for part in code for name in part.co_names} - {"exp", "log", "sqrt", "max"}
    assert used == declared
    compare(found, rows)


DRIVER = f"""
#include "{NAME}.h"
#include <stdio.h>
#include <stdlib.h>

/* A ball on a flat by velocity Verlet: mass, speed, time step and the seven inputs. */
int main(int argc, char **argv)
{{
    double in[10];
    for (int k = 0; k < argc - 1; k++)
        in[k] = atof(argv[k + 1]);
    const double mass = in[0], dt = in[2], *p = in + 3;
    double v = in[1], x = 0.0, f = 0.0, deepest = 0.0, largest = 0.0;
    dentscope_history history = {{0.0, 0.0, 0.0, 0.0}};
    do {{
        v -= 0.5 * dt * f / mass;
        x += dt * v;
        f = dentscope_force(p[0], p[1], p[2], p[3], p[4], p[5], p[6], x, &history);
        v -= 0.5 * dt * f / mass;
        deepest = x > deepest ? x : deepest;
        largest = f > largest ? f : largest;
    }} while (f > 0.0);
    printf("%.17g %.17g %.17g %.17g\\n", v, deepest, largest, history.residual);
    return 0;
}}
"""


@needs("gcc")
def test_one_collision_by_the_exported_force_is_ours(sources):
    """The force with its history in a time-stepping program: restitution, depth, force, dent."""
    (sources / "driver.c").write_text(DRIVER)
    program = built(sources, "driver", "gcc", *C_FLAGS, "driver.c", f"{NAME}.c", "-lm")
    for speed in (0.1, 1.0, 10.0):
        ours = struck(ALUMINIUM, R, MASS, speed)
        bodies = (STEEL.E, STEEL.nu, STEEL.Sy, ALUMINIUM.E, ALUMINIUM.nu, ALUMINIUM.Sy)
        inputs = (MASS, speed, ours.contact_time_s / 5000.0, *bodies, R)
        ((back, *found),) = answers([program, *map(repr, inputs)], sources)
        assert (-back / speed, *found) == pytest.approx(numbers_of(ours), rel=1e-3)


def struck(flat, radius, mass, speed):
    ball = Striker(mass=mass, tip_radius=radius)
    return strike(scene_of(LAWS["fitted"], sphere=STEEL, flat=flat, gravity=0.0, striker=ball,
                           approach=Approach(speed)))  # fmt: skip


def numbers_of(ours):
    return ours.restitution, ours.peak_depth_m, ours.peak_force_N, ours.residual_m


SOURCE = Path(os.environ.get("LAMMPS_SOURCE", "no-such-folder"))
FLAGS = ["-std=c++17", "-O1", "-Wall", "-Wextra", "-Werror"]
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

LAMMPS_DRIVER = f"""
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


@needs("g++")
@pytest.mark.skipif(not (SOURCE / "GRANULAR").is_dir(), reason="LAMMPS_SOURCE names no LAMMPS")
def test_it_compiles_with_the_headers_of_lammps(sources):
    ours = ["-I", str(sources), str(sources / f"{STYLE}.cpp")]
    theirs = [f"-isystem{SOURCE / name}" for name in ("GRANULAR", ".", "STUBS")]
    command = ["g++", *FLAGS, "-fsyntax-only", *theirs, *ours]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    listed = (sources / f"{STYLE}.h").read_text()
    assert "GranSubModStyle(dentscope,GranSubModNormalDentscope,NORMAL);" in listed


@pytest.fixture(scope="module")
def program(sources):
    for name in ("gran_sub_mod_normal.h", "granular_model.h", "error.h"):
        (sources / name).write_text(INTERFACE)
    (sources / "driver.cpp").write_text(LAMMPS_DRIVER)
    return built(sources, "lammps-driver", "g++", *FLAGS, "driver.cpp", f"{STYLE}.cpp")


def coefficients(body):
    return (-1.0, -1.0, -1.0) if body.rigid else (body.E, body.nu, body.Sy)


@needs("g++")
@pytest.mark.parametrize(
    ("flat", "radius", "mass", "speed"),
    [(ALUMINIUM, R, MASS, 0.1), (ALUMINIUM, R, MASS, 10.0), (RIGID, R, MASS, 1.0),
     (STEEL, 0.5 * R, 0.5 * MASS, 2.0)],
    ids=["just yielding", "deep", "rigid wall", "two balls"],
)  # fmt: skip
def test_one_collision_by_it_is_ours(program, flat, radius, mass, speed):
    """Restitution, depth, force, dent and contact radius, in 5000 steps."""
    ours = struck(flat, radius, mass, speed)
    step, bodies = ours.contact_time_s / 5000.0, (*coefficients(STEEL), *coefficients(flat))
    command = [program, *map(repr, (mass, speed, step, radius, *bodies))]
    ((back, deepest, *found, wide, untouched),) = answers(command, program.parent)
    assert (-back / speed, deepest, *found) == pytest.approx(numbers_of(ours), rel=1e-3)
    at_peak = LAWS["fitted"].contact_radius(Pair(STEEL, flat, radius), deepest)
    assert wide == pytest.approx(float(at_peak), rel=1e-6)
    assert untouched == -7.0


@needs("g++")
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
