"""A closed form as source code that needs nothing else, in six languages.

Python, C, Fortran, MATLAB or Octave, Modelica, JavaScript.

Each file holds the coefficients and one routine from the two materials, the radius and the approach
to force, contact radius, sphere's share, permanent depths and the exponent of the unloading. They
are printed from the same lines that the law itself runs (`tree`).
"""

from __future__ import annotations

import ast
import textwrap
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from ...core.output import write_file
from ..closed_form import COEFFICIENTS
from ..fitted import ClosedForm
from .lammps import STYLE, lammps_header, lammps_source
from .tree import INPUTS, OUTPUTS, RESULTS, Lines, before, when_closed, when_open

NAME = "dentscope_contact"

_ABOUT = (
    "Elastic-plastic contact of a sphere (s) and a flat (f) on first loading; law of dentscope.",
    "E Young's modulus, nu Poisson's ratio, Sy yield strength, R radius, depth = approach; SI.",
    "A rigid body: infinite E and Sy. An elastic body: infinite Sy.",
    "Results: force [N], contact radius [m], sphere's share of the approach, permanent depth of",
    "sphere and flat after unloading from this depth [m], exponent N of the unloading curve",
    "F/F_m = ((depth - residual)/(depth_m - residual))^N with residual = residual_s + residual_f.",
)


@dataclass(frozen=True)
class Language:
    """How a language writes an assignment; by default as Python does.

    - `line`: format of an assignment, with the fields `target` and `value`.
    - `number`, `name`: text of a number and of a name.
    - `functions`: names of functions that differ from Python's; one for `pow` replaces the
      operator.
    - `operators`: operators that differ, each with its blanks.
    """

    line: str = "{target} = {value}"
    number: Callable[[float], str] = repr
    name: Callable[[str], str] = str
    functions: Mapping[str, str] = field(default_factory=dict)
    operators: Mapping[str, str] = field(default_factory=dict)

    def lines(self, lines: Lines, *, indent: int = 4) -> str:
        """Return assignments as text."""
        texts = (
            self.line.format(target=self.name(name), value=self.expression(value))
            for name, value in lines
        )
        return textwrap.indent("\n".join(texts), indent * " ")

    def expression(self, value: ast.expr) -> str:
        """Return an expression as text: Python's own printer sets the brackets."""
        text = ast.unparse(_Written(self).visit(value))
        for ours, theirs in self.operators.items():
            text = text.replace(ours, theirs)
        return text


class _Written(ast.NodeTransformer):
    """A copy of an expression with names, numbers and powers of a language."""

    def __init__(self, language: Language) -> None:
        self.language = language

    def visit_Constant(self, node: ast.Constant) -> ast.Name:
        assert isinstance(node.value, float)
        return ast.Name(self.language.number(node.value))

    def visit_Name(self, node: ast.Name) -> ast.Name:
        return ast.Name(self.language.name(node.id))

    def visit_Call(self, node: ast.Call) -> ast.Call:
        assert isinstance(node.func, ast.Name)
        function = self.language.functions.get(node.func.id, node.func.id)
        return ast.Call(ast.Name(function), [self.visit(x) for x in node.args], [])

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.UnaryOp:
        return ast.UnaryOp(node.op, self.visit(node.operand))

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        left, right = self.visit(node.left), self.visit(node.right)
        if isinstance(node.op, ast.Pow) and "pow" in self.language.functions:
            return ast.Call(ast.Name(self.language.functions["pow"]), [left, right], [])
        return ast.BinOp(left, node.op, right)


def write_sources(law: ClosedForm, folder: Path) -> list[Path]:
    """Write the law in every language and for LAMMPS; the folder is made if needed."""
    texts = {
        f"{NAME}.py": python_source(law),
        f"{NAME}.h": c_header(law),
        f"{NAME}.c": c_source(law),
        f"{NAME}.f90": fortran_source(law),
        f"{NAME}.m": matlab_source(law),
        f"{NAME}.mo": modelica_source(law),
        f"{NAME}.js": javascript_source(law),
        f"{STYLE}.h": lammps_header(),
        f"{STYLE}.cpp": lammps_source(),
    }
    return [write_file(folder / name, text.encode("ascii")) for name, text in texts.items()]


