"""Cases: a request, the worlds in which its mission is simulated, and the outcome expected in each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Literal

from fieldhand.execution.drivers.simulation.world import World
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand_bench.missions.places import ANYWHERE, CasePlace

MarkerName = Literal["start", "end"]
#: Minimum and maximum, both included.
Bounds = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class ExpectedStep:
    """An action that must be done.

    Attributes:
        action: Name in the robot's profile.
        captures: Number of captures.
        at: Place of the action.
        label: Name by which later steps refer to the tree; empty for none.
    """

    action: str
    captures: int = 1
    at: CasePlace = ANYWHERE
    label: str = ""


@dataclass(frozen=True, kw_only=True)
class SlowWithin:
    """Ground on which every drive is slow.

    Attributes:
        near: Zone or trees, and the distance within which it is slow.
        most_m_s: Highest speed there in m/s.
    """

    near: KeptFrom
    most_m_s: float


@dataclass(frozen=True, kw_only=True)
class KeptFrom:
    """What every drive must keep away from: a zone of the file, or each tree of a place.

    Attributes:
        zone: Name of the zone; empty for trees.
        trees: Place of the trees.
        metres: Least distance of the robot's path, metres.
    """

    metres: float
    zone: str = ""
    trees: CasePlace = ANYWHERE


@dataclass(frozen=True, kw_only=True)
class ExpectedWork:
    """Work along paths that must be done.

    Attributes:
        action: Name in the robot's profile.
        metres: Metres with the action on.
        past: The trees within ``reach_m`` of these metres, and no others; anywhere if they do not matter.
        reach_m: Distance up to which a tree is passed, metres.
    """

    action: str
    metres: Bounds
    past: CasePlace = ANYWHERE
    reach_m: float = 2.5


@dataclass(frozen=True, kw_only=True)
class Expected:
    """The outcome that a mission must have.

    Attributes:
        steps: Required actions, without any others; None if only ``counts`` are given.
        any_order: True if the steps may be done in any order.
        counts: Captures of each action, without any other actions; None if only ``steps`` are given.
        trees: Number of different trees at which each action was done.
        at_all: Place of every action.
        works: Work along paths, without any other.
        free_points: True if actions may be done away from trees.
        repeats: True if an action may be repeated at a tree; used with ``counts``.
        apart_m: Distance between successive stops, metres.
        most_travel_m: Maximum distance driven, metres.
        lasts_s: Duration of the mission, seconds.
        most_speed_m_s: Maximum speed of a leg on average, m/s.
        stands: Number of positions from which each tree was worked on.
        least_stops: Minimum number of actions done.
        charges: Number of charges.
        waited_s: Time for which it stands still because of events, seconds.
        status: Final status of the mission.
        keeps_from: What every drive keeps away from.
        slow_near: Where every drive is slow.
        end: Final position: a marker, or a place that the nearest tree must match. None for anywhere.
    """

    steps: tuple[ExpectedStep, ...] | None = None
    any_order: bool = False
    counts: Mapping[str, Bounds] | None = None
    trees: Mapping[str, Bounds] = field(default_factory=dict)
    at_all: CasePlace = ANYWHERE
    works: tuple[ExpectedWork, ...] = ()
    free_points: bool = False
    repeats: bool = False
    apart_m: Bounds | None = None
    most_travel_m: float | None = None
    lasts_s: Bounds | None = None
    most_speed_m_s: float | None = None
    stands: int | None = None
    least_stops: int = 0
    charges: Bounds | None = None
    waited_s: Bounds | None = None
    status: str = "completed"
    end: CasePlace | MarkerName | None = None
    keeps_from: tuple[KeptFrom, ...] = ()
    slow_near: tuple[SlowWithin, ...] = ()


@dataclass(frozen=True, kw_only=True)
class CaseWorld:
    """A simulated world and the outcome expected in it."""

    world: World
    expected: Expected


@dataclass(frozen=True, kw_only=True)
class Case:
    """A request with its expected outcomes.

    Attributes:
        id: Identifier, unique among all cases that are run together.
        request: Text of the request.
        site: Path of a GeoJSON file.
        robot: Name or profile file of the robot.
        worlds: Worlds in which the mission is simulated; none if ``asks``.
        asks: True if the request is ambiguous or cannot be fulfilled, so that a question or a refusal is right.
        source: File of the case, for messages.
        runs: First instants at which the mission is due, for a robot whose clock shows UTC, if it is approved on
            1 January 2026 at 00:00 UTC; none for a mission that begins when it is started.
        task: The same mission as the draft of a Task (XML), as a language model would write it; empty for none.
        earlier: What earlier missions did on the site; None if nothing is on record.
    """

    id: str
    request: str
    site: Path
    robot: str
    worlds: tuple[CaseWorld, ...] = ()
    asks: bool = False
    runs: tuple[datetime, ...] = ()
    source: str = ""
    task: str = ""
    earlier: EarlierMissions | None = None
