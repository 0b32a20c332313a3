"""An exported tree obeys the rules that BehaviorTree.CPP documents, held by code that knows nothing of the writer.

The rules: XML format 4 with one tree to execute; names of node types and ports; how many children each control and
decorator has; every port that stands at a node is in its model, every port of the model without a default stands there.
scripts/btcpp_acceptance.py holds the library itself against it.
"""

from __future__ import annotations

import re

from hypothesis import HealthCheck, assume, given, settings
from lxml import etree

from fieldhand.errors import TaskError
from fieldhand.exchange.btcpp import write_tree
from fieldhand.task.frames import Task
from fieldhand.testing.generated.tasks import ROVER, Parts

FORBIDDEN = re.compile(r"[\s<>&\"'/\\:*?|.\x00-\x1f\x7f]")
#: Of the library's own nodes: least and most children, and ports.
LIBRARY = {
    "Sequence": (1, 9999, ()),
    "Fallback": (1, 9999, ()),
    "IfThenElse": (2, 3, ()),
    "Repeat": (1, 1, ("num_cycles",)),
    "Inverter": (1, 1, ()),
    "ForceSuccess": (1, 1, ()),
    "LoopString": (1, 1, ("queue", "value", "if_empty")),
    "LoopInt": (1, 1, ("queue", "value", "if_empty")),
    "Script": (0, 0, ("code",)),
    "AlwaysSuccess": (0, 0, ()),
    "AlwaysFailure": (0, 0, ()),
}
AROUND = ("_description", "_skipIf", "_successIf", "_failureIf", "_said", "_at_said")


@given(Parts(ROVER).tasks())
@settings(deadline=None, max_examples=15, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
def test_the_documented_rules_hold(task: Task) -> None:
    try:
        root = etree.fromstring(write_tree(task, ROVER))
    except TaskError:
        assume(False)
    assert root.tag == "root"
    assert root.get("BTCPP_format") == "4"
    assert [child.tag for child in root] == ["BehaviorTree", "TreeNodesModel"]
    tree, models = root
    assert tree.get("ID") == root.get("main_tree_to_execute")
    assert len(tree) == 1
    known, around = {}, set()
    for model in models:
        assert model.tag in ("Action", "Condition", "Decorator")
        around |= {model.get("ID")} if model.tag == "Decorator" else set()
        name = model.get("ID")
        assert name not in known | LIBRARY.keys()
        assert name not in ("", "Root", "root")
        assert not FORBIDDEN.search(name)
        ports = {}
        for port in model:
            assert port.tag in ("input_port", "output_port", "inout_port")
            assert port.get("name") not in ("", "ID", "name", *ports)
            assert re.match("[A-Za-z]", port.get("name"))
            assert not FORBIDDEN.search(port.get("name"))
            ports[port.get("name")] = port.get("default")
        known[name] = ports
    for node in tree.iterdescendants():
        given_ = {key for key in node.attrib if key != "name" and not key.startswith("_")}
        assert {key for key in node.attrib if key.startswith("_")} <= set(AROUND)
        if node.tag in LIBRARY:
            least, most, ports_ = LIBRARY[node.tag]
            assert least <= len(node) <= most
            assert given_ == set(ports_)
        else:
            assert len(node) == (node.tag in around)
            assert given_ <= known[node.tag].keys()
            assert {key for key, default in known[node.tag].items() if default is None} <= given_
