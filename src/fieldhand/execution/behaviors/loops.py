"""Loops: a body again and again, at each place of a selector or a number of times.

py_trees calls ``initialise`` when a loop that is not running is ticked; it begins with no round done. ``tick`` begins
a round when none is in progress (:meth:`Loop.begin_round`), ticks the body, and when the body has succeeded asks
whether that was the last (:meth:`Loop.end_round`). A loop fails as soon as its body does. ``stop`` of py_trees stops
a body that is running.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence as PyTreesSequence
from py_trees.decorators import Decorator

from fieldhand.errors import FieldhandError, OutputError
from fieldhand.execution.attempt import Attempt
from fieldhand.execution.behaviors.leaves import Leaf
from fieldhand.execution.behaviors.surroundings import admitted, is_caught, shed, to_come_around, visit_to
from fieldhand.execution.conditions import evaluate
from fieldhand.execution.goals import Steps, drive
from fieldhand.forecast.routes import home_if_last, reachable, standing, visits_in_order
from fieldhand.forecast.state import Choice, Visit
from fieldhand.site.model import Place
from fieldhand.task.conditions import Condition
from fieldhand.task.plan import ForEach, Node, Repeat
from fieldhand.task.results import Decided, Visiting

#: What comes now: a round, nothing more, or nothing at all because the mission is about to end.
Next = Literal["round", "done", "over"]


class Loop(Decorator):
    """A body in rounds."""

    def __init__(self, name: str, node: Node, attempt: Attempt, body: Behaviour) -> None:
        super().__init__(name, body)
        self.node = node
        self.attempt = attempt
        self._in_round = False

    def begin_loop(self) -> None:
        """What is done once, when the loop is reached."""

    def begin_round(self) -> Next:
        """Whether there is another round."""
        raise NotImplementedError

    def end_round(self) -> bool:
        """Whether the round that was done was the last."""
        raise NotImplementedError

    def leave_loop(self) -> None:
        """What is done once, when the loop is done."""

    def tick(self) -> Iterator[Behaviour]:
        """Tick the loop: at most one round begins in a tick."""
        status = Status.RUNNING
        try:
            if self.status != Status.RUNNING:
                self._in_round = False
                self.begin_loop()
            if not self._in_round:
                following = self.begin_round()
                self._in_round = following == "round"
                status = Status.SUCCESS if following == "done" else Status.RUNNING
        except OutputError:
            raise
        except FieldhandError as error:
            self.attempt.fail(self.node.id, error, handled=is_caught(self))
            status = Status.FAILURE
        if self._in_round and status == Status.RUNNING:
            yield from self.decorated.tick()
            status = self.update()
        if status == Status.SUCCESS:
            self.leave_loop()
        if status != Status.RUNNING:
            self.stop(status)
        self.status = status
        yield self

    def update(self) -> Status:
        """What the body's status means for the loop."""
        status: Status = self.decorated.status
        if status == Status.RUNNING and self.attempt.giving_up == self.node.id:
            self.attempt.giving_up = ""
            self.decorated.stop(Status.INVALID)
            self._in_round = False
            return Status.RUNNING
        if status == Status.SUCCESS:
            self._in_round = False
            return Status.SUCCESS if self.end_round() else Status.RUNNING
        return status

    def holds(self, condition: Condition | None) -> bool:
        """Whether the loop's ``until`` holds now."""
        if condition is None:
            return False
        found = evaluate(condition, self.attempt.facts)
        self.attempt.emit(Decided(t=self.attempt.t, node=self.node.id, holds=found.holds, why=found.why))
        return found.holds


class RepeatBody(Loop):
    """``Repeat``: a number of rounds, or until a condition holds after one."""

    node: Repeat

    def begin_loop(self) -> None:
        self.rounds_left = self.node.times

    def begin_round(self) -> Next:
        if self.rounds_left <= 0:
            return "done"
        self.rounds_left -= 1
        self.attempt.rounds[self.node.id] = self.rounds_left
        return "round"

    def end_round(self) -> bool:
        return self.holds(self.node.until) or self.rounds_left <= 0

    def leave_loop(self) -> None:
        self.attempt.rounds.pop(self.node.id, None)


