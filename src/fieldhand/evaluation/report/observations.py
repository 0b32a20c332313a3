"""Observations of a mission as tables for other programs: CSV (RFC 4180) and GeoJSON (RFC 7946)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from fieldhand.task.results import Acted, Event, InDoubt
from fieldhand.visible import csv_text, visible_json

COLUMNS = (
    "t_s",
    "node",
    "kind",
    "place",
    "lat",
    "lon",
    "action",
    "status",
    "attempt",
    "quantity",
    "value",
    "unit",
    "charge_percent",
    "what",
)


def observations_csv(events: Sequence[Event]) -> str:
    """Return CSV with a row per reading, and per capture that read nothing, failed or is in doubt.

    Times are seconds, positions degrees WGS 84. Text that a spreadsheet would evaluate gets a leading apostrophe.
    """
    rows: list[tuple[object, ...]] = [COLUMNS]
    for event in _tried(events):
        readings: list[tuple[str, float | None]] = [*sorted(event.readings.items())]
        for quantity, value in readings or [("", None)]:
            row = (
                round(event.t, 3),
                event.node,
                event.kind,
                event.place,
                event.lat,
                event.lon,
                event.action,
                event.status,
                event.attempt,
                quantity,
                value if value is not None and math.isfinite(value) else "",
                event.units.get(quantity, ""),
                round(event.charge_percent, 3),
                event.what,
            )
            rows.append(row)
    return csv_text(rows)


def observations_geojson(events: Sequence[Event]) -> str:
    """Return GeoJSON with a point per capture: readings as properties by quantity, units as ``<quantity>_unit``."""
    features = [_feature(event) for event in _tried(events)]
    return visible_json({"type": "FeatureCollection", "features": features}, indent=1) + "\n"


def _tried(events: Sequence[Event]) -> list[Acted | InDoubt]:
    """Return the captures, with those that may or may not have been made."""
    return [e for e in events if isinstance(e, Acted | InDoubt)]


def _feature(event: Acted | InDoubt) -> dict[str, Any]:
    properties: dict[str, Any] = {
        "t_s": round(event.t, 3),
        "node": event.node,
        "kind": event.kind,
        "place": event.place,
        "action": event.action,
        "status": event.status,
        "attempt": event.attempt,
    }
    for quantity, value in sorted(event.readings.items()):
        properties[quantity] = value if math.isfinite(value) else None
        if quantity in event.units:
            properties[f"{quantity}_unit"] = event.units[quantity]
    if event.what:
        properties["what"] = event.what
    known = math.isfinite(event.lat) and math.isfinite(event.lon)
    geometry = {"type": "Point", "coordinates": [round(event.lon, 8), round(event.lat, 8)]} if known else None
    return {"type": "Feature", "geometry": geometry, "properties": properties}
