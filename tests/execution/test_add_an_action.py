"""An action that docs/add-an-action.md adds to a profile reaches the robot with no line of code."""

from __future__ import annotations

import re
from importlib import resources
from pathlib import Path

import yaml

from fieldhand.places.selectors import First
from fieldhand.robot.loader import parse_profile
from fieldhand.task.plan import Act
from fieldhand.task.results import Acted
from support.missions.rig import Rig, of_type


def test_the_action_of_the_docs_is_carried_out() -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "add-an-action.md").read_text()
    example = re.search(r"```yaml\n(.*?)```", page, re.DOTALL)
    assert example is not None
    husky = (resources.files("fieldhand.robot") / "profiles" / "husky.yaml").read_text()
    profile, addition = yaml.safe_load(husky), yaml.safe_load(example[1])
    for part in ("quantities", "actions"):
        profile[part] |= addition[part]
    robot = parse_profile(yaml.safe_dump(profile).encode())
    result = Rig(robot=robot).fly(Act(id="", action="measure_trunk", at=First()))
    (acted,) = of_type(result.events, Acted)
    assert acted.status == "success"
    assert acted.units == {"trunk_diameter": "mm"}
    assert 5 <= acted.readings["trunk_diameter"] <= 1000
