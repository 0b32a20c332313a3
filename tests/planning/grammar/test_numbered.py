"""Trees by number in a row, and places by the names that the site gives them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.formats.geojson_export import site_document
from fieldhand.site.loader import load_site, open_site
from planning.english.outlines import outline
from planning.english.vineyards import vineyard

ROBOT = load_robot("husky")


def plan_of(request: str) -> str | None:
    found = composed(request, open_site("demo"), ROBOT)
    return outline(found.task) if isinstance(found, Planned) else None


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("take a picture of tree 5 of row 3", "picture @ InRow(5, 5, of Rows(3, 3))"),
        ("take a picture of trees 4 to 9 of row 2", "for InRow(4, 9, of Rows(2, 2)): [picture]"),
        # Row 3 has fewer trees than 40, and the tree with the id 40 stands in it.
        ("take a picture of tree 40 of row 3", "picture @ TreeIs(40)"),
        (
            "take a picture of every tree in row 3 except tree 5",
            "for Excluding(InRow(5, 5, of Rows(3, 3)), of Rows(3, 3)): [picture]",
        ),
        ("take a picture of every tree in row 3 except tree 40", "for Excluding(TreeIs(40), of Rows(3, 3)): [picture]"),
        ("take a picture of trees 2 to 4 of every row", "for InRow(2, 4, of Rows): [picture]"),
    ],
)
def test_a_number_in_a_row_is_the_tree_that_stands_there(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    "request_",
    [
        "take a picture of every tree in row 3 except the tree with id 5",  # tree 5 stands in row 1
        "Go to tree 12. Take a picture of every tree in the same row except tree 12.",  # by number, or by id?
    ],
)
def test_a_tree_that_stands_elsewhere_or_may_be_two_is_not_planned(request_: str) -> None:
    assert plan_of(request_) is None


def test_a_marker_is_known_by_the_name_that_the_file_gives_it(tmp_path: Path) -> None:
    document = site_document(open_site("demo"))
    for feature in document["features"]:
        if feature["properties"].get("kind") == "start":
            feature["properties"]["name"] = "old barn"
    file = tmp_path / "named.geojson"
    file.write_text(json.dumps(document))
    site = load_site(file)
    assert site.marker_names == (("start", "old barn"),)
    outcome = EnglishPlanner().plan("Take a picture of tree 9 and be back at the old barn.", site, ROBOT)
    assert isinstance(outcome, Planned)
    assert outcome.task.composition.nominal == "return_to_start"
    again = site_document(site)
    assert {"kind": "start", "name": "old barn"} in [feature["properties"] for feature in again["features"]]


@pytest.mark.parametrize("request_", ["Photograph N12 to N15.", "take a picture of vines N12 through N15"])
def test_a_range_of_ids_is_every_one_between(request_: str) -> None:
    outcome = EnglishPlanner().plan(request_, vineyard(), ROBOT)
    assert isinstance(outcome, Planned)
    assert outline(outcome.task).startswith("for UnionOf(TreeIs(N12)+TreeIs(N13)+TreeIs(N14)+TreeIs(N15)): [picture]")


@pytest.mark.parametrize("request_", ["Photograph N15 to N12.", "Photograph N12 to S15."])
def test_a_range_that_runs_backwards_or_between_two_kinds_of_ids_is_none(request_: str) -> None:
    outcome = EnglishPlanner().plan(request_, vineyard(), ROBOT)
    assert not (isinstance(outcome, Planned) and "N13" in outline(outcome.task))
