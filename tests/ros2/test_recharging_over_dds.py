"""A mission over DDS with a robot that docks by Nav2's actions and charges; it goes as in the plain simulation."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import pytest
import yaml

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.compatibility import UTC
from fieldhand.places.selectors import TreeIs
from fieldhand.robot.loader import load_robot, profile_bytes
from fieldhand.site.loader import open_site
from fieldhand.task.plan import Act, InOrder, Recharge
from fieldhand.task.results import Acted, ChargeBegun, ChargeEnded
from ros2.robot_in_process import connected_simulated_robot
from support.missions.rechargeable import CHARGING, task_of
from support.missions.rig import of_type

pytest.importorskip("cyclonedds")

DOCKING = {
    "dock": {
        "action": {
            "name": "dock_robot",
            "type": "nav2_msgs/action/DockRobot",
            "request": {"use_dock_id": True, "dock_id": "$place", "navigate_to_staging_pose": False},
            "success": "success",
        }
    },
    "undock": {
        "action": {
            "name": "undock_robot",
            "type": "nav2_msgs/action/UndockRobot",
            "request": {"max_undocking_time": 30.0},
            "success": "success",
        }
    },
}


def profile(folder: Path) -> str:
    """The husky with a small battery, a charger and Nav2's docking server."""
    data, _ = profile_bytes("husky")
    document = yaml.safe_load(data)
    document["energy"] |= {"capacity_j": 60_000, "charging": CHARGING}
    document["ros2"] |= {"distro": "jazzy", "use_sim_time": True}
    document["ros2"]["actions"] |= DOCKING
    path = folder / "husky.yaml"
    path.write_text(yaml.safe_dump(document), encoding="utf-8")
    return str(path)


def test_docks_and_charges_as_in_simulation(tmp_path: Path) -> None:
    name, site = profile(tmp_path), open_site("demo")
    robot = load_robot(name)
    (near,) = [t.place.id for t in site.trees if t.place.id == "1"] or [site.trees[0].place.id]
    picture = Act(action="take_thermal_picture", at=TreeIs(tree=near))
    task = task_of(InOrder(steps=(picture, Recharge(until_percent=95.0), Act(action="read_co2"))), site, robot)
    approved = mission.authorize(
        mission.review(task, site, robot), by="tests", at=datetime(2026, 1, 1, tzinfo=UTC), confirmed=EveryWarning()
    )
    with connected_simulated_robot("demo", name, task, seed=3, tick_s=0.5) as (vehicle, _):
        there = mission.carry_out(approved, vehicle=vehicle, seed=3)
    here = mission.simulate(approved, seed=3)
    assert there.status == here.status == "completed"
    for run in (there, here):
        (begun,) = of_type(run.events, ChargeBegun)
        (charged,) = of_type(run.events, ChargeEnded)
        assert begun.place == "charger"
        assert charged.charge_percent == pytest.approx(95.0, abs=1.0)
        assert [(e.action, e.place) for e in of_type(run.events, Acted)] == [
            ("take_thermal_picture", near),
            ("read_co2", "charger"),
        ]
    real, simulated = (of_type(run.events, ChargeEnded)[0].seconds for run in (there, here))
    assert real == pytest.approx(simulated, rel=0.1, abs=5.0)
