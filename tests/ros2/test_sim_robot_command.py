"""``fieldhand sim-robot``: a robot in a process of its own, over real DDS; killed, it goes on where it stood."""

from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
import yaml

from fieldhand.execution.drivers.protocol import ActionGoal
from fieldhand.execution.drivers.ros2.dds import open_dds
from fieldhand.execution.drivers.ros2.driver import Ros2Driver
from fieldhand.execution.drivers.ros2.ros_clock import RosClock
from fieldhand.robot.loader import load_robot, profile_bytes
from fieldhand.site.loader import open_site
from fieldhand.testing.driver_contract import drive_goal
from ros2.sim_robots import patient
from ros2.simulated_robot_rig import interfaces_of
from support.processes.command import fieldhand
from support.processes.patience import LONG_S, until

WORLD = {
    "readings": {"co2": 377},
    "charge_percent": 80,
    "faults": [{"fault": "action_fails", "action": "read_co2", "times": 1}],
}


@contextmanager
def sim_robot(*words: str) -> Iterator[subprocess.Popen[str]]:
    """A robot that is ready."""
    command = [sys.executable, "-m", "fieldhand", "sim-robot", "--site", "demo", "--json", *words]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
        try:
            assert line(process)["event"] == "ready"
            yield process
        finally:
            process.kill()


def line(process: subprocess.Popen[str]) -> dict[str, Any]:
    assert process.stdout is not None
    said = json.loads(process.stdout.readline())
    assert isinstance(said, dict)
    return said


def kept(state: Path) -> tuple[float, float]:
    """Where the robot would go on."""
    written = json.loads(state.read_text())
    return written["x"], written["y"]


def test_a_killed_robot_goes_on_where_it_stood_and_a_told_one_ends_in_order(tmp_path: Path) -> None:
    world, state = tmp_path / "world.yaml", tmp_path / "state.json"
    world.write_text(yaml.safe_dump(WORLD))
    husky = str(patient(tmp_path))
    words = ("--robot", husky, "--world", str(world), "--speed", "20", "--state", str(state))
    site, robot = open_site("demo"), load_robot(husky)
    assert robot.ros2 is not None
    interfaces = interfaces_of(robot.ros2.release, tuple(robot.ros2.interfaces.items()))
    capture = ActionGoal(action="read_co2", place=site.trees[0].place)

    @contextmanager
    def connected() -> Iterator[Ros2Driver]:
        node = open_dds(interfaces)  # a new one: an old one believes for ten seconds that who was killed is still there
        yield Ros2Driver.connect(
            node, interfaces, site, robot, clock=RosClock.wait_for_first(node, LONG_S), within_s=LONG_S
        )
        node.close()

    def finish(driver: Ros2Driver) -> Any:
        return until(lambda: (p := driver.poll()).over and p)

    with sim_robot(*words) as process, connected() as driver:
        driver.start_action(capture)
        assert "gave an error" in finish(driver).what  # once
        assert line(process)["name"] == "/co2_sensor/read"
        start = kept(state)
        driver.start_drive(drive_goal(site.start, site.trees[-1].place))
        until(lambda: driver.poll() and math.dist(start, kept(state)) > 20.0)
        process.send_signal(signal.SIGKILL)
        process.wait(LONG_S)
    at, charge = kept(state), json.loads(state.read_text())["charge_percent"]
    assert math.dist(start, at) > 20.0
    assert charge < 80.0
    with sim_robot(*words) as process, connected() as driver:
        here = driver.position()
        assert math.dist(at, (here.x, here.y)) < 0.1
        assert driver.charge_percent() == pytest.approx(charge, abs=1e-3)
        driver.start_action(capture)
        assert finish(driver).readings == {"co2": 377.0}
        assert line(process)["readings"] == {"co2": 377.0}
        process.send_signal(signal.SIGTERM)
        assert line(process) == {"event": "ended", "why": "the program was told to end (SIGTERM)"}
        assert process.wait(LONG_S) == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--on", "pigeon"), "--on: there is no transport 'pigeon'; give dds or rclpy"),
        (("--speed", "0"), "--speed: 0 is not a valid speed; give a number above 0"),
        (("--speed", "nan"), "--speed: nan is not a valid speed; give a number above 0"),
        (("--namespace", "a b"), "--namespace: 'a b' is not a ROS name; use letters"),
        (("--robot", "plain.yaml"), "plain.yaml: the robot husky has no ros2 section in its profile; name its topics"),
        (
            ("--state", "state.json"),
            "state.json: is not the state of a simulated robot: format Field required; remove it",
        ),
        (("--world", "no.yaml"), "no.yaml: cannot be read"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(tmp_path: Path, words: tuple[str, ...], said: str) -> None:
    profile = yaml.safe_load(profile_bytes("husky")[0])
    del profile["ros2"]
    (tmp_path / "plain.yaml").write_text(yaml.safe_dump(profile))
    (tmp_path / "state.json").write_text("{}")
    run = fieldhand("sim-robot", "--site", "demo", *words, cwd=tmp_path)
    assert (run.status, run.out) == (2, "")
    assert said in run.err
    assert len(run.err.splitlines()) == 1
