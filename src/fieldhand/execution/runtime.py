"""Carry out a Task that was approved: tick its behavior tree until the plan is over, take its exit, say the end."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from fieldhand.clock import Clock, ScaledClock, WallClock
from fieldhand.errors import DriveFault, FieldhandError, NotApprovedError, OutputError
from fieldhand.execution.attempt import Attempt, Ending
from fieldhand.execution.drivers.protocol import Driver
from fieldhand.execution.goals import drive
from fieldhand.execution.guard import Guard
from fieldhand.execution.interrupts import ctrl_c_as_request
from fieldhand.execution.waiting import Steps
from fieldhand.forecast.routes import drives_for
from fieldhand.forecast.state import Spent
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.authorization import AuthorizedTask
from fieldhand.task.results import Ended, Event, Exited, MissionStatus, Started

#: Seconds of the wall clock between two looks at the robot, and at whether someone wants to stop.
LOOK_EVERY_S = 0.1

#: Seconds that a robot is given to stand still after a goal was cancelled.
CANCEL_WITHIN_S = 10.0

Asked = Callable[[], str | None]


@dataclass(frozen=True, kw_only=True)
class Result:
    """How a mission ended, and everything that was gathered.

    Attributes:
        status: As in :class:`~fieldhand.task.results.Ended`.
        reason: Why it did not complete, in words; empty if it did.
        spent: Metres, seconds and percent of the battery, the way home included.
        events: Every event, in order; the first is ``Started``, the last ``Ended``.
    """

    status: MissionStatus
    reason: str
    spent: Spent
    events: tuple[Event, ...]


def never() -> None:
    """Nobody wants to stop the mission."""


def run(
    authorized: AuthorizedTask,
    *,
    site: Site,
    robot: RobotProfile,
    driver: Driver,
    guard: Guard,
    clock: Clock,
    emit: Callable[[Event], None],
    interrupted: Asked = never,
    wall: WallClock | None = None,
) -> Result:
    """Carry out a mission, whatever comes: it always ends with one ``Ended`` event, the last.

    Args:
        authorized: What approval gave.
        site, robot: Those that were approved.
        driver: The robot, real or simulated, in no goal.
        guard: Asked before every drive and every action; it has the last word on the budget.
        clock: The mission's time, the driver's too.
        emit: Takes each event as it happens. What it raises ends the mission at once and comes out of here, when the
            robot stands.
        interrupted: Asked at every tick; a reason ends the mission as ``aborted``. So does Ctrl-C.
        wall: The time of day, to be written down.

    Raises:
        NotApprovedError: The site or the profile is not the one that was approved; nothing was done.
    """
    _require_approved(authorized, site, robot)
    attempt = Attempt(
        task=authorized.task,
        site=site,
        robot=robot,
        driver=driver,
        guard=guard,
        clock=clock,
        drives=drives_for(site, robot),
        emit=emit,
        wall=wall,
    )
    with ctrl_c_as_request() as pressed:
        try:
            ending = _attempt_plan(attempt, lambda: pressed() or interrupted())
        finally:
            # Whatever came, an error of this program too: no wheel turns when nobody looks.
            _come_to_rest(attempt)
        return _end(attempt, ending)


def _come_to_rest(attempt: Attempt) -> None:
    """Stop the robot and wait until it stands, and write nothing: there may be nothing that can be written to."""
    attempt.stop_driver()
    given_up_s = attempt.clock.now() + CANCEL_WITHIN_S
    while not attempt.driver.poll().over and attempt.clock.now() < given_up_s:
        _let_time_pass(attempt)


def _require_approved(authorized: AuthorizedTask, site: Site, robot: RobotProfile) -> None:
    approved = authorized.authorization
    for kind, name, given, wanted in (
        ("site", site.name, site.sha256, approved.site_sha256),
        ("robot profile", robot.name, robot.sha256, approved.robot_sha256),
    ):
        if given != wanted:
            raise NotApprovedError(
                f"the {kind} {name} is not the one that was approved (SHA-256 {given[:12]}, approved {wanted[:12]})",
                where=f"task {authorized.task.id}",
                advice="approve the Task again",
            )


def _attempt_plan(attempt: Attempt, asked: Asked) -> Ending:
    """The plan, then the exit that follows from how it went."""
    try:
        _start(attempt)
        ending = _carry_out_plan(attempt, asked)
        ending = _settled(attempt, ending)
        return _take_exit(attempt, ending, asked)
    except KeyboardInterrupt:
        ending = _aborted(attempt, "stopped by the operator", then_stay=True)
        try:
            return _settled(attempt, ending)
        except KeyboardInterrupt:
            return ending


def _start(attempt: Attempt) -> None:
    position = attempt.driver.position()
    attempt.emit(
        Started(
            t=attempt.t,
            task=attempt.task.id,
            robot=attempt.robot.name,
            site=attempt.site.name,
            lat=position.lat,
            lon=position.lon,
            charge_percent=attempt.driver.charge_percent(),
            seed=attempt.driver.seed,
            at=attempt.time_of_day.began_at,
        )
    )


def _carry_out_plan(attempt: Attempt, asked: Asked) -> Ending:
    """Tick the tree until it is done, has failed, or was cut short.

    Whether to stop is asked before anything new begins, and again before time passes.
    """
    from py_trees.common import Status

    from fieldhand.execution.tree import compile_tree

    tree = compile_tree(attempt.task, attempt)
    try:
        while True:
            reason = asked() or attempt.driver.stopped()
            if reason:
                return _aborted(attempt, reason)
            tree.tick_once()
            if attempt.ending is not None:
                return attempt.ending
            stopped = attempt.driver.stopped()
            if stopped and tree.status == Status.FAILURE:
                return _aborted(attempt, stopped)
            if tree.status == Status.SUCCESS:
                return Ending(status="completed", exit="nominal", then=attempt.task.composition.nominal)
            if tree.status == Status.FAILURE:
                then = attempt.exit_for(attempt.fault)
                return Ending(status="faulted", exit="faulted", then=then, reason=attempt.what)
            reason = asked()
            if reason:
                return _aborted(attempt, reason)
            _let_time_pass(attempt)
    finally:
        tree.stop(Status.INVALID)


def _take_exit(attempt: Attempt, ending: Ending, asked: Asked) -> Ending:
    """Drive where the exit leads. What goes wrong on the way ends the mission where the robot then is."""
    attempt.emit(Exited(t=attempt.t, node=ending.node, exit=ending.exit, then=ending.then, reason=ending.reason))
    home = attempt.site.home(ending.then, attempt.standing)
    heard = asked() if ending.status == "aborted" else None
    way = drive(attempt, "", home) if ending.then != "stay" else None
    try:
        while way is not None and _advance(way):
            # Who stopped the mission, and let the Task bring the robot home, must say something new to stop that.
            reason = asked()
            reason = attempt.driver.stopped() or (reason if reason != heard else None)
            if reason:
                return _settled(attempt, _aborted(attempt, reason, then_stay=True))
            _let_time_pass(attempt)
    except OutputError:
        raise
    except FieldhandError as error:
        attempt.fail("", error, handled=False)
        reason = f"{ending.reason}; then {error}" if ending.reason else str(error)
        status: MissionStatus = "aborted" if ending.status == "aborted" else "faulted"
        return Ending(status=status, exit="faulted", then="stay", reason=reason)
    return ending


def _advance(steps: Steps) -> bool:
    """One step further; whether there are more."""
    return next(steps, True) is None


def _aborted(attempt: Attempt, reason: str, *, then_stay: bool = False) -> Ending:
    """A person or the robot's own stop ended it. A robot that cannot move any more stays."""
    stuck = then_stay or attempt.driver.stopped() is not None
    then = "stay" if stuck else attempt.exit_for("aborted")
    return Ending(status="aborted", exit="faulted", then=then, reason=reason)


