"""What evaluation makes of an event log, held against what was really done."""

from __future__ import annotations

from dataclasses import replace
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from evaluation.event_logs import HOT, Paper, random_plan, task_of
from fieldhand.evaluation.outcome import judge
from fieldhand.places.selectors import Corners, Half, TreeIs, Trees
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, InOrder, Repeat, StopMission, Try
from fieldhand.task.results import Acted, Arrived, Decided, Ended, Exited, Faulted, Shed, Visiting

seeds = st.integers(0, 2**32)
PICTURE = Act(id="", action="take_thermal_picture")
CO2 = Act(id="", action="read_co2")


def only(task, events):
    (outcome,) = judge(task, events)
    return outcome


def acted(node, status="success", attempt=1, place="1"):
    return Acted(t=1, node=node, action="a", status=status, kind="tree", place=place, lat=0, lon=0, attempt=attempt)


def arrived(node, place):
    return Arrived(
        t=1, node=node, kind="tree", place=place, lat=0, lon=0, leg_m=5, travelled_m=5, charge_percent=90
    )  # fmt: skip


def ended(status="completed", reason=""):
    return Ended(t=9, status=status, lat=0, lon=0, travelled_m=1, charge_percent=50, reason=reason)


@settings(max_examples=120, deadline=None)
@given(seed=seeds)
def test_a_mission_without_faults_meets_every_goal_and_wants_what_was_done(seed):
    rng = Random(seed)
    task = task_of(random_plan(rng))
    paper = Paper(rng)
    events = paper.follow(task)
    for goal, outcome in zip(task.command.goals, judge(task, events), strict=True):
        assert outcome.done == paper.done[goal.node]
        assert outcome.wanted == paper.wanted[goal.node]
        assert outcome.outcome == "success", outcome
        if outcome.wanted == 0:
            assert outcome.why.startswith(("not needed", "left out"))


@settings(max_examples=120, deadline=None)
@given(seed=seeds, cut=st.floats(0, 1))
def test_a_log_that_stops_anywhere_is_never_a_failure_and_a_success_only_of_what_is_whole(seed, cut):
    rng = Random(seed)
    task = task_of(random_plan(rng))
    paper = Paper(rng)
    events = paper.follow(task)[:-2]
    for goal, outcome in zip(task.command.goals, judge(task, events[: round(cut * len(events))]), strict=True):
        assert outcome.outcome != "failure", outcome
        if outcome.outcome == "success":
            assert outcome.done == paper.done[goal.node] == paper.wanted[goal.node]
        if outcome.wanted is not None:
            assert outcome.wanted == paper.wanted[goal.node]


@settings(max_examples=120, deadline=None)
@given(seed=seeds, odds=st.floats(0.02, 0.3))
def test_fewer_captures_than_called_for_are_never_a_success(seed, odds):
    rng = Random(seed)
    task = task_of(random_plan(rng))
    paper = Paper(rng, fail=lambda node, made: rng.random() < odds)
    events = paper.follow(task)
    for goal, outcome in zip(task.command.goals, judge(task, events), strict=True):
        assert outcome.done == paper.done[goal.node]
        if paper.done[goal.node] < paper.wanted[goal.node]:
            assert outcome.outcome == "failure", outcome
        if outcome.outcome == "success" and not goal.optional:
            assert outcome.done >= outcome.wanted >= paper.wanted[goal.node]
            if goal.expected is not None and not goal.conditional:
                assert outcome.done >= goal.expected


@settings(max_examples=120, deadline=None)
@given(seed=seeds)
def test_a_log_out_of_order_is_judged_without_an_error_and_never_too_well(seed):
    rng = Random(seed)
    task = task_of(random_plan(rng))
    events = Paper(rng).follow(task)
    shuffled = rng.sample(events, rng.randint(0, len(events)))
    for goal, outcome in zip(task.command.goals, judge(task, shuffled), strict=True):
        if outcome.outcome == "success" and not goal.optional:
            assert outcome.done >= outcome.wanted


