"""What the meaning of a plan asks of whoever carries it out, and what is answered.

A place is the carrier's own: nothing here looks into one. The *place in hand* is the last that was driven to.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from fieldhand.places.selector import Selector
    from fieldhand.task.conditions import Condition
    from fieldhand.task.nodes.act import Act
    from fieldhand.task.nodes.any_order import AnyOrder
    from fieldhand.task.nodes.for_each import ForEach
    from fieldhand.task.nodes.optional_step import OptionalStep
    from fieldhand.task.nodes.repeat import Repeat
    from fieldhand.task.plan import Node

OpaquePlace: TypeAlias = Any
#: The visits of a for-each that is under way, as the carrier keeps them.
OpaqueTour: TypeAlias = Any
#: What an action measured, by quantity.
Reading: TypeAlias = Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Locate:
    """Which place a selector means now; without a selector the place in hand. Answer: the one place."""

    node: Node
    selector: Selector | None


@dataclass(frozen=True, kw_only=True)
class Permit:
    """Whether work that must be done may go ahead. Answer: nothing; what forbids it is thrown in, or ends the plan."""

    node: Node
    place: OpaquePlace


@dataclass(frozen=True, kw_only=True)
class DriveTo:
    """Be at a place. Answer: the place as it was reached, which now is the place in hand.

    Attributes:
        tour: The visits of which this is one; None for a drive of its own.
        back: To the place in hand: nothing is driven, unless a drive that failed has left the robot elsewhere.
    """

    node: Node
    place: OpaquePlace
    tour: OpaqueTour | None = None
    back: bool = False


@dataclass(frozen=True, kw_only=True)
class BindLabel:
    """Let a label mean some places. Answer: nothing. An empty label binds nothing."""

    node: Node
    label: str
    places: tuple[OpaquePlace, ...]


@dataclass(frozen=True, kw_only=True)
class Capture:
    """Make the captures of an action at the place in hand. Answer: what the last of them measured."""

    node: Act


@dataclass(frozen=True, kw_only=True)
class ForgetReading:
    """Nothing is known of a reading any more. Answer: nothing."""

    node: Act
    reading: str


@dataclass(frozen=True, kw_only=True)
class SetReading:
    """Let a reading be what was measured. Answer: nothing."""

    node: Act
    reading: str
    value: Reading


@dataclass(frozen=True, kw_only=True)
class Decide:
    """Whether a condition holds now. Answer: yes or no."""

    node: Node
    condition: Condition


@dataclass(frozen=True, kw_only=True)
class ArrangeSteps:
    """In which order some steps are done. Answer: the position of each, once."""

    node: AnyOrder


@dataclass(frozen=True, kw_only=True)
class BeginVisits:
    """The visits of a for-each: its selector is resolved now. Answer: the tour."""

    node: ForEach


@dataclass(frozen=True, kw_only=True)
class NextVisit:
    """Which visit of a tour comes next. Answer: its place; None where none does."""

    node: ForEach
    tour: OpaqueTour
    made: int


@dataclass(frozen=True, kw_only=True)
class BeginRound:
    """Another round of a repeat begins. Answer: nothing."""

    node: Repeat
    left: int


@dataclass(frozen=True, kw_only=True)
class OfferStep:
    """Whether an optional step is done. Answer: yes or no."""

    node: OptionalStep


Instruction = (
    Locate
    | Permit
    | DriveTo
    | BindLabel
    | Capture
    | ForgetReading
    | SetReading
    | Decide
    | ArrangeSteps
    | BeginVisits
    | NextVisit
    | BeginRound
    | OfferStep
)
