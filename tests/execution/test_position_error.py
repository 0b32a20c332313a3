"""A robot that stops within the tolerance of its navigation, and one that is not where it believes to be."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString
from shapely.geometry import Point as ShapelyPoint

from execution.journalled import Field, PowerCut
from fieldhand.clock import SimulatedClock
from fieldhand.errors import WorldError
from fieldhand.execution.drivers.protocol import ActionGoal
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.goal_course import until_near_end
from fieldhand.execution.drivers.simulation.world import Blocked, Localisation, TreeRef, Truth, World
from fieldhand.execution.drivers.simulation.world_file import parse_world
from fieldhand.execution.mission_clock import MissionClock
from fieldhand.execution.mission_runner import Result
from fieldhand.places.selectors import Rows, TreeIs
from fieldhand.site.model import Place
from fieldhand.task.event_lines import from_json
from fieldhand.task.plan import Act, ForEach, Node
from fieldhand.task.results import Arrived, Ended, Faulted, Strayed
from fieldhand.testing.driver_contract import drive_goal, finish
from support.examples import examples
from support.missions.rig import Rig, captured, husky, of_type, orchard

SITE = orchard()
TREES = [tree.place for tree in SITE.trees]
ROW = ForEach(select=Rows(first="r1", last="r1"), body=Act(action="read_co2"))

Point = tuple[float, float]
POINTS = st.tuples(st.floats(-50, 50), st.floats(-50, 50))
ERRORS = st.builds(
    Localisation,
    drift_m_per_100_m=st.floats(0, 5),
    toward_deg=st.none() | st.floats(0, 359),
    noise_m=st.sampled_from([0.0, 0.02]),
    fix_drifts=st.booleans(),
)


def driver_in(world: World, seed: int = 0, alpha: float = 1.0) -> tuple[SimulatedDriver, SimulatedClock]:
    clock = SimulatedClock()
    return SimulatedDriver(SITE, husky(alpha), world, clock, np.random.default_rng(seed)), clock


def driven(driver: SimulatedDriver, clock: SimulatedClock, place: Place) -> float:
    """Drive to a place from where the robot believes to be; return the metres."""
    at = driver.position()
    driver.start_drive(drive_goal(at.as_place(), place))
    return finish(driver, clock).metres


def off(driver: SimulatedDriver) -> Point:
    pose, true = driver.pose(), driver.true_position()
    return pose.x - true.x, pose.y - true.y


def length(path: tuple[Point, ...]) -> float:
    return sum(math.dist(a, b) for a, b in itertools.pairwise(path))


@given(st.lists(POINTS, min_size=2, max_size=6).map(tuple), st.floats(0.01, 5.0))
@settings(max_examples=examples(100, thorough=1000))
def test_a_path_ends_where_all_that_is_left_is_near_its_end(path: tuple[Point, ...], tolerance_m: float) -> None:
    assume(all(math.dist(a, b) > 1e-3 for a, b in itertools.pairwise(path)))
    cut = until_near_end(path, tolerance_m)
    whole = LineString(path)
    assert whole.distance(ShapelyPoint(cut[-1])) < 1e-6
    assert length(cut) <= max(0.0, length(path) - tolerance_m) + 1e-6
    rest = [cut[-1], *path[len(cut) - 1 :]]
    if length(cut) > 0.0:
        assert math.dist(cut[-1], path[-1]) == pytest.approx(tolerance_m, abs=1e-6)
        assert length(tuple(rest)) + length(cut) == pytest.approx(length(path))
    else:
        rest = list(path)
    assert all(math.dist(point, path[-1]) <= tolerance_m + 1e-6 for point in rest)


@given(st.lists(st.integers(0, len(TREES) - 1), min_size=1, max_size=5), st.floats(0.05, 0.5), st.integers(0, 9))
@settings(max_examples=examples(25, thorough=300))
def test_a_drive_ends_within_tolerance_and_the_next_begins_there(visits, tolerance_m: float, seed: int) -> None:
    driver, clock = driver_in(World(goal_tolerance_m=tolerance_m), seed)
    for visit in visits:
        place, before = TREES[visit], driver.position().xy
        metres = driven(driver, clock, place)
        away = math.dist(driver.position().xy, place.xy)
        assert away <= tolerance_m + 1e-9
        assert metres == pytest.approx(max(0.0, math.dist(before, place.xy) - tolerance_m), abs=1e-9)
        assert metres == pytest.approx(math.dist(before, driver.position().xy), abs=1e-9)


def test_a_plan_from_another_place_nearby_begins_where_the_robot_is() -> None:
    driver, clock = driver_in(World(goal_tolerance_m=0.25))
    driven(driver, clock, TREES[0])
    here = driver.position().xy
    driver.start_drive(drive_goal(TREES[0], TREES[1]))  # as a mission plans it that takes the robot to be at the place
    clock.advance(0.0)
    assert driver.position().xy == pytest.approx(here)
    assert finish(driver, clock).metres == pytest.approx(math.dist(here, TREES[1].xy) - 0.25)


@given(st.lists(st.integers(0, len(TREES) - 1), min_size=1, max_size=5), ERRORS, st.integers(0, 9))
@settings(max_examples=examples(25, thorough=300))
def test_the_error_grows_with_the_metres_and_the_robot_steers_by_what_it_believes(visits, size, seed: int) -> None:
    driver, clock = driver_in(World(localisation=size), seed, alpha=0.5)
    metres = 0.0
    for visit in visits:
        metres += driven(driver, clock, TREES[visit])
        assert driver.pose().xy == pytest.approx(TREES[visit].xy, abs=1e-6)
        assert math.hypot(*off(driver)) == pytest.approx(size.drift_m_per_100_m * metres / 100.0, abs=1e-6)
        shown = driver.pose() if size.fix_drifts else driver.true_position()
        assert math.dist(driver.position().xy, shown.xy) <= 8.0 * size.noise_m + 1e-9
        if size.toward_deg is not None and math.hypot(*off(driver)) > 0.01:
            toward = math.radians(size.toward_deg)
            along = off(driver)[0] * math.sin(toward) + off(driver)[1] * math.cos(toward)
            assert along == pytest.approx(math.hypot(*off(driver)))


@given(st.lists(st.integers(0, len(TREES) - 1), min_size=1, max_size=5), ERRORS, st.integers(0, 9), st.integers(0, 5))
@settings(max_examples=examples(20, thorough=200))
def test_the_same_seed_gives_the_same_also_after_a_restart(visits, size, seed: int, cut: int) -> None:
    world = World(localisation=size, goal_tolerance_m=0.25)
    (one, clock), (two, later) = driver_in(world, seed, 0.5), driver_in(world, seed, 0.5)
    for number, visit in enumerate(visits):
        if number == cut:
            state, now = two.state(), later.now()
            two, later = driver_in(world, seed + 1, 0.5)
            later.advance(now)
            two.restore(state)
        assert driven(one, clock, TREES[visit]) == pytest.approx(driven(two, later, TREES[visit]), abs=1e-3)
        for a, b in ((one.pose(), two.pose()), (one.true_position(), two.true_position())):
            assert a.xy == pytest.approx(b.xy, abs=1e-3)


def test_a_fix_has_the_noise_of_the_world_and_is_the_same_at_the_same_time() -> None:
    driver, clock = driver_in(World(localisation=Localisation(noise_m=0.05)))
    found = []
    for _ in range(1000):
        found.append(driver.position().xy)
        assert driver.position().xy == found[-1]
        clock.advance(0.1)
    spread = np.array(found) - np.array(driver.true_position().xy)
    assert np.std(spread, axis=0) == pytest.approx([0.05, 0.05], rel=0.15)
    assert np.mean(spread, axis=0) == pytest.approx([0.0, 0.0], abs=0.01)


@given(st.floats(0, 5), st.floats(0, 359), st.floats(0.5, 2.0))
@settings(max_examples=examples(25, thorough=300))
def test_an_obstacle_stops_the_robot_where_it_is_not_where_it_believes_to_be(drift, toward, radius: float) -> None:
    far = TREES[4]  # 25 m along the first row
    size = Localisation(drift_m_per_100_m=drift, toward_deg=toward)
    world = World(faults=(Blocked(at=TreeRef(id=TREES[2].id), within_m=radius),), localisation=size)
    driver, clock = driver_in(world)
    for _ in range(3):  # trying again does not lead through
        driver.start_drive(drive_goal(driver.position().as_place(), far))
        progress = finish(driver, clock)
        away = math.dist(driver.true_position().xy, TREES[2].xy)
        if progress.fault == "none":
            assert away > radius - 1e-6
            return
        assert progress.fault == "blocked"
        assert away == pytest.approx(radius, abs=1e-5)


def test_a_capture_is_that_of_the_tree_where_the_robot_is() -> None:
    """Driven 100 m, it believes to be one tree farther on than it is."""
    values = tuple((TreeRef(id=tree.id), 400.0 + number) for number, tree in enumerate(TREES))
    spacing = math.dist(TREES[1].xy, TREES[2].xy)
    size = Localisation(drift_m_per_100_m=spacing, toward_deg=90.0)
    world = World(readings={"co2": Truth(trees=values)}, localisation=size)
    driver, clock = driver_in(world)
    east = max(place.x for place in TREES)
    while sum(off(driver)) < spacing - 1e-6:
        left = 100.0 * (1.0 - off(driver)[0] / spacing)
        at, to = driver.position(), driver.position().x + (min(left, 20.0) if driver.position().x < east else -left)
        driver.start_drive(drive_goal(at.as_place(), Place.of_robot((to, at.y), lat=at.lat, lon=at.lon)))
        finish(driver, clock)
    driver.start_action(ActionGoal(action="read_co2", place=TREES[2]))
    assert finish(driver, clock).readings == {"co2": 401.0}


def test_without_error_and_tolerance_nothing_differs() -> None:
    results = [Rig(robot=husky(alpha=0.5), world=w).fly(ROW) for w in (World(), World(localisation=Localisation()))]
    legs = [[(a.place, a.leg_m) for a in of_type(r.events, Arrived)] for r in results]
    assert [place for place, _ in legs[0]] == [place for place, _ in legs[1]]
    assert [m for _, m in legs[0]] == pytest.approx([m for _, m in legs[1]])


def flown(world: World, plan: Node = ROW, corridor_m: float | None = 2.0, retries: int = 1) -> Result:
    return Rig(robot=replace(husky(retries=retries), corridor_m=corridor_m), world=world).fly(plan)


def test_a_mission_with_tolerance_drift_and_noise_is_a_little_shorter_and_completes() -> None:
    exact = flown(World())
    near = flown(
        World(goal_tolerance_m=0.25, localisation=Localisation(drift_m_per_100_m=1.0, noise_m=0.02)), corridor_m=1.0
    )
    assert near.status == exact.status == "completed"
    assert captured(near.events) == captured(exact.events)
    (a,), (b,) = of_type(near.events, Ended), of_type(exact.events, Ended)
    assert b.travelled_m - 0.5 * len(of_type(exact.events, Arrived)) < a.travelled_m < b.travelled_m
    assert not of_type(near.events, Faulted)


def test_drift_that_fixes_show_beyond_the_corridor_is_an_event_then_a_stop() -> None:
    size = Localisation(drift_m_per_100_m=20.0, toward_deg=0.0, fix_drifts=False)
    result = flown(World(localisation=size), Act(action="read_co2", at=TreeIs(tree="r1c4")))
    strayed, faults = of_type(result.events, Strayed), of_type(result.events, Faulted)
    assert strayed
    assert all(2.0 < s.away_m < 4.0 for s in strayed)
    assert "left the approved way by" in faults[0].what
    for event, following in itertools.pairwise(result.events):
        if isinstance(event, Strayed):
            assert isinstance(following, Faulted)
    assert result.status == "faulted"
    assert captured(result.events) == []


def test_drift_that_nobody_sees_is_no_event() -> None:
    size = Localisation(drift_m_per_100_m=20.0, toward_deg=0.0)
    assert not of_type(flown(World(localisation=size)).events, Strayed)


def test_a_world_file_states_it() -> None:
    keys = "{drift_m_per_100_m: 1, toward_deg: 90, noise_m: 0.02, fix_drifts: false}"
    world = parse_world(yaml.safe_load(f"goal_tolerance_m: 0.25\nlocalisation: {keys}"))
    assert world.goal_tolerance_m == 0.25
    assert world.localisation == Localisation(drift_m_per_100_m=1, toward_deg=90, noise_m=0.02, fix_drifts=False)
    assert parse_world({}) == World()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("goal_tolerance_m: -1", "goal_tolerance_m"),
        ("localisation: {drift_m_per_100_m: 101}", "localisation.drift_m_per_100_m"),
        ("localisation: {toward_deg: 360}", "localisation.toward_deg"),
        ("localisation: {noise_m: .nan}", "localisation.noise_m"),
        ("localisation: {fix_drifts: 2}", "localisation.fix_drifts"),
        ("localisation: {noise: 1}", "did you mean 'noise_m'"),
        ("localisation: 3", "localisation: must be a mapping"),
    ],
)
def test_a_mistake_in_it_is_named(text: str, said: str) -> None:
    with pytest.raises(WorldError, match=said.replace(".", r"\.")):
        parse_world(yaml.safe_load(text))


class DriftingField(Field):
    """A journalled mission of a robot that stops within a tolerance, and drifts."""

    def _new(self) -> tuple[SimulatedClock | MissionClock, SimulatedDriver]:
        clock, _ = super()._new()
        world = World(goal_tolerance_m=0.25, localisation=Localisation(drift_m_per_100_m=2.0, noise_m=0.02))
        return clock, SimulatedDriver(SITE, self.robot, world, clock, np.random.default_rng(2))


@pytest.mark.parametrize("outlives", [False, True])
def test_a_power_cut_changes_nothing_of_it(tmp_path: Path, outlives: bool) -> None:
    plan, cut = Act(action="read_co2", at=TreeIs(tree="r0c4")), 0
    while True:
        cut += 1
        field = DriftingField(tmp_path / f"{cut}", robot=replace(husky(), corridor_m=1.0), outlives=outlives)
        try:
            field.fly(plan, cut=cut)
        except PowerCut:
            field.fly(plan)
        else:
            break
        found = [event for line in field.lines if (event := from_json(line)) is not None]
        assert of_type(found, Ended)[-1].status == "completed"
        assert captured(found) == [("read_co2", "r0c4")]
        assert not of_type(found, Strayed)
    assert cut > 3
