"""The node of ``ros2/fieldhand_ros``: what can be said of it without ROS, and, where one is sourced, whole missions."""

from __future__ import annotations

import ast
import configparser
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

import fieldhand
from fieldhand.execution.drivers.ros2.rclpy import open_rclpy
from fieldhand.execution.drivers.ros2.transport import QosProfile, Transport
from fieldhand.execution.operator_commands import AGENT_COMMANDS
from ros2.sourced import goals, graph, rclpy_robot, sourced, standard_husky
from support.processes.command import fieldhand as command
from support.processes.patience import LONG_S, until

PACKAGE = Path(__file__).parents[2] / "ros2/fieldhand_ros"
#: What each transition of lifecycle_msgs/msg/Transition is called by.
CONFIGURE, CLEAN_UP, ACTIVATE, DEACTIVATE, SHUT_DOWN = 1, 2, 3, 4, 5


# --- without ROS -----------------------------------------------------------------------------------------------------


def test_the_manifest_says_what_the_package_is() -> None:
    root = etree.parse(str(PACKAGE / "package.xml")).getroot()
    assert (root.tag, root.get("format")) == ("package", "3")
    for tag in ("name", "version", "description", "maintainer", "license"):
        (element,) = root.findall(tag)
        assert element.text
    assert root.findtext("name") == PACKAGE.name
    assert root.findtext("version") == fieldhand.__version__
    assert root.find("maintainer").get("email")  # type: ignore[union-attr]
    assert root.findtext("export/build_type") == "ament_python"
    imported = {name for file in PACKAGE.rglob("*.py") for name in _imported(ast.parse(file.read_text()))}
    known = {"fieldhand", "setuptools", PACKAGE.name, *sys.stdlib_module_names}
    assert imported - known <= {dependency.text for dependency in root.findall("exec_depend")}


