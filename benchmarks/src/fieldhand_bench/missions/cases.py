"""A case: a request, the worlds that its mission is driven in, and what must have happened in each of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from fieldhand.execution.drivers.simulation.world import World
from fieldhand_bench.missions.places import ANYWHERE, Place

MarkerName = Literal["start", "end"]
#: The least and the most of something.
Bounds = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Step:
    """An action that must happen.

    Attributes:
        action: By its name in the robot's profile.
        captures: How many at that place.
        at: Where.
        label: Under which later steps find the tree; empty for none.
    """

    action: str
    captures: int = 1
    at: Place = ANYWHERE
    label: str = ""


@dataclass(frozen=True, kw_only=True)
class Expected:
    """What must have happened.

    Attributes:
        steps: These actions and no others; None where only their numbers count.
        any_order: In whatever order.
        counts: Captures of each action; actions that are not named must not happen. None where steps say it.
        trees: At how many different trees each action was done.
        at_all: Where every action must have been done.
        free_points: Actions may be done away from trees.
        repeats: Where numbers count, a tree may be worked on twice.
        apart_m: Metres between a stop with an action and the next one.
        most_travel_m: Metres driven in all.
        least_stops: At how many stops something must have been done.
        status: With which the mission must end.
        end: Where the robot must be then: a marker, or a place whose tree is the nearest one. None for anywhere.
    """

    steps: tuple[Step, ...] | None = None
    any_order: bool = False
    counts: Mapping[str, Bounds] | None = None
    trees: Mapping[str, Bounds] = field(default_factory=dict)
    at_all: Place = ANYWHERE
    free_points: bool = False
    repeats: bool = False
    apart_m: Bounds | None = None
    most_travel_m: float | None = None
    least_stops: int = 0
    status: str = "completed"
    end: Place | MarkerName | None = None


@dataclass(frozen=True, kw_only=True)
class CaseWorld:
    """What the sensors would read, and what must happen then."""

    world: World
    expected: Expected


@dataclass(frozen=True, kw_only=True)
class Case:
    """A request with what it means.

    Attributes:
        id: Among all cases that are run together.
        site: GeoJSON file.
        robot: Name or profile file.
        worlds: One or more; none where the request ``asks``.
        asks: The request can be understood in two ways, or not at all: a question or a refusal is right, a plan wrong.
        source: File of the case, for messages.
    """

    id: str
    request: str
    site: Path
    robot: str
    worlds: tuple[CaseWorld, ...] = ()
    asks: bool = False
    source: str = ""
