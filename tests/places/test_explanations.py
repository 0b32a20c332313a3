"""How a selector came to its places: any selector agrees with its explanation; ties, ends and stand-ins are said."""

from __future__ import annotations

import tracemalloc
from typing import get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import PlaceError
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.explanation import explain, notes
from fieldhand.places.picks.ordered import Order
from fieldhand.places.picks.quota import Manner
from fieldhand.places.points.transect import PathShape
from fieldhand.places.resolution import resolve
from fieldhand.places.wording import say_selector
from fieldhand.terms import AnySide, CountedFrom, Side, Towards
from support.sites.points import at_start, orchard, place_at, planted, site_of, without_rows

sides = st.sampled_from(get_args(Side))
counts = st.integers(1, 4)
counted_from = st.sampled_from(get_args(CountedFrom))
row_names = st.sampled_from(["", "1", "2", "-1", "B1"])
leaves = st.sampled_from(
    [
        *(s.Trees(), s.TreeIs(tree="1"), s.Here(), s.Marker(name="start"), s.Bound(label="b"), s.First(), s.Last()),
        *(
            s.GateIs(gate="g"),
            s.PointsIn(zone="z"),
            s.PointsIn(zone="A", count=3),
            s.PointsIn(zone="z", count=2, random=True),
            s.PointsIn(count=2),
            s.AlongRow(trees=2),
            s.Across(),
            s.RowOf(),
        ),
    ]
)


def _around(inner: st.SearchStrategy[s.Selector]) -> st.SearchStrategy[s.Selector]:
    corner = st.sampled_from(["nw", "ne", "se", "sw"])
    return st.one_of(
        st.builds(s.Half, side=sides, of=inner),
        st.builds(s.Quarter, quarter=corner, of=inner),
        st.builds(s.Edge, side=sides, of=inner),
        st.builds(s.AmongExtreme, side=sides, of=inner),
        st.builds(s.Extreme, side=sides, count=counts, of=inner),
        st.builds(s.EdgeMiddle, side=sides, count=counts, of=inner),
        st.builds(s.Middle, count=counts, of=inner),
        st.builds(s.Corners, which=st.lists(corner, min_size=1, max_size=4).map(tuple), of=inner),
        st.builds(
            s.Nearest,
            to=inner,
            count=counts,
            adjacent=st.booleans(),
            fresh=st.booleans(),
            side=st.sampled_from(get_args(AnySide)),
            of=inner,
        ),
        st.builds(s.Farthest, origin=inner, count=counts, of=inner),
        st.builds(s.Adjacent, near=inner, count=counts, of=inner),
        st.builds(s.NotVisited, of=inner),
        st.builds(s.Excluding, places=inner, of=inner),
        st.builds(s.Where, attribute=st.just("n"), test=st.just("ge"), value=st.just(2.0), of=inner),
        st.builds(s.Top, attribute=st.just("n"), count=counts, of=inner),
        st.builds(
            s.InZone,
            zone=st.sampled_from(["z", "A"]),
            outside=st.booleans(),
            margin_m=st.sampled_from([0.0, 5.0]),
            of=inner,
        ),
        st.builds(s.Within, distance_m=st.floats(1, 100), to=inner, beyond=st.booleans(), of=inner),
        st.builds(s.Take, count=counts, of=inner),
        st.builds(s.RandomSample, count=counts, seed=st.integers(0, 3), of=inner),
        st.builds(s.Spread, count=counts, of=inner),
        st.builds(s.Evenly, count=counts, out_of=st.sampled_from((0, 0, 3, 5)), of=inner),
        st.builds(
            s.Quota,
            per=st.sampled_from(["", "row", "block", "zone", "n", "colour"]),
            count=st.integers(0, 3),
            percent=st.sampled_from([0.0, 0.0, 30.0]),
            how=st.sampled_from(get_args(Manner)),
            by=st.sampled_from(["", "n"]),
            of=inner,
        ),
        st.builds(s.Missing, of=inner),
        st.builds(s.Grid, every_m=st.floats(1, 30), zone=st.sampled_from(["", "z", "A"]), of=inner),
        st.builds(
            s.Transect,
            count=st.integers(0, 4),
            apart_m=st.sampled_from([0.0, 0.0, 5.0]),
            shape=st.sampled_from(get_args(PathShape)),
            legs=st.integers(0, 5),
            zone=st.sampled_from(["", "z", "A"]),
            of=inner,
        ),
        st.builds(s.InBlock, block=st.sampled_from(["A", "B", "z"]), of=inner),
        st.builds(s.Rows, first=row_names, last=row_names, every=counts, counted_from=counted_from, of=inner),
        st.builds(s.RowOf, origin=inner, over=st.integers(-1, 1), of=inner),
        st.builds(s.InRow, first=st.integers(-3, 3), last=st.integers(-3, 3), counted_from=counted_from, of=inner),
        st.builds(s.EveryNth, nth=counts, start=counts, of=inner),
        st.builds(s.AlongRow, trees=counts, towards=st.sampled_from(get_args(Towards)), origin=inner),
        st.builds(s.Across, origin=inner, side=counted_from),
        st.builds(s.Successive, count=counts, near=inner, of=inner),
        st.builds(s.Ordered, by=st.sampled_from(get_args(Order)), attribute=st.just("n"), of=inner),
        st.builds(s.Nth, nth=st.integers(-3, 3), of=inner),
        st.builds(
            s.Spaced, apart_m=st.floats(1, 9), count=counts, zone=st.sampled_from(["", "z"]), near=inner, of=inner
        ),
        st.builds(s.UnionOf, parts=st.lists(inner, min_size=1, max_size=3).map(tuple)),
    )


