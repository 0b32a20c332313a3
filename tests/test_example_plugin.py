"""The example of a plugin is installed for real, listed, and used by its names."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from support.processes.command import Run, fieldhand, loaded_with

ROOT = Path(__file__).parent.parent
EXAMPLE = ROOT / "examples" / "plugin"
#: Its cart idles on its own time: on a busy machine a faster one runs out of battery while the program starts.
PACE = "pace=100"


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The environment variables of a process in which the example is installed."""
    target = tmp_path_factory.mktemp("installed")
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps"]
    # Copied: a build leaves files beside the sources.
    source = tmp_path_factory.mktemp("source") / "plugin"
    subprocess.run(["cp", "-r", str(EXAMPLE), str(source)], check=True)
    done = subprocess.run(
        [*pip, "--no-build-isolation", "--target", str(target), str(source)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    state = tmp_path_factory.mktemp("state")
    return os.environ | {"PYTHONPATH": str(target), "XDG_STATE_HOME": str(state), "FIELDHAND_CONFIG": str(state)}


@pytest.fixture(scope="module")
def command(installed: dict[str, str]) -> Iterator[Callable[..., Run]]:
    """Run a command in a copy of a process in which the example is installed."""
    with loaded_with(installed) as run:
        yield run


def test_it_is_listed_beside_what_is_built_in(installed: dict[str, str], tmp_path: Path) -> None:
    done = fieldhand("plugins", "--json", cwd=tmp_path, env=installed, fresh=True)
    listed = json.loads(done.out)["plugins"]
    mine = {(one["group"], one["name"]) for one in listed if one["distribution"] == "fieldhand-example"}
    assert mine == {("fieldhand.drivers", "cart"), ("fieldhand.planners", "survey"), ("fieldhand.robots", "cart")}
    assert not [one for one in listed if one["problem"] or one["overridden_by"]]
    assert {"auto", "english", "llm", "dds", "rclpy", "husky", "geojson"} <= {one["name"] for one in listed}


def test_its_planner_plans_and_its_driver_drives(command: Callable[..., Run], tmp_path: Path) -> None:
    done = command(
        "run", "survey 5 trees", "--site", "demo", "--robot", "cart", "--planner", "survey", "--on", "cart",
        "--driver-option", PACE, "--yes", "--confirm", "--events", "log.jsonl", "--json", cwd=tmp_path,
    )  # fmt: skip
    assert done.status == 0, done.err
    assert json.loads(done.out)["planner"] == "survey"
    events = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text().splitlines()]
    assert len({event["place"] for event in events if event["event"] == "action"}) == 5
    assert events[0]["robot"] == "cart"
    assert events[-1]["status"] == "completed"


def test_the_demo_mission_is_driven_by_its_driver(command: Callable[..., Run], tmp_path: Path) -> None:
    done = command("demo", "--on", "cart", "--driver-option", PACE, "-o", "out", cwd=tmp_path)
    assert done.status in (0, 1), done.err
    events = [json.loads(line) for line in (tmp_path / "out" / "events.jsonl").read_text().splitlines()]
    pictures = {e["place"] for e in events if e["event"] == "action" and e["action"] == "take_thermal_picture"}
    assert len(pictures) >= 4, done.err  # the corners, and the optional trees that the distance allows
    assert events[-1]["travelled_m"] <= 450.0
    # The cart drives exactly the length of each path, which no simulated robot does.
    planned = [event["planned_m"] for event in events if event["event"] == "drive"]
    driven = [event["leg_m"] for event in events if event["event"] == "arrive"]
    assert driven == pytest.approx(planned[: len(driven)], abs=0.01)


def test_a_wrong_option_is_an_error_in_one_line(command: Callable[..., Run], tmp_path: Path) -> None:
    chosen = ("--site", "demo", "--robot", "cart", "--planner", "survey", "--on", "cart")
    for option, said in (
        ("pace=0", "not a number above 0"),
        ("colour=red", "no option 'colour'"),
        ("pace", "name=value"),
    ):
        done = command("run", "survey 5 trees", *chosen, "--yes", "--driver-option", option, cwd=tmp_path)
        assert done.status == 2
        assert said in done.err
        assert "Traceback" not in done.err


def test_its_driver_keeps_the_contract_of_drivers(installed: dict[str, str], tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", str(tmp_path),
         str(EXAMPLE / "tests")],
        cwd=tmp_path, env=installed, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout
    assert done.stdout.count(".") >= 12  # each test of the contract
