"""Convert events to lines of an event log and back. Logs are untrusted, so every field is validated."""

from __future__ import annotations

import dataclasses
import json
import math
from functools import cache
from typing import TYPE_CHECKING, Any, get_args

from fieldhand.errors import TaskError
from fieldhand.hidden_characters import json_text
from fieldhand.task.results import Event, Shed

if TYPE_CHECKING:
    from pydantic import TypeAdapter

#: Beginnings of reasons in logs of earlier versions that named the places left out.
_NAMED_PLACES = ("skipped ", "left out ", "there is no way to ")

_TYPES: dict[str, type[Event]] = {kind.event: kind for kind in get_args(Event)}


def to_json(event: Event) -> str:
    """Return an event as one line of an event log."""
    fields = {f.name: getattr(event, f.name) for f in dataclasses.fields(event)}
    if images := fields.get("images"):
        fields["images"] = [dataclasses.asdict(image) for image in images]
    return json_text({"event": event.event, **fields})


def from_json(line: str, *, where: str = "") -> Event | None:
    """Return the event in a line of an event log; None for an event type unknown to this version.

    Raises:
        TaskError: The line is not JSON, or a field of the event is missing or invalid.
    """
    try:
        record: dict[str, Any] = json.loads(line)
        kind = _TYPES.get(record.pop("event"))
        if kind is None:
            return None
        record = _of_earlier_version(kind, record)
        known = {f.name for f in dataclasses.fields(kind)}
        return _checked(kind, {key: value for key, value in record.items() if key in known})
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise TaskError(
            f"not an event: {' '.join(str(error).split())[:200]}", where=where, advice="was the log cut off or edited?"
        ) from None


def is_same(line: str, recorded: str) -> bool:
    """Return True if a line equals a recorded one, but for fields that are at their default and were added since."""
    if line == recorded:
        return True
    try:
        now, before = json.loads(line), json.loads(recorded)
        kind = _TYPES[before["event"]]
    except (ValueError, KeyError, TypeError):
        return False
    new = [f for f in dataclasses.fields(kind) if f.name not in before]
    if any(f.default is dataclasses.MISSING for f in new):
        return False
    added = json.loads(json_text({f.name: f.default for f in new}))
    return bool(now == {**added, **before})


def _of_earlier_version(kind: type[Event], record: dict[str, Any]) -> dict[str, Any]:
    """Return the fields of an event with those that earlier versions expressed by words in others.

    The reason of a ``Shed`` without ``names_places`` named the places if it began with one of a few words.
    """
    reason = record.get("reason")
    if kind is not Shed or "names_places" in record or not isinstance(reason, str):
        return record
    if not record.get("optional") or not reason.startswith(_NAMED_PLACES):
        return record
    return {**record, "names_places": True, "reason": reason.removeprefix("skipped ").removeprefix("left out ")}


def _checked(kind: type[Event], record: dict[str, Any]) -> Event:
    """Return an event whose fields have their declared types."""
    from pydantic import ValidationError

    try:
        event = _adapters()[kind.event].validate_json(json.dumps(record), strict=True)
    except ValidationError as error:
        wrong = error.errors(include_url=False)[0]
        name = str(wrong["loc"][0]) if wrong["loc"] else "a field"
        value = json.dumps(record.get(name), default=str)[:60]
        raise ValueError(f"{name} cannot be {value}" if name in record else f"{name} is missing") from None
    for f in dataclasses.fields(kind):
        found = getattr(event, f.name)
        if isinstance(found, float) and not math.isfinite(found):
            raise ValueError(f"{f.name} cannot be {found}")
    return event


@cache
def _adapters() -> dict[str, TypeAdapter[Event]]:
    from pydantic import TypeAdapter

    return {name: TypeAdapter(kind) for name, kind in _TYPES.items()}
