"""Requests that the grammar of constructions plans: as the rules do where both plan, and some that the rules refuse."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

from functools import cache

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.grammar.reader import composed, read
from fieldhand.planning.planner import Planned, Refused
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline
from planning.english.vineyards import vineyard
from support.requests import english, rows
from support.requests.inserted import with_word

ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}
KNOWN = [case[:3] for case in (*english.PLANNED, *rows.PLANNED)]
UNKNOWN = ("gently", "purple", "xyzzy", "backwards", "maybe")
#: Requests in words of other people, and what they become.
MORE = {
    "demo": [
        ("Everything within 15 metres of tree 88 needs a canopy temperature reading.", "for Within(15, TreeIs(88)): [picture]"),
        ("Pick 12 trees at random across the whole orchard and measure the canopy temperature of each.", "for RandomSample(12): [picture]"),
        ("Rows 4 through 6, canopy temp and air temp at each tree, then head back to where you began.", "for Rows(4, 6): [picture; air] | return_to_start"),
        ("Thermal at trees 100 through 102. If there's enough battery left over, do CO2 on those too.", "for UnionOf(TreeIs(100)+TreeIs(101)+TreeIs(102)): [picture; maybe [co2]]"),
        ("scan every second tree of row 2 with the thermal camera", "for EveryNth(2, of Rows(2, 2)): [picture]"),
        ("Row 7, every third tree, thermal, then go park at the charger.", "for EveryNth(3, of Rows(7, 7)): [picture]; go Marker(charger) | stay"),
        ("read co2 at the tree of row 5 farthest from the charger", "co2 @ Farthest(Marker(charger), of Rows(5, 5))"),
        ("take a picture of three trees in row 3 next to each other", "for Adjacent(Here, 3, of Rows(3, 3)): [picture]"),
    ],
    "vineyard": [
        ("north block row 8, co2 + air temp", "for Rows(8, 8, of InBlock(North)): [co2; air] | return_to_start"),
        ("The southwest quarter of the south block, canopy temps please.", "for Quarter(sw, of InBlock(South)): [picture] | return_to_start"),
        ("thermal north block row 2", "for Rows(2, 2, of InBlock(North)): [picture] | return_to_start"),
        ("South block rows 1 to 3, every 4th vine, thermal.", "for EveryNth(4, of Rows(1, 3, of InBlock(South))): [picture] | return_to_start"),
        ("North rows 3, 4 and 5 with the thermal camera, don't use more than 60% of the battery.", "for UnionOf(Rows(3, 3, of InBlock(North))+Rows(4, 4, of InBlock(North))+Rows(5, 5, of InBlock(North))): [picture] | energy_percent 60 | return_to_start"),
        ("Just the easternmost and westernmost vine of the whole place, air temp at each.", "for UnionOf(Extreme(east)+Extreme(west)): [air] | return_to_start"),
        ("Take pictures of the vines along the edge of the south block.", "for UnionOf(Edge(north, of InBlock(South))+Edge(east, of InBlock(South))+Edge(south, of InBlock(South))+Edge(west, of InBlock(South))): [picture] | return_to_start"),
    ],
}  # fmt: skip


@cache
def site_of(name: str) -> Site:
    return open_site("demo") if name == "demo" else vineyard()


@pytest.mark.parametrize(
    ("site", "request_", "plan"), [(site, *case) for site, cases in MORE.items() for case in cases]
)
def test_what_people_say_is_planned_with_every_word(site: str, request_: str, plan: str) -> None:
    outcome = EnglishPlanner().plan(request_, site_of(site), ROBOTS["husky"])
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert unaccounted(outcome.task) == ()
    assert mismatches(outcome.task, site_of(site), ROBOTS["husky"]) == ()


@pytest.mark.parametrize(
    "request_",
    [
        "Take pictures of row 12.",  # of which block?
        "Take a picture of row 3 of the north block.",  # of every vine, or of one?
        "Take a picture of tree 4 and polish it.",
        "Take pictures of the Merlot vines tomorrow or on Friday, row by row.",
        "Mow between rows 5 and 9 of the North block, and take canopy temps while you are at it.",
        "Drive slowly along row 22 in South and read CO2 at each vine.",
    ],
)  # fmt: skip
def test_what_is_open_or_not_possible_is_not_planned(request_: str) -> None:
    assert not isinstance(EnglishPlanner().plan(request_, site_of("vineyard"), ROBOTS["husky"]), Planned)


@pytest.mark.parametrize("word", UNKNOWN)
def test_an_unknown_word_anywhere_ends_it_or_is_in_what_is_listed_as_a_remark(word: str) -> None:
    """At each position of each request one of the words, in turn; each of them with the thorough profile."""
    for changed in with_word(word, UNKNOWN, [request for _, request, _ in KNOWN[::40]]):
        outcome = composed(changed, site_of("demo"), ROBOTS["husky"])
        if isinstance(outcome, Planned):
            (added,) = {one for one in UNKNOWN if f" {one} " in f" {changed} "}
            remarks = [one for one in outcome.task.command.assumptions if "is taken as a remark" in one]
            assert any(added in one for one in remarks), changed


def test_a_place_that_is_understood_and_not_there_is_said_to_be_missing() -> None:
    outcome = EnglishPlanner().plan("CO2 at N250, N9999 and N2 pls", site_of("vineyard"), ROBOTS["husky"])
    assert isinstance(outcome, Refused)
    assert "there is no tree 'N9999'" in outcome.reasons[0].what


def test_reading_twice_gives_the_same() -> None:
    for robot, request, _ in KNOWN[::25]:
        again = [read(request, site_of("demo"), ROBOTS[robot]).readings for _ in range(2)]
        assert again[0] == again[1]


def test_an_empty_or_odd_text_is_not_covered() -> None:
    for text in ("", " ", "...", "?!", "and then", "5", "," * 50, "take " * 60):
        assert isinstance(composed(text, site_of("demo"), ROBOTS["husky"]), Refused)


@pytest.mark.parametrize("part", ["tree 4 and ", "a picture of every tree in row 3 and ", "if it is low, "])
def test_a_request_of_any_length_is_read_within_bounds(part: str) -> None:
    request = f"Take a picture of {part * 300}tree 9."
    assert isinstance(composed(request, site_of("demo"), ROBOTS["husky"]), Refused)
