"""Requests about fields as growers say them: plants by a size, references, samples of areas, sides of things."""

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
        GARDEN,
        AMIGA,
        "any bean that's shorter than 43 cm, I want a leaf off it",
        "for Where(height_cm, lt, 43, of Where(crop, eq, bean)): [sample_leaf]",
    ),
    (
        GARDEN,
        AMIGA,
        "any bean shorter than 0.43 m wants a picture",
        "for Where(height_cm, lt, 43, of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph any potatoes that are taller than 30 cm",
        "for Where(height_cm, gt, 30, of Where(crop, eq, potato)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "a leaf from any squash that is under 55 cm, please",
        "for Where(height_cm, lt, 55, of Where(crop, eq, squash)): [sample_leaf]",
    ),
    (
        GARDEN,
        AMIGA,
        "any beans over 50 cm, take a picture of them",
        "for Where(height_cm, gt, 50, of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph any two beans taller than 45 cm",
        "for Take(2, of Where(height_cm, gt, 45, of Where(crop, eq, bean))): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "take a leaf off every kale plant that's shorter than 65 cm",
        "for Where(height_cm, lt, 65, of Where(crop, eq, kale)): [sample_leaf]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the kale, but drive less than 200 m",
        "for Where(crop, eq, kale): [picture] | distance_m 200",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph either end of bed 2 and of bed 5",
        (
            "for UnionOf(InRow(1, 1, of UnionOf(Rows(2, 2)+Rows(5, 5)))+InRow(-1, -1, of UnionOf(Rows(2, "
            "2)+Rows(5, 5)))): [picture]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        "photograph either end of beds 2 and 5",
        (
            "for UnionOf(InRow(1, 1, of UnionOf(Rows(2, 2)+Rows(5, 5)))+InRow(-1, -1, of UnionOf(Rows(2, "
            "2)+Rows(5, 5)))): [picture]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        "photograph either end of bed 2 and bed 5",
        (
            "for UnionOf(InRow(1, 1, of UnionOf(Rows(2, 2)+Rows(5, 5)))+InRow(-1, -1, of UnionOf(Rows(2, "
            "2)+Rows(5, 5)))): [picture]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        "photograph either end of bed 2 and either end of bed 5",
        (
            "for UnionOf(InRow(1, 1, of UnionOf(Rows(2, 2)+Rows(5, 5)))+InRow(-1, -1, of UnionOf(Rows(2, "
            "2)+Rows(5, 5)))): [picture]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        "photograph either end of each bed",
        "for UnionOf(InRow(1, 1, of Rows)+InRow(-1, -1, of Rows)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "soil moisture at either end of the potato beds",
        (
            "for UnionOf(InRow(1, 1, of Rows(of Where(crop, eq, potato)))+InRow(-1, -1, of Rows(of "
            "Where(crop, eq, potato)))): [moisture]"
        ),
    ),
    (
        GARDEN,
        AMIGA,
        ("measure nitrate at six plants of bed 2, then go to whichever came out lowest and take a leaf from it"),
        "for Take(6, of Rows(2, 2)): [nitrate = r1]; go ByReading(r1, soil_nitrate, True); sample_leaf",
    ),
    (
        GARDEN,
        AMIGA,
        "measure nitrate at six plants of bed 2, then sample a leaf from whichever was highest",
        "for Take(6, of Rows(2, 2)): [nitrate = r1]; sample_leaf @ ByReading(r1, soil_nitrate)",
    ),
    (
        GARDEN,
        AMIGA,
        "measure nitrate at six plants of bed 2 and photograph whichever of them turned out lowest",
        "for Take(6, of Rows(2, 2)): [nitrate = r1]; picture @ ByReading(r1, soil_nitrate, True)",
    ),
    (
        GARDEN,
        AMIGA,
        "measure moisture at six plants of bed 2, then photograph whichever is driest",
        "for Take(6, of Rows(2, 2)): [moisture = r1]; picture @ ByReading(r1, soil_moisture, True)",
    ),
    (
        GARDEN,
        AMIGA,
        "measure moisture at six plants of bed 2, then photograph the one that was highest",
        "for Take(6, of Rows(2, 2)): [moisture = r1]; picture @ ByReading(r1, soil_moisture)",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "a thermal picture of the five melons with the lowest moisture on our list",
        "for Top(moisture, 5, True, of Where(crop, eq, melon)): [picture]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "thermal pictures of the three aubergines with the highest moisture in our records",
        "for Top(moisture, 3, of Where(crop, eq, aubergine)): [picture]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "thermal pictures of the melons with a moisture below 26 on record",
        "for Where(moisture, lt, 26, of Where(crop, eq, melon)): [picture]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "thermal pictures of the 4 driest melons going by our records",
        "for Top(moisture, 4, True, of Where(crop, eq, melon)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "measure moisture halfway along bed 3 and photograph every radish in it",
        "moisture @ Middle(of Rows(3, 3)); for Where(crop, eq, radish, of Rows(3, 3)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "measure moisture at the last plant of bed 2, then photograph each potato in it",
        "moisture @ InRow(-1, -1, of Rows(2, 2)); for Where(crop, eq, potato, of Rows(2, 2)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "measure moisture halfway along bed 3. Over 40 percent, take a picture of every radish in it",
        (
            "moisture @ Middle(of Rows(3, 3)) = r1; if r1 > 40 percent: [for Where(crop, eq, radish, of "
            "Rows(3, 3)): [picture]]"
        ),
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture except the cowslip patch",
        "mow area Excluding(InZone(cowslip patch), of InZone(long pasture))",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture but not the cowslip patch",
        "mow area Excluding(InZone(cowslip patch), of InZone(long pasture))",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture. Leave the cowslip patch standing",
        "mow area Excluding(InZone(cowslip patch), of InZone(long pasture))",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture and leave the cowslip patch uncut, and keep 5 metres off the pond",
        "mow area Excluding(InZone(cowslip patch), of InZone(long pasture)) | avoid InZone(pond) 5 m",
    ),
    (
        PASTURE,
        TRACTOR,
        "cut the long pasture, but leave the cowslip patch and the boggy corner as they are",
        "mow area Excluding(UnionOf(InZone(cowslip patch)+InZone(boggy corner)), of InZone(long pasture))",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture without touching the boggy corner",
        "mow area Excluding(InZone(boggy corner), of InZone(long pasture))",
    ),
    (
        PASTURE,
        TRACTOR,
        "Time to mow the long pasture. Leave out the cowslip patch.",
        "mow area Excluding(InZone(cowslip patch), of InZone(long pasture))",
    ),
    (
        PASTURE,
        AMIGA,
        (
            "try six random spots on the bank for moisture; should the average come out over 45 percent, do "
            "six more in the boggy corner"
        ),
        (
            "for PointsIn(bank, 6, True): [moisture = r1]; if mean(r1 > 45 percent): [for PointsIn(boggy "
            "corner, 6, True): [moisture]]"
        ),
    ),
    (
        PASTURE,
        AMIGA,
        (
            "moisture at six random spots in the boggy corner; if the average is over 45 percent, do six "
            "more on the bank"
        ),
        (
            "for PointsIn(boggy corner, 6, True): [moisture = r1]; if mean(r1 > 45 percent): [for "
            "PointsIn(bank, 6, True): [moisture]]"
        ),
    ),
    (
        PASTURE,
        AMIGA,
        "nitrate at four random spots on the bank, then four more in the boggy corner",
        "for PointsIn(bank, 4, True): [nitrate]; for PointsIn(boggy corner, 4, True): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "nitrate at four spots on the bank, then four more spots in the boggy corner",
        "for PointsIn(bank, 4): [nitrate]; for PointsIn(boggy corner, 4): [nitrate]",
    ),
    (
        GARDEN,
        AMIGA,
        "moisture at three random plants in bed 2, then three more readings in bed 3",
        "for RandomSample(3, of Rows(2, 2)): [moisture]; for RandomSample(3, 1, of Rows(3, 3)): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "moisture at three random plants in bed 2; if the mean is below 20 percent, do three more in bed 3",
        (
            "for RandomSample(3, of Rows(2, 2)): [moisture = r1]; if mean(r1 < 20 percent): [for "
            "RandomSample(3, 1, of Rows(3, 3)): [moisture]]"
        ),
    ),
    (GARDEN, AMIGA, "try three plants of bed 4 for nitrate", "for Take(3, of Rows(4, 4)): [nitrate]"),
    (GARDEN, AMIGA, "try every radish for moisture at 20 cm", "for Where(crop, eq, radish): [moisture(depth_cm 20)]"),
    (
        GARDEN,
        AMIGA,
        "nitrate in both potato beds, four spots in each, nicely spread out",
        "for Quota(row, 4, of Rows(of Where(crop, eq, potato))): [nitrate]",
    ),
    (
        GARDEN,
        AMIGA,
        "stick the nitrate probe in both potato beds, three spots in each",
        "for Quota(row, 3, of Rows(of Where(crop, eq, potato))): [nitrate]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph four evenly spread plants in each potato bed",
        "for Quota(row, 4, of Rows(of Where(crop, eq, potato))): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "soil moisture at three spots in each of beds 2 and 4, well spread",
        "for Quota(row, 3, of UnionOf(Rows(2, 2)+Rows(4, 4))): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "soil moisture in beds 2 and 4, three plants each",
        "for Quota(row, 3, of UnionOf(Rows(2, 2)+Rows(4, 4))): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph bed 2 and bed 4, at three plants in each",
        "for Quota(row, 3, of UnionOf(Rows(2, 2)+Rows(4, 4))): [picture]",
    ),
    (
        PASTURE,
        AMIGA,
        "nitrate on the bank and in the boggy corner, four spots in each, well spread out",
        "for UnionOf(PointsIn(bank, 4)+PointsIn(boggy corner, 4)): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "nitrate on the bank and in the boggy corner, four readings in each",
        "for UnionOf(PointsIn(bank, 4)+PointsIn(boggy corner, 4)): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        ("what's the average nitrate on the bank, and in the boggy corner? Four spots in each should do, well spread."),
        "for UnionOf(PointsIn(bank, 4)+PointsIn(boggy corner, 4)): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "what's the average soil moisture on the bank? Five readings should do, well spread.",
        "for PointsIn(bank, 5): [moisture]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "co2 in the hot bay and in the mild bay, five readings in each, well spread",
        "for UnionOf(Spread(5, of InZone(hot bay))+Spread(5, of InZone(mild bay))): [co2]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "co2 in the hot bay and the mild bay, five readings in each",
        "for UnionOf(Spread(5, of InZone(hot bay))+Spread(5, of InZone(mild bay))): [co2]",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the long pasture but leave the cowslips standing",
        "mow area Excluding(InZone(cowslip patch), of InZone(long pasture))",
    ),
    (PASTURE, AMIGA, "soil nitrate at five spots in the cowslips", "for PointsIn(cowslip patch, 5): [nitrate]"),
    (GARDEN, AMIGA, "soil moisture in the roses", "moisture @ PointsIn(rose bed)"),
    (
        PASTURE,
        AMIGA,
        (
            "walk a W over the long pasture with fifteen nitrate readings on the way, without setting a "
            "wheel in the cowslips"
        ),
        "for Transect(15, long pasture): [nitrate] | avoid InZone(cowslip patch)",
    ),
    (
        PASTURE,
        AMIGA,
        "soil moisture on the bank, and don't set foot in the boggy corner",
        "moisture @ PointsIn(bank) | avoid InZone(boggy corner)",
    ),
    (
        PASTURE,
        AMIGA,
        "nitrate on the bank, without straying into the cowslips",
        "nitrate @ PointsIn(bank) | avoid InZone(cowslip patch)",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        ("what's the average co2 in the hot bay, and in the mild one? Five readings in each should do, well spread"),
        "for UnionOf(Spread(5, of InZone(hot bay))+Spread(5, of InZone(mild bay))): [co2]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "keep out of the hot bay and read co2 at five places in the mild one",
        "for PointsIn(mild bay, 5): [co2] | avoid InZone(hot bay)",
    ),
    (
        PASTURE,
        AMIGA,
        "soil moisture on the bank, one probe every 10 metres each way, 10 cm deep",
        "for Grid(10, bank): [moisture(depth_cm 10)]",
    ),
    (
        PASTURE,
        AMIGA,
        "I need soil moisture on the bank, one reading every 10 m in both directions",
        "for Grid(10, bank): [moisture]",
    ),
    (PASTURE, AMIGA, "nitrate in the boggy corner every 8 metres both ways", "for Grid(8, boggy corner): [nitrate]"),
    (
        PASTURE,
        AMIGA,
        "measure nitrate in the boggy corner every 8 metres each way at 25 cm",
        "for Grid(8, boggy corner): [nitrate(depth_cm 25)]",
    ),
]

ASKED = [
    (GARDEN, AMIGA, "photograph any bean", 2),
    (GARDEN, AMIGA, "photograph either end of bed 2", 2),
    (GARDEN, AMIGA, "sample a leaf from the tall ones in bed 4", 2),
    (GARDEN, AMIGA, "photograph the tall beans", 2),
    (GARDEN, AMIGA, "photograph the short squashes", 2),
    (PASTURE, AMIGA, "do a soil test in three places on the bank", 2),
    (PASTURE, AMIGA, "take a soil reading in the boggy corner", 2),
    (GARDEN, AMIGA, "soil tests at every radish", 2),
    (GARDEN, AMIGA, "a soil test at plant V12, 20 cm deep", 2),
]

REFUSED = [
    (GARDEN, AMIGA, "photograph the kale, shorter than 200 m", "'shorter than 200 m'"),
    (
        GARDEN,
        AMIGA,
        "photograph any kale under 20 cm",
        "nothing on this site matches the trees whose crop is kale, whose height is below 20 cm",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph any of the beans that are under 43 cm",
        "'photograph any of the beans that are under 43 cm': it is not clear what is measured, and where",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "any melon that's shorter than 3 m, take a thermal picture of it",
        "'shorter than': this site records no height of its trees",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "take a thermal picture of the mint plants that are shorter than 3 m",
        "'shorter than': this site records no height of its trees",
    ),
    (GLASSHOUSE, HUSKY, "a thermal picture of any aubergine under 20 cm", "'under 20 cm'"),
    (GARDEN, AMIGA, "photograph the kale within 20 cm", "'within 20 cm'"),
    (
        GARDEN,
        AMIGA,
        "photograph whichever came out lowest",
        "'photograph whichever came out lowest': nothing before it measures that",
    ),
    (GLASSHOUSE, HUSKY, "a thermal picture of the tall melons", "'of the tall melons'"),
    (
        GARDEN,
        AMIGA,
        "measure moisture halfway along bed 3 and photograph every radish there",
        "'photograph every radish there': it is not clear where that is",
    ),
    (
        GARDEN,
        AMIGA,
        "measure moisture at plant V33 and photograph every radish in it",
        "'photograph every radish in it': it is not clear where that is",
    ),
    (PASTURE, TRACTOR, "leave the cowslip patch standing", "each word is known, but not what they say together"),
    (
        PASTURE,
        AMIGA,
        "moisture at six random spots on the bank; if the average is over 45 percent, take six more",
        "'more'",
    ),
    (PASTURE, TRACTOR, "mow the daisies", "not understood: 'daisies'"),
    (
        GARDEN,
        AMIGA,
        "at plant V12 measure soil moisture. If it is below 20 percent take a picture, otherwise take 2 more",
        "'more'",
    ),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_a_request_about_a_field_has_its_plan(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_what_the_site_does_not_tell_is_asked(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_what_a_field_lacks_is_refused_with_the_reason(
    site: Site, robot: RobotProfile, request_: str, why: str
) -> None:
    require_refusal(site, robot, request_, why)
