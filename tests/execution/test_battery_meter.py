"""One false reading of the battery changes nothing, and a charge that has truly fallen is acted on in time."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.execution.battery_meter import STEP_PERCENT, BatteryMeter
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.places.selectors import Trees
from fieldhand.robot.loader import load_robot, parse_profile, profile_bytes
from fieldhand.robot.model import RobotProfile
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Acted, LimitCrossed
from support.missions.rig import Rig, husky, of_type

HOLD_S, FASTEST = 3.0, 0.15
LEVELS = (30.0, 20.0, 10.0)
ANY = st.one_of(st.floats(0.0, 100.0), st.just(math.nan), st.just(math.inf))
PLAN = ForEach(id="", select=Trees(), body=Act(id="", action="read_co2"))


def meter(percent: float, levels: tuple[float, ...] = LEVELS) -> BatteryMeter:
    return BatteryMeter(percent, 0.0, hold_s=HOLD_S, fastest=FASTEST, levels=levels)


@given(
    start=st.floats(9.0, 100.0),
    steps=st.lists(st.tuples(st.floats(0.05, 10.0), st.floats(0.0, 1.0)), min_size=3, max_size=60),
    at=st.integers(0, 58),
    false=ANY,
)
def test_one_false_reading_between_good_ones_crosses_no_level(start, steps, at, false):
    true, now, read = start, 0.0, meter(start)
    for number, (seconds, share) in enumerate(steps):
        now, true = now + seconds, max(0.0, true - share * FASTEST * seconds)
        percent = read.read(false if number == at else true, now)
        assert [level for level in LEVELS if percent <= level < true] == []


@given(start=st.floats(20.0, 100.0), fall=st.floats(0.0, 100.0), every=st.floats(0.05, HOLD_S / 2.0))
def test_a_charge_that_stays_counts_within_the_time(start, fall, every):
    read, end, now = meter(start), max(0.0, start - fall), 0.0
    while now < HOLD_S + 2.0 * every:
        now += every
        read.read(end, now)
    assert read.percent == end
    assert read.next_reading_in(now) == math.inf


@given(rise=st.floats(0.0, 80.0))
def test_a_battery_that_was_changed_counts_once_it_is_read_for_long_enough(rise):
    read = meter(20.5)
    assert read.read(20.5 + rise, 1.0) == (20.5 + rise if rise <= STEP_PERCENT else 20.5)
    read.read(20.5 + rise, 2.5)
    assert read.read(20.5 + rise, 4.0) == 20.5 + rise


def test_what_the_model_explains_counts_at_once_and_a_surprise_is_looked_at_again_soon():
    read = meter(80.0)
    assert read.read(78.0, 10.0) == 78.0
    assert read.next_reading_in(10.0) == math.inf
    assert read.read(0.0, 11.0) == 78.0
    assert read.next_reading_in(11.0) == HOLD_S / 2.0
    # Looks at one moment, and two moments, are not yet a charge that lasts.
    assert [read.read(0.0, 11.0) for _ in range(9)] == [78.0] * 9
    assert read.read(0.0, 15.0) == 78.0
    assert read.read(1.0, 15.5) == 1.0


def test_past_a_level_a_charge_that_the_model_explains_counts_before_one_percent_is_lost():
    small = BatteryMeter(20.1, 0.0, hold_s=HOLD_S, fastest=4.0, levels=LEVELS)
    assert [small.read(20.0 - 0.1 * k, 0.1 * k) for k in (1, 2)] == [20.1, 20.1]
    assert small.read(19.6, 0.4) == 19.9
    broken = BatteryMeter(90.0, 0.0, hold_s=HOLD_S, fastest=4.0, levels=LEVELS)
    assert [broken.read(0.0, t) for t in (0.1, 0.2, 0.4, 3.0)] == [90.0] * 4
    assert broken.read(0.0, 3.1) == 0.0


def test_without_a_time_every_reading_counts():
    read = BatteryMeter(80.0, 0.0, hold_s=0.0, fastest=FASTEST, levels=LEVELS)
    assert read.read(0.0, 1.0) == 0.0


def test_the_profile_says_how_long():
    data, source = profile_bytes("husky")
    longer = data.replace(b"  reserve_percent: 20", b"  hold_s: 12\n  reserve_percent: 20")
    assert parse_profile(longer, source=source).energy.hold_s == 12.0
    assert load_robot("husky").energy.hold_s == HOLD_S


class FalseMeter(SimulatedDriver):
    """A simulated robot whose meter is wrong at some moments, counted from 1 as it is read.

    Attributes:
        wrong: What it says then; below 0 so much less than is true.
        first, last: The moments.
        seen_s: When it first was wrong.
    """

    wrong: float = 0.0
    first: int = 0
    last: float = 0
    seen_s: float | None = None

    def charge_percent(self) -> float:
        now = self._clock.now()
        if not hasattr(self, "_moments"):
            self._moments, self._read_s = 0, -1.0
        if now != self._read_s:
            self._moments, self._read_s = self._moments + 1, now
        true = super().charge_percent()
        if not self.first <= self._moments <= self.last:
            return true
        self.seen_s = now if self.seen_s is None else self.seen_s
        return max(0.0, true + self.wrong) if self.wrong < 0.0 else self.wrong


@dataclass
class FalseRig(Rig):
    wrong: float = 0.0
    first: int = 0
    last: float = 0
    made: list[FalseMeter] = field(default_factory=list)

    def driver(self) -> SimulatedDriver:
        rng = np.random.default_rng(self.seed)
        made = FalseMeter(self.site, self.robot, self.world, self.clock, rng)
        made.wrong, made.first, made.last = self.wrong, self.first, self.last
        self.made.append(made)
        return made


def holding(hold_s: float) -> RobotProfile:
    robot = husky()
    return replace(robot, energy=replace(robot.energy, hold_s=hold_s))


@pytest.mark.parametrize("wrong", [0.0, -50.0, 5.0, 100.0, math.nan])
@pytest.mark.parametrize("at", [2, 3, 7, 20, 41])
def test_a_mission_goes_on_after_one_false_reading(wrong: float, at: int) -> None:
    rig = FalseRig(world=World(charge_percent=70.0), wrong=wrong, first=at, last=at)
    result = rig.fly(PLAN)
    assert rig.made[0].seen_s is not None
    assert of_type(result.events, LimitCrossed) == []
    assert result.status == "completed"
    assert len(of_type(result.events, Acted)) == 20
    assert all(25.0 < event.charge_percent <= 70.0 for event in of_type(result.events, Acted))


def test_believed_at_once_the_same_reading_would_end_it() -> None:
    rig = FalseRig(robot=holding(0.0), world=World(charge_percent=70.0), first=20, last=20)
    assert rig.fly(PLAN).status == "faulted"


@pytest.mark.parametrize(("wrong", "level"), [(0.0, "stop"), (15.0, "return"), (-45.0, "warn")])
@pytest.mark.parametrize("at", [3, 20])
def test_a_charge_that_has_truly_fallen_is_acted_on_in_time(wrong: float, level: str, at: int) -> None:
    rig = FalseRig(world=World(charge_percent=70.0), wrong=wrong, first=at, last=math.inf)
    crossed = of_type(rig.fly(PLAN).events, LimitCrossed)
    assert level in [event.level for event in crossed]
    assert rig.made[0].seen_s is not None
    assert crossed[0].t - rig.made[0].seen_s <= HOLD_S + 0.2
