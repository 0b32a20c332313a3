"""Requests about rows: on the demo orchard, and where blocks, names, directions or the want of rows matter."""

from __future__ import annotations

import pytest

import planted
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Outcome, Planned, Refused
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.geojson import open_site
from fieldhand.task.codec import decode, encode
from fieldhand.task.references import references
from fieldhand.task.schema import validate
from outlines import outline
from row_requests import ASKED, PLANNED, REFUSED

DEMO = open_site("demo")
ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}
SITES = {
    "blocks": planted.two_blocks(),
    "crossed": planted.crossed(),
    "named": planted.named_rows(),
    "east-west": planted.east_west(),
    "scattered": planted.scattered(),
}

#: (site, request, what becomes of it)
ELSEWHERE = [
    ("blocks", "take a picture of every tree in row 3", "asks 'row 3': of which block?"),
    ("blocks", "take a picture of tree 4 of row 3 of block B", "picture @ InRow(4, 4, of Rows(3, 3, of InBlock(B)))"),
    ("blocks", "take a picture of every tree in block b", "for InBlock(B): [picture]"),
    ("blocks", "take 3 pictures in block A", "for Take(3, of InBlock(A)): [picture]"),
    (
        "blocks",
        "take a picture of a tree in each block",
        "for Union(Take(1, of InBlock(A))+Take(1, of InBlock(B))): [picture]",
    ),
    ("blocks", "take pictures in the block", "asks 'the block': which block?"),
    ("blocks", "take pictures in block C", "refuses 'block C': this site has none of that name"),
    ("blocks", "take pictures of row B2", "refuses there is no row 'B2'"),
    ("blocks", "take pictures of the last row", "asks 'the last row': of which block?"),
    ("blocks", "take pictures of the last row of block A", "for Rows(-1, -1, of InBlock(A)): [picture]"),
    ("blocks", "take pictures of the westernmost row", "asks 'the westernmost row': of which block?"),
    ("blocks", "take pictures of every other row of block A", "for Rows(2, of InBlock(A)): [picture]"),
    ("blocks", "take pictures of every other row", "for Rows(2): [picture]"),
    (
        "blocks",
        "take pictures of row 2 of blocks A and B",
        "for Union(Rows(2, 2, of InBlock(A))+Rows(2, 2, of InBlock(B))): [picture]",
    ),
    ("blocks", "take pictures at the corners of block B", "for Corners(of InBlock(B)): [picture]"),
    ("blocks", "take pictures in the northern half of block B", "for Half(north, of InBlock(B)): [picture]"),
    (
        "blocks",
        "take a picture of the oldest tree of each of rows 1 and 2 of block B",
        "for Union(Top(age, 1, of Rows(1, 1, of InBlock(B)))+Top(age, 1, of Rows(2, 2, of InBlock(B)))): [picture]",
    ),
    (
        "blocks",
        "in block B, take a picture of every third tree of row 2",
        "for EveryNth(3, of Rows(2, 2, of InBlock(B))): [picture]",
    ),
    (
        "crossed",
        "take pictures of the second row from the north of block river",
        "for Rows(2, 2, north, of InBlock(river)): [picture]",
    ),
    (
        "crossed",
        "take pictures of the second row from the east of block home",
        "for Rows(2, 2, east, of InBlock(home)): [picture]",
    ),
    (
        "crossed",
        "take pictures of the second row from the west of block river",
        "refuses 'the second row from the west': the rows run east-west: they are not counted from the west",
    ),
    (
        "crossed",
        "take pictures of the second row from the east",
        "asks 'the second row from the east': of which block?",
    ),
    ("crossed", "take pictures of every other row of the river block", "for Rows(2, of InBlock(river)): [picture]"),
    ("crossed", "take pictures of the first row of block river", "for Rows(1, 1, north, of InBlock(river)): [picture]"),
    ("crossed", "take pictures of the third row of block river", "for Rows(3, 3, north, of InBlock(river)): [picture]"),
    ("crossed", "take pictures of the third row of block home", "for Rows(3, 3, west, of InBlock(home)): [picture]"),
    ("crossed", "take pictures of the middle row of block river", "for Rows(B3, B3, of InBlock(river)): [picture]"),
    ("crossed", "take a picture of the tree 3 trees east of tree T64", "picture @ AlongRow(3, east, TreeIs(T64))"),
    (
        "crossed",
        "take a picture of the tree 3 trees north of tree T64",
        "refuses 'the tree 3 trees north': the rows run east-west: they have no end in the north",
    ),
    (
        "crossed",
        "take a picture of the tree across the aisle to the south of tree T64",
        "picture @ Across(TreeIs(T64), south)",
    ),
    (
        "crossed",
        "take a picture of the tree across the aisle to the south of tree T4",
        "refuses 'the tree across the aisle to the south': the rows run north-south: no aisle lies to the south",
    ),
    (
        "crossed",
        "take a picture of the tree at the western end of row B1",
        "picture @ InRow(1, 1, west, of Rows(B1, B1))",
    ),
    (
        "crossed",
        "take a picture of the first three trees from the south of row A2",
        "for InRow(1, 3, south, of Rows(A2, A2)): [picture]",
    ),
    (
        "crossed",
        "go to tree T64. go one row further east and take a picture",
        "refuses 'one row further east': the rows of this site run different ways",
    ),
    ("crossed", "take pictures in the home block", "for InBlock(home): [picture]"),
    (
        "crossed",
        "take a picture of every tree in row B1 of the river block",
        "for Rows(B1, B1, of InBlock(river)): [picture]",
    ),
    (
        "crossed",
        "take a picture of each tree in the river and home blocks",
        "for Union(InBlock(river)+InBlock(home)): [picture]",
    ),
    ("crossed", "take pictures in a block", "asks 'a block': which block?"),
    ("blocks", "take pictures in the B block", "for InBlock(B): [picture]"),
    ("blocks", "take pictures in a block", "asks 'a block': which block?"),
    (
        "crossed",
        "take a picture of the northern half of block home",
        "asks 'take a picture of the northern half of block home': at every tree, or at how many?",
    ),
    (
        "crossed",
        "take pictures of the trees in row A1 but not tree T5",
        "for Excluding(TreeIs(T5), of Rows(A1, A1)): [picture]",
    ),
    (
        "crossed",
        "take pictures of the trees in row A1 except trees T5 and T7",
        "for Excluding(Union(TreeIs(T5)+TreeIs(T7)), of Rows(A1, A1)): [picture]",
    ),
    (
        "crossed",
        "take pictures of the trees in row A1 except tree T64",
        "refuses 'tree T64': not all of these trees stand in those rows",
    ),
    ("crossed", "take a picture of tree T5 in row A1", "picture @ TreeIs(T5)"),
    (
        "crossed",
        "take a picture of tree T64 in row A1",
        "refuses 'tree T64': not all of these trees stand in those rows",
    ),
    ("crossed", "take a picture of trees T5, T7 and T64", "for Union(TreeIs(T5)+TreeIs(T7)+TreeIs(T64)): [picture]"),
    ("blocks", "take pictures of the even rows", "asks 'the even rows': of which block?"),
    ("blocks", "take pictures of the odd rows of block B", "for Rows(1, 2, of InBlock(B)): [picture]"),
    ("named", "take pictures of the even rows", "refuses 'the even rows': these rows are not numbered one after"),
    ("named", "take pictures of row A12", "for Rows(A12, A12): [picture]"),
    ("named", "take pictures of rows A12 to A14", "for Rows(A12, A14): [picture]"),
    (
        "named",
        "take a picture of every tree in rows A12, a14 and A16",
        "for Union(Rows(A12, A12)+Rows(A14, A14)+Rows(A16, A16)): [picture]",
    ),
    (
        "named",
        "take a picture of tree 3 of row A12 and a CO2 reading at tree T5",
        "picture @ InRow(3, 3, of Rows(A12, A12)); co2 @ TreeIs(T5)",
    ),
    ("named", "take pictures of row A99", "refuses there is no row 'A99'"),
    ("named", "take pictures of the second row", "for Rows(2, 2, west): [picture]"),
    ("east-west", "take pictures of the northernmost row", "for Rows(1, 1, north): [picture]"),
    ("east-west", "take pictures of the second row from the south", "for Rows(2, 2, south): [picture]"),
    (
        "east-west",
        "take pictures of the second row from the east",
        "refuses 'the second row from the east': the rows run east-west: they are not counted from the east",
    ),
    (
        "east-west",
        "take pictures of the tree at the western end of row 3",
        "picture @ InRow(1, 1, west, of Rows(3, 3))",
    ),
    ("east-west", "take pictures of the middle row", "for Rows(4, 4): [picture]"),
    (
        "east-west",
        "take a picture of tree 20. go two rows further north and take another.",
        "picture @ TreeIs(20); go Take(1, of RowOf(-2)); picture",
    ),
    (
        "east-west",
        "take a picture of tree 20. go 5 trees to the south and take another.",
        "refuses '5 trees to the south': the rows run east-west: they have no end in the south",
    ),
    ("scattered", "take a picture of every tree in row 3", "refuses 'row 3': no rows are known on this site"),
    ("scattered", "take a picture of every third tree", "refuses 'every third tree': no rows are known on this site"),
    (
        "scattered",
        "go to tree 5, then 5 trees down the row",
        "refuses '5 trees down the row': no rows are known on this site",
    ),
    (
        "scattered",
        "take a picture of the tree opposite tree 5",
        "refuses 'the tree opposite': no rows are known on this site",
    ),
    ("scattered", "take three CO2 readings 15 m apart", "for Spaced(15, 3): [co2]"),
]


