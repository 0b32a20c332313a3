"""Commands that take dataclasses of options: each field of a group becomes an option of the command line.

::

    @dataclass(frozen=True, kw_only=True)
    class Greeting:
        name: Annotated[str, typer.Option("--name", help="Name to greet.")]
        loud: Annotated[bool, typer.Option("--loud", help="Greet in capitals.")] = False

    @grouped()
    def greet(greeting: Greeting, times: Annotated[int, typer.Option("--times")] = 1) -> None: ...

``greet --name Ada --loud`` calls ``greet(greeting=Greeting(name="Ada", loud=True), times=1)``. Typer reads a command's
options from the signature of its function, so the decorator returns a function with one parameter per option.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, fields, is_dataclass
from functools import wraps
from inspect import Parameter, Signature, signature
from typing import Any, get_type_hints

CommandFunction = Callable[..., None]


def grouped(order: str = "") -> Callable[[CommandFunction], CommandFunction]:
    """Return a decorator that expands the groups of a command into single options.

    Args:
        order: Names of all options, separated by spaces, in the order of the command's help; by default that of the
            parameters, with the fields of a group in its place.

    Raises:
        TypeError: ``order`` does not name every option exactly once.
    """

    def expand(command: CommandFunction) -> CommandFunction:
        groups: dict[str, type[Any]] = {}
        options: dict[str, Parameter] = {}
        for name, parameter in signature(command, eval_str=True).parameters.items():
            if is_dataclass(parameter.annotation) and isinstance(parameter.annotation, type):
                groups[name] = parameter.annotation
                options |= _options_of(parameter.annotation)
            else:
                options[name] = parameter.replace(kind=Parameter.KEYWORD_ONLY)
        names = order.split() or list(options)
        if sorted(names) != sorted(options):
            raise TypeError(f"{command.__name__} has the options {sorted(options)}, its order names {sorted(names)}")

        @wraps(command)
        def call(**values: Any) -> None:
            built = {}
            for name, group in groups.items():
                built[name] = group(**{f.name: values.pop(f.name) for f in fields(group) if f.name in values})
            command(**values, **built)

        shown: Any = call
        shown.__signature__ = Signature([options[name] for name in names])
        shown.__annotations__ = {name: options[name].annotation for name in names}
        return call

    return expand


def _options_of(group: type[Any]) -> dict[str, Parameter]:
    """Return a parameter for each field of a group."""
    hints = get_type_hints(group, include_extras=True)
    return {
        field.name: Parameter(
            field.name,
            Parameter.KEYWORD_ONLY,
            default=Parameter.empty if field.default is MISSING else field.default,
            annotation=hints[field.name],
        )
        for field in fields(group)
    }
