"""The fitted law as source code that needs nothing else: Python, C, Fortran, MATLAB or Octave.

Each file holds the coefficients and one routine from the two materials, the radius and the approach
to force, contact radius, sphere's share, permanent depths and the exponent of the unloading. They
are translated from the same lines that the law itself runs (`closed_form`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..core.material import Material, Pair
from .base import critical_depth
from .closed_form import COEFFICIENTS
from .export_syntax import Syntax, expression, statements
from .fitted import Fitted

NAME = "dentscope_contact"
INPUTS = ("E_s", "nu_s", "Sy_s", "E_f", "nu_f", "Sy_f", "R", "depth")
OUTPUTS = ("force", "contact_radius", "share", "residual_s", "residual_f", "exponent")

_FROM_INPUTS = {
    "k_s": "(1.0 - nu_s * nu_s) / E_s",
    "k_f": "(1.0 - nu_f * nu_f) / E_f",
    "q_s": "1.0 / Sy_s",
    "q_f": "1.0 / Sy_f",
    "D": "depth / R",
}
_TO_OUTPUTS = {
    "force": "F * R * R / (k_s + k_f)",
    "contact_radius": "a * R",
    "share": "share",
    "residual_s": "phi * left * depth",
    "residual_f": "(1.0 - phi) * left * depth",
    "exponent": "N",
}
_ABOUT = (
    "Elastic-plastic contact of a sphere (s) and a flat (f) on first loading; law of dentscope.",
    "E Young's modulus, nu Poisson's ratio, Sy yield strength, R radius, depth = approach; SI.",
    "A rigid body: infinite E and Sy. An elastic body: infinite Sy.",
    "Results: force [N], contact radius [m], sphere's share of the approach, permanent depth of",
    "sphere and flat after unloading from this depth [m], exponent N of the unloading curve",
    "F/F_m = ((depth - residual)/(depth_m - residual))^N with residual = residual_s + residual_f.",
)


def write_sources(law: Fitted, folder: Path) -> list[Path]:
    """Write the law in every language and the table for discrete-element codes.

    Parameters
    ----------
    law
        The fitted law.
    folder
        Where the files go; made if needed.

    Returns
    -------
    list of Path
        The files written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    texts = {
        f"{NAME}.py": python_source(law),
        f"{NAME}.h": c_header(law),
        f"{NAME}.c": c_source(law),
        f"{NAME}.f90": fortran_source(law),
        f"{NAME}.m": matlab_source(law),
        "dem_parameters.csv": dem_table(law),
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="ascii")
    return [folder / name for name in texts]


def _comment(law: Fitted, mark: str) -> str:
    domain = f"Fitted over: {law.domain.note}." if law.domain.note else "Domain not stated."
    lines = (*_ABOUT, *_folded(domain))
    return "\n".join(f"{mark} {line}" for line in lines)


def _folded(text: str, width: int = 94) -> list[str]:
    lines = [""]
    for word in text.split():
        if len(lines[-1]) + len(word) + 1 > width:
            lines.append("")
        lines[-1] += f" {word}" if lines[-1] else word
    return lines


def _coefficient(name: str) -> str:
    return f"coef_{name}" if name in COEFFICIENTS else name


def _decimal(x: float) -> str:
    text = repr(float(x))
    return text if "." in text or "e" in text else f"{text}.0"


def _lines(syntax: Syntax) -> list[tuple[str, str]]:
    """(target, expression) of the form's statements."""
    return [(syntax.name(s.target), expression(s.value, syntax)) for s in statements()]


def _block(lines: list[tuple[str, str]], *, indent: int = 4, end: str = "") -> str:
    return "\n".join(f"{' ' * indent}{target} = {text}{end}" for target, text in lines)


def _coefficients(law: Fitted) -> Mapping[str, str]:
    return {f"coef_{name}": _decimal(law.coefficients[name]) for name in COEFFICIENTS}


def python_source(law: Fitted) -> str:
    """The law as a Python module that imports nothing but math."""
    syntax = Syntax(power="{}**{}".format, number=_decimal, name=_coefficient)
    return f'''"""Contact of a sphere and a flat.

{_comment(law, "").replace(chr(10) + " ", chr(10)).strip()}
"""

from math import exp, log, sqrt

{_block(list(_coefficients(law).items()), indent=0)}


def contact({", ".join(INPUTS)}):
    """Return {", ".join(OUTPUTS)}."""
{_block(list(_FROM_INPUTS.items()))}
    if D <= 0.0:
        return 0.0, 0.0, k_s / (k_s + k_f), 0.0, 0.0, 1.5
{_block(_lines(syntax))}
    left = max(left, 0.0)
    return (
{"".join(f"        {text},{chr(10)}" for text in _TO_OUTPUTS.values())}    )
'''


