"""Events in words, one line each, as they happen: what a terminal and a web page show of a mission under way."""

from __future__ import annotations

from collections.abc import Callable

from fieldhand.clock import clock_time
from fieldhand.evaluation.reasons import SKIPPED, names_places
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task
from fieldhand.task.results import (
    Acted,
    Arrived,
    ClockSet,
    Continued,
    Decided,
    Ended,
    Event,
    Exited,
    Faulted,
    InDoubt,
    Obstructed,
    Paused,
    Resumed,
    Shed,
    Started,
    Visiting,
    Waited,
)
from fieldhand.task.words import capitalised, say_count, say_name, say_number, say_unit

#: A list of places longer than this is counted, not named.
NAMED = 8


class Teller:
    """Says events in words; remembers nothing but the robot."""

    def __init__(self, robot: RobotProfile) -> None:
        self._robot = robot

    def tell(self, event: Event) -> str | None:
        """The event as a line, or None where it is not worth one."""
        words = self._words(event)
        return None if words is None else f"{clock_time(event.t):>8}  {words}"

    def _words(self, event: Event) -> str | None:
        match event:
            case Started():
                return f"{event.robot} starts on {event.site}, battery at {event.charge_percent:.0f} %"
            case Visiting():
                return f"{say_count(len(event.places), 'place')} to visit: {_names(event.places)}"
            case Arrived():
                so_far = f"{event.travelled_m:.0f} m, battery at {event.charge_percent:.0f} %"
                return f"at {_place(event.kind, event.place)} ({so_far})"
            case Acted(status="success"):
                readings = ", ".join(
                    f"{say_name(q)} {say_number(value, 3)} {say_unit(event.units.get(q, ''))}".rstrip()
                    for q, value in event.readings.items()
                )
                return f"   {noun(self._robot, event.action)}{': ' + readings if readings else ''}"
            case Acted():
                return f"   {noun(self._robot, event.action)} failed (attempt {event.attempt}): {event.what}"
            case InDoubt():
                then = "it is made again" if event.then == "repeat" else "it is not made again"
                return f"   {noun(self._robot, event.action)} in doubt: {event.what}; {then}"
            case Resumed():
                return f"goes on after a power cut, battery at {event.charge_percent:.0f} %"
            case Paused():
                return f"paused ({event.reason})"
            case Continued():
                return "continued"
            case Decided():
                return f"   {capitalised(event.why)}."
            case Shed(optional=True) if names_places(event.reason):
                return f"   left out: {event.reason.removeprefix(f'{SKIPPED} ')}"
            case Shed(optional=True):
                return f"   left out: {_names(event.places)} ({event.reason})"
            case Shed():
                return f"GIVEN UP: {_names(event.places) or event.node}: {event.reason}"
            case Obstructed(free=True):
                return f"a blocked way to {_place(event.kind, event.place)} is tried again"
            case Obstructed():
                lost = f"; no way is left to {_trees(event.unreachable)}" if event.unreachable else ""
                return f"BLOCKED on the way to {_place(event.kind, event.place)}: {event.what}{lost}"
            case Waited():
                if event.wanted == "way":
                    return f"waited {clock_time(event.seconds)} for a way to come free"
                return (
                    f"waited {clock_time(event.seconds)} for its position: {'it is back' if event.over else 'in vain'}"
                )
            case ClockSet():
                way = "forward" if event.by_s > 0 else "back"
                return f"the wall clock was set {way} by {clock_time(abs(event.by_s))}; the mission's time goes on"
            case Faulted():
                return f"fault: {event.what}{' (handled)' if event.handled else ''}"
            case Exited():
                reason = f" ({event.reason})" if event.reason else ""
                return f"{event.exit} exit: {event.then.replace('_', ' ')}{reason}"
            case Ended():
                return f"mission {event.status}"
            case _:
                return None


def goal_names(task: Task, robot: RobotProfile) -> Callable[[str], str]:
    """A function that says the goal of an id in words."""
    goals = {goal.id: goal for goal in task.command.goals}

    def name(goal: str) -> str:
        return noun(robot, goals[goal].action) if goal in goals else goal

    return name


def noun(robot: RobotProfile, action: str) -> str:
    """What an action yields, as people say it."""
    known = robot.action.get(action)
    return known.words[0] if known and known.words else say_name(action)


def _place(kind: str, name: str) -> str:
    return f"tree {name}" if kind == "tree" else f"the {name}"


def _trees(names: tuple[str, ...]) -> str:
    return f"{'tree' if len(names) == 1 else 'trees'} {_names(names)}"


def _names(places: tuple[str, ...]) -> str:
    shown = ", ".join(places[:NAMED])
    return shown if len(places) <= NAMED else f"{shown} and {len(places) - NAMED} more"
