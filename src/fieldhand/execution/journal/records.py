"""Records of a mission's inputs as JSON: answers of the robot, the guard and the operator."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

from fieldhand import errors
from fieldhand.errors import FieldhandError, JournalError
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Position, Progress
from fieldhand.execution.operator_commands import OperatorCommand
from fieldhand.execution.unobserved_drive import UnobservedDrive, unobserved_of
from fieldhand.forecast.failsafe_state import FailsafeForecast
from fieldhand.forecast.mission_state import Verdict, VisitChoice
from fieldhand.task.results import ImageFile

#: ``sight``: an observation. ``begun``: a goal is about to start. ``cancel``: its cancellation was requested.
#: ``admit``, ``choose``: an answer of the guard. ``cut``: a power cut. ``interrupt``: a second Ctrl-C.
#: ``foresee``: an alarm of the failsafe; other answers of it are not recorded.
RecordKind = Literal["sight", "begun", "cancel", "admit", "choose", "foresee", "cut", "interrupt"]


@dataclass(frozen=True, kw_only=True)
class Record:
    """One answer; ``body`` is its JSON."""

    kind: str
    body: str


class InputLog(Protocol):
    """Log of inputs and events, in order."""

    def next(self) -> Record | None:
        """Return the next recorded answer, or None once they are used up."""
        ...

    def append(self, record: Record) -> None:
        """Append an answer; :meth:`commit` syncs it."""
        ...

    def event(self, line: str) -> None:
        """Append an event. During a replay it must equal the recorded one, but for defaults of fields added since.

        Raises:
            JournalError: It differs.
        """
        ...

    def commit(self, *, order: int = 0) -> None:
        """Write what was appended to the disk and sync it.

        Args:
            order: Number of the last operator command that was read.

        Raises:
            JournalError: It cannot be written (a full disk).
        """
        ...

    @property
    def has_new_events(self) -> bool:
        """True if there are events that are not committed."""
        ...


@dataclass(frozen=True, kw_only=True)
class Observation:
    """Robot, time and operator command as observed at one instant.

    Attributes:
        lost: Why the position is unknown; None if it is known.
        wall: Time of day in seconds since 1970; None if there is none.
        next_in: Seconds until the driver is due; None if no goal is running.
        events: Value of each event that the mission watches; None for one that is unknown.
        away, taken: As :class:`~fieldhand.execution.drivers.protocol.SharedNavigation`.
        odometer_m: Reading of the robot's odometer; None if it has none.
        unobserved: What the robot drove on during a power cut, which ``progress`` includes; None for nothing.
        absent_s: Seconds for which nobody looked at the robot before, because of a power cut.
    """

    t: float
    position: Position
    charge_percent: float
    progress: Progress
    stopped: str | None
    lost: str | None
    next_in: float | None
    order: OperatorCommand | None
    wall: float | None = None
    events: Mapping[str, float | None] = field(default_factory=dict)
    away: str | None = None
    taken: str | None = None
    odometer_m: float | None = None
    unobserved: UnobservedDrive | None = None
    absent_s: float = 0.0

    def record(self) -> Record:
        """Return the record of the observation."""
        p, g, o = self.position, self.progress, self.order
        body: dict[str, Any] = {
            "t": self.t,
            "at": [p.x, p.y, p.lat, p.lon, *(() if p.heading_deg is None else (p.heading_deg,))],
            "charge": self.charge_percent,
            "goal": [g.state, g.metres, g.seconds, dict(g.readings), g.what, g.fault],
            "stopped": self.stopped,
            "lost": self.lost,
            "wall": self.wall,
            "next_in": self.next_in,
            "order": None if o is None else [o.number, o.wanted, o.reason],
        }
        if self.events:
            body["events"] = dict(self.events)
        body |= {name: why for name, why in (("away", self.away), ("taken", self.taken)) if why is not None}
        if g.files:
            body["images"] = [dataclasses.asdict(file) for file in g.files]
        if self.odometer_m is not None:
            body["odometer"] = self.odometer_m
        if self.absent_s:
            body["absent"] = self.absent_s
        if self.unobserved is not None:
            body["unobserved"] = [self.unobserved.metres, self.unobserved.seconds, self.unobserved.by]
        return Record(kind="sight", body=json.dumps(body))


def observation_of(record: Record) -> Observation:
    """Return the observation of a record.

    Raises:
        JournalError: The record is not valid.
    """
    try:
        body = json.loads(record.body)
        x, y, lat, lon, *heading = body["at"]
        state, metres, seconds, readings, what, fault = body["goal"]
        order, unobserved = body["order"], body.get("unobserved")
        return Observation(
            t=float(body["t"]),
            position=Position(x=x, y=y, lat=lat, lon=lon, heading_deg=heading[0] if heading else None),
            charge_percent=float(body["charge"]),
            progress=Progress(
                state=state,
                metres=metres,
                seconds=seconds,
                readings=readings,
                what=what,
                fault=fault,
                files=tuple(ImageFile(**file) for file in body.get("images", ())),
            ),
            stopped=body["stopped"],
            lost=body["lost"],
            wall=body["wall"],
            next_in=body["next_in"],
            order=None if order is None else OperatorCommand(number=order[0], wanted=order[1], reason=order[2]),
            events=body.get("events", {}),
            away=body.get("away"),
            taken=body.get("taken"),
            odometer_m=body.get("odometer"),
            absent_s=body.get("absent", 0.0),
            unobserved=None if unobserved is None else unobserved_of(*unobserved),
        )
    except (ValueError, KeyError, TypeError) as error:
        raise invalid_record(error) from None


def goal_record(goal: DriveGoal | ActionGoal) -> Record:
    """Return the record of a goal that starts, with everything that distinguishes it."""
    place = [goal.place.kind, goal.place.id]
    if isinstance(goal, DriveGoal):
        body: dict[str, Any] = {"drive": place, "from": goal.path_m[0], "to": goal.path_m[-1], "m": goal.length_m}
        if goal.work is not None:
            body |= {"action": goal.work.action, "parameters": dict(goal.work.parameters), "on": goal.work.on}
    else:
        body = {"action": goal.action, "place": place, "parameters": dict(goal.parameters)}
    return Record(kind="begun", body=json.dumps(body))


def answer_record(kind: RecordKind, node: str, answer: Verdict | VisitChoice | FieldhandError) -> Record:
    """Return the record of the guard's answer about a node, or of the error that it raised."""
    fields: dict[str, Any]
    if isinstance(answer, FieldhandError):
        fields = {"error": [type(answer).__name__, answer.what, answer.where, answer.advice]}
    else:
        fields = {"answer": dataclasses.asdict(answer)}
    return Record(kind=kind, body=json.dumps({"node": node, **fields}))


