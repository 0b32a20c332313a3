"""Loops: a body again and again, at each place of a selector or a number of times.

py_trees calls ``initialise`` when a loop that is not running is ticked; it begins with no round done. ``tick`` begins
a round when none is in progress (:meth:`Loop.begin_round`), ticks the body, and when the body has succeeded asks
whether that was the last (:meth:`Loop.end_round`). A loop fails as soon as its body does. ``stop`` of py_trees stops
a body that is running.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Literal

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence as PyTreesSequence
from py_trees.decorators import Decorator

from fieldhand.errors import BlockedFault, FieldhandError, OutputError
from fieldhand.execution.attempt import Attempt
from fieldhand.execution.behaviors.leaves import Leaf
from fieldhand.execution.behaviors.surroundings import admitted, is_caught, shed, to_come_around, visit_to
from fieldhand.execution.goals import drive
from fieldhand.execution.obstacles import no_way
from fieldhand.execution.waiting import Steps
from fieldhand.forecast.conditions import evaluate
from fieldhand.forecast.routes import home_if_last, order_visits, reachable, standing, visits_in_order
from fieldhand.forecast.state import Choice, Visit
from fieldhand.language import message
from fieldhand.site.model import Place
from fieldhand.task.conditions import Condition
from fieldhand.task.plan import ForEach, Node, Repeat
from fieldhand.task.results import Decided, Visiting
from fieldhand.task.words import listed

#: So many places are named in a message.
_NAMED = 8

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

    A place that the robot finds no way to, because of what stands in its way, is put off to the end. What is then still
    out of reach is given up: where the visits were mandatory, the loop has failed when all others are made.

    Attributes:
        left: Visits that are still to be made, in the order planned.
        cut_off: Those to which no way is left.
        place: The place of the visit in hand.
    """

    node: ForEach

    def __init__(self, name: str, node: ForEach, attempt: Attempt, body: Behaviour) -> None:
        arrive = ArriveAtPlace(f"{node.id} drive to the next place", node, attempt, self)
        super().__init__(name, node, attempt, PyTreesSequence(f"{node.id} visit", memory=True, children=[arrive, body]))
        self.left: list[Visit] = []
        self.cut_off: list[Visit] = []
        self.place: Place | None = None
        self._visited: list[Place] = []
        self._missed: list[Place] = []
        self._why = ""
        self._ways = 0

    def begin_loop(self) -> None:
        node, attempt = self.node, self.attempt
        self.left, self.cut_off, self.place, self._visited, self._missed = [], [], None, [], []
        self._ways = attempt.blockages.version
        places = attempt.resolve(node.select)
        closed: tuple[Place, ...] = ()
        cut_off: tuple[Place, ...] = ()
        if node.optional:
            places, closed = reachable(attempt.drives, places)
        if node.optional:
            ordered = standing(attempt.drives, attempt.standing, places)
            self.left = list(attempt.visits.of_places(node, ordered, attempt.state(node.id).context))
        else:
            places, cut_off = self._parted(places)
            home = home_if_last(attempt.task, attempt.site, node.id, attempt.here)
            ordered = visits_in_order(node, attempt.drives, attempt.standing, places, home)
            self.left = [visit_to(attempt, place, node.body) for place in ordered]
            self.cut_off = [visit_to(attempt, place, node.body) for place in cut_off]
        ids = tuple(place.id for place in (*ordered, *cut_off))
        attempt.emit(Visiting(t=attempt.t, node=node.id, places=ids, optional=node.optional))
        if closed:
            why = f"{closed[0].kind} {closed[0].id} is {attempt.drives.problem(closed[0])}"
            self._give_up(closed, f"cannot be reached: {why}")

    def begin_round(self) -> Next:
        if self._ways != self.attempt.blockages.version:
            self._look_again()
        if self._enough():
            return "done"
        if self.left:
            return self._next_chosen() if self.node.optional else self._next_in_order()
        if self.cut_off:
            self.place = self.cut_off[0].place
            return "round"
        if self._missed:
            missed = _missed(self._missed)
            raise BlockedFault(f"{missed}: {self._why}")
        return "done"

    def end_round(self) -> bool:
        if self.place is not None:
            self._visited.append(self.place)
        over = not self.left and not self.cut_off and not self._missed
        return self.holds(self.node.until) or over or self._enough()

    def undone(self) -> tuple[Place, ...]:
        """The places of the visits that are still to be made."""
        return tuple(v.place for v in (*self.left, *self.cut_off))

    @property
    def is_last_resort(self) -> bool:
        """Whether the visit in hand is one that was put off: now it is worth waiting for."""
        return bool(self.cut_off) and self.place == self.cut_off[0].place

    def arrived(self) -> None:
        """The robot has come to the place in hand."""
        if self.is_last_resort:
            self.cut_off.pop(0)

    def cannot_reach(self, fault: BlockedFault) -> None:
        """Put the visit in hand off or, where that was done, give it up with all to which no way is left either."""
        place = self.place
        assert place is not None  # noqa: S101  a round begins with a place
        if self.node.optional:
            self._give_up([place], fault.what)
        elif not self.is_last_resort and no_way(self.attempt, [place])[0]:
            self.cut_off.append(visit_to(self.attempt, place, self.node.body))
        else:
            gone = [p for p, cut in zip(self._off(), no_way(self.attempt, self._off()), strict=True) if cut]
            given_up = [place, *(p for p in gone if p != place)] if self.is_last_resort else [place]
            self.cut_off = [v for v in self.cut_off if v.place not in given_up]
            self._missed += given_up
            self._give_up(given_up, fault.what)

    def _off(self) -> list[Place]:
        return [v.place for v in self.cut_off]

    def _give_up(self, places: Sequence[Place], why: str) -> None:
        self._why = why
        choice, optional = Choice(index=None, reason=why), self.node.optional
        shed(self.attempt, self.node.id, places, choice, optional=optional, cause="unreachable")

    def leave_loop(self) -> None:
        """After the loop its label means every place that it visited."""
        if self._visited:
            self.attempt.bind(self.node.label, tuple(self._visited))

    def still_to_come(self) -> list[Visit]:
        """The visits after the one in hand, as the guard sees them."""
        if self.node.at_most is None:
            return list(self.left)
        return self.left[: max(0, self.node.at_most - len(self._visited) - 1)]

    def _parted(self, places: Sequence[Place]) -> tuple[tuple[Place, ...], tuple[Place, ...]]:
        """Those to which there is a way from where the robot stands, and those that what it found cuts off."""
        gone = no_way(self.attempt, places)
        return (
            tuple(p for p, cut in zip(places, gone, strict=True) if not cut),
            tuple(p for p, cut in zip(places, gone, strict=True) if cut),
        )

    def _look_again(self) -> None:
        """The ways have changed: which places are cut off, from which side the others are reached, in which order."""
        attempt, node = self.attempt, self.node
        self._ways = attempt.blockages.version
        if not attempt.blockages.stretches and not self.cut_off:
            return
        visits = {(v.place.kind, v.place.id): v for v in (*self.left, *self.cut_off)}
        near, far = self._parted([v.place for v in visits.values()])
        if node.optional and far:
            self._give_up(far, "no way to it is left: what the robot found in its way closes it off")
            far = ()
        open_ = [replace(p, stand=None) if p.kind == "tree" else p for p in near]
        ordered = standing(attempt.drives, attempt.standing, open_)
        if node.order == "best" and not node.optional:
            home = home_if_last(attempt.task, attempt.site, node.id, attempt.here)
            ordered = tuple(ordered[k] for k in order_visits(attempt.drives, attempt.standing, ordered, home))
        self.left = [replace(visits[p.kind, p.id], place=p) for p in ordered]
        self.cut_off = [replace(visits[p.kind, p.id], place=replace(p, stand=None)) for p in far]

    def _enough(self) -> bool:
        return self.node.at_most is not None and len(self._visited) >= self.node.at_most

    def _next_in_order(self) -> Next:
        """Ask the guard whether the next visit may be made."""
        visit = self.left.pop(0)
        refused, later = [visit.place, *self.undone()], self.still_to_come()
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
        self.place = place = self._loop.place
        assert place is not None  # noqa: S101  a round begins with a place
        loop = self._loop
        try:
            patient = loop.is_last_resort
            yield from drive(self.attempt, self.node.id, place, patient=patient, ask=self._asked)
        except BlockedFault as fault:
            loop.cannot_reach(fault)
            self.attempt.giving_up = loop.node.id
            while True:
                yield
        loop.arrived()
        self.attempt.bind(self._label, (place,))

    def _asked(self, place: Place) -> Steps:
        """Ask the guard again on the way; wait for ever if it says no, as :meth:`permission` does."""
        visit, loop = visit_to(self.attempt, place, self._loop.node.body), self._loop
        refused, later = [place, *loop.undone()], loop.still_to_come()
        if not admitted(self, loop.node, self.attempt, visit, refused=refused, later=later):
            while True:
                yield


def _ids(places: Sequence[Place]) -> str:
    return listed([p.id for p in places[:_NAMED]]) + (" and others" if len(places) > _NAMED else "")


def _missed(places: Sequence[Place]) -> str:
    if len(places) == 1:
        return message("1 place could not be reached ({ids})", context="log", ids=_ids(places))
    return message("{count} places could not be reached ({ids})", context="log", count=len(places), ids=_ids(places))
