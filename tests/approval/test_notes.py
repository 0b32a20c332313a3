"""The read-back says what a person may not expect of where a mission leads."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.approval.checks import examine
from fieldhand.approval.readback import read_back
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import AlongRow, Top, TreeIs
from fieldhand.site.loader import load_demo
from fieldhand.site.model import Site
from fieldhand.task.plan import Act, ForEach, InOrder
from fieldhand.testing.small_orchard import husky, orchard, task_for

SITE = orchard(rows=8, columns=4)
PICTURE = Act(id="", action="take_thermal_picture")


def notes_of(*selectors: Selector, site: Site = SITE) -> tuple[str, ...]:
    steps = tuple(ForEach(id="", select=s, body=PICTURE) for s in selectors)
    task = task_for(site, InOrder(id="", steps=(replace(PICTURE, at=TreeIs(tree="1")), *steps)))
    estimate = examine(task, site, husky()).estimate
    assert estimate is not None
    return read_back(task, site, husky(), estimate).notes


def test_a_tie_is_told() -> None:
    (note,) = notes_of(Top(attribute="age_years", count=2), site=load_demo())
    assert "tie" in note


def test_the_end_of_a_row_is_told_of_the_tree_in_hand() -> None:
    (note,) = notes_of(AlongRow(trees=30, towards="up"), TreeIs(tree="2"))
    assert "ends" in note


def test_where_there_is_nothing_to_tell_nothing_is_told() -> None:
    assert notes_of(TreeIs(tree="5")) == ()
