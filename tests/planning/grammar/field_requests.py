"""What is checked of requests about fields: their plans, the questions that they lead to, and their refusals."""

from __future__ import annotations

from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.plan import walk
from planning.english.outlines import outline


def name(value: object) -> str:
    """Return the text of a test's parameter as its name."""
    return value if isinstance(value, str) else ""


def require_plan(site: Site, robot: RobotProfile, request: str, plan: str) -> None:
    outcome = EnglishPlanner().plan(request, site, robot)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).removesuffix(" | return_to_start") == plan
    for node in walk(outcome.task.composition.plan):
        if node.selector is not None and node.work is None and not node.selector.relative:
            assert resolve(node.selector, site, Context(here=site.start))


def require_question(site: Site, robot: RobotProfile, request: str, ways: int) -> None:
    outcome = EnglishPlanner().plan(request, site, robot)
    assert isinstance(outcome, Clarify), outcome
    assert len(outcome.choices) == ways


def require_refusal(site: Site, robot: RobotProfile, request: str, why: str) -> None:
    outcome = EnglishPlanner().plan(request, site, robot)
    assert isinstance(outcome, Refused), outcome
    assert why in " | ".join(str(reason.what) for reason in outcome.reasons)
