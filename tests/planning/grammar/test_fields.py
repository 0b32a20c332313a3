"""Requests about fields that are no orchards: crops as nouns, beds, ground without plants, gates, parts of areas."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from planning.english.outlines import outline
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

PLANNED = [
    (GARDEN, AMIGA, "photograph every single squash", "for Where(crop, eq, squash): [picture]"),
    (GARDEN, AMIGA, "photograph the potatoes", "for Where(crop, eq, potato): [picture]"),
    (GARDEN, AMIGA, "take a picture of each radish", "for Where(crop, eq, radish): [picture]"),
    (GARDEN, AMIGA, "a picture of the tallest bean", "picture @ Top(height_cm, 1, of Where(crop, eq, bean))"),
    (
        GARDEN,
        AMIGA,
        "photograph the three shortest potatoes",
        "for Top(height_cm, 3, True, of Where(crop, eq, potato)): [picture]",
    ),
    (GARDEN, AMIGA, "photograph every third potato", "for EveryNth(3, of Where(crop, eq, potato)): [picture]"),
    (GARDEN, AMIGA, "photograph the kale", "for Where(crop, eq, kale): [picture]"),
    (GARDEN, AMIGA, "photograph five beans at random", "for RandomSample(5, of Where(crop, eq, bean)): [picture]"),
    (
        GARDEN,
        AMIGA,
        "photograph beans and radishes",
        "for UnionOf(Where(crop, eq, bean)+Where(crop, eq, radish)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the radishes, the beans and the kale",
        "for UnionOf(Where(crop, eq, radish)+Where(crop, eq, bean)+Where(crop, eq, kale)): [picture]",
    ),
    (GARDEN, AMIGA, "photograph the potato plants in bed 2", "for Where(crop, eq, potato, of Rows(2, 2)): [picture]"),
    (GARDEN, AMIGA, "photograph the squash bed", "for Rows(5, 5): [picture]"),
    (
        GARDEN,
        AMIGA,
        "photograph both ends of the squash bed",
        "for UnionOf(InRow(1, 1, of Rows(5, 5))+InRow(-1, -1, of Rows(5, 5))): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the first plant of each potato bed",
        "for InRow(1, 1, of Rows(of Where(crop, eq, potato))): [picture]",
    ),
    (GARDEN, AMIGA, "photograph the netted beds", "for Rows(of Where(netted, eq, True)): [picture]"),
    (
        GARDEN,
        AMIGA,
        "take a picture in the middle of every bed except the netted ones",
        "for UnionOf(Middle(of Rows(1, 1))+Middle(of Rows(2, 2))+Middle(of Rows(5, 5))+Middle(of Rows(6, "
        "6))): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "one picture halfway down each bed, but skip the netted ones",
        "for UnionOf(Middle(of Rows(1, 1))+Middle(of Rows(2, 2))+Middle(of Rows(5, 5))+Middle(of Rows(6, "
        "6))): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the potatoes under 20 cm tall",
        "for Where(height_cm, lt, 20, of Where(crop, eq, potato)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the potatoes that have not reached 18 cm yet",
        "for Where(height_cm, lt, 18, of Where(crop, eq, potato)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the plants between 50 and 60 cm high",
        "for Where(height_cm, le, 60, of Where(height_cm, ge, 50)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the beans taller than 0.45 m",
        "for Where(height_cm, gt, 45, of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the squash plants with frost damage",
        "for Where(frost_damage, eq, True, of Where(crop, eq, squash)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the squashes without frost damage",
        "for Where(frost_damage, eq, False, of Where(crop, eq, squash)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the squashes with frost damage and the plants on either side of them",
        "for UnionOf(Where(frost_damage, eq, True, of Where(crop, eq, squash))+TreeIs(V58)+TreeIs(V56)+"
        "TreeIs(V54)+TreeIs(V52)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the bean closest to the heap",
        "picture @ Nearest(InZone(manure heap), of Where(crop, eq, bean))",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the potato nearest the river gate",
        "picture @ Nearest(GateIs(river gate), of Where(crop, eq, potato))",
    ),
    (GARDEN, AMIGA, "photograph the plant nearest the tool shed", "picture @ Nearest(Marker(start))"),
    (GARDEN, AMIGA, "soil moisture at every plant in beds 2 to 4", "for Rows(2, 4): [moisture]"),
    (GARDEN, AMIGA, "soil moisture at 3 plants in each bed", "for Quota(row, 3, of Rows): [moisture]"),
    (
        GARDEN,
        AMIGA,
        "soil moisture at four radishes spread evenly along the bed, then at the rest of the radishes",
        "for Evenly(4, of Where(crop, eq, radish, of Rows(3, 3))): [moisture]; for Excluding(Evenly(4, "
        "of Where(crop, eq, radish, of Rows(3, 3))), of Where(crop, eq, radish)): [moisture]",
    ),
    (GARDEN, AMIGA, "soil moisture in the rose bed", "moisture @ PointsIn(rose bed)"),
    (GARDEN, AMIGA, "soil moisture at both gates", "for UnionOf(GateIs(street gate)+GateIs(river gate)): [moisture]"),
    (
        GARDEN,
        AMIGA,
        "photograph the fourth squash",
        "picture @ InRow(4, 4, of Where(crop, eq, squash, of Rows(5, 5)))",
    ),
    (GARDEN, AMIGA, "photograph every plant on the allotment", "for Trees: [picture]"),
    (
        GARDEN,
        AMIGA,
        "photograph the easternmost plant of each bed",
        "for UnionOf(Extreme(east, of Rows(1, 1))+Extreme(east, of Rows(2, 2))+Extreme(east, of Rows(3, 3))+"
        "Extreme(east, of Rows(4, 4))+Extreme(east, of Rows(5, 5))+Extreme(east, of Rows(6, 6))): [picture]",
    ),
    (GARDEN, AMIGA, "photograph the unnetted plants", "for Where(netted, eq, False): [picture]"),
    (GARDEN, TRACTOR, "spray beds 1 to 3", "spray rows Rows(1, 3)"),
    (GARDEN, TRACTOR, "spray the potatoes", "spray rows Where(crop, eq, potato)"),
    (GARDEN, TRACTOR, "film the bean bed", "film rows Rows(4, 4)"),
    (GLASSHOUSE, AMIGA, "photograph the aubergines", "for Where(crop, eq, aubergine): [picture]"),
    (
        GLASSHOUSE,
        AMIGA,
        "photograph the third Long Tom",
        "picture @ InRow(3, 3, of Where(cultivar, eq, Long Tom, of Rows(2, 2)))",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "photograph the Black King closest to the seedling table",
        "picture @ Nearest(InZone(seedling table), of Where(cultivar, eq, Black King))",
    ),
    (GLASSHOUSE, AMIGA, "photograph bed 3", "for Rows(3, 3): [picture]"),
    (GLASSHOUSE, AMIGA, "photograph the beds in the mild bay", "for InZone(mild bay, of Rows): [picture]"),
    (GLASSHOUSE, AMIGA, "photograph the mint", "for Where(crop, eq, mint): [picture]"),
    (
        GLASSHOUSE,
        AMIGA,
        "photograph the staked plants in the hot bay",
        "for Where(staked, eq, True, of InZone(hot bay)): [picture]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "photograph the hot bay aubergines",
        "for Where(crop, eq, aubergine, of InZone(hot bay)): [picture]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "photograph the melons recorded with a moisture below 27 percent",
        "for Where(moisture, lt, 27, of Where(crop, eq, melon)): [picture]",
    ),
    (GLASSHOUSE, AMIGA, "photograph the driest melon", "picture @ Top(moisture, 1, True, of Where(crop, eq, melon))"),
    (GLASSHOUSE, AMIGA, "photograph the last plant of each bed", "for InRow(-1, -1, of Rows): [picture]"),
    (GLASSHOUSE, HUSKY, "CO2 in the middle of the hot bay", "co2 @ PointsIn(hot bay)"),
    (
        GLASSHOUSE,
        AMIGA,
        "a leaf from each end of the melon bed",
        "for UnionOf(InRow(1, 1, of Rows(3, 3))+InRow(-1, -1, of Rows(3, 3))): [sample_leaf]",
    ),
    (
        PASTURE,
        AMIGA,
        "soil moisture at nine spots in the cow paddock, evenly spread",
        "for PointsIn(cow paddock, 9): [moisture]",
    ),
    (PASTURE, AMIGA, "soil moisture at six random places on the bank", "for PointsIn(bank, 6, True): [moisture]"),
    (
        PASTURE,
        AMIGA,
        "soil moisture at ten points in the northern half of the long pasture",
        "for PointsIn(long pasture, 10, north): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "twelve nitrate readings in the western half of the cow paddock",
        "for PointsIn(cow paddock, 12, west): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "lay a 30 m grid over the long pasture and take nitrate at every point, except in the boggy corner",
        "for InZone(boggy corner, True, of Grid(30, long pasture)): [nitrate]",
    ),
    (
        PASTURE,
        AMIGA,
        "nitrate on a 40 m grid over the cow paddock, leaving out the bank",
        "for InZone(bank, True, of Grid(40, cow paddock)): [nitrate]",
    ),
    (PASTURE, AMIGA, "walk a W across the bank with ten nitrate readings", "for Transect(10, bank): [nitrate]"),
    (
        PASTURE,
        AMIGA,
        "soil moisture at random spots on the bank until the mean is known to within 5 percent, at most 25 points",
        "for PointsIn(bank, 25, True) at most 25 until mean(r1) +- 5 % from 5: [moisture = r1]",
    ),
    (PASTURE, TRACTOR, "mow the cowslips' patch", "mow area InZone(cowslip patch)"),
    (PASTURE, TRACTOR, "mow the northern half of the cow paddock", "mow area Half(north, of InZone(cow paddock))"),
    (PASTURE, TRACTOR, "mow everything except the cowslip patch", "mow area Excluding(InZone(cowslip patch))"),
    (PASTURE, TRACTOR, "mow the common", "mow area Trees"),
    (PASTURE, TRACTOR, "mow the bank. Use the middle gate.", "mow area InZone(bank) | only middle gate"),
    (
        PASTURE,
        TRACTOR,
        "mow the half of the cow paddock nearest the middle gate",
        "mow area Half(west, of InZone(cow paddock))",
    ),
    (PASTURE, AMIGA, "soil moisture at the gates", "for UnionOf(GateIs(middle gate)+GateIs(farm gate)): [moisture]"),
    (PASTURE, TRACTOR, "mow the pasture", "mow area InZone(long pasture)"),
    (
        GARDEN,
        AMIGA,
        "go to the beans and photograph every second one",
        "for EveryNth(2, of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "a leaf of the shortest bean and one of the tallest",
        "for UnionOf(Top(height_cm, 1, True, of Where(crop, eq, bean))+Top(height_cm, 1, of Where(crop, eq, bean))): "
        "[sample_leaf]",
    ),
    (
        GARDEN,
        AMIGA,
        "soil moisture in the rose bed and in the manure heap",
        "for UnionOf(PointsIn(rose bed)+PointsIn(manure heap)): [moisture]",
    ),
    (
        GARDEN,
        AMIGA,
        "photograph the two biggest potatoes",
        "for Top(height_cm, 2, of Where(crop, eq, potato)): [picture]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "photograph two staked and two unstaked plants",
        "for UnionOf(Take(2, of Where(staked, eq, True))+Take(2, of Where(staked, eq, False))): [picture]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "measure the soil moisture at all melons. Photograph those with a moisture above 30.",
        "for Where(crop, eq, melon): [moisture = r1; if r1 > 30 percent: [picture]]",
    ),
]

#: Requests with the number of their readings; 0 for an open question.
ASKED = [
    (GARDEN, AMIGA, "photograph the bean nearest the gate", 2),
    (GARDEN, AMIGA, "photograph the potato bed", 2),
    (GARDEN, AMIGA, "photograph the far end of bed 3", 2),
    (PASTURE, TRACTOR, "mow the paddock", 2),
    (PASTURE, AMIGA, "soil moisture at the bottom of the bank", 4),
    (PASTURE, AMIGA, "soil moisture at random spots on the bank", 0),
    (PASTURE, TRACTOR, "mow the half nearest the farm gate", 3),
    (PASTURE, TRACTOR, "mow the bank and use the gate", 2),
    (GARDEN, AMIGA, "six soil moisture readings in the rose bed and in the manure heap", 0),
    (GLASSHOUSE, AMIGA, "at each melon, take a leaf if the moisture is under 25 percent", 0),
]

REFUSED = [
    (
        GLASSHOUSE,
        HUSKY,
        "measure the soil moisture in bed 3",
        "husky cannot read the soil moisture: no action 'read_soil_moisture'",
    ),
    (GARDEN, AMIGA, "photograph the carrots", "'carrots': none of the plants here is of this kind"),
    (GARDEN, AMIGA, "photograph the tomato bed", "'tomato': none of the plants here is of this kind"),
    (GLASSHOUSE, AMIGA, "photograph bed 9", "there is no row '9' in block mild bay, block hot bay"),
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


def test_beds_and_rows_are_the_same_plants() -> None:
    by_bed, by_row = (EnglishPlanner().plan(f"photograph {word} 2", GARDEN, AMIGA) for word in ("bed", "row"))
    assert isinstance(by_bed, Planned)
    assert isinstance(by_row, Planned)
    assert outline(by_bed.task) == outline(by_row.task)