def said(outcome: Outcome) -> str:
    match outcome:
        case Planned(task=task):
            return outline(task)
        case Clarify(question=question):
            return f"asks {question}"
        case Refused(reasons=reasons):
            return f"refuses {reasons[0].what}"


@pytest.mark.parametrize(("robot", "request_", "plan"), PLANNED, ids=lambda v: str(v)[:60])
def test_a_request_about_rows_becomes_this_plan_and_a_whole_task(robot: str, request_: str, plan: str) -> None:
    outcome = EnglishPlanner().plan(request_, DEMO, ROBOTS[robot])
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    capabilities = capabilities_of(ROBOTS[robot])
    document = encode(outcome.task)
    assert references(outcome.task, capabilities) == ()
    assert validate(document, capabilities) == ()
    assert decode(document) == outcome.task


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("row 3", "every other tree"),
        ("the third row from the east", "every fifth tree"),
        ("every third tree", "rows 2 to 5"),
        ("the wet corner", "yellow trees"),
    ],
)
def test_an_area_and_trees_with_a_comma_alone_between_them_are_the_trees_there(first: str, second: str) -> None:
    outcome = EnglishPlanner().plan(f"take a picture of {first}, {second}", DEMO, ROBOTS["husky"])
    assert isinstance(outcome, Planned)
    inner, area = (second, first) if "tree" in second else (first, second)
    whole = EnglishPlanner().plan(f"take a picture of {inner} of {area}", DEMO, ROBOTS["husky"])
    assert said(outcome) == said(whole)
    assert any(s.startswith(f"'{first}, {second}' is read as ") for s in outcome.task.command.assumptions)


