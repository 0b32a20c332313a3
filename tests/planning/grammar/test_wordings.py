"""Orders, ends, limits, stops and parameters in the words of many speakers: the requests of a list mean the same."""

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

SITE, HUSKY, AMIGA = open_site("demo"), load_robot("husky"), load_robot("amiga")
#: Orders of visits and of captures.
ORDERS = {
    "for UnionOf(TreeIs(100)+TreeIs(23)+TreeIs(157)): [picture]": [
        "Photograph trees 100, 23 and 157 in whatever order is shortest.",
        "Photograph trees 100, 23 and 157 in whichever order you find convenient.",
        "Photograph trees 100, 23 and 157. The order of visits is free.",
        "Photograph trees 100, 23 and 157; visit order does not matter.",
        "Photograph trees 100, 23 and 157, order's up to you.",
        "Photograph trees 100, 23 and 157 by the shortest route.",
        "Photograph trees 100, 23 and 157. Any order will do.",
        "Photograph trees 100, 23 and 157. I don't care about the order.",
        "Photograph trees 100, 23 and 157 in the most efficient order.",
        "Photograph trees 100, 23 and 157 in whatever order suits you.",
        "Photograph trees 100, 23 and 157. You choose the order.",
        "Photograph trees 100, 23 and 157. The order in which they are visited doesn't matter.",
        "Photograph trees 100, 23 and 157. Order: free.",
    ],
    "for UnionOf(TreeIs(100)+TreeIs(23)+TreeIs(157)) given: [picture]": [
        "Photograph trees 100, 23 and 157 in that sequence.",
        "Photograph trees 100, 23 and 157 in the order I gave them.",
        "Photograph trees 100, 23 and 157, strictly in that sequence.",
        "Photograph trees 100, 23 and 157 exactly in the order written.",
        "Photograph trees 100, 23 and 157. Keep to this order.",
        "Photograph trees 100, 23 and 157. The order matters.",
        "Photograph trees 100, 23 and 157. Stick to the order.",
        "Photograph trees 100, 23 and 157, respecting this order.",
        "Photograph trees 100, 23 and 157. Order: as listed.",
        "In this order, photograph trees 100, 23 and 157.",
    ],
    "for Ordered(south_to_north, of Rows(9, 9)) given: [picture]": [
        "Photograph row 9 from the south end.",
        "Photograph row 9, beginning by the south.",
        "Photograph row 9, the south end being where you begin.",
        "Photograph row 9, beginning at its southern end.",
        "Photograph row 9. Come at it from the south end.",
        "Photograph row 9. Start at the south end.",
        "Photograph row 9. Work from south to north.",
        "Photograph row 9 starting in the south and ending in the north.",
        "Photograph row 9, south end first.",
    ],
    "for Ordered(south_to_north, of EveryNth(2, south, of Rows(9, 9))) given: [picture]": [
        "Survey every other tree of row 9 with the thermal camera, starting from the south end.",
        "Photograph every other tree of row 9, the south end being where you begin.",
        "From the south end, photograph every other tree of row 9.",
        "Take a picture of every second tree in row 9 beginning with the southernmost.",
        "Take a picture of every second tree in row 9 from south to north.",
    ],
    "co2 @ TreeIs(100); picture @ TreeIs(23); co2 @ TreeIs(157)": [
        "CO2 at tree 100, a picture of tree 23 and CO2 at tree 157, in that order.",
        "In this order: CO2 at tree 100, a picture of tree 23, CO2 at tree 157.",
    ],
    "for UnionOf(TreeIs(4)+TreeIs(5)) given: [co2]; picture @ TreeIs(6)": [
        "CO2 at trees 4 and 5 and a picture of tree 6, in that order.",
    ],
    "for Where(leaf_color, eq, yellow): [co2; picture]": [
        "At each yellow tree take CO2 and a picture, in that order.",
        "CO2 and a picture, in that order, at each yellow tree.",
    ],
}
#: Ends of a mission.
ENDS = {
    "picture @ TreeIs(9) | return_to_start": [
        "Photograph tree 9. Terminate at the start marker.",
        "Photograph tree 9, then toddle on back to where you set off.",
        "Photograph tree 9, then home, nothing else.",
        "Photograph tree 9. Afterwards go back to where you started from.",
        "Photograph tree 9 and be parked at the start. Done.",
    ],
    "picture @ TreeIs(9); go Marker(charger) | stay": [
        "Photograph tree 9. Mission ends at the charger.",
        "Photograph tree 9. The mission should end at the charger.",
        "Photograph tree 9. Final position: the charger.",
        "Photograph tree 9. The robot should be left at the charger.",
        "Photograph tree 9, finishing up at the charger.",
    ],
    "picture @ TreeIs(9)": [
        "Photograph tree 9 and be done with it.",
        "Photograph tree 9, and that'll do.",
        "Photograph tree 9, and that'll do nicely.",
        "Photograph tree 9. You may rest now.",
        "Photograph tree 9. Nothing else.",
        "Photograph tree 9. Done.",
        "Photograph tree 9 and call it a day.",
        "Photograph tree 9, and then you can have your rest.",
        "Photograph tree 9 and that's it.",
        "Photograph tree 9. Job done.",
        "Photograph tree 9, then knock off for the day.",
    ],
    "for Where(leaf_color, eq, yellow): [picture = r1; if r1 > 38 degC: [co2]]": [
        "At every yellow tree take a picture; if it is above 38, CO2, otherwise nothing else.",
        "At every yellow tree take a picture, and if it is above 38 take CO2, and that's it.",
    ],
}
#: Limits, and as many places as they allow.
LIMITS = {
    "for Where(leaf_color, eq, yellow): [picture] | duration_s 1200": [
        "Photograph every yellow tree in 20 minutes or less.",
        "Photograph every yellow tree. You have 20 minutes, not a minute more.",
        "Photograph every yellow tree. 20 minutes, no longer.",
        "Photograph every yellow tree. Time: 20 min.",
        "Photograph every yellow tree. Be done in 20 minutes.",
        "Photograph every yellow tree. It has to be finished in 20 minutes.",
        "Photograph every yellow tree. Cap it at 20 minutes.",
        "Photograph every yellow tree, 20 minutes on the clock.",
        "Photograph every yellow tree in twenty minutes flat.",
    ],
    "for Where(leaf_color, eq, yellow): [picture] | distance_m 400": [
        "Photograph every yellow tree. At most 400 m.",
        "Photograph every yellow tree, not exceeding 400 m.",
        "Photograph every yellow tree; cap the driving at 400 m.",
    ],
    "for Where(leaf_color, eq, yellow): [picture] | reserve 30": [
        "Photograph every yellow tree, battery no lower than 30%.",
        "Photograph every yellow tree, at least 30% left.",
        "Photograph every yellow tree. Stop at 30 % battery.",
        "Photograph every yellow tree without the battery dropping below 30%.",
    ],
    "for Where(leaf_color, eq, yellow) optional: [co2] | duration_s 1200": [
        "Take CO2 at as many as you can of the yellow trees in 20 minutes.",
        "In 20 minutes take CO2 at however many of the yellow trees fit.",
        "Get through as many yellow trees as you can in 20 minutes and take CO2 at each.",
        "Yellow trees, CO2. 20 minutes on the clock, as many as fit, not a minute more.",
    ],
    "for Trees optional: [picture] | distance_m 400": [
        "Photograph as many different trees as possible with at most 400 m of driving.",
    ],
    "for UnionOf(TreeIs(4)+TreeIs(5)+TreeIs(6)) optional: [picture] | duration_s 300": [
        "Photograph as many as you can of trees 4 to 6 within 5 minutes.",
    ],
}
#: Stops at a distance.
STOPS = {
    "for Spaced(20, of Rows(5, 5)): [co2]": [
        "Check CO2 along row 5 at stops 20 m apart.",
        "Along row 5 make stops 20 m apart; at each stop read CO2.",
        "CO2 along row 5. Stops 20 m apart.",
        "CO2 along row 5, stops every 20 m.",
        "CO2 along row 5 at 20 m intervals.",
        "CO2 along row 5, a reading each 20 metres.",
        "Every 20 m along row 5: CO2.",
        "Row 5, every 20 m: CO2.",
        "In row 5 stop every 20 m and read CO2.",
        "Drive along row 5, stopping every 20 m for a CO2 reading.",
        "Read CO2 along row 5, 20 m between stops.",
        "Read CO2 along row 5 with a spacing of 20 m.",
        "Read CO2 along row 5. Spacing: 20 m.",
        "Read CO2 along row 5. One reading every 20 m.",
        "Read CO2 along row 5. Every 20 m will do.",
    ],
    "for UnionOf(Spaced(20, of Rows(5, 5))+Spaced(20, of Rows(7, 7))): [co2]": [
        "Rows 5 and 7, stops 20 m apart: CO2.",
        "CO2 along rows 5 and 7. Stops 20 m apart.",
    ],
    "for Ordered(south_to_north, of Spaced(20, of Rows(5, 5))) given: [air; co2]": [
        "Along row 5, beginning at its southern end, make stops 20 m apart; at each read air temperature and CO2.",
        "From the south end of row 5, the air temperature and CO2 every 20 m.",
    ],
}
#: Parameters of actions.
PARAMETERS = {
    "picture(view ground) @ TreeIs(4)": [
        "A ground-view photograph of tree 4.",
        "Photograph tree 4, view: ground.",
        "Photograph tree 4. View: ground.",
        "Photo of tree 4, ground view.",
        "Ground photos, please, not canopy ones, at tree 4.",
        "Photos of the ground, not of the canopy, at tree 4.",
        "Not canopy but ground photos of tree 4.",
    ],
    "for UnionOf(TreeIs(7)+TreeIs(17)): [moisture(depth_cm 10)]": [
        "Moisture at trees 7 and 17. Depth: 10 cm.",
        "Moisture at trees 7 and 17. The depth should be 10 cm.",
        "Moisture at trees 7 and 17, all at 10 cm.",
        "Depth 10 cm: moisture at trees 7 and 17.",
    ],
    "for UnionOf(TreeIs(7)+TreeIs(17)): [moisture]": [
        "Moisture at trees 7 and 17, standard depth.",
        "Moisture at the default depth at trees 7 and 17.",
        "Moisture at trees 7 and 17. Standard depth is fine.",
    ],
}

