"""What requests become: a plan, a question, or a refusal that says why."""

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.codec import decode, encode
from fieldhand.task.plan import walk
from fieldhand.task.references import references
from fieldhand.task.schema import validate
from planning.english.outlines import outline
from support.requests.english import ASKED, PLANNED, REFUSED, WARNED
from support.requests.planned import outcome_of

SITE = open_site("demo")
ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}


@pytest.mark.parametrize(("robot", "request_", "plan"), PLANNED, ids=lambda v: str(v)[:50])
def test_a_request_becomes_this_plan_and_a_whole_task(robot: str, request_: str, plan: str) -> None:
    outcome = outcome_of(robot, request_)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    capabilities = capabilities_of(ROBOTS[robot])
    document = encode(outcome.task)
    assert references(outcome.task, capabilities) == ()
    assert validate(document, capabilities) == ()
    assert decode(document) == outcome.task
    ids = [node.id for node in walk(outcome.task.composition.plan)]
    assert len(set(ids)) == len(ids)


@pytest.mark.parametrize(("robot", "request_", "plan"), PLANNED, ids=lambda v: str(v)[:50])
def test_planning_twice_gives_the_same_and_every_step_says_its_words(robot: str, request_: str, plan: str) -> None:
    first = outcome_of(robot, request_)
    assert first == EnglishPlanner().plan(request_, SITE, ROBOTS[robot])
    assert isinstance(first, Planned)
    for node in walk(first.task.composition.plan):
        assert all(0 <= start < end <= len(request_) for start, end in node.said)
    warned = [WARNED[request_]] if WARNED.get(request_) else []
    assert [str(problem.what) for problem in unaccounted(first.task)] == warned


@pytest.mark.parametrize(("robot", "request_", "question"), ASKED, ids=lambda v: str(v)[:50])
def test_what_can_be_read_in_two_ways_is_asked(robot: str, request_: str, question: str) -> None:
    outcome = outcome_of(robot, request_)
    assert isinstance(outcome, Clarify), outcome
    assert outcome.question == question


@pytest.mark.parametrize(("robot", "request_", "why"), REFUSED, ids=lambda v: str(v)[:50])
def test_what_cannot_be_done_is_refused_with_its_reason(robot: str, request_: str, why: str) -> None:
    outcome = outcome_of(robot, request_)
    assert isinstance(outcome, Refused), outcome
    assert outcome.reasons[0].what == why
