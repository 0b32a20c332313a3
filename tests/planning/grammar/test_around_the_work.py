"""Words around the work: the charge to come home with, what is done if there is time, where and when it ends."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from planning.grammar.field_requests import name, require_plan
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
AMIGA, HUSKY, TRACTOR = load_robot("amiga"), load_robot("husky"), load_robot("tractor")

BANK, RESERVED = "mow area InZone(bank)", "mow area InZone(bank) | reserve 40"
CHARGE = [
    ("Mow the bank, but come home at 40 percent battery.", RESERVED),
    ("Mow the bank. Return at 40 percent.", RESERVED),
    ("Mow the bank and come home when the battery reaches 40.", RESERVED),
    ("Mow the bank but turn back at 40 % charge.", RESERVED),
    ("Mow the bank, but head home once you are down to 40 percent.", RESERVED),
    ("Mow the bank. When 40 % is left, come home.", RESERVED),
    ("At 40 % battery come home. Mow the bank.", RESERVED),
    ("Mow the bank, come home as soon as there is only 40 % left.", RESERVED),
    ("Mow the bank without draining the battery below 40 %.", RESERVED),
    ("Mow the bank until only 40 % is left.", RESERVED),
    ("Mow the bank, taking the battery into account.", BANK),
    (
        "First mow the boggy corner and then the bank, but come home at 40 percent battery.",
        f"mow area InZone(boggy corner); {RESERVED}",
    ),
]
ALSO = f"{BANK}; maybe [mow area InZone(boggy corner)]"
IF_IT_FITS = [
    ("Mow the bank and if there is time left also the boggy corner.", ALSO),
    ("Mow the bank and, if the battery allows, the boggy corner as well.", ALSO),
    ("Mow the bank and, time permitting, the boggy corner.", ALSO),
    ("Mow the bank. If there is time left, also the boggy corner.", ALSO),
    ("Mow the bank, then the boggy corner if there is time.", ALSO),
    (
        "Mow the bank and as much of the long pasture as the battery allows.",
        f"{BANK}; mow area InZone(long pasture), optional",
    ),
    ("Mow the bank as far as you get in 20 minutes.", f"{BANK}, optional | duration_s 1200"),
    ("Mow the bank as far as the battery takes you.", f"{BANK}, optional"),
    ("Mow the bank for as long as the battery lasts.", f"{BANK}, optional"),
]


@pytest.mark.parametrize(("request_", "plan"), [*CHARGE, *IF_IT_FITS], ids=name)
def test_work_is_limited_by_the_charge(request_, plan):
    require_plan(PASTURE, TRACTOR, request_, plan)
