"""Requests as growers say them, on a made vineyard: planned where the places are right, else asked or refused.

Which places are right is told here from how the vineyard was planted, not by the selectors.
"""

# ruff: noqa: E501 - a request and its places stand on one line each

from __future__ import annotations

import itertools
import math
import random
import re
from collections.abc import Callable

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.places.selectors import Evenly, Quota, RandomSample, Successive
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Outcome, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.task.plan import walk
from fieldhand.task.results import Acted
from planning.english.outlines import outline
from planning.english.vineyards import ALONG, ROWS, Vine, vines, vineyard
from support.examples import examples
from support.missions.flights import fly_task

HUSKY = load_robot("husky")
BY_ID = {vine.id: vine for vine in vines()}


def outcome_of(request: str) -> Outcome:
    return EnglishPlanner(suggests=False).plan(request, vineyard(), HUSKY)


def visited(outcome: Planned) -> list[Vine]:
    """The vines that the selectors of a plan come to from the start."""
    found: list[str] = []
    for node in walk(outcome.task.composition.plan):
        selector = node.selector
        if selector is not None and not selector.relative:
            found += [p.id for p in resolve(selector, vineyard(), Context(here=vineyard().start))]
    return [BY_ID[one] for one in found]


def north(vine: Vine) -> bool:
    return vine.block == "North"


def at(block: str, row: int, place: int) -> Vine:
    return next(v for v in vines() if (v.block, v.row, v.place) == (block, row, place))


N250 = BY_ID["N250"]
EXACT: list[tuple[str, Callable[[Vine], bool]]] = [
    ("Take pictures of rows 3 to 8 of the north block.", lambda v: north(v) and 3 <= v.row <= 8),
    ("Take pictures of every tree in the north block.", north),
    ("Take a picture at the first and last vine of every tenth row of the north block.", lambda v: north(v) and v.row in (1, 11) and v.place in (1, ALONG)),
    ("Take a picture of every fifth vine in rows 3 to 8 of the north block.", lambda v: north(v) and 3 <= v.row <= 8 and v.place % 5 == 1),
    ("Take 3 pictures of each vine in row 2 of the north block.", lambda v: north(v) and v.row == 2),
    ("Measure CO2 at the vines with vigor below 0.35 in the south block.", lambda v: not north(v) and v.vigor < 0.35),
    ("Take a picture of vine N250 and the vine next to it on the east.", lambda v: v in (N250, at(N250.block, N250.row + 1, N250.place))),
    ("Take a picture of vine N250 and the vine next to it on the west.", lambda v: v in (N250, at(N250.block, N250.row - 1, N250.place))),
    ("Take a picture of vine N250 and the vine to the north of it.", lambda v: v in (N250, at(N250.block, N250.row, N250.place - 1))),
    ("Take a picture of the southern neighbour of vine N250.", lambda v: v is at(N250.block, N250.row, N250.place + 1)),
    ("Take a picture of vine N250 and its two neighbours.", lambda v: v.block == N250.block and v.row == N250.row and abs(v.place - N250.place) <= 1),
    ("Take pictures of the last 3 vines of row 8 of the north block.", lambda v: north(v) and v.row == 8 and v.place > ALONG - 3),
    ("Take pictures of every 4th vine in row 8 of the south block starting with the second.", lambda v: not north(v) and v.row == 8 and v.place % 4 == 2),
    ("Take pictures of the Syrah vines in row 7 of the south block.", lambda v: not north(v) and v.row == 7),
    ("Take a picture at each corner of the north block and then come home.", lambda v: north(v) and v.row in (1, ROWS) and v.place in (1, ALONG)),
    ("Every morning take pictures of row 12 of the north block.", lambda v: north(v) and v.row == 12),
    ("Take pictures of row 12 of the north block tomorrow.", lambda v: north(v) and v.row == 12),
    ("Take a picture of every second vine in row 5 of the north block, but only on weekdays.", lambda v: north(v) and v.row == 5 and v.place % 2 == 1),
    ("Daily, measure CO2 at vine N250.", lambda v: v is N250),
    ("Measure CO2 at N250, N300 and N2.", lambda v: v.id in ("N250", "N300", "N2")),
    ("Take a picture at the corners of both blocks.", lambda v: v.row in (1, ROWS) and v.place in (1, ALONG)),
]  # fmt: skip

#: How many are drawn, and from which.
DRAWN: list[tuple[str, int, Callable[[Vine], bool]]] = [
    ("Take pictures of 10 vines chosen at random in the north block.", 10, north),
    ("Take a picture of 20 random Merlot vines.", 20, lambda v: v.variety == "Merlot"),
    ("Measure CO2 at one random vine in the south block.", 1, lambda v: not north(v)),
    ("Photograph 3 vines picked at random in each of rows 2, 3 and 4 of the north block.", 9, lambda v: north(v) and v.row in (2, 3, 4)),
]  # fmt: skip

