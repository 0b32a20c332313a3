"""Requests about fields as growers say them: plants by a size, references, samples of areas, sides of things."""

from __future__ import annotations

import pytest

from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.plan import walk
from planning.english.outlines import outline
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

PLANNED = [
    (
        GARDEN,
        AMIGA,
        "any bean that's shorter than 43 cm, I want a leaf off it",
        "for Where(height_cm, lt, 43, of Where(crop, eq, bean)): [sample_leaf]",
    ),
    (
        GARDEN,
        AMIGA,
        "any bean shorter than 0.43 m wants a picture",
        "for Where(height_cm, lt, 43, of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph any potatoes that are taller than 30 cm",
        "for Where(height_cm, gt, 30, of Where(crop, eq, potato)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "a leaf from any squash that is under 55 cm, please",
        "for Where(height_cm, lt, 55, of Where(crop, eq, squash)): [sample_leaf]",
    ),
    (
        GARDEN,
        AMIGA,
        "any beans over 50 cm, take a picture of them",
        "for Where(height_cm, gt, 50, of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph any two beans taller than 45 cm",
        "for Take(2, of Where(height_cm, gt, 45, of Where(crop, eq, bean))): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "take a leaf off every kale plant that's shorter than 65 cm",
        "for Where(height_cm, lt, 65, of Where(crop, eq, kale)): [sample_leaf]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the kale, but drive less than 200 m",
        "for Where(crop, eq, kale): [picture] | distance_m 200",
    ),
]

ASKED = [
    (GARDEN, AMIGA, "photograph any bean", 2),
]

REFUSED = [
    (
        GARDEN,
        AMIGA,
        "photograph the kale, shorter than 200 m",
        "'shorter than 200 m' does not fit at this point in 'photograph the kale, shorter than 200 m'",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph any kale under 20 cm",
        "nothing on this site matches the trees whose crop is kale, whose height is below 20 cm",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph any of the beans that are shorter than 43 cm",
        "'that are shorter than' does not fit at this point in 'photograph any of the beans that are shorter than 43 cm'",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "any melon that's shorter than 3 m, take a thermal picture of it",
        "'shorter than': this site records no height of its trees",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "take a thermal picture of the mint plants that are shorter than 3 m",
        "'shorter than': this site records no height of its trees",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "a thermal picture of any aubergine under 20 cm",
        "'under 20 cm' does not fit at this point in 'a thermal picture of any aubergine under 20 cm'",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the kale within 20 cm",
        "'within 20 cm' does not fit at this point in 'photograph the kale within 20 cm'",
    ),
]


def _name(value: object) -> str:
    return value if isinstance(value, str) else ""


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=_name)
def test_a_request_about_a_field_has_its_plan(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    outcome = EnglishPlanner().plan(request_, site, robot)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).removesuffix(" | return_to_start") == plan
    for node in walk(outcome.task.composition.plan):
        if node.selector is not None and node.work is None and not node.selector.relative:
            assert resolve(node.selector, site, Context(here=site.start))


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=_name)
def test_what_the_site_does_not_tell_is_asked(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    outcome = EnglishPlanner().plan(request_, site, robot)
    assert isinstance(outcome, Clarify), outcome
    assert len(outcome.choices) == ways


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=_name)
def test_what_a_field_lacks_is_refused_with_the_reason(
    site: Site, robot: RobotProfile, request_: str, why: str
) -> None:
    outcome = EnglishPlanner().plan(request_, site, robot)
    assert isinstance(outcome, Refused), outcome
    assert why in " | ".join(str(reason.what) for reason in outcome.reasons)
