"""A planned route as a QGroundControl plan (file format version 1) for a ground rover.

A plan of a ground station is a list of waypoints: it knows no condition, no reading and no budget. So it holds the
straight part of a mission, as far as every branch drives the same ways, and the boundary and keep-outs as a fence. At a
stop the robot waits as long as the certain work there takes; what it does there a waypoint cannot say.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from fieldhand.exchange.incidents import LatLon
from fieldhand.exchange.routes.route import Route
from fieldhand.site.model import Site

#: Of MAVLink: MAV_CMD_NAV_WAYPOINT, MAV_FRAME_GLOBAL_RELATIVE_ALT, MAV_TYPE_GROUND_ROVER, MAV_AUTOPILOT_ARDUPILOTMEGA.
_WAYPOINT, _FRAME, _ROVER, _ARDUPILOT = 16, 3, 10, 3
#: The kind of height of an item: relative to home.
_RELATIVE = 1


@dataclass(frozen=True, kw_only=True)
class GroundStationPlan:
    """A plan and what of the route is in it.

    Attributes:
        stops: Stops of the route that are in it.
        left_out: Stops that are not, since they hang on a reading or on the budget.
    """

    data: bytes
    stops: int
    left_out: int


def write_plan(route: Route, site: Site) -> GroundStationPlan:
    """The straight part of a planned route."""
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
    """A waypoint: seconds to wait, radii (the vehicle's own), heading (any), latitude, longitude, height."""
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
    """Boundaries to stay inside of and keep-outs to stay outside of; holes of a polygon turn it round."""
    found = []
    for kind, inside in (("boundary", True), ("keep_out", False)):
        for zone in site.zones:
            if zone.kind != kind:
                continue
            rings = [(zone.polygon.exterior, inside), *((ring, not inside) for ring in zone.polygon.interiors)]
            for ring, inclusion in rings:
                corners = site.projection.degrees(np.asarray(ring.coords)[:-1, :2])
                polygon = [_rounded((float(lat), float(lon))) for lat, lon in corners]
                found.append({"version": 1, "inclusion": inclusion, "polygon": polygon})
    return found


def _rounded(at: LatLon) -> list[float]:
    return [round(at[0], 9), round(at[1], 9)]
