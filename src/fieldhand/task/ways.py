"""Limits of where a mission drives: ground that it keeps out of, ground on which it is slow, and gates that it uses."""

from __future__ import annotations

from dataclasses import dataclass

from fieldhand.places.selector import Selector
from fieldhand.task.nodes.base import Span


@dataclass(frozen=True, kw_only=True)
class Avoid:
    """Places that the robot keeps out of: a zone (as ``InZone``), the aisles beside a row or other trees.

    With a distance it keeps so far from them: from the outline of a zone, the line of a row, a marker.

    Attributes:
        distance_m: Distance to keep in metres; 0 to keep out only.
        said: Character ranges of the request that state it.
    """

    places: Selector
    distance_m: float = 0.0
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class OnlyGate:
    """A gate that the robot may pass; with one or more of them it passes no other gate.

    Attributes:
        gate: Name of the gate.
        said: Character ranges of the request that state it.
    """

    gate: str
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class SlowNear:
    """Places at which the robot drives slowly, wherever its path leads through them.

    Without a distance that is within a zone, in the aisles beside rows or other trees, or in the opening of a gate;
    with one, as near to them.

    Attributes:
        distance_m: Metres within which it drives slowly; 0 for the places themselves.
        speed_m_s: Highest driving speed there; None for the robot's slow speed.
        said: Character ranges of the request that state it.
    """

    places: Selector
    distance_m: float = 0.0
    speed_m_s: float | None = None
    said: tuple[Span, ...] = ()
