"""`dentscope laws`: the published contact laws listed, shown and compared on a user's own pair."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import InputError
from ..core.output import csv_text, write_figure, write_file
from .shared.groups import Commands, group
from .shared.places import folder_option
from .shared.terminal import entry, new_console, say, show_table, wrapped

if TYPE_CHECKING:
    from ..models.base import ContactLaw

_YIELDS = {"flattening": "sphere", "indentation": "flat", "either": "either"}


class _Laws(Commands):
    alone = ("list",)


app = group("Contact laws, ours and published: list, show, compare. Alone: the list.", cls=_Laws)


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
            # a law that is known and not offered has its reason in the message
            told = f"no law {error.message}" if error.allowed else error.message
            raise InputError(told, source=source, key=key, allowed=error.allowed) from None
    return found


@app.command("list")
def list_laws() -> None:
    """Every law: for which body, and whether its equations could be read."""
    from ..core.inputs.added import LAWS as GROUP
    from ..core.inputs.added import names_added
    from ..models import LAWS, UNAVAILABLE

    head = ["law", "yields", "equations"]
    rows = [[law.name, _YIELDS[law.regime], law.standing.told] for law in LAWS.values()]
    show_table(new_console(), head, rows, align="left")
    for text in (
        "verified second hand: read in a text or code, other than the thesis, that names the "
        "paper. unverified: they rest on the thesis, on memory, on limits and continuity.",
        "Any two can be joined, LOADING+UNLOADING: kogut-etsion+ghaednia.",
        f"Not offered: {', '.join(UNAVAILABLE)}.",
        f"Of other packages: {', '.join(names_added(GROUP)) or 'none'}.",
        "Sources, ranges and reasons: dentscope laws show NAME",
    ):
        typer.echo(wrapped(text))


@app.command()
def show(law: Annotated[str, typer.Argument(help="A name of `dentscope laws list`.")]) -> None:
    """One law: source, equations, range, what was read, and what it breaks."""
    [chosen] = laws_named([law], key="LAW")
    lines = {
        "law": chosen.name, "law of": chosen.title, "source": chosen.source,
        "equations": chosen.equations, "made for": chosen.regime,
        "range": chosen.domain.note or "not stated", "standing": chosen.standing.told,
        "read": chosen.read, "described in": _described_in(chosen),
    }  # fmt: skip
    for key, text in lines.items():
        if text:
            entry(key, text)
    for text, size in chosen.breaks:
        entry("breaks", f"{text}: {size:g} %")


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
    from ..core.inputs.toml_input import read_toml
    from ..core.inputs.unused_keys import unused_keys
    from ..models import LAWS
    from ..start.comparison import USED, LawRow, compared

    laws = laws_named(law) if law else list(LAWS.values())
    found = compared(pair, laws, last=content.load.max_delta_over_R)
    table_file = write_file(out / "curves.csv", csv_text(found.rows, header=LawRow._fields))
    picture = write_figure(found.plot(), out / "curves.png", dpi=130)

    console = new_console()
    console.print(found.finding)
    show_table(console, *found.table())
    unused = unused_keys(read_toml(file), USED)
    if unused:
        say(f"not in these laws: {', '.join(unused)}; `dentscope case` takes them")
    console.print(f"written: {table_file}\nwritten: {picture}", soft_wrap=True)


def _described_in(law: ContactLaw) -> str:
    kernels = getattr(law, "own", None)
    place = kernels.residual.py_func if kernels else type(law)
    return str(place.__module__).removeprefix("dentscope.")
