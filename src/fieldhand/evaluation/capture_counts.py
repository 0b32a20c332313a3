"""Counts of captures per action of a plan, from an event log."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from fieldhand.task import plan as p
from fieldhand.task.results import Acted, Event, InDoubt, Shed, Worked


@dataclass(kw_only=True)
class CaptureCount:
    """Counts of one action of the plan in an event log; of work along a path, its stretches count as captures.

    Attributes:
        wanted: Captures to be made on the branch that was taken, as far as that is known.
        done: Captures that succeeded.
        in_doubt: Captures that the power cut off and that were not made again.
        seen: Those of them that the replay has come to.
        reached: The robot came to this action at least once.
        open: More may be wanted: a loop or a step that holds the action was not reached, or not to its end.
        undecided: A condition that leads here was not tested.
        failed: Times that it failed for good.
        given_up: Places given up although they had to be visited.
        left_out: Places of an optional loop that were shed.
        spared: Times that an optional step which holds it was shed.
        skipped: Why a branch that leads here was not taken, each time.
        stopped: A stop of the plan came before it.
        stretches: True for work along a path, whose stretches are counted.
        worked_m: Metres worked along them.
    """

    wanted: int = 0
    done: int = 0
    in_doubt: int = 0
    seen: int = 0
    reached: bool = False
    open: bool = False
    undecided: bool = False
    failed: int = 0
    given_up: int = 0
    left_out: int = 0
    spared: int = 0
    skipped: list[str] = field(default_factory=list)
    stopped: bool = False
    stretches: bool = False
    worked_m: float = 0.0
    reasons: list[str] = field(default_factory=list)


class CaptureCounts:
    """The counts of all actions of a plan.

    Attributes:
        of: The count of each action, by the id of its node.
        inside: The ids of a node and of all inside it, by the id of the node.
    """

    def __init__(self, plan: p.Node) -> None:
        self.of = {node.id: CaptureCount(stretches=node.work is not None) for node in p.walk(plan) if _counts(node)}
        self.inside = {node.id: frozenset(n.id for n in p.walk(node)) for node in p.walk(plan)}

    def count(self, events: Iterable[Event]) -> None:
        """Add what was done, wherever the plan was then."""
        worked: dict[tuple[str, str], bool] = {}
        for event in events:
            count = self.of.get(event.node)
            if count is not None and isinstance(event, Worked):
                count.reached = True
                count.worked_m += event.worked_m
                whole = event.status == "success"
                count.done += whole
                worked[event.node, event.stretch] = whole
            if count is not None and isinstance(event, Shed):
                # An obstacle covers a part of the stretch, whose rest was worked.
                count.done -= sum(worked.pop((event.node, place), False) for place in event.places)
            if count is not None and isinstance(event, Acted | InDoubt):
                count.reached = True
                count.done += event.count if isinstance(event, Acted) and event.status == "success" else 0
                count.in_doubt += isinstance(event, InDoubt) and event.then == "skip"

    def under(self, *nodes: p.Node) -> list[CaptureCount]:
        """Return the counts of the actions in some nodes, in plan order."""
        return [self.of[inner.id] for node in nodes for inner in p.walk(node) if _counts(inner)]

    def copies(self, node: p.Node) -> Mapping[str, CaptureCount]:
        """Return copies of the counts of a node's actions, for :meth:`forgive`."""
        return {name: replace(self.of[name]) for name in self.inside[node.id] & self.of.keys()}

    def miss(self, node: p.Node, times: int) -> None:
        """Add what a node wants as far as the plan fixes it; the rest is open."""
        if node.act is not None:
            self.of[node.id].wanted += node.act.count * times
        elif _counts(node):
            self.of[node.id].open = True  # the site determines the number of stretches
        for part in node.parts:
            if part.certain and part.times is not None and node.tested is None and not node.is_optional:
                self.miss(part.node, times * part.times)
            else:
                self.open(part.node, undecided=not (part.certain or node.is_optional))

    def open(self, node: p.Node, *, undecided: bool = False) -> None:
        """More may be wanted of a node's actions; ``undecided``: or nothing, as a condition was not tested."""
        for branch in (child for inner in p.walk(node) if inner.is_choice for child in inner.children):
            for count in self.under(branch):
                count.undecided = True
        for count in self.under(node):
            count.open = True
            count.undecided = count.undecided or undecided

    def forgive(self, before: Mapping[str, CaptureCount]) -> None:
        """Take back what a visit wanted beyond what it gave."""
        for name, old in before.items():
            count = self.of[name]
            count.wanted = old.wanted + count.seen - old.seen
            count.open, count.undecided = old.open, old.undecided

    def spare(self, node: p.Node, event: Shed) -> None:
        """Record that an optional step was given up."""
        for count in self.under(node):
            count.spared += 1
            count.reasons.append(event.reason)

    def shed(self, node: p.Node, event: Shed) -> None:
        """Record that places of a node were given up."""
        unsure = (part.node for inner in p.walk(node) for part in inner.parts if not part.certain)
        perhaps = frozenset[str]().union(*(self.inside[inner.id] for inner in unsure))
        for step in p.walk(node):
            if step.is_optional_step and not event.optional:
                self.spare(step, event)
        for name, count in self.of.items():
            if name not in self.inside[node.id] or (name in perhaps and not event.optional):
                continue
            if event.optional:
                count.left_out += len(event.places)
            else:
                count.given_up += max(1, len(event.places))
            if event.reason not in count.reasons:
                count.reasons.append(event.reason)


def _counts(node: p.Node) -> bool:
    """Return True if a node is an action at a place or along a path."""
    return node.act is not None or (node.work is not None and bool(node.work.action))
