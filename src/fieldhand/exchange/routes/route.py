"""A route: the stops and legs of a mission in order, in degrees.

A planned route follows the branch on which every condition holds. Its stops are certain as long as every other branch
drives the same legs and no optional step has occurred.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import TYPE_CHECKING

from fieldhand.exchange.broken_off import driven_part
from fieldhand.exchange.incidents import Incident, LatLon, incidents
from fieldhand.exchange.incidents import known as _known
from fieldhand.forecast.branches import branches
from fieldhand.forecast.resource_limits import speed_of
from fieldhand.forecast.visit_order import drives_for
from fieldhand.forecast.walk_steps import Walk, WalkStep
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.frames import Task
from fieldhand.task.results import Acted, Arrived, Driving, Ended, Event, Started

if TYPE_CHECKING:
    pass


@dataclass(frozen=True, kw_only=True)
class ExportedWork:
    """An action at a stop, planned or performed.

    Attributes:
        captures: Number of captures, planned or made.
        certain: True if every branch performs the action.
        failed: Number of failed captures.
        seconds: Duration; 0 if a log does not contain it.
        readings: Value and unit of the last capture, by quantity.
    """

    node: str
    action: str
    captures: int
    certain: bool = True
    failed: int = 0
    seconds: float = 0.0
    readings: dict[str, tuple[float, str]] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class RouteStop:
    """A place where the robot stops.

    Attributes:
        place: Id of the tree, or name of the marker or point.
        at: Position of the tree or point.
        stand: Position of the robot.
        way: Leg from the previous stop, including both ends; empty if the robot does not move.
        length_m: Length of that leg in metres, as planned or driven.
        travelled_m: Distance from the start of the mission in metres.
        certain: True if the stop is visited for all readings and leg costs.
        home: True at the end of the mission.
        t: Seconds from the start in a log; None in a plan.
        heading_deg: Heading of the robot in degrees clockwise from north; None if it is not known.
    """

    node: str
    kind: str
    place: str
    at: LatLon
    stand: LatLon
    way: tuple[LatLon, ...] = ()
    length_m: float = 0.0
    travelled_m: float = 0.0
    work: tuple[ExportedWork, ...] = ()
    certain: bool = True
    home: bool = False
    t: float | None = None
    heading_deg: float | None = None


@dataclass(frozen=True, kw_only=True)
class ExportedRoute:
    """The stops of a mission, with its start and incidents.

    Attributes:
        name: Name of the route in other programs.
        start: Start position of the robot.
        speed_m_s: Driving speed in m/s.
        driven: True for a route from a log, False for a plan.
        incidents: Incidents, each with the number of stops before it.
    """

    name: str
    start: LatLon
    stops: tuple[RouteStop, ...]
    speed_m_s: float
    driven: bool
    incidents: tuple[tuple[int, Incident], ...] = ()


def planned(task: Task, site: Site, robot: RobotProfile) -> ExportedRoute:
    """Return the route of a Task on the branch where every condition holds.

    Raises:
        PlaceError: A selector matches nothing on this site.
        DriveFault: A place cannot be reached.
    """
    found = branches(task, site, robot)
    if not found.walks and found.broken:
        raise found.broken[0].error
    walked = found.walks[0]
    known = _Certain(found.walks if found.complete else (walked,), complete=found.complete)
    first = next((s.context.here for s in walked.steps), site.start)
    stops: list[RouteStop] = [_stop(first, site, node="", certain=True)]
    ways = drives_for(site, robot, task.constraints)
    travelled, drives = 0.0, 0
    for step in walked.steps:
        if step.kind in ("drive", "exit") and step.drive is not None:
            travelled += step.drive.length_m
            heading = ways.heading_after(step.drive) if step.heading_deg is None else step.heading_deg
            stops.append(_driven_to(step, site, travelled, drives < known.drives, heading))
            drives += 1
        elif step.kind == "exit":
            stops[-1] = replace(stops[-1], home=True)
        elif step.kind == "act" and step.node.act is not None:
            done = ExportedWork(
                node=step.node.id,
                action=step.node.act.action,
                captures=step.captures,
                certain=drives <= known.drives and (drives, step.node.id) in known.acts,
                seconds=step.seconds,
            )
            stops[-1] = replace(stops[-1], work=(*stops[-1].work, done))
    begin = stops[0]
    return ExportedRoute(
        name=task.id,
        start=begin.stand,
        stops=tuple(stops if begin.work or begin.home else stops[1:]),
        speed_m_s=speed_of(task.constraints, robot),
        driven=False,
    )


def driven(
    events: Sequence[Event], *, speed_m_s: float = 0.0, tell: Callable[[Event], str | None] = lambda _: None
) -> ExportedRoute:
    """Return the route of an event log, without stops that lack a valid position.

    Args:
        events: Event log.
        speed_m_s: Driving speed in m/s.
        tell: Returns the description of an event, preceded by its time, or None.
    """
    started = next((e for e in events if isinstance(e, Started)), None)
    begin = (0.0, 0.0) if started is None else (started.lat, started.lon)
    stops: list[RouteStop] = []
    here = begin
    way: tuple[LatLon, ...] = ()
    broken: tuple[LatLon, ...] = ()
    for event in events:
        match event:
            case Driving():
                path = tuple((a, b) for a, b in event.path if _known((a, b)))
                # An earlier drive that did not arrive ended where this one starts.
                broken = (*broken, *driven_part(way, path[0])) if way and path else broken
                way = path
            case Arrived() if _known((event.lat, event.lon)):
                here = (event.lat, event.lon)
                stops.append(
                    RouteStop(
                        node=event.node, kind=event.kind, place=event.place, at=here, stand=here,
                        way=broken + way, length_m=event.leg_m, travelled_m=event.travelled_m, t=event.t,
                    )
                )  # fmt: skip
                way, broken = (), ()
            case Acted() if _known((event.lat, event.lon)):
                if not stops or stops[-1].place != event.place:
                    metres = stops[-1].travelled_m if stops else 0.0
                    at = (event.lat, event.lon)
                    stops.append(
                        RouteStop(
                            node=event.node, kind=event.kind, place=event.place, at=at, stand=here,
                            travelled_m=metres, t=event.t,
                        )
                    )  # fmt: skip
                stops[-1] = replace(
                    stops[-1],
                    at=(event.lat, event.lon),
                    work=_with(stops[-1].work, event),
                    heading_deg=event.heading_deg,
                )
            case Ended() if stops:
                stops[-1] = replace(stops[-1], home=not stops[-1].work)
            case _:
                pass
    name = started.task if started is not None else "mission"
    beside = tuple(
        (sum(stop.t is not None and stop.t <= one.t for stop in stops), one) for one in incidents(events, tell)
    )
    return ExportedRoute(name=name, start=begin, stops=tuple(stops), speed_m_s=speed_m_s, driven=True, incidents=beside)


class _Certain:
    """The common beginning of all branches.

    Attributes:
        drives: Number of drives that are the same on every branch.
        acts: Actions performed on every branch, by node and number of drives before them.
    """

    def __init__(self, walks: Sequence[Walk], *, complete: bool) -> None:
        each = [self._straight(walked, complete) for walked in walks]
        ways = [drives for drives, _ in each]
        self.drives = sum(1 for _ in takewhile(lambda same: len(set(same)) == 1, zip(*ways, strict=False)))
        self.acts = frozenset.intersection(*(acts for _, acts in each))

    def _straight(self, walked: Walk, complete: bool) -> tuple[list[tuple[LatLon, ...]], frozenset[tuple[int, str]]]:
        """Return the drives and acts of a branch up to the first optional step or place that readings decide.

        If not all branches were explored, the result also ends at the first condition.
        """
        drives: list[tuple[LatLon, ...]] = []
        acts: set[tuple[int, str]] = set()
        for step in walked.steps:
            if (step.kind == "visit-list" and step.node.is_optional) or (step.kind == "decide" and not complete):
                break
            if step.node.selector is not None and step.node.selector.decided_by_readings:
                break
            if step.drive is not None:
                drives.append(step.drive.points)
            elif step.kind == "act":
                acts.add((len(drives), step.node.id))
        return drives, frozenset(acts)


def _with(work: tuple[ExportedWork, ...], event: Acted) -> tuple[ExportedWork, ...]:
    """Return the work of a stop with one more capture added."""
    good = event.status == "success"
    readings = {q: (v, event.units.get(q, "")) for q, v in event.readings.items() if math.isfinite(v)} if good else {}
    last = work[-1] if work and (work[-1].node, work[-1].action) == (event.node, event.action) else None
    if last is None:
        last, work = ExportedWork(node=event.node, action=event.action, captures=0), (*work, None)  # type: ignore[arg-type]
    more = replace(
        last,
        captures=last.captures + (event.count if good else 0),
        failed=last.failed + (0 if good else 1),
        readings=readings or last.readings,
    )
    return (*work[:-1], more)


def _driven_to(step: WalkStep, site: Site, travelled: float, certain: bool, heading_deg: float | None) -> RouteStop:
    assert step.drive is not None  # noqa: S101  the caller looked
    way = site.projection.lat_lon(step.drive.points)
    made = _stop(step.places[0], site, node=step.node.id, certain=certain)
    return replace(
        made,
        way=way,
        stand=way[-1],
        length_m=step.drive.length_m,
        travelled_m=travelled,
        home=step.kind == "exit",
        heading_deg=heading_deg,
    )


def _stop(place: Place, site: Site, *, node: str, certain: bool) -> RouteStop:
    (stand,) = site.projection.lat_lon([place.stand or place.xy])
    return RouteStop(
        node=node, kind=place.kind, place=place.id, at=(place.lat, place.lon), stand=stand, certain=certain
    )