def c_header(law: Fitted) -> str:
    """Declaration of the C function."""
    fields = "\n".join(f"    double {name};" for name in OUTPUTS)
    return f"""/*
{_comment(law, " *")}
 */
#ifndef DENTSCOPE_CONTACT_H
#define DENTSCOPE_CONTACT_H

typedef struct {{
{fields}
}} dentscope_result;

#ifdef __cplusplus
extern "C" {{
#endif
dentscope_result {NAME}({", ".join(f"double {name}" for name in INPUTS)});
#ifdef __cplusplus
}}
#endif

#endif
"""


def c_source(law: Fitted) -> str:
    """The law as C99 that needs nothing but the mathematical library."""
    syntax = Syntax(power="pow({}, {})".format, number=_decimal, name=_coefficient)
    constants = "\n".join(
        f"static const double {name} = {value};" for name, value in _coefficients(law).items()
    )
    declared = [(f"const double {name}", text) for name, text in _FROM_INPUTS.items()]
    form = [(f"const double {name}", text) for name, text in _lines(syntax)]
    results = [(f"result.{name}", text) for name, text in _TO_OUTPUTS.items()]
    results[3:5] = [(name, text.replace("left", "kept")) for name, text in results[3:5]]
    return f"""/* See {NAME}.h */
#include "{NAME}.h"
#include <math.h>

{constants}

dentscope_result {NAME}({", ".join(f"double {name}" for name in INPUTS)})
{{
    dentscope_result result = {{0.0, 0.0, 0.0, 0.0, 0.0, 1.5}};
{_block(declared, end=";")}
    if (D <= 0.0) {{
        result.share = k_s / (k_s + k_f);
        return result;
    }}
{_block(form, end=";")}
    const double kept = left > 0.0 ? left : 0.0;
{_block(results, end=";")}
    return result;
}}
"""


def _fortran_name(name: str) -> str:
    """Fortran does not tell capitals from small letters: a capital gets a prefix."""
    name = _coefficient(name)
    body = name.removeprefix("coef_")
    changed = f"cap_{body}" if body != body.lower() else body
    return (f"coef_{changed}" if name.startswith("coef_") else changed).rstrip("_") + (
        "x" if name.endswith("_") else ""
    )


def fortran_source(law: Fitted) -> str:
    """The law as an elemental subroutine of a Fortran 2008 module."""
    syntax = Syntax(power="{}**{}".format, number=lambda x: f"{_decimal(x)}_dp", name=_fortran_name)
    constants = "\n".join(
        f"  real(dp), parameter :: {_fortran_name(name)} = {_decimal(law.coefficients[name])}_dp"
        for name in COEFFICIENTS
    )
    plain = {k: v.replace("1.0", "1.0_dp") for k, v in {**_FROM_INPUTS, **_TO_OUTPUTS}.items()}
    # inputs and outputs carry a prefix of their own, so that no name meets one of the form's
    for name in (*INPUTS, "F", "N", "D"):
        for key, text in plain.items():
            plain[key] = _words(text, {name: _io(name) if name in INPUTS else _fortran_name(name)})
    nus = {name: _io(name) for name in ("nu_s", "nu_f")}
    form = [(target, _words(text, nus)) for target, text in _lines(syntax)]
    before = [(_fortran_name(name), plain[name]) for name in _FROM_INPUTS]
    after = [(f"out_{name}", plain[name]) for name in OUTPUTS]
    local = sorted({name for name, _ in (*before, *form)})
    names = [_io(name) for name in INPUTS]
    outs = [f"out_{name}" for name in OUTPUTS]
    return f"""{_comment(law, "!")}
module {NAME}_law
  implicit none
  private
  public :: {NAME}
  integer, parameter :: dp = selected_real_kind(15, 307)
{constants}
contains

  elemental subroutine {NAME}({_wrapped([*names, *outs])})
    real(dp), intent(in) :: {_wrapped(names)}
    real(dp), intent(out) :: {_wrapped(outs)}
    real(dp) :: {_wrapped(local)}
{_block([(n, _long(t)) for n, t in before])}
    if ({_fortran_name("D")} <= 0.0_dp) then
      out_force = 0.0_dp
      out_contact_radius = 0.0_dp
      out_share = k_s / (k_s + k_f)
      out_residual_s = 0.0_dp
      out_residual_f = 0.0_dp
      out_exponent = 1.5_dp
      return
    end if
{_block([(n, _long(t)) for n, t in form])}
    left = max(left, 0.0_dp)
{_block([(n, _long(t)) for n, t in after])}
  end subroutine {NAME}

end module {NAME}_law
"""


