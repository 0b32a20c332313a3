"""Compare a plan with an event log: mandatory work done and undone, and each optional visit.

The events of a mission are in the order in which the plan is executed, so both are read in parallel. Where the log does
not continue as the plan does, the mission was cut short there: all work that would have followed is undone.
"""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.errors import PlaceError
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.places.selector import Selector
from fieldhand.site.model import Site
from fieldhand.task import plan as p
from fieldhand.task.results import (
    Acted,
    Arrived,
    ChargeBegun,
    ChargeEnded,
    Decided,
    Driving,
    Ended,
    Event,
    Exited,
    Faulted,
    LimitCrossed,
    Shed,
    Started,
    Visiting,
)
from fieldhand_bench.account import Account, Made, Undone


class _Cut(Exception):
    """Raised where the log does not continue as the plan does. Not an error: it unwinds the plan."""


class _Stopped(Exception):
    """Raised at a stop of the plan. Not an error: the steps that follow are not required."""


def follow(root: p.Node, site: Site, events: Sequence[Event]) -> Account:
    """Read a plan and an event log in parallel and return the work that was done and undone."""
    reader = _Reader(site, events)
    try:
        reader.play(root)
    except _Cut:
        reader.account.rest = tuple(reader.left)
    except _Stopped:
        pass
    ends = Faulted | Shed if reader.account.rest else Faulted
    beyond = next((e for e in reader.left if not isinstance(e, ends)), None)
    if beyond is not None:
        reader.account.odd.append(f"{beyond.event} of {beyond.node} at {beyond.t:.0f} s is not what the plan says")
    return reader.account


