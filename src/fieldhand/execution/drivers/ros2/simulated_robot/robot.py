"""The simulated robot as ROS 2 sees it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from fieldhand.clock import Clock
from fieldhand.errors import InputError
from fieldhand.execution.drivers.protocol import Progress
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.map_frame import degrees_to_map
from fieldhand.execution.drivers.ros2.simulated_robot.action_server import ActionServer
from fieldhand.execution.drivers.ros2.simulated_robot.capture_servers import CaptureCall, CaptureServer, capture_server
from fieldhand.execution.drivers.ros2.simulated_robot.field_values import submessage
from fieldhand.execution.drivers.ros2.simulated_robot.navigation_server import NavigationServer
from fieldhand.execution.drivers.ros2.simulated_robot.place_lookup import PlaceLookup
from fieldhand.execution.drivers.ros2.simulated_robot.robot_platform import SimulatedPlatform
from fieldhand.execution.drivers.ros2.simulated_robot.sensor_topics import SensorTopics
from fieldhand.execution.drivers.ros2.simulated_robot.speed_limit import SpeedLimit
from fieldhand.execution.drivers.ros2.simulated_robot.telemetry_topics import TelemetryTopics
from fieldhand.execution.drivers.ros2.transport import Message, QosProfile, Server, Transport
from fieldhand.execution.drivers.simulation import SimulatedDriver
from fieldhand.execution.drivers.simulation_state import SimulationState
from fieldhand.execution.world import World
from fieldhand.robot.bindings import Datum, Ros2Bindings
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site

_CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
#: Simulators send the time to whoever listens, and never twice.
_CLOCK_QUALITY = QosProfile(reliable=False, depth=1)
#: Seconds that a robot stands before its sensors measure, at the least; and how much of a second of the wall clock:
#: between two goals of one drive it stands for as long as its client needs.
_SETTLED_S, _SETTLED_WALL_S = 0.5, 0.25


@dataclass(frozen=True, kw_only=True)
class GoalReport:
    """What the robot says of a goal that is over, or was rejected.

    Attributes:
        seconds: Since the robot was first made.
        name: Whole name of what was asked, by ROS.
        end: ``succeeded``, ``failed``, ``cancelled``, ``pre-empted`` or ``rejected``.
        why: It failed or was rejected; empty where it was not.
        place: The nearest tree or marker, or the one that was named; degrees far from any.
        metres, took_s: Of the goal.
        readings: In the units of the profile.
        charge_percent: Of the battery, then.
    """

    seconds: float
    name: str
    end: str
    why: str = ""
    place: str = ""
    metres: float = 0.0
    took_s: float = 0.0
    readings: Mapping[str, float] = field(default_factory=dict)
    charge_percent: float = 0.0


class _StepClock:
    """A clock that stands still between two calls of :meth:`tick`.

    All that the robot sends in one step then belongs to one moment, however long its process waits within the step.

    Attributes:
        wall_s: The time of day of that moment.
    """

    def __init__(self, clock: Clock, wall: Callable[[], float]) -> None:
        self._clock, self._wall = clock, wall
        self.tick()

    def now(self) -> float:
        return self._now

    def advance(self, seconds: float) -> None:
        self._clock.advance(seconds)
        self.tick()

    def tick(self) -> None:
        """Take the time of the clock beneath."""
        self._now, self.wall_s = self._clock.now(), self._wall()


class SimulatedRobot:
    """A robot that stands on a site and answers by ROS 2 what its profile binds.

    Everything happens in :meth:`step`: nothing waits, and no thread is begun.

    Args:
        site, profile: What is simulated; the profile says how it is reached.
        world: What its sensors read, and what goes wrong with it.
        transport: Its node.
        interfaces: Types of the profile's release, with its own.
        clock: In whose seconds it drives.
        seed: Of every random thing.
        sim_time: Say the time on ``/clock``, and stamp messages by it; otherwise they have the time of day.
        speed: Seconds of the clock in one of the wall clock, where it passes by itself.
        say: Told of each goal.
        memory: Of the robot that it goes on as; None for one at the start of the site.
        wall: The time of day.

    Raises:
        InputError: The profile does not say how the robot is reached.
        WorldError: The world does not fit the site or the robot.
        Ros2Error: A type is not known, or a path leads nowhere in its type.
        ValueError: The memory is of no such robot.
    """

    def __init__(
        self,
        site: Site,
        profile: RobotProfile,
        world: World,
        transport: Transport,
        interfaces: Interfaces,
        clock: Clock,
        *,
        seed: int,
        sim_time: bool = False,
        speed: float = 1.0,
        report: Callable[[GoalReport], None] = lambda _: None,
        state: SimulationState | None = None,
        wall: Callable[[], float] = time.time,
    ) -> None:
        bindings = bindings_of(profile)
        self._clock, self._report, self._sim_time = _StepClock(clock, wall), report, sim_time
        driver = SimulatedDriver(site, profile, world, self._clock, np.random.default_rng(seed))
        self._begun_s = self._clock.now()
        if state is not None:
            driver.restore(state)
            self._begun_s -= state.seconds
        self.platform = SimulatedPlatform(driver, site)
        self._limit = SpeedLimit(transport, bindings, profile.speed_m_s)
        self._places = PlaceLookup(site, profile)
        start = site.start
        self._datum = bindings.navigation.datum or Datum(lat=start.lat, lon=start.lon)
        self._servers: list[CaptureServer] = [self._navigation(site, bindings, interfaces, transport)]
        self._sensors = SensorTopics(
            transport,
            interfaces,
            bindings,
            taken=TelemetryTopics.topics(bindings),
            measure=self._measure,
            header=lambda: self._stamped("base_link"),
        )
        for name, bound in bindings.actions.items():
            if bound.call is not None:
                whole = bindings.whole_name(bound.call.name)
                capture_call = CaptureCall(
                    profile.action[name], bound.call, interfaces, self.platform, self._places, self._captured(whole)
                )
                self._servers.append(
                    capture_server(capture_call, transport, whole, stamp=self._stamp, refused=self._refused(whole))
                )
        self._telemetry = TelemetryTopics(transport, interfaces, bindings, self.platform, stamped=self._stamped)
        self._from_ll: Server | None = None
        if bindings.navigation.from_ll:
            whole = bindings.whole_name(bindings.navigation.from_ll)
            self._from_ll = transport.serve(whole, "robot_localization/srv/FromLL")
        self._time = transport.publish("/clock", _CLOCK_TYPE, _CLOCK_QUALITY) if sim_time else None
        self._settles_s = max(_SETTLED_S, min(_SETTLED_WALL_S * speed, self._sensors.shortest_wait_s / 3.0))
        self._standing_s: float | None = None
        self._transport = transport

    @property
    def seconds(self) -> float:
        """Since the robot was first made, without the time between its end and its next beginning."""
        return self._clock.now() - self._begun_s

    def state(self) -> SimulationState:
        """By which it goes on later from where it stands now."""
        self._clock.tick()
        return self.platform.state()

    def step(self) -> None:
        """Do what is due now: answer, drive on, say how it is."""
        self._clock.tick()
        now = self._clock.now()
        if self._time is not None:
            self._time.send({"clock": self._stamp()})
        self.platform.step()
        for server in self._servers:
            server.step()
        self._nav.step()
        for to, request in self._from_ll.requests() if self._from_ll is not None else ():
            self._locate(to, request)
        if self.platform.driving:
            self._standing_s = None
        elif self._standing_s is None:
            self._standing_s = now
        settled = self._standing_s is not None and now - self._standing_s >= self._settles_s
        if settled or self._standing_s is None:
            self._sensors.step(now, standing=settled)
        self._telemetry.step(now)

    def close(self) -> None:
        """Leave the graph."""
        self._transport.close()

    def _navigation(
        self, site: Site, bindings: Ros2Bindings, interfaces: Interfaces, transport: Transport
    ) -> ActionServer:
        name = bindings.whole_name(bindings.navigation.action)
        self._nav = NavigationServer(
            bindings,
            interfaces,
            self.platform,
            site,
            self._places,
            self._datum,
            speed=self._limit.m_s,
            now=self._clock.now,
            stamped=self._stamped,
            report=lambda end, progress: self._tell(name, end, self._nearest(), progress),
        )
        return ActionServer(
            transport, name, bindings.navigation.type, self._nav, stamp=self._stamp, refused=self._refused(name)
        )

    def _measure(self, action: str) -> Mapping[str, float]:
        return self.platform.sense(action, self._nearest())

    def _captured(self, whole: str) -> Callable[[str, Place, Progress], None]:
        def over(action: str, place: Place, progress: Progress) -> None:
            self._sensors.captured(action, progress.readings, self._clock.now())
            self._tell(whole, progress.state, place, progress)

        return over

    def _refused(self, whole: str) -> Callable[[str], None]:
        return lambda why: self._tell(whole, "rejected", self._nearest(), Progress(state="failed", what=why))

    def _tell(self, name: str, end: str, place: Place, progress: Progress) -> None:
        self._report(
            GoalReport(
                seconds=self.seconds,
                name=name,
                end=end,
                why=progress.what,
                place=_called(place),
                metres=progress.metres,
                took_s=progress.seconds,
                readings=progress.readings,
                charge_percent=self.platform.charge_percent,
            )
        )

    def _nearest(self) -> Place:
        at = self.platform.position
        return self._places.nearest((at.x, at.y))

    def _locate(self, to: object, request: Message) -> None:
        """Degrees to the map frame, as robot_localization's ``fromLL``."""
        assert self._from_ll is not None  # noqa: S101  asked for by who serves it
        point = submessage(request, "ll_point")
        lat, lon = (float(v) if isinstance(v, float) else math.nan for v in map(point.get, ("latitude", "longitude")))
        ((x, y),) = degrees_to_map(self._datum, [(lat, lon)])
        self._from_ll.reply(to, {"map_point": {"x": x, "y": y, "z": 0.0}})

    def _stamp(self) -> Mapping[str, int]:
        seconds = self.seconds if self._sim_time else self._clock.wall_s
        return {"sec": int(seconds), "nanosec": int(seconds % 1.0 * 1e9)}

    def _stamped(self, frame: str) -> Message:
        return {"stamp": self._stamp(), "frame_id": frame}


def _called(place: Place) -> str:
    return f"{place.lat:.6f}, {place.lon:.6f}" if place.kind == "point" else f"{place.kind} {place.id}"


def bindings_of(profile: RobotProfile) -> Ros2Bindings:
    """How a robot is reached.

    Raises:
        InputError: Its profile does not say it.
    """
    if profile.ros2 is None:
        raise InputError(
            f"the robot {profile.name} has no part ros2 in its profile",
            where=profile.source,
            advice="say there what its topics, services and actions are called (docs/add-a-robot.md)",
        )
    return profile.ros2