def _io(name: str) -> str:
    return f"in_{name.lower()}"


def _words(text: str, names: Mapping[str, str]) -> str:
    """Replace whole words."""
    pattern = r"\b(" + "|".join(map(re.escape, names)) + r")\b"
    return re.sub(pattern, lambda m: names[m.group(1)], text)


def _wrapped(names: list[str], most: int = 5) -> str:
    rows = [", ".join(names[k : k + most]) for k in range(0, len(names), most)]
    return ", &\n      ".join(rows)


def _long(text: str, width: int = 100) -> str:
    """Continue a long line after an operator."""
    lines = [""]
    for word in text.split(" "):
        if len(lines[-1]) + len(word) + 1 > width:
            lines.append("")
        lines[-1] += f" {word}" if lines[-1] else word
    return " &\n      ".join(lines)


def matlab_source(law: Fitted) -> str:
    """The law as a MATLAB or Octave function; any input may be an array."""
    syntax = Syntax(
        power="{}.^{}".format, number=_decimal, name=_coefficient, times=" .* ", over=" ./ "
    )

    def array(text: str) -> str:
        return text.replace(" * ", " .* ").replace(" / ", " ./ ")

    constants = [(name, f"{value};") for name, value in _coefficients(law).items()]
    before = [(name, f"{array(text)};") for name, text in _FROM_INPUTS.items()]
    after = [(f"out_{name}", f"{array(text)};") for name, text in _TO_OUTPUTS.items()]
    outs = [f"out_{name}" for name in OUTPUTS]
    return f"""function [{", ".join(outs)}] = {NAME}({", ".join(INPUTS)})
{_comment(law, "%")}
{_block(constants, indent=2)}
{_block(before, indent=2)}
  open_contact = D <= 0;
  D = max(D, 1e-100);
{_block([(name, f"{text};") for name, text in _lines(syntax)], indent=2)}
  left = max(left, 0);
{_block(after, indent=2)}
  closed = ~open_contact;
  out_share = out_share .* closed + x_s .* open_contact;
  out_exponent = out_exponent .* closed + 1.5 .* open_contact;
  out_force = out_force .* closed;
  out_contact_radius = out_contact_radius .* closed;
  out_residual_s = out_residual_s .* closed;
  out_residual_f = out_residual_f .* closed;
end
"""


_DEM_PAIRS = ((200.0, 200.0, 200.0), (71.7, 200.0, 300.0), (200.0, 200.0, 503.0))
_DEM_RATIOS = (0.1, 1.0, 10.0)
_DEM_DEPTHS = (0.001, 0.003, 0.01, 0.03)


def dem_table(law: Fitted) -> str:
    """What the simpler laws of discrete-element codes need to agree with this law, as CSV.

    Those laws carry neither two yielding bodies nor this loading curve, so the table gives what
    makes them agree at a largest approach: for Hertz with damping (LAMMPS `hertz/material`) the
    restitution from the energies of loading and unloading; for the linear hysteretic law of Luding
    (YADE `LudingMat`) the secant stiffnesses of loading (same energy) and of unloading.
    """
    head = (
        "# E [GPa], Sy [MPa], nu = 0.3; stiffnesses over E' R; e from the energies of one cycle",
        "E_s,E_f,Sy_s,Sy_f,Delta_over_R,delta_over_delta_c,F_over_E_R2,a_over_R,"
        "residual_over_Delta,k_loading,k_unloading,restitution",
    )
    lines = []
    for E_s, E_f, Sy in _DEM_PAIRS:
        for ratio in _DEM_RATIOS:
            s, f = (Sy, Sy / ratio) if ratio < 1.0 else (Sy * ratio, Sy)
            pair = Pair(Material(E_s * 1e9, 0.3, s * 1e6), Material(E_f * 1e9, 0.3, f * 1e6), 1.0)
            for D in _DEM_DEPTHS:
                x = np.linspace(0.0, D, 2001)
                spent = float(np.trapezoid(law.loading(pair, x), x))
                gained = float(np.trapezoid(law.unloading(pair, x, D), x))
                F = float(law.loading(pair, D))
                left = float(sum(law.residual(pair, D)))
                numbers = (
                    E_s, E_f, s, f, D, D / critical_depth(pair), F / pair.E_reduced,
                    float(law.contact_radius(pair, D)), left / D,
                    2.0 * spent / D**2 / pair.E_reduced,
                    F / (D - left) / pair.E_reduced, (gained / spent) ** 0.5,
                )  # fmt: skip
                lines.append(",".join(f"{x:.6g}" for x in numbers))
    return "\n".join((*head, *lines)) + "\n"
