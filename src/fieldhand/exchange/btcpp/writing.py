"""Export of a Task as a tree of BehaviorTree.CPP v4.

Every plan node is one element whose ``name`` is the node's id; elements without a name are auxiliary. ``_said``
contains the ranges of the request that the node came from, and ``_description`` the words themselves.

Blackboard entries: ``n2_places`` and ``n2_place`` of a loop, ``n2_done`` once its condition held, ``n5_order`` and
``n5_step`` of steps in any order, ``reading_NAME``, and ``mission_exit``: empty until a stop takes an exit. A stop
fails, so that nothing after it is done; no fallback catches that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from fieldhand.errors import TaskError
from fieldhand.exchange.btcpp.vocabulary import (
    ALLOWS,
    BEGIN,
    BEGIN_SERIES,
    CONDITIONS,
    EXIT,
    FAULT,
    GO_TO,
    IF_UNKNOWN,
    LIMIT,
    ORDER,
    RECHARGE,
    RESOLVE,
    TEST_SERIES,
    WAIT,
    WAIT_PORT,
    WORK,
    models,
    plain_attributes,
    port_name,
)
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import Here
from fieldhand.task import plan as p
from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown
from fieldhand.task.battery_condition import BatteryBelow
from fieldhand.task.capabilities import Capabilities
from fieldhand.task.codec import encode_parts
from fieldhand.task.codec_shapes import Attribute
from fieldhand.task.codec_text import attribute_text, hidden_character, number_text
from fieldhand.task.codec_xml import MAX_BYTES, MAX_DEPTH
from fieldhand.task.conditions import AllOf, AnyOf, Condition, Not, TreeHas
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from lxml.etree import _Element

MAIN_TREE = "Mission"
EXIT_ENTRY = "mission_exit"


def write_tree(task: Task, capabilities: Capabilities) -> bytes:
    """Return a Task as an XML document for BehaviorTree.CPP 4, Groot2 and Nav2.

    Args:
        task: Task that this robot can carry out.
        capabilities: Capabilities of the robot, which define the leaves described in the document.

    Raises:
        TaskError: The Task contains something that the document cannot represent; the message names the node.
    """
    from lxml import etree

    root = etree.Element("root", BTCPP_format="4", main_tree_to_execute=MAIN_TREE)
    etree.SubElement(root, "BehaviorTree", ID=MAIN_TREE).append(_TreeWriter(task).mission())
    root.append(models(capabilities))
    etree.indent(root)
    data: bytes = etree.tostring(root, xml_declaration=True, encoding="UTF-8") + b"\n"
    if len(data) > MAX_BYTES:
        raise TaskError(f"the tree has {len(data)} bytes, more than {MAX_BYTES}", advice="split the mission")
    deepest = max(sum(1 for _ in e.iterancestors()) for e in root.iter())
    if deepest >= MAX_DEPTH:
        raise TaskError(f"the tree nests more than {MAX_DEPTH} elements", advice="nest less deeply")
    return data


class _TreeWriter:
    """Writer of the nodes of one Task."""

    def __init__(self, task: Task) -> None:
        self._task = task
        nodes = list(p.walk(task.composition.plan))
        self._entry = {id(node): f"n{k}" for k, node in enumerate(nodes, start=1)}
        if len({node.id for node in nodes}) < len(nodes):
            raise TaskError("nodes of the plan share an id", advice="give each node an id of its own")

    def mission(self) -> _Element:
        """Return the whole mission: metadata, plan and exits."""
        task, composition = self._task, self._task.composition
        begin = _element(
            BEGIN,
            task=task.id,
            command=encode_parts([task.command]),
            constraints=encode_parts([task.constraints]),
            watches=encode_parts(composition.watches),
            timing=encode_parts([] if task.timing is None else [task.timing]),
            earlier=encode_parts([] if task.earlier is None else [task.earlier]),
            resources=encode_parts(task.resources),
        )
        stopped = _element(EXIT, then=composition.nominal)
        stopped.set("_failureIf", f"{EXIT_ENTRY} != 'nominal'")
        exits = " ".join(f"{e.fault}:{e.then}" for e in composition.faulted)
        done = _element(EXIT, then=composition.nominal)
        _set(done, _said(composition.nominal_said), EXIT)
        over = _element("Fallback", stopped, _element(FAULT, exits=exits))
        return _element(
            "Sequence",
            begin,
            _script(f"{EXIT_ENTRY} := ''"),
            _element("IfThenElse", self.node(composition.plan), done, over),
        )

    def node(self, node: p.Node) -> _Element:
        """Return the element of a plan node."""
        element = self._of(node)
        quoted = " ... ".join(self._task.command.request[a:b] for a, b in node.said)
        if not node.id:
            raise TaskError("a node of the plan has no id", where=type(node).__name__, advice="give it one")
        _set(element, {"name": node.id, "_description": quoted} | _said(node.said), node.id)
        if node.at_said:
            _set(element, {f"_at{key}": text for key, text in _said(node.at_said).items()}, node.id)
        return element

    def _of(self, node: p.Node) -> _Element:
        entry = self._entry[id(node)]
        match node:
            case p.InOrder(steps=steps):
                return _element("Sequence", *[self.node(s) for s in steps] or (_element("AlwaysSuccess"),))
            case p.AnyOrder():
                return self._any_order(node, entry)
            case p.ForEach():
                return self._for_each(node, entry)
            case p.Repeat(until=None):
                rounds = _element("Repeat", self.node(node.body), num_cycles=str(node.times))
                return _element("Sequence", *_begin_series(node), rounds) if node.collects else rounds
            case p.Repeat():
                return self._repeat_until(node, entry)
            case p.If(condition=condition, then=then, otherwise=otherwise):
                other = _element("AlwaysSuccess") if otherwise is None else self.node(otherwise)
                return _element("IfThenElse", self._condition(condition, node.id), self.node(then), other)
            case p.Try(body=body, otherwise=otherwise):
                instead = self.node(otherwise)
                instead.set("_failureIf", f"{EXIT_ENTRY} != ''")
                return _element("Fallback", self.node(body), instead)
            case p.OptionalStep(body=body):
                allows = _element(ALLOWS, **(_ports(node, node.id) | {"node": node.id}))
                return _element("IfThenElse", allows, self.node(body), _element("AlwaysSuccess"))
            case p.GoTo(place=place):
                return _element(GO_TO, **(_ports(node, node.id) | {"place": encode_parts([place])}))
            case p.Act():
                return self._act(node)
            case p.Wait(seconds=seconds):
                return _element(WAIT, **{WAIT_PORT: number_text(seconds)})
            case p.Pace(body=body):
                return _element(LIMIT, self.node(body), **_ports(node, node.id))
            case p.WorkAlong():
                return _element(WORK, work=encode_parts([replace(node, said=(), along_said=())]))
            case p.Recharge():
                return _element(RECHARGE, **_ports(node, node.id))
            case p.StopMission(exit=taken):
                # No script after the node: it would also run if a fallback skips the node.
                return _element("Sequence", _script(f"{EXIT_ENTRY} := '{taken}'"), _element("AlwaysFailure"))

    def _any_order(self, node: p.AnyOrder, entry: str) -> _Element:
        """Return a leaf that computes the best order, followed by a loop over the numbered steps."""
        steps = []
        for number, step in enumerate(node.steps, start=1):
            one = self.node(step)
            one.set("_skipIf", f"{entry}_step != {number}")
            steps.append(one)
        places = encode_parts([_first_place(step) for step in node.steps])
        order = _element(ORDER, places=places, order=f"{{{entry}_order}}")
        body = _element("Sequence", *steps or (_element("AlwaysSuccess"),))
        return _element("Sequence", order, _loop("LoopInt", body, entry, "order", "step"))

    def _for_each(self, node: p.ForEach, entry: str) -> _Element:
        select = {"select": encode_parts([node.select]), "places": f"{{{entry}_places}}"}
        resolve = _element(RESOLVE, **(_ports(node, node.id, beside=("label",)) | select))
        go = {"place": f"{{{entry}_place}}"} | ({"label": _plain(node.label, node.id)} if node.label else {})
        visit = _element("Sequence", _element(GO_TO, **go), self.node(node.body))
        before, test = self._until(node.until, entry, node.id)
        visit.extend(test)
        if node.optional:
            allows = _element(ALLOWS, node=node.id, place=f"{{{entry}_place}}")
            visit = _element("IfThenElse", allows, visit, _element("AlwaysSuccess"))
        if node.until is not None:
            visit.set("_successIf", f"{entry}_done")
        return _element("Sequence", resolve, *before, _loop("LoopString", visit, entry, "places", "place"))

    def _repeat_until(self, node: p.Repeat, entry: str) -> _Element:
        before, test = self._until(node.until, entry, node.id)
        once = _element("Sequence", self.node(node.body), *test)
        once.set("_successIf", f"{entry}_done")
        rounds = _element("Repeat", once, num_cycles=str(node.times))
        return _element("Sequence", *_begin_series(node), *before, rounds)

    def _until(self, until: Condition | None, entry: str, where: str) -> tuple[list[_Element], list[_Element]]:
        """Return the nodes before a loop and at the end of each iteration by which a condition ends it."""
        if until is None:
            return [], []
        held = _element("Sequence", self._condition(until, where), _script(f"{entry}_done := true"))
        return [_script(f"{entry}_done := false")], [_element("ForceSuccess", held)]

    def _act(self, node: p.Act) -> _Element:
        """Return a drive to the place, if one is given, and the action."""
        ports = _ports(node, node.id, beside=("reading", "label") if node.at is not None else ("reading",))
        if node.reading:
            ports["reading"] = _reading(node.reading, node.id)
        for key, value in node.parameters:
            if key in ports or key in ("name", "ID", "count", "label", "reading"):
                raise TaskError(f"a tree cannot contain a parameter called {key!r}", where=node.id)
            ports[key] = _plain(value, node.id) if isinstance(value, str) else number_text(value)
        act = _element(node.action, **ports)
        if node.at is None:
            return act
        go = {"place": encode_parts([node.at])} | ({"label": _plain(node.label, node.id)} if node.label else {})
        return _element("Sequence", _element(GO_TO, **go), act)

    def _condition(self, condition: Condition, where: str, *, negated: bool = False) -> _Element:
        """Return a condition as leaves under Sequence (all), Fallback (any) and Inverter (not).

        An unknown condition is false, and so is its negation: a leaf under an odd number of inverters therefore returns
        true if it has no reading.
        """
        match condition:
            case AllOf(conditions=inner):
                parts = [self._condition(c, where, negated=negated) for c in inner]
                return _element("Sequence", *parts or (_element("AlwaysSuccess"),))
            case AnyOf(conditions=inner):
                parts = [self._condition(c, where, negated=negated) for c in inner]
                return _element("Fallback", *parts or (_element("AlwaysFailure"),))
            case Not(condition=one):
                return _element("Inverter", self._condition(one, where, negated=not negated))
            case Aggregate() | CountReadings() | MeanKnown() | CompareSeries():
                unknown = {IF_UNKNOWN: "true"} if negated else {}
                return _element(TEST_SERIES, condition=encode_parts([condition]), **unknown)
            case _:
                ports = _ports(condition, where)
                if not isinstance(condition, TreeHas | BatteryBelow):
                    ports |= {"reading": _reading(condition.reading, where), "quantity": condition.quantity}
                unknown = {IF_UNKNOWN: "true"} if negated else {}
                return _element(CONDITIONS[type(condition)], **ports, **unknown)


def _begin_series(node: p.Repeat) -> tuple[_Element, ...]:
    """Return the leaf that begins the series of a repeat anew, if it has one."""
    return (_element(BEGIN_SERIES, reading=_plain(node.collects, node.id)),) if node.collects else ()


def _loop(kind: str, body: _Element, entry: str, queue: str, value: str) -> _Element:
    ports = {"queue": f"{{{entry}_{queue}}}", "value": f"{{{entry}_{value}}}", "if_empty": "SUCCESS"}
    return _element(kind, body, **ports)


def _script(code: str) -> _Element:
    return _element("Script", code=code)


def _first_place(step: p.Node) -> Selector:
    return next((node.selector for node in p.walk(step) if node.selector is not None), Here())


def _element(kind: str, *children: _Element, **ports: str) -> _Element:
    from lxml import etree

    element = etree.Element(kind)
    _set(element, {key: text for key, text in ports.items() if text}, kind)
    element.extend(children)
    return element


def _set(element: _Element, attributes: dict[str, str], where: str) -> None:
    for key, text in attributes.items():
        character = hidden_character(text, lines=True)
        if character:
            raise TaskError(f"{key} holds the character {character}, which a tree cannot hold", where=where)
        if text or key == "name":
            element.set(key, text)


def _ports(part: Any, where: str, *, beside: tuple[str, ...] = ()) -> dict[str, str]:
    """Return the plain fields of a part that differ from their defaults."""
    found: dict[str, str] = {}
    for attribute in plain_attributes(type(part)):
        value = getattr(part, attribute.field)
        if attribute.field in beside or value is None or value == attribute.default:
            continue
        for name, text in _written(attribute, value, where).items():
            found[port_name(name)] = _plain(text, where)
    return found


def _written(attribute: Attribute, value: Any, where: str) -> dict[str, str]:
    try:
        return attribute_text(attribute, value)
    except ValueError as error:
        raise TaskError(f"{attribute.name}: {error}", where=where) from None


def _plain(text: str, where: str) -> str:
    """Return a text protected from blackboard substitution, which would replace anything in braces."""
    bare = text.strip()
    if not text:
        raise TaskError("a tree cannot contain an empty text", where=where)
    if bare.startswith("{") and bare.endswith("}"):
        what = f"a tree cannot contain the text {text!r}: in braces it means a blackboard entry"
        raise TaskError(what, where=where, advice="write it without braces")
    return text


def _reading(name: str, where: str) -> str:
    if "{" in name or "}" in name:
        raise TaskError(
            f"a tree cannot contain a reading called {name!r}", where=where, advice="name it without braces"
        )
    return f"{{reading_{name}}}"


def _said(spans: Sequence[p.Span]) -> dict[str, str]:
    return {"_said": " ".join(f"{a}-{b}" for a, b in spans)} if spans else {}
