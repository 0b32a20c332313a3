"""Import of BehaviorTree.CPP v4 trees as Tasks, written by :mod:`.writing` or composed of known leaves.

An unchanged exported tree gives the original Task. For a tree that was changed or drawn in an editor, everything
derived from the plan (ids, goals, state variables) is created anew.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, get_args

from fieldhand.errors import TaskError
from fieldhand.exchange.btcpp.elements import Elements, Tag
from fieldhand.exchange.btcpp.nodes import NodeReader
from fieldhand.exchange.btcpp.vocabulary import BEGIN, EXIT
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.task import plan as p
from fieldhand.task.build import FAULTED_EXITS, make_task
from fieldhand.task.capabilities import Capabilities
from fieldhand.task.codec import decode_parts
from fieldhand.task.codec_xml import at_line, parse_xml, require_visible
from fieldhand.task.frames import Command, Constraints, Fault, FaultedExit, Resource, Task, Then
from fieldhand.task.timing import Timing
from fieldhand.task.watches import Watch

if TYPE_CHECKING:
    from lxml.etree import _Element


@dataclass(frozen=True, kw_only=True)
class _Frames:
    """Data of a tree other than its plan."""

    id: str = ""
    command: Command
    constraints: Constraints = field(default_factory=Constraints)
    resources: tuple[Resource, ...]
    nominal: Then = "return_to_end"
    nominal_said: tuple[p.Span, ...] = ()
    faulted: tuple[FaultedExit, ...] = FAULTED_EXITS
    watches: tuple[Watch, ...] = ()
    timing: Timing | None = None
    earlier: EarlierMissions | None = None


def read_tree(
    data: bytes,
    capabilities: Capabilities,
    *,
    request: str = "",
    resources: tuple[Resource, ...] = (),
    source: str = "",
) -> Task:
    """Parse a tree into a Task.

    Args:
        data: XML document.
        capabilities: Capabilities of the robot, which define the known leaves.
        request, resources: Request, robot and site to use if the tree does not contain them.
        source: Name of the document in error messages.

    Raises:
        TaskError: The document is not such a tree, is refused before parsing (entities, size, depth), or contains
            something without an equivalent in a Task (an unknown node, a script, an endless loop); the message names
            line and node.
    """
    if not data.strip():
        raise TaskError("the document is empty", where=source, advice="give a tree of BehaviorTree.CPP 4")
    elements = Elements(source=source, capabilities=capabilities)
    root = parse_xml(data, source=source)
    require_visible(root, source=source)
    main, trees = _trees(root, elements)
    reader = NodeReader(elements, trees)
    frames, plan = _mission(main, reader, _Frames(command=Command(request=request), resources=resources))
    measures = {
        name: tuple((q, capabilities.quantities[q].unit) for q in action.measures)
        for name, action in capabilities.actions.items()
    }
    made = make_task(
        request=frames.command.request,
        plan=plan,
        measures=measures,
        resources=frames.resources,
        constraints=frames.constraints,
        nominal=frames.nominal,
        faulted=frames.faulted,
        assumptions=frames.command.assumptions,
        nominal_said=frames.nominal_said,
        no_part=frames.command.no_part,
        read_as=frames.command.read_as,
        warnings=frames.command.warnings,
        watches=frames.watches,
        timing=frames.timing,
    )
    made = replace(made, earlier=frames.earlier)
    if not frames.id or not _fits(frames.command, plan):
        return made
    composition = replace(made.composition, plan=plan)
    return replace(made, id=frames.id, command=frames.command, composition=composition)


def _fits(command: Command, plan: p.Node) -> bool:
    """Return True if ids are unique and the goals match the plan."""
    nodes = list(p.walk(plan))
    ids = Counter(node.id for node in nodes)
    acts = {(act.id, act.action) for act in p.acts(plan)}
    return "" not in ids and max(ids.values()) == 1 and {(g.node, g.action) for g in command.goals} == acts


def _trees(root: _Element, elements: Elements) -> tuple[_Element, dict[str, _Element]]:
    """Return the main tree and all trees by name."""
    if root.tag != "root":
        raise elements.error(
            root, "is not a tree of BehaviorTree.CPP", 'its outermost element is <root BTCPP_format="4">'
        )
    if root.get("BTCPP_format") != "4":
        version = root.get("BTCPP_format") or "no format, as version 3 did"
        raise elements.error(
            root, f"names {version}; format 4 can be read", "convert it with convert_v3_to_v4.py first"
        )
    trees: dict[str, _Element] = {}
    for child in root:
        if child.tag == "include":
            raise elements.error(child, "another file cannot be included", "put its trees into this one")
        if child.tag == "BehaviorTree":
            name = str(child.get("ID") or "")
            if name in trees:
                raise elements.error(child, f"there are two trees called {name!r}", "rename one")
            if len(child) != 1:
                raise elements.error(child, f"contains {len(child)} nodes, a tree contains one", "correct it")
            trees[name] = child
    main = root.get("main_tree_to_execute")
    if main is None and len(trees) == 1:
        return next(iter(trees.values())), trees
    if main not in trees:
        known = ", ".join(sorted(trees)) or "none"
        raise elements.error(root, f"main_tree_to_execute is {main!r}; trees here: {known}", "name one of them")
    return trees[main], trees


def _mission(tree: _Element, reader: NodeReader, frames: _Frames) -> tuple[_Frames, p.Node]:
    """Return the frames and the plan of a main tree."""
    elements, top = reader.elements, tree[0]
    tag = elements.tag(top)
    inside = [elements.tag(child) for child in top]
    if tag.kind != "Sequence" or not inside or inside[0].kind != BEGIN:
        return frames, reader.node(top)
    begin = inside[0]
    elements.ports(begin, ("task", "command", "constraints", "resources", "watches", "timing", "earlier"))
    frames = _begun(begin, elements, frames)
    rest = inside[1:]
    if rest and rest[0].kind == "Script":
        rest = rest[1:]
    if len(rest) == 1 and rest[0].kind == "IfThenElse" and len(rest[0].element) == 3:
        return _exits(rest[0], elements, frames), reader.node(rest[0].element[0])
    if not rest:
        raise elements.error(top, "contains no plan", f"put the plan after <{BEGIN}>")
    steps = tuple(reader.node(one.element) for one in rest)
    return frames, steps[0] if len(steps) == 1 else p.InOrder(id=top.get("name") or "", steps=steps)


def _begun(begin: Tag, elements: Elements, frames: _Frames) -> _Frames:
    def parts(port: str, cls: type | tuple[type, ...], least: int, most: int) -> tuple[Any, ...]:
        where = f"{at_line(elements.source, begin.line, begin.kind)}, {port}"
        found = decode_parts(begin.ports.get(port, ""), cls if isinstance(cls, tuple) else (cls,), source=where)
        if not least <= len(found) <= most:
            raise TaskError(f"contains {len(found)} of <{port}>", where=where, advice="take it from an exported tree")
        return found

    command = parts("command", Command, 0, 1)
    constraints = parts("constraints", Constraints, 0, 1)
    timing = parts("timing", get_args(Timing), 0, 1) if begin.ports.get("timing") else ()
    earlier = parts("earlier", EarlierMissions, 0, 1) if begin.ports.get("earlier") else ()
    return replace(
        frames,
        id=begin.ports.get("task", ""),
        command=command[0] if command else frames.command,
        constraints=constraints[0] if constraints else frames.constraints,
        resources=parts("resources", Resource, 0, 9) if "resources" in begin.ports else (),
        watches=parts("watches", Watch, 0, 999) if "watches" in begin.ports else (),
        timing=timing[0] if timing else None,
        earlier=earlier[0] if earlier else None,
        faulted=(),
    )


def _exits(ending: Tag, elements: Elements, frames: _Frames) -> _Frames:
    """Return the exits defined after the plan."""
    done, over = elements.tag(ending.element[1]), elements.tag(ending.element[2])
    if done.kind != EXIT or over.kind != "Fallback" or len(over.element) != 2:
        what = f"after the plan, <{EXIT}> and a <Fallback> for other endings are needed"
        raise elements.error(ending.element, what, "take them from an exported tree")
    elements.ports(done, ("then",))
    fault = elements.tag(over.element[1])
    elements.ports(fault, ("exits",))
    faulted = []
    for pair in fault.ports.get("exits", "").split():
        name, _, then = pair.partition(":")
        if name not in get_args(Fault) or then not in get_args(Then):
            raise elements.error(
                fault.element, f"{pair!r} is not a fault and an exit", "write for instance drive_failed:stay"
            )
        faulted.append(FaultedExit(fault=name, then=then))  # type: ignore[arg-type]  # both were looked up
    then = done.ports.get("then", "")
    if then not in get_args(Then):
        raise elements.error(done.element, f"{then!r} is not an exit", f"write one of {', '.join(get_args(Then))}")
    nominal: Any = then
    return replace(frames, nominal=nominal, nominal_said=elements.spans(done, "_said"), faulted=tuple(faulted))
