"""Sentences that build on those before: "when you have them all", "and again in the herb patch", "do the same in"."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE, ORCHARD = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

# What is done when all of it is done.
HOTTEST = "for Where(crop, eq, squash): [picture = r1]; {}ByReading(r1, canopy_temperature){}"


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Take a thermal picture of every squash. When you have them all, go back to the hottest one and measure the "
         "air temperature there.", HOTTEST.format("go ", "; air")),
        ("Photograph every squash, and once they have all been photographed go to the hottest one and read CO2.",
         HOTTEST.format("go ", "; co2")),
        ("Photograph every squash. When you are through with the bed, read CO2 at the hottest plant.",
         HOTTEST.format("co2 @ ", "")),
        ("Photograph every squash. After you have done them all, read CO2 at the hottest one.",
         HOTTEST.format("co2 @ ", "")),
        ("Photograph every squash. Once you've got the lot, return to the warmest and read CO2.",
         HOTTEST.format("go ", "; co2")),
        ("Photograph every squash. When all of them are done, read CO2 at the rose bed.",
         "for Where(crop, eq, squash): [picture]; co2 @ PointsIn(rose bed)"),
        ("Photograph every squash. After the last one, drive to the manure heap and read CO2.",
         "for Where(crop, eq, squash): [picture]; co2 @ PointsIn(manure heap)"),
        ("Photograph every squash. With all the pictures taken, go to the hottest one.", HOTTEST.format("go ", "")),
        ("Photograph every squash. When the whole bed is done, measure CO2 at the manure heap.",
         "for Where(crop, eq, squash): [picture]; co2 @ PointsIn(manure heap)"),
    ],
)  # fmt: skip
def test_work_follows_when_all_before_it_is_done(request_: str, plan: str) -> None:
    require_plan(GARDEN, HUSKY, request_, plan)


ELSEWHERE = [
    (GARDEN, HUSKY, "Measure CO2 at the rose bed and again in the manure heap, and report how far apart the two are.",
     "co2 @ PointsIn(rose bed); co2 @ PointsIn(manure heap)"),
    (GARDEN, HUSKY, "Take the air temperature at the rose bed and once more at the manure heap.",
     "air @ PointsIn(rose bed); air @ PointsIn(manure heap)"),
    (GARDEN, HUSKY, "Read CO2 at the rose bed, then again at the street gate.",
     "co2 @ PointsIn(rose bed); go GateIs(street gate); co2"),
    (GARDEN, HUSKY, "Read CO2 at the rose bed and a second time at the manure heap.",
     "co2 @ PointsIn(rose bed); co2 @ PointsIn(manure heap)"),
    (ORCHARD, HUSKY, "Measure CO2 and the air temperature at tree 4 and again at tree 9.",
     "co2 @ TreeIs(4); air; go TreeIs(9); co2; air"),
    (GLASSHOUSE, HUSKY, "Measure the CO2 in the middle of the hot bay and do the same in the mild bay.",
     "co2 @ PointsIn(hot bay); co2 @ PointsIn(mild bay)"),
    (GLASSHOUSE, HUSKY,
     "Measure the CO2 at the west end and the east end of the hot bay, then do the same in the mild bay.",
     "for UnionOf(Transect(1, edge, hot bay, west)+Transect(1, edge, hot bay, east)): [co2]; "
     "for UnionOf(Transect(1, edge, mild bay, west)+Transect(1, edge, mild bay, east)): [co2]"),
    (PASTURE, HUSKY, "Read CO2 at the north and the south end of the bank and do the same in the boggy corner.",
     "for UnionOf(Transect(1, edge, bank, north)+Transect(1, edge, bank, south)): [co2]; "
     "for UnionOf(Transect(1, edge, boggy corner, north)+Transect(1, edge, boggy corner, south)): [co2]"),
    (GARDEN, HUSKY, "Read CO2 next to the manure heap and again in the rose bed.",
     "co2 @ Transect(1, edge, manure heap, -1.5); co2 @ PointsIn(rose bed)"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), ELSEWHERE, ids=name)
def test_the_same_is_done_elsewhere(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


MEAN = "for {0}: [picture = r1]; if {2}(r1 > 30 degC): [for {1}: [picture]]"
ROWS = MEAN.format("Rows(4, 4)", "Rows(5, 5)", "mean")
ASKED_FOR = [
    ("Get the average leaf temperature of row 4, and if that is above 30 degrees do row 5 as well.", ROWS),
    ("What is the average leaf temperature of row 4? If it is above 30 degrees do row 5 as well.", ROWS),
    ("Find the mean leaf temperature of row 4; if it exceeds 30 degrees, do the same in row 5.", ROWS),
    ("Photograph row 4 and work out the average. If it is above 30 degrees, do row 5 too.", ROWS),
    ("Take thermal pictures of row 4, and if the average is above 30 degrees do row 5 as well.", ROWS),
    ("What is the highest leaf temperature of row 4? If it is above 30 degrees, do row 5 too.",
     MEAN.format("Rows(4, 4)", "Rows(5, 5)", "maximum")),
    ("Measure the average canopy temperature of the squash. If it is over 30 degrees, photograph the kale as well.",
     MEAN.format("Where(crop, eq, squash)", "Where(crop, eq, kale)", "mean")),
    ("Photograph every third plant of row 4. If the average is over 30 degrees do row 5 as well.",
     MEAN.format("EveryNth(3, of Rows(4, 4))", "EveryNth(3, of Rows(5, 5))", "mean")),
    ("Take five CO2 readings in the rose bed. If the average is above 500 ppm, do the manure heap too.",
     "for PointsIn(rose bed, 5): [co2 = r1]; if mean(r1 > 500 ppm): [for PointsIn(manure heap, 5): [co2]]"),
    ("Take the air temperature at the rose bed. If it is above 30 degrees do the manure heap as well.",
     "air @ PointsIn(rose bed) = r1; if r1 > 30 degC: [air @ PointsIn(manure heap)]"),
]  # fmt: skip


@pytest.mark.parametrize(("request_", "plan"), ASKED_FOR)
def test_it_is_the_statistic_that_was_asked_for(request_: str, plan: str) -> None:
    require_plan(GARDEN, HUSKY, request_, plan)


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        ("Measure the average leaf temperature of each row. If it is above 30 degrees, photograph the kale.",
         "it is not clear which of them"),
        ("Get the average leaf temperature of row 4. Wherever it is above 30 degrees, read CO2 too.", ""),
    ],
)  # fmt: skip
def test_one_of_several_means_is_not_guessed(request_: str, why: str) -> None:
    require_refusal(GARDEN, HUSKY, request_, why)


def test_at_how_many_places_of_bare_ground_a_mean_is_measured_is_asked() -> None:
    require_question(GARDEN, HUSKY, "Measure the average CO2 in the rose bed.", 0)


COMPARED = [
    (PASTURE, HUSKY, "Air temperature at the bank, again after 20 minutes, and if it rose 2 degrees or more "
     "measure CO2.",
     "air @ PointsIn(bank) = r2; wait 1200; air = r1; if mean(r1) >= mean(r2) + 2 degC: [co2]"),
    (PASTURE, HUSKY, "Read CO2 at the bank and once more half an hour later. If it dropped by 50 ppm or more, "
     "read the air "
     "temperature.", "co2 @ PointsIn(bank) = r2; wait 1800; co2 = r1; if mean(r1) <= mean(r2) + -50 ppm: [air]"),
    (PASTURE, HUSKY, "Start with an air temperature reading in the boggy corner. Then take eight more, evenly "
     "spread over "
     "the cow paddock, and compare their average with the one from the boggy corner.",
     "air @ PointsIn(boggy corner); for PointsIn(cow paddock, 8): [air]"),
    (PASTURE, HUSKY, "Read CO2 in the boggy corner and five more on the bank, and compare the bank with the "
     "boggy corner.",
     "co2 @ PointsIn(boggy corner); for PointsIn(bank, 5): [co2]"),
    (PASTURE, HUSKY, "My supervisor believes that it is cooler at the water. Take five air temperature readings "
     "around the "
     "pond and five on the bank and tell me whether she is right.",
     "for Transect(5, edge, pond): [air]; for PointsIn(bank, 5): [air]"),
    (PASTURE, HUSKY, "Take three CO2 readings on the bank and three in the boggy corner and tell me whether the "
     "bank is "
     "higher.", "for PointsIn(bank, 3): [co2]; for PointsIn(boggy corner, 3): [co2]"),
    (PASTURE, HUSKY, "Take three CO2 readings on the bank and three in the boggy corner and say how big the gap "
     "between "
     "them is.", "for PointsIn(bank, 3): [co2]; for PointsIn(boggy corner, 3): [co2]"),
    (PASTURE, HUSKY, "I think it is colder in the boggy corner than on the bank. Take four air temperature readings in "
     "each and tell me if I am right.", "for UnionOf(PointsIn(boggy corner, 4)+PointsIn(bank, 4)): [air]"),
    (PASTURE, AMIGA, "My boss claims that the bank is wetter than the boggy corner. Take four moisture readings "
     "in each.",
     "for UnionOf(PointsIn(bank, 4)+PointsIn(boggy corner, 4)): [moisture]"),
    (PASTURE, HUSKY, "Do the cows trample the grass? Compare six random CO2 readings on the bank with six from the cow "
     "paddock.", "for PointsIn(bank, 6, True): [co2]; for PointsIn(cow paddock, 6, True): [co2]"),
    (PASTURE, HUSKY, "Take six random CO2 readings in the long pasture that are at least 20 metres away from the pond.",
     "for PointsIn(long pasture, 6, True): [co2] | avoid InZone(pond) 20 m"),
    (GLASSHOUSE, AMIGA, "Take five evenly spread moisture readings in the mild bay and tell me how they differ between "
     "the crops.", "for Spread(5, of InZone(mild bay)): [moisture]"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), COMPARED, ids=name)
def test_readings_are_compared(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


QUESTIONS = [
    (PASTURE, AMIGA, "How wet is the soil on the bank? Take three moisture readings there.",
     "for PointsIn(bank, 3): [moisture]"),
    (PASTURE, AMIGA, "How moist is the bank? Take three readings there at 20 cm.",
     "for PointsIn(bank, 3): [moisture(depth_cm 20)]"),
    (PASTURE, AMIGA, "How wet is the soil on the bank? Take a moisture reading there.", "moisture @ PointsIn(bank)"),
    (PASTURE, AMIGA, "How dry is it on the bank?", "moisture @ PointsIn(bank)"),
    (GLASSHOUSE, AMIGA, "How moist is the soil under the melons, ten centimetres down?",
     "for Where(crop, eq, melon): [moisture(depth_cm 10)]"),
    (GLASSHOUSE, HUSKY, "How warm are the leaves of the melons?", "for Where(crop, eq, melon): [picture]"),
    (GLASSHOUSE, AMIGA, "Probe all plants listed below 25 moisture at 15 cm and photograph any that read under "
     "20 percent.",
     "for Where(moisture, lt, 25): [moisture(depth_cm 15) = r1; if r1 < 20 percent: [picture]]"),
    (PASTURE, TRACTOR, "Check the soil moisture at 10 cm in three places in the cow paddock first. Only if the "
     "average is "
     "under 30 percent may you mow it.",
     "for PointsIn(cow paddock, 3): [moisture(depth_cm 10) = r1]; if mean(r1 < 30 percent): [mow area "
     "InZone(cow paddock)]"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), QUESTIONS, ids=name)
def test_questions_are_answered_by_readings(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(
    ("site", "request_", "why"),
    [
        (GLASSHOUSE, "How moist is the soil under the melons, ten centimetres down?", "husky cannot read the "
     "soil moisture"),
        (PASTURE, "How wet is the soil on the bank? Take three moisture readings there.",
         "husky cannot read the soil moisture"),
        (PASTURE, "Take five CO2 readings on the bank and tell me whether the grass is dry.", "tell me whether"),
        (PASTURE, "Compare six CO2 readings on the bank with six from the cow paddock that are at least 20 metres away "
         "from the pond.", "a distance is kept in the whole mission"),
        (PASTURE, "Take five CO2 readings on the bank and compare the bank with the cowslip patch.", "compare"),
    ],
    ids=name,
)  # fmt: skip
def test_what_readings_cannot_answer_is_refused(site: Site, request_: str, why: str) -> None:
    require_refusal(site, HUSKY, request_, why)
