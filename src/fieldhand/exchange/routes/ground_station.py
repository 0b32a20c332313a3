"""Export of a planned route as a QGroundControl plan (file format version 1) for a ground rover.

A ground station plan is a list of waypoints without conditions, readings or budgets. It therefore contains only the
part of a mission that every branch drives identically, and the boundary and keep-out zones as a geofence. At a stop
the robot waits for the duration of the certain work; the work itself cannot be represented.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from fieldhand.exchange.incidents import LatLon
from fieldhand.exchange.routes.route import ExportedRoute
from fieldhand.site.model import Site

#: MAVLink values: MAV_CMD_NAV_WAYPOINT, MAV_FRAME_GLOBAL_RELATIVE_ALT, MAV_TYPE_GROUND_ROVER,
#: MAV_AUTOPILOT_ARDUPILOTMEGA.
_WAYPOINT, _FRAME, _ROVER, _ARDUPILOT = 16, 3, 10, 3
#: Altitude mode of an item: relative to home.
_RELATIVE = 1


@dataclass(frozen=True, kw_only=True)
class GroundStationPlan:
    """A plan, and the stops that it includes.

    Attributes:
        stops: Number of stops included.
        left_out: Number of stops omitted because they depend on a reading or the budget.
    """

    data: bytes
    stops: int
    left_out: int


def write_plan(route: ExportedRoute, site: Site) -> GroundStationPlan:
    """Return the unconditional part of a planned route."""
    straight = [stop for stop in route.stops if stop.certain]
    items: list[dict[str, Any]] = []
    for stop in straight:
        seconds = sum(work.seconds for work in stop.work if work.certain)
        points = [*stop.way[1:]] or [stop.stand]
        for at in points[:-1]:
            items.append(_item(at, 0.0, len(items) + 1))
        items.append(_item(points[-1], seconds, len(items) + 1))
    plan = {
        "fileType": "Plan",
        "version": 1,
        "groundStation": "QGroundControl",
        "geoFence": {"version": 2, "circles": [], "polygons": _fence(site)},
        "rallyPoints": {"version": 2, "points": []},
        "mission": {
            "version": 2,
            "firmwareType": _ARDUPILOT,
            "vehicleType": _ROVER,
            "globalPlanAltitudeMode": _RELATIVE,
            "cruiseSpeed": route.speed_m_s,
            "hoverSpeed": route.speed_m_s,
            "plannedHomePosition": [*_rounded(route.start), 0],
            "items": items,
        },
    }
    data = (json.dumps(plan, indent=4) + "\n").encode()
    return GroundStationPlan(data=data, stops=len(straight), left_out=len(route.stops) - len(straight))


def _item(at: LatLon, hold_s: float, number: int) -> dict[str, Any]:
    """Return a waypoint: wait in seconds, radii (vehicle defaults), heading (any), latitude, longitude, altitude."""
    return {
        "type": "SimpleItem",
        "autoContinue": True,
        "command": _WAYPOINT,
        "doJumpId": number,
        "frame": _FRAME,
        "params": [round(hold_s, 1), 0, 0, None, *_rounded(at), 0],
        "AMSLAltAboveTerrain": None,
        "Altitude": 0,
        "AltitudeMode": _RELATIVE,
    }


def _fence(site: Site) -> list[dict[str, Any]]:
    """Return boundaries as inclusion fences and keep-out zones as exclusion fences, with holes inverted."""
    found = []
    for kind, inside in (("boundary", True), ("keep_out", False)):
        for zone in site.zones:
            if zone.kind != kind:
                continue
            rings = [(zone.polygon.exterior, inside), *((ring, not inside) for ring in zone.polygon.interiors)]
            for ring, inclusion in rings:
                corners = site.projection.lat_lon(np.asarray(ring.coords)[:-1, :2])
                polygon = [_rounded(at) for at in corners]
                found.append({"version": 1, "inclusion": inclusion, "polygon": polygon})
    return found


def _rounded(at: LatLon) -> list[float]:
    return [round(at[0], 9), round(at[1], 9)]
