"""Selectors by earlier missions choose exactly the places that the records name, for any records and any period."""

from __future__ import annotations

from datetime import datetime, timedelta

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fieldhand.compatibility import UTC
from fieldhand.errors import NoPlaceError, PlaceError
from fieldhand.places.context import Context
from fieldhand.places.earlier.period import Period
from fieldhand.places.resolution import resolve
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import DoneEarlier, Excluding, Rows, TopEarlier, Trees, WhereEarlier
from fieldhand.site.earlier_missions import EarlierCapture, EarlierMission, EarlierMissions, EarlierValue
from fieldhand.testing.small_orchard import orchard

#: A Wednesday, at noon.
NOW = datetime(2026, 11, 25, 12, tzinfo=UTC)
SITE = orchard(2, 5)
TREES = [tree.place.id for tree in SITE.trees]
ACTIONS = ("take_thermal_picture", "read_co2")


@st.composite
def captures(draw: st.DrawFn) -> EarlierCapture:
    action = draw(st.sampled_from(ACTIONS))
    hours = draw(st.integers(0, 24 * 60))
    outcome = draw(st.sampled_from(("done", "done", "failed")))
    value = (EarlierValue(name="co2", value=draw(st.integers(380, 500)), unit="ppm"),)
    return EarlierCapture(
        place=draw(st.sampled_from(TREES)),
        at=(NOW - timedelta(hours=hours)).isoformat(),
        action=action,
        outcome=outcome,
        values=value if action == "read_co2" and outcome == "done" else (),
    )


@st.composite
def records(draw: st.DrawFn) -> EarlierMissions:
    missions = []
    for number in range(draw(st.integers(1, 3))):
        some = tuple(sorted(draw(st.lists(captures(), max_size=8)), key=lambda one: one.time))
        begun = some[0].at if some else NOW.isoformat()
        missions.append(EarlierMission(id=f"m{number}", begun=begun, captures=some))
    return EarlierMissions(as_of=NOW.isoformat(), missions=tuple(missions))


periods = st.one_of(
    st.just(Period()),
    st.builds(lambda c: Period(calendar=c), st.sampled_from(("today", "yesterday", "this_week", "last_month", "mon"))),
    st.builds(lambda n: Period(last_days=n), st.integers(1, 70)),
    st.builds(lambda n: Period(last_hours=n), st.integers(1, 1500)),
    st.builds(lambda n: Period(first_day=(NOW - timedelta(days=n)).date().isoformat()), st.integers(0, 60)),
)


def chosen(selector: Selector, known: EarlierMissions) -> list[str]:
    try:
        return [place.id for place in resolve(selector, SITE.with_earlier(known), Context(here=SITE.start))]
    except NoPlaceError:
        return []


@settings(deadline=None)
@given(records(), periods, st.sampled_from(ACTIONS))
def test_what_was_done_and_what_was_not_are_all_trees(known: EarlierMissions, period: Period, action: str) -> None:
    """Checked against a loop over the captures."""
    done = DoneEarlier(action=action, period=period)
    expected = {
        one.place
        for _, one in known.captures()
        if one.action == action and one.outcome == "done" and period.covers(one.time, NOW)
    }
    assert chosen(done, known) == [tree for tree in TREES if tree in expected]
    rest = chosen(Excluding(places=done, of=Trees()), known)
    assert rest == [tree for tree in TREES if tree not in expected]


@settings(deadline=None)
@given(records(), periods, st.integers(1, 12), st.booleans())
def test_the_top_have_readings_at_least_as_extreme_as_all_others(
    known: EarlierMissions, period: Period, count: int, lowest: bool
) -> None:
    latest: dict[str, tuple[datetime, str, float]] = {}
    for mission, one in known.captures():
        value = one.value_of("co2")
        if value is not None and period.covers(one.time, NOW):
            key = (one.time, mission.id, value.value)
            latest[one.place] = max(latest.get(one.place, key), key, key=lambda found: found[:2])
    # Two readings of one mission at one place at one time have no order.
    times = [(mission.id, one.place, one.at) for mission, one in known.captures()]
    assume(len(set(times)) == len(times))
    assume(latest)
    top = chosen(TopEarlier(quantity="co2", count=count, lowest=lowest, period=period), known)
    values = [latest[tree][2] * (1 if lowest else -1) for tree in top]
    others = [found[2] * (1 if lowest else -1) for tree, found in latest.items() if tree not in top]
    assert len(top) == min(count, len(latest))
    assert values == sorted(values)
    assert not others or max(values) <= min(others)


