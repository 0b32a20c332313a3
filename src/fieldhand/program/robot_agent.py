"""A robot that waits for signed missions, whatever it is told by: the agent's addresses, or services of ROS 2."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.mission_supervisor import MissionSupervisor
from fieldhand.delivery.received_missions import ReceivedMission

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.vehicle import Connection
    from fieldhand.missions import StoredMission
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site

#: Seconds within which the robot stands still before a program ends, and between two looks whether it does.
_RESTS_WITHIN_S, _LOOK_S = 5.0, 0.02


@dataclass(frozen=True, kw_only=True)
class RobotAgent:
    """What takes missions and carries them out, one at a time.

    Attributes:
        sites: On which the robot may work; empty for any.
        on: On what missions are carried out, in words.
        missing: What of the robot does not answer now, in words; nothing where missions are simulated.
        let_go: Ends what was opened beside.
    """

    robot: RobotProfile
    sites: tuple[Site, ...]
    mission_store: MissionStore
    supervisor: MissionSupervisor
    on: str = "simulation"
    missing: Callable[[], tuple[str, ...]] = tuple
    let_go: ExitStack = field(default_factory=ExitStack)

    def take(self, file: Path) -> ReceivedMission:
        """Verify a mission that lies on this machine, and keep it; from then on it may be started.

        Raises:
            BundleError: It cannot be read, or is no mission for this robot.
            NotTrustedError: Nobody who is trusted here has signed it.
            ExecutionError: The same mission is here with a later approval.
            StoreError: It cannot be kept.
        """
        import hashlib

        from fieldhand.approval.bundle.container import read_bundle_file

        data = read_bundle_file(file)
        with self.mission_store.receiving() as incoming:
            incoming.write(data)
            return self.mission_store.take(incoming, hashlib.sha256(data).hexdigest())[0]

    def pause_for_exit(self, within_s: float = _RESTS_WITHIN_S) -> None:
        """Let the robot stand still, if a mission is under way; ``resume`` goes on with it."""
        until = time.monotonic() + within_s

        def wait() -> bool:
            time.sleep(_LOOK_S)
            return time.monotonic() < until

        self.supervisor.pause_for_exit(wait)

    def close(self) -> None:
        """Let the robot stand still, and let go of everything: the program ends."""
        self.pause_for_exit()
        self.let_go.close()
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
    warn: Callable[[str], None],
) -> RobotAgent:
    """Compose the agent of a robot.

    Args:
        environ: Says where trusted keys lie, and what else is kept.
        robot, sites: Names or files.
        store: Folder of its missions; None for the one in the user's state folder.
        world, speed: Of the simulation.
        seed: Of the simulation, and of the guard.
        lenient: How sites are read.
        connection: How the robot is reached, at each mission anew; None for the simulation.
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

    profile = load_robot(robot)
    places = tuple(open_site(one, lenient=lenient) for one in sites)
    trusted = trust_store(environ)
    trusted.known()
    here = World() if world is None else load_world(world)
    memory = approval_memory(environ)

    def admit(bundle: Bundle) -> None:
        memory.admit(bundle.manifest, bundle.signer.fingerprint, clock=_now(), source="the mission")

    mission_store = MissionStore(
        store or missions.missions_folder(environ).parent / "agent",
        accept=acceptance(robot=profile, sites=places, trusted=trusted, now=_now),
        now=_now,
        admit=admit,
    )
    conclude = partial(_conclude, finished_missions.history_folder(environ), warn)
    if connection is None:
        supervisor = MissionSupervisor(
            mission_store,
            carry=partial(missions.carry_out, speed=speed, emit=lambda _: None),
            world=here,
            check=partial(_require_sound, here),
            conclude=conclude,
            seed=seed,
        )
        return RobotAgent(robot=profile, sites=places, mission_store=mission_store, supervisor=supervisor)
    from fieldhand.execution.drivers.registry import driver_kind
    from fieldhand.program.mission_connector import MissionConnector

    let_go, missing = ExitStack(), None
    with ExitStack() as stack:
        stack.callback(mission_store.close)
        kind = driver_kind(connection.transport)
        if kind.watch is not None:
            presence = kind.watch(profile, connection)
            let_go.callback(presence.close)
            missing = presence.missing
        connector = MissionConnector(connection, kind.connect)
        let_go.callback(connector.close)
        stack.pop_all()
    return RobotAgent(
        robot=profile,
        sites=places,
        mission_store=mission_store,
        supervisor=MissionSupervisor(
            mission_store, carry=connector.carry, check=connector.check, conclude=conclude, seed=seed
        ),
        on=str(connection),
        missing=missing or tuple,
        let_go=let_go,
    )


def _now() -> datetime:
    return datetime.now(UTC)


def _conclude(history: Path, warn: Callable[[str], None], stored: StoredMission) -> None:
    """Leave the report of a mission in its folder, and keep what it cost."""
    from fieldhand import finished_missions, mission, missions

    done = finished_missions.conclude(
        stored.authorized,
        stored.site,
        stored.robot,
        missions.events_of(stored.folder),
        estimate=mission.review(stored.authorized.task, stored.site, stored.robot).estimate,
        folder=stored.folder,
        history=history,
        at=_now(),
        bundle=stored.bundle,
    )
    if done.history_error:
        warn(done.history_error)


def _require_sound(world: World, bundle: Bundle) -> None:
    """The checks of whoever runs a mission by hand: the world fits it, and no check finds an error."""
    from fieldhand import mission
    from fieldhand.errors import NotApprovedError

    mission.check_world(world, bundle.site, bundle.robot)
    errors = mission.review(bundle.authorized.task, bundle.site, bundle.robot).errors
    if errors:
        raise NotApprovedError("; ".join(str(problem.line()) for problem in errors))
