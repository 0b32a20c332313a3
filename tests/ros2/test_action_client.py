"""Every goal of an action ends once, as the robot says, whatever gets lost; none that was given up runs on."""

from __future__ import annotations

import random
from dataclasses import dataclass, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.ros2.action_client import CANCEL_S, RESULT_AGAIN_S, ActionClient
from fieldhand.execution.drivers.ros2.action_outcome import ActionOutcome
from ros2.in_memory import Disturbed, Graph, Node
from ros2.scripted import Script, ScriptedAction, Served
from support.examples import examples

NAME, TYPE = "/navigate", "nav2_msgs/action/NavigateToPose"
ACCEPT_S, QUIET_S, NOTICED_S = 5.0, 8.0, 10.0
STEP_S = 0.25


@dataclass
class Rig:
    """A client and a server with a clock between them."""

    clock: SimulatedClock
    graph: Graph
    robot: Node
    server: ScriptedAction
    client: ActionClient

    def pass_time(self, seconds: float) -> None:
        until = self.clock.now() + seconds
        while self.clock.now() < until:
            self.tick()

    def tick(self) -> ActionOutcome | None:
        self.clock.advance(STEP_S)
        self.server.step()
        return self.client.step()

    def finish(self, within_s: float = 200.0) -> ActionOutcome:
        until = self.clock.now() + within_s
        while self.clock.now() < until:
            if (outcome := self.tick()) is not None:
                return outcome
        raise AssertionError(f"it did not end within {within_s} s")


def rig(*scripts: Script, seed: int = 0, quiet_s: float | None = QUIET_S, found_s: float = 0.0) -> Rig:
    clock = SimulatedClock()
    graph = Graph(clock.now, seed=seed, noticed_s=NOTICED_S, found_s=found_s)
    robot = graph.node()
    server = ScriptedAction(robot, NAME, TYPE, clock.now, lambda goal: scripts[int(str(goal["number"]))])
    ids = random.Random(seed)
    client = ActionClient(
        graph.node(), NAME, TYPE, steady=clock.now, accept_s=ACCEPT_S, quiet_s=quiet_s, new_id=lambda: ids.randbytes(16)
    )
    return Rig(clock, graph, robot, server, client)


def served(rig: Rig, number: int) -> Served | None:
    return next((g for g in rig.server.goals.values() if g.goal["number"] == number), None)


SCRIPTS = st.builds(
    Script,
    accepts=st.sampled_from([True, True, True, False]),
    lasts_s=st.floats(0.0, 20.0),
    ends=st.sampled_from(["succeeded", "aborted", "cancelled"]),
    feedback_every_s=st.sampled_from([0.5, 2.0, None]),
    cancels=st.sampled_from([True, True, True, False]),
    cancel_takes_s=st.floats(0.0, 3.0),
)
DISTURBED = st.builds(
    Disturbed,
    loss=st.sampled_from([0.0, 0.2, 0.5]),
    twice=st.sampled_from([0.0, 0.3]),
    delay_s=st.sampled_from([(0.0, 0.0), (0.0, 2.0), (0.0, 9.0)]),
)
#: A request does not come twice: a server that took it would reject it then.
ONCE = DISTURBED.map(lambda how: replace(how, twice=0.0))
WAYS = ("send_goal reply", "get_result *", "cancel_goal *", "feedback", "status")


@settings(max_examples=examples(60, thorough=2000), deadline=None)
@given(
    plans=st.lists(st.tuples(SCRIPTS, st.none() | st.floats(0.0, 12.0)), min_size=1, max_size=3),
    disturbed=st.fixed_dictionaries({}, optional={"send_goal request": ONCE, **dict.fromkeys(WAYS, DISTURBED)}),
    seed=st.integers(0, 2**16),
)
def test_every_goal_ends_once_as_the_robot_says_and_none_runs_on(
    plans: list[tuple[Script, float | None]], disturbed: dict[str, Disturbed], seed: int
) -> None:
    r = rig(*(script for script, _ in plans), seed=seed)
    for way, how in disturbed.items():
        r.graph.disturb(f"{NAME}/_action/{way}", how)
    for number, (script, cancel_after_s) in enumerate(plans):
        begun = r.clock.now()
        r.client.start({"number": number})
        outcome = None
        while outcome is None:
            if cancel_after_s is not None and r.clock.now() - begun >= cancel_after_s:
                r.client.cancel()
            outcome = r.tick()
            assert r.clock.now() - begun < ACCEPT_S + script.lasts_s + QUIET_S + CANCEL_S + 2 * RESULT_AGAIN_S + 10.0
        truth = served(r, number)
        if outcome.how in ("succeeded", "aborted"):
            assert truth is not None
            assert truth.state == outcome.how
        if outcome.how == "rejected":
            assert not script.accepts
        if outcome.how == "cancelled":
            assert outcome.what or cancel_after_s is not None or script.ends == "cancelled"
        for _ in range(4):
            assert r.tick() is outcome
    r.pass_time(60.0)
    assert all(not g.script.cancels for g in r.server.executing)
    numbers = [goal["number"] for goal in r.server.received]
    assert len(numbers) == len(set(numbers))


@settings(max_examples=examples(40, thorough=500), deadline=None)
@given(script=SCRIPTS, vanishes_s=st.floats(0.0, 15.0), cancel_s=st.none() | st.floats(0.0, 20.0))
def test_a_server_that_vanishes_at_any_step_ends_the_goal_within_the_limits(
    script: Script, vanishes_s: float, cancel_s: float | None
) -> None:
    r = rig(script)
    r.client.start({"number": 0})
    outcome = None
    while outcome is None:
        if r.clock.now() >= vanishes_s and r.robot.vanished_s is None:
            r.robot.vanish()
        if cancel_s is not None and r.clock.now() >= cancel_s:
            r.client.cancel()
        outcome = r.tick()
        assert r.clock.now() < vanishes_s + max(NOTICED_S, QUIET_S + CANCEL_S) + script.lasts_s + 10.0
    if r.robot.vanished_s is not None and outcome.how == "untold":
        assert "navigate" in outcome.what
        assert outcome.moving or r.server.received == []
    truth = served(r, 0)
    assert outcome.how in ("untold", "rejected", "cancelled") or (truth is not None and truth.state == outcome.how)


