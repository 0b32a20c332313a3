"""Protocol of a driver: the contract between execution and a robot.

A driver has one goal at a time, a drive or an action. Nothing blocks: ``start_*`` begins a goal, :meth:`Driver.poll`
says how far it is, :meth:`Driver.cancel` asks for its end. That is how a ROS 2 action client works; the simulated
twin keeps to it.

    start_drive / start_action ──▶ running ──▶ succeeded | failed
                                      └─cancel──▶ cancelled

A goal that the robot's own stop cuts short (:meth:`Driver.stopped`) is cancelled, too. A goal that fails says
what kind of failure it was (:data:`GoalFault`): execution decides by the kind what to do, never by the words.

The outcome of a goal stays what :meth:`~Driver.poll` answers until the next goal starts, so that nothing is lost when
a mission is interrupted between two calls. ``tests/driver_contract.py`` holds every driver to this.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, Protocol

from fieldhand.site.model import Place

#: ``cut_off`` is no driver's answer: the journal's, for a goal that was under way when the power was cut.
GoalState = Literal["idle", "running", "succeeded", "failed", "cancelled", "cut_off"]

#: Why a goal failed; ``none`` of one that did not.
#:
#: * ``blocked``: something stands in the way that the robot's own avoidance found no way past; it stands before it.
#: * ``lost``: the robot does not know where it is (:meth:`Driver.lost`). It stands still. A goal that is begun while it
#:   is lost fails at once, and one that is under way when it gets lost is ended: no capture is made by a lost robot.
#: * ``empty``: the battery is.
#: * ``failed``: anything else.
GoalFault = Literal["none", "failed", "blocked", "lost", "empty"]


@dataclass(frozen=True, kw_only=True)
class Position:
    """Position of the robot itself (not of the tree that it stands beside).

    Attributes:
        x, y: Metres east and north in the site's projection.
        lat, lon: Degrees, WGS 84.
    """

    x: float
    y: float
    lat: float
    lon: float


@dataclass(frozen=True, kw_only=True)
class DriveGoal:
    """A drive along a path to a place.

    Attributes:
        place: Where it leads.
        path_m: Corners of the path in local metres, the robot's own position first, at least two.
        path_degrees: The same corners as (lat, lon).
        length_m: Of the path.
        speed_m_s: Not faster than this.
    """

    place: Place
    path_m: tuple[tuple[float, float], ...]
    path_degrees: tuple[tuple[float, float], ...]
    length_m: float
    speed_m_s: float


@dataclass(frozen=True, kw_only=True)
class ActionGoal:
    """One capture of an action at the place where the robot stands, with every parameter that the profile declares."""

    action: str
    place: Place
    parameters: Mapping[str, str | float] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Progress:
    """Progress of the current goal, and its cost so far.

    Attributes:
        metres: Driven for this goal, by the robot's odometry.
        seconds: Since the goal was started, until it was over.
        readings: What a capture measured, by quantity, in the units of the profile. A sensor that gave nothing is
            absent.
        what: Why it failed, in words.
        fault: Why it failed, by its kind.
    """

    state: GoalState
    metres: float = 0.0
    seconds: float = 0.0
    readings: Mapping[str, float] = field(default_factory=dict)
    what: str = ""
    fault: GoalFault = "none"

    @property
    def over(self) -> bool:
        """True if the robot has nothing more to do for the goal."""
        return self.state != "running"


class Driver(Protocol):
    """A robot, real or simulated. One goal at a time; no call blocks; no call fails because a robot does."""

    @property
    def seed(self) -> int | None:
        """The seed of a simulation, None where the robot is real."""
        ...

    def start_drive(self, goal: DriveGoal) -> None:
        """Begin a drive. No goal may be running."""
        ...

    def start_action(self, goal: ActionGoal) -> None:
        """Begin one capture. No goal may be running."""
        ...

    def poll(self) -> Progress:
        """Return the progress of the last goal; ``idle`` before the first. Asking twice changes nothing."""
        ...

    def cancel(self) -> None:
        """Ask for the end of the goal in hand; it is over when :meth:`poll` says so. Does nothing without one."""
        ...

    def next_event_in(self) -> float | None:
        """Return seconds until :meth:`poll` is worth calling again, or None if no goal is running.

        The simulation knows when a goal will be over, and a simulated clock jumps there; a real robot gives its
        polling period.
        """
        ...

    def position(self) -> Position:
        """Return the robot's position now."""
        ...

    def charge_percent(self) -> float:
        """Return the charge of the battery now, 0 to 100."""
        ...

    def lost(self) -> str | None:
        """Return why the robot does not know where it is ("no satellite fix"), or None while it does.

        :meth:`position` then is the last that it knew.
        """
        ...

    def stopped(self) -> str | None:
        """Return why the robot will not move again in this mission (an emergency stop), or None while it may."""
        ...