def drawn_site(lengths: list[int], scattered: bool):
    """Rows of those lengths in two blocks, or the same trees in none."""
    rows = [[(6.0 * k, -4.0 * j) for j in range(n)] for k, n in enumerate(lengths)]
    half = (len(rows) + 1) // 2
    blocks = [("A", 0.0, [(str(k + 1), r) for k, r in enumerate(rows[:half])])]
    if rows[half:]:
        blocks.append(("B", 0.0, [(f"B{k + 1}", r) for k, r in enumerate(rows[half:])]))
    count = sum(lengths)
    site = planted(
        blocks,
        properties=[{"n": float(k)} for k in range(count)],
        zones=[("z", "zone", [(-1, -6), (9, -6), (9, 5), (-1, 5)])],
        markers={"start": (0, 9)},
    )
    return without_rows(site) if scattered else site


@settings(max_examples=400, deadline=None)
@given(st.recursive(leaves, _around, max_leaves=5), st.lists(st.integers(1, 5), min_size=1, max_size=5), st.booleans())
def test_any_selector_gives_places_each_once_and_explains_the_same_or_says_why_not(selector, lengths, scattered):
    site = drawn_site(lengths, scattered)
    bound = {"b": (site.trees[-1].place, place_at(2, 2))}
    context = Context(here=site.start, visited=(site.trees[0].place.id,), bound=bound)
    try:
        found = resolve(selector, site, context)
    except PlaceError:
        with pytest.raises(PlaceError, match=r"\A[^\n]*\Z"):
            explain(selector, site, context)
        return
    assert found
    assert len(set(found)) == len(found)
    told = explain(selector, site, context)
    assert told.places == found
    assert told.notes == notes(selector, site, context)
    last = told.parts[-1]
    assert (last.selector, last.chosen) == (selector, len(found))
    assert last.ids == tuple(p.id for p in found)[: len(last.ids)]
    assert {part.selector for part in told.parts} <= set(selector.walk())
    assert len(told.say()) == len(told.parts)


def said(selector: s.Selector, site) -> tuple[str, ...]:
    return notes(selector, site, at_start(site))


def test_a_tie_at_the_end_of_a_pick_is_said_with_who_is_taken():
    site = without_rows(
        site_of([(0, 0), (4, 0), (8, 0), (3, 9)], properties=[{"reward": r} for r in (5.0, 9.0, 9.0, 1.0)])
    )
    assert said(s.Top(attribute="reward", count=1), site) == (
        "2 trees tie for the highest reward: 2 and 3; 2 comes first in the file",
    )
    assert said(s.Top(attribute="reward", count=2), site) == ()
    assert said(s.Extreme(side="south", count=2), site) == (
        "3 trees tie for the southernmost: 1, 2 and 3; 1 and 2 come first in the file",
    )


def test_what_would_have_come_next_is_kept():
    site = without_rows(site_of([(0, 0), (4, 0), (9, 0), (15, 0)]))
    (*_, last) = explain(s.Nearest(to=s.TreeIs(tree="1")), site, at_start(site)).parts
    assert (last.ids, last.runners_up, last.candidates) == (("2",), ("3", "4"), 3)


