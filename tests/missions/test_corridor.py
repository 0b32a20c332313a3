"""A robot that leaves the way of a drive by more than its profile allows is recorded and stopped, then tries again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from execution.journalled import Field, PowerCut
from fieldhand.clock import SimulatedClock
from fieldhand.errors import ProfileError
from fieldhand.evaluation.log_replay import replay_log
from fieldhand.evaluation.report.incidents import faults
from fieldhand.evaluation.report.place_names import PlaceNames
from fieldhand.exchange.incidents import incidents
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.ground_truth import GroundTruth
from fieldhand.execution.drivers.simulation.world import RobotStrays, TreeRef, World
from fieldhand.execution.drivers.simulation.world_file import parse_world
from fieldhand.execution.mission_clock import MissionClock
from fieldhand.execution.mission_runner import Result
from fieldhand.places.selectors import Rows, TreeIs
from fieldhand.robot.loader import parse_profile, profile_bytes
from fieldhand.task.event_lines import from_json, to_json
from fieldhand.task.plan import Act, ForEach, GoTo, InOrder, Node, Try
from fieldhand.task.results import Arrived, Driving, Ended, Faulted, Strayed, Worked
from fieldhand.wording.events import EventText
from support.examples import examples
from support.missions.rig import Rig, captured, husky, of_type, orchard, task_for
from support.missions.working import along, tractor

SITE = orchard()
#: Far from the start, so that the robot strays in the middle of a drive of 20 m.
PLAN = Act(action="read_co2", at=TreeIs(tree="r0c4"))


def kept(corridor_m: float | None, retries: int = 1):
    return replace(husky(retries=retries), corridor_m=corridor_m)


def flown(
    by_m: float, *, corridor_m: float | None = 2.0, times: int | None = 1, retries: int = 1, plan: Node = PLAN
) -> Result:
    world = World(faults=(RobotStrays(by_m=by_m, times=times),))
    return Rig(robot=kept(corridor_m, retries), world=world).fly(plan)


def ways(result: Result) -> list[shapely.LineString]:
    return [
        shapely.LineString(SITE.projection.metres(*zip(*d.path, strict=True))) for d in of_type(result.events, Driving)
    ]


@pytest.mark.parametrize("by_m", [3.0, -3.0])
def test_a_robot_that_leaves_its_way_is_stopped_and_tries_again(by_m: float) -> None:
    result = flown(by_m)
    assert result.status == "completed"
    (strayed,) = of_type(result.events, Strayed)
    (fault,) = of_type(result.events, Faulted)
    assert strayed.place == "r0c4"
    assert 2.0 < strayed.away_m < 3.0
    assert strayed.corridor_m == 2.0
    at = shapely.Point(SITE.projection.metres(strayed.lat, strayed.lon)[0])
    first, again = ways(result)[:2]
    assert first.distance(at) == pytest.approx(strayed.away_m, abs=0.01)
    # It is stopped at once, and the next way begins where it then stands.
    assert shapely.Point(again.coords[0]).distance(at) < 1.0
    assert fault.handled
    assert f"left the approved way by {strayed.away_m:.1f} m; trying again" in fault.what
    assert fault.t >= strayed.t
    assert 0.0 < strayed.travelled_m < of_type(result.events, Arrived)[0].travelled_m
    assert captured(result.events) == [("read_co2", "r0c4")]


def test_a_robot_that_strays_at_every_try_fails_for_good() -> None:
    result = flown(4.0, times=None)
    assert result.status == "faulted"
    assert [f.handled for f in of_type(result.events, Faulted)][-1] is False
    assert len([s for s in of_type(result.events, Strayed) if s.place == "r0c4"]) == 2
    assert captured(result.events) == []


def test_a_plan_can_go_on_after_it() -> None:
    plan = Try(body=GoTo(place=TreeIs(tree="r0c4")), otherwise=Act(action="read_co2", at=TreeIs(tree="r1c1")))
    world = World(faults=(RobotStrays(by_m=4.0, at=TreeRef(id="r0c4")),))
    result = Rig(robot=kept(1.5, retries=0), world=world).fly(plan)
    assert result.status == "completed"
    assert captured(result.events) == [("read_co2", "r1c1")]


@pytest.mark.parametrize(("by_m", "corridor_m"), [(1.9, 2.0), (50.0, None)])
def test_within_the_corridor_or_without_one_nothing_happens(by_m: float, corridor_m: float | None) -> None:
    result = flown(by_m, corridor_m=corridor_m, times=None)
    assert result.status == "completed"
    assert of_type(result.events, Strayed) == []
    assert of_type(result.events, Faulted) == []


@given(st.floats(-8.0, 8.0), st.floats(0.6, 6.0), st.integers(0, 2), st.sampled_from([1, 2, None]))
@settings(max_examples=examples(25, thorough=300))
def test_every_excess_is_recorded_and_ends_its_drive(by_m, corridor_m, retries, times) -> None:
    plan = ForEach(select=Rows(first="r1", last="r2"), body=Act(action="read_co2"))
    result = flown(by_m, corridor_m=corridor_m, times=times, retries=retries, plan=plan)
    strayed = of_type(result.events, Strayed)
    assert all(corridor_m < s.away_m <= abs(by_m) + 0.01 for s in strayed)
    assert len(strayed) == len([f for f in of_type(result.events, Faulted) if "left the approved way" in f.what])
    if abs(by_m) < corridor_m - 1e-6:
        assert not strayed
    for event, following in zip(result.events, result.events[1:], strict=False):
        if isinstance(event, Strayed):
            assert isinstance(following, Faulted)
    assert [from_json(to_json(s)) for s in strayed] == strayed
    counts = replay_log(task_for(plan).composition.plan, result.events)
    assert sum(count.done for count in counts.values()) == len(captured(result.events))


def test_words_report_and_replay_show_it() -> None:
    result = flown(3.0)
    (strayed,) = of_type(result.events, Strayed)
    text = EventText(kept(2.0))
    said = f"LEFT THE WAY to tree r0c4 by {strayed.away_m:.1f} m, at most 2 m are allowed; it is stopped"
    assert text.sentence(strayed) == said
    (one,) = [i for i in incidents(result.events, text.line) if i.event == "strayed"]
    assert (one.at, one.words, one.place) == ((strayed.lat, strayed.lon), said, "r0c4")
    lines = faults(kept(2.0), result.events, PlaceNames(SITE)).lines
    assert any(said in line for line in lines)


def test_work_along_a_row_goes_on_where_the_way_was_left(monkeypatch: pytest.MonkeyPatch) -> None:
    metres = iter([0.0, 3.0])  # not on the drive to the row, but along it
    monkeypatch.setattr(GroundTruth, "strays_by_m", lambda *_: next(metres, 0.0))
    robot = replace(tractor(), corridor_m=1.5)
    result = Rig(site=SITE, robot=robot).fly(InOrder(steps=(along("r0"),)))
    assert result.status == "completed"
    worked, (strayed,) = of_type(result.events, Worked), of_type(result.events, Strayed)
    assert [w.status for w in worked] == ["failed", "success"]
    assert f"left the approved way by {strayed.away_m:.1f} m" in worked[0].what
    # What it did off the row is worked again.
    assert sum(w.worked_m for w in worked) >= 19.9


class StrayingField(Field):
    """A journalled mission whose robot leaves its way once."""

    def _new(self) -> tuple[SimulatedClock | MissionClock, SimulatedDriver]:
        clock, _ = super()._new()
        world = World(faults=(RobotStrays(by_m=4.0, times=1),))
        return clock, SimulatedDriver(SITE, self.robot, world, clock, np.random.default_rng(2))


@pytest.mark.parametrize("outlives", [False, True])
def test_a_power_cut_around_it_is_survived(tmp_path: Path, outlives: bool) -> None:
    cut = 0
    while True:
        cut += 1
        field = StrayingField(tmp_path / f"{cut}", robot=kept(2.0), outlives=outlives)
        try:
            field.fly(PLAN, cut=cut)
        except PowerCut:
            field.fly(PLAN)
        else:
            break
        found = [event for line in field.lines if (event := from_json(line)) is not None]
        assert of_type(found, Ended)[-1].status == "completed"
        assert captured(found) == [("read_co2", "r0c4")]
        assert len(of_type(found, Strayed)) <= 1
    assert cut > 3


def test_a_world_file_and_a_profile_state_it() -> None:
    world = parse_world(yaml.safe_load('faults:\n- {fault: robot_strays, at: {id: "r0c4"}, by_m: -3, times: 2}'))
    assert world.faults == (RobotStrays(by_m=-3.0, at=TreeRef(id="r0c4"), times=2),)
    data, _ = profile_bytes("husky")
    assert parse_profile(data).corridor_m is None
    assert parse_profile(data + b"corridor_m: 1.5\n").corridor_m == 1.5
    for value in ("0.5", "-1", ".nan", "true", "1000"):
        with pytest.raises(ProfileError, match="corridor_m"):
            parse_profile(data + f"corridor_m: {value}\n".encode())