def _about(law: ClosedForm, mark: str) -> str:
    domain = f"Fitted over: {law.domain.note}." if law.domain.note else "Domain not stated."
    return textwrap.indent("\n".join((*_ABOUT, *textwrap.wrap(domain, 94))), mark)


def _coefficients(law: ClosedForm) -> Lines:
    return [(f"coef_{n}", ast.Constant(float(law.coefficients[n]))) for n in COEFFICIENTS]


def python_source(law: ClosedForm) -> str:
    """The law as a Python module that imports nothing but math."""
    python = Language()
    return f'''# ruff: noqa
# fmt: off
"""Contact of a sphere and a flat.

{_about(law, "")}
"""

from math import exp, log, sqrt

{python.lines(_coefficients(law), indent=0)}


def contact({", ".join(INPUTS)}):
    """Return {", ".join(OUTPUTS)}."""
{python.lines(before())}
    if D <= 0.0:
{python.lines(when_open(), indent=8)}
    else:
{python.lines(when_closed(law.correction), indent=8)}
    return {", ".join(RESULTS)}
'''


def c_header(law: ClosedForm) -> str:
    """Declaration of the C function."""
    return f"""/*
{_about(law, " * ")}
 */
#ifndef DENTSCOPE_CONTACT_H
#define DENTSCOPE_CONTACT_H

typedef struct {{
    double {", ".join(OUTPUTS)};
}} dentscope_result;

#ifdef __cplusplus
extern "C" {{
#endif
dentscope_result {NAME}({_c_inputs()});

/* What a contact keeps of its deepest approach; all 0 at the touch. */
typedef struct {{
    double depth, force, residual, exponent;
}} dentscope_history;

/* Normal force [N] in a time step: on loading the law, on the way back and again up to the deepest
   approach F_m ((depth - residual)/(depth_m - residual))^N. */
double dentscope_force({_c_inputs()}, dentscope_history *history);
#ifdef __cplusplus
}}
#endif

#endif
"""


def c_source(law: ClosedForm) -> str:
    """The law as C99 that needs nothing but the mathematical library."""
    local = Language("const double {target} = {value};", functions={"pow": "pow", "max": "fmax"})
    return f"""/* See {NAME}.h */
#include "{NAME}.h"
#include <math.h>

{replace(local, line="static " + local.line).lines(_coefficients(law), indent=0)}

dentscope_result {NAME}({_c_inputs()})
{{
{local.lines(before())}
    if (D <= 0.0) {{
{local.lines(when_open(), indent=8)}
        const dentscope_result result = {{{", ".join(RESULTS)}}};
        return result;
    }}
{local.lines(when_closed(law.correction))}
    const dentscope_result result = {{{", ".join(RESULTS)}}};
    return result;
}}

double dentscope_force({_c_inputs()}, dentscope_history *history)
{{
    if (depth >= history->depth) {{
        const dentscope_result r = {NAME}({", ".join(INPUTS)});
        history->depth = depth;
        history->force = r.force;
        history->residual = r.residual_s + r.residual_f;
        history->exponent = r.exponent;
        return r.force;
    }}
    if (depth <= history->residual)
        return 0.0;
    const double share = (depth - history->residual) / (history->depth - history->residual);
    return history->force * pow(share, history->exponent);
}}
"""


def _c_inputs() -> str:
    return ", ".join(f"double {name}" for name in INPUTS)


def _fortran_name(name: str) -> str:
    """Fortran does not tell capitals from small letters: a name with capitals gets a prefix."""
    if name in INPUTS:
        return f"in_{name.lower()}"
    return name if name == name.lower() else f"cap_{name.lower()}"


def _continued(line: str) -> str:
    """Break a long line of Fortran, but for comments."""
    if line.startswith("!"):
        return line
    return " &\n".join(textwrap.wrap(line, 100, subsequent_indent=8 * " "))


