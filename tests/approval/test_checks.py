"""What forbids approval, what only warns, and that nothing else does."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from shapely.geometry import Point, box

from fieldhand.approval.branch_checks import driven_through
from fieldhand.approval.checks import check, examine
from fieldhand.forecast.visit_order import drives_for
from fieldhand.forecast.walk_branch import walk_branch as walk_through
from fieldhand.places.selectors import Bound, Corners, InZone, Marker, NotVisited, Take, TreeIs, Trees, Where
from fieldhand.site.drives import Drive
from fieldhand.site.model import Zone
from fieldhand.task.codec import encode
from fieldhand.task.conditions import Compare
from fieldhand.task.frames import Budget, Constraints, Resource
from fieldhand.task.plan import Act, ForEach, GoTo, If, InOrder
from fieldhand.testing.small_orchard import block, husky, orchard, task_for

SITE, ROBOT = orchard(), husky()
PICTURE = Act(id="", action="take_thermal_picture")


def at(selector, **more):
    return replace(PICTURE, at=selector, **more)


def problems(plan, site=SITE, **more):
    return check(task_for(site, plan, **more), site, ROBOT)


def errors(plan, site=SITE, **more):
    return [p for p in problems(plan, site, **more) if p.severity == "error"]


def test_a_sound_task_has_no_problem_and_an_estimate():
    found = examine(task_for(SITE, ForEach(id="", select=Corners(), body=PICTURE)), SITE, ROBOT)
    assert found.problems == ()
    assert found.estimate is not None


def test_an_action_that_the_robot_lacks_is_named_with_what_it_can_do():
    found = errors(Act(id="", action="pick_fruit", at=TreeIs(tree="1")))
    assert found
    assert all("pick_fruit" in str(error) and "take_thermal_picture" in str(error) for error in found)


def test_the_given_document_is_checked_and_not_the_one_that_would_be_written():
    task = task_for(SITE, at(TreeIs(tree="1")))
    document = encode(task).replace(b"take_thermal_picture", b"take_a_nap")
    found = check(task, SITE, ROBOT, document=document)
    assert any("take_a_nap" in p.what and p.where.startswith("line ") for p in found)
    assert check(task, SITE, ROBOT, document=b"<task") != ()


def test_a_reading_that_is_tested_before_it_is_taken_is_an_error_at_its_node():
    low = Compare(reading="r", quantity="co2", test="lt", value=400.0, unit="ppm")
    (error,) = errors(InOrder(id="", steps=(at(TreeIs(tree="1")), If(id="", condition=low, then=PICTURE))))
    assert error.node == "n3"
    assert "'r'" in error.what


def test_a_place_that_nothing_binds_is_an_error():
    (error,) = errors(at(Bound(label="nowhere")))
    assert "nowhere" in error.what


@pytest.mark.parametrize("kind", ["site", "robot"])
def test_a_task_for_another_site_or_robot_is_refused(kind):
    task = task_for(SITE, at(TreeIs(tree="1")))
    changed = tuple(replace(r, sha256="0" * 64) if r.kind == kind else r for r in task.resources)
    (error,) = check(replace(task, resources=changed), SITE, ROBOT)
    assert error.severity == "error"
    assert "another version" in error.what
    other = tuple(Resource(kind=kind, name="x", sha256="1" * 64) if r.kind == kind else r for r in task.resources)
    assert "planned for x" in check(replace(task, resources=other), SITE, ROBOT)[0].what


def test_a_task_that_names_no_resources_is_a_warning():
    found = check(replace(task_for(SITE, at(TreeIs(tree="1"))), resources=()), SITE, ROBOT)
    assert [p.severity for p in found] == ["warning", "warning"]


def test_every_empty_selection_is_named_at_once():
    plan = InOrder(
        id="",
        steps=(
            at(TreeIs(tree="99")),
            ForEach(id="", select=InZone(zone="moon"), body=PICTURE),
            ForEach(id="", select=Where(attribute="leaf_color", test="eq", value="blue"), body=PICTURE),
            at(Marker(name="charger")),
        ),
    )
    found = errors(plan)
    assert [p.node for p in found] == ["n2", "n3", "n5", "n7"]
    assert all(p.advice for p in found)
    assert all("\n" not in str(p) for p in found)


def test_several_trees_where_one_is_needed_are_an_error():
    (error,) = errors(at(Corners()))
    assert error.node == "n1"


def test_a_relative_place_that_finds_nothing_on_one_branch_is_an_error():
    site = orchard(rows=1, columns=2)
    steps = (at(TreeIs(tree="1")), at(TreeIs(tree="2")))
    (error,) = errors(InOrder(id="", steps=(*steps, at(Take(count=1, of=NotVisited())))), site)
    assert "n4" in str(error)


def test_a_tree_inside_a_keep_out_is_an_error():
    site = orchard(zones=[block("keep_out", "pond", (0.5, 0.5), (1.5, 1.5))])
    assert [p.node for p in errors(at(TreeIs(tree="7")), site)] == ["n1"]
    assert "pond" in str(errors(at(TreeIs(tree="7")), site)[0])
    assert errors(at(TreeIs(tree="9")), site) == []


def test_a_drive_that_crosses_a_zone_or_a_tree_line_is_found_from_the_site_alone():
    plan = InOrder(id="", steps=(GoTo(id="", place=TreeIs(tree="1")), GoTo(id="", place=TreeIs(tree="20"))))
    driven = walk_through(task_for(SITE, plan), SITE, ROBOT, holds=lambda node: True)
    assert driven_through(driven.steps, SITE) == ()
    (leg,) = (s.drive for s in driven.steps if s.node.id == "n3")
    x, y = leg.at(leg.length_m / 2)
    pond = Zone(name="pond", kind="keep_out", polygon=Point(x, y).buffer(1.0))
    fence = Zone(name="fence", kind="boundary", polygon=box(-100, -100, 100, 100).difference(Point(x, y).buffer(2.0)))
    assert driven_through(driven.steps, replace(SITE, zones=(pond, fence))) == (
        ("n3", "through the keep-out “pond”"),
        ("n3", "outside the boundary"),
    )
    ends = [(float(x), float(y)) for x, y in SITE.xy[[0, -1]]]
    straight = Drive(tuple(ends), 1.0, SITE.start, SITE.start)
    steps = tuple(replace(s, drive=straight) if s.node.id == "n3" else s for s in driven.steps)
    crossed = driven_through(steps, SITE)
    assert {what for _, what in crossed} == {f"through the trees of row {r.name}" for r in SITE.planting.rows}


def test_a_mission_around_a_keep_out_is_sound():
    plan = InOrder(id="", steps=(GoTo(id="", place=TreeIs(tree="1")), GoTo(id="", place=TreeIs(tree="20"))))
    around = orchard(zones=[block("keep_out", "pond", (1.3, 1.3), (1.7, 1.7))])
    assert check(task_for(around, plan), around, ROBOT) == ()


@pytest.mark.parametrize(("limit", "severity"), [(10.0, "error"), (500.0, None)])
def test_a_budget_that_cannot_last_is_an_error_with_the_numbers(limit, severity):
    constraints = Constraints(budgets=(Budget(kind="distance_m", limit=limit),))
    found = problems(ForEach(id="", select=Corners(), body=PICTURE), constraints=constraints)
    assert [p.severity for p in found] == ([severity] if severity else [])
    assert all("10 m" in p.what for p in found)


def test_a_budget_above_the_mean_says_what_it_takes_in_bad_missions():
    start, end, tree = SITE.start, SITE.markers["end"], SITE.by_id["20"].place
    drives = drives_for(SITE, ROBOT)
    there = drives.between(start, tree)
    metres = there.length_m + drives.between(there.end, end).length_m
    constraints = Constraints(budgets=(Budget(kind="distance_m", limit=1.1 * metres, failure_probability=0.02),))
    plan = ForEach(id="", select=TreeIs(tree="20"), body=PICTURE, optional=True)
    (error,) = errors(plan, constraints=constraints)
    mean, high, chance = map(int, re.search(r"about (\d+) m .* more than (\d+) m in (\d+) of 100", error.what).groups())
    assert mean < 1.1 * metres < high, "the figures say why it does not last"
    assert chance == 2


def test_a_budget_in_which_no_optional_visit_fits_is_an_error_with_the_numbers():
    constraints = Constraints(budgets=(Budget(kind="distance_m", limit=24.0),))
    plan = ForEach(id="", select=TreeIs(tree="20"), body=PICTURE, optional=True)
    (error,) = errors(plan, constraints=constraints)
    assert "24 m is too small for a single visit" in error.what
    metres = int(re.search(r"about (\d+) m, including the way home", error.what)[1])
    start, end, tree = SITE.start, SITE.markers["end"], SITE.by_id["20"].place
    drives = drives_for(SITE, ROBOT)
    there = drives.between(start, tree)
    assert metres == pytest.approx(there.length_m + drives.between(there.end, end).length_m, abs=12)


def test_as_many_as_you_can_is_no_problem_when_only_some_fit():
    constraints = Constraints(budgets=(Budget(kind="distance_m", limit=60.0),))
    assert problems(ForEach(id="", select=Trees(), body=PICTURE, optional=True), constraints=constraints) == ()


def test_errors_stand_before_warnings():
    task = replace(task_for(SITE, at(TreeIs(tree="99"))), resources=())
    assert [p.severity for p in check(task, SITE, ROBOT)] == ["error", "warning", "warning"]
