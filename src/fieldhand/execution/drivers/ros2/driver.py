"""Driver of a robot over ROS 2, as a :class:`~fieldhand.execution.drivers.protocol.Driver`.

    start_drive  ──▶ RunningDrive   ──▶ NavigationClient ──▶ goals of Nav2
    start_action ──▶ RunningCapture ──▶ CaptureClient    ──▶ actions, services, topics
    position, charge, lost, stopped ◀── Telemetry ◀── topics

There are no threads and no callbacks: :meth:`Ros2Driver.poll` takes what has arrived and sends what is due. No method
raises because of the robot; a fault ends the current goal with its reason.
"""

from __future__ import annotations

import dataclasses
import math
import time
import uuid
from collections.abc import Callable, Collection, Mapping

from fieldhand.clock import Clock
from fieldhand.compatibility import Self
from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Position, Progress
from fieldhand.execution.drivers.ros2.action_outcome import GoalEnd
from fieldhand.execution.drivers.ros2.capture import CaptureClient, RunningCapture
from fieldhand.execution.drivers.ros2.event_topics import EventTopics
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.navigation import NavigationClient, RunningDrive
from fieldhand.execution.drivers.ros2.route_drive import RouteDrive
from fieldhand.execution.drivers.ros2.startup import Startup
from fieldhand.execution.drivers.ros2.telemetry import Telemetry
from fieldhand.execution.drivers.ros2.transport import Transport
from fieldhand.execution.drivers.ros2.working import ImplementClient, RunningStretch
from fieldhand.robot.bindings import Ros2Bindings
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Seconds of the wall clock between two polls of the robot.
LOOK_EVERY_S = 0.05
#: Seconds within which all of the robot must be available.
READY_WITHIN_S = 20.0
#: Seconds for which the position counts as lost after navigation reported it.
LOST_S = 5.0
#: Odometry messages to wait for after a drive, so that its last metres are counted, and the time limit in seconds.
LAST_METRES, LAST_METRES_S = 2, 0.5
#: Seconds within which remaining goals must end when the driver is left.
LEAVE_S = 3.0
#: Metres from the site's start beyond which the robot is on another site.
_FAR_M = 5_000.0


