"""Metres that the robot drives while the program that carries out the mission is dead, held against its own account."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
import yaml

from fieldhand import missions
from fieldhand.execution.journal import store
from fieldhand.forecast.visit_order import drives_for, start_place
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import Driving, Ended, Event, Resumed
from ros2.sim_robots import SimRobot, patient, sim_robot
from support.processes.command import fieldhand, in_background
from support.processes.patience import until

pytest.importorskip("cyclonedds")

#: Its seconds in one of ours.
FAST = 20.0
SITE = open_site("demo")
REQUEST = "Measure CO2 at tree 60, then at tree 5."


@pytest.fixture(autouse=True)
def _no_disk(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


def profile(folder: Path, *, alpha: float, odometer: bool) -> str:
    """Write the profile of a husky whose legs cost so much, with a counter of its metres or without one."""
    path = patient(folder, type="nav2_msgs/action/NavigateThroughPoses")
    robot = yaml.safe_load(path.read_text())
    robot["leg_cost"]["alpha"] = alpha
    if odometer:
        robot["ros2"]["odometer"] = {"topic": "odometer", "type": "std_msgs/msg/Float64", "stale_s": 600}
    path.write_text(yaml.safe_dump(robot, sort_keys=False))
    return str(path)


def driven_m(robot: SimRobot) -> float:
    """Return the metres of all its goals, by its own account."""
    return sum(line["metres"] for line in robot.account() if line["event"] == "goal" and "navigate" in line["name"])


def moved_m(robot: SimRobot) -> float:
    """Return how far it is from where it began, by the state that it keeps up to date."""
    state = json.loads((robot.folder / "robot.json").read_text())
    start = start_place(drives_for(SITE, load_robot("husky")))
    return math.dist((state["x"], state["y"]), start.stand or start.xy)


def events(under: Path) -> list[Event]:
    """Return the events in the journal of the only mission."""
    folders = [folder for folder in under.glob("*") if missions.exists(folder)]
    return [event for folder in folders for event in missions.events_of(folder)]


@pytest.mark.parametrize(("alpha", "odometer"), [(1.0, False), (0.5, True)])
def test_metres_driven_while_the_program_was_dead_are_counted(tmp_path: Path, alpha: float, odometer: bool) -> None:
    """The robot drives on to the end of its goal; metres and the seconds for them count, also when replayed."""
    under, husky = tmp_path / "m", profile(tmp_path, alpha=alpha, odometer=odometer)
    with sim_robot(tmp_path, "--site", "demo", "--robot", husky, "--speed", str(FAST), "--seed", "3") as robot:
        run = ("run", REQUEST, "--site", "demo", "--robot", husky, "--yes", "--confirm", "--missions", str(under))
        with in_background(*run, *robot.reached, out=tmp_path / "run.txt"):
            until(lambda: any(isinstance(e, Driving) for e in events(under)))
            until(lambda: moved_m(robot) > 3.0)  # of its first drive, most of which nobody observes
        (folder,) = under.iterdir()
        until(lambda: not missions.is_running(folder))
        before_m = driven_m(robot)
        until(lambda: driven_m(robot) > before_m)
        done = fieldhand("resume", "--missions", str(under), "--json")
        assert done.status == 0, done.err
        total_m = driven_m(robot)
    found = events(under)
    (resumed,) = (e for e in found if isinstance(e, Resumed))
    (ended,) = (e for e in found if isinstance(e, Ended))
    assert resumed.driven_by == ("odometer" if odometer else "path")
    assert resumed.driven_m > 10.0
    # Seconds of driving, not those for which the program was dead.
    assert resumed.driven_s == pytest.approx(resumed.driven_m, rel=0.01)
    assert ended.travelled_m == pytest.approx(total_m, rel=0.03)
    assert json.loads(done.out)["travelled_m"] == pytest.approx(ended.travelled_m, abs=0.1)
    again = fieldhand("status", "--missions", str(under), "--json")
    assert json.loads(again.out)["travelled_m"] == pytest.approx(ended.travelled_m, abs=0.1)
    assert all(json.loads(to_json(e)) for e in found)
