"""Selectors on sites: each definition of docs/site.md, held against brute force where trees may stand anywhere.

Longer than other files: every selector stands once here, beside its brute force.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
import shapely
import shapely.affinity
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import PlaceError
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve, resolve_one
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import (
    Adjacent,
    AmongExtreme,
    Bound,
    Corners,
    Edge,
    EdgeMiddle,
    Evenly,
    Excluding,
    Extreme,
    Farthest,
    First,
    GateIs,
    Half,
    Here,
    InZone,
    Last,
    Marker,
    Middle,
    Nearest,
    NotVisited,
    Ordered,
    Quarter,
    RandomSample,
    Spaced,
    Spread,
    Successive,
    Take,
    Top,
    TreeIs,
    Trees,
    UnionOf,
    Where,
    Within,
)
from fieldhand.site.describe import describe
from fieldhand.site.model import Site, Zone
from support.sites.points import at_start, grid, orchard, place_at, planted, point, read, site_of, without_rows
from support.sites.points import sites as inferred_sites

LON, LAT = -120.42, 37.26
SIDES = ("north", "east", "south", "west")
TOWARDS = {"north": (0, 1), "east": (1, 0), "south": (0, -1), "west": (-1, 0)}
TINY = 2e-3


def sites(min_size: int = 1, max_size: int = 30) -> st.SearchStrategy[Site]:
    """Sites of scattered trees; those with rows have tests of their own."""
    return inferred_sites(min_size, max_size).map(without_rows)


sides = st.sampled_from(SIDES)
counts = st.integers(1, 4)


def ids(selector: Selector, site, context: Context | None = None) -> list[str]:
    return [p.id for p in resolve(selector, site, context or at_start(site))]


def reach(place, side: str) -> float:
    return place.x * TOWARDS[side][0] + place.y * TOWARDS[side][1]


def away(a, b) -> float:
    return math.hypot(a.x - b.x, a.y - b.y)


# Sources


def test_trees_are_all_in_file_order():
    assert ids(Trees(), orchard()) == [str(k) for k in range(1, 21)]


def test_a_tree_is_found_by_its_id_alone():
    site = orchard()
    assert ids(TreeIs(tree="7"), site) == ["7"]
    with pytest.raises(PlaceError, match=r"no tree '21'.*20 trees are 1 to 20"):
        ids(TreeIs(tree="21"), site)


def test_a_gate_is_found_by_its_name_and_a_name_used_twice_gets_a_number():
    features = [point(LON, LAT), *(point(LON, LAT + k * 1e-4, kind="gate", name="North gate") for k in (1, 2))]
    site = read(*features, point(LON, LAT + 3e-4, kind="gate"))
    assert [g.place.id for g in site.gates] == ["North gate", "North gate 2", "gate 3"]
    for said, found in (("North gate", 0), ("north_gate", 0), ("north gate 2", 1), ("gate 3", 2)):
        assert resolve(GateIs(gate=said), site, at_start(site)) == (site.gates[found].place,)
    with pytest.raises(PlaceError, match=r"no gate 'barn gate'.*its gates are North gate, North gate 2, gate 3"):
        ids(GateIs(gate="barn gate"), site)
    with pytest.raises(PlaceError, match=r"no gate 'gate'.*no gates"):
        ids(GateIs(gate="gate"), orchard())


def test_markers_are_themselves_and_missing_ones_fall_back_except_the_charger():
    marked = orchard(markers={"start": (9, -5), "end": (0, 30), "charger": (1, 1)})
    assert [ids(Marker(name=n), marked)[0] for n in ("start", "end", "charger")] == ["start", "end", "charger"]
    bare = orchard()
    assert ids(Marker(name="start"), bare) == ["1"]
    assert ids(Marker(name="end"), orchard(markers={"start": (9, -5)})) == ["start"]
    with pytest.raises(PlaceError, match="no charger"):
        ids(Marker(name="charger"), bare)


def test_here_and_bound_places_come_from_the_mission():
    site = orchard()
    context = Context(here=site.trees[4].place, bound={"hot": (site.trees[2].place, site.trees[0].place)})
    assert ids(Here(), site, context) == ["5"]
    assert ids(Bound(label="hot"), site, context) == ["3", "1"]
    with pytest.raises(PlaceError, match=r"no place is named 'cold'.*hot"):
        ids(Bound(label="cold"), site, context)


def test_first_and_last_go_by_the_markers_else_by_the_file():
    assert [ids(First(), orchard()), ids(Last(), orchard())] == [["1"], ["20"]]
    marked = orchard(markers={"start": (19, 17), "end": (-1, -1)})
    assert [ids(First(), marked), ids(Last(), marked)] == [["20"], ["1"]]
    assert ids(First(of=Half(side="west")), marked) == ["10"]


def test_a_union_is_its_parts_in_their_order_each_place_once():
    site = orchard(markers={"start": (0, -5)})
    parts = (TreeIs(tree="9"), Marker(name="start"), Trees(), TreeIs(tree="3"))
    assert ids(UnionOf(parts=parts), site) == ["9", "start", *[str(k) for k in range(1, 21) if k != 9]]


# Halves, edges, corners


@given(sites(), sides)
def test_a_half_holds_exactly_the_trees_on_its_side_of_the_extents_middle_line(site, side):
    wanted = site.xy @ np.array(TOWARDS[side])
    middle = (wanted.min() + wanted.max()) / 2
    expected = [t.place.id for t, w in zip(site.trees, wanted, strict=True) if w >= middle - 0.01]
    assert ids(Half(side=side), site) == expected


@given(sites())
def test_two_opposite_halves_are_all_trees_and_a_quarter_is_what_two_halves_share(site):
    north, south, east = (set(ids(Half(side=s), site)) for s in ("north", "south", "east"))
    assert north | south == set(site.by_id)
    shared = north & east
    if shared:
        assert set(ids(Quarter(quarter="ne"), site)) == shared
    else:
        with pytest.raises(PlaceError, match="north-east quarter"):
            ids(Quarter(quarter="ne"), site)


@given(sites(min_size=2), sides, st.data())
def test_a_half_is_the_farms_half_whichever_way_an_attribute_test_nests(site, side, data):
    colours = data.draw(
        st.lists(st.sampled_from(["yellow", "green"]), min_size=len(site.trees), max_size=len(site.trees))
    )
    trees = tuple(replace(t, properties={"c": c}) for t, c in zip(site.trees, colours, strict=True))
    site = replace(site, trees=trees)
    yellow = {"attribute": "c", "test": "eq", "value": "yellow"}
    expected = [k for k in ids(Half(side=side), site) if site.by_id[k].properties["c"] == "yellow"]
    if expected:
        assert ids(Half(side=side, of=Where(**yellow)), site) == expected
        assert ids(Where(**yellow, of=Half(side=side)), site) == expected


def test_a_half_of_a_zone_is_the_zones_own():
    site = orchard(zones=[("west block", "zone", [(-1, -1), (7, -1), (7, 17), (-1, 17)])])
    assert ids(Half(side="east", of=InZone(zone="west block")), site) == ["6", "7", "8", "9", "10"]
    assert ids(Extreme(side="east", count=2, of=InZone(zone="west block")), site) == ["6", "7"]


@given(sites(), sides, counts)
def test_extreme_trees_are_the_farthest_to_their_side_in_order(site, side, count):
    if count > len(site.trees):
        with pytest.raises(PlaceError, match=f"only {len(site.trees)}"):
            ids(Extreme(side=side, count=count), site)
        return
    found = resolve(Extreme(side=side, count=count), site, at_start(site))
    expected = sorted(site.trees, key=lambda t: (-reach(t.place, side), t.index))[:count]
    assert [p.id for p in found] == [t.place.id for t in expected]


@pytest.mark.parametrize(
    ("side", "expected"),
    [("north", [5, 4, 10, 9, 15, 14, 20, 19]), ("east", range(16, 21)), ("south", [1, 2, 6, 7, 11, 12, 16, 17])],
)
def test_among_extreme_are_those_less_than_a_row_spacing_from_the_extreme(side, expected):
    """Rows 6 m apart run north to south, trees stand 4 m apart: a row exactly one spacing behind is the next row."""
    columns = [[(6.0 * c, 4.0 * r) for r in range(5)] for c in range(4)]
    site = planted([("1", 0.0, [(str(k), list(reversed(row))) for k, row in enumerate(columns)])], order=_as_in_grid())
    assert sorted(map(int, ids(AmongExtreme(side=side), site))) == sorted(expected)


def _as_in_grid() -> list[int]:
    """The trees of a grid in its file order, where rows are listed from their northern end."""
    return [5 * c + 4 - r for c in range(4) for r in range(5)]


def test_among_extreme_without_rows_goes_by_the_spacing_of_the_trees():
    site = without_rows(site_of([(0, 0), (1, 5), (2, 9.9), (9, 10), (4, -6)]))
    assert site.spacing_m == pytest.approx(5.099, abs=1e-3)
    assert ids(AmongExtreme(side="north"), site) == ["2", "3", "4"]
    assert ids(AmongExtreme(side="south"), site) == ["5"]


@given(sites(), sides)
def test_the_edge_is_what_no_tree_hides_within_a_corridor(site, side):
    across = {"north": 0, "south": 0, "east": 1, "west": 1}[side]
    corridor = 0.7 * site.spacing_m
    expected = [
        t.place.id
        for t in site.trees
        if not any(
            abs(o.place.xy[across] - t.place.xy[across]) <= corridor
            and reach(o.place, side) > reach(t.place, side) + 0.01
            for o in site.trees
        )
    ]
    assert ids(Edge(side=side), site) == expected


@pytest.mark.parametrize("turned", [0, 8, 17, -12])
def test_the_edge_of_a_turned_orchard_is_its_outermost_row(turned):
    angle = math.radians(turned)
    points = [
        (x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle))
        for x, y in grid(6, 12, across=5, along=4)
    ]
    site = site_of(points)
    assert ids(Edge(side="north"), site) == [str(12 * k) for k in range(1, 7)]
    assert ids(Edge(side="east"), site) == [str(k) for k in range(61, 73)]
    assert set(ids(EdgeMiddle(side="east", count=2), site)) == {"66", "67"}
    assert set(ids(EdgeMiddle(side="north", count=2), site)) == {"36", "48"}


def test_the_middle_of_an_edge_stays_where_it_is_when_its_tree_was_visited():
    site = orchard(5, 5)
    assert ids(EdgeMiddle(side="east"), site) == ["23"]
    assert ids(EdgeMiddle(side="east", of=NotVisited()), site, at_start(site, visited=["23"])) == ["22"]


@given(sites(min_size=2), counts)
def test_the_middle_is_nearest_to_the_centre_of_the_extent(site, count):
    count = min(count, len(site.trees))
    centre = place_at(*((site.xy.min(axis=0) + site.xy.max(axis=0)) / 2).tolist())
    found = resolve(Middle(count=count), site, at_start(site))
    left = [t.place for t in site.trees if t.place not in found]
    assert len(found) == count
    assert all(away(p, centre) <= away(q, centre) + TINY for p in found for q in left)


def brute_rectangle_area(site) -> float:
    """Smallest enclosing rectangle by trying the direction of every pair of trees."""
    best = math.inf
    for a in site.xy:
        for b in site.xy:
            length = math.hypot(*(b - a))
            if length > 0:
                u = (b - a) / length
                along, across = site.xy @ u, site.xy @ np.array([-u[1], u[0]])
                best = min(best, np.ptp(along) * np.ptp(across))
    return best


@settings(max_examples=60)
@given(sites(min_size=3, max_size=14))
def test_corners_are_of_the_smallest_rectangle_by_brute_force(site):
    from fieldhand.site.rectangle import named_corners, smallest_rectangle

    corners = smallest_rectangle(site.xy)
    area = math.hypot(*(corners[1] - corners[0])) * math.hypot(*(corners[3] - corners[0]))
    assert area == pytest.approx(brute_rectangle_area(site), rel=1e-6, abs=1e-6)
    named = named_corners(corners)
    assert len({tuple(c) for c in named.values()}) == len({tuple(c) for c in corners})
    for name, corner in named.items():
        found = resolve_one(Corners(which=(name,)), site, at_start(site))
        nearest = min(math.hypot(*(t.place.xy - corner)) for t in site.trees)
        assert math.hypot(*(np.array(found.xy) - corner)) <= nearest + TINY


@pytest.mark.parametrize("trees", [2, 3, 17, 40])
@pytest.mark.parametrize("way", [(0.0, 5.0), (5.0, 0.0), (3.0, 4.0)])
def test_trees_on_one_line_have_a_rectangle_without_width(trees, way):
    site = site_of([(way[0] * k, way[1] * k) for k in range(trees)])
    assert set(ids(Corners(which=("sw", "nw", "se", "ne")), site)) == {"1", str(trees)}
    assert describe(site).area_m2 == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("turned", range(-40, 41, 8))
def test_corners_keep_their_names_while_the_orchard_turns_up_to_forty_degrees(turned):
    angle = math.radians(turned)
    points = [
        (x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle))
        for x, y in grid(4, 4, across=4)
    ]
    assert ids(Corners(which=("sw", "nw", "se", "ne")), site_of(points)) == ["1", "4", "13", "16"]


def test_at_45_degrees_every_corner_still_has_one_name():
    diamond = site_of([(0, 10), (10, 0), (0, -10), (-10, 0), (0, 0)])
    assert sorted(ids(Corners(), diamond)) == ["1", "2", "3", "4"]


def test_corners_of_a_named_group_are_its_own_and_do_not_move_when_one_was_visited():
    kinds = [{"v": "Kerman"}] * 10 + [{"v": "Peters"}] * 10
    site = orchard(properties=kinds)
    assert ids(Corners(which=("ne",), of=Where(attribute="v", test="eq", value="kerman")), site) == ["10"]
    assert ids(Corners(which=("ne",), of=NotVisited()), site, at_start(site, visited=["20"])) == ["19"]
    long = site_of([(0, 0), (10, 0), (0, 10), (6, 10), (10, 2), (100, 0)])
    assert ids(
        Corners(which=("ne",), of=Within(distance_m=50.0, to=Marker(name="start"))),
        replace(long, markers={"start": place_at(5, -1)}),
    ) == ["4"]
    assert ids(Corners(which=("ne",), of=NotVisited()), long, at_start(long, visited=["6"])) == ["5"]


# Near and far


@given(sites(min_size=2), counts, st.data())
def test_nearest_are_no_farther_than_any_left_out_and_never_the_tree_itself(site, count, data):
    me = data.draw(st.sampled_from(site.trees)).place
    visited = data.draw(st.lists(st.sampled_from([t.place.id for t in site.trees]), max_size=3, unique=True))
    fresh = data.draw(st.booleans())
    allowed = [t.place for t in site.trees if t.place != me and not (fresh and t.place.id in visited)]
    selector = Nearest(to=TreeIs(tree=me.id), count=count, fresh=fresh)
    context = at_start(site, visited=visited)
    if len(allowed) < count:
        with pytest.raises(PlaceError):
            resolve(selector, site, context)
        return
    found = resolve(selector, site, context)
    expected = sorted(allowed, key=lambda p: (round(away(p, me), 4), site.by_id[p.id].index))[:count]
    assert list(found) == expected


def test_next_to_prefers_the_same_row_among_neighbours_only():
    points = [(0, 0), (0, 4.5), (4, 0), (4, 4.5), (0, 9)]
    rows = ["A", "A", "B", "B", "A"]
    site = site_of(points, row_names=rows)
    one = TreeIs(tree="1")
    assert ids(Nearest(to=one), site) == ["3"]
    assert ids(Nearest(to=one, adjacent=True), site) == ["2"]
    assert ids(Nearest(to=one, adjacent=True, count=3), site) == ["2", "3", "4"]
    apart = site_of([(0, 0), (0, 40), (4, 0)], row_names=["A", "A", "B"])
    assert ids(Nearest(to=one, adjacent=True), apart) == ["3"]


@given(sites(min_size=2), st.sampled_from(["north", "east", "south", "west"]), st.data())
def test_nearest_on_a_side_is_the_nearest_of_those_in_that_quarter_of_the_compass(site, side, data):
    me = data.draw(st.sampled_from(site.trees)).place

    def is_there(place):
        east, north = place.x - me.x, place.y - me.y
        out, aside = {"north": (north, east), "east": (east, north), "south": (-north, east), "west": (-east, north)}[
            side
        ]
        return out > 0 and abs(aside) <= out and away(place, me) > 0.01

    there = [t.place for t in site.trees if is_there(t.place)]
    selector = Nearest(to=TreeIs(tree=me.id), side=side)
    if not there:
        with pytest.raises(PlaceError):
            resolve_one(selector, site, at_start(site))
        return
    found = resolve_one(selector, site, at_start(site))
    assert away(found, me) <= min(away(p, me) for p in there) + TINY
    assert is_there(found)


def test_the_neighbour_on_a_side_is_the_next_tree_there_and_none_beyond_a_road():
    points = [(4.0 * k + (200.0 if k > 2 else 0.0), 2.0 * j) for k in range(5) for j in range(3)]
    site = site_of(points, row_names=[str(k) for k in range(5) for _ in range(3)])
    beside = {
        side: Nearest(to=TreeIs(tree="5"), adjacent=True, side=side) for side in ("north", "east", "south", "west")
    }
    assert {side: ids(x, site) for side, x in beside.items()} == {
        "north": ["6"],
        "east": ["8"],
        "south": ["4"],
        "west": ["2"],
    }
    with pytest.raises(PlaceError, match=r"none.*next to tree 8, on its east side"):
        ids(Nearest(to=TreeIs(tree="8"), adjacent=True, side="east"), site)
    assert ids(Nearest(to=TreeIs(tree="8"), side="east"), site) == ["11"]


@given(sites(min_size=3), st.data())
def test_a_draw_depends_on_seed_and_ids_only(site, data):
    count = data.draw(st.integers(1, len(site.trees)))
    seed = data.draw(st.integers(0, 5))
    drawn = ids(RandomSample(count=count, seed=seed), site)
    assert len(set(drawn)) == count
    assert ids(RandomSample(count=count, seed=seed), site, at_start(site, visited=drawn)) == drawn
    kept = data.draw(st.sets(st.sampled_from([t.place.id for t in site.trees])).map(lambda more: {*more, *drawn}))
    some = UnionOf(parts=tuple(TreeIs(tree=t) for t in sorted(kept)))
    assert set(ids(RandomSample(count=count, seed=seed, of=some), site)) == set(drawn)


@given(sites(min_size=3, max_size=9), st.data())
def test_trees_that_are_spread_stand_at_least_half_as_far_apart_as_any_choice_could(site, data):
    count = data.draw(st.integers(2, len({t.place.xy for t in site.trees})))
    xy = {t.place.id: t.place.xy for t in site.trees}

    def nearest_two(names) -> float:
        return min(math.dist(xy[a], xy[b]) for a, b in itertools.combinations(names, 2))

    spread = ids(Spread(count=count), site)
    assert len(set(spread)) == count
    best = max(nearest_two(names) for names in itertools.combinations(xy, count))
    assert nearest_two(spread) >= best / 2 - 1e-9
    assert ids(Spread(count=count), site) == spread


def test_one_that_is_spread_is_in_the_middle_and_more_than_there_are_are_refused():
    site = site_of([(4.0 * k, 0.0) for k in range(5)])
    assert ids(Spread(count=1), site) == [site.trees[2].place.id]
    assert ids(Spread(count=3), site) == [site.trees[k].place.id for k in (0, 2, 4)]
    with pytest.raises(PlaceError):
        ids(Spread(count=6), site)


@given(st.integers(1, 40), st.data())
def test_trees_along_a_row_are_as_even_as_whole_trees_allow_and_its_ends_are_among_them(length, data):
    count = data.draw(st.integers(1, length))
    shuffled = data.draw(st.permutations(range(length)))
    site = planted([("A", 0.0, [("1", [(0.0, -4.0 * k) for k in range(length)])])], order=shuffled)
    along = [t.place.id for t in sorted(site.trees, key=lambda t: -t.place.y)]
    found = [along.index(name) for name in ids(Evenly(count=count), site)]
    assert len(set(found)) == count
    if count == 1:
        assert abs(found[0] - (length - 1) / 2) <= 0.5
    else:
        assert sorted(found) == found
        assert {0, length - 1} <= set(found)
        assert all(abs(k - m * (length - 1) / (count - 1)) <= 0.5 for m, k in enumerate(found))


@given(st.integers(1, 40), st.integers(1, 7), st.data())
def test_of_every_few_along_a_row_the_same_places_are_chosen_of_the_last_ones_too(length, whole, data):
    count = data.draw(st.integers(1, whole))
    site, few = (site_of([(4.0 * k, 0.0) for k in range(n)]) for n in (length, whole))
    line = Ordered(by="west_to_east")
    pattern = {int(name) - 1 for name in ids(Evenly(count=count, of=line), few)}
    expected = [str(k + 1) for k in range(length) if k % whole in pattern]
    if expected:
        assert ids(Evenly(count=count, out_of=whole, of=line), site) == expected
    else:
        with pytest.raises(PlaceError):
            ids(Evenly(count=count, out_of=whole, of=line), site)


def test_some_of_a_row_keep_the_order_in_which_they_are_given():
    site = site_of([(4.0 * k, 0.0) for k in range(9)])
    backwards = Ordered(by="east_to_west")
    assert ids(Evenly(count=3, of=backwards), site) == ["9", "5", "1"]
    assert ids(Evenly(count=2, out_of=4, of=backwards), site) == ["9", "6", "5", "2", "1"]
    for wrong in (Evenly(count=10), Evenly(count=0), Evenly(count=4, out_of=3)):
        with pytest.raises(PlaceError):
            ids(wrong, site)


def test_each_tree_is_drawn_as_often_as_any_other():
    site = site_of([(4.0 * k, 0.0) for k in range(20)])
    times = Counter(t for seed in range(2000) for t in ids(RandomSample(count=5, seed=seed), site))
    assert len(times) == 20
    assert all(abs(n - 500) < 5 * (2000 * 0.25 * 0.75) ** 0.5 for n in times.values())


def test_a_margin_takes_the_trees_near_a_zone_too():
    site = site_of([(4.0 * k, 0.0) for k in range(20)])
    pond = shapely.Polygon([(-2, -20), (9, -20), (9, -3), (-2, -3)])
    east, north = site.xy[0] - (0.0, 0.0)
    pond = shapely.affinity.translate(pond, east, north)
    site = replace(site, zones=(Zone(name="pond", kind="keep_out", polygon=pond),))
    assert ids(InZone(zone="pond", margin_m=3.0), site) == ["1", "2", "3"]
    assert ids(InZone(zone="pond", margin_m=4.5), site) == ["1", "2", "3", "4"]
    assert ids(InZone(zone="pond", outside=True, margin_m=60.0), site) == ["19", "20"]


WATER = shapely.Polygon([(7, -14), (21, -11), (26, 3), (15, 6), (13, -2), (5, -4)])


def with_water(site: Site, spread: float = 1.0) -> Site:
    """The site with a zone that is no rectangle, wider by ``spread``, somewhere on or beside its trees."""
    around = shapely.affinity.translate(shapely.affinity.scale(WATER, spread, spread), *site.xy.mean(axis=0))
    return replace(site, zones=(Zone(name="pond", kind="keep_out", polygon=around),))


@given(sites(min_size=2), st.integers(1, 6), st.floats(0.2, 3.0))
def test_nearest_to_a_zone_is_by_the_distance_to_its_outline_and_never_inside(site, count, spread):
    site = with_water(site, spread)
    pond = site.zones[0].polygon
    apart = {t.place.id: pond.distance(shapely.Point(t.place.x, t.place.y)) for t in site.trees}
    outside = sorted(d for d in apart.values() if d > 0)
    for selector, expected in (
        (Nearest(to=InZone(zone="pond"), count=count), outside[:count]),
        (Farthest(origin=InZone(zone="pond"), count=count), outside[::-1][:count]),
    ):
        if len(outside) < count:
            with pytest.raises(PlaceError):
                ids(selector, site)
            continue
        assert sorted(apart[tree] for tree in ids(selector, site)) == pytest.approx(sorted(expected), abs=TINY)
    near = [tree for tree, metres in apart.items() if 0 < metres <= 12.0]
    if near:
        assert ids(Within(distance_m=12.0, to=InZone(zone="pond")), site) == near


def test_a_zone_without_trees_is_near_to_rows_on_its_sides_and_to_lines_of_points():
    site = site_of(
        [(4.0 * k, 2.0 * j) for k in range(5) for j in range(10)],
        row_names=[str(k) for k in range(5) for _ in range(10)],
        zones=[("pond", "keep_out", [(20, 12), (30, 12), (30, 16.5), (20, 16.5)])],
    )
    pond = InZone(zone="pond")
    assert ids(Successive(count=3, near=pond), site) == ["49", "48", "47"]
    assert ids(Adjacent(near=pond, count=2), site)[0] in ("47", "48", "49", "50")
    assert ids(Nearest(to=pond, side="west"), site) == ["47"]
    with pytest.raises(PlaceError):
        ids(Nearest(to=pond, side="east"), site)
    assert reach(resolve(Spaced(apart_m=3.0, count=2, near=pond), site, at_start(site))[0], "east") > 15
    with pytest.raises(PlaceError, match="no zone 'lake'"):
        ids(Nearest(to=InZone(zone="lake")), site)


def test_a_tree_that_the_file_holds_twice_is_not_its_own_neighbour():
    site = site_of([(0, 0), (0, 0), (4, 0)])
    assert ids(Nearest(to=TreeIs(tree="1")), site) == ["3"]
    assert ids(Adjacent(near=TreeIs(tree="2"), count=2), site) == ["2", "3"]
    with pytest.raises(PlaceError, match="only 2"):
        ids(Adjacent(near=TreeIs(tree="2"), count=3), site)


@given(sites(min_size=2), st.data())
def test_the_farthest_is_at_least_as_far_as_every_other_tree(site, data):
    origin = data.draw(st.sampled_from(site.trees)).place
    found = resolve_one(Farthest(origin=TreeIs(tree=origin.id)), site, at_start(site))
    assert found != origin
    assert away(found, origin) >= max(away(t.place, origin) for t in site.trees) - TINY


@given(sites(min_size=2), st.floats(0.5, 200), st.data())
def test_within_is_by_straight_distance_and_leaves_out_what_it_is_measured_from(site, distance, data):
    origin = data.draw(st.sampled_from(site.trees)).place
    expected = [t.place.id for t in site.trees if t.place != origin and away(t.place, origin) <= distance]
    selector = Within(distance_m=distance, to=TreeIs(tree=origin.id))
    if expected:
        assert ids(selector, site) == expected
    else:
        with pytest.raises(PlaceError, match="within"):
            ids(selector, site)


@given(sites(min_size=3), st.floats(0.5, 60.0), st.data())
def test_beyond_a_distance_are_all_others_but_what_it_is_measured_from(site, distance, data):
    some = data.draw(st.lists(st.sampled_from(site.trees), min_size=1, max_size=3, unique_by=lambda t: t.place.id))
    to = UnionOf(parts=tuple(TreeIs(tree=tree.place.id) for tree in some))
    origins = [tree.place for tree in some]
    expected = [t.place.id for t in site.trees if min(away(t.place, o) for o in origins) > max(distance, 0.01)]
    selector = Within(distance_m=distance, to=to, beyond=True)
    if expected:
        assert ids(selector, site) == expected
    else:
        with pytest.raises(PlaceError, match="more than"):
            ids(selector, site)


def test_trees_side_by_side_begin_with_the_nearest_and_follow_the_row():
    site = orchard()
    assert ids(Adjacent(near=TreeIs(tree="6"), count=5), site) == ["6", "7", "8", "9", "10"]
    assert ids(Adjacent(near=TreeIs(tree="8"), count=2), site) == ["8", "7"]
    wide = site_of(grid(4, 5, across=4.0, along=4.4), row_names=[str(c) for c in range(4) for _ in range(5)])
    assert ids(Adjacent(near=TreeIs(tree="6"), count=4), wide) == ["6", "7", "8", "9"]


@given(sites(min_size=2), st.integers(2, 6), st.data())
def test_trees_side_by_side_are_each_a_neighbour_of_one_before(site, count, data):
    seed = data.draw(st.sampled_from(site.trees)).place
    count = min(count, len(site.trees))
    found = resolve(Adjacent(near=TreeIs(tree=seed.id), count=count), site, at_start(site))
    assert found[0] == seed
    assert len(set(found)) == count
    for k in range(1, count):
        left = [t.place for t in site.trees if t.place not in found[:k]]
        possible = min(away(p, q) for p in found[:k] for q in left)
        chosen = min(away(p, found[k]) for p in found[:k])
        assert chosen <= 1.5 * 1.5 * max(possible, site.spacing_m) + TINY


@given(sites(min_size=1), st.integers(1, 8))
def test_take_goes_from_nearest_to_nearest(site, count):
    count = min(count, len(site.trees))
    here = place_at(3.1, 4.7)
    found = resolve(Take(count=count, of=Trees()), site, Context(here=here))
    assert len(set(found)) == count
    at = here
    for k, place in enumerate(found):
        left = [t.place for t in site.trees if t.place not in found[:k]]
        assert away(place, at) <= min(away(p, at) for p in left) + TINY
        at = place


@pytest.mark.parametrize("shape", ["scattered", "raster"])
def test_take_from_many_trees_is_the_same_greedy_chain_with_ties_in_file_order(shape):
    rng = np.random.default_rng(5)
    points = rng.uniform(0, 100, (400, 2)) if shape == "scattered" else rng.permutation(grid(20, 20, across=4.0))
    site = site_of(points.tolist())
    found = resolve(Take(count=400, of=Trees()), site, at_start(site))
    at, left = site.start, [t.place for t in site.trees]
    for place in found:
        assert place == min(left, key=lambda p: round(away(p, at), 4))
        left.remove(place)
        at = place
    assert not left


# What the mission has seen, attributes, zones


def test_other_and_excluding_leave_out_what_they_say():
    site = orchard()
    assert ids(NotVisited(of=TreeIsIn("1", "2", "3")), site, at_start(site, visited=["2"])) == ["1", "3"]
    assert ids(Excluding(places=Half(side="north"), of=Half(side="west")), site) == ["1", "2", "6", "7"]
    with pytest.raises(PlaceError, match="not visited yet"):
        ids(NotVisited(of=TreeIs(tree="2")), site, at_start(site, visited=["2"]))


def TreeIsIn(*trees: str) -> UnionOf:  # noqa: N802
    return UnionOf(parts=tuple(TreeIs(tree=t) for t in trees))


@pytest.fixture
def attributed():
    colours = ["Green", "yellow", "green", "YELLOW ", "brown"]
    values = [
        {"leaf_color": c, "age": float(k), "count": str(k), "sick": k == 2}
        | ({"reward": 1.5 * (k % 3)} if k != 4 else {})
        for k, c in enumerate(colours)
    ]
    return site_of([(4.0 * k, 0.0) for k in range(5)], properties=values)


@pytest.mark.parametrize(
    ("attribute", "test", "value", "expected"),
    [
        ("leaf_color", "eq", "Yellow", "24"),
        ("leaf_color", "ne", "yellow", "135"),
        ("Leaf Color", "eq", "yellow", "24"),
        ("age", "lt", 2.0, "12"),
        ("age", "le", 2.0, "123"),
        ("age", "gt", 2.0, "45"),
        ("age", "ge", "2", "345"),
        ("age", "eq", 3.0, "4"),
        ("age", "ne", 3.0, "1235"),
        ("count", "gt", 1.0, "345"),
        ("sick", "eq", True, "3"),
        ("sick", "eq", "yes", "3"),
        ("sick", "ne", True, "1245"),
        ("reward", "ge", 0.0, "1234"),
        ("reward", "ne", 0.0, "23"),
    ],
)
def test_attributes_compare_as_numbers_or_as_text_without_case(attributed, attribute, test, value, expected):
    assert ids(Where(attribute=attribute, test=test, value=value), attributed) == list(expected)


@pytest.mark.parametrize(
    ("selector", "says"),
    [
        (
            Where(attribute="leaf_colour", test="eq", value="x"),
            "did you mean 'leaf_color'.*the trees have leaf_color, age",
        ),
        (Where(attribute="leaf_color", test="eq", value="yelow"), "did you mean.*values are.*brown"),
        (Where(attribute="leaf_color", test="lt", value="x"), "cannot be above or below"),
        (Where(attribute="leaf_color", test="lt", value=3.0), "not a number"),
        (Where(attribute="age", test="gt", value=99.0), "nothing on this site matches the trees whose age is above 99"),
        (Top(attribute="leaf_color", count=1), "not a number"),
        (Top(attribute="reward", count=5), "only 4"),
        (Top(attribute="age", count=0), "asked for"),
        (InZone(zone="wet corner"), "no zone 'wet corner'.*no zones"),
        (Within(distance_m=-1.0, to=TreeIs(tree="1")), "more than 0 m"),
        (Corners(which=()), "no corner"),
        (UnionOf(parts=()), "no parts"),
        (Take(count=9, of=Trees()), "9 were asked for, but there are only 5"),
        (Nearest(to=TreeIs(tree="99")), "no tree '99'"),
    ],
)
def test_what_finds_nothing_says_which_part_and_what_there_is(attributed, selector, says):
    with pytest.raises(PlaceError, match=says) as caught:
        resolve(selector, attributed, at_start(attributed))
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 600


def test_top_ranks_by_number_with_ties_in_file_order_and_without_those_that_lack_it(attributed):
    assert ids(Top(attribute="reward", count=3), attributed) == ["3", "2", "1"]
    assert ids(Top(attribute="reward", count=3, lowest=True), attributed) == ["1", "4", "2"]
    assert ids(Top(attribute="count", count=2), attributed) == ["5", "4"]


def test_zones_hold_what_stands_inside_or_on_their_edge_and_are_called_without_case():
    square = [(-1, -1), (6, -1), (6, 4), (-1, 4)]
    site = orchard(zones=[("Wet Corner", "zone", square), ("pond", "keep_out", [(40, 0), (50, 0), (45, 5)])])
    assert ids(InZone(zone="wet corner"), site) == ["1", "2", "6", "7"]
    assert ids(InZone(zone="wet-corner", outside=True), site) == [str(k) for k in range(1, 21) if k not in (1, 2, 6, 7)]
    with pytest.raises(PlaceError, match="inside the zone “pond”"):
        ids(InZone(zone="pond"), site)
    with pytest.raises(PlaceError, match="did you mean 'Wet Corner'"):
        ids(InZone(zone="wet cornr"), site)


def test_one_place_is_one_place():
    site = orchard()
    assert resolve_one(TreeIs(tree="3"), site, at_start(site)).id == "3"
    with pytest.raises(PlaceError, match="'every tree' selects 20 places"):
        resolve_one(Trees(), site, at_start(site))
