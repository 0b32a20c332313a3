"""Missions of an agent on a real robot: none begins that could not, and the robot is let go whatever becomes of one."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from fieldhand import missions
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.clock import SimulatedClock
from fieldhand.delivery.bundle_checks import acceptance, sha256_of
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.mission_supervisor import MissionSupervisor, ReceivedStatus
from fieldhand.errors import ExecutionError, FieldhandError, NotApprovedError, Ros2Error
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.journal import store
from fieldhand.execution.operator_commands import parse_agent_command
from fieldhand.execution.vehicle import Connection, Vehicle
from fieldhand.program.mission_connector import MissionConnector
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from support.missions.signed import KEY, NOW, good
from support.processes.patience import LONG_S
from support.processes.robot_agents import fly, other_mission

BY = Connection(transport="dds", domain=3)


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


class Agent:
    """An agent whose robot is in this process.

    Attributes:
        silent: The robot does not answer.
        reached, let_go: How often it was reached, and let go of.
    """

    def __init__(self, folder: Path) -> None:
        self.silent, self.charge, self.reached, self.let_go = False, 90.0, 0, 0
        trusted = TrustStore(folder / "config")
        trusted.trust(KEY.public, name="Ada", at=NOW)
        accept = acceptance(robot=load_robot("husky"), sites=(), trusted=trusted, now=lambda: NOW)
        self.mission_store = MissionStore(folder / "store", accept=accept, now=lambda: NOW)
        self.begin()
        for data in (good(), other_mission()):
            with self.mission_store.receiving() as part:
                part.write(data)
                self.mission_store.take(part, sha256_of(data))

    def begin(self) -> None:
        """Start it, as after a power cut."""
        self.connector = MissionConnector(BY, self.connect)
        self.supervisor = MissionSupervisor(self.mission_store, carry=self.connector.carry, check=self.connector.check)

    @contextmanager
    def connect(
        self, site: Site, robot: RobotProfile, task: Task, by: Connection, within_s: float
    ) -> Iterator[Vehicle]:
        assert task.composition.plan
        assert by == BY
        assert within_s > 0
        if self.silent:
            raise Ros2Error("the robot is not ready", advice="switch it on")
        self.reached += 1
        clock = SimulatedClock()
        driver = SimulatedDriver(site, robot, World(charge_percent=self.charge), clock, np.random.default_rng(0))
        try:
            yield Vehicle(driver=driver, clock=clock, charge_percent=self.charge, by=by)
        finally:
            self.let_go += 1

    def tell(self, data: bytes, said: str) -> ReceivedStatus:
        held = self.mission_store.get(sha256_of(data))
        self.supervisor.give_command(held, parse_agent_command(said), "a test")
        self.supervisor.join(LONG_S)
        return self.supervisor.status_of(held)

    def folders(self) -> list[str]:
        return [folder.name for folder in (self.mission_store.missions).iterdir()]


@pytest.fixture
def agent(tmp_path: Path) -> Agent:
    return Agent(tmp_path)


def test_a_mission_is_carried_out_on_the_robot_that_was_looked_at(agent: Agent) -> None:
    found = agent.tell(good(), "start")
    assert (found.state, found.status) == ("ended", "completed")
    assert (agent.reached, agent.let_go) == (1, 1)
    started_on = missions.read_folder(
        agent.mission_store.folder_of(agent.mission_store.get(sha256_of(good())))
    ).started_on
    assert started_on == missions.RobotAtStart(by=BY, charge_percent=90.0)


@pytest.mark.parametrize(("silent", "charge"), [(True, 90.0), (False, 15.0)])
def test_a_mission_that_cannot_begin_leaves_nothing_in_the_way(agent: Agent, silent: bool, charge: float) -> None:
    agent.silent, agent.charge = silent, charge
    with pytest.raises((Ros2Error, NotApprovedError), match=r"switch it on|charge it first"):
        agent.tell(good(), "start")
    assert agent.folders() == []
    assert agent.reached == agent.let_go
    agent.silent, agent.charge = False, 90.0
    assert agent.tell(other_mission(), "start").status == "completed"
    assert agent.tell(good(), "start").status == "completed"


def test_a_robot_that_was_reached_for_one_mission_carries_no_other_out(
    agent: Agent, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as broken:
        broken.setattr(missions, "begin", lambda *_: (_ for _ in ()).throw(FieldhandError("the disk is full")))
        with pytest.raises(FieldhandError, match="the disk is full"):
            agent.tell(good(), "start")
    assert (agent.reached, agent.let_go) == (1, 0)
    assert agent.tell(other_mission(), "start").status == "completed"
    assert (agent.reached, agent.let_go) == (2, 2)
    agent.connector.close()
    assert agent.let_go == 2


def test_a_mission_that_was_cut_off_reaches_its_robot_anew(agent: Agent, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(missions, "carry_out", lambda *_, **__: None)  # the power is cut before the first tick
    assert agent.tell(good(), "start").state == "interrupted"
    monkeypatch.undo()
    agent.begin()
    agent.silent = True
    found = agent.tell(good(), "resume")
    assert found.state == "interrupted"
    assert "the robot is not ready" in found.fault
    agent.silent = False
    assert agent.tell(good(), "resume").status == "completed"
    assert (agent.reached, agent.let_go) == (2, 2)


def test_a_mission_of_the_simulation_does_not_go_on_on_the_robot(agent: Agent) -> None:
    agent.supervisor = MissionSupervisor(agent.mission_store, carry=lambda _: None)
    assert agent.tell(good(), "start").state == "interrupted"
    agent.begin()
    found = agent.tell(good(), "resume")
    assert "started in simulation and cannot be continued on a robot" in found.fault
    assert agent.reached == 0
    given = missions.open_mission(agent.mission_store.folder_of(agent.mission_store.get(sha256_of(good()))))
    assert given.started_on is None
    fly(given)
    with pytest.raises(ExecutionError, match="has ended"):
        agent.tell(good(), "resume")
