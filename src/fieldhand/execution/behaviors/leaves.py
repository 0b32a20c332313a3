"""The leaves of the tree: nodes at which the robot does something, or ends.

py_trees calls ``initialise`` when a leaf that is not running is ticked, ``update`` at every tick, and ``terminate``
when it is done or when the tree takes it out of the running (status INVALID). Here ``initialise`` begins the work
afresh, ``update`` takes it one step further, and ``terminate`` stops the robot if the work was cut short.
"""

from __future__ import annotations

from collections.abc import Generator

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from fieldhand.errors import BlockedFault, FieldhandError, OutputError
from fieldhand.execution.attempt import Attempt, Ending
from fieldhand.execution.behaviors.surroundings import admitted, gives_up_optional, is_caught, visit_to
from fieldhand.execution.goals import capture, drive
from fieldhand.execution.obstacles import open_a_way
from fieldhand.execution.waiting import Steps
from fieldhand.language import message
from fieldhand.site.model import Place
from fieldhand.task.plan import Act, GoTo, Node, Stop
from fieldhand.task.results import MissionStatus


class Leaf(Behaviour):
    """A node whose work is a series of steps (:meth:`work`).

    Attributes:
        place: Where the work is, once that is known.
    """

    def __init__(self, name: str, node: Node, attempt: Attempt) -> None:
        super().__init__(name)
        self.node = node
        self.attempt = attempt
        self.place: Place | None = None
        self._steps: Steps | None = None

    def work(self) -> Steps:
        """The work, from its beginning; yields while the robot is busy, raises when it failed for good."""
        raise NotImplementedError

    def initialise(self) -> None:
        """Begin the work afresh."""
        self.place = None
        self._steps = self.work()

    def update(self) -> Status:
        """Take the work one step further."""
        assert self._steps is not None  # noqa: S101  py_trees calls initialise first
        try:
            next(self._steps)
        except StopIteration:
            return Status.SUCCESS
        except OutputError:
            raise
        except FieldhandError as error:
            if isinstance(error, BlockedFault) and gives_up_optional(self, self.attempt, error):
                return Status.RUNNING
            self.attempt.fail(self.node.id, error, handled=is_caught(self))
            return Status.FAILURE
        return Status.RUNNING

    def terminate(self, new_status: Status) -> None:
        """Stop the robot if the work was cut short."""
        if new_status == Status.INVALID and self.status == Status.RUNNING:
            self.attempt.stop_driver()
        self._steps = None

    def drive(self, place: Place) -> Steps:
        """Drive; where something in the way leads it another way, the guard is asked anew."""
        yield from drive(self.attempt, self.node.id, place, ask=lambda to: self.permission(to, self.node))

    def stand_at(self, place: Place) -> Generator[None, None, Place]:
        """The place with where the robot will stand there; waits where what it found in its way leaves none."""
        if not self.attempt.is_at(place) and self.attempt.standing != place:
            yield from open_a_way(self.attempt, self.node.id, place)
        return self.attempt.reached(place)

    def permission(self, place: Place, work: Node) -> Steps:
        """Wait for ever if the guard forbids the work: the tree is about to be cut off above this leaf."""
        visit = visit_to(self.attempt, place, work)
        if not admitted(self, self.node, self.attempt, visit, refused=[place]):
            while True:
                yield


class GoToPlace(Leaf):
    """``GoTo``: resolve the place now that it is reached, drive there, bind it."""

    def __init__(self, name: str, node: GoTo, attempt: Attempt) -> None:
        super().__init__(name, node, attempt)
        self._goto = node

    def work(self) -> Steps:
        node, attempt = self._goto, self.attempt
        self.place = place = yield from self.stand_at(attempt.resolve_one(node.place))
        yield from self.permission(place, node)
        yield from self.drive(place)
        attempt.bind(node.label, (place,))


class DoAction(Leaf):
    """``Act``: drive if it names a place, then make its captures there; bind the place and what was read.

    Without a place of its own it is work at the place in hand: a robot that a failed drive has left elsewhere drives
    back there first, and where it cannot, the work fails.
    """

    def __init__(self, name: str, node: Act, attempt: Attempt) -> None:
        super().__init__(name, node, attempt)
        self._act = node

    def work(self) -> Steps:
        node, attempt = self._act, self.attempt
        # A reading of an earlier round must not decide anything if this one fails.
        attempt.readings.pop(node.reading, None)
        place = attempt.here if node.at is None else (yield from self.stand_at(attempt.resolve_one(node.at)))
        self.place = place
        yield from self.permission(place, node)
        if node.at is not None or attempt.standing != place:
            yield from self.drive(place)
        attempt.bind(node.label, (place,))
        for _ in range(node.count):
            readings = yield from capture(attempt, node)
            if node.reading:
                attempt.readings[node.reading] = readings


class EndMission(Leaf):
    """``Stop``: the plan is over. It stays running, so that nothing after it is ticked."""

    def __init__(self, name: str, node: Stop, attempt: Attempt) -> None:
        super().__init__(name, node, attempt)
        self._stop = node

    def work(self) -> Steps:
        attempt = self.attempt
        if self._stop.exit == "nominal":
            then = attempt.task.composition.nominal
            status: MissionStatus = "completed"
        else:
            then = attempt.exit_for("action_failed")
            status = "faulted"
        attempt.end(
            Ending(
                status=status,
                exit=self._stop.exit,
                then=then,
                reason=message("the plan says to stop here", context="log"),
                node=self._stop.id,
            )
        )
        while True:
            yield
