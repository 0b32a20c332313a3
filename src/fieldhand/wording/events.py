"""Events as sentences: one line each for a terminal and a web page."""

from __future__ import annotations

from collections.abc import Callable

from fieldhand.clock import clock_time
from fieldhand.language import counted, joined, kept_in_log, message, named, shaped
from fieldhand.language.words import (
    capitalised,
    say_name,
    say_number,
    say_place,
    say_rounded,
    say_unit,
    say_wait,
    some_names,
)
from fieldhand.robot.model import RobotProfile
from fieldhand.task.exceeded import say_status
from fieldhand.task.frames import Task
from fieldhand.task.results import (
    Acted,
    Arrived,
    ChargeBegun,
    ChargeEnded,
    ClockSet,
    Continued,
    Decided,
    Dwelling,
    Dwelt,
    Ended,
    Event,
    EventBegan,
    EventEnded,
    Exited,
    Faulted,
    ImageLost,
    InDoubt,
    LimitCrossed,
    MissionStatus,
    Obstructed,
    Paused,
    Resumed,
    Shed,
    Started,
    Strayed,
    Visiting,
    Waited,
    Worked,
    Working,
)
from fieldhand.wording.limits import say_crossing
from fieldhand.wording.recharging import say_charge_begun, say_charge_ended
from fieldhand.wording.watches import say_began

#: A list of places longer than this is counted, not named.
NAMED = 8


class EventText:
    """Describes events in words."""

    def __init__(self, robot: RobotProfile) -> None:
        self._robot = robot

    def line(self, event: Event) -> str | None:
        """Return the event as a line with its time, or None if it is not worth one."""
        words = self.sentence(event)
        if words is None:
            return None
        indent = "   " if isinstance(event, Acted | InDoubt | Decided) or _is_left_out(event) else ""
        return joined("  ", (f"{clock_time(event.t):>8}", joined("", (indent, words))))

    def brief(self, event: Event) -> str:
        """Return what happened on one line without its time; the event's name where it is not worth a line."""
        words = self.sentence(event)
        return event.event if words is None else shaped(words, _on_one_line)

    def sentence(self, event: Event) -> str | None:
        """Return what happened, without its time, or None where it is not worth a line."""
        match event:
            case Started():
                charge = f"{event.charge_percent:.0f}"
                return message(
                    "{robot} starts on {site}, battery at {charge} %", robot=event.robot, site=event.site, charge=charge
                )
            case Visiting():
                names = _names(tuple(dict.fromkeys(event.places)))
                return counted(
                    "{count} place to visit: {names}",
                    "{count} places to visit: {names}",
                    len(event.places),
                    names=names,
                )
            case Arrived():
                return message(
                    "at {place} ({metres} m, battery at {charge} %)",
                    place=say_place(event.kind, event.place, event.side),
                    metres=f"{event.travelled_m:.0f}",
                    charge=f"{event.charge_percent:.0f}",
                )
            case Acted():
                return self._acted(event)
            case ImageLost():
                return message(
                    "{capture}: {what}", capture=noun(self._robot, event.action), what=kept_in_log(event.what)
                )
            case Working():
                return self._working(event)
            case Worked():
                return self._worked(event)
            case InDoubt():
                fills = {"capture": noun(self._robot, event.action), "what": kept_in_log(event.what)}
                if event.then == "repeat":
                    return message("{capture} in doubt: {what}; it is taken again", **fills)
                return message("{capture} in doubt: {what}; it is not taken again", **fills)
            case ChargeBegun():
                return say_charge_begun(event)
            case ChargeEnded():
                return say_charge_ended(event)
            case Resumed():
                return _resumed(event)
            case Paused():
                return message("paused ({reason})", reason=kept_in_log(event.reason))
            case Continued():
                return message("continued")
            case Decided():
                return message("{what}.", what=capitalised(kept_in_log(event.why)))
            case Shed():
                return _shed(event)
            case Obstructed():
                return _obstructed(event)
            case Strayed():
                return message(
                    "LEFT THE WAY to {place} by {metres} m, at most {most} m are allowed; it is stopped",
                    place=say_place(event.kind, event.place),
                    metres=say_rounded(event.away_m, 1),
                    most=say_number(event.corridor_m, 3),
                )
            case Dwelling():
                return message("waits {time}", time=say_wait(event.seconds))
            case Dwelt():
                return message("waited {time}", time=say_wait(round(event.seconds)))
            case Waited():
                return _waited(event)
            case EventBegan():
                return say_began(event)
            case EventEnded():
                return message(
                    "over after {time}: {what}", time=clock_time(event.seconds), what=kept_in_log(event.what)
                )
            case LimitCrossed():
                return say_crossing(event)
            case ClockSet():
                by = clock_time(abs(event.by_s))
                if event.by_s > 0:
                    return message(
                        "the wall clock was set forward by {time}; the mission's time is not affected", time=by
                    )
                return message("the wall clock was set back by {time}; the mission's time is not affected", time=by)
            case Faulted(handled=True):
                return message("fault: {what} (handled)", what=kept_in_log(event.what))
            case Faulted():
                return message("fault: {what}", what=kept_in_log(event.what))
            case Exited():
                return _exited(event)
            case Ended():
                return say_end(event.status, event.reason if event.status == "exceeded" else "")
            case _:
                return None

    def _working(self, event: Working) -> str:
        if not event.action:
            return message("drives along {stretch}", stretch=kept_in_log(event.stretch))
        return message(
            "{action} along {stretch}", action=noun(self._robot, event.action), stretch=kept_in_log(event.stretch)
        )

    def _worked(self, event: Worked) -> str:
        done = message("{metres} m driven", metres=f"{event.leg_m:.0f}")
        if event.action:
            done = message("{metres} m worked", metres=f"{event.worked_m:.0f}")
        if event.unit:
            done = joined(", ", (done, joined(" ", (say_number(event.amount, 1), say_unit(event.unit)))))
        stretch = kept_in_log(event.stretch)
        if event.status == "success":
            return joined(": ", (stretch, done))
        return message(
            "{stretch}: {done}, then stopped ({what})", stretch=stretch, done=done, what=kept_in_log(event.what)
        )

    def _acted(self, event: Acted) -> str:
        capture = noun(self._robot, event.action)
        if event.status != "success":
            return message(
                "{capture} failed (attempt {attempt}): {what}",
                capture=capture,
                attempt=str(event.attempt),
                what=kept_in_log(event.what),
            )
        readings = [
            joined(" ", [p for p in (say_name(q), say_number(value, 3), say_unit(event.units.get(q, ""))) if p])
            for q, value in event.readings.items()
        ]
        if saved := sum(bool(image.file) for image in event.images):
            readings.append(counted("{count} image", "{count} images", saved))
        if not readings:
            return capture
        return message("{capture}: {readings}", capture=capture, readings=joined(", ", readings))


