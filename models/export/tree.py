"""The fitted law's routine as one list of assignments, from its inputs to its outputs.

The functions of `closed_form` are straight lines of assignments; here they are set one after the
other, each call replaced by the lines of what it calls. A field of a tuple becomes a name.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Mapping, Sequence

from .. import closed_form
from ..correction import CHANNELS, MOST, PairCorrection

INPUTS = ("E_s", "nu_s", "Sy_s", "E_f", "nu_f", "Sy_f", "R", "depth")
OUTPUTS = ("force", "contact_radius", "share", "residual_s", "residual_f", "exponent")
RESULTS = tuple(f"out_{name}" for name in OUTPUTS)
"""The outputs as the lines name them."""

_CONSTANTS = {name: getattr(closed_form, name) for name in ("PI", "TINY", "SHARPEST")}
_FROM_INPUTS = """
k_s = (1.0 - nu_s * nu_s) / E_s
k_f = (1.0 - nu_f * nu_f) / E_f
q_s = 1.0 / Sy_s
q_f = 1.0 / Sy_f
D = depth / R
"""
_TO_OUTPUTS = """
kept = max(left, 0.0)
out_force = F * R * R / (k_s + k_f)
out_contact_radius = a * R
out_share = share
out_residual_s = phi * kept * depth
out_residual_f = (1.0 - phi) * kept * depth
out_exponent = N
"""
_OPEN = """
out_force = 0.0
out_contact_radius = 0.0
out_share = k_s / (k_s + k_f)
out_residual_s = 0.0
out_residual_f = 0.0
out_exponent = 1.5
"""

Lines = list[tuple[str, ast.expr]]
"""Assignments: target and value."""


def before() -> Lines:
    """What comes first: the bodies' numbers and D from the inputs."""
    return _parsed(_FROM_INPUTS)


def when_open() -> Lines:
    """The outputs of an open contact, D of zero or less."""
    return _parsed(_OPEN)


def when_closed(correction: PairCorrection | None) -> Lines:
    """The closed form, and the outputs from what it gives."""
    lines: Lines = []
    defined = {*INPUTS, *(target for target, _ in before())}
    own: dict[str, str] = {}
    _unroll("of_pair", closed_form.PairNumbers._fields, lines, defined, own)
    if correction is not None:
        _unroll("groups_of", closed_form.Groups._fields, lines, defined, own)
        lines += _corrected(correction)
        own = {name: f"own_{name}" for name in CHANNELS}
    _unroll("contact", closed_form.Contact._fields, lines, defined, own)
    used = [(name, value) for name, value in lines if ast.unparse(value) != name]
    return [*used, *_parsed(_TO_OUTPUTS)]


def _corrected(correction: PairCorrection) -> Lines:
    """What `Correction.of` does to the pair's numbers, bump by bump and channel by channel."""
    text = []
    for number, centre in enumerate(correction.centres.tolist()):
        places = zip(closed_form.Groups._fields, centre, correction.reaches.tolist(), strict=True)
        away = " - ".join(
            f"({name}{-at:+}) * ({name}{-at:+}) / {2.0 * reach * reach!r}"
            for name, at, reach in places
        )
        text.append(f"bump_{number} = exp(-{away})")
    for k, (name, channel) in enumerate(CHANNELS.items()):
        weights = enumerate(correction.weights[:, k].tolist())
        text.append(
            f"shift_{name} = " + "".join(f"{w:+} * bump_{n}" for n, w in weights).lstrip("+")
        )
        bent = (
            f"{channel.unit!r} * shift_{name} "
            f"/ sqrt(1.0 + shift_{name} * shift_{name} / {MOST * MOST!r})"
        )
        text.append(
            f"own_{name} = " + (f"{name} * exp({bent})" if channel.factor else f"{name} + {bent}")
        )
    return _parsed("\n".join(text))


def _parsed(text: str) -> Lines:
    found: Lines = []
    for node in ast.parse(text).body:
        assert isinstance(node, ast.Assign)
        found.append((ast.unparse(node.targets[0]), node.value))
    return found


def _unroll(
    function: str,
    results: tuple[str, ...],
    lines: Lines,
    defined: set[str],
    own: Mapping[str, str],
    arguments: Sequence[str] = (),
) -> None:
    """Append the lines of a function of `closed_form`, its results named `results`.

    A field that is in `own` is read under the name given there, a parameter under that of the
    argument, if there are any.
    """
    (tree,) = ast.parse(inspect.getsource(getattr(closed_form, function))).body
    assert isinstance(tree, ast.FunctionDef)
    flat = _Flat(own)
    flat.renamed.update(zip((a.arg for a in tree.args.args), arguments, strict=False))
    for node in tree.body[1:]:  # the first is the docstring
        assert isinstance(node, ast.Assign | ast.Return)
        assert node.value is not None
        value = flat.visit(node.value)
        called = _called(value)
        if isinstance(node, ast.Return):
            values = value.args if called in closed_form.TUPLES else [value]
            lines += zip(results, values, strict=True)
            defined.update(results)
            continue
        names = ast.unparse(node.targets[0]).strip("()").split(", ")
        if called is not None:
            given = [ast.unparse(argument) for argument in value.args]
            flat.renamed |= {n: _unused(n, defined) for n in names if n in defined}
            named = tuple(flat.renamed.get(n, n) for n in names)
            _unroll(called, named, lines, defined, own, given)
            continue
        (name,) = names
        new = _unused(name, defined)
        flat.renamed[name] = new
        lines.append((new, value))


def _unused(name: str, defined: set[str]) -> str:
    number, new = 1, name
    while new in defined:
        number += 1
        new = f"{name}_{number}"
    defined.add(new)
    return new


def _called(value: ast.expr) -> str | None:
    """Name of the function or tuple of `closed_form` that is called."""
    if not isinstance(value, ast.Call) or not isinstance(value.func, ast.Name):
        return None
    name = value.func.id
    return name if name in vars(closed_form) and name not in closed_form.ELEMENTARY else None


class _Flat(ast.NodeTransformer):
    """Fields and renamed locals become names, constants numbers."""

    def __init__(self, own: Mapping[str, str]) -> None:
        self.renamed: dict[str, str] = {}
        self.own = own

    def visit_Attribute(self, node: ast.Attribute) -> ast.Name:
        assert isinstance(node.value, ast.Name)
        coefficient = node.value.id == "co"
        return ast.Name(f"coef_{node.attr}" if coefficient else self.own.get(node.attr, node.attr))

    def visit_Name(self, node: ast.Name) -> ast.expr:
        if node.id in _CONSTANTS:
            return ast.Constant(_CONSTANTS[node.id])
        return ast.Name(self.renamed.get(node.id, node.id))
