"""Missions on a robot of rclpy's own, over either transport. Skipped where no ROS 2 is sourced."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from fieldhand import missions
from fieldhand.site.loader import open_site
from ros2.sourced import NOT_CYCLONE, goals, graph, rclpy_robot, sourced, standard_husky
from support.processes.command import fieldhand, in_background
from support.processes.patience import until

pytestmark = sourced

START = open_site("demo").start
REQUEST = "Take thermal pictures of the corner trees, then read the co2 of the middle tree."
OVER = [pytest.param("dds", marks=pytest.mark.skipif(NOT_CYCLONE, reason="not Cyclone DDS")), "rclpy"]


@pytest.fixture(autouse=True)
def domain() -> Iterator[int]:
    with graph(201 + os.getpid() % 30) as number:
        yield number


def words(profile: Path, folder: Path, over: str) -> tuple[str, ...]:
    run = ("run", REQUEST, "--site", "demo", "--robot", str(profile), "--yes", "--confirm", "--no-history", "--json")
    return (*run, "--on", over, "--missions", str(folder))


@pytest.mark.parametrize("over", OVER)
def test_a_mission_goes_to_its_end_also_where_nav2_gives_a_goal_up(over: str, tmp_path: Path) -> None:
    profile = standard_husky(tmp_path)
    with rclpy_robot(tmp_path, "--speed", "60", "--abort", "3", lat=START.lat, lon=START.lon) as robot:
        ran = fieldhand(*words(profile, tmp_path / "m", over))
        ended = [goal["end"] for goal in goals(robot)]
    assert ran.status == 0, ran.err
    said = json.loads(ran.out)
    assert said["status"] == "completed"
    assert ended.count("aborted") == 1
    assert set(ended) == {"succeeded", "aborted"}
    (folder,) = (tmp_path / "m").iterdir()
    made = [event for event in missions.events_of(folder) if getattr(event, "status", "") == "success"]
    readings = [dict(event.readings) for event in made if getattr(event, "readings", None)]
    assert readings == [{"canopy_temperature": 31.5}] * 4 + [{"co2": 405.0}]


@pytest.mark.parametrize("over", OVER)
def test_a_mission_that_is_aborted_cancels_its_goal_on_the_robot(over: str, tmp_path: Path) -> None:
    profile = standard_husky(tmp_path)
    with (
        rclpy_robot(tmp_path, "--speed", "2", lat=START.lat, lon=START.lon) as robot,
        in_background(*words(profile, tmp_path / "m", over), out=tmp_path / "out"),
    ):
        until(lambda: goals(robot))
        (folder,) = (tmp_path / "m").iterdir()
        missions.send_command(folder, "abort", "a test", wait=lambda: bool(threading.Event().wait(0.02)) or True)
        until(lambda: goals(robot)[-1]["end"] == "canceled")
        until(lambda: missions.status(folder).now.state == "ended")
    assert missions.status(folder).now.status == "aborted"
