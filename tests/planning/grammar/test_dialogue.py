"""What several clauses mean together, beyond the known requests: where to go, what is left out, and what is open."""

from __future__ import annotations

from functools import cache

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline


@cache
def demo() -> Site:
    return open_site("demo")


def plan_of(request: str) -> str | None:
    outcome = composed(request, demo(), load_robot("husky"))
    return outline(outcome.task) if isinstance(outcome, Planned) else None


@pytest.mark.parametrize(
    "end", ["come back", "go home", "return", "drive back when done", "come back when you are done"]
)
def test_a_return_without_a_place_is_one_to_the_start(end: str) -> None:
    assert plan_of(f"Take a picture of tree 4 and {end}.") == "picture @ TreeIs(4) | return_to_start"


def test_nothing_follows_a_return_when_all_is_done() -> None:
    assert plan_of("Take a picture of tree 4, come back when done, then take a picture of tree 5.") is None


def test_only_the_last_of_two_commands_may_be_left_out_if_it_has_a_place_of_its_own() -> None:
    both = "Take a picture of tree 4 and measure CO2 at tree 5 if there is time."
    assert plan_of(both) == "picture @ TreeIs(4); maybe [co2 @ TreeIs(5)]"
    assert plan_of("Go to tree 4, take a picture and measure CO2 if there is time.") is None


def test_stops_one_after_the_other_stay_in_order_and_say_where_something_is_done() -> None:
    stops = "for UnionOf(TreeIs(3)+TreeIs(9)+TreeIs(4)) given: [co2]"
    assert plan_of("Go to tree 3, then tree 9, then tree 4, and read CO2 at each of them.") == stops
    assert plan_of("Go to tree 3, then tree 9 and read CO2.") is None  # at tree 3 as well?


@pytest.mark.parametrize(("way", "towards"), [("down", ""), ("up", ", up")])
def test_the_next_trees_are_those_in_the_direction_of_the_drive(way: str, towards: str) -> None:
    plan = f"go TreeIs(50); for UnionOf(AlongRow(1{towards})+AlongRow(2{towards})): [picture]"
    assert plan_of(f"Go to tree 50, go {way} the row and take a picture of the next two trees.") == plan


def test_a_tree_that_may_be_one_of_the_row_before_is_left_open() -> None:
    assert plan_of("Go to row 3, then go to tree 5 and take a picture.") is not None
    assert plan_of("Go to row 3, then go to the northernmost tree and take a picture.") is None


def test_rows_are_counted_to_a_side_that_they_do_not_run_to() -> None:
    assert plan_of("Take a picture of tree 50, move two rows further west and take another.") == (
        "picture @ TreeIs(50); go Take(1, of RowOf(-2)); picture"
    )
    assert plan_of("Take a picture of tree 50, move two rows further north and take another.") is None
    assert plan_of("Take a picture of tree 50, go to the row to the south and take a picture there.") is None


def test_trees_are_counted_from_a_side_by_numbers_as_by_ranks() -> None:
    by_rank = plan_of("Take a picture of the third tree from the south in row 3.")
    assert by_rank is not None
    assert plan_of("Take a picture of tree 3 from the south in row 3.") == by_rank
    counted = "for InRow(2, 4, south, of Rows(3, 3)): [picture]"
    assert plan_of("Take pictures of trees 2 to 4 from the south in row 3.") == counted


def test_what_is_said_to_come_first_is_the_first_step() -> None:
    first = "Photograph the oldest tree first, then measure CO2 at tree 4."
    assert plan_of(first) == "picture @ Top(age_years, 1); co2 @ TreeIs(4)"


def test_a_bare_end_is_no_place_and_nothing_follows_it() -> None:
    assert plan_of("Take a picture at tree 4 and finish.") == "picture @ TreeIs(4)"
    assert plan_of("Go to tree 4 and stop.") == "go TreeIs(4) | stay"
    assert plan_of("Take a picture at tree 4, stop, then measure CO2 at tree 5.") is None


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        (
            "Take a picture of every third tree in row 2. Do the same in row 4.",
            "for EveryNth(3, of Rows(2, 2)): [picture]; for EveryNth(3, of Rows(4, 4)): [picture]",
        ),
        (
            "Take a picture of the oldest tree in the northern half. Do the same in the southern half.",
            "picture @ Top(age_years, 1, of Half(north)); picture @ Top(age_years, 1, of Half(south))",
        ),
        (
            "Measure CO2 at the first tree of row 2. If it is low, take a picture. Do the same in row 4.",
            "co2 @ InRow(1, 1, of Rows(2, 2)) = r1; if r1 low: [picture]; "
            "co2 @ InRow(1, 1, of Rows(4, 4)) = r2; if r2 low: [picture]",
        ),
        (
            "Measure CO2 at tree 40. Take a picture of the last tree in row 2 and do the same in the next row.",
            "co2 @ TreeIs(40); picture @ InRow(-1, -1, of Rows(2, 2)); picture @ InRow(-1, -1, of RowOf(1))",
        ),
    ],
)
def test_the_same_in_another_area_is_done_at_its_corresponding_trees(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    "request_",
    [
        "Take a picture of tree 4 and do the same in row 3.",  # at every tree?
        "Take a picture of every tree in rows 2 and 3. Do the same in the next row.",  # next to which?
        "Take a picture of the first tree in row 2 of the northern half. Do the same in row 4.",  # of that half?
    ],
)
def test_the_same_in_an_area_of_another_kind_is_left_open(request_: str) -> None:
    assert plan_of(request_) is None
