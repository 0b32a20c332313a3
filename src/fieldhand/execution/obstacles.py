"""Obstacles in the robot's way: drive around them, wait for them to go, record what they close off.

A stretch that was found blocked counts as a keep-out for the rest of the mission: for the drives, the guard, the order
of visits. Only where no other way is left the robot waits, and then tries a blocked one again.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from shapely.geometry import LineString, Point, Polygon

from fieldhand.errors import BlockedFault, DriveFault
from fieldhand.execution.attempt import Attempt
from fieldhand.execution.waiting import wait
from fieldhand.language import message
from fieldhand.site.model import Place
from fieldhand.task.results import Event, Obstructed, Waited
from fieldhand.task.run import Steps

#: Metres along its way to which a robot that was stopped looks ahead.
_AHEAD_M = 0.5


def avoid(attempt: Attempt, node: str, place: Place, what: str) -> None:
    """Remember what stands before the robot, which was stopped on the way to a place, and say what that closes off."""
    trees = [tree.place for tree in attempt.site.trees]
    before = attempt.drives.linked(trees, attempt.standing)
    position, path = attempt.seen.position, LineString(attempt.driven)
    along = path.project(Point(position.x, position.y))
    ahead = path.interpolate(min(path.length, along + _AHEAD_M))
    if ahead.distance(Point(position.x, position.y)) <= 0.0:
        ahead = Point(attempt.driven[-1])
    attempt.blockages.found((position.x, position.y), (ahead.x, ahead.y))
    attempt.guard.ways_are(attempt.drives)
    after = attempt.drives.linked(trees, attempt.standing)
    closed = [tree.id for tree, was, is_ in zip(trees, before, after, strict=True) if was and not is_]
    _say(attempt, node, place, what, unreachable=closed)


def open_a_way(attempt: Attempt, node: str, place: Place) -> Steps:
    """See that there is a way to a place. Where what was found blocked leaves none, wait; then try one again.

    Raises:
        DriveFault: There never was a way.
    """
    try:
        attempt.way_to(place)
        return
    except DriveFault as fault:
        if not attempt.blockages.stretches:
            raise
        what = fault.what
    yield from wait(attempt, attempt.robot.patience.blocked_wait_s)
    known = attempt.blockages.stretches
    # The one found last is the one that the robot most likely stands before.
    for left in (*(tuple(s for s in known if s is not one) for one in reversed(known)), ()):
        attempt.blockages.are(left)
        try:
            attempt.way_to(place)
            break
        except DriveFault as fault:
            what = fault.what
    else:
        attempt.blockages.are(known)
    attempt.guard.ways_are(attempt.drives)
    opened = len(attempt.blockages.stretches) < len(known)
    waited = attempt.robot.patience.blocked_wait_s
    attempt.emit(Waited(t=attempt.t, node=node, wanted="way", seconds=waited, over=opened, what=what))
    if not opened:
        raise BlockedFault(what)
    _say(attempt, node, place, message("it may be gone", context="log"), free=True)


def no_way(attempt: Attempt, places: Sequence[Place]) -> tuple[bool, ...]:
    """To which of the places no way is left from where the robot stands, whichever side of them it would stand on."""
    if not attempt.blockages.stretches:
        return (False,) * len(places)
    anywhere = [replace(place, stand=None) if place.kind == "tree" else place for place in places]
    return tuple(not linked for linked in attempt.drives.linked(anywhere, attempt.standing))


def recall(attempt: Attempt, events: Iterable[Event]) -> None:
    """Take up what an earlier part of the same mission found blocked, from its events."""
    last = next((e for e in reversed(list(events)) if isinstance(e, Obstructed)), None)
    if last is None:
        return
    projection = attempt.site.projection
    attempt.blockages.are([Polygon(projection.metres(*np.array(area).T)) for area in last.blocked])
    attempt.guard.ways_are(attempt.drives)


def _say(
    attempt: Attempt, node: str, place: Place, what: str, *, unreachable: Sequence[str] = (), free: bool = False
) -> None:
    position, projection = attempt.seen.position, attempt.site.projection
    areas = [projection.degrees(np.array(s.exterior.coords)[:-1]) for s in attempt.blockages.stretches]
    attempt.emit(
        Obstructed(
            t=attempt.t,
            node=node,
            kind=place.kind,
            place=place.id,
            lat=position.lat,
            lon=position.lon,
            travelled_m=attempt.travelled_m,
            blocked=tuple(tuple((float(lat), float(lon)) for lat, lon in area) for area in areas),
            unreachable=tuple(unreachable),
            free=free,
            what=what,
        )
    )
