"""Contract tests for drivers: subclass :class:`DriverContract` and return your driver in each situation.

::

    class TestMyDriver(DriverContract):
        def make(self) -> tuple[Driver, Clock, Site]:
            clock = SimulatedClock()
            return MyDriver(clock), clock, orchard()

        ...
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

from fieldhand.clock import Clock
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Driver, Progress
from fieldhand.site.model import Place, Site

__all__ = ["DriverContract", "drive_goal", "finish"]

#: Maximum number of polls until a goal is over.
MANY = 10_000


class DriverContract(ABC):
    """The contract of :mod:`fieldhand.execution.drivers.protocol`, as tests.

    Attributes:
        action: Name of an action of the robot.
        measures: Quantity that the action measures.
    """

    action = "read_co2"
    measures = "co2"

    @abstractmethod
    def make(self) -> tuple[Driver, Clock, Site]:
        """Return an idle driver, its clock and its site; the robot is at the start with a charged battery."""

    @abstractmethod
    def make_blocked(self) -> tuple[Driver, Clock, Site]:
        """Return the same as :meth:`make`, with an impassable obstacle on the way to the last tree."""

    @abstractmethod
    def make_lost(self) -> tuple[Driver, Clock, Site]:
        """Return the same as :meth:`make`, with a position that is lost on the drive to the last tree and recovers."""

    @abstractmethod
    def make_broken(self) -> tuple[Driver, Clock, Site]:
        """Return the same as :meth:`make`, with an action that fails."""

    def test_it_begins_idle_at_the_start(self) -> None:
        driver, _, site = self.make()
        assert driver.poll().state == "idle"
        assert driver.next_event_in() is None
        assert math.dist((driver.position().x, driver.position().y), site.start.xy) < 1.0
        assert 0 < driver.charge_percent() <= 100
        assert driver.stopped() is None

    def test_a_drive_runs_and_then_has_arrived(self) -> None:
        driver, clock, site = self.make()
        goal = drive_goal(site.start, site.trees[0].place)
        driver.start_drive(goal)
        assert driver.poll().state == "running"
        progress = finish(driver, clock)
        assert progress.state == "succeeded"
        assert progress.metres > 0
        assert progress.seconds > 0
        assert math.dist((driver.position().x, driver.position().y), goal.path_m[-1]) < 0.5

    def test_the_position_is_on_the_way_while_it_drives(self) -> None:
        driver, clock, site = self.make()
        goal = drive_goal(site.start, site.trees[-1].place)
        driver.start_drive(goal)
        wait = driver.next_event_in()
        assert wait is not None
        clock.advance(min(wait, 4.0) / 2)
        here = (driver.position().x, driver.position().y)
        (ax, ay), (bx, by) = goal.path_m[0], goal.path_m[-1]
        off = abs((here[0] - ax) * (by - ay) - (here[1] - ay) * (bx - ax)) / math.dist((ax, ay), (bx, by))
        assert off < 0.5
        assert math.dist(here, goal.path_m[-1]) < math.dist(goal.path_m[0], goal.path_m[-1])
        position = driver.position()
        x, y = site.projection.metres(position.lat, position.lon)[0].tolist()
        assert math.dist((x, y), here) < 0.01

    def test_a_capture_gives_readings(self) -> None:
        driver, clock, site = self.make()
        driver.start_action(ActionGoal(action=self.action, place=site.trees[0].place))
        progress = finish(driver, clock)
        assert progress.state == "succeeded"
        assert math.isfinite(progress.readings[self.measures])

    def test_the_outcome_stays_until_the_next_goal(self) -> None:
        driver, clock, site = self.make()
        driver.start_action(ActionGoal(action=self.action, place=site.trees[0].place))
        first = finish(driver, clock)
        assert [driver.poll() for _ in range(3)] == [first] * 3
        assert driver.next_event_in() is None

    def test_the_battery_empties_and_never_fills(self) -> None:
        driver, clock, site = self.make()
        charges = [driver.charge_percent()]
        driver.start_drive(drive_goal(site.start, site.trees[-1].place))
        while not driver.poll().over:
            clock.advance(min(driver.next_event_in() or 0.0, 2.0))
            charges.append(driver.charge_percent())
        assert charges == sorted(charges, reverse=True)
        assert charges[-1] < charges[0]

    def test_a_cancelled_drive_comes_to_rest_where_it_is(self) -> None:
        driver, clock, site = self.make()
        driver.start_drive(drive_goal(site.start, site.trees[-1].place))
        clock.advance(min(driver.next_event_in() or 0.0, 4.0) / 2)
        driver.cancel()
        progress = finish(driver, clock)
        assert progress.state == "cancelled"
        assert progress.metres > 0
        stood = driver.position()
        clock.advance(5.0)
        assert driver.position() == stood

    def test_cancel_without_a_goal_does_nothing(self) -> None:
        driver, clock, site = self.make()
        driver.cancel()
        assert driver.poll().state == "idle"
        driver.start_action(ActionGoal(action=self.action, place=site.trees[0].place))
        done = finish(driver, clock)
        driver.cancel()
        assert driver.poll() == done

    def test_a_second_goal_at_once_is_refused(self) -> None:
        driver, _, site = self.make()
        goal = drive_goal(site.start, site.trees[-1].place)
        driver.start_drive(goal)
        try:
            driver.start_drive(goal)
        except RuntimeError as error:
            refused = str(error)
        else:
            refused = "it was taken"
        assert "one at a time" in refused, refused

    def test_what_succeeded_has_no_fault(self) -> None:
        driver, clock, site = self.make()
        driver.start_drive(drive_goal(site.start, site.trees[0].place))
        assert finish(driver, clock).fault == "none"
        assert driver.lost() is None

    def test_a_blocked_drive_says_so_and_stands_before_what_blocks_it(self) -> None:
        driver, clock, site = self.make_blocked()
        goal = drive_goal(site.start, site.trees[-1].place)
        driver.start_drive(goal)
        progress = finish(driver, clock)
        assert (progress.state, progress.fault) == ("failed", "blocked")
        assert progress.what
        here = driver.position()
        assert 0.1 < math.dist((here.x, here.y), goal.path_m[-1]) < goal.length_m

    def test_an_action_that_gives_an_error_says_that_it_failed(self) -> None:
        driver, clock, site = self.make_broken()
        driver.start_action(ActionGoal(action=self.action, place=site.trees[0].place))
        progress = finish(driver, clock)
        assert (progress.state, progress.fault) == ("failed", "failed")
        assert not progress.readings

    def test_a_lost_robot_stands_still_fails_every_goal_and_says_when_it_is_back(self) -> None:
        driver, clock, site = self.make_lost()
        driver.start_drive(drive_goal(site.start, site.trees[-1].place))
        progress = finish(driver, clock)
        assert (progress.state, progress.fault) == ("failed", "lost")
        assert driver.lost()
        stood = driver.position()
        driver.start_action(ActionGoal(action=self.action, place=site.trees[0].place))
        refused = finish(driver, clock)
        assert (refused.state, refused.fault, dict(refused.readings)) == ("failed", "lost", {})
        for _ in range(MANY):
            if driver.lost() is None:
                break
            clock.advance(1.0)
        assert driver.lost() is None
        here = driver.position()
        assert math.dist((here.x, here.y), (stood.x, stood.y)) < 0.5  # the last that a lost robot knew is a moment old
        driver.start_action(ActionGoal(action=self.action, place=site.trees[0].place))
        assert finish(driver, clock).state == "succeeded"

    def test_a_goal_can_follow_a_cancelled_one(self) -> None:
        driver, clock, site = self.make()
        driver.start_drive(drive_goal(site.start, site.trees[-1].place))
        driver.cancel()
        finish(driver, clock)
        driver.start_action(ActionGoal(action=self.action, place=site.trees[0].place))
        assert finish(driver, clock).state == "succeeded"


def drive_goal(start: Place, end: Place, speed_m_s: float = 1.0) -> DriveGoal:
    """Return the goal of a straight drive."""
    return DriveGoal(
        place=end,
        path_m=(start.xy, end.xy),
        path_degrees=((start.lat, start.lon), (end.lat, end.lon)),
        length_m=math.dist(start.xy, end.xy),
        speed_m_s=speed_m_s,
    )


def finish(driver: Driver, clock: Clock) -> Progress:
    """Advance the clock until the current goal is over, and return its outcome."""
    for _ in range(MANY):
        progress = driver.poll()
        if progress.over:
            return progress
        clock.advance(driver.next_event_in() or 0.0)
    raise AssertionError("the goal is never over")
