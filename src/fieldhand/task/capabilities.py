"""The part of a robot profile that Task documents are checked against, as pure data.

The task room does not import robot profiles; :func:`fieldhand.robot.capabilities.capabilities_of` converts one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

#: Names that no action may have: ``<at>`` and ``<along>`` are siblings of the action's element.
RESERVED_ACTIONS = ("at", "along")


@dataclass(frozen=True, kw_only=True)
class NumberParameter:
    """A numeric parameter with inclusive bounds (None: unbounded)."""

    minimum: float | None = None
    maximum: float | None = None
    unit: str = ""


@dataclass(frozen=True, kw_only=True)
class ChoiceParameter:
    """A parameter with a fixed set of values."""

    choices: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class ActionCapability:
    """An action.

    Attributes:
        measures: Names of the quantities that one capture measures.
        parameters: Its parameters by name.
        is_implement: True if it is on while the robot drives, instead of done at a place.
    """

    measures: tuple[str, ...] = ()
    parameters: Mapping[str, NumberParameter | ChoiceParameter] = field(default_factory=dict)
    is_implement: bool = False


@dataclass(frozen=True, kw_only=True)
class QuantityCapability:
    """A measured quantity: its unit, and the level words ("low") that have a threshold."""

    unit: str
    levels: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class EventCapability:
    """An event that the robot detects all the time: its unit if it is measured, and whether it can simply hold.

    A measured event simply holds if the profile gives its threshold.
    """

    unit: str = ""
    holds: bool = True


@dataclass(frozen=True, kw_only=True)
class Capabilities:
    """The actions, quantities and events of a robot by name. The order of the mappings is the order in the schema."""

    actions: Mapping[str, ActionCapability]
    quantities: Mapping[str, QuantityCapability]
    events: Mapping[str, EventCapability] = field(default_factory=dict)
