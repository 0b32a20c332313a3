"""Amounts, parts of groups and exceptions as strangers say them: planned, asked about, or refused with the reason."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline
from planning.grammar.field_requests import name, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GLASSHOUSE, GARDEN, PASTURE, DEMO = glasshouse(), vegetable_garden(), pasture(), open_site("demo")
HUSKY, AMIGA = load_robot("husky"), load_robot("amiga")

PLANNED = [
    (
        GLASSHOUSE,
        AMIGA,
        "Three leaf samples from each aubergine cultivar, but none from row 1.",
        "for Quota(cultivar, 3, of Excluding(Rows(1, 1), of Where(crop, eq, aubergine))): [sample_leaf]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Two leaf samples from each crop, but nothing from the mild bay.",
        "for Quota(crop, 2, of Excluding(InZone(mild bay))): [sample_leaf]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Take leaf samples from four plants per crop. Leave out row 3.",
        "for Quota(crop, 4, of Excluding(Rows(3, 3))): [sample_leaf]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "A leaf sample from six random plants, none of them in row 4.",
        "for RandomSample(6, of Excluding(Rows(4, 4))): [sample_leaf]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Two leaf samples per cultivar in the hot bay.",
        "for Quota(cultivar, 2, of InZone(hot bay)): [sample_leaf]",
    ),
    (
        GARDEN,
        AMIGA,
        "Pictures of ten random plants, but no kale.",
        "for RandomSample(10, of Excluding(Where(crop, eq, kale))): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Leave out the netted beds and take thermal pictures of two plants in each of the others.",
        "for Quota(row, 2, of Excluding(Rows(of Where(netted, eq, True)), of Rows)): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Skip beds 1 and 2. Read CO2 at the first plant of each of the other beds.",
        "for InRow(1, 1, of Excluding(UnionOf(Rows(1, 1)+Rows(2, 2)), of Rows)): [co2]",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of the first plant of beds 3 and 4. In each of the other beds read CO2 at two plants.",
        "for InRow(1, 1, of UnionOf(Rows(3, 3)+Rows(4, 4))): [picture]; for Quota(row, 2, of "
        "Excluding(UnionOf(Rows(3, 3)+Rows(4, 4)), of Rows)): [co2]",
    ),
    (
        GARDEN,
        AMIGA,
        "Test nitrate 30 cm down in the middle of every bed, but not in the kale.",
        "for UnionOf(Middle(of Rows(1, 1))+Middle(of Rows(2, 2))+Middle(of Rows(3, 3))+Middle(of "
        "Rows(4, 4))+Middle(of Rows(5, 5))): [nitrate(depth_cm 30)]",
    ),
    (
        GARDEN,
        AMIGA,
        "Moisture in the middle of every bed apart from the potato ones.",
        "for UnionOf(Middle(of Rows(3, 3))+Middle(of Rows(4, 4))+Middle(of Rows(5, 5))+Middle(of "
        "Rows(6, 6))): [moisture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Five thermal pictures of the beans, not all of them.",
        "for Take(5, of Where(crop, eq, bean)): [picture]",
    ),
    (GARDEN, HUSKY, "Thermal pictures of one of the beans.", "picture @ Take(1, of Where(crop, eq, bean))"),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of all but two of the beans.",
        "for Excluding(Take(2, of Where(crop, eq, bean)), of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of all but one of the beans.",
        "for Excluding(Take(1, of Where(crop, eq, bean)), of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of all but the two tallest beans.",
        "for Excluding(Top(height_cm, 2, of Where(crop, eq, bean)), of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of every bean but the first.",
        "for Excluding(InRow(1, 1, of Rows(4, 4)), of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of all the beans but three.",
        "for Excluding(Take(3, of Where(crop, eq, bean)), of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of roughly half of the potatoes.",
        "for Quota(50, of Where(crop, eq, potato)): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of a good third of the potatoes.",
        "for Quota(33.33, of Where(crop, eq, potato)): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of every third bean, beginning with the first one in the row.",
        "for EveryNth(3, of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of every third bean. Begin with the second in the bed.",
        "for EveryNth(3, 2, of Where(crop, eq, bean)): [picture]",
    ),
    (
        GARDEN,
        AMIGA,
        "Keep measuring soil moisture at random potatoes until you know the mean to within two percent, "
        "but take no more than twelve readings.",
        "for RandomSample(12, of Where(crop, eq, potato)) at most 12 until mean(r1) +- 2 % from 5: [moisture = r1]",
    ),
    (
        GARDEN,
        AMIGA,
        "Measure soil moisture at the beans. Stop after three readings below 25 percent.",
        "for Where(crop, eq, bean) until count(r1 < 25 percent) >= 3: [moisture = r1]",
    ),
    (
        GARDEN,
        AMIGA,
        "Measure soil moisture at the beans until you have three readings under 20 percent.",
        "for Where(crop, eq, bean) until count(r1 < 20 percent) >= 3: [moisture = r1]",
    ),
    (
        GARDEN,
        AMIGA,
        "For my report I need the soil nitrate at 30 cm, next to three randomly chosen plants of each "
        "crop. Give me the average for each crop.",
        "for Quota(crop, 3, random): [nitrate(depth_cm 30)]",
    ),
    (
        GLASSHOUSE,
        HUSKY,
        "Thermal pictures of three staked and three unstaked plants of the mild bay, chosen at random, "
        "and compare the means.",
        "for UnionOf(RandomSample(3, of Where(staked, eq, True, of InZone(mild bay)))+RandomSample(3, "
        "1, of Where(staked, eq, False, of InZone(mild bay)))): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "I am writing about nets. Thermal pictures of two netted and two unnetted plants, chosen at "
        "random, and compare the means.",
        "for UnionOf(RandomSample(2, of Where(netted, eq, True))+RandomSample(2, 1, of Where(netted, "
        "eq, False))): [picture]",
    ),
    (
        GARDEN,
        HUSKY,
        "Thermal pictures of two plants with frost damage and two without, at random.",
        "for UnionOf(RandomSample(2, of Where(frost_damage, eq, True))+RandomSample(2, 1, of "
        "Where(frost_damage, eq, False))): [picture]",
    ),
    (
        PASTURE,
        HUSKY,
        "Three air temperature readings in the boggy corner and three on the bank, one minute apart.",
        "air @ PointsIn(boggy corner); wait 60; air; wait 60; air; air @ PointsIn(bank); wait 60; air; wait 60; air",
    ),
    (
        PASTURE,
        HUSKY,
        "Three CO2 readings in the boggy corner, two on the bank and two in the cowslip patch, five minutes apart.",
        "co2 @ PointsIn(boggy corner); wait 300; co2; wait 300; co2; co2 @ PointsIn(bank); wait 300; "
        "co2; co2 @ PointsIn(cowslip patch); wait 300; co2",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Photograph the melons which are still missing from that mission.",
        "for DoneEarlier(left_out, missions 1, of Where(crop, eq, melon)): [picture]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Yesterday you had to stop early, so please photograph the melons which are still missing from that mission.",
        "for DoneEarlier(left_out, calendar yesterday, of Where(crop, eq, melon)): [picture]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Yesterday's mission was cut short. Photograph the plants that were left out.",
        "for DoneEarlier(left_out, calendar yesterday): [picture]",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Photograph the melons that are still outstanding from yesterday.",
        "for DoneEarlier(left_out, calendar yesterday, of Where(crop, eq, melon)): [picture]",
    ),
    (DEMO, HUSKY, "Read CO2 next to trees 4 and 9.", "for UnionOf(TreeIs(4)+TreeIs(9)): [co2]"),
    (DEMO, HUSKY, "Photograph one of the yellow trees.", "picture @ Take(1, of Where(leaf_color, eq, yellow))"),
]

#: Requests with the number of answers.
ASKED = [
    (GARDEN, AMIGA, "Leaf samples from some of the potatoes for the laboratory.", 3),
    (GARDEN, HUSKY, "Take some thermal pictures in the squash, not the whole lot.", 2),
    (GARDEN, HUSKY, "Thermal pictures of the beans. Not all of them.", 2),
    (GLASSHOUSE, HUSKY, "Read CO2 at plant number 8 in the mild bay.", 2),
]

REFUSED = [
    (GARDEN, HUSKY, "Thermal pictures of two plants in each of the others.", "it is not clear which rows are meant"),
    (
        GARDEN,
        HUSKY,
        "Ignore the kale and photograph three plants in every other bed.",
        "'in every other bed' does not fit at this point in 'Ignore the kale and photograph three "
        "plants in every other bed'",
    ),
    (
        GARDEN,
        AMIGA,
        "Measure soil moisture at the beans. Stop when two readings in a row are below 25 percent.",
        "'two readings in a row are below 25 percent': readings that follow each other are not counted by themselves",
    ),
    (
        GARDEN,
        AMIGA,
        "Measure soil moisture at each bean until three consecutive readings are above 30 percent.",
        "'three consecutive readings are above 30 percent': readings that follow each other are not "
        "counted by themselves",
    ),
    (
        PASTURE,
        HUSKY,
        "Take ten CO2 readings in the long pasture, but none in the cowslip patch.",
        "so many points of bare ground are spread over all of it",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Yesterday you had to stop early. Photograph row 2, every plant.",
        "'Yesterday' refers to an earlier mission, but not clearly enough",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Take a photo of each strawberry in row 2.",
        "'strawberry': none of the plants here is of this kind",
    ),
    (
        GLASSHOUSE,
        AMIGA,
        "Leaf samples from three courgettes and three melons.",
        "'courgettes': none of the plants here is of this kind",
    ),
    (GARDEN, AMIGA, "Photograph the sweet potatoes.", "'sweet potatoes': none of the plants here is of this kind"),
]


@pytest.mark.parametrize(("site", "robot", "request_text", "plan"), PLANNED, ids=name)
def test_amounts_and_exceptions(site: Site, robot: RobotProfile, request_text: str, plan: str) -> None:
    outcome = EnglishPlanner().plan(request_text, site, robot)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).removesuffix(" | return_to_start") == plan


@pytest.mark.parametrize(("site", "robot", "request_text", "ways"), ASKED, ids=name)
def test_how_many_or_which_is_asked(site: Site, robot: RobotProfile, request_text: str, ways: int) -> None:
    require_question(site, robot, request_text, ways)


@pytest.mark.parametrize(("site", "robot", "request_text", "why"), REFUSED, ids=name)
def test_refused_with_the_reason(site: Site, robot: RobotProfile, request_text: str, why: str) -> None:
    require_refusal(site, robot, request_text, why)
