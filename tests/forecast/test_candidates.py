"""Of more optional visits than one choice is made from, those that cost least are kept, in forecast and guard alike."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import ProblemError
from fieldhand.evaluation import visit_chooser
from fieldhand.forecast import expected_visits
from fieldhand.forecast.candidates import MOST_CANDIDATES, cheapest
from fieldhand.forecast.mission_state import Visit
from fieldhand.forecast.remaining_work import RemainingWork
from fieldhand.forecast.visit_distances import visit_distances
from fieldhand.forecast.visit_order import drives_for, start_place, with_stands
from fieldhand.forecast.walk_branch import walk_branch
from fieldhand.orienteering import table
from fieldhand.places.selectors import Trees
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import parse_site
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, ForEach
from fieldhand.testing.small_orchard import husky, orchard, task_for
from fieldhand_bench.site.orchard import benchmark_orchard
from support.missions.paper import Paper

ROBOT = load_robot("husky")
MADE = parse_site(benchmark_orchard(120, 3), name="made")
DRIVES = drives_for(MADE, ROBOT)
HERE = start_place(DRIVES)
VISITS = [
    Visit(place=p) for p in with_stands(DRIVES, HERE, [t.place for t in MADE.trees if not DRIVES.problem(t.place)])
]
(HOME,) = DRIVES.stands((MADE.home("return_to_end", HERE),))
METRES = [DRIVES.between(HERE, v.place).length_m + DRIVES.between(v.place, HOME).length_m for v in VISITS]

MANY = ForEach(id="n1", select=Trees(), body=Act(id="", action="take_thermal_picture"), optional=True)
FEW = 9


def limited(limit: float) -> Constraints:
    return Constraints(budgets=(Budget(kind="distance_m", limit=limit, failure_probability=0.1),))


def test_a_table_has_room_for_the_candidates_the_place_in_hand_and_the_end() -> None:
    assert MOST_CANDIDATES + 2 == table.MOST


def test_what_is_kept_is_not_refused_and_one_more_would_be(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(table, "MOST", FEW + 2)
    rest = RemainingWork(stops=(HOME,))
    kept = [VISITS[k] for k in cheapest(HERE, VISITS, rest, DRIVES, FEW)]
    found = visit_distances(HERE, kept, rest, DRIVES, table=3).table
    assert found is not None
    assert found.size == table.MOST
    with pytest.raises(ProblemError, match="more than"):
        visit_distances(HERE, VISITS[: FEW + 1], rest, DRIVES, table=3)


@settings(deadline=None, max_examples=60)
@given(chosen=st.sets(st.integers(0, len(VISITS) - 1), min_size=1), most=st.integers(1, len(VISITS)))
def test_all_are_kept_up_to_the_limit_and_of_more_the_cheapest_in_their_order(chosen: set[int], most: int) -> None:
    order = sorted(chosen)
    visits = [VISITS[k] for k in order]
    kept = cheapest(HERE, visits, RemainingWork(stops=(HOME,)), DRIVES, most)
    assert list(kept) == sorted(set(kept))
    assert len(kept) == min(most, len(visits))
    metres = np.array([METRES[k] for k in order])
    left = np.delete(metres, list(kept))
    assert not len(left) or metres[list(kept)].max() <= left.min() + 2e-3
    assert kept == cheapest(HERE, visits, RemainingWork(stops=(HOME,)), DRIVES, most)


@settings(deadline=None, max_examples=20)
@given(shuffled=st.permutations(range(len(VISITS))), most=st.integers(1, len(VISITS)))
def test_the_order_of_the_visits_decides_only_between_equal_ones(shuffled: list[int], most: int) -> None:
    rest = RemainingWork(stops=(HOME,))
    one = sorted(round(METRES[k], 2) for k in cheapest(HERE, VISITS, rest, DRIVES, most))
    kept = cheapest(HERE, [VISITS[k] for k in shuffled], rest, DRIVES, most)
    assert sorted(round(METRES[shuffled[k]], 2) for k in kept) == one


def test_where_nothing_follows_only_the_way_there_counts() -> None:
    there = [DRIVES.between(HERE, v.place).length_m for v in VISITS]
    kept = cheapest(HERE, VISITS, RemainingWork(), DRIVES, 12)
    assert max(there[k] for k in kept) <= min(m for k, m in enumerate(there) if k not in kept) + 2e-3


def test_a_visit_that_ends_elsewhere_counts_the_way_home_from_there() -> None:
    near, *others = (VISITS[k] for k in np.argsort(METRES, kind="stable")[:3])
    home = [DRIVES.between(v.place, HOME).length_m for v in VISITS]
    moved = Visit(place=near.place, leaves=VISITS[int(np.argmax(home))].place)
    assert 0 in cheapest(HERE, [near, *others], RemainingWork(stops=(HOME,)), DRIVES, 2)
    assert cheapest(HERE, [moved, *others], RemainingWork(stops=(HOME,)), DRIVES, 2) == (1, 2)


def test_straight_drives_need_no_table_and_keep_all() -> None:
    site = orchard(zones=[])
    drives = drives_for(site, ROBOT)
    here = start_place(drives)
    visits = [Visit(place=p) for p in with_stands(drives, here, [t.place for t in site.trees])]
    home = site.home("return_to_end", here)
    straight = drives.are_straight([here, *(v.place for v in visits), home])
    assert straight == drives.roadmap([here, *(v.place for v in visits), home]).straight
    kept = cheapest(here, visits, RemainingWork(stops=(home,)), drives, 3)
    assert len(kept) == (len(visits) if straight else 3)


def test_the_forecast_counts_what_is_left_out_and_expects_no_visit_there(monkeypatch: pytest.MonkeyPatch) -> None:
    task = task_for(MADE, MANY, constraints=limited(150.0))
    free = walk_branch(task, MADE, husky(), holds=lambda _: True)
    monkeypatch.setattr(expected_visits, "cheapest", partial(cheapest, most=FEW))
    few = walk_branch(task, MADE, husky(), holds=lambda _: True)
    (all_, kept) = (next(s for s in found.steps if s.kind == "visit-list") for found in (free, few))
    assert kept.visit_forecast is not None
    assert all_.visit_forecast is not None
    assert set(kept.visit_forecast.chances) == set(all_.visit_forecast.chances)
    assert {p.id for p in (*kept.places, *kept.shed)} == {p.id for p in (*all_.places, *all_.shed)}
    assert sum(chance > 0.0 for chance in kept.visit_forecast.chances.values()) <= FEW
    assert 0 < kept.visit_forecast.visits <= min(FEW, all_.visit_forecast.visits + 1e-9)
    assert len(kept.places) == round(kept.visit_forecast.visits)


@pytest.mark.parametrize("seed", range(3))
def test_the_guard_visits_only_what_it_chooses_from_and_gives_up_the_rest_at_the_end(
    monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    task, places, most = task_for(MADE, MANY, constraints=limited(110.0)), [v.place for v in VISITS], 30
    within = {VISITS[k].place.id for k in cheapest(HERE, VISITS, RemainingWork(stops=(HOME,)), DRIVES, most)}
    monkeypatch.setattr(visit_chooser, "cheapest", partial(cheapest, most=most))
    paper = Paper(task, MADE, husky(), seed)
    last = paper.optional(MANY, places)
    assert 0 < len(paper.visited) < most
    assert set(paper.visited) <= within
    assert {name for name, _ in paper.shed} == {p.id for p in places} - set(paper.visited)
    assert last is not None
    assert last.index is None
    assert f"{most} others cost less to reach" in last.reason


def test_when_all_are_visited_the_guard_goes_on_with_those_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    task, places = task_for(MADE, MANY, constraints=limited(400.0)), [v.place for v in VISITS]
    within = {VISITS[k].place.id for k in cheapest(HERE, VISITS, RemainingWork(stops=(HOME,)), DRIVES, FEW)}
    monkeypatch.setattr(visit_chooser, "cheapest", partial(cheapest, most=FEW))
    paper = Paper(task, MADE, husky(), 0)
    paper.optional(MANY, places)
    assert set(paper.visited[:FEW]) == within
    assert len(paper.visited) > FEW
    assert paper.spent.metres <= 400.0


def test_up_to_the_limit_a_guard_decides_as_it_would_without_one(monkeypatch: pytest.MonkeyPatch) -> None:
    task, places = task_for(MADE, MANY, constraints=limited(150.0)), [v.place for v in VISITS]
    found = []
    for most in (MOST_CANDIDATES, len(places)):
        monkeypatch.setattr(visit_chooser, "cheapest", partial(cheapest, most=most))
        paper = Paper(task, MADE, husky(), 1)
        paper.optional(MANY, places)
        found.append((paper.visited, paper.shed))
    assert found[0] == found[1]
