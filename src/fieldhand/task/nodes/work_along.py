"""A drive along rows, through aisles, over an area or along its edge, with an implement on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from fieldhand.language.words import say_action
from fieldhand.task.instructions import BeginStretches, DriveTo, NextVisit, WorkStretch
from fieldhand.task.nodes.base import GivenUp, PlanNode, Program, Role, SayPlace, Span

if TYPE_CHECKING:
    from fieldhand.places.selector import Selector
    from fieldhand.task.instructions import OpaquePlace
    from fieldhand.task.run import PlanRun

#: Path along which an implement works.
WorkMode = Literal["rows", "aisles", "headlands", "area", "perimeter"]

#: Sides of rows that are worked.
RowSides = Literal["one", "both", "north", "east", "south", "west"]

#: Direction in which lanes run, or in which every row or aisle is driven.
WorkHeading = Literal[
    "any", "north_south", "east_west", "north", "east", "south", "west", "clockwise", "counterclockwise"
]


@dataclass(frozen=True, kw_only=True)
class WorkAlong(PlanNode):
    """An action that is on while driving along rows, aisles, an area or its edge.

    Without an action the robot only drives.

    The selector is resolved once, when the node is reached, into stretches: paths that are driven in one piece. The
    robot drives to the begin of each stretch and along it, with the action on from the first to the last plant and off
    in gaps of a row and on headlands.

    Attributes:
        action: The action; empty to drive only.
        parameters: Name and value of each parameter that the profile declares for the action.
        along: Trees of the rows, or a zone.
        along_said: Character ranges of the request that name them.
        mode: ``rows``: beside each row. ``aisles``: between neighbouring rows. ``headlands``: along both ends of the
            rows. ``area``: all ground. ``perimeter``: its edge.
        sides: Of each row any one, both, or one; with ``perimeter``, that side of it.
        every: 2 for every second aisle.
        heading: With ``area``, direction of its lanes; else the side towards which each row, aisle or side of an edge
            is driven.
        laps: Times the whole is done.
        gaps: ``on`` to be on in gaps of a row.
        order: As of a for-each.
        optional: As much as the budget allows.
    """

    id: str = ""
    action: str = ""
    parameters: tuple[tuple[str, str | float], ...] = ()
    along: Selector
    along_said: tuple[Span, ...] = ()
    mode: WorkMode = "rows"
    sides: RowSides = "one"
    every: int = 1
    heading: WorkHeading = "any"
    laps: int = 1
    gaps: Literal["off", "on"] = "off"
    order: Literal["best", "given"] = "best"
    optional: bool = False
    said: tuple[Span, ...] = ()

    def execute(self, run: PlanRun) -> Program:
        frame = run.frame
        frame.tour = tour = yield BeginStretches(node=self)
        while True:
            place: OpaquePlace | None = yield NextVisit(node=self, tour=tour, made=frame.made)
            if place is None:
                break
            try:
                yield DriveTo(node=self, place=place, tour=tour)
                yield WorkStretch(node=self, tour=tour)
            except GivenUp as given_up:
                if given_up.node != self.id:
                    raise
                continue
            frame.made += 1

    def say(self, place: SayPlace) -> str:
        where = {
            "rows": "along",
            "aisles": "between",
            "headlands": "along the ends of",
            "area": "over",
            "perimeter": "around",
        }[self.mode]
        return f"{say_action(self.action) if self.action else 'drive'} {where} {place(self.along)}"

    @property
    def role(self) -> Role:
        return "action"

    @property
    def work(self) -> WorkAlong:
        return self

    @property
    def on_ground(self) -> bool:
        """Return True if the ground that the selector names is worked, whether or not trees stand on it."""
        return self.mode in ("area", "perimeter")

    @property
    def goes_around(self) -> bool:
        """Return True for laps around what the selector names."""
        return self.mode == "perimeter"

    @property
    def selector(self) -> Selector:
        return self.along

    @property
    def at_said(self) -> tuple[Span, ...]:
        return self.along_said

    @property
    def visits_each(self) -> bool:
        return True

    @property
    def in_any_order(self) -> bool:
        return self.order == "best"

    @property
    def keeps_order(self) -> bool:
        return self.order == "given"

    @property
    def is_optional(self) -> bool:
        return self.optional
