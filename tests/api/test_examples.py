"""Examples for a site and a robot: all can be planned, in the language asked for, and they name what is there."""

from __future__ import annotations

from typing import Any

import pytest

from fieldhand import mission
from fieldhand.language import language_of_request
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import load_built_in, parse_site
from fieldhand.site.random_orchards import random_orchard
from support.processes.browser import browser


def asked(**body: Any) -> list[str]:
    answer = browser().post("/api/examples", body)
    assert answer.status_code == 200, answer.text
    return list(answer.json()["examples"])


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize(("site", "robot"), [("demo", "husky"), ("vineyard", "tractor")])
def test_every_example_is_planned_without_a_warning(site: Any, robot: str, language: str) -> None:
    examples = asked(site=site, robot=robot, lang=language)
    assert 3 <= len(examples) <= 6
    assert len(set(examples)) == len(examples)
    for text in examples:
        planned = mission.make_planner("english", {}).plan(text, load_built_in(site), load_robot(robot))
        assert isinstance(planned, Planned), text
        assert not planned.task.command.warnings
        assert language_of_request(text) == language


def test_examples_follow_what_the_robot_can_do_and_the_site_has() -> None:
    texts = " ".join(asked(site="vineyard", robot="tractor"))
    assert "Mow " in texts
    assert "vine" in texts
    assert "block North" in texts
    assert "Mow " not in " ".join(asked(site="vineyard", robot="amiga"))


def test_a_site_of_ones_own_has_examples_too() -> None:
    data = random_orchard(3).to_bytes()
    examples = asked(site={"name": "mine.geojson", "text": data.decode()}, robot="amiga")
    site = parse_site(data, name="mine")
    assert examples
    for text in examples:
        assert isinstance(mission.make_planner("english", {}).plan(text, site, load_robot("amiga")), Planned)
