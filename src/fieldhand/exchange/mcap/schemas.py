"""JSON schemas of the messages in a file: events, derived from their classes, and the messages of Foxglove's panels.

The names and fields of the latter are those of Foxglove's message schemas (docs.foxglove.dev, "Message schemas").
"""

from __future__ import annotations

import dataclasses
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from fieldhand.task.results import Event

DRAFT = "https://json-schema.org/draft/2020-12/schema"
#: Prefix of the event topics, followed by the name of the event.
EVENTS = "/mission/"

_NUMBER, _TEXT = {"type": "number"}, {"type": "string"}
_TIME = {
    "type": "object",
    "title": "time",
    "properties": {"sec": {"type": "integer", "minimum": 0}, "nsec": {"type": "integer", "minimum": 0}},
    "required": ["sec", "nsec"],
}

LOCATION = {
    "title": "foxglove.LocationFix",
    "type": "object",
    "properties": {
        "timestamp": _TIME,
        "frame_id": _TEXT,
        "latitude": _NUMBER,
        "longitude": _NUMBER,
        "altitude": _NUMBER,
        "position_covariance": {"type": "array", "items": _NUMBER, "minItems": 9, "maxItems": 9},
        "position_covariance_type": {"title": "foxglove.PositionCovarianceType", "enum": [0, 1, 2, 3]},
    },
    "required": [
        "timestamp", "frame_id", "latitude", "longitude", "altitude", "position_covariance", "position_covariance_type",
    ],
}  # fmt: skip
GEOJSON = {"title": "foxglove.GeoJSON", "type": "object", "properties": {"geojson": _TEXT}, "required": ["geojson"]}
LOG = {
    "title": "foxglove.Log",
    "type": "object",
    "properties": {
        "timestamp": _TIME,
        "level": {"title": "foxglove.LogLevel", "enum": [0, 1, 2, 3, 4, 5]},
        "message": _TEXT,
        "name": _TEXT,
        "file": _TEXT,
        "line": {"type": "integer", "minimum": 0},
    },
    "required": ["timestamp", "level", "message", "name", "file", "line"],
}
IMAGE = {
    "title": "foxglove.CompressedImage",
    "type": "object",
    "properties": {
        "timestamp": _TIME,
        "frame_id": _TEXT,
        "data": {"type": "string", "contentEncoding": "base64"},
        "format": _TEXT,
    },
    "required": ["timestamp", "frame_id", "data", "format"],
}
STATE = {
    "title": "fieldhand.State",
    "type": "object",
    "properties": {
        "charge_percent": _NUMBER,
        "travelled_m": _NUMBER,
        "readings": {"type": "object", "additionalProperties": _NUMBER},
    },
}


def schema_of(event: type[Event]) -> dict[str, Any]:
    """Return the schema of one kind of event, as stored in a line of an event log."""
    hints = get_type_hints(event)
    fields = dataclasses.fields(event)
    return {
        "$schema": DRAFT,
        "title": f"fieldhand.{event.__name__}",
        "type": "object",
        "properties": {"event": {"const": event.event}} | {f.name: _of_hint(hints[f.name]) for f in fields},
        "required": ["event", *(f.name for f in fields)],
    }


def _of_hint(hint: Any) -> dict[str, Any]:
    origin, inner = get_origin(hint), get_args(hint)
    plain = {str: _TEXT, float: _NUMBER, int: {"type": "integer"}, bool: {"type": "boolean"}}
    if hint in plain:
        return plain[hint]
    if origin is Literal:
        return {"enum": list(inner)}
    if origin in (Union, UnionType):
        return {"anyOf": [{"type": "null"} if one is NoneType else _of_hint(one) for one in inner]}
    if dataclasses.is_dataclass(hint):
        hints = get_type_hints(hint)
        return {"type": "object", "properties": {f.name: _of_hint(hints[f.name]) for f in dataclasses.fields(hint)}}
    if origin is tuple:
        length = {} if inner[-1] is ... else {"minItems": len(inner), "maxItems": len(inner)}
        return {"type": "array", "items": _of_hint(inner[0])} | length
    return {"type": "object", "additionalProperties": _of_hint(inner[1])}