def _on_one_line(text: str) -> str:
    return " ".join(text.split())


def say_end(status: MissionStatus, reason: str = "") -> str:
    """Return how a mission ended, and in brackets why, where that is given."""
    ended = message("mission {status}", status=say_status(status))
    return message("{what} ({why})", what=ended, why=kept_in_log(reason)) if reason else ended


def _is_left_out(event: Event) -> bool:
    return isinstance(event, Shed) and event.optional


def _resumed(event: Resumed) -> str:
    continues = message("continues after a power cut, battery at {charge} %", charge=f"{event.charge_percent:.0f}")
    if not event.driven_m:
        return continues
    metres = f"{event.driven_m:.0f}"
    match event.driven_by:
        case "odometer":
            drove = message("it drove on for {metres} m meanwhile, by its odometer", metres=metres)
        case "line":
            drove = message("it drove on for at least {metres} m meanwhile, the straight line", metres=metres)
        case _:
            drove = message("it drove on for about {metres} m meanwhile, estimated along its way", metres=metres)
    return joined("; ", (continues, drove))


def _shed(event: Shed) -> str:
    if not event.optional:
        places = _names(event.places) or event.node
        return message("GIVEN UP: {places}: {reason}", places=places, reason=kept_in_log(event.reason))
    if event.names_places:
        return message("left out: {what}", what=kept_in_log(event.reason))
    return message("left out: {places} ({reason})", places=_names(event.places), reason=kept_in_log(event.reason))


def _obstructed(event: Obstructed) -> str:
    place = say_place(event.kind, event.place)
    if event.free:
        return message("a blocked way to {place} is tried again", place=place)
    blocked = message("BLOCKED on the way to {place}: {what}", place=place, what=kept_in_log(event.what))
    if not event.unreachable:
        return blocked
    names = _names(event.unreachable)
    if len(event.unreachable) == 1:
        return joined("; ", (blocked, message("no way is left to tree {id}", id=names)))
    return joined("; ", (blocked, message("no way is left to trees {ids}", ids=names)))


def _waited(event: Waited) -> str:
    time = clock_time(event.seconds)
    if event.wanted == "event":
        if event.over:
            return message("waited {time} until it was over", time=time)
        return message("waited {time}, and it is not over", time=time)
    if event.wanted == "navigation":
        if event.over:
            return message("waited {time} for the robot's navigation: it is ready", time=time)
        return message("waited {time} for the robot's navigation without success", time=time)
    if event.wanted == "way":
        return message("waited {time} for a way to become free", time=time)
    if event.over:
        return message("waited {time} for its position: it is back", time=time)
    return message("waited {time} for its position without success", time=time)


def _exited(event: Exited) -> str:
    then = named(event.then.replace("_", " "), "way")
    text = (
        message("nominal exit: {then}", then=then)
        if event.exit == "nominal"
        else message("faulted exit: {then}", then=then)
    )
    return message("{what} ({why})", what=text, why=kept_in_log(event.reason)) if event.reason else text


def goal_names(task: Task, robot: RobotProfile) -> Callable[[str], str]:
    """Return a function that names the goal of an id in words."""
    goals = {goal.id: goal for goal in task.command.goals}

    def name(goal: str) -> str:
        return noun(robot, goals[goal].action) if goal in goals else goal

    return name


def noun(robot: RobotProfile, action: str) -> str:
    """Return the noun for what an action yields."""
    known = robot.action.get(action)
    return named(known.words[0], "capture") if known and known.words else say_name(action)


def _names(places: tuple[str, ...]) -> str:
    return some_names(places, NAMED)
