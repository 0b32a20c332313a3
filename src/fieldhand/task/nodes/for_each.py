"""A node executed at each place of a selector."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from fieldhand.task.instructions import BeginSeries, BeginVisits, BindLabel, Decide, DriveTo, NextVisit
from fieldhand.task.nodes.base import ChildNode, GivenUp, K, PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.places.selector import Selector
    from fieldhand.task.conditions import Condition
    from fieldhand.task.instructions import OpaquePlace
    from fieldhand.task.plan import Node
    from fieldhand.task.run import PlanRun


@dataclass(frozen=True, kw_only=True)
class ForEach(PlanNode):
    """``body`` at each place of a selector.

    The selector is resolved once, when the node is reached. Each visit drives to the next place, binds the label to it
    and executes the body, until no place is left, ``at_most`` visits are made, or ``until`` is true after a visit. An
    abandoned visit does not count. Afterwards the label is bound to every place that was visited.

    Attributes:
        label: Names the place for ``Bound(label=...)`` in ``body``.
        order: ``best`` for the shortest drive; ``given`` for the order of the selector.
        optional: Visits may be dropped to keep the budget, least worth first ("as many as you can").
        at_most: Maximum number of visits ("up to 6").
        reward: Attribute that a visit is worth, else 1.
        reward_by: ``lowest`` if the lowest rank first ("as many weak vines as you can"); ``highest``.
        until: Stop once this holds after a visit.
        collects: Reading of which all readings so far are forgotten when the loop begins.
    """

    id: str = ""
    select: Selector
    body: Node
    label: str = ""
    order: Literal["best", "given"] = "best"
    optional: bool = False
    at_most: int | None = None
    reward: str = ""
    reward_by: Literal["value", "highest", "lowest"] = "value"
    until: Condition | None = None
    collects: str = ""
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:
        frame = run.frame
        if self.collects:
            yield BeginSeries(node=self, reading=self.collects)
        frame.tour = tour = yield BeginVisits(node=self)
        visited: list[OpaquePlace] = []
        while self.at_most is None or len(visited) < self.at_most:
            place: OpaquePlace | None = yield NextVisit(node=self, tour=tour, made=len(visited))
            if place is None:
                break
            try:
                place = yield DriveTo(node=self, place=place, tour=tour)
                yield BindLabel(node=self, label=self.label, places=(place,))
                yield from run.do(self.body)
            except GivenUp as given_up:
                if given_up.node != self.id:
                    raise
                continue
            visited.append(place)
            frame.made = len(visited)
            if self.until is not None and (yield Decide(node=self, condition=self.until)):
                break
        if visited:
            yield BindLabel(node=self, label=self.label, places=tuple(visited))

    def say(self, place: SayPlace) -> str:
        return f"{'as many as fit of' if self.optional else 'at each of'} {place(self.select)}"

    @property
    def role(self) -> Role:
        return "place"

    @property
    def parts(self) -> tuple[ChildNode, ...]:
        return (ChildNode(node=self.body, times=1 if self.select.single else None),)

    def with_children(self, children: Sequence[Node]) -> ForEach:
        (body,) = children
        return replace(self, body=body)

    def goes_on_after(self, child: Node) -> bool:  # noqa: ARG002
        return True

    @property
    def in_any_order(self) -> bool:
        return self.order == "best"

    @property
    def keeps_order(self) -> bool:
        return self.order == "given"

    def flow(self, known: K, visit: Callable[[Node, K], K], test: Callable[[Node, K], None]) -> K:
        after = visit(self.body, known)
        test(self, after)
        return known | after

    @property
    def visits_each(self) -> bool:
        return True

    @property
    def rewarded_by(self) -> str:
        return self.reward

    @property
    def rewarded_first(self) -> Literal["value", "highest", "lowest"]:
        return self.reward_by

    @property
    def selector(self) -> Selector:
        return self.select

    @property
    def tested(self) -> Condition | None:
        return self.until

    @property
    def is_optional(self) -> bool:
        return self.optional
