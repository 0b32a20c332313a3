"""Requests about earlier missions: what was done, read and left out before, and when."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

from itertools import product

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Outcome, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.plan import walk
from planning.english.outlines import outline

ROBOTS = {name: load_robot(name) for name in ("husky", "amiga", "tractor")}
DEMO, VINEYARD = open_site("demo"), open_site("vineyard")

#: Requests for the husky on the built-in orchard.
PLANNED = [
    # what was done
    ("skip the ones done yesterday and take a picture of every tree in row 3", "for Excluding(DoneEarlier(calendar yesterday), of Rows(3, 3)): [picture]"),
    ("Take a picture of every tree in row 3. Skip the ones done yesterday.", "for Excluding(DoneEarlier(calendar yesterday), of Rows(3, 3)): [picture]"),
    ("Skip the ones you did yesterday and take pictures of the rest of row 5.", "for Excluding(DoneEarlier(calendar yesterday), of Rows(5, 5)): [picture]"),
    ("Skip those already photographed this week. Take a picture of every yellow tree.", "for Excluding(DoneEarlier(take_thermal_picture, calendar this_week), of Where(leaf_color, eq, yellow)): [picture]"),
    ("take pictures of every tree in row 3 except those already done today", "for Excluding(DoneEarlier(calendar today), of Rows(3, 3)): [picture]"),
    ("take pictures of row 3 except the trees we photographed yesterday", "for Excluding(DoneEarlier(take_thermal_picture, calendar yesterday), of Rows(3, 3)): [picture]"),
    ("take a picture of every tree in row 3, but leave out those pictured yesterday", "for Excluding(DoneEarlier(take_thermal_picture, calendar yesterday), of Rows(3, 3)): [picture]"),
    ("take a picture of every tree in row 3, skip what was done yesterday", "for Excluding(DoneEarlier(calendar yesterday), of Rows(3, 3)): [picture]"),
    ("take a picture of row 3, but only those not pictured this week", "for Excluding(DoneEarlier(take_thermal_picture, calendar this_week), of Rows(3, 3)): [picture]"),
    ("take a picture of those not pictured this month", "for Excluding(DoneEarlier(take_thermal_picture, calendar this_month)): [picture]"),
    ("photograph every tree not visited since Monday", "for Excluding(DoneEarlier(first_day mon)): [picture]"),
    ("Photograph the trees done on Monday.", "for DoneEarlier(calendar mon): [picture]"),
    ("take pictures of the yellow trees that have not been photographed in the last 3 days", "for Excluding(DoneEarlier(take_thermal_picture, days 3), of Where(leaf_color, eq, yellow)): [picture]"),
    ("I want pictures of the trees you have not photographed this month", "for Excluding(DoneEarlier(take_thermal_picture, calendar this_month)): [picture]"),
    ("take a picture of every tree in row 3 that was not visited last week", "for Excluding(DoneEarlier(calendar last_week), of Rows(3, 3)): [picture]"),
    ("take a picture of every tree that is yellow and was not photographed yesterday", "for Excluding(DoneEarlier(take_thermal_picture, calendar yesterday), of Where(leaf_color, eq, yellow)): [picture]"),
    ("take pictures of trees 4, 5 and 6 that were not done yesterday", "for Excluding(DoneEarlier(calendar yesterday), of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6))): [picture]"),
    ("take a picture of the trees sprayed less than a week ago", "for DoneEarlier(spray, days 7): [picture]"),
    ("take a picture of the trees sprayed more than a week ago", "for Excluding(DoneEarlier(spray, days 7), of DoneEarlier(spray)): [picture]"),
    ("take a picture of every tree last visited more than a week ago", "for Excluding(DoneEarlier(days 7), of DoneEarlier): [picture]"),
    ("take a picture of every tree that has not been sprayed for two weeks", "for Excluding(DoneEarlier(spray, days 14)): [picture]"),
    ("take a picture of every tree not visited in over a week", "for Excluding(DoneEarlier(days 7)): [picture]"),
    ("measure CO2 at every tree that has never been measured", "for Excluding(DoneEarlier(co2)): [co2]"),
    ("measure CO2 at all trees not measured since 2026-11-01", "for Excluding(DoneEarlier(co2, first_day 2026-11-01)): [co2]"),
    ("I need CO2 readings from the trees whose CO2 has not been measured since October", "for Excluding(DoneEarlier(co2, first_day --10-01)): [co2]"),
    ("take a picture of every tree photographed between 1 and 15 November", "for DoneEarlier(take_thermal_picture, first_day --11-01 day --11-15): [picture]"),
    ("take a picture of every tree photographed in October", "for DoneEarlier(take_thermal_picture, first_day --10-01 day --10-31): [picture]"),
    ("take a picture of every tree visited twice this month", "for DoneEarlier(2, calendar this_month): [picture]"),
    ("take pictures of trees with no picture yet", "for Excluding(DoneEarlier(take_thermal_picture)): [picture]"),
    ("take pictures of the trees where no picture was taken this month", "for Excluding(DoneEarlier(take_thermal_picture, calendar this_month)): [picture]"),
    ("take a picture where we measured CO2 yesterday", "for DoneEarlier(co2, calendar yesterday): [picture]"),
    ("take a picture of 5 trees not visited this week", "for Take(5, of Excluding(DoneEarlier(calendar this_week))): [picture]"),
    ("take a picture of the tree nearest to the charger that was not visited this week", "picture @ Nearest(Marker(charger), of Excluding(DoneEarlier(calendar this_week)))"),
    ("At the trees not visited yesterday, take a picture and measure CO2.", "for Excluding(DoneEarlier(calendar yesterday)): [picture; co2]"),
    ("For each tree not visited yesterday: measure CO2; if it is above 450 ppm take a picture.", "for Excluding(DoneEarlier(calendar yesterday)): [co2 = r1; if r1 > 450 ppm: [picture]]"),
    ("every morning at 6 am, take a picture of the trees not visited yesterday", "for Excluding(DoneEarlier(calendar yesterday)): [picture] | at=06:00"),
    ("Today, take a picture of the trees not visited yesterday", "for Excluding(DoneEarlier(calendar yesterday)): [picture] | day=today"),
    ("Photograph row 3. The ones done yesterday can be left out.", "for Excluding(DoneEarlier(calendar yesterday), of Rows(3, 3)): [picture]"),
    ("for each tree in row 3 that we did not photograph last week, take a picture", "for Excluding(DoneEarlier(take_thermal_picture, calendar last_week), of Rows(3, 3)): [picture]"),
    ("take a picture of every tree that we visited more than 3 times this month", "for DoneEarlier(4, calendar this_month): [picture]"),
    ("take pictures of trees visited by the robot yesterday", "for DoneEarlier(calendar yesterday): [picture]"),
    ("Skip the ones already done. Photograph row 3 and measure CO2 in row 4.", "for Excluding(DoneEarlier, of Rows(3, 3)): [picture]; for Excluding(DoneEarlier, of Rows(4, 4)): [co2]"),
    ("take a picture of every tree not visited in any earlier mission", "for Excluding(DoneEarlier): [picture]"),
    # what was left out, and what failed
    ("take pictures of the trees we did not get to yesterday", "for DoneEarlier(left_out, calendar yesterday): [picture]"),
    ("take pictures of the trees we missed last time", "for DoneEarlier(left_out, missions 1): [picture]"),
    ("revisit the trees that we missed yesterday", "for DoneEarlier(left_out, calendar yesterday): [go Here]"),
    ("take pictures of the failed trees of yesterday", "for DoneEarlier(failed, calendar yesterday): [picture]"),
    ("take pictures of the trees where the picture failed yesterday", "for DoneEarlier(take_thermal_picture, failed, calendar yesterday): [picture]"),
    ("go back to the trees that failed last time and take a picture of each", "for DoneEarlier(failed, missions 1): [picture]"),
    # what was read
    ("Measure CO2 at tree 4, then take a picture where CO2 was high in an earlier mission", "co2 @ TreeIs(4); for WhereEarlier(co2, gt, 500, ppm): [picture]"),
    ("measure CO2 again where CO2 was high", "for WhereEarlier(co2, gt, 500, ppm): [co2]"),
    ("again measure CO2 where CO2 was high", "for WhereEarlier(co2, gt, 500, ppm): [co2]"),
    ("remeasure CO2 where it was high last week", "for WhereEarlier(co2, gt, 500, ppm, calendar last_week): [co2]"),
    ("measure CO2 where it was above 450 ppm last time", "for WhereEarlier(co2, gt, 450, ppm, missions 1): [co2]"),
    ("take a picture of every tree whose CO2 was between 400 and 450 ppm last week", "for WhereEarlier(co2, le, 450, ppm, calendar last_week, of WhereEarlier(co2, ge, 400, ppm, calendar last_week)): [picture]"),
    ("take a picture of the trees where CO2 was not high last week", "for WhereEarlier(co2, le, 500, ppm, calendar last_week): [picture]"),
    ("take a picture of every tree whose average CO2 last month was above 450 ppm", "for WhereEarlier(co2, gt, 450, ppm, mean, calendar last_month): [picture]"),
    ("take a picture of every tree with CO2 above 450 ppm last week", "for WhereEarlier(co2, gt, 450, ppm, calendar last_week): [picture]"),
    ("take a picture of every tree that was above 30 degC last week", "for WhereEarlier(canopy_temperature, gt, 30, degC, calendar last_week): [picture]"),
    ("take a picture of the trees with high CO2 last week", "for WhereEarlier(co2, gt, 500, ppm, calendar last_week): [picture]"),
    ("take a picture of the 10 hottest trees of last week", "for TopEarlier(canopy_temperature, 10, calendar last_week): [picture]"),
    ("take pictures of last week's 10 hottest trees", "for TopEarlier(canopy_temperature, 10, calendar last_week): [picture]"),
    ("take a picture of the tree that was hottest yesterday", "picture @ TopEarlier(canopy_temperature, calendar yesterday)"),
    ("measure CO2 where it was highest last week", "co2 @ TopEarlier(co2, calendar last_week)"),
    ("measure CO2 at the 3 places where the CO2 was lowest in the last mission", "for TopEarlier(co2, 3, True, missions 1): [co2]"),
    ("take pictures of the 3 trees with the highest CO2 in the last 2 weeks in row 3", "for TopEarlier(co2, 3, days 14, of Rows(3, 3)): [picture]"),
    ("photograph the 5 trees in the northern half that were hottest last month", "for TopEarlier(canopy_temperature, 5, calendar last_month, of Half(north)): [picture]"),
    ("take a picture of the hottest 5 trees of the last 3 missions", "for TopEarlier(canopy_temperature, 5, missions 3): [picture]"),
    ("take a picture of the 5 trees with the highest average CO2 of this month", "for TopEarlier(co2, 5, mean, calendar this_month): [picture]"),
    ("take pictures of all yellow trees except the 5 hottest of last week", "for Excluding(TopEarlier(canopy_temperature, 5, calendar last_week, of Where(leaf_color, eq, yellow)), of Where(leaf_color, eq, yellow)): [picture]"),
]  # fmt: skip

#: Requests for other robots and sites.
ELSEWHERE = [
    ("amiga", "measure again the 5 with the lowest soil moisture of last mission", "for TopEarlier(soil_moisture, 5, True, missions 1): [moisture]"),
    ("amiga", "measure the soil moisture again at the 5 driest trees of last week", "for TopEarlier(soil_moisture, 5, True, calendar last_week): [moisture]"),
    ("amiga", "measure the soil moisture at every tree not measured this week", "for Excluding(DoneEarlier(soil_moisture, calendar this_week)): [moisture]"),
    ("amiga", "take a picture of every tree clipped last week", "for DoneEarlier(sample_leaf, calendar last_week): [picture]"),
    ("tractor", "take a picture of every tree filmed yesterday", "for DoneEarlier(film, calendar yesterday): [picture]"),
    ("tractor", "take a picture of every tree mown this month", "for DoneEarlier(mow, calendar this_month): [picture]"),
]  # fmt: skip

#: Requests about the present, or without a place of earlier missions, whose plans do not depend on these.
PRESENT = [
    ("Measure CO2 at every tree in row 3, then take a picture where CO2 was high", "for Rows(3, 3): [co2 = r1; if r1 high: [picture]]"),
    ("Take a picture of every tree in row 3, then measure CO2 at the 3 hottest", "for Rows(3, 3): [picture = r1]; for ByReading(r1, canopy_temperature, 3): [co2]"),
    ("Measure CO2 at every tree in row 3. Take a picture of those above 450 ppm.", "for Rows(3, 3): [co2 = r1; if r1 > 450 ppm: [picture]]"),
    ("We had a leak last week. Take a picture of tree 4.", "picture @ TreeIs(4)"),
    ("I want the yellow trees photographed today", "for Where(leaf_color, eq, yellow): [picture]"),
    ("Every tree in row 3 should be photographed today", "for Rows(3, 3): [picture]"),
    ("Let CO2 be measured at the yellow trees today", "for Where(leaf_color, eq, yellow): [co2] | day=today"),
]  # fmt: skip

ASKED = [
    "take a picture of the ones that failed",
    "take pictures of the trees we missed",
    "measure CO2 at the 10 hottest trees of last week",
    "go to the trees that were hot yesterday, and measure CO2 there",
    "take a picture of the trees we were not able to visit yesterday",
    "take a picture of the trees where the temperature was above 30 degrees in the last 3 missions",
]

REFUSED = [
    ("take a picture of the hottest trees of last week", "it does not say how many"),
    ("take a picture of the trees we visited", "it does not say when that was"),
    ("take a picture of every tree in row 3 not done last season", "an earlier mission"),
    ("take a picture of the trees visited this morning", "this morning"),
    ("take pictures of every tree in row 3 except those already done this morning", "an earlier mission"),
    ("take a picture of every tree in row 3 that was yellow last week", "last week"),
    ("take a picture of the oldest tree of last week", "last week"),
    ("take a picture of the trees pruned yesterday", "yesterday"),
    ("take a picture of every tree not visited in February", ""),
    ("Measure CO2 at tree 4. If it was high last week, take a picture.", "last week"),
    ("We did row 4 yesterday. Take a picture of every tree in rows 3 to 5.", ""),
    ("Take a picture of the yellow trees. Measure CO2 at the ones already visited.", "this mission or an earlier one"),
    ("Measure CO2 at tree 4, then photograph 3 trees that have not been visited yet", "this mission or an earlier one"),
    ("Photograph row 3. Then photograph the ones that failed.", "this mission or an earlier one"),
    ("take pictures as last time", "an earlier mission"),
    ("Redo the measurements in row 3.", "an earlier mission"),
    ("take a picture of the trees not done recently", "an earlier mission"),
]

#: Periods behind "not visited" with the outline of their period.
PERIODS = [
    ("yesterday", "calendar yesterday"), ("today", "calendar today"), ("this week", "calendar this_week"), ("last week", "calendar last_week"),
    ("this month", "calendar this_month"), ("last month", "calendar last_month"), ("this year", "calendar this_year"), ("last year", "calendar last_year"),
    ("on Tuesday", "calendar tue"), ("last Friday", "calendar fri"), ("last time", "missions 1"), ("in the last mission", "missions 1"),
    ("on the previous run", "missions 1"), ("in the last two missions", "missions 2"), ("in the last hour", "hours 1"), ("in the past 48 hours", "hours 48"),
    ("in the last 3 days", "days 3"), ("in the last week", "days 7"), ("within the last fortnight", "days 14"), ("for two weeks", "days 14"),
    ("in the past month", "months 1"), ("over the last 6 months", "months 6"), ("for a year", "months 12"), ("since Monday", "first_day mon"),
    ("since 3 November", "first_day --11-03"), ("since November 3rd", "first_day --11-03"), ("since the 3rd of November 2026", "first_day 2026-11-03"),
    ("on 2026-11-03", "first_day 2026-11-03 day 2026-11-03"), ("from Monday to Wednesday", "first_day mon day wed"),
    ("from 28 October to 3 November", "first_day --10-28 day --11-03"), ("in October", "first_day --10-01 day --10-31"),
    ("in October 2025", "first_day 2025-10-01 day 2025-10-31"), ("since the beginning of the month", "calendar this_month"),
]  # fmt: skip
CLAUSES = [
    ("not visited", ""), ("that were not visited", ""), ("that have not been photographed", "take_thermal_picture, "),
    ("we did not visit", ""), ("that we haven't measured CO2 at", "co2, "), ("not sprayed", "spray, "),
]  # fmt: skip


def planned(request: str, robot: str = "husky") -> Outcome:
    return EnglishPlanner(suggests=False).plan(request, DEMO, ROBOTS[robot])


def plan_of(request: str, robot: str = "husky") -> str:
    outcome = planned(request, robot)
    assert isinstance(outcome, Planned), outcome
    return outline(outcome.task)


@pytest.mark.parametrize(("request_", "expected"), PLANNED, ids=lambda text: text[:60])
def test_places_are_chosen_by_what_earlier_missions_did_and_read(request_: str, expected: str) -> None:
    assert plan_of(request_) == expected


@pytest.mark.parametrize(("robot", "request_", "expected"), ELSEWHERE)
def test_each_robot_has_words_for_its_own_earlier_work(robot: str, request_: str, expected: str) -> None:
    assert plan_of(request_, robot) == expected


@pytest.mark.parametrize(("request_", "expected"), PRESENT, ids=lambda text: text[:60])
def test_what_is_read_now_is_not_taken_for_an_earlier_reading(request_: str, expected: str) -> None:
    assert plan_of(request_) == expected


@pytest.mark.parametrize("request_", ASKED)
def test_two_ways_to_read_the_past_are_asked(request_: str) -> None:
    outcome = planned(request_)
    assert isinstance(outcome, Clarify), outcome
    assert len(outcome.choices) >= 2


@pytest.mark.parametrize(("request_", "why"), REFUSED)
def test_what_is_not_clear_about_the_past_is_refused(request_: str, why: str) -> None:
    outcome = EnglishPlanner().plan(request_, DEMO, ROBOTS["husky"])
    assert isinstance(outcome, Refused), outcome
    assert why in " | ".join(str(reason.what) for reason in outcome.reasons)


@pytest.mark.parametrize(("clause", "period"), [
    pytest.param(clause, period, id=f"{clause[0]} {period[0]}") for clause, period in product(CLAUSES, PERIODS)
])  # fmt: skip
def test_each_clause_goes_with_each_period(clause: tuple[str, str], period: tuple[str, str]) -> None:
    said = plan_of(f"take a picture of every tree in row 3 {clause[0]} {period[0]}")
    assert said == f"for Excluding(DoneEarlier({clause[1]}{period[1]}), of Rows(3, 3)): [picture]"


@pytest.mark.parametrize("request_", ["take a picture of every tree in row 3", "measure CO2 at tree 4"])
def test_a_plan_without_the_past_uses_no_records(request_: str) -> None:
    outcome = planned(request_)
    assert isinstance(outcome, Planned)
    selectors = [node.selector for node in walk(outcome.task.composition.plan) if node.selector is not None]
    assert not any(part.uses_records for selector in selectors for part in selector.walk())


def test_vines_of_a_block_are_skipped_by_what_was_done() -> None:
    request = "Skip the vines done last week and take pictures of the rest of row 5 in the north block"
    outcome = EnglishPlanner().plan(request, VINEYARD, ROBOTS["husky"])
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).startswith("for Excluding(DoneEarlier(calendar last_week), of Rows(5, 5, of InBlock(")
