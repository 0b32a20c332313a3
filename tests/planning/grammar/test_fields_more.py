"""Further requests about fields: one more of a kind, neighbours, which of two, depths of a probe, distances to keep."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from planning.grammar.field_requests import require_plan, require_question
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

TWO_PICTURES = "picture @ PointsIn(bank); picture @ PointsIn(boggy corner)"
BESIDE = (
    "for UnionOf(Where(frost_damage, eq, True, of Where(crop, eq, squash))"
    "+TreeIs(V58)+TreeIs(V56)+TreeIs(V54)+TreeIs(V52)): [picture]"
)
WETTER = "for UnionOf(PointsIn(bank, 4)+PointsIn(boggy corner, 4)): [moisture]"
RICHER = (
    "for UnionOf(Evenly(3, of Where(crop, eq, bean, of Rows(4, 4)))"
    "+Evenly(3, of Where(crop, eq, squash, of Rows(5, 5)))): [nitrate]"
)
CLEAR = "for PointsIn(cow paddock, 9, True): [moisture] | avoid InZone(pond) 10 m"
DEEP = "for Where(crop, eq, bean): [moisture(depth_cm 25)]"

PLANNED = [
    (PASTURE, HUSKY, "Take a thermal photo of the bank, followed by one of the boggy corner.", TWO_PICTURES),
    (PASTURE, HUSKY, "Take a thermal photo of the bank and then one of the boggy corner.", TWO_PICTURES),
    (PASTURE, HUSKY, "Start with a thermal photo of the bank, followed by one of the boggy corner.", TWO_PICTURES),
    (
        PASTURE,
        HUSKY,
        "Start at sunrise with a thermal photo of the bank, followed by one of the boggy corner.",
        f"{TWO_PICTURES} | not_before=sunrise not_after=sunrise+15",
    ),
    (GARDEN, HUSKY, "Picture each squash with frost damage and the plants directly on either side of it.", BESIDE),
    (GARDEN, HUSKY, "Picture each squash with frost damage and also the plants right next to it.", BESIDE),
    (GARDEN, HUSKY, "Picture each squash with frost damage and its two neighbours.", BESIDE),
    (GARDEN, HUSKY, "Picture each squash with frost damage and both its neighbours.", BESIDE),
    (PASTURE, AMIGA, "Which is wetter, the bank or the boggy corner? Take four readings in each.", WETTER),
    (PASTURE, AMIGA, "Which is drier, the bank or the boggy corner? Measure at four points in each.", WETTER),
    (GARDEN, AMIGA, "Which has more nitrate under it, the beans or the squash? Use three plants of each.", RICHER),
    (
        GARDEN,
        AMIGA,
        "Which have more nitrate, the beans or the squash? Take three of each, evenly spread, and compare them.",
        RICHER,
    ),
    (
        PASTURE,
        AMIGA,
        "Read soil moisture at nine random points in the cow paddock, none within 10 m of the pond.",
        CLEAR,
    ),
    (
        PASTURE,
        AMIGA,
        "Read soil moisture at nine random points in the cow paddock, at least 10 m from the pond.",
        CLEAR,
    ),
    (
        PASTURE,
        AMIGA,
        "Read soil moisture at nine random points in the cow paddock, none closer than 10 m to the pond.",
        CLEAR,
    ),
    (GARDEN, AMIGA, "Read soil moisture at every bean and push the probe down to 25 cm.", DEEP),
    (GARDEN, AMIGA, "Read soil moisture at every bean. Push the probe 25 cm deep.", DEEP),
    (GARDEN, AMIGA, "Read soil moisture at every bean, with the probe 25 cm down.", DEEP),
    (
        GLASSHOUSE,
        AMIGA,
        "Measure soil moisture at the plants whose moisture on the map is below 24, driest first.",
        "for Ordered(attribute, moisture, of Where(moisture, lt, 24)) given: [moisture]",
    ),
    (
        PASTURE,
        HUSKY,
        "Read CO2 at random spots on the bank until the mean is known to 20 ppm, but stop after 20 at the latest.",
        "for PointsIn(bank, 20, True) at most 20 until mean(r1) +- 20 ppm from 5: [co2 = r1]",
    ),
    (
        PASTURE,
        HUSKY,
        "Read CO2 at random spots on the bank until the mean is known to 20 ppm. In any case stop after 20.",
        "for PointsIn(bank, 20, True) at most 20 until mean(r1) +- 20 ppm from 5: [co2 = r1]",
    ),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED)
def test_requests_about_fields_are_planned(site: object, robot: object, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(
    ("site", "robot", "request_", "ways"),
    [
        (PASTURE, HUSKY, "Which is warmer, the bank or the boggy corner? Take four readings in each.", 2),
        (GARDEN, AMIGA, "Recheck every bean and push the probe down to 25 cm.", 2),
    ],
)
def test_what_is_read_there_is_asked(site: object, robot: object, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


def test_a_part_of_a_row_is_worked() -> None:
    require_plan(GLASSHOUSE, TRACTOR, "Spray row 4 from H4-2 to H4-6.", "spray rows InRow(2, 6, of Rows(4, 4))")
