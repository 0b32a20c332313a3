"""State of a mission while it is carried out.

The behaviors of the tree are stateless: they share one :class:`ActiveMission`, which is passed to each. There is no
blackboard.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal

from fieldhand.clock import Clock
from fieldhand.errors import ActionFault, BlockedFault, DriveFault, FieldhandError, LostFault, PlaceError
from fieldhand.execution.battery_meter import BatteryMeter
from fieldhand.execution.drive_controller import DriveController, drive_goal
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Progress, StretchWork
from fieldhand.execution.guard import Guard
from fieldhand.execution.journal.records import Observation
from fieldhand.execution.limit_levels import charge_levels, fastest_charge, fastest_drain
from fieldhand.execution.open_goals import OpenCapture, OpenDrive, OpenManeuver, OpenStretch, joules_done, unusable
from fieldhand.execution.recorded_inputs import RecordedInputs
from fieldhand.execution.time_of_day import TimeOfDay
from fieldhand.forecast.conditions import ConditionInputs
from fieldhand.forecast.headings import cameras_of, way_in
from fieldhand.forecast.mission_state import MissionState, Spent
from fieldhand.forecast.optional_visits import OptionalVisits
from fieldhand.forecast.recharge_rules import charge_target, charger_of, farthest_target
from fieldhand.forecast.resource_limits import speed_of
from fieldhand.forecast.slow_ground import slow_ground
from fieldhand.forecast.visit_order import start_place
from fieldhand.forecast.working import amount_of, end_of, use_of, working_speed
from fieldhand.places.context import Context
from fieldhand.places.reading_series import ReadingSeries, TakenReading
from fieldhand.places.resolution import resolve, resolve_one
from fieldhand.places.selector import Selector
from fieldhand.robot.model import InDoubtPolicy, RobotProfile
from fieldhand.site.bearings import first_heading
from fieldhand.site.blockages import Blockages
from fieldhand.site.drives import Drive, Drives
from fieldhand.site.model import Place, Site
from fieldhand.site.working.stretch import Stretch, pieces
from fieldhand.task.build import exit_of
from fieldhand.task.collected import collected
from fieldhand.task.frames import Fault, Task, Then
from fieldhand.task.nodes.work_along import WorkAlong
from fieldhand.task.results import (
    Acted,
    Arrived,
    ClockSet,
    Driving,
    Event,
    Faulted,
    ImageLost,
    InDoubt,
    MissionStatus,
    Resumed,
    Strayed,
    Worked,
    Working,
)
from fieldhand.task.run import PlanRun

#: Seconds of the mission between two polls while the robot waits.
LOOK_AGAIN_S = 1.0


@dataclass(frozen=True, kw_only=True)
class Ending:
    """End of the plan, with the exit that follows; ``node`` is the ``Stop`` that ended it, if any."""

    status: MissionStatus
    exit: Literal["nominal", "faulted"]
    then: Then
    reason: str = ""
    node: str = ""


class ActiveMission:
    """State of a mission: position, bound places, readings, resources used, and events so far.

    Args:
        task, site, robot: Task to carry out, its site and robot.
        inputs: Driver, guard, clock and operator commands, recorded. The mission begins on construction.
        drives: Drives between places.

    Attributes:
        slow: Ground on which the robot drives slowly.
        controller: Carries out the current goal.
        guard: The budget guard.
        clock: Mission clock.
        dwells_until_s: Time of the mission clock at which a wait of the plan ends; None if the robot does not wait.
        halted: True while nothing new may begin because the mission is about to turn home.
        blockages: Blocked stretches found so far.
        here: The plan's current place (:mod:`fieldhand.task.plan`).
        standing: Place of the robot itself: ``here``, or a point on the way where a drive failed.
        visited: Ids of the trees at which it has stopped, each once.
        action_j: Energy of the actions so far in joules, by the profile.
        time_of_day: Time of day at the beginning, and later changes of the wall clock.
        driven: Path of the last drive, in local metres.
        readings: Values of each bound reading, by quantity.
        series: All readings of each name that the plan uses as a series.
        run: Current nodes of the plan.
        ending: Set when the plan ends before its last node; the tree is not ticked any more.
        fault: Fault for the Task's exits.
        charges, planned_charges: Number of charges so far that the guard ordered, and of those that the plan contains.
        docked: True while the robot is connected to its charger.
        to_charger: True while it interrupts the plan to charge.
        recharge_due: Reason to charge before the next drive or action; empty if there is none.
    """

    def __init__(
        self,
        *,
        task: Task,
        site: Site,
        robot: RobotProfile,
        inputs: RecordedInputs,
        drives: Drives,
    ) -> None:
        self.task = task
        self.site = site
        self.robot = robot
        self.inputs = inputs
        self.guard: Guard = inputs
        self.clock: Clock = inputs
        self.slow = slow_ground(task.constraints, site, robot)
        self.controller = DriveController(
            inputs,
            site,
            robot,
            ways=lambda: self.drives,
            speed=self._speed_m_s,
            on_restart=self._restarted,
            on_doubt=self._in_doubt,
            slow=self.slow,
            on_strayed=self._strayed,
        )
        self.blockages = Blockages(drives)
        self._begun_s = self.clock.now()
        self.time_of_day = TimeOfDay(inputs)
        self._wake_s: float | None = None
        self.dwells_until_s: float | None = None
        self.action_j = 0.0
        self._full = self.observation.charge_percent
        self._cuts = 0
        self._open: OpenDrive | OpenCapture | OpenManeuver | None = None
        self._recorded: Progress | None = None
        self._lost_images: set[str] = set()
        self.events: list[Event] = []
        self.here = start_place(drives)
        self.standing = self._stands()
        self.arrived_at: Place | None = None
        self.visited: list[str] = []
        self.bound: dict[str, tuple[Place, ...]] = {}
        self.readings: dict[str, Mapping[str, float]] = {}
        self.series: dict[str, ReadingSeries] = {}
        self._collected = collected(task.composition.plan)
        self._cameras = cameras_of(task.composition.plan, robot)
        self.run = PlanRun(task.composition.plan)
        self.travelled_m = 0.0
        self.driven: tuple[tuple[float, float], ...] = ()
        self.ending: Ending | None = None
        self.fault: Fault = "action_failed"
        self.what = ""
        self.halted = False
        self.charges = self.planned_charges = 0
        self.docked = self._charging = self.to_charger = False
        self.recharge_due = ""
        self._charged_percent = self._docked_s = 0.0
        self._docked_since, self._docked_at = 0.0, 0.0
        self._done = self._done_before_charge = 0
        self._turns, self._done_before_turn = 0, -1
        self._look_again_s = LOOK_AGAIN_S
        self._battery = BatteryMeter(
            self._full,
            self.clock.now(),
            hold_s=robot.energy.hold_s,
            fastest=fastest_drain(robot),
            levels=charge_levels(task.constraints, robot, self._full),
        )

    @property
    def observation(self) -> Observation:
        """The robot as observed now."""
        return self.inputs.observation

    @property
    def t(self) -> float:
        """Seconds since the attempt began."""
        return self.clock.now() - self._begun_s

    @property
    def spent(self) -> Spent:
        """Resources used so far, including the current goal."""
        metres, joules, goal = self.travelled_m, self.action_j, self._open
        if goal is not None:
            progress = self.controller.poll()
            if isinstance(goal, OpenDrive):
                metres += progress.metres
                joules += self._implement_j(goal)
            else:
                joules += joules_done(self.robot.doable[goal.action], progress)
        charge, charged, docked_s = self.charge_percent(), self._charged_percent, self._docked_s
        if self._charging:
            charged += max(0.0, charge - self._docked_at)
            docked_s += self.clock.now() - self._docked_since
        percent = self._full - charge + charged
        return Spent(
            metres=metres,
            seconds=self.t,
            percent=percent,
            joules=joules,
            docked_s=docked_s,
            absent_s=self.inputs.absent_s,
        )

    @property
    def drives(self) -> Drives:
        """The drives that are still possible."""
        return self.blockages.drives

    @property
    def visits(self) -> OptionalVisits:
        """Creates the visits of optional nodes."""
        return OptionalVisits(self.task, self.site, self.robot, self.drives)

    @property
    def facts(self) -> ConditionInputs:
        """Facts against which a condition is tested now."""
        return ConditionInputs(
            site=self.site,
            robot=self.robot,
            here=self.here,
            readings=self.readings,
            series=self.series,
            charge_percent=self.charge_percent(),
        )

    def charge_percent(self) -> float:
        """Return the battery charge in percent, filtered for single false readings."""
        return self._battery.read(self.observation.charge_percent, self.clock.now())

    def next_reading_in(self) -> float:
        """Return the seconds until the battery should be read again after an unexpected reading."""
        return self._battery.next_reading_in(self.clock.now())

    def emit(self, event: Event) -> None:
        """Record an event, preceded by a change of the wall clock if there was one."""
        if by_s := self.time_of_day.set_by():
            self.emit(ClockSet(t=self.t, by_s=by_s))
        self.events.append(event)
        self.inputs.event(event)

    def resolve(self, selector: Selector) -> tuple[Place, ...]:
        """Return the places that a selector means now; their stands are open.

        Raises:
            PlaceError: It selects nothing, or names what the site lacks.
        """
        return tuple(resolve(selector, self.site, self._context(self.here)))

    def resolve_one(self, selector: Selector) -> Place:
        """Return the one place that a selector means now.

        Raises:
            PlaceError: It gives none or several, or names what the site lacks.
        """
        return resolve_one(selector, self.site, self._context(self.here))

    def reached(self, place: Place, node: str = "") -> Place:
        """Return a place with the stand that a drive of a node would lead to now, or the current place if the robot is
        there.

        Raises:
            DriveFault: There is no way to it.
        """
        if self.standing.serves(place):
            return self.standing
        return self.way_to(place, node).end

    def way_to(self, place: Place, node: str = "") -> Drive:
        """Return the drive of a node to a place, or to its other side if obstacles leave no other.

        Raises:
            DriveFault: There is no way.
        """
        camera = self._cameras.get(node)
        try:
            return way_in(self.drives, self.robot, self.standing, place, camera)
        except DriveFault:
            if not self.blockages.stretches or place.stand is None:
                raise
            return way_in(self.drives, self.robot, self.standing, dataclasses.replace(place, stand=None), camera)

    def state(self) -> MissionState:
        """Return the state for the guard's decisions; its ``here`` is the robot's position, from which it would drive
        home.
        """
        return MissionState(
            frames=tuple(self.run.frames),
            context=self._context(self.standing),
            spent=self.spent,
            charge_percent=self.charge_percent(),
            charges=self.charges,
            planned_charges=self.planned_charges,
        )

    def bind(self, label: str, places: tuple[Place, ...]) -> None:
        """Bind places to a label, if the node has one."""
        if label:
            self.bound[label] = places

    def collect(self, reading: str, values: Mapping[str, float]) -> None:
        """Add a reading taken here to its series, if the plan uses it as one."""
        if values and reading in self._collected:
            taken = TakenReading(place=self.here, values=dict(values))
            self.series[reading] = self.series.get(reading, ReadingSeries()).plus(taken)

    def end(self, ending: Ending) -> None:
        """End the plan, unless it has ended already."""
        if self.ending is None:
            self.ending = ending

    def exit_for(self, fault: Fault) -> Then:
        """Return the Task's exit for a fault, or the default one."""
        return exit_of(self.task, fault)

    def fail(self, node: str, error: FieldhandError, *, handled: bool) -> None:
        """Record that a node failed for good; ``handled`` is True if a try/otherwise continues from there."""
        match error:
            case BlockedFault():
                self.fault, name = "drive_failed", "blocked"
            case LostFault():
                self.fault, name = "drive_failed", "lost"
            case DriveFault():
                self.fault, name = "drive_failed", "drive_failed"
            case ActionFault():
                self.fault, name = "action_failed", "action_failed"
            case _:
                # Work without a place is no fault of the robot, so the Task's exit for failed work applies.
                self.fault, name = "action_failed", "no_place" if isinstance(error, PlaceError) else "cannot_go_on"
        self.what = str(error)
        self.emit(Faulted(t=self.t, node=node, fault=name, what=self.what, handled=handled))

    def is_at(self, place: Place) -> bool:
        """Return True if the robot has stopped at a place and is still there."""
        return self.arrived_at is not None and self.arrived_at.serves(place)

    def stop_at(self, place: Place) -> None:
        """Record that the robot has reached a place."""
        self.here = self.standing = self.arrived_at = place
        if place.kind == "tree" and place.id not in self.visited:
            self.visited.append(place.id)

    def stands_anew(self) -> None:
        """Record that the robot may have been moved by others."""
        self.arrived_at, self.standing = None, self._stands()

    def start_drive(self, node: str, place: Place) -> None:
        """Start a drive.

        Raises:
            DriveFault, PlaceError: There is no way to the place.
        """
        way, camera = self.way_to(place, node), self._cameras.get(node)
        goal = drive_goal(self.drives, self.robot, way, self._speed_m_s(), camera)
        if (along := self._begin_of_work(node)) is not None:
            goal = dataclasses.replace(goal, heading_deg=along)
        self._emit_driving(node, dataclasses.replace(goal, speed_m_s=self.controller.first_speed_m_s(goal)))
        self._open = OpenDrive(node=node, goal=goal)
        self.controller.start(goal)

    def _begin_of_work(self, node: str) -> float | None:
        """Return the heading in which the work begins to which a node drives now; None if it drives to a place."""
        frame = self.run.frame if self.run.frames else None
        stretch = getattr(frame.tour, "current", None) if frame is not None and frame.node.id == node else None
        return first_heading(stretch.points) if isinstance(stretch, Stretch) else None

    def _speed_m_s(self) -> float:
        """Return the speed limit of a drive that begins now."""
        return speed_of(self.task.constraints, self.robot, self.run.pace_m_s)

    def start_stretch(self, node: WorkAlong, stretch: Stretch, number: int) -> None:
        """Start the ``number``-th attempt at a stretch."""
        goal = DriveGoal(
            place=end_of(stretch, self.site),
            path_m=stretch.points,
            path_degrees=self.site.projection.lat_lon(stretch.points),
            length_m=stretch.length_m,
            speed_m_s=working_speed(node, self.task.constraints, self.robot),
            work=StretchWork(
                action=node.action, parameters=self._parameters(node), on=stretch.on if node.action else ()
            ),
        )
        self._open = OpenStretch(node=node.id, goal=goal, work=node, stretch=stretch, number=number)
        self._emit_working(self._open, dataclasses.replace(goal, speed_m_s=self.controller.first_speed_m_s(goal)))
        self.controller.start(goal)

    def _parameters(self, node: WorkAlong) -> Mapping[str, str | float]:
        action = self.robot.action.get(node.action)
        defaults = {} if action is None else {p.name: p.default for p in action.parameters}
        return {**defaults, **dict(node.parameters)}

    def _implement_j(self, open_: OpenDrive) -> float:
        """Return the energy that the implement of a stretch has used so far in joules, by the profile."""
        done = open_.done(self.controller.reached_m) if isinstance(open_, OpenStretch) else None
        if done is None or not isinstance(open_, OpenStretch):
            return 0.0
        return use_of(done, open_.work, self.task.constraints, self.robot, self.slow).implement_j

    def _emit_working(self, open_: OpenStretch, goal: DriveGoal) -> None:
        """Record the start of work along a stretch, or along the rest of it."""
        self.driven = goal.path_m
        self.emit(
            Working(
                t=self.t,
                node=open_.node,
                action=open_.work.action,
                stretch=open_.stretch.name,
                parameters={} if goal.work is None else goal.work.parameters,
                planned_m=goal.length_m,
                path=goal.path_degrees,
                on=() if goal.work is None else goal.work.on,
                speed_m_s=goal.speed_m_s,
                attempt=open_.number,
            )
        )

    def _end_stretch(self, open_: OpenStretch, progress: Progress) -> None:
        """Record the end of work along a stretch: what was worked, and where the robot is."""
        self.action_j += self._implement_j(open_)
        succeeded = progress.state == "succeeded"
        node, done = open_.work, open_.done(self.controller.reached_m)
        if succeeded:
            done = open_.stretch
        use = None if done is None else use_of(done, node, self.task.constraints, self.robot, self.slow)
        on_m = 0.0 if use is None else use.on_m
        amount = amount_of(node, self.robot, on_m) if node.action else None
        worked = () if done is None or not node.action else pieces(done.points, done.on)
        at = self.observation.position
        self.emit(
            Worked(
                t=self.t,
                node=open_.node,
                action=node.action,
                stretch=open_.stretch.name,
                status="success" if succeeded else "cancelled" if progress.state == "cancelled" else "failed",
                lat=at.lat,
                lon=at.lon,
                leg_m=progress.metres,
                worked_m=on_m,
                area_m2=0.0 if use is None else use.area_m2,
                amount=0.0 if amount is None else amount.value,
                unit="" if amount is None else amount.unit,
                paths=tuple(self.site.projection.lat_lon(part) for part in worked),
                attempt=open_.number,
                what=progress.what,
                travelled_m=self.travelled_m,
                charge_percent=self.charge_percent(),
            )
        )

    def start_capture(self, node: str, action: str, parameters: Mapping[str, str | float], number: int) -> None:
        """Start the ``number``-th attempt at a capture."""
        self._open = OpenCapture(node=node, action=action, number=number)
        goal = ActionGoal(action=action, place=self.here, parameters=parameters, node=node, attempt=number)
        self.controller.start(goal)

    # --- charging ------------------------------------------------------------------------------------------------

    @property
    def charger(self) -> Place | None:
        """The charger of the site, if the robot can use it."""
        return charger_of(self.site, self.robot)

    @property
    def charge_target(self) -> float:
        """The charge in percent up to which the mission charges."""
        return charge_target(self.task.constraints, self.robot)

    @property
    def farthest_target(self) -> float:
        """The charge in percent up to which it charges when a drive was broken off for it."""
        return farthest_target(self.task.constraints, self.robot)

    def start_maneuver(self, node: str, action: str, number: int) -> None:
        """Start the ``number``-th attempt at docking or undocking."""
        self._open = OpenManeuver(node=node, action=action, number=number)
        self.controller.start(ActionGoal(action=action, place=self.here))

    def docked_now(self) -> None:
        """Record that the robot has docked: from now on its charge rises."""
        self.charged()
        self.docked = self._charging = True
        self._docked_since, self._docked_at = self.clock.now(), self.charge_percent()
        self._battery.rises(fastest_charge(self.robot))

    def charged(self) -> None:
        """Record that the robot begins to leave its charger: its charge falls again."""
        if self._charging:
            self._charged_percent += max(0.0, self.charge_percent() - self._docked_at)
            self._docked_s += self.clock.now() - self._docked_since
            self._battery.rises(0.0)
        self._charging = False

    @property
    def may_recharge(self) -> bool:
        """True if the robot may interrupt the plan to charge now."""
        constraints = self.task.constraints
        most = constraints.recharge_at_most
        allowed = constraints.recharge and self.charger is not None and (most is None or self.charges < most)
        return allowed and not self.to_charger

    @property
    def charged_in_vain(self) -> bool:
        """True if nothing of the plan was done since it was last interrupted to charge."""
        return self.charges > 0 and self._done == self._done_before_charge

    @property
    def turns(self) -> int:
        """Number of drives broken off because they cost too much, since anything of the plan was done."""
        return self._turns if self._done == self._done_before_turn else 0

    def turned_back(self) -> None:
        """Record that a drive was broken off because it cost too much."""
        self._turns, self._done_before_turn = self.turns + 1, self._done

    def recharged(self) -> None:
        """Record that the plan was interrupted to charge."""
        self.charges, self._done_before_charge = self.charges + 1, self._done

    @contextmanager
    def looking_every(self, seconds: float) -> Iterator[None]:
        """Look less often while nothing can happen, but at least once in these seconds."""
        self._look_again_s = max(LOOK_AGAIN_S, seconds)
        try:
            yield
        finally:
            self._look_again_s = LOOK_AGAIN_S

    def attend(self) -> Progress:
        """Return the progress of the current goal, and record its end once."""
        progress = self.controller.poll()
        goal = self._open
        if goal is None:
            return progress if self._recorded is None else self._recorded
        if not progress.over:
            return progress
        self._open = None
        if isinstance(goal, OpenManeuver):
            self.action_j += joules_done(self.robot.doable[goal.action], progress)
        elif isinstance(goal, OpenCapture):
            progress = self._end_capture(goal, progress)
        else:
            self._end_drive(goal, progress)
        self._recorded = progress
        return progress

    def stop_driver(self) -> None:
        """Ask the driver to cancel the current goal, if there is one."""
        if self._open is not None:
            self.controller.cancel()

    def wait_until(self, mission_s: float | None) -> None:
        """Stand still until a time of the mission clock; None ends the wait."""
        self._wake_s = mission_s

    def next_event_in(self) -> float | None:
        """Return the seconds until the robot or a wait is due, or None if it neither works nor waits."""
        found = [] if (soon := self.observation.next_in) is None else [soon]
        if self._wake_s is not None:
            found.append(min(self._look_again_s, max(0.0, self._wake_s - self.clock.now())))
        if found and self.task.composition.watches:
            found.append(LOOK_AGAIN_S)
        return min(found, default=None)

    @property
    def dwell_left_s(self) -> float:
        """Seconds left of a wait of the plan; 0 if the robot does not wait."""
        return 0.0 if self.dwells_until_s is None else max(0.0, self.dwells_until_s - self.clock.now())

    @property
    def busy(self) -> bool:
        """True if there is a goal whose end is not recorded yet."""
        return self._open is not None

    @property
    def doing(self) -> OpenDrive | OpenCapture | OpenManeuver | None:
        """The current goal."""
        return self._open

    def note_power_cuts(self) -> None:
        """Record that the mission was resumed since the last call."""
        if self.inputs.cuts != self._cuts:
            self._cuts = self.inputs.cuts
            at = self.observation.position
            resumed = Resumed(t=self.t, lat=at.lat, lon=at.lon, charge_percent=self.charge_percent())
            if (driven := self.inputs.unobserved) is not None:
                resumed = dataclasses.replace(
                    resumed, driven_m=driven.metres, driven_s=driven.seconds, driven_by=driven.by
                )
            self.emit(resumed)

    def emit_arrived(self, node: str, place: Place, leg_m: float) -> None:
        """Record that the robot has arrived at a place."""
        position = self.observation.position
        self.emit(
            Arrived(
                t=self.t,
                node=node,
                kind=place.kind,
                place=place.id,
                side=place.side,
                lat=position.lat,
                lon=position.lon,
                leg_m=leg_m,
                travelled_m=self.travelled_m,
                charge_percent=self.charge_percent(),
            )
        )

    def _emit_driving(self, node: str, goal: DriveGoal) -> None:
        """Record the start of a drive."""
        self.driven = goal.path_m
        self.emit(
            Driving(
                t=self.t,
                node=node,
                kind=goal.place.kind,
                place=goal.place.id,
                side=goal.place.side,
                planned_m=goal.length_m,
                path=goal.path_degrees,
                speed_m_s=goal.speed_m_s,
                heading_deg=goal.heading_deg,
            )
        )

    def _restarted(self, goal: DriveGoal) -> None:
        """Record the start of a drive that continues an interrupted one."""
        self.note_power_cuts()
        if isinstance(self._open, OpenStretch) and goal.work is not None:
            self._emit_working(self._open, goal)
            return
        self._emit_driving("" if self._open is None else self._open.node, goal)

    def _strayed(self, away_m: float) -> None:
        """Record that the robot has left the way of a drive."""
        doing, position, corridor_m = self._open, self.observation.position, self.robot.corridor_m
        place = doing.goal.place if isinstance(doing, OpenDrive) else self.here
        self.emit(
            Strayed(
                t=self.t,
                node="" if doing is None else doing.node,
                kind=place.kind,
                place=place.id,
                lat=position.lat,
                lon=position.lon,
                away_m=away_m,
                corridor_m=away_m if corridor_m is None else corridor_m,
                travelled_m=self.spent.metres,
            )
        )

    def _in_doubt(self, goal: ActionGoal, then: InDoubtPolicy, progress: Progress) -> None:
        """Record that a capture is in doubt."""
        self.note_power_cuts()
        doing, place = self._open, goal.place
        self.emit(
            InDoubt(
                t=self.t,
                node="" if doing is None else doing.node,
                action=goal.action,
                then=then,
                kind=place.kind,
                place=place.id,
                side=place.side,
                lat=place.lat,
                lon=place.lon,
                attempt=doing.number if isinstance(doing, OpenCapture | OpenManeuver) else 1,
                what=progress.what,
                charge_percent=self.charge_percent(),
            )
        )

    def _end_drive(self, open_: OpenDrive, progress: Progress) -> None:
        """Record the end of a drive, at its destination or on the way."""
        self.travelled_m += progress.metres
        if isinstance(open_, OpenStretch):
            self._end_stretch(open_, progress)
        if progress.state != "succeeded":
            self.arrived_at, self.standing = None, self._stands()
            return
        self._done += not self.to_charger
        self.stop_at(open_.goal.place)
        if isinstance(open_, OpenStretch):
            return
        self.emit_arrived(open_.node, open_.goal.place, progress.metres)

    def _end_capture(self, open_: OpenCapture, progress: Progress) -> Progress:
        """Record the end of a capture; return its progress, which is failed if a reading is implausible."""
        action, here, at = self.robot.action[open_.action], self.here, self.observation.position
        self.action_j += joules_done(action, progress)
        if progress.state in ("cancelled", "cut_off"):
            return progress  # cancelled without effect, or in doubt, which is recorded already
        if progress.state == "succeeded":
            why = (unusable(self.robot, q, progress.readings.get(q)) for q in action.measures)
            if what := next(filter(None, why), ""):
                progress = dataclasses.replace(progress, state="failed", fault="failed", readings={}, what=what)
        lost = [file for file in progress.files if not file.file]
        if progress.state == "succeeded" and lost and not action.measures and len(lost) == len(progress.files):
            progress = dataclasses.replace(progress, state="failed", fault="failed", what=lost[0].what)
        done = progress.state == "succeeded"
        self._done += done
        for what in dict.fromkeys(file.what for file in lost):
            self._record_lost_image(open_, what)
        self.emit(
            Acted(
                t=self.t,
                node=open_.node,
                action=open_.action,
                status="success" if done else "failed",
                kind=here.kind,
                place=here.id,
                side=here.side,
                lat=here.lat,
                lon=here.lon,
                attempt=open_.number,
                readings={q: progress.readings[q] for q in action.measures} if done else {},
                units={q: self.robot.quantity[q].unit for q in action.measures} if done else {},
                what=progress.what,
                charge_percent=self.charge_percent(),
                images=progress.files,
                robot_lat=at.lat,
                robot_lon=at.lon,
                heading_deg=at.heading_deg,
            )
        )
        return progress

    def _record_lost_image(self, open_: OpenCapture, what: str) -> None:
        """Record that images are not saved, once for each reason."""
        if what in self._lost_images:
            return
        self._lost_images.add(what)
        self.emit(
            ImageLost(
                t=self.t, node=open_.node, action=open_.action, kind=self.here.kind, place=self.here.id, what=what
            )
        )

    def _context(self, here: Place) -> Context:
        return Context(here=here, visited=tuple(self.visited), bound=dict(self.bound), series=dict(self.series))

    def _stands(self) -> Place:
        """Return the robot's position as a place: ``here`` if it is there."""
        position = self.observation.position
        return self.here if position.is_at(self.here) else position.as_place()
