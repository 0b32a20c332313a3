"""The application of the command line with all its commands."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Annotated, Any, Final

import typer

from fieldhand.cli.plugin_commands import CommandsWithPlugins

#: The commands in the order of the help, each with its module in this package.
_COMMANDS: Final = {
    "plan": "plan",
    "check": "check",
    "approve": "approve",
    "inspect": "inspect",
    "run": "run",
    "resume": "resume",
    "status": "status",
    "pause": "tell",
    "abort": "tell",
    "missions": "missions",
    "report": "report",
    "replay": "replay",
    "send": "send",
    "outbox": "outbox",
    "watch": "watch",
    "order": "order",
    "runs": "runs",
    "site": "site",
    "sim_robot": "sim_robot",
    "plugins": "plugins",
    "demo": "demo",
}

#: Commands whose names Python reserves: the module and the function of each.
_RENAMED: Final = {"import": ("import_tree", "import_tree"), "return": ("tell", "come_home")}

#: Groups of commands, each with its module.
_GROUPS: Final = {"export": "exports", "robot": "robot", "keys": "keys", "accounts": "accounts"}


def assemble(*others: Callable[..., None], only: str | None = None) -> typer.Typer:
    """Return the application: the commands of this package, then ``others``, then those of plugins.

    Args:
        others: Further commands.
        only: Name of the command that will be run: if this package has it, no other is imported.
    """
    app = typer.Typer(
        name="fieldhand",
        cls=CommandsWithPlugins,
        help="Say in plain words what a field robot should do; get a checked mission, approve it, have it carried out.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    wanted = {only} if only in _names() else _names()
    for name, module in _COMMANDS.items():
        if _typed(name) in wanted:
            app.command()(_imported(module, name))
    for command in others if only not in wanted else ():
        app.command()(command)
    for name, (module, function) in _RENAMED.items():
        if name in wanted:
            app.command(name)(_imported(module, function))
    for name, module in _GROUPS.items():
        if name in wanted:
            app.add_typer(_imported(module, name))
    app.callback()(_top)
    return app


def _names() -> set[str]:
    """Return the names of this package's commands, as they are typed."""
    return {*map(_typed, _COMMANDS), *_RENAMED, *_GROUPS}


def _typed(function: str) -> str:
    """Return the name of the command that a function implements."""
    return function.replace("_", "-")


def _imported(module: str, name: str) -> Any:
    return getattr(import_module(f"fieldhand.cli.{module}"), name)


def _version(wanted: bool) -> None:
    if wanted:
        from fieldhand import __version__

        typer.echo(f"fieldhand {__version__}")
        raise typer.Exit


def _top(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    pass
