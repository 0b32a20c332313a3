"""A Task and its XML say the same thing."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import get_args

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fieldhand.errors import TaskError
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import Corners, Half, Here, Nearest, Trees, Where
from fieldhand.task.codec import decode, decode_draft, encode
from fieldhand.task.codec_shapes import FAMILIES, all_shapes, shape_of
from fieldhand.task.conditions import Condition, TreeHas
from fieldhand.task.frames import Budget, Command, Composition, Constraints, Task
from fieldhand.task.plan import Act, GoTo, If, InOrder, Node, StopMission
from fieldhand.task.schema import validate
from fieldhand.task.timing import DayTime, Schedule, StartTime, Timing
from fieldhand.task.watches import Watch, WatchCondition
from fieldhand.testing.generated.tasks import ROVER, Parts, numbers, texts, values

PARTS = Parts(ROVER)
SLOW = (HealthCheck.too_slow, HealthCheck.data_too_large)


def task_of(plan: Node, request: str = "") -> Task:
    return Task(id="t", command=Command(request=request), composition=Composition(plan=plan))


def holding(part: object) -> Task:
    """A Task that holds one part."""
    if isinstance(part, Selector):
        return task_of(GoTo(id="n1", place=part))
    if isinstance(part, get_args(Timing)):
        return replace(task_of(StopMission(id="n1")), timing=part)
    if isinstance(part, get_args(Condition)):
        return task_of(If(id="n1", condition=part, then=StopMission(id="n2")))
    if isinstance(part, get_args(WatchCondition)):
        composition = Composition(plan=StopMission(id="n1"), watches=(Watch(condition=part, response="wait"),))
        return replace(task_of(StopMission(id="n1")), composition=composition)
    return task_of(part)


@settings(max_examples=120, deadline=None, suppress_health_check=SLOW)
@given(PARTS.tasks())
def test_whole_tasks_come_back_equal_and_their_documents_are_the_same_and_valid(task):
    document = encode(task)
    assert decode(document) == task
    assert encode(decode(document)) == document
    assert validate(document, ROVER) == ()


@pytest.mark.parametrize("cls", [c for family in FAMILIES for c in family], ids=lambda c: c.__name__)
@settings(max_examples=15, deadline=None, suppress_health_check=SLOW)
@given(data=st.data())
def test_every_selector_condition_and_node_comes_back_equal(cls, data):
    task = holding(data.draw(PARTS.instance(cls, 2)))
    assert decode(encode(task)) == task


@settings(max_examples=100, deadline=None)
@given(values)
def test_a_value_keeps_its_type(value):
    task = holding(TreeHas(attribute="x", test="eq", value=value))
    found = decode(encode(task)).composition.plan.condition.value
    assert found == value
    assert type(found) is type(value)


@settings(max_examples=200, deadline=None)
@given(numbers)
def test_every_finite_number_comes_back_to_the_last_bit(number):
    found = decode(encode(holding(Where(attribute="x", test="lt", value=number)))).composition.plan.place.value
    assert repr(found) == repr(number)


@settings(max_examples=100, deadline=None)
@given(texts)
def test_a_request_comes_back_word_for_word(request):
    assert decode(encode(task_of(StopMission(id="n1"), request))).command.request == request


def test_what_is_default_is_not_written():
    document = encode(holding(Corners(of=Half(side="north")))).decode()
    assert "<trees/>" not in document
    assert "which=" not in document
    assert "<constraints" not in document
    assert '<corners>\n          <half side="north"/>' in document


def test_the_order_of_the_elements_of_a_node_does_not_matter():
    task = holding(Nearest(to=Here(), of=Half(side="north")))
    lines = encode(task).decode().splitlines()
    start, end = (next(i for i, line in enumerate(lines) if tag in line) for tag in ("<to>", "</to>"))
    after = next(i for i, line in enumerate(lines) if "</of>" in line) + 1
    moved = lines[:start] + lines[end + 1 : after] + lines[start : end + 1] + lines[after:]
    assert moved != lines
    assert decode("\n".join(moved).encode()) == task


def test_a_prefix_comments_and_a_schema_location_change_nothing():
    document = b"""<f:task xmlns:f="urn:fieldhand:task:1" id="t" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
      xsi:schemaLocation="urn:fieldhand:task:1 task.xsd"><!-- for tomorrow --><f:command><f:request>go</f:request>
      </f:command><f:task-composition><f:plan><f:stop id="n1"/></f:plan></f:task-composition></f:task>"""
    assert decode(document) == task_of(StopMission(id="n1"), "go")


def test_the_default_selector_may_be_written_out():
    document = encode(holding(Corners())).replace(b"<corners/>", b"<corners><trees/></corners>")
    assert decode(document) == holding(Corners(of=Trees()))


def test_a_draft_may_leave_out_what_is_derived():
    draft = decode_draft(
        b"""<task xmlns="urn:fieldhand:task:1"><task-composition>
          <plan><sequence><act><read_co2/><at><corners which="nw"/></at></act><stop/></sequence></plan>
          <exits nominal="stay"/></task-composition>
          <constraints><budget kind="distance_m" limit="100"/></constraints></task>"""
    )
    act = Act(id="", action="read_co2", at=Corners(which=("nw",)))
    assert draft.plan == InOrder(id="", steps=(act, StopMission(id="")))
    assert (draft.nominal, draft.faulted, draft.request, draft.assumptions) == ("stay", (), "", ())
    assert draft.constraints.budgets[0].limit == 100


@settings(max_examples=30, deadline=None, suppress_health_check=SLOW)
@given(PARTS.tasks())
def test_a_whole_task_is_a_draft_too(task):
    document = encode(task)
    draft = decode_draft(document)
    assert validate(document, ROVER, draft=True) == ()
    assert (draft.plan, draft.request) == (task.composition.plan, task.command.request)
    assert (draft.faulted, draft.nominal) == (task.composition.faulted, task.composition.nominal)
    assert (draft.constraints, draft.assumptions) == (task.constraints, task.command.assumptions)


def test_the_names_of_the_elements_of_one_class_differ():
    for cls, shape in all_shapes().items():
        written = [a.name for a in shape.attributes] + [c.name for c in shape.children]
        assert len(written) == len(set(written)), cls
        assert shape_of(cls) is shape


@pytest.mark.parametrize(
    ("task", "words"),
    [
        (task_of(StopMission(id="n1"), "ring \x07"), "U+0007"),
        (task_of(StopMission(id="n1"), "half a \ud83c tree"), "U+D83C"),
        (task_of(StopMission(id="n\x00")), "U+0000"),
        (holding(Where(attribute="x", test="lt", value=float("inf"))), "not a finite number"),
        (holding(Where(attribute="x", test="lt", value=float("nan"))), "not a finite number"),
        (task_of(Act(id="n1", action="take picture")), "cannot be the name"),
        (task_of(Act(id="n1", action="at")), "cannot be the name"),
        (task_of(Act(id="n1", action="a", parameters=(("x y", 1.0),))), "not a name"),
        (task_of(Act(id="n1", action="a", parameters=(("x", 1.0), ("x", 2.0)))), "is given twice"),
        (task_of(Act(id="n1", action="a", parameters=(("x", "10"),))), "would be read as a number"),
        (task_of(Act(id="n1", action="a", count=10**30)), "too many digits"),
        (task_of(StopMission(id="n1"), "x" * 4_000_000), "split the mission"),
    ],
)
def test_what_xml_cannot_hold_is_refused_in_one_line(task, words):
    with pytest.raises(TaskError, match=re.escape(words)) as refused:
        encode(task)
    assert "\n" not in str(refused.value)


def test_a_plan_nested_too_deep_is_refused_by_encode():
    plan: Node = StopMission(id="n")
    for _ in range(5000):
        plan = InOrder(id="n", steps=(plan,))
    with pytest.raises(TaskError, match="nest less deeply"):
        encode(task_of(plan))


def test_sixty_ifs_in_one_another_are_not_too_deep():
    plan: Node = StopMission(id="n")
    for _ in range(60):
        plan = If(id="n", condition=TreeHas(attribute="a", test="eq", value=1.0), then=InOrder(id="s", steps=(plan,)))
    assert decode(encode(task_of(plan))) == task_of(plan)


def test_the_ranges_of_words_are_attributes_and_may_be_left_out():
    told = Task(
        id="t",
        command=Command(request="Please stop, at most 5 m, 9 % left, at the end.", no_part=((0, 6),)),
        composition=Composition(plan=StopMission(id="n1", said=((7, 11),)), nominal="stay", nominal_said=((36, 46),)),
        constraints=Constraints(
            budgets=(Budget(kind="distance_m", limit=5, said=((13, 24),)),),
            reserve_percent=9,
            reserve_said=((26, 34),),
        ),
    )
    document = encode(told)
    assert decode(document) == told
    older = re.sub(rb' (no-part|said|nominal-said|reserve-said)="[^"]*"', b"", document)
    assert len(older) < len(document)
    assert decode(older).constraints.budgets == (Budget(kind="distance_m", limit=5),)
    assert validate(older, ROVER) == ()


MORNING = DayTime(clock="06:30")


@pytest.mark.parametrize(
    "timing",
    [
        StartTime(day="tomorrow", not_before=MORNING, not_after=DayTime(sun="sunrise", offset_min=-30), said=((0, 4),)),
        StartTime(done_by=DayTime(sun="dusk"), time_zone="Europe/Rome"),
        Schedule(at=(MORNING,), weekdays=("mon", "fri"), every_days=2, first_day="--03-01", last_day="2027-12-31"),
        Schedule(at=(DayTime(sun="sunrise"),), late_min=1440, done_by=DayTime(sun="sunset"), last_day="today"),
        Schedule(
            every_min=120, until=DayTime(clock="18:00"), late_min=5, missed="late", done_by_min=90, said=((0, 4),)
        ),
    ],
)
def test_times_are_an_element_of_their_own(timing: StartTime | Schedule) -> None:
    plain = task_of(StopMission(id="n1"))
    told = replace(plain, timing=timing)
    assert decode(encode(told)) == told
    assert validate(encode(told), ROVER) == ()
    assert b"timing" not in encode(plain)
