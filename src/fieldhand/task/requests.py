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
    from fieldhand.task.nodes.optional import Optional
    from fieldhand.task.nodes.repeat import Repeat
    from fieldhand.task.plan import Node

Place: TypeAlias = Any
#: The visits of a for-each that is under way, as the carrier keeps them.
Tour: TypeAlias = Any
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
    place: Place


@dataclass(frozen=True, kw_only=True)
class Drive:
    """Be at a place. Answer: the place as it was reached, which now is the place in hand.

    Attributes:
        tour: The visits of which this is one; None for a drive of its own.
        back: To the place in hand: nothing is driven, unless a drive that failed has left the robot elsewhere.
    """

    node: Node
    place: Place
    tour: Tour | None = None
    back: bool = False


@dataclass(frozen=True, kw_only=True)
class Bind:
    """Let a label mean some places. Answer: nothing. An empty label binds nothing."""

    node: Node
    label: str
    places: tuple[Place, ...]


@dataclass(frozen=True, kw_only=True)
class Capture:
    """Make the captures of an action at the place in hand. Answer: what the last of them measured."""

    node: Act


@dataclass(frozen=True, kw_only=True)
class Forget:
    """Nothing is known of a reading any more. Answer: nothing."""

    node: Act
    reading: str


@dataclass(frozen=True, kw_only=True)
class Read:
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
class Arrange:
    """In which order some steps are done. Answer: the position of each, once."""

    node: AnyOrder


@dataclass(frozen=True, kw_only=True)
class Begin:
    """The visits of a for-each: its selector is resolved now. Answer: the tour."""

    node: ForEach


@dataclass(frozen=True, kw_only=True)
class Next:
    """Which visit of a tour comes next. Answer: its place; None where none does."""

    node: ForEach
    tour: Tour
    made: int


@dataclass(frozen=True, kw_only=True)
class Round:
    """Another round of a repeat begins. Answer: nothing."""

    node: Repeat
    left: int


@dataclass(frozen=True, kw_only=True)
class Offer:
    """Whether an optional step is done. Answer: yes or no."""

    node: Optional


Request = Locate | Permit | Drive | Bind | Capture | Forget | Read | Decide | Arrange | Begin | Next | Round | Offer
