"""Captures that a command does not name: "check tree 4", "sample 5 vines per variety"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.language.words import say_action
from fieldhand.planning.english.naming import takes_pictures
from fieldhand.planning.grammar.dialogue.faults import NotComposed
from fieldhand.planning.grammar.dialogue.state import DialogueState, Setting, with_assumption
from fieldhand.planning.grammar.meaning import UNSAID_THING, CaptureCommand, Thing
from fieldhand.robot.model import Action

#: Word in the name of an action that takes something away.
_SAMPLE = "sample"


def named_things(
    setting: Setting, state: DialogueState, command: CaptureCommand
) -> tuple[DialogueState, tuple[Thing, ...]]:
    """Return the captures of a command, one that it does not name as the one that its verb suggests.

    Who is to look at something takes pictures, and who is to sample something takes samples, if the robot has just one
    action for it. Otherwise it may be each capture that the robot is able to.

    Raises:
        NotComposed: The robot captures nothing at places.
    """
    unsaid = next((thing for thing in command.things if thing.action == UNSAID_THING), None)
    if unsaid is None:
        return state, command.things
    at_places = [action for action in setting.robot.actions if action.implement is None]
    if not at_places:
        raise NotComposed(message("the robot has nothing that is done at a single tree", context="fault"))
    likely = [action for action in at_places if _is_meant(action, unsaid)]
    if len(likely) == 1:
        (action,) = likely
        state = with_assumption(state, _sentence(setting, command, action))
        name = action.name
    else:
        name = setting.either("what is taken?", command.used, [one.name for one in at_places])
    return state, tuple(replace(thing, action=name, verb="") for thing in command.things)


def _is_meant(action: Action, unsaid: Thing) -> bool:
    """Return True for the kind of action that the verb of a capture suggests."""
    if unsaid.verb == "look":
        return takes_pictures(action)
    return unsaid.verb == "sample" and _SAMPLE in action.name.split("_")


def _sentence(setting: Setting, command: CaptureCommand, action: Action) -> str:
    return message(
        "'{said}' does not say what is done there: the robot is to {action}.",
        context="assumption",
        said=setting.quoted(command.used),
        action=say_action(action.name, 1),
    )
