"""Short requests about fields: what is left out at the ends, what any will do, what is sprayed against."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from planning.grammar.field_requests import require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE = vegetable_garden(), glasshouse(), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")


def ends(row: int, kind: str) -> str:
    """The plants of a kind that fill a row, without those at its ends."""
    at = f"InRow(1, 1, of Rows({row}, {row}))+InRow(-1, -1, of Rows({row}, {row}))"
    return f"for Excluding(UnionOf({at}), of {kind}): [picture]"


KALE, SQUASH = ends(6, "Where(crop, eq, kale)"), ends(5, "Where(crop, eq, squash)")
ENDS_LEFT_OUT = [
    (GARDEN, "Pictures of every kale except the two at the ends of the row.", KALE),
    (GARDEN, "Pictures of every kale except the ones at the ends of the row.", KALE),
    (GARDEN, "Photograph all the kale except the two at the ends.", KALE),
    (GARDEN, "Photograph all the kale but the first and last of the row.", KALE),
    (GARDEN, "Photograph every squash except both ends of the bed.", SQUASH),
    (GARDEN, "Photograph every squash, but not the two at the ends of the bed.", SQUASH),
    (GARDEN, "Photograph every squash except the plants at both ends.", SQUASH),
    (GARDEN, "Take a picture of every squash except the two plants at the ends of bed 5.", SQUASH),
    (GARDEN, "Photograph every plant in bed 3 except the two at the ends.", ends(3, "Rows(3, 3)")),
    (GARDEN, "Photograph bed 3 without the two at the ends.", ends(3, "Rows(3, 3)")),
    (GLASSHOUSE, "Photograph every mint except the two at the ends of the row.", ends(4, "Where(crop, eq, mint)")),
]


@pytest.mark.parametrize(("site", "request_", "plan"), ENDS_LEFT_OUT)
def test_the_ends_of_the_only_row_of_a_kind_are_left_out(site, request_, plan):
    require_plan(site, AMIGA, request_, plan)


@pytest.mark.parametrize(
    "request_",
    [
        "Photograph every potato except the two at the ends of the row.",
        "Photograph every kale except the three at the ends of the row.",
        "Photograph every kale except the two at the ends of bed 5.",
    ],
)
def test_other_ends_are_not_guessed(request_):
    require_refusal(GARDEN, AMIGA, request_, "does not fit")


ROWS_NOT_NETTED = [
    ("Film the beds that aren't netted.", "film rows Rows(of Where(netted, eq, False))"),
    ("Film the beds which aren't netted.", "film rows Rows(of Where(netted, eq, False))"),
    ("Film each bed that isn't netted.", "film rows Rows(of Where(netted, eq, False))"),
    ("Spray the rows that aren't netted.", "spray rows Rows(of Where(netted, eq, False))"),
    ("Spray every row that isn't netted at 200 l/ha.", "spray rows Rows(of Where(netted, eq, False)), rate_l_ha 200"),
    ("Drive along the beds that are not netted.", "drive rows Rows(of Where(netted, eq, False))"),
    ("Film the beds that are netted.", "film rows Rows(of Where(netted, eq, True))"),
    ("Photograph the plants that aren't netted.", "for Where(netted, eq, False): [picture]"),
]


@pytest.mark.parametrize(("request_", "plan"), ROWS_NOT_NETTED)
def test_rows_that_are_not_so_are_those_marked_otherwise(request_, plan):
    require_plan(GARDEN, TRACTOR, request_, plan)


ANY_WILL_DO = [
    ("Moisture at three plants of each crop, any three will do.", "for Quota(crop, 3): [moisture]"),
    ("Moisture at three plants of each crop, any will do.", "for Quota(crop, 3): [moisture]"),
    ("I need leaf samples from two plants of each crop, any two will do.", "for Quota(crop, 2): [sample_leaf]"),
    ("Leaf samples from two plants of each crop, any of them will do.", "for Quota(crop, 2): [sample_leaf]"),
    ("Nitrate at one plant of each crop, it doesn't matter which.", "for Quota(crop, 1): [nitrate]"),
    ("Photograph four plants of each crop, whichever you like.", "for Quota(crop, 4): [picture]"),
    ("Leaf samples from three beans, any three will do.", "for Take(3, of Where(crop, eq, bean)): [sample_leaf]"),
    ("Leaf samples from three beans, any of them will do.", "for Take(3, of Where(crop, eq, bean)): [sample_leaf]"),
]


@pytest.mark.parametrize(("request_", "plan"), ANY_WILL_DO)
def test_any_will_do(request_, plan):
    require_plan(GARDEN, AMIGA, request_, plan)


def test_another_number_contradicts_the_first():
    require_refusal(GARDEN, AMIGA, "Moisture at three plants of each crop, any two will do.", "")


TALL = "Where(height_cm, gt, 30, of Where(crop, eq, bean))"
OF_THEM = [
    ("Photograph the beans over 30 cm and cut a leaf from the tallest of them.", "sample_leaf @ Top(height_cm, 1"),
    ("Photograph the beans over 30 cm and clip a leaf of the tallest of them.", "sample_leaf @ Top(height_cm, 1"),
    ("Photograph the beans over 30 cm, then snip a leaf off the tallest of these.", "sample_leaf @ Top(height_cm, 1"),
    ("Photograph the beans over 30 cm and pluck a leaf from the two tallest of them.", "for Top(height_cm, 2"),
    (
        "Photograph the beans over 30 cm and cut a leaf from the shortest of them.",
        "sample_leaf @ Top(height_cm, 1, True",
    ),
]


@pytest.mark.parametrize(("request_", "then"), OF_THEM)
def test_the_best_of_them_is_one_of_those_before(request_, then):
    leaf = "" if then.startswith("sample") else ": [sample_leaf]"
    require_plan(GARDEN, AMIGA, request_, f"for {TALL}: [picture]; {then}, of {TALL}){leaf}")


@pytest.mark.parametrize("first", ["three random beans", "any three beans"])
def test_the_best_of_those_drawn_is_not_known(first):
    require_refusal(GARDEN, AMIGA, f"Photograph {first} and cut a leaf from the tallest of them.", "")


AGAINST = [
    ("Spray row 3 against the mildew, 400 l/ha, only from the west side.", "Rows(3, 3), rate_l_ha 400, west"),
    ("Spray row 3 against mildew at 400 l/ha.", "Rows(3, 3), rate_l_ha 400"),
    ("Spray the kale against the caterpillars.", "Where(crop, eq, kale)"),
    ("Spray bed 6 against aphids.", "Rows(6, 6)"),
    ("Spray beds 2 and 3 against blight, 300 l/ha.", "UnionOf(Rows(2, 2)+Rows(3, 3)), rate_l_ha 300"),
    ("Spray row 5 at 250 l/ha against the slugs.", "Rows(5, 5), rate_l_ha 250"),
    ("Spray rows 1 and 2 against late blight.", "UnionOf(Rows(1, 1)+Rows(2, 2))"),
    ("Spray bed 4 against rust on both sides.", "Rows(4, 4), both"),
]


@pytest.mark.parametrize(("request_", "rows"), AGAINST)
def test_what_is_sprayed_against_changes_no_plan(request_, rows):
    require_plan(GARDEN, TRACTOR, request_, f"spray rows {rows}")


@pytest.mark.parametrize(
    "request_", ["Film row 3 against the mildew.", "Spray row 3 against the wind.", "Spray the mildew in row 3."]
)
def test_against_is_no_purpose_of_other_work(request_):
    require_refusal(GARDEN, TRACTOR, request_, "")


LAPS = "mow perimeter InZone(cow paddock), 2 laps"
EDGE_ONLY = [
    ("Mow two laps along the edge of the cow paddock, nothing further in.", LAPS),
    ("Mow two laps along the edge of the cow paddock and nothing further in.", LAPS),
    ("Mow two rounds along the edge of the cow paddock, nothing in the middle.", LAPS),
    ("Mow two laps around the cow paddock, but not the middle.", LAPS),
    ("Mow two laps around the cow paddock, leave the middle.", LAPS),
    ("Mow along the edge of the bank, nothing further in.", "mow perimeter InZone(bank)"),
    ("Mow along the edge of the bank, nothing inside.", "mow perimeter InZone(bank)"),
    ("Mow once along the edge of the bank, no further in.", "mow perimeter InZone(bank)"),
]


@pytest.mark.parametrize(("request_", "plan"), EDGE_ONLY)
def test_nothing_further_in(request_, plan):
    require_plan(PASTURE, TRACTOR, request_, plan)


ROUND = "for Transect(10, edge, pond): [picture]"
AT_PACE = [
    ("Circle the pond once at 0.5 m/s and take a thermal picture every 10 metres.", "speed 0.5"),
    ("Circle the pond at 0.5 m/s and take a thermal picture every 10 m.", "speed 0.5"),
    ("Circle the pond once, at 0.5 m/s, and take a thermal picture every 10 metres.", "speed 0.5"),
    ("Circle the pond at a speed of 0.4 m/s and take thermal pictures every 10 metres.", "speed 0.4"),
    ("Circle the pond no faster than 0.5 m/s and take a thermal picture every 10 metres.", "speed 0.5"),
    ("Drive around the pond at 0.5 m/s and take a thermal picture every 10 metres.", "speed 0.5"),
    ("Drive once around the pond at 0.5 m/s and take a thermal picture every 10 metres.", "speed 0.5"),
    ("Circle the pond once and take a thermal picture every 10 metres, at 0.5 m/s.", "speed 0.5"),
]


@pytest.mark.parametrize(("request_", "speed"), AT_PACE)
def test_the_speed_of_a_round_stands_before_what_is_taken_on_it(request_, speed):
    require_plan(PASTURE, HUSKY, request_, f"{ROUND} | {speed}")


def test_nothing_further_in_restricts_no_area():
    require_refusal(PASTURE, TRACTOR, "Mow the cow paddock, nothing further in.", "")


@pytest.mark.parametrize(
    "request_",
    [
        "Get me a thermal picture of plant 7.",
        "Air temperature at plant 3.",
        "Take a thermal picture of plants 7 and 8.",
        "CO2 at tree 10.",
    ],
)
def test_a_number_that_each_row_has_asks_for_the_row(request_):
    require_question(GLASSHOUSE, HUSKY, request_, 0)


NO_SUCH = [
    ("Air temperature at H9-4 please.", "there is no tree 'H9-4'"),
    ("Air temperature at plant H9-4.", "there is no tree 'H9-4'"),
    ("Thermal picture of H1-99.", "there is no tree 'H1-99'"),
    ("Thermal pictures of H1-1 and H5-1.", "there is no tree 'H5-1'"),
    ("CO2 at K1-1.", "there is no tree 'K1-1'"),
    ("CO2 at plant 11.", "there is no tree '11'"),
]


@pytest.mark.parametrize(("request_", "why"), NO_SUCH)
def test_ids_that_the_site_lacks_are_named(request_, why):
    require_refusal(GLASSHOUSE, HUSKY, request_, why)


HAY = [
    "Turn the hay on the bank this afternoon.",
    "Turn the hay on the bank.",
    "Ted the hay in the cow paddock.",
    "Bale the hay.",
    "Make hay on the bank.",
    "Rake up the hay on the bank.",
    "Bring in the hay from the cow paddock.",
    "Load the straw bales.",
]


@pytest.mark.parametrize("request_", HAY)
def test_hay_is_work_without_an_action(request_):
    require_refusal(PASTURE, TRACTOR, request_, "asks for work that tractor has no action for")


OVER_SO_LONG = [
    "If somebody comes near, stop until they have been gone for a minute.",
    "If somebody comes near, stop until they are gone for a minute.",
    "If somebody comes near, wait until nobody has been there for two minutes.",
    "Stop for people until they have been away for 30 seconds.",
    "If it rains, wait until it has been dry for 10 minutes.",
    "If it rains, pause until it has stopped for at least 5 minutes.",
    "If it rains, wait until it has been over for 5 minutes, then go on.",
    "If the wind is strong, wait until it has been calm for a quarter of an hour.",
]


@pytest.mark.parametrize("rule", OVER_SO_LONG)
def test_the_time_for_which_an_event_must_be_over_is_no_longest_wait(rule):
    require_refusal(PASTURE, TRACTOR, f"Mow the cow paddock. {rule}", "how long it must be over")


LONGEST_WAIT = [
    ("If it rains, wait until it is over, at most 5 minutes.", "rain: wait 5 min, then return_to_start"),
    ("If it rains, wait until it has stopped for at most 5 minutes.", "rain: wait 5 min, then return_to_start"),
    ("If it rains, wait 5 minutes, then go on.", "rain: wait 5 min, then go_on"),
    ("If it rains, wait for 5 minutes and then come home.", "rain: wait 5 min, then return_to_start"),
]


@pytest.mark.parametrize(("rule", "watch"), LONGEST_WAIT)
def test_the_longest_wait_is_still_said(rule, watch):
    plan = f"mow area InZone(cow paddock) | return_to_start | at any time {watch}"
    require_plan(PASTURE, TRACTOR, f"Mow the cow paddock. {rule}", plan)