def test_a_retry_that_succeeds_is_a_success():
    task = task_of(PICTURE)
    events = [
        acted("n1", "failed", 1),
        Faulted(t=1, node="n1", fault="action_failed", what="blurred", handled=True),
        acted("n1", "success", 2),
        ended(),
    ]
    outcome = only(task, events)
    assert (outcome.outcome, outcome.done, outcome.wanted) == ("success", 1, 1)
    assert outcome.why == "1 of 1 thermal picture"


def test_giving_up_what_had_to_be_visited_is_a_failure_that_says_why():
    task = task_of(ForEach(id="", select=Corners(), body=PICTURE))
    events = [
        Visiting(t=0, node="n1", places=("1", "2", "3", "4")),
        acted("n2"),
        acted("n2", place="2"),
        Shed(t=2, node="n1", places=("3", "4"), optional=False, reason="the way home would not fit"),
        Exited(t=3, exit="faulted", then="return_to_end"),
        ended("returned"),
    ]
    outcome = only(task, events)
    assert (outcome.outcome, outcome.done, outcome.wanted) == ("failure", 2, 4)
    assert "2 places given up (the way home would not fit)" in outcome.why


def test_a_failed_visit_that_is_caught_counts_against_its_goal_and_for_its_stand_in():
    task = task_of(ForEach(id="", select=Corners(), body=Try(id="", body=PICTURE, otherwise=CO2)))
    events = [
        Visiting(t=0, node="n1", places=("1", "2")),
        acted("n3", "failed", 1),
        acted("n3", "failed", 2),
        acted("n4"),
        acted("n3", place="2"),
        ended(),
    ]
    picture, co2 = judge(task, events)
    assert (picture.outcome, picture.done, picture.wanted) == ("failure", 1, 2)
    assert (co2.outcome, co2.done, co2.wanted) == ("success", 1, 1)


@pytest.mark.parametrize(
    ("status", "expected"), [("returned", "success"), ("completed", "success"), ("faulted", "failure")]
)
def test_as_many_as_you_can_is_met_by_what_the_budget_allowed(status, expected):
    task = task_of(ForEach(id="", select=Trees(), body=PICTURE, optional=True))
    loop = [Visiting(t=0, node="n1", places=("1", "2", "3"), optional=True), acted("n2")]
    if status == "faulted":
        events = [*loop, acted("n2", "failed", place="2"), ended(status)]
    else:
        shed = Shed(t=1, node="n1", places=("2", "3"), optional=True, reason="100 m are used up")
        events = [*loop, shed, ended(status)]
    assert only(task, events).outcome == expected


def test_as_many_as_you_can_is_not_met_by_none():
    task = task_of(ForEach(id="", select=Trees(), body=PICTURE, optional=True))
    events = [
        Visiting(t=0, node="n1", places=("1", "2"), optional=True),
        Shed(t=1, node="n1", places=("1", "2"), optional=True, reason="too far"),
        ended(),
    ]
    outcome = only(task, events)
    assert outcome.outcome == "failure"
    assert "2 places left out (too far)" in outcome.why


def test_a_place_that_was_closed_when_its_loop_began_is_not_taken_off_twice():
    plan = ForEach(id="", select=Trees(), body=PICTURE, optional=True)
    events = [
        Visiting(t=0, node="n1", places=("1", "2"), optional=True),
        Shed(t=0, node="n1", places=("3",), optional=True, reason="cannot be reached"),
        acted("n2"),
        acted("n2", place="2"),
        ended(),
    ]
    outcome = only(task_of(plan), events)
    assert (outcome.outcome, outcome.done, outcome.wanted) == ("success", 2, 2)


def test_at_most_counts_what_was_shed_beyond_it_only_once():
    task = task_of(ForEach(id="", select=Trees(), body=PICTURE, optional=True, at_most=2))
    places = tuple(str(k) for k in range(9))
    events = [
        Visiting(t=0, node="n1", places=places, optional=True),
        acted("n2"),
        acted("n2"),
        Shed(t=1, node="n1", places=places[2:], optional=True, reason="enough"),
        ended(),
    ]
    outcome = only(task, events)
    assert (outcome.outcome, outcome.done, outcome.wanted) == ("success", 2, 2)


