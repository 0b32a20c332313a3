"""Ways to ask for work along paths: what needs work, rates in words, directions, laps and rests."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline
from support.sites.gardens import pasture

PLANNER = EnglishPlanner()
CORNER = "mow area InZone(wet corner)"
TRACTOR = {
    # What needs work.
    "Row 5 needs filming.": "film rows Rows(5, 5)",
    "Rows 2 and 6 need a spray.": "spray rows UnionOf(Rows(2, 2)+Rows(6, 6))",
    "The wet corner could do with a mow.": CORNER,
    "The wet corner is due a cut.": CORNER,
    "Rows 2 to 4 have to be sprayed at 150 l/ha.": "spray rows Rows(2, 4), rate_l_ha 150",
    "The aisles want mowing.": "mow aisles Trees",
    "Give row 6 a good spray.": "spray rows Rows(6, 6)",
    "Give the wet corner a trim.": CORNER,
    "Have rows 2 to 4 filmed.": "film rows Rows(2, 4)",
    "Get the wet corner mown for us please.": CORNER,
    "We'd like row 6 sprayed.": "spray rows Rows(6, 6)",
    "Take the mower over the wet corner.": CORNER,
    "Run the mower across the wet corner.": CORNER,
    "Go and spray row 6.": "spray rows Rows(6, 6)",
    "Do the mowing in the wet corner.": CORNER,
    "Cut the wet corner.": CORNER,
    "Row 2 needs spraying and row 5 needs filming.": "spray rows Rows(2, 2); film rows Rows(5, 5)",
    # Rates and speeds in words.
    "Spray row 6, 220 litres to the hectare.": "spray rows Rows(6, 6), rate_l_ha 220",
    "Spray row 6 with 220 litres per hectare.": "spray rows Rows(6, 6), rate_l_ha 220",
    "Spray row 6 at a rate of 220 liters a hectare.": "spray rows Rows(6, 6), rate_l_ha 220",
    "Row 6 needs a spray of 220 litres/ha.": "spray rows Rows(6, 6), rate_l_ha 220",
    "Spray rows 2 and 3, 220 l per ha.": "spray rows UnionOf(Rows(2, 2)+Rows(3, 3)), rate_l_ha 220",
    "Spray row 6 at 100 litres an acre.": "spray rows Rows(6, 6), rate_l_ha 247.105",
    "Film row 5 at half a metre a second.": "film rows Rows(5, 5) | speed 0.5",
    "Film row 5. Take it slowly, no faster than half a metre per second.": "film rows Rows(5, 5) | speed 0.5",
    # Directions.
    "Film row 5 from the north end to the south end.": "film rows Rows(5, 5), heading south",
    "Film row 5, starting at the south end.": "film rows Rows(5, 5), heading north",
    "Mow between rows 2 and 5 going north.": "mow aisles Rows(2, 5), heading north",
    "Film rows 2 to 4 from south to north.": "film rows Rows(2, 4), heading north",
    "Mow the wet corner in lanes running east to west.": f"{CORNER}, heading east_west",
    "Mow the wet corner, with north-south stripes.": f"{CORNER}, heading north_south",
    "The wet corner wants mowing. The lanes should run north to south.": f"{CORNER}, heading north_south",
    # Responses to events in other words.
    "Film row 5. If anyone gets too close, stand still until they've moved off.": (
        "film rows Rows(5, 5) | at any time person_near: wait, then return_to_start"
    ),
    "Film row 5. The moment somebody walks up to you, freeze, and carry on once they're gone.": (
        "film rows Rows(5, 5) | at any time person_near: wait, then return_to_start"
    ),
    "Film row 5. Should the wind get up past 9 m/s, give it up and drive home.": (
        "film rows Rows(5, 5) | at any time wind > 9 m/s: return_to_start"
    ),
    "Film row 5. If it gets windier than 6 m/s, wait.": (
        "film rows Rows(5, 5) | at any time wind > 6 m/s: wait, then return_to_start"
    ),
    "Film row 5 and pack it in if it rains.": "film rows Rows(5, 5) | at any time rain: end",
    "Film row 5. If it rains, wait it out.": "film rows Rows(5, 5) | at any time rain: wait, then return_to_start",
    "Film row 5, but stop for anyone who gets in the way.": (
        "film rows Rows(5, 5) | at any time person_near: wait, then end"
    ),
    "Film row 5. Somebody about? Hold still until they have gone.": (
        "film rows Rows(5, 5) | at any time person_near: wait, then return_to_start"
    ),
    "Film rows 2 to 4. Whenever the battery drops below 35 percent, recharge first and then carry on.": (
        "film rows Rows(2, 4) | recharge below 35"
    ),
    "Film rows 2 to 4. If the battery gets below a third, go and charge, then carry on where you were.": (
        "film rows Rows(2, 4) | recharge below 33.33"
    ),
}
HUSKY = {
    # Laps and rests.
    "Drive twice around the pond.": "drive perimeter InZone(pond), 2 laps",
    "Do three laps of the wet corner.": "drive perimeter InZone(wet corner), 3 laps",
    "Once round the orchard, then home.": "drive perimeter Trees | return_to_start",
    "Make a circuit of the pond.": "drive perimeter InZone(pond)",
    "Patrol the fence four times, with a five-minute break between laps.": (
        "3 times: [drive perimeter Trees; wait 300]; drive perimeter Trees"
    ),
    "Go round the pond twice and rest a quarter of an hour in between.": (
        "drive perimeter InZone(pond); wait 900; drive perimeter InZone(pond)"
    ),
    "Two laps of the pond with a three-minute rest after each.": ("2 times: [drive perimeter InZone(pond); wait 180]"),
    # Captures along an edge.
    "Go once round the pond with a thermal picture every 8 metres.": "for Transect(8, edge, pond): [picture]",
    "Patrol the fence and read CO2 every 30 m.": "for Transect(30, edge): [co2]",
    "Along the edge of the wet corner, read CO2 every 12 m.": "for Transect(12, edge, wet corner): [co2]",
    "Take pictures at nine points around the pond.": "for Transect(9, edge, pond): [picture]",
    # Captures with a time between them.
    "Take four CO2 readings at tree 9, five minutes apart.": (
        "co2 @ TreeIs(9); wait 300; co2; wait 300; co2; wait 300; co2"
    ),
    "Read the CO2 at tree 9 every two minutes, three times.": "co2 @ TreeIs(9); wait 120; co2; wait 120; co2",
    "Read CO2 at tree 9, and again half an hour later.": "co2 @ TreeIs(9); wait 1800; co2",
    "Read CO2 at tree 9, wait a quarter of an hour and read it again.": "co2 @ TreeIs(9); wait 900; co2",
    "Take a picture of each corner tree twice, with a minute between the two.": (
        "for Corners: [picture; wait 60; picture]"
    ),
    # Orders, and what is left of a sample.
    "CO2 at tree 9, a picture of tree 60 and CO2 at tree 30, in whatever order is quickest.": (
        "any order: [co2 @ TreeIs(9); picture @ TreeIs(60); co2 @ TreeIs(30)]"
    ),
    "Photograph every other tree of row 5. If the hottest of them is over 34 degrees, photograph the others too.": (
        "for EveryNth(2, of Rows(5, 5)): [picture = r1]; if maximum(r1 > 34 degC): "
        "[for Excluding(EveryNth(2, of Rows(5, 5)), of Rows(5, 5)): [picture]]"
    ),
}
#: On a pasture without plants, by the robot.
PASTURE = {
    "amiga": {
        "Lay a 20 metre grid over the long pasture and read the soil moisture at each crossing, except in the boggy "
        "corner.": "for InZone(boggy corner, True, of Grid(20, long pasture)): [moisture]",
        "Cross the bank in an X and test the nitrate at six spots on the way.": "for Transect(6, x, bank): [nitrate]",
        "Walk a W over the bank, stopping eight times to read the soil moisture.": "for Transect(8, bank): [moisture]",
        "How wet is the cow paddock on average? Nine spots, 20 cm deep, should tell us.": (
            "for PointsIn(cow paddock, 9): [moisture(depth_cm 20)]"
        ),
        "How much nitrate is there in the bank? Six points spread over it should do.": (
            "for PointsIn(bank, 6): [nitrate]"
        ),
        "Eight soil moisture readings scattered at random across the bank.": "for PointsIn(bank, 8, True): [moisture]",
        "Read the soil moisture along the pond's edge, every 5 m.": "for Transect(5, edge, pond): [moisture]",
    },
    "husky": {
        "Patrol the sheep fence with a CO2 reading every 20 m.": "for Transect(20, edge, sheep fence): [co2]",
        "Read the air temperature at the bank and the cowslip patch, whichever way round is shortest.": (
            "for UnionOf(PointsIn(bank)+PointsIn(cowslip patch)): [air]"
        ),
    },
    "tractor": {
        "The bank wants mowing, in stripes from east to west.": "mow area InZone(bank), heading east_west",
        "Tomorrow, not before ten, mow the bank.": "mow area InZone(bank) | day=tomorrow not_before=10:00",
        "After 7 this evening the bank needs a cut.": "mow area InZone(bank) | day=today not_before=19:00",
    },
}
ASKED = {
    "tractor": ["Mow the wet corner east to west."],
    "amiga": ["Test the soil at tree 9."],
    "husky": [],
}
REFUSED = {
    "tractor": ["Cut row 5.", "Trim the trees of row 5.", "Spray row 5 from west to east.", "Give tree 4 a spray."],
    "husky": ["Row 5 needs spraying.", "Go to tree 9, then come back and take a picture on the way."],
}


def _plan(robot: str, request: str):
    return PLANNER.plan(request, open_site("demo"), load_robot(robot))


@pytest.mark.parametrize(
    ("robot", "request_", "expected"),
    [*(("tractor", *item) for item in TRACTOR.items()), *(("husky", *item) for item in HUSKY.items())],
)
def test_what_is_asked_for_in_other_words_is_planned(robot: str, request_: str, expected: str) -> None:
    planned = _plan(robot, request_)
    assert isinstance(planned, Planned), planned
    assert outline(planned.task) == expected


@pytest.mark.parametrize(
    ("robot", "request_", "expected"), [(robot, *item) for robot, all_ in PASTURE.items() for item in all_.items()]
)
def test_work_on_ground_without_plants_is_planned(robot: str, request_: str, expected: str) -> None:
    planned = PLANNER.plan(request_, pasture(), load_robot(robot))
    assert isinstance(planned, Planned), planned
    assert outline(planned.task).removesuffix(" | return_to_start") == expected


@pytest.mark.parametrize(("robot", "request_"), [(robot, one) for robot, all_ in ASKED.items() for one in all_])
def test_what_may_mean_two_things_is_asked(robot: str, request_: str) -> None:
    assert isinstance(_plan(robot, request_), Clarify)


@pytest.mark.parametrize(("robot", "request_"), [(robot, one) for robot, all_ in REFUSED.items() for one in all_])
def test_what_cannot_be_planned_is_refused(robot: str, request_: str) -> None:
    assert isinstance(_plan(robot, request_), Refused)
