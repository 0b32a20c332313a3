"""Files for Nav2: no free cell on forbidden ground, drives on free cells, and a graph whose ways are the drives."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
import pytest
import shapely
import yaml
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.ndimage import distance_transform_edt, label
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components, dijkstra

from fieldhand.errors import DriveFault, InputError
from fieldhand.exchange.nav2 import MapOptions, Nav2Files, export_nav2
from fieldhand.exchange.nav2.approved_path import MOST_POSES
from fieldhand.exchange.nav2.grid import MOST_CELLS, MapGrid
from fieldhand.exchange.nav2.maps import slower_percent
from fieldhand.exchange.routes.route import planned
from fieldhand.forecast.closed_ground import closed_ground
from fieldhand.forecast.slow_ground import slow_ground
from fieldhand.forecast.visit_order import drives_for
from fieldhand.places.selectors import Rows, TreeIs
from fieldhand.robot.bindings import Datum
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import load_demo, site_files, site_of
from fieldhand.site.model import Site
from fieldhand.task.frames import Constraints, Task
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.ways import Avoid, SlowNear
from support.examples import examples
from support.missions.rig import task_for
from support.nav2_files import (
    FREE,
    OCCUPIED,
    Graph,
    OccupancyGrid,
    on_earth,
    on_map,
    read_graph,
    read_map,
    speed_limit,
)
from support.sites.planted import generated, scattered
from support.sites.points import site_of as site_at

ROBOT = load_robot("husky")
PLAN = ForEach(select=Rows(first="4", last="4"), body=Act(action="read_co2"))


def built_in(name: str) -> Site:
    return site_of(site_files(name))


def datum_of(site: Site, heading: float = 90.0, east: float = 0.0, north: float = 0.0) -> Datum:
    lat, lon = site.projection.degrees([[east, north]])[0].tolist()
    return Datum(lat=lat, lon=lon, heading_deg=heading)


def exported(site: Site, task: Task | None = None, **options: object) -> Nav2Files:
    given_options = {"datum": datum_of(site, 70.0, 30.0, -20.0), "resolution_m": 0.1} | options
    return export_nav2(site, ROBOT, task, MapOptions(**given_options))  # type: ignore[arg-type]


@lru_cache(maxsize=8)
def demo(name: str = "demo") -> tuple[Site, Nav2Files]:
    site = built_in(name)
    return site, exported(site)


def clearance_m(grid: OccupancyGrid) -> np.ndarray:
    """Metres from the centre of each cell to the centre of the nearest occupied one, as Nav2 inflates them."""
    return np.asarray(distance_transform_edt(grid.data != OCCUPIED)) * grid.resolution


def along(a: tuple[float, float], b: tuple[float, float], step: float) -> list[tuple[float, float]]:
    steps = max(1, math.ceil(math.dist(a, b) / step))
    return [(a[0] + (b[0] - a[0]) * k / steps, a[1] + (b[1] - a[1]) * k / steps) for k in range(steps + 1)]


def forbidden(site: Site) -> shapely.Geometry:
    """Ground that no robot may be on, in metres of the site."""
    keep_outs = shapely.union_all([zone.polygon for zone in site.zones_of("keep_out")])
    boundaries = [zone.polygon for zone in site.zones_of("boundary")]
    if not boundaries:
        return keep_outs
    inside = shapely.union_all([*boundaries, *(shapely.Point(g.place.xy).buffer(g.width_m / 2) for g in site.gates)])
    return shapely.union_all([keep_outs, shapely.box(-900, -900, 900, 900).difference(inside)])


def assert_free_cells_are_allowed(site: Site, found: Nav2Files, ground: shapely.Geometry, name: str, seed: int) -> None:
    """No free cell has a part on some ground: random ones, and random ones beside occupied cells."""
    grid = read_map(found.files, name)
    assert set(np.unique(grid.data).tolist()) <= {FREE, OCCUPIED}
    rng = np.random.default_rng(seed)
    inner = np.argwhere(grid.data == FREE)
    beside = np.argwhere((grid.data == FREE) & (clearance_m(grid) < 1.5 * grid.resolution))
    chosen = [cells[rng.integers(0, len(cells), 150)] for cells in (inner, beside) if len(cells)]
    for row, column in np.concatenate(chosen).tolist():
        corners = on_earth(found.datum, grid.corners(row, column))
        cell = shapely.Polygon(site.projection.metres(*np.array(corners).T))
        assert cell.intersection(ground).area < 1e-5, (row, column)


def reached(site: Site) -> list:
    """The places that the robot can reach, each with a stand; none if it cannot be at the start."""
    drives = drives_for(site, ROBOT)
    if drives.problem(site.start):
        return []
    places = [*site.markers.values(), *(tree.place for tree in site.trees)]
    places = [place for place, problem in zip(places, drives.problems(places), strict=True) if not problem]
    return [p for p in drives.stands(places) if drives.layout.spot(p.stand).spur == 0.0]


def assert_drives_are_free(site: Site, found: Nav2Files, seed: int, *, count: int) -> None:
    """The robot's width is free along drives between random places, but for the size of a cell.

    Drives lead over trees in no row, which the map shows.
    """
    grid = read_map(found.files, "map.yaml")
    clear = clearance_m(grid)
    alone = [tree.place for tree in site.trees if site.planting.row_of[tree.index] < 0 and site.planting.rows]
    lone = shapely.MultiPoint(on_map(found.datum, [(place.lat, place.lon) for place in alone]))
    shapely.prepare(around := lone.buffer(ROBOT.width_m / 2.0 + grid.resolution))
    drives, places = drives_for(site, ROBOT), reached(site)
    rng = np.random.default_rng(seed)
    for _ in range(count if len(places) > 1 else 0):
        a, b = (places[k] for k in rng.choice(len(places), 2, replace=False))
        try:
            drive = drives.between(a, b)
        except DriveFault:
            continue  # on another part of the ground
        corners = on_map(found.datum, site.projection.lat_lon(drive.points))
        for one, two in pairwise(corners):
            for x, y in along(one, two, grid.resolution):
                if not around.intersects(shapely.Point(x, y)):
                    assert clear[grid.cell(x, y)] >= found.clear_m - 0.02, (a.id, b.id)


def matrix_of(graph: Graph) -> csr_matrix:
    number = {node: k for k, node in enumerate(graph.nodes)}
    one = [number[start] for start, _, _ in graph.edges.values()]
    two = [number[end] for _, end, _ in graph.edges.values()]
    metres = [max(1e-9, math.dist(a, b)) for a, b, _ in graph.ways()]
    return csr_matrix((metres, (one, two)), shape=(len(number), len(number)))


@pytest.mark.parametrize("name", ["demo", "vineyard"])
def test_no_free_cell_lies_on_forbidden_ground(name: str) -> None:
    site, found = demo(name)
    for mask in ("map.yaml", "keepout.yaml"):
        assert_free_cells_are_allowed(site, found, forbidden(site), mask, 1)


@pytest.mark.parametrize("name", ["demo", "vineyard"])
def test_every_drive_lies_on_cells_that_the_robot_fits_on(name: str) -> None:
    site, found = demo(name)
    assert_drives_are_free(site, found, 2, count=60)


@given(st.integers(0, 10_000), st.booleans(), st.floats(0.0, 360.0))
@settings(max_examples=examples(8, thorough=150))
def test_any_site_is_mapped_so_that_its_drives_are_free_and_its_keep_outs_are_not(seed, rows, heading) -> None:
    site = generated(seed) if rows else scattered(seed)
    try:
        found = exported(site, datum=datum_of(site, heading, 40.0, 70.0))
    except InputError as error:
        assume("fewer than two places" not in str(error))
        raise
    assert_free_cells_are_allowed(site, found, forbidden(site), "map.yaml", seed)
    assert_drives_are_free(site, found, seed, count=10)
    assert_graph_is_the_network(site, found)


@pytest.mark.parametrize("name", ["demo", "vineyard"])
def test_no_robot_passes_between_the_trees_of_a_row(name: str) -> None:
    site, found = demo(name)
    grid = read_map(found.files, "map.yaml")
    for row in site.planting.rows[::5]:
        at = on_map(found.datum, [(site.trees[k].place.lat, site.trees[k].place.lon) for k in row.trees])
        assert all(grid.at(x, y) == OCCUPIED for a, b in pairwise(at) for x, y in along(a, b, 0.05))
        # On the ground beside the row alone, no cell on one side has a neighbour on the other, not even diagonally.
        line = shapely.LineString(at)
        strip = line.buffer(0.8, cap_style="flat")
        rows, columns = np.indices(grid.data.shape)
        xs, ys = grid.x + (columns + 0.5) * grid.resolution, grid.y + (rows + 0.5) * grid.resolution
        inside = shapely.contains_xy(strip, xs, ys) & (grid.data == FREE)
        parts, _ = label(inside, structure=np.ones((3, 3)))
        left = shapely.contains_xy(line.buffer(0.8, single_sided=True, cap_style="flat"), xs, ys) & inside
        sides = set(np.unique(parts[left])), set(np.unique(parts[inside & ~left]))
        assert sides[0]
        assert sides[1]
        assert not sides[0] & sides[1]


def test_a_fence_is_open_only_at_its_gate() -> None:
    site, found = demo("vineyard")
    grid = read_map(found.files, "map.yaml")
    (gate,) = site.gates
    ((x, y),) = on_map(found.datum, [(gate.place.lat, gate.place.lon)])
    (inside,) = (zone for zone in site.zones if zone.name == "meadow")
    middle = inside.polygon.representative_point()
    ends = on_map(found.datum, site.projection.lat_lon([(middle.x, middle.y), site.start.xy]))

    def joined(data: np.ndarray) -> bool:
        parts, _ = label(data == FREE, structure=np.ones((3, 3)))
        one, two = (parts[grid.cell(*end)] for end in ends)
        assert one
        assert two
        return bool(one == two)

    assert joined(grid.data)
    shut = grid.data.copy()
    row, column = grid.cell(x, y)
    around = math.ceil((gate.width_m / 2.0 + 0.5) / grid.resolution)
    shut[row - around : row + around + 1, column - around : column + around + 1] = OCCUPIED
    assert not joined(shut)


def assert_graph_is_the_network(site: Site, found: Nav2Files) -> None:
    """Nodes and edges are clear; what a drive connects, the graph connects, and by a way as short."""
    graph, grid = read_graph(found.files["route.geojson"]), read_map(found.files, "map.yaml")
    drives, clear = drives_for(site, ROBOT), clearance_m(grid)
    both = {(start, end) for start, end, _ in graph.edges.values()}
    assert both == {(end, start) for start, end in both}
    assert len(both) == len(graph.edges)
    at = {node: site.projection.metres(*on_earth(found.datum, [xy])[0])[0] for node, xy in graph.nodes.items()}
    for node, (x, y) in at.items():
        assert drives.layout.are_free(np.array([[x, y]]))[0], node
    off = {
        n
        for n, (x, y) in at.items()
        if not drives.layout.visibility.area.edged.buffer(0.01).covers(shapely.Point(x, y))
    }
    for start, end, _ in graph.edges.values():
        if start in off or end in off:
            continue  # a place nearer to an obstacle than half the robot's width
        for x, y in along(graph.nodes[start], graph.nodes[end], grid.resolution):
            assert clear[grid.cell(x, y)] >= found.clear_m - 0.02, (start, end)
    places = reached(site)
    if not places:
        return
    stands = on_map(found.datum, site.projection.lat_lon([p.stand for p in places]))
    numbers = list(graph.nodes)
    xy = np.array([graph.nodes[n] for n in numbers])
    node = [int(np.argmin(np.hypot(*(xy - stand).T))) for stand in stands]
    for place, stand, k in zip(places, stands, node, strict=True):
        assert math.dist(stand, xy[k]) < 0.01, place.id
        assert place.id in graph.places[numbers[k]]
    matrix = matrix_of(graph)
    _, part = connected_components(matrix, directed=True, connection="strong")
    chosen = list(range(len(places)))[:: max(1, len(places) // 25)]
    lengths = drives.point_lengths([places[k].stand for k in chosen])
    routes = dijkstra(matrix, indices=[node[k] for k in chosen])[:, [node[k] for k in chosen]]
    assert (np.isfinite(lengths) == np.isfinite(routes)).all()
    assert ((part[[node[k] for k in chosen]][:, None] == part[[node[k] for k in chosen]]) == np.isfinite(lengths)).all()
    some = np.isfinite(lengths)
    # Nodes are written to the millimetre.
    assert (routes[some] >= lengths[some] - 0.02).all()
    # A stand in an aisle is joined to the aisle and to the corners that it sees, not to every place beyond.
    assert (routes[some] <= 1.2 * lengths[some] + 8.0).all()


@pytest.mark.parametrize("name", ["demo", "vineyard"])
def test_the_routes_are_the_drives(name: str) -> None:
    site, found = demo(name)
    assert_graph_is_the_network(site, found)
    graph, drives = read_graph(found.files["route.geojson"]), drives_for(site, ROBOT)
    assert graph.frames == {"map"}
    trees = [tree.place for tree in site.trees][:: 1 + len(site.trees) // 40]
    numbers = list(graph.nodes)
    xy = np.array(list(graph.nodes.values()))
    stands = on_map(found.datum, site.projection.lat_lon([p.stand for p in drives.stands(trees)]))
    node = [int(np.argmin(np.hypot(*(xy - stand).T))) for stand in stands]
    lengths = drives.lengths(drives.stands(trees))
    routes = dijkstra(matrix_of(graph), indices=node)[:, node]
    longer = (routes - lengths)[lengths > 1.0] / lengths[lengths > 1.0]
    assert np.median(longer) < 0.005
    assert longer.max() < 0.03
    assert len(numbers) == found.nodes
    assert len(graph.edges) == found.edges


def test_a_graph_of_corners_alone_connects_the_markers_as_well() -> None:
    site = built_in("demo")
    found = exported(site, at_trees=False)
    graph = read_graph(found.files["route.geojson"])
    named = {place: node for node, places in graph.places.items() for place in places}
    assert set(named) == {"start", "end", "charger"}
    numbers = list(graph.nodes)
    chosen = [numbers.index(named[name]) for name in ("start", "end")]
    route = dijkstra(matrix_of(graph), indices=chosen[:1])[0, chosen[1]]
    assert route == pytest.approx(drives_for(site, ROBOT).between(site.start, site.markers["end"]).length_m, abs=0.1)


def test_edges_carry_what_the_plugins_of_the_route_server_read() -> None:
    site, found = demo()
    graph = read_graph(found.files["route.geojson"])
    aisles = set()
    for _, _, metadata in graph.ways():
        # The loader keeps the type of a number, and the plugins read a float.
        assert isinstance(metadata["speed_limit"], float)
        assert isinstance(metadata["abs_speed_limit"], float)
        assert (metadata["speed_limit"], metadata["abs_speed_limit"]) == (100.0, ROBOT.speed_m_s)
        aisles |= {metadata.get("aisle")}
    assert b'"speed_limit": 100.0' in found.files["route.geojson"]
    assert {None, "aisle between rows 3 and 4"} < aisles
    assert len(aisles) == len(site.planting.rows)


@given(st.floats(0.0, 360.0), st.floats(-1000.0, 1000.0), st.floats(-1000.0, 1000.0))
@settings(max_examples=examples(4, thorough=40))
def test_coordinates_are_those_of_the_datum(heading: float, east: float, north: float) -> None:
    site = built_in("demo")
    found = exported(site, datum=datum_of(site, heading, east, north), resolution_m=0.5)
    graph, grid = read_graph(found.files["route.geojson"]), read_map(found.files, "map.yaml")
    start = next(node for node, places in graph.places.items() if "start" in places)
    ((x, y),) = on_map(found.datum, site.projection.lat_lon([drives_for(site, ROBOT).stands((site.start,))[0].stand]))
    assert math.dist(graph.nodes[start], (x, y)) < 0.01
    for tree in site.trees[::20]:
        ((x, y),) = on_map(found.datum, [(tree.place.lat, tree.place.lon)])
        assert grid.at(x, y) == OCCUPIED


@pytest.mark.parametrize("name", ["demo", "vineyard"])
def test_the_same_site_gives_the_same_bytes(name: str) -> None:
    assert dict(exported(built_in(name)).files) == dict(demo(name)[1].files)


def limited(*, avoid: tuple[Avoid, ...] = (), slow: tuple[SlowNear, ...] = ()) -> Task:
    return task_for(PLAN, constraints=Constraints(avoid=avoid, slow=slow))


def test_a_mask_keeps_out_of_what_the_mission_avoids() -> None:
    site = built_in("demo")
    task = limited(avoid=(Avoid(places=Rows(first="9", last="9")), Avoid(places=TreeIs(tree="1"), distance_m=3.0)))
    found = exported(site, task)
    closed = shapely.union_all([one.shape for one in closed_ground(task.constraints, drives_for(site, ROBOT))])
    assert_free_cells_are_allowed(site, found, closed, "keepout.yaml", 3)
    plain, masked = (read_map(found.files, name).data for name in ("map.yaml", "keepout.yaml"))
    assert (masked >= plain).all()
    assert 0.9 < ((masked - plain) > 0).sum() * 0.01 / closed.difference(forbidden(site)).area < 1.1
    assert found.files["map.pgm"] == demo()[1].files["map.pgm"]
    at = [
        xy for node in read_graph(found.files["route.geojson"]).nodes.values() for xy in on_earth(found.datum, [node])
    ]
    points = shapely.points(site.projection.metres(*np.array(at).T))
    assert float(shapely.distance(closed, points).min()) >= ROBOT.width_m / 2 - 0.01


def test_a_mask_and_the_graph_limit_the_speed_where_the_mission_is_slow() -> None:
    site = built_in("demo")
    task = limited(
        slow=(
            SlowNear(places=TreeIs(tree="45"), distance_m=6.0, speed_m_s=0.33),
            SlowNear(places=TreeIs(tree="46"), distance_m=3.0, speed_m_s=0.2),
        )
    )
    found = exported(site, task)
    grid = read_map(found.files, "speed.yaml")
    info = yaml.safe_load(found.files["nav2_params.yaml"])["speed_costmap_filter_info_server"]["ros__parameters"]
    assert info["type"] == 2
    slow = slow_ground(task.constraints, site, ROBOT)
    rng = np.random.default_rng(5)
    seen = set()
    for x, y in rng.uniform(site.xy.min(axis=0), site.xy.max(axis=0), (4000, 2)).tolist():
        limits = [speed for shape, speed in slow.grounds if shape.covers(shapely.Point(x, y))]
        around = [speed for shape, speed in slow.grounds if shape.distance(shapely.Point(x, y)) < 0.8]
        ((map_x, map_y),) = on_map(found.datum, site.projection.lat_lon([(x, y)]))
        limit = speed_limit(grid.at(map_x, map_y), info)
        if limits:
            assert min(around) - 0.0101 * ROBOT.speed_m_s <= limit <= min(limits) + 1e-9
            seen.add(min(limits))
        elif not around:
            assert limit == math.inf
    assert seen == {0.33, 0.2}
    # Nav2's own launch files read the same mask as a percentage of the controller's speed.
    percent = {"base": 100.0, "multiplier": -1.0}
    for value in np.unique(grid.data).tolist():
        assert speed_limit(value, percent) / 100.0 * ROBOT.speed_m_s == pytest.approx(speed_limit(value, info))
    graph = read_graph(found.files["route.geojson"])
    for a, b, metadata in graph.ways():
        ends = site.projection.metres(*np.array(on_earth(found.datum, [a, b])).T)
        parts = slow.parts([tuple(end) for end in ends.tolist()])
        long = sum(part.to_m - part.from_m for part in parts if part.speed_m_s < metadata["abs_speed_limit"] - 1e-9)
        assert long < 1.1, "only the half metres before and behind slow ground"
        assert metadata["speed_limit"] == pytest.approx(100.0 * metadata["abs_speed_limit"] / ROBOT.speed_m_s)
    assert {metadata["abs_speed_limit"] for _, _, metadata in graph.ways()} == {1.0, 0.33, 0.2}


@given(st.floats(0.001, 3.0), st.floats(0.1, 3.0))
def test_a_limit_in_percent_is_never_faster_and_hardly_slower(limit: float, speed: float) -> None:
    value = slower_percent(limit, speed)
    assert 0 <= value <= 99
    kept = (100 - value) / 100.0 * speed
    assert kept <= max(limit, 0.01 * speed) + 1e-6
    assert kept > min(limit, speed) - 0.0101 * speed


def test_the_path_of_a_mission_is_its_planned_route() -> None:
    site = built_in("demo")
    task = limited(slow=())
    found = exported(site, task)
    path = yaml.safe_load(found.files["path.yaml"])
    assert path["header"] == {"frame_id": "map"}
    at = [(pose["pose"]["position"]["x"], pose["pose"]["position"]["y"]) for pose in path["poses"]]
    route = planned(task, site, ROBOT)
    steps = [math.dist(a, b) for a, b in pairwise(at)]
    assert max(steps) <= 0.2511
    assert sum(steps) == pytest.approx(route.stops[-1].travelled_m, rel=0.001)
    for stop in route.stops:
        ((x, y),) = on_map(found.datum, [stop.stand])
        assert min(math.dist((x, y), pose) for pose in at) < 0.01
    stands = {tuple(on_map(found.datum, [stop.stand])[0]): stop.heading_deg for stop in route.stops}
    met = 0
    for (a, b), pose in zip(pairwise(at), path["poses"][1:], strict=True):
        turn = pose["pose"]["orientation"]
        assert math.hypot(turn["z"], turn["w"]) == pytest.approx(1.0, abs=1e-5)
        yaw = 2.0 * math.atan2(turn["z"], turn["w"])
        stand = next((heading for there, heading in stands.items() if math.dist(there, b) < 0.01), None)
        if stand is not None:  # as the robot stands there, which is along the aisle
            met += 1
            assert math.cos(yaw - math.radians(found.datum.heading_deg - stand)) > 0.999
        elif math.dist(a, b) > 0.05:
            assert math.cos(yaw - math.atan2(b[1] - a[1], b[0] - a[0])) > 0.999
    assert met >= len(stands)
    grid = read_map(found.files, "keepout.yaml")
    assert all(grid.at(x, y) == FREE for x, y in at)
    assert "path.yaml" not in demo()[1].files


def test_parameters_name_the_files_and_the_same_topics_on_both_sides() -> None:
    _, found = demo()
    nodes = yaml.safe_load(found.files["nav2_params.yaml"])
    of = {name: node["ros__parameters"] for name, node in nodes.items() if "ros__parameters" in node}
    named = {
        parameters[key]
        for parameters in of.values()
        for key in ("yaml_filename", "graph_filepath")
        if key in parameters
    }
    assert named == {"map.yaml", "keepout.yaml", "speed.yaml", "route.geojson"}
    assert named <= set(found.files)
    costmap = nodes["global_costmap"]["global_costmap"]["ros__parameters"]
    for mask in ("keepout", "speed"):
        info, server = of[f"{mask}_costmap_filter_info_server"], of[f"{mask}_filter_mask_server"]
        assert info["mask_topic"] == server["topic_name"]
        assert costmap[f"{mask}_filter"]["filter_info_topic"] == info["filter_info_topic"]
        assert {f"{mask}_filter_mask_server", f"{mask}_costmap_filter_info_server"} <= set(
            of["lifecycle_manager_filters"]["node_names"]
        )
    assert (
        of["keepout_costmap_filter_info_server"]["base"],
        of["keepout_costmap_filter_info_server"]["multiplier"],
    ) == (0, 1)
    # Fieldhand limits the speed of a husky itself, on the topic that the filter would reset.
    assert costmap["speed_filter"]["enabled"] is False
    unlimited = replace(ROBOT, ros2=replace(ROBOT.ros2, navigation=replace(ROBOT.ros2.navigation, speed_limit="")))
    site = built_in("demo")
    other = export_nav2(site, unlimited, None, MapOptions(datum=datum_of(site), resolution_m=0.5))
    assert yaml.safe_load(other.files["nav2_params.yaml"])["global_costmap"]["global_costmap"]["ros__parameters"][
        "speed_filter"
    ]["enabled"]


HOSTILE = 'x"], "features": [] }\n---\nimage: /etc/passwd # \u202e\x07 \\ %{}'


def test_hostile_names_stay_text() -> None:
    site = replace(load_demo(), name=HOSTILE)
    robot = replace(ROBOT, ros2=replace(ROBOT.ros2, navigation=replace(ROBOT.ros2.navigation, frame="m'ap: {")))
    found = export_nav2(site, robot, limited(), MapOptions(datum=datum_of(site), resolution_m=0.5))
    assert json.loads(found.files["route.geojson"])["name"] == HOSTILE
    assert found.files["route.geojson"].isascii()
    assert read_graph(found.files["route.geojson"]).frames == {"m'ap: {"}
    assert yaml.safe_load(found.files["path.yaml"])["header"]["frame_id"] == "m'ap: {"
    parameters = yaml.safe_load(found.files["nav2_params.yaml"])
    assert parameters["map_server"]["ros__parameters"]["frame_id"] == "m'ap: {"
    assert all(name.isascii() and "/" not in name for name in found.files)
    assert read_map(found.files, "map.yaml").data.shape == (found.rows, found.columns)


def test_a_map_that_is_too_large_is_refused_with_a_resolution_that_fits() -> None:
    bounds = (0.0, 0.0, 3_000.0, 2_000.0)
    with pytest.raises(InputError, match=r"3000 m by 2000 m in cells of 0.05 m is too large") as caught:
        MapGrid.around(bounds, 0.05)
    least = float(str(caught.value).split("give ")[1].split(" or more")[0])
    grid = MapGrid.around(bounds, least)
    assert 0.8 * MOST_CELLS < grid.columns * grid.rows <= MOST_CELLS
    site = site_at([(0.0, 0.0), (2_000.0, 1_500.0)])
    with pytest.raises(InputError, match="is too large"):
        export_nav2(site, ROBOT, None, MapOptions(datum=datum_of(site)))


def test_a_graph_that_is_too_large_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fieldhand.exchange.nav2.route_graph.MOST_FEATURES", 1_000)
    with pytest.raises(InputError, match=r"--corners-only: a route graph of .* is too large: at most 1000; give it"):
        exported(built_in("demo"), resolution_m=0.5)
    assert exported(built_in("demo"), resolution_m=0.5, at_trees=False).edges < 1_000
    assert MOST_POSES > 100_000


def test_a_site_without_a_way_or_a_datum_is_refused() -> None:
    alone = site_at([(0.0, 0.0)])
    with pytest.raises(InputError, match="fewer than two places"):
        export_nav2(alone, ROBOT, None, MapOptions(datum=datum_of(alone)))
    with pytest.raises(InputError, match="--datum: the profile of husky does not state where its map frame lies"):
        export_nav2(load_demo(), ROBOT)
    far = Datum(lat=37.0, lon=-121.0)
    with pytest.raises(InputError, match=r"the origin of the map is .* km from the site; give one within 5 km"):
        export_nav2(load_demo(), ROBOT, None, MapOptions(datum=far))


def test_the_datum_of_the_profile_is_used() -> None:
    site = built_in("demo")
    datum = datum_of(site, 17.0, 12.0, 5.0)
    navigation = replace(ROBOT.ros2.navigation, from_ll="", datum=datum)
    robot = replace(ROBOT, ros2=replace(ROBOT.ros2, navigation=navigation))
    options = MapOptions(resolution_m=0.5)
    assert export_nav2(site, robot, None, options).files == export_nav2(
        site, ROBOT, None, replace(options, datum=datum)
    ).files  # fmt: skip


def test_open_ground_without_obstacles_has_a_graph_too() -> None:
    rng = np.random.default_rng(7)
    site = site_at([tuple(xy) for xy in rng.uniform(0.0, 60.0, (40, 2))])
    found = exported(site)
    graph = read_graph(found.files["route.geojson"])
    count, _ = connected_components(matrix_of(graph), directed=True, connection="strong")
    assert count == 1
    assert len({place for places in graph.places.values() for place in places}) >= 40


def test_trunks_widen_the_walls_alone() -> None:
    site = built_in("demo")
    thin, thick = (read_map(exported(site, trunk_m=trunk).files, "map.yaml") for trunk in (0.0, 0.3))
    assert (thick.data >= thin.data).all()
    row = site.planting.rows[3].trees
    for a, b in pairwise(
        on_map(datum_of(site, 70.0, 30.0, -20.0), [(site.trees[k].place.lat, site.trees[k].place.lon) for k in row])
    ):
        across = np.array([b[1] - a[1], a[0] - b[0]]) / math.dist(a, b)
        middle = (np.array(a) + np.array(b)) / 2.0
        assert thick.at(*(middle + 0.28 * across)) == OCCUPIED
        assert thin.at(*(middle + 0.28 * across)) == FREE
