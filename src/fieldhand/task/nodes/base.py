"""The base class of plan nodes, and the exceptions that end one.

A node is executed as a generator. It yields instructions (:mod:`fieldhand.task.instructions`) to the executor, receives
the results, and returns when the node is done. Failures are thrown into it:

* :class:`Failed`: an action, a drive or a place failed for good. The nearest enclosing ``Try`` continues with its
  otherwise; without one the plan has failed.
* :class:`GivenUp`: a visit of a for-each, or an optional step, was abandoned. Execution continues after it.
* :class:`Cut`: a node was left out, or a log does not show how it ended. Execution continues after that node.

A ``StopMission`` raises :class:`Stopped`, which nothing catches: the plan is over.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias, TypeVar

from fieldhand.compatibility import Self

if TYPE_CHECKING:
    from fieldhand.places.selector import Selector
    from fieldhand.task.conditions import Condition
    from fieldhand.task.instructions import Instruction
    from fieldhand.task.nodes.act import Act
    from fieldhand.task.nodes.recharge import Recharge
    from fieldhand.task.nodes.stop_mission import StopMission
    from fieldhand.task.nodes.work_along import WorkAlong
    from fieldhand.task.plan import Node
    from fieldhand.task.run import PlanRun

#: A range of characters of the request: start, and end (exclusive).
Span: TypeAlias = tuple[int, int]

#: Role of the words of the request that a node came from.
Role: TypeAlias = Literal["condition", "limit", "end", "action", "place", "order"]

#: A generator of instructions that is sent their results and returns nothing.
Program: TypeAlias = "Generator[Instruction, Any, None]"

#: Function that returns a selector in a few words.
SayPlace: TypeAlias = "Callable[[Selector], str]"


class Failed(Exception):
    """A node failed for good. Thrown into the program; it unwinds to the nearest ``Try``."""


class GivenUp(Exception):
    """A visit or an optional step was abandoned. Thrown into the program; it unwinds to that node.

    Args:
        node: Id of the for-each or the optional step.
    """

    def __init__(self, node: str) -> None:
        self.node = node
        super().__init__(node)


class Cut(Exception):
    """The rest of a node is unknown. Thrown into the program, which continues after that node.

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
    """A node inside another, with the number of times it is executed each time the other is.

    Attributes:
        times: Number of times if all goes well; None where the site, a reading or the budget decides.
        certain: False if a test, a failure or the budget decides whether it is reached.
    """

    node: Node
    times: int | None = 1
    certain: bool = True


class Known(Protocol):
    """The bindings known at a point of a plan; ``|`` merges those of two branches."""

    def __or__(self, other: Self, /) -> Self: ...


K = TypeVar("K", bound=Known)


class PlanNode(ABC):
    """The base class of plan nodes, which are dataclasses.

    The properties below describe a node without executing it. Their defaults fit a node that does not drive, does no
    work and has no children.

    Attributes:
        id: Identifier within the Task, the same from planning to the report; empty until ``task.build.make_task``.
        said: Character ranges of the request from which the node was derived: start, and end (exclusive).
    """

    id: str
    said: tuple[Span, ...]

    @abstractmethod
    def execute(self, run: PlanRun) -> Program:
        """Execute the node: yield instructions and receive their results.

        Args:
            run: The plan under way, which executes child nodes (:meth:`Run.do`).
        """

    @abstractmethod
    def say(self, place: SayPlace) -> str:
        """Return a short description of the node."""

    @property
    @abstractmethod
    def role(self) -> Role:
        """The role of the words of the request that it came from."""

    # --- the nodes inside --------------------------------------------------------------------------------------------

    @property
    def parts(self) -> tuple[ChildNode, ...]:
        """The direct children in document order, each with the number of times it is executed."""
        return ()

    @property
    def children(self) -> tuple[Node, ...]:
        """The direct children in document order."""
        return tuple(part.node for part in self.parts)

    def with_children(self, children: Sequence[Node]) -> Self:  # noqa: ARG002
        """Return a copy of the node with other children, as many as before."""
        return self

    @property
    def is_series(self) -> bool:
        """True if executing it means executing all its children and nothing else."""
        return False

    def goes_on_after(self, child: Node) -> bool:  # noqa: ARG002
        """Return True if another child, or another execution of the same one, can follow this child."""
        return False

    @property
    def in_any_order(self) -> bool:
        """True if the robot chooses the order of steps or visits."""
        return False

    @property
    def keeps_order(self) -> bool:
        """True if it has several steps or visits in an order fixed by the plan."""
        return False

    @property
    def is_choice(self) -> bool:
        """True if it tests a condition and executes at most one child."""
        return False

    @property
    def caught(self) -> tuple[Node, ...]:
        """The children whose failure the node catches."""
        return ()

    def flow(self, known: K, visit: Callable[[Node, K], K], test: Callable[[Node, K], None]) -> K:  # noqa: ARG002
        """Propagate what is known through the children, on every branch at once.

        Args:
            known: What may be known when the node is reached.
            visit: Given a child and what may be known before it, returns what may be known after it.
            test: Called with the node and what may be known when it tests its condition.

        Returns:
            What may be known after the children.
        """
        return known

    # --- the node itself ---------------------------------------------------------------------------------------------

    @property
    def act(self) -> Act | None:
        """The node itself, if it is an action."""
        return None

    @property
    def work(self) -> WorkAlong | None:
        """The node itself, if it is work along a path."""
        return None

    @property
    def recharge(self) -> Recharge | None:
        """The node itself, if it charges the battery."""
        return None

    @property
    def selector(self) -> Selector | None:
        """The node's own selector, if it has one."""
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
        """True if it visits every place of its selector, else the selector must name one place."""
        return False

    @property
    def at_most(self) -> int | None:
        """The maximum number of visits; None for all."""
        return None

    @property
    def rewarded_by(self) -> str:
        """The attribute of a tree that is the reward of visiting it; empty for 1 each."""
        return ""

    @property
    def rewarded_first(self) -> Literal["value", "highest", "lowest"]:
        """The values of that attribute which are worth most by their rank; ``value`` if the values are the worth."""
        return "value"

    @property
    def rounds(self) -> int | None:
        """The maximum number of rounds of a repeat; None for other nodes."""
        return None

    @property
    def tested(self) -> Condition | None:
        """The condition that the node itself tests."""
        return None

    @property
    def dwell_s(self) -> float:
        """Seconds for which it stands still; 0 for a node that does not wait."""
        return 0.0

    @property
    def pace_m_s(self) -> float:
        """The highest driving speed inside it in m/s; infinite for a node that does not limit it."""
        return math.inf

    def around(self, rest: Sequence[Node]) -> tuple[Node, ...]:
        """Return the remaining nodes of the node, once it is under way, so that its own conditions still apply."""
        return tuple(rest)

    @property
    def label(self) -> str:
        """The label that it binds; empty for none."""
        return ""

    @property
    def reading(self) -> str:
        """The reading that it binds; empty for none."""
        return ""

    @property
    def collects(self) -> str:
        """The reading whose series begins anew when the node is reached; empty for none."""
        return ""

    @property
    def is_optional(self) -> bool:
        """True if the budget guard may shed the node, or visits of it, while the mission continues."""
        return False

    @property
    def is_optional_step(self) -> bool:
        """True if it is shed as a whole, not visit by visit."""
        return False

    @property
    def ends_plan(self) -> bool:
        """True if nothing can follow it."""
        return False
