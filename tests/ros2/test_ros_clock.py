"""The clock that follows ``/clock``: it passes as that does, never goes back, and keeps nobody waiting for ever."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.clock import PacedClock
from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.ros_clock import TOPIC, TYPE, RosClock, unused_clock_remark
from fieldhand.execution.mission_clock import MissionClock
from ros2.in_memory import Graph


class Simulator:
    """Something that publishes its time each time that anybody sleeps.

    Args:
        pace: Its seconds in one of the wall clock.
    """

    def __init__(self, pace: float = 1.0, said_s: float = 1_700_000_000.0) -> None:
        self.wall_s, self.said_s, self.pace = 0.0, said_s, pace
        self.graph = Graph(lambda: self.wall_s)
        self.listener = self.graph.node()
        self.node = self.graph.node()
        self.topic = self.node.publish(TOPIC, TYPE)

    def say(self) -> None:
        whole, part = divmod(round(self.said_s * 1e9), 10**9)
        self.topic.send({"clock": {"sec": whole, "nanosec": part}})

    def sleep(self, seconds: float) -> None:
        self.wall_s += seconds
        self.said_s += seconds * self.pace
        self.say()

    def clock(self, within_s: float = 1.0) -> RosClock:
        return RosClock.wait_for_first(self.listener, within_s, steady=lambda: self.wall_s, sleep=self.sleep)


@given(st.lists(st.floats(-1000, 1000), min_size=1, max_size=20))
def test_it_passes_as_the_topic_says_and_never_goes_back(steps: list[float]) -> None:
    simulator = Simulator()
    clock = simulator.clock()
    seen = [clock.now()]
    for step in steps:
        simulator.said_s += step
        simulator.say()
        seen.append(clock.now())
    assert seen[0] == 0
    passed = [b - a for a, b in itertools.pairwise(seen)]
    assert passed == pytest.approx([max(0.0, step) for step in steps], abs=1e-5)


@pytest.mark.parametrize("pace", [0.5, 1.0, 20.0])
def test_waiting_lasts_as_long_as_its_own_seconds(pace: float) -> None:
    simulator = Simulator(pace)
    clock = simulator.clock()
    for _ in range(120):
        clock.advance(pace * 0.05)
    assert clock.now() == pytest.approx(6 * pace, rel=0.3)
    assert clock.speed == pytest.approx(pace, rel=0.01)


def test_a_simulation_that_is_paused_keeps_nobody_waiting() -> None:
    simulator = Simulator()
    clock = simulator.clock()
    simulator.pace = 0.0
    clock.advance(3600.0)
    assert simulator.wall_s < 1
    assert clock.now() == pytest.approx(0, abs=0.01)
    assert clock.speed > 0


def test_time_passes_as_ours_once_the_simulation_was_killed_and_as_its_own_once_it_is_back() -> None:
    simulator = Simulator(10.0)
    clock = simulator.clock()
    told_s, gone_s = clock.now(), simulator.wall_s
    simulator.node.vanish()
    while simulator.wall_s < gone_s + 60.0:
        clock.advance(1.0)
    assert clock.now() - told_s == pytest.approx(simulator.wall_s - gone_s - simulator.graph.noticed_s, abs=0.1)
    assert clock.speed == 1.0
    simulator.topic = simulator.graph.node().publish(TOPIC, TYPE)
    told_s, back_s = clock.now(), simulator.wall_s
    for _ in range(20):
        clock.advance(1.0)
    assert clock.now() - told_s == pytest.approx(10.0 * (simulator.wall_s - back_s), abs=0.2)
    assert clock.speed == pytest.approx(10.0, rel=0.01)


def test_a_mission_runs_on_it_as_on_a_clock_that_passes_by_itself() -> None:
    simulator = Simulator(10.0)
    clock = simulator.clock()
    assert isinstance(clock, PacedClock)
    of_mission = MissionClock(clock)
    for _ in range(20):
        of_mission.rest()
    assert of_mission.speed == clock.speed
    assert of_mission.now() == 0
    assert of_mission.look() == pytest.approx(clock.now())


def test_a_silent_clock_is_said() -> None:
    simulator = Simulator()
    simulator.topic.close()
    with pytest.raises(Ros2Error, match=r"/clock is silent.*start the simulation"):
        simulator.clock(within_s=0.5)
    assert simulator.wall_s == pytest.approx(0.5, abs=0.05)


def test_two_simulations_are_not_taken_for_one_and_one_that_ended_is_forgotten() -> None:
    simulator = Simulator()
    other = simulator.graph.node()
    other.publish(TOPIC, TYPE)
    with pytest.raises(Ros2Error, match=r"several simulations.*ROS_DOMAIN_ID"):
        simulator.clock(within_s=0.5)
    other.vanish()
    simulator.clock(within_s=20.0)
    assert simulator.wall_s >= simulator.graph.noticed_s


def test_a_clock_of_another_type_is_said() -> None:
    simulator = Simulator()
    simulator.topic.close()
    simulator.graph.node().publish(TOPIC, "std_msgs/msg/Header")
    with pytest.raises(Ros2Error, match="of another type"):
        simulator.clock(within_s=0.1)


def test_a_time_that_is_not_taken_is_told() -> None:
    simulator = Simulator()
    assert "--sim-time" in unused_clock_remark(simulator.listener)
    simulator.topic.close()
    assert unused_clock_remark(simulator.listener) == ""
