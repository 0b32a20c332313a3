"""What a mission keeps away from: no drive passes it, nothing else changes, what it makes impossible is reported."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString

import fieldhand as fh
from fieldhand.approval.checks import examine
from fieldhand.errors import DriveFault
from fieldhand.execution.drivers.simulation.world import Blocked, TreeRef, World
from fieldhand.forecast.closed_ground import avoided
from fieldhand.forecast.visit_order import drives_for
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import Here, InBlock, InZone, Marker, Nearest, Rows, TreeIs, Trees, UnionOf
from fieldhand.robot.loader import load_robot
from fieldhand.site.closed_ground import along_trees
from fieldhand.site.loader import parse_site
from fieldhand.site.model import Site
from fieldhand.task.codec import decode, encode
from fieldhand.task.frames import Constraints, Task
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Driving, Ended
from fieldhand.task.ways import Avoid
from fieldhand.testing.generated.orchards import orchard_sites, seeds
from missions.test_ways import planted, random_plan
from support.examples import examples
from support.missions.rig import Rig, husky, of_type, task_for

ROBOT = load_robot("husky")
DEMO = fh.Site.demo()
SLOW = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow, HealthCheck.filter_too_much]}


def row(name: str, **of: Any) -> Rows:
    return Rows(first=name, last=name, **of)


def pictures(
    select: Selector, *avoid: Avoid, only_gates: tuple[str, ...] = (), site: Site = DEMO, **given: Any
) -> Task:
    body = Act(action="take_thermal_picture")
    plan = ForEach(select=select, body=body, **given)
    return fh.build_task(plan, site, ROBOT, avoid=avoid, only_gates=only_gates)


def errors(task: Task, site: Site = DEMO) -> list[str]:
    return [problem.line() for problem in examine(task, site, ROBOT).errors]


def random_avoidance(rng: np.random.Generator, site: Site) -> Avoid:
    """Return places of any kind, with a distance or without one."""
    planting = site.planting
    tree = site.trees[int(rng.integers(len(site.trees)))].place.id
    kinds: list[Selector] = [TreeIs(tree=tree), UnionOf(parts=(TreeIs(tree=tree), TreeIs(tree=site.trees[0].place.id)))]
    if planting.rows:
        one = planting.rows[int(rng.integers(len(planting.rows)))]
        block = planting.blocks[one.block]
        kinds += [row(one.name, of=InBlock(block=block.name)), row(one.name, of=InBlock(block=block.name))]
        kinds.append(InBlock(block=block.name))
    kinds += [InZone(zone=zone.name) for zone in site.zones if zone.kind != "boundary" and zone.name]
    places = kinds[int(rng.integers(len(kinds)))]
    return Avoid(places=places, distance_m=float(rng.choice([0.0, 0.0, rng.uniform(0.5, 15.0)])))


def nearest_m(avoid: Avoid, site: Site, path: Any) -> float:
    """Return how near a path comes to the places of an avoidance, measured without its ground."""
    line = LineString(path)
    if isinstance(avoid.places, InZone):
        return min(line.distance(zone.polygon) for zone in site.zones if zone.name == avoid.places.zone)
    trees = [site.by_id[p.id].index for p in fh_places(avoid.places, site)]
    return line.distance(along_trees(site, trees))


def fh_places(selector: Selector, site: Site) -> Any:
    return resolve(selector, site, Context(here=site.start))


@settings(max_examples=examples(15, thorough=60), **SLOW)
@given(seed=st.integers(0, 2**32 - 1))
def test_no_drive_of_a_mission_passes_what_it_avoids_or_comes_nearer_than_the_distance(seed: int) -> None:
    site = planted(seed).site
    rng = np.random.default_rng(seed + 2)
    avoid = tuple(random_avoidance(rng, site) for _ in range(int(rng.integers(1, 3))))
    faults = ()
    if rng.random() < 0.3:
        tree = site.trees[int(rng.integers(len(site.trees)))].place.id
        faults = (Blocked(at=TreeRef(id=tree), within_m=2.0, times=1),)
    robot = husky(alpha=0.5)
    constraints = Constraints(avoid=avoid)
    assume(not drives_for(site, robot, constraints).problem(site.start))
    rig = Rig(site=site, robot=robot, world=World(faults=faults), seed=seed)
    events = rig.fly(task_for(random_plan(rng, site), constraints=constraints)).events
    assert of_type(events, Ended)
    whole = drives_for(site, robot)
    for event in of_type(events, Driving):
        degrees = np.asarray(event.path)
        path = site.projection.metres(degrees[:, 0], degrees[:, 1])
        for one in avoid:
            ground = avoided(one, whole)
            assert not LineString(path).intersects(ground.shape.buffer(-0.01)), (event, one)
            if one.distance_m:
                assert nearest_m(one, site, path) >= one.distance_m - 0.01


@settings(max_examples=examples(25, thorough=100), **SLOW)
@given(site=orchard_sites(), seed=seeds)
def test_an_avoidance_never_shortens_a_way(site: Site, seed: int) -> None:
    rng = np.random.default_rng(seed)
    constraints = Constraints(avoid=(random_avoidance(rng, site),))
    whole, closed = drives_for(site, ROBOT), drives_for(site, ROBOT, constraints)
    trees = [tree.place for tree in site.trees]
    some = [trees[k] for k in rng.choice(len(trees), size=min(8, len(trees)), replace=False).tolist()]
    some = [p for p, why in zip(some, closed.problems(some), strict=True) if not why]
    assert not any(whole.problems(some))
    for a, b in pairwise(some):
        try:
            way = closed.between(a, b)
        except DriveFault:
            continue  # both can be reached, but only from elsewhere
        free = whole.between(replace(a, stand=way.start.stand), replace(b, stand=way.end.stand))
        # In a margin, where a robot may stand but not drive, a way out may differ by a few centimetres.
        assert way.length_m >= free.length_m - 0.05


@settings(max_examples=examples(15, thorough=60), **SLOW)
@given(site=orchard_sites(), seed=seeds)
def test_what_cannot_be_reached_is_an_error_that_says_so_and_nothing_else_is(site: Site, seed: int) -> None:
    rng = np.random.default_rng(seed)
    avoid = random_avoidance(rng, site)
    task = pictures(Trees(), avoid, site=site)
    whole, closed = drives_for(site, ROBOT), drives_for(site, ROBOT, task.constraints)
    places = [tree.place for tree in site.trees]
    assume(not any(whole.problems([*places, site.start, site.home("return_to_end", site.start)])))
    found = errors(task, site)
    impossible = [
        *closed.problems(places),
        closed.problem(site.start),
        closed.problem(site.home("return_to_end", site.start)),
    ]
    assert bool(found) == any(impossible)
    assert all("where the robot must not drive" in line or "the robot must" in line for line in found)


def test_trees_of_an_avoided_row_are_named_and_the_rows_beside_it_are_worked_on_from_the_other_side():
    (line,) = errors(pictures(row("5"), Avoid(places=row("5"))))
    assert "in row 5, where the robot must not drive" in line
    for beside in ("4", "6"):
        task = pictures(row(beside), Avoid(places=row("5")))
        assert not errors(task)


def test_a_tree_that_two_avoidances_close_together_is_reported_with_both():
    (line,) = errors(pictures(row("4"), Avoid(places=row("3")), Avoid(places=row("5"))))
    assert "the robot must keep out of row 3 and keep out of row 5" in line


def test_optional_places_are_left_out_with_the_reason():
    task = pictures(UnionOf(parts=(row("4"), row("5"))), Avoid(places=row("5")), optional=True)
    found = examine(task, DEMO, ROBOT)
    assert not found.errors
    (warning,) = [p.line() for p in found.problems if "left out" in p.line()]
    assert "in row 5, where the robot must not drive" in warning


def test_a_start_or_an_end_inside_an_avoided_area_is_an_error():
    (line,) = errors(pictures(row("4"), Avoid(places=InZone(zone="pond"), distance_m=200)))
    assert "the start marker, where the robot begins, is within 200 m of the zone" in line
    assert any(
        "the end marker is in the zone" in line
        for line in errors(pictures(row("7"), Avoid(places=InZone(zone="wet corner"))))
    )


def test_an_avoidance_without_extent_or_that_depends_on_the_robot_is_an_error():
    (line,) = errors(pictures(row("4"), Avoid(places=Marker(name="end"))))
    assert "how far to keep from the end marker" in line
    (line,) = errors(pictures(row("4"), Avoid(places=row("77"))))
    assert "there is no row '77'" in line
    (line,) = errors(pictures(row("4"), Avoid(places=Nearest(to=Here(), fresh=True))))
    assert "depends on where the robot is" in line


def test_without_avoidance_the_drives_are_the_same_object_and_the_xml_has_no_new_element():
    task = pictures(row("4"))
    assert drives_for(DEMO, ROBOT, task.constraints) is drives_for(DEMO, ROBOT)
    assert b"avoid" not in encode(task)
    assert repr(Constraints()) == "Constraints(budgets=(), reserve_percent=None, reserve_said=(), speed_m_s=None)"


def test_an_avoidance_is_part_of_the_id_of_a_task_and_of_its_document():
    plain, careful = pictures(row("4")), pictures(row("4"), Avoid(places=InZone(zone="pond"), distance_m=2))
    assert plain.id != careful.id
    assert decode(encode(careful)) == careful


def test_approval_forecast_guard_and_robot_drive_the_same_detour():
    careful = pictures(row("4"), Avoid(places=InZone(zone="pond"), distance_m=4))
    review = fh.review(careful, DEMO, ROBOT)
    run = fh.simulate(fh.authorize(review, by="Ada"), seed=3)
    shown = [step.drive.points for step in review.estimate.worst.walk.steps if step.drive is not None]
    driven = [event.path for event in of_type(run.result.events, Driving)]
    assert [len(path) for path in driven] == [len(points) for points in shown]
    zone = next(zone.polygon for zone in DEMO.zones if zone.name == "pond")
    for path in driven:
        metres = DEMO.projection.metres(*np.asarray(path).T)
        assert LineString(metres).distance(zone) >= 4 + ROBOT.width_m / 2 - 0.01


def fenced() -> Site:
    """Return two rows in a fence with two gates, and the start outside."""

    def degrees(x: float, y: float) -> list[float]:
        return [-120.0 + x / 88_900.0, 37.0 + y / 111_000.0]

    def feature(kind: str, shape: str, coordinates: Any, **more: Any) -> dict[str, Any]:
        return {
            "type": "Feature",
            "geometry": {"type": shape, "coordinates": coordinates},
            "properties": {"kind": kind, **more},
        }

    ring = [degrees(*at) for at in ((-10, -10), (30, -10), (30, 40), (-10, 40), (-10, -10))]
    features = [
        feature("tree", "Point", degrees(x, y), id=f"{x}-{y}", row=str(x)) for x in (0, 10, 20) for y in range(0, 31, 5)
    ]
    features += [
        feature("fence", "LineString", ring),
        feature("gate", "Point", degrees(10, -10), name="south gate", width_m=3),
        feature("gate", "Point", degrees(10, 40), name="north gate", width_m=3),
        feature("start", "Point", degrees(10, -20)),
    ]
    return parse_site(json.dumps({"type": "FeatureCollection", "features": features}).encode(), name="fenced")


def test_only_the_named_gate_is_passed():
    site = fenced()
    north, south = (next(g.place.xy for g in site.gates if g.place.id == name) for name in ("north gate", "south gate"))
    for allowed, passed, other in (("north gate", north, south), ("south gate", south, north)):
        task = pictures(row("10"), only_gates=(allowed,), site=site)
        review = fh.review(task, site, ROBOT)
        assert not review.errors
        lines = [LineString(s.drive.points) for s in review.estimate.worst.walk.steps if s.drive is not None]
        assert min(line.distance(shapely.Point(passed)) for line in lines) < 1.5
        assert all(line.distance(shapely.Point(other)) > 1.5 for line in lines)


def test_a_gate_that_the_site_lacks_is_an_error_with_those_that_it_has():
    (line,) = errors(pictures(row("10"), only_gates=("east gate",), site=fenced()), fenced())
    assert "the site has no such gate" in line
    assert "south gate" in line


def test_both_gates_closed_is_reported_as_the_reason():
    site = fenced()
    task = pictures(
        row("10"), Avoid(places=UnionOf(parts=(TreeIs(tree="10-0"), TreeIs(tree="10-30"))), distance_m=11), site=site
    )
    found = errors(task, site)
    assert found
    assert all("the robot must" in line for line in found)
