"""Measured steps of a mission: its legs and captures with their cost, from its event log."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from fieldhand.errors import InputError
from fieldhand.robot.model import RobotProfile
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import (
    Acted,
    Arrived,
    Decided,
    Driving,
    Dwelt,
    Ended,
    Event,
    Shed,
    Started,
    Visiting,
)

MeasuredKind = Literal["leg", "capture", "rest"]

#: A capture begins where one of these ends; behind a fault, a pause or a power cut nobody knows since when it took.
_PROMPT = (Arrived, Acted, Dwelt, Decided, Visiting, Shed)
#: Percent by which a charge may seem to rise between two readings of it.
_NOISE_PERCENT = 0.5


@dataclass(frozen=True, kw_only=True)
class MeasuredStep:
    """The time between two readings of the charge: a leg, a capture, or the rest.

    Attributes:
        kind: Kind of step.
        name: The action of a capture; else empty.
        planned_m: Length of the leg as planned.
        metres: Driven, by odometry; of a leg the leg's own.
        seconds: Duration of the leg or capture; nan if not logged.
        moved_m, whole_s, percent: Driven, passed and used of a full battery since the charge was read before.
        sure: True if those three are known.
        speed_m_s: Commanded speed; nan if not logged.
        done: True if the leg arrived or the capture succeeded.
    """

    kind: MeasuredKind
    name: str = ""
    planned_m: float = 0.0
    metres: float = 0.0
    seconds: float = math.nan
    moved_m: float = 0.0
    whole_s: float = 0.0
    percent: float = 0.0
    sure: bool = True
    speed_m_s: float = math.nan
    done: bool = True


@dataclass(frozen=True, kw_only=True)
class MeasuredMission:
    """A measured mission: its robot and steps.

    Attributes:
        key: SHA-256 of its events: the same mission is kept once.
        simulated: True if it was simulated.
        left_out: Steps whose figures are no numbers.
    """

    key: str
    task: str
    robot: str
    simulated: bool
    steps: tuple[MeasuredStep, ...]
    left_out: int = 0


def measure_mission(events: Sequence[Event], *, where: str = "the log") -> MeasuredMission:
    """Return the measured steps of a mission.

    Raises:
        InputError: The log has no beginning, so that nobody knows which robot it is of.
    """
    started = next((e for e in events if isinstance(e, Started)), None)
    if started is None:
        raise InputError("has no line that identifies its robot", where=where, advice="give a whole event log")
    found = _LogReader(started).read(events)
    sound = tuple(step for step in found if _finite(step))
    digest = hashlib.sha256("\n".join(to_json(e) for e in events).encode("utf-8", errors="replace"))
    return MeasuredMission(
        key=digest.hexdigest(),
        task=started.task,
        robot=started.robot,
        simulated=started.seed is not None,
        steps=sound,
        left_out=len(found) - len(sound),
    )


def predicted(step: MeasuredStep, robot: RobotProfile) -> tuple[float, float]:
    """Return seconds and percent of a full battery that a profile predicts for a leg or a capture."""
    if step.kind == "leg":
        speed = robot.speed_m_s if math.isnan(step.speed_m_s) else min(robot.speed_m_s, step.speed_m_s)
        seconds = step.planned_m / speed
        return seconds, robot.percent(step.planned_m, seconds)
    action = robot.action.get(step.name)
    if action is None:
        return 0.0, 0.0
    return action.duration_s, robot.percent(0.0, action.duration_s, action.energy_j)


def _finite(step: MeasuredStep) -> bool:
    numbers = (step.planned_m, step.metres, step.moved_m, step.whole_s, step.percent)
    return all(math.isfinite(n) for n in numbers) and not math.isinf(step.seconds) and step.whole_s >= 0


class _LogReader:
    """Reads a log and remembers when the charge was last read."""

    def __init__(self, started: Started) -> None:
        self._charge, self._at_s, self._travelled = started.charge_percent, started.t, 0.0
        self._astray, self._parts = False, 0
        self._steps: list[MeasuredStep] = []

    def read(self, events: Sequence[Event]) -> list[MeasuredStep]:
        before: Event | None = None
        for event in events:
            match event:
                case Driving():
                    # Until the next arrival nobody knows how far it came.
                    self._astray, self._parts = True, self._parts + 1
                case Arrived():
                    self._arrive(event, before)
                case Acted():
                    timed = isinstance(before, _PROMPT) and event.attempt == 1
                    seconds = event.t - before.t if timed and before is not None else math.nan
                    done = event.status == "success"
                    step = MeasuredStep(kind="capture", name=event.action, seconds=seconds, done=done)
                    self._close(step, event.t, event.charge_percent, self._travelled)
                case Ended():
                    self._astray = False
                    self._close(MeasuredStep(kind="rest"), event.t, event.charge_percent, event.travelled_m)
                case _:
                    if hasattr(event, "charge_percent"):
                        # A power cut, a pause: what was used meanwhile belongs to no step.
                        self._charge, self._at_s = event.charge_percent, event.t
            before = event
        return self._steps

    def _arrive(self, event: Arrived, before: Event | None) -> None:
        # A drive in parts, after a pause or at several speeds, is no measurement of one speed.
        leg = before if isinstance(before, Driving) and self._parts == 1 else None
        self._astray, self._parts = False, 0
        step = MeasuredStep(
            kind="leg",
            planned_m=leg.planned_m if leg else 0.0,
            metres=event.leg_m,
            seconds=event.t - leg.t if leg else math.nan,
            speed_m_s=math.nan if leg is None or leg.speed_m_s is None else leg.speed_m_s,
            done=leg is not None,
        )
        self._close(step, event.t, event.charge_percent, event.travelled_m)

    def _close(self, step: MeasuredStep, t: float, charge: float, travelled: float) -> None:
        used = self._charge - charge
        known = not self._astray and used >= -_NOISE_PERCENT
        self._steps.append(
            replace(step, moved_m=travelled - self._travelled, whole_s=t - self._at_s, percent=used, sure=known)
        )
        self._charge, self._at_s, self._travelled = charge, t, travelled
