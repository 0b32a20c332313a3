"""Follow a plan along an event log: how many captures each action was to give on the branch that was taken.

A robot does one thing after another, so the events of a node stand together; the plan says what must come, the log says
which branch, how many places, what was given up. Where the two do not fit (a log of another program, a log that was cut
off) the rest of a node counts as not reached and the replay goes on at the next node that the log names.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import Enum, auto

from fieldhand.evaluation.tally import Tallies, Tally
from fieldhand.language import message
from fieldhand.task import plan as p
from fieldhand.task.results import (
    Acted,
    Arrived,
    ClockSet,
    Decided,
    Driving,
    Ended,
    Event,
    Exited,
    Faulted,
    InDoubt,
    LimitCrossed,
    Obstructed,
    Shed,
    Visiting,
    Waited,
)


class _Flow(Enum):
    """How a node came to its end."""

    DONE = auto()
    FAILED = auto()
    CUT = auto()
    STOPPED = auto()


def replay(plan: p.Node, events: Sequence[Event]) -> dict[str, Tally]:
    """The tally of every action of a plan, by the id of its node."""
    return _Replay(plan, events).run()


class _Replay:
    """The plan, the events that belong to it, and how far they are read."""

    def __init__(self, plan: p.Node, events: Sequence[Event]) -> None:
        self._plan = plan
        self._tallies = Tallies(plan)
        self._inside = self._tallies.inside
        own = self._inside[plan.id]
        over = next((k for k, e in enumerate(events) if isinstance(e, Exited | Ended)), len(events))
        self._orderly = any(isinstance(e, Ended) and e.status in ("completed", "returned", "exceeded") for e in events)
        # The exit itself belongs to the plan only where a stop took it: then it names that stop.
        # What stood in the way, waiting, and what was crossed say nothing of the plan.
        aside = (Obstructed, Waited, ClockSet, LimitCrossed)
        self._events = [e for e in events[: over + 1] if e.node in own and not isinstance(e, aside)]
        self._next = 0

    def run(self) -> dict[str, Tally]:
        for event in self._events:
            if isinstance(event, Acted) and event.node in self._tallies.of:
                tally = self._tallies.of[event.node]
                tally.reached = True
                tally.done += event.count if event.status == "success" else 0
            elif isinstance(event, InDoubt) and event.node in self._tallies.of:
                self._tallies.of[event.node].reached = True
                self._tallies.of[event.node].in_doubt += event.then == "skip"
        self._play(self._plan)
        return self._tallies.of

    # --- the log -----------------------------------------------------------------------------------------------

    def _peek(self) -> Event | None:
        return self._events[self._next] if self._next < len(self._events) else None

    def _comes(self, nodes: Iterable[p.Node]) -> bool:
        """Whether the next event belongs to one of these nodes."""
        event = self._peek()
        return event is not None and any(event.node in self._inside[node.id] for node in nodes)

    # --- nodes -------------------------------------------------------------------------------------------------

    def _play(self, node: p.Node) -> _Flow:
        match node:
            case p.Sequence(steps=steps):
                return self._sequence(steps)
            case p.AnyOrder(steps=steps):
                return self._any_order(steps)
            case p.ForEach():
                return self._for_each(node)
            case p.Repeat():
                return self._repeat(node)
            case p.If():
                return self._if(node)
            case p.Try():
                return self._try(node)
            case p.Optional():
                return self._optional(node)
            case p.Act():
                return self._act(node)
            case p.GoTo():
                return self._go_to(node)
            case p.Stop():
                self._next += self._comes([node])
                return _Flow.STOPPED

    def _sequence(self, steps: Sequence[p.Node]) -> _Flow:
        for k, step in enumerate(steps):
            flow, rest = self._play(step), steps[k + 1 :]
            if flow is _Flow.DONE or (flow is _Flow.FAILED and self._comes(rest)):
                continue
            self._leave(rest, flow)
            return flow
        return _Flow.DONE

    def _any_order(self, steps: Sequence[p.Node]) -> _Flow:
        left = list(steps)
        while left:
            step = next((s for s in left if self._comes([s])), None)
            if step is None:
                # Nothing more of it in the log. A step without events of its own (a stop) is played at the end.
                if all(self._silent(s) for s in left):
                    return self._sequence(left)
                self._leave(left, _Flow.CUT)
                return _Flow.CUT if self._peek() is None else _Flow.DONE
            left.remove(step)
            flow = self._play(step)
            if flow is not _Flow.DONE and not self._comes(left):
                self._leave(left, flow)
                return flow
        return _Flow.DONE

    def _for_each(self, node: p.ForEach) -> _Flow:
        event = self._skim(node)
        if not isinstance(event, Visiting):
            return self._absent(node)
        self._next += 1
        listed, places, visits, shed = frozenset(event.places), len(event.places), 0, 0
        most = places if node.at_most is None else min(places, node.at_most)
        while True:
            event = self._skim(node)
            left = min(most, places - shed) - visits
            if isinstance(event, Shed) and event.node == node.id:
                # Places that were closed when the loop began are shed, and not among those to visit.
                shed += len(listed.intersection(event.places))
                self._shed(node, event)
            elif isinstance(event, Decided) and event.node == node.id:
                self._next += 1
                if event.holds:
                    return _Flow.DONE
            elif left > 0 and self._comes([node.body]):
                visits += 1
                before = self._tallies.copies(node.body)
                flow = self._play(node.body)
                event = self._peek()
                if self._sheds(node) and flow is _Flow.FAILED:
                    # The visit itself was given up half-way: what it lacks is left out, not failed.
                    visits -= 1
                    self._tallies.forgive(before)
                elif flow is not _Flow.DONE and not self._goes_on(node):
                    self._unmade(node, most - visits, flow)
                    return flow
            else:
                break
        if not node.optional or left > 0:
            self._unmade(node, most - visits, _Flow.CUT)
        if left <= 0 or self._silent(node.body):
            return _Flow.DONE
        return _Flow.CUT if event is None else _Flow.FAILED

    def _repeat(self, node: p.Repeat) -> _Flow:
        for k in range(node.times):
            flow, left = self._play(node.body), node.times - k - 1
            event = self._peek()
            if isinstance(event, Shed) and event.node == node.id:
                self._shed(node, event)
                self._leave([node.body], flow, left)
                return _Flow.FAILED
            if isinstance(event, Decided) and event.node == node.id:
                self._next += 1
                if event.holds:
                    return _Flow.DONE
            elif event is None and node.until is not None and flow is not _Flow.STOPPED:
                # The log stops before the test: whether there was to be another round is not known.
                if left:
                    self._tallies.open(node.body)
                return flow
            elif flow is not _Flow.DONE and not self._comes([node]):
                if left:
                    self._leave([node.body], flow, left)
                return flow
        return _Flow.DONE

    def _if(self, node: p.If) -> _Flow:
        event = self._skim(node)
        if not isinstance(event, Decided):
            return self._absent(node)
        self._next += 1
        taken, other = (node.then, node.otherwise) if event.holds else (node.otherwise, node.then)
        for tally in self._tallies.under(other) if other is not None else ():
            tally.skipped.append(event.why)
        return _Flow.DONE if taken is None else self._play(taken)

    def _try(self, node: p.Try) -> _Flow:
        flow = self._play(node.body)
        if self._comes([node.otherwise]):
            return self._play(node.otherwise)
        for tally in self._tallies.under(node.otherwise):
            if flow is _Flow.DONE or flow is _Flow.STOPPED:
                tally.skipped.append(message("what it stands in for went well", context="log"))
            else:
                tally.open = tally.undecided = True
        return flow

    def _optional(self, node: p.Optional) -> _Flow:
        self._skim(node)
        if not self._comes([node]) and not self._silent(node.body):
            return self._absent(node)
        before, flow = self._tallies.copies(node.body), _Flow.FAILED
        if not self._sheds(node):
            flow = self._play(node.body)
        event = self._peek()
        # Behind work that was done whole it is the next time that was shed; a drive alone may have left no trace.
        of_this = flow is not _Flow.DONE or isinstance(list(p.walk(node.body))[-1], p.GoTo)
        if isinstance(event, Shed) and self._sheds(node) and of_this:
            # Given up as a whole or half-way: what it lacks is left out, not failed.
            self._next += 1
            self._tallies.forgive(before)
            self._tallies.spare(node, event)
            return _Flow.DONE
        return flow

    def _act(self, node: p.Act) -> _Flow:
        tally = self._tallies.of[node.id]
        tally.wanted += node.count
        captures, unknown, failed_at, faulted = 0, 0, 0, False
        while captures + unknown < node.count:
            event = self._peek()
            if event is None or event.node != node.id:
                break
            # The same place again from the first attempt is the next visit; the last one failed for good.
            begun = captures + unknown > 0 or failed_at > 0
            if isinstance(event, Acted):
                if failed_at and event.attempt <= failed_at:
                    break
                good = event.status == "success"
                captures, failed_at = (captures + event.count, 0) if good else (captures, event.attempt)
            elif isinstance(event, InDoubt):
                unknown, failed_at = (unknown + 1, 0) if event.then == "skip" else (unknown, failed_at)
            elif isinstance(event, Faulted):
                faulted = faulted or not event.handled
            elif isinstance(event, Shed):
                tally.given_up += max(1, len(event.places))
                tally.reasons.append(event.reason)
                faulted = True
            elif begun:
                break
            self._next += 1
        tally.seen += captures
        if captures + unknown >= node.count:
            return _Flow.DONE
        tally.failed += 1 if failed_at else 0
        return _Flow.CUT if self._peek() is None and not (failed_at or faulted) else _Flow.FAILED

    def _go_to(self, node: p.GoTo) -> _Flow:
        flow = _Flow.DONE
        while (event := self._peek()) is not None and event.node == node.id:
            if isinstance(event, Shed) or (isinstance(event, Faulted) and not event.handled):
                flow = _Flow.FAILED
            self._next += 1
            if isinstance(event, Arrived):
                return _Flow.DONE
        return flow

    # --- what was not reached ----------------------------------------------------------------------------------

    def _skim(self, node: p.Node) -> Event | None:
        """The next event, drives and faults of the node itself passed over."""
        while (event := self._peek()) is not None:
            if event.node != node.id or not isinstance(event, Driving | Arrived | Faulted):
                return event
            self._next += 1
        return None

    def _sheds(self, node: p.Node) -> bool:
        """Whether the log goes on with optional work of this very node that was given up."""
        event = self._peek()
        return isinstance(event, Shed) and event.node == node.id and event.optional

    def _absent(self, node: p.Node) -> _Flow:
        """The log never came to this node."""
        event = self._peek()
        if isinstance(event, Shed) and event.node == node.id:
            self._shed(node, event)
        flow = _Flow.CUT if self._peek() is None else _Flow.DONE
        self._leave([node], _Flow.CUT)
        return flow

    def _goes_on(self, node: p.ForEach) -> bool:
        """Whether the log has more of this very loop, so that a failed visit did not end it."""
        event = self._peek()
        return event is not None and event.node in self._inside[node.id] and not isinstance(event, Visiting)

    def _unmade(self, node: p.ForEach, left: int, flow: _Flow) -> None:
        """The visits that a loop still had before it when it ended."""
        if left <= 0:
            return
        if flow is _Flow.STOPPED:
            self._leave([node.body], flow)
        elif node.optional:
            # An optional loop is whole when the mission ended in order: what it left out, the budget left out.
            if not self._orderly:
                self._tallies.open(node.body)
        elif node.until is not None:
            self._tallies.open(node.body)
        else:
            self._leave([node.body], flow, left)

    def _leave(self, nodes: Iterable[p.Node], flow: _Flow, times: int = 1) -> None:
        """Nodes that the robot did not come to."""
        for node in nodes:
            if flow is _Flow.STOPPED:
                for tally in self._tallies.under(node):
                    tally.stopped = True
            else:
                self._tallies.miss(node, times)

    def _shed(self, node: p.Node, event: Shed) -> None:
        self._next += 1
        self._tallies.shed(node, event)

    def _silent(self, node: p.Node) -> bool:
        """Whether a node holds nothing that must leave a trace in the log."""
        return not any(isinstance(n, p.Act | p.If) for n in p.walk(node))
