"""What a plan means, whoever carries it out: random plans with random answers and random failures."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from fieldhand.places.selectors import TreeIs, Trees
from fieldhand.task import instructions as ask
from fieldhand.task.build import make_task
from fieldhand.task.nodes.base import Cut, Failed, GivenUp, Stopped
from fieldhand.task.plan import (
    Act,
    AnyOrder,
    ForEach,
    GoTo,
    If,
    InOrder,
    Node,
    OptionalStep,
    Repeat,
    StopMission,
    Try,
    walk,
)
from fieldhand.task.run import PlanRun, StackFrame, carry_out

WORD = ("", "a", "b")


def plans() -> st.SearchStrategy[Node]:
    """Plans of every kind of node, their ids made as those of a Task are."""
    leaf: st.SearchStrategy[Node] = st.one_of(
        st.builds(
            Act,
            id=st.just(""),
            action=st.just("look"),
            at=st.sampled_from((None, TreeIs(tree="t"))),
            reading=st.sampled_from(WORD),
            label=st.sampled_from(WORD),
        ),
        st.builds(GoTo, id=st.just(""), place=st.just(TreeIs(tree="t")), label=st.sampled_from(WORD)),
        st.builds(StopMission, id=st.just("")),
    )

    def inner(part: st.SearchStrategy[Node]) -> st.SearchStrategy[Node]:
        steps = st.lists(part, max_size=3).map(tuple)
        nothing = st.just("")
        return st.one_of(
            st.builds(InOrder, id=nothing, steps=steps),
            st.builds(AnyOrder, id=nothing, steps=steps),
            st.builds(
                ForEach,
                id=nothing,
                select=st.just(Trees()),
                body=part,
                label=st.sampled_from(WORD),
                at_most=st.sampled_from((None, 1, 2)),
                optional=st.booleans(),
            ),
            st.builds(Repeat, id=nothing, times=st.integers(1, 3), body=part),
            st.builds(If, id=nothing, condition=st.none(), then=part, otherwise=st.one_of(st.none(), part)),
            st.builds(Try, id=nothing, body=part, otherwise=part),
            st.builds(OptionalStep, id=nothing, body=part),
        )

    return st.recursive(leaf, inner, max_leaves=12).map(
        lambda plan: make_task(request="", plan=plan, measures={}).composition.plan
    )


class Scripted:
    """Answers from a list of numbers, and fails or gives up where it says so; it checks each request.

    Args:
        plan: The plan.
        luck: What is answered, one number a request; 0 where it has no more.
        unlucky: Whether requests may fail, and work may be given up.
    """

    def __init__(self, plan: Node, luck: list[int], *, unlucky: bool = True) -> None:
        self.run = PlanRun(plan)
        self.luck, self.unlucky = iter(luck), unlucky
        self.asked: list[ask.Instruction] = []
        self.open: list[Node] = []
        self.ended: list[tuple[str, str]] = []
        self.run.entered, self.run.left = self.open.append, self._left
        #: The id that the next request must belong to, from inside or itself.
        self.must_be_in: set[str] | None = None

    def _left(self, node: Node, outcome: str) -> None:
        assert self.open.pop() is node
        self.ended.append((node.id, outcome))

    def answer(self, request: ask.Instruction) -> Any:
        assert [frame.node for frame in self.run.frames] == self.open
        assert request.node is self.open[-1]
        assert self.must_be_in is None or request.node.id in self.must_be_in
        self.must_be_in = None
        self.asked.append(request)
        number = next(self.luck, 0)
        if self.unlucky and number % 7 == 5:
            self._fail(request)
        if self.unlucky and number % 7 == 6:
            self._give_up()
        match request:
            case ask.ArrangeSteps(node=node):
                return tuple(reversed(range(len(node.steps)))) if number % 2 else tuple(range(len(node.steps)))
            case ask.BeginVisits():
                return list(range(number % 4))
            case ask.NextVisit(tour=tour):
                return tour.pop() if tour else None
            case ask.DriveTo(place=place):
                return place
            case ask.Decide() | ask.OfferStep():
                return bool(number % 2)
            case ask.Locate():
                return -1
        return None

    def _fail(self, request: ask.Instruction) -> None:
        catching = next((f for f in self.run.outwards() if f.instead), None)
        if catching is not None:
            self.must_be_in = {node.id for node in walk(catching.instead[0])} | self._after(catching.node)
        raise Failed(request.node.id)

    def _give_up(self) -> None:
        frame = self.run.optional
        if frame is None or (frame is self.run.frame):
            return
        node = frame.node
        self.must_be_in = ({node.id} if isinstance(node, ForEach) else set()) | self._after(node)
        raise GivenUp(node.id)

    def _after(self, node: Node) -> set[str]:
        """Ids of what may be asked for behind a node: all of the nodes around it, and what is in them."""
        around = [f.node for f in self.run.frames]
        outer = around[: around.index(node)]
        inside = {n.id for n in walk(node)}
        # A loop around it may come to it again.
        again = any(isinstance(n, ForEach | Repeat) for n in outer)
        return {n.id for o in outer for n in walk(o)} - (set() if again else inside)


def ended(script: Scripted) -> str:
    """Carry the plan out; how it ended."""
    try:
        carry_out(script.run.program(), script.answer)
    except Failed:
        return "failed"
    except Stopped:
        return "stopped"
    return "done"


@given(plans(), st.lists(st.integers(0, 70), max_size=60))
def test_requests_come_from_the_node_in_hand_and_every_node_that_is_entered_is_left(
    plan: Node, luck: list[int]
) -> None:
    script = Scripted(plan, luck)
    how = ended(script)
    assert script.run.frames == script.open == []
    assert script.ended[-1][0] == plan.id
    assert script.ended[-1][1] == {"done": "done", "failed": "failed", "stopped": "cut"}[how]
    assert (how == "stopped") <= any(isinstance(node, StopMission) for node in walk(plan))


@given(plans(), st.lists(st.integers(0, 70), max_size=60))
def test_without_failures_only_a_stop_ends_a_plan_early(plan: Node, luck: list[int]) -> None:
    script = Scripted(plan, luck, unlucky=False)
    how = ended(script)
    assert how in ("done", "stopped")
    if how == "done":
        assert {outcome for _, outcome in script.ended} == {"done"}


@given(plans(), st.lists(st.integers(0, 70), max_size=60))
def test_the_same_answers_give_the_same_requests(plan: Node, luck: list[int]) -> None:
    """A mission that goes on after a power cut comes to where it was by its recorded answers."""
    once, again = Scripted(plan, luck), Scripted(plan, luck)
    assert ended(once) == ended(again)
    assert [type(r) for r in once.asked] == [type(r) for r in again.asked]
    assert [r.node.id for r in once.asked] == [r.node.id for r in again.asked]


@given(plans(), st.lists(st.integers(0, 70), max_size=60), st.integers(0, 20), st.integers(0, 5))
def test_a_node_that_is_cut_is_over_and_what_comes_behind_it_goes_on(
    plan: Node, luck: list[int], when: int, outwards: int
) -> None:
    script = Scripted(plan, luck, unlucky=False)
    cut: list[str] = []

    def answer(request: ask.Instruction) -> Any:
        if len(script.asked) == when and not cut:
            around = [frame.node for frame in script.run.outwards()]
            node = around[min(outwards, len(around) - 1)]
            cut.append(node.id)
            script.must_be_in = script._after(node)
            raise Cut(node.id)
        return script.answer(request)

    with suppress(Stopped):
        carry_out(script.run.program(), answer)
    assert script.run.frames == script.open == []
    if cut:
        first = next(k for k, (name, outcome) in enumerate(script.ended) if outcome == "cut" and name == cut[0])
        assert {outcome for _, outcome in script.ended[first + 1 :]} <= {"done"} or any(
            isinstance(node, StopMission) for node in walk(plan)
        )


@given(plans(), st.lists(st.integers(0, 70), max_size=60))
def test_a_node_goes_on_after_a_child_only_where_it_says_so(plan: Node, luck: list[int]) -> None:
    script = Scripted(plan, luck)
    before: dict[int, tuple[StackFrame, Node]] = {}

    def entered(node: Node) -> None:
        script.open.append(node)
        if len(script.run.frames) > 1:
            around = script.run.frames[-2]
            _, last = before.get(id(around), (around, None))
            assert last is None or around.node.goes_on_after(last) or last in around.node.caught
            before[id(around)] = (around, node)

    script.run.entered = entered
    ended(script)


@given(plans())
def test_a_node_with_its_own_children_is_itself_and_its_parts_are_its_children(plan: Node) -> None:
    for node in walk(plan):
        assert node.with_children(node.children) == node
        assert tuple(part.node for part in node.parts) == node.children
        renamed = [replace(child, id=f"{child.id}b") for child in node.children]
        assert [child.id for child in node.with_children(renamed).children] == [child.id for child in renamed]


def test_a_visit_that_is_given_up_does_not_count_and_is_not_among_the_label() -> None:
    body = Act(id="", action="look")
    loop = ForEach(id="", select=Trees(), body=body, label="t", at_most=2, optional=True)
    plan = make_task(request="", plan=loop, measures={}).composition.plan
    run, bound, driven = PlanRun(plan), [], []

    def answer(request: ask.Instruction) -> Any:
        match request:
            case ask.BeginVisits():
                return ["a", "b", "c", "d"]
            case ask.NextVisit(tour=tour):
                return tour.pop(0) if tour else None
            case ask.DriveTo(place=place, tour=None):
                return place
            case ask.DriveTo(place=place):
                driven.append(place)
                return place
            case ask.BindLabel(node=node, places=places) if node is plan:
                bound.append(places)
            case ask.Capture() if driven[-1] == "b":
                raise GivenUp(plan.id)
        return None

    carry_out(run.program(), answer)
    assert driven == ["a", "b", "c"]
    assert bound == [("a",), ("b",), ("c",), ("a", "c")]


def test_a_failure_in_the_otherwise_of_a_try_is_not_caught_by_that_try() -> None:
    act = Act(id="", action="look")
    inner = Try(id="", body=act, otherwise=replace(act, action="listen"))
    outer = Try(id="", body=inner, otherwise=replace(act, action="wait"))
    plan = make_task(request="", plan=outer, measures={}).composition.plan
    done: list[str] = []

    def answer(request: ask.Instruction) -> None:
        if isinstance(request, ask.Capture):
            done.append(request.node.action)
            if request.node.action != "wait":
                raise Failed(request.node.id)

    carry_out(PlanRun(plan).program(), answer)
    assert done == ["look", "listen", "wait"]
