"""A camera that looks to one side sees every plant of which it takes a picture: the robot turns, or comes in so."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path

import pytest
import yaml
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from execution.journalled import Field, PowerCut
from fieldhand.approval.checks import examine
from fieldhand.approval.readback import read_back
from fieldhand.approval.stops import plan_of
from fieldhand.errors import ProfileError
from fieldhand.execution.drivers.simulation.world import ActionFails, World
from fieldhand.forecast.estimate import estimate
from fieldhand.forecast.headings import cameras_of
from fieldhand.forecast.visit_order import drives_for
from fieldhand.places.selectors import TreeIs, UnionOf
from fieldhand.robot.camera import Camera, CameraSide
from fieldhand.robot.loader import load_changed, parse_profile, profile_bytes
from fieldhand.robot.model import RobotProfile
from fieldhand.site.bearings import apart_deg
from fieldhand.site.model import Site
from fieldhand.task.build import make_task
from fieldhand.task.event_lines import from_json
from fieldhand.task.plan import Act, ForEach, GoTo, InOrder, Node
from fieldhand.task.results import Acted, Driving, Ended
from support.missions.cameras import PICTURE, looking, off_view, pictures
from support.missions.rig import Rig, husky, of_type, orchard, task_for
from support.missions.working import row
from support.sites.planted import generated

SITE = orchard()
SIDES: tuple[CameraSide, ...] = ("left", "right", "front", "back")


def some_rows(*names: str) -> UnionOf:
    return UnionOf(parts=tuple(row(name) for name in names))


def each(*trees: str) -> ForEach:
    where = UnionOf(parts=tuple(TreeIs(tree=t) for t in trees))
    return ForEach(id="", select=where, body=Act(id="", action=PICTURE))


def seconds(plan: Node, site: Site, robot: RobotProfile) -> tuple[float, float]:
    """Metres and seconds that the forecast expects; legs of this robot cost what they are long."""
    branch = estimate(task_for(plan), site, robot, 0).branches[0]
    return branch.metres.mean, branch.seconds.mean


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("turn_deg_s", [30.0, 90.0])
def test_a_robot_that_turns_sees_every_plant_and_takes_the_time_that_was_forecast(
    side: CameraSide, turn_deg_s: float
) -> None:
    robot, plan = (
        looking(side, turn_deg_s),
        ForEach(select=some_rows("r1", "r2"), body=Act(action=PICTURE)),
    )
    result = Rig(robot=robot).fly(plan)
    taken = pictures(result.events)
    assert {event.place for event in taken} == {f"r{r}c{c}" for r in (1, 2) for c in range(5)}
    assert max(off_view(SITE, event, side) for event in taken) < 1.0
    metres, duration = seconds(plan, SITE, robot)
    (ended,) = of_type(result.events, Ended)
    assert ended.travelled_m == pytest.approx(metres, abs=0.01)
    assert ended.t == pytest.approx(duration, abs=0.1)
    # The turns are not free.
    quick = Rig(robot=replace(robot, turn_deg_s=720.0)).fly(plan)
    assert ended.t > of_type(quick.events, Ended)[0].t + 1.0


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(SIDES), st.sampled_from([None, 45.0]))
def test_in_any_orchard_the_log_shows_what_the_check_said(
    seed: int, side: CameraSide, turn_deg_s: float | None
) -> None:
    site, robot = generated(seed), looking(side, turn_deg_s)
    drives = drives_for(site, robot)
    trees = [tree.place for tree in site.trees]
    assume(not drives.problem(site.start) and not drives.problem(site.home("return_to_end", site.start)))
    able = [p.id for p, why in zip(trees, drives.problems(trees), strict=True) if not why]
    step = 1 + len(able) // 6
    chosen = able[seed % step :: step]
    assume(chosen)
    plan = each(*chosen)
    examined = examine(task_for(plan), site, robot)
    assert examined.estimate is not None
    result = Rig(site=site, robot=robot).fly(plan)
    taken = pictures(result.events)
    assert {event.place for event in taken} == set(chosen)
    steps = [s for s in examined.estimate.branches[0].walk.steps if s.node.act is not None and s.kind == "act"]
    foreseen = {s.places[0].id: s.sees for s in steps}
    for event in taken:
        if event.heading_deg is None:  # it has not moved yet
            assert not foreseen[event.place]
        elif foreseen[event.place] is not None:
            assert (off_view(site, event, side) <= 30.0 + 1e-6) == foreseen[event.place]
    unseen = [place for place, sees in foreseen.items() if sees is False]
    warned = [problem for problem in examined.problems if "the camera of" in problem.what]
    assert len(warned) == bool(unseen)
    (ended,) = of_type(result.events, Ended)
    metres, duration = seconds(plan, site, robot)
    assert ended.travelled_m == pytest.approx(metres, abs=0.05)
    assert ended.t == pytest.approx(duration, abs=0.5)
    if turn_deg_s is not None:
        assert not unseen


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_robot_that_does_not_turn_comes_in_from_the_right_end_and_goes_along_each_row_once(side: CameraSide) -> None:
    site, robot = orchard(6, 12), looking(side, None)
    plan = ForEach(select=some_rows(*(f"r{k}" for k in range(6))), body=Act(action=PICTURE))
    result = Rig(site=site, robot=robot).fly(plan)
    taken = pictures(result.events)
    assert len(taken) == 72
    assert max(off_view(site, event, side) for event in taken) < 5.0
    # Every row in one go: five more ways than rows would be needed if it turned back within one.
    rows = [site.planting.row_of[site.by_id[event.place].index] for event in taken]
    assert sum(a != b for a, b in itertools.pairwise(rows)) == 5
    plain = Rig(site=site).fly(plan)
    assert of_type(result.events, Ended)[0].travelled_m < 1.6 * of_type(plain.events, Ended)[0].travelled_m


def test_without_a_camera_the_robot_stands_along_the_row_in_driving_direction() -> None:
    result = Rig().fly(InOrder(steps=tuple(Act(action="read_co2", at=TreeIs(tree=t)) for t in ("r1c3", "r1c1"))))
    assert [event.heading_deg for event in of_type(result.events, Acted)] == pytest.approx([90.0, 270.0], abs=1.0)
    drives = of_type(result.events, Driving)
    assert [d.heading_deg for d in drives[:2]] == pytest.approx([90.0, 270.0], abs=1.0)


def test_two_cameras_at_one_tree_turn_the_robot_between_the_pictures() -> None:
    robot = looking("left", 60.0)
    actions = tuple(replace(a, camera=Camera(side="front")) if a.name == "read_co2" else a for a in robot.actions)
    robot = replace(robot, actions=actions)
    plan = InOrder(steps=(GoTo(place=TreeIs(tree="r1c3")), Act(action=PICTURE), Act(action="read_co2")))
    result = Rig(robot=robot).fly(plan)
    one, two = of_type(result.events, Acted)
    assert off_view(SITE, one, "left") < 1.0
    assert off_view(SITE, two, "front") < 1.0
    assert len(of_type(result.events, Driving)) == 2  # there and home: a turn is no drive
    assert of_type(result.events, Ended)[0].t == pytest.approx(seconds(plan, SITE, robot)[1], abs=0.1)


def test_a_retried_picture_does_not_turn_the_robot_away() -> None:
    world = World(faults=(ActionFails(action=PICTURE, times=1),))
    result = Rig(robot=looking("right", 45.0), world=world).fly(each("r1c2"))
    failed, taken = of_type(result.events, Acted)
    assert (failed.status, taken.status) == ("failed", "success")
    assert off_view(SITE, taken, "right") < 1.0


@pytest.mark.parametrize("outlives", [False, True])
def test_a_mission_with_turns_resumes_after_a_power_cut_at_any_time(tmp_path: Path, outlives: bool) -> None:
    robot = looking("right", 20.0)
    plan = InOrder(steps=tuple(Act(action=PICTURE, at=TreeIs(tree=t)) for t in ("r1c3", "r2c0")))
    for cut in itertools.count(1):
        field = Field(tmp_path / f"{cut}", robot=robot, outlives=outlives)
        try:
            field.fly(plan, cut=cut)
        except PowerCut:
            field.fly(plan)
        else:
            break
        taken = pictures(event for line in field.lines if (event := from_json(line)) is not None)
        assert {event.place for event in taken} == {"r1c3", "r2c0"}
        assert max(off_view(SITE, event, "right") for event in taken) < 1.0
    assert cut > 3


def test_the_plan_says_and_shows_how_the_robot_stands() -> None:
    robot, task = looking("right", 45.0), task_for(each("r1c1", "r1c3"))
    forecast = estimate(task, SITE, robot, 0)
    words = read_back(task, SITE, robot, forecast)
    note = "Take a thermal picture: at 2 stops the robot stands with the plant on its right; it turns on the spot"
    assert any(one.startswith(note) for one in words.notes)
    stops = plan_of(task, [b.walk for b in forecast.branches], words.lines).stops
    assert all(stop.heading_deg is not None for stop in stops)
    coming = read_back(task, SITE, looking("right", None), estimate(task, SITE, looking("right", None), 0))
    assert any("comes in so that the plant is on its right" in one for one in coming.notes)
    assert not any(
        "the plant is" in one for one in read_back(task, SITE, husky(), estimate(task, SITE, husky(), 0)).notes
    )


def test_a_camera_that_cannot_see_a_plant_is_a_warning() -> None:
    robot, task = looking("front", None), task_for(each("r1c1", "r1c3"))
    (warning,) = [p for p in examine(task, SITE, robot).problems if "the camera of" in p.what]
    assert warning.severity == "warning"
    assert "looks ahead and does not see tree" in warning.what
    assert "nor 1 more" in warning.what
    assert "turn_deg_s" in warning.advice


def test_the_first_picture_at_a_place_gives_the_heading_of_the_drive() -> None:
    robot = looking("left", 45.0)
    picture = Act(action=PICTURE)
    plan = make_task(
        request="a test",
        plan=InOrder(
            steps=(
                GoTo(place=TreeIs(tree="r0c0")),
                Act(action="read_co2"),
                picture,
                Act(action="read_co2", at=TreeIs(tree="r0c1")),
                GoTo(place=TreeIs(tree="r0c2")),
                ForEach(select=row("r1"), body=InOrder(steps=(Act(action="read_co2"), picture))),
            )
        ),
        measures={},
        nominal="stay",
    ).composition.plan
    first, *_ = (node.id for node in plan.children)
    found = cameras_of(plan, robot)
    goes = [node.id for node in plan.children if node.selector is not None]
    assert [node in found for node in goes] == [True, False, False, True]
    assert first in found
    assert cameras_of(plan, husky()) == {}


@pytest.mark.parametrize(
    ("camera", "why"),
    [
        ({"side": "up"}, "side"),
        ({}, "side"),
        ({"side": "left", "view_deg": 0.5}, "view_deg"),
        ({"side": "left", "fov": 3}, "fov"),
    ],
)
def test_a_camera_that_is_wrong_in_the_profile_is_named(camera: dict[str, object], why: str) -> None:
    values = yaml.safe_load(profile_bytes("husky")[0])
    values["actions"][PICTURE]["camera"] = camera
    with pytest.raises(ProfileError, match=why):
        parse_profile(yaml.safe_dump(values).encode(), source="test.yaml")


def test_profiles_have_a_camera_and_a_speed_of_turning() -> None:
    robot = load_changed("husky", {"turn_deg_s": 45, "actions": {PICTURE: {"camera": {"side": "left"}}}})
    assert robot.turn_deg_s == 45.0
    assert robot.action[PICTURE].camera == Camera(side="left", view_deg=60.0)
    assert husky().action[PICTURE].camera is None


@given(st.floats(0, 360), st.floats(0, 360), st.sampled_from(SIDES), st.floats(1, 180))
def test_a_camera_sees_what_is_within_half_its_view(
    heading: float, bearing: float, side: CameraSide, view: float
) -> None:
    camera = Camera(side=side, view_deg=view)
    assert camera.off_deg(camera.heading_towards(bearing), bearing) < 1e-6
    assert camera.sees(heading, bearing) == (apart_deg(heading, camera.heading_towards(bearing)) <= view / 2.0)
