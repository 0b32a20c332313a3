"""Sites, plans and driven paths as GeoJSON, in degrees WGS 84, each feature with a ``role``.

``zone``, ``block``, ``row``, ``tree``, ``gate``, ``marker``: the site. ``path``, ``stop``: a plan, its legs with the
node that drives them, and its stops with their number and the nodes that drive or act there; ``work``: a stretch of
work along a path, with the intervals in which it is ``on``. ``avoided``: ground that a plan keeps out of. ``choice``:
a place that an answer to a question would select. ``leg``, ``worked``, ``capture``, ``end``: a mission that was driven,
with times in seconds since its start.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from fieldhand.site.choices import choice_marks
from fieldhand.site.drawing.blocks import block_words, outline_of
from fieldhand.site.model import Place, Site
from fieldhand.site.projection import Projection
from fieldhand.task.results import Acted, Arrived, Driving, Ended, Event, Worked

if TYPE_CHECKING:
    from fieldhand.forecast.estimate import Estimate
    from fieldhand.forecast.walk_steps import Walk
    from fieldhand.site.working.stretch import Stretch
    from fieldhand.task.plan import Node

Feature = dict[str, Any]
#: Decimals of a degree, for a resolution of a centimetre.
_DECIMALS = 7


def site_map(site: Site) -> Feature:
    """Return the map of a site: zones, blocks, rows, trees, gates and markers."""
    zones = [
        _feature("Polygon", _rings(zone.polygon, site.projection), role="zone", name=zone.name, kind=zone.kind)
        for zone in site.zones
    ]
    planting = site.planting
    blocks = [
        _feature("Polygon", _rings(outline_of(site, block), site.projection), role="block", name=block_words(block))
        for block in planting.blocks
    ]
    rows = [
        _feature(
            "LineString",
            site.projection.positions(site.xy[row.trees], _DECIMALS),
            role="row",
            name=row.name,
            block=planting.blocks[row.block].name,
            known=row.known,
            confidence=round(row.confidence, 3),
        )
        for row in planting.rows
        if len(row.trees) > 1
    ]
    names = [row.name for row in planting.rows] + [""]  # the last name is for trees without a row, whose index is -1
    trees = [
        _at(tree.place, role="tree", id=tree.place.id, row=names[row], attributes=dict(tree.properties))
        for tree, row in zip(site.trees, planting.row_of.tolist(), strict=True)
    ]
    gates = [_at(gate.place, role="gate", name=gate.place.id, width_m=gate.width_m) for gate in site.gates]
    markers = [_at(place, role="marker", name=name) for name, place in site.markers.items()]
    return _collection([*zones, *blocks, *rows, *trees, *gates, *markers])


def plan_map(site: Site, estimate: Estimate) -> Feature:
    """Return the map of a plan: each leg of every branch once, and the stops in the order in which they are reached.

    On the first branch, every condition holds; ``branch`` is true for legs and stops that only other branches have.
    """
    legs: dict[tuple[Any, ...], Feature] = {}
    stops: dict[tuple[str, str], Feature] = {}
    for number, branch in enumerate(estimate.branches):
        _add_legs(legs, branch.walk, site.projection, other=number > 0)
        _add_stops(stops, branch.walk, other=number > 0)
    avoided = [
        _feature("Polygon", _rings(part, site.projection), role="avoided", name=ground.rule)
        for ground in estimate.closed
        for part in shapely.get_parts(ground.shape)
    ]
    return _collection([*site_map(site)["features"], *avoided, *legs.values(), *stops.values()])


def choices_map(site: Site, choices: Sequence[Sequence[Place]]) -> Feature:
    """Return the map of a site with the places of several choices, each with the numbers of its choices."""
    marks = [
        _at(m.place, role="choice", numbers=list(m.numbers), labelled=m.labelled, place=m.place.id, kind=m.place.kind)
        for m in choice_marks(choices)
    ]
    return _collection([*site_map(site)["features"], *marks])


def driven_map(events: Iterable[Event]) -> Feature:
    """Return the map of an event log: legs with the times of their start and end, and captures with their readings."""
    features: list[Feature] = []
    driving: Driving | None = None
    for event in events:
        match event:
            case Driving():
                driving = event
            case Arrived() if driving is not None:
                features.append(_leg(driving, event.t, to=event.place))
                driving = None
            case Worked():
                features += [
                    _feature(
                        "LineString",
                        [_position(lat, lon) for lat, lon in part],
                        role="worked",
                        t=event.t,
                        node=event.node,
                        action=event.action,
                        name=event.stretch,
                    )
                    for part in event.paths
                ]
            case Acted():
                features.append(
                    _feature(
                        "Point",
                        _position(event.lat, event.lon),
                        role="capture",
                        t=event.t,
                        node=event.node,
                        action=event.action,
                        status=event.status,
                        place=event.place,
                        readings=dict(event.readings),
                        units=dict(event.units),
                        **({} if event.heading_deg is None else {"heading_deg": round(event.heading_deg, 1)}),
                    )
                )
            case Ended():
                if driving is not None:
                    # The last drive was interrupted; only this event contains its end.
                    driven = _driven(driving.path, (event.lat, event.lon))
                    features.append(_leg(driving, event.t, to="", path=driven))
                features.append(_feature("Point", _position(event.lat, event.lon), role="end", t=event.t))
            case _:
                pass
    return _collection(features)


def _add_legs(legs: dict[tuple[Any, ...], Feature], walk: Walk, projection: Projection, *, other: bool) -> None:
    for step in walk.steps:
        if step.stretch is not None:
            legs.setdefault(
                (step.node.id, step.stretch.points), _stretch(step.node, step.stretch, projection, other=other)
            )
        if step.drive is None:
            continue
        legs.setdefault(
            (step.node.id, step.drive.points),
            _feature(
                "LineString",
                projection.positions(step.drive.points, _DECIMALS),
                role="path",
                node=step.node.id,
                home=step.kind == "exit",
                length_m=round(step.drive.length_m, 2),
                branch=other,
            ),
        )


def _stretch(node: Node, stretch: Stretch, projection: Projection, *, other: bool) -> Feature:
    """Return a stretch of work along a path."""
    return _feature(
        "LineString",
        projection.positions(stretch.points, _DECIMALS),
        role="work",
        node=node.id,
        name=str(stretch.name),
        length_m=round(stretch.length_m, 2),
        on=[[round(a, 2), round(b, 2)] for a, b in stretch.on],
        branch=other,
    )


def _add_stops(stops: dict[tuple[str, str], Feature], walk: Walk, *, other: bool) -> None:
    """Add a stop for each place at which a node drives or acts, except for the way home."""
    for step in walk.steps:
        if step.kind not in ("drive", "act", "wait") or step.node.work is not None:
            continue
        place = step.places[0]
        stop = stops.setdefault(
            (place.kind, place.id),
            _at(place, role="stop", number=len(stops) + 1, place=place.id, kind=place.kind, nodes=[], branch=other),
        )
        if step.node.id not in stop["properties"]["nodes"]:
            stop["properties"]["nodes"].append(step.node.id)
        if step.sees is not None and step.heading_deg is not None:
            stop["properties"]["heading_deg"] = round(step.heading_deg, 1)


def _leg(driving: Driving, until: float, *, to: str, path: Sequence[tuple[float, float]] | None = None) -> Feature:
    line = [_position(lat, lon) for lat, lon in (driving.path if path is None else path)]
    return _feature("LineString", line, role="leg", node=driving.node, t=driving.t, until=until, to=to)


def _driven(path: Sequence[tuple[float, float]], end: tuple[float, float]) -> list[tuple[float, float]]:
    """Return the points of a path that the robot passed before it stopped at ``end``, followed by ``end``."""
    here = np.asarray(end)
    corners = np.asarray(path)
    # Longitudes are scaled, as a degree of longitude is shorter than one of latitude.
    scale = np.array([1.0, np.cos(np.radians(end[0]))])
    a, way = corners[:-1] * scale, np.diff(corners, axis=0) * scale
    along = np.clip(((here * scale - a) * way).sum(axis=1) / np.maximum((way**2).sum(axis=1), 1e-30), 0.0, 1.0)
    off = np.hypot(*(a + along[:, None] * way - here * scale).T)
    return [*path[: int(off.argmin()) + 1], end]


def _at(at: Place, /, **properties: Any) -> Feature:
    return _feature("Point", _position(at.lat, at.lon), **properties)


def _feature(geometry: str, coordinates: Any, /, **properties: Any) -> Feature:
    return {"type": "Feature", "geometry": {"type": geometry, "coordinates": coordinates}, "properties": properties}


def _collection(features: list[Feature]) -> Feature:
    return {"type": "FeatureCollection", "features": features}


def _position(lat: float, lon: float) -> list[float]:
    return [round(lon, _DECIMALS), round(lat, _DECIMALS)]


def _rings(polygon: Any, projection: Projection) -> list[list[list[float]]]:
    return [projection.positions(ring.coords, _DECIMALS) for ring in (polygon.exterior, *polygon.interiors)]
