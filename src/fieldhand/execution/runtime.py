"""Carry out a Task that was approved: tick its behavior tree until the plan is over, take its exit, say the end."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.clock import Clock, WallClock
from fieldhand.errors import DriveFault, FieldhandError, NotApprovedError, OutputError
from fieldhand.execution.attempt import Attempt, Ending
from fieldhand.execution.bridge import Bridge
from fieldhand.execution.drivers.protocol import Driver
from fieldhand.execution.goals import drive
from fieldhand.execution.guard import Guard
from fieldhand.execution.interrupts import ctrl_c_as_request
from fieldhand.execution.journal.records import Tape
from fieldhand.execution.mission_clock import MissionClock
from fieldhand.execution.orders import Order
from fieldhand.execution.watch import Lookout, NoLookout
from fieldhand.execution.witness import Patience
from fieldhand.forecast.limits import reserve_percent
from fieldhand.forecast.state import Spent, Verdict
from fieldhand.language import joined, message, named
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.site.stopping import stands_in
from fieldhand.task.authorization import AuthorizedTask
from fieldhand.task.exceeded import exceeded, final_status, reason_with
from fieldhand.task.frames import Then
from fieldhand.task.results import Ended, Event, Exited, MissionStatus, Started
from fieldhand.task.run import Steps

if TYPE_CHECKING:
    from fieldhand.execution.tree import MissionTree


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


def nobody() -> None:
    """Nobody wants anything of the mission."""


def run(
    authorized: AuthorizedTask,
    *,
    site: Site,
    robot: RobotProfile,
    driver: Driver,
    guard: Guard,
    clock: Clock,
    emit: Callable[[Event], None],
    interrupted: Callable[[], str | None] = nobody,
    wall: WallClock | None = None,
    orders: Callable[[], Order | None] = nobody,
    lookout: Lookout | None = None,
    tape: Tape | None = None,
    simulated: bool = False,
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
        orders: Asked at every tick: what a person wants now.
        lookout: Asked at every look whether what is left lasts for the way home; None where there are no limits.
        tape: Keeps what is needed to go on after a power cut. What it holds already is not done again: the mission
            goes on from there. Its events come from the tape, not from ``emit``.
        simulated: The driver is a simulation; for a mission that goes on it is a new one, brought to where it was.

    Raises:
        NotApprovedError: The site or the profile is not the one that was approved; nothing was done.
        JournalError: The tape cannot be written, or the mission does not go as it says.
    """
    _require_approved(authorized, site, robot)
    with ctrl_c_as_request() as pressed:

        def asked() -> Order | None:
            reason = pressed() or interrupted()
            return Order(wanted="end", reason=reason) if reason else orders()

        bridge = Bridge(
            authorized.task,
            site=site,
            robot=robot,
            driver=driver,
            guard=guard,
            lookout=lookout or NoLookout(),
            clock=clock if isinstance(clock, MissionClock) else MissionClock(clock),
            emit=emit,
            asked=asked,
            wall=wall,
            tape=tape,
            simulated=simulated,
        )
        try:
            ending = _attempt_plan(bridge)
        except BaseException:
            bridge.witness.abandon()
            raise
        finally:
            # Whatever came, an error of this program too: no wheel turns when nobody looks.
            _come_to_rest(bridge.attempt)
        result = _end(bridge.attempt, ending)
        bridge.witness.finish()
        return result


def _come_to_rest(attempt: Attempt) -> None:
    """Stop the robot and wait until it stands, and write nothing: there may be nothing that can be written to."""
    attempt.stop_driver()
    patience = Patience(attempt.clock)
    while not attempt.driver.poll().over and not patience.over:
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


def _attempt_plan(bridge: Bridge) -> Ending:
    """The plan, then the exit that follows from how it went."""
    attempt = bridge.attempt
    try:
        _start(attempt)
        ending = _carry_out_plan(bridge)
        ending = _settled(attempt, ending)
        return _take_exit(bridge, ending)
    except KeyboardInterrupt:
        bridge.witness.interrupted()
        ending = _aborted(attempt, Order(wanted="abort", reason=message("stopped by the operator", context="log")))
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
            charge_percent=attempt.charge_percent(),
            seed=attempt.driver.seed,
            at=attempt.time_of_day.began_at,
            reserve_percent=reserve_percent(attempt.task.constraints, attempt.robot),
        )
    )
    attempt.watch.look()


