"""Events in words, one line each, as they happen."""

from __future__ import annotations

from collections.abc import Callable

from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Task
from fieldhand.task.results import (
    Acted,
    Arrived,
    Decided,
    Ended,
    Event,
    Exited,
    Faulted,
    Shed,
    Started,
    Visiting,
)

#: A list of places longer than this is counted, not named.
NAMED = 8


class Teller:
    """Says events in words; remembers nothing but the robot."""

    def __init__(self, robot: RobotProfile) -> None:
        self._robot = robot

    def tell(self, event: Event) -> str | None:
        """The event as a line, or None where it is not worth one."""
        words = self._words(event)
        return None if words is None else f"  {_time(event.t)}  {words}"

    def _words(self, event: Event) -> str | None:
        match event:
            case Started():
                return f"{event.robot} starts on {event.site}, battery at {event.charge_percent:.0f} %"
            case Visiting():
                return f"{len(event.places)} place{'s' * (len(event.places) != 1)} to visit: {_names(event.places)}"
            case Arrived(kind="tree"):
                return f"at tree {event.place} ({event.travelled_m:.0f} m, battery {event.charge_percent:.0f} %)"
            case Arrived():
                return f"at the {event.place} ({event.travelled_m:.0f} m, battery {event.charge_percent:.0f} %)"
            case Acted(status="success"):
                readings = ", ".join(
                    f"{q.replace('_', ' ')} {value:.4g} {pretty(event.units.get(q, ''))}"
                    for q, value in event.readings.items()
                )
                return f"   {noun(self._robot, event.action)}{': ' + readings if readings else ''}"
            case Acted():
                return f"   {noun(self._robot, event.action)} failed (attempt {event.attempt}): {event.what}"
            case Decided():
                return f"   {event.why}"
            case Shed():
                work = "optional" if event.optional else "MANDATORY"
                return f"given up ({work}): {_names(event.places)}: {event.reason}"
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
    return known.words[0] if known and known.words else action.replace("_", " ")


def pretty(unit: str) -> str:
    """A unit as people write it."""
    return {"degC": "°C", "percent": "%"}.get(unit, unit)


def _names(places: tuple[str, ...]) -> str:
    shown = ", ".join(places[:NAMED])
    return shown if len(places) <= NAMED else f"{shown} and {len(places) - NAMED} more"


def _time(seconds: float) -> str:
    minutes, rest = divmod(int(seconds), 60)
    return f"{minutes:3d}:{rest:02d}"
