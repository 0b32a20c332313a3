"""The judge of whole missions finds nothing wrong with sound logs, and every mistake that is planted in one."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fieldhand.execution.drivers.simulation.world import ActionFails, TreeRef, World
from fieldhand.places.selectors import TreeIs, Trees, UnionOf
from fieldhand.task.frames import Budget, Constraints, Task
from fieldhand.task.plan import Act, AnyOrder, ForEach, InOrder, Node, Repeat, Try, walk
from fieldhand.task.results import Acted, Arrived, Decided, Ended, Event, Exited, Shed, Visiting
from fieldhand_bench.draw import Draft
from fieldhand_bench.fly import fly
from fieldhand_bench.referee import Judgement, judge
from support.examples import examples
from support.missions.rig import BudgetOf, Rig, husky, of_type, orchard, task_for

PICTURE = Act(id="", action="take_thermal_picture")
THREE = ("r0c0", "r2c3", "r3c1")
ALL_THREE = ForEach(id="", select=UnionOf(parts=tuple(TreeIs(tree=t) for t in THREE)), body=PICTURE)
MANY = ForEach(id="", select=Trees(), body=PICTURE, optional=True, reward="reward")
RIG = Rig()


def flown(plan: Node, *, visits: int = 1000, **task: object) -> tuple[Task, list[Event]]:
    """A mission on the grid, with a guard that admits so many visits."""
    made = task_for(plan, **task)  # type: ignore[arg-type]
    return made, list(replace(RIG, guard=BudgetOf(visits)).fly(made).events)


def ruled(task: Task, events: list[Event]) -> Judgement:
    return judge(task, orchard(), husky(), events)


def sound(ruling: Judgement) -> bool:
    return not (ruling.silent or ruling.doubled or ruling.misplaced or ruling.odd)


def changed(events: list[Event], old: Event, **fields: object) -> list[Event]:
    return [replace(e, **fields) if e is old else e for e in events]


def limited(kind: str, limit: float) -> Constraints:
    return Constraints(budgets=(Budget(kind=kind, limit=limit),))  # type: ignore[arg-type]


def test_a_mission_that_did_all_it_had_to_is_sound() -> None:
    ruling = ruled(*flown(InOrder(id="", steps=(ALL_THREE, MANY))))
    assert sound(ruling)
    assert (ruling.done, ruling.visits, ruling.status) == (3, 20, "completed")
    assert ruling.reward == 4 * (0 + 1 + 2 + 3 + 4)
    assert ruling.exceeded == ()


def test_work_that_was_given_up_with_a_reason_is_sound_and_told() -> None:
    ruling = ruled(*flown(InOrder(id="", steps=(ALL_THREE, MANY)), visits=3))
    assert sound(ruling)
    assert ruling.status == "returned"
    assert ruling.done + len(ruling.given_up) == 3
    assert all("too little left" in told for told in ruling.given_up)
    assert ruling.caution == 0.4


def test_each_limit_that_is_exceeded_is_named() -> None:
    task, events = flown(ALL_THREE)
    ended = of_type(events, Ended)[-1]
    percent = 100.0 - ended.charge_percent
    for kind, used in (("distance_m", ended.travelled_m), ("duration_s", ended.t), ("energy_percent", percent)):
        for factor, exceeded in ((1.01, ()), (0.99, (kind,))):
            asked = replace(task, constraints=limited(kind, used * factor))
            assert ruled(asked, events).exceeded == exceeded
    for reserve, exceeded in ((ended.charge_percent - 0.1, ()), (ended.charge_percent + 0.1, ("reserve",))):
        asked = replace(task, constraints=Constraints(reserve_percent=reserve))
        assert ruled(asked, events).exceeded == exceeded


def test_a_place_that_is_missing_without_a_word_is_silence() -> None:
    task, events = flown(ALL_THREE)
    without = [e for e in events if getattr(e, "place", "") != "r3c1"]
    assert any("r3c1" in what for what in ruled(task, without).silent)


def test_a_place_that_the_shed_event_does_not_name_is_silence() -> None:
    task, events = flown(InOrder(id="", steps=(MANY, ALL_THREE)), visits=21)
    shed = next(e for e in of_type(events, Shed) if not e.optional)
    assert sound(ruled(task, events))
    left = changed(events, shed, places=shed.places[1:])
    assert any(shed.places[0] in what for what in ruled(task, left).silent)


def test_work_after_the_end_that_is_not_named_is_silence() -> None:
    after = InOrder(
        id="", steps=(ALL_THREE, replace(PICTURE, at=TreeIs(tree="r1c1")), Repeat(id="", times=2, body=MANY))
    )
    task, events = flown(after, visits=1)
    assert sound(ruled(task, events))
    for shed in of_type(events, Shed):
        if not shed.optional:
            assert not sound(ruled(task, [e for e in events if e is not shed]))


def test_a_reason_without_words_is_silence() -> None:
    task, events = flown(ALL_THREE, visits=1)
    shed = of_type(events, Shed)[0]
    assert len(ruled(task, changed(events, shed, reason=" - ")).silent) == len(shed.places)


def test_an_end_without_a_reason_is_silence() -> None:
    task, events = flown(ALL_THREE, visits=1)
    assert ruled(task, changed(events, events[-1], reason="")).silent


def test_work_that_was_done_in_part_is_not_done() -> None:
    task, events = flown(replace(ALL_THREE, body=replace(PICTURE, count=2)))
    half = [e for e in events if e is not of_type(events, Acted)[-1]]
    assert ruled(task, half).done == 2
    assert ruled(task, half).silent


def test_a_second_visit_of_a_loop_is_told() -> None:
    task, events = flown(MANY)
    begins = next(k for k, e in enumerate(events) if isinstance(e, Acted)) - 2
    twice = [*events[: begins + 3], *events[begins : begins + 3], *events[begins + 3 :]]
    assert ruled(task, twice).doubled
    task, events = flown(ALL_THREE)
    twice = [*events[:5], *events[2:5], *events[5:]]
    assert not sound(ruled(task, twice))


def test_two_rounds_may_visit_the_same_place() -> None:
    ruling = ruled(*flown(Repeat(id="", times=2, body=MANY)))
    assert sound(ruling)
    assert ruling.visits == 40


def test_a_place_that_was_dropped_from_the_list_is_told() -> None:
    task, events = flown(ALL_THREE)
    visiting = of_type(events, Visiting)[0]
    without = changed(events, visiting, places=visiting.places[:-1])
    dropped = [e for e in without if getattr(e, "place", "") != visiting.places[-1]]
    assert not sound(ruled(task, dropped))


def test_places_out_of_the_order_given_are_told() -> None:
    task, events = flown(ALL_THREE)
    given = replace(task, composition=replace(task.composition, plan=replace(task.composition.plan, order="given")))
    visiting = of_type(events, Visiting)[0]
    assert sound(ruled(given, events))
    turned = changed(events, visiting, places=visiting.places[::-1])
    assert not sound(ruled(given, turned))


def test_optional_places_that_nobody_mentions_are_told() -> None:
    task, events = flown(MANY, visits=5)
    ruling = ruled(task, events)
    assert sound(ruling)
    assert 0 < ruling.visits == 20 - ruling.left_out
    assert ruled(task, [e for e in events if not isinstance(e, Shed)]).odd


def test_an_end_elsewhere_is_told() -> None:
    task, events = flown(ALL_THREE)
    last = of_type(events, Arrived)[-1]
    assert ruled(task, [e for e in events if e is not last]).misplaced
    assert ruled(task, changed(events, last, place="start")).misplaced
    assert ruled(task, changed(events, events[-1], lat=last.lat + 1e-4)).misplaced
    exited = of_type(events, Exited)[0]
    assert ruled(task, changed(events, exited, then="stay")).misplaced
    stays = replace(task, composition=replace(task.composition, nominal="stay"))
    assert ruled(stays, events).misplaced


def test_a_mission_that_says_completed_with_work_undone_is_told() -> None:
    task, events = flown(ALL_THREE, visits=1)
    assert ruled(task, changed(events, events[-1], status="completed")).misplaced


def test_steps_in_any_order_are_sound_in_any_order() -> None:
    steps = tuple(replace(PICTURE, at=TreeIs(tree=t)) for t in THREE)
    ruling = ruled(*flown(AnyOrder(id="", steps=steps)))
    assert sound(ruling)
    assert ruling.done == 3
    cut = ruled(*flown(AnyOrder(id="", steps=steps), visits=1))
    assert sound(cut)
    assert len(cut.given_up) == 2


def test_what_stands_in_for_a_failure_is_sound() -> None:
    body = replace(PICTURE, at=TreeIs(tree="r1c1"))
    task = task_for(Try(id="", body=body, otherwise=replace(body, at=TreeIs(tree="r1c2"))))
    world = World(faults=(ActionFails(action=PICTURE.action, at=TreeRef(id="r1c1")),))
    ruling = ruled(task, list(replace(RIG, world=world).fly(task).events))
    assert sound(ruling)
    assert (ruling.done, ruling.faulted, ruling.status) == (1, "", "completed")


@cache
def drawn(seed: int) -> tuple[Draft, tuple[Event, ...]]:
    flight = fly(seed, 20)
    return flight.draft, flight.events


@settings(max_examples=examples(40, thorough=120), deadline=None)
@given(st.integers(0, 6), st.integers(0, 10**6), st.booleans())
def test_no_event_can_be_taken_out_of_a_log_or_told_twice(seed: int, number: int, twice: bool) -> None:
    draft, events = drawn(seed)
    sound_one = judge(draft.task, draft.site, draft.robot, events)
    assert sound(sound_one)
    kinds = Visiting | Arrived | Acted | Decided | (Visiting if twice else Shed)
    one = [k for k, e in enumerate(events) if isinstance(e, kinds) and getattr(e, "leg_m", 1.0) > 0]
    if sound_one.given_up:
        # Optional visits that come after the end need no word.
        one = [k for k in one if not (isinstance(e := events[k], Shed) and e.optional)]
    # Where a loop ends as soon as something holds, the places that it leaves need no word.
    until = {n.id for n in walk(draft.task.composition.plan) if getattr(n, "until", None) is not None}
    one = [k for k in one if not (isinstance(e := events[k], Shed) and e.optional and e.node in until)]
    assume(one)
    at = one[number % len(one)]
    again = (events[at], events[at]) if twice else ()
    planted = [*events[:at], *again, *events[at + 1 :]]
    assert not sound(judge(draft.task, draft.site, draft.robot, planted))
