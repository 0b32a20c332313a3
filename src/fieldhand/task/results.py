"""The results frame: what happened, as events, and what came of each goal, as outcomes.

An event log is one JSON object a line (:mod:`fieldhand.task.event_lines`), in the order in which things happened:
``event`` names the type, the other keys are the fields below. Execution writes events; evaluation reads them; other
programs may, too. Every event has ``t`` (seconds since the mission began) and ``node`` (id of the plan node, empty
where none is meant). Degrees are WGS 84.
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
    """The mission begins. ``seed`` is None where the robot is real.

    ``at`` is the wall clock's time then (ISO 8601, UTC), empty where there is none: ``at`` and ``t`` give any event's
    own, whatever is done to the wall clock meanwhile. ``reserve_percent`` is the charge that must be left at the end;
    None in logs of earlier versions.
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
    """A for-each has resolved its selector: the ids of its places in the order planned."""

    event: ClassVar[str] = "visiting"
    t: float
    node: str
    places: tuple[str, ...]
    optional: bool = False


@dataclass(frozen=True, kw_only=True)
class Driving:
    """A drive begins; ``path`` holds its corners as (lat, lon), ``speed_m_s`` how fast the robot was told to drive."""

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
class InDoubt:
    """A capture was in the air when the power was cut: nobody knows whether it was made.

    ``then`` says what follows: it is made again (``repeat``), or taken as it is, without readings (``skip``).
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
class Resumed:
    """The mission goes on after a power cut, where the robot is now. The time without power does not count."""

    event: ClassVar[str] = "resumed"
    t: float
    node: str = ""
    lat: float
    lon: float
    charge_percent: float


@dataclass(frozen=True, kw_only=True)
class Paused:
    """A person told the robot to wait; it stands still as soon as the capture in hand is made."""

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
    """A condition was tested; ``why`` says it in words ("canopy_temperature 31.2 degC is below 33 degC")."""

    event: ClassVar[str] = "condition"
    t: float
    node: str
    holds: bool
    why: str


@dataclass(frozen=True, kw_only=True)
class Shed:
    """Work was given up, to stay inside the budget or because no way leads to it: which places, and why."""

    event: ClassVar[str] = "shed"
    t: float
    node: str
    places: tuple[str, ...]
    optional: bool
    reason: str
    chance_short: float = 0.0
    cause: Literal["budget", "unreachable"] = "budget"


@dataclass(frozen=True, kw_only=True)
class Obstructed:
    """Something stands in the way to a place, or what stood there is taken as gone (``free``) and will be tried again.

    ``blocked`` is all that the robot will not drive over from now on, each area as its corners (lat, lon).
    ``unreachable`` are the trees to which no way leads any more from where it stands, of those to which one led before.
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
    """The robot stood still for what may come right by itself: a way, or knowing where it is.

    ``over``: it knows where it is again; there is a way that it will try again.
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
    """A limit, or a level of the battery, was crossed while the robot drove, worked or stood; each once.

    ``level``: ``warn``, ``return`` and ``stop`` of the battery; ``reserve``: less charge is left than must be;
    ``limit``: more was used of ``quantity`` than a budget allows; ``way_home``: ``value``, which is left of
    ``quantity`` (of the charge, above the reserve), only just lasts for the way home, which takes ``threshold`` on
    average; ``out_of_reach``: the charge above the stop level does not last for it. Of the others ``value`` is what was
    read and ``threshold`` the level.

    ``then``: what the robot does about it; ``end``: its mission is over where it stands, as no way home was reserved.
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
    """Somebody set the wall clock, by so many seconds forward or back. ``t`` does not know of it."""

    event: ClassVar[str] = "clock"
    t: float
    node: str = ""
    by_s: float


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

    ``completed``: the plan was done and its exit taken. ``returned``: the robot came home before the plan was done, so
    that a limit would be kept. ``exceeded``: either of these, beyond a limit (:mod:`fieldhand.task.exceeded`).
    ``faulted``: a fault ended it. ``aborted``: a person did.
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