@pytest.mark.parametrize(("robot", "request_", "question"), ASKED, ids=lambda v: str(v)[:60])
def test_what_may_mean_two_things_along_rows_is_asked(robot: str, request_: str, question: str) -> None:
    assert said(EnglishPlanner().plan(request_, DEMO, ROBOTS[robot])) == f"asks {question}"


@pytest.mark.parametrize(("robot", "request_", "why"), REFUSED, ids=lambda v: str(v)[:60])
def test_what_cannot_be_said_of_rows_is_refused_with_its_reason(robot: str, request_: str, why: str) -> None:
    assert said(EnglishPlanner().plan(request_, DEMO, ROBOTS[robot])) == f"refuses {why}"


@pytest.mark.parametrize(("site", "request_", "expected"), ELSEWHERE, ids=lambda v: str(v)[:60])
def test_blocks_names_and_the_way_of_the_rows_matter(site: str, request_: str, expected: str) -> None:
    found = said(EnglishPlanner().plan(request_, SITES[site], ROBOTS["husky"]))
    assert found.startswith(expected) if expected.startswith("refuses") else found == expected


def test_a_row_in_several_blocks_is_asked_with_the_blocks_to_choose_from() -> None:
    outcome = EnglishPlanner().plan("take pictures of row 3", SITES["blocks"], ROBOTS["husky"])
    assert isinstance(outcome, Clarify)
    assert outcome.choices == ("row 3 of block A", "row 3 of block B")
    for choice in outcome.choices:
        assert isinstance(
            EnglishPlanner().plan(f"take pictures of {choice}", SITES["blocks"], ROBOTS["husky"]), Planned
        )


def test_an_assumption_says_which_way_is_counted() -> None:
    outcome = EnglishPlanner().plan(
        "take a picture of tree 20, go to the next row and take another", DEMO, ROBOTS["husky"]
    )
    assert isinstance(outcome, Planned)
    assert "'the next row' is counted towards higher row numbers (east)." in outcome.task.command.assumptions