def test_a_branch_that_was_not_taken_is_met_with_none_wanted_and_says_why():
    task = task_of(InOrder(id="", steps=(PICTURE, If(id="", condition=HOT, then=CO2))))
    decided = Decided(t=2, node="n3", holds=False, why="canopy temperature 35 °C is not below 33 °C")
    outcome = judge(task, [acted("n2"), decided, ended()])[1]
    assert (outcome.outcome, outcome.wanted) == ("success", 0)
    assert outcome.why == "not needed: canopy temperature 35 °C is not below 33 °C"


def test_what_stands_behind_a_stop_is_not_wanted():
    plan = InOrder(id="", steps=(PICTURE, If(id="", condition=HOT, then=StopMission(id="")), CO2))
    task = task_of(plan)
    decided = Decided(t=2, node="n3", holds=True, why="it is low")
    outcome = judge(task, [acted("n2"), decided, Exited(t=3, exit="nominal", then="stay"), ended()])[1]
    assert (outcome.outcome, outcome.done, outcome.wanted) == ("success", 0, 0)
    assert "the plan ended before it" in outcome.why


def test_what_stands_behind_a_stop_that_only_the_exit_tells_of_is_not_wanted():
    plan = InOrder(id="", steps=(Try(id="", body=PICTURE, otherwise=StopMission(id="")), CO2))
    failed = [
        acted("n3", "failed"),
        Faulted(t=2, node="n3", fault="action_failed", what="no picture", handled=True),
        Exited(t=3, node="n4", exit="nominal", then="stay"),
        ended(),
    ]
    picture, co2 = judge(task_of(plan), failed)
    assert picture.outcome == "failure"
    assert (co2.outcome, co2.done, co2.wanted) == ("success", 0, 0)
    assert "the plan ended before it" in co2.why


@pytest.mark.parametrize(
    ("end", "expected"),
    [([], "indeterminate"), ([ended("aborted")], "indeterminate"), ([ended("returned", "low battery")], "failure")],
)
def test_what_was_never_reached_is_failed_only_where_the_mission_is_known_to_be_over(end, expected):
    task = task_of(InOrder(id="", steps=(PICTURE, Act(id="", action="read_co2", at=TreeIs(tree="9")))))
    assert judge(task, [acted("n2"), *end])[1].outcome == expected


def test_a_condition_that_was_never_tested_leaves_its_goal_indeterminate():
    task = task_of(InOrder(id="", steps=(PICTURE, If(id="", condition=HOT, then=CO2))))
    fault = Faulted(t=1, node="n2", fault="action_failed", what="no power")
    picture, co2 = judge(task, [acted("n2", "failed"), fault, ended("faulted", "no power")])
    assert picture.outcome == "failure"
    assert co2.outcome == "indeterminate"
    assert co2.wanted is None


def test_an_aborted_loop_that_was_begun_is_a_failure_of_a_goal_that_had_to_be_met():
    task = task_of(ForEach(id="", select=Corners(), body=PICTURE))
    events = [Visiting(t=0, node="n1", places=("1", "2", "3")), acted("n2"), ended("aborted", "the operator said so")]
    outcome = only(task, events)
    assert (outcome.outcome, outcome.done, outcome.wanted) == ("failure", 1, 3)


def test_steps_in_any_order_are_found_in_the_order_of_the_log():
    steps = tuple(Act(id="", action="read_co2", at=TreeIs(tree=str(k)), count=k) for k in (1, 2, 3))
    task = task_of(AnyOrder(id="", steps=steps))
    log = [acted(node) for node, count in (("n4", 3), ("n2", 1), ("n3", 2)) for _ in range(count)]
    assert [o.outcome for o in judge(task, [*log, ended()])] == ["success"] * 3
    short = judge(task, [*log[:-1], ended("faulted")])
    assert [o.outcome for o in short] == ["success", "failure", "success"]


