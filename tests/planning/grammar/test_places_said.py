"""Places and noun phrases as people say them: lists, rows, parts of rows, attributes, rankings, distances, references."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Clarify, Planned
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline
from planning.english.vineyards import vineyard

HUSKY = load_robot("husky")
PLANNED = {
    "demo": [
        ("Photograph one tree per row in the wet corner.", "for Quota(row, 1, of Rows(of InZone(wet corner))): [picture]"),
        ("Photograph as many trees as possible in the northern half of row 4 in 5 minutes.", "for InRow(1, 9, north, of Rows(4, 4)) optional: [picture] | duration_s 300"),
        ("Photograph trees 4, 9 and 12, then measure CO2 at the second one.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)): [picture]; co2 @ TreeIs(9)"),
        ("Take a thermal picture of trees 20, 21 and 25-30.", "for UnionOf(TreeIs(20)+TreeIs(21)+TreeIs(25)+TreeIs(26)+TreeIs(27)+TreeIs(28)+TreeIs(29)+TreeIs(30)): [picture]"),
        ("Measure CO2 at number 140.", "co2 @ TreeIs(140)"),
        ("Measure CO2 at tree no. 140.", "co2 @ TreeIs(140)"),
        ("Take pictures of trees numbered 20 to 30.", "for UnionOf(TreeIs(20)+TreeIs(21)+TreeIs(22)+TreeIs(23)+TreeIs(24)+TreeIs(25)+TreeIs(26)+TreeIs(27)+TreeIs(28)+TreeIs(29)+TreeIs(30)): [picture]"),
        ("Photograph trees 4, 9, 12 to 15 and 20.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)+TreeIs(13)+TreeIs(14)+TreeIs(15)+TreeIs(20)): [picture]"),
        ("Photograph the trees with numbers 4, 9 and 12.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)): [picture]"),
        ("Measure CO2 at trees 20 up to 30.", "for UnionOf(TreeIs(20)+TreeIs(21)+TreeIs(22)+TreeIs(23)+TreeIs(24)+TreeIs(25)+TreeIs(26)+TreeIs(27)+TreeIs(28)+TreeIs(29)+TreeIs(30)): [co2]"),
        ("Take pictures of all trees from number 20 to number 30.", "for UnionOf(TreeIs(20)+TreeIs(21)+TreeIs(22)+TreeIs(23)+TreeIs(24)+TreeIs(25)+TreeIs(26)+TreeIs(27)+TreeIs(28)+TreeIs(29)+TreeIs(30)): [picture]"),
        ("Photograph the trees of row 3 and of row 5.", "for UnionOf(Rows(3, 3)+Rows(5, 5)): [picture]"),
        ("Photograph the southernmost three trees of row 4.", "for Extreme(south, 3, of Rows(4, 4)): [picture]"),
        ("Photograph the last but one tree in row 4.", "picture @ InRow(-2, -2, of Rows(4, 4))"),
        ("Photograph the second tree from each end of row 4.", "for UnionOf(InRow(2, 2, of Rows(4, 4))+InRow(-2, -2, of Rows(4, 4))): [picture]"),
        ("Photograph one tree in three in row 4.", "for EveryNth(3, of Rows(4, 4)): [picture]"),
        ("Photograph the two trees at the southern end of row 4.", "for InRow(1, 2, south, of Rows(4, 4)): [picture]"),
        ("Photograph row 4 from the fifth tree on.", "for InRow(5, -1, of Rows(4, 4)): [picture]"),
        ("Photograph row 4 from tree 5 to tree 10.", "for InRow(5, 10, of Rows(4, 4)): [picture]"),
        ("Photograph the northern ends of all rows.", "for InRow(1, 1, north, of Rows): [picture]"),
        ("Photograph the yellow-leaved trees.", "for Where(leaf_color, eq, yellow): [picture]"),
        ("Photograph the trees where the leaves are yellow.", "for Where(leaf_color, eq, yellow): [picture]"),
        ("Photograph the trees that are two years old.", "for Where(age_years, eq, 2): [picture]"),
        ("Photograph the trees aged 2.", "for Where(age_years, eq, 2): [picture]"),
        ("Photograph the trees aged 2 years.", "for Where(age_years, eq, 2): [picture]"),
        ("Photograph trees aged between 3 and 8.", "for Where(age_years, le, 8, of Where(age_years, ge, 3)): [picture]"),
        ("Photograph trees aged 3 to 8 years.", "for Where(age_years, le, 8, of Where(age_years, ge, 3)): [picture]"),
        ("Photograph trees of 8 years and older.", "for Where(age_years, ge, 8): [picture]"),
        ("Photograph trees under 4 years.", "for Where(age_years, lt, 4): [picture]"),
        ("Photograph trees with an age of 12 years.", "for Where(age_years, eq, 12): [picture]"),
        ("Photograph trees with yields of 6 to 8 kg.", "for Where(yield_kg, le, 8, of Where(yield_kg, ge, 6)): [picture]"),
        ("Photograph trees with a yield between 6 and 8 kg.", "for Where(yield_kg, le, 8, of Where(yield_kg, ge, 6)): [picture]"),
        ("Photograph the Carmels.", "for Where(variety, eq, Carmel): [picture]"),
        ("Photograph all Carmels in row 4.", "for Where(variety, eq, Carmel, of Rows(4, 4)): [picture]"),
        ("Photograph the yellow Carmels.", "for Where(leaf_color, eq, yellow, of Where(variety, eq, Carmel)): [picture]"),
        ("Photograph the three oldest Carmels.", "for Top(age_years, 3, of Where(variety, eq, Carmel)): [picture]"),
        ("Photograph the heaviest-bearing tree.", "picture @ Top(yield_kg, 1)"),
        ("Photograph the five worst trees by yield.", "for Top(yield_kg, 5, True): [picture]"),
        ("Photograph the ten trees that yielded least.", "for Top(yield_kg, 10, True): [picture]"),
        ("Photograph the tree which gave the most.", "picture @ Top(yield_kg, 1)"),
        ("Photograph the top 10 yielders.", "for Top(yield_kg, 10): [picture]"),
        ("Photograph a random tree in row 7.", "picture @ RandomSample(1, of Rows(7, 7))"),
        ("Photograph tree 40 and the four trees around it.", "for UnionOf(TreeIs(40)+Nearest(TreeIs(40), 4, True)): [picture]"),
        ("Photograph the tree north of tree 40.", "picture @ Nearest(TreeIs(40), True, north)"),
        ("Photograph tree 40's northern neighbour.", "picture @ Nearest(TreeIs(40), True, north)"),
        ("Photograph tree 40's nearest neighbour.", "picture @ Nearest(TreeIs(40))"),
        ("Photograph the trees not in the wet corner.", "for Excluding(InZone(wet corner)): [picture]"),
        ("Photograph the edge trees.", "for UnionOf(Edge(north)+Edge(east)+Edge(south)+Edge(west)): [picture]"),
        ("Photograph the tree in the far north-west.", "picture @ Corners(nw)"),
        ("Photograph the most central tree.", "picture @ Middle"),
        ("Photograph row 3 every 20 metres.", "for Spaced(20, of Rows(3, 3)): [picture]"),
        ("Photograph all trees in row 4 without tree 60.", "for Excluding(TreeIs(60), of Rows(4, 4)): [picture]"),
        ("Photograph row 4 without the first tree.", "for Excluding(InRow(1, 1, of Rows(4, 4)), of Rows(4, 4)): [picture]"),
        ("Photograph as many trees as possible in row 3.", "for Rows(3, 3) optional: [picture]"),
        ("Photograph as many trees as possible in row 3 within 10 minutes.", "for Rows(3, 3) optional: [picture] | duration_s 600"),
        ("Photograph as many yellow trees as you can in the eastern half in 10 minutes.", "for Where(leaf_color, eq, yellow, of Half(east)) optional: [picture] | duration_s 600"),
        ("Photograph one tree per row in the eastern half.", "for Quota(row, 1, of Rows(of Half(east))): [picture]"),
        ("Photograph one tree per row in rows 3 to 7.", "for Quota(row, 1, of Rows(3, 7)): [picture]"),
        ("Photograph two trees in each row of the northern half.", "for Quota(row, 2, of Rows(of Half(north))): [picture]"),
        ("Measure CO2 at trees 4, 9 and 12, then photograph the same trees.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)): [co2; picture]"),
        ("Photograph trees 4 and 9. Measure CO2 at the first one.", "for UnionOf(TreeIs(4)+TreeIs(9)): [picture]; co2 @ TreeIs(4)"),
        ("Photograph trees 4 and 9. Measure CO2 at the latter.", "for UnionOf(TreeIs(4)+TreeIs(9)): [picture]; co2 @ TreeIs(9)"),
        ("Photograph the yellow trees in row 3, then photograph the rest.", "for Where(leaf_color, eq, yellow, of Rows(3, 3)): [picture]; for Excluding(Where(leaf_color, eq, yellow, of Rows(3, 3)), of Rows(3, 3)): [picture]"),
        ("Photograph the yellow trees of row 4, then measure CO2 at the others.", "for Where(leaf_color, eq, yellow, of Rows(4, 4)): [picture]; for Excluding(Where(leaf_color, eq, yellow, of Rows(4, 4)), of Rows(4, 4)): [co2]"),
        ("Go to tree 40 and photograph the next five trees.", "go TreeIs(40); for UnionOf(AlongRow(1)+AlongRow(2)+AlongRow(3)+AlongRow(4)+AlongRow(5)): [picture]"),
        ("Photograph every tree in row 4 from the third to the last.", "for InRow(3, -1, of Rows(4, 4)): [picture]"),
        ("Photograph row 4 but skip the first two trees.", "for Excluding(InRow(1, 2, of Rows(4, 4)), of Rows(4, 4)): [picture]"),
        ("Photograph row 4, not the yellow trees.", "for Excluding(Where(leaf_color, eq, yellow), of Rows(4, 4)): [picture]"),
        ("Photograph all trees except the Carmels.", "for Excluding(Where(variety, eq, Carmel)): [picture]"),
        ("Photograph all trees except those older than 8 years.", "for Excluding(Where(age_years, gt, 8)): [picture]"),
        ("Photograph all trees other than the yellow ones in row 3.", "for Excluding(Where(leaf_color, eq, yellow, of Rows(3, 3))): [picture]"),
        ("Photograph the trees in rows 3 and 4 that are yellow or pale green.", "for UnionOf(Where(leaf_color, eq, yellow, of UnionOf(Rows(3, 3)+Rows(4, 4)))+Where(leaf_color, eq, pale green, of UnionOf(Rows(3, 3)+Rows(4, 4)))): [picture]"),
        ("Photograph the yellow trees in row 3 and in row 5.", "for Where(leaf_color, eq, yellow, of UnionOf(Rows(3, 3)+Rows(5, 5))): [picture]"),
        ("Photograph the yellow trees in row 3 and those in row 5.", "for UnionOf(Where(leaf_color, eq, yellow, of Rows(3, 3))+Where(leaf_color, eq, yellow, of Rows(5, 5))): [picture]"),
        ("Photograph the oldest and the youngest tree in row 3.", "for UnionOf(Top(age_years, 1, of Rows(3, 3))+Top(age_years, 1, True, of Rows(3, 3))): [picture]"),
        ("Photograph the tree with the highest and the tree with the lowest yield.", "for UnionOf(Top(yield_kg, 1)+Top(yield_kg, 1, True)): [picture]"),
        ("Photograph the tree with the second highest yield.", "picture @ Top(yield_kg, 1, of Excluding(Top(yield_kg, 1)))"),
        ("Photograph the five oldest and the five youngest trees.", "for UnionOf(Top(age_years, 5)+Top(age_years, 5, True)): [picture]"),
        ("Photograph the oldest five.", "for Top(age_years, 5): [picture]"),
        ("Photograph one tree in row 3 and two in row 5.", "picture @ Take(1, of Rows(3, 3)); for Take(2, of Rows(5, 5)): [picture]"),
        ("Photograph two trees each in rows 3 and 5.", "for Quota(row, 2, of UnionOf(Rows(3, 3)+Rows(5, 5))): [picture]"),
        ("Photograph ten trees, evenly distributed over row 3.", "for Evenly(10, of Rows(3, 3)): [picture]"),
        ("Photograph three trees in the middle of the orchard.", "for Adjacent(Middle, 3): [picture]"),
        ("Photograph two trees near the charger.", "for Nearest(Marker(charger), 2): [picture]"),
        ("Photograph a tree near the pond.", "picture @ Nearest(InZone(pond))"),
        ("Photograph the three trees north of tree 40.", "for UnionOf(AlongRow(1, north, TreeIs(40))+AlongRow(2, north, TreeIs(40))+AlongRow(3, north, TreeIs(40))): [picture]"),
        ("Photograph the trees within a radius of 20 m around tree 40.", "for Within(20, TreeIs(40)): [picture]"),
        ("Photograph all trees in a 20 m radius of tree 40.", "for Within(20, TreeIs(40)): [picture]"),
        ("Photograph all trees up to 20 m from the charger.", "for Within(20, Marker(charger)): [picture]"),
        ("Photograph the trees between 20 and 40 m from the charger.", "for Within(20, Marker(charger), True, of Within(40, Marker(charger))): [picture]"),
        ("Photograph the tree in each corner.", "for Corners: [picture]"),
        ("Photograph row 4's third tree.", "picture @ InRow(3, 3, of Rows(4, 4))"),
        ("Measure CO2 at row 4's northern end.", "co2 @ InRow(1, 1, north, of Rows(4, 4))"),
        ("Photograph row 4's ends.", "for UnionOf(InRow(1, 1, of Rows(4, 4))+InRow(-1, -1, of Rows(4, 4))): [picture]"),
        ("Measure tree 40's CO2.", "co2 @ TreeIs(40)"),
        ("Measure CO2 at one tree in each row but the last.", "for Quota(row, 1, of Excluding(Rows(-1, -1), of Rows)): [co2]"),
        ("Measure CO2 at the middle tree of every row except 3 and 4.", "for UnionOf(Middle(of Rows(1, 1))+Middle(of Rows(2, 2))+Middle(of Rows(5, 5))+Middle(of Rows(6, 6))+Middle(of Rows(7, 7))+Middle(of Rows(8, 8))+Middle(of Rows(9, 9))+Middle(of Rows(10, 10))): [co2]"),
        ("Photograph rows 3 to 7 except 5.", "for Excluding(Rows(5, 5), of Rows(3, 7)): [picture]"),
        ("Photograph the yellow or pale green trees.", "for UnionOf(Where(leaf_color, eq, yellow)+Where(leaf_color, eq, pale green)): [picture]"),
        ("Photograph all trees that are yellow or pale green.", "for UnionOf(Where(leaf_color, eq, yellow)+Where(leaf_color, eq, pale green)): [picture]"),
        ("Photograph trees with yellow or pale green leaves.", "for UnionOf(Where(leaf_color, eq, yellow)+Where(leaf_color, eq, pale green)): [picture]"),
        ("Photograph trees older than 5 but younger than 10 years.", "for Where(age_years, lt, 10, of Where(age_years, gt, 5)): [picture]"),
        ("Photograph trees without yellow leaves.", "for Where(leaf_color, ne, yellow): [picture]"),
        ("Photograph the non-yellow trees.", "for Where(leaf_color, ne, yellow): [picture]"),
        ("Photograph trees aged over 5.", "for Where(age_years, gt, 5): [picture]"),
        ("Photograph trees over 15 kg.", "for Where(yield_kg, gt, 15): [picture]"),
        ("Photograph trees between 6 and 8 kg.", "for Where(yield_kg, le, 8, of Where(yield_kg, ge, 6)): [picture]"),
        ("Photograph trees that yielded between 6 and 8 kg.", "for Where(yield_kg, le, 8, of Where(yield_kg, ge, 6)): [picture]"),
        ("Photograph the trees that are twelve years of age.", "for Where(age_years, eq, 12): [picture]"),
        ("Photograph the best tree by yield.", "picture @ Top(yield_kg, 1)"),
        ("Photograph every other tree in the northern half of row 2.", "for EveryNth(2, of InRow(1, 9, north, of Rows(2, 2))): [picture]"),
        ("Photograph five trees in the southern half of row 2.", "for Take(5, of InRow(1, 9, south, of Rows(2, 2))): [picture]"),
        ("Measure CO2 at the trees in the last third of row 4.", "for InRow(-6, -1, of Rows(4, 4)): [co2]"),
        ("Measure CO2 at two trees at each end of row 4.", "for UnionOf(InRow(1, 2, of Rows(4, 4))+InRow(-2, -1, of Rows(4, 4))): [co2]"),
        ("Photograph trees 4 and 9, then measure CO2 at the second one.", "for UnionOf(TreeIs(4)+TreeIs(9)): [picture]; co2 @ TreeIs(9)"),
        ("Photograph the yellow trees in row 4, then measure CO2 at the other trees in row 4.", "for Where(leaf_color, eq, yellow, of Rows(4, 4)): [picture]; for Excluding(Where(leaf_color, eq, yellow, of Rows(4, 4)), of Rows(4, 4)): [co2]"),
        ("Photograph the yellow trees in row 4, then measure CO2 at the other trees.", "for Where(leaf_color, eq, yellow, of Rows(4, 4)): [picture]; for Excluding(Where(leaf_color, eq, yellow, of Rows(4, 4)), of Rows(4, 4)): [co2]"),
    ],
    "vineyard": [
        ("Photograph vines N300, N305 and N310-N315.", "for UnionOf(TreeIs(N300)+TreeIs(N305)+TreeIs(N310)+TreeIs(N311)+TreeIs(N312)+TreeIs(N313)+TreeIs(N314)+TreeIs(N315)): [picture] | return_to_start"),
        ("Photograph vines from N300 to N310.", "for UnionOf(TreeIs(N300)+TreeIs(N301)+TreeIs(N302)+TreeIs(N303)+TreeIs(N304)+TreeIs(N305)+TreeIs(N306)+TreeIs(N307)+TreeIs(N308)+TreeIs(N309)+TreeIs(N310)): [picture] | return_to_start"),
        ("Photograph the Merlots.", "for Where(variety, eq, Merlot): [picture] | return_to_start"),
        ("Photograph the ten Merlots with the lowest vigor.", "for Top(vigor, 10, True, of Where(variety, eq, Merlot)): [picture] | return_to_start"),
        ("Photograph vines with vigour under 0.32.", "for Where(vigor, lt, 0.32): [picture] | return_to_start"),
        ("Photograph three random vines of each variety.", "for Quota(variety, 3, random): [picture] | return_to_start"),
        ("Measure CO2 at vines no. N300 and N310.", "for UnionOf(TreeIs(N300)+TreeIs(N310)): [co2] | return_to_start"),
        ("Photograph 10 vines in the north-west corner of the South block.", "for Adjacent(Corners(nw, of InBlock(South)), 10): [picture] | return_to_start"),
        ("Photograph as many Merlots as possible in the North block in 20 minutes.", "for Where(variety, eq, Merlot, of InBlock(North)) optional: [picture] | duration_s 1200 | return_to_start"),
    ],
}  # fmt: skip
#: Requests that leave open which places are meant, or how many.
ASKED = [
    ("demo", "Photograph all trees between 20 and 30."),
    ("demo", "Take a picture of each row but the last."),
    ("demo", "Take a picture of the outer rows."),
    ("demo", "Take a picture of the two outermost rows."),
    ("demo", "Take a picture of all rows except 3 and 4."),
    ("demo", "Take a picture of row no. 3."),
    ("demo", "Take a picture of rows 1, 3 and 5 to 7."),
    ("demo", "Take a picture of the third to fifth rows."),
    ("demo", "Take a picture of the row furthest to the east."),
    ("demo", "Photograph the middle rows."),
    ("demo", "Take a picture of the row with tree 40."),
    ("demo", "Take a picture of the row that tree 40 is in."),
    ("demo", "Take a picture of tree 40's row."),
    ("demo", "Take a picture of tree 40's whole row."),
    ("demo", "Photograph the row next to row 3."),
    ("demo", "Take a picture of the rows on either side of row 3."),
    ("vineyard", "In the North block, take a picture of rows 3 to 5."),
    ("vineyard", "Take a picture of block North's row 3."),
    ("vineyard", "Take a picture of the North block's third row."),
    ("demo", "Take a picture of the northern half of row 2."),
    ("demo", "Take a picture of the southern half of row 2."),
    ("demo", "Take a picture of the first half of row 4."),
    ("demo", "Take a picture of the second half of row 4."),
    ("demo", "Take a picture of the northern third of row 4."),
    ("demo", "Photograph the middle five trees of row 4."),
    ("demo", "Photograph the five trees in the middle of row 4."),
    ("demo", "Photograph the youngest trees."),
    ("demo", "Photograph three or four trees."),
    ("demo", "Photograph the trees around tree 40."),
    ("demo", "Photograph the trees around the pond."),
    ("demo", "Photograph trees near the pond."),
    ("demo", "Photograph the trees next to tree 40."),
    ("demo", "Take a picture of tree 40's neighbours."),
    ("demo", "Photograph tree 40 and the trees next to it."),
    ("demo", "Photograph the trees between tree 40 and tree 45."),
    ("demo", "Photograph the trees close to the start."),
    ("vineyard", "Photograph the vines between N300 and N310."),
    ("vineyard", "In North, take a picture of row 12. In South, take a picture of row 14."),
    ("vineyard", "Take a picture of row 12 North and row 14 South."),
    ("demo", "Photograph the trees in the middle of the orchard."),
    ("demo", "Take a picture of the row east of row 5."),
    ("vineyard", "Measure CO2 at N300's neighbours."),
]  # fmt: skip


def site_of(name: str) -> Site:
    return open_site("demo") if name == "demo" else vineyard()


@pytest.mark.parametrize(
    ("site", "request_", "plan"), [(site, *case) for site, cases in PLANNED.items() for case in cases]
)
def test_a_place_is_planned_as_it_is_said(site: str, request_: str, plan: str) -> None:
    outcome = composed(request_, site_of(site), HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert mismatches(outcome.task, site_of(site), HUSKY) == ()


@pytest.mark.parametrize(("site", "request_"), ASKED)
def test_an_open_place_is_asked_about(site: str, request_: str) -> None:
    assert isinstance(composed(request_, site_of(site), HUSKY), Clarify)
