"""Where mission, robot and people meet: the attempt at a Task with all that stands between it and the robot.

Attempt ──▶ Helm (pause, what was cut short) ──▶ Witness (the tape) ──▶ Driver, Guard, Clock, orders
"""

from __future__ import annotations

from collections.abc import Callable

from fieldhand.clock import WallClock
from fieldhand.execution.attempt import Attempt
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Driver, Progress
from fieldhand.execution.guard import Guard
from fieldhand.execution.helm import Helm
from fieldhand.execution.journal.records import Tape
from fieldhand.execution.mission_clock import MissionClock
from fieldhand.execution.orders import Order
from fieldhand.execution.recording import OpenCapture
from fieldhand.execution.watch import Lookout
from fieldhand.execution.witness import Asked, Witness
from fieldhand.forecast.routes import drives_for
from fieldhand.robot.model import InDoubtPolicy, RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.event_lines import to_json
from fieldhand.task.frames import Task
from fieldhand.task.results import Continued, Driving, Event, InDoubt, Paused, Resumed


class Bridge:
    """One attempt, ready to begin.

    Args:
        task, site, robot, driver, guard, lookout, clock, emit, wall, tape, simulated: As
            :func:`fieldhand.execution.runtime.run`.
        asked: What a person wants now.

    Attributes:
        attempt: The mission.
        witness: What it is told.
    """

    def __init__(
        self,
        task: Task,
        *,
        site: Site,
        robot: RobotProfile,
        driver: Driver,
        guard: Guard,
        lookout: Lookout,
        clock: MissionClock,
        emit: Callable[[Event], None],
        asked: Asked,
        wall: WallClock | None,
        tape: Tape | None,
        simulated: bool,
    ) -> None:
        drives = drives_for(site, robot)
        self._emit, self._tape, self._cuts = emit, tape, 0
        self.witness = Witness(
            driver=driver,
            guard=guard,
            lookout=lookout,
            clock=clock,
            wall=wall,
            tape=tape,
            asked=asked,
            simulated=simulated,
        )
        self._helm = Helm(
            self.witness.driver,
            site,
            robot,
            ways=lambda: self.attempt.drives,
            set_out=self._tell_way,
            doubt=self._tell_doubt,
        )
        self.attempt = Attempt(
            task=task,
            site=site,
            robot=robot,
            driver=self._helm,
            guard=self.witness.guard,
            clock=self.witness.clock,
            drives=drives,
            emit=self._take,
            wall=self.witness.wall,
            lookout=self.witness.lookout,
        )

    def order(self) -> Order | None:
        """What a person wants of the mission now. A pause is kept here until it is over, or the robot is stopped."""
        attempt, helm, witness = self.attempt, self._helm, self.witness
        order = witness.order()
        self._tell_cut()
        if order is None or order.wanted != "pause":
            return order
        attempt.emit(Paused(t=attempt.t, reason=order.reason))
        helm.hold()
        while order is not None and order.wanted == "pause" and helm.stopped() is None:
            if helm.at_rest():
                witness.wait(attempt.watch.has_news)
            else:
                witness.advance(helm.next_event_in() or 0.0)
            attempt.watch.look()
            order = witness.order()
            self._tell_cut()
        helm.go_on()
        if order is None:
            attempt.emit(Continued(t=attempt.t))
        return None if order is None or order.wanted == "pause" else order

    def _take(self, event: Event) -> None:
        """An event goes to the tape, which tells it on once it is safe; without one at once."""
        if self._tape is None:
            self._emit(event)
        else:
            self._tape.event(to_json(event))

    def _tell_cut(self) -> None:
        if self.witness.cuts == self._cuts:
            return
        self._cuts = self.witness.cuts
        attempt = self.attempt
        at = attempt.driver.position()
        attempt.emit(Resumed(t=attempt.t, lat=at.lat, lon=at.lon, charge_percent=attempt.charge_percent()))

    def _tell_way(self, way: DriveGoal) -> None:
        attempt, doing = self.attempt, self.attempt.doing
        self._tell_cut()
        attempt.driven = way.path_m
        attempt.emit(
            Driving(
                t=attempt.t,
                node="" if doing is None else doing.node,
                kind=way.place.kind,
                place=way.place.id,
                planned_m=way.length_m,
                path=way.path_degrees,
                speed_m_s=way.speed_m_s,
            )
        )

    def _tell_doubt(self, goal: ActionGoal, then: InDoubtPolicy, progress: Progress) -> None:
        attempt, doing = self.attempt, self.attempt.doing
        self._tell_cut()
        attempt.emit(
            InDoubt(
                t=attempt.t,
                node="" if doing is None else doing.node,
                action=goal.action,
                then=then,
                kind=goal.place.kind,
                place=goal.place.id,
                lat=goal.place.lat,
                lon=goal.place.lon,
                attempt=doing.number if isinstance(doing, OpenCapture) else 1,
                what=progress.what,
                charge_percent=attempt.charge_percent(),
            )
        )
