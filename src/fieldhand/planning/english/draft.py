"""The plan while it is being made: blocks of steps that can still be moved, wrapped and copied."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.task import conditions as c
from fieldhand.task import plan as p
from fieldhand.task.plan import Span


@dataclass(eq=False)
class DraftBlock:
    """Steps one after the other."""

    steps: list[Step] = field(default_factory=list)
    parent: DraftBlock | None = None

    def add(self, step: Step) -> None:
        """Append a step, and make its blocks know where they stand."""
        self.steps.append(step)
        for inner in blocks_of(step):
            inner.parent = self


@dataclass(eq=False)
class Go:
    """Drive to a place."""

    place: s.Selector
    said: tuple[Span, ...] = ()


@dataclass(eq=False)
class DraftCapture:
    """An action at a place, or at the place in hand."""

    action: str
    at: s.Selector | None = None
    at_said: tuple[Span, ...] = ()
    count: int = 1
    reading: str = ""
    said: tuple[Span, ...] = ()
    command: int = 0  # captures that one command asks for have the same number; 0: asked for by none


@dataclass(eq=False)
class Loop:
    """A block at each of several places."""

    select: s.Selector
    body: DraftBlock
    order: Literal["best", "given"] = "best"
    optional: bool = False
    at_most: int | None = None
    until: c.Condition | None = None
    said: tuple[Span, ...] = ()


@dataclass(eq=False)
class Times:
    """A block a number of times."""

    times: int
    body: DraftBlock
    until: c.Condition | None = None
    said: tuple[Span, ...] = ()


@dataclass(eq=False)
class Choice:
    """A block where a condition holds, and another where it does not."""

    condition: c.Condition
    then: DraftBlock
    otherwise: DraftBlock | None = None
    said: tuple[Span, ...] = ()


@dataclass(eq=False)
class Attempt:
    """A block, and another if it fails."""

    body: DraftBlock
    fallback: DraftBlock
    said: tuple[Span, ...] = ()


@dataclass(eq=False)
class Maybe:
    """A block that may be left out where too little is left for it."""

    body: DraftBlock
    said: tuple[Span, ...] = ()


@dataclass(eq=False)
class Halt:
    """The end of the mission; ``here`` where the request says that the robot is to stay."""

    said: tuple[Span, ...] = ()
    here: bool = False


Step = Go | DraftCapture | Loop | Times | Choice | Attempt | Maybe | Halt


def blocks_of(step: Step) -> list[DraftBlock]:
    """The blocks inside a step."""
    match step:
        case Loop(body=body) | Times(body=body) | Maybe(body=body):
            return [body]
        case Choice(then=then, otherwise=otherwise):
            return [then] if otherwise is None else [then, otherwise]
        case Attempt(body=body, fallback=fallback):
            return [body, fallback]
        case _:
            return []


def walk(block: DraftBlock) -> Iterator[tuple[Step, DraftBlock]]:
    """Every step below a block, in the order of the text, with the block that holds it."""
    for step in block.steps:
        yield step, block
        for inner in blocks_of(step):
            yield from walk(inner)


def shape(block: DraftBlock) -> tuple[object, ...]:
    """What a block does, without the words that say it: equal for blocks that do the same."""
    made: list[object] = []
    for step in block.steps:
        match step:
            case Go():
                made.append(("go", step.place))
            case DraftCapture():
                made += [("go", step.at)] if step.at is not None else []
                made.append((step.action, step.count))
            case Loop():
                made.append(("each", step.select, step.order, step.optional, step.at_most, shape(step.body)))
            case _:
                made.append((type(step).__name__, *(shape(inner) for inner in blocks_of(step))))
    return tuple(made)


def copy_block(
    block: DraftBlock, keep: Callable[[Step], bool], renamed: dict[str, str], fresh: Callable[[], str]
) -> DraftBlock:
    """A copy with readings of its own. Steps that ``keep`` refuses are left out, and choices that hold nothing then."""
    made = DraftBlock()
    for step in block.steps:
        if not keep(step):
            continue
        match step:
            case Go():
                made.add(Go(place=step.place, said=step.said))
            case DraftCapture():
                reading = ""
                if step.reading:
                    reading = renamed[step.reading] = fresh()
                made.add(replace(step, reading=reading))
            case Loop():
                body = copy_block(step.body, keep, renamed, fresh)
                made.add(replace(step, body=body, until=_renamed(step.until, renamed)))
            case Times():
                body = copy_block(step.body, keep, renamed, fresh)
                made.add(replace(step, body=body, until=_renamed(step.until, renamed)))
            case Choice():
                condition = rename(step.condition, renamed)
                then = copy_block(step.then, keep, renamed, fresh)
                other = None if step.otherwise is None else copy_block(step.otherwise, keep, renamed, fresh)
                if then.steps or (other is not None and other.steps):
                    made.add(Choice(condition=condition, then=then, otherwise=other, said=step.said))
            case Attempt():
                body = copy_block(step.body, keep, renamed, fresh)
                made.add(Attempt(body=body, fallback=copy_block(step.fallback, keep, renamed, fresh), said=step.said))
            case Maybe():
                made.add(Maybe(body=copy_block(step.body, keep, renamed, fresh), said=step.said))
            case Halt():
                made.add(Halt(said=step.said))
    return made


def _renamed(until: c.Condition | None, renamed: dict[str, str]) -> c.Condition | None:
    return None if until is None else rename(until, renamed)


def rename(condition: c.Condition, renamed: dict[str, str]) -> c.Condition:
    """A condition on the readings of a copy."""
    match condition:
        case c.Compare() | c.Between() | c.Level():
            return replace(condition, reading=renamed.get(condition.reading, condition.reading))
        case c.AllOf() | c.AnyOf():
            return replace(condition, conditions=tuple(rename(i, renamed) for i in condition.conditions))
        case c.Not():
            return replace(condition, condition=rename(condition.condition, renamed))
        case _:
            return condition


def node_of(block: DraftBlock) -> p.Node:
    """A block as a plan node; one step alone needs no sequence around it."""
    nodes = tuple(_node(step) for step in block.steps)
    return nodes[0] if len(nodes) == 1 else p.InOrder(id="", steps=nodes)


def _node(step: Step) -> p.Node:
    match step:
        case Go():
            return p.GoTo(id="", place=step.place, said=step.said)
        case DraftCapture():
            return p.Act(
                id="",
                action=step.action,
                at=step.at,
                at_said=step.at_said,
                count=step.count,
                reading=step.reading,
                said=step.said,
            )
        case Loop():
            body = node_of(step.body) if step.body.steps else p.GoTo(id="", place=s.Here(), said=step.said)
            return p.ForEach(
                id="",
                select=step.select,
                body=body,
                order=step.order,
                optional=step.optional,
                at_most=step.at_most,
                until=step.until,
                said=step.said,
            )
        case Times():
            return p.Repeat(id="", times=step.times, body=node_of(step.body), until=step.until, said=step.said)
        case Choice():
            if not step.then.steps and step.otherwise is not None:
                return p.If(
                    id="", condition=c.Not(condition=step.condition), then=node_of(step.otherwise), said=step.said
                )
            other = node_of(step.otherwise) if step.otherwise is not None and step.otherwise.steps else None
            return p.If(id="", condition=step.condition, then=node_of(step.then), otherwise=other, said=step.said)
        case Attempt():
            return p.Try(id="", body=node_of(step.body), otherwise=node_of(step.fallback), said=step.said)
        case Maybe():
            return p.OptionalStep(id="", body=node_of(step.body), said=step.said)
        case Halt():
            return p.StopMission(id="", said=step.said)
