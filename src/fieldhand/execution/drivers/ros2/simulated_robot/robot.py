"""The simulated robot as a ROS 2 node."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from fieldhand.clock import Clock
from fieldhand.errors import InputError
from fieldhand.execution.drivers.protocol import Progress
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.map_frame import degrees_to_map
from fieldhand.execution.drivers.ros2.navigation import FOLLOW_PATH, ROUTE
from fieldhand.execution.drivers.ros2.simulated_robot.action_server import ActionServer, GoalHandler
from fieldhand.execution.drivers.ros2.simulated_robot.camera_topics import CameraTopics
from fieldhand.execution.drivers.ros2.simulated_robot.capture_servers import CaptureCall, CaptureServer, capture_server
from fieldhand.execution.drivers.ros2.simulated_robot.controller_server import ControllerServer
from fieldhand.execution.drivers.ros2.simulated_robot.field_values import submessage
from fieldhand.execution.drivers.ros2.simulated_robot.lifecycle_servers import LifecycleServer
from fieldhand.execution.drivers.ros2.simulated_robot.navigation_server import NavigationServer
from fieldhand.execution.drivers.ros2.simulated_robot.navigator import Navigator
from fieldhand.execution.drivers.ros2.simulated_robot.place_lookup import PlaceLookup
from fieldhand.execution.drivers.ros2.simulated_robot.robot_platform import SimulatedPlatform
from fieldhand.execution.drivers.ros2.simulated_robot.route_server import RouteServer
from fieldhand.execution.drivers.ros2.simulated_robot.sensor_topics import SensorTopics
from fieldhand.execution.drivers.ros2.simulated_robot.speed_limit import SpeedLimit
from fieldhand.execution.drivers.ros2.simulated_robot.switch_server import SwitchServer
from fieldhand.execution.drivers.ros2.simulated_robot.telemetry_topics import TelemetryTopics
from fieldhand.execution.drivers.ros2.transport import QosProfile, RosMessage, Server, Transport
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.state import SimulationState
from fieldhand.execution.drivers.simulation.world import World, WorldFault
from fieldhand.robot.bindings import Datum, Ros2Bindings
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site

_CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
#: Simulators publish the time best effort, newest message only.
_CLOCK_QUALITY = QosProfile(reliable=False, depth=1)
#: Minimum time in seconds that a robot stands before its sensors measure, in seconds of its clock and of the wall
#: clock. Between two goals of one drive it stands only while its client reacts.
_SETTLED_S, _SETTLED_WALL_S = 0.5, 0.25


@dataclass(frozen=True, kw_only=True)
class GoalReport:
    """Report on a finished or rejected goal.

    Attributes:
        seconds: Time since the robot was first created.
        name: Full ROS name of the action or service.
        end: ``succeeded``, ``failed``, ``cancelled``, ``pre-empted`` or ``rejected``; of a switch ``on``, ``off`` or
            ``failed``.
        why: Reason of a failure or rejection; otherwise empty.
        place: The nearest tree or marker, or the one that was named; degrees if far from any.
        metres, took_s: Distance and duration of the goal.
        readings: Readings in the units of the profile.
        charge_percent: Battery charge at the end of the goal.
        off_m: Metres from where the robot is to where its navigation believes that it is.
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
    off_m: float = 0.0


#: Degrees short of a goal's heading at which it stops turning: the default of Nav2's goal checker (0.25 rad).
YAW_TOLERANCE_DEG = math.degrees(0.25)


