"""Actions that a robot lacks and others have, by the words of the built-in profiles.

"Measure CO2" asked of a robot without that sensor is understood; what is missing is an action of the profile.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from fieldhand.language import message
from fieldhand.language.words import say_action
from fieldhand.planning.english.inflection import forms_of, plural_of
from fieldhand.planning.english.naming import Phrase, robot_entries, split
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.vocabulary import questions
from fieldhand.robot.builtin_profiles import AMIGA, HUSKY, TRACTOR
from fieldhand.robot.loader import parse_profile
from fieldhand.robot.model import Action, RobotProfile


@dataclass(frozen=True, kw_only=True)
class LackedAction:
    """Words that ask for an action which the robot does not have.

    Attributes:
        first, last: Numbers of the words, the latter excluded.
        does: The action as a verb phrase.
        name: Name of the action.
    """

    first: int
    last: int
    does: str
    name: str

    def say(self, robot: RobotProfile) -> str:
        """Return what the robot lacks."""
        return say_lacking(self.does, self.name, robot)


def say_lacking(does: str, name: str, robot: RobotProfile) -> str:
    """Return the sentence that a robot has no such action: "husky cannot spray: no action 'spray'"."""
    return message("{robot} cannot {does}: no action '{action}'", robot=robot.name, does=does, action=name)


def lacked_actions(words: Sequence[Word], among: frozenset[int], robot: RobotProfile) -> Iterator[LackedAction]:
    """Yield the actions of other robots that words name, from left to right, and that this robot lacks.

    Args:
        words: Words of a request.
        among: Numbers of the words that are looked at; a phrase has at least one of them.
        robot: Robot of the mission.
    """
    known = _known()
    own = {phrase for phrase, _ in robot_entries(robot)}
    qualifiers = {phrase[0] for phrase in known if len(phrase) > 1}
    at = 0
    while at < len(words):
        qualified = at > 0 and words[at - 1].norm in qualifiers  # "soil temperature" is no temperature of the air
        for end in range(min(at + _longest(), len(words)), at, -1):
            phrase = tuple(word.norm for word in words[at:end])
            action = None if qualified or phrase in own else known.get(phrase)
            if action is None or action.name in robot.action or among.isdisjoint(range(at, end)):
                continue
            if split(action.name)[1:] in own:
                continue  # "a colour picture", asked of a robot that takes other pictures
            yield LackedAction(first=at, last=end, does=say_action(action.name), name=action.name)
            at = end - 1
            break
        at += 1


def measured_units() -> frozenset[str]:
    """Return the units in which the built-in robots measure something."""
    return frozenset(quantity.unit for profile in _profiles() for quantity in profile.quantities)


@cache
def _profiles() -> tuple[RobotProfile, ...]:
    return tuple(parse_profile(profile.read_bytes()) for profile in (AMIGA, TRACTOR, HUSKY))


@cache
def _known() -> Mapping[Phrase, Action]:
    """Return the actions of the built-in robots by the words that name them or what they measure."""
    found: dict[Phrase, Action] = {}
    for robot in _profiles():
        for action in robot.actions:
            for phrase in _phrases(action):
                found.setdefault(phrase, action)
        for action in robot.actions:
            quantities = [quantity for quantity in robot.quantities if quantity.name in action.measures]
            for phrase in (split(word) for quantity in quantities for word in (*quantity.words, quantity.name)):
                found.setdefault(phrase, action)
    for question, reading in questions().items():
        if (asked := found.get(split(reading))) is not None:
            found.setdefault(split(question), asked)
    return found


@cache
def _longest() -> int:
    return max(len(phrase) for phrase in _known())


def _phrases(action: Action) -> Iterator[Phrase]:
    """Yield the words for an action."""
    for noun in (*action.words, *(() if "_" in action.name and action.words else (action.name,))):
        phrase = split(noun)
        yield phrase
        yield (*phrase[:-1], plural_of(phrase[-1]))
    for verb in action.verbs:
        yield from (split(form) for form in forms_of(verb))
