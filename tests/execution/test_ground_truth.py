"""The world bound to a site and a robot: what the file says is exact, what it leaves open depends on the seed alone."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import WorldError
from fieldhand.execution.drivers.simulation.ground_truth import GroundTruth, _enters
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    Blocked,
    SensorAbsurd,
    SensorSilent,
    TreeRef,
    Truth,
    World,
    WorldFault,
)
from fieldhand.site.model import Place
from support.missions.rig import husky, orchard

SITE, ROBOT = orchard(), husky()
TREES = {t.place.id: t.place for t in SITE.trees}


def truth(seed: int = 0, *faults: WorldFault, **readings: Truth) -> GroundTruth:
    return GroundTruth(World(readings=readings, faults=faults), SITE, ROBOT, seed)


def read_co2(ground: GroundTruth, place: Place) -> float:
    return ground.capture("read_co2", place)[0]["co2"]


def test_what_the_file_says_is_read_exactly() -> None:
    near = TREES["r1c1"]
    ground = truth(
        co2=Truth(
            default=380,
            trees=((TreeRef(id="r0c0"), 500.0), (TreeRef(lat=near.lat + 1e-6, lon=near.lon), 450.0)),
        )
    )
    assert read_co2(ground, TREES["r0c0"]) == 500
    assert read_co2(ground, near) == 450
    assert read_co2(ground, TREES["r2c2"]) == 380
    assert read_co2(ground, SITE.markers["end"]) == 380


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**63 - 1), st.permutations(sorted(TREES)))
def test_what_is_drawn_does_not_depend_on_which_tree_comes_first(seed: int, order: list[str]) -> None:
    one, two = truth(seed), truth(seed)
    first = {name: read_co2(one, TREES[name]) for name in sorted(TREES)}
    second = {name: read_co2(two, TREES[name]) for name in order}
    assert first == second


def test_drawn_values_follow_the_profile_and_the_noise_of_a_capture_is_small() -> None:
    quantity = ROBOT.quantity["co2"]
    one = np.array([read_co2(truth(seed), TREES["r0c0"]) for seed in range(400)])
    assert abs(one.mean() - quantity.typical) < 5 * quantity.spread / math.sqrt(400)
    assert 0.85 < one.std() / quantity.spread < 1.15
    ground = truth(3)
    again = np.array([read_co2(ground, TREES["r0c0"]) for _ in range(50)])
    assert 0 < again.std() < 0.05 * quantity.spread
    assert len({read_co2(truth(3), place) for place in TREES.values()}) == len(TREES)


def test_drawn_values_stay_in_the_believable_range() -> None:
    from dataclasses import replace

    narrow = replace(ROBOT.quantity["co2"], minimum=405.0, maximum=415.0)
    robot = replace(ROBOT, quantities=tuple(narrow if q.name == "co2" else q for q in ROBOT.quantities))
    ground = GroundTruth(World(), SITE, robot, 0)
    values = [read_co2(ground, place) for place in TREES.values()]
    assert min(values) == 405.0
    assert max(values) == 415.0


def test_an_action_fails_as_often_as_told_and_only_where_told() -> None:
    ground = truth(0, ActionFails(action="read_co2", times=2, at=TreeRef(id="r0c0")))
    assert ground.capture("read_co2", TREES["r0c1"])[1] == ""
    assert ground.capture("take_thermal_picture", TREES["r0c0"])[1] == ""
    assert [bool(ground.capture("read_co2", TREES["r0c0"])[1]) for _ in range(4)] == [True, True, False, False]
    always = truth(0, ActionFails(action="read_co2"))
    assert all(always.capture("read_co2", place)[1] for place in TREES.values())


def test_a_sensor_can_be_silent_or_absurd() -> None:
    silent = truth(0, SensorSilent(quantity="co2", times=1))
    assert silent.capture("read_co2", TREES["r0c0"])[0] == {}
    assert "co2" in silent.capture("read_co2", TREES["r0c0"])[0]
    assert read_co2(truth(0, SensorAbsurd(quantity="co2", value=-7.0)), TREES["r0c0"]) == -7.0


@pytest.mark.parametrize(
    ("world", "says"),
    [
        (
            World(readings={"co": Truth(default=1.0)}),
            "readings: the robot husky has no quantity 'co'; did you mean 'co2'",
        ),
        (World(readings={"ph": Truth(default=1.0)}), "its quantities are canopy_temperature, ambient_temperature, co2"),
        (
            World(readings={"co2": Truth(trees=((TreeRef(id="r0c9"), 1.0),))}),
            "co2.trees[0]: grid has no tree 'r0c9'",
        ),
        (
            World(readings={"co2": Truth(trees=((TreeRef(lat=10.0, lon=10.0), 1.0),))}),
            "check that the world file belongs to this site",
        ),
        (World(faults=(ActionFails(action="fly"),)), "faults[0]: the robot husky has no action 'fly'"),
        (World(faults=(SensorSilent(quantity="fly"),)), "faults[0]: the robot husky has no quantity 'fly'"),
        (World(faults=(Blocked(at=TreeRef(id="oak")),)), "faults[0]: grid has no tree 'oak'"),
    ],
)
def test_a_world_of_another_robot_or_site_is_refused(world: World, says: str) -> None:
    with pytest.raises(WorldError) as caught:
        GroundTruth(world, SITE, ROBOT, 0)
    assert says in str(caught.value)


coordinates = st.floats(-10, 10).map(lambda v: round(v, 2))
points = st.tuples(coordinates, coordinates)


@settings(max_examples=60, deadline=None)
@given(st.lists(points, min_size=2, max_size=4).map(tuple), points, st.floats(0.5, 4))
def test_an_obstacle_stops_a_path_where_it_first_comes_too_near(
    path: tuple[tuple[float, float], ...], centre: tuple[float, float], radius: float
) -> None:
    """Against a walk along the path in small steps."""
    step, driven, inside, first = 0.005, 0.0, math.dist(path[0], centre) < radius, None
    margin = abs(math.dist(path[0], centre) - radius)
    for a, b in itertools.pairwise(path):
        length = math.dist(a, b)
        for k in range(int(length / step) + 1):
            p = [a[i] + (b[i] - a[i]) * min(1.0, k * step / max(length, 1e-9)) for i in (0, 1)]
            now = math.dist(p, centre) < radius
            if now and not inside and first is None:
                first = driven + k * step
            inside = now
        driven += length
    found = _enters(path, centre, radius)
    if margin < 0.01:
        return  # on the rim: the walk cannot tell
    if first is not None:
        assert found is not None
        assert found <= first + 1e-6
    if found is not None:
        # The walk may step over a mere touch, which still is too near.
        assert _distance_at(path, found, centre) == pytest.approx(radius, abs=1e-6)


def _distance_at(path: tuple[tuple[float, float], ...], at: float, centre: tuple[float, float]) -> float:
    for a, b in itertools.pairwise(path):
        length = math.dist(a, b)
        if at <= length + 1e-9 and length > 0:
            return math.dist((a[0] + (b[0] - a[0]) * at / length, a[1] + (b[1] - a[1]) * at / length), centre)
        at -= length
    return math.dist(path[-1], centre)


def test_a_robot_at_the_rim_does_not_get_through_and_one_inside_gets_out() -> None:
    assert _enters(((0.0, 0.0), (4.0, 0.0)), (5.0, 0.0), 5.0) == 0.0
    assert _enters(((0.0, 0.0), (-4.0, 0.0)), (5.0, 0.0), 5.0) is None
    assert _enters(((5.0, 0.0), (20.0, 0.0)), (5.0, 0.0), 5.0) is None
    assert _enters(((5.0, 0.0), (20.0, 0.0), (5.0, 0.0)), (5.0, 0.0), 5.0) == pytest.approx(25.0)
