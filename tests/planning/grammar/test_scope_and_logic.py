"""How far "if there is time", "except", "but only", "until" and "those" reach, and what stays as it was beside them."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

#: Only what was added is left out if the budget is short.
ADDED = [
    (PASTURE, TRACTOR, "Mow the bank, and the cow paddock too if the battery allows it.", "mow area InZone(bank); maybe [mow area InZone(cow paddock)]"),
    (PASTURE, TRACTOR, "Mow the bank, the boggy corner and also the cowslip patch if there is time.", "mow area UnionOf(InZone(bank)+InZone(boggy corner)); maybe [mow area InZone(cowslip patch)]"),
    (PASTURE, TRACTOR, "Mow the bank and the boggy corner if there is time.", "maybe [mow area UnionOf(InZone(bank)+InZone(boggy corner))]"),
    (PASTURE, TRACTOR, "Mow the bank too if there is time.", "maybe [mow area InZone(bank)]"),
    (GARDEN, TRACTOR, "Spray beds 3 and 4, and beds 5 and 6 as well, if there is time.", "spray rows UnionOf(Rows(3, 3)+Rows(4, 4)); maybe [spray rows UnionOf(Rows(5, 5)+Rows(6, 6))]"),
    (GARDEN, AMIGA, "Photograph the beans, and the kale too if there's time.", "for Where(crop, eq, bean): [picture]; maybe [for Where(crop, eq, kale): [picture]]"),
    (GARDEN, AMIGA, "Photograph bed 4. If the battery is above 60 percent, photograph bed 5 too.", "for Rows(4, 4): [picture]; if not battery <= 60: [for Rows(5, 5): [picture]]"),
    (GARDEN, AMIGA, "At each plant of bed 4 take a picture and, if the battery is above 60 percent, a leaf.", "for Rows(4, 4): [picture; if not battery <= 60: [sample_leaf]]"),
]  # fmt: skip
#: Laps go on until the battery is low; what ends by itself only keeps as much.
UNTIL = [
    (PASTURE, HUSKY, "Go round the pond until the battery is at 40 percent.", "100 times until battery <= 40: [drive perimeter InZone(pond)]"),
    (PASTURE, HUSKY, "Patrol the boundary as long as the battery is above 50 percent.", "100 times until battery <= 50: [drive perimeter Trees]"),
    (PASTURE, TRACTOR, "Keep mowing the bank until the battery is down to 40 percent.", "mow area InZone(bank) | reserve 40"),
    (PASTURE, HUSKY, "Patrol the boundary, but be back with 40 percent.", "drive perimeter Trees | reserve 40"),
    (PASTURE, TRACTOR, "Mow the bank, you have 40 minutes including getting back.", "mow area InZone(bank) | duration_s 2400"),
]  # fmt: skip
#: Each of several exceptions is left out.
EXCEPTED = [
    (GARDEN, AMIGA, "Photograph everything except the beans and bed 6.", "for Excluding(UnionOf(Where(crop, eq, bean)+Rows(6, 6))): [picture]"),
    (GARDEN, AMIGA, "Everything except the beans and the last two beds gets a picture.", "for Excluding(UnionOf(Where(crop, eq, bean)+Rows(-2, -1))): [picture]"),
    (GARDEN, AMIGA, "Apart from the radishes, the kale and bed 4, everything gets a picture.", "for Excluding(UnionOf(Where(crop, eq, radish)+Where(crop, eq, kale)+Rows(4, 4))): [picture]"),
    (GARDEN, AMIGA, "Except for the radishes and beds 1 and 2, photograph everything.", "for Excluding(UnionOf(Where(crop, eq, radish)+Rows(1, 1)+Rows(2, 2))): [picture]"),
    (GARDEN, AMIGA, "Skip the beans and bed 6. Photograph everything else.", "for Excluding(UnionOf(Where(crop, eq, bean)+Rows(6, 6))): [picture]"),
    (GARDEN, AMIGA, "Photograph all plants but not bed 1 and not the kale.", "for Excluding(Where(crop, eq, kale), of Excluding(Rows(1, 1))): [picture]"),
    (GARDEN, AMIGA, "Photograph every plant except those at the row ends.", "for Excluding(UnionOf(InRow(1, 1, of Rows)+InRow(-1, -1, of Rows))): [picture]"),
    (GARDEN, AMIGA, "Photograph three potatoes, none of them at the end of a row.", "for Take(3, of Excluding(UnionOf(InRow(1, 1, of Rows)+InRow(-1, -1, of Rows)), of Where(crop, eq, potato))): [picture]"),
    (GARDEN, AMIGA, "One picture in each bed, but three in bed 5.", "for Quota(row, 1, of Excluding(Rows(5, 5), of Rows)): [picture]; for Take(3, of Rows(5, 5)): [picture]"),
    (GARDEN, AMIGA, "One picture in each bed, and three in bed 5.", "for Quota(row, 1, of Rows): [picture]; for Take(3, of Rows(5, 5)): [picture]"),
    (GARDEN, AMIGA, "The beans are done already, so just photograph what is left in beds 3 to 6.", "for Excluding(Where(crop, eq, bean), of Rows(3, 6)): [picture]"),
]  # fmt: skip
#: "But only" keeps a part of what was named; "but" and "except" leave it out.
ONLY = [
    (PASTURE, TRACTOR, "Mow the cow paddock, but only the western half.", "mow area Half(west, of InZone(cow paddock))"),
    (PASTURE, TRACTOR, "Mow the cow paddock, western half only, and the boggy corner.", "mow area UnionOf(Half(west, of InZone(cow paddock))+InZone(boggy corner))"),
    (PASTURE, TRACTOR, "Mow the cow paddock but not the bank.", "mow area Excluding(InZone(bank), of InZone(cow paddock))"),
    (GARDEN, AMIGA, "Photograph bed 5, but only the northern half.", "for Half(north, of Rows(5, 5)): [picture]"),
    (GLASSHOUSE, HUSKY, "Photograph bed 2, just the Black King.", "for Where(cultivar, eq, Black King, of Rows(2, 2)): [picture]"),
    (GARDEN, AMIGA, "Photograph the potatoes, but only every other one.", "for EveryNth(2, of Where(crop, eq, potato)): [picture]"),
    (GARDEN, AMIGA, "Photograph all beds, but only the first plant of each.", "for InRow(1, 1, of Rows): [picture]"),
]  # fmt: skip
#: Pronouns stand for what was named last.
THOSE = [
    (GARDEN, AMIGA, "Photograph the squash and take a leaf of those with frost damage.", "for Where(crop, eq, squash): [picture]; for Where(frost_damage, eq, True, of Where(crop, eq, squash)): [sample_leaf]"),
    (GARDEN, AMIGA, "Photograph every squash except the ones with frost damage, and take a leaf of those with frost damage.", "for Excluding(Where(frost_damage, eq, True), of Where(crop, eq, squash)): [picture]; for Where(frost_damage, eq, True, of Where(crop, eq, squash)): [sample_leaf]"),
    (GARDEN, AMIGA, "Take a leaf of those with frost damage.", "for Where(frost_damage, eq, True): [sample_leaf]"),
    (GARDEN, AMIGA, "Photograph the potatoes and take a leaf of every third one.", "for Where(crop, eq, potato): [picture]; for EveryNth(3, of Where(crop, eq, potato)): [sample_leaf]"),
    (GARDEN, AMIGA, "Photograph the potatoes and take a leaf of the three tallest ones.", "for Where(crop, eq, potato): [picture]; for Top(height_cm, 3, of Where(crop, eq, potato)): [sample_leaf]"),
    (GARDEN, AMIGA, "Photograph the potatoes and take a leaf of two random ones.", "for Where(crop, eq, potato): [picture]; for RandomSample(2, of Where(crop, eq, potato)): [sample_leaf]"),
    (GARDEN, AMIGA, "Take a leaf of five potatoes and of as many beans.", "for UnionOf(Take(5, of Where(crop, eq, potato))+Take(5, of Where(crop, eq, bean))): [sample_leaf]"),
    (GLASSHOUSE, HUSKY, "Photograph the melons, and read CO2 at the staked ones.", "for Where(crop, eq, melon): [picture]; for Where(staked, eq, True, of Where(crop, eq, melon)): [co2]"),
    (GARDEN, AMIGA, "Measure moisture at both ends of bed 5, then in the middle.", "for UnionOf(InRow(1, 1, of Rows(5, 5))+InRow(-1, -1, of Rows(5, 5))): [moisture]; moisture @ Middle(of Rows(5, 5))"),
    (GARDEN, AMIGA, "Measure moisture at both ends of bed 5 and photograph the drier one.", "for UnionOf(InRow(1, 1, of Rows(5, 5))+InRow(-1, -1, of Rows(5, 5))): [moisture = r1]; picture @ ByReading(r1, soil_moisture, True)"),
    (GARDEN, AMIGA, "Photograph the kale, then the beans.", "for Where(crop, eq, kale): [picture]; for Where(crop, eq, bean): [picture]"),
    (PASTURE, AMIGA, "Three moisture readings in the long pasture, the same on the bank, and tell me both averages.", "for PointsIn(long pasture, 3): [moisture]; for PointsIn(bank, 3): [moisture]"),
    (GARDEN, HUSKY, "Read the air temperature at the first plant of beds 1 to 3 and CO2 wherever it is over 35.", "for InRow(1, 1, of Rows(1, 3)): [air = r1; if r1 > 35 degC: [co2]]"),
    (GARDEN, HUSKY, "Read the air temperature at the first plant of beds 1 to 4. If at least two are above 35, photograph bed 1.", "for InRow(1, 1, of Rows(1, 4)): [air = r1]; if count(r1 > 35 degC) >= 2: [for Rows(1, 1): [picture]]"),
]  # fmt: skip

#: What the words leave open.
ASKED = [
    (GARDEN, AMIGA, "Photograph the potatoes, but not the ones nearest the street gate.", 3),
    (GARDEN, AMIGA, "Photograph the kale, then bed 3.", 2),
    (GARDEN, AMIGA, "Measure moisture at the tool shed until the battery is down to 60 %.", 0),
    (GARDEN, TRACTOR, "Spray bed 5 at a weaker rate.", 0),
]

REFUSED = [
    (GARDEN, AMIGA, "Photograph the kale. Take a leaf of the ones with frost damage.", "no such ones were named before"),
    (GARDEN, AMIGA, "Photograph everything else.", "it is not clear which others are meant"),
    (GARDEN, AMIGA, "Photograph the potatoes, then the beans, but of those only every other one.", "it is not clear which trees are meant"),
    (GLASSHOUSE, HUSKY, "Photograph the aubergines, the Long Tom first.", "it is not clear in which order"),
    (PASTURE, HUSKY, "Read CO2 at both gates, then again in the opposite order.", "it is not clear in which order"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), [*ADDED, *UNTIL, *EXCEPTED, *ONLY, *THOSE], ids=name)
def test_words_reach_as_far_as_meant(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_what_is_left_open_is_asked(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_what_refers_to_nothing_is_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
