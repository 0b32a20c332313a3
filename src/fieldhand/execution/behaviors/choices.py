"""Choices: one of two branches by a condition, another branch after a failure, the best order of a set.

py_trees calls ``initialise`` when a composite that is not running is ticked: here the condition is tested and the
order is computed, so both are those of the moment in which the node is reached, and stay while it runs.
"""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Composite, Selector
from py_trees.composites import Sequence as PyTreesSequence

from fieldhand.errors import DriveFault, PlaceError
from fieldhand.execution.attempt import Attempt
from fieldhand.forecast.conditions import evaluate
from fieldhand.forecast.routes import home_if_last, steps_in_order
from fieldhand.task.plan import AnyOrder, If, Sequence, Try
from fieldhand.task.results import Decided


class DoInOrder(PyTreesSequence):
    """``Sequence``: the steps one after another; it fails as soon as one does."""

    def __init__(self, name: str, node: Sequence, steps: list[Behaviour]) -> None:
        super().__init__(name, memory=True, children=steps)
        self.node = node


class DoInBestOrder(PyTreesSequence):
    """``AnyOrder``: the steps in the order that drives least from where the robot is when it gets here."""

    def __init__(self, name: str, node: AnyOrder, attempt: Attempt, steps: list[Behaviour]) -> None:
        super().__init__(name, memory=True, children=steps)
        self.node = node
        self._attempt = attempt
        self._steps = tuple(steps)

    def initialise(self) -> None:
        """Compute the order. Where a step cannot be placed the order given stands: that step will say so itself."""
        attempt = self._attempt
        home = home_if_last(attempt.task, attempt.site, self.node.id, attempt.here)
        context = attempt.state(self.node.id).context
        try:
            order = steps_in_order(self.node, attempt.site, attempt.drives, context, home)
        except (PlaceError, DriveFault):
            order = tuple(range(len(self._steps)))
        self.children = [self._steps[k] for k in order]
        self.current_child = self.children[0] if self.children else None


class TryElse(Selector):
    """``Try``: the body, and if that fails the otherwise."""

    def __init__(self, name: str, node: Try, body: Behaviour, otherwise: Behaviour) -> None:
        super().__init__(name, memory=True, children=[body, otherwise])
        self.node = node


class ChooseBranch(Composite):
    """``If``: test the condition once, then follow the branch; without an otherwise there is nothing to fail."""

    def __init__(self, name: str, node: If, attempt: Attempt, branches: list[Behaviour]) -> None:
        super().__init__(name, branches)
        self.node = node
        self._attempt = attempt

    def initialise(self) -> None:
        """Test the condition and choose the branch."""
        found = evaluate(self.node.condition, self._attempt.facts)
        self._attempt.emit(Decided(t=self._attempt.t, node=self.node.id, holds=found.holds, why=found.why))
        branches = iter(self.children)
        then, otherwise = next(branches), next(branches, None)
        self.current_child = then if found.holds else otherwise

    def tick(self) -> Iterator[Behaviour]:
        """Tick the branch that was chosen."""
        if self.status != Status.RUNNING:
            for child in self.children:
                if child.status != Status.INVALID:
                    child.stop(Status.INVALID)
            self.initialise()
        status = Status.SUCCESS
        if self.current_child is not None:
            yield from self.current_child.tick()
            status = self.current_child.status
        if status != Status.RUNNING:
            self.stop(status)
        self.status = status
        yield self
