"""The robot beneath the servers: it does one thing at a time, and says when that is over."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise

from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Position, Progress
from fieldhand.execution.drivers.simulation import SimulatedDriver
from fieldhand.execution.drivers.simulation_state import SimulationState
from fieldhand.site.model import Place, Site

Point = tuple[float, float]
Over = Callable[[Progress], None]

#: Metres: a shorter step has no direction.
_STILL_M = 1e-6


class SimulatedPlatform:
    """A simulated robot that drives and makes captures.

    Attributes:
        metres: By its odometer, since it was made.
        odometry: Where it would stand by odometer and heading alone, east and north of where it was made, in metres. A
            drive costs more or less than its length, and that is what wheels count.
        heading_deg: Clockwise from north.

    Args:
        driver: Simulates it.
        site: Where it stands.
    """

    def __init__(self, driver: SimulatedDriver, site: Site) -> None:
        self._driver, self._site, self._speed = driver, site, 0.0
        self.metres = 0.0
        self.odometry: Point = (0.0, 0.0)
        self.heading_deg = 0.0
        self._activity = ""
        self._over: Over = _nobody
        self._counted = 0.0
        self._seen = self._driver.position()

    @property
    def activity(self) -> str:
        """What it is at, in words; empty if at nothing."""
        return self._activity

    @property
    def position(self) -> Position:
        """Where it is."""
        return self._driver.position()

    @property
    def charge_percent(self) -> float:
        """Of the battery."""
        return self._driver.charge_percent()

    @property
    def lost(self) -> str | None:
        """Why it does not know where it is."""
        return self._driver.lost()

    @property
    def stopped(self) -> str | None:
        """Why it will not move again."""
        return self._driver.stopped()

    @property
    def speed_m_s(self) -> float:
        """At which it moves now."""
        return self._speed if self.driving else 0.0

    @property
    def driving(self) -> bool:
        """Whether it is under way."""
        return self._activity == "driving"

    def state(self) -> SimulationState:
        """By which it goes on later."""
        return self._driver.state()

    def drive(self, through: tuple[Point, ...], place: Place, speed_m_s: float, over: Over) -> None:
        """Drive from where it stands along corners in local metres; it may do nothing else.

        Args:
            through: At least one.
            place: Where they lead.
            speed_m_s: Not faster than this.
            over: Told once when it is over, but not where it is broken off.
        """
        here = self._driver.position()
        path = ((here.x, here.y), *through)
        degrees = self._site.projection.degrees(path)
        self._speed = speed_m_s
        self._driver.start_drive(
            DriveGoal(
                place=place,
                path_m=path,
                path_degrees=tuple((float(lat), float(lon)) for lat, lon in degrees),
                length_m=length_m(path),
                speed_m_s=speed_m_s,
            )
        )
        self._begin("driving", over)

    def capture(self, action: str, place: Place, parameters: Mapping[str, str | float], over: Over) -> None:
        """Make a capture; it may do nothing else."""
        self._driver.start_action(ActionGoal(action=action, place=place, parameters=parameters))
        self._begin(f"at {action}", over)

    def sense(self, action: str, place: Place) -> Mapping[str, float]:
        """What the sensors of an action give without being asked for a capture; a failure gives nothing."""
        return self._driver.sense(action, place)

    def stop_now(self) -> Progress:
        """End what it does at once; whoever was to be told when it is over is not."""
        self._watch(self._driver.poll())
        self._driver.cancel()
        progress = self._driver.poll()
        self._watch(progress)
        self._activity, self._over = "", _nobody
        return progress

    def step(self) -> None:
        """See how far it is."""
        progress = self._driver.poll()
        self._watch(progress)
        if self._activity and progress.over:
            over, self._activity, self._over = self._over, "", _nobody
            over(progress)

    def _begin(self, activity: str, over: Over) -> None:
        self._activity, self._over, self._counted = activity, over, 0.0

    def _watch(self, progress: Progress) -> None:
        """Count metres, and turn to where it goes."""
        if not self.driving:
            return
        here = self._driver.position()
        east, north = here.x - self._seen.x, here.y - self._seen.y
        self._seen = here
        if math.hypot(east, north) > _STILL_M:
            self.heading_deg = math.degrees(math.atan2(east, north)) % 360.0
        step = max(0.0, progress.metres - self._counted)
        self._counted = progress.metres
        self.metres += step
        turned = math.radians(self.heading_deg)
        self.odometry = (self.odometry[0] + step * math.sin(turned), self.odometry[1] + step * math.cos(turned))


def length_m(path: tuple[Point, ...]) -> float:
    """Of a path, in metres."""
    return sum(math.dist(a, b) for a, b in pairwise(path))


def _nobody(_: Progress) -> None:
    """Nobody waits for it."""