def test_a_goal_whose_request_is_lost_was_never_begun_and_is_confirmed_so() -> None:
    r = rig(Script())
    r.graph.disturb("*send_goal request", Disturbed(loss=1.0))
    r.client.start({"number": 0})
    outcome = r.finish()
    assert (outcome.how, outcome.moving) == ("cancelled", False)
    assert outcome.what == "/navigate did not accept or reject the goal within 5 s"


def test_a_goal_that_is_accepted_after_it_was_given_up_is_cancelled_then() -> None:
    r = rig(Script(lasts_s=1000.0))
    r.graph.disturb("*send_goal request", Disturbed(delay_s=(9.0, 9.0)))
    r.client.start({"number": 0})
    assert r.finish().how == "cancelled"
    assert not r.server.goals
    r.pass_time(15.0)
    assert [g.state for g in r.server.goals.values()] == ["cancelled"]


def test_a_lost_accepting_or_result_is_made_up_for() -> None:
    for way in ("*send_goal reply", "*get_result reply", "*get_result request"):
        r = rig(Script())
        r.graph.disturb(way, Disturbed(loss=1.0))
        r.client.start({"number": 0})
        assert r.finish().how == "succeeded", way


def test_feedback_and_results_of_others_are_not_taken_for_its_own() -> None:
    r = rig(Script(feedback_every_s=None, lasts_s=60.0))
    other = r.robot.publish(f"{NAME}/_action/feedback", f"{TYPE}_FeedbackMessage")
    r.client.start({"number": 0})
    for _ in range(400):
        other.send({"goal_id": {"uuid": bytes(range(16))}, "feedback": {"distance_remaining": 5.0}})
        if (outcome := r.tick()) is not None:
            break
    assert r.client.feedback == {}
    assert outcome is not None
    assert outcome.what == f"/navigate was silent for {QUIET_S:g} s"


def test_a_cancelled_goal_may_still_succeed_and_says_so() -> None:
    r = rig(Script(lasts_s=2.0, cancel_takes_s=10.0, result={"error_code": 0}))
    r.client.start({"number": 0})
    r.pass_time(1.0)
    r.client.cancel()
    assert r.finish() == ActionOutcome(how="succeeded", result={"error_code": 0})


def test_one_that_refuses_to_be_cancelled_is_said_to_move_still() -> None:
    r = rig(Script(lasts_s=500.0, cancels=False))
    r.client.start({"number": 0})
    r.pass_time(1.0)
    r.client.cancel()
    outcome = r.finish()
    assert (outcome.how, outcome.moving, outcome.what) == ("untold", True, "/navigate refuses to be cancelled")


def test_a_server_gets_the_goal_once_the_one_before_it_that_was_killed_is_forgotten() -> None:
    r = rig(Script())
    killed = r.graph.node()
    before = ScriptedAction(killed, NAME, TYPE, r.clock.now, lambda goal: Script())
    killed.vanish()
    r.client.start({"number": 0})
    assert r.finish().how == "succeeded"
    assert r.clock.now() >= NOTICED_S
    assert len(r.server.received) == 1
    assert not before.received


def test_two_servers_get_no_goal() -> None:
    r = rig(Script())
    second = ScriptedAction(r.graph.node(), NAME, TYPE, r.clock.now, lambda goal: Script())
    r.client.start({"number": 0})
    outcome = r.finish()
    assert (outcome.how, outcome.what) == ("rejected", "2 servers answer /navigate: which robot is meant?")
    second.step()
    assert not r.server.received
    assert not second.received


def test_a_server_that_was_started_anew_has_forgotten_the_goal() -> None:
    r = rig(Script(lasts_s=500.0), quiet_s=60.0)
    r.client.start({"number": 0})
    r.pass_time(2.0)
    r.robot.vanish()
    r.server = ScriptedAction(r.graph.node(), NAME, TYPE, r.clock.now, lambda goal: Script())
    outcome = r.finish(20.0)
    assert (outcome.how, outcome.what) == (
        "cancelled", "/navigate no longer knows the goal: it was restarted"
    )  # fmt: skip


def test_nothing_is_sent_before_both_ends_have_found_each_other() -> None:
    r = rig(Script(), found_s=3.0)
    r.client.start({"number": 0})
    assert r.finish().how == "succeeded"


def test_one_goal_at_a_time() -> None:
    r = rig(Script())
    r.client.start({"number": 0})
    with pytest.raises(RuntimeError, match="one at a time"):
        r.client.start({"number": 0})


def test_goals_of_others_are_over_before_the_first_of_ours() -> None:
    r = rig(Script(lasts_s=500.0, cancel_takes_s=2.0))
    r.client.start({"number": 0})
    r.pass_time(1.0)
    ours = ActionClient(r.graph.node(), NAME, TYPE, steady=r.clock.now, accept_s=ACCEPT_S)
    r.graph.disturb("*cancel_goal reply", Disturbed(loss=1.0))
    assert not ours.cancel_everything()
    r.pass_time(10.0)
    assert not r.server.executing
    assert not ours.cancel_everything()  # nobody said so
    r.graph.disturb("*cancel_goal reply", Disturbed())
    for _ in range(8):
        r.tick()
        if done := ours.cancel_everything():
            break
    assert done