def _imported(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module.partition(".")[0]


def test_what_is_installed_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    said: dict[str, Any] = {}
    monkeypatch.setattr("setuptools.setup", lambda **words: said.update(words))
    exec(compile((PACKAGE / "setup.py").read_text(), "setup.py", "exec"), {"__name__": "setup"})
    assert (said["name"], said["version"]) == (PACKAGE.name, fieldhand.__version__)
    for _, files in said["data_files"]:
        assert all((PACKAGE / file).is_file() for file in files)
    for script in said["entry_points"]["console_scripts"]:
        module, _, function = script.partition(" = ")[2].partition(":")
        tree = ast.parse((PACKAGE / f"{module.replace('.', '/')}.py").read_text())
        assert function in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    config = configparser.ConfigParser()
    config.read(PACKAGE / "setup.cfg")
    assert config["install"]["install_scripts"] == f"$base/lib/{PACKAGE.name}"


def test_the_launch_file_passes_the_parameters_that_the_node_has() -> None:
    launch = (PACKAGE / "launch/executor.launch.py").read_text()
    compile(launch, "executor.launch.py", "exec")
    node = (PACKAGE / "fieldhand_ros/executor.py").read_text()
    (given,) = (
        ast.literal_eval(statement.value)
        for statement in ast.parse(launch).body
        if isinstance(statement, ast.Assign) and getattr(statement.targets[0], "id", "") == "ARGUMENTS"
    )
    of_ros = {"use_sim_time", "namespace", "until"}
    assert all(f'("{name}", ' in node for name, *_ in given if name not in of_ros)


# --- where ROS is sourced --------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("executor")


@pytest.fixture(scope="module")
def mission(folder: Path) -> Path:
    """Signed by somebody whom the robot trusts."""
    env = os.environ | {"FIELDHAND_CONFIG": str(folder / "config")}
    profile, path = standard_husky(folder), folder / "corners.mission"
    request = "Take thermal pictures of the corner trees."
    for words in (
        ("keys", "new", "--name", "Rosa", "-o", str(folder / "rosa.pub")),
        ("keys", "trust", str(folder / "rosa.pub"), "--yes"),
        ("approve", request, "--site", "demo", "--robot", str(profile), "--yes", "--confirm", "-o", str(path)),
    ):
        done = command(*words, env=env)
        assert done.status == 0, done.err + done.out
    return path


@dataclass(frozen=True)
class Executor:
    """The node in another process, as another node sees it."""

    node: Transport
    robot: Path

    def change(self, transition: int) -> bool:
        answer = self._asked("change_state", "lifecycle_msgs/srv/ChangeState", {"transition": {"id": transition}})
        return bool(answer["success"])

    def tell(self, said: str) -> tuple[bool, str]:
        answer = self._asked(said, "std_srvs/srv/Trigger", {})
        return bool(answer["success"]), str(answer["message"])

    def set(self, name: str, text: str) -> None:
        value = {"type": 4, "string_value": text}
        self._asked(
            "set_parameters", "rcl_interfaces/srv/SetParameters", {"parameters": ({"name": name, "value": value},)}
        )

    def status(self) -> Mapping[str, Any]:
        """Return the messages that are kept for late subscribers."""
        heard = self.node.subscribe("/executor/status", "std_msgs/msg/String", QosProfile(transient=True, depth=1))
        text = str(until(heard.take)[-1]["data"])
        heard.close()
        return dict(json.loads(text))

    def state(self) -> str:
        mission = self.status()["mission"]
        return "" if mission is None else str(mission["state"])

    def _asked(self, service: str, kind: str, request: Mapping[str, object]) -> Mapping[str, Any]:
        client = self.node.client(f"/executor/{service}", kind)
        until(client.servers)
        client.ask(request)
        ((_, answer),) = until(client.replies)
        client.close()
        return answer


@pytest.fixture
def executor(folder: Path, mission: Path, tmp_path: Path) -> Iterator[Executor]:
    from fieldhand.site.loader import open_site

    start = open_site("demo").start
    parameters = {
        "mission": mission,
        "robot": folder / "husky.yaml",
        "missions": tmp_path / "store",
        "config": folder / "config",
    }
    words = [word for name, value in parameters.items() for word in ("-p", f"{name}:={value}")]
    search = os.pathsep.join((str(PACKAGE), *(p for p in sys.path if p)))
    with (
        graph(201 + os.getpid() % 30),
        rclpy_robot(tmp_path, "--speed", "8", lat=start.lat, lon=start.lon) as robot,
        subprocess.Popen(
            [sys.executable, "-m", "fieldhand_ros.executor", "--ros-args", *words],
            env=os.environ | {"PYTHONPATH": search, "XDG_STATE_HOME": str(tmp_path)},
        ) as process,
    ):
        node = open_rclpy()
        try:
            yield Executor(node, robot)
        finally:
            node.close()
            process.terminate()
            assert process.wait(LONG_S) in (0, -15)


@sourced
def test_a_mission_through_the_node_from_its_start_to_its_end(executor: Executor) -> None:
    """Paused and let go on, the node put to rest in between and woken again, and called home."""
    done, why = executor.tell("start")
    assert not done
    assert "configure the node first" in why
    assert executor.change(CONFIGURE)
    assert "activate it first" in executor.tell("start")[1]
    assert executor.change(ACTIVATE)
    assert executor.tell("start")[0]
    until(lambda: executor.state() == "running")
    until(lambda: goals(executor.robot))
    assert executor.tell("pause")[0]
    until(lambda: executor.state() == "paused")
    assert executor.tell("resume")[0]
    until(lambda: executor.state() == "running")
    assert executor.change(DEACTIVATE)
    until(lambda: executor.state() == "paused")
    assert not executor.change(CLEAN_UP)
    until(lambda: "under way" in executor.status()["problem"])
    before = len(goals(executor.robot))
    assert executor.change(ACTIVATE)
    assert executor.tell("resume")[0]
    until(lambda: len(goals(executor.robot)) > before)
    assert executor.tell("return")[0]
    until(lambda: executor.state() == "ended")
    status = executor.status()
    assert "return was called over ROS 2" in status["mission"]["reason"]
    assert status["problem"] == ""
    assert executor.change(DEACTIVATE)
    assert executor.change(CLEAN_UP)
    until(lambda: executor.status()["mission"] is None)
    assert executor.change(SHUT_DOWN)


@sourced
def test_what_may_not_run_is_refused_with_its_reason(executor: Executor, mission: Path, tmp_path: Path) -> None:
    spoilt = tmp_path / "spoilt.mission"
    spoilt.write_bytes(mission.read_bytes()[:-100])
    for name, value, why in (
        ("mission", str(spoilt), "is truncated"),
        ("mission", "", "the parameter mission is not set"),
        ("mission", str(mission), ""),
        ("robot", "amiga", "amiga"),
        ("robot", "", "the parameter robot is not set"),
    ):
        executor.set(name, value)
        if why:
            assert not executor.change(CONFIGURE)
            until(lambda why=why: why in executor.status()["problem"])


@sourced
def test_diagnostics_say_what_is_wrong(executor: Executor) -> None:
    heard = executor.node.subscribe("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", QosProfile())
    assert executor.change(CONFIGURE)
    waiting = until(lambda: [a for a in heard.take() if a["status"][0]["hardware_id"] == "husky"])  # type: ignore[index]
    assert waiting[0]["status"][0]["level"] == 0  # type: ignore[index]
    executor.set("mission", "")
    assert executor.change(CLEAN_UP)
    assert not executor.change(CONFIGURE)
    wrong = until(lambda: [a for a in heard.take() if a["status"][0]["level"] == 2])  # type: ignore[index]
    assert "the parameter mission is not set" in wrong[0]["status"][0]["message"]  # type: ignore[index]


def test_every_order_of_the_agent_is_a_service() -> None:
    """The node makes one for each; its page names them all."""
    page = (PACKAGE / "README.md").read_text()
    assert all(f"`~/{said}`" in page for said in AGENT_COMMANDS)
