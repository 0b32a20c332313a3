"""Leaves that a robot must implement for an exported tree, with their ports: the ``TreeNodesModel``.

Control flow uses the nodes of BehaviorTree.CPP; only leaves are specific to this program: one for each action of the
robot and each kind of condition. Ports are derived from the dataclasses, as the XML of the Task is.
"""

from __future__ import annotations

from dataclasses import MISSING, dataclass
from typing import TYPE_CHECKING, Literal

from fieldhand.task.battery_condition import BatteryBelow
from fieldhand.task.capabilities import Capabilities, ChoiceParameter, NumberParameter
from fieldhand.task.codec_shapes import Attribute, shape_of
from fieldhand.task.codec_text import attribute_text, number_text
from fieldhand.task.conditions import Between, Compare, Level, TreeHas
from fieldhand.task.plan import Act, ForEach, OptionalStep, Pace, Recharge

if TYPE_CHECKING:
    from lxml.etree import _Element

BEGIN, GO_TO, RESOLVE, ORDER, ALLOWS, EXIT, FAULT, LIMIT, WORK, RECHARGE = (
    "BeginMission", "GoToPlace", "ResolvePlaces", "OrderSteps", "BudgetAllows", "TakeExit", "HandleFault", "LimitSpeed",
    "WorkAlong", "RechargeBattery",
)  # fmt: skip
#: The wait of Nav2, which waits for the seconds of its port.
WAIT, WAIT_PORT = "Wait", "wait_duration"
#: Leaves about all readings of a name: forget them, and test a condition on them.
BEGIN_SERIES, TEST_SERIES = "BeginReadings", "TestReadings"
#: Leaf of each kind of condition.
CONDITIONS: dict[type, str] = {
    Compare: "CompareReading",
    Between: "ReadingBetween",
    Level: "ReadingIs",
    TreeHas: "TreeHas",
    BatteryBelow: "BatteryBelow",
}
#: Port with the result of a condition whose reading was never taken, derived from the leaf's position.
IF_UNKNOWN = "if_unknown"
#: Fields that are not ports: the id is the node's name, ranges of the request are separate attributes.
_BESIDE = ("id", "said", "at_said")

PortDirection = Literal["input", "output"]


@dataclass(frozen=True, kw_only=True)
class Port:
    """A port of a leaf.

    Attributes:
        type: C++ type name.
        default: What holds where the port is not given; None where it must be.
        about: One-line description.
    """

    name: str
    type: str
    default: str | None = None
    direction: PortDirection = "input"
    about: str = ""


@dataclass(frozen=True, kw_only=True)
class Leaf:
    """A leaf: an action or a condition; or a decorator around one node."""

    id: str
    kind: Literal["Action", "Condition", "Decorator"]
    ports: tuple[Port, ...]


def port_name(attribute: str) -> str:
    """Return the port of a field, with underscores as usual in C++."""
    return attribute.replace("-", "_")


def plain_attributes(cls: type) -> tuple[Attribute, ...]:
    """Return the fields of a class that become ports, including those of its quantity."""
    shape = shape_of(cls)
    of_quantity = shape.head.attributes if shape.head is not None else ()
    return tuple(a for a in (*shape.attributes, *of_quantity) if a.field not in _BESIDE)


def leaves(capabilities: Capabilities) -> tuple[Leaf, ...]:
    """Return every leaf that a tree for this robot may contain."""
    frames = tuple(Port(name=n, type=_TEXT, about=f"<{n}> of the Task, as XML") for n in ("command", "constraints"))
    task = Port(name="task", type=_TEXT, about="Id of the Task")
    resources = Port(name="resources", type=_TEXT, default="", about="Robot and site that it was planned for, as XML")
    watches = Port(name="watches", type=_TEXT, default="", about="Conditions checked throughout the mission, as XML")
    timing = Port(name="timing", type=_TEXT, default="", about="When the mission runs, as XML")
    earlier = Port(name="earlier", type=_TEXT, default="", about="Earlier missions that the plan depends on, as XML")
    places = Port(name="places", type=_PLACES, direction="output", about="The places found, in the order to visit them")
    first = Port(name="places", type=_TEXT, about="First place of each step, as XML, in the order of the steps")
    order = Port(name="order", type=_STEPS, direction="output", about="Numbers of the steps from 1, best order first")
    node = Port(name="node", type=_TEXT, about="Name of the loop or step that the budget may leave out")
    then = Port(name="then", type=_TEXT, about="return_to_end, return_to_start or stay")
    work = Port(name="work", type=_TEXT, about="Work along rows, aisles or an area: <work-along> of the Task, as XML")
    exits = Port(name="exits", type=_TEXT, default="", about="What to do about each fault, as fault:exit")
    series = Port(name="reading", type=_TEXT, about="Name of the readings of which none is kept from before")
    tested = Port(name="condition", type=_TEXT, about="Condition on all readings of a name, as XML")
    ours = (
        Leaf(id=BEGIN, kind="Action", ports=(task, *frames, resources, watches, timing, earlier)),
        Leaf(id=GO_TO, kind="Action", ports=(_PLACE, _LABEL)),
        Leaf(id=RESOLVE, kind="Action", ports=(_SELECT, *_ports(ForEach, beside=("label",)), places)),
        Leaf(id=ORDER, kind="Action", ports=(first, order)),
        Leaf(id=BEGIN_SERIES, kind="Action", ports=(series,)),
        Leaf(id=EXIT, kind="Action", ports=(then,)),
        Leaf(id=RECHARGE, kind="Action", ports=_ports(Recharge)),
        Leaf(id=FAULT, kind="Action", ports=(exits,)),
        Leaf(id=WAIT, kind="Action", ports=(Port(name=WAIT_PORT, type="double", about="Seconds to stand still"),)),
        Leaf(id=LIMIT, kind="Decorator", ports=_ports(Pace)),
        Leaf(id=WORK, kind="Action", ports=(work,)),
        Leaf(
            id=ALLOWS, kind="Condition", ports=(node, Port(name="place", type=_TEXT, default=""), *_ports(OptionalStep))
        ),
    )
    test = Leaf(id=TEST_SERIES, kind="Condition", ports=(tested, _UNKNOWN))
    conditions = (Leaf(id=name, kind="Condition", ports=_condition_ports(cls)) for cls, name in CONDITIONS.items())
    return (
        *ours,
        *conditions,
        test,
        *(_action(name, capabilities) for name, a in capabilities.actions.items() if not a.is_implement),
    )