#: Requests that may mean something else, and what is open.
NOT_PLANNED = {
    "Photograph tree 100, then tree 23. The order doesn't matter.": "are these two steps, or one round?",
    "Photograph the first six trees of row 9 from the south end.": "the first from the south, or trees 1 to 6?",
    "Take a picture of every second tree in row 10 starting with the last.": "counted from the last, or from the 1st?",
    "Photograph every other tree of rows 2 to 4, starting in the east.": "the trees are counted along the rows",
    "Take CO2 readings along row 5, 15 m apart, four of them.": "four along the row, or four more?",
    "Photograph every tree of row 5. Every 20 m, read CO2.": "every 20 m along which line?",
    "Photograph every tree of row 5 at stops 20 m apart.": "at every tree, or at stops?",
    "CO2 along row 5. Distance: 20 m.": "between stops, or of the drive?",
    "Photograph tree 4, done, then tree 9.": "something follows the end",
    "Photograph yellow trees for 20 minutes.": "at most 20 minutes, or as many as fit?",
    "Ground photos, not ground ones, at tree 5.": "the contrast contradicts itself",
    "Moisture at tree 4 and nitrate at tree 9. Depth: 10 cm.": "of both, or of the last?",
    "Moisture at tree 4, nitrate at tree 9, depth 10 cm.": "of both, or of the last?",
    "Moisture at tree 4 at 30 cm, standard depth.": "the depths contradict each other",
    "Moisture at tree 4 at the usual depth.": "which depth is usual?",
}


@pytest.mark.parametrize(
    ("request_", "plan"),
    [(said, plan) for plans in (ORDERS, ENDS, LIMITS, STOPS) for plan in plans for said in plans[plan]],
)
def test_other_words_mean_the_same(request_: str, plan: str) -> None:
    outcome = composed(request_, SITE, HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert unaccounted(outcome.task) == ()
    assert mismatches(outcome.task, SITE, HUSKY) == ()


@pytest.mark.parametrize(("request_", "plan"), [(said, plan) for plan, many in PARAMETERS.items() for said in many])
def test_a_parameter_is_named_in_any_place(request_: str, plan: str) -> None:
    outcome = composed(request_, SITE, AMIGA)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert unaccounted(outcome.task) == ()


@pytest.mark.parametrize("request_", NOT_PLANNED)
def test_what_may_mean_something_else_is_not_planned(request_: str) -> None:
    robot = AMIGA if "oisture" in request_ or "Ground" in request_ else HUSKY
    assert not isinstance(composed(request_, SITE, robot), Planned)
