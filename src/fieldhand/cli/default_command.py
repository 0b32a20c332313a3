"""Groups of commands of which one runs where none is named."""

from __future__ import annotations

from typing import Any, ClassVar

from typer.core import TyperGroup


class GroupWithDefault(TyperGroup):
    """A group of commands with a default: arguments that begin with no command's name are those of the default.

    Attributes:
        default: Name of the default.
    """

    default: ClassVar[str]

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        named = args and args[0] not in (*self.commands, *ctx.help_option_names)
        return super().parse_args(ctx, [self.default, *args] if named else args)
