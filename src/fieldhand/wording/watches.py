"""Word the conditions that a mission watches, and the responses to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.language import Message, kept_in_log, labelled, message, named
from fieldhand.language.words import capitalised, say_action, say_duration, say_name, say_number, say_quantity, say_unit
from fieldhand.robot.model import RobotProfile
from fieldhand.task.watches import EventAbsent, EventBeyond, EventHolds, Fallback, ReadingBeyond, Watch
from fieldhand.terms import Test

if TYPE_CHECKING:
    from fieldhand.task.results import EventBegan


def say_event(name: str, robot: RobotProfile) -> str:
    """Return an event of the profile as a clause: "someone is near"."""
    known = robot.event.get(name)
    if known is None:
        return say_name(name)
    text = named(known.description, "event", message("“{name}”", context="event", name=known.description))
    return labelled(text, known.labels)


def say_watched(watch: Watch, robot: RobotProfile) -> str:
    """Return the condition of a watch as a clause: "the wind is above 5 m/s"."""
    match watch.condition:
        case EventHolds(event=name):
            return say_event(name, robot)
        case EventAbsent(event=name):
            return message("it is not the case that {what}", context="log", what=say_event(name, robot))
        case EventBeyond(event=name, test=test, value=value, unit=unit):
            noun = robot.event[name].words[0] if name in robot.event else name
            return _beyond(_named(noun), test, say_quantity(value, unit))
        case ReadingBeyond(quantity=name, test=test, value=value, unit=unit):
            reading = message("a reading of {quantity}", context="log", quantity=say_name(name))
            return _beyond(reading, test, say_quantity(value, unit))


def _named(noun: str) -> Message:
    return named(noun, "event", message("“{name}”", context="event", name=noun))


def _beyond(what: str, test: Test, limit: str) -> str:
    match test:
        case "lt":
            return message("{what} is below {limit}", context="log", what=what, limit=limit)
        case "le":
            return message("{what} is at most {limit}", context="log", what=what, limit=limit)
        case "gt":
            return message("{what} is above {limit}", context="log", what=what, limit=limit)
        case "ge":
            return message("{what} is at least {limit}", context="log", what=what, limit=limit)
        case "eq":
            return message("{what} is exactly {limit}", context="log", what=what, limit=limit)
        case "ne":
            return message("{what} is other than {limit}", context="log", what=what, limit=limit)


def wait_limit_s(watch: Watch, robot: RobotProfile) -> float:
    """Return the maximum duration of a wait in seconds."""
    return robot.patience.event_wait_s if watch.at_most_s is None else watch.at_most_s


def slow_limit_m_s(watch: Watch, robot: RobotProfile) -> float:
    """Return the highest driving speed in m/s of a watch whose response is to drive slowly."""
    return robot.slowly_m_s if watch.speed_m_s is None else watch.speed_m_s


def say_watch(watch: Watch, robot: RobotProfile) -> str:
    """Return a watch as a sentence of the read-back."""
    text = _say_response(watch, robot)
    if not watch.during:
        return message("At any time: {rule}", rule=text)
    return message("In the steps to {action}: {rule}", action=say_action(watch.during), rule=text)


def _say_response(watch: Watch, robot: RobotProfile) -> str:
    what = say_watched(watch, robot)
    match watch.response:
        case "slow":
            speed = say_number(slow_limit_m_s(watch, robot), 3)
            return message("while {what}, drive no faster than {speed} m/s.", what=what, speed=speed)
        case "wait":
            time = say_duration(wait_limit_s(watch, robot))
            after = _FALLBACKS[watch.fallback]
            return message(
                "if {what}, stand still until it is over, at most {time}; then {after}.",
                what=what,
                time=time,
                after=after,
            )
        case "skip":
            return message("if {what}, leave out the current visit and go on with the next.", what=what)
        case "skip_row":
            return message("if {what}, leave out the rest of that row and go on.", what=what)
        case "return_to_start":
            return message("if {what}, give up the rest and return to the start.", what=what)
        case "return_to_end":
            return message("if {what}, give up the rest and return to the end.", what=what)
        case "end":
            return message("if {what}, end the mission where the robot is.", what=what)


_FALLBACKS: dict[Fallback, str] = {
    "return_to_start": message("give up the rest and return to the start", context="fallback"),
    "return_to_end": message("give up the rest and return to the end", context="fallback"),
    "end": message("end the mission there", context="fallback"),
    "skip": message("leave out the current visit", context="fallback"),
    "go_on": message("go on all the same", context="fallback"),
}


def say_held(watch: Watch, robot: RobotProfile, value: float | None) -> str:
    """Return the condition of a watch as it began to hold, for the event log: "wind 7.5 m/s, the limit is 5 m/s"."""
    what = say_watched(watch, robot)
    if value is None:
        return message("{what}, or its sensor is silent", context="log", what=what)
    match watch.condition:
        case EventBeyond(unit=unit) | ReadingBeyond(unit=unit):
            number, of = say_number(value, 3), say_unit(unit)
            return message("{what} ({value} {unit})", context="log", what=what, value=number, unit=of)
        case EventHolds() | EventAbsent():
            return what


def say_began(event: EventBegan) -> str:
    """Return a sentence on the event and the robot's response."""
    what = capitalised(kept_in_log(event.what))
    match event.response:
        case "wait":
            return message("{what}: it stands still", what=what)
        case "skip":
            return message("{what}: it leaves out the current visit", what=what)
        case "skip_row":
            return message("{what}: it leaves out the rest of the row", what=what)
        case "return_to_start" | "return_to_end":
            return message("{what}: it turns home", what=what)
        case "end":
            return message("{what}: it ends its mission there", what=what)
        case "slow":
            return message("{what}: it drives slowly", what=what)