@settings(deadline=None)
@given(records(), periods, st.integers(380, 500), st.sampled_from(("latest", "mean", "median", "minimum", "maximum")))
def test_above_and_not_above_share_the_trees_that_were_read(
    known: EarlierMissions, period: Period, limit: int, statistic: str
) -> None:
    def passing(test: str) -> set[str]:
        where = WhereEarlier(quantity="co2", test=test, value=limit, unit="ppm", statistic=statistic, period=period)
        try:
            return set(chosen(where, known))
        except PlaceError:  # nothing was read in the period
            return set()

    read = {one.place for _, one in known.captures() if one.values and period.covers(one.time, NOW)}
    assert passing("gt") | passing("le") == read
    assert not passing("gt") & passing("le")


@pytest.mark.parametrize(
    ("period", "first", "last"),
    [
        (Period(calendar="yesterday"), "2026-11-24", "2026-11-24"),
        (Period(calendar="last_week"), "2026-11-16", "2026-11-22"),
        (Period(calendar="this_month"), "2026-11-01", "2026-11-25"),
        (Period(calendar="last_month"), "2026-10-01", "2026-10-31"),
        (Period(calendar="wed"), "2026-11-18", "2026-11-18"),
        (Period(first_day="mon"), "2026-11-23", None),
        (Period(first_day="--12-24", last_day="--01-06"), "2025-12-24", "2026-01-06"),
        (Period(first_day="--02-29", last_day="--02-29"), "2024-02-29", "2024-02-29"),
    ],
)
def test_days_of_a_period(period: Period, first: str, last: str | None) -> None:
    assert [None if day is None else day.isoformat() for day in period.days(NOW)] == [first, last]


@pytest.mark.parametrize(
    ("period", "said"),
    [
        (Period(calendar="today", last_days=3), "exclude each other"),
        (Period(last_days=0), "not possible"),
        (Period(last_missions=10**9), "not possible"),
        (Period(first_day="--13-45"), "is not a day"),
        (Period(first_day="\x1b[31m" + "x" * 10_000), "is not a day"),
        (Period(first_day="2026-11-20", last_day="2026-11-01"), "before it begins"),
    ],
)
def test_an_impossible_period_is_an_error_in_words(period: Period, said: str) -> None:
    known = EarlierMissions(as_of=NOW.isoformat())
    with pytest.raises(PlaceError) as caught:
        resolve(DoneEarlier(period=period), SITE.with_earlier(known), Context(here=SITE.start))
    assert said in str(caught.value)
    assert "\x1b" not in str(caught.value)
    assert len(str(caught.value)) < 400


def test_readings_in_another_unit_are_not_compared() -> None:
    value = EarlierValue(name="co2", value=0.04, unit="percent")
    one = EarlierCapture(place="1", at=NOW.isoformat(), action="read_co2", values=(value,))
    known = EarlierMissions(
        as_of=NOW.isoformat(), missions=(EarlierMission(id="m", begun=NOW.isoformat(), captures=(one,)),)
    )
    with pytest.raises(PlaceError, match="percent"):
        chosen(WhereEarlier(quantity="co2", test="gt", value=400, unit="ppm"), known)


def test_a_site_without_records_says_what_is_missing() -> None:
    with pytest.raises(PlaceError, match="--missions"):
        resolve(Excluding(places=DoneEarlier(), of=Rows(first="1", last="1")), SITE, Context(here=SITE.start))
