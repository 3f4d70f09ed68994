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

from ..core.errors import InputError, InputErrors
from .shared.groups import Commands, group
from .shared.places import folder_option, misused

if typing.TYPE_CHECKING:
    from pydantic.fields import FieldInfo

    from ..reduce.kinds import Kind
    from .shared.batch import Job

_SETTABLE = (float, int, bool, str, Path)


class _Kinds(Commands):
    """The commands of the kinds, made from their options when they are asked for."""

    def list_commands(self, ctx: Any) -> list[str]:
        from ..reduce.kinds import kind_names

        return list(kind_names())

    def abouts(self, ctx: Any) -> dict[str, str]:
        """Kinds and what each gives, or why it cannot be loaded."""
        from ..reduce.kinds import all_kinds

        return all_kinds()

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        from ..reduce.kinds import kind_names

        if cmd_name in kind_names():
            return _command(cmd_name)
        return super().get_command(ctx, cmd_name)


app = group(
    "Raw recordings to numbers with uncertainties, and a picture to check them by.", cls=_Kinds
)

RawFiles = Annotated[
    list[Path] | None,
    typer.Argument(metavar="FILE...", help="The raw recording, several, or a folder of them."),
]
Listed = Annotated[
    Path | None,
    typer.Option("--list", help="Table of raw files: column file, and options of each alone."),
]
Into = Annotated[
    Path | None, folder_option("Folder of a recording set, new or existing.", name="--into")
]
Out = Annotated[Path, folder_option("Without --into: folder for the numbers and the picture.")]


def _command(name: str) -> Any:
    """Return the command of a kind: FILE, the kind's options, the conditions of the trial."""
    from ..reduce.kinds import all_kinds, load_kind
    from ..reduce.output.row import Row
    from .shared.batch import jobs_of

    kind = load_kind(name)

    def run(context: Any, files: Any, listed: Any, into: Any, out: Any, **given: Any) -> None:
        # a default may stand for what the file says: an option counts where it was typed
        source = context.get_parameter_source
        typed = {k: v for k, v in given.items() if source(k).name != "DEFAULT"}
        row = {k: typed.pop(k) for k in Row.model_fields if k in typed}
        jobs = jobs_of(kind, files or [], listed, typed)
        if len(jobs) == 1:
            _reduce(kind, jobs[0], into, out, row, {})
        else:
            _reduce_each(kind, jobs, into, out, row)

    # a name that a reader of another package shares with `Row` is asked for once
    fields = {**kind.options.model_fields, **Row.model_fields}
    keyword = inspect.Parameter.KEYWORD_ONLY
    parameters = [
        inspect.Parameter("context", keyword, annotation=typer.Context),
        inspect.Parameter("files", keyword, annotation=RawFiles, default=None),
        inspect.Parameter("listed", keyword, annotation=Listed, default=None),
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
    needed = "(needed, here or in the list)" if field.is_required() else ""
    words = (field.description or "", f"({', '.join(choices)})" if choices else "", needed)
    option = typer.Option("--" + name.replace("_", "-"), help=" ".join(filter(None, words)))
    default = None if field.is_required() else field.default
    if default is None:
        plain = typing.Optional[plain]  # noqa: UP045
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
    raise InputError(
        f"{annotation} cannot be an option", key="Options", allowed="float, int, bool, str, Path"
    )


def _reduce_each(
    kind: Kind, jobs: list[Job], into: Path | None, out: Path, row: dict[str, Any]
) -> None:
    """Reduce several files; those that cannot be are told at the end and left out."""
    from rich.console import Console
    from rich.progress import track

    from .shared.batch import draw_page

    if row.get("trial"):
        needed = "left out: each trial is named as its file"
        raise misused(f"given for {len(jobs)} files", key="--trial", allowed=needed)
    left_out: list[InputError] = []
    failed, pictures = 0, dict[str, Path]()
    for job in track(jobs, "reducing", console=Console(stderr=True), transient=True):
        try:
            _reduce(kind, job, into, out, row, pictures)
        except InputErrors as several:  # the names of options are made from every mistake
            left_out, failed = [*left_out, *several.errors], failed + 1
    typer.echo(f"{len(jobs) - failed} of {len(jobs)} files reduced")
    if pictures:
        page = _pictures_of(into, out) / f"all-{kind.name}.png"
        draw_page(pictures, page)
        typer.echo(f"all pictures: {page}")
    if left_out:
        raise InputErrors(tuple({str(error): error for error in left_out}.values()))


def _pictures_of(into: Path | None, out: Path) -> Path:
    return out if into is None else into / "reduced"


def _reduce(
    kind: Kind, job: Job, into: Path | None, out: Path, row: dict[str, Any],
    pictures: dict[str, Path],
) -> None:  # fmt: skip
    """Reduce one file; its picture, or that of what was refused, is added to `pictures`."""
    from ..core.inputs.names import trial_name
    from ..core.inputs.toml_input import parse_model
    from ..reduce.gates import Refused
    from ..reduce.output.into_set import store
    from ..reduce.output.record import write_record
    from ..reduce.output.row import Row

    with _named_as_options():
        conditions = parse_model(row, Row, source="command line")
        name = conditions.trial or trial_name(job.file, **job.options)
        try:
            reduced = kind.run(job.file, job.options, source=job.source)
        except Refused as refused:
            if refused.draw is not None:
                picture = _pictures_of(into, out) / f"{name}-{kind.name}-refused.png"
                refused.draw(picture)
                pictures[name] = picture
                typer.echo(f"picture of what was refused: {picture}", err=True)
            raise
        written: tuple[Path, ...]
        if into is None:
            written = write_record(reduced, out, name, kind=kind.name, options=job.options)
            lines = []
        else:
            done = store(reduced, into, conditions, kind=kind.name, options=job.options)
            written = (done.record, done.picture, *filter(None, [done.flow]))
            lines = [f"  rows of {into}: {', '.join(done.trials)}"] if done.trials else []
            lines += [f"note: {note}" for note in done.notes]
    # a reader of another package may draw none
    there = [path for path in written if path.is_file()]
    if written[1] in there:
        pictures[name] = written[1]
    told = [f"  {name} = {value}" for name, value in reduced.values.items()]
    told += [f"  note: {note}" for note in reduced.notes]
    for line in (f"{job.file}:", *told, *lines, f"written: {', '.join(map(str, there))}"):
        typer.echo(line)


@contextlib.contextmanager
def _named_as_options() -> Iterator[None]:
    """Tell mistakes in options under the names that they have on the command line."""
    try:
        yield
    except InputError as error:
        several = error.errors if isinstance(error, InputErrors) else (error,)
        typed = ("", "command line")
        raise InputErrors(tuple(
            e.at("command line", e.key and "--" + e.key.replace("_", "-"))
            if e.source in typed else e for e in several
        )) from None  # fmt: skip
