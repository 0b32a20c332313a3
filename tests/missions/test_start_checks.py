"""A mission on a robot: it sets out only from the site and with the charge, and goes on only on a robot."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand import mission, missions
from fieldhand.clock import Clock, SimulatedClock
from fieldhand.errors import ExecutionError, FieldhandError, JournalError, NotApprovedError
from fieldhand.execution.drivers.protocol import Position
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.journal import store
from fieldhand.execution.vehicle import Connection, Vehicle
from fieldhand.forecast.visit_order import drives_for, start_place
from fieldhand.places.selectors import Trees
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Acted, Event, Resumed
from support.examples import examples
from support.missions.kept import inputs
from support.missions.rig import husky, orchard, task_for

BY = Connection(transport="dds", domain=7, namespace="/east")
ROBOT = husky()


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


def in_the_pond(site: Site) -> tuple[float, float]:
    """Metres east and north of the start."""
    start, pond = site.start, site.zones_of("keep_out")[0].polygon.centroid
    return (pond.x - start.x, pond.y - start.y)


class Somewhere(SimulatedDriver):
    """A robot that stands where somebody left it, so many metres east and north of the start."""

    def __init__(self, site: Site, away_m: tuple[float, float], clock: Clock | None = None) -> None:
        super().__init__(site, ROBOT, World(), clock or SimulatedClock(), np.random.default_rng(0))
        self.site, self.away_m = site, away_m
        self.why_lost: str | None = None
        self.why_stopped: str | None = None

    def position(self) -> Position:
        start = start_place(drives_for(self.site, ROBOT))
        x, y = (a + b for a, b in zip(start.stand or start.xy, self.away_m, strict=True))
        ((lat, lon),) = self.site.projection.degrees([(x, y)])
        return Position(x=x, y=y, lat=float(lat), lon=float(lon))

    def lost(self) -> str | None:
        return self.why_lost

    def stopped(self) -> str | None:
        return self.why_stopped


@pytest.mark.parametrize(
    ("site", "away_m", "why"),
    [
        (open_site("demo"), (-5_000.0, 0.0), "outside the boundary"),
        (open_site("demo"), (0.0, -300_000.0), "outside the boundary"),
        (orchard(), (-150.0, 0.0), "150 m from the nearest tree"),
        (orchard(), (0.0, -2_000.0), "2,000 m from the nearest tree"),
        (open_site("demo"), in_the_pond(open_site("demo")), "inside the keep-out"),
    ],
)
def test_a_robot_that_stands_elsewhere_does_not_set_out(site: Site, away_m: tuple[float, float], why: str) -> None:
    with pytest.raises(ExecutionError, match=f"m from the start.*{why}"):
        missions.require_in_place(site, ROBOT, Somewhere(site, away_m))


@settings(max_examples=examples(15, thorough=100))
@given(st.floats(-90.0, 0.0), st.floats(-60.0, 60.0))
def test_a_robot_may_set_out_from_wherever_a_drive_can_begin(east: float, north: float) -> None:
    site = orchard()
    driver = Somewhere(site, (east, north))
    try:
        away_m = missions.require_in_place(site, ROBOT, driver)
    except ExecutionError:
        return
    assert away_m == pytest.approx((east**2 + north**2) ** 0.5)
    at = driver.position()
    here = replace(site.start, kind="point", id="here", x=at.x, y=at.y, stand=(at.x, at.y))
    assert drives_for(site, ROBOT).between(here, site.trees[0].place).length_m >= 0


def test_a_robot_that_is_lost_or_stopped_does_not_set_out() -> None:
    driver = Somewhere(orchard(), (0.0, 0.0))
    assert missions.require_in_place(orchard(), ROBOT, driver) == 0
    driver.why_lost = "no satellite fix"
    with pytest.raises(ExecutionError, match=r"does not know where it is: no satellite fix"):
        missions.require_in_place(orchard(), ROBOT, driver)
    driver.why_lost, driver.why_stopped = None, "emergency stop"
    with pytest.raises(ExecutionError, match=r"will not move: emergency stop"):
        missions.require_in_place(orchard(), ROBOT, driver)


def test_a_charge_that_does_not_last_is_said_before_a_wheel_turns() -> None:
    site, low = orchard(), replace(ROBOT, energy=replace(ROBOT.energy, capacity_j=80_000.0))
    review = mission.review(task_for(ForEach(id="", select=Trees(), body=Act(id="", action="read_co2"))), site, low)
    assert not review.errors
    missions.require_charged(review, site, low, 100.0)
    with pytest.raises(NotApprovedError, match=r"battery at 21 %.*charge it first"):
        missions.require_charged(review, site, low, 21.0, confirm=True)


def test_a_mission_is_not_examined_again_for_the_battery_it_was_examined_for(monkeypatch: pytest.MonkeyPatch) -> None:
    site = orchard()
    review = mission.review(task_for(ForEach(id="", select=Trees(), body=Act(id="", action="read_co2"))), site, ROBOT)

    def examined_again(*args: object, **options: object) -> None:
        raise AssertionError

    monkeypatch.setattr(mission, "review", examined_again)
    missions.require_charged(review, site, ROBOT, 100.0)
    with pytest.raises(AssertionError):
        missions.require_charged(review, site, ROBOT, 99.0)


@dataclass
class Robot:
    """A robot that outlasts the program: it is what its driver drives, also after that was killed."""

    clock: SimulatedClock
    driver: SimulatedDriver

    @classmethod
    def at_the_start(cls) -> Robot:
        clock = SimulatedClock()
        site = open_site("demo")
        return cls(clock, SimulatedDriver(site, ROBOT, World(charge_percent=80.0), clock, np.random.default_rng(1)))

    @property
    def vehicle(self) -> Vehicle:
        return Vehicle(driver=self.driver, clock=self.clock, charge_percent=self.driver.charge_percent(), by=BY)


def begun(tmp_path: Path, robot: Robot) -> missions.StoredMission:
    given = replace(inputs(), world=None, started_on=missions.robot_at_start(robot.vehicle))
    return missions.begin(tmp_path, "m1", given)


class _Killed(BaseException):
    """As kill -9: nothing of the program runs any more."""


def test_a_mission_that_was_killed_goes_on_where_the_robot_is(tmp_path: Path) -> None:
    """It is not brought to where it was, and has used what it has used since it set out."""
    robot = Robot.at_the_start()
    given = begun(tmp_path, robot)

    def dies(event: Event) -> None:
        if isinstance(event, Acted):
            raise _Killed

    with pytest.raises(_Killed):
        missions.carry_out(given, vehicle=robot.vehicle, emit=dies)
    assert robot.driver.charge_percent() < 80.0
    result = missions.carry_out(missions.open_mission(given.folder), vehicle=robot.vehicle, emit=lambda _: None)
    assert result.status == "completed"
    assert len([e for e in result.events if isinstance(e, Acted)]) == 1
    assert len([e for e in result.events if isinstance(e, Resumed)]) == 1
    assert result.spent.percent == pytest.approx(80.0 - robot.driver.charge_percent())
    assert missions.read_folder(given.folder).started_on == missions.RobotAtStart(by=BY, charge_percent=80.0)


def test_simulation_and_robot_are_not_mistaken_for_each_other(tmp_path: Path) -> None:
    robot = Robot.at_the_start()
    on_robot = begun(tmp_path, robot)
    in_simulation = missions.begin(tmp_path, "m2", inputs())
    with pytest.raises(ExecutionError, match=r"started on a robot \(dds, domain 7 as /east\).*resume it on that robot"):
        missions.carry_out(on_robot, emit=print)
    with pytest.raises(ExecutionError, match=r"started in simulation and cannot be continued on a robot"):
        missions.carry_out(in_simulation, vehicle=robot.vehicle, emit=print)
    assert missions.events_of(on_robot.folder) == missions.events_of(in_simulation.folder) == ()


def test_a_folder_says_on_what_it_was_begun_and_older_ones_open(tmp_path: Path) -> None:
    older = missions.begin(tmp_path, "m1", inputs()).folder
    about = json.loads((older / "mission.json").read_bytes())
    assert about["format"] == 1
    assert "departure" not in about
    assert missions.read_folder(older).started_on is None
    newer = begun(tmp_path / "on", Robot.at_the_start()).folder
    about = json.loads((newer / "mission.json").read_bytes())
    assert about["format"] == 2
    assert about["departure"]["by"] == {"transport": "dds", "domain": 7, "namespace": "/east", "sim_time": False}
    for bad in (None, {}, {"by": {"transport": "dds", "more": 1}, "charge_percent": 1}, {"by": {}}):
        (newer / "mission.json").write_text(json.dumps(about | {"departure": bad}))
        with pytest.raises(JournalError, match="not a mission"):
            assert missions.read_folder(newer).started_on is None
        with pytest.raises(FieldhandError):
            missions.open_mission(newer)
