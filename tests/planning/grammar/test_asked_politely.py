"""Work that is asked for politely, wished for or told to be due, with the time and the reason beside it."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Refused
from fieldhand.robot.loader import load_robot
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
HUSKY, TRACTOR = load_robot("husky"), load_robot("tractor")

BANK, AFTERNOON = "mow area InZone(bank)", "mow area InZone(bank) | day=today not_before=12:00 done_by=18:00"
POLITE = [
    ("Would you mind mowing the bank?", BANK),
    ("How about mowing the bank?", BANK),
    ("It would be great if the bank were mown.", BANK),
    ("It would be lovely if the bank could be mown today.", BANK),
    ("Can the bank be mown, please?", BANK),
    ("The bank needs mowing. Can you do it?", BANK),
    ("The bank needs mowing; would you take care of that?", BANK),
    ("The bank needs mowing, can you see to that?", BANK),
    ("Please see to it that the bank gets mown.", BANK),
    ("I'd be grateful if you mowed the bank.", BANK),
    ("Mow the bank by lunchtime.", BANK),
    ("The bank has to be mown this afternoon, could you do that?", AFTERNOON),
    ("Could the bank be mowed this afternoon?", AFTERNOON),
    ("I want the bank mown this afternoon.", AFTERNOON),
    ("The bank must be mown by 6 pm.", f"{BANK} | done_by=18:00"),
    ("Mow the bank, the thistles are terrible.", BANK),
]


@pytest.mark.parametrize(("request_", "plan"), POLITE, ids=name)
def test_work_is_asked_for_politely(request_, plan):
    require_plan(PASTURE, TRACTOR, request_, plan)


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("It would be great if all the kale were photographed.", "for Where(crop, eq, kale): [picture]"),
        ("The kale has to be photographed, could you do that?", "for Where(crop, eq, kale): [picture]"),
        ("Would you mind photographing the kale?", "for Where(crop, eq, kale): [picture]"),
    ],
    ids=name,
)
def test_captures_are_asked_for_politely(request_, plan):
    require_plan(GARDEN, HUSKY, request_, plan)


@pytest.mark.parametrize(
    "request_",
    [
        "Spray bed 4 with 500 litres per hectare, the caterpillars are awful this year.",
        "Spray bed 4 with 500 l/ha. The caterpillars are awful this year.",
        "Spray bed 4 with 500 l/ha, because the caterpillars are awful this year.",
    ],
)
def test_a_reason_behind_a_comma_is_a_remark(request_):
    require_plan(GARDEN, TRACTOR, request_, "spray rows Rows(4, 4), rate_l_ha 500")


@pytest.mark.parametrize(
    ("site", "request_", "why"),
    [
        (
            GARDEN,
            "Spray bed 4 with 1200 litres per hectare, the caterpillars are awful this year.",
            "between 50 and 800",
        ),
        (PASTURE, "The hay on the bank has to be turned this afternoon, could you do that?", "has to be turned"),
        (PASTURE, "The hay should be raked tomorrow.", "raked' asks for work that tractor has no action for"),
        (PASTURE, "Mow the bank this week.", "this week"),
        (PASTURE, "Mow the bank where the ground is wet this week.", "this week"),
        (PASTURE, "The bank was mown this morning. Mow the cow paddock.", "this morning"),
    ],
    ids=name,
)
def test_what_cannot_be_done_is_named(site, request_, why):
    require_refusal(site, TRACTOR, request_, why)


def test_a_time_that_could_be_planned_is_no_reason_to_refuse():
    outcome = EnglishPlanner().plan("Turn the hay on the bank this afternoon.", PASTURE, TRACTOR)
    assert isinstance(outcome, Refused)
    assert len(outcome.reasons) == 1


@pytest.mark.parametrize(
    ("request_", "ways"),
    [
        ("Spray the middle row before lunch.", 2),
        ("Film the middle row of the hot bay.", 2),
        ("Film along the middle row.", 2),
    ],
    ids=name,
)
def test_of_an_even_number_of_rows_two_are_in_the_middle(request_, ways):
    require_question(GLASSHOUSE, TRACTOR, request_, ways)


def test_the_two_middle_rows_may_be_in_two_sections():
    require_plan(GLASSHOUSE, TRACTOR, "Spray the two middle rows.", "spray rows UnionOf(Rows(2, 2)+Rows(3, 3))")
