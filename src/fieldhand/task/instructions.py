"""Instructions that an executing plan yields, and the results it is sent.

Places are opaque here: their type belongs to the executor. The *current place* is the last one driven to.
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
    from fieldhand.task.nodes.recharge import Recharge
    from fieldhand.task.nodes.repeat import Repeat
    from fieldhand.task.nodes.work_along import WorkAlong
    from fieldhand.task.plan import Node

OpaquePlace: TypeAlias = Any
#: The visits of a for-each or the stretches of work along a path under way, in a type of the executor.
OpaqueTour: TypeAlias = Any
#: Measured values by quantity.
Reading: TypeAlias = Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Locate:
    """Resolve a selector now; without a selector, the current place. Result: the one place."""

    node: Node
    selector: Selector | None


@dataclass(frozen=True, kw_only=True)
class Permit:
    """Ask permission for mandatory work at a place. Result: none; a refusal is thrown in, or ends the plan."""

    node: Node
    place: OpaquePlace


@dataclass(frozen=True, kw_only=True)
class DriveTo:
    """Drive to a place. Result: the place as reached, now the current place.

    Attributes:
        tour: The for-each tour that the visit belongs to; None for a drive of its own.
        back: Return to the current place: no drive, unless a failed drive displaced the robot.
    """

    node: Node
    place: OpaquePlace
    tour: OpaqueTour | None = None
    back: bool = False


@dataclass(frozen=True, kw_only=True)
class BindLabel:
    """Bind a label to places; an empty label binds nothing. Result: none."""

    node: Node
    label: str
    places: tuple[OpaquePlace, ...]


@dataclass(frozen=True, kw_only=True)
class Capture:
    """Make the captures of an action at the current place. Result: the values measured by the last one."""

    node: Act


@dataclass(frozen=True, kw_only=True)
class WaitFor:
    """Ask permission to stand still for some seconds, and do so. Result: none; a refusal is as that of ``Permit``."""

    node: Node
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Charge:
    """Dock at the charger, which is the current place, and charge the battery. Result: none."""

    node: Recharge


@dataclass(frozen=True, kw_only=True)
class ForgetReading:
    """Clear a reading. Result: none."""

    node: Act
    reading: str


@dataclass(frozen=True, kw_only=True)
class SetReading:
    """Bind a reading to measured values. Result: none."""

    node: Act
    reading: str
    value: Reading


@dataclass(frozen=True, kw_only=True)
class BeginSeries:
    """Discard the readings of a series, which begins anew. Result: none."""

    node: Node
    reading: str


@dataclass(frozen=True, kw_only=True)
class Decide:
    """Evaluate a condition now. Result: True or False."""

    node: Node
    condition: Condition


@dataclass(frozen=True, kw_only=True)
class ArrangeSteps:
    """Choose the order of some steps. Result: the position of each, once."""

    node: AnyOrder


@dataclass(frozen=True, kw_only=True)
class BeginVisits:
    """Resolve the selector of a for-each. Result: the tour."""

    node: ForEach


@dataclass(frozen=True, kw_only=True)
class NextVisit:
    """Choose the next visit or stretch of a tour. Result: the place where it begins; None where none is left."""

    node: ForEach | WorkAlong
    tour: OpaqueTour
    made: int


@dataclass(frozen=True, kw_only=True)
class BeginStretches:
    """Resolve the selector of work along a path to stretches. Result: the tour."""

    node: WorkAlong


@dataclass(frozen=True, kw_only=True)
class WorkStretch:
    """Drive along the current stretch of a tour with the action on. Result: none; its end becomes the current place."""

    node: WorkAlong
    tour: OpaqueTour


@dataclass(frozen=True, kw_only=True)
class BeginRound:
    """Announce another round of a repeat. Result: none."""

    node: Repeat
    left: int


@dataclass(frozen=True, kw_only=True)
class OfferStep:
    """Ask whether to do an optional step. Result: True or False."""

    node: OptionalStep


Instruction = (
    Locate
    | Permit
    | DriveTo
    | BindLabel
    | Capture
    | WaitFor
    | Charge
    | ForgetReading
    | SetReading
    | BeginSeries
    | Decide
    | ArrangeSteps
    | BeginVisits
    | NextVisit
    | BeginStretches
    | WorkStretch
    | BeginRound
    | OfferStep
)
