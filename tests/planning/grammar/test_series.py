"""Requests on several readings together: statistics, counts, precision, comparisons, and places by readings."""

from __future__ import annotations

from functools import cache

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

AT, PHOTO = "measure CO2 at tree 4.", "photograph tree 4."
CO2 = "Measure CO2 at every tree of row 3. "
HEAT = "Take a thermal picture of every tree of row 3. "
BOTH = "Take a thermal picture of every tree of row 3 and of every tree of row 4. "
ROW, WARM = "for Rows(3, 3): [co2 = r1]; ", "for Rows(3, 3): [picture = r1]; "
ROWS = "for Rows(3, 3): [picture = r1]; for Rows(4, 4): [picture = r2]; "
SHOT, READ = "[picture @ TreeIs(4)]", "[co2 @ TreeIs(4)]"

PLANS = [
    # statistics
    (CO2 + "If the average is above 450 ppm, " + PHOTO, ROW + f"if mean(r1 > 450 ppm): {SHOT}"),
    (CO2 + "If the mean CO2 is below 400 ppm, " + PHOTO, ROW + f"if mean(r1 < 400 ppm): {SHOT}"),
    (CO2 + "If the mean of the readings is below 400 ppm, " + PHOTO, ROW + f"if mean(r1 < 400 ppm): {SHOT}"),
    (CO2 + "If on average it is below 400 ppm, " + PHOTO, ROW + f"if mean(r1 < 400 ppm): {SHOT}"),
    (CO2 + "If they are above 450 ppm on average, " + PHOTO, ROW + f"if mean(r1 > 450 ppm): {SHOT}"),
    (CO2 + "If their average exceeds 450 ppm, " + PHOTO, ROW + f"if mean(r1 > 450 ppm): {SHOT}"),
    (CO2 + "Should the median exceed 450 ppm, " + PHOTO, ROW + f"if median(r1 > 450 ppm): {SHOT}"),
    (CO2 + "If the highest reading is above 500 ppm, " + PHOTO, ROW + f"if maximum(r1 > 500 ppm): {SHOT}"),
    (CO2 + "If the lowest of them is below 380 ppm, " + PHOTO, ROW + f"if minimum(r1 < 380 ppm): {SHOT}"),
    (CO2 + "If the average is high, " + PHOTO, ROW + f"if mean(r1 high): {SHOT}"),
    (
        CO2 + "If the average is between 400 and 450 ppm, " + PHOTO,
        ROW + f"if mean(400 <= r1 <= 450 ppm): {SHOT}",
    ),
    (CO2 + "If the average is not above 450 ppm, " + PHOTO, ROW + f"if not mean(r1 > 450 ppm): {SHOT}"),
    (CO2 + "Photograph tree 4 if the average is above 450 ppm.", ROW + f"if mean(r1 > 450 ppm): {SHOT}"),
    (
        CO2 + "If the average is above 450 ppm, photograph them.",
        ROW + "if mean(r1 > 450 ppm): [for Rows(3, 3): [picture]]",
    ),
    (
        CO2 + "If their average is above 450 ppm, measure it at 5 more trees.",
        ROW + "if mean(r1 > 450 ppm): [for Take(5, of NotVisited): [co2]]",
    ),
    (HEAT + "If the spread exceeds 5 degrees, " + AT, WARM + f"if range(r1 > 5 degC): {READ}"),
    (HEAT + "If the temperature range is over 5 degrees, " + AT, WARM + f"if range(r1 > 5 degC): {READ}"),
    (
        HEAT + "If the difference between the highest and the lowest is more than 5 degrees, " + AT,
        WARM + f"if range(r1 > 5 degC): {READ}",
    ),
    (HEAT + "If the hottest one is above 38 degrees, " + AT, WARM + f"if maximum(r1 > 38 degC): {READ}"),
    (
        "Take 3 CO2 readings at tree 4. If the average is above 450 ppm, photograph it.",
        "co2 x3 @ TreeIs(4) = r1; if mean(r1 > 450 ppm): [picture]",
    ),
    (
        "Take 3 CO2 readings at each tree of row 3. If the average is above 450 ppm, photograph it.",
        "for Rows(3, 3): [3 times: [co2 = r1]; if mean(r1 > 450 ppm): [picture]]",
    ),
    # how many
    (CO2 + "If any of them is above 450 ppm, " + PHOTO, ROW + f"if count(r1 > 450 ppm) >= 1: {SHOT}"),
    (CO2 + "If none of them is above 450 ppm, " + PHOTO, ROW + f"if count(r1 > 450 ppm) = 0: {SHOT}"),
    (CO2 + "If all of them are above 450 ppm, " + PHOTO, ROW + f"if count(r1 > 450 ppm) = 100 %: {SHOT}"),
    (CO2 + "If more than 3 of them are below 400 ppm, " + PHOTO, ROW + f"if count(r1 < 400 ppm) > 3: {SHOT}"),
    (
        CO2 + "If more than 30 % of the readings are below 400 ppm, " + PHOTO,
        ROW + f"if count(r1 < 400 ppm) > 30 %: {SHOT}",
    ),
    (HEAT + "If at least 3 of them are above 38 degrees, " + AT, WARM + f"if count(r1 > 38 degC) >= 3: {READ}"),
    (HEAT + "If fewer than 3 trees are above 38 degrees, " + AT, WARM + f"if count(r1 > 38 degC) < 3: {READ}"),
    (HEAT + "If most of them are hot, " + AT, WARM + f"if count(r1 high) > 50 %: {READ}"),
    (HEAT + "If at most 2 of the trees are above 38 degrees, " + AT, WARM + f"if count(r1 > 38 degC) <= 2: {READ}"),
    # until
    (
        "Measure CO2 at every tree of row 3 until the mean is known to within 5 %, at most 30.",
        "for Rows(3, 3) at most 30 until mean(r1) +- 5 % from 5: [co2 = r1]",
    ),
    (
        "Measure CO2 at all trees of rows 2 to 5 until you know the mean to within 10 ppm, at most 30 trees.",
        "for Rows(2, 5) at most 30 until mean(r1) +- 10 ppm from 5: [co2 = r1]",
    ),
    (
        "Measure CO2 at every tree of row 3 until the error of the mean is below 10 ppm.",
        "for Rows(3, 3) until mean(r1) +- 10 ppm from 5: [co2 = r1]",
    ),
    (
        "Measure CO2 at tree 4 until the mean is known to 5 %, at most 12 readings.",
        "go TreeIs(4); 12 times until mean(r1) +- 5 % from 5: [co2 = r1]",
    ),
    (
        "Measure CO2 at tree 4 until the average is known to within 10 ppm.",
        "go TreeIs(4); 30 times until mean(r1) +- 10 ppm from 5: [co2 = r1]",
    ),
    (
        "Measure CO2 at every tree until you have found three above 450 ppm.",
        "for Trees until count(r1 > 450 ppm) >= 3: [co2 = r1]",
    ),
    (
        "Measure CO2 at every tree of row 3 until three of them are above 450 ppm.",
        "for Rows(3, 3) until count(r1 > 450 ppm) >= 3: [co2 = r1]",
    ),
    (
        "Measure CO2 at every tree of row 3 until the average is above 450 ppm.",
        "for Rows(3, 3) until mean(r1 > 450 ppm): [co2 = r1]",
    ),
    # comparisons
    (BOTH + "If the mean of row 3 is higher than that of row 4, " + AT, ROWS + f"if mean(r1) > mean(r2): {READ}"),
    (BOTH + "If row 3 is hotter than row 4 on average, " + AT, ROWS + f"if mean(r1) > mean(r2): {READ}"),
    (
        BOTH + "If the average of row 3 is at least 2 degrees higher than the average of row 4, " + AT,
        ROWS + f"if mean(r1) >= mean(r2) + 2 degC: {READ}",
    ),
    (
        "Take a thermal picture at tree 4 and at tree 9. If tree 4 is hotter than tree 9, " + AT,
        f"picture @ TreeIs(4) = r1; picture @ TreeIs(9) = r2; if mean(r1) > mean(r2): {READ}",
    ),
    # places
    (HEAT + "Then measure CO2 at the hottest one.", WARM + "co2 @ ByReading(r1, canopy_temperature)"),
    (HEAT + "Then measure CO2 at the hottest of them.", WARM + "co2 @ ByReading(r1, canopy_temperature)"),
    (HEAT + "Measure CO2 at the 3 hottest ones.", WARM + "for ByReading(r1, canopy_temperature, 3): [co2]"),
    (HEAT + "Measure CO2 at the hottest three of them.", WARM + "for ByReading(r1, canopy_temperature, 3): [co2]"),
    (HEAT + "Measure CO2 at the two coldest trees.", WARM + "for ByReading(r1, canopy_temperature, 2, True): [co2]"),
    (HEAT + "Measure CO2 at the tree with the highest temperature.", WARM + "co2 @ ByReading(r1, canopy_temperature)"),
    (HEAT + "Measure CO2 at the hottest tree of row 3.", WARM + "co2 @ ByReading(r1, canopy_temperature)"),
    (HEAT + "Go back to where it was hottest and measure CO2.", WARM + "go ByReading(r1, canopy_temperature); co2"),
    (CO2 + "Go back to where CO2 was highest and take a thermal picture.", ROW + "go ByReading(r1, co2); picture"),
    (
        CO2 + "Return to the place with the highest CO2 and take a picture there.",
        ROW + "go ByReading(r1, co2); picture",
    ),
    (
        "Take a thermal picture at tree 4 and at tree 9, then measure CO2 at the hotter of the two.",
        "picture @ TreeIs(4) = r1; picture @ TreeIs(9) = r1; co2 @ ByReading(r1, canopy_temperature)",
    ),
    # readings named one by one are tested one by one, as before
    (
        "Measure CO2 at trees 4 and 9. If both are above 450 ppm, " + PHOTO,
        f"co2 @ TreeIs(4) = r1; co2 @ TreeIs(9) = r2; if r1 > 450 ppm and r2 > 450 ppm: {SHOT}",
    ),
]

