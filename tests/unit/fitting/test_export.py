"""The exported law is compiled or run in each language and equals the law itself."""

import ctypes
import math
import re
import runpy
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.dynamics import Approach, Striker, scene_of, strike
from dentscope.models import LAWS
from dentscope.models.export import INPUTS, NAME, OUTPUTS, write_sources

INF = math.inf


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
    return Material(E=math.nan, nu=math.nan, rigid=True) if E == INF else Material(E, nu, Sy)


def expected(rows, name):
    law = replace(LAWS[name], limits={})
    found = []
    for E_s, nu_s, Sy_s, E_f, nu_f, Sy_f, R, d in rows:
        pair = Pair(body(E_s, nu_s, Sy_s), body(E_f, nu_f, Sy_f), R)
        found.append(
            (
                float(law.loading(pair, d)),
                float(law.contact_radius(pair, d)),
                float(law.share(pair, d)),
                *(float(x) for x in law.residual(pair, d)),
                float(law.unloading_exponent(pair, d)),
            )
        )
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


def test_python(sources):
    contact = runpy.run_path(str(sources / f"{NAME}.py"))["contact"]
    compare([contact(*row) for row in ROWS])


@needs("gcc")
def test_c(sources):
    library = sources / "law.so"
    flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    subprocess.run(
        ["gcc", *flags, "-o", library, sources / f"{NAME}.c", "-lm"], check=True, timeout=120
    )

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
    subprocess.run(
        ["gfortran", *flags, f"{NAME}.f90", "main.f90", "-o", "main"],
        cwd=sources, check=True, timeout=120,
    )  # fmt: skip
    with written(sources).open() as stream:
        compare(answers([sources / "main"], sources, stdin=stream))


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


def test_the_compact_law_is_written_by_the_same_printer(tmp_path):
    write_sources(LAWS["compact"], tmp_path)
    contact = runpy.run_path(str(tmp_path / f"{NAME}.py"))["contact"]
    compare([contact(*row) for row in ROWS], law="compact")
    assert len((tmp_path / f"{NAME}.py").read_text().splitlines()) < 250


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
    flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror"]
    program = sources / "driver"
    files = [sources / "driver.c", sources / f"{NAME}.c"]
    subprocess.run(["gcc", *flags, "-o", program, *files, "-lm"], check=True, timeout=120)
    ball, flat = Material(193e9, 0.29, 7e8, density=8000.0), Material(68.9e9, 0.33, 2.76e8)
    R = 3e-3
    mass = 4.0 / 3.0 * math.pi * R**3 * ball.density
    for speed in (0.1, 1.0, 10.0):
        ours = strike(
            scene_of(
                LAWS["fitted"], sphere=ball, flat=flat, gravity=0.0,
                striker=Striker(mass=mass, tip_radius=R), approach=Approach(speed),
            )
        )  # fmt: skip
        step = ours.contact_time_s / 5000.0
        inputs = (mass, speed, step, ball.E, ball.nu, ball.Sy, flat.E, flat.nu, flat.Sy, R)
        ((back, deepest, largest, residual),) = answers([program, *map(repr, inputs)], sources)
        assert -back / speed == pytest.approx(ours.restitution, rel=1e-3)
        assert deepest == pytest.approx(ours.peak_depth_m, rel=1e-3)
        assert largest == pytest.approx(ours.peak_force_N, rel=1e-3)
        assert residual == pytest.approx(ours.residual_m, rel=1e-3)