NOT_PLANNED = """
Take pictures of row 12.
Drive down rows 3 to 8 of the north block and spray.
Mow between rows 10 and 14 of the north block.
Count the grapes on 10 Syrah vines.
Take pictures of the missing vines in the south block.
Take pictures of a few vines in the north block.
Take pictures on the left side of the north block.
Skip the ones you did last season and take pictures of the rest of row 5 in the north block.
Sample 5 vines per variety.
Take pictures of 5 vines. Do not drive through row 10.
Measure CO2 at the two vines closest to vine N250 on the east side.
Take as many pictures as you can of the south block with 30 % battery.
Patrol the vineyard.
Measure CO2 at vine N9999.
Measure CO2 at N9999.
If the battery is below 50 percent come home.
Take pictures of random vines in the north block.
""".strip().splitlines()


@pytest.mark.parametrize(("request_", "is_meant"), EXACT, ids=lambda v: v[:60] if isinstance(v, str) else "")
def test_a_request_comes_to_the_vines_that_are_meant(request_: str, is_meant: Callable[[Vine], bool]) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Planned), outcome
    assert {v.id for v in visited(outcome)} == {v.id for v in vines() if is_meant(v)}
    assert unaccounted(outcome.task) == ()


@pytest.mark.parametrize(("request_", "count", "is_meant"), DRAWN, ids=lambda v: v[:60] if isinstance(v, str) else "")
def test_a_draw_is_of_the_vines_that_are_meant_and_not_of_the_nearest(
    request_: str, count: int, is_meant: Callable[[Vine], bool]
) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Planned), outcome
    drawn = visited(outcome)
    assert len({v.id for v in drawn}) == count
    assert all(is_meant(v) for v in drawn)
    selectors = [node.selector for node in walk(outcome.task.composition.plan)]
    parts = [part for s in selectors if s is not None for part in s.walk()]
    assert any(isinstance(part, RandomSample) or (isinstance(part, Quota) and part.how == "random") for part in parts)
    assert outcome == outcome_of(request_)
    if count >= 10:
        assert max(v.y for v in drawn) - min(v.y for v in drawn) > 20.0


@pytest.mark.parametrize(
    ("request_", "count", "whole"),
    [
        ("Take a picture of 3 of every 5 vines in row 2 of the north block.", 3, 5),
        ("Measure CO2 at two out of every four vines of row 2 of the north block.", 2, 4),
    ],
)
def test_some_of_every_few_vines_are_taken_evenly_along_the_row(request_: str, count: int, whole: int) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Planned), outcome
    row = sorted((v for v in vines() if (v.block, v.row) == ("North", 2)), key=lambda v: v.place)
    taken = {v.place for v in visited(outcome)}
    assert taken <= {v.place for v in row}
    for begin in range(0, len(row) - whole + 1, whole):
        few = [v.place for v in row[begin : begin + whole]]
        assert len(taken & set(few)) == count
        assert {few[0], few[-1]} <= taken


@pytest.mark.parametrize(
    ("request_", "count", "whole"),
    [
        ("Drive along 5 vines and take a picture of 3 of them.", 3, 5),
        ("Of the next 6 vines measure CO2 at any 2.", 2, 6),
        ("Take pictures of 3 of the next 5 vines down the row.", 3, 5),
    ],
)
def test_some_of_a_run_of_vines_are_taken_evenly_along_it(request_: str, count: int, whole: int) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Planned), outcome
    (selector,) = [node.selector for node in walk(outcome.task.composition.plan) if node.selector is not None]
    assert selector == Evenly(count=count, of=Successive(count=whole))


@pytest.mark.parametrize(
    ("request_", "count"),
    [
        ("Take pictures of 8 vines spread over the north block.", 8),
        ("Measure CO2 at 5 vines spread across the north block.", 5),
        ("Measure CO2 at 6 vines far apart from each other in the north block.", 6),
    ],
)
def test_spread_vines_are_of_the_block_and_far_from_each_other(request_: str, count: int) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Planned), outcome
    spread = visited(outcome)
    block = [v for v in vines() if north(v)]
    assert len({v.id for v in spread}) == count
    assert {v.id for v in spread} <= {v.id for v in block}
    apart = min(math.dist((a.x, a.y), (b.x, b.y)) for a, b in itertools.combinations(spread, 2))
    area = (max(v.x for v in block) - min(v.x for v in block)) * (max(v.y for v in block) - min(v.y for v in block))
    # No more discs of that radius than these fit: with them the block is covered.
    assert apart > 0.5 * math.sqrt(area / count)
    assert unaccounted(outcome.task) == ()


def test_two_draws_of_a_request_are_independent() -> None:
    outcome = outcome_of(
        "Take pictures of 10 random vines in the north block. Measure CO2 at 10 random vines in the north block."
    )
    assert isinstance(outcome, Planned), outcome
    assert len({v.id for v in visited(outcome)}) > 10


