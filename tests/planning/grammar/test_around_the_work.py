"""Words around the work: the charge to come home with, what is done if there is time, where and when it ends."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Answer, Clarify, Planned
from fieldhand.robot.loader import load_robot
from planning.english.outlines import outline
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
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


KALE, ALL_KALE = "for Where(crop, eq, kale): [picture]", "for Where(crop, eq, kale) optional: [picture]"
CO2 = "co2 @ PointsIn(rose bed)"
ONE_GATE, TWO_GATES = f"{KALE} | only street gate", f"{KALE} | only street gate | only river gate"
GATES = [
    ("In through the street gate, leaf temperature of all the kale, and out the same gate again.", ONE_GATE),
    ("Go in by the street gate, photograph the kale, and come out the same way.", ONE_GATE),
    ("Photograph the kale. In and out through the street gate.", ONE_GATE),
    ("Enter by the street gate. Photograph the kale. Leave by that gate again.", ONE_GATE),
    ("In at the street gate, pictures of the kale, out at the river gate.", TWO_GATES),
    ("Photograph the kale, entering by the street gate and leaving by the river gate.", TWO_GATES),
    (
        "Come in by the street gate, read CO2 at the rose bed and leave again through the street gate.",
        f"{CO2} | only street gate",
    ),
]
IN_TIME = [
    (
        "Photograph as many kales as possible in 12 minutes; when time runs out you should be at the street gate.",
        f"{ALL_KALE}; go GateIs(street gate) | duration_s 720 | stay",
    ),
    (
        "Get as many thermal pictures of the kale as you can in twelve minutes, and be at the rose bed when the time is"
        " over.",
        f"{ALL_KALE}; go PointsIn(rose bed) | duration_s 720 | stay",
    ),
    ("Photograph as many kales as possible within 12 minutes and be back in time.", f"{ALL_KALE} | duration_s 720"),
]
ORDER = [
    ("Photograph the kale. When you get back, read the CO2.", f"{KALE}; co2 @ Marker(start)"),
    (
        "Photograph the kale, and when you are back read the CO2 at the street gate.",
        f"{KALE}; co2 @ GateIs(street gate)",
    ),
    ("On your way home, read the CO2 at the rose bed. Photograph the kale.", f"{KALE}; {CO2}"),
    ("Photograph the kale. Before you start, read CO2 at the rose bed.", f"{CO2}; {KALE}"),
    ("Photograph the kale. First of all, read CO2 at the rose bed.", f"{CO2}; {KALE}"),
    (
        "Before you leave, read the air temperature at the start. Then photograph the kale.",
        f"air @ Marker(start); {KALE}",
    ),
    ("Measure CO2 at the start before you leave, then photograph the kale.", f"co2 @ Marker(start); {KALE}"),
    ("Photograph the kale and, to finish, read CO2 at the rose bed.", f"{KALE}; {CO2}"),
    ("Photograph the kale, and as the last thing read CO2 at the rose bed.", f"{KALE}; {CO2}"),
]
ENDS = [
    ("Photograph the kale and stay at the street gate.", f"{KALE}; go GateIs(street gate) | stay"),
    ("Photograph the kale, then drive to the street gate and wait there.", f"{KALE}; go GateIs(street gate) | stay"),
    ("Photograph the kale and remain at the rose bed.", f"{KALE}; go PointsIn(rose bed) | stay"),
]


@pytest.mark.parametrize(("request_", "plan"), [*GATES, *IN_TIME, *ORDER, *ENDS], ids=name)
def test_it_is_said_how_the_robot_comes_and_where_it_ends(request_, plan):
    require_plan(GARDEN, HUSKY, request_, plan)


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        ("Drive to the street gate and stay there. Photograph the kale.", "something follows the end of the mission"),
        ("Drive to the street gate, wait there, then photograph the kale.", "waiting without a time"),
        ("Photograph the kale and be at the street gate when the time is over.", "when the time is"),
        ("Photograph the kale and come back the same way.", "the same way"),
    ],
    ids=name,
)
def test_an_end_that_does_not_fit_is_refused(request_, why):
    require_refusal(GARDEN, HUSKY, request_, why)


def test_before_you_leave_may_be_before_the_work_or_behind_it():
    require_question(GARDEN, HUSKY, "Photograph the kale, but before you leave read the CO2 at the rose bed.", 2)


MONDAYS = "at=sunrise weekdays=mon first_day=--05-01"
MONTHS = [
    (
        "Every Friday in July at eight in the morning, photograph the trunks of two kale plants.",
        "for Take(2, of Where(crop, eq, kale)): [picture(view trunk)] | at=08:00 weekdays=fri first_day=--07-01"
        " last_day=--07-31",
    ),
    (
        "In August, photograph the kale every morning at seven.",
        f"{KALE} | at=07:00 first_day=--08-01 last_day=--08-31",
    ),
    (
        "From May to September, photograph the kale every Monday.",
        f"{KALE} | {MONDAYS} last_day=--09-30 late_min=1440 done_by=sunset",
    ),
    (
        "Photograph the kale on Mondays in May, June and July.",
        f"{KALE} | {MONDAYS} last_day=--07-31 late_min=1440 done_by=sunset",
    ),
    (
        "Photograph the kale every week from April until October.",
        f"{KALE} | at=sunrise every_days=7 first_day=--04-01 last_day=--10-31 late_min=1440 done_by=sunset",
    ),
    (
        "Photograph the kale daily throughout June.",
        f"{KALE} | at=sunrise first_day=--06-01 last_day=--06-30 late_min=1440 done_by=sunset",
    ),
    (
        "From the beginning of June to the end of August, photograph the kale at 6 pm every Monday.",
        f"{KALE} | at=18:00 weekdays=mon first_day=--06-01 last_day=--08-31",
    ),
    ("Photograph the kale every hour from 9 until the evening.", f"{KALE} | at=09:00 every_min=60 until=18:00"),
]


@pytest.mark.parametrize(("request_", "plan"), MONTHS, ids=name)
def test_months_are_limits_of_a_standing_mission(request_, plan):
    require_plan(GARDEN, AMIGA, request_, plan)


def test_a_month_alone_is_no_time():
    require_refusal(GARDEN, AMIGA, "Photograph the kale in July.", "in July")


@pytest.mark.parametrize(
    ("request_", "ways"),
    [
        ("Keep an eye on the air at the rose bed every so often until evening.", 2),
        ("Keep an eye on the CO2 at the rose bed every so often until evening.", 3),
        ("Keep an eye on the CO2 at the rose bed until evening.", 3),
        ("Keep an eye on the CO2 at the rose bed.", 0),
        ("Monitor the air at the rose bed every so often until evening.", 2),
        ("Read the CO2 at the rose bed now and then.", 0),
        ("Check the air at the rose bed.", 2),
    ],
    ids=name,
)
def test_it_is_asked_what_is_measured_and_how_often(request_, ways):
    require_question(GARDEN, HUSKY, request_, ways)


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Keep an eye on the CO2 at the rose bed every morning.", f"{CO2} | at=sunrise late_min=1440 done_by=12:00"),
        (
            "Keep an eye on the CO2 at the rose bed every half hour from 9 to 12.",
            f"{CO2} | at=09:00 every_min=30 until=12:00 late_min=30",
        ),
        ("Watch the CO2 at the rose bed every hour for two hours.", f"{CO2}; wait 3600; co2; wait 3600; co2"),
    ],
    ids=name,
)
def test_what_is_watched_over_is_measured_as_often_as_is_said(request_, plan):
    require_plan(GARDEN, HUSKY, request_, plan)


def test_one_answer_leads_to_the_next_question():
    request = "Keep an eye on the CO2 at the rose bed until evening."
    first = Answer(question="How often?", answer="every 20 minutes")
    asked = EnglishPlanner().plan(request, GARDEN, HUSKY, (first,))
    assert isinstance(asked, Clarify)
    then = Answer(question=asked.question, answer="at 08:00")
    planned = EnglishPlanner().plan(request, GARDEN, HUSKY, (first, then))
    assert isinstance(planned, Planned)
    assert outline(planned.task).startswith(f"{CO2} | at=08:00 every_min=20 until=18:00")


HALF_HOURS = "at=09:00 every_min=30 until=12:00 late_min=30"
BETWEEN = [
    ("From 9 till noon read CO2 at the rose bed every half hour, waiting at the street gate in between.", HALF_HOURS),
    ("Read CO2 at the rose bed every half hour from 9 to 12, and wait at the street gate in between.", HALF_HOURS),
    ("Every half hour from 9 to noon, read CO2 at the rose bed, returning to the street gate in between.", HALF_HOURS),
    ("Read CO2 at the rose bed every half hour from 9 to 12, parked at the street gate in the meantime.", HALF_HOURS),
    ("Read CO2 at the rose bed every half hour from 9 to 12. Wait at the street gate between readings.", HALF_HOURS),
    ("Every half hour from 9 to 12 read CO2 at the rose bed. In between, wait at the street gate.", HALF_HOURS),
]


@pytest.mark.parametrize(("request_", "when"), BETWEEN, ids=name)
def test_between_runs_the_robot_waits_where_it_is_told(request_, when):
    require_plan(GARDEN, HUSKY, request_, f"{CO2}; go GateIs(street gate) | {when} | stay")


def test_a_wait_between_the_steps_of_one_mission_is_refused():
    request = "Every day at noon read CO2 at the rose bed, waiting at the street gate in between."
    require_refusal(GARDEN, HUSKY, request, "waiting without a time")
