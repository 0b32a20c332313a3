"""What came of a drive or a capture, written down when it is over."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.execution.drivers.protocol import DriveGoal, Progress
from fieldhand.language import message
from fieldhand.robot.model import Action, RobotProfile
from fieldhand.task.results import Acted, Arrived

if TYPE_CHECKING:
    from fieldhand.execution.attempt import Attempt


@dataclass(frozen=True, kw_only=True)
class OpenDrive:
    """A drive that the driver has begun and whose end is not recorded yet."""

    node: str
    goal: DriveGoal


@dataclass(frozen=True, kw_only=True)
class OpenCapture:
    """A capture that the driver has begun and whose end is not recorded yet."""

    node: str
    action: str
    number: int


def end_drive(attempt: Attempt, open_: OpenDrive, progress: Progress) -> None:
    """A drive is over: the robot has arrived, or stands somewhere on the way."""
    attempt.travelled_m += progress.metres
    if progress.state != "succeeded":
        attempt.stranded()
        return
    place = open_.goal.place
    attempt.stop_at(place)
    position = attempt.driver.position()
    attempt.emit(
        Arrived(
            t=attempt.t,
            node=open_.node,
            kind=place.kind,
            place=place.id,
            lat=position.lat,
            lon=position.lon,
            leg_m=progress.metres,
            travelled_m=attempt.travelled_m,
            charge_percent=attempt.charge_percent(),
        )
    )


def end_capture(attempt: Attempt, open_: OpenCapture, progress: Progress) -> Progress:
    """A capture is over.

    Returns:
        What came of it: one whose readings cannot be believed has failed.
    """
    action = attempt.robot.action[open_.action]
    attempt.action_j += joules_done(action, progress)
    if progress.state in ("cancelled", "cut_off"):
        return progress  # nothing was done, so nothing happened; or it is in doubt, and that was said
    measures = action.measures
    if progress.state == "succeeded":
        what = next(filter(None, (unusable(attempt.robot, q, progress.readings.get(q)) for q in measures)), "")
        if what:
            progress = dataclasses.replace(progress, state="failed", fault="failed", readings={}, what=what)
    done, here = progress.state == "succeeded", attempt.here
    attempt.emit(
        Acted(
            t=attempt.t,
            node=open_.node,
            action=open_.action,
            status="success" if done else "failed",
            kind=here.kind,
            place=here.id,
            lat=here.lat,
            lon=here.lon,
            attempt=open_.number,
            readings={q: progress.readings[q] for q in measures} if done else {},
            units={q: attempt.robot.quantity[q].unit for q in measures} if done else {},
            what=progress.what,
            charge_percent=attempt.charge_percent(),
        )
    )
    return progress


def joules_done(action: Action, progress: Progress) -> float:
    """Return the energy that a capture has taken so far, by the profile."""
    return action.energy_j * min(1.0, progress.seconds / action.duration_s)


def unusable(robot: RobotProfile, name: str, value: float | None) -> str:
    """Why a reading cannot be believed; empty if it can."""
    quantity = robot.quantity[name]
    if value is None:
        return message("the sensor gave no {quantity}", context="log", quantity=name)
    if not math.isfinite(value) or not quantity.minimum <= value <= quantity.maximum:
        return message(
            "{quantity} {reading} is outside {low} to {high}: the sensor cannot be believed",
            context="log",
            quantity=name,
            reading=f"{value:g} {quantity.unit}",
            low=f"{quantity.minimum:g}",
            high=f"{quantity.maximum:g}",
        )
    return ""
