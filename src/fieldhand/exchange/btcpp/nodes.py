"""Conversion of tree nodes to plan nodes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, get_args

from fieldhand.exchange.btcpp.elements import Elements, Tag
from fieldhand.exchange.btcpp.vocabulary import (
    ALLOWS,
    BEGIN_SERIES,
    CONDITIONS,
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
)
from fieldhand.exchange.btcpp.writing import EXIT_ENTRY
from fieldhand.places.selectors import SELECTORS
from fieldhand.task import plan as p
from fieldhand.task.aggregates import SeriesCondition
from fieldhand.task.capabilities import ChoiceParameter
from fieldhand.task.codec_shapes import shape_of
from fieldhand.task.codec_text import bare_value
from fieldhand.task.codec_xml import MAX_DEPTH
from fieldhand.task.conditions import AllOf, AnyOf, Condition, Not

if TYPE_CHECKING:
    from lxml.etree import _Element

#: Maximum number of nodes after subtrees are expanded.
MAX_NODES = 20_000
_READING = re.compile(r"\{(?:reading_)?([^{}]+)\}")
_AFTER_STOP = f"_failureIf={EXIT_ENTRY} != ''"


class NodeReader:
    """Reader of the nodes of one document.

    Args:
        elements: Reader of the document's elements.
        trees: Trees by name, for subtrees.
    """

    def __init__(self, elements: Elements, trees: Mapping[str, _Element]) -> None:
        self.elements = elements
        self._trees = trees
        self._inside: list[str] = []
        #: Nesting depth of the subtrees being expanded.
        self._depth = 0
        self._nodes = 0

    def node(self, element: _Element, *scripts: str) -> p.Node:
        """Return the plan node of an element; ``scripts`` are those that its parent's notation puts around it."""
        self._nodes += 1
        if self._nodes > MAX_NODES:
            raise self.elements.error(element, f"the tree has more than {MAX_NODES:,} nodes", "use subtrees less often")
        if self._depth + _depth(element) > MAX_DEPTH:
            raise self.elements.error(element, f"more than {MAX_DEPTH} nodes are nested", "nest less deeply")
        tag = self.elements.tag(element)
        known: tuple[str, ...] = tuple(self.elements.known.get(tag.kind, ()))
        known = {"Repeat": ("num_cycles",), "SubTree": ("ID",)}.get(tag.kind, known)
        self.elements.ports(tag, known, scripts=scripts)
        beside: dict[str, Any] = {"id": tag.name, "said": self.elements.spans(tag, "_said")}
        match tag.kind:
            case "Sequence":
                return self._sequence(tag, beside)
            case "Fallback":
                return self._fallback(tag, beside)
            case "IfThenElse":
                return self._if(tag, beside)
            case "Repeat":
                (body,) = self.elements.children(tag, 1)
                return p.Repeat(**beside, times=self._times(tag), body=self.node(body))
            case "SubTree":
                return self._subtree(tag)
            case str() if tag.kind == GO_TO:
                place = self.elements.parts(tag, "place", SELECTORS)
                return p.GoTo(**beside, place=place, **self.elements.fields(tag, p.GoTo))
            case str() if tag.kind == WAIT:
                renamed = {("seconds" if port == WAIT_PORT else port): text for port, text in tag.ports.items()}
                return p.Wait(**beside, **self.elements.fields(replace(tag, ports=renamed), p.Wait))
            case str() if tag.kind == LIMIT:
                (body,) = self.elements.children(tag, 1)
                return p.Pace(**beside, body=self.node(body), **self.elements.fields(tag, p.Pace))
            case str() if tag.kind == WORK:
                work: p.WorkAlong = self.elements.parts(tag, "work", (p.WorkAlong,))
                return replace(work, **beside, along_said=self.elements.spans(tag, "_at_said"))
            case str() if tag.kind == RECHARGE:
                return p.Recharge(**beside, **self.elements.fields(tag, p.Recharge))
            case str() if tag.kind in self.elements.capabilities.actions:
                return self._act(tag, beside | {"at_said": self.elements.spans(tag, "_at_said")})
        raise self.elements.error(
            element, f"<{tag.kind}> is not allowed here", "a Task has no step that consists of this alone"
        )

    def _sequence(self, tag: Tag, beside: dict[str, Any]) -> p.Node:
        inside = [self.elements.tag(child) for child in tag.element]
        kinds = [one.kind for one in inside]
        if kinds[:1] == [RESOLVE]:
            return self._for_each(tag, inside, beside)
        if kinds == [ORDER, "LoopInt"]:
            return self._any_order(inside[1], beside)
        if kinds in (["Script", "Repeat"], [BEGIN_SERIES, "Repeat"], [BEGIN_SERIES, "Script", "Repeat"]):
            return self._repeat(inside, beside)
        if kinds == ["Script", "AlwaysFailure"]:
            return self._stop(inside[0], beside)
        acts = self.elements.capabilities.actions
        if len(kinds) == 2 and kinds[0] == GO_TO and kinds[1] in acts and not (inside[0].name or inside[1].name):
            at = self.elements.parts(inside[0], "place", SELECTORS)
            self.elements.ports(inside[0], ("place", "label"))
            self.elements.ports(inside[1], self.elements.known[kinds[1]])
            spans = self.elements.spans(tag, "_at_said")
            act = self._act(inside[1], beside | {"at": at, "at_said": spans})
            label = inside[0].ports.get("label") or act.label
            return replace(act, label=label)
        steps = tuple(self.node(child.element) for child in inside if child.kind != "AlwaysSuccess")
        return p.InOrder(**beside, steps=steps)

    def _any_order(self, loop: Tag, beside: dict[str, Any]) -> p.AnyOrder:
        entry = _entry(loop, "value", "_step")
        (body,) = self.elements.children(loop, 1)
        steps = tuple(
            self.node(child, f"_skipIf={entry}_step != {number}")
            for number, child in enumerate(body, start=1)
            if child.tag != "AlwaysSuccess"
        )
        return p.AnyOrder(**beside, steps=steps)

    def _for_each(self, tag: Tag, inside: list[Tag], beside: dict[str, Any]) -> p.ForEach:
        resolve, loop = inside[0], inside[-1]
        shape = [one.kind for one in inside]
        if shape not in ([RESOLVE, "LoopString"], [RESOLVE, "Script", "LoopString"]):
            raise self.elements.error(
                tag.element, f"after <{RESOLVE}> a <LoopString> over its places is needed", "add it"
            )
        self.elements.ports(resolve, self.elements.known[RESOLVE])
        self.elements.ports(loop, ("queue", "value", "if_empty"))
        entry = _entry(loop, "value", "_place")
        if loop.ports.get("queue") != resolve.ports.get("places"):
            raise self.elements.error(loop.element, "the queue is not the places before it", "name the same entry")
        (once,) = self.elements.children(loop, 1)
        visit = self.elements.tag(once)
        done = (f"_successIf={entry}_done",) if len(inside) == 3 else ()
        self.elements.ports(visit, (), scripts=done)
        if visit.kind == "IfThenElse":
            asked, once, _ = self.elements.children(visit, 3)
            if self.elements.tag(asked).kind != ALLOWS:
                raise self.elements.error(asked, f"an optional visit has to test <{ALLOWS}>", "put it first")
            visit = self.elements.tag(once)
        steps = list(visit.element)
        if visit.kind != "Sequence" or len(steps) not in (2, 3) or self.elements.tag(steps[0]).kind != GO_TO:
            what = f"a visit is a <Sequence> of <{GO_TO}>, one node and optionally a test"
            raise self.elements.error(visit.element, what, "put what is done there into one <Sequence>")
        go = self.elements.tag(steps[0])
        return p.ForEach(
            **beside,
            select=self.elements.parts(resolve, "select", SELECTORS),
            label=go.ports.get("label", ""),
            body=self.node(steps[1]),
            until=self._test(steps[2]) if len(steps) == 3 else None,
            **self.elements.fields(resolve, p.ForEach, beside=("label",)),
        )

    def _repeat(self, inside: list[Tag], beside: dict[str, Any]) -> p.Repeat:
        """Convert a repeat with a test, or with a series that begins anew."""
        repeat = inside[-1]
        (once,) = self.elements.children(repeat, 1)
        if inside[0].kind == BEGIN_SERIES:
            self.elements.ports(inside[0], self.elements.known[BEGIN_SERIES])
            beside |= {"collects": inside[0].ports.get("reading", "")}
            if len(inside) == 2:
                self.elements.ports(repeat, ("num_cycles",))
                return p.Repeat(**beside, times=self._times(repeat), body=self.node(once))
        body = list(once)
        if once.tag != "Sequence" or len(body) != 2:
            raise self.elements.error(once, "a round is a <Sequence> of one node and a test", "correct it")
        until = self._test(body[1])
        return p.Repeat(**beside, times=self._times(repeat), body=self.node(body[0]), until=until)

    def _test(self, element: _Element) -> Condition:
        """Return the condition at the end of an iteration."""
        if element.tag != "ForceSuccess" or len(element) != 1 or len(element[0]) != 2:
            what = "the test at the end of a round is <ForceSuccess> of a condition and a <Script>"
            raise self.elements.error(element, what, "take it from an exported tree")
        return self._condition(element[0][0])

    def _fallback(self, tag: Tag, beside: dict[str, Any]) -> p.Node:
        """Convert a fallback; with more than two children, each replaces those before it."""
        if len(tag.element) < 2:
            raise self.elements.error(tag.element, "contains fewer than two nodes", "add what to do if the first fails")
        tried = [self.node(child, _AFTER_STOP) for child in tag.element]
        rest = tried[-1]
        for body in reversed(tried[1:-1]):
            rest = p.Try(id="", body=body, otherwise=rest)
        return p.Try(**beside, body=tried[0], otherwise=rest)

    def _if(self, tag: Tag, beside: dict[str, Any]) -> p.Node:
        if len(tag.element) == 2:
            what = "fails where its condition is not met, which a Task cannot express"
            raise self.elements.error(tag.element, what, "give it a third node: <AlwaysSuccess/>")
        first, then, other = self.elements.children(tag, 3)
        asked = self.elements.tag(first)
        if asked.kind == ALLOWS:
            self.elements.ports(asked, self.elements.known[ALLOWS])
            if other.tag != "AlwaysSuccess":
                raise self.elements.error(
                    other, "the alternative to an optional step must be to do nothing", "use <AlwaysSuccess/>"
                )
            return p.OptionalStep(**beside, body=self.node(then), **self.elements.fields(asked, p.OptionalStep))
        otherwise = None if other.tag == "AlwaysSuccess" else self.node(other)
        return p.If(**beside, condition=self._condition(first), then=self.node(then), otherwise=otherwise)

    def _condition(self, element: _Element) -> Condition:
        tag = self.elements.tag(element)
        self.elements.ports(tag, self.elements.known.get(tag.kind, ()))
        match tag.kind:
            case "Sequence":
                return AllOf(conditions=tuple(self._condition(c) for c in element if c.tag != "AlwaysSuccess"))
            case "Fallback":
                return AnyOf(conditions=tuple(self._condition(c) for c in element if c.tag != "AlwaysFailure"))
            case "Inverter":
                (inner,) = self.elements.children(tag, 1)
                return Not(condition=self._condition(inner))
        if tag.kind == TEST_SERIES:
            tested: Condition = self.elements.parts(tag, "condition", get_args(SeriesCondition))
            return tested
        cls = next((cls for cls, kind in CONDITIONS.items() if kind == tag.kind), None)
        if cls is None:
            raise self.elements.error(
                element, f"<{tag.kind}> is not a condition", f"use {', '.join(CONDITIONS.values())}"
            )
        tag.ports.pop(IF_UNKNOWN, None)
        found = self.elements.fields(tag, cls, beside=("reading",))
        if shape_of(cls).head is not None:
            found |= {"reading": self._reading(tag), "quantity": tag.ports.get("quantity", "")}
        made: Condition = cls(**found)
        return made

    def _act(self, tag: Tag, beside: dict[str, Any]) -> p.Act:
        parameters: list[tuple[str, str | float]] = []
        for key, text in tag.ports.items():
            spec = self.elements.capabilities.actions[tag.kind].parameters.get(key)
            if spec is not None and text:
                value = text if isinstance(spec, ChoiceParameter) else bare_value(text)
                parameters.append((key, text if isinstance(value, bool) else value))
        reading = self._reading(tag) if tag.ports.get("reading") else ""
        found = self.elements.fields(tag, p.Act, beside=("reading",))
        return p.Act(**beside, action=tag.kind, parameters=tuple(parameters), reading=reading, **found)

    def _reading(self, tag: Tag) -> str:
        found = _READING.fullmatch(tag.ports.get("reading", "").strip())
        if found is None:
            what = "the port 'reading' names no blackboard entry"
            raise self.elements.error(tag.element, what, "write for instance {reading_r1}")
        return found[1]

    def _stop(self, script: Tag, beside: dict[str, Any]) -> p.StopMission:
        code = script.ports.get("code", "")
        found = re.fullmatch(rf"{EXIT_ENTRY} := '(nominal|faulted)'", code.strip())
        if found is None:
            raise self.elements.error(script.element, f"a Task cannot express the script {code!r}", "take it out")
        return p.StopMission(**beside, exit="nominal" if found[1] == "nominal" else "faulted")

    def _times(self, tag: Tag) -> int:
        text = tag.ports.get("num_cycles", "")
        if not re.fullmatch(r"[1-9][0-9]{0,8}", text.strip()):
            raise self.elements.error(tag.element, f"num_cycles is {text!r}", "give a whole number from 1")
        return int(text)

    def _subtree(self, tag: Tag) -> p.Node:
        name = tag.ports.get("ID", "")
        if name not in self._trees:
            raise self.elements.error(tag.element, f"there is no tree {name!r} in this document", "add it")
        if name in self._inside:
            raise self.elements.error(tag.element, f"the tree {name!r} contains itself", "remove the recursion")
        self._inside.append(name)
        self._depth += _depth(tag.element)
        found = self.node(self._trees[name][0])
        self._depth -= _depth(tag.element)
        self._inside.pop()
        return found


def _depth(element: _Element) -> int:
    """Return the depth of an element in its document."""
    return sum(1 for _ in element.iterancestors())


def _entry(loop: Tag, port: str, ending: str) -> str:
    """Return the prefix of a loop's blackboard entries: ``n2`` of ``{n2_place}``."""
    return loop.ports.get(port, "").strip("{}").removesuffix(ending)
