"""Obstacles: drive around them, wait for them to go, record what they close off.

A stretch that was found blocked counts as a keep-out zone for the rest of the mission: for drives, the guard, and the
order of visits. Only if no other way is left, the robot waits and then tries a blocked one again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from shapely.geometry import LineString, Point

from fieldhand.errors import BlockedFault, DriveFault
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.waiting import wait
from fieldhand.language import message
from fieldhand.site.model import Place
from fieldhand.task.results import Obstructed, Waited
from fieldhand.task.run import Steps

#: Distance in metres ahead of a stopped robot within which the obstacle is assumed.
_AHEAD_M = 0.5


def avoid(mission: ActiveMission, node: str, place: Place, what: str) -> None:
    """Record the obstacle before the robot, which was stopped on the way to a place, and what it closes off."""
    position, path = mission.observation.position, LineString(mission.driven)
    along = path.project(Point(position.xy))
    ahead = path.interpolate(min(path.length, along + _AHEAD_M))
    if ahead.distance(Point(position.xy)) <= 0.0:
        ahead = Point(mission.driven[-1])
    _close(mission, node, place, what, lambda: mission.blockages.add_ahead(position.xy, (ahead.x, ahead.y)))


def avoid_stand(mission: ActiveMission, node: str, place: Place, what: str) -> None:
    """Record an obstacle where the robot would stand at the end of its last drive, near which it was stopped."""
    stand, position = mission.driven[-1], mission.observation.position
    _close(mission, node, place, what, lambda: mission.blockages.add_stand(stand, position.xy))


def _close(mission: ActiveMission, node: str, place: Place, what: str, add: Callable[[], object]) -> None:
    """Record an obstacle and the trees that it closes off."""
    trees = [tree.place for tree in mission.site.trees]
    before = mission.drives.reachable(trees, mission.standing)
    add()
    mission.guard.update_drives(mission.drives)
    after = mission.drives.reachable(trees, mission.standing)
    closed = [tree.id for tree, was, is_ in zip(trees, before, after, strict=True) if was and not is_]
    _emit_obstructed(mission, node, place, what, unreachable=closed)


def wait_for_way(mission: ActiveMission, node: str, place: Place) -> Steps:
    """Ensure that there is a way to a place. If blocked stretches leave none, wait, then reopen one of them.

    Raises:
        DriveFault: There never was a way.
        BlockedFault: No way is left.
    """
    try:
        mission.way_to(place)
        return
    except DriveFault as fault:
        if not mission.blockages.stretches:
            raise
        what = fault.what
    yield from wait(mission, mission.robot.patience.blocked_wait_s)
    known = mission.blockages.stretches
    # The robot most likely stands before the stretch found last.
    for left in (*(tuple(s for s in known if s is not one) for one in reversed(known)), ()):
        mission.blockages.replace(left)
        try:
            mission.way_to(place)
            break
        except DriveFault as fault:
            what = fault.what
    else:
        mission.blockages.replace(known)
    mission.guard.update_drives(mission.drives)
    opened = len(mission.blockages.stretches) < len(known)
    waited = mission.robot.patience.blocked_wait_s
    mission.emit(Waited(t=mission.t, node=node, wanted="way", seconds=waited, over=opened, what=what))
    if not opened:
        raise BlockedFault(what)
    _emit_obstructed(mission, node, place, message("it may be gone", context="log"), free=True)


def cut_off_places(mission: ActiveMission, places: Sequence[Place]) -> tuple[bool, ...]:
    """Return for each place True if no way is left to it from the robot's position, to either side of it."""
    if not mission.blockages.stretches:
        return (False,) * len(places)
    anywhere = [replace(place, stand=None) if place.planted else place for place in places]
    return tuple(not linked for linked in mission.drives.reachable(anywhere, mission.standing))


def _emit_obstructed(
    mission: ActiveMission, node: str, place: Place, what: str, *, unreachable: Sequence[str] = (), free: bool = False
) -> None:
    position, projection = mission.observation.position, mission.site.projection
    mission.emit(
        Obstructed(
            t=mission.t,
            node=node,
            kind=place.kind,
            place=place.id,
            lat=position.lat,
            lon=position.lon,
            travelled_m=mission.travelled_m,
            blocked=tuple(projection.lat_lon(list(s.exterior.coords)[:-1]) for s in mission.blockages.stretches),
            unreachable=tuple(unreachable),
            free=free,
            what=what,
        )
    )
