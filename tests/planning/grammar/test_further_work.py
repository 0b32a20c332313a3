"""Ground that is worked like that before it, and the direction of work on rows that are named by their plants."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

DEMO, GARDEN, GLASSHOUSE, PASTURE = open_site("demo"), vegetable_garden(), glasshouse(), pasture()
TRACTOR = load_robot("tractor")
BEANS, SQUASH = "film rows Where(crop, eq, bean)", "film rows Where(crop, eq, squash)"
THERE_AND_BACK = f"{BEANS}, heading north; {SQUASH}, heading south"

PLANNED = [
    (DEMO, "spray rows 3 to 5, then row 7", "spray rows Rows(3, 5); spray rows Rows(7, 7)"),
    (DEMO, "spray row 3 and then row 7", "spray rows Rows(3, 3); spray rows Rows(7, 7)"),
    (DEMO, "spray row 5, after that row 4", "spray rows Rows(5, 5); spray rows Rows(4, 4)"),
    (
        DEMO,
        "spray row 3 at 200 l/ha and row 5 at 300 l/ha",
        "spray rows Rows(3, 3), rate_l_ha 200; spray rows Rows(5, 5), rate_l_ha 300",
    ),
    (
        DEMO,
        "spray row 3 at 200 l/ha, then row 5",
        "spray rows Rows(3, 3), rate_l_ha 200; spray rows Rows(5, 5), rate_l_ha 200",
    ),
    (DEMO, "spray rows 3 and 5 at 200 l/ha", "spray rows UnionOf(Rows(3, 3)+Rows(5, 5)), rate_l_ha 200"),
    (DEMO, "spray row 3 and row 5 at 200 l/ha", "spray rows UnionOf(Rows(3, 3)+Rows(5, 5)), rate_l_ha 200"),
    (
        DEMO,
        "film row 1 on the west side and row 2 on the east side",
        "film rows Rows(1, 1), west; film rows Rows(2, 2), east",
    ),
    (DEMO, "film row 4 first, and then row 6 from both sides", "film rows Rows(4, 4); film rows Rows(6, 6), both"),
    (
        DEMO,
        "film row 6 from south to north, then film row 7 on the way back",
        "film rows Rows(6, 6), heading north; film rows Rows(7, 7), heading south",
    ),
    (
        DEMO,
        "film row 6 from south to north and row 7 on the way back",
        "film rows Rows(6, 6), heading north; film rows Rows(7, 7), heading south",
    ),
    (
        DEMO,
        "film row 6 northwards, then turn around and film row 7",
        "film rows Rows(6, 6), heading north; film rows Rows(7, 7), heading south",
    ),
    (PASTURE, "mow the bank, then the cow paddock", "mow area InZone(bank); mow area InZone(cow paddock)"),
    (PASTURE, "mow the bank first and then the cowslip patch", "mow area InZone(bank); mow area InZone(cowslip patch)"),
    (PASTURE, "mow the bank and the cowslip patch", "mow area UnionOf(InZone(bank)+InZone(cowslip patch))"),
    (
        PASTURE,
        "First mow the bank, then the boggy corner, and finally the cowslip patch.",
        "mow area InZone(bank); mow area InZone(boggy corner); mow area InZone(cowslip patch)",
    ),
    (PASTURE, "go over the bank and mow it", "mow area InZone(bank)"),
    (GARDEN, "film the beans from south to north", f"{BEANS}, heading north"),
    (GARDEN, "film the beans northwards", f"{BEANS}, heading north"),
    (GARDEN, "film the squash starting at its south end", f"{SQUASH}, heading north"),
    (
        GARDEN,
        "film the radish along its whole length, from north to south",
        "film rows Where(crop, eq, radish), heading south",
    ),
    (
        GARDEN,
        "Film the beans from south to north, then turn round and film the squash on the way back.",
        THERE_AND_BACK,
    ),
    (GARDEN, "Film the beans from the south end to the north end, and the squash on the way back.", THERE_AND_BACK),
    (GARDEN, "Film the beans from south to north. Turn around and film the squash coming back.", THERE_AND_BACK),
    (GARDEN, "film the beans heading north, then the squash heading south", THERE_AND_BACK),
    (GARDEN, "drive along the beans and film them", BEANS),
    (
        GARDEN,
        "spray the beans, then the squash",
        "spray rows Where(crop, eq, bean); spray rows Where(crop, eq, squash)",
    ),
    (GLASSHOUSE, "film the melons from west to east", "film rows Where(crop, eq, melon), heading east"),
    (
        GLASSHOUSE,
        "film row 1 from west to east and row 2 on the way back",
        "film rows Rows(1, 1), heading east; film rows Rows(2, 2), heading west",
    ),
]

ASKED = [
    (DEMO, "spray row 5 and then row 4 with 250 litres per hectare", 2),
    (DEMO, "spray row 3 from both sides, then row 5", 2),
]

REFUSED = [
    (GARDEN, "film the beans from east to west", "an order needs several places"),
    (DEMO, "photograph row 3, then turn round", "turn"),
    (GARDEN, "film the beans and turn round, then photograph every squash", "film the beans"),
    (PASTURE, "mow the bank, then the moon", "moon"),
]


@pytest.mark.parametrize(("site", "request_", "plan"), PLANNED, ids=name)
def test_ground_is_worked_like_that_before_it(site: Site, request_: str, plan: str) -> None:
    require_plan(site, TRACTOR, request_, plan)


@pytest.mark.parametrize(("site", "request_", "ways"), ASKED, ids=name)
def test_what_may_belong_to_both_works_is_asked_about(site: Site, request_: str, ways: int) -> None:
    require_question(site, TRACTOR, request_, ways)


@pytest.mark.parametrize(("site", "request_", "why"), REFUSED, ids=name)
def test_ways_back_from_nothing_are_refused(site: Site, request_: str, why: str) -> None:
    require_refusal(site, TRACTOR, request_, why)
