"""The command line assembled, and the two ways in which it can end early.

A mistake in the user's input is one line on standard error and exit code 2; a computation that
did not reach its end says so and leaves with exit code 3. Neither shows a traceback.
"""

from __future__ import annotations

import sys

import typer

from ..core.errors import EXIT_INPUT_ERROR, InputError
from . import campaign, laws, proof, recordings, reduce, studies
from .case import case
from .diagnose import diagnose
from .doctor import doctor
from .examples import examples
from .figures import figures
from .fit import fit
from .impact import impact
from .inverse import inverse
from .verify import verify

app = typer.Typer(
    name="dentscope",
    help="Elastic-plastic contact and impact: finite elements, closed forms, recordings.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

# typer ships its own copy of click in newer versions and uses the installed one in older ones;
# the base class of its usage errors is reached through a name that both export.
_UsageError: type[Exception] = typer.BadParameter.__mro__[1]


app.add_typer(campaign.app, name="campaign")
app.add_typer(laws.app, name="laws")
app.add_typer(recordings.app, name="recordings")
app.add_typer(reduce.app, name="reduce")
app.command()(case)
app.command()(fit)
app.command()(impact)
app.command()(inverse)
app.command()(diagnose)
app.command()(examples)
app.command()(doctor)
studies.add(app, figures, name="figures")
studies.add(app, verify, name="verify")
studies.add(app, proof.app, name="proof")


@app.callback()
def main() -> None:
    """Elastic-plastic contact and impact: finite elements, closed forms, recordings."""


@app.command()
def version() -> None:
    """Print the version."""
    from .. import __version__

    typer.echo(__version__)


def run(arguments: list[str] | None = None) -> int:
    """Run one command and return its exit code.

    Parameters
    ----------
    arguments
        What follows `dentscope` on the command line; by default the process's own arguments.
    """
    try:
        result = app(args=arguments, standalone_mode=False)
    except InputError as error:
        sys.stderr.write(f"{error}\n")
        return EXIT_INPUT_ERROR
    except _UsageError as error:
        sys.stderr.write(f"command line: {getattr(error, 'format_message', error.__str__)()}\n")
        return EXIT_INPUT_ERROR
    except typer.Exit as stop:
        return int(stop.exit_code)
    except (typer.Abort, KeyboardInterrupt):
        sys.stderr.write("stopped\n")
        return 130
    return result if isinstance(result, int) else 0