NOT_PLANNED = [
    ("Photograph the hottest tree.", "not measured before"),
    ("Take a thermal picture of the hottest tree of row 3.", "not measured before"),
    ("Measure CO2 at tree 4. If the average is above 450 ppm, photograph it.", "only one reading"),
    ("If the average is above 450 ppm, " + PHOTO, "nothing before it measures that"),
    (CO2 + "If the average is above 36 degrees, " + PHOTO, "nothing before it measures that"),
    (CO2 + "If the average is above 450 ppm, take a thermal picture.", "at which of them"),
    ("Take 3 CO2 readings at each tree of row 3. If the average is above 450 ppm, " + PHOTO, "at each place"),
    ("In each row, measure CO2 at 2 trees. If the average is above 450 ppm, " + PHOTO, "of each row"),
    (CO2 + "If the standard deviation is above 20 ppm, " + PHOTO, "does not compute"),
    ("Compare tree 4 with tree 9.", "not taken before"),
]


@cache
def answer(request: str, robot: str = "husky") -> Planned | Clarify | Refused:
    return EnglishPlanner().plan(request, open_site("demo"), load_robot(robot))


@pytest.mark.parametrize(("request_", "plan"), PLANS)
def test_requests_are_planned_as_meant(request_: str, plan: str) -> None:
    made = answer(request_)
    assert isinstance(made, Planned), made
    assert outline(made.task).partition(" | ")[0] == plan


@pytest.mark.parametrize(("request_", "why"), NOT_PLANNED)
def test_other_requests_are_asked_about_or_refused(request_: str, why: str) -> None:
    made = answer(request_)
    text = made.question if isinstance(made, Clarify) else " ".join(str(one.what) for one in made.reasons)
    assert why in text, text


def test_percent_of_a_quantity_in_percent_is_asked_about() -> None:
    made = answer("Measure soil moisture at every tree of row 3 until the mean is known to within 2 %.", "amiga")
    assert isinstance(made, Clarify | Refused)


def test_the_driest_are_those_of_soil_moisture() -> None:
    made = answer("Measure soil moisture at every tree of row 3, then sample a leaf at the 3 driest ones.", "amiga")
    assert isinstance(made, Planned)
    assert (
        outline(made.task)
        == "for Rows(3, 3): [moisture = r1]; for ByReading(r1, soil_moisture, 3, True): [sample_leaf]"
    )
