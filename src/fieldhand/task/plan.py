"""Plan nodes: the composite and atomic tasks of a Task.

Every node has an ``id`` that is unique in its Task and stays the same from planning to the report. ``said`` holds the
character ranges of the request (start, end) from which the node came; empty where nothing in the request says it.

The budget guard may shed what is optional (:func:`is_optional`), and the mission goes on: work that was shed did not
fail. It is asked about an ``Optional`` once, when that is reached, about all of it; in one stands nothing else that is
optional.

How they behave is fixed here, for the preview and for the robot alike:

* Whatever needs a place drives there first; the last place reached is the *place in hand* (:class:`~.selectors.Here`).
* A selector that an ``Act`` or ``GoTo`` names must give one place.
* ``ForEach`` resolves its selector once, when it is reached; then it drives to each place and does ``body`` there.
* A node fails when an action or a drive in it fails for good; ``Try`` catches that, else the mission ends faulted.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from fieldhand.task.conditions import Condition
from fieldhand.task.selectors import Selector

Span = tuple[int, int]


@dataclass(frozen=True, kw_only=True)
class Sequence:
    """Steps in their order."""

    id: str
    steps: tuple[Node, ...]
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class AnyOrder:
    """Steps in whatever order drives least; each step starts with a place of its own."""

    id: str
    steps: tuple[Node, ...]
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ForEach:
    """``body`` at each place of a selector.

    Attributes:
        label: Name under which ``body`` finds the place (``Bound(label=...)``).
        order: ``best`` drives least; ``given`` keeps the order of the selector.
        optional: Visits may be shed by the budget guard, least worth first ("as many as you can").
        at_most: Stop after that many visits ("up to 6").
        reward: Attribute that says what a visit is worth; else every visit is worth 1.
        until: Stop once this holds after a visit.
    """

    id: str
    select: Selector
    body: Node
    label: str = ""
    order: Literal["best", "given"] = "best"
    optional: bool = False
    at_most: int | None = None
    reward: str = ""
    until: Condition | None = None
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Repeat:
    """``body`` a number of times, or until a condition holds, whichever comes first."""

    id: str
    times: int
    body: Node
    until: Condition | None = None
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class If:
    """``then`` where the condition holds, else ``otherwise`` (nothing if absent)."""

    id: str
    condition: Condition
    then: Node
    otherwise: Node | None = None
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Try:
    """``body``, and if that fails ``otherwise``."""

    id: str
    body: Node
    otherwise: Node
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Optional:
    """``body`` as a whole, if the budget allows. What it binds is known inside it alone.

    Attributes:
        reward: What it is worth.
    """

    id: str
    body: Node
    reward: float = 1.0
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class GoTo:
    """Drive to a place. ``label`` binds it for later nodes."""

    id: str
    place: Selector
    label: str = ""
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Act:
    """An atomic task: one action of the robot's profile.

    Attributes:
        at: Where; else at the place in hand.
        at_said: Those of its ranges of the request that say where.
        count: How many captures at that place.
        parameters: Name and value of each parameter that the profile declares for the action.
        label: Binds the place for later nodes.
        reading: Binds what the action measures, of several captures the last.
    """

    id: str
    action: str
    at: Selector | None = None
    at_said: tuple[Span, ...] = ()
    count: int = 1
    parameters: tuple[tuple[str, str | float], ...] = ()
    label: str = ""
    reading: str = ""
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Stop:
    """End the mission here and take an exit."""

    id: str
    exit: Literal["nominal", "faulted"] = "nominal"
    said: tuple[Span, ...] = ()


Node = Sequence | AnyOrder | ForEach | Repeat | If | Try | Optional | GoTo | Act | Stop


def children(node: Node) -> tuple[Node, ...]:
    """The nodes directly inside this one, in the order in which they stand."""
    match node:
        case Sequence(steps=steps) | AnyOrder(steps=steps):
            return steps
        case ForEach(body=body) | Repeat(body=body) | Optional(body=body):
            return (body,)
        case If(then=then, otherwise=otherwise):
            return (then,) if otherwise is None else (then, otherwise)
        case Try(body=body, otherwise=fallback):
            return (body, fallback)
        case _:
            return ()


def walk(node: Node) -> Iterator[Node]:
    """This node and every one inside it, outermost first."""
    yield node
    for child in children(node):
        yield from walk(child)


def is_optional(node: Node) -> bool:
    """Whether the budget guard may shed the node, or visits of it, and the mission goes on."""
    return isinstance(node, Optional) or (isinstance(node, ForEach) and node.optional)


def selector_of(node: Node) -> Selector | None:
    """The selector that a node names a place with, if it has one."""
    match node:
        case ForEach(select=selector) | GoTo(place=selector):
            return selector
        case Act(at=at):
            return at
        case _:
            return None


def condition_of(node: Node) -> Condition | None:
    """The condition that a node tests, if it has one."""
    match node:
        case If(condition=condition):
            return condition
        case ForEach(until=until) | Repeat(until=until):
            return until
        case _:
            return None
