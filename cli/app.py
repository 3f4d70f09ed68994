"""The command line assembled, and the two ways in which it can end early.

A mistake in the user's input is one line on standard error and exit code 2; a computation that
did not reach its end says so and leaves with exit code 3. Neither shows a traceback.
"""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from ..core.errors import EXIT_INPUT_ERROR, InputError, printable
from ..core.processes.stopping import STOPS, listening, stopped
from . import campaign, export, laws, recordings, reduce, studies
from .case import case
from .diagnose import diagnose
from .doctor import doctor
from .examples import examples
from .fit import fit
from .impact import impact
from .inverse import inverse
from .materials import show_materials
from .metal import metal
from .shared.groups import Sections
from .shared.keys import keys

# limit: mistakes that are told one by one [-]: a screen
_MISTAKES_TOLD = 20

app = typer.Typer(
    name="dentscope",
    cls=Sections,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

# typer ships its own copy of click in newer versions and uses the installed one in older ones;
# the base class of its usage errors is reached through a name that both export.
_UsageError: type[Exception] = typer.BadParameter.__mro__[1]

for _part in (campaign, export, laws, recordings, reduce):
    app.add_typer(_part.app, name=_part.__name__.rpartition(".")[2])
for _command in (case, fit, impact, inverse, diagnose, metal, examples, keys, doctor):
    app.command()(_command)
app.command(name="materials")(show_materials)
for _name in ("figures", "verify", "proof", "challenge"):
    studies.add(app, _name)


def _tell_version(asked: bool) -> None:
    if asked:
        version()
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[
        bool,
        typer.Option("--version", help="Print the version.", callback=_tell_version, is_eager=True),
    ] = False,
) -> None:
    """Elastic-plastic contact and impact: simulate a blow, and say what a recording shows of it."""


@app.command()
def version() -> None:
    """Print the version."""
    from .. import __version__

    typer.echo(__version__)


def run(arguments: list[str] | None = None) -> int:
    """Run one command, by default the process's own arguments, and return its exit code."""
    try:
        with listening():
            result = app(args=arguments, standalone_mode=False, prog_name="dentscope")
    except InputError as error:
        return _refused(str(error))
    except _UsageError as error:
        return _refused(f"command line: {getattr(error, 'format_message', error.__str__)()}")
    except OSError as error:
        # what only shows while a file is read or written: no room, no permission, no file
        told = error.strerror or str(error) or type(error).__name__
        return _refused(f"{error.filename}: {told}" if error.filename is not None else told)
    except typer.Exit as stop:
        return int(stop.exit_code)
    except (typer.Abort, *STOPS) as stop:
        sys.stderr.write("stopped\n")
        return stopped(stop)
    return result if isinstance(result, int) else 0


def _refused(told: str) -> int:
    lines = told.splitlines()
    for line in lines[:_MISTAKES_TOLD]:
        sys.stderr.write(f"{printable(line)}\n")
    if len(lines) > _MISTAKES_TOLD:
        sys.stderr.write(f"... and {len(lines) - _MISTAKES_TOLD} more of this kind\n")
    return EXIT_INPUT_ERROR
