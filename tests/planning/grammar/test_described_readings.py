"""Conditions on described readings, repetitions, limits and orders, in the wordings of many speakers."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

DEMO = open_site("demo")

#: Robot, request, and its plan in one line.
SAID: list[tuple[str, str, str]] = [
    (
        "husky",
        "Measure CO2 at the northernmost tree and then at the southernmost tree. If the northernmost reading is above 450 ppm, take a thermal picture of both.",
        "co2 @ Extreme(north) = r1; co2 @ Extreme(south); if r1 > 450 ppm: [for UnionOf(Extreme(north)+Extreme(south)): [picture]]",
    ),
    (
        "husky",
        "Measure CO2 at the northernmost tree and at the southernmost tree. If the southern one is high, photograph it.",
        "co2 @ Extreme(north); co2 @ Extreme(south) = r1; if r1 high: [picture]",
    ),
    (
        "husky",
        "Take CO2 at both ends of row 5. If the reading at the south end is high, photograph that tree.",
        "co2 @ InRow(1, 1, of Rows(5, 5)); co2 @ InRow(-1, -1, of Rows(5, 5)) = r1; if r1 high: [picture]",
    ),
    (
        "husky",
        "Get me a thermal picture of both end trees of row 5. If the one at the south end comes back over 38 degrees, shoot that one again.",
        "picture @ InRow(1, 1, of Rows(5, 5)); picture @ InRow(-1, -1, of Rows(5, 5)) = r1; if r1 > 38 degC: [picture]",
    ),
    (
        "husky",
        "Thermal picture of tree 4 and of tree 40. If tree 40's is above 38, CO2 there too.",
        "picture @ TreeIs(4); picture @ TreeIs(40) = r1; if r1 > 38 degC: [co2]",
    ),
    (
        "husky",
        "Thermal picture of tree 4 and of tree 40. If the reading at tree 4 is above 38, CO2 there.",
        "picture @ TreeIs(4) = r1; picture @ TreeIs(40); if r1 > 38 degC: [go TreeIs(4); co2]",
    ),
    (
        "husky",
        "Thermal picture of tree 4 and of tree 40. If the one at tree 4 is above 38, CO2 at tree 40.",
        "picture @ TreeIs(4) = r1; picture @ TreeIs(40); if r1 > 38 degC: [co2 @ TreeIs(40)]",
    ),
    (
        "husky",
        "Thermal picture of tree 4 and of tree 40. If the picture of tree 4 shows more than 38, CO2 at tree 40.",
        "picture @ TreeIs(4) = r1; picture @ TreeIs(40); if r1 > 38 degC: [co2 @ TreeIs(40)]",
    ),
    (
        "amiga",
        "Under the first and the last tree of row 6, measure soil moisture at 15 cm and again at 45 cm. If the 15 cm value is below 12 %, add a nitrate reading at the same depth.",
        "for UnionOf(InRow(1, 1, of Rows(6, 6))+InRow(-1, -1, of Rows(6, 6))): [moisture(depth_cm 15) = r1; moisture(depth_cm 45); if r1 < 12 percent: [nitrate(depth_cm 15)]]",
    ),
    (
        "amiga",
        "Soil moisture at 15 cm and at 45 cm at tree 4. If the 45 cm one is below 12 percent, take a leaf sample.",
        "moisture(depth_cm 15) @ TreeIs(4); moisture(depth_cm 45) = r1; if r1 < 12 percent: [sample_leaf]",
    ),
    (
        "amiga",
        "Soil moisture at 15 cm and at 45 cm at tree 4. If the reading at 45 cm is below 12 percent, take a leaf sample.",
        "moisture(depth_cm 15) @ TreeIs(4); moisture(depth_cm 45) = r1; if r1 < 12 percent: [sample_leaf]",
    ),
    (
        "husky",
        "At trees 4, 9 and 30 take CO2. Wherever it reads high, take a second one before moving on.",
        "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(30)): [co2 = r1; if r1 high: [co2]]",
    ),
    (
        "husky",
        "CO2 at tree 4. Reads low, forget the rest and come home; doesn't, then photograph tree 9.",
        "co2 @ TreeIs(4) = r1; if r1 low: [go Marker(start)] else [picture @ TreeIs(9)] | return_to_start",
    ),
    (
        "husky",
        "Photograph the trees of row 4 one by one; as soon as one image shows more than 38, finish there.",
        "for Rows(4, 4) until r1 > 38 degC: [picture = r1]",
    ),
    (
        "husky",
        "Photograph the trees of row 4. First one to top 39 C, take CO2 there and stop.",
        "for Rows(4, 4) until r1 > 39 degC: [picture = r1; if r1 > 39 degC: [co2]]",
    ),
    (
        "amiga",
        "Moisture at trees 4 to 9. Beneath twenty per cent is any? Leaf sample from that one. Otherwise nothing.",
        "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)+TreeIs(9)): [moisture = r1; if r1 < 20 percent: [sample_leaf]]",
    ),
    (
        "husky",
        "Air temperature at tree 4; if (and only if) it exceeds 35, CO2 as well.",
        "air @ TreeIs(4) = r1; if r1 > 35 degC: [co2]",
    ),
    (
        "husky",
        "Measure the air temperature at the first tree of rows 1, 2 and 3, but if one of the readings is over 35 degrees, stop there and come back.",
        "for InRow(1, 1, of UnionOf(Rows(1, 1)+Rows(2, 2)+Rows(3, 3))) until r1 > 35 degC: [air = r1] | return_to_start",
    ),
    (
        "amiga",
        "Moisture at tree 4. Is it under 15 percent, so take a leaf sample; is it not, then photograph the ground.",
        "moisture @ TreeIs(4) = r1; if r1 < 15 percent: [sample_leaf] else [picture(view ground)]",
    ),
    (
        "amiga",
        "Moisture at tree 4. Under 15 percent? Leaf sample. Not under? Picture of the ground.",
        "moisture @ TreeIs(4) = r1; if r1 < 15 percent: [sample_leaf] else [picture(view ground)]",
    ),
    ("husky", "Air at tree 4 over 35? Then CO2 at tree 9.", "air @ TreeIs(4) = r1; if r1 > 35 degC: [co2 @ TreeIs(9)]"),
    ("husky", "Photograph tree 4. Hot? CO2. Not hot? Nothing.", "picture @ TreeIs(4) = r1; if r1 high: [co2]"),
    (
        "husky",
        "Photograph tree 4; in the event that it is hotter than 38, tree 9 as well.",
        "picture @ TreeIs(4) = r1; if r1 > 38 degC: [picture @ TreeIs(9)]",
    ),
    (
        "husky",
        "Photograph tree 4. Given a reading above 38 degrees, take CO2.",
        "picture @ TreeIs(4) = r1; if r1 > 38 degC: [co2]",
    ),
    (
        "husky",
        "Photograph tree 4. >= 38: CO2. < 38: air temperature.",
        "picture @ TreeIs(4) = r1; if r1 >= 38 degC: [co2]; if r1 < 38 degC: [air]",
    ),
    (
        "husky",
        "Photograph tree 4. 38 or higher means CO2, lower means home.",
        "picture @ TreeIs(4) = r1; if r1 >= 38 degC: [co2] else [go Marker(start)] | return_to_start",
    ),
    (
        "husky",
        "Photograph tree 4. If the canopy's above 38, then CO2, and if it's below 33, then the air temperature.",
        "picture @ TreeIs(4) = r1; if r1 > 38 degC: [co2]; if r1 < 33 degC: [air]",
    ),
    ("husky", "CO2 at tree 4. A picture too if above 500.", "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture]"),
    (
        "husky",
        "CO2 at tree 4. A picture too, should it be above 500.",
        "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture]",
    ),
    (
        "husky",
        "CO2 at tree 4. Is the value above 500? If yes, a picture. If no, go home.",
        "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture] else [go Marker(start)] | return_to_start",
    ),
    (
        "husky",
        "CO2 at tree 4; if it's anything over 500, a picture.",
        "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture]",
    ),
    (
        "husky",
        "CO2 at tree 4. If what you get is above 500, take a picture.",
        "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture]",
    ),
    (
        "husky",
        "CO2 at tree 4. If you read more than 500, take a picture.",
        "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture]",
    ),
    (
        "husky",
        "CO2 at every tree of row 3. Any over 500, snap it.",
        "for Rows(3, 3): [co2 = r1; if r1 > 500 ppm: [picture]]",
    ),
    (
        "husky",
        "CO2 at every tree of row 3. If any tops 500, stop and come back.",
        "for Rows(3, 3) until r1 > 500 ppm: [co2 = r1] | return_to_start",
    ),
    (
        "husky",
        "CO2 at every tree of row 3. The moment it tops 500 ppm, halt.",
        "for Rows(3, 3) until r1 > 500 ppm: [co2 = r1]",
    ),
    ("husky", "CO2 at tree 30. 31 same. 32 same.", "co2 @ TreeIs(30); go TreeIs(31); co2; go TreeIs(32); co2"),
    ("husky", "CO2 at tree 30; ditto tree 31.", "co2 @ TreeIs(30); go TreeIs(31); co2"),
    (
        "husky",
        "Tree 10, then tree 100, a CO2 sample at each, and then the whole of it over again.",
        "co2 @ TreeIs(10); co2 @ TreeIs(100); co2 @ TreeIs(10); co2 @ TreeIs(100)",
    ),
    (
        "husky",
        "CO2 at tree 10, then at tree 100. Do this three times in total.",
        "3 times: [co2 @ TreeIs(10); co2 @ TreeIs(100)]",
    ),
    (
        "husky",
        "CO2 at tree 10, then at tree 100. Do the pair three times.",
        "3 times: [co2 @ TreeIs(10); co2 @ TreeIs(100)]",
    ),
    (
        "husky",
        "CO2 at tree 10, then at tree 100. Repeat the pair twice.",
        "co2 @ TreeIs(10); co2 @ TreeIs(100); 2 times: [co2 @ TreeIs(10); co2 @ TreeIs(100)]",
    ),
    (
        "husky",
        "CO2 at tree 10, then at tree 100. Three rounds of that.",
        "3 times: [co2 @ TreeIs(10); co2 @ TreeIs(100)]",
    ),
    ("husky", "CO2 at tree 10, then at tree 100, three rounds.", "3 times: [co2 @ TreeIs(10); co2 @ TreeIs(100)]"),
    ("husky", "CO2 at tree 10, then again, then once more.", "co2 @ TreeIs(10); co2; co2"),
    (
        "husky",
        "CO2 at tree 40 and before you return a picture of tree 9.",
        "co2 @ TreeIs(40); picture @ TreeIs(9) | return_to_start",
    ),
    (
        "husky",
        "CO2 at tree 40. Before coming back, a picture of tree 9.",
        "co2 @ TreeIs(40); picture @ TreeIs(9) | return_to_start",
    ),
    ("husky", "Begin at tree 46 with a thermal image.", "picture @ TreeIs(46)"),
    ("husky", "Begin at tree 46 with a thermal image, then CO2 at tree 50.", "picture @ TreeIs(46); co2 @ TreeIs(50)"),
    ("husky", "Start at tree 46 by taking a picture, then CO2 at tree 50.", "picture @ TreeIs(46); co2 @ TreeIs(50)"),
    ("husky", "End at tree 46 with a picture, start at tree 50 with CO2.", "co2 @ TreeIs(50); picture @ TreeIs(46)"),
    (
        "husky",
        "Photograph tree 60; if to arrive is not possible, then tree 61 in the place of it.",
        "try [picture @ TreeIs(60)] or [picture @ TreeIs(61)]",
    ),
    (
        "husky",
        "Photograph tree 60. If you cannot get to it, take it from the tree next to it instead.",
        "try [picture @ TreeIs(60)] or [picture @ Nearest(TreeIs(60), True)]",
    ),
    (
        "amiga",
        "Take a leaf sample from tree 60. If you cannot get to it, take it from the tree next to it instead.",
        "try [sample_leaf @ TreeIs(60)] or [sample_leaf @ Nearest(TreeIs(60), True)]",
    ),
    (
        "husky",
        "Photograph tree 60. Can't reach it? Tree 61 will do.",
        "try [picture @ TreeIs(60)] or [picture @ TreeIs(61)]",
    ),
    (
        "husky",
        "Photograph tree 60; should that fail, tree 61 in its stead.",
        "try [picture @ TreeIs(60)] or [picture @ TreeIs(61)]",
    ),
    (
        "husky",
        "Photograph tree 60. If there's no getting to it, do its neighbour instead.",
        "try [picture @ TreeIs(60)] or [picture @ Nearest(TreeIs(60), True)]",
    ),
    (
        "husky",
        "Fifteen hundred metres is your lot, there and back. Photograph as many yellow trees as you can.",
        "for Where(leaf_color, eq, yellow) optional: [picture] | distance_m 1500",
    ),
    (
        "husky",
        "Photograph the yellow trees, max 600 m driving all in.",
        "for Where(leaf_color, eq, yellow): [picture] | distance_m 600",
    ),
    (
        "husky",
        "Photograph the yellow trees, spending of the battery no more than thirty per cent.",
        "for Where(leaf_color, eq, yellow): [picture] | energy_percent 30",
    ),
    (
        "husky",
        "Photograph the yellow trees with no more than thirty percent of the battery spent.",
        "for Where(leaf_color, eq, yellow): [picture] | energy_percent 30",
    ),
    (
        "husky",
        "Photograph the yellow trees, and use no more than 30 percent of the battery doing it.",
        "for Where(leaf_color, eq, yellow): [picture] | energy_percent 30",
    ),
    (
        "husky",
        "Photograph the yellow trees and don't spend more than 30 % of the battery on it.",
        "for Where(leaf_color, eq, yellow): [picture] | energy_percent 30",
    ),
    (
        "husky",
        "Photograph the yellow trees; the total distance travelled shall not exceed 900 metres.",
        "for Where(leaf_color, eq, yellow): [picture] | distance_m 900",
    ),
    (
        "husky",
        "Photograph the yellow trees, provided that the total distance travelled shall not exceed 900 metres.",
        "for Where(leaf_color, eq, yellow): [picture] | distance_m 900",
    ),
    (
        "husky",
        "Photograph the yellow trees within 20 minutes including the way back.",
        "for Where(leaf_color, eq, yellow): [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Photograph the yellow trees within 600 m round trip.",
        "for Where(leaf_color, eq, yellow): [picture] | distance_m 600",
    ),
    (
        "husky",
        "Twenty minutes is all you get, not a tick more. Photograph the yellow trees.",
        "for Where(leaf_color, eq, yellow): [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Budget 30 % of the battery: yellow trees, CO2, as many as that permits.",
        "for Where(leaf_color, eq, yellow) optional: [co2] | energy_percent 30",
    ),
    ("husky", "CO2 at trees 4, 9 and 30, three readings in all.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(30)): [co2]"),
    (
        "husky",
        "Six readings in total: CO2 at the first and last tree of rows 3, 4 and 5.",
        "for UnionOf(InRow(1, 1, of UnionOf(Rows(3, 3)+Rows(4, 4)+Rows(5, 5)))+InRow(-1, -1, of UnionOf(Rows(3, 3)+Rows(4, 4)+Rows(5, 5)))): [co2]",
    ),
    ("husky", "Photograph trees 4 and 9, two pictures altogether.", "for UnionOf(TreeIs(4)+TreeIs(9)): [picture]"),
    (
        "husky",
        "Photograph the four corner trees, four pictures in total, and then come back to the start, not the end.",
        "for Corners: [picture] | return_to_start",
    ),
    (
        "husky",
        "Photograph the yellow trees. You may drive 500 m, no further.",
        "for Where(leaf_color, eq, yellow): [picture] | distance_m 500",
    ),
    (
        "husky",
        "With 500 m to spend, photograph the yellow trees.",
        "for Where(leaf_color, eq, yellow): [picture] | distance_m 500",
    ),
    (
        "husky",
        "CO2 at trees 4, 9 and 30. If tree 4 is high and tree 9 is low, photograph tree 30.",
        "co2 @ TreeIs(4) = r1; co2 @ TreeIs(9) = r2; co2 @ TreeIs(30); if r1 high and r2 low: [picture @ TreeIs(30)]",
    ),
    (
        "husky",
        "CO2 at trees 4 and 9. If both are above 500, a picture of each.",
        "co2 @ TreeIs(4) = r1; co2 @ TreeIs(9) = r2; if r1 > 500 ppm and r2 > 500 ppm: [for UnionOf(TreeIs(4)+TreeIs(9)): [picture]]",
    ),
    (
        "husky",
        "CO2 at tree 4. If it's low, take one at tree 9 as well; and if that one is also low, take a picture of tree 12.",
        "co2 @ TreeIs(4) = r1; if r1 low: [co2 @ TreeIs(9) = r2; if r2 low: [picture @ TreeIs(12)]]",
    ),
    (
        "husky",
        "CO2 at the two ends of row 4. If the northern one is high, photograph it.",
        "co2 @ InRow(1, 1, of Rows(4, 4)) = r1; co2 @ InRow(-1, -1, of Rows(4, 4)); if r1 high: [go InRow(1, 1, of Rows(4, 4)); picture]",
    ),
    (
        "husky",
        "CO2 at the four corner trees. If the north-west one is high, photograph it.",
        "co2 @ Corners(nw) = r1; co2 @ Corners(ne); co2 @ Corners(se); co2 @ Corners(sw); if r1 high: [go Corners(nw); picture]",
    ),
    (
        "husky",
        "If the CO2 at tree 4 is low and the CO2 at tree 9 is high, take a picture of tree 12.",
        "co2 @ TreeIs(4) = r1; co2 @ TreeIs(9) = r2; if r1 low and r2 high: [picture @ TreeIs(12)]",
    ),
    (
        "husky",
        "Is the air above 35 °C at tree 140? Measure it. If yes: a picture.",
        "air @ TreeIs(140) = r1; if r1 > 35 degC: [picture]",
    ),
    (
        "husky",
        "Photograph the trees of row 3. Those above 38 get a CO2 reading. Then home.",
        "for Rows(3, 3): [picture = r1; if r1 > 38 degC: [co2]] | return_to_start",
    ),
    (
        "husky",
        "Photograph tree 4 and tree 9, tree 9 before tree 4.",
        "for UnionOf(TreeIs(9)+TreeIs(4)) given: [picture]",
    ),
    ("husky", "Photograph tree 9 before tree 4.", "picture @ TreeIs(9); picture @ TreeIs(4)"),
    ("husky", "CO2 at tree 10, three times in total.", "3 times: [co2 @ TreeIs(10)]"),
    ("husky", "CO2 at tree 10. Three times in all.", "3 times: [co2 @ TreeIs(10)]"),
    (
        "husky",
        "CO2 at trees 4, 9 and 30; at whichever of them exceeds 500 ppm, take a picture.",
        "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(30)): [co2 = r1; if r1 > 500 ppm: [picture]]",
    ),
    (
        "husky",
        "CO2 tree 4. >500? pic. else home.",
        "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture] else [go Marker(start)] | return_to_start",
    ),
    (
        "husky",
        "CO2 at tree 4. Only with a reading above 500 a picture.",
        "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture]",
    ),
    ("husky", "CO2 at tree 4. From 500 ppm upwards, a picture.", "co2 @ TreeIs(4) = r1; if r1 >= 500 ppm: [picture]"),
    (
        "husky",
        "Measure CO2 at trees 4, 9 and 30. If two or more are high, photograph tree 12.",
        "co2 @ TreeIs(4) = r1; co2 @ TreeIs(9) = r2; co2 @ TreeIs(30) = r3; if r1 high and r2 high or r1 high and r3 high or r2 high and r3 high: [picture @ TreeIs(12)]",
    ),
    (
        "husky",
        "Measure CO2 at trees 4, 9 and 30 and photograph any with more than 500 ppm.",
        "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(30)): [co2 = r1; if r1 > 500 ppm: [picture]]",
    ),
    (
        "husky",
        "Photograph row 3, every tree; where it's hot, CO2 too; where it isn't, move on.",
        "for Rows(3, 3): [picture = r1; if r1 high: [co2]]",
    ),
    (
        "husky",
        "Measure CO2 at tree 4. If high, measure again; if still high, photograph it.",
        "co2 @ TreeIs(4) = r1; if r1 high: [co2 = r2; if r2 high: [picture]]",
    ),
    ("husky", "Go to tree 4. CO2 above 500? Photograph it.", "go TreeIs(4); co2 = r1; if r1 > 500 ppm: [picture]"),
    (
        "husky",
        "Go to the charger and read the air temperature. Anything above 35 and you can turn straight round and come back; otherwise carry on to tree 1 and photograph it.",
        "go Marker(charger); air = r1; if r1 > 35 degC: [go Marker(start)] else [go TreeIs(1); picture] | return_to_start",
    ),
    (
        "husky",
        "CO2 at tree 4. Above 500 ppm and you come home, otherwise photograph it.",
        "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [go Marker(start)] else [picture] | return_to_start",
    ),
    (
        "husky",
        "Shoot tree 50. If it is below 33, go five trees north and shoot that one, if it isn't, go five trees south instead.",
        "picture @ TreeIs(50) = r1; if r1 < 33 degC: [go AlongRow(5, north); picture] else [go AlongRow(5, south); picture]",
    ),
    (
        "husky",
        "From the ten trees with the highest yield, photograph as many as you can within 25 minutes.",
        "for Top(yield_kg, 10) optional: [picture] | duration_s 1500",
    ),
    (
        "husky",
        "Starting at the north end of row 3, take the air temperature at every fourth tree and work your way south.",
        "for Ordered(north_to_south, of EveryNth(4, north, of Rows(3, 3))) given: [air]",
    ),
    (
        "husky",
        "Photograph every tree of row 3, toward the north going.",
        "for Ordered(south_to_north, of Rows(3, 3)) given: [picture]",
    ),
    (
        "husky",
        "Go down row 6 reading CO2 at every tree, and the moment it tops 500 ppm, halt, snap that tree, and knock off.",
        "for Rows(6, 6) until r1 > 500 ppm: [co2 = r1; if r1 > 500 ppm: [picture]]",
    ),
    (
        "husky",
        "CO2 at every tree of row 10; and where below 400 it falls, the air temperature there too.",
        "for Rows(10, 10): [co2 = r1; if r1 < 400 ppm: [air]]",
    ),
    (
        "husky",
        "Thermal pics of trees 4 and 9. If >38 degC: + CO2 there. Else nil. Home.",
        "for UnionOf(TreeIs(4)+TreeIs(9)): [picture = r1; if r1 > 38 degC: [co2]] | return_to_start",
    ),
    (
        "husky",
        "Be the air hot at tree 100 then a picture of tree 101.",
        "air @ TreeIs(100) = r1; if r1 high: [picture @ TreeIs(101)]",
    ),
    (
        "husky",
        "CO2 at trees 4, 9 and 30. If the southern one is high, photograph it.",
        "co2 @ Extreme(south, of UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(30))) = r1; co2 @ TreeIs(9); co2 @ TreeIs(30); if r1 high: [go Extreme(south, of UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(30))); picture]",
    ),
    (
        "husky",
        "CO2 at trees 4 and 40. If the northernmost reading is high, photograph tree 12.",
        "co2 @ Extreme(north, of UnionOf(TreeIs(4)+TreeIs(40))) = r1; co2 @ TreeIs(40); if r1 high: [picture @ TreeIs(12)]",
    ),
]

#: Requests that leave open what is meant, contradict themselves, or compare readings.
OPEN: list[tuple[str, str]] = [
    ("husky", "CO2 at trees 4, 5 and 6. If the western one is high, photograph it."),
    ("husky", "CO2 at every yellow tree. If the northernmost reading is high, photograph tree 4."),
    ("husky", "Photograph ten yellow trees, as many as you can."),
    (
        "husky",
        "Starting at the north end of row 3, take the air temperature at every fourth tree and work your way north.",
    ),
    ("husky", "Photograph tree 60. If it is hot, go to tree 9 instead."),
    ("husky", "End at the charger with a picture."),
    ("husky", "Measure CO2 at trees 4 and 9. If the first is higher than the second, photograph tree 4."),
    ("husky", "Measure CO2 at trees 4 and 9. If exactly one of them is high, photograph it."),
    ("husky", "Measure CO2 at tree 4 twice. If the second one is high, photograph the tree."),
    ("husky", "Photograph trees 4, 9 and 30, but tree 30 before tree 9."),
    ("husky", "Photograph trees 4 and 9, but tree 9 before tree 12."),
    ("husky", "CO2 at trees 4 and 40. Take a picture of the one with the higher reading."),
    ("husky", "CO2 at trees 4 and 40, then photograph the hotter of the two."),
    ("husky", "If over 35 at tree 4 then CO2 at tree 9."),
    ("husky", "CO2 at tree 4. If yes, a picture."),
    ("husky", "CO2 at tree 10, then at tree 100. Three times in total."),
    ("husky", "CO2 at trees 4, 9 and 30, four readings in all."),
    ("husky", "CO2 at trees 4 and 40. If the western one is above 450, go back to it and photograph it."),
    ("husky", "CO2 at tree 60. If it's low, take the air temperature. If it's low, photograph it."),
    ("husky", "Photograph trees 4 and 40. If the one at tree 4 is above 38, take CO2."),
]


@pytest.mark.parametrize(("robot", "request_", "plan"), SAID)
def test_each_wording_has_its_plan(robot: str, request_: str, plan: str) -> None:
    found = composed(request_, DEMO, load_robot(robot))
    assert isinstance(found, Planned), found
    assert outline(found.task) == plan


@pytest.mark.parametrize(("robot", "request_"), OPEN)
def test_what_is_open_is_not_planned(robot: str, request_: str) -> None:
    assert not isinstance(composed(request_, DEMO, load_robot(robot)), Planned)
