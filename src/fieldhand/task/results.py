"""The results frame: what happened, as events, and what came of each goal, as outcomes.

An event log is one JSON object a line, in the order in which things happened: ``event`` names the type, the other keys
are the fields below. Execution writes events; evaluation reads them; other programs may, too. Every event has ``t``
(seconds since the mission began) and ``node`` (id of the plan node, empty where none is meant). Degrees are WGS 84.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any, ClassVar, Literal, get_args, get_origin, get_type_hints

from fieldhand.errors import TaskError

MissionStatus = Literal["completed", "returned", "faulted", "aborted"]


@dataclass(frozen=True, kw_only=True)
class Started:
    """The mission begins. ``seed`` is None where the robot is real."""

    event: ClassVar[str] = "started"
    t: float
    node: str = ""
    task: str
    robot: str
    site: str
    lat: float
    lon: float
    charge_percent: float
    seed: int | None = None


@dataclass(frozen=True, kw_only=True)
class Visiting:
    """A for-each has resolved its selector: the ids of its places in the order planned."""

    event: ClassVar[str] = "visiting"
    t: float
    node: str
    places: tuple[str, ...]
    optional: bool = False


@dataclass(frozen=True, kw_only=True)
class Driving:
    """A drive begins; ``path`` holds its corners as (lat, lon)."""

    event: ClassVar[str] = "drive"
    t: float
    node: str
    kind: str
    place: str
    planned_m: float
    path: tuple[tuple[float, float], ...]


@dataclass(frozen=True, kw_only=True)
class Arrived:
    """A drive is done: where the robot is, what the leg cost and what was driven in all."""

    event: ClassVar[str] = "arrive"
    t: float
    node: str
    kind: str
    place: str
    lat: float
    lon: float
    leg_m: float
    travelled_m: float
    charge_percent: float


@dataclass(frozen=True, kw_only=True)
class Acted:
    """An action is done or has failed. ``lat``/``lon`` are those of the tree or point that it was done at.

    ``readings`` holds the value of each quantity measured, in the unit of the profile. ``count`` is 1: every capture is
    an event of its own.
    """

    event: ClassVar[str] = "action"
    t: float
    node: str
    action: str
    status: Literal["success", "failed"]
    kind: str
    place: str
    lat: float
    lon: float
    count: int = 1
    attempt: int = 1
    readings: Mapping[str, float] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    what: str = ""
    charge_percent: float = 100.0


@dataclass(frozen=True, kw_only=True)
class Decided:
    """A condition was tested; ``why`` says it in words ("canopy_temperature 31.2 degC is below 33 degC")."""

    event: ClassVar[str] = "condition"
    t: float
    node: str
    holds: bool
    why: str


@dataclass(frozen=True, kw_only=True)
class Shed:
    """Work was given up to stay inside the budget: which places, and why."""

    event: ClassVar[str] = "shed"
    t: float
    node: str
    places: tuple[str, ...]
    optional: bool
    reason: str
    chance_short: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Faulted:
    """Something failed for good, or was retried and worked around (``handled``)."""

    event: ClassVar[str] = "fault"
    t: float
    node: str
    fault: str
    what: str
    handled: bool = False


@dataclass(frozen=True, kw_only=True)
class Exited:
    """The plan is over and the mission takes an exit; ``node`` is the ``Stop`` that ended the plan, if one did."""

    event: ClassVar[str] = "exit"
    t: float
    node: str = ""
    exit: Literal["nominal", "faulted"]
    then: str
    reason: str = ""


@dataclass(frozen=True, kw_only=True)
class Ended:
    """The mission is over: where the robot is and what was used.

    ``completed``: the plan was done and its exit taken. ``returned``: the budget guard brought the robot home before
    the plan was done. ``faulted``: a fault ended it. ``aborted``: a person did.
    """

    event: ClassVar[str] = "mission"
    t: float
    node: str = ""
    status: MissionStatus
    lat: float
    lon: float
    travelled_m: float
    charge_percent: float
    reason: str = ""


Event = Started | Visiting | Driving | Arrived | Acted | Decided | Shed | Faulted | Exited | Ended

_TYPES: dict[str, type[Event]] = {
    c.event: c for c in (Started, Visiting, Driving, Arrived, Acted, Decided, Shed, Faulted, Exited, Ended)
}


def to_json(event: Event) -> str:
    """An event as one line of an event log."""
    fields = {f.name: getattr(event, f.name) for f in dataclasses.fields(event)}
    return json.dumps({"event": event.event, **fields}, ensure_ascii=False, default=dict)


def from_json(line: str, *, where: str = "") -> Event | None:
    """An event from a line of an event log; None for an event type that this version does not know.

    Raises:
        TaskError: The line is not JSON, or lacks a field of its event.
    """
    try:
        record: dict[str, Any] = json.loads(line)
        kind = _TYPES.get(record.pop("event"))
        if kind is None:
            return None
        hints = _hints(kind.event)
        found = {key: _frozen(value) for key, value in record.items() if key in hints}
        for key, value in found.items():
            if not _fits(value, hints[key]):
                raise ValueError(f"{key} cannot be {json.dumps(value)[:60]}")
        return kind(**found)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise TaskError(f"not an event: {error}", where=where, advice="was the log cut off or edited?") from None


@cache
def _hints(event: str) -> dict[str, Any]:
    """The types of the fields of an event, by its name."""
    kind = _TYPES[event]
    hints = get_type_hints(kind)
    return {f.name: hints[f.name] for f in dataclasses.fields(kind)}


def _fits(value: Any, hint: Any) -> bool:
    """Whether a value that was read is of a field's type; logs come from other programs, too."""
    origin, inner = get_origin(hint), get_args(hint)
    if hint is float:
        return isinstance(value, float) or (type(value) is int and abs(value) < 1 << 64)
    if origin is Literal:
        return isinstance(value, str) and value in inner
    if origin is tuple:
        each = inner[:1] * len(value) if isinstance(value, tuple) and inner[-1] is ... else inner
        return isinstance(value, tuple) and len(value) == len(each) and all(map(_fits, value, each))
    if origin is Mapping:
        return isinstance(value, dict) and all(_fits(one, inner[1]) for one in value.values())
    if origin is None:
        return type(value) is hint
    return any(_fits(value, one) for one in inner)


def _frozen(value: Any) -> Any:
    return tuple(_frozen(v) for v in value) if isinstance(value, list) else value


@dataclass(frozen=True, kw_only=True)
class GoalOutcome:
    """What came of a goal.

    Attributes:
        done: Captures that succeeded.
        wanted: Captures that were asked for on the branch that was taken; None where it is not known (cut off before).
        why: In words.
    """

    goal: str
    outcome: Literal["success", "failure", "indeterminate"]
    done: int
    wanted: int | None
    why: str
