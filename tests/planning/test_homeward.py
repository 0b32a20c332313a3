"""A mission whose request does not say where to end ends in the same place, whichever planner planned it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.llm.planner import LlmPlanner
from fieldhand.planning.llm.scripted import ScriptedEndpoint
from fieldhand.planning.planner import Planned, Planner
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from fieldhand.task.codec import encode_parts
from fieldhand.task.frames import Composition, Task

HUSKY, DEMO = load_robot("husky"), open_site("demo")
SITES = {
    "all markers": DEMO,
    "start": replace(DEMO, markers={"start": DEMO.markers["start"]}),
    "no markers": replace(DEMO, markers={}),
}


def planned(planner: Planner, request: str, site: Site) -> Task:
    outcome = planner.plan(request, site, HUSKY)
    assert isinstance(outcome, Planned), outcome
    return outcome.task


def by_model(task: Task, site: Site, exits: str) -> Task:
    """The Task that a model's answer makes which holds the same plan and limits."""
    inside = encode_parts([task.constraints]) if task.constraints.budgets else ""
    answer = (
        f"<task><task-composition><plan>{encode_parts([task.composition.plan])}</plan>{exits}</task-composition>"
        f"{inside}</task>"
    )
    with ScriptedEndpoint([answer], repeat_last=True) as endpoint:
        return planned(LlmPlanner(endpoint.settings()), task.command.request, site)


@pytest.mark.parametrize("site", SITES.values(), ids=SITES)
@pytest.mark.parametrize("exits", ["", '<exits nominal="return_to_end"/>'])
@pytest.mark.parametrize(
    "request_",
    [
        "Take pictures of as many trees as you can within 100 m of driving.",
        "Take pictures of as many trees as you can within 300 m of driving.",
        "Take pictures of as many trees as you can within 2000 m of driving.",
        "Take a picture of as many trees as possible in 5 minutes.",
        "Take a picture of tree 4 within 10 minutes.",
        "Take a picture of tree 4.",
    ],
)
def test_both_planners_end_a_mission_alike_where_its_request_says_nothing(
    site: Site, exits: str, request_: str
) -> None:
    english = planned(EnglishPlanner(), request_, site)
    model = by_model(english, site, exits)
    assert replace(model.composition, plan=english.composition.plan) == english.composition
    assert set(english.command.assumptions) >= set(model.command.assumptions) != set()


def test_a_short_budget_is_not_spent_on_a_way_home_that_nobody_asked_for() -> None:
    request = "Take pictures of as many trees as you can within 100 m of driving."
    (short, long) = (planned(EnglishPlanner(), request.replace("100", m), DEMO) for m in ("100", "2000"))
    assert (by_model(short, DEMO, "").composition.nominal, by_model(long, DEMO, "").composition.nominal) == (
        "stay",
        "return_to_end",
    )


def test_a_return_that_is_asked_for_is_kept_however_short_the_budget() -> None:
    request = "Take pictures of as many trees as you can within 100 m of driving and return to the end."
    task = planned(EnglishPlanner(), request, DEMO)
    model = by_model(task, DEMO, '<exits nominal="return_to_end" words="return to the end"/>')
    assert isinstance(model.composition, Composition)
    assert task.composition.nominal == model.composition.nominal == "return_to_end"
    assert model.command.assumptions == ()
