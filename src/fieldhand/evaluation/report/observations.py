"""Observations of a mission as tables for other programs: CSV (RFC 4180) and GeoJSON (RFC 7946)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields
from typing import Any

from fieldhand.hidden_characters import csv_text, visible_json
from fieldhand.task.results import Acted, Event, InDoubt


@dataclass(frozen=True, kw_only=True)
class ObservationRow:
    """A reading; or a capture that read nothing, failed or is in doubt.

    Attributes:
        t_s: Seconds since the mission began.
        node: Id of the plan node.
        kind, place: Kind and name of the place.
        lat, lon: Degrees, WGS 84.
        action, status, attempt: The capture, its result, and which try it was, counted from 1.
        quantity, value, unit: The reading; empty and None where there is none.
        charge_percent: Charge afterwards, in percent of a full battery.
        what: What the robot reported, in words.
        side: Side of the tree from which it was taken, if the plan says so.
        images: Paths of the images of the capture, with a space between; each as ``images/NAME``.
    """

    t_s: float
    node: str
    kind: str
    place: str
    lat: float
    lon: float
    action: str
    status: str
    attempt: int
    quantity: str
    value: float | None
    unit: str
    charge_percent: float
    what: str
    side: str
    images: str


COLUMNS = tuple(field.name for field in fields(ObservationRow))


def observation_rows(events: Sequence[Event]) -> tuple[ObservationRow, ...]:
    """Return a row per reading, and per capture that read nothing, failed or is in doubt."""
    return tuple(
        ObservationRow(
            t_s=round(event.t, 3),
            node=event.node,
            kind=event.kind,
            place=event.place,
            lat=event.lat,
            lon=event.lon,
            action=event.action,
            status=event.status,
            attempt=event.attempt,
            quantity=quantity,
            value=value if value is not None and math.isfinite(value) else None,
            unit=event.units.get(quantity, ""),
            charge_percent=round(event.charge_percent, 3),
            what=event.what,
            side=event.side,
            images=" ".join(_files(event)),
        )
        for event in _tried(events)
        for quantity, value in _readings_of(event)
    )


def _files(event: Acted | InDoubt) -> list[str]:
    """Return the paths of the images of a capture that were saved."""
    return [image.file for image in event.images if image.file] if isinstance(event, Acted) else []


def _readings_of(event: Acted | InDoubt) -> list[tuple[str, float | None]]:
    return [*sorted(event.readings.items())] or [("", None)]


def observations_csv(events: Sequence[Event]) -> str:
    """Return the rows of :func:`observation_rows` as CSV.

    Times are seconds, positions degrees WGS 84. Text that a spreadsheet would evaluate gets a leading apostrophe.
    """
    rows = (tuple("" if cell is None else cell for cell in astuple(row)) for row in observation_rows(events))
    return csv_text([COLUMNS, *rows])


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
    if files := _files(event):
        properties["images"] = files
    if event.side:
        properties["side"] = event.side
    if event.what:
        properties["what"] = event.what
    known = math.isfinite(event.lat) and math.isfinite(event.lon)
    geometry = {"type": "Point", "coordinates": [round(event.lon, 8), round(event.lat, 8)]} if known else None
    return {"type": "Feature", "geometry": geometry, "properties": properties}
