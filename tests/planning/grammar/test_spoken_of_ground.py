"""Requests about ground that was spoken of, rounds and strips, laid points, and readings that are compared."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE, ORCHARD = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

PLANNED = [
    (
        PASTURE,
        TRACTOR,
        (
            "Read the soil moisture at six evenly spread points in the boggy corner. Mow it only if the mean"
            " is under 30 percent."
        ),
        "for PointsIn(boggy corner, 6): [moisture = r1]; if mean(r1 < 30 percent): [mow area InZone(boggy corner)]",
    ),
    (
        PASTURE,
        TRACTOR,
        "Read the soil moisture in the middle of the bank and mow it if it is below 30 percent.",
        "moisture @ PointsIn(bank) = r1; if r1 < 30 percent: [mow area InZone(bank)]",
    ),
    (
        PASTURE,
        TRACTOR,
        "Take a picture in the middle of the bank, then mow it.",
        "picture @ PointsIn(bank); mow area InZone(bank)",
    ),
    (
        PASTURE,
        TRACTOR,
        (
            "Drive to the boggy corner, read the soil moisture at six points there, and mow it if the "
            "average is under 30 percent."
        ),
        "for PointsIn(boggy corner, 6): [moisture = r1]; if mean(r1 < 30 percent): [mow area InZone(boggy corner)]",
    ),
    (
        GARDEN,
        TRACTOR,
        "Read the soil moisture at five plants of bed 6. If the average is below 20 percent, spray it.",
        "for Take(5, of Rows(6, 6)): [moisture = r1]; if mean(r1 < 20 percent): [spray rows Rows(6, 6)]",
    ),
    (
        PASTURE,
        HUSKY,
        "Go through the middle gate to the pond. Circle it once with a thermal picture every 10 metres.",
        "go GateIs(middle gate); for Transect(10, edge, pond): [picture]",
    ),
    (
        PASTURE,
        HUSKY,
        "Go through the middle gate to the bank and read CO2 in its middle.",
        "go GateIs(middle gate); co2 @ PointsIn(bank)",
    ),
    (
        PASTURE,
        HUSKY,
        "Go to the pond and drive once around it, taking a thermal picture every 10 metres.",
        "for Transect(10, edge, pond): [picture]",
    ),
    (
        PASTURE,
        HUSKY,
        "Drive to the pond, circle it twice and come home.",
        "drive perimeter InZone(pond), 2 laps",
    ),
    (
        PASTURE,
        HUSKY,
        "Circle the pond once with a thermal picture every 10 metres.",
        "for Transect(10, edge, pond): [picture]",
    ),
    (
        PASTURE,
        TRACTOR,
        "Mow two laps around the cow paddock.",
        "mow perimeter InZone(cow paddock), 2 laps",
    ),
    (
        PASTURE,
        TRACTOR,
        "Mow a strip all round the cow paddock.",
        "mow perimeter InZone(cow paddock)",
    ),
    (
        GARDEN,
        TRACTOR,
        "Film the bean bed and the kale bed in one pass each, and go no faster than half a metre per second.",
        "film rows UnionOf(Rows(4, 4)+Rows(6, 6)) | speed 0.5",
    ),
    (
        GARDEN,
        TRACTOR,
        "Film bed 3, bed 4 and bed 6 in a single pass each.",
        "film rows UnionOf(Rows(3, 3)+Rows(4, 4)+Rows(6, 6))",
    ),
    (
        PASTURE,
        AMIGA,
        "Lay a W with twelve points over the bank and read the soil moisture at 40 cm at each of them.",
        "for Transect(12, bank): [moisture(depth_cm 40)]",
    ),
    (
        PASTURE,
        AMIGA,
        "Walk a W over the bank with twelve points and read the soil moisture at each.",
        "for Transect(12, bank): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "Set out twelve points in a W over the bank and read the soil moisture at each.",
        "for Transect(12, bank): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "Spread twelve points over the bank. Read the soil moisture at each of them.",
        "for PointsIn(bank, 12): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        (
            "Keep reading the nitrate at random points in the cow paddock until the mean is known to within "
            "3 ppm. Give up after thirty readings."
        ),
        "for PointsIn(cow paddock, 30, True) at most 30 until mean(r1) +- 3 ppm from 5: [nitrate = r1]",
    ),
    (
        PASTURE,
        AMIGA,
        (
            "Read the nitrate at random points on the bank until the mean is known to within 3 ppm. Stop "
            "after twenty at the latest."
        ),
        "for PointsIn(bank, 20, True) at most 20 until mean(r1) +- 3 ppm from 5: [nitrate = r1]",
    ),
    (
        GARDEN,
        HUSKY,
        (
            "Take a CO2 reading at the manure heap, wait ten minutes and take another. If it has gone up by "
            "more than 50 ppm, take one at the rose bed as well."
        ),
        (
            "co2 @ PointsIn(manure heap) = r2; wait 600; co2 = r1; if mean(r1) > mean(r2) + 50 ppm: [co2 @ "
            "PointsIn(rose bed)]"
        ),
    ),
    (
        GARDEN,
        HUSKY,
        (
            "Take a CO2 reading at the manure heap, wait ten minutes and take another. If the second is more"
            " than 50 ppm higher than the first, take one at the rose bed."
        ),
        (
            "co2 @ PointsIn(manure heap) = r2; wait 600; co2 = r1; if mean(r1) > mean(r2) + 50 ppm: [co2 @ "
            "PointsIn(rose bed)]"
        ),
    ),
    (
        ORCHARD,
        HUSKY,
        (
            "Measure CO2 at tree 4, wait 10 minutes and measure CO2 again. If it has dropped by at least 20 "
            "ppm since then, photograph tree 4."
        ),
        "co2 @ TreeIs(4) = r2; wait 600; co2 = r1; if mean(r1) <= mean(r2) + -20 ppm: [picture @ TreeIs(4)]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at tree 4, wait 10 minutes and measure again. If the value has dropped, photograph it.",
        "co2 @ TreeIs(4) = r2; wait 600; co2 = r1; if mean(r1) < mean(r2): [picture]",
    ),
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at tree 4, then at tree 9. If the second reading is lower than the first, photograph tree 9.",
        "co2 @ TreeIs(4) = r2; co2 @ TreeIs(9) = r1; if mean(r1) < mean(r2): [picture @ TreeIs(9)]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        (
            "Read the air temperature at four random spots in each bay. If the hot one averages more than 5 "
            "degrees above the mild one, take a CO2 reading in its middle."
        ),
        (
            "for PointsIn(hot bay, 4, True): [air = r1]; for PointsIn(mild bay, 4, True): [air = r2]; if "
            "mean(r1) > mean(r2) + 5 degC: [co2 @ PointsIn(hot bay)]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        (
            "Read the nitrate at five evenly spread beans and five evenly spread potatoes. Then take three "
            "leaf samples from the crop that came out lower on average."
        ),
        (
            "for Evenly(5, of Where(crop, eq, bean, of Rows(4, 4))): [nitrate = r1]; "
            "for Spread(5, of Where(crop, eq, potato)): [nitrate = r2]; "
            "if mean(r1) < mean(r2): [for Take(3, of Where(crop, eq, bean, of Rows(4, 4))): [sample_leaf]] "
            "else [for Take(3, of Where(crop, eq, potato)): [sample_leaf]]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        (
            "Read the nitrate at five plants of bed 4 and five plants of bed 5. Take three leaf samples from"
            " the bed with the lower mean."
        ),
        (
            "for Take(5, of Rows(4, 4)): [nitrate = r1]; for Take(5, of Rows(5, 5)): [nitrate = r2]; if "
            "mean(r1) < mean(r2): [for Take(3, of Rows(4, 4)): [sample_leaf]] else [for Take(3, of Rows(5, "
            "5)): [sample_leaf]]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        (
            "Read the soil moisture at every third bean and every third kale, and photograph four plants of "
            "the drier crop."
        ),
        (
            "for EveryNth(3, of Where(crop, eq, bean)): [moisture = r1]; for EveryNth(3, of Where(crop, eq, "
            "kale)): [moisture = r2]; if mean(r1) < mean(r2): [for Take(4, of Where(crop, eq, bean)): "
            "[picture]] else [for Take(4, of Where(crop, eq, kale)): [picture]]"
        ),
    ),
    (
        PASTURE,
        AMIGA,
        (
            "Read the soil moisture at six points in the boggy corner and six points on the bank. Read the "
            "nitrate at three points in the drier of the two areas."
        ),
        (
            "for PointsIn(boggy corner, 6): [moisture = r1]; for PointsIn(bank, 6): [moisture = r2]; if "
            "mean(r1) < mean(r2): [for PointsIn(boggy corner, 3): [nitrate]] else [for PointsIn(bank, 3): "
            "[nitrate]]"
        ),
    ),
    (
        PASTURE,
        AMIGA,
        (
            "Read the soil moisture at six points in the boggy corner and on the bank each. Then read the "
            "nitrate at three points in whichever is drier."
        ),
        (
            "for PointsIn(boggy corner, 6): [moisture = r1]; for PointsIn(bank, 6): [moisture = r2]; if "
            "mean(r1) < mean(r2): [for PointsIn(boggy corner, 3): [nitrate]] else [for PointsIn(bank, 3): "
            "[nitrate]]"
        ),
    ),
    (
        ORCHARD,
        HUSKY,
        (
            "Measure CO2 at every tree in row 3 and every tree in row 4. Photograph every tree of the row "
            "with the higher average."
        ),
        (
            "for Rows(3, 3): [co2 = r1]; for Rows(4, 4): [co2 = r2]; if mean(r1) > mean(r2): [for Rows(3, "
            "3): [picture]] else [for Rows(4, 4): [picture]]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        "Read the soil moisture at V3-1 and V4-1, then photograph the drier one.",
        "for UnionOf(TreeIs(V31)+TreeIs(V41)): [moisture = r1]; picture @ ByReading(r1, soil_moisture, True)",
    ),
]

REFUSED = [
    (
        PASTURE,
        TRACTOR,
        "Mow it.",
        "it does not say where",
    ),
    (
        PASTURE,
        HUSKY,
        "Take a thermal picture every 10 metres around the pond, anticlockwise.",
        "points along an edge are visited clockwise",
    ),
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at every tree of row 3. If it has gone up by 20 ppm, photograph tree 4.",
        "it is not clear which readings are tested",
    ),
    (
        ORCHARD,
        HUSKY,
        "Measure CO2 at tree 4. Photograph every tree of the higher row.",
        "it is not clear which of them",
    ),
    (
        GARDEN,
        TRACTOR,
        "Film bed 3 from both sides in one pass.",
        "the request asks for nothing to be done",
    ),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_the_plan_is_what_is_meant(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_the_refusal_says_why(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
