"""Trees that cannot be a Task are refused with line and node, and before they cost anything."""

from __future__ import annotations

import pytest

from fieldhand.errors import TaskError
from fieldhand.exchange.btcpp import read_tree
from fieldhand.exchange.btcpp.nodes import MAX_NODES
from fieldhand.task.codec_xml import MAX_BYTES
from fieldhand.testing.generated.tasks import ROVER


def tree(inside: str, head: str = "") -> bytes:
    return f'{head}<root BTCPP_format="4">\n<BehaviorTree ID="Main">\n{inside}\n</BehaviorTree></root>'.encode()


@pytest.mark.parametrize(
    ("inside", "said"),
    [
        ("<fly_home/>", r"line 3, <fly_home>: the node 'fly_home' is unknown"),
        ("<read_c02/>", r"did you mean read_co2\?"),
        ('<Action ID="dance"/>', r"line 3, <dance>"),
        ("<Sequence>\n<ReactiveSequence/></Sequence>", r"line 4, <ReactiveSequence>"),
        ('<read_co2 speed="9"/>', r"the port 'speed' is unknown"),
        ('<read_co2 count="many"/>', r"count: 'many' is not a whole number"),
        ('<read_co2 _skipIf="x == 1"/>', r"the script _skipIf"),
        ('<Sequence><Script code="a := 1"/><AlwaysFailure/></Sequence>', r"the script 'a := 1'"),
        ('<Repeat num_cycles="-1"><read_co2/></Repeat>', r"num_cycles is '-1'"),
        ('<Repeat num_cycles="2"/>', r"contains 0 nodes, needs 1"),
        ("<Fallback><read_co2/></Fallback>", r"fewer than two"),
        ("<IfThenElse><TreeHas/><read_co2/></IfThenElse>", r"third node"),
        ('<GoToPlace place="tree 5"/>', r"'tree 5' is not a selector"),
        ('<GoToPlace place="&lt;trees/&gt;&lt;trees/&gt;"/>', r"contains 2 selectors"),
        ('<GoToPlace place="&lt;moon/&gt;"/>', r"GoToPlace>, place, line 1, <moon>: is unknown"),
        ('<GoToPlace place="&lt;!DOCTYPE a&gt;"/>', r"not a selector|DOCTYPE"),
        ('<SubTree ID="Main"/>', r"the tree 'Main' contains itself"),
        ('<SubTree ID="Other"/>', r"there is no tree 'Other'"),
        ("<AlwaysSuccess/>", r"<AlwaysSuccess> is not allowed here"),
        ('<IfThenElse><CompareReading reading="r1" quantity="co2" test="lt" value="1" unit="ppm"/><read_co2/>'
         "<AlwaysSuccess/></IfThenElse>", r"names no blackboard entry"),
    ],
)  # fmt: skip
def test_what_a_task_cannot_say_is_refused(inside: str, said: str) -> None:
    with pytest.raises(TaskError, match=said):
        read_tree(tree(inside), ROVER, source="tree.xml")


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "empty"),
        (b"<root", "not well-formed"),
        (b"\xff\xfe", "UTF-8"),
        (b"<task/>", "is not a tree"),
        (b'<root main_tree_to_execute="A"/>', "version 3"),
        (b'<root BTCPP_format="4" main_tree_to_execute="A"/>', "trees here: none"),
        (b'<root BTCPP_format="4"><include path="/etc/passwd"/></root>', "another file"),
        (tree("<read_co2/>", '<!DOCTYPE root [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;">]>'), "DOCTYPE"),
        (tree("<read_co2/>", '<!DOCTYPE root SYSTEM "http://localhost/x.dtd">'), "DOCTYPE"),
        (tree("<Sequence>" * 5_000 + "</Sequence>" * 5_000), "nested|well-formed|depth"),
        (tree("<Inverter>" * 199 + "</Inverter>" * 199), "nested"),
        (b" " * MAX_BYTES + tree("<read_co2/>"), "bytes"),
    ],
    ids=lambda v: v if isinstance(v, str) else "",
)
def test_what_is_no_tree_is_refused_before_it_costs_anything(data: bytes, said: str) -> None:
    with pytest.raises(TaskError, match=said):
        read_tree(data, ROVER)


def test_subtrees_that_double_do_not_explode() -> None:
    doubled = "".join(
        f'<BehaviorTree ID="T{k}"><Sequence><SubTree ID="T{k + 1}"/><SubTree ID="T{k + 1}"/></Sequence></BehaviorTree>'
        for k in range(40)
    )
    last = '<BehaviorTree ID="T40"><read_co2/></BehaviorTree>'
    text = f'<root BTCPP_format="4" main_tree_to_execute="T0">{doubled}{last}</root>'
    with pytest.raises(TaskError, match=f"more than {MAX_NODES:,} nodes"):
        read_tree(text.encode(), ROVER)


def test_subtrees_in_subtrees_nest_no_deeper_than_a_task() -> None:
    chain = "".join(
        f'<BehaviorTree ID="T{k}"><Sequence><SubTree ID="T{k + 1}"/></Sequence></BehaviorTree>' for k in range(400)
    )
    last = '<BehaviorTree ID="T400"><read_co2/></BehaviorTree>'
    text = f'<root BTCPP_format="4" main_tree_to_execute="T0">{chain}{last}</root>'
    with pytest.raises(TaskError, match="more than 200 nodes are nested"):
        read_tree(text.encode(), ROVER)
    deep = tree("<Sequence>" * 150 + "<read_co2/>" + "</Sequence>" * 150)
    assert len(read_tree(deep, ROVER).command.goals) == 1
