"""Goals that have begun and whose end is not recorded yet, and plausibility of readings."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fieldhand.execution.drivers.protocol import DriveGoal, Progress
from fieldhand.language import message
from fieldhand.robot.model import Action, RobotProfile
from fieldhand.site.working.stretch import Stretch
from fieldhand.task.nodes.work_along import WorkAlong


@dataclass(frozen=True, kw_only=True)
class OpenDrive:
    """A drive that the driver has begun and whose end is not recorded yet."""

    node: str
    goal: DriveGoal


@dataclass(frozen=True, kw_only=True)
class OpenStretch(OpenDrive):
    """Work along a stretch that the driver has begun and whose end is not recorded yet; ``number`` counts attempts."""

    work: WorkAlong
    stretch: Stretch
    number: int

    def done(self, reached_m: float) -> Stretch | None:
        """Return the part of the stretch up to a distance along it; None if it is nothing."""
        return self.stretch.part(0.0, reached_m)


@dataclass(frozen=True, kw_only=True)
class OpenCapture:
    """A capture that the driver has begun and whose end is not recorded yet; ``number`` counts its attempts."""

    node: str
    action: str
    number: int


@dataclass(frozen=True, kw_only=True)
class OpenManeuver:
    """Docking or undocking that the driver has begun; ``number`` counts its attempts."""

    node: str
    action: str
    number: int


def joules_done(action: Action, progress: Progress) -> float:
    """Return the energy used so far by a capture in joules, by the profile."""
    return action.energy_j * min(1.0, progress.seconds / action.duration_s)


def unusable(robot: RobotProfile, name: str, value: float | None) -> str:
    """Return why a reading is implausible; empty if it is plausible."""
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
