"""The results frame: events during a mission, and the outcome of each goal.

An event log has one JSON object per line (:mod:`fieldhand.task.event_lines`), in chronological order: ``event`` names
the type, the other keys are the fields below. Execution writes events; evaluation and other programs read them. Every
event has ``t`` (seconds since the mission began) and ``node`` (id of the plan node, or empty). Coordinates are degrees,
WGS 84.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar, Literal

MissionStatus = Literal["completed", "returned", "exceeded", "faulted", "aborted"]

Crossable = Literal["charge_percent", "distance_m", "duration_s", "energy_percent"]
Crossing = Literal["warn", "return", "stop", "reserve", "limit", "way_home", "out_of_reach"]


@dataclass(frozen=True, kw_only=True)
class Started:
    """The mission begins. ``seed`` is None for a real robot.

    ``at`` is the wall-clock time (ISO 8601, UTC), empty without a clock; ``at`` plus ``t`` gives the time of any event,
    even if the wall clock is set meanwhile. ``reserve_percent`` is the charge to leave at the end; None in logs of
    earlier versions.
    """

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
    at: str = ""
    reserve_percent: float | None = None


@dataclass(frozen=True, kw_only=True)
class Visiting:
    """A for-each resolved its selector: ids of its places in the planned order."""

    event: ClassVar[str] = "visiting"
    t: float
    node: str
    places: tuple[str, ...]
    optional: bool = False


@dataclass(frozen=True, kw_only=True)
class Driving:
    """A drive begins. ``path`` lists its corners as (lat, lon), ``speed_m_s`` is the commanded speed."""

    event: ClassVar[str] = "drive"
    t: float
    node: str
    kind: str
    place: str
    planned_m: float
    path: tuple[tuple[float, float], ...]
    speed_m_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class Arrived:
    """A drive ended: position of the robot, length of the leg and total distance."""

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
    """An action was done or failed. ``lat``/``lon`` are those of the tree or point where it was done.

    ``readings`` maps each measured quantity to its value, in the unit of the profile. ``count`` is 1: every capture is
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
class InDoubt:
    """A capture was in progress when the power failed; it is unknown whether it was made.

    ``then`` is the response: capture again (``repeat``), or accept it without readings (``skip``).
    """

    event: ClassVar[str] = "in_doubt"
    status: ClassVar[str] = "in_doubt"
    readings: ClassVar[Mapping[str, float]] = {}
    units: ClassVar[Mapping[str, str]] = {}
    t: float
    node: str
    action: str
    then: Literal["repeat", "skip"]
    kind: str
    place: str
    lat: float
    lon: float
    attempt: int = 1
    what: str = ""
    charge_percent: float = 100.0


@dataclass(frozen=True, kw_only=True)
class ChargeBegun:
    """The robot has docked and charges up to ``until_percent``, which is expected to take ``seconds``.

    Without ``node`` the robot interrupted the plan, which it continues afterwards; ``why`` is the reason.
    """

    event: ClassVar[str] = "charge"
    t: float
    node: str
    kind: str
    place: str
    lat: float
    lon: float
    charge_percent: float
    until_percent: float
    seconds: float
    why: str = ""


@dataclass(frozen=True, kw_only=True)
class ChargeEnded:
    """Charging is over: charge in percent, by how much it rose, and the seconds that it took."""

    event: ClassVar[str] = "charged"
    t: float
    node: str
    kind: str
    place: str
    lat: float
    lon: float
    charge_percent: float
    gained_percent: float
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Resumed:
    """The mission continues after a power failure from the robot's present position. The time without power does not
    count.
    """

    event: ClassVar[str] = "resumed"
    t: float
    node: str = ""
    lat: float
    lon: float
    charge_percent: float


@dataclass(frozen=True, kw_only=True)
class Paused:
    """An operator paused the mission; the robot stops once the current capture is made."""

    event: ClassVar[str] = "paused"
    t: float
    node: str = ""
    reason: str = ""


@dataclass(frozen=True, kw_only=True)
class Continued:
    """The pause is over."""

    event: ClassVar[str] = "continued"
    t: float
    node: str = ""


@dataclass(frozen=True, kw_only=True)
class Decided:
    """A condition was tested; ``why`` explains the result ("canopy_temperature 31.2 degC is below 33 degC")."""

    event: ClassVar[str] = "condition"
    t: float
    node: str
    holds: bool
    why: str


#: Why work is given up: to stay within the budget, or because there is no way to its place.
ShedCause = Literal["budget", "unreachable"]


