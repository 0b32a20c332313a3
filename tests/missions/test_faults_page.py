"""The examples of docs/faults.md: each world is flown, and the log says what the page says."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import get_args

import pytest
import yaml

from fieldhand import mission
from fieldhand.errors import OutputError
from fieldhand.execution.drivers.simulation.world_faults import AnyFault
from fieldhand.execution.drivers.simulation.world_file import parse_world
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.wording.events import EventText
from support.missions.rig import approved

DOCS = Path(__file__).resolve().parents[2] / "docs"
EXAMPLE = re.compile(r"```yaml\n# (.*?)\n(.*?)```\n\n```text\n(.*?)```", re.DOTALL)
EXAMPLES = EXAMPLE.findall((DOCS / "faults.md").read_text())
NARROW = re.compile(
    r"```yaml\n((?:(?!```).)*)```\n\nWith `corridor_m: (\d)` the log of \"(.*?)\" then says:\n\n```text\n(.*?)```",
    re.DOTALL,
)
IN_CORRIDOR = [
    (request, world, said, float(corridor_m))
    for world, corridor_m, request, said in NARROW.findall((DOCS / "faults.md").read_text())
]
ALL = [(*example, None) for example in EXAMPLES] + IN_CORRIDOR


@pytest.mark.parametrize(("request_", "world", "said", "corridor_m"), ALL, ids=[str(k) for k in range(len(ALL))])
def test_the_log_says_what_the_page_says(request_: str, world: str, said: str, corridor_m: float | None) -> None:
    site, robot = open_site("demo"), replace(load_robot("husky"), corridor_m=corridor_m)
    event_text = EventText(robot)
    outcome = mission.plan(request_, site, robot, EnglishPlanner())
    assert isinstance(outcome, Planned)
    lines: list[str] = []
    try:
        mission.simulate(
            approved(outcome.task, site, robot), world=parse_world(yaml.safe_load(world)), seed=0,
            speed=None, emit=lambda event: lines.append(event_text.line(event) or ""),
        )  # fmt: skip
    except OutputError as error:
        lines.append(str(error))
    told, at = "\n".join(lines), 0
    for line in said.splitlines():
        assert line in told[at:], f"{line}\n\n{told}"
        at = told.index(line, at) + len(line)


def test_the_page_has_its_examples() -> None:
    assert len(EXAMPLES) == (DOCS / "faults.md").read_text().count("```yaml\n# ") > 5
    assert len(IN_CORRIDOR) == (DOCS / "faults.md").read_text().count("With `corridor_m: ") == 2


def test_the_page_of_formats_lists_every_fault() -> None:
    page = (DOCS / "formats.md").read_text()
    for model in get_args(AnyFault):
        (kind,) = get_args(model.model_fields["fault"].annotation)
        assert f"{{fault: {kind}," in page