@pytest.mark.parametrize(
    ("request_", "expected"),
    [
        ("Patrol the property line.", "drive perimeter Trees"),
        ("Drive around the south block once.", "drive perimeter InBlock(South)"),
        ("Drive along rows 3 to 8 of the north block.", "drive rows Rows(3, 8, of InBlock(North))"),
        ("Drive through every second aisle of the south block.", "drive aisles InBlock(South), every 2"),
    ],
)
def test_any_robot_drives_along_rows_aisles_and_edges(request_: str, expected: str) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Planned)
    assert outline(outcome.task) == f"{expected} | return_to_start"


@pytest.mark.parametrize("request_", NOT_PLANNED)
def test_what_cannot_be_done_as_said_is_asked_or_refused(request_: str) -> None:
    assert isinstance(outcome_of(request_), Clarify | Refused)


BASES = """
Take pictures of row 12 of the north block.
Measure CO2 at vine N250.
Take a picture of vine N250 and measure CO2 there.
Take pictures of 10 random vines in the north block.
Take a picture of the vine next to vine N250 on the east.
Take a picture of every fifth vine in rows 3 to 8 of the north block.
Measure CO2 at vine N250. If it is above 450 ppm, take a picture.
Take pictures of the vines with vigor below 0.35 in the south block.
Take pictures of as many vines in the north block as you can without driving more than 400 m.
""".strip().splitlines()
#: What a plan cannot hold, of every kind that growers use; an open list.
MODIFIERS = """
slowly; carefully; quickly; gently; tomorrow; daily; hourly; regularly; tonight; yesterday; sometimes; weekly; every morning; each week
on weekdays; at 6 am; before sunrise; at noon; in the morning; after the rain; during lunch; next week; last week; on Monday; in June
once a day; every hour; for powdery mildew; for pests; for water stress; for the lab; with flash; in colour; from above
on the sunny side; facing north; in the shade; without flash; weak; sick; healthy; missing; ripe; sprayed; pruned; thirsty; infected
flowering; shaded; a few; several; on average; at the median; per variety; unless it rains; if the weather is fine
weather permitting; avoiding the mud; except the weak ones; and spray; and mow; and count the grapes; and prune
and water it; and take a leaf sample; and record a video; and call me; the ones you did last season; starting at the pond; via the barn
along the road; near the fence; backwards; diagonally; in a zigzag; clockwise; from 2 m away; with the drone; by hand
silently; urgently; secretly; until dark; for 10 minutes; with two robots; twice a day; every 10 minutes
""".replace("\n", ";").split(";")


@pytest.mark.parametrize("base", BASES)
def test_a_word_that_no_plan_holds_is_never_dropped_in_silence(base: str) -> None:
    """Wherever it is put in: refused, asked, or a warning that has to be confirmed.

    Each modifier is put into one of the requests; with the thorough profile, into each of them.
    """
    plain = outcome_of(base)
    assert isinstance(plain, Planned), plain
    assert unaccounted(plain.task) == ()
    chance = random.Random(base)
    modifiers = [m.strip() for m in MODIFIERS if m.strip()]
    silent: list[str] = []
    bases = examples(len(BASES), thorough=1)
    for modifier in modifiers[BASES.index(base) % bases :: bases]:
        words = base.split()
        k = chance.randrange(1, len(words))
        said = [
            f"{modifier[0].upper()}{modifier[1:]}, {base[0].lower()}{base[1:]}",
            f"{base[:-1]} {modifier}.",
            f"{base[:-1]}, {modifier}.",
            " ".join([*words[:k], modifier, *words[k:]]),
            re.sub(r"\b(vines?|row|rows|picture|pictures|CO2)\b", rf"{modifier} \1", base, count=1),
        ]
        for request in said:
            outcome = outcome_of(request)
            if not isinstance(outcome, Planned) or unaccounted(outcome.task) or outcome.task.command.warnings:
                continue
            timed = outcome.task.timing is not None and any(
                modifier.lower() in request[start:end].lower() for start, end in outcome.task.timing.said
            )
            if not timed:
                silent.append(request)
    assert silent == []


def test_as_many_weak_vines_as_possible_are_weak() -> None:
    """The budget decides how many; nearly all of them are among the weakest quarter, and without a ranking they are not."""
    ranks = {vine.id: k for k, vine in enumerate(sorted(vines(), key=lambda vine: vine.vigor))}
    shares = []
    for request in (
        "Take as many pictures of weak vines as you can in 10 minutes.",
        "Take as many pictures of vines as you can in 10 minutes.",
    ):
        outcome = outcome_of(request)
        assert isinstance(outcome, Planned), outcome
        made = [event.place for event in fly_task(outcome.task, vineyard()).events if isinstance(event, Acted)]
        assert len(made) > 5
        shares.append(sum(ranks[place] < len(ranks) / 4 for place in made) / len(made))
    assert shares[0] > 0.9
    assert shares[1] < 0.6
