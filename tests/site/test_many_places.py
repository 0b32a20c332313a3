"""Test drives among many places: equal to single drives, and hardly longer over the sparse road map."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from shapely.affinity import rotate, translate
from shapely.geometry import LineString, Point, box

from fieldhand.errors import DriveFault
from fieldhand.forecast.distances import Distances
from fieldhand.forecast.visit_order import reachable
from fieldhand.site.drives import Drives
from fieldhand.site.driving.free_space import TOUCH_M, Area
from fieldhand.site.driving.roadmap import Roadmap
from fieldhand.site.driving.row_obstacles import RowObstacle
from fieldhand.site.driving.visibility_graph import VisibilityGraph
from fieldhand.site.model import Site
from fieldhand.testing.generated.orchards import orchard_sites
from support.arrays import assert_near
from support.examples import examples
from support.sites.planted import generated, planted, scattered, upright
from support.sites.points import place_at

CLEARANCE, STANDOFF = 0.35, 1.5

#: Sites with named rows, inferred rows and trees in no row; with ponds, fences, gates and markers.
any_site = st.one_of(st.integers(0, 10**6).map(generated), st.integers(0, 10**6).map(scattered), orchard_sites())


def drives_on(site: Site) -> Drives:
    return Drives(site, CLEARANCE, STANDOFF)


def places_of(site: Site):
    return [*(t.place for t in site.trees), *site.markers.values()]


@settings(max_examples=40, deadline=None)
@given(any_site, st.randoms(use_true_random=False))
def test_problems_of_many_places_equal_those_of_each(site, random):
    places = places_of(site)
    together = dict(zip((p.xy for p in places), drives_on(site).problems(places), strict=True))
    drives = drives_on(site)
    shuffled = random.sample(places, len(places))
    assert {p.xy: drives.problem(p) for p in shuffled} == together
    open_, closed = reachable(drives, places)
    assert [*open_] == [p for p in places if not together[p.xy]]
    assert [*closed] == [p for p in places if together[p.xy]]


@settings(max_examples=30, deadline=None)
@given(any_site, st.integers(0, 10**6))
def test_stands_and_lengths_do_not_depend_on_earlier_queries(site, seed):
    fresh, asked = drives_on(site), drives_on(site)
    assume(not asked.problem(site.start))
    places = [p for p in places_of(site) if not asked.problem(p)]
    assume(len(places) > 1)
    rng = np.random.default_rng(seed)
    for i, j in rng.integers(0, len(places), (5, 2)).tolist():
        asked.between(places[i], places[j])
    standing = fresh.stands(places)
    assert [p.stand for p in asked.stands(places)] == [p.stand for p in standing]
    lengths = fresh.lengths(standing)
    some, others = rng.permutation(len(places))[:6].tolist(), rng.permutation(len(places))[:5].tolist()
    table = asked.lengths([standing[k] for k in some], [standing[k] for k in others])
    assert_near(table, lengths[np.ix_(some, others)], within=1e-9)
    for i in some[:3]:
        for j in others[:3]:
            assert asked.between(standing[i], standing[j]).length_m == pytest.approx(lengths[i, j], abs=1e-6)


def test_a_straight_path_past_the_end_of_a_row_is_found_in_both_directions():
    """One place is in the margin of its row, and from its foot the end of the row separates them."""
    drives = Drives(generated(51), CLEARANCE, 1.0)
    trees = [tree.place for tree in drives.site.trees if not drives.problem(tree.place)]
    standing = drives.stands(trees)
    pair = standing[46], standing[98]
    metres = drives.between(*pair).length_m
    assert len(drives.between(*pair).points) == 2
    for one, two in (pair, pair[::-1]):
        assert drives.lengths([one], [two]) == pytest.approx(metres)
        assert drives.lengths([one, two])[0, 1] == pytest.approx(metres)


@settings(max_examples=15, deadline=None)
@given(any_site)
def test_lengths_computed_place_by_place_equal_those_computed_at_once(site):
    drives = drives_on(site)
    assume(not drives.problem(site.start))
    places = drives.stands([p for p in places_of(site) if not drives.problem(p)][:12])
    table = Distances(drives)
    for k in (1, 2, 5, len(places)):
        table.between(places[:k])
    whole = table.between(places)
    assert (whole == whole.T).all()
    assert_near(whole, drives.lengths(places), within=1e-9)


# --- road map ----------------------------------------------------------------------------------------------------


def over(roads: Roadmap) -> np.ndarray:
    """Return the metres of the shortest paths over the road map between all pairs of places."""
    n, k = len(roads.at), len(roads.places)
    if roads.straight:
        return np.hypot(*(roads.at[:, None] - roads.at[None]).transpose(2, 0, 1))
    ends = np.sort(roads.ways, axis=1)
    order = np.lexsort((roads.lengths, ends[:, 1], ends[:, 0]))
    _, first = np.unique(ends[order], axis=0, return_index=True)
    kept = order[first]
    graph = coo_array((roads.lengths[kept], ends[kept].T), shape=(n, n)).tocsr()
    return dijkstra(graph, directed=False, indices=np.arange(k))[:, :k]


@settings(max_examples=50, deadline=None)
@given(any_site)
@example(generated(38))  # a stand beside a row in an aisle that something else stands in
@example(generated(210))  # a turn around a short row between two such aisles
def test_paths_over_the_roadmap_are_never_shorter_than_drives_and_hardly_longer(site):
    drives = drives_on(site)
    assume(not drives.problem(site.start))
    places = [p for p in places_of(site) if not drives.problem(p)]
    assume(len(places) > 1)
    roads = drives.roadmap(places)
    assert [p.stand for p in roads.places] == [p.stand for p in drives.stands(places)]
    assert roads.at[: len(places)].tolist() == [list(p.stand) for p in roads.places]
    assert (roads.lengths > 0.0).all()
    assert len(roads.ways) <= 40 * len(places) + len(drives.layout.graph.ways(0)[0])
    lengths, found = drives.lengths(roads.places), over(roads)
    assert (found >= lengths * (1.0 - 1e-9) - 1e-5).all()  # corners may be cut by a millionth of a metre
    apart = lengths > 1e-6
    stretch = found[apart] / lengths[apart] - 1.0
    if stretch.size:
        longer = (found - lengths)[apart]
        assert np.median(np.minimum(stretch / 0.01, longer / 0.5)) <= 1.0  # a per cent, or half a metre
        # The excess is greatest for near neighbours, and for a place within the clearance of an obstacle.
        assert (longer <= 0.15 * lengths[apart] + 16.0 * CLEARANCE).all()


def test_on_open_ground_all_drives_are_straight_and_the_roadmap_is_empty():
    boundary = ("fence", "boundary", box(-10.0, -10.0, 90.0, 90.0))
    trees = [(float(x), float(y)) for x, y in np.random.default_rng(1).uniform(0.0, 80.0, (20, 2))]
    for zones in ((), (boundary,)):
        site = planted([], lone=trees, zones=zones)
        roads = drives_on(site).roadmap([t.place for t in site.trees])
        assert roads.straight
        assert (len(roads.ways), len(roads.lengths), len(roads.at)) == (0, 0, 20)
        assert_near(over(roads), drives_on(site).lengths(roads.places), rel=1e-6, within=1e-12)
    pond = ("pond", "keep_out", Point(40.0, 40.0).buffer(3.0))
    site = planted([], lone=[t for t in trees if Point(t).distance(pond[2]) > 1.0], zones=[pond])
    assert not drives_on(site).roadmap([t.place for t in site.trees]).straight


def test_the_roadmap_of_few_places_or_none():
    drives = drives_on(upright(3, 5))
    none, one = drives.roadmap([]), drives.roadmap([drives.site.trees[4].place])
    assert (len(none.places), over(none).shape) == (0, (0, 0))
    assert over(one).tolist() == [[0.0]]


def test_places_without_a_path_between_them_are_named():
    wall = ("wall", "keep_out", box(-5.0, 9.0, 35.0, 9.4))
    fence = ("fence", "boundary", box(-5.0, -10.0, 35.0, 30.0))
    site = planted([], lone=[(3.0, 3.0), (20.0, 4.0), (20.0, 20.0)], zones=[wall, fence])
    with pytest.raises(DriveFault, match="no way from tree 1 to tree 3"):
        drives_on(site).roadmap([t.place for t in site.trees])


def test_the_size_of_the_roadmap_grows_with_the_places():
    ways = []
    for trees in (20, 40, 80):
        site = upright(6, trees)
        roads = drives_on(site).roadmap([t.place for t in site.trees])
        ways.append(len(roads.ways) / len(site.trees))
    assert max(ways) < 12.0


# --- visibility --------------------------------------------------------------------------------------------------


@st.composite
def holed(draw):
    """Draw ground with holes, a line along the middle of each, and points around them."""
    corner, turned = st.floats(5.0, 70.0), st.floats(0.0, 180.0)
    made = st.tuples(corner, corner, st.floats(0.5, 30.0), st.floats(0.5, 6.0), turned)
    holes, lines = [], []
    for x, y, w, h, turn in draw(st.lists(made, min_size=1, max_size=14)):
        holes.append(rotate(box(x, y, x + w, y + h), turn))
        middle = LineString([(x, y + h / 2.0), (x + w, y + h / 2.0)])
        lines.append(rotate(middle, turn, origin=box(x, y, x + w, y + h).centroid).coords)
    ground = box(0.0, 0.0, 100.0, 100.0).difference(shapely.union_all(holes))
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    return ground, np.array(lines), rng.uniform(-5.0, 105.0, (30, 2))


@settings(max_examples=60, deadline=None)
@given(holed())
def test_a_line_is_visible_if_the_ground_covers_it_and_no_near_row_separates_its_ends(world):
    ground, axes, at = world
    area = Area(ground)
    i, j = np.triu_indices(len(at), k=1)
    seen = area.sees(at[i], at[j])
    lines = [LineString(pair) for pair in np.stack([at[i], at[j]], axis=1)]
    assert seen.tolist() == [area.edged.covers(line) for line in lines]
    visibility = VisibilityGraph(ground, axes)
    kept = pairs_of(visibility.pairs(at))
    assert pairs_of([(i[seen], j[seen])]) <= kept <= pairs_of([(i, j)])
    to_others = {(a, b + 7) for a, b in pairs_of(visibility.pairs(at[:7], at[7:]))}
    assert to_others >= {(a, b) for a, b in zip(i[seen].tolist(), j[seen].tolist(), strict=True) if a < 7 <= b}


@settings(max_examples=60, deadline=None)
@given(holed())
def test_the_corners_linked_to_a_point_are_those_at_which_a_path_may_turn(world):
    ground, axes, at = world
    at = at[Area(ground).holds(at)]
    assume(len(at) > 1)
    visibility = VisibilityGraph(ground, axes)
    shortest = visibility.graph.lengths(visibility.links(at))
    everything = VisibilityGraph(ground, np.empty((0, 2, 2)))
    assert_near(shortest, everything.graph.lengths(everything.links(at)), within=1e-9)


@st.composite
def rows_on_ground(draw):
    """Draw obstacles around straight and bent rows, which may overlap, and the ground without them."""
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    obstacles = []
    for _ in range(draw(st.integers(0, 12))):
        along = np.cumsum(rng.uniform(4.0, 30.0, draw(st.integers(2, 4))))
        axis = LineString(np.column_stack([along, rng.uniform(-1.5, 1.5, len(along))]))
        placed = translate(rotate(axis, rng.uniform(0.0, 360.0)), *rng.uniform(-10.0, 90.0, 2))
        obstacles.append(RowObstacle(shapely.get_coordinates(placed), rng.uniform(0.01, 2.0)))
    taken = shapely.union_all([body.polygon for body in obstacles])
    return obstacles, box(0.0, 0.0, 100.0, 100.0), taken, rng


@settings(max_examples=60, deadline=None)
@given(rows_on_ground())
def test_a_line_crosses_a_row_if_it_meets_its_axis_or_one_of_its_ends(drawn):
    obstacles, outer, taken, rng = drawn
    ground = outer.difference(taken)
    rows = [LineString(line) for body in obstacles for line in body.barriers]
    barriers = shapely.multilinestrings(np.array([outer.buffer(TOUCH_M, join_style="mitre").exterior, *rows]))
    corners = shapely.get_coordinates(ground)
    at = np.concatenate([rng.uniform(0.0, 100.0, (40, 2)), corners])
    at = at[Area(ground).holds(at)]
    i, j = np.triu_indices(len(at), k=1)
    assert Area(ground, barriers).sees(at[i], at[j]).tolist() == Area(ground).sees(at[i], at[j]).tolist()


@settings(max_examples=examples(15, thorough=200), deadline=None)
@given(any_site)
def test_the_corners_that_see_each_other_are_those_between_which_the_ground_is_free(site):
    layout = drives_on(site).layout
    axes = [np.stack([body.axis[:-1], body.axis[1:]], axis=1) for body in layout.aisles.obstacles]
    by_edges = VisibilityGraph(layout.soft, np.concatenate([np.empty((0, 2, 2)), *axes]))
    assert [part.tolist() for part in layout.graph.ways(0)] == [part.tolist() for part in by_edges.graph.ways(0)]


def pairs_of(batches) -> set[tuple[int, int]]:
    return {(a, b) for one, two in batches for a, b in zip(one.tolist(), two.tolist(), strict=True)}


def test_the_axis_of_a_long_row_separates_points_on_both_sides():
    row = box(10.0, 49.0, 90.0, 51.0)
    ground = box(0.0, 0.0, 100.0, 100.0).difference(row)
    visibility = VisibilityGraph(ground, np.array([[(10.0, 50.0), (90.0, 50.0)]]))
    assert not pairs_of(visibility.pairs(np.array([(50.0, 20.0), (55.0, 80.0)])))


def test_a_marker_at_a_tree_keeps_its_position_in_any_order_of_queries():
    site = upright(3, 5, markers={"start": (6.0, 8.0)})
    tree = next(t.place for t in site.trees if t.place.xy == (6.0, 8.0))
    marker = site.markers["start"]
    for first, second in ((tree, marker), (marker, tree)):
        drives = drives_on(site)
        standing = {p.kind: p.stand for p in (*drives.stands([first]), *drives.stands([second]))}
        assert standing["marker"] == marker.xy
        assert standing["tree"] != tree.xy
    assert drives.problem(place_at(6.0, 8.0)) == ""
