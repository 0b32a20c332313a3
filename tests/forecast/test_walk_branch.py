"""A Task walked through on paper: drives before work, places resolved when reached, branches, exits."""

from itertools import pairwise

import pytest

from fieldhand.errors import PlaceError, TaskError
from fieldhand.forecast import request_handler
from fieldhand.forecast.branches import branches
from fieldhand.forecast.walk_branch import walk_branch
from fieldhand.places.selectors import Bound, Here, Marker, Nearest, NotVisited, TreeIs, Trees, Where
from fieldhand.task.conditions import Level
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, InOrder, Repeat, StopMission, Try
from fieldhand.testing.small_orchard import block, husky, orchard, task_for

SITE = orchard()
ROBOT = husky()
LOW = Level(reading="r", quantity="canopy_temperature", level="low")


def picture(at=None, **more):
    return Act(id="", action="take_thermal_picture", at=at, **more)


def tree(name):
    return TreeIs(tree=name)


def walked(plan, *, holds=lambda _: True, fails=lambda _: False, **more):
    return walk_branch(task_for(SITE, plan, **more), SITE, ROBOT, holds=holds, fails=fails)


def places(walk_, kind="act"):
    return [s.places[0].id for s in walk_.steps if s.kind == kind]


def test_every_drive_begins_where_the_last_one_ended_and_the_last_ends_at_home():
    plan = InOrder(id="", steps=(picture(tree("7")), ForEach(id="", select=Trees(), body=picture(), at_most=5)))
    found = walked(plan)
    drives = [s.drive for s in found.steps if s.drive is not None]
    assert drives[0].points[0] == SITE.start.xy
    assert all(a.points[-1] == b.points[0] for a, b in pairwise(drives))
    assert found.end == SITE.markers["end"]
    assert (found.exit, found.steps[-1].kind) == ("nominal", "exit")
    assert sum(found.legs_m) == pytest.approx(sum(d.length_m for d in drives))


def test_work_without_a_place_is_done_at_the_place_in_hand_and_costs_no_drive():
    found = walked(InOrder(id="", steps=(picture(tree("7")), picture(count=2), picture(tree("7")))))
    assert places(found) == ["7", "7", "7"]
    assert places(found, "drive") == ["7"]
    assert [s.captures for s in found.steps if s.kind == "act"] == [1, 2, 1]


def test_relative_places_resolve_when_they_are_reached():
    plan = InOrder(
        id="",
        steps=(
            picture(tree("1"), label="a"),
            picture(Nearest(to=Here(), fresh=True)),
            picture(Nearest(to=Here(), of=NotVisited())),
            picture(Bound(label="a")),
        ),
    )
    found = places(walked(plan))
    assert found[0] == found[3] == "1"
    assert len(set(found[:3])) == 3


def test_a_for_each_resolves_once_binds_each_place_and_afterwards_all_of_them():
    yellow = Where(attribute="leaf_color", test="eq", value="yellow")
    body = InOrder(id="", steps=(GoTo(id="", place=Bound(label="x")), picture()))
    again = ForEach(id="", select=Bound(label="x"), body=picture(), order="given")
    found = walked(InOrder(id="", steps=(ForEach(id="", select=yellow, body=body, label="x"), again)))
    acts = places(found)
    assert len(acts) == 2 * 7
    assert acts[:7] == acts[7:]
    assert sorted(acts[:7], key=int) == ["1", "4", "7", "10", "13", "16", "19"]


def test_a_loop_stops_once_its_until_holds_and_a_repeat_after_its_rounds():
    until = ForEach(id="", select=Trees(), body=picture(reading="r"), until=LOW)
    assert len(places(walked(until, holds=lambda _: True))) == 1
    assert len(places(walked(until, holds=lambda _: False))) == 20
    repeat = Repeat(id="", times=3, body=picture(tree("1"), reading="r"), until=LOW)
    assert len(places(walked(repeat, holds=lambda _: False))) == 3
    assert len(places(walked(repeat, holds=lambda _: True))) == 1


def test_a_try_goes_on_with_its_otherwise_only_where_the_body_fails():
    plan = InOrder(id="", steps=(Try(id="", body=picture(tree("1")), otherwise=picture(tree("2"))), picture(tree("3"))))
    assert places(walked(plan)) == ["1", "3"]
    assert places(walked(plan, fails=lambda _: True)) == ["1", "2", "3"]


def test_a_stop_ends_the_walk_with_its_exit():
    plan = InOrder(id="", steps=(picture(tree("1")), StopMission(id="", exit="faulted"), picture(tree("2"))))
    found = walked(plan)
    assert places(found) == ["1"]
    assert (found.exit, found.steps[-1].kind, found.steps[-1].node.id) == ("faulted", "exit", "n3")
    # What every mission does after a fault is to return to its start.
    assert found.end == SITE.start


def test_staying_drives_nowhere_at_the_end():
    found = walked(picture(tree("1")), nominal="stay")
    assert found.end.id == "1"
    assert found.steps[-1].drive is None


