"""Execution state of a plan: the stack of active nodes, and the progress of each."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from fieldhand.task.nodes.base import Cut, Failed, GivenUp, Program

if TYPE_CHECKING:
    from fieldhand.task.instructions import Instruction, OpaqueTour
    from fieldhand.task.plan import Node

RunOutcome = Literal["done", "failed", "cut"]

#: A generator that yields while it waits, and returns when done.
Steps = Generator[None, None, None]


@dataclass(kw_only=True)
class StackFrame:
    """An active node.

    Attributes:
        left: Steps that follow the active one, in order; of a repeat the remaining rounds.
        tour: The visits of a for-each.
        made: Number of visits made.
        instead: Nodes executed if the active child fails; empty where the failure propagates.
    """

    node: Node
    left: tuple[Node, ...] = ()
    tour: OpaqueTour | None = None
    made: int = 0
    instead: tuple[Node, ...] = ()


def pace_of(frames: Sequence[StackFrame]) -> float:
    """Return the highest driving speed that active nodes allow in m/s; infinite without a limit."""
    return min((frame.node.pace_m_s for frame in frames), default=math.inf)


def _unheard(*_: object) -> None:
    """Do nothing: the default listener."""


class PlanRun:
    """One execution of a plan.

    Args:
        plan: Root node.

    Attributes:
        frames: The active nodes, outermost first.
        entered, left: Listeners called when a node begins and ends; the outcome is ``cut`` where it was abandoned or
            the plan ended inside it.
    """

    def __init__(self, plan: Node) -> None:
        self.plan = plan
        self.frames: list[StackFrame] = []
        self.entered: Callable[[Node], None] = _unheard
        self.left: Callable[[Node, RunOutcome], None] = _unheard

    def program(self) -> Program:
        """Return the program of the whole plan."""
        return self.do(self.plan)

    def do(self, node: Node) -> Program:
        """Execute a node inside the active one."""
        self.frames.append(StackFrame(node=node))
        depth = len(self.frames)
        outcome: RunOutcome = "cut"
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
        """The innermost active node."""
        return self.frames[-1]

    def outwards(self) -> Iterator[StackFrame]:
        """Return the stack frames, innermost first."""
        return reversed(self.frames)

    @property
    def optional(self) -> StackFrame | None:
        """The active optional visit or step; there is at most one."""
        return next((frame for frame in self.outwards() if frame.node.is_optional), None)

    @property
    def pace_m_s(self) -> float:
        """Return the highest driving speed that the active nodes allow in m/s; infinite without a limit."""
        return pace_of(self.frames)

    @property
    def is_caught(self) -> bool:
        """Return True if an enclosing ``Try`` continues when the active node fails."""
        return any(frame.instead for frame in self.frames)


def carry_out(program: Program, answer: Callable[[Instruction], Any]) -> None:
    """Execute a program to its end.

    Args:
        program: Program of a node.
        answer: Returns the result of each instruction, or raises :class:`Failed`, :class:`GivenUp` or :class:`Cut`,
            which are thrown into the program. Any other exception ends the program and propagates.

    Raises:
        Failed: Nothing in the plan catches the failure.
        Stopped: The plan reached a ``StopMission``.
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
    """Execute a program like :func:`carry_out`, but yield whenever a result has to be waited for.

    Args:
        program: Program of a node.
        perform: Generator that returns the result of an instruction, or raises as in :func:`carry_out`.
    """
    try:
        request = next(program, None)
        while request is not None:
            try:
                result = yield from perform(request)
            except (Failed, GivenUp, Cut) as thrown:
                request = _thrown(program, thrown)
            else:
                request = _sent(program, result)
    finally:
        program.close()


def _sent(program: Program, result: Any) -> Instruction | None:
    """Send a result and return the next instruction; None at the end."""
    try:
        return program.send(result)
    except StopIteration:
        return None


def _thrown(program: Program, thrown: Exception) -> Instruction | None:
    try:
        return program.throw(thrown)
    except StopIteration:
        return None
