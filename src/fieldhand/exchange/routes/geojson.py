"""Export of a route as GeoJSON (RFC 7946): a line for each leg, a point for each stop."""

from __future__ import annotations

from typing import Any

from fieldhand.exchange.incidents import Incident, LatLon
from fieldhand.exchange.routes.route import ExportedRoute, RouteStop
from fieldhand.hidden_characters import visible_json


def write_geojson(route: ExportedRoute) -> bytes:
    """Return a FeatureCollection, with incidents after legs and stops.

    Positions are longitude, latitude in degrees, WGS 84, to a hundredth of a millimetre.
    """
    features: list[dict[str, Any]] = []
    for number, stop in enumerate(route.stops, start=1):
        if len(stop.way) > 1:
            line = {"type": "LineString", "coordinates": [_position(p) for p in stop.way]}
            properties: dict[str, Any] = {"what": "way", "to_stop": number, "length_m": round(stop.length_m, 3)}
            features.append(_feature(line, properties | _certainty(route, stop)))
        features.append(_feature({"type": "Point", "coordinates": _position(stop.at)}, _of_stop(route, stop, number)))
    features += [_of_incident(one, behind) for behind, one in route.incidents]
    closed = next((one.blocked for _, one in reversed(route.incidents) if one.blocked is not None), ())
    for area in closed:
        ring = [_position(corner) for corner in area]
        if len(ring) > 2:
            ring = ring if ring[0] == ring[-1] else [*ring, ring[0]]
            features.append(_feature({"type": "Polygon", "coordinates": [ring]}, {"what": "blocked"}))
    collection = {"type": "FeatureCollection", "name": route.name, "features": features}
    return (visible_json(collection, indent=1) + "\n").encode()


def _of_stop(route: ExportedRoute, stop: RouteStop, number: int) -> dict[str, Any]:
    found: dict[str, Any] = {
        "what": "end" if stop.home else "stop",
        "number": number,
        "node": stop.node,
        "kind": stop.kind,
        "place": stop.place,
        "robot_position": _position(stop.stand),
        "travelled_m": round(stop.travelled_m, 3),
        "actions": [
            {"node": w.node, "action": w.action, "captures": w.captures}
            | ({"failed": w.failed} if route.driven else {"certain": w.certain})
            for w in stop.work
        ],
    }
    if stop.heading_deg is not None:
        found["heading_deg"] = round(stop.heading_deg, 1)
    if stop.t is not None:
        found["t_s"] = round(stop.t, 3)
    for work in stop.work:
        for quantity, (value, unit) in work.readings.items():
            found[quantity] = value
            found[f"{quantity}_unit"] = unit
    return found | _certainty(route, stop)


def _of_incident(one: Incident, behind: int) -> dict[str, Any]:
    """Return an incident as a point, without a geometry if the log has no position."""
    geometry = None if one.at is None else {"type": "Point", "coordinates": _position(one.at)}
    properties = {"what": one.event, "after_stop": behind, "node": one.node, "place": one.place, "t_s": round(one.t, 3)}
    if one.unreachable:
        properties["unreachable"] = list(one.unreachable)
    return _feature(geometry, properties | {"said": one.words})


def _certainty(route: ExportedRoute, stop: RouteStop) -> dict[str, Any]:
    return {} if route.driven else {"certain": stop.certain}


def _feature(geometry: dict[str, Any] | None, properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def _position(at: LatLon) -> list[float]:
    return [round(at[1], 9), round(at[0], 9)]