def _carry_out_plan(bridge: Bridge) -> Ending:
    """Tick the tree until it is done, has failed, or was cut short.

    Whether to stop is asked before anything new begins, and again before time passes.
    """
    from py_trees.common import Status

    from fieldhand.execution.tree import compile_tree

    attempt = bridge.attempt
    tree = compile_tree(attempt)
    try:
        while True:
            order = bridge.order() or _stopped(attempt)
            if order:
                return _aborted(attempt, order)
            if attempt.watch.alarm != "none":
                return _alarmed(tree, attempt)
            tree.tick_once()
            if (ending := _over(tree, attempt)) is not None:
                return ending
            order = bridge.order()
            if order:
                return _aborted(attempt, order)
            _let_time_pass(attempt)
    finally:
        tree.stop(Status.INVALID)


def _over(tree: MissionTree, attempt: Attempt) -> Ending | None:
    """Return the end of the plan; None while it goes on."""
    from py_trees.common import Status

    if attempt.ending is not None:
        return attempt.ending
    stopped = _stopped(attempt)
    if stopped and tree.status == Status.FAILURE:
        return _aborted(attempt, stopped)
    if tree.status == Status.SUCCESS:
        return Ending(status="completed", exit="nominal", then=attempt.task.composition.nominal)
    if tree.status == Status.FAILURE:
        then = attempt.exit_for(attempt.fault)
        return Ending(status="faulted", exit="faulted", then=then, reason=attempt.what)
    return None


def _alarmed(tree: MissionTree, attempt: Attempt) -> Ending:
    """Break off what the robot is at: it stops for good, or gives up all that is left of the plan and turns home.

    A goal that is over by now is done: the plan goes on to what it would begin next, and gives that up.
    """
    why = attempt.watch.why
    if attempt.watch.alarm == "stop":
        return _settled(attempt, _stood(attempt, why))
    attempt.halted = True
    result = attempt.driver.poll()
    if attempt.busy and not result.over:
        broken_off = _settled(attempt, Ending(status="returned", exit="faulted", then="stay", reason=why))
        if not attempt.driver.poll().over:
            return broken_off
        result = attempt.driver.poll()
    while result.state in ("idle", "succeeded"):
        tree.tick_once()
        if (ending := _over(tree, attempt)) is not None:
            return ending
        if not tree.between:
            break
    attempt.halted = False
    tree.give_up(Verdict(go=False, reason=why))
    return Ending(status="returned", exit="faulted", then=attempt.watch.exit, reason=why)


def _stood(attempt: Attempt, why: str) -> Ending:
    """The end of a mission whose robot cannot come home: where it stands, once it does."""
    at = attempt.driver.position()
    home = attempt.site.home(attempt.exit_for("low_budget"), attempt.standing)
    away = math.dist((at.x, at.y), home.stand or home.xy)
    stands = message(
        "it stands in {where}, {metres} m from {place}",
        context="log",
        where=stands_in(attempt.drives, (at.x, at.y)),
        metres=f"{away:.0f}",
        place=message("the {role}", context="log", role=named(home.id, "role")),
    )
    reason = joined("; ", (why, stands))
    return Ending(status="faulted", exit="faulted", then="stay", reason=reason)


