"""Replay a plan along an event log: the number of captures of each action on the branch that was taken.

The plan is carried out as it is on the robot (:mod:`fieldhand.task.run`), and the log answers what its nodes ask: which
branch, how many places, what was given up. A robot does one thing after another, so the events of a node stand
together. Where the log has no answer (it was cut off, or another program wrote it), what is left of the open nodes
counts as not reached, up to the node behind which the log goes on.
"""

from __future__ import annotations

import itertools
from bisect import bisect_left
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from fieldhand.evaluation.capture_counts import CaptureCount, CaptureCounts
from fieldhand.language import message
from fieldhand.task import instructions as ask
from fieldhand.task.nodes.base import Cut, Failed, GivenUp, Stopped
from fieldhand.task.plan import Act, Node, WorkAlong, acts
from fieldhand.task.results import (
    Acted,
    Arrived,
    ChargeEnded,
    ClockSet,
    Decided,
    Driving,
    Dwelt,
    Ended,
    Event,
    EventBegan,
    EventEnded,
    Exited,
    Faulted,
    InDoubt,
    LimitCrossed,
    Obstructed,
    Shed,
    Strayed,
    Visiting,
    Waited,
    Worked,
    Working,
)
from fieldhand.task.run import PlanRun, RunOutcome, StackFrame, carry_out


def replay_log(plan: Node, events: Sequence[Event]) -> dict[str, CaptureCount]:
    """Return the capture count of every action of a plan, by the id of its node."""
    return _Replay(plan, events).run()


@dataclass(kw_only=True)
class _ReplayedVisits:
    """The visits of a for-each, as the log lists them; the one of an optional step.

    Attributes:
        listed: The places; a tree worked on from both sides is listed twice.
        most: Number of them that may be visited.
        begun: Visits begun, without those given up half-way.
        shed: Number of places given up.
        skipped: Number of places left out because of an event.
        before: The counts when the current visit began.
        missed: True if a mandatory stretch of work was not done whole.
    """

    listed: tuple[str, ...] = ()
    most: int
    begun: int = 0
    shed: int = 0
    skipped: int = 0
    before: Mapping[str, CaptureCount] = field(default_factory=dict)
    missed: bool = False

    @property
    def unmade(self) -> int:
        """Return the number of visits not begun, without those left out because of an event."""
        most = min(self.most, len(self.listed) - self.skipped) if self.skipped else self.most
        return max(0, most - self.begun)

    @property
    def to_come(self) -> int:
        """Return the number of visits that may still follow in the log."""
        return min(self.most, len(self.listed) - self.shed) - self.begun


