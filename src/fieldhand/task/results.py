"""The results frame: events during a mission, and the outcome of each goal.

An event log has one JSON object per line (:mod:`fieldhand.task.event_lines`), in chronological order: ``event`` names
the type, the other keys are the fields below. Execution writes events; evaluation and other programs read them. Every
event has ``t`` (seconds since the mission began) and ``node`` (id of the plan node, or empty). Coordinates are degrees,
WGS 84.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar, Literal

MissionStatus = Literal["completed", "returned", "exceeded", "faulted", "aborted"]

Crossable = Literal["charge_percent", "distance_m", "duration_s", "energy_percent"]
Crossing = Literal["warn", "return", "stop", "reserve", "limit", "way_home", "costly_drive", "out_of_reach"]


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
    """A for-each resolved its selector: ids of its places in the planned order; their sides, if the plan names any."""

    event: ClassVar[str] = "visiting"
    t: float
    node: str
    places: tuple[str, ...]
    optional: bool = False
    sides: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Driving:
    """A drive begins. ``path`` lists its corners as (lat, lon), ``speed_m_s`` is the commanded speed.

    ``side``, here and in the events below, is the side of the tree on which the robot is to stand, if the plan says so.
    ``heading_deg`` is the heading at its end, in degrees clockwise from north.
    """

    event: ClassVar[str] = "drive"
    t: float
    node: str
    kind: str
    place: str
    planned_m: float
    path: tuple[tuple[float, float], ...]
    speed_m_s: float | None = None
    side: str = ""
    heading_deg: float | None = None


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
    side: str = ""


#: Paths of images that a mission writes; a log of others may name anything.
IMAGE_PATH = re.compile(r"images/(?P<name>[A-Za-z0-9_-]{1,150}\.(?:png|jpg|tif))")


@dataclass(frozen=True, kw_only=True)
class ImageFile:
    """An image of a capture, as it was saved.

    ``name`` is that of the profile, ``file`` the path below the mission's folder, with its ``sha256`` and size in
    ``bytes``. ``encoding`` is that of the robot's message. Without a ``file`` the image was not saved, and ``what`` is
    the reason.
    """

    name: str
    file: str = ""
    sha256: str = ""
    bytes: int = 0
    width: int = 0
    height: int = 0
    encoding: str = ""
    what: str = ""


@dataclass(frozen=True, kw_only=True)
class Acted:
    """An action was done or failed. ``lat``/``lon`` are those of the tree or point where it was done.

    ``readings`` maps each measured quantity to its value, in the unit of the profile. ``count`` is 1: every capture is
    an event of its own. ``robot_lat``, ``robot_lon`` and ``heading_deg`` (clockwise from north) are those of the robot;
    None if unknown.
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
    side: str = ""
    images: tuple[ImageFile, ...] = ()
    robot_lat: float | None = None
    robot_lon: float | None = None
    heading_deg: float | None = None


@dataclass(frozen=True, kw_only=True)
class ImageLost:
    """An image was taken but could not be saved; recorded once for each reason."""

    event: ClassVar[str] = "image_lost"
    t: float
    node: str
    action: str
    kind: str
    place: str
    what: str


@dataclass(frozen=True, kw_only=True)
class Working:
    """Work along a stretch begins, or continues after an interruption.

    ``path`` lists the corners as (lat, lon); ``on`` the intervals along it in metres in which the action is on.
    ``action`` is empty if the robot only drives.
    """

    event: ClassVar[str] = "working"
    t: float
    node: str
    action: str
    stretch: str
    parameters: Mapping[str, str | float] = field(default_factory=dict)
    planned_m: float
    path: tuple[tuple[float, float], ...]
    on: tuple[tuple[float, float], ...] = ()
    speed_m_s: float
    attempt: int = 1


@dataclass(frozen=True, kw_only=True)
class Worked:
    """Work along a stretch ended, whole or (``failed``, ``cancelled``) in part; the action is off.

    ``worked_m`` are the metres with the action on, ``paths`` their parts as (lat, lon), ``area_m2`` the area worked,
    ``amount`` what was applied, in ``unit``. ``leg_m`` is the distance driven for it.
    """

    event: ClassVar[str] = "worked"
    t: float
    node: str
    action: str
    stretch: str
    status: Literal["success", "failed", "cancelled"]
    lat: float
    lon: float
    leg_m: float
    worked_m: float
    area_m2: float = 0.0
    amount: float = 0.0
    unit: str = ""
    paths: tuple[tuple[tuple[float, float], ...], ...] = ()
    attempt: int = 1
    what: str = ""
    travelled_m: float
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
    side: str = ""


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


