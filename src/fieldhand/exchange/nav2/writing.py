"""All files of an export to Nav2."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from fieldhand.exchange.nav2.approved_path import write_path
from fieldhand.exchange.nav2.frame import map_frame
from fieldhand.exchange.nav2.grid import MapGrid
from fieldhand.exchange.nav2.ground import mapped_ground, occupied
from fieldhand.exchange.nav2.maps import map_document, occupancy_image, speed_image
from fieldhand.exchange.nav2.parameters import write_parameters
from fieldhand.exchange.nav2.route_graph import route_graph, write_route_graph
from fieldhand.exchange.routes.route import planned
from fieldhand.forecast.resource_limits import speed_of
from fieldhand.forecast.slow_ground import NO_SLOW_GROUND, slow_ground
from fieldhand.forecast.visit_order import drives_for
from fieldhand.language import message
from fieldhand.robot.bindings import Datum
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task


@dataclass(frozen=True, kw_only=True)
class MapOptions:
    """Options of the maps and the route graph of a site.

    Attributes:
        datum: Position of the map frame; None for that of the robot's profile.
        resolution_m: Length of the side of a cell in metres.
        trunk_m: Radius of a trunk in metres, by which the walls along rows are widened.
        at_trees: Give the route graph a node at each place from which the robot works on a tree.
    """

    datum: Datum | None = None
    resolution_m: float = 0.05
    trunk_m: float = 0.0
    at_trees: bool = True


@dataclass(frozen=True, kw_only=True)
class Nav2Files:
    """Files for Nav2.

    Attributes:
        files: Contents by file name.
        datum: Position of the map frame.
        columns, rows: Number of cells of the maps.
        nodes, edges: Number of nodes and of directed edges of the route graph.
        clear_m: Radius that a robot may have in Nav2 so that all drives lie on cells outside its inflation.
        notes: What the files do not contain.
    """

    files: Mapping[str, bytes]
    datum: Datum
    columns: int
    rows: int
    nodes: int
    edges: int
    clear_m: float
    notes: tuple[str, ...] = field(default=())


def export_nav2(
    site: Site, robot: RobotProfile, task: Task | None = None, options: MapOptions | None = None
) -> Nav2Files:
    """Return the maps, masks, route graph and parameters of Nav2 for a site.

    Args:
        site: The site.
        robot: Profile of the robot.
        task: Task whose limits of where the robot drives are included, and its planned path.
        options: How the site is mapped.

    Raises:
        InputError: The site is too large for the resolution, or the map frame is unknown.
        PlaceError: A selector of the Task matches nothing on this site.
        DriveFault: A place of the Task cannot be reached.
    """
    options = options or MapOptions()
    frame = map_frame(robot, site.projection, options.datum)
    constraints = None if task is None else task.constraints
    drives = drives_for(site, robot, constraints)
    slow = NO_SLOW_GROUND if constraints is None else slow_ground(constraints, site, robot)
    ground = mapped_ground(drives, frame, slow, trunk_m=options.trunk_m)
    grid = MapGrid.around(ground.bounds, options.resolution_m)
    taken = occupied(ground, grid)
    speed_m_s = robot.speed_m_s if constraints is None else speed_of(constraints, robot)
    graph = route_graph(drives, slow, speed_m_s, at_trees=options.at_trees)
    files = {
        "map.pgm": occupancy_image(taken),
        "map.yaml": map_document(grid, "map.pgm", mode="trinary"),
        "keepout.pgm": occupancy_image(taken | grid.covered(ground.closed)),
        "keepout.yaml": map_document(grid, "keepout.pgm", mode="trinary"),
        "speed.pgm": speed_image(ground, grid, robot.speed_m_s),
        "speed.yaml": map_document(grid, "speed.pgm", mode="raw"),
        "route.geojson": write_route_graph(graph, frame, name=site.name, speed_m_s=robot.speed_m_s),
        "nav2_params.yaml": write_parameters(robot, frame.name),
    }
    notes: list[str] = []
    if task is not None:
        route = planned(task, site, robot)
        files["path.yaml"] = write_path(route, frame)
        if not all(stop.certain for stop in route.stops):
            notes.append(message("the path is that of the branch on which every condition holds"))
    return Nav2Files(
        files=files,
        datum=frame.datum,
        columns=grid.columns,
        rows=grid.rows,
        nodes=len(graph.nodes),
        edges=2 * len(graph.edges),
        clear_m=max(0.0, robot.width_m / 2.0 - options.trunk_m - math.sqrt(2.0) * options.resolution_m),
        notes=tuple(notes),
    )