class Ros2Driver:
    """Driver of one robot, created by :meth:`connect`.

    Args:
        transport: Transport of the robot's graph; closed by its owner.
        site, robot: Site and robot of the mission; the profile must have a ``ros2`` part.
        clock: Mission clock.
        steady: Monotonic clock in seconds.
        look_every_s: Seconds of the mission clock between two polls of a running goal.
        actions: Names of the actions the mission needs; None for all that the profile binds.
        events: Names of the events that the mission watches; None for all that the profile binds.
        new_id: Returns the 16 bytes of a goal id.

    Raises:
        Ros2Error: The profile has no ROS 2 part, or uses unknown types.
    """

    def __init__(
        self,
        transport: Transport,
        site: Site,
        robot: RobotProfile,
        *,
        clock: Clock,
        steady: Callable[[], float] = time.monotonic,
        look_every_s: float = LOOK_EVERY_S,
        actions: Collection[str] | None = None,
        events: Collection[str] | None = None,
        new_id: Callable[[], bytes] = lambda: uuid.uuid4().bytes,
    ) -> None:
        bindings = _bindings_of(robot, actions, events)
        self._site = site
        self._clock, self._steady, self._look_every_s = clock, steady, look_every_s
        self._telemetry = Telemetry(
            transport, bindings, site.projection, speed_m_s=robot.speed_m_s, clock=clock.now, steady=steady
        )
        self._events = EventTopics(transport, bindings, steady=steady, only=events)
        self._navigation = NavigationClient(
            transport,
            bindings,
            speed_m_s=robot.speed_m_s,
            position=self._last_position,
            stamp_s=lambda: self._telemetry.stamp_s,
            clock=clock.now,
            steady=steady,
            new_id=new_id,
        )
        self._captures = CaptureClient(transport, bindings, clock=clock.now, steady=steady, new_id=new_id, only=actions)
        self._implements = ImplementClient(transport, robot, bindings, clock=clock.now, steady=steady, only=actions)
        self._task: RunningDrive | RunningStretch | RunningCapture | None = None
        self._refused: GoalEnd | None = None
        self._lost: tuple[float, str] | None = None
        self._ended: GoalEnd | None = None
        self._count_from: tuple[int, float] | None = None
        self._begun_s, self._begun_m = 0.0, 0.0
        self._result = Progress(state="idle")

    @classmethod
    def connect(
        cls,
        transport: Transport,
        interfaces: Interfaces,
        site: Site,
        robot: RobotProfile,
        *,
        clock: Clock,
        steady: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
        look_every_s: float = LOOK_EVERY_S,
        within_s: float = READY_WITHIN_S,
        actions: Collection[str] | None = None,
        events: Collection[str] | None = None,
        new_id: Callable[[], bytes] = lambda: uuid.uuid4().bytes,
    ) -> Self:
        """Wait until the robot is available, idle and localized, and return its driver.

        Args:
            transport, site, robot, clock, steady, look_every_s, actions, events, new_id: As for the constructor.
            interfaces: Types that the transport can use.
            sleep: Sleeps for the given seconds of the steady clock.
            within_s: Seconds to wait for the robot.

        Raises:
            Ros2Error: A part of the robot is missing; all missing parts are named, with the cause where it is known.
        """
        driver = cls(
            transport,
            site,
            robot,
            clock=clock,
            steady=steady,
            look_every_s=look_every_s,
            actions=actions,
            events=events,
            new_id=new_id,
        )
        startup = Startup(
            transport,
            interfaces,
            navigation=driver._navigation,
            captures=driver._captures,
            implements=driver._implements,
            telemetry=driver._telemetry,
            events=driver._events,
            far=lambda: driver._far_from(site),
            rest=lambda: sleep(LOOK_EVERY_S),
            steady=steady,
        )
        try:
            startup.wait(within_s)
            startup.clear()
        except Ros2Error:
            driver.close()
            raise
        return driver

    @property
    def seed(self) -> int | None:
        return None

    def start_drive(self, goal: DriveGoal) -> None:
        work = goal.work
        if work is None:
            drive = RouteDrive if self._navigation.has_routes and goal.length_m > 0.0 else RunningDrive
            self._begin(lambda: drive(self._navigation, goal))
        else:
            self._begin(lambda: RunningStretch(self._navigation, self._implements, goal, work))

    def start_action(self, goal: ActionGoal) -> None:
        self._begin(lambda: RunningCapture(self._captures, goal))

    def poll(self) -> Progress:
        self._receive()
        if self._task is None:
            return self._result
        if self._refused is None and (cut := self._refusal()) is not None:
            self._refused = cut
            self._task.cancel()
        ending = self._ended or self._task.step()
        if ending is None:
            return self._progress(GoalEnd(state="running"))
        if isinstance(self._task, RunningDrive | RunningStretch) and not self._is_counted():
            self._ended = ending
            return self._progress(GoalEnd(state="running"))
        return self._finish(ending)

    def cancel(self) -> None:
        if self._task is not None:
            self._task.cancel()

    def next_event_in(self) -> float | None:
        return None if self._task is None else self._look_every_s

    def position(self) -> Position:
        self._telemetry.listen()
        position = self._last_position()
        assert position is not None  # noqa: S101  connected only where it is known
        heading = self._navigation.heading_of(self._telemetry.yaw)
        heading = self._navigation.heading_deg if heading is None else heading
        return position if heading is None else dataclasses.replace(position, heading_deg=heading)

    def charge_percent(self) -> float:
        self._telemetry.listen()
        return min(100.0, max(0.0, self._telemetry.charge_percent or 0.0))

    def lost(self) -> str | None:
        self._telemetry.listen()
        return self._is_lost()

    def events(self) -> Mapping[str, float | None]:
        self._events.listen()
        return self._events.values()

    def away(self) -> str | None:
        return self._navigation.away()

    def taken(self) -> str | None:
        return self._navigation.taken()

    def odometer_m(self) -> float | None:
        self._telemetry.listen()
        return self._telemetry.odometer_m

    def stopped(self) -> str | None:
        self._receive()
        return self._telemetry.stopped()

    def leave(self, sleep: Callable[[float], None] = time.sleep) -> None:
        """Cancel any remaining goal and wait up to :data:`LEAVE_S` seconds for it to end.

        Args:
            sleep: Sleeps for the given seconds of the steady clock.
        """
        clients = (*self._navigation.clients, *self._captures.actions)
        until = self._steady() + LEAVE_S
        if self._implements.is_on:
            for _ in self._implements.all_off():
                if self._steady() >= until:
                    break
                sleep(LOOK_EVERY_S)
        for client in clients:
            client.cancel("the driver was closed")
        while any(client.busy for client in clients) and self._steady() < until:
            for client in clients:
                client.step()
            sleep(LOOK_EVERY_S)

    def close(self) -> None:
        """Close all endpoints without sending anything; call :meth:`leave` first to cancel a running goal."""
        self._telemetry.close()
        self._events.close()
        self._navigation.close()
        self._captures.close()
        self._implements.close()

    # --- goals ---------------------------------------------------------------------------------------------------

    def _begin(self, task: Callable[[], RunningDrive | RunningStretch | RunningCapture]) -> None:
        if not self.poll().over:
            raise RuntimeError("a goal is running: a driver has one at a time")
        self._begun_s, self._begun_m = self._clock.now(), self._telemetry.metres
        if (refused := self._refusal()) is not None:
            self._result = self._progress(refused)
            return
        self._refused, self._task, self._ended, self._count_from = None, task(), None, None
        self.poll()  # sends the goal at once

    def _receive(self) -> None:
        """Process received messages. An abandoned goal that turns out to be running is cancelled here."""
        self._telemetry.listen()
        for client in (*self._navigation.clients, *self._captures.actions):
            client.step()

    def _refusal(self) -> GoalEnd | None:
        """Return why no goal can run now, as the end of such a goal; None if one can."""
        if (why := self._telemetry.stopped()) is not None:
            return GoalEnd(state="cancelled", what=why)
        if (why := self._is_lost()) is not None:
            return GoalEnd(state="failed", what=why, fault="lost")
        if (why := self._telemetry.silent()) is not None:
            return GoalEnd(state="failed", what=why, fault="failed")
        return None

    def _is_counted(self) -> bool:
        """Return True once the last metres of a finished drive were counted: odometry arrives a moment late."""
        received, now = self._telemetry.odometry_count, self._steady()
        if self._count_from is None:
            self._count_from = received, now
        before, since = self._count_from
        return received - before >= LAST_METRES or now - since >= LAST_METRES_S

    def _finish(self, ending: GoalEnd) -> Progress:
        cut = self._refused
        # A lost robot makes no capture and has not arrived; otherwise a goal that succeeded stays succeeded.
        if cut is not None and (cut.fault == "lost" or ending.state != "succeeded"):
            more = f"; {ending.what}" if ending.state == "failed" and ending.what else ""
            ending = dataclasses.replace(cut, what=f"{cut.what}{more}")
        elif ending.fault == "lost":
            self._lost = self._steady(), ending.what
        elif ending.state == "failed" and self._telemetry.charge_percent is not None and self.charge_percent() <= 0.0:
            ending = dataclasses.replace(ending, fault="empty", what=f"the battery is empty; {ending.what}")
        if ending.state == "cancelled" and not ending.what:
            ending = dataclasses.replace(ending, what="cancelled")
        self._task, self._refused = None, None
        self._result = self._progress(ending)
        return self._result

    def _progress(self, ending: GoalEnd) -> Progress:
        return Progress(
            state=ending.state,
            metres=self._telemetry.metres - self._begun_m,
            seconds=max(0.0, self._clock.now() - self._begun_s),
            readings=ending.readings,
            images=ending.images,
            what=ending.what,
            fault=ending.fault,
        )

    # --- robot state ---------------------------------------------------------------------------------------------

    def _last_position(self) -> Position | None:
        return self._telemetry.position

    def _is_lost(self) -> str | None:
        why = self._telemetry.lost() or self._far_from(self._site)
        if why is None and self._lost is not None:
            since, reason = self._lost
            return reason if self._steady() - since < LOST_S else None
        return why

    def _far_from(self, site: Site) -> str | None:
        """Return why the robot cannot be on the site; None if it can, or if its position is unknown."""
        position = self._last_position()
        if position is None:
            return None
        away = math.dist(position.xy, site.start.xy)
        if away <= _FAR_M:
            return None
        return f"the robot stands {away / 1000.0:.0f} km from the start of {site.name}: it is on another site"


def _bindings_of(robot: RobotProfile, actions: Collection[str] | None, events: Collection[str] | None) -> Ros2Bindings:
    """Return the ROS 2 bindings of a profile.

    Raises:
        Ros2Error: The profile has none, or does not bind an action or event that is needed.
    """
    if robot.ros2 is None:
        raise Ros2Error(
            f"the profile of {robot.name} does not define how the robot is reached over ROS 2",
            where=robot.source,
            advice="add a ros2 section (docs/formats.md)",
        )
    unbound = [name for name in actions or () if name not in robot.ros2.actions]
    if unbound:
        raise Ros2Error(
            f"the profile of {robot.name} does not define how the robot does {', '.join(unbound)} over ROS 2",
            where=robot.source,
            advice="name them under ros2: actions",
        )
    unheard = [name for name in events or () if name not in robot.ros2.events]
    if unheard:
        raise Ros2Error(
            f"the profile of {robot.name} does not define which topics report {', '.join(unheard)} over ROS 2",
            where=robot.source,
            advice="name them under ros2: events",
        )
    return robot.ros2
