"""`dentscope laws`: the published contact laws listed, shown and compared on a user's own pair."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import InputError
from ..core.output import csv_text, write_figure, write_file
from .groups import Commands, group
from .places import folder_option
from .terminal import console as new_console
from .terminal import entry, show_table

if TYPE_CHECKING:
    from ..core.material import Pair
    from ..models.base import ContactLaw


class _Laws(Commands):
    """Alone: the list."""

    alone = ("list",)


app = group("Contact laws, ours and published: list, show, compare. Alone: the list.", cls=_Laws)

COLUMNS = (
    "law",
    "delta_over_R",
    "delta_m",
    "force_N",
    "contact_radius_m",
    "mean_pressure_over_Symin",
    "residual_sphere_m",
    "residual_flat_m",
)
_POINTS = 120


def laws_named(names: list[str], *, source: str = "command line", key: str = "--law") -> Any:
    """Return the laws of these names or files; an unknown one is an error that lists the known."""
    from ..models import law_named

    found = []
    for name in names:
        try:
            found.append(law_named(name))
        except InputError as error:
            if error.source:
                raise
            raise InputError(
                f"no law {name!r}", source=source, key=key, allowed=error.allowed
            ) from None
    return found


@app.command("list")
def list_laws() -> None:
    """Every law: what it is for, and from where its equations were read."""
    from ..models import LAWS, RATE_MODELS, UNAVAILABLE

    for law in LAWS.values():
        bodies = "both bodies" if law.regime == "either" else law.regime
        entry(law.name, f"{law.title}. For {bodies}; {law.standing.told}: {law.read}")
    typer.echo(
        "\nverified second hand: read in a text or code, other than the thesis, that names the "
        "paper. unverified: they rest on the thesis, on limits and continuity.\n"
        "Any two can be joined, LOADING+UNLOADING: kogut-etsion+ghaednia.\n"
        "\nModels of depth and rate that leave no dent; shown, and not computed with:"
    )
    for name, model in RATE_MODELS.items():
        entry(name, f"{model.formula}; {model.objection}")
    typer.echo("\nNot offered, and why:")
    for name, reason in UNAVAILABLE.items():
        entry(name, reason)


@app.command()
def show(law: Annotated[str, typer.Argument(help="A name of `dentscope laws list`.")]) -> None:
    """One law: source, equations, range, what was read, and what it breaks."""
    from ..models import RATE_MODELS, law_named

    if law in RATE_MODELS:
        _show_rate_model(law)
        return
    chosen = law_named(law)
    lines = {
        "law": chosen.name,
        "authors": chosen.title,
        "source": chosen.source,
        "equations": chosen.equations,
        "made for": chosen.regime,
        "range": chosen.domain.note or "not stated",
        "standing": chosen.standing.told,
        "read": chosen.read,
        "described in": _described_in(chosen),
    }
    _echo([*lines.items(), *(("breaks", f"{text}: {size:g} %") for text, size in chosen.breaks)])


def _show_rate_model(name: str) -> None:
    """One model of depth and rate, and for Kelvin and Voigt's an impact worked out."""
    from ..models import RATE_MODELS
    from ..models.published.viscous import paradox

    model = RATE_MODELS[name]
    lines = [
        ("model", name), ("authors", model.title), ("source", model.source),
        ("force", model.formula), ("objection", model.objection),
    ]  # fmt: skip
    if name == "kelvin-voigt":
        told = paradox(mass=0.05, stiffness=2e6, damping=120.0, speed=1.3)
        example = (
            f"0.05 kg at 1.3 m/s on 2 MN/m with 120 N s/m: {told.force_at_touch:.0f} N at first "
            f"touch, {told.pull_at_return:.1f} N on return; let go where the force vanishes, "
            f"{told.depth_at_zero_force * 1e6:.0f} um stay"
        )
        lines.append(("example", example))
    _echo([*lines, ("described in", "models.published.viscous")])


def _echo(lines: Iterable[tuple[str, str]]) -> None:
    for key, text in lines:
        if text:
            entry(key, text)


