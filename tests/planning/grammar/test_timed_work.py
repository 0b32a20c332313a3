"""Work at several times of a day, at intervals, and again later."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline
from planning.grammar.field_requests import name, require_plan, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE, ORCHARD = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

ROUND = "for UnionOf(GateIs(middle gate)+GateIs(farm gate)): [co2]"
AT_TIMES = [
    (GARDEN, HUSKY, "Monday to Friday, measure the air temperature at the rose bed at 7 am and once more at 2 pm.",
     "air @ PointsIn(rose bed) | at=07:00,14:00 weekdays=mon,tue,wed,thu,fri"),
    (PASTURE, HUSKY,
     "Read CO2 on the bank at 7 am and then again at 2 pm, every day.",
     "co2 @ PointsIn(bank) | at=07:00,14:00"),
    (PASTURE, HUSKY,
     "Three times a day, at 7 am, noon and 6 pm, read CO2 on the bank.",
     "co2 @ PointsIn(bank) | at=07:00,12:00,18:00"),
    (PASTURE, HUSKY,
     "Read CO2 on the bank every day at sunrise and once more at sunset.",
     "co2 @ PointsIn(bank) | at=sunrise,sunset"),
    (ORCHARD, HUSKY, "Photograph tree 4 tomorrow at 7 am and again at 2 pm.",
     "picture @ TreeIs(4) | at=07:00,14:00 first_day=tomorrow last_day=today"),
    (ORCHARD, HUSKY, "Photograph tree 4 tomorrow morning at 7 and in the evening at 6.",
     "picture @ TreeIs(4) | at=07:00,18:00 first_day=tomorrow last_day=today"),
    (ORCHARD, HUSKY,
     "Every morning at seven and every evening at six, photograph tree 4.",
     "picture @ TreeIs(4) | at=07:00,18:00"),
    (ORCHARD, HUSKY,
     "Every day at 7 am photograph tree 4, and again at 2 pm.",
     "picture @ TreeIs(4) | at=07:00,14:00"),
    (ORCHARD, HUSKY,
     "Photograph tree 4 daily: once at 7 am and once at 2 pm.",
     "picture @ TreeIs(4) | at=07:00,14:00"),
    (PASTURE, HUSKY,
     "Begin half an hour before sunrise and read CO2 at both gates. Repeat this round every hour until "
     "nine in the morning.",
     f"{ROUND} | at=sunrise-30 every_min=60 until=09:00"),
    (PASTURE, HUSKY, "Start at 6 am and read CO2 at both gates. Do the round again every hour until noon.",
     f"{ROUND} | at=06:00 every_min=60 until=12:00"),
    (PASTURE, HUSKY, "Read CO2 at both gates every hour, starting at six in the morning and ending at noon.",
     f"{ROUND} | at=06:00 every_min=60 until=12:00"),
    (PASTURE, HUSKY, "Tomorrow, read CO2 at both gates every two hours between 8 am and 6 pm.",
     f"{ROUND} | at=08:00 every_min=120 until=18:00 first_day=tomorrow last_day=today"),
    (PASTURE, TRACTOR,
     "Mow the bank tomorrow from ten o'clock and pause while the wind is above 8 metres per second.",
     "mow area InZone(bank) | day=tomorrow not_before=10:00 | return_to_start | at any time wind > 8 "
     "m/s: wait, then return_to_start"),
    (PASTURE, TRACTOR, "Mow the boggy corner on Friday at 7 am and come home if it rains.",
     "mow area InZone(boggy corner) | day=fri not_before=07:00 not_after=07:15 | return_to_start | at "
     "any time rain: return_to_start"),
    (PASTURE, HUSKY, "Read CO2 at both gates every quarter of an hour from 5 to 7 am.",
     f"{ROUND} | at=05:00 every_min=15 until=07:00 late_min=15"),
    (PASTURE, HUSKY, "From sunrise until ten in the morning, read CO2 at both gates every half hour.",
     f"{ROUND} | at=sunrise every_min=30 until=10:00 late_min=30"),
    (PASTURE, HUSKY, "Start tomorrow at nine and stop by noon: read CO2 at both gates.",
     f"{ROUND} | day=tomorrow not_before=09:00 not_after=09:15 done_by=12:00"),
    (ORCHARD, TRACTOR, "Spray row 4 tonight at ten and stop if someone is in the row.",
     "spray rows Rows(4, 4) | day=today not_before=22:00 not_after=22:15 | at any time person_near: wait, then end"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), AT_TIMES, ids=name)
def test_work_at_several_times(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(
    ("site", "robot", "request_", "why"),
    [
        (ORCHARD, HUSKY, "At 7 am photograph tree 4, and again at 2 pm photograph tree 9.", "not a time"),
        (ORCHARD, HUSKY, "Photograph tree 4 on Mondays at 7 am and on Fridays at 2 pm.", "not exactly enough"),
        (ORCHARD, HUSKY, "At 7 am photograph tree 4 and at 2 pm tree 9.", "not a time"),
    ],
    ids=name,
)
def test_times_of_different_work_are_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)


def test_runs_until_a_time_are_asked_for_their_beginning() -> None:
    found = EnglishPlanner().plan("Read CO2 at both gates. Repeat the round every hour until 6 pm.", PASTURE, HUSKY)
    assert isinstance(found, Clarify), found
    assert found.question == "At what time of the day?"


def _times(action: str, place: str, times: int, seconds: int) -> str:
    return "; ".join([f"{action} @ {place}", *[f"wait {seconds}; {action}"] * (times - 1)])


HEAP, BANK = "PointsIn(manure heap)", "PointsIn(bank)"
AT_INTERVALS = [
    (GARDEN, HUSKY,
     "Go to the manure heap and take a gas sample there every 10 minutes for an hour.", _times("co2", HEAP, 7, 600)),
    (GARDEN, HUSKY,
     "Stay at the manure heap for an hour and read the carbon dioxide every ten minutes.", _times("co2", HEAP, 7, 600)),
    (GARDEN, HUSKY,
     "Wait at the manure heap for half an hour, reading CO2 every ten minutes.", _times("co2", HEAP, 4, 600)),
    (GARDEN, HUSKY,
     "Spend an hour at the manure heap and measure CO2 every 15 minutes.", _times("co2", HEAP, 5, 900)),
    (PASTURE, HUSKY, "For half an hour, read CO2 on the bank every 5 minutes.", _times("co2", BANK, 7, 300)),
    (PASTURE, HUSKY, "Over the next two hours, read CO2 on the bank every 20 minutes.", _times("co2", BANK, 7, 1200)),
    (PASTURE, HUSKY, "Read CO2 on the bank for the next hour, once every half hour.", _times("co2", BANK, 3, 1800)),
    (PASTURE, HUSKY, "Read CO2 on the bank every minute for three minutes.", _times("co2", BANK, 4, 60)),
    (PASTURE, HUSKY, "Read CO2 on the bank every 7 minutes for half an hour.", _times("co2", BANK, 5, 420)),
    (ORCHARD, HUSKY, "Photograph tree 4 every ten minutes for half an hour.", _times("picture", "TreeIs(4)", 4, 600)),
    (ORCHARD, HUSKY,
     "Go to tree 4 and take a picture there every 10 minutes, three times.",
     "go TreeIs(4); picture; wait 600; picture; wait 600; picture"),
    (ORCHARD, HUSKY,
     "Stand at tree 4 for thirty minutes. Take a CO2 reading every ten minutes.", _times("co2", "TreeIs(4)", 4, 600)),
    (ORCHARD, HUSKY, "Read CO2 at tree 4 every two minutes, three times in all.", _times("co2", "TreeIs(4)", 3, 120)),
    (ORCHARD, HUSKY,
     "Read CO2 and the air temperature at tree 4 every 10 minutes for 20 minutes, then photograph tree "
     "9.",
     "co2 @ TreeIs(4); air; wait 600; co2; air; wait 600; co2; air; picture @ TreeIs(9)"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), AT_INTERVALS, ids=name)
def test_captures_at_intervals_of_time(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


def test_the_number_of_captures_at_intervals_is_stated() -> None:
    found = EnglishPlanner().plan("Photograph tree 4 every ten minutes for half an hour.", ORCHARD, HUSKY)
    assert isinstance(found, Planned), found
    stated = "Every 10 min for 30 min is taken as 4 times: at the beginning, at the end, and between."
    assert stated in found.task.command.assumptions


GATES = "for UnionOf(GateIs(middle gate)+GateIs(farm gate)): [co2]"
AGAIN_LATER = [
    (PASTURE, HUSKY,
     "Read CO2 at both gates, then do it all again half an hour later.",
     f"{GATES}; wait 1800; {GATES}"),
    (PASTURE, HUSKY,
     "Read CO2 at both gates. Half an hour later, do the whole round again.",
     f"{GATES}; wait 1800; {GATES}"),
    (PASTURE, HUSKY, "Read CO2 at both gates. Repeat the round after half an hour.", f"{GATES}; wait 1800; {GATES}"),
    (PASTURE, HUSKY, "Read CO2 at both gates, wait 30 minutes, and do it all again.", f"{GATES}; wait 1800; {GATES}"),
    (PASTURE, HUSKY, "Read CO2 at both gates. Wait ten minutes and repeat.", f"{GATES}; wait 600; {GATES}"),
    (PASTURE, HUSKY,
     "Read CO2 at both gates, three rounds, twenty minutes apart.",
     f"2 times: [{GATES}; wait 1200]; {GATES}"),
    (PASTURE, HUSKY,
     "Read CO2 at both gates, two rounds with 20 minutes between rounds.",
     f"{GATES}; wait 1200; {GATES}"),
    (GLASSHOUSE, HUSKY, "Read CO2 in the middle of each bay, then do it all again an hour later.",
     "for UnionOf(PointsIn(hot bay)+PointsIn(mild bay)): [co2]; wait 3600; "
     "for UnionOf(PointsIn(hot bay)+PointsIn(mild bay)): [co2]"),
    (GLASSHOUSE, HUSKY, "Photograph every melon, then do the same again an hour later.",
     "for Where(crop, eq, melon): [picture]; wait 3600; for Where(crop, eq, melon): [picture]"),
    (ORCHARD, HUSKY, "Read CO2 at tree 4 now and again in an hour.", "co2 @ TreeIs(4); wait 3600; co2"),
    (ORCHARD, HUSKY,
     "Read CO2 at tree 4, then in half an hour do it again.",
     "co2 @ TreeIs(4); wait 1800; co2 @ TreeIs(4)"),
    (ORCHARD, HUSKY,
     "Read CO2 at tree 4. An hour later, photograph tree 9.",
     "co2 @ TreeIs(4); wait 3600; picture @ TreeIs(9)"),
    (ORCHARD, HUSKY,
     "Read CO2 at tree 4, and ten minutes later go to tree 9.",
     "co2 @ TreeIs(4); wait 600; go TreeIs(9)"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), AGAIN_LATER, ids=name)
def test_work_is_done_again_later(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(
    ("site", "robot", "request_", "why"),
    [
        (PASTURE, HUSKY, "Read CO2 at both gates every 10 minutes for an hour.", "at one place"),
        (ORCHARD, HUSKY, "Read CO2 at tree 4 for an hour.", "it does not say how often"),
        (ORCHARD, HUSKY, "Read CO2 at tree 4 every hour for ten minutes.", "it does not say how often"),
        (ORCHARD, HUSKY, "Read CO2 at tree 4 every minute for two hours.", "at most 50 times"),
    ],
    ids=name,
)
def test_intervals_that_are_not_clear_are_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)


ALSO_THERE = [
    (PASTURE, HUSKY, "Read the air temp on the bank, and if it's below 3 degrees also in the boggy corner.",
     "air @ PointsIn(bank) = r1; if r1 < 3 degC: [air @ PointsIn(boggy corner)]"),
    (PASTURE, HUSKY, "Read CO2 on the bank and, if it is above 500 ppm, at both gates as well.",
     f"co2 @ PointsIn(bank) = r1; if r1 > 500 ppm: [{GATES}]"),
    (GARDEN, HUSKY, "Read CO2 at the manure heap; if it is high, then also at the rose bed.",
     "co2 @ PointsIn(manure heap) = r1; if r1 high: [co2 @ PointsIn(rose bed)]"),
    (ORCHARD, HUSKY, "Read the air temp at tree 4; if it is below 30 degrees also at trees 5 and 9.",
     "air @ TreeIs(4) = r1; if r1 < 30 degC: [for UnionOf(TreeIs(5)+TreeIs(9)): [air]]"),
    (ORCHARD, HUSKY, "Read the air temp at tree 4; above 32 degrees do CO2 there and at tree 9, otherwise come home.",
     "air @ TreeIs(4) = r1; if r1 > 32 degC: [co2; co2 @ TreeIs(9)] else [go Marker(start)]"),
    (ORCHARD, HUSKY, "Read CO2 at tree 4. If it is above 500 ppm photograph it and tree 9, if not come home.",
     "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture; picture @ TreeIs(9)] else [go Marker(start)]"),
    (ORCHARD, HUSKY, "CO2 at tree 4; over 500 ppm take a picture there and at trees 5 and 6, else photograph tree 9.",
     "co2 @ TreeIs(4) = r1; if r1 > 500 ppm: [picture; for UnionOf(TreeIs(5)+TreeIs(6)): [picture]] "
     "else [picture @ TreeIs(9)]"),
    (PASTURE, AMIGA,
     "Soil moisture on the bank; below 20 percent, nitrate there and in the boggy corner, otherwise "
     "home.",
     "moisture @ PointsIn(bank) = r1; if r1 < 20 percent: [nitrate; nitrate @ PointsIn(boggy corner)] "
     "else [go Marker(start)]"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), ALSO_THERE, ids=name)
def test_a_condition_decides_on_a_further_place(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


OR_SOONER = [
    (ORCHARD, HUSKY,
     "Photograph trees 4, 9 and 30, then back to the charger, or straight there if the battery drops "
     "under 40 percent.",
     "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(30)): [picture; if battery <= 40: [go Marker(charger); stop]]; "
     "go Marker(charger) | stay"),
    (ORCHARD, HUSKY,
     "Photograph row 4, then go to the charger. If the battery falls below 40 percent, go straight to "
     "the charger.",
     "for Rows(4, 4): [picture; if battery <= 40: [go Marker(charger); stop]]; go Marker(charger) | stay"),
    (ORCHARD, HUSKY,
     "Photograph row 4. If the battery falls below 40 percent, drive straight to the charger, otherwise "
     "come home.",
     "for Rows(4, 4): [picture; if battery <= 40: [go Marker(charger); stop]]"),
    (ORCHARD, HUSKY,
     "Photograph row 4, then drive to the charger, but right away once the battery falls below 30 "
     "percent.",
     "for Rows(4, 4): [picture; if battery <= 30: [go Marker(charger); stop]]; go Marker(charger) | stay"),
    (ORCHARD, HUSKY,
     "CO2 at tree 4 and a picture of tree 9, then back to the charger, or straight there if the battery "
     "drops below 40 %.",
     "co2 @ TreeIs(4); if battery <= 40: [go Marker(charger); stop]; picture @ TreeIs(9); "
     "if battery <= 40: [go Marker(charger); stop]; go Marker(charger) | stay"),
    (ORCHARD, HUSKY, "Photograph row 4, then come home, or sooner if the battery drops below 40 %.",
     "for Rows(4, 4): [picture] | reserve 40"),
    (PASTURE, HUSKY, "Read CO2 at both gates, then come home, earlier if the battery drops below 40 percent.",
     "for UnionOf(GateIs(middle gate)+GateIs(farm gate)): [co2] | reserve 40"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), OR_SOONER, ids=name)
def test_a_low_battery_ends_the_work_sooner(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


def test_what_is_done_otherwise_among_visits_is_not_guessed() -> None:
    request = "Photograph row 4. If the battery falls below 40 %, go straight to the charger, otherwise measure CO2."
    assert not isinstance(EnglishPlanner().plan(request, ORCHARD, HUSKY), Planned)


NOT_ROWS = "for Excluding(UnionOf(Rows(1, 1)+Rows(2, 2)), of Where(variety, eq, Carmel)): [picture]"
DONE_BEFORE = [
    (ORCHARD, HUSKY, "Rows 1 and 2 were done this morning, so just photograph the remaining Carmels.", NOT_ROWS),
    (ORCHARD, HUSKY, "Rows 1 and 2 are already done; photograph the rest of the Carmels.", NOT_ROWS),
    (ORCHARD, HUSKY, "We did rows 1 and 2 yesterday. Photograph the other Carmels.", NOT_ROWS),
    (ORCHARD, HUSKY,
     "I've already photographed rows 1 and 2, so take a picture of each of the remaining Carmels.", NOT_ROWS),
    (ORCHARD, HUSKY, "Photograph the remaining Carmels; rows 1 and 2 were finished yesterday.", NOT_ROWS),
    (ORCHARD, HUSKY,
     "Somebody already did tree 31. Read CO2 at the rest of row 2.",
     "for Excluding(TreeIs(31), of Rows(2, 2)): [co2]"),
    (GLASSHOUSE, HUSKY, "I did row 1 by hand. Photograph the remaining melons.",
     "for Excluding(Rows(1, 1), of Where(crop, eq, melon)): [picture]"),
    (GARDEN, AMIGA, "Row 2 has been sampled already. Take a leaf sample from each of the other potatoes.",
     "for Excluding(Rows(2, 2), of Where(crop, eq, potato)): [sample_leaf]"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), DONE_BEFORE, ids=name)
def test_what_was_done_before_is_left_out_of_the_rest(
    site: Site, robot: RobotProfile, request_: str, plan: str
) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(
    "request_",
    [
        "Rows 1 and 2 were done this morning. Photograph every Carmel.",
        "Photograph the remaining Carmels.",
        "Photograph the remaining 5 trees of row 1.",
        "Rows 1 and 2 were planted this morning, so photograph the remaining Carmels.",
    ],
)
def test_what_was_done_is_left_out_only_of_a_rest(request_: str) -> None:
    assert not isinstance(EnglishPlanner().plan(request_, ORCHARD, HUSKY), Planned)


KEPT_OFF = [
    (PASTURE, AMIGA, "Read soil moisture on the bank without driving onto the cowslip patch itself.",
     "moisture @ PointsIn(bank) | avoid InZone(cowslip patch)"),
    (PASTURE, AMIGA, "Read soil moisture on the bank. Don't drive onto the cowslip patch.",
     "moisture @ PointsIn(bank) | avoid InZone(cowslip patch)"),
    (PASTURE, AMIGA, "Read soil moisture on the bank, but stay off the cowslip patch itself.",
     "moisture @ PointsIn(bank) | avoid InZone(cowslip patch)"),
    (PASTURE, HUSKY, "Read CO2 at both gates without entering the boggy corner.",
     "for UnionOf(GateIs(middle gate)+GateIs(farm gate)): [co2] | avoid InZone(boggy corner)"),
    (ORCHARD, HUSKY, "Photograph trees 4 and 9 without running over the wet corner.",
     "for UnionOf(TreeIs(4)+TreeIs(9)): [picture] | avoid InZone(wet corner)"),
    (ORCHARD, HUSKY,
     "Never step onto the wet corner. Photograph tree 4.",
     "picture @ TreeIs(4) | avoid InZone(wet corner)"),
    (ORCHARD, HUSKY, "Take a picture every 8 m around the wet corner without driving onto it.",
     "for Transect(8, edge, wet corner): [picture] | avoid InZone(wet corner)"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), KEPT_OFF, ids=name)
def test_ground_that_is_not_driven_onto_is_kept_out_of(
    site: Site, robot: RobotProfile, request_: str, plan: str
) -> None:
    outcome = EnglishPlanner().plan(request_, site, robot)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).replace(" | return_to_start", "") == plan


AWAITED = [
    (PASTURE, HUSKY, "Wait at the farm gate until 6 pm, then read CO2 on the bank.",
     "go GateIs(farm gate); co2 @ PointsIn(bank) | not_before=18:00"),
    (PASTURE, HUSKY, "Go to the farm gate, wait there until noon, then read CO2 on the bank.",
     "go GateIs(farm gate); co2 @ PointsIn(bank) | not_before=12:00"),
    (GARDEN, HUSKY, "Drive to the manure heap and wait there until sunset. Then photograph every potato.",
     "go PointsIn(manure heap); for Where(crop, eq, potato): [picture] | not_before=sunset"),
    (ORCHARD, HUSKY, "Wait at the charger until 6:30 am and then photograph row 4.",
     "go Marker(charger); for Rows(4, 4): [picture] | not_before=06:30"),
    (ORCHARD, HUSKY, "Tomorrow, wait by tree 4 until 9 am, then photograph row 4.",
     "go TreeIs(4); for Rows(4, 4): [picture] | day=tomorrow not_before=09:00"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), AWAITED, ids=name)
def test_a_time_that_is_awaited_first_begins_the_mission(
    site: Site, robot: RobotProfile, request_: str, plan: str
) -> None:
    require_plan(site, robot, request_, plan)
    found = EnglishPlanner().plan(request_, site, robot)
    assert isinstance(found, Planned)
    assert any("the mission begins at" in line for line in found.task.command.warnings)


@pytest.mark.parametrize(
    "request_",
    [
        "Wait at the charger until 6 pm.",
        "Drive to tree 4 and wait until noon.",
        "Photograph row 4, wait until 6 pm, then photograph it again.",
        "Read CO2 at tree 4, then wait at the charger until 6 pm, then read CO2 at tree 4 again.",
        "Stay at tree 4 until 6 pm and read CO2 every 10 minutes.",
    ],
)
def test_a_time_that_is_awaited_later_is_refused(request_: str) -> None:
    require_refusal(ORCHARD, HUSKY, request_, "cannot wait for a time of the clock")


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Drive to the manure heap. Then photograph every potato.", "for Where(crop, eq, potato): [picture]"),
        ("Go to the rose bed, then photograph V11 and V12.", "for UnionOf(TreeIs(V11)+TreeIs(V12)): [picture]"),
        ("Go to the manure heap and photograph row 3, every plant.", "for Rows(3, 3): [picture]"),
    ],
)
def test_plants_behind_a_drive_to_bare_ground_are_elsewhere(request_: str, plan: str) -> None:
    heap = "rose bed" if "rose" in request_ else "manure heap"
    require_plan(GARDEN, HUSKY, request_, f"go PointsIn({heap}); {plan}")


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Can you read CO2 at tree 4 tomorrow at 7 am?", "day=tomorrow not_before=07:00 not_after=07:15"),
        ("Could you read CO2 at tree 4 every day at noon?", "at=12:00"),
        ("We read CO2 at tree 4 at 6 am every day.", "at=06:00"),
    ],
)
def test_what_is_asked_of_you_was_not_done_before(request_: str, plan: str) -> None:
    require_plan(ORCHARD, HUSKY, request_, f"co2 @ TreeIs(4) | {plan}")
