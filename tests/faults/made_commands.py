"""Every command of the program, and of its groups, by its words."""

import typer.main
from dentscope.cli.app import app


def _below(command, *words):
    yield words, command
    context = command.context_class(command)
    for word in getattr(command, "list_commands", lambda _: ())(context):
        yield from _below(command.get_command(context, word), *words, word)


COMMANDS = dict(_below(typer.main.get_command(app)))
