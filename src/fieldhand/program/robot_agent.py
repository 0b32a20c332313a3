"""The agent of a robot: it stores signed missions and carries them out, behind a REST API or services of ROS 2."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from datetime import datetime, tzinfo
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict

from fieldhand.compatibility import UTC
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.mission_supervisor import MissionSupervisor
from fieldhand.delivery.received_missions import ReceivedMission
from fieldhand.program.review_cache import ReviewCache

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.vehicle import Connection
    from fieldhand.missions import StoredMission
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site

#: Seconds within which the robot must stop before the program ends, and between two checks.
_STOPS_WITHIN_S, _CHECK_S = 5.0, 0.02


@dataclass(frozen=True, kw_only=True)
class RobotAgent:
    """The agent of a robot, which receives missions and carries them out, one at a time.

    Attributes:
        robot: Profile of the robot.
        sites: Sites on which the robot may work; empty for any.
        mission_store: Missions that were received.
        supervisor: Supervisor that carries them out.
        on: Driver of the missions, in words.
        missing: Returns the parts of the robot that do not respond, in words; none in simulation.
        resources: Connections that are closed with the agent.
    """

    robot: RobotProfile
    sites: tuple[Site, ...]
    mission_store: MissionStore
    supervisor: MissionSupervisor
    on: str = "simulation"
    missing: Callable[[], tuple[str, ...]] = tuple
    resources: ExitStack = field(default_factory=ExitStack)

    def take(self, file: Path) -> ReceivedMission:
        """Verify and store a signed mission from a file, so that it can be started.

        Raises:
            BundleError: The file cannot be read, or is not a mission for this robot.
            NotTrustedError: Its key is not trusted here.
            ExecutionError: The same mission was received with a later approval.
            StoreError: The mission cannot be stored.
        """
        import hashlib

        from fieldhand.approval.bundle.container import read_bundle_file

        data = read_bundle_file(file)
        with self.mission_store.receiving() as incoming:
            incoming.write(data)
            return self.mission_store.take(incoming, hashlib.sha256(data).hexdigest())[0]

    def pause_for_exit(self, within_s: float = _STOPS_WITHIN_S) -> None:
        """Pause the running mission, if there is one, and wait until the robot stops; ``resume`` continues it."""
        until = time.monotonic() + within_s

        def wait() -> bool:
            time.sleep(_CHECK_S)
            return time.monotonic() < until

        self.supervisor.pause_for_exit(wait)

    def close(self) -> None:
        """Pause the running mission, begin no other run, and close all connections and the store."""
        self.supervisor.timetables.close()
        self.pause_for_exit()
        self.resources.close()
        self.mission_store.close()


def compose_robot_agent(
    environ: Mapping[str, str],
    *,
    robot: str,
    sites: tuple[str, ...] = (),
    store: Path | None = None,
    world: Path | None = None,
    seed: int = 0,
    speed: float | None = None,
    lenient: bool = False,
    connection: Connection | None = None,
    zone: str = "",
    warn: Callable[[str], None],
) -> RobotAgent:
    """Compose the agent of a robot.

    Args:
        environ: Environment variables that name the folders of trusted keys and of stored data.
        robot: Name or file of the robot profile.
        sites: Names or files of the sites.
        store: Folder of its missions; None for the one in the user's state folder.
        world: World file of the simulation.
        seed: Seed of the simulation and of the budget guard.
        speed: Simulated seconds per second; None for as fast as possible.
        lenient: True to read sites leniently.
        connection: Connection to the robot, opened for each mission; None for the simulation.
        zone: Time zone of the robot, for timetables that state none; empty for that of this machine.
        warn: Prints a warning when the cost of a mission cannot be recorded.

    Raises:
        InputError: Robot, site, world, store or trusted keys cannot be used.
    """
    from functools import partial

    from fieldhand import finished_missions, missions
    from fieldhand.approval.memory import approval_memory, trust_store
    from fieldhand.delivery.bundle_checks import acceptance
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.drivers.simulation.world_file import load_world
    from fieldhand.robot.loader import load_robot
    from fieldhand.site.loader import open_site
    from fieldhand.timetable.day_times import local_zone, zone_of

    profile = load_robot(robot)
    places = tuple(open_site(one, lenient=lenient) for one in sites)
    trusted = trust_store(environ)
    trusted.known()
    simulated_world = World() if world is None else load_world(world)
    memory = approval_memory(environ)

    def admit(bundle: Bundle) -> None:
        memory.admit(bundle.manifest, bundle.signer.fingerprint, clock=_now(), source="the mission")

    mission_store = MissionStore(
        store or missions.missions_folder(environ).parent / "agent",
        accept=acceptance(robot=profile, sites=places, trusted=trusted, now=_now),
        now=_now,
        admit=admit,
    )
    reviews = ReviewCache()

    def lasts(bundle: Bundle) -> float:
        estimate = reviews.review(bundle.authorized, bundle.site, bundle.robot).estimate
        return 0.0 if estimate is None else max(branch.seconds.p90 for branch in estimate.branches)

    times: _Times = {"now": _now, "zone": zone_of(zone, local_zone(environ)), "lasts": lasts}
    conclude = partial(_conclude, reviews, finished_missions.history_folder(environ), warn)
    if connection is None:
        supervisor = MissionSupervisor(
            mission_store,
            carry=partial(missions.carry_out, speed=speed, emit=lambda _: None),
            world=simulated_world,
            check=partial(_require_valid, reviews, simulated_world),
            conclude=conclude,
            seed=seed,
            simulated=True,
            **times,
        )
        return RobotAgent(robot=profile, sites=places, mission_store=mission_store, supervisor=supervisor)
    from fieldhand.execution.drivers.registry import driver_kind
    from fieldhand.program.mission_connector import MissionConnector

    resources, missing = ExitStack(), None
    with ExitStack() as stack:
        stack.callback(mission_store.close)
        kind = driver_kind(connection.transport)
        if kind.watch is not None:
            presence = kind.watch(profile, connection)
            resources.callback(presence.close)
            missing = presence.missing
        connector = MissionConnector(connection, kind.connect, reviews)
        resources.callback(connector.close)
        stack.pop_all()
    return RobotAgent(
        robot=profile,
        sites=places,
        mission_store=mission_store,
        supervisor=MissionSupervisor(
            mission_store, carry=connector.carry, check=connector.check, conclude=conclude, seed=seed, **times
        ),
        on=str(connection),
        missing=missing or tuple,
        resources=resources,
    )


class _Times(TypedDict):
    """Clock, time zone and durations for the supervisor of missions."""

    now: Callable[[], datetime]
    zone: tzinfo
    lasts: Callable[[Bundle], float]


def _now() -> datetime:
    return datetime.now(UTC)


def _conclude(reviews: ReviewCache, history: Path, warn: Callable[[str], None], stored: StoredMission) -> None:
    """Write the report of a mission to its folder, and record its cost for calibration."""
    from fieldhand import finished_missions, missions

    done = finished_missions.conclude(
        stored.authorized,
        stored.site,
        stored.robot,
        missions.events_of(stored.folder),
        estimate=reviews.review(stored.authorized, stored.site, stored.robot).estimate,
        folder=stored.folder,
        history=history,
        at=_now(),
        bundle=stored.bundle,
        images=stored.folder,
    )
    if done.history_error:
        warn(done.history_error)


def _require_valid(reviews: ReviewCache, world: World, bundle: Bundle) -> None:
    """Require that the world fits a mission, and that no check finds an error.

    Raises:
        WorldError: The world does not fit.
        NotApprovedError: A check found an error.
    """
    from fieldhand import mission
    from fieldhand.errors import NotApprovedError

    mission.check_world(world, bundle.site, bundle.robot)
    errors = reviews.review(bundle.authorized, bundle.site, bundle.robot).errors
    if errors:
        raise NotApprovedError("; ".join(str(problem.line()) for problem in errors))
