"""Requests about fields in other words: what is left out, halves, references, fronted places, means, battery."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

PLANNED = [
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture, but not the cowslip patch or the boggy corner",
        "mow area Excluding(UnionOf(InZone(cowslip patch)+InZone(boggy corner)), of InZone(long pasture))",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture without the cowslip patch or the boggy corner",
        "mow area Excluding(UnionOf(InZone(cowslip patch)+InZone(boggy corner)), of InZone(long pasture))",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture, but neither the boggy corner nor the cowslip patch",
        "mow area Excluding(UnionOf(InZone(boggy corner)+InZone(cowslip patch)), of InZone(long pasture))",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow everything except the bank, the cowslip patch or the boggy corner",
        "mow area Excluding(UnionOf(InZone(bank)+InZone(cowslip patch)+InZone(boggy corner)))",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture. Do not mow the cowslip patch or the boggy corner",
        "mow area Excluding(UnionOf(InZone(cowslip patch)+InZone(boggy corner)), of InZone(long pasture))",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture. Don't touch the cowslip patch, nor the boggy corner",
        "mow area Excluding(UnionOf(InZone(cowslip patch)+InZone(boggy corner)), of InZone(long pasture))",
    ),
    (
        GARDEN,
        AMIGA,
        "take a leaf sample from every bed except the radishes or the kale",
        "for Quota(row, 1, of Excluding(UnionOf(Rows(3, 3)+Rows(6, 6)), of Rows)): [sample_leaf]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "photograph every plant in the hot bay, but not the Long Tom or plant H1-3",
        "for Excluding(UnionOf(Where(cultivar, eq, Long Tom)+TreeIs(H1-3)), of InZone(hot bay)): [picture]",
    ),
    (
        PASTURE,
        AMIGA,
        (
            "measure soil moisture on a 30 m grid over the long pasture, but not in the boggy corner or the "
            "cowslip patch"
        ),
        ("for InZone(cowslip patch, True, of InZone(boggy corner, True, of Grid(30, long pasture))): [moisture]"),
    ),
    (
        PASTURE,
        AMIGA,
        (
            "measure soil moisture on a 40 m grid over the long pasture except in the cowslip patch, the "
            "boggy corner or the bank"
        ),
        (
            "for InZone(bank, True, of InZone(boggy corner, True, of InZone(cowslip patch, True, of Grid(40, "
            "long pasture)))): [moisture]"
        ),
    ),
    (
        GARDEN,
        HUSKY,
        ("read the air temperature in the rose bed. Stay at least 3 metres away from the netted beans the whole time."),
        "air @ PointsIn(rose bed) | avoid Where(netted, eq, True, of Where(crop, eq, bean)) 3 m",
    ),
    (
        GARDEN,
        HUSKY,
        "keep 2 metres away from the manure heap all the time and read the air temperature in the rose bed",
        "air @ PointsIn(rose bed) | avoid InZone(manure heap) 2 m",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the tallest bean, and keep at least two metres from the manure heap throughout",
        "picture @ Top(height_cm, 1, of Where(crop, eq, bean)) | avoid InZone(manure heap) 2 m",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank and stay 5 metres clear of the cowslip patch at all times",
        "mow area InZone(bank) | avoid InZone(cowslip patch) 5 m",
    ),
    (
        PASTURE,
        HUSKY,
        "read CO2 on the bank. Don't go within 10 metres of the pond at any point.",
        "co2 @ PointsIn(bank) | avoid InZone(pond) 10 m",
    ),
    (
        PASTURE,
        HUSKY,
        "read CO2 on the bank and keep well away from the cowslip patch, at least 8 metres, the whole time",
        "co2 @ PointsIn(bank) | avoid InZone(cowslip patch) 8 m",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank, staying at least three metres away from the pond for the whole of the job",
        "mow area InZone(bank) | avoid InZone(pond) 3 m",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank, keeping a distance of 4 m from the pond while you work",
        "mow area InZone(bank) | avoid InZone(pond) 4 m",
    ),
    (PASTURE, TRACTOR, "mow the half of the bank that lies to the west", "mow area Half(west, of InZone(bank))"),
    (
        PASTURE,
        AMIGA,
        "measure soil moisture at five points in the northern half of the long pasture",
        "for PointsIn(long pasture, 5, north): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "measure soil moisture on a 20 m grid in the southern half of the cow paddock",
        "for Grid(20, cow paddock, south): [moisture]",
    ),
    (PASTURE, HUSKY, "read CO2 in the middle of the eastern half of the bank", "co2 @ PointsIn(bank, east)"),
    (GARDEN, TRACTOR, "make a video of bed 3, then one of the kale bed", "film rows Rows(3, 3); film rows Rows(6, 6)"),
    (
        GARDEN,
        TRACTOR,
        "film the bean bed, then one more of the squash bed",
        "film rows Rows(4, 4); film rows Rows(5, 5)",
    ),
    (GARDEN, TRACTOR, "take a video of bed 3 and another of bed 5", "film rows Rows(3, 3); film rows Rows(5, 5)"),
    (
        GARDEN,
        TRACTOR,
        "give me a video of the bean bed, followed by one of bed 6",
        "film rows Rows(4, 4); film rows Rows(6, 6)",
    ),
    (GLASSHOUSE, TRACTOR, "I want a film of row 3 and one of row 4", "film rows Rows(3, 3); film rows Rows(4, 4)"),
    (GARDEN, TRACTOR, "a video of each potato bed, please", "film rows Rows(of Where(crop, eq, potato))"),
    (
        PASTURE,
        TRACTOR,
        "patrol the edge of the cow paddock once, starting from the middle gate",
        "go GateIs(middle gate); drive perimeter InZone(cow paddock)",
    ),
    (
        GARDEN,
        TRACTOR,
        "mow the rose bed starting from the street gate",
        "go GateIs(street gate); mow area InZone(rose bed)",
    ),
    (
        GARDEN,
        AMIGA,
        (
            "measure nitrate at three random beans. If their average is under 20 ppm, photograph the ground "
            "at those three plants."
        ),
        (
            "for RandomSample(3, of Where(crop, eq, bean)): [nitrate = r1]; if mean(r1 < 20 ppm): [for "
            "RandomSample(3, of Where(crop, eq, bean)): [picture(view ground)]]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        (
            "measure nitrate at three beans chosen at random. If the mean is below 20 ppm, take a leaf from "
            "each of them."
        ),
        (
            "for RandomSample(3, of Where(crop, eq, bean)): [nitrate = r1]; if mean(r1 < 20 ppm): [for "
            "RandomSample(3, of Where(crop, eq, bean)): [sample_leaf]]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        (
            "pick four squashes at random and measure the soil moisture. Then take a leaf sample from those "
            "four squashes."
        ),
        "for RandomSample(4, of Where(crop, eq, squash)): [moisture; sample_leaf]",
    ),
    (
        PASTURE,
        AMIGA,
        "read the moisture at five points spread over the bank, then read nitrate at the same spots",
        "for PointsIn(bank, 5): [moisture; nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "measure soil moisture at six points on the bank, then nitrate at those points",
        "for PointsIn(bank, 6): [moisture; nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "measure soil moisture at six points on the bank. Measure nitrate at each of the same six points.",
        "for PointsIn(bank, 6): [moisture; nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        (
            "take soil moisture at four random points on the bank. If the average is under 20 percent, "
            "repeat the measurement at the same four points at 30 cm."
        ),
        (
            "for PointsIn(bank, 4, True): [moisture = r1]; if mean(r1 < 20 percent): [for PointsIn(bank, 4, "
            "True): [moisture(depth_cm 30)]]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        "measure nitrate at three random beans and photograph those three plants afterwards",
        "for RandomSample(3, of Where(crop, eq, bean)): [nitrate; picture]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        ("go to the five melons with the lowest moisture and measure the soil moisture again, this time at 30 cm"),
        "for Top(moisture, 5, True, of Where(crop, eq, melon)): [moisture(depth_cm 30)]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "measure soil moisture at the first melon and then once more at 40 cm",
        "moisture @ InRow(1, 1, of Where(crop, eq, melon, of Rows(3, 3))); moisture(depth_cm 40)",
    ),
    (
        GARDEN,
        AMIGA,
        "measure the nitrate at the tallest kale, then again at 40 cm depth",
        "nitrate @ Top(height_cm, 1, of Where(crop, eq, kale)); nitrate(depth_cm 40)",
    ),
    (
        GARDEN,
        AMIGA,
        "measure soil moisture at three random beans, and measure it again there, this time 40 cm deep",
        "for RandomSample(3, of Where(crop, eq, bean)): [moisture; moisture(depth_cm 40)]",
    ),
    (
        GARDEN,
        AMIGA,
        "take three soil moisture readings in bed 5, spaced evenly along it",
        "for Evenly(3, of Rows(5, 5)): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "check the soil moisture at four beans spread along the bed's length",
        "for Evenly(4, of Where(crop, eq, bean, of Rows(4, 4))): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "check the soil moisture at four beans, placed at equal distances along the bed",
        "for Evenly(4, of Where(crop, eq, bean, of Rows(4, 4))): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "measure nitrate at three beans. Pick them at random.",
        "for RandomSample(3, of Where(crop, eq, bean)): [nitrate]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph six beans picked out by lot",
        "for RandomSample(6, of Where(crop, eq, bean)): [picture]",
    ),
    (
        PASTURE,
        AMIGA,
        "take ten nitrate readings in the long pasture, scattered at random",
        "for PointsIn(long pasture, 10, True): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "take ten nitrate readings on the bank, distributed evenly over the whole area",
        "for PointsIn(bank, 10): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "measure soil moisture at ten spots on the bank. Choose them at random.",
        "for PointsIn(bank, 10, True): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "take eight nitrate readings on the bank at evenly distributed spots",
        "for PointsIn(bank, 8): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "take eight nitrate readings at spots distributed evenly over the bank",
        "for PointsIn(bank, 8): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "over the cow paddock, test the soil moisture on a grid of points 30 metres apart, at 10 cm depth",
        "for Grid(30, cow paddock): [moisture(depth_cm 10)]",
    ),
    (
        PASTURE,
        AMIGA,
        "over the long pasture, take nitrate readings on a 40 metre grid",
        "for Grid(40, long pasture): [nitrate]",
    ),
    (PASTURE, AMIGA, "across the bank, measure nitrate at ten random spots", "for PointsIn(bank, 10, True): [nitrate]"),
    (
        PASTURE,
        AMIGA,
        "in the boggy corner, at 30 cm depth, measure the soil moisture at five random spots",
        "for PointsIn(boggy corner, 5, True): [moisture(depth_cm 30)]",
    ),
    (
        PASTURE,
        HUSKY,
        "all over the cow paddock, read CO2 at eight evenly spread points",
        "for PointsIn(cow paddock, 8): [co2]",
    ),
    (
        PASTURE,
        AMIGA,
        "throughout the bank, measure soil moisture every 20 metres on a grid",
        "for Grid(20, bank): [moisture]",
    ),
    (PASTURE, AMIGA, "measure soil moisture at points 30 metres apart over the bank", "for Grid(30, bank): [moisture]"),
    (
        GARDEN,
        AMIGA,
        "at 15 cm depth, measure soil moisture at five random beans",
        "for RandomSample(5, of Where(crop, eq, bean)): [moisture(depth_cm 15)]",
    ),
    (
        PASTURE,
        TRACTOR,
        ("patrol the edge of the cow paddock two times at 1 m/s at most, and stop for people until they have moved on"),
        (
            "drive perimeter InZone(cow paddock), 2 laps | speed 1 | return_to_start | at any time "
            "person_near: wait, then return_to_start"
        ),
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank. Let people pass.",
        "mow area InZone(bank) | return_to_start | at any time person_near: wait, then return_to_start",
    ),
    (
        GARDEN,
        TRACTOR,
        "film bed 4 and give way to people",
        "film rows Rows(4, 4) | return_to_start | at any time person_near: wait, then return_to_start",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank and always wait for people to pass",
        "mow area InZone(bank) | return_to_start | at any time person_near: wait, then return_to_start",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank. If you see someone, stop the mower and wait till they've walked on.",
        "mow area InZone(bank) | return_to_start | at any time person_near: wait, then return_to_start",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank and yield to people",
        "mow area InZone(bank) | return_to_start | at any time person_near: wait, then return_to_start",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "photograph every melon. If the battery falls below 40 percent, leave the rest and stop.",
        "for Where(crop, eq, melon): [picture; if battery <= 40: [stop]]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph every bean. Should the battery fall to 40 percent, break off and come home.",
        "for Where(crop, eq, bean): [picture] | reserve 40",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph every bean, always keeping 30 percent of the battery in reserve",
        "for Where(crop, eq, bean): [picture] | reserve 30",
    ),
    (
        GARDEN,
        AMIGA,
        "take one leaf sample from each bed, leaving out the potato beds, and bring them all to the tool shed",
        "for Quota(row, 1, of Excluding(Rows(of Where(crop, eq, potato)), of Rows)): [sample_leaf]",
    ),
    (
        GARDEN,
        AMIGA,
        "take a leaf from the first bean and drop it off at the tool shed",
        "sample_leaf @ InRow(1, 1, of Where(crop, eq, bean, of Rows(4, 4)))",
    ),
    (
        GARDEN,
        AMIGA,
        "take a leaf sample of three beans chosen at random and bring the samples back here",
        "for RandomSample(3, of Where(crop, eq, bean)): [sample_leaf]",
    ),
    (
        GARDEN,
        AMIGA,
        "take a leaf of the tallest kale, then carry it to the street gate",
        "sample_leaf @ Top(height_cm, 1, of Where(crop, eq, kale)); go GateIs(street gate) | stay",
    ),
    (
        GARDEN,
        AMIGA,
        "take a leaf of the tallest kale and return with it to the river gate",
        "sample_leaf @ Top(height_cm, 1, of Where(crop, eq, kale)); go GateIs(river gate) | stay",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "what is the average air temperature in the hot bay and in the mild bay? Use four readings in each.",
        "for UnionOf(Spread(4, of InZone(hot bay))+Spread(4, of InZone(mild bay))): [air]",
    ),
    (
        PASTURE,
        AMIGA,
        "what is the average soil moisture on the bank? Measure at ten random points.",
        "for PointsIn(bank, 10, True): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "how wet is the boggy corner on average? Use eight readings.",
        "for PointsIn(boggy corner, 8): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "what is the mean soil moisture of the beans and of the squashes? Use three plants of each.",
        "for UnionOf(Spread(3, of Where(crop, eq, bean))+Spread(3, of Where(crop, eq, squash))): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "what is the average soil moisture in the bean bed? Use four readings.",
        "for Evenly(4, of Rows(4, 4)): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "find out the average soil moisture of the bank from ten readings",
        "for PointsIn(bank, 10): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "tell me the mean nitrate in the cow paddock, based on eight random points",
        "for PointsIn(cow paddock, 8, True): [nitrate]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "how warm is the air in the mild bay? Take the average of four readings.",
        "for Spread(4, of InZone(mild bay)): [air]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "I'd like to know the average CO2 level in the hot bay, from five readings",
        "for Spread(5, of InZone(hot bay)): [co2]",
    ),
    (
        PASTURE,
        HUSKY,
        "read CO2 at the farm gate, at the bank and in the boggy corner",
        "for UnionOf(GateIs(farm gate)+PointsIn(bank)+PointsIn(boggy corner)): [co2]",
    ),
    (
        PASTURE,
        HUSKY,
        "read CO2 at the middle gate and the bank",
        "for UnionOf(GateIs(middle gate)+PointsIn(bank)): [co2]",
    ),
    (
        GARDEN,
        HUSKY,
        "read the air temperature at the rose bed, at the manure heap and at the street gate",
        "for UnionOf(PointsIn(rose bed)+PointsIn(manure heap)+GateIs(street gate)): [air]",
    ),
    (PASTURE, HUSKY, "read CO2 at the pond", "co2 @ Transect(1, edge, pond)"),
    (
        PASTURE,
        HUSKY,
        "read CO2 at the farm gate, at the pond and in the boggy corner",
        "for UnionOf(GateIs(farm gate)+Transect(1, edge, pond)+PointsIn(boggy corner)): [co2]",
    ),
    (PASTURE, HUSKY, "go to the pond and take a thermal picture there", "go Transect(1, edge, pond); picture"),
    (
        PASTURE,
        HUSKY,
        "if the CO2 on the bank is above 500 ppm, read it in the boggy corner as well; otherwise go home",
        "co2 @ PointsIn(bank) = r1; if r1 > 500 ppm: [co2 @ PointsIn(boggy corner)] else [go Marker(start)]",
    ),
    (
        PASTURE,
        AMIGA,
        "if the soil moisture in the boggy corner is over 40 percent, measure nitrate there too",
        "moisture @ PointsIn(boggy corner) = r1; if r1 > 40 percent: [nitrate]",
    ),
    (
        GARDEN,
        AMIGA,
        (
            "choose three beans by chance, measure the nitrate at each one, and if they average below 15 ppm "
            "bring me a leaf from those three"
        ),
        (
            "for RandomSample(3, of Where(crop, eq, bean)): [nitrate = r1]; if mean(r1 < 15 ppm): [for "
            "RandomSample(3, of Where(crop, eq, bean)): [sample_leaf]]"
        ),
    ),
    (
        GARDEN,
        HUSKY,
        "visit the rose bed and the manure heap and read the air temperature at each of them",
        "for UnionOf(PointsIn(rose bed)+PointsIn(manure heap)): [air]",
    ),
    (GARDEN, TRACTOR, "use the side camera to film bed 4 from its east side", "film rows Rows(4, 4), east"),
    (GARDEN, TRACTOR, "film bed 4 with the side camera", "film rows Rows(4, 4)"),
    (GARDEN, TRACTOR, "film bed 4 from the east", "film rows Rows(4, 4), east"),
    (GARDEN, TRACTOR, "film bed 4 along its west side", "film rows Rows(4, 4), west"),
    (
        GARDEN,
        TRACTOR,
        "spray the potato beds one after the other at 250 l/ha",
        "spray rows Rows(of Where(crop, eq, potato)), rate_l_ha 250",
    ),
    (
        GARDEN,
        TRACTOR,
        "spray all six beds at 200 l/ha except those that are netted",
        "spray rows Excluding(UnionOf(Rows(3, 3)+Rows(4, 4)), of Rows), rate_l_ha 200",
    ),
    (
        GARDEN,
        TRACTOR,
        "spray beds 1 to 6 at 150 l/ha, leaving the beans and the kale unsprayed",
        "spray rows Excluding(UnionOf(Rows(4, 4)+Rows(6, 6)), of Rows(1, 6)), rate_l_ha 150",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank first, then the cowslip patch",
        "mow area InZone(bank); mow area InZone(cowslip patch)",
    ),
    (
        PASTURE,
        TRACTOR,
        "start mowing the long pasture at the farm gate",
        "go GateIs(farm gate); mow area InZone(long pasture)",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank but keep 3 metres away from the cowslip patch and 2 metres away from the pond",
        "mow area InZone(bank) | avoid InZone(cowslip patch) 3 m | avoid InZone(pond) 2 m",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank, but hold still if anybody walks up to you and carry on once they have left",
        "mow area InZone(bank) | return_to_start | at any time person_near: wait, then return_to_start",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank, and if it should start raining, head back to the stable door",
        "mow area InZone(bank) | return_to_start | at any time rain: return_to_start",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank, and give the pond a berth of at least 4 metres",
        "mow area InZone(bank) | avoid InZone(pond) 4 m",
    ),
    (
        GARDEN,
        AMIGA,
        "at every third bean, measure soil moisture at 10 and at 30 cm",
        "for EveryNth(3, of Where(crop, eq, bean)): [moisture(depth_cm 10); moisture(depth_cm 30)]",
    ),
    (
        PASTURE,
        AMIGA,
        "take a soil moisture reading in the middle of the bank, once at 10 cm and once at 50 cm",
        "moisture(depth_cm 10) @ PointsIn(bank); moisture(depth_cm 50)",
    ),
    (
        PASTURE,
        AMIGA,
        "on the bank, take nitrate at points laid out on a 20 m grid, 30 cm deep",
        "for Grid(20, bank): [nitrate(depth_cm 30)]",
    ),
    (
        PASTURE,
        AMIGA,
        "over the whole of the bank, measure soil moisture at 12 evenly spaced points",
        "for PointsIn(bank, 12): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "take nitrate at one random point in each quarter of the long pasture",
        (
            "for UnionOf(PointsIn(long pasture, True, nw)+PointsIn(long pasture, True, ne)+PointsIn(long "
            "pasture, True, se)+PointsIn(long pasture, True, sw)): [nitrate]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        "measure soil moisture in each bed at the third plant from the north",
        "for InRow(3, 3, north, of Rows): [moisture]",
    ),
]

ASKED = [
    (GARDEN, TRACTOR, "spray half of bed 4 at 200 l/ha", 2),
    (PASTURE, TRACTOR, "mow half of the cow paddock", 4),
    (PASTURE, TRACTOR, "mow half the long pasture", 4),
    (PASTURE, TRACTOR, "mow one quarter of the bank", 4),
    (PASTURE, AMIGA, "measure soil moisture at six points in half of the cow paddock", 4),
    (PASTURE, AMIGA, "what's the average nitrate on the bank and in the boggy corner? Four spots should be enough", 2),
    (GLASSHOUSE, AMIGA, "photograph the melons that are too dry", 2),
    (GLASSHOUSE, AMIGA, "photograph the very dry aubergines", 3),
    (GARDEN, AMIGA, "photograph the beans that are too small", 2),
    (GARDEN, AMIGA, "photograph the big squashes", 2),
]

REFUSED = [
    (
        GARDEN,
        AMIGA,
        "measure nitrate at three random beans. Photograph those five plants.",
        "'Photograph those five plants': 'those five plants': no such ones were named before",
    ),
    (
        GARDEN,
        AMIGA,
        "measure nitrate at three random beans. Photograph those three squashes.",
        "'Photograph those three squashes': 'those three squashes': no such ones were named before",
    ),
    (
        GARDEN,
        AMIGA,
        "measure nitrate at two random beans and at the tallest kale. Photograph those three plants.",
        "'Photograph those three plants': 'those three plants': no such ones were named before",
    ),
    (
        GARDEN,
        AMIGA,
        "measure the nitrate at the tallest kale and bring it to the street gate",
        (
            "'and bring it to' does not fit at this point in 'measure the nitrate at the tallest kale and "
            "bring it to the street gate'"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        "bring the crates to the tool shed",
        "'bring the crates' asks for work that amiga has no action for",
    ),
    (PASTURE, HUSKY, "read CO2 in the pond", "pond is a keep-out zone"),
    (PASTURE, TRACTOR, "drive into the pond and take a picture inside", "pond is a keep-out zone"),
    (GARDEN, TRACTOR, "use the mower to film bed 4", "the request asks for nothing to be done"),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_each_wording_has_its_plan(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_what_is_left_open_is_asked(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_what_is_not_meant_is_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)
