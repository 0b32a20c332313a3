"""What every kind of node says of itself.

The *meaning* of a node is a generator. It yields requests (:mod:`fieldhand.task.requests`) to whoever carries the plan
out, is sent the answers, and returns when the node is done. What goes wrong is thrown in:

* :class:`Failed`: an action, a drive or a place failed for good. The nearest ``Try`` around goes on with its otherwise;
  where there is none, the plan has failed.
* :class:`GivenUp`: a visit of a for-each, or an optional step, is given up half-way. That node goes on behind it.

A ``Stop`` raises :class:`Stopped`, which nothing catches: the plan is over.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from fieldhand.places.selectors import Selector
    from fieldhand.task.conditions import Condition
    from fieldhand.task.nodes.stop import Stop
    from fieldhand.task.plan import Node
    from fieldhand.task.requests import Request
    from fieldhand.task.run import Run

#: A range of characters of the request: first, and one behind the last.
Span: TypeAlias = tuple[int, int]

#: Requests, the answers to them, and nothing at the end.
Meaning: TypeAlias = "Generator[Request, Any, None]"

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


class Stopped(Exception):
    """A ``Stop`` was reached.

    Args:
        node: The ``Stop``.
    """

    def __init__(self, node: Stop) -> None:
        self.node = node
        super().__init__(node.id)


class PlanNode(ABC):
    """A node of a plan; its fields are those of the dataclass that it is."""

    id: str
    said: tuple[Span, ...]

    @abstractmethod
    def meaning(self, run: Run) -> Meaning:
        """Carry the node out: yield what it needs, be sent what happened.

        Args:
            run: The plan that is under way; it carries out nodes inside this one (:meth:`Run.do`).
        """

    @abstractmethod
    def say(self, place: SayPlace) -> str:
        """Return what the node does, in a few words."""

    @property
    def children(self) -> tuple[Node, ...]:
        """The nodes directly inside, in the order in which they stand."""
        return ()

    @property
    def selector(self) -> Selector | None:
        """The selector that the node itself names places with."""
        return None

    @property
    def tested(self) -> Condition | None:
        """The condition that the node itself tests."""
        return None

    @property
    def is_optional(self) -> bool:
        """True if the budget guard may shed the node, or visits of it, and the mission goes on."""
        return False
