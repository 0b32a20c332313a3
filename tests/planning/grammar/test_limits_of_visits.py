"""How many places are visited at most, how well a mean is to be known, and what a study is about."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_refusal
from support.sites.gardens import vegetable_garden

DEMO, GARDEN = open_site("demo"), vegetable_garden()
HUSKY, AMIGA = load_robot("husky"), load_robot("amiga")
BEANS = "Where(crop, eq, bean)"
KNOWN = f"for {BEANS} at most 6 until mean(r1) +- 0.5 degC from 5: [picture = r1]"
AT_MOST = f"for {BEANS} at most 6: [picture]"
THREE = "for Take(3, of Where(crop, eq, bean)): [nitrate]"

PLANNED = [
    (
        GARDEN,
        HUSKY,
        "Take thermal pictures of the beans one by one"
        " until you know their mean to within half a degree, but visit no more than six plants.",
        KNOWN,
    ),
    (
        GARDEN,
        HUSKY,
        "Take thermal pictures of the beans until the mean is known to within half a degree, at most six plants.",
        KNOWN,
    ),
    (
        GARDEN,
        HUSKY,
        "Take thermal pictures of the beans until the mean is known to within 0.5 degrees, but visit at most six.",
        KNOWN,
    ),
    (
        GARDEN,
        HUSKY,
        "Take thermal pictures of the beans"
        " until the mean is known to within 0.5 degrees, but do no more than six plants.",
        KNOWN,
    ),
    (
        GARDEN,
        HUSKY,
        "Take thermal pictures of the beans until the mean is known to within a degree, at most six plants.",
        KNOWN.replace("0.5", "1"),
    ),
    (GARDEN, HUSKY, "Photograph the beans, but visit no more than six plants.", AT_MOST),
    (GARDEN, HUSKY, "Photograph the beans. Visit at most six.", AT_MOST),
    (GARDEN, HUSKY, "Photograph the beans, but do at most six.", AT_MOST),
    (
        DEMO,
        HUSKY,
        "Measure CO2 at the yellow trees, but measure at most five of them.",
        "for Where(leaf_color, eq, yellow) at most 5: [co2]",
    ),
    (
        DEMO,
        HUSKY,
        "Photograph trees 4 and 9, but photograph no tree twice.",
        "for UnionOf(TreeIs(4)+TreeIs(9)): [picture]",
    ),
    (DEMO, HUSKY, "Photograph trees 4 and 9, no tree more than once.", "for UnionOf(TreeIs(4)+TreeIs(9)): [picture]"),
    (GARDEN, HUSKY, "Photograph the beans, but visit no plant twice.", "for Where(crop, eq, bean): [picture]"),
    (DEMO, HUSKY, "Visit at most ten trees of row 3 and photograph them.", "for Rows(3, 3) at most 10: [picture]"),
    (GARDEN, AMIGA, "For the nitrogen trial, read the nitrate of three beans.", THREE),
    (GARDEN, AMIGA, "For our nitrate study, read the nitrate of three beans.", THREE),
    (GARDEN, AMIGA, "For my fertiliser experiment I need the nitrate of three beans.", THREE),
    (GARDEN, AMIGA, "For the soil nitrate survey we need the nitrate of three beans.", THREE),
]

REFUSED = [
    (
        DEMO,
        HUSKY,
        "Photograph trees 4 and 5, but visit at most ten trees of row 3.",
        "it does not say what to do there",
    ),
    (DEMO, HUSKY, "Visit at most ten trees of row 3.", "it does not say what to do there"),
    (DEMO, HUSKY, "For the CO2 study, photograph tree 4.", "the request says 'co2'"),
    (GARDEN, AMIGA, "For each trial, photograph V11.", "trial"),
    (GARDEN, AMIGA, "For the bean trial, photograph row 3, every plant.", "trial"),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_visits_are_limited(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_visits_for_nothing_are_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)


@pytest.mark.parametrize(
    ("site", "robot", "request_", "plan"),
    [
        (
            DEMO,
            HUSKY,
            "Photograph tree 4, then as many other trees as you can in 10 minutes.",
            "picture @ TreeIs(4); for NotVisited optional: [picture] | duration_s 600",
        ),
        (
            GARDEN,
            AMIGA,
            "Read the nitrate at the tallest bean first, and then at as many other beans as you can in 10 minutes.",
            "nitrate @ Top(height_cm, 1, of Where(crop, eq, bean));"
            " for NotVisited(of Where(crop, eq, bean)) optional: [nitrate] | duration_s 600",
        ),
        (
            DEMO,
            HUSKY,
            "Photograph as many different trees as possible in 10 minutes.",
            "for Trees optional: [picture] | duration_s 600",
        ),
    ],
    ids=name,
)
def test_other_places_are_those_not_visited(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)
