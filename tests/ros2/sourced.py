"""Where a ROS 2 is sourced: its graph on this machine alone, a robot of rclpy's own, and a profile for it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from fieldhand.robot.loader import profile_bytes

sourced = pytest.mark.skipif(find_spec("rclpy") is None, reason="no ROS 2 is sourced")
#: Services of one middleware are not understood by another.
NOT_CYCLONE = "cyclonedds" not in os.environ.get("RMW_IMPLEMENTATION", "cyclonedds")
#: This machine alone, and without multicast, which its own network has not everywhere.
UNICAST = (
    '<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>'
    "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
    '<MaxAutoParticipantIndex>120</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers>'
    "</Discovery></Domain></CycloneDDS>"
)
#: Captures of types that every ROS has: the built-in profile asks a camera and a sensor of their own packages.
_CAPTURES = """\
  actions:
    take_thermal_picture:
      service: {name: thermal_camera/trigger, type: std_srvs/srv/Trigger, success: success, message: message}
      topics: {canopy_temperature: {topic: thermal_camera/mean, type: sensor_msgs/msg/Temperature}}
    read_ambient_temperature:
      topics: {ambient_temperature: {topic: air_temperature, type: sensor_msgs/msg/Temperature}}
    read_co2:
      topics: {co2: {topic: co2, type: std_msgs/msg/Float64}}
"""


@contextmanager
def graph(number: int) -> Iterator[int]:
    """A domain of its own, in the environment."""
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("CYCLONEDDS_URI", UNICAST)
        environment.setenv("ROS_DOMAIN_ID", str(number))
        yield number


def standard_husky(folder: Path) -> Path:
    """The built-in husky with captures that need no package but ROS's own."""
    whole = profile_bytes("husky")[0].decode()
    before, found, _ = whole.partition("  actions:\n    take_thermal_picture:\n      action:")
    assert found
    path = folder / "husky.yaml"
    path.write_text(before + _CAPTURES)
    return path


@contextmanager
def rclpy_robot(folder: Path, *words: str, lat: float, lon: float) -> Iterator[Path]:
    """``rclpy_robot.py`` in a process of its own.

    Yields:
        The file of what it says.
    """
    said = folder / "robot.jsonl"
    program = Path(__file__).with_name("rclpy_robot.py")
    order = [sys.executable, program, "--lat", str(lat), "--lon", str(lon), *words]
    with said.open("w") as out, subprocess.Popen(order, stdout=out) as process:
        try:
            yield said
        finally:
            process.terminate()


def goals(said: Path) -> list[dict[str, Any]]:
    """Return what a robot says of the goals that have ended."""
    lines = [json.loads(line) for line in said.read_text().splitlines(keepends=True) if line.endswith("\n")]
    return [line for line in lines if line["event"] == "goal"]
