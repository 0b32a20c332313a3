"""Amounts that are said to be little or much, without a number: the person is asked for one."""

from __future__ import annotations

from fieldhand.language import Number, message
from fieldhand.language.words import say_name
from fieldhand.planning.grammar.dialogue.state import OpenQuestion, Setting
from fieldhand.planning.grammar.meaning import OPEN_VALUE


def require_amounts(setting: Setting, action: str, parameters: tuple[tuple[str, str | float], ...], used: int) -> None:
    """Ask for the amount of a parameter of which none is said ("not too much").

    Raises:
        OpenQuestion: A parameter has no number.
    """
    open_names = {name for name, value in parameters if value == OPEN_VALUE}
    for one in setting.robot.action[action].parameters if open_names else ():
        if one.name not in open_names or one.minimum is None or one.maximum is None:
            continue
        asked = message(
            "'{said}': how much? Say the {parameter}: {low} to {high} {unit} (otherwise {default} {unit}).",
            context="question",
            said=setting.quoted(used),
            parameter=say_name(one.name.removesuffix(f"_{one.unit.replace('/', '_')}")),
            low=Number(f"{one.minimum:g}"),
            high=Number(f"{one.maximum:g}"),
            unit=one.unit,
            default=Number(f"{one.default:g}"),
        )
        raise OpenQuestion(asked, used)
