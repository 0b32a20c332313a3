"""Requests that were written without sight of the grammar, and their plans."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline
from planning.english.vineyards import vineyard

HUSKY = load_robot("husky")
PLANNED = {
    "demo": [
        ("Photograph the halfway tree of row 3.", "picture @ Middle(of Rows(3, 3))"),
        ("CO2 at tree 5, then scoot over to the charger.", "co2 @ TreeIs(5); go Marker(charger)"),
        ("Photograph the three best-bearing trees.", "for Top(yield_kg, 3): [picture]"),
        ("Photograph three trees apiece in rows 2 and 4.", "for Quota(row, 3, of UnionOf(Rows(2, 2)+Rows(4, 4))): [picture]"),
        ("Photograph row 3 starting with the last tree.", "for Ordered(south_to_north, of Rows(3, 3)) given: [picture]"),
        ("Go to tree 80 and photograph every tree in the two rows to the east.", "go TreeIs(80); for UnionOf(RowOf(1)+RowOf(2)): [picture]"),
        ("Take CO2 at all trees of row 4 except the ends.", "for Excluding(UnionOf(InRow(1, 1, of Rows(4, 4))+InRow(-1, -1, of Rows(4, 4))), of Rows(4, 4)): [co2]"),
        ("Photograph the trees in the northern half between 5 and 12 years old.", "for Where(age_years, le, 12, of Where(age_years, ge, 5, of Half(north))): [picture]"),
        ("Cover the whole of row 3 with pictures.", "for Rows(3, 3): [picture]"),
        ("Photograph two trees of each variety.", "for Quota(variety, 2): [picture]"),
        ("Take CO2 at one tree per variety in the northern half.", "for Quota(variety, 1, of Half(north)): [co2]"),
        ("Photograph row 5 except its ends.", "for Excluding(UnionOf(InRow(1, 1, of Rows(5, 5))+InRow(-1, -1, of Rows(5, 5))), of Rows(5, 5)): [picture]"),
        ("Photograph row 3, all but the last tree.", "for Excluding(InRow(-1, -1, of Rows(3, 3)), of Rows(3, 3)): [picture]"),
        ("Photograph every tree except the first of each row.", "for Excluding(InRow(1, 1, of Rows), of Rows): [picture]"),
        ("Take a picture of tree 40 and both its neighbours.", "for UnionOf(TreeIs(40)+Nearest(TreeIs(40), 2, True)): [picture]"),
        ("Take a picture at tree 40 and measure CO2 at its northern neighbour.", "picture @ TreeIs(40); co2 @ Nearest(Here, True, north)"),
        ("Go to tree 12. Take pictures of 3 of the next 5 trees.", "go TreeIs(12); for Evenly(3, of UnionOf(AlongRow(1)+AlongRow(2)+AlongRow(3)+AlongRow(4)+AlongRow(5))): [picture]"),
        ("Of trees 4, 9 and 12 take pictures of any two.", "for Take(2, of UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12))): [picture]"),
        ("Read CO2 at 4 trees in row 5, evenly spaced.", "for Evenly(4, of Rows(5, 5)): [co2]"),
        ("Take pictures of 5 trees in the northern half, far apart from each other.", "for Spread(5, of Half(north)): [picture]"),
        ("Photograph trees 4, 9 and 12 in reverse order.", "for UnionOf(TreeIs(12)+TreeIs(9)+TreeIs(4)) given: [picture]"),
        ("Photograph the trees of row 2, last one first.", "for Ordered(south_to_north, of Rows(2, 2)) given: [picture]"),
        ("Go to tree 40. Take pictures of the two rows to the east.", "go TreeIs(40); for UnionOf(RowOf(1)+RowOf(2)): [picture]"),
        ("Take a picture of trees older than 5 years and younger than 10.", "for Where(age_years, lt, 10, of Where(age_years, gt, 5)): [picture]"),
        ("Take pictures of trees between 5 and 10 years old.", "for Where(age_years, le, 10, of Where(age_years, ge, 5)): [picture]"),
        ("Take a picture of the first two and last two trees of each row.", "for UnionOf(InRow(1, 2, of Rows)+InRow(-2, -1, of Rows)): [picture]"),
        ("Go get me thermal shots of all the trees in row 4 and then park it at the charger.", "for Rows(4, 4): [picture]; go Marker(charger) | stay"),
        ("Go photograph tree 3, then take it home.", "picture @ TreeIs(3) | return_to_start"),
        ("Make a thermal photo of all the almond trees in the row 9, except the number 140.", "for Excluding(TreeIs(140), of Rows(9, 9)): [picture]"),
        ("Photograph every Carmel except 30.", "for Excluding(TreeIs(30), of Where(variety, eq, Carmel)): [picture]"),
        ("Measure the CO2 at the tree which is most in the north.", "co2 @ Extreme(north)"),
        ("CO2 at tree 5 and then at the tree that is the most southern.", "co2 @ TreeIs(5); co2 @ Extreme(south)"),
        ("Take the CO2 at the ten trees with the lowest production, but the battery must not go under 50 %.", "for Top(yield_kg, 10, True): [co2] | reserve 50"),
        ("Photograph tree 3. Don't let the battery fall below 50 %.", "picture @ TreeIs(3) | reserve 50"),
        ("Photograph tree 3 and make sure there's at least 40 % battery left when it's done.", "picture @ TreeIs(3) | reserve 40"),
        ("CO2 at 8 trees of the variety Carmel, well distributed, in less than half an hour.", "for Spread(8, of Where(variety, eq, Carmel)): [co2] | duration_s 1800"),
        ("Take the CO2 of tree 9 within an hour.", "co2 @ TreeIs(9) | duration_s 3600"),
        ("Photograph the two end trees of every row.", "for UnionOf(InRow(1, 1, of Rows)+InRow(-1, -1, of Rows)): [picture]"),
        ("Photograph the trees from 20 to 22. If at one of them it is above 35 degrees, take also the CO2 of this tree.", "for UnionOf(TreeIs(20)+TreeIs(21)+TreeIs(22)): [picture = r1; if r1 > 35 degC: [co2]]"),
        ("Photograph the trees that are less than 6 metres from the charger.", "for Within(6, Marker(charger)): [picture]"),
        ("Photograph the trees from the third to the twentieth in row 2.", "for InRow(3, 20, of Rows(2, 2)): [picture]"),
        ("In row 4, photograph the third tree.", "picture @ InRow(3, 3, of Rows(4, 4))"),
        ("Take pictures in row 4, at the yellow trees.", "for Where(leaf_color, eq, yellow, of Rows(4, 4)): [picture]"),
        ("Take CO2 readings in the northern half, at the three oldest trees.", "for Top(age_years, 3, of Half(north)): [co2]"),
        ("Take one picture in every row, at the first tree.", "for InRow(1, 1, of Rows): [picture]"),
        ("Photograph tree 3 and then go home.", "picture @ TreeIs(3) | return_to_start"),
        ("Measure CO2 at the tree nearest to the charger and the tree furthest from it.", "for UnionOf(Nearest(Marker(charger))+Farthest(Marker(charger))): [co2]"),
        ("Measure CO2 at all Nonpareil trees that yielded less than 5 kg.", "for Where(yield_kg, lt, 5, of Where(variety, eq, Nonpareil)): [co2]"),
        ("Photograph trees 1 through 4 except 2.", "for Excluding(TreeIs(2), of UnionOf(TreeIs(1)+TreeIs(2)+TreeIs(3)+TreeIs(4))): [picture]"),
        ("Go along row 4 and take a picture of each tree whose leaves are not green.", "for Where(leaf_color, ne, green, of Rows(4, 4)): [picture]"),
        ("Photograph the trees that are 8 years or older.", "for Where(age_years, ge, 8): [picture]"),
        ("CO2 at every tree with a yield of 10 kg or more", "for Where(yield_kg, ge, 10): [co2]"),
        ("I want CO2 in row 6, except where the tree is younger than 4 years.", "for Excluding(Where(age_years, lt, 4), of Rows(6, 6)): [co2]"),
        ("Take CO2 at every tree in row 3 but the yellow ones.", "for Excluding(Where(leaf_color, eq, yellow, of Rows(3, 3)), of Rows(3, 3)): [co2]"),
        ("Photograph row 6, every tree, except the last two in the row.", "for Excluding(InRow(-2, -1, of Rows(6, 6)), of Rows(6, 6)): [picture]"),
        ("Take pictures of every tree in row 5 and measure CO2 at any tree that is above 38 degrees.", "for Rows(5, 5): [picture = r1; if r1 > 38 degC: [co2]]"),
        ("Take a picture of every tree in row 5. Measure CO2 at the ones that are hot, then go to the charger.", "for Rows(5, 5): [picture = r1; if r1 high: [co2]]; go Marker(charger)"),
        ("Photograph row 4, all trees. Any that are hot get a CO2 reading.", "for Rows(4, 4): [picture = r1; if r1 high: [co2]]"),
        ("Measure CO2 at each tree of row 7 and photograph those where it is high.", "for Rows(7, 7): [co2 = r1; if r1 high: [picture]]"),
        ("Photograph every tree of row 3; for those that are hot, get the CO2 and the air temperature. Then photograph tree 9.", "for Rows(3, 3): [picture = r1; if r1 high: [co2; air]]; picture @ TreeIs(9)"),
        ("Measure CO2 at each tree of row 7 and photograph it if it is high, otherwise measure the air temperature.", "for Rows(7, 7): [co2 = r1; if r1 high: [picture] else [air]]"),
        ("If a tree in row 3 has more than 450 ppm of CO2, photograph it.", "for Rows(3, 3): [co2 = r1; if r1 > 450 ppm: [picture]]"),
        ("If any tree in row 3 is above 38 degrees in the thermal picture, take its CO2. Then go to the charger.", "for Rows(3, 3): [picture = r1; if r1 > 38 degC: [co2]]; go Marker(charger)"),
        ("Photograph row 4, every tree. Take a CO2 reading at every tree in row 4 that is hot.", "for Rows(4, 4): [picture = r1; if r1 high: [co2]]"),
        ("What I need is this: CO2 at trees 10, 20, 30 and 40, and then back to the start.", "for UnionOf(TreeIs(10)+TreeIs(20)+TreeIs(30)+TreeIs(40)): [co2] | return_to_start"),
        ("Record how warm the air is at every tree in the wet corner and come back to the start.", "for InZone(wet corner): [air] | return_to_start"),
        ("Photograph the trees in the wet corner, oldest first, for no more than 12 minutes.", "for Ordered(attribute, age_years, True, of InZone(wet corner)) given: [picture] | duration_s 720"),
        ("Measure air temperature at every third tree of row 8 starting from the second one.", "for EveryNth(3, 2, of Rows(8, 8)): [air]"),
        ("First take thermal pictures in row 1, then in row 3, then return to the start.", "for Rows(1, 1): [picture]; for Rows(3, 3): [picture] | return_to_start"),
        ("Take pictures of row 1 from south to north and of row 2 from north to south.", "for Ordered(south_to_north, of Rows(1, 1)) given: [picture]; for Ordered(north_to_south, of Rows(2, 2)) given: [picture]"),
        ("Do the whole of row 10 with the thermal camera.", "for Rows(10, 10): [picture]"),
        ("Do rows 1, 3 and 5 with the thermal camera and rows 2 and 4 with the CO2 sensor.", "for UnionOf(Rows(1, 1)+Rows(3, 3)+Rows(5, 5)): [picture]; for UnionOf(Rows(2, 2)+Rows(4, 4)): [co2]"),
        ("Visit tree 100, then tree 20, then tree 60 and read CO2 at each of them.", "for UnionOf(TreeIs(100)+TreeIs(20)+TreeIs(60)) given: [co2]"),
        ("Give it twenty minutes: as many of the yellow trees as it can photograph in that time.", "for Where(leaf_color, eq, yellow) optional: [picture] | duration_s 1200"),
        ("Photograph tree 5. If hot, take the CO2 too.", "picture @ TreeIs(5) = r1; if r1 high: [co2]"),
        ("Take CO2 at tree 44 and the two trees next to it.", "for UnionOf(TreeIs(44)+Nearest(TreeIs(44), 2, True)): [co2]"),
        ("take pictures of every tree in rows 1 to 4 but row 3", "for Excluding(Rows(3, 3), of Rows(1, 4)): [picture]"),
        ("take pictures of all rows but row 3", "for Excluding(Rows(3, 3), of Rows): [picture]"),
        ("For every Nonpareil in row 3, one CO2 reading and one thermal picture.", "for Where(variety, eq, Nonpareil, of Rows(3, 3)): [co2; picture]"),
        ("Any tree in rows 8 to 10 that gave us under 4 kilos needs a CO2 reading, please.", "for Where(yield_kg, lt, 4, of Rows(8, 10)): [co2]"),
        ("Anything that's twelve years or older should get a thermal image.", "for Where(age_years, ge, 12): [picture]"),
        ("Every tree in the north half gets its canopy temperature taken.", "for Half(north): [picture]"),
        ("Only if tree 14 has more than 450 ppm of CO2 do I want pictures of row 1, all trees.", "co2 @ TreeIs(14) = r1; if r1 > 450 ppm: [for Rows(1, 1): [picture]]"),
        ("tree 19 picture, tree 20 co2, tree 21 picture, home", "picture @ TreeIs(19); co2 @ TreeIs(20); picture @ TreeIs(21) | return_to_start"),
        ("Photograph all trees of the Nonpareil variety in row 3.", "for Where(variety, eq, Nonpareil, of Rows(3, 3)): [picture]"),
        ("Photograph the trees of variety Carmel in row 4.", "for Where(variety, eq, Carmel, of Rows(4, 4)): [picture]"),
        ("Take pictures of 5 trees in the Carmel.", "for Take(5, of Where(variety, eq, Carmel)): [picture]"),
        ("CO2 at every tree with more than 10 kg of yield.", "for Where(yield_kg, gt, 10): [co2]"),
        ("Photograph trees 10, 20, 30 and so on until 60.", "for UnionOf(TreeIs(10)+TreeIs(20)+TreeIs(30)+TreeIs(40)+TreeIs(50)+TreeIs(60)): [picture]"),
        ("Photograph trees 10, 20, and every ten after that up to tree 60.", "for UnionOf(TreeIs(10)+TreeIs(20)+TreeIs(30)+TreeIs(40)+TreeIs(50)+TreeIs(60)): [picture]"),
        ("Measure CO2 along row 4, five trees will do.", "for Take(5, of Rows(4, 4)): [co2]"),
        ("Take CO2 in the northern half, six spots are enough.", "for Take(6, of Half(north)): [co2]"),
        ("Measure CO2 at one tree in row 3, any tree is fine.", "co2 @ Take(1, of Rows(3, 3))"),
        ("CO2 at one tree in row 3 and one tree in row 5, in each case the oldest one.", "for UnionOf(Top(age_years, 1, of Rows(3, 3))+Top(age_years, 1, of Rows(5, 5))): [co2]"),
        ("CO2 in rows 2, 4 and 6, at the first tree of each.", "for InRow(1, 1, of UnionOf(Rows(2, 2)+Rows(4, 4)+Rows(6, 6))): [co2]"),
        ("In rows 2 and 5, at the oldest tree of each, take a picture.", "for UnionOf(Top(age_years, 1, of Rows(2, 2))+Top(age_years, 1, of Rows(5, 5))): [picture]"),
        ("If the CO2 is over 450 ppm at tree 20, photograph tree 25.", "co2 @ TreeIs(20) = r1; if r1 > 450 ppm: [picture @ TreeIs(25)]"),
        ("Photograph the five oldest trees and then the five youngest.", "for Top(age_years, 5): [picture]; for Top(age_years, 5, True): [picture]"),
        ("Photograph the five oldest trees in row 3 and the five youngest.", "for UnionOf(Top(age_years, 5, of Rows(3, 3))+Top(age_years, 5, True, of Rows(3, 3))): [picture]"),
        ("Photograph the tree with the highest yield and the one with the lowest.", "for UnionOf(Top(yield_kg, 1)+Top(yield_kg, 1, True)): [picture]"),
        ("Take a picture of the tree beside the pond.", "picture @ Nearest(InZone(pond))"),
        ("Take one CO2 sample at the tree next to the pond and one at the tree that is farthest away from it.", "co2 @ Nearest(InZone(pond)); co2 @ Farthest(InZone(pond))"),
        ("Photograph three trees side by side near the charger.", "for Adjacent(Marker(charger), 3): [picture]"),
        ("Photograph three adjacent trees in the middle of row 3.", "for Adjacent(Middle(of Rows(3, 3)), 3): [picture]"),
        ("Measure CO2 at 4 points spread evenly along row 6.", "for Evenly(4, of Rows(6, 6)): [co2]"),
        ("Drive along row 3 with a picture at every tree.", "for Rows(3, 3): [picture]"),
        ("Photograph the northern end trees of rows 2 to 4.", "for InRow(1, 1, north, of Rows(2, 4)): [picture]"),
        ("At tree 40 a picture, then CO2, then the air temperature.", "go TreeIs(40); picture; co2; air"),
        ("At tree 40, picture, then CO2, then air temperature. Repeat the whole process at three other Nonpareil trees at least 15 metres from one another.", "go TreeIs(40); picture; co2; air; for Apart(15, 3, True, of NotVisited(of Where(variety, eq, Nonpareil))): [picture; co2; air]"),
        ("Take the air temperature at tree 85. If it is below 30 degrees come home, otherwise continue with pictures of row 5.", "air @ TreeIs(85) = r1; if r1 < 30 degC: [go Marker(start)] else [for Rows(5, 5): [picture]] | return_to_start"),
        ("If the CO2 at tree 4 is high go home, otherwise carry on with pictures of trees 5 to 8.", "co2 @ TreeIs(4) = r1; if r1 high: [go Marker(start)] else [for UnionOf(TreeIs(5)+TreeIs(6)+TreeIs(7)+TreeIs(8)): [picture]] | return_to_start"),
    ],
    "vineyard": [
        ("In the South block, row 11, make photos of the vines from the tenth to the twentieth.", "for InRow(10, 20, of Rows(11, 11, of InBlock(South))): [picture] | return_to_start"),
        ("North, row 12: a picture of the third vine.", "picture @ InRow(3, 3, of Rows(12, 12, of InBlock(North))) | return_to_start"),
        ("Run down row 14 in the north block and get a heat picture of every tenth vine.", "for EveryNth(10, of Rows(14, 14, of InBlock(North))): [picture] | return_to_start"),
        ("Take carbon dioxide at the three Merlots nearest the gate, then bring it home to the barn.", "for Nearest(GateIs(gate), 3, of Where(variety, eq, Merlot)): [co2] | return_to_start"),
        ("Take thermal pictures in row 12 of the North block, at the vines with vigor below 0.35.", "for Where(vigor, lt, 0.35, of Rows(12, 12, of InBlock(North))): [picture] | return_to_start"),
        ("Measure CO2 at the vine nearest the pond and at the vine furthest from it.", "co2 @ Nearest(InZone(pond)); co2 @ Farthest(InZone(pond)) | return_to_start"),
        ("Measure CO2 at every Syrah vine with vigor between 0.3 and 0.4.", "for Where(vigor, le, 0.4, of Where(vigor, ge, 0.3, of Where(variety, eq, Syrah))): [co2] | return_to_start"),
        ("Take a CO2 reading wherever vigor is under 0.35 in the South block.", "for Where(vigor, lt, 0.35, of InBlock(South)): [co2] | return_to_start"),
        ("Photograph the vines N10, N20 and N30, and measure CO2 at those that are hot.", "for UnionOf(TreeIs(N10)+TreeIs(N20)+TreeIs(N30)): [picture = r1; if r1 high: [co2]] | return_to_start"),
        ("Take CO2 at the 30 least vigorous Cabernet Sauvignon vines and take a thermal picture wherever it is above 500.", "for Top(vigor, 30, True, of Where(variety, eq, Cabernet Sauvignon)): [co2 = r1; if r1 > 500 ppm: [picture]] | return_to_start"),
        ("Whenever a vine in row 11 of the North block turns out to be above 36 degrees in the thermal picture, its CO2 should be measured too.", "for Rows(11, 11, of InBlock(North)): [picture = r1; if r1 > 36 degC: [co2]] | return_to_start"),
        ("Okay so first thing, CO2 at the gate. After that go over to North row 9 and do a thermal on each vine that has a vigor under 0.4.", "co2 @ GateIs(gate); for Where(vigor, lt, 0.4, of Rows(9, 9, of InBlock(North))): [picture] | return_to_start"),
        ("I'd like to know how warm the canopy is at the ends of rows 1, 4 and 10 in the North block.", "for UnionOf(InRow(1, 1, of UnionOf(Rows(1, 1, of InBlock(North))+Rows(4, 4, of InBlock(North))+Rows(10, 10, of InBlock(North))))+InRow(-1, -1, of UnionOf(Rows(1, 1, of InBlock(North))+Rows(4, 4, of InBlock(North))+Rows(10, 10, of InBlock(North))))): [picture] | return_to_start"),
        ("Go through North row 10 and take a thermal picture of any vine with vigor below 0.4. Where the canopy is hot, measure CO2 as well.", "for Where(vigor, lt, 0.4, of Rows(10, 10, of InBlock(North))): [picture = r1; if r1 high: [co2]] | return_to_start"),
        ("Go to N300. If the canopy temperature is above 35 °C, measure CO2 at N300 and go to the gate.", "go TreeIs(N300); picture = r1; if r1 > 35 degC: [co2 @ TreeIs(N300); go GateIs(gate)] | return_to_start"),
        ("Measure CO2 at vine N100 three times and at vine N200 twice.", "co2 x3 @ TreeIs(N100); co2 x2 @ TreeIs(N200) | return_to_start"),
        ("Take thermal pictures in row 12 of both blocks, at the vines with vigor below 0.35.", "for Where(vigor, lt, 0.35, of UnionOf(Rows(12, 12, of InBlock(North))+Rows(12, 12, of InBlock(South)))): [picture] | return_to_start"),
        ("Take the vines that have a vigor of at least 0.7 in row 11 of the North block and get me their canopy temperatures, working from the south end to the north.", "for Ordered(south_to_north, of Where(vigor, ge, 0.7, of Rows(11, 11, of InBlock(North)))) given: [picture] | return_to_start"),
        ("It would be great to have CO2 at N13, N413 and N513; should any of the three be over 550, get thermal pictures of all three.", "co2 @ TreeIs(N13) = r1; co2 @ TreeIs(N413) = r2; co2 @ TreeIs(N513) = r3; if r1 > 550 ppm or r2 > 550 ppm or r3 > 550 ppm: [for UnionOf(TreeIs(N13)+TreeIs(N413)+TreeIs(N513)): [picture]] | return_to_start"),
        ("Bring me back air temperatures from ten vines spread evenly along row 10 in the South block.", "for Evenly(10, of Rows(10, 10, of InBlock(South))): [air] | return_to_start"),
        ("N12: thermal. If hot, CO2 there and at N13. If not, go to N400 for a CO2.", "picture @ TreeIs(N12) = r1; if r1 high: [co2; co2 @ TreeIs(N13)] else [go TreeIs(N400); co2] | return_to_start"),
        ("Measure air temperature at N1, N312, N13 and N466, strictly in the sequence listed.", "for UnionOf(TreeIs(N1)+TreeIs(N312)+TreeIs(N13)+TreeIs(N466)) given: [air] | return_to_start"),
        ("An air temperature, taken at the gate, and then, only if it's over 28, thermal pictures of the ten weakest vines in the South block.", "air @ GateIs(gate) = r1; if r1 > 28 degC: [for Top(vigor, 10, True, of InBlock(South)): [picture]] | return_to_start"),
        ("An air temperature, taken at the gate, and then, only if it's over 28, thermal pictures of the ten weakest vines, South block.", "air @ GateIs(gate) = r1; if r1 > 28 degC: [for Top(vigor, 10, True, of InBlock(South)): [picture]] | return_to_start"),
        ("Thermal pictures of the ten weakest vines, South block.", "for Top(vigor, 10, True, of InBlock(South)): [picture] | return_to_start"),
        ("Photograph vines with under 0.4 vigor in row 3 of North.", "for Where(vigor, lt, 0.4, of Rows(3, 3, of InBlock(North))): [picture] | return_to_start"),
        ("CO2 at ten vines in the Merlot.", "for Take(10, of Where(variety, eq, Merlot)): [co2] | return_to_start"),
        ("CO2 at one Merlot, one Syrah and one Cabernet vine, in each case the one closest to the barn.", "for UnionOf(Nearest(Marker(start), of Where(variety, eq, Merlot))+Nearest(Marker(start), of Where(variety, eq, Syrah))+Nearest(Marker(start), of Where(variety, eq, Cabernet Sauvignon))): [co2] | return_to_start"),
        ("CO2 at every vine under 0.35 vigor in rows 1 to 6 of the North block but not row 4.", "for Excluding(Rows(4, 4, of InBlock(North)), of Where(vigor, lt, 0.35, of Rows(1, 6, of InBlock(North)))): [co2] | return_to_start"),
        ("CO2 under the ten weakest Syrah vines first, then under the ten strongest. Ninety minutes at most.", "for Top(vigor, 10, True, of Where(variety, eq, Syrah)): [co2]; for Top(vigor, 10, of Where(variety, eq, Syrah)): [co2] | duration_s 5400 | return_to_start"),
        ("CO2 at three vines within 20 yards of the southwest corner of the North block.", "for Take(3, of Within(18.288, Corners(sw, of InBlock(North)))): [co2] | return_to_start"),
        ("Make a picture of three vines side by side somewhere in the middle of the North block.", "for Adjacent(Middle(of InBlock(North)), 3): [picture] | return_to_start"),
        ("Go to the gate and take the air temperature, and do it again when you are back at the barn.", "go GateIs(gate); air; go Marker(start); air | return_to_start"),
        ("Read the air temperature along the southern edge of the South block, three spots will do.", "for Take(3, of Edge(south, of InBlock(South))): [air] | return_to_start"),
    ],
}  # fmt: skip
#: Requests with words that ask for nothing and have to be confirmed.
REMARKED = [
    ("Photograph tree 5 on the double.", "picture @ TreeIs(5)", "double"),
    ("Right, I want it to go down row 7, and at any tree that reads above 38 degrees on the thermal camera, get a CO2 reading too.", "for Rows(7, 7): [picture = r1; if r1 > 38 degC: [co2]]", "'Right'"),
    ("Hi, when you get a minute could you have the robot swing past row 6 and grab me a thermal of each tree, cheers.", "for Rows(6, 6): [picture]", "'minute'"),
    ("So what I'd like is basically a CO2 number for each of the Carmels down in the wet corner, nothing fancy.", "for Where(variety, eq, Carmel, of InZone(wet corner)): [co2]", "'nothing fancy'"),
]  # fmt: skip
#: What the grammar leaves to a question or a refusal, and why.
NOT_PLANNED = {
    "Take readings at trees 4 and 5.": "which readings?",
    "Photograph trees 10, 20, 30 and so on up to 95.": "95 is none of them",
    "Take a picture of every tree in row 3, any tree will do.": "every tree, or any?",
    "Photograph the five oldest trees and the five best.": "the best by what?",
    "Measure CO2 at tree 5. If it is hot, photograph it.": "CO2 is not hot",
    "Measure CO2 at each tree of row 7 and photograph it if it is hot.": "CO2 is not hot",
    "Take a CO2 reading at every tree in row 3 that is hot.": "hot in the air, or in the canopy?",
    "Measure CO2 at tree 5 and photograph those that are high.": "which trees?",
    "Take pictures of the yellow trees in row 4, then in row 6.": "the yellow ones, or all?",
    "Take CO2 at trees 4 and 5 and the tree next to it.": "next to which?",
    "If the air temperature at the start is above 30 degrees, photograph every tree in row 2; otherwise measure CO2 there.": "there: at the start, or in row 2?",
}


def site_of(name: str) -> Site:
    return open_site("demo") if name == "demo" else vineyard()


@pytest.mark.parametrize(
    ("site", "request_", "plan"), [(site, *case) for site, cases in PLANNED.items() for case in cases]
)
def test_it_is_planned_with_every_word(site: str, request_: str, plan: str) -> None:
    outcome = composed(request_, site_of(site), HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert unaccounted(outcome.task) == ()
    assert mismatches(outcome.task, site_of(site), HUSKY) == ()


@pytest.mark.parametrize(("request_", "plan", "remark"), REMARKED)
def test_what_asks_for_nothing_is_planned_with_a_warning(request_: str, plan: str, remark: str) -> None:
    outcome = composed(request_, site_of("demo"), HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert [remark in str(problem.what) for problem in unaccounted(outcome.task)] == [True]


@pytest.mark.parametrize("request_", NOT_PLANNED)
def test_what_may_mean_something_else_is_not_planned(request_: str) -> None:
    assert not isinstance(composed(request_, site_of("demo"), HUSKY), Planned)
