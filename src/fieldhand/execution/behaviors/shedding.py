"""An optional step: the guard is asked once about all of it; then it is done, or it is shed and the mission goes on."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator

from fieldhand.errors import DriveFault, FieldhandError, OutputError
from fieldhand.execution.attempt import Attempt
from fieldhand.execution.behaviors.surroundings import first_places_of, is_caught, shed, to_come_around
from fieldhand.forecast.state import Choice
from fieldhand.language import message
from fieldhand.site.model import Place
from fieldhand.task.plan import Optional


class DoIfItFits(Decorator):
    """``Optional``: the body, if the guard chooses it when the node is reached; else nothing, which is no failure.

    py_trees ticks it afresh when it is not running: then the guard is asked. A body that is given up while it runs
    (:attr:`Attempt.giving_up`) is stopped, and the node succeeds.

    Attributes:
        place: Where the step begins, once the guard has been asked.
    """

    def __init__(self, name: str, node: Optional, attempt: Attempt, body: Behaviour) -> None:
        super().__init__(name, body)
        self.node = node
        self.attempt = attempt
        self.place: Place | None = None

    def tick(self) -> Iterator[Behaviour]:
        """Ask the guard, if that has not been done; then tick the body."""
        status = Status.RUNNING
        if self.status != Status.RUNNING:
            try:
                status = Status.RUNNING if self._fits() else Status.SUCCESS
            except OutputError:
                raise
            except FieldhandError as error:
                self.attempt.fail(self.node.id, error, handled=is_caught(self))
                status = Status.FAILURE
        if status == Status.RUNNING:
            yield from self.decorated.tick()
            status = self.update()
        if status != Status.RUNNING:
            self.stop(status)
        self.status = status
        yield self

    def update(self) -> Status:
        """What the body's status means for the step."""
        status: Status = self.decorated.status
        if status == Status.RUNNING and self.attempt.giving_up == self.node.id:
            self.attempt.giving_up = ""
            self.decorated.stop(Status.INVALID)
            return Status.SUCCESS
        return status

    def _fits(self) -> bool:
        """Ask the guard whether the step may be done; where not, say that it is shed, and why."""
        node, attempt = self.node, self.attempt
        state = attempt.state(node.id)
        try:
            visit = attempt.visits.of_step(node, state.context)
        except DriveFault as fault:
            why = message("cannot be reached: {why}", context="log", why=fault.what)
            never = Choice(index=None, reason=why)
            shed(attempt, node.id, first_places_of(node, attempt), never, optional=True, cause="unreachable")
            return False
        self.place = visit.place
        choice = attempt.guard.choose(state, [visit], still_to_come=to_come_around(self))
        if choice.index is None:
            shed(attempt, node.id, [visit.place], choice, optional=True)
        return choice.index is not None
