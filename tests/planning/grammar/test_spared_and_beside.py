"""What mowing leaves standing, places beside what cannot be entered, both sides of rows, and where missions end."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.robot.loader import load_robot
from fieldhand.site.model import Site
from planning.grammar.field_requests import require_plan, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

PASTURE, HUSKY, AMIGA, TRACTOR = pasture(), load_robot("husky"), load_robot("amiga"), load_robot("tractor")

GLASSHOUSE, GARDEN = glasshouse(), vegetable_garden()

_PADDOCK = "mow area InZone(cow paddock)"
_LONG = "mow area Excluding(UnionOf(InZone(boggy corner)+InZone(cowslip patch)), of InZone(long pasture))"

MOWED = [
    (
        "Mow the cow paddock but leave four metres of grass standing around the pond.",
        f"{_PADDOCK} | avoid InZone(pond) 4 m",
    ),
    ("Mow the cow paddock, leaving 2 m of grass around the pond.", f"{_PADDOCK} | avoid InZone(pond) 2 m"),
    ("Mow the cow paddock but leave 3 metres around the pond.", f"{_PADDOCK} | avoid InZone(pond) 3 m"),
    ("Mow the cow paddock but leave three metres standing around the pond.", f"{_PADDOCK} | avoid InZone(pond) 3 m"),
    (
        "Mow the cow paddock but leave a strip of three metres around the pond unmown.",
        f"{_PADDOCK} | avoid InZone(pond) 3 m",
    ),
    ("Mow the cow paddock. Leave a ring of 3 m uncut around the pond.", f"{_PADDOCK} | avoid InZone(pond) 3 m"),
    (
        "Mow the cow paddock and leave a 3 m strip of grass uncut around the pond.",
        f"{_PADDOCK} | avoid InZone(pond) 3 m",
    ),
    ("Leave three metres uncut around the pond and mow the cow paddock.", f"{_PADDOCK} | avoid InZone(pond) 3 m"),
    (
        "Mow the common but leave 5 m of grass standing around the pond and the cowslip patch.",
        "mow area Trees | avoid InZone(pond) 5 m | avoid InZone(cowslip patch) 5 m",
    ),
    (
        "Mow the cow paddock but leave four metres of grass around the pond and around the bank.",
        f"{_PADDOCK} | avoid InZone(pond) 4 m | avoid InZone(bank) 4 m",
    ),
    ("Mow everything in the long pasture apart from the boggy corner and the cowslip patch.", _LONG),
    ("Mow everything in the long pasture, except the boggy corner and the cowslip patch.", _LONG),
    ("Mow everything in the long pasture but not the boggy corner or the cowslip patch.", _LONG),
    ("Mow everything in the long pasture. Leave out the boggy corner and the cowslip patch.", _LONG),
    ("Mow everything on the bank.", "mow area InZone(bank)"),
    ("Mow everything within the cow paddock.", _PADDOCK),
    ("Mow everything in the cow paddock except the bank.", "mow area Excluding(InZone(bank), of InZone(cow paddock))"),
    ("Mow all that is in the boggy corner.", "mow area InZone(boggy corner)"),
]

BESIDE = [
    ("Measure the air temperature beside the pond.", "air @ Transect(1, edge, pond)"),
    ("Measure the air temperature next to the pond.", "air @ Transect(1, edge, pond)"),
    ("Take a CO2 reading by the pond.", "co2 @ Transect(1, edge, pond)"),
    (
        "Measure the air temperature beside the pond, on the bank and in the boggy corner.",
        "air @ Transect(1, edge, pond); air @ PointsIn(bank); air @ PointsIn(boggy corner)",
    ),
    (
        "Measure the air temperature at the bank, at the cowslip patch and beside the pond.",
        "for UnionOf(PointsIn(bank)+PointsIn(cowslip patch)+Transect(1, edge, pond)): [air]",
    ),
    (
        "Measure the air temperature beside the pond and at the bank.",
        "air @ Transect(1, edge, pond); air @ PointsIn(bank)",
    ),
    ("Take a CO2 reading next to the pond and at the bank.", "co2 @ Transect(1, edge, pond); co2 @ PointsIn(bank)"),
    (
        "Take a CO2 reading at the pond and at the middle gate.",
        "co2 @ Transect(1, edge, pond); co2 @ GateIs(middle gate)",
    ),
]


WORKED = [
    (GLASSHOUSE, "Film both beds in the mild bay, each along both sides.", "film rows InZone(mild bay, of Rows), both"),
    (GLASSHOUSE, "Film the two rows in the mild bay.", "film rows InZone(mild bay, of Rows)"),
    (GLASSHOUSE, "Film all two rows of the hot bay from both sides.", "film rows InZone(hot bay, of Rows), both"),
    (GLASSHOUSE, "Film rows 3 to 4 along both sides.", "film rows Rows(3, 4), both"),
    (GLASSHOUSE, "Film rows 3 to 4, each of them from both sides.", "film rows Rows(3, 4), both"),
    (GARDEN, "Spray the kale along both sides.", "spray rows Where(crop, eq, kale), both"),
    (GARDEN, "Spray beds 3 and 4, each from both sides.", "spray rows UnionOf(Rows(3, 3)+Rows(4, 4)), both"),
    (GARDEN, "Spray beds 3 and 4, each one on both sides.", "spray rows UnionOf(Rows(3, 3)+Rows(4, 4)), both"),
    (GARDEN, "Spray bed 3, then leave through the river gate.", "spray rows Rows(3, 3); go GateIs(river gate)"),
    (GARDEN, "Film bed 3, then exit by the river gate.", "film rows Rows(3, 3); go GateIs(river gate)"),
    (
        GARDEN,
        "Film bed 3, then leave by the river gate and go to the manure heap.",
        "film rows Rows(3, 3); go GateIs(river gate); go PointsIn(manure heap)",
    ),
    (GARDEN, "Film bed 3. Leave by the river gate.", "film rows Rows(3, 3) | only river gate"),
]


@pytest.mark.parametrize(("site", "request_", "plan"), WORKED)
def test_rows_are_worked_along_both_sides_and_left_by_a_gate(site: Site, request_: str, plan: str) -> None:
    require_plan(site, TRACTOR, request_, plan)


def test_so_many_rows_are_those_that_are_there() -> None:
    require_refusal(GLASSHOUSE, TRACTOR, "Film the three rows in the mild bay.", "")


_EACH_BUT = "for Quota(row, 2, random, of Excluding(Rows(6, 6), of Rows)): [picture]"

CHOSEN = [
    (GARDEN, "Choose two plants at random in each bed and photograph them, but leave out the kale.", _EACH_BUT),
    (GARDEN, "Choose two plants at random in each bed and photograph them, but not the kale.", _EACH_BUT),
    (GARDEN, "Choose two plants at random in each bed and photograph them. Leave out the kale.", _EACH_BUT),
    (GARDEN, "Leave out the kale. Choose two plants at random in each bed and photograph them.", _EACH_BUT),
    (
        GARDEN,
        "Go to two plants in each bed and photograph them, but leave out bed 3.",
        "for Quota(row, 2, of Excluding(Rows(3, 3), of Rows)): [picture]",
    ),
    (
        GARDEN,
        "Choose two plants in each bed, photograph them, and skip the potatoes.",
        "for Quota(row, 2, of Excluding(UnionOf(Rows(1, 1)+Rows(2, 2)), of Rows)): [picture]",
    ),
    (
        GARDEN,
        "Pick two plants in every bed and photograph them, but leave out the kale and the beans.",
        "for Quota(row, 2, of Excluding(UnionOf(Rows(4, 4)+Rows(6, 6)), of Rows)): [picture]",
    ),
    (
        GARDEN,
        "Choose two plants at random in each bed and photograph them, but leave out the netted ones.",
        "for Quota(row, 2, random, of Excluding(UnionOf(Rows(3, 3)+Rows(4, 4)), of Rows)): [picture]",
    ),
    (
        GLASSHOUSE,
        "Photograph two plants of each aubergine cultivar.",
        "for Quota(cultivar, 2, of Where(crop, eq, aubergine)): [picture]",
    ),
    (
        GLASSHOUSE,
        "Take a thermal picture of three random plants from each aubergine cultivar.",
        "for Quota(cultivar, 3, random, of Where(crop, eq, aubergine)): [picture]",
    ),
    (GARDEN, "Take a picture of bed 3's first plant for the student.", "picture @ InRow(1, 1, of Rows(3, 3))"),
    (PASTURE, "Take five CO2 readings on the bank for our trainees.", "for PointsIn(bank, 5): [co2]"),
]


@pytest.mark.parametrize(("site", "request_", "plan"), CHOSEN)
def test_plants_chosen_of_each_group_but_those_left_out(site: Site, request_: str, plan: str) -> None:
    require_plan(site, HUSKY, request_, plan)


@pytest.mark.parametrize(("request_", "plan"), MOWED)
def test_mowing_spares_what_is_left_standing(request_: str, plan: str) -> None:
    require_plan(PASTURE, TRACTOR, request_, plan)


@pytest.mark.parametrize(("request_", "plan"), BESIDE)
def test_readings_beside_what_cannot_be_entered_are_taken_at_its_edge(request_: str, plan: str) -> None:
    require_plan(PASTURE, HUSKY, request_, plan)


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        ("Read the air temperature in the pond.", "keep-out zone"),
        ("Read the air temperature on the bank and in the pond.", "keep-out zone"),
    ],
)
def test_no_reading_is_taken_inside_of_it(request_: str, why: str) -> None:
    require_refusal(PASTURE, HUSKY, request_, why)


@pytest.mark.parametrize(
    "request_",
    [
        "Mow the cow paddock but leave a strip standing around the pond.",
        "Mow the cow paddock but leave four litres of grass standing around the pond.",
    ],
)
def test_a_strip_without_a_width_is_not_guessed(request_: str) -> None:
    require_refusal(PASTURE, TRACTOR, request_, "")


@pytest.mark.parametrize(
    ("request_", "end"),
    [
        ("If it is below 35 percent, mow it, otherwise return to the farm gate.", "stay"),
        ("If it is below 35 percent, mow the bank, otherwise go back to the middle gate.", "stay"),
        ("If it is above 35 percent, return to the middle gate, otherwise mow the bank.", "stay"),
        ("If it is above 35 percent, go back to the farm gate.", "stay"),
        ("If it is above 35 percent, return to the farm gate. Then mow the bank.", "return_to_start"),
        ("If it is below 35 percent, mow the bank, otherwise go home.", "return_to_start"),
        ("If it is below 35 percent, mow the bank.", "return_to_start"),
    ],
)
def test_a_robot_sent_back_to_a_place_in_one_case_stays_there(request_: str, end: str) -> None:
    outcome = EnglishPlanner().plan(f"Read the soil moisture at the bank. {request_}", PASTURE, TRACTOR)
    assert outcome.task.composition.nominal == end