def test_a_repeat_wants_its_count_again_and_again():
    task = task_of(Repeat(id="", times=3, body=replace(PICTURE, count=2)))
    outcome = only(task, [*[acted("n2")] * 5, ended("faulted")])
    assert (outcome.outcome, outcome.done, outcome.wanted) == ("failure", 5, 6)


def test_a_for_each_that_was_never_reached_wants_an_unknown_number():
    task = task_of(InOrder(id="", steps=(PICTURE, ForEach(id="", select=Half(side="north"), body=CO2))))
    outcome = judge(task, [acted("n2"), ended("returned", "the battery is low")])[1]
    assert (outcome.outcome, outcome.wanted) == ("failure", None)
    assert "never reached" in outcome.why


def test_visits_that_leave_no_trace_are_made_where_the_log_is_whole():
    """The robot stands at the second place already, and what it drives to there is where it is."""
    body = Try(id="", body=GoTo(id="", place=TreeIs(tree="2")), otherwise=CO2)
    task = task_of(ForEach(id="", select=Trees(), body=body))
    log = [Visiting(t=1, node="n1", places=("1", "2")), arrived("n1", "1"), arrived("n3", "2")]
    whole = only(task, [*log, ended()])
    assert (whole.outcome, whole.wanted) == ("success", 0)
    assert only(task, log).outcome == "indeterminate"


def test_a_repeat_that_was_cut_off_before_its_test_has_not_gone_well():
    plan = Try(id="", body=Repeat(id="", times=2, body=PICTURE, until=HOT), otherwise=CO2)
    assert judge(task_of(plan), [acted("n3")])[1].outcome == "indeterminate"


def test_the_way_home_is_no_part_of_the_plan():
    task = task_of(PICTURE)
    home = Arrived(t=3, node="n1", kind="marker", place="end", lat=0, lon=0, leg_m=1, travelled_m=1, charge_percent=9)
    outcome = only(task, [Exited(t=2, exit="nominal", then="return_to_end"), home, acted("n1"), ended()])
    assert outcome.outcome == "failure"


def test_what_is_shed_on_the_way_home_is_found_at_every_step_that_it_names():
    loop = ForEach(id="", select=Corners(), body=PICTURE)
    twice = Repeat(id="", times=2, body=CO2)
    perhaps = If(id="", condition=HOT, then=CO2)
    task = task_of(InOrder(id="", steps=(twice, CO2, loop, perhaps)))
    reason = "the way home would not fit"
    sheds = [("n2", ()), ("n4", ()), ("n5", ("1", "2", "3", "4")), ("n7", ())]
    events = [
        acted("n3"),
        Shed(t=1, node="n3", places=("5",), optional=False, reason=reason),
        *(Shed(t=1, node=node, places=places, optional=False, reason=reason) for node, places in sheds),
        ended("returned", reason),
    ]
    repeated, co2, pictures, conditional = judge(task, events)
    assert (repeated.outcome, repeated.done, repeated.wanted) == ("failure", 1, 2)
    assert (co2.outcome, co2.done, co2.wanted) == ("failure", 0, 1)
    assert (pictures.outcome, pictures.done) == ("failure", 0)
    assert reason in co2.why
    assert reason in pictures.why
    assert conditional.outcome == "indeterminate"


def test_an_optional_visit_that_was_given_up_half_way_is_left_out_and_not_failed():
    body = InOrder(id="", steps=(PICTURE, Act(id="", action="read_co2", at=TreeIs(tree="9"))))
    task = task_of(ForEach(id="", select=Trees(), body=body, optional=True))
    shed = Shed(t=1, node="n1", places=("1",), optional=True, reason="no budget for the second part")
    events = [
        Visiting(t=0, node="n1", places=("1", "2"), optional=True),
        acted("n3"),
        shed,
        acted("n3", place="2"),
        acted("n4", place="9"),
        ended(),
    ]
    pictures, co2 = judge(task, events)
    assert (pictures.outcome, pictures.done, pictures.wanted) == ("success", 2, 2)
    assert (co2.outcome, co2.done, co2.wanted) == ("success", 1, 1)
    assert "1 place left out" in co2.why
