"""Headings at which a robot stands at the places of a mission, so that its cameras see the plants.

A robot ends a drive along the aisle in which it stands. For a camera that looks to one side, of both directions along
the aisle the one counts in which the plant is on that side: a robot that turns on the spot turns to it, another comes
in from the other end of the row. Headings are in degrees clockwise from true north.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.robot.camera import Camera
from fieldhand.robot.model import RobotProfile
from fieldhand.site.bearings import apart_deg, bearing_of
from fieldhand.site.model import Place
from fieldhand.task.plan import Node, walk

if TYPE_CHECKING:
    from fieldhand.site.drives import Drive, Drives

XY = tuple[float, float]

#: Metres between robot and plant below which the plant has no bearing.
_UPON_M = 0.2
#: Degrees by which a robot may be off the heading for a camera before it turns again.
NEAR_DEG = 10.0


@dataclass(frozen=True, kw_only=True)
class Facing:
    """Heading at a place, and True in ``sees`` if the camera then has the plant in view; None without a camera."""

    heading_deg: float | None
    sees: bool | None = None


def cameras_of(plan: Node, robot: RobotProfile) -> Mapping[str, Camera]:
    """Return for each node that drives to a place the camera of the first picture that is taken there, by node id."""
    if all(action.camera is None for action in robot.actions):
        return {}
    nodes = tuple(walk(plan))
    found: dict[str, Camera] = {}
    for k, node in enumerate(nodes):
        if node.act is None and node.selector is None:
            continue
        inside = tuple(walk(node))[1:] if node.visits_each else nodes[k + 1 :]
        camera = _camera_of(node, robot)
        for later in inside if camera is None else ():
            if later.selector is not None or later.recharge is not None or later.work is not None:
                break
            if (camera := _camera_of(later, robot)) is not None:
                break
        if camera is not None:
            found[node.id] = camera
    return found


def _camera_of(node: Node, robot: RobotProfile) -> Camera | None:
    action = None if node.act is None else robot.action.get(node.act.action)
    return None if action is None else action.camera


def way_in(drives: Drives, robot: RobotProfile, a: Place, b: Place, camera: Camera | None) -> Drive:
    """Return the drive to a place at which a camera takes a picture: the shortest, or for a robot that does not turn on
    the spot the shortest after which a plant of a row is on the camera's side.

    Raises:
        DriveFault: There is no way.
    """
    if camera is None or not camera.lateral or robot.turn_deg_s is not None or not b.planted:
        return drives.between(a, b)
    return drives.arriving(a, b, camera.side)


def facing(drives: Drives, robot: RobotProfile, place: Place, camera: Camera | None, along_deg: float | None) -> Facing:
    """Return the heading of a robot for a camera at the stand of a place.

    Args:
        drives: Drives of the robot.
        robot: The robot.
        place: The place, with its stand.
        camera: Camera that takes a picture there; None if there is none.
        along_deg: Heading in which it arrives; None if that is unknown.
    """
    stand = place.stand or place.xy
    if camera is None or not place.planted or math.dist(stand, place.xy) < _UPON_M:
        return Facing(heading_deg=along_deg)
    bearing = bearing_of(stand, place.xy)
    if robot.turn_deg_s is None:
        return Facing(heading_deg=along_deg, sees=along_deg is not None and camera.sees(along_deg, bearing))
    heading, axis = camera.heading_towards(bearing), drives.axis_deg(place)
    if camera.lateral and axis is not None:
        heading = min((axis % 360.0, (axis + 180.0) % 360.0), key=lambda one: apart_deg(one, heading))
    return Facing(heading_deg=heading, sees=camera.sees(heading, bearing))


def turn_s(robot: RobotProfile, *headings: float | None) -> float:
    """Return the seconds of turning on the spot from each heading to the next; an unknown one takes none."""
    if robot.turn_deg_s is None:
        return 0.0
    turns = itertools.pairwise(headings)
    return sum(apart_deg(a, b) for a, b in turns if a is not None and b is not None) / robot.turn_deg_s


def in_rows(drives: Drives, places: Sequence[Place], camera: Camera) -> tuple[Place, ...]:
    """Return visits in an order in which a robot that does not turn on the spot sees every plant of a row as it passes.

    Plants of one row with their stands on one side of it are visited one after the other, in the direction in which
    they are on the camera's side. Rows keep the order in which they are reached first.

    Args:
        drives: Drives of the robot.
        places: Places in visiting order, with stands.
        camera: Camera that looks to the left or the right.
    """
    groups: dict[object, list[Place]] = {}
    for number, place in enumerate(places):
        ends = drives.row_ends(place)
        groups.setdefault((ends, _is_right(ends, place)) if ends else number, []).append(place)
    return tuple(place for ends, together in groups.items() for place in _in_direction(ends, together, camera))


def _is_right(ends: tuple[XY, ...], place: Place) -> bool:
    """Return True if the robot stands on the right of a row, seen from its first tree to its last."""
    (x0, y0), (x1, y1) = ends
    x, y = place.stand or place.xy
    return (x1 - x0) * (y - place.y) - (y1 - y0) * (x - place.x) < 0.0


def _in_direction(group: object, places: list[Place], camera: Camera) -> list[Place]:
    """Return the plants of one side of a row in the direction in which the camera sees them."""
    if len(places) < 2 or not isinstance(group, tuple):
        return places
    (x0, y0), (x1, y1) = group[0]
    towards = camera.heading_towards(bearing_of(places[0].stand or places[0].xy, places[0].xy))
    forward = apart_deg(bearing_of((x0, y0), (x1, y1)), towards) < 90.0
    return sorted(places, key=lambda p: (p.x - x0) * (x1 - x0) + (p.y - y0) * (y1 - y0), reverse=not forward)
