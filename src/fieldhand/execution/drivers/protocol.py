"""Driver protocol: the contract between execution and a robot.

A driver has one goal at a time, a drive or an action. No call blocks: ``start_*`` starts a goal, :meth:`Driver.poll`
returns its progress, :meth:`Driver.cancel` requests its cancellation, as in a ROS 2 action client.

    start_drive / start_action ──▶ running ──▶ succeeded | failed
                                      └─cancel──▶ cancelled

A goal that is interrupted by the robot's own stop (:meth:`Driver.stopped`) is cancelled, too. A failed goal reports its
kind of fault (:data:`GoalFault`), on which execution bases its response; the text is for people.

:meth:`~Driver.poll` returns the outcome of a goal until the next goal starts, so that nothing is lost when a mission is
interrupted between two calls. ``fieldhand.testing.driver_contract`` verifies these properties for every driver.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, Protocol, runtime_checkable

from fieldhand.robot.camera import Camera
from fieldhand.site.model import Place
from fieldhand.task.results import ImageFile

#: States of a goal. ``cut_off`` is never returned by a driver: the journal records it for a goal interrupted by a power
#: cut.
GoalState = Literal["idle", "running", "succeeded", "failed", "cancelled", "cut_off"]

#: Kind of fault of a failed goal; ``none`` otherwise.
#:
#: * ``blocked``: an obstacle that the robot's own avoidance could not pass; the robot stands before it.
#: * ``occupied``: an obstacle where the robot would stand at the end of the drive; the robot stands near it.
#: * ``interrupted``: the robot's navigation ended the drive for no reason of the drive itself: another client's goal
#:   took its place, or its server was restarted (:class:`SharedNavigation`).
#: * ``lost``: the position is unknown (:meth:`Driver.lost`) and the robot stands still. A goal started while it is lost
#:   fails at once, and a running one ends, so a lost robot makes no capture.
#: * ``empty``: the battery is empty.
#: * ``implement``: the implement of a stretch failed; it is off, and the robot stands.
#: * ``failed``: anything else.
GoalFault = Literal["none", "failed", "blocked", "occupied", "interrupted", "lost", "empty", "implement"]


#: Metres within which a robot counts as being at a point.
AT_M = 0.5
#: Metres from the end of a drive within which an obstacle counts as standing where the robot would stand.
NEAR_M = 2.5


@dataclass(frozen=True, kw_only=True)
class Position:
    """Position of the robot itself (not of the tree it stands beside).

    Attributes:
        x, y: Metres east and north in the site's projection.
        lat, lon: Degrees, WGS 84.
        heading_deg: Heading in degrees clockwise from true north, 0 to 360; None if it is not known.
    """

    x: float
    y: float
    lat: float
    lon: float
    heading_deg: float | None = None

    @property
    def xy(self) -> tuple[float, float]:
        """Metres east and north."""
        return (self.x, self.y)

    def is_at(self, place: Place) -> bool:
        """Return True if the robot is at the stand of a place, within :data:`AT_M`."""
        return math.dist(self.xy, place.stand or place.xy) <= AT_M

    def as_place(self, name: str = "on the way") -> Place:
        """Return the position as a place of its own."""
        return Place.of_robot(self.xy, lat=self.lat, lon=self.lon, name=name)


@dataclass(frozen=True, kw_only=True)
class StretchWork:
    """Work along the path of a drive, which is followed exactly: an implement that is on in parts of it.

    The driver switches the implement off whenever the drive ends, whatever the reason.

    Attributes:
        action: Name of the action; empty to follow the path only.
        parameters: A value for every parameter that the profile declares.
        on: Intervals along the path in metres in which the implement is on, in order and disjoint.
    """

    action: str = ""
    parameters: Mapping[str, str | float] = field(default_factory=dict)
    on: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True, kw_only=True)
class DriveGoal:
    """A drive along a path to a place.

    Attributes:
        place: Destination.
        path_m: Corners of the path in local metres, at least two, starting at the robot's position.
        path_degrees: The same corners as (lat, lon).
        length_m: Length of the path in metres.
        speed_m_s: Speed limit in m/s.
        work: Work along the path; None for a drive whose path the robot may leave.
        heading_deg: Heading at the end in degrees clockwise from true north; None for that of the last leg.
        faces: Camera for whose picture the robot has this heading; None if it only stands along the aisle, so that
            another heading is no failure.
    """

    place: Place
    path_m: tuple[tuple[float, float], ...]
    path_degrees: tuple[tuple[float, float], ...]
    length_m: float
    speed_m_s: float
    work: StretchWork | None = None
    heading_deg: float | None = None
    faces: Camera | None = None


@dataclass(frozen=True, kw_only=True)
class ActionGoal:
    """A capture at the robot's current place, with a value for every parameter that the profile declares.

    ``node`` and ``attempt`` name the capture in what is saved of it.
    """

    action: str
    place: Place
    parameters: Mapping[str, str | float] = field(default_factory=dict)
    node: str = ""
    attempt: int = 1


@dataclass(frozen=True, kw_only=True)
class CapturedImage:
    """An image that a capture has taken, as the bytes of a file.

    Attributes:
        name: Name of the image in the profile.
        format: Format of the file.
        width, height: Size in pixels.
        encoding: Encoding of the robot's message: that of the pixels, or of the compressed image.
        note: How values of the pixels are to be read; empty where that is plain.
    """

    name: str
    format: Literal["png", "jpeg", "tiff"]
    data: bytes = field(repr=False)
    width: int
    height: int
    encoding: str
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class Progress:
    """Progress of the current goal, and its cost so far.

    Attributes:
        metres: Distance driven for this goal, by the robot's odometry.
        seconds: Time since the start of the goal, until its end.
        readings: Readings of a capture by quantity, in the units of the profile; failed sensors are omitted.
        what: Cause of a failure, in words.
        fault: Kind of failure.
        images: Images of a capture.
        files: Those images as they were saved; a driver leaves it empty.
    """

    state: GoalState
    metres: float = 0.0
    seconds: float = 0.0
    readings: Mapping[str, float] = field(default_factory=dict)
    what: str = ""
    fault: GoalFault = "none"
    images: tuple[CapturedImage, ...] = ()
    files: tuple[ImageFile, ...] = ()

    @property
    def over(self) -> bool:
        """True if the robot has finished with the goal."""
        return self.state != "running"


class Driver(Protocol):
    """A robot, real or simulated. One goal at a time; no call blocks; no call raises because of the robot."""

    @property
    def seed(self) -> int | None:
        """Random seed of a simulation; None for a real robot."""
        ...

    def start_drive(self, goal: DriveGoal) -> None:
        """Start a drive. No goal may be running."""
        ...

    def start_action(self, goal: ActionGoal) -> None:
        """Start a capture. No goal may be running."""
        ...

    def poll(self) -> Progress:
        """Return the progress of the last goal; ``idle`` before the first. Repeated calls have no effect."""
        ...

    def cancel(self) -> None:
        """Request cancellation of the current goal; :meth:`poll` reports its end. Has no effect without a goal."""
        ...

    def next_event_in(self) -> float | None:
        """Return the seconds until :meth:`poll` is worth calling again, or None if no goal is running.

        A simulation returns when its goal ends, and a simulated clock jumps there; a real robot returns its polling
        period.
        """
        ...

    def position(self) -> Position:
        """Return the robot's position."""
        ...

    def charge_percent(self) -> float:
        """Return the battery charge, 0 to 100."""
        ...

    def lost(self) -> str | None:
        """Return why the robot's position is unknown ("no satellite fix"), or None if it is known.

        :meth:`position` then returns the last known position.
        """
        ...

    def stopped(self) -> str | None:
        """Return why the robot will not move again in this mission (an emergency stop), or None."""
        ...


@runtime_checkable
class EventSource(Protocol):
    """A driver that also reports the events of its robot's profile; without it, all of them are unknown."""

    def events(self) -> Mapping[str, float | None]:
        """Return the current value of each event: 1 or 0, or the value of a measured one; None if it is unknown."""
        ...


@runtime_checkable
class Odometer(Protocol):
    """A driver whose robot counts all metres that it drives, also while no program is connected to it."""

    def odometer_m(self) -> float | None:
        """Return the metres counted since the robot was switched on; None if it has no such counter."""
        ...


@runtime_checkable
class SharedNavigation(Protocol):
    """A driver whose navigation is a program of its own, which can be restarted and which others can use, too."""

    def away(self) -> str | None:
        """Return why no drive can begin now ("bt_navigator is inactive"), though one may later; None if one can."""
        ...

    def taken(self) -> str | None:
        """Return who else drives the robot now, in words; None if nobody does."""
        ...
