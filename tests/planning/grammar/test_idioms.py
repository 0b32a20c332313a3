"""Everyday turns of phrase: what they mean, and that those which mean nothing are no obstacle."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

READ = [
    ("Start the morning in row 4: a thermal picture of every third tree.", "for EveryNth(3, of Rows(4, 4)): [picture]"),
    (
        "Take a picture of tree 4. If it is high, measure CO2 before you move on.",
        "picture @ TreeIs(4) = r1; if r1 high: [co2]",
    ),
    ("Photograph tree 4 and finish back at the start where I'm parked.", "picture @ TreeIs(4) | return_to_start"),
    ("Take one last picture at tree 9.", "picture @ TreeIs(9)"),
    (
        "I can spare the robot for 25 minutes. Photograph as many of the pale green trees as you can in that time.",
        "for Where(leaf_color, eq, pale green) optional: [picture] | duration_s 1500",
    ),
    ("I have only 10 minutes. Take a picture of tree 4.", "picture @ TreeIs(4) | duration_s 600"),
    ("Photograph the third, fifth and seventh rows.", "for UnionOf(Rows(3, 3)+Rows(5, 5)+Rows(7, 7)): [picture]"),
    ("Photograph the middle third of row 2.", "for InRow(7, 12, of Rows(2, 2)): [picture]"),
    ("Run down row 3 with a thermal picture every 15 metres.", "for Spaced(15, of Rows(3, 3)): [picture]"),
    ("At tree 4 I'd also like the CO2.", "go TreeIs(4); co2"),
    ("Photograph tree 4, then do tree 9 as well.", "picture @ TreeIs(4); go TreeIs(9); picture"),
    (
        "Photograph as many yellow trees as 30 percent of the battery allows.",
        "for Where(leaf_color, eq, yellow) optional: [picture] | energy_percent 30",
    ),
    (
        "Visit as many yellow trees as 60 minutes allow and take one CO2 reading at each.",
        "for Where(leaf_color, eq, yellow) optional: [co2] | duration_s 3600",
    ),
    (
        "Try to get a thermal picture of tree 50; if you can't reach it, take tree 51 instead. Either way, go on to "
        "tree 60 for an air temperature.",
        "try [picture @ TreeIs(50)] or [picture @ TreeIs(51)]; go TreeIs(60); air",
    ),
    ("Photograph tree 9 and, on the way back, tree 4.", "picture @ TreeIs(9); picture @ TreeIs(4)"),
    (
        "Measure the air temperature at tree 4. If it's over 35, come straight back; otherwise take a CO2 sample in "
        "the middle of the field on the way home.",
        "air @ TreeIs(4) = r1; if r1 > 35 degC: [go Marker(start)] else [co2 @ Middle] | return_to_start",
    ),
    (
        "Photograph tree 4. If it's under 33 or over 38, take another picture.",
        "picture @ TreeIs(4) = r1; if r1 < 33 degC or r1 > 38 degC: [picture]",
    ),
    (
        "Photograph tree 4. If it is neither low nor high, go home.",
        "picture @ TreeIs(4) = r1; if not r1 low and not r1 high: [go Marker(start)] | return_to_start",
    ),
    (
        "Photograph tree 4. If it is between 33 and 36, measure CO2.",
        "picture @ TreeIs(4) = r1; if 33 <= r1 <= 36 degC: [co2]",
    ),
    (
        "Take a CO2 reading at tree 20. Same for 40 and 60.",
        "co2 @ TreeIs(20); for UnionOf(TreeIs(40)+TreeIs(60)): [co2]",
    ),
    (
        "Do two rounds: photograph trees 4, 9 and 14.",
        "2 times: [for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(14)): [picture]]",
    ),
    (
        "Do the following twice: photograph tree 4, measure CO2 at tree 9.",
        "2 times: [picture @ TreeIs(4); co2 @ TreeIs(9)]",
    ),
    (
        "Photograph the eastern half first, then the western half.",
        "for Half(east): [picture]; for Half(west): [picture]",
    ),
    ("Photograph row 4, then row 5.", "for Rows(4, 4): [picture]; for Rows(5, 5): [picture]"),
    (
        "Photograph row 4 northwards and row 5 southwards.",
        "for Ordered(south_to_north, of Rows(4, 4)) given: [picture]; "
        "for Ordered(north_to_south, of Rows(5, 5)) given: [picture]",
    ),
    (
        "Photograph row 6 and, battery permitting, row 7.",
        "for Rows(6, 6): [picture]; maybe [for Rows(7, 7): [picture]]",
    ),
    (
        "Photograph trees 9, 10, 11 and, if the battery allows, tree 12.",
        "for UnionOf(TreeIs(9)+TreeIs(10)+TreeIs(11)): [picture]; maybe [picture @ TreeIs(12)]",
    ),
    (
        "Photograph the trees of row 9 in order from north to south.",
        "for Ordered(north_to_south, of Rows(9, 9)) given: [picture]",
    ),
    (
        "Photograph the Carmel trees in order of age, oldest first.",
        "for Ordered(attribute, age_years, True, of Where(variety, eq, Carmel)) given: [picture]",
    ),
    (
        "Photograph the Carmel trees in order of age.",
        "for Ordered(attribute, age_years, of Where(variety, eq, Carmel)) given: [picture]",
    ),
    (
        "As long as the air at the start is under 30, photograph row 3.",
        "air @ Marker(start) = r1; if r1 < 30 degC: [for Rows(3, 3): [picture]]",
    ),
    (
        "Photograph tree 4 and tree 9, then do it all again.",
        "for UnionOf(TreeIs(4)+TreeIs(9)): [picture]; for UnionOf(TreeIs(4)+TreeIs(9)): [picture]",
    ),
    (
        "Photograph tree 4 and measure CO2 at tree 9, then do it all again.",
        "picture @ TreeIs(4); co2 @ TreeIs(9); picture @ TreeIs(4); co2 @ TreeIs(9)",
    ),
    ("Return to the charger afterwards.", "go Marker(charger) | stay"),
    ("Photograph row 3 and return to the charger afterwards.", "for Rows(3, 3): [picture]; go Marker(charger) | stay"),
    (
        "Photograph tree 4. If it's under 36, continue with tree 5.",
        "picture @ TreeIs(4) = r1; if r1 < 36 degC: [go TreeIs(5); picture = r2]",
    ),
    (
        "Photograph tree 4. If it's under 36, go on to tree 5 and photograph it; otherwise come home.",
        "picture @ TreeIs(4) = r1; if r1 < 36 degC: [go TreeIs(5); picture] else [go Marker(start)] | return_to_start",
    ),
    ("Photograph tree 4, then continue with tree 5.", "picture @ TreeIs(4); go TreeIs(5); picture"),
    (
        "Try to get a thermal picture of tree 60, and if you can't reach it take one of the tree next to it instead.",
        "try [picture @ TreeIs(60)] or [picture @ Nearest(TreeIs(60), True)]",
    ),
    (
        "Photograph tree 60. If you can't reach it, photograph the nearest tree to it.",
        "try [picture @ TreeIs(60)] or [picture @ Nearest(TreeIs(60))]",
    ),
    ("Photograph tree 60 or, if that is blocked, tree 61.", "try [picture @ TreeIs(60)] or [picture @ TreeIs(61)]"),
    ("Photograph tree 60, or tree 61 if it can't be reached.", "try [picture @ TreeIs(60)] or [picture @ TreeIs(61)]"),
    (
        "Photograph tree 60; if it's blocked, the one next to it.",
        "try [picture @ TreeIs(60)] or [picture @ Nearest(TreeIs(60), True)]",
    ),
    (
        "Photograph the westernmost row, then the easternmost.",
        "for Rows(1, 1, west): [picture]; for Rows(1, 1, east): [picture]",
    ),
    ("Photograph the northernmost tree and the southernmost.", "for UnionOf(Extreme(north)+Extreme(south)): [picture]"),
    ("Photograph the northernmost tree, then the southernmost.", "picture @ Extreme(north); picture @ Extreme(south)"),
    (
        "Photograph the northernmost tree of row 4 and the southernmost.",
        "for UnionOf(Extreme(north, of Rows(4, 4))+Extreme(south, of Rows(4, 4))): [picture]",
    ),
    (
        "Go to the northernmost tree and take a picture, then go to the easternmost and measure CO2.",
        "go Extreme(north); picture; go Extreme(east); co2",
    ),
    ("Photograph the easternmost.", "picture @ Extreme(east)"),
    (
        "Photograph the two westernmost rows, then the easternmost.",
        "for Rows(1, 2, west): [picture]; for Rows(1, 1, east): [picture]",
    ),
    (
        "Drive to the north end of row 6, take a picture, then drive to the south end and take another.",
        "go InRow(1, 1, north, of Rows(6, 6)); picture; go InRow(1, 1, south, of RowOf); picture",
    ),
    (
        "Photograph the tree at the north end of row 6 and measure CO2 at the south end.",
        "picture @ InRow(1, 1, north, of Rows(6, 6)); co2 @ InRow(1, 1, south, of RowOf)",
    ),
    (
        "Photograph every tree in row 6 and measure CO2 at the north end.",
        "for Rows(6, 6): [picture]; co2 @ InRow(1, 1, north, of Rows(6, 6))",
    ),
    (
        "For every row from 2 to 6, take a CO2 reading at its northern end.",
        "for InRow(1, 1, north, of Rows(2, 6)): [co2]",
    ),
    (
        "Go to tree 40, take a picture, then go to the north end of its row and take another.",
        "go TreeIs(40); picture; go InRow(1, 1, north, of RowOf); picture",
    ),
    (
        "Go to tree 40, take a picture, then go to the north end and take another.",
        "go TreeIs(40); picture; go InRow(1, 1, north, of RowOf); picture",
    ),
    (
        "In row 6, take a picture at the north end and CO2 at the south end.",
        "for InRow(1, 1, north, of Rows(6, 6)): [picture]; co2 @ InRow(1, 1, south, of Rows(6, 6))",
    ),
    ("Go to the north end of row 3.", "go InRow(1, 1, north, of Rows(3, 3))"),
    (
        "Read CO2 at tree 95. If it comes out above 450 ppm, repeat the reading at two nearby trees; otherwise just "
        "take a thermal image of tree 95.",
        "co2 @ TreeIs(95) = r1; if r1 > 450 ppm: [for Nearest(Here, 2, True): [co2]] else [picture @ TreeIs(95)]",
    ),
    (
        "Take a CO2 reading at tree 60. If it is high, repeat the reading at the two trees next to tree 60.",
        "co2 @ TreeIs(60) = r1; if r1 high: [for Nearest(TreeIs(60), 2, True): [co2]]",
    ),
    (
        "Measure CO2 at tree 133, and if it is under 400 ppm repeat the measurement once.",
        "co2 @ TreeIs(133) = r1; if r1 < 400 ppm: [co2]",
    ),
    (
        "Measure CO2 at tree 133, and if it is under 400 ppm repeat the measurement.",
        "co2 @ TreeIs(133) = r1; if r1 < 400 ppm: [co2]",
    ),
    ("Measure CO2 at tree 133 and repeat the measurement at tree 5.", "co2 @ TreeIs(133); go TreeIs(5); co2"),
    (
        "Measure CO2 at trees 5 and 6 and repeat the measurement at tree 7.",
        "for UnionOf(TreeIs(5)+TreeIs(6)): [co2]; go TreeIs(7); co2",
    ),
    ("Photograph trees 10 through 20 of row 6 in that order.", "for InRow(10, 20, of Rows(6, 6)) given: [picture]"),
    (
        "Take a picture of trees 5 through 8 in row 9, then a CO2 reading at the last of them.",
        "for InRow(5, 8, of Rows(9, 9)): [picture]; co2 @ InRow(8, 8, of Rows(9, 9))",
    ),
    (
        "Take a picture of trees 5 to 8, then a CO2 reading at the last of them only.",
        "for UnionOf(TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)): [picture]; co2 @ TreeIs(8)",
    ),
    (
        "Read the air temperature at tree 40; if it is above 35, photograph the five trees that follow it down the "
        "row.",
        "air @ TreeIs(40) = r1; if r1 > 35 degC: [for "
        "UnionOf(AlongRow(1)+AlongRow(2)+AlongRow(3)+AlongRow(4)+AlongRow(5)): [picture]]",
    ),
    (
        "Photograph tree 40 and the five trees after it.",
        "for UnionOf(TreeIs(40)+AlongRow(1, TreeIs(40))+AlongRow(2, TreeIs(40))+AlongRow(3, TreeIs(40))+AlongRow(4, "
        "TreeIs(40))+AlongRow(5, TreeIs(40))): [picture]",
    ),
    (
        "Photograph tree 40 and the next five down the row.",
        "for UnionOf(TreeIs(40)+AlongRow(1, TreeIs(40))+AlongRow(2, TreeIs(40))+AlongRow(3, TreeIs(40))+AlongRow(4, "
        "TreeIs(40))+AlongRow(5, TreeIs(40))): [picture]",
    ),
    (
        "Photograph tree 40 and then the next five trees in the row.",
        "picture @ TreeIs(40); for UnionOf(AlongRow(1)+AlongRow(2)+AlongRow(3)+AlongRow(4)+AlongRow(5)): [picture]",
    ),
    (
        "Take the air temperature at tree 40, go three trees north in the same row and take it again there.",
        "air @ TreeIs(40); go AlongRow(3, north); air",
    ),
    (
        "Take the air temperature at tree 40, go three trees north and take it again there.",
        "air @ TreeIs(40); go AlongRow(3, north); air",
    ),
    (
        "Measure CO2 at the tree in the middle of the southern edge.",
        "co2 @ EdgeMiddle(south)",
    ),
    (
        "One CO2 reading at each corner tree, whichever comes first.",
        "for Corners: [co2]",
    ),
    (
        "Photograph rows 6-8.",
        "for Rows(6, 8): [picture]",
    ),
    (
        "Photograph rows 3 & 5.",
        "for UnionOf(Rows(3, 3)+Rows(5, 5)): [picture]",
    ),
    (
        "Photograph row #3.",
        "for Rows(3, 3): [picture]",
    ),
    (
        "Photograph trees 4, 5 & 6.",
        "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)): [picture]",
    ),
    (
        "Photograph tree no. 5.",
        "picture @ TreeIs(5)",
    ),
    (
        "Photograph tree nr 5.",
        "picture @ TreeIs(5)",
    ),
    (
        "Take CO2 every 25m along row 3.",
        "for Spaced(25, of Rows(3, 3)): [co2]",
    ),
    (
        "Take CO2 every 25 mtrs along row 3.",
        "for Spaced(25, of Rows(3, 3)): [co2]",
    ),
    (
        "Photograph tree 4. If > 36C, CO2 too.",
        "picture @ TreeIs(4) = r1; if r1 > 36 degC: [co2]",
    ),
    (
        "Photograph tree 4. If it's more than 36 deg, CO2 too.",
        "picture @ TreeIs(4) = r1; if r1 > 36 degC: [co2]",
    ),
    (
        "Photograph tree 4. If it's more than 36°, CO2 too.",
        "picture @ TreeIs(4) = r1; if r1 > 36 degC: [co2]",
    ),
    (
        "Photograph tree 4. If it's more than 36 Celsius, measure CO₂ too.",
        "picture @ TreeIs(4) = r1; if r1 > 36 degC: [co2]",
    ),
    (
        "Photograph tree 4. If it's more than 97 °F, measure CO2 too.",
        "picture @ TreeIs(4) = r1; if r1 > 36.1111 degC: [co2]",
    ),
    (
        "Measure CO2 at tree 4. If it's over 450, photograph it.",
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]",
    ),
    (
        "Measure CO2 at tree 4. If it's 450 or higher, photograph it.",
        "co2 @ TreeIs(4) = r1; if r1 >= 450 ppm: [picture]",
    ),
    (
        "Measure CO2 at tree 4. If it reaches 450, photograph it.",
        "co2 @ TreeIs(4) = r1; if r1 >= 450 ppm: [picture]",
    ),
    (
        "Measure CO2 at tree 4. If it's at least 450 ppm, photograph it.",
        "co2 @ TreeIs(4) = r1; if r1 >= 450 ppm: [picture]",
    ),
    (
        "Measure CO2 at tree 4. If not below 450 ppm, photograph it.",
        "co2 @ TreeIs(4) = r1; if not r1 < 450 ppm: [picture]",
    ),
    (
        "Measure CO2 at tree 4. If it exceeds 450 ppm photograph it, else leave it.",
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]",
    ),
    (
        "Measure CO2 at tree 4 and photograph it if the reading is above 450 ppm.",
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]",
    ),
    (
        "Measure CO2 at tree 4 and photograph it when it's above 450 ppm.",
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]",
    ),
    (
        "Measure CO2 at tree 4, photographing it if it's above 450 ppm.",
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]",
    ),
    (
        "Only if the CO2 at tree 4 is above 450 ppm, photograph it.",
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]",
    ),
    (
        "Photograph tree 4 only if its CO2 is above 450 ppm.",
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]",
    ),
    (
        "Photograph tree 4 if its CO2 is above 450 ppm; otherwise photograph tree 5.",
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture] else [picture @ TreeIs(5)]",
    ),
    (
        "Photograph tree 4 if CO2 there is above 450 ppm.",
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]",
    ),
    (
        "Photograph those of trees 4 to 8 whose CO2 is above 450 ppm.",
        "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)): [co2 = r1; if r1 > 450 ppm: [picture]]",
    ),
    (
        "Photograph any of trees 4 to 8 whose CO2 is above 450 ppm.",
        "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)): [co2 = r1; if r1 > 450 ppm: [picture]]",
    ),
    (
        "Photograph trees 4 to 8 where CO2 is above 450 ppm.",
        "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)): [co2 = r1; if r1 > 450 ppm: [picture]]",
    ),
    (
        "Photograph each tree in row 4 with CO2 above 450 ppm.",
        "for Rows(4, 4): [co2 = r1; if r1 > 450 ppm: [picture]]",
    ),
    (
        "At each tree in row 4, check CO2 and photograph it if that's above 450 ppm.",
        "for Rows(4, 4): [co2 = r1; if r1 > 450 ppm: [picture]]",
    ),
    (
        "Check CO2 at each tree in row 4 and photograph the ones above 450 ppm.",
        "for Rows(4, 4): [co2 = r1; if r1 > 450 ppm: [picture]]",
    ),
    (
        "Check CO2 at each tree in row 4, and at those above 450 ppm take a picture.",
        "for Rows(4, 4): [co2 = r1; if r1 > 450 ppm: [picture]]",
    ),
    (
        "Check CO2 at each tree in row 4. Those above 450 ppm get a picture.",
        "for Rows(4, 4): [co2 = r1; if r1 > 450 ppm: [picture]]",
    ),
    (
        "Check CO2 at each tree in row 4. Above 450 ppm: picture. Below 400: air temperature.",
        "for Rows(4, 4): [co2 = r1; if r1 > 450 ppm: [picture]; if r1 < 400 ppm: [air]]",
    ),
    (
        "Check CO2 at each tree in row 4 and take a picture when it's high.",
        "for Rows(4, 4): [co2 = r1; if r1 high: [picture]]",
    ),
    (
        "Check CO2 at each tree in row 4 and take a picture when it's low or high.",
        "for Rows(4, 4): [co2 = r1; if r1 low or r1 high: [picture]]",
    ),
    (
        "Check CO2 in row 4, tree by tree, until you find one above 450 ppm; photograph that one.",
        "for Rows(4, 4) until r1 > 450 ppm: [co2 = r1; if r1 > 450 ppm: [picture]]",
    ),
    (
        "Check CO2 in row 4, tree by tree. If one is above 450 ppm, photograph it and go on.",
        "for Rows(4, 4): [co2 = r1; if r1 > 450 ppm: [picture]]",
    ),
    (
        "Check CO2 at trees 4, 5 and 6. If any is above 450, photograph all three.",
        "co2 @ TreeIs(4) = r1; co2 @ TreeIs(5) = r2; co2 @ TreeIs(6) = r3; if r1 > 450 ppm or r2 > 450 ppm or r3 > "
        "450 ppm: [for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)): [picture]]",
    ),
    (
        "Check CO2 at tree 4 and air temperature at tree 5. If the CO2 is above 450 and the temperature below 30, "
        "photograph tree 6.",
        "co2 @ TreeIs(4) = r1; air @ TreeIs(5) = r2; if r1 > 450 ppm and r2 < 30 degC: [picture @ TreeIs(6)]",
    ),
    (
        "Visit as many trees within 15 m of tree 40 as 30 % of the battery lets you, and read the air temperature "
        "at each.",
        "for Within(15, TreeIs(40)) optional: [air] | energy_percent 30",
    ),
    (
        "Photograph the four corner trees and then come back to the start, not the end.",
        "for Corners: [picture] | return_to_start",
    ),
    (
        "Photograph tree 4. Finish at the start, not at the end marker.",
        "picture @ TreeIs(4) | return_to_start",
    ),
    (
        "Photograph tree 4 and finish at the charger rather than at the end marker.",
        "picture @ TreeIs(4); go Marker(charger) | stay",
    ),
    (
        "Photograph tree 4 and go back to the start instead of the end.",
        "picture @ TreeIs(4) | return_to_start",
    ),
    (
        "Photograph tree 45, or tree 46 in case you can't get to 45.",
        "try [picture @ TreeIs(45)] or [picture @ TreeIs(46)]",
    ),
    (
        "Photograph tree 45, or tree 46 if you can't get to 45.",
        "try [picture @ TreeIs(45)] or [picture @ TreeIs(46)]",
    ),
    (
        "Photograph tree 45, or tree 46 if you can't get to tree 45.",
        "try [picture @ TreeIs(45)] or [picture @ TreeIs(46)]",
    ),
    (
        "Photograph trees 10 to 14, and for each one hotter than 38 degrees take pictures of two nearby trees.",
        "for UnionOf(TreeIs(10)+TreeIs(11)+TreeIs(12)+TreeIs(13)+TreeIs(14)): [picture = r1; if r1 > 38 degC: [for "
        "Nearest(Here, 2, True): [picture]]]",
    ),
    (
        "Photograph trees 3 to 8 and stop as soon as one of them shows more than 40 degrees.",
        "for UnionOf(TreeIs(3)+TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)) until r1 > 40 degC: [picture = r1]",
    ),
    (
        "Photograph every tree in rows 3 to 5; stop and come back as soon as one of them shows more than 40 degrees.",
        "for Rows(3, 5) until r1 > 40 degC: [picture = r1] | return_to_start",
    ),
    (
        "Measure the air temperature at the four corners and come back if it drops below 0 degrees.",
        "for Corners until r1 < 0 degC: [air = r1] | return_to_start",
    ),
    (
        "Measure the air temperature at the four corners and come back if it is below 0 degrees.",
        "for Corners until r1 < 0 degC: [air = r1] | return_to_start",
    ),
    (
        "Measure the air temperature at each corner and come home if it is over 35.",
        "for Corners until r1 > 35 degC: [air = r1] | return_to_start",
    ),
    (
        "Photograph trees 3 to 8 and come home if it is over 38.",
        "for UnionOf(TreeIs(3)+TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)) until r1 > 38 degC: [picture = "
        "r1] | return_to_start",
    ),
    (
        "Photograph trees 3 to 8. If it is over 38, come home.",
        "for UnionOf(TreeIs(3)+TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)): [picture = r1; if r1 > 38 degC: "
        "[stop]] | return_to_start",
    ),
    (
        "Photograph trees 3 to 8. If one is over 38, come home.",
        "for UnionOf(TreeIs(3)+TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)): [picture = r1; if r1 > 38 degC: "
        "[stop]] | return_to_start",
    ),
    (
        "Photograph trees 3 to 8 and measure CO2 if it is over 38.",
        "for UnionOf(TreeIs(3)+TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)): [picture = r1; if r1 > 38 degC: "
        "[co2]]",
    ),
    (
        "Take a picture at tree 4. Take another one at tree 4.",
        "picture @ TreeIs(4); picture @ TreeIs(4)",
    ),
    (
        "Measure CO2 at trees 5 and 6. One reading at tree 7.",
        "for UnionOf(TreeIs(5)+TreeIs(6)): [co2]; co2 @ TreeIs(7)",
    ),
    (
        "Measure CO2 at trees 5 and 6, one reading at each.",
        "for UnionOf(TreeIs(5)+TreeIs(6)): [co2]",
    ),
    (
        "Measure CO2 at trees 5 and 6. Three readings at each.",
        "for UnionOf(TreeIs(5)+TreeIs(6)): [co2 x3]",
    ),
    (
        "In the next 15 minutes, get thermal pictures of as many Carmel trees as you can.",
        "for Where(variety, eq, Carmel) optional: [picture] | duration_s 900",
    ),
    (
        "Photograph trees 4 to 9 except tree 6.",
        "for Excluding(TreeIs(6), of UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)+TreeIs(9))): [picture]",
    ),
    (
        "I need the air temperature at trees 4 to 9 of row 2, leaving out tree 6.",
        "for Excluding(InRow(6, 6, of Rows(2, 2)), of InRow(4, 9, of Rows(2, 2))): [air]",
    ),
    (
        "Photograph trees 4 to 9 of row 2 except tree 6.",
        "for Excluding(InRow(6, 6, of Rows(2, 2)), of InRow(4, 9, of Rows(2, 2))): [picture]",
    ),
]


@pytest.mark.parametrize(("request_", "expected"), READ)
def test_a_turn_of_phrase_is_read_as_it_is_meant(request_: str, expected: str) -> None:
    planned = EnglishPlanner().plan(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(planned, Planned)
    assert outline(planned.task) == expected
