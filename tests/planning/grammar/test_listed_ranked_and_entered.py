"""Plants that the map lists, as many as possible with the best first, and rows of ground that is entered by a gate."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import require_plan
from support.sites.gardens import glasshouse, vegetable_garden

GARDEN, GLASS = vegetable_garden(), glasshouse()
DEMO, VINES = open_site("demo"), open_site("vineyard")
AMIGA, HUSKY, TRACTOR = load_robot("amiga"), load_robot("husky"), load_robot("tractor")

MOIST = "for Where(moisture, gt, 30): [moisture(depth_cm 10); moisture(depth_cm 25)]"
BEANS = "for Where(crop, eq, bean) optional highest height_cm first: [sample_leaf] | duration_s 1800"
OLDEST = "for Trees optional highest age_years first: [picture] | duration_s 600"
SOUTH = "spray rows Rows(of InBlock(South))"

PLANNED = [
    (
        GLASS, AMIGA,
        "Our map lists some plants with a moisture of more than 30. Measure the soil "
        "moisture there again, at 10 cm and at 25 cm.",
        MOIST,
    ),
    (
        GLASS, AMIGA,
        "There are plants with a moisture above 30 on our map. Measure the soil moisture "
        "there at 10 cm and at 25 cm.",
        MOIST,
    ),
    (
        GLASS, AMIGA,
        "The records show plants with a moisture above 30. Measure the soil moisture of "
        "each of them at 10 cm and at 25 cm.",
        MOIST,
    ),
    (
        DEMO, HUSKY, "The map shows some yellow trees. Photograph them.",
        "for Where(leaf_color, eq, yellow): [picture]",
    ),
    (
        GARDEN, AMIGA,
        "You have half an hour to sample leaves of as many beans as you can, beginning "
        "with the tallest.",
        BEANS,
    ),
    (GARDEN, AMIGA, "Sample leaves of as many beans as possible in half an hour, the tallest plants first.", BEANS),
    (
        GARDEN, AMIGA,
        "In half an hour sample leaves of as many beans as possible, starting with the "
        "tallest plants.",
        BEANS,
    ),
    (DEMO, HUSKY, "You've got 10 minutes to photograph as many trees as possible, starting with the oldest.", OLDEST),
    (DEMO, HUSKY, "Photograph as many trees as you can in 10 minutes, oldest first.", OLDEST),
    (
        DEMO, HUSKY, "Photograph the yellow trees, oldest first.",
        "for Ordered(attribute, age_years, True, of Where(leaf_color, eq, yellow)) given: [picture]",
    ),
    (VINES, TRACTOR, "Go to the south block and spray all its rows.", SOUTH),
    (VINES, TRACTOR, "Go into the south block and spray every row there.", SOUTH),
    (
        GLASS, TRACTOR, "Get into the hot bay and film both rows there, each along both sides.",
        "film rows InZone(hot bay, of Rows), both",
    ),
    (GLASS, TRACTOR, "Go to the mild bay and film all two rows there.", "film rows InZone(mild bay, of Rows)"),
    (GARDEN, TRACTOR, "Use the street gate to get in and film bed 3.", "film rows Rows(3, 3) | only street gate"),
    (GARDEN, TRACTOR, "Use the river gate and mow the rose bed.", "mow area InZone(rose bed) | only river gate"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED)
def test_places_are_listed_ranked_and_entered(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


REFUSED = [
    (VINES, TRACTOR, "Go into the south block and spray all 99 rows there."),
    (DEMO, HUSKY, "The map shows some yellow trees. Measure CO2 at tree 4."),
    (GLASS, TRACTOR, "Get into the hot bay and prune every row there."),
]


@pytest.mark.parametrize(("site", "robot", "request_"), REFUSED)
def test_what_does_not_fit_together_is_no_plan(site: Site, robot: RobotProfile, request_: str) -> None:
    assert not isinstance(EnglishPlanner().plan(request_, site, robot), Planned)
