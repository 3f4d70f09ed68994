"""`dentscope reduce KIND FILE --into SET`: raw recordings to numbers with uncertainties.

The options of each kind are those of its module's `Options`, read when the command is asked for.
"""

from __future__ import annotations

import contextlib
import inspect
import types
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from .shared.groups import Commands, group
from .shared.places import folder_option

if typing.TYPE_CHECKING:
    from pydantic.fields import FieldInfo

    from ..reduce.kinds import Kind

_SETTABLE = (float, int, bool, str, Path)


class _Kinds(Commands):
    """The commands of the kinds, made from their options when they are asked for."""

    def list_commands(self, ctx: Any) -> list[str]:
        from ..reduce.kinds import all_kinds

        return list(all_kinds())

    def abouts(self, ctx: Any) -> dict[str, str]:
        """Kinds and what each gives, without loading any of them."""
        from ..reduce.kinds import all_kinds

        return all_kinds()

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        from ..reduce.kinds import all_kinds

        return _command(cmd_name) if cmd_name in all_kinds() else super().get_command(ctx, cmd_name)


app = group(
    "Raw recordings to numbers with uncertainties, and a picture to check them by.", cls=_Kinds
)

RawFiles = Annotated[
    list[Path], typer.Argument(metavar="FILE...", help="The raw recording, or several.")
]
Into = Annotated[
    Path | None, folder_option("Folder of a recording set, new or existing.", name="--into")
]
Out = Annotated[Path, folder_option("Without --into: folder for the numbers and the picture.")]


def _command(name: str) -> Any:
    """Return the command of a kind: FILE, the kind's options, the conditions of the trial."""
    from ..reduce.kinds import all_kinds, load_kind
    from ..reduce.row import Row

    kind = load_kind(name)

    def run(**given: Any) -> None:
        files, into, out = given.pop("files"), given.pop("into"), given.pop("out")
        row = {k: given.pop(k) for k in Row.model_fields}
        if len(files) == 1:
            _reduce(kind, files[0], into, out, _set(given), _set(row))
        else:
            _reduce_each(kind, files, into, out, _set(given), _set(row))

    # a reader of another package may have taken `Row` for its options
    fields = {**kind.options.model_fields, **Row.model_fields}
    keyword = inspect.Parameter.KEYWORD_ONLY
    parameters = [
        inspect.Parameter("files", keyword, annotation=RawFiles),
        inspect.Parameter("into", keyword, annotation=Into, default=None),
        *(_parameter(k, field) for k, field in fields.items()),
        inspect.Parameter("out", keyword, annotation=Out, default=Path("build/reduce")),
    ]
    run.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {p.name: p.annotation for p in parameters}
    about = all_kinds()[name]
    run.__doc__ = about[0].upper() + about[1:] + "."
    alone = group("")
    alone.command(name)(run)
    return typer.main.get_command(alone)


def _parameter(name: str, field: FieldInfo) -> inspect.Parameter:
    """Return the option of one field; the range is checked by the field itself, in one line."""
    plain, choices = _plain_type(field.annotation)
    words = (field.description or "", f"({', '.join(choices)})" if choices else "")
    option = typer.Option("--" + name.replace("_", "-"), help=" ".join(filter(None, words)))
    default = inspect.Parameter.empty if field.is_required() else field.default
    if field.is_required() or default is None:
        default = inspect.Parameter.empty if field.is_required() else None
        plain = plain if field.is_required() else typing.Optional[plain]  # noqa: UP045
    return inspect.Parameter(
        name, inspect.Parameter.KEYWORD_ONLY, annotation=Annotated[plain, option], default=default
    )


def _plain_type(annotation: Any) -> tuple[Any, tuple[str, ...]]:
    """Return the type that the command line shows, and the words it may take."""
    inner = [a for a in typing.get_args(annotation) if a is not types.NoneType]
    if typing.get_origin(annotation) is typing.Literal:
        return str, tuple(map(str, inner))
    for part in (annotation, *inner):
        if part in _SETTABLE:
            return part, ()
    raise TypeError(f"{annotation} cannot be an option")


