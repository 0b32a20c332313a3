"""Rows, counts along them, orders: each held against brute force that knows how the orchard was drawn.

The oracle is plain Python over :class:`Farm`, which keeps the rows as lists of ids; it looks at no code of selectors.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import PlaceError
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.explanation import explain
from fieldhand.places.picks.ordered import Order
from fieldhand.places.resolution import resolve
from fieldhand.site.model import Place, Site
from support.sites.points import at_start, place_at, planted, point, read, site_of, without_rows

COMPASS = {"north": (0, 1), "east": (1, 0), "south": (0, -1), "west": (-1, 0)}
OLD = {"attribute": "age", "test": "gt", "value": 2.0}


@dataclass(frozen=True)
class Farm:
    """A site and how it was drawn: for each block its name, the way along and across its rows, and these."""

    site: Site
    blocks: list[tuple[str, tuple[float, float], tuple[float, float], list[list[str]]]]

    @property
    def rows(self) -> list[list[str]]:
        return [row for *_, rows in self.blocks for row in rows]

    def row_of(self, tree: str) -> list[str]:
        return next(row for row in self.rows if tree in row)

    def block_of(self, tree: str):
        return next(block for block in self.blocks if any(tree in row for row in block[3]))

    def at(self, tree: str) -> Place:
        return self.site.by_id[tree].place

    def in_file_order(self, trees) -> list[str]:
        chosen = set(trees)
        return [t.place.id for t in self.site.trees if t.place.id in chosen]


def away(a: Place, b: Place) -> float:
    return math.hypot(a.x - b.x, a.y - b.y)


def ids(selector: s.Selector, site: Site, context: Context | None = None) -> list[str]:
    return [p.id for p in resolve(selector, site, context or at_start(site))]


def faced(way: tuple[float, float], side: str) -> float:
    """The cosine of the angle between a way and a side of the compass."""
    return way[0] * COMPASS[side][0] + way[1] * COMPASS[side][1]


@st.composite
def farms(draw, most_blocks: int = 2) -> Farm:
    """Orchards of one or two blocks: any bearing, rows of unequal length, gaps, trees in any order in the file."""
    drawn, blocks = [], []
    east, count = 0.0, 0
    for b in range(draw(st.integers(1, most_blocks))):
        bearing = draw(st.sampled_from([0.0, 12.0, 30.0, 60.0, 88.0, 90.0, 120.0, 150.0]))
        turn = math.radians(bearing)
        along = (math.sin(turn), math.cos(turn))
        east_west = 45 < bearing < 135
        if (along[0] < 0) if east_west else (along[1] > 0):
            along = (-along[0], -along[1])
        # South is to the right of who walks a row from its western end; east is to the left from its northern end.
        across = (along[1], -along[0]) if east_west else (-along[1], along[0])
        rows, ids_ = [], []
        lengths = draw(st.lists(st.lists(st.booleans(), min_size=1, max_size=6), min_size=1, max_size=4))
        for r, standing in enumerate(lengths):
            spots = [k for k, there in enumerate(standing) if there] or [0]
            shift = draw(st.sampled_from([0.0, 0.3, -0.25]))
            row = [
                (
                    east + 6 * r * across[0] + (4 * k + shift) * along[0],
                    6 * r * across[1] + (4 * k + shift) * along[1],
                )
                for k in spots
            ]
            rows.append((str(r + 1), row))
            ids_.append([count + k for k in range(len(row))])
            count += len(row)
        drawn.append((f"{'AB'[b]}", bearing, rows))
        blocks.append((f"{'AB'[b]}", along, across, ids_))
        east += 100.0
    order = draw(st.permutations(range(count)))
    ages = draw(st.lists(st.integers(0, 5), min_size=count, max_size=count))
    markers = draw(st.sampled_from([{}, {"start": (-7.0, 9.0)}, {"start": (11.0, -30.0)}]))
    site = planted(drawn, order=order, markers=markers, properties=[{"age": float(a)} for a in ages])
    name = {k: str(place + 1) for place, k in enumerate(order)}
    return Farm(site, [(n, u, v, [[name[k] for k in row] for row in rows]) for n, u, v, rows in blocks])


def old(farm: Farm, tree: str) -> bool:
    return farm.site.by_id[tree].properties["age"] > 2.0


def expect(selector: s.Selector, farm: Farm, expected: list[str], context: Context | None = None) -> None:
    """The selector gives these; where they are none it says so."""
    if expected:
        assert ids(selector, farm.site, context) == expected
    else:
        with pytest.raises(PlaceError):
            ids(selector, farm.site, context)


# Blocks and rows


@given(farms(), st.sampled_from(["A", "a", "block B", "2", "C"]))
def test_a_block_is_called_by_its_name_or_its_number(farm, said):
    number = {"A": 0, "a": 0, "block B": 1, "2": 1}.get(said, 9)
    trees = [t for row in farm.blocks[number][3] for t in row] if number < len(farm.blocks) else []
    expect(s.InBlock(block=said), farm, farm.in_file_order(trees))


@settings(max_examples=150)
@given(farms(), st.integers(-4, 5), st.integers(-4, 5), st.integers(1, 3), st.sampled_from(["usual", *COMPASS]))
def test_rows_are_counted_within_their_block_from_the_side_that_is_said(farm, first, last, every, side):
    name, _, across, rows = farm.blocks[-1]
    selector = s.Rows(
        first=str(first), last=str(last), every=every, counted_from=side, of=s.InBlock(block=name)
    )  # fmt: skip
    counted = rows
    if side != "usual":
        cosine = faced(across, side)
        if abs(cosine) < 0.5 - 1e-9:
            with pytest.raises(PlaceError, match=f"cannot be counted from the {side}.*run .* to .*count from the"):
                ids(selector, farm.site)
            return
        counted = rows[::-1] if cosine > 0 else rows
    numbers = [n if n > 0 else len(rows) + 1 + n for n in (first, last) if n != 0]
    if len(numbers) < 2 or not all(1 <= n <= len(rows) for n in numbers):
        expect(selector, farm, [])
        return
    step = every if numbers[1] >= numbers[0] else -every
    stop = numbers[1] + (1 if step > 0 else -1)
    expect(selector, farm, farm.in_file_order(t for n in range(numbers[0], stop, step) for t in counted[n - 1]))


@given(farms(), st.integers(1, 4))
def test_every_so_many_rows_count_in_each_block(farm, every):
    kept = [t for *_, rows in farm.blocks for row in rows[::every] for t in row]
    assert ids(s.Rows(every=every), farm.site) == farm.in_file_order(kept)


@given(farms(), st.integers(1, 4))
def test_a_row_number_that_several_blocks_have_is_not_guessed(farm, number):
    having = [name for name, *_, rows in farm.blocks if len(rows) >= number]
    row = s.Rows(first=str(number), last=str(number))
    if len(having) == 2:
        with pytest.raises(PlaceError, match=rf'row {number} is in 2 blocks: block A, block B; .*"row {number} of bl'):
            ids(row, farm.site)
        if any(old(farm, t) for row in farm.rows for t in row):
            with pytest.raises(PlaceError, match="in 2 blocks"):  # which trees are old does not decide it
                ids(s.Rows(first=str(number), last=str(number), of=s.Where(**OLD)), farm.site)
    elif having:
        assert set(ids(row, farm.site)) == set(
            next(rows for name, *_, rows in farm.blocks if name == having[0])[number - 1]
        )
    else:
        with pytest.raises(PlaceError, match=f"there is no row '{number}'.*there (are|is)"):
            ids(row, farm.site)


@given(farms(), st.integers(-3, 3), st.data())
def test_the_row_of_a_tree_and_those_beside_it(farm, over, data):
    tree = data.draw(st.sampled_from([t for row in farm.rows for t in row]))
    rows = farm.block_of(tree)[3]
    at = rows.index(farm.row_of(tree)) + over
    expected = rows[at] if 0 <= at < len(rows) else []
    expect(s.RowOf(origin=s.TreeIs(tree=tree), over=over), farm, farm.in_file_order(expected))


def row_site(names: list[str], **more) -> Site:
    """Rows of three trees each, 6 m apart from west to east, with these names."""
    return planted([("1", 0.0, [(n, [(6.0 * k, -4.0 * j) for j in range(3)]) for k, n in enumerate(names)])], **more)


@pytest.mark.parametrize(
    ("names", "first", "last", "columns"),
    [
        (["1", "2", "3"], "2", "2", [1]),
        (["3", "2", "1"], "1", "1", [2]),  # the file's own name comes first
        (["3", "2", "1"], "-1", "-1", [0]),  # and says from which side rows count
        (["R07", "R08", "R09"], "8", "R09", [1, 2]),
        (["A", "B", "C"], "2", "2", [1]),
        (["C", "B", "A"], "2", "-1", [0, 1]),
        (["Row 5", "Row 6", "Row 8"], "row 6", "8", [1, 2]),
        (["old", "new", "2"], "2", "2", [2]),
        (["old", "new", "top"], "2", "2", [1]),
        (["1", "2", "4"], "4", "1", [0, 1, 2]),
    ],
)
def test_rows_go_by_their_own_names_first_then_by_their_number(names, first, last, columns):
    found = ids(s.Rows(first=first, last=last), row_site(names))
    assert sorted({(int(t) - 1) // 3 for t in found}) == columns
    assert len(found) == 3 * len(columns)


def test_a_number_that_is_left_out_of_the_rows_own_is_no_row():
    with pytest.raises(PlaceError, match=r"no row '3'.*3 rows: 1, 2, 4"):
        ids(s.Rows(first="3", last="3"), row_site(["1", "2", "4"]))


def test_a_side_that_is_named_counts_whatever_the_rows_are_called():
    assert ids(s.Rows(first="1", last="1", counted_from="east"), row_site(["1", "2", "3"])) == ["7", "8", "9"]


# Trees along the row


def counted_in(farm: Farm, trees: list[str], backwards: bool) -> list[list[str]]:
    """The trees of a group in each row, as they are counted."""
    rows = [[t for t in row if t in set(trees)] for row in farm.rows]
    return [row[::-1] if backwards else row for row in rows]


@settings(max_examples=150)
@given(
    farms(most_blocks=1), st.integers(-6, 7), st.integers(-6, 7), st.booleans(), st.sampled_from(["usual", *COMPASS])
)
def test_trees_of_a_row_count_among_what_is_left_from_the_end_that_is_said(farm, first, last, only_old, side):
    group = [t for row in farm.rows for t in row if not only_old or old(farm, t)]
    selector = s.InRow(first=first, last=last, counted_from=side, of=s.Where(**OLD) if only_old else s.Trees())
    cosine = 0.0 if side == "usual" else faced(farm.blocks[0][1], side)
    if not group or first == 0 or last == 0 or (side != "usual" and abs(cosine) < 0.5 - 1e-9):
        with pytest.raises(PlaceError):
            ids(selector, farm.site)
        return
    low, high = (last, first) if first * last > 0 and first > last else (first, last)
    kept = []
    for row in counted_in(farm, group, cosine > 0):
        for number, tree in enumerate(row, start=1):
            from_end = number - len(row) - 1
            after = number >= low if low > 0 else from_end >= low
            before = number <= high if high > 0 else from_end <= high
            kept += [tree] if after and before else []
    expect(selector, farm, farm.in_file_order(kept))


def every_nth(rows, nth, start):
    """Of each row by itself; where no row has as many trees, on from row to row."""
    counted = [list(row) for row in rows]
    if max(map(len, counted), default=0) < nth:
        counted = [[t for row in counted for t in row]]
    return [t for row in counted for t in row[start - 1 :: nth]]


def test_every_fiftieth_tree_is_not_the_first_of_every_row():
    rows = [(str(k + 1), [(6.0 * k, -4.0 * n) for n in range(12)]) for k in range(10)]
    site = planted([("1", 0.0, rows)])
    assert len(ids(s.EveryNth(nth=50), site)) == 3
    assert any("goes on from row to row" in note for note in explain(s.EveryNth(nth=50), site, at_start(site)).notes)


@given(farms(), st.integers(1, 6), st.integers(1, 4), st.booleans())
def test_every_nth_tree_counts_along_each_row_among_what_is_left(farm, nth, start, only_old):
    group = [t for row in farm.rows for t in row if not only_old or old(farm, t)]
    kept = every_nth(counted_in(farm, group, False), nth, start)
    selector = s.EveryNth(nth=nth, start=start, of=s.Where(**OLD) if only_old else s.Trees())
    expect(selector, farm, farm.in_file_order(kept))


def test_trees_of_whole_rows_go_by_the_numbers_that_the_file_gives_them():
    """The third tree is missing; whoever walks the row counts on, the file does not."""
    row = [(0.0, -4.0 * k) for k in (0, 1, 3, 4)]
    numbers = [{"position": float(n), "age": 5.0} for n in (1, 2, 4, 5)]
    site = planted([("1", 0.0, [("1", row)])], properties=numbers)
    object.__setattr__(site.planting.rows[0], "slots", np.array([1, 2, 4, 5]))
    assert ids(s.InRow(first=4, last=5), site) == ["3", "4"]
    assert ids(s.InRow(first=2, last=-1), site) == ["2", "3", "4"]
    assert "numbers in the file" in explain(s.InRow(first=4, last=4), site, at_start(site)).rules[-1]
    assert ids(s.InRow(first=4, last=4, counted_from="north"), site) == ["4"]
    assert ids(s.EveryNth(nth=2), site) == ["1", "3"]
    with pytest.raises(PlaceError, match="row 1 has no tree 3"):
        ids(s.InRow(first=3, last=3), site)


@settings(max_examples=150)
@given(farms(), st.integers(1, 7), st.sampled_from(["down", "up", *COMPASS]), st.data())
def test_so_many_trees_along_the_row_or_its_last_one(farm, trees, towards, data):
    tree = data.draw(st.sampled_from([t for row in farm.rows for t in row]))
    row = farm.row_of(tree)
    selector = s.AlongRow(trees=trees, towards=towards, origin=s.TreeIs(tree=tree))
    if towards in COMPASS:
        cosine = faced(farm.block_of(tree)[1], towards)
        if abs(cosine) < 0.5 - 1e-9:
            with pytest.raises(PlaceError, match=f"{towards} is not a direction along row .*which runs .* to .*; say "):
                ids(selector, farm.site)
            return
        way = 1 if cosine > 0 else -1
    else:
        usual, other = (away(farm.at(row[k]), farm.site.start) for k in (0, -1))
        way = 1 if usual <= other + 1e-4 else -1
        way = way if towards == "down" else -way
    at = row.index(tree) + way * trees
    assert ids(selector, farm.site) == [row[min(max(at, 0), len(row) - 1)]]
    past = not 0 <= at < len(row)
    said = " ".join(explain(selector, farm.site, at_start(farm.site)).notes)
    assert past == ("its last tree" in said)


@given(farms(), st.sampled_from(["usual", *COMPASS]), st.data())
def test_the_tree_abreast_is_the_nearest_of_the_next_row(farm, side, data):
    tree = data.draw(st.sampled_from([t for row in farm.rows for t in row]))
    _, _, across, rows = farm.block_of(tree)
    at = rows.index(farm.row_of(tree))
    ways = [-1, 1]
    if side != "usual":
        cosine = faced(across, side)
        ways = [] if abs(cosine) < 0.5 - 1e-9 else [1 if cosine > 0 else -1]
    beside = [t for way in ways if 0 <= at + way < len(rows) for t in rows[at + way]]
    me = farm.at(tree)
    nearest = sorted(beside, key=lambda t: (round(away(farm.at(t), me), 4), farm.site.by_id[t].index))[:1]
    expect(s.Across(origin=s.TreeIs(tree=tree), side=side), farm, nearest)


@settings(max_examples=150)
@given(farms(), st.integers(1, 4), st.booleans(), st.floats(-20, 120), st.floats(-30, 30))
def test_successive_trees_are_of_the_nearest_row_that_has_as_many(farm, count, only_old, x, y):
    here = place_at(x, y)
    group = [t for row in farm.rows for t in row if not only_old or old(farm, t)]
    rows = [row for row in counted_in(farm, group, False) if len(row) >= count]
    selector = s.Successive(count=count, of=s.Where(**OLD) if only_old else s.Trees())
    if not rows:
        expect(selector, farm, [], Context(here=here))
        return
    found = ids(selector, farm.site, Context(here=here))
    far = {t: away(farm.at(t), here) for t in group}
    row = farm.row_of(found[0])
    left = [t for t in row if t in group]
    assert min(far[t] for t in left) <= min(min(far[t] for t in r) for r in rows) + 1e-3
    windows = [left[k : k + count] for k in range(len(left) - count + 1)]
    assert found in windows or found[::-1] in windows
    assert sum(far[t] for t in found) <= min(sum(far[t] for t in w) for w in windows) + 2e-3
    assert far[found[0]] <= far[found[-1]] + 1e-3


def test_a_place_that_is_no_tree_of_a_row_counts_from_the_nearest_one():
    site = row_site(["1", "2"], markers={"start": (7.0, 3.0)})
    assert ids(s.AlongRow(trees=1), site) == ["5"]
    assert ids(s.RowOf(), site) == ["4", "5", "6"]
    told = explain(s.AlongRow(trees=1), site, at_start(site))
    assert told.notes == ("start is not in a row, so counting starts at the nearest tree in a row, 4",)
    assert told.rules == ("down is south here, away from the start",)


# Orders


@settings(max_examples=100)
@given(farms(), st.sampled_from(Order.__args__), st.booleans(), st.data())
def test_an_order_is_what_sorting_gives_with_ties_as_in_the_file(farm, by, descending, data):
    here = place_at(3.0, -5.0)
    row_major = [t for row in farm.rows for t in row]
    keys = {
        "west_to_east": lambda t: farm.at(t).x,
        "east_to_west": lambda t: -farm.at(t).x,
        "south_to_north": lambda t: farm.at(t).y,
        "north_to_south": lambda t: -farm.at(t).y,
        "nearest_first": lambda t: away(farm.at(t), here),
        "farthest_first": lambda t: -away(farm.at(t), here),
        "rows": row_major.index,
        "attribute": lambda t: farm.site.by_id[t].properties["age"],
    }
    sign = -1 if descending else 1
    expected = sorted(
        farm.site.by_id, key=lambda t: (round(sign * keys[by](t), 4), farm.site.by_id[t].index)
    )  # fmt: skip
    selector = s.Ordered(by=by, attribute="age", descending=descending)
    assert ids(selector, farm.site, Context(here=here)) == expected
    nth = data.draw(st.integers(-len(expected) - 1, len(expected) + 1))
    if nth != 0 and abs(nth) <= len(expected):
        assert ids(s.Nth(nth=nth, of=selector), farm.site, Context(here=here)) == [
            expected[nth - 1 if nth > 0 else nth]
        ]
    else:
        with pytest.raises(PlaceError):
            ids(s.Nth(nth=nth, of=selector), farm.site, Context(here=here))


def test_what_lacks_an_attribute_comes_last_and_text_goes_by_the_alphabet():
    site = without_rows(site_of([(0, 0), (4, 0), (8, 0), (12, 0)], properties=[{"v": "pear"}, {}, {"v": "Apple"}, {}]))
    assert ids(s.Ordered(by="attribute", attribute="v"), site) == ["3", "1", "2", "4"]
    assert ids(s.Ordered(by="attribute", attribute="v", descending=True), site) == ["1", "3", "2", "4"]
    assert explain(s.Ordered(by="attribute", attribute="v"), site, at_start(site)).notes == (
        "2 places lack v and come last",
    )


# How the parts nest


@settings(max_examples=100)
@given(farms(most_blocks=1), st.integers(1, 3), st.sampled_from(list(COMPASS)))
def test_every_third_old_tree_of_some_rows_in_a_half_is_counted_among_these(farm, nth, side):
    """However rows, the half of the farm and the age nest, the same trees are counted."""
    xy = [(t.place.x, t.place.y) for t in farm.site.trees]
    far = [x * COMPASS[side][0] + y * COMPASS[side][1] for x, y in xy]
    middle = (max(far) + min(far)) / 2
    inside = {t.place.id for t, f in zip(farm.site.trees, far, strict=True) if f >= middle - 0.01}
    last = min(2, len(farm.rows))
    group = [t for row in farm.rows[:last] for t in row if t in inside and old(farm, t)]
    kept = every_nth(counted_in(farm, group, False), nth, 1)
    rows = {"first": "1", "last": str(last)}
    for of in (
        s.Where(**OLD, of=s.Half(side=side, of=s.Rows(**rows))),
        s.Half(side=side, of=s.Rows(**rows, of=s.Where(**OLD))),
        s.Rows(**rows, of=s.Where(**OLD, of=s.Half(side=side))),
        s.Half(side=side, of=s.Ordered(by="rows", of=s.Where(**OLD, of=s.Rows(**rows)))),
    ):
        got = s.EveryNth(nth=nth, of=of)
        if kept:
            assert set(ids(got, farm.site)) == set(kept)
        else:
            with pytest.raises(PlaceError):
                ids(got, farm.site)


def test_the_half_of_a_block_is_its_own_and_the_middle_of_a_row_too():
    rows = [[(6.0 * c, -4.0 * k) for k in range(5)] for c in range(4)]
    site = planted(
        [("A", 0.0, [("1", rows[0]), ("2", rows[1])]), ("B", 0.0, [("1", [(x, y - 60) for x, y in rows[2]])])]
    )
    assert ids(s.Half(side="north", of=s.InBlock(block="A")), site) == ["1", "2", "3", "6", "7", "8"]
    assert ids(s.Half(side="north", of=s.Rows(first="2", last="2")), site) == ["6", "7", "8", "9", "10"]
    assert ids(s.Middle(of=s.Rows(first="2", last="2")), site) == ["8"]
    assert ids(s.Corners(which=("sw",), of=s.Rows(first="2", last="2")), site) == ["10"]


def test_a_block_may_be_called_a_zone_and_a_zone_a_block():
    ring = [(-1, -9), (7, -9), (7, 1), (-1, 1)]
    site = planted(
        [("A", 0.0, [("1", [(0, 0), (0, -4)])]), ("B", 0.0, [("1", [(40, 0), (40, -4)])])],
        zones=[("wet corner", "zone", ring), ("B", "zone", ring)],
    )
    assert ids(s.InZone(zone="A"), site) == ["1", "2"]
    assert ids(s.InZone(zone="A", outside=True), site) == ["3", "4"]
    assert ids(s.InBlock(block="Wet-Corner"), site) == ["1", "2"]
    assert [ids(s.InZone(zone="B"), site), ids(s.InBlock(block="B"), site)] == [["1", "2"], ["3", "4"]]
    with pytest.raises(PlaceError, match=r"no block 'C'.*blocks are A, B, its zones wet corner"):
        ids(s.InBlock(block="C"), site)
    with pytest.raises(PlaceError, match=r"no zone 'C'.*zones are wet corner, B, its blocks A, B"):
        ids(s.InZone(zone="C"), site)


# What cannot be

SCATTERED = without_rows(site_of([(0, 0), (7, 2), (3, 9)], properties=[{"age": 1.0}] * 3))


@pytest.mark.parametrize(
    "selector",
    [
        s.Rows(first="1", last="1"),
        s.Rows(every=2),
        s.RowOf(),
        s.InRow(first=1, last=2),
        s.EveryNth(nth=3),
        s.AlongRow(trees=2),
        s.Across(),
        s.Successive(count=2),
        s.Ordered(by="rows"),
    ],
)
def test_a_site_without_rows_says_so_and_why(selector):
    with pytest.raises(PlaceError, match="this site has no rows; the trees do not stand in rows; select trees by id"):
        ids(selector, SCATTERED)


@pytest.mark.parametrize(
    ("selector", "says"),
    [
        (s.Rows(first="1", last="9"), "there is no row '9'; there are 3 rows: 1, 2, 3"),
        (s.Rows(first="1", last="2", every=0), "every 0th row is not possible"),
        (s.RowOf(over=5), "there is no row 5 rows after row 1; the rows are counted from west: 1, 2, 3"),
        (s.RowOf(over=-1), "there is no row 1 row before row 1"),
        (s.InRow(first=0, last=2), "counted from 1"),
        (s.InRow(first=4, last=5), "none of the 3 rows has trees 4 to 5; the longest has 3"),
        (s.InRow(first=4, last=4, of=s.Rows(first="2", last="2")), "row 2 has no tree 4; 3 trees can be chosen"),
        (s.EveryNth(nth=0), "is not possible"),
        (s.EveryNth(nth=2, start=9), "nothing on this site matches every other tree of each row, from the ninth on"),
        (s.AlongRow(trees=0), "moving 0 trees along a row"),
        (s.AlongRow(trees=2, origin=s.Trees()), "'every tree' selects 9 places, but only one is allowed here"),
        (s.Across(side="west"), "there is no row to the west of row 1"),
        (s.Successive(count=4), "4 were asked for, but there are only 3: 4 successive trees of one row"),
        (s.Nth(nth=0, of=s.Trees()), "places are counted from 1"),
        (s.Nth(nth=12, of=s.Trees()), "12 were asked for, but there are only 9: every tree"),
        (s.Ordered(by="attribute", attribute="x"), "no tree has an attribute 'x'"),
    ],
)
def test_what_rows_cannot_give_is_said_with_what_there_is(selector, says):
    site = row_site(["1", "2", "3"])
    with pytest.raises(PlaceError, match=says) as caught:
        ids(selector, site)
    assert "\n" not in str(caught.value)


def test_rows_of_two_blocks_are_no_range():
    two = planted([(b, 0.0, [(f"{b}{k}", [(50.0 * n + 6 * k, 0.0)]) for k in (1, 2)]) for n, b in enumerate("AB")])
    with pytest.raises(PlaceError, match="row A1 is in block A and row B2 is in block B, so they do not form a range"):
        ids(s.Rows(first="A1", last="B2"), two)
    assert ids(s.Rows(first="B1", last="B2"), two) == ["3", "4"]


def test_a_file_that_names_blocks_rows_and_positions_is_counted_as_it_says():
    """Two blocks of two rows; in block East the third tree of row 1 is missing, and its trees count from the south."""
    step_lon, step_lat = 6.0 / 88_800, 4.0 / 111_000
    trees = [
        point(
            -120.0 + step_lon * (column + (9 if block == "East" else 0)),
            37.0 + step_lat * n,
            id=f"{block[0]}{column}-{n}",
            block=block,
            row=str(column),
            position=n,
        )
        for block in ("West", "East")
        for column in (1, 2)
        for n in range(1, 7)
        if (block, column, n) != ("East", 1, 3)
    ]
    site = read(*trees)
    east = s.InBlock(block="east")
    assert ids(s.Rows(first="1", last="1", of=east), site) == [f"E1-{n}" for n in (1, 2, 4, 5, 6)]
    assert ids(s.InRow(first=4, last=5, of=s.Rows(first="1", last="1", of=east)), site) == ["E1-4", "E1-5"]
    assert ids(s.InRow(first=-1, last=-1, of=s.Rows(first="1", last="1", of=east)), site) == ["E1-6"]
    assert ids(s.InRow(first=3, last=3, counted_from="south", of=s.Rows(first="1", last="1", of=east)), site) == [
        "E1-4"
    ]
    with pytest.raises(PlaceError, match=r"row 1 is in 2 blocks: block West, block East"):
        ids(s.Rows(first="1", last="1"), site)
