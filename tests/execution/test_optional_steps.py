"""An optional step on the robot: the guard is asked once about all of it, and what it sheds is no failure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import pytest

from fieldhand.evaluation.outcome import judge
from fieldhand.execution.drivers.simulation.world import ActionFails, World
from fieldhand.execution.guard import NoGuard
from fieldhand.forecast.mission_state import MissionState, Verdict, Visit, VisitChoice
from fieldhand.places.selectors import TreeIs, UnionOf
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, InOrder, Node, OptionalStep, Repeat, StopMission, Try
from fieldhand.task.results import Exited, Faulted, Shed
from support.missions.rig import BudgetOf, Rig, captured, husky, of_type, task_for

PICTURE = "take_thermal_picture"


def act(tree: str = "", **more: object) -> Act:
    return Act(id="", action=PICTURE, at=TreeIs(tree=tree) if tree else None, **more)


def seq(*steps: Node) -> InOrder:
    return InOrder(id="", steps=steps)


def optional(*steps: Node, reward: float = 1.0) -> OptionalStep:
    return OptionalStep(id="", body=steps[0] if len(steps) == 1 else seq(*steps), reward=reward)


@dataclass
class Sheds(NoGuard):
    """A guard that sheds every optional visit, or those of some turns, and keeps what it was asked about."""

    turns: tuple[int, ...] | None = None
    asked: list[tuple[str, Visit]] = field(default_factory=list)
    refuses: tuple[str, ...] = ()

    def admit(self, state: MissionState, visit: Visit, still_to_come: object = ()) -> Verdict:
        return Verdict(go=visit.place.id not in self.refuses, reason="too far")

    def choose(
        self,
        state: MissionState,
        candidates: list[Visit],
        *,
        at_most: int | None = None,
        still_to_come: Sequence[Visit] = (),
    ) -> VisitChoice:
        (visit,) = candidates
        self.asked.append((state.node, visit))
        if self.turns is None or len(self.asked) - 1 in self.turns:
            return VisitChoice(index=None, shed=(0,), reason="too little left", chance_short=0.3)
        return VisitChoice(index=0)


def places(result) -> list[str]:
    return [place for _, place in captured(result.events)]


PLAN = seq(act("r0c0"), optional(act("r3c4"), act("r3c3"), reward=2.0), act("r0c1"))


def test_a_step_that_the_guard_chooses_is_done_in_its_turn():
    guard = Sheds(turns=())
    result = Rig(guard=guard).fly(PLAN)
    assert places(result) == ["r0c0", "r3c4", "r3c3", "r0c1"]
    assert of_type(result.events, Shed) == []
    ((node, visit),) = guard.asked
    assert (node, visit.place.id, visit.leaves.id, visit.reward) == ("n3", "r3c4", "r3c3", 2.0)
    assert visit.service_s == 2 * husky().action[PICTURE].duration_s
    assert visit.inside_m == 5.0


def test_a_step_that_the_guard_sheds_is_told_and_the_mission_completes():
    task = task_for(PLAN)
    result = Rig(guard=Sheds()).fly(task)
    assert (result.status, places(result)) == ("completed", ["r0c0", "r0c1"])
    (shed,) = of_type(result.events, Shed)
    assert (shed.node, shed.places, shed.optional, shed.reason) == ("n3", ("r3c4",), True, "too little left")
    outcomes = judge(task, result.events)
    assert [o.outcome for o in outcomes] == ["success"] * 4
    assert [o.wanted for o in outcomes] == [1, 0, 0, 1]
    assert "left out (too little left)" in outcomes[1].why


def test_work_that_is_refused_half_way_gives_up_the_step_alone():
    task = task_for(seq(optional(act("r0c1"), act("r3c4"), act("r3c3")), act("r0c2")))
    result = Rig(guard=Sheds(turns=(), refuses=("r3c4",))).fly(task)
    assert (result.status, places(result)) == ("completed", ["r0c1", "r0c2"])
    (shed,) = of_type(result.events, Shed)
    assert (shed.node, shed.optional, shed.reason) == ("n2", True, "too far")
    outcomes = judge(task, result.events)
    assert [o.outcome for o in outcomes] == ["success"] * 4
    assert [o.done for o in outcomes] == [1, 0, 0, 1]


def test_at_each_place_of_a_loop_the_guard_is_asked_anew():
    trees = UnionOf(parts=tuple(TreeIs(tree=f"r0c{k}") for k in range(4)))
    task = task_for(ForEach(id="", select=trees, body=seq(act(), optional(act(count=2)))))
    result = Rig(guard=Sheds(turns=(1, 3))).fly(task)
    assert result.status == "completed"
    assert [places(result).count(f"r0c{k}") for k in range(4)] == [3, 1, 3, 1]
    plain, extra = judge(task, result.events)
    assert (plain.outcome, plain.done, plain.wanted) == ("success", 4, 4)
    assert (extra.outcome, extra.done, extra.wanted) == ("success", 4, 4)
    assert "left out 2 times (too little left)" in extra.why


def test_in_a_repeat_and_an_any_order_set_the_rest_goes_on_where_a_step_is_shed():
    assert places(Rig(guard=Sheds(turns=(0,))).fly(Repeat(id="", times=2, body=optional(act("r0c0"))))) == ["r0c0"]
    several = AnyOrder(id="", steps=(act("r0c3"), optional(act("r0c1")), act("r0c0")))
    assert places(Rig(guard=Sheds()).fly(several)) == ["r0c0", "r0c3"]
    assert places(Rig(guard=Sheds(turns=())).fly(several)) == ["r0c0", "r0c1", "r0c3"]


def test_each_time_that_a_step_is_shed_counts_by_itself():
    task = task_for(Repeat(id="", times=3, body=optional(GoTo(id="", place=TreeIs(tree="r0c1")), act())))
    for turns in ((0,), (1,), (2,), (0, 2), (1, 2)):
        result = Rig(guard=Sheds(turns=turns)).fly(task)
        (outcome,) = judge(task, result.events)
        assert (outcome.outcome, outcome.done, outcome.wanted) == ("success", 3 - len(turns), 3 - len(turns))


def test_a_step_whose_place_there_is_not_fails_as_any_other_and_a_try_catches_it():
    nowhere = optional(act("r9c9"))
    result = Rig().fly(nowhere)
    assert result.status == "faulted"
    assert [(e.fault, e.handled) for e in of_type(result.events, Faulted)] == [("no_place", False)]
    assert places(Rig().fly(Try(id="", body=nowhere, otherwise=act("r0c0")))) == ["r0c0"]


def test_an_action_that_fails_inside_the_step_is_a_failure():
    task = task_for(seq(optional(act("r0c1")), act("r0c2")))
    result = Rig(world=World(faults=(ActionFails(action=PICTURE),))).fly(task)
    assert result.status == "faulted"
    assert judge(task, result.events)[0].outcome == "failure"


def test_a_stop_inside_the_step_ends_the_mission_only_if_the_step_is_done():
    plan = seq(optional(act("r0c1"), StopMission(id="")), act("r0c2"))
    assert places(Rig(guard=Sheds(turns=())).fly(plan)) == ["r0c1"]
    assert places(Rig(guard=Sheds()).fly(plan)) == ["r0c2"]


@pytest.mark.parametrize("visits", [0, 1])
def test_a_mission_that_turns_home_tells_the_optional_steps_it_did_not_come_to(visits):
    task = task_for(seq(*[act("r0c0")] * visits, act("r0c1"), optional(act("r3c4"))))
    result = Rig(guard=BudgetOf(visits)).fly(task)
    assert result.status == "returned"
    assert [(e.places, e.optional) for e in of_type(result.events, Shed)] == [(("r0c1",), False), (("r3c4",), True)]
    assert [o.outcome for o in judge(task, result.events)][-2:] == ["failure", "success"]
    assert of_type(result.events, Exited)[0].exit == "faulted"
