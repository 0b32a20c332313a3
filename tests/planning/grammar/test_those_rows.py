"""Rows that were named before: "these rows", "the same rows", "each of those rows"."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

DEMO, HUSKY = open_site("demo"), load_robot("husky")
FIRST = "Photograph rows 3 to 5."
#: What the second sentence does; rows of it are those of the first.
PLANNED = [
    ("Then measure CO2 at the Carmel trees of these rows.", "for Where(variety, eq, Carmel, of Rows(3, 5)): [co2]"),
    ("Then measure CO2 at the first tree of each of those rows.", "for InRow(1, 1, of Rows(3, 5)): [co2]"),
    ("Then measure CO2 at 2 trees in each of these rows.", "for Quota(row, 2, of Rows(3, 5)): [co2]"),
    ("Then measure CO2 at every third tree of the same rows.", "for EveryNth(3, of Rows(3, 5)): [co2]"),
    ("Then read CO2 at the 4 trees with the highest yield in those rows.", "for Top(yield_kg, 4, of Rows(3, 5)): [co2]"),
    ("Then drive along these rows.", "drive rows Rows(3, 5)"),
    ("Then measure CO2 at 2 trees in each of the rows.", "for Quota(row, 2, of Rows): [co2]"),
]  # fmt: skip


@pytest.mark.parametrize(("then", "plan"), PLANNED)
def test_these_rows_are_those_named_before(then: str, plan: str) -> None:
    outcome = composed(f"{FIRST} {then}", DEMO, HUSKY)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == f"for Rows(3, 5): [picture]; {plan}"
    assert unaccounted(outcome.task) == ()


def test_rows_may_have_been_named_in_a_list() -> None:
    outcome = composed(
        "Photograph the first tree of rows 2 and 6. Then measure CO2 at every tree of these rows.", DEMO, HUSKY
    )
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).endswith("for UnionOf(Rows(2, 2)+Rows(6, 6)): [co2]")


@pytest.mark.parametrize("request_", ["Photograph these rows.", "Photograph tree 4, then each of those rows."])
def test_rows_that_nothing_named_are_not_guessed(request_: str) -> None:
    assert isinstance(composed(request_, DEMO, HUSKY), Refused | Clarify)