def _take_exit(bridge: Bridge, ending: Ending) -> Ending:
    """Drive where the exit leads. What goes wrong on the way ends the mission where the robot then is."""
    attempt = bridge.attempt
    attempt.watch.turn("exit")
    attempt.emit(Exited(t=attempt.t, node=ending.node, exit=ending.exit, then=ending.then, reason=ending.reason))
    home = attempt.site.home(ending.then, attempt.standing)
    heard = bridge.order() if ending.status == "aborted" else None
    way = drive(attempt, "", home) if ending.then != "stay" else None
    short_of_home = ""
    try:
        while way is not None:
            if not _advance(way):
                # The estimate was cautious: from a safe place the rest of the way may be in reach after all.
                way = drive(attempt, "", home) if short_of_home and attempt.watch.reaches(home) else None
                short_of_home = "" if way is not None else short_of_home
                continue
            # Who stopped the mission, and let the Task bring the robot home, must say something new to stop that.
            order = bridge.order()
            if order is not None and (order == heard or order.wanted == "return"):
                order = None
            order = _stopped(attempt) or order
            if order:
                return _settled(attempt, _aborted(attempt, Order(wanted="abort", reason=order.reason)))
            if attempt.watch.alarm == "stop":
                return _settled(attempt, _stood(attempt, attempt.watch.why))
            if attempt.watch.alarm == "shelter" and (refuge := attempt.watch.refuge(home)) is not None:
                short_of_home, way = attempt.watch.why, _changed_to(attempt, refuge)
            _let_time_pass(attempt)
    except OutputError:
        raise
    except FieldhandError as error:
        attempt.fail("", error, handled=False)
        then = message("then {what}", context="log", what=str(error))
        reason = joined("; ", (ending.reason, then)) if ending.reason else str(error)
        status: MissionStatus = "aborted" if ending.status == "aborted" else "faulted"
        return Ending(status=status, exit="faulted", then="stay", reason=reason)
    return _stood(attempt, short_of_home) if short_of_home else ending


def _changed_to(attempt: Attempt, place: Place) -> Steps:
    """Break off the drive in hand and drive to another place."""
    attempt.stop_driver()
    while attempt.busy and not attempt.attend().over:
        yield
    yield from drive(attempt, "", place)


def _advance(steps: Steps) -> bool:
    """One step further; whether there are more."""
    return next(steps, True) is None


def _stopped(attempt: Attempt) -> Order | None:
    """The robot's own stop, as an order."""
    reason = attempt.driver.stopped()
    return Order(wanted="abort", reason=reason) if reason else None


def _aborted(attempt: Attempt, order: Order) -> Ending:
    """A person or the robot's own stop ended it. A robot that cannot move any more stays."""
    then: Then = "stay"
    if attempt.driver.stopped() is None and order.wanted == "end":
        then = attempt.exit_for("aborted")
    elif attempt.driver.stopped() is None and order.wanted == "return":
        home = attempt.exit_for("low_budget")
        then = "return_to_start" if home == "stay" else home
    return Ending(status="aborted", exit="faulted", then=then, reason=order.reason)


def _settled(attempt: Attempt, ending: Ending) -> Ending:
    """Let the robot come to rest, and record what came of the goal that it was at: a capture that was done is kept."""
    attempt.stop_driver()
    patience = Patience(attempt.clock)
    while attempt.busy and not attempt.attend().over:
        if patience.over:
            error = DriveFault(
                message("the robot does not stop when told to", context="log"),
                advice=message("use its emergency stop", context="log"),
            )
            attempt.fail("", error, handled=False)
            return Ending(status="faulted", exit="faulted", then="stay", reason=str(error))
        _let_time_pass(attempt)
    return ending


def _let_time_pass(attempt: Attempt) -> None:
    """Until the driver has something to say or something could be crossed; in slices where that takes real time."""
    seconds = attempt.next_event_in()
    attempt.clock.advance(0.0 if seconds is None else seconds)
    attempt.watch.look()


def _end(attempt: Attempt, ending: Ending) -> Result:
    attempt.watch.turn("over")
    attempt.watch.look()
    position = attempt.driver.position()
    spent = attempt.spent
    ended = Ended(
        t=attempt.t,
        status=ending.status,
        lat=position.lat,
        lon=position.lon,
        travelled_m=attempt.travelled_m,
        charge_percent=attempt.charge_percent(),
        reason=ending.reason if ending.status != "completed" else "",
    )
    found = exceeded(attempt.task.constraints, [*attempt.events, ended])
    status = final_status(ending.status, found)
    if status != ending.status:
        ended = replace(ended, status=status, reason=reason_with(found, ended.reason))
    attempt.emit(ended)
    return Result(status=ended.status, reason=ended.reason, spent=spent, events=tuple(attempt.events))
