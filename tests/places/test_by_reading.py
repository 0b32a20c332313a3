"""Places chosen by the readings of the mission."""

from __future__ import annotations

import math
from statistics import fmean

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.errors import PlaceError
from fieldhand.places.context import Context
from fieldhand.places.reading_series import ReadingSeries, TakenReading
from fieldhand.places.resolution import resolve
from fieldhand.places.selectors import ByReading, GroupByReading
from support.missions.rig import orchard

SITE = orchard()
IDS = [tree.place.id for tree in SITE.trees]
TAKEN = st.lists(st.tuples(st.sampled_from(IDS), st.integers(300, 600)), min_size=1, max_size=12)


def context(*taken: tuple[str, float | None]) -> Context:
    readings = [
        TakenReading(place=SITE.by_id[name].place, values={} if value is None else {"co2": float(value)})
        for name, value in taken
    ]
    return Context(here=SITE.start, series={"r": ReadingSeries(readings)})


def by(count: int = 1, *, lowest: bool = False) -> ByReading:
    return ByReading(reading="r", quantity="co2", count=count, lowest=lowest)


@given(TAKEN, st.integers(1, 6), st.booleans())
def test_the_most_extreme_come_first_by_the_mean_of_each_place(
    taken: list[tuple[str, int]], count: int, lowest: bool
) -> None:
    values: dict[str, list[int]] = {}
    for name, value in taken:
        values.setdefault(name, []).append(value)
    means = {name: fmean(some) for name, some in values.items()}
    found = [place.id for place in resolve(by(count, lowest=lowest), SITE, context(*taken))]
    assert len(found) == len(set(found)) == min(count, len(means))
    chosen = [means[name] for name in found]
    assert chosen == sorted(chosen, reverse=not lowest)
    others = [mean for name, mean in means.items() if name not in found]
    for other in others:
        assert other >= chosen[-1] if lowest else other <= chosen[-1]


def test_in_a_forecast_the_farthest_is_assumed() -> None:
    away = {name: math.dist(SITE.by_id[name].place.xy, SITE.start.xy) for name in ("r0c0", "r3c4", "r1c1")}
    found = resolve(by(2), SITE, context(*((name, None) for name in away)))
    assert [place.id for place in found] == sorted(away, key=lambda name: -away[name])[:2]


def test_readings_of_another_quantity_do_not_count() -> None:
    other = TakenReading(place=SITE.by_id["r3c4"].place, values={"canopy_temperature": 50.0})
    some = context(("r0c0", 400), ("r1c1", 410))
    both = Context(here=SITE.start, series={"r": some.series["r"].plus(other)})
    assert [place.id for place in resolve(by(5), SITE, both)] == ["r1c1", "r0c0"]


@pytest.mark.parametrize("selector", [by(), GroupByReading(group="row", reading="r", quantity="co2")])
def test_without_a_reading_there_is_no_place(selector: ByReading | GroupByReading) -> None:
    with pytest.raises(PlaceError, match="no reading “r” was taken"):
        resolve(selector, SITE, Context(here=SITE.start))


@given(st.dictionaries(st.sampled_from(IDS), st.integers(300, 600), min_size=1, max_size=12), st.booleans())
def test_a_row_is_chosen_by_the_mean_of_its_readings(values: dict[str, int], lowest: bool) -> None:
    row_of = {tree: row.name for row in SITE.planting.rows for tree in (IDS[k] for k in row.trees)}
    by_row: dict[str, list[int]] = {}
    for name, value in values.items():
        by_row.setdefault(row_of[name], []).append(value)
    selector = GroupByReading(group="row", reading="r", quantity="co2", lowest=lowest)
    found = [place.id for place in resolve(selector, SITE, context(*values.items()))]
    (row,) = {row_of[name] for name in found}
    assert len(found) == sum(name == row for name in row_of.values())
    best = (min if lowest else max)(fmean(some) for some in by_row.values())
    assert fmean(by_row[row]) == pytest.approx(best)


def test_an_extended_series_leaves_the_original_as_it_was() -> None:
    place = SITE.trees[0].place
    one = ReadingSeries([TakenReading(place=place, values={"co2": 1.0})])
    two = one.plus(TakenReading(place=place, values={"co2": 2.0}))
    other = one.plus(TakenReading(place=place, values={"co2": 3.0}))
    assert [s.values("co2") for s in (one, two, other)] == [(1.0,), (1.0, 2.0), (1.0, 3.0)]
