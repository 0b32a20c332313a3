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

    ("demo", "husky", "measure CO2 at tree 4 and likewise at tree 9", "co2 @ TreeIs(4); go TreeIs(9); co2"),
    ("demo", "husky", "measure CO2 at tree 4 as well as at tree 9", "co2 @ TreeIs(4); co2 @ TreeIs(9)"),
    ("demo", "husky", "measure CO2 at the three trees nearest to the pond and at the three farthest from it", "for UnionOf(Nearest(InZone(pond), 3)+Farthest(InZone(pond), 3)): [co2]"),
    ("demo", "husky", "measure CO2 at every third tree of row 4 until a value is under 400 ppm", "for EveryNth(3, of Rows(4, 4)) until r1 < 400 ppm: [co2 = r1]"),
    ("demo", "husky", "go along row 4 and measure CO2 at every third tree, until you find one under 400 ppm", "for EveryNth(3, of Rows(4, 4)) until r1 < 400 ppm: [co2 = r1]"),
    ("demo", "amiga", "A leaf sample at tree 4. After that take a trunk picture of that same tree", "sample_leaf @ TreeIs(4); picture(view trunk)"),
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
