"""What later clauses refer to, repeat, correct and reorder, and which reading a condition tests."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

DEMO = open_site("demo")


def plan_of(request: str) -> str | None:
    """Return the plan of a request to husky, or to amiga behind "amiga>"."""
    robot, _, said = request.rpartition("a> ")
    found = composed(said, DEMO, load_robot("amiga" if robot else "husky"))
    return outline(found.task) if isinstance(found, Planned) else None


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Take a picture of tree 47, then of its two nearest neighbours.", "picture @ TreeIs(47); for Nearest(Here, 2): [picture]"),
        ("Measure CO2 at tree 47 and at its nearest neighbour in the same row.", "co2 @ TreeIs(47); co2 @ Nearest(Here, of RowOf)"),
        ("Photograph tree 47. If it is above 38, also photograph the trees on either side of it in the row.", "picture @ TreeIs(47) = r1; if r1 > 38 degC: [for UnionOf(AlongRow(1)+AlongRow(1, up)): [picture]]"),
        ("Photograph tree 47. If it is above 38, photograph the tree on each side of it.", "picture @ TreeIs(47) = r1; if r1 > 38 degC: [for UnionOf(AlongRow(1)+AlongRow(1, up)): [picture]]"),
        ("Photograph tree 47 and the trees either side.", "for UnionOf(TreeIs(47)+AlongRow(1, TreeIs(47))+AlongRow(1, up, TreeIs(47))): [picture]"),
        ("Take a picture of tree 47, and then one of the tree on each side of it.", "picture @ TreeIs(47); for UnionOf(AlongRow(1)+AlongRow(1, up)): [picture]"),
        ("Go to tree 47 and read CO2. If it is high, do the same at the trees on either side of it.", "go TreeIs(47); co2 = r1; if r1 high: [for UnionOf(AlongRow(1)+AlongRow(1, up)): [co2]]"),
        ("Photograph tree 60. If it is above 36 °C, also check its two nearest neighbours; if not, go home.", "picture @ TreeIs(60) = r1; if r1 > 36 degC: [for Nearest(Here, 2): [picture]] else [go Marker(start)] | return_to_start"),
        ("Begin at the pond: photograph each of the five trees closest to it.", "for Nearest(InZone(pond), 5): [picture]"),
        ("Go to the pond, then photograph the four trees nearest it.", "for Nearest(InZone(pond), 4): [picture]"),
        ("Photograph trees 1, 19 and 152. CO2 at the last of these.", "for UnionOf(TreeIs(1)+TreeIs(19)+TreeIs(152)): [picture]; co2 @ TreeIs(152)"),
        ("Photograph trees 1, 19 and 152. Measure CO2 at the first of the three.", "for UnionOf(TreeIs(1)+TreeIs(19)+TreeIs(152)): [picture]; co2 @ TreeIs(1)"),
        ("Photograph trees 1, 19 and 152, and CO2 just at the second of them.", "for UnionOf(TreeIs(1)+TreeIs(19)+TreeIs(152)): [picture]; co2 @ TreeIs(19)"),
        ("Photograph the four trees nearest the pond, then the air temperature just at the last of the four.", "for Nearest(InZone(pond), 4): [picture]; air @ Here"),
        ("CO2 at the tree nearest the pond and at tree 9. Photograph the pond one.", "co2 @ Nearest(InZone(pond)); co2 @ TreeIs(9); picture @ Nearest(InZone(pond))"),
        ("Photograph tree 47, then go 3 trees further down the row and take a second one.", "picture @ TreeIs(47); go AlongRow(3); picture"),
        ("Measure CO2 at tree 20 and then a second one at tree 30.", "co2 @ TreeIs(20); co2 @ TreeIs(30)"),
        ("Take a picture of tree 40, and then of the tree that is as far away from it as possible in the same row.", "picture @ TreeIs(40); picture @ Farthest(Here, of RowOf)"),
        ("Temperature and CO2 at tree 4, then both again at tree 9.", "air @ TreeIs(4); co2; air @ TreeIs(9); co2"),
        ("CO2 and temp at tree 4, then the same two at tree 9.", "co2 @ TreeIs(4); air; co2 @ TreeIs(9); air"),
        ("Row 6. A picture of each tree.", "for Rows(6, 6): [picture]"),
        ("Photograph 3 yellow trees and read co2 at the last of them.", "for Take(3, of Where(leaf_color, eq, yellow)): [picture]; co2 @ Here"),
        ("go to tree 30, photograph it and the two trees on either side", "go TreeIs(30); picture; for UnionOf(AlongRow(1)+AlongRow(1, up)): [picture]"),
    ],
)  # fmt: skip
def test_what_is_spoken_of_before_is_found(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("amiga> Soil moisture at 15 cm and again at 45 cm at tree 4.", "moisture(depth_cm 15) @ TreeIs(4); moisture(depth_cm 45)"),
        ("amiga> Measure soil moisture at 20 cm and then at 40 cm at trees 4 and 5.", "for UnionOf(TreeIs(4)+TreeIs(5)): [moisture(depth_cm 20); moisture(depth_cm 40)]"),
        ("amiga> Measure moisture at tree 4, first at 10 cm, then at 30 cm.", "moisture(depth_cm 10) @ TreeIs(4); moisture(depth_cm 30)"),
        ("amiga> Soil moisture at tree 4 at 20 cm, then 40, then 60.", "moisture(depth_cm 20) @ TreeIs(4); moisture(depth_cm 40); moisture(depth_cm 60)"),
        ("amiga> Moisture at tree 4: 20 cm, 40 cm and 60 cm.", "moisture(depth_cm 20) @ TreeIs(4); moisture(depth_cm 40); moisture(depth_cm 60)"),
        ("amiga> Measure moisture at tree 4 at 20 cm. Then again at 40 cm.", "moisture(depth_cm 20) @ TreeIs(4); moisture(depth_cm 40)"),
        ("amiga> Measure moisture at tree 4 at 20 cm and once more at 40 cm.", "moisture(depth_cm 20) @ TreeIs(4); moisture(depth_cm 40)"),
        ("amiga> Nitrate at 20 cm at tree 4, then at 50 cm too.", "nitrate(depth_cm 20) @ TreeIs(4); nitrate(depth_cm 50)"),
        ("amiga> 20 cm, then 40, then 60: moisture at trees 7, 77 and 147.", "for UnionOf(TreeIs(7)+TreeIs(77)+TreeIs(147)): [moisture(depth_cm 20); moisture(depth_cm 40); moisture(depth_cm 60)]"),
        ("amiga> Moisture at 15 cm at tree 4. If it is below 20 percent, again at 45 cm.", "moisture(depth_cm 15) @ TreeIs(4) = r1; if r1 < 20 percent: [moisture(depth_cm 45)]"),
    ],
)  # fmt: skip
def test_the_same_is_done_with_other_values(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Measure CO2 at tree 5 and then at tree 165, and do that whole round three times.", "3 times: [co2 @ TreeIs(5); co2 @ TreeIs(165)]"),
        ("Measure CO2 at tree 5, then tree 165. Repeat the round twice more.", "co2 @ TreeIs(5); co2 @ TreeIs(165); 2 times: [co2 @ TreeIs(5); co2 @ TreeIs(165)]"),
        ("Three times over: CO2 at tree 5, CO2 at tree 165.", "3 times: [co2 @ TreeIs(5); co2 @ TreeIs(165)]"),
        ("CO2 at tree 5, then at tree 165. Then once more both.", "co2 @ TreeIs(5); co2 @ TreeIs(165); co2 @ TreeIs(5); co2 @ TreeIs(165)"),
        ("CO2 at tree 5, CO2 at tree 165. Then both once more in the same order.", "co2 @ TreeIs(5); co2 @ TreeIs(165); co2 @ TreeIs(5); co2 @ TreeIs(165)"),
        ("Tree 30: CO2. Tree 31: same. Tree 32: ditto.", "co2 @ TreeIs(30); go TreeIs(31); co2; go TreeIs(32); co2"),
        ("tree 30 co2. tree 31 same. tree 32 same but only if 31 came out high. home.", "co2 @ TreeIs(30); go TreeIs(31); co2 = r1; if r1 high: [go TreeIs(32); co2] | return_to_start"),
        ("Photograph tree 20. Go 5 trees down the row and take a picture. Repeat that twice more.", "picture @ TreeIs(20); go AlongRow(5); picture; 2 times: [go AlongRow(5); picture]"),
        ("Photograph tree 20. Go two rows further east and take another. Do that twice more.", "picture @ TreeIs(20); go Take(1, of RowOf(2)); picture; 2 times: [go Take(1, of RowOf(2)); picture]"),
    ],
)  # fmt: skip
def test_what_was_done_is_repeated(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("CO2 at tree 60. Over 500 ppm -> thermal pic same tree. Done.", "co2 @ TreeIs(60) = r1; if r1 > 500 ppm: [picture]"),
        ("CO2 at tree 60. Were it to turn out above 500, photograph it.", "co2 @ TreeIs(60) = r1; if r1 > 500 ppm: [picture]"),
        ("Photograph tree 60. Had it come out above 38, CO2 there as well.", "picture @ TreeIs(60) = r1; if r1 > 38 degC: [co2]"),
        ("CO2 at tree 60. Is it elevated, I want to say above 450 ppm, photograph it.", "co2 @ TreeIs(60) = r1; if r1 > 450 ppm: [picture]"),
        ("Measure air temp at tree 90. Is more than 35 degrees, photograph it. Is not, then nothing.", "air @ TreeIs(90) = r1; if r1 > 35 degC: [picture]"),
        ("CO2 at tree 60. If it is above 500, measure CO2 at its 5 nearest trees; else if it is less than 400, photograph tree 60; else do nothing further.", "co2 @ TreeIs(60) = r1; if r1 > 500 ppm: [for Nearest(Here, 5): [co2]] else [if r1 < 400 ppm: [picture @ TreeIs(60)]]"),
        ("CO2 at tree 60. If it's above 500, photograph it. Otherwise skip that.", "co2 @ TreeIs(60) = r1; if r1 > 500 ppm: [picture]"),
        ("Air temp at tree 60. Unless it's above 35 come straight home; if it is above, photograph the three trees nearest to it.", "air @ TreeIs(60) = r1; if not r1 > 35 degC: [go Marker(start)] else [for Nearest(Here, 3): [picture]] | return_to_start"),
        ("Air temp at tree 60. Unless it's above 35, go home; if it is, photograph tree 9.", "air @ TreeIs(60) = r1; if not r1 > 35 degC: [go Marker(start)] else [picture @ TreeIs(9)] | return_to_start"),
        ("Photograph tree 4. If the canopy is low, take the air temperature. If it's high, CO2.", "picture @ TreeIs(4) = r1; if r1 low: [air]; if r1 high: [co2]"),
        ("Photograph tree 4. If it's below 33, take the air temperature. If it's above 38, measure CO2.", "picture @ TreeIs(4) = r1; if r1 < 33 degC: [air]; if r1 > 38 degC: [co2]"),
        ("CO2 at tree 30 and at tree 31. Photograph tree 32, but only if 31 was high.", "co2 @ TreeIs(30); co2 @ TreeIs(31) = r1; if r1 high: [picture @ TreeIs(32)]"),
        ("Measure CO2 at trees 30 and 31. Photograph tree 32, but only if 31 was high.", "co2 @ TreeIs(30); co2 @ TreeIs(31) = r1; if r1 high: [picture @ TreeIs(32)]"),
        ("Measure CO2 at trees 30 and 31, then the air temperature at tree 32. If tree 30 was high, photograph it.", "co2 @ TreeIs(30) = r1; co2 @ TreeIs(31); air @ TreeIs(32); if r1 high: [go TreeIs(30); picture]"),
        ("CO2 at tree 30 and tree 31. If it was above 450 at tree 30, photograph tree 32.", "co2 @ TreeIs(30) = r1; co2 @ TreeIs(31); if r1 > 450 ppm: [picture @ TreeIs(32)]"),
        ("CO2 at trees 30 to 33. If tree 31 was high, photograph it.", "co2 @ TreeIs(30); co2 @ TreeIs(31) = r1; co2 @ TreeIs(32); co2 @ TreeIs(33); if r1 high: [go TreeIs(31); picture]"),
        ("CO2 at trees 30 to 33. If tree 33 was high, photograph it.", "co2 @ TreeIs(30); co2 @ TreeIs(31); co2 @ TreeIs(32); co2 @ TreeIs(33) = r1; if r1 high: [picture]"),
        ("amiga> Soil moisture at each tree in the wet corner. Where it is over 35 percent, photograph the ground there.", "for InZone(wet corner): [moisture = r1; if r1 > 35 percent: [picture(view ground)]]"),
        ("Photograph every tree in row 3. As soon as one is above 38, end the survey and come back.", "for Rows(3, 3) until r1 > 38 degC: [picture = r1] | return_to_start"),
        ("Photograph every tree in row 3. End the survey as soon as one comes out above 38.", "for Rows(3, 3) until r1 > 38 degC: [picture = r1]"),
        ("Measure CO2 along row 3, every tree, the whole survey to be terminated at the first value above 450.", "for Rows(3, 3) until r1 > 450 ppm: [co2 = r1]"),
        ("Go along row 6 making thermal pictures until you come across a tree with a canopy temperature over 40 degrees. Take CO2 at that one and go home.", "for Rows(6, 6) until r1 > 40 degC: [picture = r1; if r1 > 40 degC: [co2]] | return_to_start"),
        ("Take a picture of tree 50. If you can't get to it, take one of tree 51 instead.", "try [picture @ TreeIs(50)] or [picture @ TreeIs(51)]"),
        ("Photograph tree 50. If the picture does not succeed, measure CO2.", "try [picture @ TreeIs(50)] or [co2]"),
        ("amiga> Leaf samples at trees 50, 60 and 70. If the leaf sample does not succeed at one tree, take instead a picture of its canopy.", "for UnionOf(TreeIs(50)+TreeIs(60)+TreeIs(70)): [try [sample_leaf] or [picture(view canopy)]]"),
        ("Measure CO2 at the five trees nearest the pond. Anything at 500 ppm or more gets a picture as well; anything below, an air temperature instead. Then a picture of tree 4.", "for Nearest(InZone(pond), 5): [co2 = r1; if r1 >= 500 ppm: [picture] else [air]]; picture @ TreeIs(4)"),
        ("Measure CO2 at trees 5 to 9; a second reading, same tree, whenever the first falls under 400 ppm.", "for UnionOf(TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)+TreeIs(9)): [co2 = r1; if r1 < 400 ppm: [co2]]"),
        ("Measure CO2 at tree 9, and take a second reading if the first is below 400.", "co2 @ TreeIs(9) = r1; if r1 < 400 ppm: [co2]"),
        ("Photograph every 5th tree in row 6. If one's over 38 C photograph the tree right next to it too.", "for EveryNth(5, of Rows(6, 6)): [picture = r1; if r1 > 38 degC: [picture @ Nearest(Here, True)]]"),
    ],
)  # fmt: skip
def test_conditions_test_the_reading_that_was_taken(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Tree 19 - no, make that tree 1 - temp, then pic, then home.", "go TreeIs(1); air; picture | return_to_start"),
        ("Pics of trees 40, 41, scratch 41, make it 42.", "for UnionOf(TreeIs(40)+TreeIs(42)): [picture]"),
        ("Photograph trees 40 and 41 - scratch tree 41, make it tree 42.", "for UnionOf(TreeIs(40)+TreeIs(42)): [picture]"),
        ("Row 4, please. Oh, so sorry, I meant row 6! A picture of each tree.", "for Rows(6, 6): [picture]"),
    ],
)  # fmt: skip
def test_what_is_corrected_is_replaced(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Photograph tree 4, then tree 9. Actually, swap them.", "picture @ TreeIs(9); picture @ TreeIs(4)"),
        ("Photograph tree 4, then measure CO2 at tree 9. No, the other way round.", "co2 @ TreeIs(9); picture @ TreeIs(4)"),
        ("Farthest tree from the start, thermal image; then the tree nearest the pond, thermal image. Actually, swap them: the pond one first.", "picture @ Nearest(InZone(pond)); picture @ Farthest(Marker(start))"),
        ("Photograph tree 4 and measure CO2 at tree 9, tree 9 first.", "co2 @ TreeIs(9); picture @ TreeIs(4)"),
        ("Photograph trees 4, 9 and 12, tree 9 first.", "for UnionOf(TreeIs(9)+TreeIs(4)+TreeIs(12)) given: [picture]"),
        ("Photograph tree 4 and tree 9, the latter first.", "for UnionOf(TreeIs(9)+TreeIs(4)) given: [picture]"),
        ("Only after row 2 has been done with the thermal camera should the air temperature be taken at tree 74; before all of that, CO2 at tree 169.", "co2 @ TreeIs(169); for Rows(2, 2): [picture]; air @ TreeIs(74)"),
        ("Measure CO2 at tree 9, but only after tree 4 has been photographed.", "picture @ TreeIs(4); co2 @ TreeIs(9)"),
        ("Photograph tree 4 and then tree 5. Before all of that, CO2 at tree 169.", "co2 @ TreeIs(169); picture @ TreeIs(4); picture @ TreeIs(5)"),
        ("Take CO2 at tree 21, and after it a thermal picture of the same tree.", "co2 @ TreeIs(21); picture"),
    ],
)  # fmt: skip
def test_steps_are_done_in_the_order_that_is_said_behind_them(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    "request_",
    [
        "Photograph trees 4 and 9, then its four nearest neighbours.",  # whose?
        "Photograph row 3, every tree, then its two nearest neighbours.",
        "Photograph the trees on either side.",
        "Photograph the tree closest to the pond, then the three trees closest to it.",  # to the tree, or to the pond?
        "Photograph trees 1, 19 and 152. CO2 at the first of the two.",
        "Photograph trees 1, 19 and 152. CO2 at the fourth of these.",
        "CO2 at tree 4. Photograph the pond one.",
        "Take a picture and CO2 at tree 4, then a second one at tree 9.",
        "CO2, air temperature and a picture at tree 4, then both again at tree 9.",
        "Row 6. Take a picture.",  # at every tree?
        "amiga> Moisture at 10 cm at tree 4, then 40 at tree 5.",
        "amiga> Nitrate and moisture at 20 cm at tree 4, then again at 40 cm.",  # both?
        "Photograph tree 4. Both again.",
        "Photograph tree 4, CO2 at tree 9 and air temperature at tree 12. Then both again.",
        "Photograph tree 20. Go to tree 30 and take a picture. Repeat that twice more.",
        "Photograph tree 20. Go 5 trees down the row and take a picture. Repeat that three times.",  # in all?
        "CO2 at tree 60. Unless it's above 500, photograph it. If so, go home.",  # if what?
        "CO2 at tree 60. If it's above 500, photograph it. If so, go home.",
        "CO2 at tree 60. If it's low, take the air temperature. If it's low, photograph it.",  # which one?
        "CO2 at trees 4 to 9. Anything below, a picture.",
        "CO2 and air temperature at tree 30. CO2 at tree 31. If tree 30 was high, photograph it.",
        "CO2 at tree 30 if tree 31 was high.",
        "Photograph tree 4 and measure CO2 at tree 9. If the picture fails, go home.",
        "Photograph trees 4 and 9 and measure CO2 at each. If the picture fails at one of them, take the air temperature.",
        "Photograph tree 4. If it fails at one tree, measure CO2.",
        "Photograph every tree in row 3, end the survey at the first value.",
        "Photograph trees 4 and 9. Scratch tree 12, make it 13.",
        "Photograph tree 4. CO2 at tree 9. Scratch tree 4, make it tree 5.",
        "Photograph tree 4, CO2 at tree 9, air temperature at tree 12. Swap them.",
        "Photograph tree 4. If it is high, CO2 at tree 9. The other way round.",
        "Photograph tree 4 and CO2 at tree 9, tree 12 first.",
        "Photograph tree 4. If it is high, measure CO2 at tree 9. Before all of that, CO2 at tree 12.",
    ],
)
def test_what_has_no_single_meaning_is_left_open(request_: str) -> None:
    assert plan_of(request_) is None