#: Source of a distance that was driven unobserved: the robot's ``odometer``, which measured it; else it is estimated
#: along the ``path`` of the drive, or straight on (``line``), which is the least that it can be. Empty for none.
UnobservedBy = Literal["", "odometer", "path", "line"]


@dataclass(frozen=True, kw_only=True)
class Resumed:
    """The mission continues after a power failure from the robot's present position. The time without power does not
    count, but for that of driving on.

    ``driven_m`` and ``driven_s`` are what the robot drove on meanwhile, to the end of its goal, known by ``driven_by``.
    They count as driven.
    """

    event: ClassVar[str] = "resumed"
    t: float
    node: str = ""
    lat: float
    lon: float
    charge_percent: float
    driven_m: float = 0.0
    driven_s: float = 0.0
    driven_by: UnobservedBy = ""


@dataclass(frozen=True, kw_only=True)
class Paused:
    """The mission is paused, by an operator (the robot stops once the current capture is made) or because another
    client drives the robot.
    """

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


#: Why work is given up: to stay within the budget, because there is no way to its place, or because of an event for
#: which the Task says to skip it.
ShedCause = Literal["budget", "unreachable", "event"]


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
class Strayed:
    """The robot left the way of a drive by ``away_m``, more than the ``corridor_m`` of its profile, and is stopped."""

    event: ClassVar[str] = "strayed"
    t: float
    node: str
    kind: str
    place: str
    lat: float
    lon: float
    away_m: float
    corridor_m: float
    travelled_m: float


@dataclass(frozen=True, kw_only=True)
class Dwelling:
    """The robot begins to stand still for some seconds, because the plan says so."""

    event: ClassVar[str] = "waiting"
    t: float
    node: str
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Dwelt:
    """The robot has stood still for some seconds, because the plan says so."""

    event: ClassVar[str] = "waited"
    t: float
    node: str
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Waited:
    """The robot waited for a problem to resolve itself: a blocked way, a lost position, an event that it watches, or a
    navigation that was restarted.

    ``over``: the position is known again, there is a way to try, the event is over, or the navigation is active.
    """

    event: ClassVar[str] = "wait"
    t: float
    node: str
    wanted: Literal["way", "position", "event", "navigation"]
    seconds: float
    over: bool
    what: str = ""


@dataclass(frozen=True, kw_only=True)
class EventBegan:
    """A condition that the mission watches began to hold.

    ``watch`` is its position in the Task, from 1, ``name`` the event or quantity, and ``value`` its value: 1 for an
    event that is true or false, None for one that is unknown and counts as holding. ``response`` is what the robot
    does.
    """

    event: ClassVar[str] = "event_began"
    t: float
    node: str = ""
    watch: int
    name: str
    response: Literal["wait", "skip", "skip_row", "return_to_start", "return_to_end", "end", "slow"]
    value: float | None
    unit: str = ""
    what: str
    lat: float
    lon: float
    travelled_m: float
    charge_percent: float


@dataclass(frozen=True, kw_only=True)
class EventEnded:
    """A watched condition is over: it has not held for the time that the profile sets. ``seconds``: its duration."""

    event: ClassVar[str] = "event_ended"
    t: float
    node: str = ""
    watch: int
    name: str
    seconds: float
    what: str


@dataclass(frozen=True, kw_only=True)
class LimitCrossed:
    """A limit or battery level was crossed; reported once each.

    ``level``: ``warn``, ``return`` and ``stop`` of the battery; ``reserve``: less charge is left than required;
    ``limit``: more of ``quantity`` was used than a budget allows; ``way_home``: ``value``, the rest of ``quantity`` (of
    the charge, above the reserve), barely suffices for the way home, which takes ``threshold`` on average;
    ``out_of_reach``: the charge above the stop level does not suffice for it; ``costly_drive``: the drive costs far
    more than its length, so that at its end ``value`` would be left above the stop level, while the way from there to
    the charger takes ``threshold`` on average. For the other levels ``value`` is the reading and ``threshold`` the
    level.

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

    ``completed``: the plan was done and its exit taken. ``returned``: the robot gave up the rest early, to keep a limit
    or because of an event. ``exceeded``: either of these, beyond a limit (:mod:`fieldhand.task.exceeded`).
    ``faulted``: a fault ended it. ``aborted``: an operator did.
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
    | ImageLost
    | Working
    | Worked
    | InDoubt
    | ChargeBegun
    | ChargeEnded
    | Resumed
    | Paused
    | Continued
    | Decided
    | Shed
    | Obstructed
    | Strayed
    | Dwelling
    | Dwelt
    | Waited
    | EventBegan
    | EventEnded
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