def verdict_of(record: Record, node: str) -> Verdict:
    """Return the verdict of a record about a node, or raise the recorded error.

    Raises:
        JournalError: The record is not valid, or about another node.
    """
    answer = _answer(record, node)
    try:
        return Verdict(**answer)
    except TypeError as error:
        raise invalid_record(error) from None


def choice_of(record: Record, node: str) -> VisitChoice:
    """Return the choice of a record about a node; as :func:`verdict_of`."""
    answer = _answer(record, node)
    try:
        return VisitChoice(**{**answer, "shed": tuple(answer["shed"])})
    except (TypeError, KeyError) as error:
        raise invalid_record(error) from None


def foresight_record(forecast: FailsafeForecast) -> Record:
    """Return the record of an alarm of the failsafe."""
    return Record(kind="foresee", body=json.dumps(dataclasses.asdict(forecast)))


def foresight_of(record: Record) -> FailsafeForecast:
    """Return the alarm of a record.

    Raises:
        JournalError: The record is not valid.
    """
    try:
        return FailsafeForecast(**json.loads(record.body))
    except (ValueError, TypeError) as error:
        raise invalid_record(error) from None


def _answer(record: Record, node: str) -> Mapping[str, Any]:
    try:
        body = json.loads(record.body)
        about, error, answer = body["node"], body.get("error"), body.get("answer")
    except (ValueError, KeyError, TypeError, AttributeError) as fault:
        raise invalid_record(fault) from None
    if about != node:
        raise divergence(f"the guard was asked about {about}, now it is asked about {node}")
    if error is not None:
        raise _error(error)
    if not isinstance(answer, dict):
        raise invalid_record("an answer of the guard is missing")
    return answer


def _error(parts: Sequence[str]) -> FieldhandError:
    name, what, where, advice = parts
    kind = getattr(errors, name, FieldhandError) if name in errors.__all__ else FieldhandError
    made: FieldhandError = kind(what, where=where, advice=advice)
    return made


def invalid_record(why: object) -> JournalError:
    """Return the error for a record that is invalid."""
    return JournalError(
        f"the journal contains something that no mission wrote ({why})", advice="run the Task as a new mission"
    )


def divergence(why: str) -> JournalError:
    """Return the error for a mission that deviates from its record."""
    return JournalError(
        f"the mission does not proceed as the journal records it: {why}",
        advice="resume it with the version of Fieldhand that started it, or run the Task as a new mission",
    )