class _Replay:
    """The plan under way, the events that belong to it, and how far they are read."""

    def __init__(self, plan: Node, events: Sequence[Event]) -> None:
        self._counts = CaptureCounts(plan)
        self._inside = self._counts.inside
        over = next((k for k, e in enumerate(events) if isinstance(e, Exited | Ended)), len(events))
        self._orderly = any(isinstance(e, Ended) and e.status in ("completed", "returned", "exceeded") for e in events)
        # The exit itself belongs to the plan only where a stop took it: then it names that stop.
        # What stood in the way, waiting, events, and what was crossed say nothing of the plan.
        aside = (Obstructed, Strayed, Waited, ClockSet, LimitCrossed, EventBegan, EventEnded)
        self._events = [e for e in events[: over + 1] if e.node in self._inside[plan.id] and not isinstance(e, aside)]
        self._next = 0
        self._of: dict[str, list[int]] = {}
        for position, event in enumerate(self._events):
            self._of.setdefault(event.node, []).append(position)
        self._run = PlanRun(plan)
        self._run.entered, self._run.left = self._entered, self._left

    def run(self) -> dict[str, CaptureCount]:
        self._counts.count(self._events)
        with suppress(Stopped):
            carry_out(self._run.program(), self._answer)
        return self._counts.of

    # --- the log -----------------------------------------------------------------------------------------------

    def _peek(self) -> Event | None:
        return self._events[self._next] if self._next < len(self._events) else None

    def _peek_own(self, node: Node) -> Event | None:
        """Return the next event if it belongs to the node itself."""
        event = self._peek()
        return event if event is not None and event.node == node.id else None

    def _shed(self, node: Node) -> bool:
        """Consume the next event if it reports places of the node itself as given up."""
        event = self._skim(node)
        if not isinstance(event, Shed):
            return False
        self._next += 1
        visits = self._run.frame.tour
        if isinstance(visits, _ReplayedVisits):
            # Places that were closed when the loop began are shed, and not among those to visit.
            shed = sum(place in visits.listed for place in event.places)
            visits.shed += shed
            if event.cause == "event" and event.optional:
                visits.skipped += shed
            visits.missed = visits.missed or not event.optional
        self._counts.shed(node, event)
        return True

    def _comes(self, nodes: Iterable[Node]) -> bool:
        """Return True if the next event belongs to one of these nodes, or to one inside."""
        event = self._peek()
        return event is not None and any(event.node in self._inside[node.id] for node in nodes)

    def _skim(self, node: Node) -> Event | None:
        """Return the next event if it belongs to the node itself, after skipping its drives and faults."""
        while isinstance(event := self._peek_own(node), Driving | Arrived | Faulted):
            self._next += 1
        return event

    def _is_whole(self) -> bool:
        """Return True if the log was not cut off here."""
        return self._orderly or self._peek() is not None

    def _is_unseen(self, node: Node) -> bool:
        """Return True if a node may have been done without an event."""
        return _is_silent(node) and (self._is_whole() or not any(acts(node)))

    def _when(self, node: Node) -> int:
        """Return the position of the next event of a node or of one inside."""
        some = [self._of[name] for name in self._inside[node.id] if name in self._of]
        later = (positions[k] for positions in some if (k := bisect_left(positions, self._next)) < len(positions))
        return min(later, default=len(self._events))

    # --- answers -----------------------------------------------------------------------------------------------

    def _answer(self, request: ask.Instruction) -> Any:
        match request:
            case ask.Capture(node=act):
                self._capture(act)
            case ask.WaitFor(node=node):
                self._wait(node)
            case ask.Charge(node=recharge):
                self._charge(recharge)
            case ask.DriveTo(node=node, tour=None) if node.act is None:
                self._drive(node)
            case ask.Decide(node=node):
                return self._decide(node)
            case ask.BeginVisits(node=loop):
                return self._begin(loop)
            case ask.BeginStretches(node=work):
                return self._begin(work)
            case ask.WorkStretch(node=work, tour=tour):
                self._work(work, tour)
            case ask.NextVisit(node=loop, tour=tour):
                return self._visit(loop, tour)
            case ask.BeginRound(node=repeat, left=left):
                if self._shed(repeat):
                    # All of its rounds are given up, whatever its test would have said.
                    self._counts.miss(repeat.body, left + 1)
                    self._run.frame.left = ()
                    raise self._lost()
            case ask.OfferStep(node=step):
                return self._offer(step)
            case ask.ArrangeSteps(node=node):
                return self._arrange(node)
        return None

    def _arrange(self, node: Node) -> tuple[int, ...]:
        """Return the order of the log; steps without events come last, those that need none (a stop) at the end."""
        if not self._comes([node]) and not self._is_unseen(node):
            raise self._absent(node)
        keys = [(self._when(step), _is_silent(step)) for step in node.children]
        return tuple(sorted(range(len(keys)), key=keys.__getitem__))

    def _capture(self, node: Act) -> None:
        count = self._counts.of[node.id]
        count.wanted += node.count
        captures, unknown, failed_at, place = 0, 0, 0, ""
        while captures + unknown < node.count:
            event = self._peek_own(node)
            # The same place again from the first attempt is the next visit; the last one failed for good.
            begun = captures + unknown > 0 or failed_at > 0
            if isinstance(event, Acted):
                if failed_at and event.attempt <= failed_at:
                    break
                good, place = event.status == "success", event.place
                captures, failed_at = (captures + event.count, 0) if good else (captures, event.attempt)
            elif isinstance(event, InDoubt):
                unknown, failed_at = (unknown + 1, 0) if event.then == "skip" else (unknown, failed_at)
            elif isinstance(event, Shed):
                count.given_up += max(1, len(event.places))
                count.reasons.append(event.reason)
            elif event is None or (begun and not isinstance(event, Faulted)):
                break
            self._next += 1
        count.seen += captures
        if captures + unknown < node.count:
            count.failed += failed_at > 0
            raise self._lost()
        if self._is_skipped(place):
            raise self._lost()

    def _is_skipped(self, place: str | None = None) -> bool:
        """Return True if the next event reports that the visit (to a place) is left out because of an event."""
        event = self._peek()
        if not isinstance(event, Shed) or event.cause != "event" or not event.optional:
            return False
        return place is None or event.places[:1] == (place,)

    def _wait(self, node: Node) -> None:
        """Consume the wait of the node."""
        over = False
        while not over and (event := self._peek_own(node)) is not None:
            self._next += 1
            over = isinstance(event, Dwelt)
        if not over:
            raise self._lost()

    def _work(self, node: WorkAlong, visits: _ReplayedVisits) -> None:
        """Consume the work along one stretch: attempts, drives around obstacles, and what was given up of it."""
        count, name, good, failed = self._counts.of.get(node.id, CaptureCount()), "", False, False
        while (event := self._peek_own(node)) is not None:
            if isinstance(event, Working | Worked):
                if name and event.stretch != name:
                    break
                name = event.stretch
                good = isinstance(event, Worked) and event.status == "success"
                failed = failed or (isinstance(event, Worked) and event.status == "failed")
            elif isinstance(event, Shed):
                if not name or name not in event.places:
                    break
                self._counts.shed(node, event)
                self._next += 1
                visits.missed = visits.missed or not event.optional
                count.wanted += 1
                return
            elif not isinstance(event, Driving | Arrived | Faulted):
                break
            self._next += 1
        count.wanted += 1
        count.seen += good
        if not good:
            count.failed += failed
            raise self._lost()

    def _charge(self, node: Node) -> None:
        """Consume the charges of the node: the last one that began is the one that counts."""
        charged = False
        while (event := self._peek_own(node)) is not None and not isinstance(event, Driving | Arrived):
            charged = isinstance(event, ChargeEnded)
            self._next += 1
        if not charged:
            raise self._lost()

    def _drive(self, node: Node) -> None:
        """Consume the drive of the node; a drive to the current place has no event."""
        step, failed, set_out = self._run.optional, False, False
        while (event := self._peek_own(node)) is not None and not isinstance(event, Arrived):
            failed = failed or isinstance(event, Shed | Faulted)
            set_out = set_out or isinstance(event, Driving)
            self._next += 1
        if event is not None:
            self._next += 1
            return
        shed = step is not None and step.node.is_optional_step and self._peek_own(step.node) is not None
        if failed or shed or (set_out and self._is_skipped()):
            raise self._lost()

    def _decide(self, node: Node) -> bool:
        event = self._skim(node)
        if isinstance(event, Decided):
            self._next += 1
            if node.is_choice:
                for count in self._counts.under(*(node.children[1:] if event.holds else node.children[:1])):
                    count.skipped.append(event.why)
            return event.holds
        if node.is_choice:
            raise self._absent(node)
        if self._peek() is None and self._run.frame.left:
            raise self._lost()
        return False

    def _begin(self, node: Node) -> _ReplayedVisits:
        event = self._skim(node)
        if not isinstance(event, Visiting):
            raise self._absent(node)
        self._next += 1
        most = len(event.places) if node.at_most is None else min(len(event.places), node.at_most)
        return _ReplayedVisits(listed=event.places, most=most)

    def _visit(self, node: Node, visits: _ReplayedVisits) -> bool | None:
        """Begin the next visit if the log has one."""
        while self._shed(node):
            pass
        if visits.to_come <= 0:
            if not node.is_optional:
                self._miss_visits(node, visits)
                if node.work is not None and visits.missed:
                    raise self._lost()
            return None
        seen = self._comes(node.children) or isinstance(self._peek_own(node), Decided | Working | Worked)
        if not seen and not (self._is_whole() and _is_silent(node)):
            raise self._lost()
        visits.begun += 1
        visits.before = self._counts.copies(node)
        return True

    def _offer(self, node: Node) -> bool:
        self._skim(node)
        if self._given_up(self._run.frame):
            return False
        if not self._comes([node]) and not self._is_unseen(node):
            raise self._absent(node)
        self._run.frame.tour = _ReplayedVisits(most=1, begun=1, before=self._counts.copies(node))
        return True

    # --- what was not reached ----------------------------------------------------------------------------------

    def _entered(self, node: Node) -> None:
        if not node.ends_plan:
            return
        self._next += self._comes([node])
        for frame in self._run.frames:
            self._went_well(frame)
            left = frame.node.children if isinstance(frame.tour, _ReplayedVisits) and frame.tour.unmade else frame.left
            for count in self._counts.under(*left):
                count.stopped = True

    def _left(self, _: Node, outcome: RunOutcome) -> None:
        if outcome == "done" and self._run.frames:
            self._went_well(self._run.frame)

    def _went_well(self, frame: StackFrame) -> None:
        for count in self._counts.under(*frame.instead):
            count.skipped.append(message("the step it replaces succeeded", context="log"))

    def _absent(self, node: Node) -> Exception:
        """Count a node that the log never reached; return the exception that continues the replay after it."""
        self._shed(node)
        self._counts.miss(node, 1)
        return self._lost()

    def _lost(self) -> Exception:
        """Count the rest of the open nodes up to the next event; return the exception that continues there."""
        for inner, around in itertools.pairwise(self._run.outwards()):
            self._miss(inner)
            thrown = self._onward(around, inner.node)
            if thrown is not None:
                return thrown
        root = self._run.frames[0]
        self._miss(root)
        return Cut(root.node.id)

    def _onward(self, around: StackFrame, child: Node) -> Exception | None:
        """Return the exception that continues after a child of an open node; None if no event follows there."""
        node, visits = around.node, around.tour
        if isinstance(visits, _ReplayedVisits) and self._given_up(around):
            # What the visit or the step lacks is left out, not failed.
            visits.begun -= 1
            self._counts.forgive(visits.before)
            return GivenUp(node.id)
        if around.instead:
            return Failed(child.id) if self._comes(around.instead) else None
        if node.visits_each:
            return Cut(child.id) if self._comes([node]) and not isinstance(self._peek(), Visiting) else None
        later = around.left if node.rounds is None else (node,)
        return Cut(child.id) if self._comes(later) else None

    def _given_up(self, frame: StackFrame) -> bool:
        """Return True if the next event reports optional work of the node as given up; consume it for a step."""
        node, event = frame.node, self._peek_own(frame.node)
        if not isinstance(event, Shed) or not event.optional:
            return False
        if event.cause != "event" and not node.is_optional:
            return False
        if node.is_optional_step:
            self._next += 1
            self._counts.spare(node, event)
        return True

    def _miss(self, frame: StackFrame) -> None:
        """Count the remaining work of an open node as missed."""
        if isinstance(frame.tour, _ReplayedVisits):
            self._miss_visits(frame.node, frame.tour)
        for count in self._counts.under(*frame.instead):
            count.open = count.undecided = True
        for later in frame.left:
            self._counts.miss(later, 1)

    def _miss_visits(self, node: Node, visits: _ReplayedVisits) -> None:
        if not visits.unmade or (node.is_optional and self._orderly):
            return  # an optional loop is whole when the mission ended in order: the budget left out the rest
        if node.is_optional or node.tested is not None:
            self._counts.open(node)
        else:
            self._counts.miss(*((node, visits.unmade) if node.work is not None else (node.children[0], visits.unmade)))


def _is_silent(node: Node) -> bool:
    """Return True if a node that does not fail may leave no trace in the log."""
    return (
        node.act is None
        and not node.dwell_s
        and node.work is None
        and not node.is_choice
        and all(map(_is_silent, node.caught or node.children))
    )
