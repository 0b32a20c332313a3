"""What every kind of node says of itself.

The *meaning* of a node is a generator. It yields requests (:mod:`fieldhand.task.instructions`) to whoever carries the
plan out, is sent the answers, and returns when the node is done. What goes wrong is thrown in:

* :class:`Failed`: an action, a drive or a place failed for good. The nearest ``Try`` around goes on with its otherwise;
  where there is none, the plan has failed.
* :class:`GivenUp`: a visit of a for-each, or an optional step, is given up half-way. That node goes on behind it.
* :class:`Cut`: a log does not tell what came of a node. What comes behind that node goes on.

A ``StopMission`` raises :class:`Stopped`, which nothing catches: the plan is over.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Protocol, Self, TypeAlias, TypeVar

if TYPE_CHECKING:
    from fieldhand.places.selector import Selector
    from fieldhand.task.conditions import Condition
    from fieldhand.task.instructions import Instruction
    from fieldhand.task.nodes.act import Act
    from fieldhand.task.nodes.stop_mission import StopMission
    from fieldhand.task.plan import Node
    from fieldhand.task.run import Run

#: A range of characters of the request: first, and one behind the last.
Span: TypeAlias = tuple[int, int]

#: What the words of the request that a node came from are about.
Role: TypeAlias = Literal["condition", "limit", "end", "action", "place", "order"]

#: Requests, the answers to them, and nothing at the end.
Program: TypeAlias = "Generator[Instruction, Any, None]"

#: Says a selector in a few words.
SayPlace: TypeAlias = "Callable[[Selector], str]"


class Failed(Exception):
    """A node failed for good. Thrown into a meaning; it unwinds to the nearest ``Try``."""


class GivenUp(Exception):
    """A visit or an optional step is given up. Thrown into a meaning; it unwinds to that node.

    Args:
        node: Id of the for-each or the optional step.
    """

    def __init__(self, node: str) -> None:
        self.node = node
        super().__init__(node)


class Cut(Exception):
    """Nobody knows what is left of a node. Thrown into a meaning; that node is over, and what comes behind it goes on.

    Args:
        node: Id of the node.
    """

    def __init__(self, node: str) -> None:
        self.node = node
        super().__init__(node)


class Stopped(Exception):
    """A ``StopMission`` was reached.

    Args:
        node: The ``StopMission``.
    """

    def __init__(self, node: StopMission) -> None:
        self.node = node
        super().__init__(node.id)


@dataclass(frozen=True, kw_only=True)
class ChildNode:
    """A node inside another, and how often it is done whenever the other is.

    Attributes:
        times: The number of times, if all goes well; None where the site, a reading or the budget decides.
        certain: Whether it is come to at all if all goes well; else a test, a failure or the budget decides.
    """

    node: Node
    times: int | None = 1
    certain: bool = True


class Known(Protocol):
    """The knowledge at some point of a plan; ``|`` joins that of two ways that meet."""

    def __or__(self, other: Self, /) -> Self: ...


K = TypeVar("K", bound=Known)


class PlanNode(ABC):
    """A node of a plan; its fields are those of the dataclass that it is.

    The properties below are all that other modules ask of a node without carrying it out. Their defaults are those of a
    node that drives nowhere, does nothing and holds no other.
    """

    id: str
    said: tuple[Span, ...]

    @abstractmethod
    def execute(self, run: Run) -> Program:
        """Carry the node out: yield what it needs, be sent what happened.

        Args:
            run: The plan that is under way; it carries out nodes inside this one (:meth:`Run.do`).
        """

    @abstractmethod
    def say(self, place: SayPlace) -> str:
        """Return what the node does, in a few words."""

    @property
    @abstractmethod
    def role(self) -> Role:
        """The subject of the words that it came from."""

    # --- the nodes inside --------------------------------------------------------------------------------------------

    @property
    def parts(self) -> tuple[ChildNode, ...]:
        """The nodes directly inside, in the order in which they stand, each with how often it is done."""
        return ()

    @property
    def children(self) -> tuple[Node, ...]:
        """The nodes directly inside, in the order in which they stand."""
        return tuple(part.node for part in self.parts)

    def with_children(self, children: Sequence[Node]) -> Self:  # noqa: ARG002
        """Return the node with others in place of its children, as many as it has."""
        return self

    @property
    def is_series(self) -> bool:
        """True if it is nothing but its children, all of them."""
        return False

    def goes_on_after(self, child: Node) -> bool:  # noqa: ARG002
        """Return True if something inside the node can come after this child of it, another round of it included."""
        return False

    @property
    def in_any_order(self) -> bool:
        """True if the robot chooses the order of steps or visits."""
        return False

    @property
    def keeps_order(self) -> bool:
        """True if it has several steps or visits, and the plan says in which order they come."""
        return False

    @property
    def is_choice(self) -> bool:
        """True if one of its children is done at most, by what it tests."""
        return False

    @property
    def caught(self) -> tuple[Node, ...]:
        """The children whose failure the node catches."""
        return ()

    def flow(self, known: K, visit: Callable[[Node, K], K], test: Callable[[Node, K], None]) -> K:  # noqa: ARG002
        """Follow what is known through the nodes inside, on every branch at once.

        Args:
            known: What may be known when the node is reached.
            visit: Given a child and what may be known before it, returns what may be known after it.
            test: Given the node and what may be known when it tests its condition.

        Returns:
            What may be known after the nodes inside.
        """
        return known

    # --- what the node itself does -----------------------------------------------------------------------------------

    @property
    def act(self) -> Act | None:
        """The node itself, if it is an action."""
        return None

    @property
    def selector(self) -> Selector | None:
        """The selector that the node itself names places with."""
        return None

    @property
    def at_said(self) -> tuple[Span, ...]:
        """The ranges of the request that name its place."""
        return ()

    @property
    def only_drives(self) -> bool:
        """True if it is a drive to its place and nothing else."""
        return False

    @property
    def visits_each(self) -> bool:
        """True if it visits all that its selector gives, else the selector must give one place."""
        return False

    @property
    def at_most(self) -> int | None:
        """The number of visits after which it is over; None for all."""
        return None

    @property
    def rewarded_by(self) -> str:
        """The attribute of trees that visits are worth."""
        return ""

    @property
    def rounds(self) -> int | None:
        """The number of rounds that a repeat has at most; None for what is no repeat."""
        return None

    @property
    def tested(self) -> Condition | None:
        """The condition that the node itself tests."""
        return None

    @property
    def label(self) -> str:
        """The label that it binds to its place; empty for none."""
        return ""

    @property
    def reading(self) -> str:
        """The reading that it takes; empty for none."""
        return ""

    @property
    def is_optional(self) -> bool:
        """True if the budget guard may shed the node, or visits of it, and the mission goes on."""
        return False

    @property
    def is_optional_step(self) -> bool:
        """True if it is shed as a whole; of what else is optional visits are."""
        return False

    @property
    def ends_plan(self) -> bool:
        """True if nothing comes after it."""
        return False
