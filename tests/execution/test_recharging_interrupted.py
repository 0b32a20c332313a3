"""Charging in the middle of a stretch and of a wait, and power cuts while the robot charges."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from execution.journalled import Field, PowerCut
from fieldhand import mission
from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import BatteryDrains, World
from fieldhand.execution.mission_clock import MissionClock
from fieldhand.places.selectors import Rows, TreeIs
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.event_lines import from_json
from fieldhand.task.nodes.work_along import WorkAlong
from fieldhand.task.plan import Act, GoTo, InOrder, Node, Recharge, Wait
from fieldhand.task.results import Acted, ChargeBegun, ChargeEnded, Dwelling, Dwelt, Ended, Resumed, Worked
from support.missions.rechargeable import CHARGING, rechargeable, simulated, task_of
from support.missions.rig import husky, of_type, orchard
from support.missions.working import tractor


def small_tractor() -> RobotProfile:
    """Return the tractor with a battery for about four rows of the built-in orchard."""
    robot = tractor()
    return replace(robot, energy=replace(robot.energy, capacity_j=700_000.0))


def flown(plan: Node, robot: RobotProfile, drains: BatteryDrains | None) -> mission.Run:
    site = Site.demo()
    world = None if drains is None else World(faults=(drains,))
    return simulated(task_of(plan, site, robot, recharge=True), site, robot, world=world)


@pytest.mark.parametrize(("factor", "from_s"), [(1.3, 300.0), (1.6, 300.0), (1.6, 400.0)])
def test_work_along_a_row_goes_on_where_a_charge_broke_it_off(factor: float, from_s: float) -> None:
    plan = WorkAlong(action="spray", along=Rows(first="2", last="5"))
    whole = of_type(flown(plan, small_tractor(), None).events, Worked)
    done = flown(plan, small_tractor(), BatteryDrains(factor=factor, from_s=from_s))
    assert done.status == "completed", done.reason
    parts = of_type(done.events, Worked)
    assert [p.stretch for p in parts if p.status == "success"] == [w.stretch for w in whole]
    broken = [p for p in parts if p.status == "cancelled"]
    assert broken
    for one in whole:
        some = [p for p in parts if p.stretch == one.stretch]
        assert sum(p.worked_m for p in some) == pytest.approx(one.worked_m, abs=0.01)
        assert sum(p.amount for p in some) == pytest.approx(one.amount, rel=1e-3)
        ends = [path[-1] for p in some[:-1] for path in p.paths[-1:]]
        begins = [path[0] for p in some[1:] for path in p.paths[:1]]
        for end, begin in zip(ends, begins, strict=True):
            assert np.allclose(end, begin, atol=2e-6)  # a fifth of a metre
    between = [e for e in done.events if isinstance(e, Worked | ChargeEnded)]
    for part in broken:
        assert isinstance(between[between.index(part) + 1], ChargeEnded)


def test_a_wait_goes_on_for_the_time_that_a_charge_left_of_it() -> None:
    plan = InOrder(steps=(GoTo(place=TreeIs(tree="100")), Wait(seconds=1000.0), Act(action="take_thermal_picture")))
    done = flown(plan, rechargeable(alpha=1.0), BatteryDrains(factor=1.7, from_s=200.0))
    assert done.status == "completed", done.reason
    (begun,), (ended,) = of_type(done.events, Dwelling), of_type(done.events, Dwelt)
    charged = [e for e in of_type(done.events, ChargeEnded) if begun.t < e.t < ended.t]
    assert 1 <= len(charged) <= 3
    assert ended.seconds == pytest.approx(1000.0)
    assert ended.t - begun.t > 1000.0 + sum(e.seconds for e in charged)
    (capture,) = of_type(done.events, Acted)
    assert capture.t > ended.t


def test_an_implement_takes_its_energy_where_it_is_on() -> None:
    plan = WorkAlong(action="spray", along=Rows(first="2", last="5"))
    robot = small_tractor()
    task = task_of(plan, Site.demo(), robot, recharge=True)
    estimate = mission.review(task, Site.demo(), robot).estimate
    done = simulated(task, Site.demo(), robot)
    assert estimate is not None
    assert estimate.worst.charges is not None
    assert estimate.worst.charges.mean == len(of_type(done.events, ChargeEnded)) == 1
    assert all(part.status == "success" for part in of_type(done.events, Worked))


def with_charger() -> Site:
    """Return the grid with a charger beside its start."""
    site = orchard()
    start = site.markers["start"]
    x, y = start.x, start.y - 3.0
    lat, lon = site.projection.degrees([(x, y)])[0]
    charger = Place(kind="marker", id="charger", x=x, y=y, lat=float(lat), lon=float(lon))
    return replace(site, markers={**site.markers, "charger": charger})


class Watched(SimulatedDriver):
    """A simulated robot that is looked at every ten seconds, as a real one is."""

    def next_event_in(self) -> float | None:
        soon = super().next_event_in()
        return None if soon is None else min(10.0, soon)


class ChargingField(Field):
    def _new(self) -> tuple[SimulatedClock | MissionClock, SimulatedDriver]:
        clock, _ = super()._new()
        return clock, Watched(with_charger(), self.robot, World(), clock, np.random.default_rng(2))


@pytest.mark.parametrize("outlives", [False, True])
def test_it_charges_on_after_every_power_cut(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, outlives: bool) -> None:
    monkeypatch.setattr("execution.journalled.orchard", with_charger)
    charging = rechargeable().energy.charging
    robot = husky(alpha=1.0)
    robot = replace(robot, energy=replace(robot.energy, capacity_j=60_000.0, charging=charging))
    picture = Act(action="take_thermal_picture", at=TreeIs(tree="r1c1"), count=4)
    plan = InOrder(steps=(picture, Recharge(until_percent=95.0), replace(picture, at=TreeIs(tree="r2c2"))))
    cut, while_charging = 0, 0
    while True:
        cut += 1
        field = ChargingField(tmp_path / str(cut), robot=robot, outlives=outlives)
        try:
            field.fly(plan, cut=cut)
        except PowerCut:
            field.fly(plan)
        else:
            break
        found = [event for line in field.lines if (event := from_json(line)) is not None]
        assert of_type(found, Ended)[-1].status == "completed"
        charges, begun = of_type(found, ChargeEnded), of_type(found, ChargeBegun)
        assert charges[-1].charge_percent >= 94.0
        assert sum(e.status == "success" for e in of_type(found, Acted)) == 8
        resumed = of_type(found, Resumed)
        while_charging += any(b.t <= r.t <= charges[-1].t for r in resumed for b in begun)
    assert while_charging > 1
    assert CHARGING["until_percent"] < 95.0