@app.command()
def compare(
    file: Annotated[Path, typer.Argument(help="CASE.toml, as for `dentscope case`.")],
    law: Annotated[
        list[str] | None, typer.Option(help="A law; may be repeated. Default: all.")
    ] = None,
    out: Annotated[Path, folder_option("Folder for table and picture.")] = Path("build/laws"),
) -> None:
    """Curves of the laws for one pair, and which of them to use."""
    from ..start.case_file import read_pair

    content, pair = read_pair(file)
    from ..models import LAWS, law_named
    from ..models.choose import demand, objection, recommended

    last = content.load.max_delta_over_R
    laws = [law_named(name) for name in law] if law else list(LAWS.values())
    rows = curves(pair, laws, last=last)
    table_file, picture = out / "curves.csv", out / "curves.png"
    write_file(table_file, csv_text(rows, header=COLUMNS))
    draw(pair, laws, rows, picture)

    need = demand(pair, last * pair.R)
    console = new_console()
    best = recommended(LAWS, need)
    console.print(f"use: {', '.join(best) or 'none of these laws holds here'}")
    console.print(
        f"at Delta/R = {last:g}: {need.w:.4g} times the depth of first yield; regime: {need.regime}"
    )
    objections = {one.name: objection(one, need) for one in laws}
    found = [[r for r in rows if r[0] == one.name][-1] for one in laws]
    order = {name: k for k, name in enumerate(best)}
    found.sort(key=lambda row: (order.get(row[0], len(order)), bool(objections[row[0]])))
    show_table(
        console,
        ("law", "F [N]", "a [mm]", "p/Sy_min", "left [um]", "may be used"),
        [
            (
                row[0], f"{row[3]:.4g}", f"{row[4] * 1e3:.4g}", f"{row[5]:.3f}",
                f"{(row[6] + row[7]) * 1e6:.4g}", "no" if objections[row[0]] else "yes",
            )
            for row in found
        ],
    )  # fmt: skip
    for reason in dict.fromkeys(filter(None, objections.values())):
        names = ", ".join(name for name, told in objections.items() if told == reason)
        console.print(f"no: {reason}: {names}")
    console.print(f"written: {table_file}\nwritten: {picture}", soft_wrap=True)


def _described_in(law: ContactLaw) -> str:
    import sys

    kernels = getattr(law, "own", None)
    if kernels is None:
        return type(law).__module__.split(".", 1)[-1]
    place = sys.modules[kernels.residual.py_func.__module__]
    return str(place.__name__).split(".", 1)[-1]


def curves(pair: Pair, laws: list[ContactLaw], *, last: float) -> list[tuple[Any, ...]]:
    """Rows of `COLUMNS` for every law, from below first yield to Delta/R = `last`."""
    import numpy as np

    from ..models import critical_depth

    deepest = last * pair.R
    depth = np.geomspace(min(0.3 * critical_depth(pair), 1e-2 * deepest), deepest, _POINTS)
    scale = pair.Sy_min if pair.Sy_min < float("inf") else pair.E_reduced
    rows: list[tuple[Any, ...]] = []
    for law in laws:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the table says what is out of range
            force, a = law.loading(pair, depth), law.contact_radius(pair, depth)
            pressure = law.hardness(pair, depth) / scale
            sphere, flat = law.residual(pair, depth)
        if not np.all(np.isfinite(force)):
            raise InputError(f"{law.name} has no finite force for this pair", key="law")
        columns = (depth / pair.R, depth, force, a, pressure, sphere, flat)
        rows += [(law.name, *map(float, row)) for row in zip(*columns, strict=True)]
    return rows


def draw(pair: Pair, laws: list[ContactLaw], rows: list[tuple[Any, ...]], picture: Path) -> Path:
    """Draw force over Hertz's, mean pressure, contact radius and residual depth over Delta/R."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np

    figure, axes = plt.subplots(2, 2, figsize=(11, 8), layout="constrained")
    colours = plt.get_cmap("turbo")(np.linspace(0.05, 0.95, len(laws)))
    styles = ("-", "--", "-.", ":")
    stiffness = 4.0 / 3.0 * pair.E_reduced * np.sqrt(pair.R)
    for k, law in enumerate(laws):
        x, d, force, a, p, s, f = np.array([r[1:] for r in rows if r[0] == law.name]).T
        look = {"color": colours[k], "linestyle": styles[k % 4], "linewidth": 1.4}
        axes[0, 0].semilogx(x, force / (stiffness * d**1.5), label=law.name, **look)
        axes[0, 1].semilogx(x, p, **look)
        axes[1, 0].loglog(x, a / pair.R, **look)
        axes[1, 1].semilogx(x, (s + f) / d, **look)
    for axis, label in zip(
        axes.flat,
        (
            "force / Hertz's force",
            "mean pressure / Sy_min",
            "contact radius / R",
            "residual / largest depth",
        ),
        strict=True,
    ):
        axis.set_xlabel("Delta / R")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    axes[0, 0].set_ylim(0.0, 2.0)
    axes[0, 1].set_ylim(0.0, 5.0)
    figure.legend(loc="outside right center", fontsize=8)
    write_figure(figure, picture, dpi=130)
    plt.close(figure)
    return picture