def fortran_source(law: ClosedForm) -> str:
    """The law as an elemental subroutine of a Fortran 2008 module."""
    fortran = Language(number=lambda x: f"{x!r}_dp", name=_fortran_name)
    constants = replace(fortran, line="real(dp), parameter :: {target} = {value}")
    first, last = before(), when_closed(law.correction)
    inputs = [_fortran_name(name) for name in INPUTS]
    local = sorted({_fortran_name(name) for name, _ in (*first, *last)} - set(RESULTS))
    text = f"""{_about(law, "! ")}
module {NAME}_law
  implicit none
  private
  public :: {NAME}
  integer, parameter :: dp = selected_real_kind(15, 307)
{constants.lines(_coefficients(law), indent=2)}
contains

  elemental subroutine {NAME}({", ".join([*inputs, *RESULTS])})
    real(dp), intent(in) :: {", ".join(inputs)}
    real(dp), intent(out) :: {", ".join(RESULTS)}
    real(dp) :: {", ".join(local)}
{fortran.lines(first)}
    if ({_fortran_name("D")} <= 0.0_dp) then
{fortran.lines(when_open(), indent=6)}
      return
    end if
{fortran.lines(last)}
  end subroutine {NAME}

end module {NAME}_law
"""
    return "\n".join(map(_continued, text.split("\n")))


def matlab_source(law: ClosedForm) -> str:
    """The law as a MATLAB or Octave function; any input may be an array."""
    matlab = Language(
        "{target} = {value};", operators={" ** ": " .^ ", " * ": " .* ", " / ": " ./ "}
    )
    by_mask = "\n".join(
        f"  {name} = {name} .* closed + ({matlab.expression(value)}) .* ~closed;"
        for name, value in when_open()
    )
    return f"""function [{", ".join(RESULTS)}] = {NAME}({", ".join(INPUTS)})
{_about(law, "% ")}
{matlab.lines(_coefficients(law), indent=2)}
{matlab.lines(before(), indent=2)}
  closed = D > 0;
  D = max(D, 1e-100);
{matlab.lines(when_closed(law.correction), indent=2)}
{by_mask}
end
"""


def modelica_source(law: ClosedForm) -> str:
    """The law as a Modelica function; a body can't be rigid there, whose modulus is infinite."""
    modelica = Language("{target} := {value};", operators={" ** ": " ^ "})
    first, last = before(), when_closed(law.correction)
    coefficients = _coefficients(law)
    local = sorted({name for name, _ in (*coefficients, *first, *last)} - set(RESULTS))
    return f"""function {NAME}
{_about(law, "  // ")}
{textwrap.indent(chr(10).join(f"input Real {name};" for name in INPUTS), "  ")}
{textwrap.indent(chr(10).join(f"output Real {name};" for name in RESULTS), "  ")}
protected
{textwrap.indent(chr(10).join(f"Real {name};" for name in local), "  ")}
algorithm
{modelica.lines(coefficients, indent=2)}
{modelica.lines(first, indent=2)}
  if D <= 0.0 then
{modelica.lines(when_open())}
    return;
  end if;
{modelica.lines(last, indent=2)}
end {NAME};
"""


def javascript_source(law: ClosedForm) -> str:
    """The law as a JavaScript function, for a script of a page or for `require`."""
    javascript = Language(
        "const {target} = {value};",
        functions={"pow": "Math.pow", **{f: f"Math.{f}" for f in ("exp", "log", "sqrt", "max")}},
    )
    result = ", ".join(f"{name}: out_{name}" for name in OUTPUTS)
    return f"""/*
{_about(law, " * ")}
 */
const {NAME} = (() => {{
  "use strict";
{javascript.lines(_coefficients(law), indent=2)}

  return ({", ".join(INPUTS)}) => {{
{javascript.lines(before())}
    if (!(D > 0.0)) {{
{javascript.lines(when_open(), indent=6)}
      return {{ {result} }};
    }}
{javascript.lines(when_closed(law.correction))}
    return {{ {result} }};
  }};
}})();

if (typeof module !== "undefined") module.exports = {NAME};
"""