def test_each_part_says_what_it_left_of_what():
    site = planted([("1", 0.0, [(str(c + 1), [(6.0 * c, -4.0 * k) for k in range(5)]) for c in range(3)])])
    told = explain(s.EveryNth(nth=2, of=s.Rows(first="2", last="3")), site, at_start(site))
    assert told.say() == (
        "every tree: 15 (1, 2, 3, 4, 5, 6 and 9 more)",
        "the trees of rows 2 to 3: 10 of 15 (6, 7, 8, 9, 10, 11 and 4 more); rows are counted from west",
        "every other tree of rows 2 to 3: 6 of 10 (6, 8, 10, 11, 13, 15); existing trees are counted, in each row"
        " from north",
    )


@pytest.mark.parametrize(
    ("selector", "note"),
    [
        (
            s.AlongRow(trees=9, origin=s.TreeIs(tree="3")),
            "row 1 ends after 2 trees; its last tree in that direction is 5",
        ),
        (s.AlongRow(trees=1, origin=s.TreeIs(tree="5")), "row 1 ends here; its last tree in that direction is 5"),
        (s.InRow(first=1, last=4), "row 2 has fewer than 4 trees to choose from"),
        (
            s.Across(origin=s.TreeIs(tree="5")),
            "row 2 has no tree abreast of it; the nearest one is 12 m along the row",
        ),
    ],
)
def test_where_a_row_ends_is_said(selector, note):
    site = planted([("1", 0.0, [("1", [(0, -4.0 * k) for k in range(5)]), ("2", [(6, 0), (6, -4)])])])
    assert note in said(selector, site)


def test_trees_of_which_the_file_says_nothing_are_said_to_be_left_out():
    trees = [{"age": 5.0}, {}, {"age": 30.0}, {}]
    site = without_rows(site_of([(0, 0), (4, 0), (8, 0), (12, 0)], properties=trees))
    assert said(s.Where(attribute="age", test="gt", value=4.0), site) == ("2 have no age and are left out",)
    assert said(s.Top(attribute="age", count=1), site) == ("2 have no age and are left out",)


@pytest.mark.parametrize(
    ("selector", "rule"),
    [
        (s.Half(side="north"), "halves and quarters go by the middle lines of the extent along true north"),
        (s.AmongExtreme(side="east"), "less than 6.0 m, one row spacing, from the easternmost"),
        (s.First(), "the site has no start marker, so the order of the file applies"),
        (s.Rows(first="2", last="2", counted_from="east"), "rows are counted from east"),
        (s.Across(), "that is in row 2"),
        (s.Successive(count=2), "row 1 is the nearest with that many"),
        (s.InZone(zone="1"), "that is a block of the site"),
        (s.Adjacent(near=s.Here(), count=2), "each is a neighbour of one before it, in the same row first"),
    ],
)
def test_the_rule_that_was_applied_is_said(selector, rule):
    site = planted([("1", 0.0, [(str(c + 1), [(6.0 * c, -4.0 * k) for k in range(3)]) for c in range(2)])])
    assert explain(selector, site, at_start(site)).rules[-1:] == (rule,)


def test_groups_within_groups_are_resolved_and_said_however_deep_they_nest():
    """Each level names its group twice, as what it keeps and as the ground of the half: 2 to the power of 60 in all."""
    site = orchard()
    selector: s.Selector = s.Trees()
    for k in range(60):
        near = s.Nearest(to=s.TreeIs(tree="7"), count=19 - k % 2, of=s.UnionOf(parts=(selector, s.Trees())))
        selector = s.Half(side="north", of=s.Excluding(places=s.TreeIs(tree="1"), of=near))
    tracemalloc.start()
    try:
        told = explain(selector, site, at_start(site))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert told.places == resolve(selector, site, at_start(site))
    assert 0 < len(told.parts[-1].words) < 25_000
    assert peak < 200e6  # said anew for each part it was 3 GB
    assert all(part.words == say_selector(part.selector) for part in told.parts[:30])


def test_explaining_what_cannot_be_fails_as_resolving_does():
    with pytest.raises(PlaceError, match="no tree 'x'"):
        explain(s.TreeIs(tree="x"), orchard(), at_start(orchard()))