def _settled(attempt: Attempt, ending: Ending) -> Ending:
    """Let the robot come to rest, and record what came of the goal that it was at: a capture that was done is kept."""
    attempt.stop_driver()
    given_up_s = attempt.clock.now() + CANCEL_WITHIN_S
    while attempt.busy and not attempt.attend().over:
        if attempt.clock.now() >= given_up_s:
            error = DriveFault("the robot does not stop when told to", advice="use its emergency stop")
            attempt.fail("", error, handled=False)
            return Ending(status="faulted", exit="faulted", then="stay", reason=str(error))
        _let_time_pass(attempt)
    return ending


def _let_time_pass(attempt: Attempt) -> None:
    """Until the driver has something to say; in small slices where that takes real time."""
    seconds = attempt.next_event_in()
    if seconds is None:
        return
    longest = LOOK_EVERY_S * attempt.clock.speed if isinstance(attempt.clock, ScaledClock) else math.inf
    attempt.clock.advance(min(seconds, longest))


def _end(attempt: Attempt, ending: Ending) -> Result:
    position = attempt.driver.position()
    spent = attempt.spent
    attempt.emit(
        Ended(
            t=attempt.t,
            status=ending.status,
            lat=position.lat,
            lon=position.lon,
            travelled_m=attempt.travelled_m,
            charge_percent=attempt.driver.charge_percent(),
            reason=ending.reason if ending.status != "completed" else "",
        )
    )
    return Result(
        status=ending.status,
        reason=ending.reason if ending.status != "completed" else "",
        spent=spent,
        events=tuple(attempt.events),
    )
