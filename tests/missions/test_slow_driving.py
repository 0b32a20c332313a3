"""Slow ground and slow driving during events: the robot keeps the limit there, and only there."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import fieldhand as fh
from fieldhand.approval.checks import examine
from fieldhand.execution.drivers.simulation.world import ScriptedEvent, World
from fieldhand.forecast.closed_ground import ground_of
from fieldhand.forecast.slow_ground import SlowGround, rests, slow_ground
from fieldhand.forecast.visit_order import drives_for
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import Here, InZone, Marker, Nearest, Rows, TreeIs, Trees
from fieldhand.robot.loader import load_robot
from fieldhand.task.codec import decode, encode
from fieldhand.task.frames import Constraints, Task
from fieldhand.task.plan import Act, ForEach, InOrder, WorkAlong
from fieldhand.task.results import Arrived, Driving, EventBegan, Worked, Working
from fieldhand.task.watches import EventAbsent, EventHolds, Watch
from fieldhand.task.ways import SlowNear
from support.examples import examples
from support.missions.rig import Rig, captured, of_type, orchard, task_for
from support.missions.watched import watch, watchful, watching, windy

ROBOT = watchful()
SITE = orchard()
DEMO = fh.Site.demo()
PLAN = ForEach(select=Trees(), body=Act(action="read_co2"))


def row(name: str) -> Rows:
    return Rows(first=name, last=name)


def slowly(*slow: SlowNear, plan: ForEach | InOrder | WorkAlong = PLAN) -> Task:
    return task_for(plan, constraints=Constraints(slow=slow))


def near(places: Selector, metres: float, speed: float | None = 0.25) -> SlowNear:
    return SlowNear(places=places, distance_m=metres, speed_m_s=speed)


@given(
    st.lists(st.tuples(st.floats(-20, 40), st.floats(-20, 40)), min_size=2, max_size=6, unique=True),
    st.lists(st.tuples(st.floats(-20, 40), st.floats(-20, 40), st.floats(0.5, 9), st.floats(0.1, 2)), max_size=3),
    st.floats(0.3, 1.5),
)
@settings(deadline=None)
def test_pieces_cover_a_path_without_gaps_and_are_slow_on_slow_ground(points, discs, speed):
    length = sum(math.dist(a, b) for a, b in pairwise(points))
    assume(length > 1e-6)  # a path without a length has no pieces
    ground = SlowGround([(shapely.Point(x, y).buffer(r), v) for x, y, r, v in discs])
    pieces = ground.pieces(points, length, speed)
    assert pieces[0].from_m == 0.0
    assert pieces[-1].to_m == pytest.approx(length)
    assert all(a.to_m == b.from_m for a, b in pairwise(pieces))
    assert all(0 < piece.speed_m_s <= speed for piece in pieces)
    line = shapely.LineString(points)
    for piece in pieces:
        at = line.interpolate((piece.from_m + piece.to_m) / 2)
        limits = [v for x, y, r, v in discs if shapely.Point(x, y).buffer(r).contains(at)]
        assert piece.speed_m_s <= min([speed, *limits]) + 1e-9
    seconds = sum((p.to_m - p.from_m) / p.speed_m_s for p in pieces)
    assert ground.extra_s(points, speed) == pytest.approx(seconds - length / speed, abs=1e-6)


@given(
    st.lists(st.tuples(st.floats(-20, 40), st.floats(-20, 40)), min_size=2, max_size=6, unique=True), st.floats(0, 1)
)
@settings(deadline=None)
def test_the_rest_of_a_path_has_the_length_that_is_left(points, part):
    length = sum(math.dist(a, b) for a, b in pairwise(points))
    rest = rests(points, part * length)
    assert rest[-1] == points[-1]
    assert sum(math.dist(a, b) for a, b in pairwise(rest)) == pytest.approx((1 - part) * length, abs=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_the_robot_keeps_the_limit_on_slow_ground_and_no_other_where_it_is_not(seed):
    slow = near(TreeIs(tree="r1c2"), 6.0)
    result = Rig(robot=ROBOT, seed=seed).fly(slowly(slow))
    assert result.status == "completed"
    assert len(captured(result.events)) == 20
    ground = ground_of(slow.places, slow.distance_m, drives_for(SITE, ROBOT)).shape
    starts = [e for e in result.events if isinstance(e, Driving)]
    ends = [*(e for e in starts[1:]), None]
    speeds = set()
    for one, after in zip(starts, ends, strict=True):
        path = SITE.projection.metres(*zip(*one.path, strict=True)).tolist()
        if after is not None and after.node == one.node:  # the drive went on with another speed there
            begins = SITE.projection.metres(*zip(*after.path, strict=True)).tolist()[0]
            whole = shapely.LineString(path)
            at = whole.project(shapely.Point(begins)) if whole.distance(shapely.Point(begins)) < 0.1 else whole.length
            path = list(shapely.ops.substring(whole, 0, at).coords) if 0 < at < whole.length else path
        inside = shapely.LineString(path).intersection(ground.buffer(-1e-6)).length if len(path) > 1 else 0.0
        speeds.add(one.speed_m_s)
        if inside > 0.01:
            assert one.speed_m_s == 0.25
    assert speeds == {0.25, ROBOT.speed_m_s}


def test_the_forecast_has_the_time_that_the_robot_takes():
    plain, slow = task_for(PLAN), slowly(near(row("r1"), 0.0, 0.2))
    times = {}
    for name, task in (("plain", plain), ("slow", slow)):
        expected = examine(task, SITE, ROBOT).estimate
        assert expected is not None
        flown = Rig(robot=ROBOT).fly(task)
        assert flown.spent.seconds == pytest.approx(expected.worst.seconds.mean, rel=0.02)
        times[name] = flown.spent.seconds
    assert times["slow"] > times["plain"] + 20


def test_without_a_speed_it_is_that_of_the_profile_or_half():
    assert ROBOT.slow_m_s is None
    assert ROBOT.slowly_m_s == ROBOT.speed_m_s / 2
    ground = slow_ground(Constraints(slow=(near(row("r1"), 0.0, None),)), SITE, ROBOT)
    assert ground.slowest_m_s == ROBOT.slowly_m_s


def test_an_implement_is_off_on_no_metre_more_and_its_stretch_is_worked_whole():
    tractor = load_robot("tractor")
    plan = WorkAlong(action="spray", along=row("3"), mode="rows")
    task = fh.build_task(plan, DEMO, tractor, slow=(near(TreeIs(tree="40"), 8.0, 0.3),))
    review = fh.review(task, DEMO, tractor)
    assert not review.errors
    run = fh.simulate(fh.authorize(review, by="Ada"), seed=2)
    assert run.success
    (worked,) = of_type(run.result.events, Worked)
    plain = fh.simulate(fh.authorize(fh.review(fh.build_task(plan, DEMO, tractor), DEMO, tractor), by="Ada"), seed=2)
    (whole,) = of_type(plain.result.events, Worked)
    assert worked.worked_m == pytest.approx(whole.worked_m, abs=0.2)
    assert 0.3 in {e.speed_m_s for e in of_type(run.result.events, Working)}


def test_slow_ground_is_in_the_id_and_the_document_of_a_task():
    task = slowly(near(row("r1"), 3.0))
    assert task.id != task_for(PLAN).id
    assert decode(encode(task)) == task
    assert b"slow-near" not in encode(task_for(PLAN))


@pytest.mark.parametrize(
    ("places", "why"),
    [
        (row("77"), "there is no row '77'"),
        (InZone(zone="lake"), "lake"),
        (Nearest(to=Here(), fresh=True), "depends on where the robot is"),
        (Marker(name="end"), "how far"),
    ],
)
def test_slow_ground_that_cannot_be_found_is_an_error(places, why):
    task = fh.build_task(
        ForEach(select=row("4"), body=Act(action="take_thermal_picture")),
        DEMO,
        load_robot("husky"),
        slow=(SlowNear(places=places),),
    )
    (line,) = [problem.line() for problem in examine(task, DEMO, load_robot("husky")).errors]
    assert why in line


def test_it_is_read_back():
    task = fh.build_task(
        ForEach(select=row("4"), body=Act(action="take_thermal_picture")),
        DEMO,
        watchful(),
        slow=(near(InZone(zone="pond"), 10.0, 0.5),),
        watches=(
            Watch(condition=EventHolds(event="person_near"), response="slow", speed_m_s=0.3),
            Watch(condition=EventAbsent(event="rain"), response="wait", during="take_thermal_picture"),
        ),
    )
    read_back = fh.review(task, DEMO, watchful()).read_back
    assert "at most 0.5 m/s within 10 m of the zone “pond”." in read_back.limits
    first, second = (line.text for line in read_back.lines[:2])
    assert first == "At any time: while someone is near, drive no faster than 0.3 m/s."
    assert second.startswith("In the steps to take a thermal picture: if it is not the case that it rains, stand still")


# --- events ----------------------------------------------------------------------------------------------------------


def slowed(speed: float | None = 0.3, **more: str) -> Task:
    return watching(PLAN, Watch(condition=EventHolds(event="person_near"), response="slow", speed_m_s=speed, **more))


def test_it_drives_slowly_while_the_event_holds_and_as_fast_as_before_afterwards():
    person = ScriptedEvent(event="person_near", from_s=30, until_s=90)
    result = flown(slowed(), person)
    assert result.status == "completed"
    assert len(captured(result.events)) == 20
    (began,) = of_type(result.events, EventBegan)
    clear_s = ROBOT.event["person_near"].clear_s
    for drive in of_type(result.events, Driving):
        if began.t + 1 < drive.t < 90:
            assert drive.speed_m_s == 0.3
        elif drive.t < began.t or drive.t > 90 + clear_s + 2:
            assert drive.speed_m_s == ROBOT.speed_m_s
    quick = flown(watching(PLAN, watch("person_near", "skip")))
    assert result.spent.seconds > quick.spent.seconds + 10


def flown(task: Task, *scripted: ScriptedEvent, seed: int = 0):
    return Rig(robot=ROBOT, world=World(events=scripted), seed=seed).fly(task)


@given(
    st.lists(st.tuples(st.integers(0, 300), st.integers(1, 100)), max_size=4),
    st.integers(0, 1000),
    st.sampled_from([0.15, 0.3, None]),
)
@settings(deadline=None, max_examples=examples(25, thorough=250))
def test_every_place_is_visited_in_the_same_order_whatever_slows_the_robot(times, seed, speed):
    scripted = [ScriptedEvent(event="person_near", from_s=a, until_s=a + b) for a, b in times]
    result, quick = flown(slowed(speed), *scripted, seed=seed), flown(slowed(speed), seed=seed)
    assert captured(result.events) == captured(quick.events)
    assert [e.place for e in of_type(result.events, Arrived)] == [e.place for e in of_type(quick.events, Arrived)]
    assert result.spent.seconds >= quick.spent.seconds - 1e-6
    assert result.spent.metres == pytest.approx(quick.spent.metres, abs=0.5)


def test_an_event_is_watched_only_in_the_steps_of_its_part():
    plan = InOrder(
        steps=(
            ForEach(select=row("r0"), body=Act(action="read_co2")),
            ForEach(select=row("r3"), body=Act(action="take_thermal_picture")),
        )
    )
    task = watching(
        plan, Watch(condition=EventHolds(event="rain"), response="return_to_end", during="take_thermal_picture")
    )
    result = flown(task, ScriptedEvent(event="rain", from_s=5))
    assert result.status == "returned"
    assert {action for action, _ in captured(result.events)} == {"read_co2"}
    assert len(captured(result.events)) == 5
    early = flown(task, ScriptedEvent(event="rain", from_s=1, until_s=20))
    assert early.status == "completed"


def test_a_part_without_its_action_is_an_error():
    task = watching(PLAN, windy(5, "wait", during="take_thermal_picture"))
    lines = [problem.line() for problem in examine(task, SITE, ROBOT).errors]
    assert any("only in the steps to take a thermal picture, and the plan has none" in line for line in lines)


def test_the_absence_of_an_event_is_watched():
    task = watching(PLAN, Watch(condition=EventAbsent(event="person_near"), response="wait", at_most_s=600))
    result = flown(
        task,
        ScriptedEvent(event="person_near", from_s=40),
    )
    assert result.status == "completed"
    (began,) = of_type(result.events, EventBegan)
    assert began.t == 0
    assert of_type(result.events, Driving)[0].t >= 40


def test_a_silent_sensor_counts_as_what_is_watched():
    for condition in (EventAbsent(event="person_near"), EventHolds(event="person_near")):
        task = watching(PLAN, Watch(condition=condition, response="end"))
        result = flown(task, ScriptedEvent(event="person_near", silent=True, from_s=0))
        assert result.status == "returned"
