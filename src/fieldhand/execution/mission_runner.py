"""Carry out an approved Task: tick its behavior tree until the plan ends, take the exit, record the end."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from fieldhand.clock import Clock, WallClock
from fieldhand.errors import DriveFault, FieldhandError, NotApprovedError, OutputError
from fieldhand.execution.active_mission import ActiveMission, Ending
from fieldhand.execution.drivers.protocol import Driver
from fieldhand.execution.event_monitor import EventMonitor, WatchState
from fieldhand.execution.event_wait import wait_until_over
from fieldhand.execution.goals import drive
from fieldhand.execution.guard import Failsafe, Guard, NoFailsafe
from fieldhand.execution.images.folder import ImageFolder
from fieldhand.execution.interrupts import ctrl_c_as_request
from fieldhand.execution.journal.records import InputLog
from fieldhand.execution.limit_monitor import LimitMonitor
from fieldhand.execution.mission_clock import MissionClock, StopTimeout
from fieldhand.execution.operator_commands import OperatorCommand
from fieldhand.execution.recorded_inputs import RecordedInputs
from fieldhand.forecast.mission_state import Spent, Verdict
from fieldhand.forecast.resource_limits import reserve_percent
from fieldhand.forecast.visit_order import drives_for
from fieldhand.language import joined, message, named
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.site.stopping import location_words
from fieldhand.task.authorization import AuthorizedTask
from fieldhand.task.exceeded import exceeded_limits, final_status, reason_with
from fieldhand.task.frames import Task, Then
from fieldhand.task.results import Continued, Ended, Event, Exited, MissionStatus, Paused, ShedCause, Started
from fieldhand.task.run import Steps
from fieldhand.task.watches import Fallback, Response, watched_events

if TYPE_CHECKING:
    from fieldhand.execution.tree import MissionTree


@dataclass(frozen=True, kw_only=True)
class Result:
    """Result of a mission.

    Attributes:
        status: Status as in :class:`~fieldhand.task.results.Ended`.
        reason: Why it did not complete, in words; empty if it did.
        spent: Metres, seconds and percent of the battery, including the way home.
        events: All events in order, from ``Started`` to ``Ended``.
    """

    status: MissionStatus
    reason: str
    spent: Spent
    events: tuple[Event, ...]


def nobody() -> None:
    """Return no command and no reason to stop."""


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
    orders: Callable[[], OperatorCommand | None] = nobody,
    failsafe: Failsafe | None = None,
    log: InputLog | None = None,
    simulated: bool = False,
    images: ImageFolder | None = None,
) -> Result:
    """Carry out a mission. Its last event is always ``Ended``, whatever happens.

    Args:
        authorized: The approved Task.
        site, robot: Approved site and robot profile.
        driver: Driver of the robot, real or simulated, without a running goal.
        guard: Decides on the budget before every drive and action.
        clock: Clock of the mission and the driver.
        emit: Receives each event as it happens. An exception it raises ends the mission, and is re-raised here once the
            robot stands still.
        interrupted: Polled at every tick; a reason ends the mission as ``aborted``. So does Ctrl-C.
        wall: Time of day, for the record.
        orders: Polled at every tick; returns the current operator command.
        failsafe: Polled at every look; checks whether resources suffice for the way home. None for missions without
            limits.
        log: Records inputs, so that the mission can be resumed after a power cut. Inputs that it holds already are
            replayed first. It receives the events instead of ``emit``.
        simulated: True if the driver is a simulation; resuming replays the mission to a new one.
        images: Saves the images of captures; None to save none.

    Raises:
        NotApprovedError: Site or profile is not the approved one; nothing was done.
        JournalError: The log cannot be written, or the mission deviates from it.
    """
    _require_approved(authorized, site, robot)
    with ctrl_c_as_request() as pressed:

        def current_command() -> OperatorCommand | None:
            reason = pressed() or interrupted()
            return OperatorCommand(wanted="end", reason=reason) if reason else orders()

        inputs = RecordedInputs(
            driver=driver,
            guard=guard,
            failsafe=failsafe or NoFailsafe(),
            clock=clock if isinstance(clock, MissionClock) else MissionClock(clock),
            emit=emit,
            current_command=current_command,
            wall=wall,
            log=log,
            simulated=simulated,
            watched=watched_events(authorized.task.composition.watches),
            images=images,
        )
        return MissionRunner(authorized.task, site, robot, inputs).run()


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


class MissionRunner:
    """Runs one mission.

    Args:
        task, site, robot: Task, site and robot of the mission.
        inputs: Driver, guard, failsafe, clock and operator commands.

    Attributes:
        mission: State of the mission.
        monitor: Monitor of battery, distance and time.
        events: Monitor of the events that the mission watches.
    """

    def __init__(self, task: Task, site: Site, robot: RobotProfile, inputs: RecordedInputs) -> None:
        self._inputs = inputs
        self.mission = ActiveMission(
            task=task, site=site, robot=robot, inputs=inputs, drives=drives_for(site, robot, task.constraints)
        )
        self.monitor = LimitMonitor(self.mission)
        self.events = EventMonitor(self.mission)

    def run(self) -> Result:
        """Run the mission, and stop the robot whatever happens."""
        try:
            ending = self._carry_out_mission()
        except BaseException:
            self._inputs.abandon()
            raise
        finally:
            # Also after a bug in this program: the robot must not move unsupervised.
            self._come_to_rest()
        result = self._end(ending)
        self._inputs.finish()
        return result

    def _come_to_rest(self) -> None:
        """Stop the robot and wait until it stands still, without recording, which may be impossible now."""
        self.mission.stop_driver()
        timeout = StopTimeout(self.mission.clock)
        while not self.mission.controller.poll().over and not timeout.expired():
            self._let_time_pass()

    def _carry_out_mission(self) -> Ending:
        """Carry out the plan, then the exit that results from its end."""
        try:
            self._start()
            return self._take_exit(self._settled(self._carry_out_plan()))
        except KeyboardInterrupt:
            self._inputs.interrupted()
            ending = self._aborted(
                OperatorCommand(wanted="abort", reason=message("stopped by the operator", context="log"))
            )
            try:
                return self._settled(ending)
            except KeyboardInterrupt:
                return ending

    def _start(self) -> None:
        mission, position = self.mission, self.mission.observation.position
        mission.emit(
            Started(
                t=mission.t,
                task=mission.task.id,
                robot=mission.robot.name,
                site=mission.site.name,
                lat=position.lat,
                lon=position.lon,
                charge_percent=mission.charge_percent(),
                seed=self._inputs.seed,
                at=mission.time_of_day.began_at,
                reserve_percent=reserve_percent(mission.task.constraints, mission.robot),
            )
        )
        self._look()

    # --- plan ----------------------------------------------------------------------------------------------------

    def _carry_out_plan(self) -> Ending:
        """Tick the tree until it succeeds, fails, or is interrupted.

        Commands are read before anything new begins, and again before time passes.
        """
        from py_trees.common import Status

        from fieldhand.execution.tree import compile_tree

        tree = compile_tree(self.mission)
        try:
            while True:
                order = self._order() or self._stopped()
                if order:
                    return self._aborted(order)
                if self.monitor.alarm != "none" and not self.monitor.turn_to_charger():
                    return self._alarmed(tree, self.monitor.why, self.monitor.exit)
                if (due := self._due(tree)) is not None:
                    if (ending := self._respond(tree, due)) is not None:
                        return ending
                    continue
                tree.tick_once()
                if (ending := self._over(tree)) is not None:
                    return ending
                order = self._order()
                if order:
                    return self._aborted(order)
                self._let_time_pass()
        finally:
            tree.stop(Status.INVALID)  # cancels the goal of the driver, if there is one

    def _over(self, tree: MissionTree) -> Ending | None:
        """Return the end of the plan, or None while it continues."""
        from py_trees.common import Status

        mission = self.mission
        if mission.ending is not None:
            return mission.ending
        stopped = self._stopped()
        if stopped and tree.status == Status.FAILURE:
            return self._aborted(stopped)
        if tree.status == Status.SUCCESS and tree.ended:
            return Ending(status="completed", exit="nominal", then=mission.task.composition.nominal)
        if tree.status == Status.FAILURE:
            then = mission.exit_for(mission.fault)
            return Ending(status="faulted", exit="faulted", then=then, reason=mission.what)
        return None

    def _alarmed(self, tree: MissionTree, why: str, then: Then, cause: ShedCause = "budget") -> Ending:
        """Respond to an alarm or event: stop the robot for good, or give up the rest of the plan and take an exit.

        A goal that has just ended counts as done: the plan advances to what it would begin next, and gives that up.
        """
        mission = self.mission
        if self.monitor.alarm == "stop":
            return self._settled(self._stranded(why))
        mission.halted = True
        result = mission.controller.poll()
        if mission.busy and not result.over:
            broken_off = self._settled(Ending(status="returned", exit="faulted", then="stay", reason=why))
            if not mission.controller.poll().over:
                return broken_off
            result = mission.controller.poll()
        while result.state in ("idle", "succeeded"):
            tree.tick_once()
            if (ending := self._over(tree)) is not None:
                return ending
            if not tree.between:
                break
        mission.halted = False
        tree.give_up(Verdict(go=False, reason=why, cause=cause))
        return Ending(status="returned", exit="faulted", then=then, reason=why)

    def _stranded(self, why: str) -> Ending:
        """Return the ending of a mission whose robot cannot drive home and stays where it stands."""
        mission, at = self.mission, self.mission.observation.position
        home = mission.site.home(mission.exit_for("low_budget"), mission.standing)
        away = math.dist((at.x, at.y), home.stand or home.xy)
        stands = message(
            "it stands in {where}, {metres} m from {place}",
            context="log",
            where=location_words(mission.drives, (at.x, at.y)),
            metres=f"{away:.0f}",
            place=message("the {role}", context="log", role=named(home.id, "role")),
        )
        return Ending(status="faulted", exit="faulted", then="stay", reason=joined("; ", (why, stands)))

    # --- events --------------------------------------------------------------------------------------------------

    def _due(self, tree: MissionTree | None) -> WatchState | None:
        """Return the watch whose response is due; without a tree, on the way home."""
        visit = None if tree is None else tree.current_visit
        at = None if visit is None else visit.place
        return self.events.due(visiting=at is not None, arrived=at is not None and self.mission.is_at(at))

    def _respond(self, tree: MissionTree, due: WatchState) -> Ending | None:
        """Respond to an event during the plan; return the ending if the plan is over."""
        mission, response = self.mission, self._response(due, self._is_interrupted)
        match response:
            case "return_to_start" | "return_to_end":
                return self._alarmed(tree, due.why, response, "event")
            case "end":
                return self._alarmed(tree, due.why, "stay", "event")
            case "skip" | "skip_row" if tree.current_visit is not None:
                stuck = self._settled(Ending(status="faulted", exit="faulted", then="stay", reason=due.why))
                if mission.busy:
                    return stuck
                tree.skip(due.why, row=response == "skip_row")
            case _:
                pass
        if response != "interrupted":
            mission.controller.unpause()
        return None

    def _respond_on_the_way_home(self, heard: OperatorCommand | None) -> Ending | None:
        """Wait for the events that hold on the way home; return the ending if the mission is over."""

        def interrupted(due: WatchState) -> bool:
            return self.events.stronger(due) or self._broken_off(heard) is not None

        while (due := self._due(None)) is not None:
            response = self._response(due, interrupted)
            if response == "end":
                return self._settled(Ending(status="returned", exit="faulted", then="stay", reason=due.why))
            if response == "interrupted" and (ending := self._broken_off(heard)) is not None:
                return self._settled(ending)
        self.mission.controller.unpause()
        return None

    def _is_interrupted(self, due: WatchState) -> bool:
        """Return True if a command, the robot's stop, an alarm or a stronger event ends a wait during the plan."""
        order = self._order() or self._stopped()
        return order is not None or self.monitor.alarm != "none" or self.events.stronger(due)

    def _response(
        self, due: WatchState, interrupted: Callable[[WatchState], bool]
    ) -> Response | Fallback | Literal["interrupted"]:
        """Return the response to an event, after the wait if that is one."""
        if due.watch.response != "wait":
            due.answered = True
            return due.watch.response
        waited = wait_until_over(self.mission, self.events, due, self._look, lambda: interrupted(due))
        due.answered = waited != "interrupted"
        return waited

    def _look(self) -> None:
        """Check the limits and the events."""
        self.monitor.look()
        self.events.look()
        self.mission.controller.limit(self.events.speed_m_s)

    # --- exit ----------------------------------------------------------------------------------------------------

    def _take_exit(self, ending: Ending) -> Ending:
        """Drive to the destination of the exit. A failure on the way ends the mission there."""
        mission, monitor = self.mission, self.monitor
        monitor.turn("exit")
        mission.recharge_due = ""
        mission.emit(Exited(t=mission.t, node=ending.node, exit=ending.exit, then=ending.then, reason=ending.reason))
        home = mission.site.home(ending.then, mission.standing)
        heard = self._order() if ending.status == "aborted" else None
        way = drive(mission, "", home) if ending.then != "stay" else None
        short_of_home = ""
        try:
            if way is not None and (ended := self._respond_on_the_way_home(heard)) is not None:
                return ended
            while way is not None:
                if not _advance(way):
                    # The estimate was conservative: from the safe place the rest of the way may be within reach.
                    way = drive(mission, "", home) if short_of_home and monitor.reaches(home) else None
                    short_of_home = "" if way is not None else short_of_home
                    continue
                if (ended := self._broken_off(heard)) is not None:
                    return self._settled(ended)
                if (ended := self._respond_on_the_way_home(heard)) is not None:
                    return ended
                if monitor.alarm == "shelter" and (refuge := monitor.refuge(home)) is not None:
                    short_of_home, way = monitor.why, self._redirect(refuge)
                self._let_time_pass()
        except OutputError:
            raise
        except FieldhandError as error:
            mission.fail("", error, handled=False)
            then = message("then {what}", context="log", what=str(error))
            reason = joined("; ", (ending.reason, then)) if ending.reason else str(error)
            status: MissionStatus = "aborted" if ending.status == "aborted" else "faulted"
            return Ending(status=status, exit="faulted", then="stay", reason=reason)
        return self._stranded(short_of_home) if short_of_home else ending

    def _broken_off(self, heard: OperatorCommand | None) -> Ending | None:
        """Return the ending if a command, the robot's stop or its battery stops it on the way home.

        Args:
            heard: The command that aborted the mission; it does not stop the drive home, only a new one does.
        """
        order = self._order()
        if order is not None and (order == heard or order.wanted == "return"):
            order = None
        order = self._stopped() or order
        if order:
            return self._aborted(OperatorCommand(wanted="abort", reason=order.reason))
        return self._stranded(self.monitor.why) if self.monitor.alarm == "stop" else None

    def _redirect(self, place: Place) -> Steps:
        """Cancel the current drive and drive to another place."""
        mission = self.mission
        mission.stop_driver()
        while mission.busy and not mission.attend().over:
            yield
        yield from drive(mission, "", place)

    # --- operator commands ---------------------------------------------------------------------------------------

    def _order(self) -> OperatorCommand | None:
        """Return the current operator command. A pause is waited for here, until it ends or the robot is stopped."""
        mission, inputs, controller = self.mission, self._inputs, self.mission.controller
        order = inputs.order()
        mission.note_power_cuts()
        if order is None or order.wanted != "pause":
            return order
        mission.emit(Paused(t=mission.t, reason=order.reason))
        controller.pause()
        while order is not None and order.wanted == "pause" and inputs.observation.stopped is None:
            if controller.at_rest():
                inputs.wait(self.monitor.has_news)
            else:
                inputs.advance(inputs.observation.next_in or 0.0)
            self._look()
            order = inputs.order()
            mission.note_power_cuts()
        controller.unpause()
        if order is None:
            mission.emit(Continued(t=mission.t))
        return None if order is None or order.wanted == "pause" else order

    def _stopped(self) -> OperatorCommand | None:
        """Return the robot's own stop as a command."""
        reason = self._inputs.observation.stopped
        return OperatorCommand(wanted="abort", reason=reason) if reason else None

    def _aborted(self, order: OperatorCommand) -> Ending:
        """Return the ending that a command or the robot's own stop requires. A robot that cannot move stays."""
        mission = self.mission
        then: Then = "stay"
        if mission.observation.stopped is None and order.wanted == "end":
            then = mission.exit_for("aborted")
        elif mission.observation.stopped is None and order.wanted == "return":
            home = mission.exit_for("low_budget")
            then = "return_to_start" if home == "stay" else home
        return Ending(status="aborted", exit="faulted", then=then, reason=order.reason)

    # --- time ----------------------------------------------------------------------------------------------------

    def _settled(self, ending: Ending) -> Ending:
        """Stop the robot and record the end of its goal: a finished capture is kept."""
        mission = self.mission
        mission.stop_driver()
        timeout = StopTimeout(mission.clock)
        while mission.busy and not mission.attend().over:
            if timeout.expired():
                error = DriveFault(
                    message("the robot does not stop when told to", context="log"),
                    advice=message("use its emergency stop", context="log"),
                )
                mission.fail("", error, handled=False)
                return Ending(status="faulted", exit="faulted", then="stay", reason=str(error))
            self._let_time_pass()
        return ending

    def _let_time_pass(self) -> None:
        """Let time pass until the driver is due or a level could be crossed, then check limits and events."""
        seconds = self.mission.next_event_in()
        self.mission.clock.advance(0.0 if seconds is None else min(seconds, self.monitor.next_look_in()))
        self._look()

    def _end(self, ending: Ending) -> Result:
        self.monitor.turn("over")
        self.monitor.look()
        mission, position = self.mission, self.mission.observation.position
        spent = mission.spent
        ended = Ended(
            t=mission.t,
            status=ending.status,
            lat=position.lat,
            lon=position.lon,
            travelled_m=mission.travelled_m,
            charge_percent=mission.charge_percent(),
            reason=ending.reason if ending.status != "completed" else "",
        )
        found = exceeded_limits(mission.task.constraints, [*mission.events, ended])
        status = final_status(ending.status, found)
        if status != ending.status:
            ended = replace(ended, status=status, reason=reason_with(found, ended.reason))
        mission.emit(ended)
        return Result(status=ended.status, reason=ended.reason, spent=spent, events=tuple(mission.events))


def _advance(steps: Steps) -> bool:
    """Take one step; return True if there are more."""
    return next(steps, True) is None
