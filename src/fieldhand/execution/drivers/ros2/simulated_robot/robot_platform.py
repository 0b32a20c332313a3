"""The simulated vehicle below the servers: one drive or capture at a time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise

from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Position, Progress
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.state import SimulationState
from fieldhand.site.model import Place, Site

Point = tuple[float, float]
Over = Callable[[Progress], None]

#: Length in metres below which a step has no direction.
_STILL_M = 1e-6


class SimulatedPlatform:
    """A simulated vehicle that drives and makes captures.

    Attributes:
        metres: Odometer in metres since construction.
        odometry: Dead-reckoned position from odometer and heading, east and north of the initial position, in metres.
            The
            cost of a drive deviates from its length, and the odometer counts the cost.

    Args:
        driver: Simulates drives and captures.
        site: Site of the robot.
    """

    def __init__(self, driver: SimulatedDriver, site: Site) -> None:
        self._driver, self._site, self._speed = driver, site, 0.0
        self.metres = 0.0
        self.odometry: Point = (0.0, 0.0)
        self._activity = ""
        self._over: Over = _nobody
        self._counted = 0.0
        self._last_position = self._driver.true_position()

    @property
    def activity(self) -> str:
        """Current activity, in words; empty if idle."""
        return self._activity

    @property
    def position(self) -> Position:
        """Current position, as its navigation believes."""
        return self._driver.pose()

    @property
    def true_position(self) -> Position:
        """Current position."""
        return self._driver.true_position()

    @property
    def fix(self) -> Position:
        """Current position, as its receiver measures it."""
        return self._driver.position()

    @property
    def noise_m(self) -> float:
        """Standard deviation of a fix in metres, east and north."""
        return self._driver.noise_m

    @property
    def goal_tolerance_m(self) -> float:
        """Distance from a goal at which its navigation has reached it."""
        return self._driver.goal_tolerance_m

    @property
    def heading_deg(self) -> float:
        """Heading in degrees clockwise from north; north before it has moved."""
        return self._driver.true_position().heading_deg or 0.0

    @property
    def charge_percent(self) -> float:
        """Battery charge in percent."""
        return self._driver.charge_percent()

    @property
    def lost(self) -> str | None:
        """Reason why its position is unknown; None if it is known."""
        return self._driver.lost()

    @property
    def stopped(self) -> str | None:
        """Reason why it will not move again; None if it will."""
        return self._driver.stopped()

    @property
    def speed_m_s(self) -> float:
        """Current speed in m/s."""
        return self._speed if self.driving else 0.0

    @property
    def driving(self) -> bool:
        """True while it drives."""
        return self._activity == "driving"

    @property
    def recovers(self) -> bool:
        """True if the last drive ended before an obstacle at which the robot's navigation recovers for ever."""
        return self._driver.recovers

    def tree_of(self, fault: int) -> Place:
        """Return the tree that a fault of the world names."""
        return self._driver.tree_of(fault)

    def state(self) -> SimulationState:
        """Return the state from which it can continue later."""
        return self._driver.state()

    def drive(
        self,
        through: tuple[Point, ...],
        place: Place,
        speed_m_s: float,
        over: Over,
        *,
        heading_deg: float | None = None,
    ) -> None:
        """Start a drive along corners in local metres; the platform must be idle.

        Args:
            through: Corners, at least one.
            place: Destination.
            speed_m_s: Speed limit.
            over: Called once at the end, unless the drive is stopped.
            heading_deg: Heading at the end; None for that of the last leg.
        """
        here = self._driver.pose()
        path = ((here.x, here.y), *through)
        self._speed = speed_m_s
        self._driver.start_drive(
            DriveGoal(
                place=place,
                path_m=path,
                path_degrees=self._site.projection.lat_lon(path),
                length_m=length_m(path),
                speed_m_s=speed_m_s,
                heading_deg=heading_deg,
            )
        )
        self._begin("driving", over)

    def capture(self, action: str, place: Place, parameters: Mapping[str, str | float], over: Over) -> None:
        """Start a capture; the platform must be idle."""
        self._driver.start_action(ActionGoal(action=action, place=place, parameters=parameters))
        self._begin(f"at {action}", over)

    def switch(self, action: str, *, on: bool) -> str:
        """Switch an implement; return why that failed, or an empty text."""
        return self._driver.switch(action, on=on)

    def read_sensors(self, action: str, place: Place) -> Mapping[str, float]:
        """Return the readings of an action's sensors without a capture; a failure gives none."""
        return self._driver.read_sensors(action, place)

    def events(self) -> Mapping[str, float | None]:
        """Return the value of each event of the robot; None if its sensor is silent."""
        return self._driver.events()

    def stop_now(self) -> Progress:
        """End the activity at once, without calling its callback."""
        self._watch(self._driver.poll())
        self._driver.cancel()
        progress = self._driver.poll()
        self._watch(progress)
        self._activity, self._over = "", _nobody
        return progress

    def step(self) -> None:
        """Process the progress of the activity."""
        progress = self._driver.poll()
        self._watch(progress)
        if self._activity and progress.over:
            over, self._activity, self._over = self._over, "", _nobody
            over(progress)

    def _begin(self, activity: str, over: Over) -> None:
        self._activity, self._over, self._counted = activity, over, 0.0

    def _watch(self, progress: Progress) -> None:
        """Update odometer and heading."""
        if not self.driving:
            return
        here = self._driver.true_position()
        east, north = here.x - self._last_position.x, here.y - self._last_position.y
        self._last_position = here
        step = max(0.0, progress.metres - self._counted)
        self._counted = progress.metres
        self.metres += step
        moved = math.hypot(east, north) > _STILL_M
        turned = math.atan2(east, north) if moved else math.radians(self.heading_deg)
        self.odometry = (self.odometry[0] + step * math.sin(turned), self.odometry[1] + step * math.cos(turned))


def length_m(path: tuple[Point, ...]) -> float:
    """Return the length of a path in metres."""
    return sum(math.dist(a, b) for a, b in pairwise(path))


def _nobody(_: Progress) -> None:
    """Ignore the end of an activity."""