class ForEachPlace(Loop):
    """``ForEach``: resolve the selector once, then drive to each place and do the body there.

    Attributes:
        left: Visits that are still to be made, in the order planned.
        place: The place of the visit in hand.
    """

    node: ForEach

    def __init__(self, name: str, node: ForEach, attempt: Attempt, body: Behaviour) -> None:
        arrive = ArriveAtPlace(f"{node.id} drive to the next place", node, attempt, self)
        super().__init__(name, node, attempt, PyTreesSequence(f"{node.id} visit", memory=True, children=[arrive, body]))
        self.left: list[Visit] = []
        self.place: Place | None = None
        self._visited: list[Place] = []

    def begin_loop(self) -> None:
        node, attempt = self.node, self.attempt
        self.left, self.place, self._visited = [], None, []
        places = attempt.resolve(node.select)
        closed: tuple[Place, ...] = ()
        if node.optional:
            places, closed = reachable(attempt.drives, places)
        if node.optional:
            ordered = standing(attempt.drives, attempt.standing, places)
            self.left = list(attempt.visits.of_places(node, ordered, attempt.state(node.id).context))
        else:
            home = home_if_last(attempt.task, attempt.site, node.id, attempt.here)
            ordered = visits_in_order(node, attempt.drives, attempt.standing, places, home)
            self.left = [visit_to(attempt, place, node.body) for place in ordered]
        ids = tuple(place.id for place in ordered)
        attempt.emit(Visiting(t=attempt.t, node=node.id, places=ids, optional=node.optional))
        if closed:
            why = f"{closed[0].kind} {closed[0].id} is {attempt.drives.problem(closed[0])}"
            shed(attempt, node.id, closed, Choice(index=None, reason=f"cannot be reached: {why}"), optional=True)

    def begin_round(self) -> Next:
        if not self.left or self._enough():
            return "done"
        return self._next_chosen() if self.node.optional else self._next_in_order()

    def end_round(self) -> bool:
        if self.place is not None:
            self._visited.append(self.place)
        return self.holds(self.node.until) or not self.left or self._enough()

    def leave_loop(self) -> None:
        """After the loop its label means every place that it visited."""
        if self._visited:
            self.attempt.bind(self.node.label, tuple(self._visited))

    def still_to_come(self) -> list[Visit]:
        """The visits after the one in hand, as the guard sees them."""
        if self.node.at_most is None:
            return list(self.left)
        return self.left[: max(0, self.node.at_most - len(self._visited) - 1)]

    def _enough(self) -> bool:
        return self.node.at_most is not None and len(self._visited) >= self.node.at_most

    def _next_in_order(self) -> Next:
        """Ask the guard whether the next visit may be made."""
        visit = self.left.pop(0)
        refused, later = [visit.place, *(v.place for v in self.left)], self.still_to_come()
        if not admitted(self, self.node, self.attempt, visit, refused=refused, later=later):
            return "over"
        self.place = visit.place
        return "round"

    def _next_chosen(self) -> Next:
        """Ask the guard which optional visit comes next, and say which are given up."""
        at_most = None if self.node.at_most is None else self.node.at_most - len(self._visited)
        state, to_come = self.attempt.state(self.node.id), to_come_around(self)
        choice = self.attempt.guard.choose(state, list(self.left), at_most=at_most, still_to_come=to_come)
        given_up = set(range(len(self.left))) if choice.index is None else set(choice.shed) - {choice.index}
        if given_up:
            places = [self.left[i].place for i in sorted(given_up)]
            shed(self.attempt, self.node.id, places, choice, optional=True)
        self.place = None if choice.index is None else self.left[choice.index].place
        self.left = [v for i, v in enumerate(self.left) if i not in given_up and i != choice.index]
        return "done" if self.place is None else "round"


class ArriveAtPlace(Leaf):
    """The drive of a visit. The loop has asked the guard already."""

    def __init__(self, name: str, node: ForEach, attempt: Attempt, loop: ForEachPlace) -> None:
        super().__init__(name, node, attempt)
        self._loop = loop
        self._label = node.label

    def work(self) -> Steps:
        place = self._loop.place
        assert place is not None  # noqa: S101  a round begins with a place
        yield from drive(self.attempt, self.node.id, place)
        self.attempt.bind(self._label, (place,))
