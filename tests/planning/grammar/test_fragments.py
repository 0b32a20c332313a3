"""Requests in fragments, telegram style: which places narrow each other, and what is captured where."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline
from planning.english.vineyards import vineyard

ORCHARD, HUSKY, AMIGA = open_site("demo"), load_robot("husky"), load_robot("amiga")
IN_ORCHARD = [
    ("Row 3. CO2. But not the first tree.", "for Excluding(InRow(1, 1, of Rows(3, 3)), of Rows(3, 3)): [co2]"),
    ("Row 6. Thermal. The whole thing. Then home.", "for Rows(6, 6): [picture] | return_to_start"),
    ("Row 6. All of it. Thermal.", "for Rows(6, 6): [picture]"),
    ("Row 6. All trees. Thermal.", "for Rows(6, 6): [picture]"),
    ("Row 6. Thermal pictures.", "for Rows(6, 6): [picture]"),
    ("Row 6. CO2. Every other tree.", "for EveryNth(2, of Rows(6, 6)): [co2]"),
    ("CO2. Row 6. Every other tree.", "for EveryNth(2, of Rows(6, 6)): [co2]"),
    ("Take CO2 in row 9. Every other tree.", "for EveryNth(2, of Rows(9, 9)): [co2]"),
    ("CO2, row 9, fifth tree from the north. Just that.", "co2 @ InRow(5, 5, north, of Rows(9, 9))"),
    ("Thermal pictures. Yellow trees. Northern half.", "for Where(leaf_color, eq, yellow, of Half(north)): [picture]"),
    ("Northern half. Yellow trees. Thermal.", "for Where(leaf_color, eq, yellow, of Half(north)): [picture]"),
    ("Southern half. Carmels. Oldest one. Picture.", "picture @ Top(age_years, 1, of Where(variety, eq, Carmel, of Half(south)))"),
    ("Yellow trees in row 3. CO2, thermal.", "for Where(leaf_color, eq, yellow, of Rows(3, 3)): [co2; picture]"),
    ("Wet corner: three trees: CO2", "for Take(3, of InZone(wet corner)): [co2]"),
    ("Wet corner. Five oldest trees. CO2.", "for Top(age_years, 5, of InZone(wet corner)): [co2]"),
    ("CO2: rows 2 and 3: every fourth tree", "for EveryNth(4, of UnionOf(Rows(2, 2)+Rows(3, 3))): [co2]"),
    ("Row 2. After that row 5. CO2 at every tree.", "for Rows(2, 2): [co2]; for Rows(5, 5): [co2]"),
    ("Row 3. Row 5. Thermal of every tree.", "for UnionOf(Rows(3, 3)+Rows(5, 5)): [picture]"),
    ("Row 4\nevery third tree\nCO2\nthen home", "for EveryNth(3, of Rows(4, 4)): [co2] | return_to_start"),
    ("row 4, north to south, every third tree, co2", "for Ordered(north_to_south, of EveryNth(3, north, of Rows(4, 4))) given: [co2]"),
    ("Row 3. At most 6 trees. Thermal.", "for Rows(3, 3) at most 6: [picture]"),
    ("Thermal. Row 3. At most 6 trees.", "for Rows(3, 3) at most 6: [picture]"),
    ("Thermal. Corners. Then home.", "for Corners: [picture] | return_to_start"),
    ("Tree 4. CO2. Tree 9. Picture.", "co2 @ TreeIs(4); picture @ TreeIs(9)"),
    ("CO2. Tree 4. Thermal. Tree 9.", "co2 @ TreeIs(4); picture @ TreeIs(9)"),
    ("Tree 4. CO2. Tree 9.", "co2 @ TreeIs(4); co2 @ TreeIs(9)"),
    ("Tree 4, tree 9, tree 12. CO2.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)): [co2]"),
    ("Tree 12. Tree 30. Tree 12. CO2.", "co2 @ TreeIs(12); co2 @ TreeIs(30); co2 @ TreeIs(12)"),
    ("CO2. Tree 12. Then tree 30. Then tree 12 again.", "co2 @ TreeIs(12); co2 @ TreeIs(30); co2 @ TreeIs(12)"),
    ("Charger. Air temp. Tree 4. CO2.", "air @ Marker(charger); co2 @ TreeIs(4)"),
    ("Tree 5. CO2. Above 500? Thermal.", "co2 @ TreeIs(5) = r1; if r1 > 500 ppm: [picture]"),
    ("Row 5. Trees 82 and 85. CO2.", "for UnionOf(TreeIs(82)+TreeIs(85)): [co2]"),
    ("Go to row 3. Every other tree. CO2.", "for EveryNth(2, of Rows(3, 3)): [co2]"),
    ("20 mins max. yellow trees. as many as u can. thermal", "for Where(leaf_color, eq, yellow) optional: [picture] | duration_s 1200"),
    ("Tree 4: CO2. Tree 9: CO2. In between, nothing.", "co2 @ TreeIs(4); co2 @ TreeIs(9)"),
    ("Row 6: first tree CO2. Last tree CO2.", "co2 @ InRow(1, 1, of Rows(6, 6)); co2 @ InRow(-1, -1, of Rows(6, 6))"),
    ("Wet corner. Row 9. CO2 at every tree.", "for UnionOf(InZone(wet corner)+Rows(9, 9)): [co2]"),
    ("Begin at the south end of row 9 and photograph every other tree", "for Ordered(south_to_north, of EveryNth(2, south, of Rows(9, 9))) given: [picture]"),
    ("Start at the south end of row 9. Photograph every tree.", "for Ordered(south_to_north, of Rows(9, 9)) given: [picture]"),
    ("Nonpareils, southern half. CO2 each.", "for Where(variety, eq, Nonpareil, of Half(south)): [co2]"),
    ("Trees 3, 6 and 9. Thermal photo each.", "for UnionOf(TreeIs(3)+TreeIs(6)+TreeIs(9)): [picture]"),
    ("Photograph trees 4 and 5. CO2 each.", "for UnionOf(TreeIs(4)+TreeIs(5)): [picture; co2]"),
    ("CO2 at every tree of row 9, minus any that lie inside the wet corner", "for Excluding(InZone(wet corner), of Rows(9, 9)): [co2]"),
    ("Rows 1 to 10, but the odd-numbered ones only: CO2 at every tree", "for Rows(1, 10, 2): [co2]"),
    ("To do, in this order:\n- tree 7: temp\n- tree 7: co2\n- tree 9: co2", "air @ TreeIs(7); co2 @ TreeIs(7); co2 @ TreeIs(9)"),
    ("You know the pond? The three trees sitting closest to it: air temp, please", "for Nearest(InZone(pond), 3): [air]"),
    ("Yellow trees, five of them, the ones nearest the charger: CO2", "for Nearest(Marker(charger), 5, of Where(leaf_color, eq, yellow)): [co2]"),
    ("Carmels, the three closest to the pond, a picture of each", "for Nearest(InZone(pond), 3, of Where(variety, eq, Carmel)): [picture]"),
    ("Northwest corner tree: pic. Southeast corner tree: pic. In between, nothing.", "picture @ Corners(nw); picture @ Corners(se)"),
]  # fmt: skip
BY_AMIGA = [
    ("Soil moisture, forty centimetres down, row 5, every other tree", "for EveryNth(2, of Rows(5, 5)): [moisture(depth_cm 40)]"),
]  # fmt: skip
IN_VINEYARD = [
    ("Block North. Rows 10 to 12. Every 12th vine. Air temp + CO2.", "for EveryNth(12, of Rows(10, 12, of InBlock(North))): [air; co2] | return_to_start"),
    ("North block - row 12 - every 10th vine - co2", "for EveryNth(10, of Rows(12, 12, of InBlock(North))): [co2] | return_to_start"),
    ("Block South, rows 3 and 5, first and last vine. CO2.", "for UnionOf(InRow(1, 1, of UnionOf(Rows(3, 3, of InBlock(South))+Rows(5, 5, of InBlock(South))))+InRow(-1, -1, of UnionOf(Rows(3, 3, of InBlock(South))+Rows(5, 5, of InBlock(South))))): [co2] | return_to_start"),
    ("Have a look at the north block, row 12. Every sixth vine, a picture of each, then go back", "for EveryNth(6, of Rows(12, 12, of InBlock(North))): [picture] | return_to_start"),
    ("Row 10 of block North. Vines 20 to 22, a picture of each.", "for InRow(20, 22, of Rows(10, 10, of InBlock(North))): [picture] | return_to_start"),
    ("Row 13 of block North, please. Oh, sorry, I meant row 10 of block North! Just vines 20 to 22, a picture of each", "for InRow(20, 22, of Rows(10, 10, of InBlock(North))): [picture] | return_to_start"),
    ("South block, row 13: first vine CO2, last vine CO2, nothing else, then back to where you started from", "co2 @ InRow(1, 1, of Rows(13, 13, of InBlock(South))); co2 @ InRow(-1, -1, of Rows(13, 13, of InBlock(South))) | return_to_start"),
    ("North. Row 11. Every vine. Thermal.", "for Rows(11, 11, of InBlock(North)): [picture] | return_to_start"),
    ("South block, row 13, vines 1 to 5, only the odd-numbered ones: infrared image.", "for UnionOf(InRow(1, 1, of Rows(13, 13, of InBlock(South)))+InRow(3, 3, of Rows(13, 13, of InBlock(South)))+InRow(5, 5, of Rows(13, 13, of InBlock(South)))): [picture] | return_to_start"),
    ("Merlot. Block North. Five vines. Thermal each.", "for Take(5, of Where(variety, eq, Merlot, of InBlock(North))): [picture] | return_to_start"),
    ("Row 13 of block North, please. Oh, sorry, I meant row 10! Just vines 20 to 22, a picture of each", "for InRow(20, 22, of Rows(10, 10, of InBlock(North))): [picture] | return_to_start"),
    ("Cabernet Sauvignon, eight of them, nearest the start, a thermal photo each", "for Nearest(Marker(start), 8, of Where(variety, eq, Cabernet Sauvignon)): [picture] | return_to_start"),
    ("South blk. Rows 10-12. 10th vine each, counted from north. CO2.", "for InRow(10, 10, north, of Rows(10, 12, of InBlock(South))): [co2] | return_to_start"),
]  # fmt: skip
#: What leaves open which of the places is meant, or what is captured at which.
OPEN = [
    "Row 6. Thermal. Then home.",
    "Rows 3 and 5. Picture.",
    "Row 6: northernmost tree CO2. Southernmost tree CO2.",
    "Row 5. CO2. Yellow trees. Thermal.",
    "Row 5. Every third tree. Row 7. CO2.",
    "Row 5. Row 7. Every third tree. CO2.",
    "CO2. Yellow trees. Thermal.",
    "Row 3. Northern half. Every tree. CO2.",
    "Yellow trees. Every third tree. Picture.",
    "Trees 4 and 5. Row 6. CO2.",
    "Row 6. Tree 3. CO2.",
    "Oldest tree. Yellow trees. CO2.",
    "Row 3. Every other tree. CO2. First tree. Thermal.",
    "Row 5. CO2. Tree 4.",
    "Tree 4. CO2. Thermal of every tree.",
    "CO2. All of it.",
    "CO2 at tree 4. Row 5.",
    "Row 9: CO2 at every tree. Then every other tree: thermal.",
    "Go to the last tree of row 3 and take CO2 at every third tree.",
    "CO2 each.",
    "Take a picture of tree 4. CO2 each.",
    "Row 6. The three trees closest to it: air temp.",
    "Third tree each: CO2",
    "Yellow trees. CO2. Northern half. Thermal.",
    "Tree 4, picture. Tree 9, nothing.",
    "Row 3. Two trees. Row 5. Three trees. CO2.",
    "Row 3. First tree. Last tree. CO2.",
    "Row 3, row 4. CO2 at the first tree.",
    "Tree 4. Tree 9. If hot, CO2.",
]  # fmt: skip
OPEN_IN_VINEYARD = [
    "CO2, row 10, fifth vine from the north. Just that.",
    "Block North. Block South. First vine. CO2.",
]  # fmt: skip


@pytest.mark.parametrize(("request_", "plan"), IN_ORCHARD)
def test_fragments_make_up_commands(request_: str, plan: str) -> None:
    outcome = composed(request_, ORCHARD, HUSKY)
    assert isinstance(outcome, Planned)
    assert outline(outcome.task) == plan


@pytest.mark.parametrize(("request_", "plan"), BY_AMIGA)
def test_parameters_are_fragments_as_well(request_: str, plan: str) -> None:
    outcome = composed(request_, ORCHARD, AMIGA)
    assert isinstance(outcome, Planned)
    assert outline(outcome.task) == plan


@pytest.mark.parametrize(("request_", "plan"), IN_VINEYARD)
def test_blocks_rows_and_vines_narrow_each_other(request_: str, plan: str) -> None:
    outcome = composed(request_, vineyard(), HUSKY)
    assert isinstance(outcome, Planned)
    assert outline(outcome.task) == plan


@pytest.mark.parametrize("request_", OPEN)
def test_fragments_that_fit_in_several_ways_are_not_guessed(request_: str) -> None:
    assert not isinstance(composed(request_, ORCHARD, HUSKY), Planned)


@pytest.mark.parametrize("request_", OPEN_IN_VINEYARD)
def test_rows_of_several_blocks_are_not_guessed(request_: str) -> None:
    assert not isinstance(composed(request_, vineyard(), HUSKY), Planned)
