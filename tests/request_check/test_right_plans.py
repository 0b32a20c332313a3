"""The check never doubts a right plan: those of all documented requests, and the same plans written in another way."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from fieldhand.places import selectors as s
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.llm.answer import TaskAnswer, read_answer
from fieldhand.planning.llm.chat import Reply
from fieldhand.planning.llm.examples import EXAMPLES, ROBOT
from fieldhand.planning.llm.review import read_draft
from fieldhand.planning.planner import Planned
from fieldhand.request_check import mismatches
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import load_site, open_site
from fieldhand.site.model import Site
from fieldhand.task import conditions as c
from fieldhand.task import plan as p
from fieldhand.task.build import make_task
from fieldhand.task.codec import TaskDraft
from fieldhand.task.frames import Task
from support.requests import english as english_requests
from support.requests import rows as row_requests
from support.requests.planned import outcome_of
from support.sites.grids import grid

ROOT = Path(__file__).resolve().parents[2]
MISSIONS = ROOT.parent / "shared" / "data" / "missions" / "orchard.yaml"
PAGE = (ROOT / "docs" / "english.md").read_text(encoding="utf-8")
ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}
DEMO = open_site("demo")
REQUESTS = list(
    dict.fromkeys(
        [
            *((robot, request) for robot, request, _ in (*english_requests.PLANNED, *row_requests.PLANNED)),
            *(("husky", request) for request in re.findall(r"^> (.+)\n  plan: ", PAGE, re.MULTILINE)),
        ]
    )
)


def planned(robot: str, request: str) -> Task:
    outcome = outcome_of(robot, request)
    assert isinstance(outcome, Planned), outcome
    return outcome.task


def test_there_are_many_documented_requests() -> None:
    assert len(REQUESTS) > 400


@pytest.mark.parametrize("start", range(8))
def test_no_plan_of_a_documented_request_is_doubted(start: int) -> None:
    for robot, request in REQUESTS[start::8]:
        assert mismatches(planned(robot, request), DEMO, ROBOTS[robot]) == (), request


@pytest.mark.skipif(not MISSIONS.exists(), reason="the mission cases are not at hand")
def test_no_plan_of_a_mission_case_is_doubted() -> None:
    cases = yaml.safe_load(MISSIONS.read_text(encoding="utf-8"))
    for case in cases["cases"]:
        site = load_site(MISSIONS.parent / case.get("site", cases["site"]))
        robot = ROBOTS[case.get("robot", cases["robot"])]
        outcome = EnglishPlanner().plan(case["request"], site, robot)
        assert isinstance(outcome, Planned)
        assert mismatches(outcome.task, site, robot) == (), case["request"]


def test_no_example_of_the_prompt_is_doubted() -> None:
    site, robot = grid(6, 8), load_robot(ROBOT)
    for request, answer in EXAMPLES:
        found = read_answer(Reply(text=answer))
        if isinstance(found, TaskAnswer):
            draft = read_draft(found.document, capabilities_of(robot), request)
            assert isinstance(draft, TaskDraft)
            task = make_task(
                request=request,
                plan=draft.plan,
                measures={},
                constraints=draft.constraints,
                nominal=draft.nominal,
            )
            assert mismatches(task, site, robot) == (), request


def everywhere(value: Any, change: Callable[[Any], Any]) -> Any:
    """The value with every part changed, innermost first."""
    new = {}
    for field in fields(value):
        inside = getattr(value, field.name)
        if is_dataclass(inside):
            new[field.name] = everywhere(inside, change)
        elif isinstance(inside, tuple):
            new[field.name] = tuple(everywhere(part, change) if is_dataclass(part) else part for part in inside)
    return change(replace(value, **new))


def negated(x: Any) -> Any:
    """If not c then the one, else the other."""
    if isinstance(x, p.If) and x.otherwise is not None:
        return replace(x, condition=c.Not(condition=x.condition), then=x.otherwise, otherwise=x.then)
    return x


def turned(x: Any) -> Any:
    """Below with its branches exchanged is at least."""
    other = {"lt": "ge", "le": "gt", "gt": "le", "ge": "lt"}
    if isinstance(x, p.If) and x.otherwise is not None and isinstance(x.condition, c.Compare):
        condition = replace(x.condition, test=other[x.condition.test])
        return replace(x, condition=condition, then=x.otherwise, otherwise=x.then)
    return x


def written_out(x: Any) -> Any:
    """A visit to each of some named places as steps, and some captures as so many acts."""
    if isinstance(x, p.ForEach) and isinstance(x.select, s.UnionOf) and not x.optional and x.at_most is None:
        steps = tuple(replace(x, select=part, order="best") for part in x.select.parts)
        return p.InOrder(id="", steps=steps) if all(part.single for part in x.select.parts) else x
    if isinstance(x, p.Act) and x.count > 1 and x.at is not None:
        return p.InOrder(id="", steps=(replace(x, count=1), *[replace(x, count=1, at=None)] * (x.count - 1)))
    return x


def by_number(x: Any) -> Any:
    """A word such as "low" as the number that the profile gives for it."""
    if isinstance(x, c.Level):
        quantity = next(r.quantity[x.quantity] for r in ROBOTS.values() if x.quantity in r.quantity)
        level = quantity.levels[x.level]
        test = "lt" if level.direction == "below" else "gt"
        return c.Compare(reading=x.reading, quantity=x.quantity, test=test, value=level.value, unit=quantity.unit)
    return x


@pytest.mark.parametrize("rewrite", [negated, turned, written_out, by_number], ids=lambda f: str(f.__name__))
def test_a_right_plan_in_another_form_is_not_doubted(rewrite: Callable[[Any], Any]) -> None:
    changed = 0
    for robot, request in REQUESTS:
        task = planned(robot, request)
        plan = everywhere(task.composition.plan, rewrite)
        if plan == task.composition.plan:
            continue
        changed += 1
        other = make_task(
            request=request,
            plan=plan,
            measures={},
            constraints=task.constraints,
            nominal=task.composition.nominal,
            read_as=task.command.read_as,
        )
        assert mismatches(other, DEMO, ROBOTS[robot]) == (), request
    assert changed >= 4


#: Five trees in a row, the ends of which only a side of the compass tells apart.
FIVE = '<successive count="5"><near><marker name="start"/></near></successive>'
#: Requests that the built-in planner refuses or reads otherwise, and plans for them as a careful reader writes them.
READ_BY_PEOPLE: list[tuple[str, str]] = [
    (
        "I'd love a thermal snapshot of whatever stands at the chilly north-west end, then home.",
        '<act><take_thermal_picture/><at><corners which="nw"/></at></act>',
    ),
    (
        "Somewhere along the eastern flank, grab 3 CO2 readings, each from its own tree.",
        '<for-each><select><take count="3"><edge side="east"/></take></select><body><act><read_co2/></act></body>'
        "</for-each>",
    ),
    (
        "Have a peek at the dozen oldest trees and photograph them.",
        '<for-each><select><top attribute="age_years" count="12"/></select>'
        "<body><act><take_thermal_picture/></act></body></for-each>",
    ),
    (
        "Wander over to tree 40; should the air there be hotter than 95 F, snap it twice.",
        '<sequence><act reading="a"><read_ambient_temperature/><at><tree-is tree="40"/></at></act><if><condition>'
        '<compare reading="a" test="gt"><ambient_temperature value="35" unit="degC"/></compare></condition>'
        '<then><act count="2"><take_thermal_picture/></act></then></if></sequence>',
    ),
    (
        "Photograph a handful of yellowish trees up in the swampy bit.",
        '<for-each><select><take count="4"><where attribute="leaf_color" test="eq" value="yellow">'
        '<in-zone zone="wet corner"/></where></take></select>'
        "<body><act><take_thermal_picture/></act></body></for-each>",
    ),
    (
        "Do a loop through rows three and four, snapping each Carmel; half an hour tops.",
        '<for-each optional="true"><select><where attribute="variety" test="eq" value="Carmel">'
        '<rows first="3" last="4"/></where></select><body><act><take_thermal_picture/></act></body></for-each>'
        '<!--limits--><budget kind="duration_s" limit="1800"/>',
    ),
    (
        "Ambient temp at 2 spots: dead centre and by the dock.",
        "<sequence><act><read_ambient_temperature/><at><middle/></at></act>"
        '<act><read_ambient_temperature/><at><marker name="charger"/></at></act></sequence>',
    ),
    (
        "Skip the pictures, just sniff the CO2 at number 12 and number 90.",
        '<for-each><select><union><tree-is tree="12"/><tree-is tree="90"/></union></select>'
        "<body><act><read_co2/></act></body></for-each>",
    ),
    (
        "Drive along a row of 5 trees and take a picture at 3 of them.",
        f'<sequence><go-to><extreme side="north">{FIVE}</extreme></go-to>'
        f'<for-each><select><take count="3">{FIVE}</take></select>'
        "<body><act><take_thermal_picture/></act></body></for-each>"
        f'<go-to><extreme side="south">{FIVE}</extreme></go-to></sequence>',
    ),
]


@pytest.mark.parametrize(("request_", "plan"), READ_BY_PEOPLE, ids=lambda v: str(v)[:40])
def test_a_plan_by_a_careful_reader_is_not_doubted(request_: str, plan: str) -> None:
    body, _, limits = plan.partition("<!--limits-->")
    constraints = f"<constraints>{limits}</constraints>" if limits else ""
    document = f"<task><task-composition><plan>{body}</plan></task-composition>{constraints}</task>"
    draft = read_draft(document, capabilities_of(ROBOTS["husky"]))
    assert isinstance(draft, TaskDraft), draft
    task = make_task(request=request_, plan=draft.plan, measures={}, constraints=draft.constraints)
    assert mismatches(task, DEMO, ROBOTS["husky"]) == ()


def test_a_plan_for_a_site_without_markers_or_attributes_is_not_doubted() -> None:
    bare = replace(DEMO, markers={}, zones=())
    task = make_task(
        request="Take a picture of tree 4 and return to the start.",
        plan=p.Act(id="", action="take_thermal_picture", at=s.TreeIs(tree="4")),
        measures={},
        nominal="stay",
    )
    assert isinstance(bare, Site)
    assert mismatches(task, bare, ROBOTS["husky"]) == ()