def _set(given: dict[str, Any]) -> dict[str, Any]:
    """What the user said; the rest is left to the defaults."""
    return {k: v for k, v in given.items() if v is not None}


def _reduce_each(
    kind: Kind, files: list[Path], into: Path | None, out: Path, given: dict[str, Any],
    row: dict[str, Any],
) -> None:  # fmt: skip
    """Reduce several files; those that cannot be are told at the end and left out."""
    from rich.console import Console
    from rich.progress import track

    from ..core.errors import InputError, InputErrors
    from ..reduce.record import trial_name

    if row.get("trial"):
        raise InputError(
            f"given for {len(files)} files", key="--trial", source="command line",
            allowed="left out: each trial is named as its file",
        )  # fmt: skip
    names = [trial_name(file) for file in files]
    twice = next((name for name in names if names.count(name) > 1), "")
    if twice:
        raise InputError(
            f"two files are named {twice}", source="command line", key="FILE",
            allowed="files of different names: they name the trials",
        )  # fmt: skip
    left_out: list[InputError] = []
    failed = 0
    for file in track(files, "reducing", console=Console(stderr=True), transient=True):
        try:
            _reduce(kind, file, into, out, given, row)
        except InputErrors as several:  # the names of options are made from every mistake
            left_out, failed = [*left_out, *several.errors], failed + 1
    typer.echo(f"{len(files) - failed} of {len(files)} files reduced")
    if left_out:
        raise InputErrors(tuple(left_out))


def _reduce(
    kind: Kind, file: Path, into: Path | None, out: Path, given: dict[str, Any], row: dict[str, Any]
) -> None:
    from ..core.inputs.toml_input import parse_model
    from ..reduce.gates import Refused
    from ..reduce.into_set import store
    from ..reduce.record import trial_name, write_record
    from ..reduce.row import Row

    with _named_as_options():
        conditions = parse_model(row, Row, source="command line")
        try:
            reduced = kind.run(file, given, source="command line")
        except Refused as refused:
            if refused.draw is not None:
                name = f"{conditions.trial or trial_name(file)}-{kind.name}-refused.png"
                picture = (out if into is None else into / "reduced") / name
                refused.draw(picture)
                typer.echo(f"picture of what was refused: {picture}", err=True)
            raise
        if into is None:
            name = conditions.trial or trial_name(file)
            written = write_record(reduced, out, name, kind=kind.name, options=given)
            lines = []
        else:
            done = store(reduced, into, conditions, kind=kind.name, options=given)
            written = (done.record, done.picture)
            lines = [f"  rows of {into}: {', '.join(done.trials)}"] if done.trials else []
            lines += [f"note: {note}" for note in done.notes]
    _print(file, reduced)
    for line in lines:
        typer.echo(line)
    typer.echo(f"written: {written[0]}, {written[1]}")


@contextlib.contextmanager
def _named_as_options() -> Iterator[None]:
    """Tell mistakes in options under the names that they have on the command line."""
    from ..core.errors import InputError, InputErrors

    try:
        yield
    except InputError as error:
        several = error.errors if isinstance(error, InputErrors) else (error,)
        raise InputErrors(
            tuple(
                InputError(
                    e.message,
                    source=e.source or "command line",
                    key="--" + e.key.replace("_", "-") if e.source in ("", "command line") and e.key
                    else e.key,
                    allowed=e.allowed,
                )
                for e in several
            )
        ) from None  # fmt: skip


def _print(file: Path, reduced: Any) -> None:
    typer.echo(f"{file}:")
    for name, value in reduced.values.items():
        typer.echo(f"  {name} = {value}")
    for note in reduced.notes:
        typer.echo(f"  note: {note}")