@pytest.mark.parametrize("plan", [picture(tree("99")), picture(Trees()), GoTo(id="", place=Bound(label="nobody"))])
def test_a_place_that_is_nowhere_or_many_names_the_node(plan):
    with pytest.raises(PlaceError, match="n2"):
        walked(InOrder(id="", steps=(plan, picture())))


def test_steps_in_any_order_are_done_in_the_shortest_one():
    found = walked(AnyOrder(id="", steps=(picture(tree("20")), picture(tree("1")), picture(tree("3")))))
    assert places(found) == ["1", "3", "20"]


def test_optional_visits_are_those_that_the_budget_allows_with_what_must_follow_set_aside():
    many = ForEach(id="", select=Trees(), body=picture(), optional=True)
    plenty = walked(many)
    assert len(places(plenty)) == 20
    tight = Constraints(budgets=(Budget(kind="distance_m", limit=60.0),))
    found = walked(many, constraints=tight)
    listed = next(s for s in found.steps if s.kind == "visit-list")
    assert 3 <= len(listed.places) < 20
    assert {p.id for p in (*listed.places, *listed.shed)} == {t.place.id for t in SITE.trees}
    assert sum(found.legs_m) <= 60.0
    followed = walked(InOrder(id="", steps=(many, picture(Marker(name="start")))), constraints=tight)
    assert len(places(followed)) - 1 < len(places(found))
    assert places(followed)[-1] == "start"
    assert sum(followed.legs_m) <= 60.0


def test_a_walk_goes_around_a_keep_out():
    pond = block("keep_out", "pond", (0.5, 0.5), (1.5, 3.5))
    site = orchard(zones=[pond])
    task = task_for(site, InOrder(id="", steps=(picture(tree("2")), picture(tree("12")))))
    dry, wet = (walk_branch(task, s, ROBOT, holds=lambda _: True) for s in (SITE, site))
    assert sum(wet.legs_m) > sum(dry.legs_m)


def test_branches_of_conditions_are_all_found_each_once():
    high = Level(reading="s", quantity="canopy_temperature", level="high")
    again = picture(reading="s")
    inner = InOrder(
        id="", steps=(again, If(id="", condition=high, then=picture(tree("2")), otherwise=picture(tree("3"))))
    )
    plan = InOrder(id="", steps=(picture(tree("1"), reading="r"), If(id="", condition=LOW, then=inner)))
    found = branches(task_for(SITE, plan), SITE, ROBOT)
    assert found.complete
    assert sorted(places(w)[1:] for w in found.walks) == [[], ["1", "2"], ["1", "3"]]
    assert places(found.walks[0]) == ["1", "1", "2"]


def test_a_condition_at_each_of_some_trees_has_every_combination():
    body = InOrder(id="", steps=(picture(reading="r"), If(id="", condition=LOW, then=picture())))
    task = task_for(SITE, ForEach(id="", select=Trees(), body=body, at_most=4))
    found = branches(task, SITE, ROBOT)
    assert found.complete
    assert len({w.decisions for w in found.walks}) == len(found.walks) == 2**4


def test_more_branches_than_can_be_looked_at_are_reported_with_the_extremes_among_them():
    body = InOrder(id="", steps=(picture(reading="r"), If(id="", condition=LOW, then=picture())))
    found = branches(task_for(SITE, ForEach(id="", select=Trees(), body=body)), SITE, ROBOT, limit=20)
    assert found.coverage == "bounded"
    counts = [len(places(w)) for w in found.walks]
    assert (max(counts), min(counts)) == (40, 20)


def test_a_failing_action_inside_a_try_is_a_branch():
    found = branches(task_for(SITE, Try(id="", body=picture(tree("1")), otherwise=picture(tree("2")))), SITE, ROBOT)
    # It may fail at the tree, and on the way there.
    assert sorted(places(w) for w in found.walks) == [["1"], ["1", "2"], ["2"]]


@pytest.mark.parametrize("body", [picture(), GoTo(id="", place=Here())], ids=["with captures", "without any step"])
def test_a_walk_without_end_in_sight_is_refused_with_its_node(body, monkeypatch):
    monkeypatch.setattr(request_handler, "MAX_NODES", 5_000)  # the limit itself takes many seconds to reach
    plan = Repeat(id="", times=1000, body=Repeat(id="", times=1000, body=body))
    with pytest.raises(TaskError, match="the plan has more than 5,000 steps") as caught:
        walked(plan)
    assert caught.value.where in ("n2", "n3")
    assert caught.value.advice


def test_long_walks_are_not_walked_again_and_again(monkeypatch):
    monkeypatch.setattr("fieldhand.forecast.branches.MAX_STEPS", 2_000)  # a twentieth of the limits that hold
    monkeypatch.setattr("fieldhand.forecast.branches.MAX_STEPS_ALIKE", 10_000)
    long = Repeat(id="", times=10, body=Repeat(id="", times=300, body=picture()))
    assert branches(task_for(SITE, long), SITE, ROBOT).complete
    look = picture(reading="r")
    choices = [look, If(id="", condition=LOW, then=picture(at=tree("2")), otherwise=picture(count=2))] * 4
    found = branches(task_for(SITE, InOrder(id="", steps=(long, *choices))), SITE, ROBOT)
    assert len(found.walks) == 4
    assert not found.complete
