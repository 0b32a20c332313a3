"""A Task exported as a tree and imported again is the same Task; a tree that was drawn or changed is read, too."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, reject, settings

from fieldhand.errors import TaskError
from fieldhand.exchange.btcpp import read_tree, write_tree
from fieldhand.places.selectors import Corners, Trees
from fieldhand.task import plan as p
from fieldhand.task.build import make_task
from fieldhand.task.conditions import AllOf, Compare, Not, TreeHas
from fieldhand.task.frames import Task
from fieldhand.testing.generated.tasks import ROVER, Parts

MEASURES = {"read_co2": (("co2", "ppm"),)}
WET = Compare(reading="r", quantity="co2", test="gt", value=400, unit="ppm")


def carried(task: Task) -> bytes:
    """The tree of a Task, if a tree can carry it; it says so if not."""
    try:
        return write_tree(task, ROVER)
    except TaskError as error:
        refused = str(error)
    assert "a tree cannot contain" in refused
    return reject()


@given(Parts(ROVER).tasks())
@settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
def test_a_task_comes_back(task: Task) -> None:
    document = carried(task)
    again = read_tree(document, ROVER)
    assert again == task
    assert write_tree(again, ROVER) == document


def drawn(inside: str, **more: str) -> p.Node:
    """The plan of a tree that an editor drew around ``inside``."""
    text = f'<root BTCPP_format="4"><BehaviorTree ID="Main">{inside}</BehaviorTree></root>'
    return read_tree(text.encode(), ROVER, **more).composition.plan  # type: ignore[arg-type]


def test_both_ways_to_write_a_leaf_mean_the_same() -> None:
    assert drawn('<Sequence><take_picture view="trunk"/><read_co2/></Sequence>') == drawn(
        '<Sequence><Action ID="take_picture" name="take_picture" view="trunk"/><Action ID="read_co2"/></Sequence>'
    )


def test_a_drive_with_the_action_behind_it_is_one_act() -> None:
    plan = drawn('<Sequence><GoToPlace place="&lt;corners which=&quot;nw&quot;/&gt;"/><read_co2 count="2"/></Sequence>')
    assert plan == p.Act(id="n1", action="read_co2", at=Corners(which=("nw",)), count=2)


def test_a_fallback_of_three_is_a_try_within_a_try() -> None:
    plan = drawn("<Fallback><read_co2/><take_picture/><probe_soil/></Fallback>")
    assert isinstance(plan, p.Try)
    assert isinstance(plan.otherwise, p.Try)
    assert [n.action for n in p.walk(plan) if isinstance(n, p.Act)] == ["read_co2", "take_picture", "probe_soil"]


def test_a_subtree_stands_in_its_place() -> None:
    text = """<root BTCPP_format="4" main_tree_to_execute="A">
      <BehaviorTree ID="A"><Sequence><SubTree ID="B"/><SubTree ID="B"/></Sequence></BehaviorTree>
      <BehaviorTree ID="B"><read_co2/></BehaviorTree></root>"""
    task = read_tree(text.encode(), ROVER)
    assert [n.id for n in p.walk(task.composition.plan)] == ["n1", "n2", "n3"]
    assert [g.node for g in task.command.goals] == ["n2", "n3"]


def test_what_follows_from_a_changed_plan_is_made_anew() -> None:
    steps = (p.Act(id="", action="take_picture"), p.Act(id="", action="read_co2"))
    task = make_task(request="both", plan=p.InOrder(id="", steps=steps), measures=MEASURES)
    changed = write_tree(task, ROVER).replace(b'<take_picture name="n2"/>', b"")
    found = read_tree(changed, ROVER)
    assert found.command.request == "both"
    assert [(g.node, g.action) for g in found.command.goals] == [("n2", "read_co2")]


def test_what_is_unknown_holds_neither_way() -> None:
    # Under one inverter a leaf without a reading answers yes, under two no: kept by where it stands.
    bare = AllOf(conditions=(WET, Not(condition=Not(condition=TreeHas(attribute="v", test="eq", value="x")))))
    plan = p.If(id="", condition=Not(condition=bare), then=p.Act(id="", action="read_co2"))
    document = write_tree(make_task(request="", plan=plan, measures=MEASURES), ROVER).decode()
    leaves = [line for line in document.splitlines() if "<CompareReading" in line or "<TreeHas" in line]
    assert len(leaves) == 2
    assert all('if_unknown="true"' in leaf for leaf in leaves)


@pytest.mark.parametrize("text", ["{x}", " {a b} "])
def test_text_in_braces_is_not_carried(text: str) -> None:
    plan = p.ForEach(id="", select=Trees(), reward=text, body=p.Act(id="", action="read_co2"))
    with pytest.raises(TaskError, match=r"n1: .*blackboard entry"):
        write_tree(make_task(request="", plan=plan, measures=MEASURES), ROVER)
