"""Translation of the closed form's Python text into expressions of other languages.

The functions of `closed_form` are straight lines of assignments. They are unrolled here into one
list of statements, from the two materials to the answer, and each expression is written in the
syntax of a language.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from . import closed_form

_CONSTANTS = {"PI": closed_form.PI, "TINY": closed_form.TINY}
_FUNCTIONS = ("exp", "log", "sqrt")


@dataclass(frozen=True)
class Statement:
    """One assignment `target = value`."""

    target: str
    value: ast.expr


@dataclass(frozen=True)
class Syntax:
    """How a language writes an expression.

    Parameters
    ----------
    power
        Text of a power from the texts of base and exponent.
    number
        Text of a number.
    name
        Text of a name.
    times, over
        Operators of multiplication and division.
    function
        Text of a function's name.
    """

    power: Callable[[str, str], str]
    number: Callable[[float], str]
    name: Callable[[str], str]
    times: str = " * "
    over: str = " / "
    function: Callable[[str], str] = str


def statements() -> list[Statement]:
    """The whole form as assignments, from k_i, nu_i, q_i and D to what `contact` returns."""
    defined = {"D", *closed_form.COEFFICIENTS, *closed_form.arguments_of(closed_form.of_pair)}
    lines: list[Statement] = []
    _unroll("of_pair", closed_form.PAIR_NUMBERS, lines, defined)
    _unroll("contact", RESULTS, lines, defined)
    return [line for line in lines if not _is_itself(line)]


RESULTS = ("F", "a", "share", "left", "phi", "N")
"""Names of what `contact` returns, in this order."""


def _is_itself(line: Statement) -> bool:
    return isinstance(line.value, ast.Name) and line.value.id == line.target


def _unroll(
    function: str, targets: tuple[str, ...], lines: list[Statement], defined: set[str]
) -> None:
    """Append the statements of a function of `closed_form`, its results named `targets`."""
    body = _body(function)
    renamed: dict[str, str] = {}
    for node in body:
        if isinstance(node, ast.Assign):
            (target,) = node.targets
            assert isinstance(target, ast.Name)
            value = _Rename(renamed).visit(node.value)
            name = target.id
            call = _call_of(value)
            if call is not None:
                _unroll(call, (name,), lines, defined)
                continue
            # a local name that something before has used gets another
            while name in defined:
                name += "_"
            if name != target.id:
                renamed[target.id] = name
            defined.add(name)
            lines.append(Statement(name, value))
        elif isinstance(node, ast.Return):
            assert node.value is not None
            result = _Rename(renamed).visit(node.value)
            values = result.elts if isinstance(result, ast.Tuple) else [result]
            for name, value in zip(targets, values, strict=True):
                defined.add(name)
                lines.append(Statement(name, value))


def _call_of(value: ast.expr) -> str | None:
    """Name of the closed form's function that is called, whose arguments keep their names."""
    if not isinstance(value, ast.Call) or not isinstance(value.func, ast.Name):
        return None
    if value.func.id in _FUNCTIONS:
        return None
    given = tuple(ast.unparse(argument) for argument in value.args)
    assert given == closed_form.arguments_of(getattr(closed_form, value.func.id)), given
    return value.func.id


def _body(function: str) -> list[ast.stmt]:
    text = textwrap.dedent(inspect.getsource(getattr(closed_form, function)))
    (tree,) = ast.parse(text).body
    assert isinstance(tree, ast.FunctionDef)
    return [node for node in tree.body if not isinstance(node, ast.Expr)]


class _Rename(ast.NodeTransformer):
    def __init__(self, names: Mapping[str, str]) -> None:
        self.names = names

    def visit_Name(self, node: ast.Name) -> ast.Name:
        return ast.Name(self.names.get(node.id, node.id), node.ctx)


def expression(node: ast.expr, syntax: Syntax) -> str:
    """Return an expression in a language, each part that needs it in brackets."""
    return _text(node, syntax)[0]


_ATOM, _PRODUCT, _SUM = 3, 2, 1


def _text(node: ast.expr, syntax: Syntax) -> tuple[str, int]:
    if isinstance(node, ast.Constant):
        return syntax.number(float(node.value)), _ATOM  # type: ignore[arg-type]
    if isinstance(node, ast.Name):
        if node.id in _CONSTANTS:
            return syntax.number(_CONSTANTS[node.id]), _ATOM
        return syntax.name(node.id), _ATOM
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return f"-{_bracketed(node.operand, syntax, _ATOM)}", _SUM
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        (argument,) = node.args
        return f"{syntax.function(node.func.id)}({expression(argument, syntax)})", _ATOM
    assert isinstance(node, ast.BinOp), ast.dump(node)
    return _binary(node, syntax)


def _binary(node: ast.BinOp, syntax: Syntax) -> tuple[str, int]:
    sides: tuple[Any, Any] = (node.left, node.right)
    if isinstance(node.op, ast.Pow):
        base, exponent = (_bracketed(side, syntax, _ATOM) for side in sides)
        return syntax.power(base, exponent), _ATOM
    if isinstance(node.op, ast.Mult | ast.Div):
        sign = syntax.times if isinstance(node.op, ast.Mult) else syntax.over
        left, right = _bracketed(sides[0], syntax, _PRODUCT), _bracketed(sides[1], syntax, _ATOM)
        return f"{left}{sign}{right}", _PRODUCT
    sign = " + " if isinstance(node.op, ast.Add) else " - "
    left, right = expression(sides[0], syntax), _bracketed(sides[1], syntax, _PRODUCT)
    return f"{left}{sign}{right}", _SUM


def _bracketed(node: ast.expr, syntax: Syntax, least: int) -> str:
    text, rank = _text(node, syntax)
    return text if rank >= least else f"({text})"