def models(capabilities: Capabilities) -> _Element:
    """Return the ``TreeNodesModel`` of a robot."""
    from lxml import etree

    root = etree.Element("TreeNodesModel")
    for leaf in leaves(capabilities):
        element = etree.SubElement(root, leaf.kind, ID=leaf.id)
        for port in leaf.ports:
            inside = etree.SubElement(element, f"{port.direction}_port", name=port.name, type=port.type)
            if port.default is not None:
                inside.set("default", port.default)
            inside.text = port.about or None
    return root


_TEXT, _PLACES, _STEPS, _READING = (
    "std::string", "std::shared_ptr<std::deque<std::string>>", "std::shared_ptr<std::deque<int>>",
    "std::map<std::string, double>",
)  # fmt: skip
_PLACE = Port(name="place", type=_TEXT, about="A place that was resolved, or a selector as XML")
_LABEL = Port(name="label", type=_TEXT, default="", about="Binds the place for later nodes")
_SELECT = Port(name="select", type=_TEXT, about="Selector, as XML")
_UNKNOWN = Port(name=IF_UNKNOWN, type="bool", default="false", about="What to answer where there is nothing to test")
_TYPES = {"integer": "int", "number": "double", "flag": "bool"}


def _ports(cls: type, *, beside: tuple[str, ...] = ()) -> tuple[Port, ...]:
    """Return input ports for the plain fields of a class."""
    found = []
    for attribute in plain_attributes(cls):
        if attribute.field in beside:
            continue
        name, kind = port_name(attribute.name), _TYPES.get(attribute.kind, _TEXT)
        default: str | None = None
        if attribute.default is not MISSING:
            default = "" if attribute.default is None else attribute_text(attribute, attribute.default)[attribute.name]
        found.append(Port(name=name, type=kind, default=default))
        if attribute.kind == "value":
            found.append(Port(name=port_name(f"{attribute.name}-as"), type=_TEXT, default="", about="text, or nothing"))
    return tuple(found)


def _condition_ports(cls: type) -> tuple[Port, ...]:
    shape = shape_of(cls)
    ports = [p for p in _ports(cls) if p.name != "reading"]
    if shape.head is not None:
        ports.insert(0, Port(name="quantity", type=_TEXT, about="What was measured"))
        ports.insert(0, Port(name="reading", type=_READING, about="The reading that is tested"))
    return (*ports, _UNKNOWN)


def _action(name: str, capabilities: Capabilities) -> Leaf:
    """Return the leaf of an action: the common ports, and the parameters of the action."""
    action = capabilities.actions[name]
    about = f"Measures {', '.join(action.measures)}" if action.measures else "Measures nothing"
    common = [p for p in _ports(Act) if p.name != "reading"]
    reading = Port(name="reading", type=_READING, default="", direction="output", about=about)
    parameters = (
        Port(name=key, type=_TEXT if isinstance(spec, ChoiceParameter) else "double", default="", about=_bounds(spec))
        for key, spec in action.parameters.items()
    )
    return Leaf(id=name, kind="Action", ports=(*common, reading, *parameters))


def _bounds(spec: NumberParameter | ChoiceParameter) -> str:
    if isinstance(spec, ChoiceParameter):
        return "One of " + ", ".join(spec.choices)
    low = "" if spec.minimum is None else f"from {number_text(spec.minimum)}"
    high = "" if spec.maximum is None else f"up to {number_text(spec.maximum)}"
    return " ".join(part for part in (low, high, spec.unit) if part)
