"""Read an event log: actions at trees, distance driven, final status and position."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely
import shapely.ops

from fieldhand.errors import CaseError
from fieldhand_bench.missions.case_site import CaseSite, Points

#: Maximum distance between two captures that belong to one stop, metres.
_ONE_STOP_M = 0.5


@dataclass(frozen=True, kw_only=True)
class Done:
    """An action that was done; successive captures at one tree are combined.

    Attributes:
        action: Name of the action.
        tree: Index in the file of the tree nearest to the action.
        captures: Number of captures.
        off_m: Distance from that tree, metres.
    """

    action: str
    tree: int
    captures: int
    off_m: float


@dataclass(frozen=True, kw_only=True)
class Log:
    """The content of an event log that is judged.

    Attributes:
        done: Actions that succeeded, in their order.
        stops: (k, 2), stops at which an action was done, metres east and north.
        driven: Parts of drives that were driven at one commanded speed: (n, 2) corners in metres, and the speed in m/s.
        paths: (n, 2) each, corners of the drives, metres east and north.
        worked: Metres with each action on along paths, each part as (k, 2) corners, metres east and north.
        travelled_m: Distance driven in total, metres.
        status: Final status of the mission; None if the log does not record it.
        end: (2,), final position, metres east and north; None if the log does not record it.
        lasts_s: Duration of the mission, seconds.
        fastest_m_s: Speed of the fastest leg on average, m/s.
        stands: Number of positions of the robot from which each tree was worked on.
        charges: Number of charges.
        waited_s: Time for which it stood still because of an event, seconds.
    """

    done: tuple[Done, ...]
    stops: Points
    worked: tuple[tuple[str, Points], ...] = ()
    travelled_m: float
    status: str | None
    end: Points | None
    lasts_s: float = 0.0
    fastest_m_s: float = 0.0
    stands: Mapping[int, int] = field(default_factory=dict)
    paths: tuple[Points, ...] = ()
    driven: tuple[tuple[Points, float], ...] = ()
    charges: int = 0
    waited_s: float = 0.0


def read_log(lines: Iterable[str], site: CaseSite) -> Log:
    """Parse an event log, one JSON object per line, and assign its actions to trees.

    Raises:
        CaseError: A line is not an event, or lacks a required field.
    """
    done: list[Done] = []
    stops: list[Points] = []
    paths: list[Points] = []
    worked: list[tuple[str, Points]] = []
    driven: list[tuple[Points, float]] = []
    goal: object = None
    travelled, status, end = 0.0, None, None
    lasts_s = fastest = left_s = waited_s = 0.0
    charges = 0
    stood: Points | None = None
    stands: dict[int, list[Points]] = {}
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            event: Mapping[str, Any] = json.loads(line)
            travelled = max(travelled, float(event.get("travelled_m", 0.0)))
            now_s = float(event.get("t", 0.0))
            lasts_s = max(lasts_s, now_s)
            match event.get("event"), event.get("status"):
                case "drive", _:
                    again, goal = (
                        goal == (event.get("node"), event.get("place")),
                        (event.get("node"), event.get("place")),
                    )
                    left_s = left_s if again else now_s
                    if event.get("path"):
                        paths.append(site.metres(np.array(event["path"], dtype=np.float64).reshape(-1, 2)))
                        if again and driven:
                            driven[-1] = _up_to(driven[-1][0], paths[-1][0]), driven[-1][1]
                        driven.append((paths[-1], float(event.get("speed_m_s") or math.inf)))
                case "arrive", _:
                    stood, goal = _at(event, site), None
                    if now_s > left_s:
                        fastest = max(fastest, float(event["leg_m"]) / (now_s - left_s))
                case "action", "success":
                    at = _at(event, site)
                    known = stands.setdefault(site.nearest(at)[0], [])
                    if stood is not None and all(math.dist(stood, one) > _ONE_STOP_M for one in known):
                        known.append(stood)
                    _add(done, str(event["action"]), int(event.get("count", 1)), *site.nearest(at))
                    if not stops or math.dist(at, stops[-1]) > _ONE_STOP_M:
                        stops.append(at)
                case "worked", _:
                    parts = (np.array(path, dtype=np.float64).reshape(-1, 2) for path in event["paths"])
                    worked += [(str(event["action"]), site.metres(path)) for path in parts if len(path) > 1]
                case "charged", _:
                    charges += 1
                case "wait", _ if event["wanted"] == "event":
                    waited_s += float(event["seconds"])
                case "mission", ended:
                    status, end = str(ended), _at(event, site)
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise CaseError(
                f"is not an event that can be judged: {error}",
                where=f"event log, line {number}",
                advice="was the log cut off or edited?",
            ) from None
    return Log(
        done=tuple(done),
        stops=np.array(stops).reshape(-1, 2),
        travelled_m=travelled,
        status=status,
        end=end,
        lasts_s=lasts_s,
        fastest_m_s=fastest,
        stands={tree: len(known) for tree, known in stands.items()},
        paths=tuple(paths),
        driven=tuple(driven),
        worked=tuple(worked),
        charges=charges,
        waited_s=waited_s,
    )


def _up_to(path: Points, end: Points) -> Points:
    """Return the part of a path up to a point on it; the whole of it if the point is elsewhere."""
    line, point = shapely.LineString(path), shapely.Point(end)
    if line.distance(point) > _ONE_STOP_M:
        return path
    part = shapely.ops.substring(line, 0.0, line.project(point))
    return np.array(part.coords).reshape(-1, 2)


def _at(event: Mapping[str, Any], site: CaseSite) -> Points:
    degrees = np.array([float(event["lat"]), float(event["lon"])])
    if not np.isfinite(degrees).all():
        raise ValueError("latitude and longitude are no numbers")
    return site.metres(degrees)


def _add(done: list[Done], action: str, captures: int, tree: int, off_m: float) -> None:
    if done and (done[-1].action, done[-1].tree) == (action, tree):
        last = done.pop()
        captures, off_m = captures + last.captures, last.off_m
    done.append(Done(action=action, tree=tree, captures=captures, off_m=off_m))
