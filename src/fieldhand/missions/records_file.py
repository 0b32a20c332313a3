"""The file of earlier missions in the folder of a standing mission's run (JSON)."""

from __future__ import annotations

from dataclasses import asdict

from fieldhand.errors import TaskError
from fieldhand.hidden_characters import json_text
from fieldhand.language import message
from fieldhand.site.earlier_missions import EarlierMissions


def records_json(records: EarlierMissions) -> bytes:
    """Return earlier missions as JSON."""
    return json_text(asdict(records)).encode()


def records_from_json(data: bytes) -> EarlierMissions:
    """Return earlier missions from JSON.

    Raises:
        TaskError: It is no JSON of earlier missions.
    """
    from pydantic import TypeAdapter, ValidationError

    try:
        return TypeAdapter(EarlierMissions).validate_json(data)
    except (ValidationError, RecursionError):
        raise TaskError(
            message("is not a record of earlier missions"), advice=message("run the Task as a new mission")
        ) from None
