"""Commands that other distributions add to the command line, through entry points of the group ``fieldhand.commands``.

An entry point names a :class:`typer.Typer`, which becomes a group of commands, or a function, which becomes one command
with the name of the entry point. It is imported when its command is run, and when the help lists all commands, so its
module should import what it needs inside its functions.
"""

from __future__ import annotations

from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, Final

import typer
from typer.core import TyperGroup
from typer.main import get_group

from fieldhand.errors import InputError, PluginError
from fieldhand.plugins import Plugin, active

if TYPE_CHECKING:
    from fieldhand.plugins import Group

_GROUP: Final[Group] = "fieldhand.commands"

#: Commands of other distributions of this project, which an error names if they are not installed.
_ELSEWHERE: Final = {"bench": "fieldhand-bench"}


class CommandsWithPlugins(TyperGroup):
    """The commands of this package, then those of plugins by name; a plugin cannot replace the former.

    A plugin that cannot be loaded only fails its own command; the help names it on standard error.
    """

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of all commands that can be run."""
        return [*super().list_commands(ctx), *self._loadable[0]]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command, imported if a plugin provides it; None if there is none of this name.

        Raises:
            PluginError: The plugin cannot be loaded.
            InputError: A distribution of this project provides it, and is not installed.
        """
        command = super().get_command(ctx, cmd_name)
        if command is not None:
            return command
        plugin = self._plugins.get(cmd_name)
        if plugin is not None:
            return _command_of(plugin)
        if cmd_name in _ELSEWHERE:
            raise InputError(
                f"the command is part of {_ELSEWHERE[cmd_name]}, which is not installed",
                where=cmd_name,
                advice=f"install it with: pip install {_ELSEWHERE[cmd_name]}",
            )
        return None

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help, and print the plugins that cannot be loaded."""
        from fieldhand.hidden_characters import print_error

        super().format_help(ctx, formatter)
        for error in self._loadable[1]:
            print_error(f"fieldhand: warning: {error}")

    @cached_property
    def _plugins(self) -> dict[str, Plugin]:
        return active(_GROUP, built_in=self.commands)

    @cached_property
    def _loadable(self) -> tuple[list[str], list[PluginError]]:
        """Names of the plugins that can be loaded, and errors of the others."""
        names: list[str] = []
        errors: list[PluginError] = []
        for name, plugin in self._plugins.items():
            try:
                _command_of(plugin)
            except PluginError as error:
                errors.append(error)
            else:
                names.append(name)
        return names, errors


@cache
def _command_of(plugin: Plugin) -> Any:
    """Return a plugin's command or group of commands.

    Raises:
        PluginError: It cannot be imported, or is neither.
    """
    provided = plugin.load()
    app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)
    if isinstance(provided, typer.Typer):
        app.add_typer(provided, name=plugin.name)
    elif callable(provided):
        app.command(plugin.name)(provided)
    else:
        raise plugin.error("is neither a typer.Typer nor a function")
    try:
        return get_group(app).commands[plugin.name]
    except Exception as error:
        raise plugin.error(f"is not a command: {type(error).__name__}: {error}") from error
