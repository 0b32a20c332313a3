"""Averages: a picture has one; over several readings there is none, since each reading is tested by itself."""

from __future__ import annotations

import re

from fieldhand.language import message
from fieldhand.planning.english import draft as d
from fieldhand.planning.english.faults import Unclear
from fieldhand.planning.planner import Reason
from fieldhand.robot.model import RobotProfile
from fieldhand.task.conditions import readings

_AVERAGE = re.compile(r"\b(?:averag(?:e|es|ed|ing)|avg|mean|median)\b", re.IGNORECASE)
#: An average of the one reading at hand.
_OF_ONE = re.compile(r"\b(?:its|whose|each|that picture's|the picture's) (?:averages?|avg|mean)\b", re.IGNORECASE)
#: What a profile says of an action whose reading is an average.
_YIELDS_AVERAGE = re.compile(r"\b(?:average|mean)\b", re.IGNORECASE)


def check_averages(root: d.DraftBlock, request: str, robot: RobotProfile) -> None:
    """Add the word for an average to the condition on a reading that is one.

    Raises:
        Unclear: It is said of a reading that is no average, or of several readings.
    """
    said = tuple((m.start(), m.end()) for m in _AVERAGE.finditer(request))
    choices = [step for step, _ in d.walk(root) if isinstance(step, d.Choice) and readings(step.condition)]
    if not said or not choices:
        return
    captures = {step.reading: step for step, _ in d.walk(root) if isinstance(step, d.DraftCapture) and step.reading}
    looped = {
        inner.reading
        for step, _ in d.walk(root)
        if isinstance(step, d.Loop | d.Times)
        for inner, _ in d.walk(step.body)
        if isinstance(inner, d.DraftCapture)
    }
    for choice in choices:
        tested = [captures[name] for name in readings(choice.condition) if name in captures]
        single = all(_YIELDS_AVERAGE.search(robot.action[one.action].description) for one in tested)
        several = len(tested) > 1 or any(one.reading in looped or one.count > 1 for one in tested)
        if not single or (several and not _OF_ONE.search(request)):
            words = request[said[0][0] : said[0][1]]
            what = message(
                "'{words}': each reading is tested by itself; averages of several readings are not supported",
                words=words,
            )
            raise Unclear(Reason(what=what, said=said, advice=message("say what one reading has to be"), final=True))
    choices[0].said = (*choices[0].said, *said)