@dataclass(frozen=True, kw_only=True)
class Shed:
    """Work was dropped, to stay within the budget or because no way leads to it: the places, and the reason.

    ``names_places``: the reason names the places, so that a sentence about the event does not repeat them.
    """

    event: ClassVar[str] = "shed"
    t: float
    node: str
    places: tuple[str, ...]
    optional: bool
    reason: str
    chance_short: float = 0.0
    cause: ShedCause = "budget"
    names_places: bool = False


@dataclass(frozen=True, kw_only=True)
class Obstructed:
    """An obstacle blocks the way to a place, or (``free``) a blocked area is assumed clear and will be tried again.

    ``blocked`` lists every area that the robot avoids from now on by its corners (lat, lon). ``unreachable`` lists
    trees that could be reached before and no longer can.
    """

    event: ClassVar[str] = "obstacle"
    t: float
    node: str
    kind: str
    place: str
    lat: float
    lon: float
    travelled_m: float
    blocked: tuple[tuple[tuple[float, float], ...], ...]
    unreachable: tuple[str, ...] = ()
    free: bool = False
    what: str = ""


@dataclass(frozen=True, kw_only=True)
class Waited:
    """The robot waited for a problem to resolve itself: a blocked way, or a lost position.

    ``over``: the position is known again, or there is a way to try.
    """

    event: ClassVar[str] = "wait"
    t: float
    node: str
    wanted: Literal["way", "position"]
    seconds: float
    over: bool
    what: str = ""


@dataclass(frozen=True, kw_only=True)
class LimitCrossed:
    """A limit or battery level was crossed; reported once each.

    ``level``: ``warn``, ``return`` and ``stop`` of the battery; ``reserve``: less charge is left than required;
    ``limit``: more of ``quantity`` was used than a budget allows; ``way_home``: ``value``, the rest of ``quantity`` (of
    the charge, above the reserve), barely suffices for the way home, which takes ``threshold`` on average;
    ``out_of_reach``: the charge above the stop level does not suffice for it. For the other levels ``value`` is the
    reading and ``threshold`` the level.

    ``then``: response of the robot; ``end`` ends the mission where the robot is, as no way home was reserved.
    ``cleared``: the charge is well above the level again.
    """

    event: ClassVar[str] = "limit"
    t: float
    node: str = ""
    quantity: Crossable
    level: Crossing
    value: float
    threshold: float
    then: Literal["go_on", "return", "end", "stop"]
    cleared: bool = False
    lat: float
    lon: float
    travelled_m: float
    charge_percent: float


@dataclass(frozen=True, kw_only=True)
class ClockSet:
    """The wall clock was set by so many seconds, forward or back; ``t`` is not affected."""

    event: ClassVar[str] = "clock"
    t: float
    node: str = ""
    by_s: float


@dataclass(frozen=True, kw_only=True)
class Faulted:
    """Something failed for good, or was retried or worked around (``handled``)."""

    event: ClassVar[str] = "fault"
    t: float
    node: str
    fault: str
    what: str
    handled: bool = False


@dataclass(frozen=True, kw_only=True)
class Exited:
    """The plan is over and the mission takes an exit; ``node`` is the ``StopMission`` that ended the plan, if any."""

    event: ClassVar[str] = "exit"
    t: float
    node: str = ""
    exit: Literal["nominal", "faulted"]
    then: str
    reason: str = ""


@dataclass(frozen=True, kw_only=True)
class Ended:
    """The mission is over: position of the robot and resources used.

    ``completed``: the plan was done and its exit taken. ``returned``: the robot came home early to keep a limit.
    ``exceeded``: either of these, beyond a limit (:mod:`fieldhand.task.exceeded`). ``faulted``: a fault ended it.
    ``aborted``: an operator did.
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


Event = (
    Started
    | Visiting
    | Driving
    | Arrived
    | Acted
    | InDoubt
    | ChargeBegun
    | ChargeEnded
    | Resumed
    | Paused
    | Continued
    | Decided
    | Shed
    | Obstructed
    | Waited
    | LimitCrossed
    | ClockSet
    | Faulted
    | Exited
    | Ended
)


@dataclass(frozen=True, kw_only=True)
class GoalOutcome:
    """The outcome of a goal.

    Attributes:
        done: Number of successful captures.
        wanted: Number of captures required on the branch taken; None where unknown (the mission was cut off before).
        why: Explanation in words.
    """

    goal: str
    outcome: Literal["success", "failure", "indeterminate"]
    done: int
    wanted: int | None
    why: str
