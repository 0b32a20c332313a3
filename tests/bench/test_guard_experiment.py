"""The acceptance experiment of the budget guard, in small: a dozen whole missions on small sites."""

from __future__ import annotations

import pytest

from fieldhand.task.event_lines import to_json
from fieldhand_bench.draw import PF, draw, family_of
from fieldhand_bench.families import FAMILIES
from fieldhand_bench.fly import Trial, fly, fly_all
from fieldhand_bench.summary import Summary, summarize, wrongs

MISSIONS, TREES = 12, 30


@pytest.fixture(scope="module")
def trials() -> list[Trial]:
    return list(fly_all(range(MISSIONS), most_trees=TREES))


@pytest.fixture(scope="module")
def found(trials: list[Trial]) -> Summary:
    return summarize(trials)


def test_limits_are_exceeded_no_more_often_than_is_accepted(found: Summary) -> None:
    _, possible, within, *_ = found.promises
    assert possible.missions >= MISSIONS / 2
    assert possible.failures <= possible.most
    assert within.failures <= within.most


def test_nothing_that_must_be_done_is_given_up_in_silence(found: Summary) -> None:
    assert found.silent == ()


def test_no_loop_visits_a_place_twice_and_every_mission_ends_where_it_should(trials: list[Trial]) -> None:
    assert [(t.seed, what) for t in trials for what in wrongs(t)] == []


def test_no_mission_is_ended_by_an_empty_battery(found: Summary) -> None:
    assert found.lost == 0


def test_limits_bind_and_visits_are_made_in_spite_of_them(trials: list[Trial]) -> None:
    choosing = [t for t in trials if t.forecast.visits]
    assert sum(bool(t.ruling.left_out) for t in choosing) >= len(choosing) / 5
    assert sum(t.ruling.visits for t in choosing) >= 0.6 * sum(t.forecast.visits for t in choosing)
    assert any(t.ruling.given_up for t in trials)


def test_every_family_takes_its_turn() -> None:
    assert [family_of(seed) for seed in range(7)] == list(FAMILIES)


@pytest.mark.parametrize("seed", [0, 2, 6])
def test_a_seed_is_always_the_same_mission(seed: int) -> None:
    one, two = fly(seed, TREES), fly(seed, TREES)
    assert [to_json(e) for e in one.events] == [to_json(e) for e in two.events]
    assert one.trial.ruling == two.trial.ruling


def test_drafts_have_limits_of_every_kind_and_sites_of_every_sort() -> None:
    drafts = [d for seed in range(60) if (d := draw(seed, most_trees=TREES)) is not None]
    assert {d.limited for d in drafts} == {"distance", "time", "energy", "two budgets", "charge"}
    assert {d.failure_probability for d in drafts} == set(PF)
    assert {d.robot.name for d in drafts} == {"husky", "amiga"}
    assert {d.task.composition.nominal for d in drafts} == {"return_to_end", "return_to_start", "stay"}
    assert any(d.charge_percent < 50.0 for d in drafts)
    assert any(not d.site.planting.rows for d in drafts)
    assert any(len(d.site.trees) < 15 for d in drafts)
    assert any(d.site.zones for d in drafts)
    assert any(d.site.markers for d in drafts)
