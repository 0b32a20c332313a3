"""Clauses around work in fields: what is left standing, up and down, both sides in turn, the end of a mission."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline
from support.sites.gardens import glasshouse, pasture, vegetable_garden

DEMO, GARDEN, GLASSHOUSE, PASTURE = open_site("demo"), vegetable_garden(), glasshouse(), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")
WITHOUT_COWSLIPS = "mow area Excluding(InZone(cowslip patch), of InZone(long pasture))"
TO_AND_FRO = "3 times: [go TreeIs(4); picture; go TreeIs(9); picture]"
TWO_IN_EACH = "for Quota(row, 2, of UnionOf(Rows(3, 3)+Rows(4, 4))): [co2]"

PLANNED = [
    (
        GARDEN,
        AMIGA,
        "Measure nitrate in the beans and in the radishes, at two spots in each bed.",
        "for Quota(row, 2, of UnionOf(Where(crop, eq, bean)+Where(crop, eq, radish))): [nitrate]",
    ),
    (DEMO, HUSKY, "Read CO2 in rows 3 and 4, at 2 trees in each row.", TWO_IN_EACH),
    (DEMO, HUSKY, "Read CO2 in row 3 and in row 4, at two trees in each row, spread along its length.", TWO_IN_EACH),
    (
        PASTURE,
        AMIGA,
        "Read the soil moisture on a grid of points 20 m apart over the long pasture.",
        "for Grid(20, long pasture): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "Measure soil moisture at random spots on the bank until the mean is known to within 2 percent,"
        " with a maximum of 12",
        "for PointsIn(bank, 12, True) at most 12 until mean(r1) +- 2 % from 5: [moisture = r1]",
    ),
    (PASTURE, TRACTOR, "Mow the long pasture. Leave the cowslip patch standing.", WITHOUT_COWSLIPS),
    (PASTURE, TRACTOR, "Mow the long pasture but leave the cowslip patch uncut", WITHOUT_COWSLIPS),
    (PASTURE, TRACTOR, "Leave the cowslip patch standing and mow the long pasture.", WITHOUT_COWSLIPS),
    (PASTURE, TRACTOR, "Mow the long pasture. Skip the cowslip patch.", WITHOUT_COWSLIPS),
    (PASTURE, TRACTOR, "Mow the long pasture, but don't mow the cowslip patch.", WITHOUT_COWSLIPS),
    (PASTURE, TRACTOR, "Time to cut the long pasture. Leave out the cowslip patch.", WITHOUT_COWSLIPS),
    (PASTURE, TRACTOR, "Mow the long pasture and leave the cowslip patch as it is.", WITHOUT_COWSLIPS),
    (DEMO, TRACTOR, "spray rows 3 to 8. Skip row 5.", "spray rows Excluding(Rows(5, 5), of Rows(3, 8))"),
    (DEMO, TRACTOR, "spray rows 3 to 8 but leave row 5 alone", "spray rows Excluding(Rows(5, 5), of Rows(3, 8))"),
    (
        DEMO,
        TRACTOR,
        "photograph row 3 and spray rows 4 to 8, but leave out row 5",
        "for Rows(3, 3): [picture]; spray rows Excluding(Rows(5, 5), of Rows(4, 8))",
    ),
    (PASTURE, TRACTOR, "mow the bank up and down", "mow area InZone(bank)"),
    (PASTURE, TRACTOR, "mow the bank back and forth", "mow area InZone(bank)"),
    (PASTURE, TRACTOR, "mow the bank, up and down north to south", "mow area InZone(bank), heading north_south"),
    (PASTURE, TRACTOR, "mow the bank back and forth, east to west", "mow area InZone(bank), heading east_west"),
    (PASTURE, TRACTOR, "mow the bank. Go to and fro from east to west.", "mow area InZone(bank), heading east_west"),
    (PASTURE, TRACTOR, "mow the bank north-south, up and down", "mow area InZone(bank), heading north_south"),
    (DEMO, TRACTOR, "film row 3, down one side and back up the other", "film rows Rows(3, 3), both"),
    (DEMO, TRACTOR, "film row 3, one side and then the other", "film rows Rows(3, 3), both"),
    (DEMO, TRACTOR, "spray row 3 on one side and back on the other side", "spray rows Rows(3, 3), both"),
    (DEMO, TRACTOR, "film row 3. Go up one side and down the other.", "film rows Rows(3, 3), both"),
    (DEMO, TRACTOR, "spray one side and the other of row 3", "spray rows Rows(3, 3), both"),
    (DEMO, TRACTOR, "get row 3 on video", "film rows Rows(3, 3)"),
    (DEMO, TRACTOR, "I want rows 3 to 5 on film", "film rows Rows(3, 5)"),
    (DEMO, TRACTOR, "capture row 3 on video, along one side and back along the other", "film rows Rows(3, 3), both"),
    (PASTURE, TRACTOR, "film all the way round the edge of the bank", "film perimeter InZone(bank)"),
    (PASTURE, TRACTOR, "film right round the bank", "film perimeter InZone(bank)"),
    (PASTURE, TRACTOR, "mow the bank, nothing more, and then come home", "mow area InZone(bank)"),
    (DEMO, TRACTOR, "spray row 3, nothing else, then film row 4", "spray rows Rows(3, 3); film rows Rows(4, 4)"),
    (DEMO, TRACTOR, "spray row 3 and charge to 80 % at the charger", "spray rows Rows(3, 3); recharge to 80"),
    (DEMO, TRACTOR, "spray row 3, then charge up to 80 % at the charger", "spray rows Rows(3, 3); recharge to 80"),
    (DEMO, TRACTOR, "spray row 3, then at the charger charge to 80 %", "spray rows Rows(3, 3); recharge to 80"),
    (
        DEMO,
        TRACTOR,
        "Rows 3 and 4 need treating: spray them at 300 l/ha.",
        "spray rows UnionOf(Rows(3, 3)+Rows(4, 4)), rate_l_ha 300",
    ),
    (DEMO, TRACTOR, "Only row 3 needs attention. Film it from both sides.", "film rows Rows(3, 3), both"),
    (GLASSHOUSE, TRACTOR, "Only the melons need treating: spray those.", "spray rows Where(crop, eq, melon)"),
    (
        GLASSHOUSE,
        TRACTOR,
        "Just the aubergines need doing: spray those at 200 l/ha, and hold off as long as somebody is nearby.",
        "spray rows Where(crop, eq, aubergine), rate_l_ha 200 | return_to_start"
        " | at any time person_near: wait, then return_to_start",
    ),
    (PASTURE, TRACTOR, "The bank needs seeing to. Mow it.", "mow area InZone(bank)"),
    (PASTURE, HUSKY, "read the air temperature up on the bank", "air @ PointsIn(bank)"),
    (
        PASTURE,
        HUSKY,
        "read the air temperature in the middle of the boggy corner, then do the same up on the bank",
        "air @ PointsIn(boggy corner); air @ PointsIn(bank)",
    ),
    (
        PASTURE,
        HUSKY,
        "go to the boggy corner, read the air temperature and CO2, then do the same on the bank",
        "air @ PointsIn(boggy corner); co2; air @ PointsIn(bank); co2",
    ),
    (
        PASTURE,
        AMIGA,
        "soil moisture at six random spots on the bank. Do the same in the cow paddock.",
        "for PointsIn(bank, 6, True): [moisture]; for PointsIn(cow paddock, 6, True): [moisture]",
    ),
    (
        PASTURE,
        AMIGA,
        "walk a W across the bank with ten nitrate readings. Repeat that in the cow paddock.",
        "for Transect(10, bank): [nitrate]; for Transect(10, cow paddock): [nitrate]",
    ),
    (
        PASTURE,
        HUSKY,
        "be in the middle of the bank at sunrise tomorrow and read the air temperature there, then do the same in the "
        "cow paddock",
        "go PointsIn(bank); air; go PointsIn(cow paddock); air | day=tomorrow not_before=sunrise not_after=sunrise+15",
    ),
    (DEMO, HUSKY, "be at tree 4 at 6 am and read CO2 there", "go TreeIs(4); co2 | not_before=06:00 not_after=06:15"),
    (
        DEMO,
        HUSKY,
        "make sure you're at tree 4 at sunrise and take a picture there",
        "go TreeIs(4); picture | not_before=sunrise not_after=sunrise+15",
    ),
    (PASTURE, HUSKY, "go to the bank and tell me how warm it is there", "air @ PointsIn(bank)"),
    (PASTURE, HUSKY, "tell me how warm it is on the bank", "air @ PointsIn(bank)"),
    (DEMO, HUSKY, "I want to know what the CO2 is at tree 5. Take a picture there.", "co2 @ TreeIs(5); picture"),
    (PASTURE, HUSKY, "Drive to the boggy corner and measure how cold the air is", "air @ PointsIn(boggy corner)"),
    (DEMO, HUSKY, "go to tree 4 and tell me how warm it is there", "go TreeIs(4); air"),
    (DEMO, HUSKY, "go back and forth between tree 4 and tree 9 three times with a picture at each one", TO_AND_FRO),
    (DEMO, HUSKY, "go to and fro between tree 4 and tree 9 for three rounds, taking a picture at each", TO_AND_FRO),
    (DEMO, HUSKY, "go up and down three times between tree 4 and tree 9 with a picture at both", TO_AND_FRO),
    (DEMO, HUSKY, "drive between tree 4 and tree 9 three times and take a picture at each one", TO_AND_FRO),
    (
        PASTURE,
        TRACTOR,
        "from ten tonight go back and forth between the middle gate and the farm gate twice with a photo at each, but "
        "if it rains go home",
        "2 times: [go GateIs(middle gate); picture; go GateIs(farm gate); picture]"
        " | day=today not_before=22:00 | return_to_start | at any time rain: return_to_start",
    ),
    (DEMO, TRACTOR, "do a lap of the boundary with the side camera on", "film perimeter Trees"),
    (DEMO, TRACTOR, "drive around the pond with the mower on", "mow perimeter InZone(pond)"),
    (DEMO, TRACTOR, "drive through every second aisle with the mower down", "mow aisles Trees, every 2"),
    (DEMO, TRACTOR, "do a lap of the boundary with the side camera on the fence the whole way", "film perimeter Trees"),
    (
        DEMO,
        TRACTOR,
        "do two laps of the boundary with the side camera running, I think something's been digging under it, and "
        "come back to the start when you've been round",
        "film perimeter Trees, 2 laps",
    ),
    (DEMO, HUSKY, "photograph tree 4, back at the start by the end", "picture @ TreeIs(4)"),
]

REFUSED = [
    (PASTURE, TRACTOR, "film around the long pasture. Leave the cowslip patch standing."),
    (DEMO, TRACTOR, "spray rows 3 to 8. Leave row 5 standing."),
    (DEMO, TRACTOR, "get row 3 on the mower"),
    (DEMO, HUSKY, "tree 4 should be at the start"),
    (DEMO, TRACTOR, "film just inside the pond"),
    (DEMO, TRACTOR, "do a lap of the wet corner with the side camera on the fence"),
    (DEMO, TRACTOR, "do a lap of the boundary with the mower on the fence"),
    (DEMO, HUSKY, "go back and forth between tree 4 and tree 9 with a picture at each"),
    (DEMO, HUSKY, "go back and forth between the yellow trees three times with a picture at each"),
    (DEMO, HUSKY, "photograph tree 3. Go back and forth between tree 4 and tree 9 three times with a picture at each."),
    (DEMO, HUSKY, "be at the yellow trees at sunrise"),
    (PASTURE, HUSKY, "do the same on the bank"),
    (DEMO, TRACTOR, "The yellow trees need treating: spray those at 300 l/ha."),
    (DEMO, TRACTOR, "Rows 3 and 4 need treating: spray row 5."),
    (DEMO, TRACTOR, "spray tree 3, down one side and back up the other"),
]


def _name(value: object) -> str:
    return value if isinstance(value, str) else ""


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=_name)
def test_a_clause_about_work_has_its_plan(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    outcome = EnglishPlanner().plan(request_, site, robot)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).removesuffix(" | return_to_start") == plan


@pytest.mark.parametrize(("site", "robot", "request_"), REFUSED, ids=_name)
def test_a_clause_that_does_not_fit_the_work_is_refused(site: Site, robot: RobotProfile, request_: str) -> None:
    assert isinstance(EnglishPlanner().plan(request_, site, robot), Refused)


def test_what_is_left_standing_of_two_areas_is_asked() -> None:
    request = "mow the bank, then mow the long pasture. Leave the cowslip patch standing."
    asked = EnglishPlanner().plan(request, PASTURE, TRACTOR)
    assert isinstance(asked, Clarify)
    assert len(asked.choices) == 2
