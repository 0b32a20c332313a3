"""Earlier missions on a site: a summary of what was done and read at its places, drawn up at one moment.

A plan that refers to earlier missions is approved with this summary, so that its places are the same in preview,
approval, on the robot and in a replay. Times are local times of the site with their difference from UTC: the calendar
day of a capture is the date that its time shows.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from functools import cached_property
from typing import Literal

from fieldhand.compatibility import datetime_from_iso
from fieldhand.errors import TaskError
from fieldhand.hidden_characters import visible
from fieldhand.language import message

#: Result of a piece of work: done, failed for good, or planned and not begun.
EarlierOutcome = Literal["done", "failed", "left_out"]


@dataclass(frozen=True, kw_only=True)
class EarlierValue:
    """A measured value of an earlier mission: name of the quantity, value, and unit, empty if the log lacks it."""

    name: str
    value: float
    unit: str = ""


@dataclass(frozen=True, kw_only=True)
class EarlierCapture:
    """A piece of work of an earlier mission at one place.

    Attributes:
        place: Id of the tree, or name of the marker or point.
        at: Local time of the site with its difference from UTC, ISO 8601.
        action: Name of the action; empty for a planned visit that was left out.
        outcome: ``done``; ``failed`` for good; ``left_out``: planned, but not begun.
        kind: Kind of the place.
        lat, lon: Position in degrees (WGS 84) of a place that is no tree of the site; None for a tree.
        values: Measured values.
    """

    place: str
    at: str
    action: str = ""
    outcome: EarlierOutcome = "done"
    kind: Literal["tree", "marker", "point", "gap"] = "tree"
    lat: float | None = None
    lon: float | None = None
    values: tuple[EarlierValue, ...] = ()

    def __post_init__(self) -> None:
        _require_time(self.at)

    @cached_property
    def time(self) -> datetime:
        """Return the time, with time zone."""
        return datetime_from_iso(self.at)

    def value_of(self, quantity: str) -> EarlierValue | None:
        """Return the measured value of a quantity; None if it was not measured."""
        return next((value for value in self.values if value.name == quantity), None)


@dataclass(frozen=True, kw_only=True)
class EarlierMission:
    """An earlier mission on the site.

    Attributes:
        id: Name of the mission in its store; else the id of its Task with the time at which it began.
        begun: Time at which it began, as in :attr:`EarlierCapture.at`.
        simulated: True if it was a simulation.
        ended: False if its log has no end: it was under way or interrupted, and more may follow.
        captures: Its work in the order of time.
    """

    id: str
    begun: str
    simulated: bool = False
    ended: bool = True
    captures: tuple[EarlierCapture, ...] = ()

    def __post_init__(self) -> None:
        _require_time(self.begun)


@dataclass(frozen=True, kw_only=True)
class EarlierMissions:
    """The earlier missions on a site, as far as they were known at one time.

    Attributes:
        as_of: Time at which the summary was drawn up, as in :attr:`EarlierCapture.at`. Periods such as "yesterday" are
            counted from it.
        missions: Missions in the order in which they began.
        moved: Number of captures that are left out because the site no longer has their tree at that position.
        damaged: Number of logs that could not be read.
        simulations: Number of simulated missions on the site that do not count.
        elsewhere: Number of missions that worked elsewhere.
    """

    as_of: str
    missions: tuple[EarlierMission, ...] = ()
    moved: int = 0
    damaged: int = 0
    simulations: int = 0
    elsewhere: int = 0

    def __post_init__(self) -> None:
        _require_time(self.as_of)

    @cached_property
    def time(self) -> datetime:
        """Return the time at which it was drawn up, with time zone."""
        return datetime_from_iso(self.as_of)

    def captures(self) -> Iterator[tuple[EarlierMission, EarlierCapture]]:
        """Yield all work with its mission, mission by mission."""
        for mission in self.missions:
            for capture in mission.captures:
                yield mission, capture


def _require_time(text: str) -> None:
    """Check a local time.

    Raises:
        TaskError: It is no time, or has no difference from UTC.
    """
    try:
        zoned = datetime_from_iso(text).tzinfo is not None
    except ValueError:
        zoned = False
    if not zoned:
        raise TaskError(
            message("“{time}” is not a time of earlier missions", time=visible(text[:40])),
            advice=message("write it as 2026-11-27T06:30:00+01:00"),
        )