class _Reader:
    """A position in an event log, with the account of the work read so far."""

    def __init__(self, site: Site, events: Sequence[Event]) -> None:
        self._site = site
        over = next((k for k, e in enumerate(events) if isinstance(e, Exited | Ended)), len(events))
        aside = Driving | Arrived | ChargeBegun | ChargeEnded  # of a charge that interrupts the plan
        self.left = [
            e
            for e in events[:over]
            if not isinstance(e, Started | LimitCrossed) and (e.node or not isinstance(e, aside))
        ]
        self.account = Account()
        self._here = ""
        self._optional = 0
        self._runs = 0

    # --- the log -----------------------------------------------------------------------------------------------------

    def _peek(self) -> Event | None:
        while self.left and isinstance(self.left[0], Faulted) and self.left[0].handled:
            self.left.pop(0)
        return self.left[0] if self.left else None

    def _comes(self, node: p.Node) -> bool:
        """Return True if the next event belongs to a node or to one inside it."""
        event = self._peek()
        return event is not None and any(n.id == event.node for n in p.walk(node))

    def _drives(self, node: p.Node) -> str | None:
        """Consume the next drive of a node and return its destination; None if another event comes next."""
        event = self._peek()
        if isinstance(event, Driving) and event.node == node.id:
            self.left.pop(0)
            event = self._peek()
            while isinstance(event, Driving) and event.node == node.id:  # broken off to charge, and begun again
                self.left.pop(0)
                event = self._peek()
            if not isinstance(event, Arrived):
                raise _Cut
        if not isinstance(event, Arrived) or event.node != node.id:
            return None
        self.left.pop(0)
        self._here = event.place
        return event.place

    def _decided(self, node: p.Node) -> bool:
        event = self._peek()
        if not isinstance(event, Decided) or event.node != node.id:
            raise _Cut
        self.left.pop(0)
        return event.holds

    # --- nodes -------------------------------------------------------------------------------------------------------

    def play(self, node: p.Node) -> None:
        """Execute a node, consuming its events from the log."""
        match node:
            case p.InOrder(steps=steps):
                self._in_order(steps)
            case p.AnyOrder(steps=steps):
                self._any_order(list(steps))
            case p.ForEach(optional=True):
                self._optional_loop(node)
            case p.ForEach():
                self._loop(node)
            case p.Repeat():
                self._repeat(node)
            case p.If():
                self._if(node)
            case p.Try():
                self._try(node)
            case p.GoTo():
                self._go_to(node)
            case p.Act():
                self._act(node)
            case p.Recharge():
                self._recharge(node)
            case p.StopMission():
                raise _Stopped

    def _in_order(self, steps: Sequence[p.Node]) -> None:
        for k, step in enumerate(steps):
            try:
                self.play(step)
            except _Cut:
                self._miss(*steps[k + 1 :])
                raise

    def _any_order(self, left: list[p.Node]) -> None:
        while left:
            step = next((s for s in left if self._comes(s)), left[0])
            left.remove(step)
            try:
                self.play(step)
            except _Cut:
                self._miss(*left)
                raise

    def _repeat(self, node: p.Repeat) -> None:
        for k in range(node.times):
            try:
                self.play(node.body)
                if node.until is not None and self._decided(node):
                    return
            except _Cut:
                if k + 1 < node.times:
                    self._undo(node.id)
                raise

    def _if(self, node: p.If) -> None:
        try:
            holds = self._decided(node)
        except _Cut:
            self._undo(node.id)
            raise
        if holds:
            self.play(node.then)
        elif node.otherwise is not None:
            self.play(node.otherwise)

    def _try(self, node: p.Try) -> None:
        before = len(self.account.undone)
        try:
            self.play(node.body)
        except _Cut:
            if not self._comes(node.otherwise):
                raise
            del self.account.undone[before:]
            self.play(node.otherwise)

    def _go_to(self, node: p.GoTo) -> None:
        # A robot that is already there records no arrival.
        if self._drives(node) is None and self._here not in self._known(node.place):
            self._miss(node)
            raise _Cut
        self._do()

    def _act(self, node: p.Act) -> None:
        captures = 0
        if node.at is not None:
            self._drives(node)
        while captures < node.count:
            event = self._peek()
            if not isinstance(event, Acted) or event.node != node.id:
                self._undo(node.id, *((self._here,) if node.at is None else self._known(node.at)))
                raise _Cut
            self.left.pop(0)
            captures += event.count if event.status == "success" else 0
        self._do()

    def _recharge(self, node: p.Recharge) -> None:
        self._drives(node)
        charged = False
        while isinstance(event := self._peek(), ChargeBegun | ChargeEnded) and event.node == node.id:
            charged = isinstance(event, ChargeEnded)
            self.left.pop(0)
        if not charged:
            self._miss(node)
            raise _Cut
        self._do()

    def _loop(self, node: p.ForEach) -> None:
        left = self._begun(node)
        if left is None:
            self._miss(node)
            raise _Cut
        wanted = len(left) if node.at_most is None else min(node.at_most, len(left))
        for k in range(wanted):
            place = self._arrives(node, left)
            if place is None:
                self._undo(node.id, *left)
                raise _Cut
            if node.order == "given" and place != left[0]:
                self.account.odd.append(f"{node.id} came to {place} before {left[0]}")
            left.remove(place)
            try:
                self.play(node.body)
                if node.until is not None and self._decided(node):
                    return
            except _Cut:
                if k + 1 < wanted:
                    self._undo(node.id, *left)
                raise

    def _optional_loop(self, node: p.ForEach) -> None:
        left = self._begun(node)
        if left is None:
            raise _Cut
        self._runs += 1
        run, visits = self._runs, 0
        while node.at_most is None or visits < node.at_most:
            if self._sheds(node, left):
                continue
            place = self._arrives(node, left)
            if place is None:
                break
            if place not in left:
                self.account.odd.append(f"{node.id} came to {place} again")
            else:
                left.remove(place)
            if self._visit(node, place):
                self.account.made.append(Made(node=node.id, run=run, place=place))
                visits += 1
                if node.until is not None and self._decided(node):
                    return
        enough = node.at_most is not None and visits >= node.at_most
        if left and not enough:
            if isinstance(self._peek(), Faulted):
                raise _Cut
            self.account.odd.append(f"{node.id} left {len(left)} places out without a word")

    def _visit(self, node: p.ForEach, place: str) -> bool:
        """Return True if the visit was made with all its work."""
        self._optional += 1
        try:
            self.play(node.body)
        except _Cut:
            event = self._peek()
            if isinstance(event, Shed) and event.node == node.id and place in event.places:
                self.left.pop(0)
                self.account.left_out += 1
                return False
            if not isinstance(event, Faulted):
                self.account.odd.append(f"{node.id} broke the visit of {place} off without a word")
            raise
        finally:
            self._optional -= 1
        return True

    def _begun(self, node: p.ForEach) -> list[str] | None:
        """Return the places of a loop as the robot resolved them; None if it never began the loop."""
        event = self._peek()
        if not isinstance(event, Visiting) or event.node != node.id:
            return None
        self.left.pop(0)
        known, found = set(self._known(node.select)), event.places
        some = node.optional or node.at_most is not None
        if known and not (set(found) <= known if some else set(found) == known):
            self.account.odd.append(f"{node.id} has other places than the plan selects")
        return list(found)

    def _arrives(self, node: p.ForEach, left: Sequence[str]) -> str | None:
        """Return the place of the next visit, which is the current place if the robot is already there."""
        place = self._drives(node)
        if place is None and self._here in left and self._comes(node.body):
            return self._here
        if place is not None and not node.optional and place not in left:
            self.account.odd.append(f"{node.id} came to {place}, which is none of its places or was visited")
            raise _Cut
        return place

    def _sheds(self, node: p.ForEach, left: list[str]) -> bool:
        event = self._peek()
        if not isinstance(event, Shed) or event.node != node.id or not event.optional:
            return False
        self.left.pop(0)
        self.account.left_out += len(event.places)
        left[:] = [place for place in left if place not in event.places]
        return True

    # --- work done and undone ----------------------------------------------------------------------------------------

    def _do(self) -> None:
        self.account.done += not self._optional

    def _undo(self, node: str, *places: str) -> None:
        if not self._optional:
            self.account.undone.append(Undone(node=node, places=places))

    def _miss(self, *nodes: p.Node) -> None:
        """Record nodes that were not reached as undone, with their places where these can be resolved."""
        for node in nodes:
            match node:
                case p.InOrder(steps=steps) | p.AnyOrder(steps=steps):
                    self._miss(*steps)
                case p.ForEach(optional=True) | p.StopMission():
                    pass
                case p.ForEach(at_most=None, select=selector) | p.GoTo(place=selector):
                    self._undo(node.id, *self._known(selector))
                case p.Act(at=at):
                    self._undo(node.id, *(() if at is None else self._known(at)))
                case _:
                    self._undo(node.id)

    def _known(self, selector: Selector) -> tuple[str, ...]:
        """Return the ids of a selector's places; none if only the robot can resolve them."""
        if selector.relative:
            return ()
        try:
            return tuple(place.id for place in resolve(selector, self._site, Context(here=self._site.start)))
        except PlaceError:
            return ()
