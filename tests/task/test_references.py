"""The parts of a Task refer to each other rightly, or the problem is named with its node."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand.places.selectors import Bound, Corners, First, Here, Nearest, Trees
from fieldhand.task.build import make_task
from fieldhand.task.conditions import AllOf, Between, Compare, Level, Not
from fieldhand.task.frames import Goal, Variable
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, InOrder, OptionalStep, Repeat, StopMission, Try
from fieldhand.task.references import references
from fieldhand.testing.generated.tasks import ROVER

MEASURES = {"probe_soil": (("soil_moisture", "percent"), ("soil_ph", "pH")), "read_co2": (("co2", "ppm"),)}


def task_of(*steps, any_order=False):
    kind = AnyOrder if any_order else InOrder
    return make_task(request="go", plan=kind(id="", steps=steps), measures=MEASURES)


def probe(reading="", **more):
    return Act(id="", action="probe_soil", reading=reading, **more)


def dry(reading="r"):
    return Compare(reading=reading, quantity="soil_moisture", test="lt", value=10, unit="percent")


def when(condition, then=None, otherwise=None):
    return If(id="", condition=condition, then=then or StopMission(id=""), otherwise=otherwise)


SOUND = {
    "read, then test": task_of(probe("r"), when(dry())),
    "read in a branch, test after it": task_of(probe("a"), when(dry("a"), probe("r")), when(dry())),
    "read in a loop, test for its end": task_of(
        ForEach(id="", select=Trees(), body=probe("r"), until=AllOf(conditions=(dry(), Not(condition=dry()))))
    ),
    "read at an attempt, test in its fallback": task_of(Try(id="", body=probe("r"), otherwise=when(dry()))),
    "bind a place, name it": task_of(GoTo(id="", place=First(), label="p"), GoTo(id="", place=Bound(label="p"))),
    "name the place of a loop inside it": task_of(
        ForEach(id="", select=Corners(), label="c", body=probe(at=Nearest(to=Bound(label="c"))))
    ),
    "read and test in an optional step": task_of(
        OptionalStep(id="", body=InOrder(id="", steps=(probe("r"), when(dry()))))
    ),
    "read before an optional step, test after it": task_of(
        probe("r"), OptionalStep(id="", body=probe("r")), when(dry()), OptionalStep(id="", body=when(dry()))
    ),
    "an optional step at each place": task_of(ForEach(id="", select=Trees(), body=OptionalStep(id="", body=probe()))),
    "an action binds its place": task_of(probe(at=First(), label="p"), GoTo(id="", place=Nearest(to=Bound(label="p")))),
}


@pytest.mark.parametrize("task", SOUND.values(), ids=SOUND.keys())
def test_what_is_bound_before_it_is_named_is_right(task):
    assert references(task, ROVER) == ()


UNSOUND = {
    "never read": (task_of(when(dry())), "node 'n2' tests the reading 'r', which nothing before it takes"),
    "read too late": (task_of(when(dry()), probe("r")), "node 'n2' tests the reading 'r'"),
    "read in the branch that it decides": (task_of(when(dry(), probe("r"))), "node 'n2' tests the reading 'r'"),
    "read in the other branch": (
        task_of(probe("a"), when(dry("a"), probe("r"), when(dry()))),
        "node 'n5' tests the reading 'r'",
    ),
    "read by a step that may come later": (task_of(probe("r"), when(dry()), any_order=True), "tests the reading 'r'"),
    "read later in the loop": (
        task_of(Repeat(id="", times=2, body=InOrder(id="", steps=(when(dry()), probe("r"))))),
        "tests the reading 'r'",
    ),
    "read by a step that may be shed": (
        task_of(OptionalStep(id="", body=probe("r")), when(dry())),
        "node 'n4' tests the reading 'r', which only an optional step takes: test it inside that",
    ),
    "bound by a step that may be shed": (
        task_of(OptionalStep(id="", body=GoTo(id="", place=First(), label="p")), GoTo(id="", place=Bound(label="p"))),
        "node 'n4' names the place 'p', which only an optional step binds: name it inside that",
    ),
    "place never bound": (
        task_of(GoTo(id="", place=Nearest(to=Bound(label="p")))),
        "node 'n2' names the place 'p', which nothing before it binds",
    ),
    "place bound by itself": (task_of(GoTo(id="", place=Bound(label="p"), label="p")), "names the place 'p'"),
}


@pytest.mark.parametrize(("task", "expected"), UNSOUND.values(), ids=UNSOUND.keys())
def test_what_is_named_before_it_is_bound_is_a_problem(task, expected):
    problems = references(task)
    assert len(problems) == 1
    assert expected in problems[0]


@pytest.mark.parametrize(
    "condition",
    [
        Compare(reading="r", quantity="co2", test="lt", value=400, unit="ppm"),
        Between(reading="r", quantity="co2", low=1, high=2, unit="ppm"),
        Level(reading="r", quantity="co2", level="low"),
    ],
)
def test_a_reading_is_tested_for_what_its_action_measures(condition):
    task = task_of(probe("r"), when(Not(condition=condition)))
    assert references(task) == ()
    assert references(task, ROVER) == (
        "node 'n3' tests the co2 of the reading 'r', but probe_soil does not measure it",
    )


def test_a_reading_taken_anew_replaces_the_one_before():
    co2 = Act(id="", action="read_co2", reading="r")
    assert references(task_of(co2, probe("r"), when(dry())), ROVER) == ()
    assert len(references(task_of(probe("r"), co2, when(dry())), ROVER)) == 1


@pytest.mark.parametrize(("low", "high", "wrong"), [(5, 1, True), (1, 5, False), (3, 3, False)])
def test_the_low_end_of_a_range_comes_first(low, high, wrong):
    between = Between(reading="r", quantity="soil_moisture", low=low, high=high, unit="percent")
    problems = references(task_of(probe("r"), when(Not(condition=between))), ROVER)
    expected = (
        "node 'n3' tests whether the soil_moisture is between 5 and 1, which is impossible: give the low end first"
    )
    assert problems == ((expected,) if wrong else ())


@pytest.mark.parametrize(("times", "wrong"), [(100, False), (101, True)])
def test_nested_repeats_do_not_multiply_without_end(times, wrong):
    plan = Repeat(id="", times=10, body=Repeat(id="", times=times, body=Repeat(id="", times=100, body=probe())))
    expected = "node 'n4' can run 101,000 rounds, including the loops around it; 100,000 is the most"
    assert references(task_of(plan)) == ((expected,) if wrong else ())


@pytest.mark.parametrize(
    ("inner", "outer"),
    [
        (OptionalStep(id="", body=probe()), lambda body: OptionalStep(id="", body=Repeat(id="", times=2, body=body))),
        (OptionalStep(id="", body=probe()), lambda body: ForEach(id="", select=Trees(), optional=True, body=body)),
        (ForEach(id="", select=Trees(), optional=True, body=probe()), lambda body: OptionalStep(id="", body=body)),
    ],
)
def test_nothing_optional_stands_inside_an_optional_step_nor_it_inside_optional_visits(inner, outer):
    (problem,) = references(task_of(outer(inner)))
    assert "is optional inside 'n2', which is itself optional" in problem


@pytest.mark.parametrize(("order", "optional", "wrong"), [("given", True, 1), ("best", True, 0), ("given", False, 0)])
def test_optional_visits_are_made_in_no_given_order(order, optional, wrong):
    found = references(task_of(ForEach(id="", select=Trees(), body=probe(), order=order, optional=optional)))
    assert len(found) == wrong
    assert all("given order" in problem for problem in found)


def test_ids_stand_once():
    task = task_of(probe(), probe())
    plan = InOrder(id="n1", steps=(probe(at=Here()), StopMission(id="n1"), StopMission(id="")))
    problems = references(replace(task, composition=replace(task.composition, plan=plan)))
    assert "2 nodes of the plan have the id 'n1'" in problems
    assert "2 nodes of the plan have no id" in problems


def test_goals_and_state_variables_name_actions_that_fit():
    task = task_of(probe("r"), GoTo(id="", place=First()))
    command = replace(
        task.command,
        goals=(
            Goal(id="g1", node="n3", action="probe_soil"),
            Goal(id="g1", node="n2", action="read_co2"),
        ),
        variables=(
            Variable(name="r", quantity="co2", unit="ppm", node="n9"),
            Variable(name="q", quantity="soil_ph", unit="pH", node="n2"),
        ),
    )
    assert references(replace(task, command=command)) == (
        "2 goals have the id 'g1'",
        "goal 'g1' names 'n3', which is not an action of the plan",
        "goal 'g1' counts 'read_co2', but its node 'n2' does 'probe_soil'",
        "state variable 'r' names 'n9', which is not an action of the plan",
        "state variable 'q' is not the reading that 'n2' binds",
    )
