"""Places named by others: beside those spoken of, in the same row, of each kind; and the readings and depths before."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline
from planning.english.vineyards import vineyard

SITES = {"demo": open_site("demo"), "vineyard": vineyard()}
ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}
PLANNED = [
    ("demo", "husky", "take a thermal picture at tree 83, then pictures of the four trees closest to it", "picture @ TreeIs(83); for Nearest(Here, 4): [picture]"),
    ("demo", "husky", "measure the air temperature at tree 83. If it is above 32 °C, take thermal images of the four trees closest to it", "air @ TreeIs(83) = r1; if r1 > 32 degC: [for Nearest(Here, 4): [picture]]"),
    ("demo", "husky", "measure the air temperature at tree 83. If it is above 32 °C, take thermal images of the four trees nearest to tree 83", "air @ TreeIs(83) = r1; if r1 > 32 degC: [for Nearest(TreeIs(83), 4): [picture]]"),
    ("demo", "husky", "measure the air temperature at tree 83. If it is above 32 °C, photograph the four closest trees", "air @ TreeIs(83) = r1; if r1 > 32 degC: [for Nearest(Here, 4): [picture]]"),
    ("demo", "husky", "measure the air temperature at tree 83. If it is above 32 °C, photograph the four trees around it", "air @ TreeIs(83) = r1; if r1 > 32 degC: [for Nearest(Here, 4, True): [picture]]"),
    ("demo", "amiga", "take a picture of tree 4, and one of the ground under it too", "picture @ TreeIs(4); picture(view ground)"),
    ("demo", "amiga", "take a picture of every yellow tree, and one of the ground under it", "for Where(leaf_color, eq, yellow): [picture; picture(view ground)]"),
    ("demo", "amiga", "take a picture of tree 4 and another of the ground", "picture @ TreeIs(4); picture(view ground)"),
    ("demo", "husky", "take the CO2 at tree 100, and if it's high take it twice more", "co2 @ TreeIs(100) = r1; if r1 high: [co2 x2]"),
    ("demo", "husky", "take the CO2 at tree 100, and if it's above 420 ppm take it there twice more", "co2 @ TreeIs(100) = r1; if r1 > 420 ppm: [co2 x2]"),
    ("demo", "husky", "take the CO2 at tree 100, and if it's above 420 ppm take it again there", "co2 @ TreeIs(100) = r1; if r1 > 420 ppm: [co2]"),
    ("demo", "husky", "take the CO2 at tree 100, and if it's above 420 ppm measure it two more times", "co2 @ TreeIs(100) = r1; if r1 > 420 ppm: [co2 x2]"),
    ("demo", "husky", "start with row 1 and take a thermal picture of every third tree", "for EveryNth(3, of Rows(1, 1)): [picture]"),
    ("demo", "husky", "start with row 1 and take a thermal picture of every third tree, then do the same in row 10", "for EveryNth(3, of Rows(1, 1)): [picture]; for EveryNth(3, of Rows(10, 10)): [picture]"),
    ("demo", "husky", "begin with row 1: a thermal picture of every third tree. Then do the same in row 10", "for EveryNth(3, of Rows(1, 1)): [picture]; for EveryNth(3, of Rows(10, 10)): [picture]"),
    ("demo", "husky", "start in row 1, taking a thermal picture of every third tree, then do the same in row 10", "for EveryNth(3, of Rows(1, 1)): [picture]; for EveryNth(3, of Rows(10, 10)): [picture]"),
    ("vineyard", "husky", "CO2 at the first vine of every Merlot row", "for InRow(1, 1, of Rows(of Where(variety, eq, Merlot))): [co2] | return_to_start"),
    ("vineyard", "husky", "a picture at both ends of the Syrah rows", "for UnionOf(InRow(1, 1, of Rows(of Where(variety, eq, Syrah)))+InRow(-1, -1, of Rows(of Where(variety, eq, Syrah)))): [picture] | return_to_start"),
    ("vineyard", "husky", "measure the CO2 at the three vines nearest to the pond and also at the three farthest from it", "for UnionOf(Nearest(InZone(pond), 3)+Farthest(InZone(pond), 3)): [co2] | return_to_start"),
    ("demo", "husky", "measure CO2 at tree 4 and also at tree 9", "co2 @ TreeIs(4); co2 @ TreeIs(9)"),
    ("demo", "husky", "measure CO2 at tree 4 and likewise at tree 9", "co2 @ TreeIs(4); go TreeIs(9); co2"),
    ("demo", "husky", "measure CO2 at tree 4 as well as at tree 9", "co2 @ TreeIs(4); co2 @ TreeIs(9)"),
    ("demo", "husky", "measure CO2 at the three trees nearest to the pond and at the three farthest from it", "for UnionOf(Nearest(InZone(pond), 3)+Farthest(InZone(pond), 3)): [co2]"),
    ("demo", "husky", "measure CO2 at every third tree of row 4 until a value is under 400 ppm", "for EveryNth(3, of Rows(4, 4)) until r1 < 400 ppm: [co2 = r1]"),
    ("demo", "husky", "go along row 4 and measure CO2 at every third tree, until you find one under 400 ppm", "for EveryNth(3, of Rows(4, 4)) until r1 < 400 ppm: [co2 = r1]"),
    ("demo", "amiga", "A leaf sample at tree 4. After that take a trunk picture of that same tree", "sample_leaf @ TreeIs(4); picture(view trunk)"),
    ("demo", "amiga", "take a leaf sample at 5 trees of row 3. After the last one take a trunk picture of that same tree. Stay there.", "for Take(5, of Rows(3, 3)): [sample_leaf]; go Here; picture(view trunk) | stay"),
    ("demo", "husky", "pictures at tree 40 and at the two trees north of it in the row", "picture @ TreeIs(40); for UnionOf(AlongRow(1, north)+AlongRow(2, north)): [picture]"),
    ("demo", "husky", "pictures at tree 40 and the two trees next to it in the row", "for UnionOf(TreeIs(40)+Nearest(TreeIs(40), 2, True, of RowOf(TreeIs(40)))): [picture]"),
    ("demo", "husky", "measure CO2 at tree 4, and end up back where you began", "co2 @ TreeIs(4) | return_to_start"),
    ("demo", "husky", "measure CO2 at tree 4. End where you started", "co2 @ TreeIs(4) | return_to_start"),
    ("demo", "husky", "measure CO2 at tree 4 and finish where you set out", "co2 @ TreeIs(4) | return_to_start"),
    ("demo", "amiga", "Ten leaf samples, any ten trees of row 3.", "for Take(10, of Rows(3, 3)): [sample_leaf]"),
    ("demo", "husky", "choose five trees of row 3 at random and measure CO2 at each of them", "for RandomSample(5, of Rows(3, 3)): [co2]"),
    ("demo", "husky", "pick five trees at random in row 3 and take a picture of each", "for RandomSample(5, of Rows(3, 3)): [picture]"),
    ("demo", "husky", "at five random trees of each variety measure CO2", "for UnionOf(RandomSample(5, of Where(variety, eq, Carmel))+RandomSample(5, 1, of Where(variety, eq, Nonpareil))): [co2]"),
    ("demo", "husky", "measure CO2 at five random Carmel trees and five random Nonpareil trees", "for UnionOf(RandomSample(5, of Where(variety, eq, Carmel))+RandomSample(5, 1, of Where(variety, eq, Nonpareil))): [co2]"),
    ("demo", "husky", "measure CO2 at tree 83, then take a picture of the tree closest to it", "co2 @ TreeIs(83); picture @ Nearest(Here)"),
    ("demo", "husky", "measure CO2 at tree 83, then take a picture of the four trees closest to it", "co2 @ TreeIs(83); for Nearest(Here, 4): [picture]"),
    ("demo", "husky", "measure CO2 at tree 83, then take a picture at the four trees closest to it", "co2 @ TreeIs(83); for Nearest(Here, 4): [picture]"),
    ("demo", "husky", "measure CO2 at tree 83, then photograph the four trees closest to it", "co2 @ TreeIs(83); for Nearest(Here, 4): [picture]"),
    ("demo", "husky", "measure CO2 at tree 83, then photograph the four trees closest to there", "co2 @ TreeIs(83); for Nearest(Here, 4): [picture]"),
    ("demo", "husky", "measure CO2 at tree 83, then photograph the four trees next to it", "co2 @ TreeIs(83); for Nearest(Here, 4, True): [picture]"),
    ("demo", "husky", "measure CO2 at tree 83, then photograph four trees near it", "co2 @ TreeIs(83); for Nearest(Here, 4, True): [picture]"),
    ("demo", "husky", "measure CO2 at tree 83, then photograph the trees within 10 m of it", "co2 @ TreeIs(83); for Within(10, Here): [picture]"),
    ("demo", "husky", "measure CO2 at tree 83, then photograph the four trees nearest", "co2 @ TreeIs(83); for Nearest(Here, 4): [picture]"),
    ("demo", "husky", "measure CO2 at tree 83, then photograph the four trees nearest to that tree", "co2 @ TreeIs(83); for Nearest(Here, 4): [picture]"),
    ("demo", "husky", "measure CO2 at tree 83, then photograph the tree next to it in the row", "co2 @ TreeIs(83); picture @ Nearest(Here, True, of RowOf)"),
    ("demo", "husky", "measure CO2 at tree 83, then photograph the two trees beside it in the same row", "co2 @ TreeIs(83); for Nearest(Here, 2, True, of RowOf): [picture]"),
    ("demo", "husky", "measure CO2 at tree 83, then photograph the tree next to it in the same row", "co2 @ TreeIs(83); picture @ Nearest(Here, True, of RowOf)"),
    ("vineyard", "husky", "CO2 at the first vine of the rows of Merlot", "for InRow(1, 1, of Rows(of Where(variety, eq, Merlot))): [co2] | return_to_start"),
    ("vineyard", "husky", "CO2 at the first vine of every row of Merlot", "for InRow(1, 1, of Rows(of Where(variety, eq, Merlot))): [co2] | return_to_start"),
    ("vineyard", "husky", "CO2 at the first vine of every row of Merlot vines", "for InRow(1, 1, of Rows(of Where(variety, eq, Merlot))): [co2] | return_to_start"),
    ("vineyard", "husky", "drive along the Merlot rows with a picture at every 50th vine", "for EveryNth(50, of Rows(of Where(variety, eq, Merlot))): [picture] | return_to_start"),
    ("vineyard", "husky", "CO2 at the north end of each row in the Merlot", "for InRow(1, 1, north, of Rows(of Where(variety, eq, Merlot))): [co2] | return_to_start"),
    ("vineyard", "husky", "CO2 at the first vine of each row of the North block", "for InRow(1, 1, of Rows(of InBlock(North))): [co2] | return_to_start"),
    ("demo", "amiga", "ground picture at tree 4", "picture(view ground) @ TreeIs(4)"),
    ("demo", "husky", "start in row 1 and take a picture of every third tree", "for EveryNth(3, of Rows(1, 1)): [picture]"),
    ("demo", "husky", "start at row 1 and take a picture of every third tree", "for EveryNth(3, of Rows(1, 1)): [picture]"),
    ("demo", "husky", "begin with row 1 and take a picture of every third tree", "for EveryNth(3, of Rows(1, 1)): [picture]"),
    ("demo", "husky", "row 1 first: a picture of every third tree", "for EveryNth(3, of Rows(1, 1)): [picture]"),
    ("demo", "husky", "take CO2 at tree 4. If it is high, take it again twice", "co2 @ TreeIs(4) = r1; if r1 high: [co2 x2]"),
    ("demo", "husky", "take CO2 at tree 4. If it is above 420, take it two more times", "co2 @ TreeIs(4) = r1; if r1 > 420 ppm: [co2 x2]"),
    ("demo", "husky", "take CO2 at tree 4. If it is above 420, take it twice more", "co2 @ TreeIs(4) = r1; if r1 > 420 ppm: [co2 x2]"),
    ("demo", "husky", "take CO2 at tree 4. If it is above 420, measure CO2 twice more", "co2 @ TreeIs(4) = r1; if r1 > 420 ppm: [co2 x2]"),
    ("demo", "husky", "take CO2 at tree 4. If it is above 420, measure it again two times", "co2 @ TreeIs(4) = r1; if r1 > 420 ppm: [co2 x2]"),
    ("demo", "husky", "take CO2 at tree 4. If it is above 420, take another two readings", "co2 @ TreeIs(4) = r1; if r1 > 420 ppm: [co2 x2]"),
    ("demo", "husky", "for each variety, photograph three trees", "for UnionOf(Take(3, of Where(variety, eq, Carmel))+Take(3, of Where(variety, eq, Nonpareil))): [picture]"),
    ("demo", "husky", "choose five trees at random and take a picture of each", "for RandomSample(5): [picture]"),
    ("demo", "husky", "pick three random trees and photograph them", "for RandomSample(3): [picture]"),
    ("demo", "amiga", "at each yellow tree take a picture and another one of the ground", "for Where(leaf_color, eq, yellow): [picture; picture(view ground)]"),
    ("demo", "husky", "photograph every tree of row 3. At the last one measure CO2 as well", "for Rows(3, 3): [picture]; go Here; co2"),
    ("demo", "husky", "photograph every tree of row 3, and at the last one also measure CO2", "for Rows(3, 3): [picture]; go Here; co2"),
    ("demo", "husky", "photograph 5 trees of row 3, then measure CO2 at the last one", "for Take(5, of Rows(3, 3)): [picture]; co2 @ Here"),
    ("demo", "husky", "measure the air temperature at the first tree of row 4, then at the last one", "air @ InRow(1, 1, of Rows(4, 4)); air @ InRow(-1, -1, of Rows(4, 4))"),
    ("demo", "husky", "take a picture of each of the three-year-olds", "for Where(age_years, eq, 3): [picture]"),
    ("demo", "husky", "photograph all four-year-old trees", "for Where(age_years, eq, 4): [picture]"),
    ("demo", "husky", "photograph the yellow trees, the nearest first", "for Ordered(nearest_first, of Where(leaf_color, eq, yellow)) given: [picture]"),
    ("demo", "husky", "go to tree 4 and measure the air temperature. Then go to tree 9 and measure it there also", "go TreeIs(4); air; go TreeIs(9); air"),
    ("demo", "husky", "measure the air temperature at tree 4, then measure it at tree 9 as well", "air @ TreeIs(4); air @ TreeIs(9)"),
    ("demo", "husky", "measure the air temperature at tree 4 and at tree 9. If the second value is above 30 degrees, take a picture there", "air @ TreeIs(4); air @ TreeIs(9) = r1; if r1 > 30 degC: [picture]"),
    ("demo", "husky", "measure the air temperature at tree 4, then at tree 9. If this second reading is above 30 degrees, take a picture of that tree too", "air @ TreeIs(4); air @ TreeIs(9) = r1; if r1 > 30 degC: [picture]"),
    ("demo", "husky", "measure the air temperature at tree 4, then at tree 9. If the first one is above 30 degrees, take a picture at tree 4", "air @ TreeIs(4) = r1; air @ TreeIs(9); if r1 > 30 degC: [picture @ TreeIs(4)]"),
    ("demo", "husky", "measure CO2 at tree 5 and tree 9, and if the second is higher than 420 take a picture there", "co2 @ TreeIs(5); co2 @ TreeIs(9) = r1; if r1 > 420 ppm: [picture]"),
    ("demo", "husky", "take a thermal image at each tree of row 6. If the canopy temperature at a tree exceeds 36 °C, also measure CO2 there", "for Rows(6, 6): [picture = r1; if r1 > 36 degC: [co2]]"),
    ("demo", "husky", "take a thermal image at each tree of row 6. If the canopy temperature of a tree is above 36 °C, also measure CO2 there and at the tree next to it in the same row", "for Rows(6, 6): [picture = r1; if r1 > 36 degC: [co2; co2 @ Nearest(Here, True, of RowOf)]]"),
    ("demo", "husky", "take a thermal image at each tree of row 6. If a tree is above 36 °C, also measure CO2 there; otherwise continue", "for Rows(6, 6): [picture = r1; if r1 > 36 degC: [co2]]"),
    ("demo", "husky", "take a thermal image at each tree of row 6. If it is above 36 °C, measure CO2, otherwise go on", "for Rows(6, 6): [picture = r1; if r1 > 36 degC: [co2]]"),
    ("demo", "husky", "take a thermal image at each tree of row 6. Where it is above 36 °C, measure CO2, else move on to the next tree", "for Rows(6, 6): [picture = r1; if r1 > 36 degC: [co2]]"),
    ("demo", "amiga", "in row 4, take the soil moisture at every third tree, at a depth of 40 cm. When it is under 14 percent, take also the nitrate at the same place and the same depth. At the end, come back to the start", "for EveryNth(3, of Rows(4, 4)): [moisture(depth_cm 40) = r1; if r1 < 14 percent: [nitrate(depth_cm 40)]] | return_to_start"),
    ("demo", "amiga", "measure soil moisture at tree 4 at 40 cm and nitrate at the same depth", "moisture(depth_cm 40) @ TreeIs(4); nitrate(depth_cm 40)"),
    ("demo", "amiga", "soil moisture at 40 cm at tree 4. If it is under 14 percent, measure nitrate at the same depth", "moisture(depth_cm 40) @ TreeIs(4) = r1; if r1 < 14 percent: [nitrate(depth_cm 40)]"),
    ("demo", "amiga", "moisture at tree 60 with one reading at 10 cm, one at 30 cm and one at 60 cm", "moisture(depth_cm 10) @ TreeIs(60); moisture(depth_cm 30); moisture(depth_cm 60)"),
    ("demo", "amiga", "moisture at 10, 30 and 60 cm at tree 60", "moisture(depth_cm 10) @ TreeIs(60); moisture(depth_cm 30); moisture(depth_cm 60)"),
    ("demo", "amiga", "measure the soil moisture at tree 60 at 10 cm, 30 cm and 60 cm. Do the same at tree 120", "moisture(depth_cm 10) @ TreeIs(60); moisture(depth_cm 30); moisture(depth_cm 60); go TreeIs(120); moisture(depth_cm 10); moisture(depth_cm 30); moisture(depth_cm 60)"),
    ("demo", "husky", "you have 20 minutes. Take as many pictures of yellow trees as you can", "for Where(leaf_color, eq, yellow) optional: [picture] | duration_s 1200"),
    ("vineyard", "husky", "CO2 at 8 random Cabernets", "for RandomSample(8, of Where(variety, eq, Cabernet Sauvignon)): [co2] | return_to_start"),
    ("demo", "husky", "measure the air temperature at the first tree of row 4 and at the second one", "air @ InRow(1, 1, of Rows(4, 4)); air @ InRow(2, 2, of Rows(4, 4))"),
    ("demo", "husky", "photograph trees 4, 7 and 9, and measure CO2 at the last one", "for UnionOf(TreeIs(4)+TreeIs(7)+TreeIs(9)): [picture]; co2 @ TreeIs(9)"),
    ("demo", "husky", "measure CO2 at trees 4, 7 and 9. If the last reading is above 420 ppm, take a picture there", "co2 @ TreeIs(4); co2 @ TreeIs(7); co2 @ TreeIs(9) = r1; if r1 > 420 ppm: [picture]"),
    ("demo", "husky", "measure CO2 at trees 4, 7 and 9. If the third one is above 420 ppm, photograph tree 4", "co2 @ TreeIs(4); co2 @ TreeIs(7); co2 @ TreeIs(9) = r1; if r1 > 420 ppm: [picture @ TreeIs(4)]"),
    ("demo", "amiga", "in row 4, take the soil moisture at every third tree, at a depth of 40 cm. When it is under 14 percent, take also the nitrate at the same place and the same depth", "for EveryNth(3, of Rows(4, 4)): [moisture(depth_cm 40) = r1; if r1 < 14 percent: [nitrate(depth_cm 40)]]"),
    ("demo", "husky", "photograph the 12-year-olds", "for Where(age_years, eq, 12): [picture]"),
]  # fmt: skip
UNKNOWN = [
    "take thermal images of the four trees closest to it",
    "take a trunk picture of that same tree",
    "photograph the tree next to it",
    "photograph the tree closest to it",
    "photograph the trees within 10 m of it",
    "go to tree 40 and tree 50, photograph the tree closest to it",
    "photograph trees 40 and 50 and measure CO2 at the tree closest to it",
    "photograph the four trees closest to the charger, and measure CO2 at the tree farthest from it",
    "measure CO2 at tree 4 and at tree 9. If the first reading is above 420 ppm, take a picture there",
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=lambda value: str(value)[:60])
def test_what_was_named_before_is_found(site: str, robot: str, request_: str, plan: str) -> None:
    found = composed(request_, SITES[site], ROBOTS[robot])
    assert isinstance(found, Planned), found
    assert outline(found.task) == plan
    assert unaccounted(found.task) == ()
    assert mismatches(found.task, SITES[site], ROBOTS[robot]) == ()


@pytest.mark.parametrize("request_", UNKNOWN)
def test_what_was_not_named_is_not_guessed(request_: str) -> None:
    assert not isinstance(composed(request_, SITES["demo"], ROBOTS["husky"]), Planned)