class _StepClock:
    """A clock that advances only in :meth:`tick`.

    Everything that the robot sends in one step then has the same time, however long its process is delayed within the
    step.

    Attributes:
        wall_s: Time of day at the last tick.
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
        """Read the underlying clock."""
        self._now, self.wall_s = self._clock.now(), self._wall()


class SimulatedRobot:
    """A robot on a site that serves over ROS 2 what its profile binds.

    All work happens in :meth:`step`: nothing blocks, and no thread is started.

    Args:
        site, profile: Site and robot to simulate; the profile must have a ROS 2 part.
        world: Readings of its sensors, and faults.
        transport: Its node.
        interfaces: Definitions of the profile's release and its own.
        clock: Clock by which it drives.
        seed: Random seed.
        sim_time: True to publish ``/clock`` and stamp messages with it; False for the time of day.
        speed: Seconds of the clock per second of the wall clock, if it runs by itself.
        report: Called after each goal.
        state: State to continue from; None to begin at the start of the site.
        wall: Returns the time of day.

    Raises:
        InputError: The profile has no ROS 2 part.
        WorldError: The world does not fit the site or the robot.
        Ros2Error: A type is unknown, or a path does not exist in its type.
        ValueError: The state does not belong to such a robot.
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
        driver = SimulatedDriver(
            site, profile, world, self._clock, np.random.default_rng(seed), yaw_tolerance_deg=YAW_TOLERANCE_DEG
        )
        self._begun_s = self._clock.now()
        if state is not None:
            driver.restore(state)
            self._begun_s -= state.seconds
        self.platform = SimulatedPlatform(driver, site)
        self._limit = SpeedLimit(transport, bindings, profile.speed_m_s)
        self._places = PlaceLookup(site, profile)
        start = site.start
        self._datum = bindings.navigation.datum or Datum(lat=start.lat, lon=start.lon)
        self._nav: list[NavigationServer] = []
        #: Its route server; None if its profile does not name one.
        self.routes: RouteServer | None = None
        self._servers: list[ActionServer | CaptureServer | SwitchServer | LifecycleServer | Navigator] = []
        self._serve_navigation(site, profile, bindings, interfaces, transport, world.faults)
        self._sensors = SensorTopics(
            transport,
            interfaces,
            bindings,
            taken=TelemetryTopics.topics(bindings),
            measure=self._measure,
            header=lambda: self._stamped("base_link"),
        )
        self._cameras = CameraTopics(
            transport,
            bindings,
            view=lambda: (self._nearest(), self.platform.true_position),
            header=lambda: self._stamped("camera"),
        )
        for name, bound in bindings.actions.items():
            if bound.call is not None:
                full_name = bindings.whole_name(bound.call.name)
                capture_call = CaptureCall(
                    profile.doable[name],
                    bound.call,
                    interfaces,
                    self.platform,
                    self._places,
                    self._captured(full_name),
                    images=partial(self._cameras.answers, interfaces, bound.call),
                )
                self._servers.append(
                    capture_server(
                        capture_call, transport, full_name, stamp=self._stamp, refused=self._refused(full_name)
                    )
                )
            if bound.switch is not None:
                full_name = bindings.whole_name(bound.switch.name)
                self._servers.append(
                    SwitchServer(name, bound.switch, transport, full_name, self.platform, self._switched(full_name))
                )
        self._telemetry = TelemetryTopics(transport, interfaces, bindings, self.platform, stamped=self._stamped)
        self._from_ll: Server | None = None
        if bindings.navigation.from_ll:
            full_name = bindings.whole_name(bindings.navigation.from_ll)
            self._from_ll = transport.serve(full_name, "robot_localization/srv/FromLL")
        self._time = transport.publish("/clock", _CLOCK_TYPE, _CLOCK_QUALITY) if sim_time else None
        self._settles_s = max(_SETTLED_S, min(_SETTLED_WALL_S * speed, self._sensors.shortest_wait_s / 3.0))
        self._standing_s: float | None = None
        self._transport = transport

    @property
    def seconds(self) -> float:
        """Running time since the robot was first created, without interruptions."""
        return self._clock.now() - self._begun_s

    def state(self) -> SimulationState:
        """Return the state from which it can continue later."""
        self._clock.tick()
        return self.platform.state()

    def step(self) -> None:
        """Do what is due now: answer requests, drive, publish."""
        self._clock.tick()
        now = self._clock.now()
        if self._time is not None:
            self._time.send({"clock": self._stamp()})
        self.platform.step()
        for server in self._servers:
            server.step()
        for navigation in self._nav:
            navigation.step()
        if self.routes is not None:
            self.routes.step()
        for to, request in self._from_ll.requests() if self._from_ll is not None else ():
            self._locate(to, request)
        if self.platform.driving:
            self._standing_s = None
        elif self._standing_s is None:
            self._standing_s = now
        settled = self._standing_s is not None and now - self._standing_s >= self._settles_s
        if settled or self._standing_s is None:
            self._sensors.step(now, standing=settled)
        self._cameras.step(now)
        self._telemetry.step(now)

    def close(self) -> None:
        """Leave the ROS graph."""
        self._transport.close()

    def _serve_navigation(
        self,
        site: Site,
        profile: RobotProfile,
        bindings: Ros2Bindings,
        interfaces: Interfaces,
        transport: Transport,
        faults: Sequence[WorldFault],
    ) -> None:
        """Serve what Nav2 serves: the action that drives, the controller's, and the lifecycle of each node."""
        navigation = bindings.navigation

        def handler(action: str, type_name: str, controller: ControllerServer | None = None) -> NavigationServer:
            server = NavigationServer(
                bindings,
                interfaces,
                self.platform,
                site,
                self._places,
                self._datum,
                speed=self._limit.m_s,
                now=self._clock.now,
                stamped=self._stamped,
                report=self._ended(bindings.whole_name(action)),
                type_name=type_name,
                controller=controller,
            )
            self._nav.append(server)
            return server

        def serve(action: str, type_name: str, handles: GoalHandler) -> ActionServer:
            name = bindings.whole_name(action)
            return ActionServer(transport, name, type_name, handles, stamp=self._stamp, refused=self._refused(name))

        controller: ControllerServer | None = None
        drives_itself = (navigation.type, navigation.action) == (FOLLOW_PATH, navigation.follow_path)
        if navigation.follow_path and not drives_itself:
            action = navigation.follow_path
            report = self._ended(bindings.whole_name(action))
            controller = ControllerServer(self.platform, handler(action, FOLLOW_PATH), report)
            controller.server = serve(action, FOLLOW_PATH, controller)
            self._servers.append(controller.server)
        if navigation.working and (navigation.working, navigation.working_action) != (
            FOLLOW_PATH,
            navigation.follow_path,
        ):
            works, works_by = navigation.working_action, navigation.working
            self._servers.append(serve(works, works_by, handler(works, works_by)))
        states = [LifecycleServer(transport, bindings.whole_name(node)) for node in navigation.nodes]
        action, kind = navigation.action, navigation.type
        if kind == ROUTE:
            self.routes = RouteServer(
                navigation,
                kind,
                interfaces,
                self.platform,
                site,
                profile,
                self._datum,
                stamped=self._stamped,
                report=self._ended(bindings.whole_name(action)),
            )
            self._servers += [*states, serve(action, kind, self.routes)]
            return
        self._servers += states[1:]
        driving = handler(action, kind, controller)
        self._servers.append(
            Navigator(
                driving,
                lambda: serve(action, kind, driving),
                states[0] if states else None,
                faults,
                tree_of=self.platform.tree_of,
                metres=lambda: self.platform.metres,
                now=self._clock.now,
            )
        )

    def _ended(self, full_name: str) -> Callable[[str, Progress], None]:
        return lambda end, progress: self._report_goal(full_name, end, self._nearest(), progress)

    def _measure(self, action: str) -> Mapping[str, float]:
        return self.platform.read_sensors(action, self._nearest())

    def _captured(self, full_name: str) -> Callable[[str, Place, Progress], None]:
        def over(action: str, place: Place, progress: Progress) -> None:
            self._sensors.captured(action, progress.readings, self._clock.now())
            self._report_goal(full_name, progress.state, place, progress)

        return over

    def _switched(self, full_name: str) -> Callable[[bool, str], None]:
        def over(on: bool, why: str) -> None:
            end = "failed" if why else "on" if on else "off"
            self._report_goal(full_name, end, self._nearest(), Progress(state="succeeded", what=why))

        return over

    def _refused(self, full_name: str) -> Callable[[str], None]:
        return lambda why: self._report_goal(full_name, "rejected", self._nearest(), Progress(state="failed", what=why))

    def _report_goal(self, name: str, end: str, place: Place, progress: Progress) -> None:
        self._report(
            GoalReport(
                seconds=self.seconds,
                name=name,
                end=end,
                why=progress.what,
                place=_place_text(place),
                metres=progress.metres,
                took_s=progress.seconds,
                readings=progress.readings,
                charge_percent=self.platform.charge_percent,
                off_m=math.dist(self.platform.position.xy, self.platform.true_position.xy),
            )
        )

    def _nearest(self) -> Place:
        at = self.platform.true_position
        return self._places.nearest(at.xy)

    def _locate(self, to: object, request: RosMessage) -> None:
        """Answer ``fromLL`` like robot_localization: convert degrees to the map frame."""
        assert self._from_ll is not None  # noqa: S101  asked for by who serves it
        point = submessage(request, "ll_point")
        lat, lon = (float(v) if isinstance(v, float) else math.nan for v in map(point.get, ("latitude", "longitude")))
        ((x, y),) = degrees_to_map(self._datum, [(lat, lon)])
        self._from_ll.reply(to, {"map_point": {"x": x, "y": y, "z": 0.0}})

    def _stamp(self) -> Mapping[str, int]:
        seconds = self.seconds if self._sim_time else self._clock.wall_s
        return {"sec": int(seconds), "nanosec": int(seconds % 1.0 * 1e9)}

    def _stamped(self, frame: str) -> RosMessage:
        return {"stamp": self._stamp(), "frame_id": frame}


def _place_text(place: Place) -> str:
    return f"{place.lat:.6f}, {place.lon:.6f}" if place.kind == "point" else f"{place.kind} {place.id}"


def bindings_of(profile: RobotProfile) -> Ros2Bindings:
    """Return the ROS 2 bindings of a profile.

    Raises:
        InputError: The profile has none.
    """
    if profile.ros2 is None:
        raise InputError(
            f"the robot {profile.name} has no ros2 section in its profile",
            where=profile.source,
            advice="name its topics, services and actions there (docs/add-a-robot.md)",
        )
    return profile.ros2
