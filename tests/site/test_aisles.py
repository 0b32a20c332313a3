"""Test drives among rows: along aisles and headlands, never through a tree line, a keep-out or the boundary."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from scipy.sparse.csgraph import dijkstra
from shapely.geometry import LineString, Point, box
from shapely.ops import unary_union

from fieldhand.errors import DriveFault
from fieldhand.site.drives import Drive, Drives
from fieldhand.site.model import Gate, Site
from fieldhand.site.planting import Planting
from support.sites.planted import generated, planted, upright
from support.sites.points import place_at, site_of

CLEARANCE, STANDOFF = 0.35, 1.5


def trees_of(site: Site, *ids: int):
    return [site.trees[k - 1].place for k in ids]


# --- independent check -------------------------------------------------------------------------------------------


def row_lines(site: Site) -> tuple[list[str], list[LineString]]:
    """Return the names of the rows and the lines of their trees, made once for a site."""
    if "lines of the rows" not in site.cache:
        rows = [row for row in site.planting.rows if len(row.trees) > 1]
        lines = [LineString(site.xy[row.trees]) for row in rows]
        site.cache["lines of the rows"] = ([row.name for row in rows], lines)
    return site.cache["lines of the rows"]


def wrong(site: Site, way: Drive) -> str:
    """Return the violations of a drive, checked against the site alone."""
    line = LineString(way.points)
    names, rows = row_lines(site)
    for k in np.flatnonzero(shapely.intersects(rows, line)):
        return f"through the trees of row {names[k]}"
    for zone in site.zones_of("keep_out"):
        if line.intersects(zone.polygon.buffer(-1e-4)):
            return f"through {zone.name}"
    boundaries = [z.polygon for z in site.zones_of("boundary")]
    if boundaries and not unary_union(boundaries).buffer(1e-4).covers(line):
        return "over the boundary"
    if abs(line.length - way.length_m) > 1e-6:
        return "not as long as it says"
    if (way.points[0], way.points[-1]) != (way.start.stand, way.end.stand):
        return "not from stand to stand"
    return ""


def drivable(site: Site, drives: Drives):
    places = [*(t.place for t in site.trees), *site.markers.values()]
    return [p for p in places if not drives.problem(p)]


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6))
@example(698)  # rows of single trees
def test_no_drive_crosses_a_tree_line_a_keep_out_or_the_boundary(seed):
    site = generated(seed)
    drives = Drives(site, CLEARANCE, STANDOFF)
    assume(not drives.problem(site.start))  # else nothing is known of what can be reached
    places = drivable(site, drives)
    assume(len(places) > 1)
    rng = np.random.default_rng(seed)
    for i, j in rng.integers(0, len(places), (12, 2)).tolist():
        way = drives.between(places[i], places[j])  # a place without a problem can be driven to
        assert wrong(site, way) == ""
        assert drives.between(way.end, way.start).points == way.points[::-1]


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6))
def test_lengths_equal_the_drives_and_form_a_metric(seed):
    site = generated(seed)
    drives = Drives(site, CLEARANCE, STANDOFF)
    assume(not drives.problem(site.start))
    places = drivable(site, drives)
    assume(len(places) > 2)
    rng = np.random.default_rng(seed)
    standing = drives.stands([places[k] for k in rng.permutation(len(places))[:8].tolist()])
    lengths = drives.lengths(standing)
    assert (lengths == lengths.T).all()
    assert (np.diag(lengths) == 0.0).all()
    for (i, a), (j, b) in itertools.combinations(enumerate(standing), 2):
        assert drives.between(a, b).length_m == pytest.approx(lengths[i, j], abs=1e-6)
    trees = [k for k, p in enumerate(standing) if p.kind == "tree"]
    inner = lengths[np.ix_(trees, trees)]
    for k in range(len(trees)):  # beside what stands in an aisle the clearance gives way a little
        assert (inner <= inner[:, [k]] + inner[[k], :] + 4.0 * CLEARANCE).all()


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6))
def test_a_tree_is_worked_on_from_beside_it_and_from_its_own_side_of_the_row(seed):
    site = generated(seed)
    drives = Drives(site, CLEARANCE, STANDOFF)
    lines = [LineString(site.xy[row.trees]) for row in site.planting.rows if len(row.trees) > 1]
    trees = [t.place for t in site.trees if not drives.problem(t.place)]
    for place, standing in zip(trees, drives.stands(trees), strict=True):
        away = math.dist(place.xy, standing.stand)
        assert away <= STANDOFF + 0.75 + 1e-6  # uneven rows: the clearance from the line counts for more
        reached = LineString([place.xy, standing.stand])
        touched = [line.intersection(reached) for line in lines if line.intersects(reached)]
        assert all(part.distance(Point(place.xy)) < 0.15 and part.length < 0.15 for part in touched)
        assert all(line.distance(Point(standing.stand)) >= CLEARANCE - 1e-6 for line in lines)


@pytest.mark.parametrize("seed", range(7))
def test_drives_are_about_as_short_as_a_grid_search(seed):
    site = generated(1000 + seed)
    drives = Drives(site, CLEARANCE, STANDOFF)
    trees = [t.place for t in site.trees if not drives.problem(t.place)]
    assert len(trees) > 1
    search = _Grid(site)
    rng = np.random.default_rng(seed)
    for i, j in rng.integers(0, len(trees), (3, 2)).tolist():
        one, two = drives.stands([trees[i], trees[j]])
        shortest = search.metres(one.stand, two.stand)
        length = drives.between(one, two).length_m
        assert 0.95 * shortest - 2.5 <= length  # the search's own steps are a little longer than straight lines
        assert length <= 1.15 * shortest + 12.0  # aisles are left by their mouths, block ends rounded in the large


class _Grid:
    """Return paths over a 16-connected grid of 0.5 m, clear of rows, keep-outs and the boundary."""

    def __init__(self, site: Site, cell: float = 0.5) -> None:
        near = 0.9 * CLEARANCE
        shapes = [LineString(site.xy[row.trees]).buffer(near) for row in site.planting.rows if len(row.trees) > 1]
        shapes += [z.polygon.buffer(near) for z in site.zones_of("keep_out")]
        if site.zones_of("boundary"):
            inside = unary_union([z.polygon for z in site.zones_of("boundary")]).buffer(-near)
            shapes.append(box(-500, -500, 1000, 500).difference(inside))
        self.blocked = unary_union(shapes)
        shapely.prepare(self.blocked)
        (west, south), (east, north) = site.xy.min(axis=0) - 12.0, site.xy.max(axis=0) + 12.0
        x, y = np.meshgrid(np.arange(west, east, cell), np.arange(south, north, cell), indexing="ij")
        self.xy = np.column_stack([x.ravel(), y.ravel()])
        self.graph = self._edges(*x.shape, cell)

    def _edges(self, columns: int, rows: int, cell: float):
        from scipy.sparse import csr_matrix

        index = np.arange(columns * rows).reshape(columns, rows)
        found = []
        for i, j in [(1, 0), (0, 1), (1, 1), (1, -1), (2, 1), (2, -1), (1, 2), (1, -2)]:
            one = index[: columns - i, max(0, -j) : rows - max(0, j)].ravel()
            two = index[i:, max(0, j) : rows - max(0, -j)].ravel()
            clear = ~shapely.intersects(
                self.blocked, shapely.linestrings(np.stack([self.xy[one], self.xy[two]], axis=1))
            )
            found.append((one[clear], two[clear], np.full(int(clear.sum()), cell * math.hypot(i, j))))
        one, two, length = (np.concatenate(part) for part in zip(*found, strict=True))
        return csr_matrix((length, (one, two)), shape=(len(self.xy), len(self.xy)))

    def metres(self, a, b) -> float:
        ends = []
        for at in (a, b):
            away = np.hypot(*(self.xy - at).T)
            near = np.flatnonzero(away < 1.2)
            lines = shapely.linestrings([[at, p] for p in self.xy[near]])
            near = near[~shapely.intersects(self.blocked, lines)]
            ends.append((near, away[near]))
        found = dijkstra(self.graph, directed=False, indices=ends[0][0])[:, ends[1][0]]
        return float((found + ends[0][1][:, None] + ends[1][1][None, :]).min())


# --- stands ------------------------------------------------------------------------------------------------------


def test_a_stand_is_at_the_standoff_straight_beside_the_tree():
    drives = Drives(upright(3, 5), CLEARANCE, STANDOFF)
    way = drives.between(*trees_of(drives.site, 6, 8))
    assert way.start.stand[1] == pytest.approx(0.0)
    assert abs(way.start.stand[0] - 6.0) == pytest.approx(STANDOFF)
    assert way.end.stand == pytest.approx((way.start.stand[0], 8.0))


def test_in_a_narrow_aisle_the_stand_is_in_its_middle():
    drives = Drives(upright(2, 5, across=2.0), CLEARANCE, STANDOFF)
    way = drives.between(*trees_of(drives.site, 2, 8))
    assert (way.start.stand[0], way.end.stand[0]) == pytest.approx((1.0, 1.0))


def test_along_one_aisle_a_drive_is_the_straight_line():
    drives = Drives(upright(4, 30), CLEARANCE, STANDOFF)
    way = drives.between(*trees_of(drives.site, 33, 85))
    assert len(way.points) == 2
    assert way.length_m == pytest.approx(math.dist(way.points[0], way.points[1]))
    assert way.length_m == pytest.approx(math.hypot(22 * 4.0, 3.0))


def test_the_path_to_the_other_side_of_a_row_leads_around_its_end():
    site = upright(3, 21)
    drives = Drives(site, CLEARANCE, STANDOFF)
    west = replace(site.trees[30].place, stand=(4.5, 36.0))  # the tenth tree of the middle row, from its west
    east = replace(site.trees[30].place, stand=(7.5, 36.0))
    way = drives.between(west, east)
    # down 36 m, around the end of the row at the clearance on either side, and back up
    assert way.length_m == pytest.approx(2 * math.hypot(1.5 - CLEARANCE, 37.5) + 2 * CLEARANCE)
    assert wrong(site, way) == ""


def test_no_drive_passes_through_a_gap_of_missing_trees():
    rows = [[(6.0 * r, 4.0 * k) for k in range(12) if r != 1 or k not in (4, 5, 6, 7)] for r in range(3)]
    site = planted([(0.0, rows)])
    drives = Drives(site, CLEARANCE, STANDOFF)
    way = drives.between(place_at(3.0, 22.0), place_at(9.0, 22.0))
    assert wrong(site, way) == ""
    assert way.length_m > 40.0


def test_the_trees_of_neighbouring_rows_share_the_aisle_between_them():
    site = upright(6, 5)
    drives = Drives(site, CLEARANCE, STANDOFF)
    standing = drives.stands([t.place for t in site.trees[5:25]], place_at(0.0, -5.0))  # rows 2 to 5
    aisles = {round((p.stand[0] - 3.0) / 6.0) for p in standing}
    assert aisles == {1, 3}  # between rows 2 and 3, and between rows 4 and 5


def test_the_nearest_of_equally_few_aisles_are_chosen_and_existing_stands_are_kept():
    site = upright(5, 5)
    drives = Drives(site, CLEARANCE, STANDOFF)
    third = [t.place for t in site.trees[10:15]]
    for x, side in ((-20.0, -1.5), (50.0, 1.5)):
        assert {p.stand[0] for p in drives.stands(third, place_at(x, 8.0))} == {12.0 + side}
    given_ = replace(third[0], stand=(13.5, 0.0))
    standing = drives.stands([given_, *third[1:]], place_at(-20.0, 8.0))
    assert {p.stand[0] for p in standing} == {13.5}  # the robot is in that aisle anyway


def test_a_drive_from_a_place_with_a_stand_starts_there():
    site = upright(3, 9)
    drives = Drives(site, CLEARANCE, STANDOFF)
    there = drives.between(site.trees[0].place, site.trees[13].place)
    onward = drives.between(there.end, site.trees[22].place)
    assert onward.points[0] == there.points[-1]


def test_a_tree_in_no_row_is_approached_from_its_open_side():
    site = upright(2, 5, lone=[(30.0, 8.0), (30.0, 10.0)])
    drives = Drives(site, CLEARANCE, STANDOFF)
    stand = drives.stands([site.trees[-1].place])[0].stand
    assert stand == pytest.approx((30.0, 10.0 + STANDOFF))
    zone = ("shed", "keep_out", box(28, 11, 32, 14))
    blocked = Drives(replace_zones(site, [zone]), CLEARANCE, STANDOFF)
    at = blocked.stands([site.trees[-1].place])[0].stand
    assert math.dist(at, (30.0, 10.0)) == pytest.approx(STANDOFF)
    assert box(28, 11, 32, 14).distance(Point(at)) >= CLEARANCE


def replace_zones(site: Site, zones) -> Site:
    other = replace(site, zones=site_of([(0, 0)], zones=zones).zones)
    other.__dict__["planting"] = site.planting
    return other


def test_without_rows_the_stand_of_a_tree_is_its_own_position():
    site = planted([], lone=[(0.0, 0.0), (3.0, 4.0)])
    way = Drives(site, CLEARANCE, STANDOFF).between(site.trees[0].place, site.trees[1].place)
    assert way.points == ((0.0, 0.0), (3.0, 4.0))
    assert (way.start.stand, way.end.stand) == ((0.0, 0.0), (3.0, 4.0))


# --- unreachable places ------------------------------------------------------------------------------------------


def test_unreachable_trees_are_named_with_the_reason():
    narrow = upright(4, 5, across=0.5)
    says = Drives(narrow, CLEARANCE, STANDOFF).problem(narrow.trees[7].place)
    assert says == "out of reach: the aisles beside it are 0.5 m wide, the robot is 0.7 m"
    fence = ("fence", "boundary", box(-5, -10, 35, 50))
    walls = [("pond", "keep_out", box(-5, 20, 35, 22)), ("wire", "keep_out", box(-5, 30, 35, 30.1))]
    site = upright(6, 11, zones=[fence, *walls], markers={"start": (0.0, -6.0)})
    drives = Drives(site, CLEARANCE, STANDOFF)
    assert drives.problem(site.trees[3 * 11].place) == ""
    shut_in = site.trees[3 * 11 + 6].place  # at y = 24, between the two
    assert drives.problem(shut_in) == (
        "out of reach: no way out of its aisle: keep-out 'pond' closes one end and keep-out 'wire' the other"
    )
    with pytest.raises(DriveFault, match=r"tree 40 .*closes one end"):
        drives.between(site.start, shut_in)
    outside = Drives(upright(3, 5, zones=[("fence", "boundary", box(-5, -5, 17, 10))]), CLEARANCE, STANDOFF)
    assert outside.problem(outside.site.trees[4].place) == "outside the boundary"


def test_a_pond_in_the_block_is_driven_around_by_other_aisles():
    pond = Point(9.0, 40.0).buffer(5.0)
    site = upright(6, 21, zones=[("pond", "keep_out", pond)])
    drives = Drives(site, CLEARANCE, STANDOFF)
    one = replace(site.trees[0].place, stand=(9.0, 20.0))
    two = replace(site.trees[0].place, stand=(9.0, 60.0))
    way = drives.between(one, two)
    assert wrong(site, way) == ""
    assert way.length_m > 80.0


# --- fences and gates --------------------------------------------------------------------------------------------

WEST, EAST = box(0, 0, 50, 40), box(50, 0, 100, 40)


def fenced(*gates: tuple[float, float, float], west=WEST, east=EAST) -> Drives:
    site = site_of([(10, 20), (90, 20)], zones=[("west", "boundary", west), ("east", "boundary", east)])
    found = tuple(
        Gate(place=place_at(x, y, id=f"gate {k + 1}"), width_m=width) for k, (x, y, width) in enumerate(gates)
    )
    site = replace(site, gates=found)
    site.__dict__["planting"] = Planting(blocks=(), tree_count=2)
    return Drives(site, CLEARANCE, STANDOFF)


def test_a_fence_between_two_parts_is_crossed_only_at_its_gate():
    drives = fenced((50.0, 35.0, 3.0))
    way = drives.between(drives.site.trees[0].place, drives.site.trees[1].place)
    crossing = LineString(way.points).intersection(LineString([(50, 0), (50, 40)]))
    assert 33.5 + CLEARANCE <= crossing.y <= 36.5 - CLEARANCE
    assert way.length_m == pytest.approx(2 * math.hypot(40.0, 13.85), abs=0.1)


@pytest.mark.parametrize("gates", [(), ((50.0, 35.0, 0.6),)])
def test_a_fence_without_a_wide_enough_gate_is_not_crossed(gates):
    drives = fenced(*gates)
    with pytest.raises(DriveFault, match="no way"):
        drives.between(drives.site.trees[0].place, drives.site.trees[1].place)


def test_overlapping_boundaries_merge_and_a_gate_bridges_a_small_gap():
    overlapping = fenced(east=box(45, 0, 100, 40))
    a, b = (t.place for t in overlapping.site.trees)
    assert overlapping.between(a, b).length_m == pytest.approx(80.0)
    apart = fenced((50.2, 20.0, 4.0), east=box(50.4, 0, 100, 40))
    assert apart.between(a, b).length_m == pytest.approx(80.0)
    with pytest.raises(DriveFault):
        fenced(east=box(50.4, 0, 100, 40)).between(a, b)


# --- the network -------------------------------------------------------------------------------------------------


def test_the_network_names_aisles_headlands_gates_and_links():
    two = [
        (0.0, [[(6.0 * r, 4.0 * k) for k in range(8)] for r in range(4)]),
        (90.0, [[(40.0 + 4.0 * k, 30.0 - 6.0 * r) for k in range(8)] for r in range(3)]),
    ]
    fence = ("fence", "boundary", box(-10, -10, 90, 50))
    site = planted(two, zones=[fence])
    site = replace(site, gates=(Gate(place=place_at(90.0, 20.0, id="east gate"), width_m=4.0),))
    site.__dict__["planting"] = planted(two).planting
    network = Drives(site, CLEARANCE, STANDOFF).network()
    assert {line.name for line in network.of("aisle")} == {
        *(f"aisle between rows {k} and {k + 1} of block A" for k in (1, 2, 3)),
        *(f"aisle between rows {k} and {k + 1} of block B" for k in (1, 2)),
    }
    assert {line.name for line in network.of("headland")} == {
        *("north headland of block A", "south headland of block A"),
        *("east headland of block B", "west headland of block B"),
    }
    (gate,) = network.of("gate")
    assert (gate.name, gate.length_m) == ("gate east gate", pytest.approx(4.0))
    assert {round(x, 6) for x, _ in gate.points} == {90.0}
    everything = unary_union([LineString(line.points).buffer(1e-3) for line in network.lines if line.kind != "gate"])
    assert everything.geom_type == "Polygon"  # all of it hangs together
    for line in network.of("aisle"):
        assert line.length_m > 28.0
        assert all(not LineString(line.points).intersects(LineString(site.xy[r.trees])) for r in site.planting.rows)


def test_a_site_without_rows_has_no_aisles_to_draw():
    drives = Drives(planted([], lone=[(0.0, 0.0), (9.0, 0.0)]), CLEARANCE, STANDOFF)
    assert drives.network().lines == ()


# --- irregular rows ----------------------------------------------------------------------------------------------


def test_named_rows_that_cross_each_other_form_separate_groups():
    crossing = [[(0.0, 0.0), (30.0, 30.0)], [(0.0, 30.0), (30.0, 0.0)], [(40.0, 0.0), (40.0, 30.0)]]
    site = planted([(0.0, crossing)])
    drives = Drives(site, CLEARANCE, STANDOFF)
    way = drives.between(place_at(15.0, 2.0), place_at(15.0, 28.0))
    assert wrong(site, way) == ""
    assert way.length_m > 26.0


def test_a_single_row_is_driven_around_at_its_ends():
    site = planted([(90.0, [[(4.0 * k, 0.0) for k in range(11)]])])
    drives = Drives(site, CLEARANCE, STANDOFF)
    way = drives.between(place_at(30.0, 5.0), place_at(30.0, -5.0))
    assert wrong(site, way) == ""
    assert way.length_m == pytest.approx(2 * math.hypot(11.5, 4.65) + 0.7, abs=0.3)
