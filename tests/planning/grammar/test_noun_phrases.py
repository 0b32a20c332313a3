"""Noun phrases in every mix of position, area, choice and exception, whatever the order of their words."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline
from planning.english.vineyards import vineyard

HUSKY = load_robot("husky")
SITES = {"demo": open_site("demo"), "vineyard": vineyard()}

PLANNED = {
    "demo": [
        ("Photograph row 2 from tree 3 to the end.", "for InRow(3, -1, of Rows(2, 2)): [picture]"),
        (
            "Photograph at least two of trees 4, 5 and 6.",
            "for Take(2, of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6))): [picture]",
        ),
        ("Photograph all except row 2.", "for Excluding(Rows(2, 2)): [picture]"),
        (
            "Photograph row 3 without the two trees at its north end.",
            "for Excluding(InRow(1, 2, north, of Rows(3, 3)), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph trees 4 to 9, not 6.",
            "for Excluding(TreeIs(6), of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)+TreeIs(9))): [picture]",
        ),
        (
            "Photograph the three trees at the charger end of row 2.",
            "for Nearest(Marker(charger), 3, of Rows(2, 2)): [picture]",
        ),
        (
            "Photograph the nearest tree to the charger that isn't yellow.",
            "picture @ Nearest(Marker(charger), of Where(leaf_color, ne, yellow))",
        ),
        (
            "Photograph the first tree in each row that is yellow.",
            "for InRow(1, 1, of Where(leaf_color, eq, yellow, of Rows)): [picture]",
        ),
        (
            "Photograph the tree before tree 20 and the one after.",
            "for UnionOf(AlongRow(1, up, TreeIs(20))+AlongRow(1, TreeIs(20))): [picture]",
        ),
        ("Photograph of the trees in row 2 the five oldest.", "for Top(age_years, 5, of Rows(2, 2)): [picture]"),
        ("Of the trees in row 2, photograph the five oldest.", "for Top(age_years, 5, of Rows(2, 2)): [picture]"),
        (
            "Photograph every third tree, from south to north, of row 3.",
            "for Ordered(south_to_north, of EveryNth(3, south, of Rows(3, 3))) given: [picture]",
        ),
        (
            "Photograph the 4th, 8th and 12th tree of row 3 and of row 7.",
            "for UnionOf(InRow(4, 4, of UnionOf(Rows(3, 3)+Rows(7, 7)))+InRow(8, 8, of UnionOf(Rows(3, 3)+Rows(7, 7)))+InRow(12, 12, of UnionOf(Rows(3, 3)+Rows(7, 7)))): [picture]",
        ),
        (
            "Photograph the three northernmost trees of rows 2 and 4 each.",
            "for UnionOf(Extreme(north, 3, of Rows(2, 2))+Extreme(north, 3, of Rows(4, 4))): [picture]",
        ),
        (
            "Photograph the yellow trees, the ones in the wet corner excepted.",
            "for Excluding(InZone(wet corner), of Where(leaf_color, eq, yellow)): [picture]",
        ),
        (
            "Photograph the trees of rows 9 and 10 that don't stand in the wet corner.",
            "for Excluding(InZone(wet corner), of UnionOf(Rows(9, 9)+Rows(10, 10))): [picture]",
        ),
        ("Photograph all rows but row 2.", "for Excluding(Rows(2, 2), of Rows): [picture]"),
        ("Photograph the second half of row 2.", "for InRow(-9, -1, of Rows(2, 2)): [picture]"),
        (
            "Photograph the first three trees of row 2, counted from the south.",
            "for InRow(1, 3, south, of Rows(2, 2)): [picture]",
        ),
        (
            "Photograph the first three trees, counted from the south, of row 2.",
            "for InRow(1, 3, south, of Rows(2, 2)): [picture]",
        ),
        (
            "Photograph the third, fifth and last tree of row 3.",
            "for UnionOf(InRow(3, 3, of Rows(3, 3))+InRow(5, 5, of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the first two and the last two trees of row 3.",
            "for UnionOf(InRow(1, 2, of Rows(3, 3))+InRow(-2, -1, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the second tree from each end of row 3.",
            "for UnionOf(InRow(2, 2, of Rows(3, 3))+InRow(-2, -2, of Rows(3, 3))): [picture]",
        ),
        ("Photograph the second tree from the end of row 3.", "picture @ InRow(-2, -2, of Rows(3, 3))"),
        ("Photograph the two trees at the northern end of row 3.", "for InRow(1, 2, north, of Rows(3, 3)): [picture]"),
        (
            "Photograph the last three yellow trees in row 3.",
            "for InRow(-3, -1, of Where(leaf_color, eq, yellow, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the first tree in row 3 that is yellow.",
            "picture @ InRow(1, 1, of Where(leaf_color, eq, yellow, of Rows(3, 3)))",
        ),
        (
            "In row 3, photograph the first and the last tree.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3))): [picture]",
        ),
        ("In row 3 photograph the first three trees.", "for InRow(1, 3, of Rows(3, 3)): [picture]"),
        ("Photograph the three last trees in row 3.", "for InRow(-3, -1, of Rows(3, 3)): [picture]"),
        ("Photograph row 3 from the fifth tree to the end.", "for InRow(5, -1, of Rows(3, 3)): [picture]"),
        ("Photograph the trees of row 3 from the fifth tree on.", "for InRow(5, -1, of Rows(3, 3)): [picture]"),
        ("Photograph every tree of row 3 from the fifth to the tenth.", "for InRow(5, 10, of Rows(3, 3)): [picture]"),
        ("Photograph the fifth to tenth trees of row 3.", "for InRow(5, 10, of Rows(3, 3)): [picture]"),
        ("Photograph tree 3 to tree 6 of row 2.", "for InRow(3, 6, of Rows(2, 2)): [picture]"),
        ("Photograph trees 3 to 6 of rows 2 and 4.", "for InRow(3, 6, of UnionOf(Rows(2, 2)+Rows(4, 4))): [picture]"),
        ("Photograph trees 3 to 6 in each row.", "for InRow(3, 6, of Rows): [picture]"),
        ("Photograph tree number 3 of row 2.", "picture @ InRow(3, 3, of Rows(2, 2))"),
        (
            "Photograph the trees 3, 5 and 7 of row 2.",
            "for UnionOf(InRow(3, 3, of Rows(2, 2))+InRow(5, 5, of Rows(2, 2))+InRow(7, 7, of Rows(2, 2))): [picture]",
        ),
        (
            "Photograph trees 3 and 5 from the south in row 2.",
            "for UnionOf(InRow(3, 3, south, of Rows(2, 2))+InRow(5, 5, south, of Rows(2, 2))): [picture]",
        ),
        (
            "Photograph the first and last trees of rows 2, 3 and 4.",
            "for UnionOf(InRow(1, 1, of UnionOf(Rows(2, 2)+Rows(3, 3)+Rows(4, 4)))+InRow(-1, -1, of UnionOf(Rows(2, 2)+Rows(3, 3)+Rows(4, 4)))): [picture]",
        ),
        (
            "Photograph the first, the middle and the last tree of row 3.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+Middle(of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the first, middle and last tree of rows 2 and 5.",
            "for UnionOf(InRow(1, 1, of Rows(2, 2))+Middle(of Rows(2, 2))+InRow(-1, -1, of Rows(2, 2))+InRow(1, 1, of Rows(5, 5))+Middle(of Rows(5, 5))+InRow(-1, -1, of Rows(5, 5))): [picture]",
        ),
        (
            "Photograph the beginning, the middle and the end of row 3.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+Middle(of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3))): [picture]",
        ),
        ("Photograph the middle five trees of row 3.", "for InRow(8, 12, of Rows(3, 3)): [picture]"),
        ("Photograph the five middle trees of row 3.", "for InRow(8, 12, of Rows(3, 3)): [picture]"),
        ("Photograph the five trees in the middle of row 3.", "for InRow(8, 12, of Rows(3, 3)): [picture]"),
        (
            "Photograph row 3's first tree and row 4's last tree.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(-1, -1, of Rows(4, 4))): [picture]",
        ),
        (
            "Photograph the ends of rows 2 to 4.",
            "for UnionOf(InRow(1, 1, of Rows(2, 4))+InRow(-1, -1, of Rows(2, 4))): [picture]",
        ),
        ("Photograph both ends of every row.", "for UnionOf(InRow(1, 1, of Rows)+InRow(-1, -1, of Rows)): [picture]"),
        (
            "Photograph each end of row 3.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3))): [picture]",
        ),
        ("Photograph the north end of every row.", "for InRow(1, 1, north, of Rows): [picture]"),
        (
            "Photograph the north and the south end of row 3.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the northern and southern ends of row 3.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3))): [picture]",
        ),
        ("Photograph the first tree at the north end of row 3.", "picture @ InRow(1, 1, north, of Rows(3, 3))"),
        ("Photograph the last but one tree of row 3.", "picture @ InRow(-2, -2, of Rows(3, 3))"),
        ("Photograph the next to last tree of row 3.", "picture @ InRow(-2, -2, of Rows(3, 3))"),
        (
            "Photograph the first tree of row 3 and the third one.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(3, 3, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the 4th and 8th trees in rows 3 and 7.",
            "for UnionOf(InRow(4, 4, of UnionOf(Rows(3, 3)+Rows(7, 7)))+InRow(8, 8, of UnionOf(Rows(3, 3)+Rows(7, 7)))): [picture]",
        ),
        (
            "Photograph row 3: the first, the fifth and the last tree.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(5, 5, of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3))): [picture]",
        ),
        ("Photograph row 3, first five trees.", "for InRow(1, 5, of Rows(3, 3)): [picture]"),
        ("Photograph row 3, the first five trees.", "for InRow(1, 5, of Rows(3, 3)): [picture]"),
        ("Row 3, last five trees: a picture of each.", "for InRow(-5, -1, of Rows(3, 3)): [picture]"),
        ("Photograph the first half dozen trees of row 3.", "for InRow(1, 6, of Rows(3, 3)): [picture]"),
        (
            "Photograph the first five and the last tree of rows 2 and 3.",
            "for UnionOf(InRow(1, 5, of UnionOf(Rows(2, 2)+Rows(3, 3)))+InRow(-1, -1, of UnionOf(Rows(2, 2)+Rows(3, 3)))): [picture]",
        ),
        (
            "Photograph the fifth tree from the south in row 3 and in row 4.",
            "for InRow(5, 5, south, of UnionOf(Rows(3, 3)+Rows(4, 4))): [picture]",
        ),
        (
            "Photograph the fifth tree, counted from the south, in each row.",
            "for InRow(5, 5, south, of Rows): [picture]",
        ),
        ("Photograph in each row the first tree.", "for InRow(1, 1, of Rows): [picture]"),
        (
            "Photograph in every row the second and the fourth tree.",
            "for UnionOf(InRow(2, 2, of Rows)+InRow(4, 4, of Rows)): [picture]",
        ),
        ("Photograph all trees except 4, 5 and 6.", "for Excluding(UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6))): [picture]"),
        (
            "Photograph trees 4 to 9 but not 6.",
            "for Excluding(TreeIs(6), of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)+TreeIs(9))): [picture]",
        ),
        (
            "Photograph trees 4 to 9 except trees 6 and 7.",
            "for Excluding(UnionOf(TreeIs(6)+TreeIs(7)), of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)+TreeIs(9))): [picture]",
        ),
        (
            "Photograph all trees of row 3 except the first and the last.",
            "for Excluding(UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3))), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph row 3 except the yellow trees.",
            "for Excluding(Where(leaf_color, eq, yellow), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph row 3, the yellow ones excepted.",
            "for Excluding(Where(leaf_color, eq, yellow), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph row 3 except those that are yellow.",
            "for Excluding(Where(leaf_color, eq, yellow), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph row 3 except any that are yellow.",
            "for Excluding(Where(leaf_color, eq, yellow), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph row 3 except the ones older than 8 years.",
            "for Excluding(Where(age_years, gt, 8), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph row 3 except where it is yellow.",
            "for Excluding(Where(leaf_color, eq, yellow), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph row 3 except the ones in the wet corner.",
            "for Excluding(InZone(wet corner), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph row 3 save for its last tree.",
            "for Excluding(InRow(-1, -1, of Rows(3, 3)), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph every yellow tree except the oldest.",
            "for Excluding(Top(age_years, 1, of Where(leaf_color, eq, yellow)), of Where(leaf_color, eq, yellow)): [picture]",
        ),
        (
            "Photograph every yellow tree except the oldest one.",
            "for Excluding(Top(age_years, 1, of Where(leaf_color, eq, yellow)), of Where(leaf_color, eq, yellow)): [picture]",
        ),
        (
            "Photograph every yellow tree but the one nearest to the charger.",
            "for Excluding(Nearest(Marker(charger), of Where(leaf_color, eq, yellow)), of Where(leaf_color, eq, yellow)): [picture]",
        ),
        (
            "Photograph the yellow trees except the three nearest to the charger.",
            "for Excluding(Nearest(Marker(charger), 3, of Where(leaf_color, eq, yellow)), of Where(leaf_color, eq, yellow)): [picture]",
        ),
        (
            "Photograph the northern half except rows 2 and 3.",
            "for Excluding(UnionOf(Rows(2, 2)+Rows(3, 3)), of Half(north)): [picture]",
        ),
        (
            "Photograph the northern half without the wet corner.",
            "for Excluding(InZone(wet corner), of Half(north)): [picture]",
        ),
        ("Photograph all except the northern half.", "for Excluding(Half(north)): [picture]"),
        ("Photograph everything except row 2.", "for Excluding(Rows(2, 2)): [picture]"),
        ("Photograph everything but the yellow trees.", "for Excluding(Where(leaf_color, eq, yellow)): [picture]"),
        ("Photograph all rows except 2 and 4.", "for Excluding(UnionOf(Rows(2, 2)+Rows(4, 4)), of Rows): [picture]"),
        (
            "Photograph all rows but the first and the last.",
            "for Excluding(UnionOf(Rows(1, 1)+Rows(-1, -1)), of Rows): [picture]",
        ),
        ("Photograph each row except row 2.", "for Excluding(Rows(2, 2), of Rows): [picture]"),
        ("Photograph rows 2 to 6 except row 4.", "for Excluding(Rows(4, 4), of Rows(2, 6)): [picture]"),
        ("Photograph rows 2 to 6, not 4.", "for Excluding(Rows(4, 4), of Rows(2, 6)): [picture]"),
        ("Photograph any tree but tree 12.", "picture @ Take(1, of Excluding(TreeIs(12)))"),
        (
            "Photograph any three trees except tree 12 and tree 13.",
            "for Take(3, of Excluding(UnionOf(TreeIs(12)+TreeIs(13)))): [picture]",
        ),
        (
            "Photograph five random trees outside the wet corner.",
            "for RandomSample(5, of InZone(wet corner, True)): [picture]",
        ),
        (
            "Photograph the trees in row 3 not older than 8 years.",
            "for Where(age_years, le, 8, of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph every tree that is neither yellow nor pale green.",
            "for Where(leaf_color, ne, pale green, of Where(leaf_color, ne, yellow)): [picture]",
        ),
        ("Photograph the trees in row 3 other than tree 40.", "for Excluding(TreeIs(40), of Rows(3, 3)): [picture]"),
        ("Photograph the corners except the north-east one.", "for Excluding(Corners(ne), of Corners): [picture]"),
        ("Photograph all four corners but the north-east corner.", "for Excluding(Corners(ne), of Corners): [picture]"),
        (
            "Photograph the first tree of each row except row 2.",
            "for Excluding(Rows(2, 2), of InRow(1, 1, of Rows)): [picture]",
        ),
        (
            "Photograph the first tree of every row except rows 2 and 4.",
            "for Excluding(UnionOf(Rows(2, 2)+Rows(4, 4)), of InRow(1, 1, of Rows)): [picture]",
        ),
        (
            "Photograph the first tree of all rows but the last one.",
            "for InRow(1, 1, of Excluding(Rows(-1, -1), of Rows)): [picture]",
        ),
        (
            "Photograph the trees of rows 9 and 10 that do not stand in the wet corner.",
            "for Excluding(InZone(wet corner), of UnionOf(Rows(9, 9)+Rows(10, 10))): [picture]",
        ),
        (
            "Photograph the trees of rows 9 and 10 that are not in the wet corner.",
            "for Excluding(InZone(wet corner), of UnionOf(Rows(9, 9)+Rows(10, 10))): [picture]",
        ),
        (
            "Photograph the trees of rows 9 and 10 which don't stand in the wet corner.",
            "for Excluding(InZone(wet corner), of UnionOf(Rows(9, 9)+Rows(10, 10))): [picture]",
        ),
        (
            "Photograph the trees of row 9 not standing in the wet corner.",
            "for Excluding(InZone(wet corner), of Rows(9, 9)): [picture]",
        ),
        (
            "Photograph the trees of row 9 that stand outside the wet corner.",
            "for InZone(wet corner, True, of Rows(9, 9)): [picture]",
        ),
        ("Photograph two of the yellow trees.", "for Take(2, of Where(leaf_color, eq, yellow)): [picture]"),
        (
            "Photograph any two of trees 4, 5 and 6.",
            "for Take(2, of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6))): [picture]",
        ),
        (
            "Photograph at most two of trees 4, 5 and 6.",
            "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)) at most 2: [picture]",
        ),
        ("Photograph one of trees 4, 5 and 6.", "picture @ Take(1, of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)))"),
        ("Photograph one of the corners.", "picture @ Take(1, of Corners)"),
        ("Photograph the first of trees 4, 5 and 6.", "picture @ Nth(1, of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)))"),
        (
            "Photograph the last two of trees 4, 5 and 6.",
            "for UnionOf(Nth(-2, of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)))+Nth(-1, of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)))): [picture]",
        ),
        (
            "Photograph the oldest of trees 4, 5 and 6.",
            "picture @ Top(age_years, 1, of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)))",
        ),
        (
            "Photograph the two oldest of trees 4, 5 and 6.",
            "for Top(age_years, 2, of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6))): [picture]",
        ),
        ("Photograph the oldest of the yellow trees.", "picture @ Top(age_years, 1, of Where(leaf_color, eq, yellow))"),
        (
            "Photograph the three oldest of the yellow trees in row 3.",
            "for Top(age_years, 3, of Where(leaf_color, eq, yellow, of Rows(3, 3))): [picture]",
        ),
        ("Photograph the five oldest of the trees in row 2.", "for Top(age_years, 5, of Rows(2, 2)): [picture]"),
        (
            "Photograph the nearest of the yellow trees to the charger.",
            "picture @ Nearest(Marker(charger), of Where(leaf_color, eq, yellow))",
        ),
        (
            "Photograph whichever of the yellow trees is nearest to the charger.",
            "picture @ Nearest(Marker(charger), of Where(leaf_color, eq, yellow))",
        ),
        (
            "Photograph the northernmost of the yellow trees.",
            "picture @ Extreme(north, of Where(leaf_color, eq, yellow))",
        ),
        ("Photograph three random ones of the trees in row 3.", "for RandomSample(3, of Rows(3, 3)): [picture]"),
        ("Photograph three of the trees in row 3 at random.", "for RandomSample(3, of Rows(3, 3)): [picture]"),
        (
            "Photograph three of the yellow trees, chosen at random.",
            "for RandomSample(3, of Where(leaf_color, eq, yellow)): [picture]",
        ),
        ("Photograph every other one of the trees in row 3.", "for EveryNth(2, of Rows(3, 3)): [picture]"),
        ("Photograph every second of the trees in row 3.", "for EveryNth(2, of Rows(3, 3)): [picture]"),
        ("Photograph the first half of row 2.", "for InRow(1, 9, of Rows(2, 2)): [picture]"),
        ("Photograph the last third of row 2.", "for InRow(-6, -1, of Rows(2, 2)): [picture]"),
        (
            "Photograph the yellow trees, but only those in row 3.",
            "for Where(leaf_color, eq, yellow, of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph the yellow trees, only the ones in row 3.",
            "for Where(leaf_color, eq, yellow, of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph the trees of row 3, only the yellow ones.",
            "for Where(leaf_color, eq, yellow, of Rows(3, 3)): [picture]",
        ),
        ("Photograph row 3, but only the yellow ones.", "for Where(leaf_color, eq, yellow, of Rows(3, 3)): [picture]"),
        ("Photograph row 3, only the yellow trees.", "for Where(leaf_color, eq, yellow, of Rows(3, 3)): [picture]"),
        ("Photograph only the yellow trees of row 3.", "for Where(leaf_color, eq, yellow, of Rows(3, 3)): [picture]"),
        (
            "Photograph the first tree of row 3 and the third.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(3, 3, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the first tree of row 3 and the last two.",
            "for UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(-2, -1, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the oldest tree in row 3 and the youngest.",
            "for UnionOf(Top(age_years, 1, of Rows(3, 3))+Top(age_years, 1, True, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the yellow trees in row 3, the three oldest ones.",
            "for Top(age_years, 3, of Where(leaf_color, eq, yellow, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the yellow trees, the three nearest to the charger.",
            "for Nearest(Marker(charger), 3, of Where(leaf_color, eq, yellow)): [picture]",
        ),
        (
            "Photograph the yellow trees nearest to the charger, three of them.",
            "for Nearest(Marker(charger), 3, of Where(leaf_color, eq, yellow)): [picture]",
        ),
        (
            "Photograph the yellow trees, three of them, nearest to the charger.",
            "for Nearest(Marker(charger), 3, of Where(leaf_color, eq, yellow)): [picture]",
        ),
        ("Photograph the tree before tree 20.", "picture @ AlongRow(1, up, TreeIs(20))"),
        ("Photograph the tree after tree 20.", "picture @ AlongRow(1, TreeIs(20))"),
        (
            "Photograph the tree before tree 20 and the one after it.",
            "for UnionOf(AlongRow(1, up, TreeIs(20))+AlongRow(1, TreeIs(20))): [picture]",
        ),
        (
            "Photograph tree 20, the one before it and the one after it.",
            "picture @ TreeIs(20); for UnionOf(AlongRow(1, up)+AlongRow(1)): [picture]",
        ),
        (
            "Photograph tree 20 and the trees before and after it.",
            "for UnionOf(TreeIs(20)+AlongRow(1, up, TreeIs(20))+AlongRow(1, TreeIs(20))): [picture]",
        ),
        (
            "Photograph the trees before and after tree 20.",
            "for UnionOf(AlongRow(1, up, TreeIs(20))+AlongRow(1, TreeIs(20))): [picture]",
        ),
        (
            "Photograph the nearest tree to the charger that is yellow.",
            "picture @ Nearest(Marker(charger), of Where(leaf_color, eq, yellow))",
        ),
        ("Photograph the oldest tree that is yellow.", "picture @ Top(age_years, 1, of Where(leaf_color, eq, yellow))"),
        (
            "Photograph five trees at random that are older than 8 years.",
            "for RandomSample(5, of Where(age_years, gt, 8)): [picture]",
        ),
        (
            "Photograph five random trees older than 8 years.",
            "for RandomSample(5, of Where(age_years, gt, 8)): [picture]",
        ),
        ("Photograph the oldest tree which stands in row 3.", "picture @ Top(age_years, 1, of Rows(3, 3))"),
        (
            "Photograph the trees which stand nearest to the charger, five of them.",
            "for Nearest(Marker(charger), 5): [picture]",
        ),
        (
            "Photograph every third tree of row 3 from south to north.",
            "for Ordered(south_to_north, of EveryNth(3, south, of Rows(3, 3))) given: [picture]",
        ),
        (
            "Photograph every third tree in row 3, starting from the south.",
            "for Ordered(south_to_north, of EveryNth(3, south, of Rows(3, 3))) given: [picture]",
        ),
        (
            "Photograph row 3, every third tree, from the south.",
            "for Ordered(south_to_north, of EveryNth(3, south, of Rows(3, 3))) given: [picture]",
        ),
        (
            "Photograph every third tree of rows 2 and 4, beginning with the second.",
            "for EveryNth(3, 2, of UnionOf(Rows(2, 2)+Rows(4, 4))): [picture]",
        ),
        (
            "Photograph every third tree, beginning with the second, of rows 2 and 4.",
            "for EveryNth(3, 2, of UnionOf(Rows(2, 2)+Rows(4, 4))): [picture]",
        ),
        (
            "Photograph, in row 3, every third tree beginning with the second.",
            "for EveryNth(3, 2, of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph one tree in every row.",
            "for Quota(row, 1, of Rows): [picture]",
        ),
        (
            "Photograph one random tree in every row.",
            "for Quota(row, 1, random, of Rows): [picture]",
        ),
        (
            "Photograph the oldest tree of every row but the last.",
            "for UnionOf(Top(age_years, 1, of Rows(1, 1))+Top(age_years, 1, of Rows(2, 2))+Top(age_years, 1, of Rows(3, 3))+Top(age_years, 1, of Rows(4, 4))+Top(age_years, 1, of Rows(5, 5))+Top(age_years, 1, of Rows(6, 6))+Top(age_years, 1, of Rows(7, 7))+Top(age_years, 1, of Rows(8, 8))+Top(age_years, 1, of Rows(9, 9))): [picture]",
        ),
        (
            "Photograph tree 40. Photograph the rest of the row.",
            "picture @ TreeIs(40); for Excluding(TreeIs(40), of RowOf): [picture]",
        ),
        (
            "Photograph the yellow trees in rows 2 and 4 except the oldest one.",
            "for Excluding(Top(age_years, 1, of Where(leaf_color, eq, yellow, of UnionOf(Rows(2, 2)+Rows(4, 4)))), of Where(leaf_color, eq, yellow, of UnionOf(Rows(2, 2)+Rows(4, 4)))): [picture]",
        ),
        (
            "Photograph the first yellow tree of each row.",
            "for InRow(1, 1, of Where(leaf_color, eq, yellow, of Rows)): [picture]",
        ),
        ("Photograph the last tree of every second row.", "for InRow(-1, -1, of Rows(2)): [picture]"),
        (
            "Photograph every tree aged over 8 in row 3 but not those in the wet corner.",
            "for Excluding(InZone(wet corner), of Where(age_years, gt, 8, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the trees between 5 and 10 years old in rows 2 to 4, the three nearest to the charger.",
            "for Nearest(Marker(charger), 3, of Where(age_years, le, 10, of Where(age_years, ge, 5, of Rows(2, 4)))): [picture]",
        ),
        (
            "Photograph the oldest yellow tree of row 3 and the youngest.",
            "for UnionOf(Top(age_years, 1, of Where(leaf_color, eq, yellow, of Rows(3, 3)))+Top(age_years, 1, True, of Where(leaf_color, eq, yellow, of Rows(3, 3)))): [picture]",
        ),
        (
            "Photograph the two trees at each end of row 3.",
            "for UnionOf(InRow(1, 2, of Rows(3, 3))+InRow(-2, -1, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the two outermost trees of rows 2 and 3.",
            "for UnionOf(InRow(1, 1, of UnionOf(Rows(2, 2)+Rows(3, 3)))+InRow(-1, -1, of UnionOf(Rows(2, 2)+Rows(3, 3)))): [picture]",
        ),
        (
            "Photograph the second and third trees from the north in row 4.",
            "for UnionOf(InRow(2, 2, north, of Rows(4, 4))+InRow(3, 3, north, of Rows(4, 4))): [picture]",
        ),
        (
            "Photograph trees 2, 4 and 6 of rows 3, 5 and 7.",
            "for UnionOf(InRow(2, 2, of UnionOf(Rows(3, 3)+Rows(5, 5)+Rows(7, 7)))+InRow(4, 4, of UnionOf(Rows(3, 3)+Rows(5, 5)+Rows(7, 7)))+InRow(6, 6, of UnionOf(Rows(3, 3)+Rows(5, 5)+Rows(7, 7)))): [picture]",
        ),
        ("Photograph row 4, the last three trees.", "for InRow(-3, -1, of Rows(4, 4)): [picture]"),
        (
            "Photograph the first three trees of the northern half of row 4.",
            "for InRow(1, 3, of InRow(1, 9, north, of Rows(4, 4))): [picture]",
        ),
        (
            "Photograph two random trees in each of rows 2, 3 and 4.",
            "for Quota(row, 2, random, of UnionOf(Rows(2, 2)+Rows(3, 3)+Rows(4, 4))): [picture]",
        ),
        (
            "Photograph any tree of row 3 except the first.",
            "picture @ Take(1, of Excluding(InRow(1, 1, of Rows(3, 3)), of Rows(3, 3)))",
        ),
        (
            "Photograph any three trees in row 3 that are not yellow.",
            "for Take(3, of Where(leaf_color, ne, yellow, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph five trees in row 3 that are older than 8 years, chosen at random.",
            "for RandomSample(5, of Where(age_years, gt, 8, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph every other tree of row 3 that is not yellow.",
            "for Where(leaf_color, ne, yellow, of EveryNth(2, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the tree nearest to the charger in each row.",
            "for UnionOf(Nearest(Marker(charger), of Rows(1, 1))+Nearest(Marker(charger), of Rows(2, 2))+Nearest(Marker(charger), of Rows(3, 3))+Nearest(Marker(charger), of Rows(4, 4))+Nearest(Marker(charger), of Rows(5, 5))+Nearest(Marker(charger), of Rows(6, 6))+Nearest(Marker(charger), of Rows(7, 7))+Nearest(Marker(charger), of Rows(8, 8))+Nearest(Marker(charger), of Rows(9, 9))+Nearest(Marker(charger), of Rows(10, 10))): [picture]",
        ),
        (
            "Photograph the trees in the wet corner, only the yellow ones.",
            "for Where(leaf_color, eq, yellow, of InZone(wet corner)): [picture]",
        ),
        (
            "Photograph all trees but the ones in rows 2 and 4.",
            "for Excluding(UnionOf(Rows(2, 2)+Rows(4, 4))): [picture]",
        ),
        ("Photograph the corners, but not the south-west one.", "for Excluding(Corners(sw), of Corners): [picture]"),
        (
            "Photograph the trees of row 3 without the first two and the last two.",
            "for Excluding(UnionOf(InRow(1, 2, of Rows(3, 3))+InRow(-2, -1, of Rows(3, 3))), of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph the northernmost and the southernmost tree of rows 2 to 4.",
            "for UnionOf(Extreme(north, of Rows(2, 4))+Extreme(south, of Rows(2, 4))): [picture]",
        ),
        (
            "Photograph the oldest of the yellow trees in the northern half.",
            "picture @ Top(age_years, 1, of Where(leaf_color, eq, yellow, of Half(north)))",
        ),
        ("Photograph one of the three oldest trees.", "picture @ Take(1, of Top(age_years, 3))"),
        (
            "Photograph the two youngest of the ten trees nearest to the charger.",
            "for Top(age_years, 2, True, of Nearest(Marker(charger), 10)): [picture]",
        ),
        (
            "Photograph two of the ten oldest trees, chosen at random.",
            "for RandomSample(2, of Top(age_years, 10)): [picture]",
        ),
        (
            "Photograph the third oldest of the yellow trees.",
            "picture @ Top(age_years, 1, of Excluding(Top(age_years, 2, of Where(leaf_color, eq, yellow)), of Where(leaf_color, eq, yellow)))",
        ),
        (
            "Photograph the tree after tree 20 and the one before.",
            "for UnionOf(AlongRow(1, TreeIs(20))+AlongRow(1, up, TreeIs(20))): [picture]",
        ),
        (
            "Photograph the trees in row 3 which are neither yellow nor older than 8 years.",
            "for Where(age_years, le, 8, of Where(leaf_color, ne, yellow, of Rows(3, 3))): [picture]",
        ),
        (
            "Photograph the trees that are yellow and in row 3.",
            "for Where(leaf_color, eq, yellow, of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph the trees that stand in row 3 and are older than 8 years.",
            "for Where(age_years, gt, 8, of Rows(3, 3)): [picture]",
        ),
        ("Photograph the trees of row 3 aged 8 or more.", "for Where(age_years, ge, 8, of Rows(3, 3)): [picture]"),
        (
            "Photograph the trees of row 3 more than 8 years old.",
            "for Where(age_years, gt, 8, of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph the trees of row 3 with a yield of 6 kg or more.",
            "for Where(yield_kg, ge, 6, of Rows(3, 3)): [picture]",
        ),
        (
            "Photograph trees with 6 to 8 kg of yield.",
            "for Where(yield_kg, le, 8, of Where(yield_kg, ge, 6)): [picture]",
        ),
        ("Photograph the odd trees of row 3.", "for EveryNth(2, of Rows(3, 3)): [picture]"),
        ("Photograph the even-numbered trees in row 3.", "for EveryNth(2, 2, of Rows(3, 3)): [picture]"),
        ("Photograph every third tree in every second row.", "for EveryNth(3, of Rows(2)): [picture]"),
        (
            "Photograph all trees neither in row 2 nor in row 3.",
            "for Excluding(Rows(3, 3), of Excluding(Rows(2, 2))): [picture]",
        ),
        (
            "Photograph the trees inside the wet corner, and any three trees outside it.",
            "for UnionOf(InZone(wet corner)+Take(3, of InZone(wet corner, True))): [picture]",
        ),
        (
            "Measure CO2 at all trees inside the wet corner, and at any three trees outside it.",
            "for UnionOf(InZone(wet corner)+Take(3, of InZone(wet corner, True))): [co2]",
        ),
        (
            "Photograph every other tree in row 9, starting with the one at the north end.",
            "for Ordered(north_to_south, of EveryNth(2, north, of Rows(9, 9))) given: [picture]",
        ),
        (
            "Photograph all trees in row 3 bar the first.",
            "for Excluding(InRow(1, 1, of Rows(3, 3)), of Rows(3, 3)): [picture]",
        ),
        ("Photograph every tree excepting the yellow ones.", "for Excluding(Where(leaf_color, eq, yellow)): [picture]"),
    ],
    "vineyard": [
        (
            "Take a picture at the first, middle and last vine of row 12 of the North block.",
            "for UnionOf(InRow(1, 1, of Rows(12, 12, of InBlock(North)))+Middle(of Rows(12, 12, of InBlock(North)))+InRow(-1, -1, of Rows(12, 12, of InBlock(North)))): [picture] | return_to_start",
        ),
        (
            "Photograph the first and the last vine in row 12 of the North block.",
            "for UnionOf(InRow(1, 1, of Rows(12, 12, of InBlock(North)))+InRow(-1, -1, of Rows(12, 12, of InBlock(North)))): [picture] | return_to_start",
        ),
        (
            "Photograph vines 4 to 9, counted from the north, in row 3 of the North block.",
            "for InRow(4, 9, north, of Rows(3, 3, of InBlock(North))): [picture] | return_to_start",
        ),
        (
            "Take a picture along row 11 of the North block, every tenth vine, starting with the first vine at the north end.",
            "for Ordered(north_to_south, of EveryNth(10, north, of Rows(11, 11, of InBlock(North)))) given: [picture] | return_to_start",
        ),
        (
            "Take a picture at the vine at each end of the easternmost row of the South block.",
            "for UnionOf(InRow(1, 1, of Rows(1, 1, east, of InBlock(South)))+InRow(-1, -1, of Rows(1, 1, east, of InBlock(South)))): [picture] | return_to_start",
        ),
        (
            "Of all the vines we have, photograph the one farthest west and the one farthest east.",
            "for UnionOf(Extreme(west)+Extreme(east)): [picture] | return_to_start",
        ),
        (
            "Photograph block South except row 4.",
            "for Excluding(Rows(4, 4, of InBlock(South)), of InBlock(South)): [picture] | return_to_start",
        ),
        (
            "Photograph the South block except rows 4 and 5.",
            "for Excluding(UnionOf(Rows(4, 4, of InBlock(South))+Rows(5, 5, of InBlock(South))), of InBlock(South)): [picture] | return_to_start",
        ),
        (
            "Photograph the South block except its first row.",
            "for Excluding(Rows(1, 1, of InBlock(South)), of InBlock(South)): [picture] | return_to_start",
        ),
        (
            "Photograph the South block without the Merlot.",
            "for Excluding(Where(variety, eq, Merlot), of InBlock(South)): [picture] | return_to_start",
        ),
        (
            "Photograph of all vines the westernmost and the easternmost.",
            "for UnionOf(Extreme(west)+Extreme(east)): [picture] | return_to_start",
        ),
        (
            "Photograph the westernmost and the easternmost of all the vines.",
            "for UnionOf(Extreme(west)+Extreme(east)): [picture] | return_to_start",
        ),
        (
            "Photograph the first five vines of rows 3 to 5 of the North block.",
            "for InRow(1, 5, of Rows(3, 5, of InBlock(North))): [picture] | return_to_start",
        ),
        (
            "Photograph rows 3 to 5 of the North block, the first five vines of each.",
            "for InRow(1, 5, of Rows(3, 5, of InBlock(North))): [picture] | return_to_start",
        ),
        (
            "Photograph the last vine of each row of the South block except row 4.",
            "for Excluding(Rows(4, 4, of InBlock(South)), of InRow(-1, -1, of Rows(of InBlock(South)))): [picture] | return_to_start",
        ),
        (
            "Photograph the Merlot in rows 2 and 4 of the North block.",
            "for Where(variety, eq, Merlot, of UnionOf(Rows(2, 2, of InBlock(North))+Rows(4, 4, of InBlock(North)))): [picture] | return_to_start",
        ),
        (
            "Photograph every tenth vine of row 11 of the North block, beginning at the north end.",
            "for Ordered(north_to_south, of EveryNth(10, north, of Rows(11, 11, of InBlock(North)))) given: [picture] | return_to_start",
        ),
        (
            "Photograph the third vine from the south end of row 11 of the North block.",
            "picture @ InRow(3, 3, south, of Rows(11, 11, of InBlock(North))) | return_to_start",
        ),
        (
            "In the South block, photograph the first and the last vine of every row.",
            "for UnionOf(InRow(1, 1, of Rows(of InBlock(South)))+InRow(-1, -1, of Rows(of InBlock(South)))): [picture] | return_to_start",
        ),
        (
            "Photograph row 4 of the South block except the first and the last ten vines.",
            "for Excluding(UnionOf(InRow(1, 1, of Rows(4, 4, of InBlock(South)))+InRow(-10, -1, of Rows(4, 4, of InBlock(South)))), of Rows(4, 4, of InBlock(South))): [picture] | return_to_start",
        ),
        (
            "Photograph both ends of rows 3 and 7 of the South block.",
            "for UnionOf(InRow(1, 1, of UnionOf(Rows(3, 3, of InBlock(South))+Rows(7, 7, of InBlock(South))))+InRow(-1, -1, of UnionOf(Rows(3, 3, of InBlock(South))+Rows(7, 7, of InBlock(South))))): [picture] | return_to_start",
        ),
        (
            "Of the Syrah, photograph the three with the lowest vigor.",
            "for Top(vigor, 3, True, of Where(variety, eq, Syrah)): [picture] | return_to_start",
        ),
        (
            "Photograph, of the Syrah, the three with the lowest vigor.",
            "for Top(vigor, 3, True, of Where(variety, eq, Syrah)): [picture] | return_to_start",
        ),
        (
            "In the North block, take the air temperature at the first vine of row 10, then of row 11, then of row 12.",
            "for UnionOf(InRow(1, 1, of Rows(10, 10, of InBlock(North)))+InRow(1, 1, of Rows(11, 11, of InBlock(North)))+InRow(1, 1, of Rows(12, 12, of InBlock(North)))) given: [air] | return_to_start",
        ),
    ],
}
#: Requests that leave open what is meant, and the number of answers; none if it has to be written.
ASKED = [
    ("demo", "Photograph the first tree of row 2, or the last.", 2),
    ("demo", "Photograph half of row 2.", 2),
    ("demo", "Row 3: photograph the trees of it.", 2),
    ("vineyard", "Photograph rows 2 and 4 of the Merlot.", 2),
    ("demo", "Photograph the tree at either end of row 3.", 2),
    ("demo", "Photograph the first or the last tree of row 2.", 2),
    ("demo", "Photograph tree 4 or tree 5.", 2),
    ("demo", "Photograph either tree 4 or tree 5.", 2),
    ("demo", "Photograph the oldest or the youngest tree in row 3.", 2),
    (
        "vineyard",
        "Take the air temperature at the first vine of row 10, then of row 11, then of row 12 of the North block.",
        2,
    ),
]
#: Requests that must not be planned: what they leave out or ask for cannot be said of trees, or may mean two things.
REFUSED = [
    "Photograph neither tree 4 nor tree 5.",
    "Photograph neither row 2 nor row 3.",
    "Photograph every third tree of row 3 except the last.",
    "Photograph the trees of row 3 that are not yellow and older than 8 years.",
    "Photograph the last row but one.",
    "Photograph row 3 starting with the fifth tree.",
    "Photograph the wet corner. Photograph any three trees outside it.",
    "Photograph row 3, not just 40.",
    "Photograph the first and end in row 3.",
    "Photograph all trees but two.",
    "Photograph the three first and last trees of row 3.",
]


def site_of(name: str) -> Site:
    return SITES[name]


@pytest.mark.parametrize(
    ("site", "request_", "plan"), [(site, *case) for site, cases in PLANNED.items() for case in cases]
)
def test_a_noun_phrase_means_the_same_in_any_order_of_its_words(site: str, request_: str, plan: str) -> None:
    outcome = composed(request_, site_of(site), HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert mismatches(outcome.task, site_of(site), HUSKY) == ()


@pytest.mark.parametrize(("site", "request_", "answers"), ASKED)
def test_an_open_noun_phrase_is_asked_about(site: str, request_: str, answers: int) -> None:
    outcome = composed(request_, site_of(site), HUSKY)
    assert isinstance(outcome, Clarify), outcome
    assert len(outcome.choices) == answers


@pytest.mark.parametrize("request_", REFUSED)
def test_what_is_no_place_is_not_planned(request_: str) -> None:
    assert isinstance(composed(request_, SITES["demo"], HUSKY), Refused)
