"""A plan under way: which nodes are in hand, one inside the other, and how far each of them is."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from fieldhand.task.nodes.base import Cut, Failed, GivenUp, Program

if TYPE_CHECKING:
    from fieldhand.task.instructions import Instruction, OpaqueTour
    from fieldhand.task.plan import Node

Outcome = Literal["done", "failed", "cut"]

#: What takes its time: it yields until it is done.
Steps = Generator[None, None, None]


@dataclass(kw_only=True)
class StackFrame:
    """A node in hand.

    Attributes:
        left: Steps of it that come after the one in hand, in their order; of a repeat the rounds that are left.
        tour: The visits of a for-each.
        made: How many visits of it were made.
        instead: What is done if the node inside fails; empty where the failure goes on outwards.
    """

    node: Node
    left: tuple[Node, ...] = ()
    tour: OpaqueTour | None = None
    made: int = 0
    instead: tuple[Node, ...] = ()


def _unheard(*_: object) -> None:
    """Nobody is told."""


class Run:
    """One time through a plan.

    Args:
        plan: The root.

    Attributes:
        frames: The nodes in hand, outermost first.
        entered, left: Told of every node that is reached and that is over; ``cut`` where it was given up or the plan
            ended inside it.
    """

    def __init__(self, plan: Node) -> None:
        self.plan = plan
        self.frames: list[StackFrame] = []
        self.entered: Callable[[Node], None] = _unheard
        self.left: Callable[[Node, Outcome], None] = _unheard

    def program(self) -> Program:
        """The meaning of the whole plan."""
        return self.do(self.plan)

    def do(self, node: Node) -> Program:
        """Carry out one node inside the one in hand."""
        self.frames.append(StackFrame(node=node))
        depth = len(self.frames)
        outcome: Outcome = "cut"
        self.entered(node)
        try:
            yield from node.execute(self)
            outcome = "done"
        except Failed:
            outcome = "failed"
            raise
        except Cut as cut:
            if cut.node != node.id:
                raise
        finally:
            del self.frames[depth - 1 :]
            self.left(node, outcome)

    @property
    def frame(self) -> StackFrame:
        """The innermost node in hand."""
        return self.frames[-1]

    def outwards(self) -> Iterator[StackFrame]:
        """The frames, innermost first."""
        return reversed(self.frames)

    @property
    def optional(self) -> StackFrame | None:
        """The optional visit or step in hand; there is at most one."""
        return next((frame for frame in self.outwards() if frame.node.is_optional), None)

    @property
    def is_caught(self) -> bool:
        """Return True if a ``Try`` goes on when the node in hand fails."""
        return any(frame.instead for frame in self.frames)


def carry_out(program: Program, answer: Callable[[Instruction], Any]) -> None:
    """Carry a plan out to its end.

    Args:
        program: The meaning of a node.
        answer: Answers each request, or raises :class:`Failed`, :class:`GivenUp` or :class:`Cut`, which is thrown into
            the program. Whatever else it raises ends the program and comes out of here.

    Raises:
        Failed: Nothing in the plan catches the failure.
        Stopped: The plan came to a ``Stop``.
    """
    try:
        request = next(program, None)
        while request is not None:
            try:
                found = answer(request)
            except (Failed, GivenUp, Cut) as thrown:
                request = _thrown(program, thrown)
            else:
                request = _sent(program, found)
    finally:
        program.close()


def carry_out_in_steps(program: Program, perform: Callable[[Instruction], Generator[None, None, Any]]) -> Steps:
    """:func:`carry_out` by somebody whose answers take their time: it yields whenever an answer is waited for.

    Args:
        program: The meaning of a node.
        perform: Gives the answer to a request in steps, or raises as there.
    """
    try:
        request = next(program, None)
        while request is not None:
            try:
                found = yield from perform(request)
            except (Failed, GivenUp, Cut) as thrown:
                request = _thrown(program, thrown)
            else:
                request = _sent(program, found)
    finally:
        program.close()


def _sent(program: Program, found: Any) -> Instruction | None:
    """The next request; None where there is none."""
    try:
        return program.send(found)
    except StopIteration:
        return None


def _thrown(program: Program, thrown: Exception) -> Instruction | None:
    try:
        return program.throw(thrown)
    except StopIteration:
        return None
