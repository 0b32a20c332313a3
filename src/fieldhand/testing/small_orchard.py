"""A small site and Tasks on it, built in memory for tests that need no file."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from fieldhand.robot.capabilities import measures_of
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import parse_site
from fieldhand.site.model import Site
from fieldhand.task.build import make_task
from fieldhand.task.frames import Resource, Task
from fieldhand.task.plan import Node

#: Degrees of about 5 m at latitude 37.
LAT_STEP, LON_STEP = 4.5e-5, 5.6e-5
SOUTH_WEST = (37.0, -120.0)


def at(row: float, column: float) -> list[float]:
    """Return longitude and latitude of a position counted in rows northwards and columns eastwards."""
    return [SOUTH_WEST[1] + column * LON_STEP, SOUTH_WEST[0] + row * LAT_STEP]


def orchard(rows: int = 4, columns: int = 5, zones: Sequence[dict[str, Any]] = ()) -> Site:
    """Return a site of trees 1, 2, ... row by row from the south-west, with a start and an end.

    Every third tree is yellow, the others green; the reward of a tree is its id.

    Args:
        rows, columns: Numbers of rows and columns; the spacing is about 5 m.
        zones: Additional GeoJSON features, such as those of :func:`block`.
    """
    features = [_point(at(-1, 0), {"kind": "start"}), _point(at(-1, columns - 1), {"kind": "end"})]
    for k in range(rows * columns):
        row, column = divmod(k, columns)
        color = "green" if k % 3 else "yellow"
        features.append(_point(at(row, column), {"kind": "tree", "id": k + 1, "leaf_color": color, "reward": k + 1.0}))
    document = {"type": "FeatureCollection", "features": [*features, *zones]}
    return parse_site(json.dumps(document).encode(), name="orchard")


def block(kind: str, name: str, south_west: tuple[float, float], north_east: tuple[float, float]) -> dict[str, Any]:
    """Return a rectangle as a GeoJSON zone of a kind (``block``, ``obstacle``, ...), corners in rows and columns."""
    (r0, c0), (r1, c1) = south_west, north_east
    ring = [at(r0, c0), at(r0, c1), at(r1, c1), at(r1, c0), at(r0, c0)]
    return {
        "type": "Feature",
        "geometry": {"type": "Polygon", "coordinates": [ring]},
        "properties": {"kind": kind, "name": name},
    }


def husky() -> RobotProfile:
    """Return the profile of the built-in robot."""
    return load_robot("husky")


def task_for(site: Site, plan: Node, request: str = "", **more: Any) -> Task:
    """Return a Task for the site and the husky.

    Args:
        site: Site of the Task.
        plan: Root node of the plan.
        request: Request that the plan implements.
        more: Further arguments of :func:`fieldhand.task.build.make_task`.
    """
    robot = husky()
    resources = (
        Resource(kind="site", name=site.name, sha256=site.sha256),
        Resource(kind="robot", name=robot.name, sha256=robot.sha256),
    )
    return make_task(request=request, plan=plan, measures=measures_of(robot), resources=resources, **more)


def _point(lon_lat: list[float], properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "geometry": {"type": "Point", "coordinates": lon_lat}, "properties": properties}
