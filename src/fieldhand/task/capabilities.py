"""What a Task may ask of a robot, as pure data: the part of a profile that Task documents are checked against.

The task room does not know robot profiles; :func:`fieldhand.robot.capabilities.capabilities_of` makes this from one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

#: In a Task document ``<at>`` stands beside the action in ``<act>``, so no action may have that name.
RESERVED_ACTIONS = ("at",)


@dataclass(frozen=True, kw_only=True)
class NumberParameter:
    """A number between two bounds, both included (None: no bound)."""

    minimum: float | None = None
    maximum: float | None = None
    unit: str = ""


@dataclass(frozen=True, kw_only=True)
class ChoiceParameter:
    """One of some words."""

    choices: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class ActionCapability:
    """One action: the names of the quantities that a capture yields, and its parameters by name."""

    measures: tuple[str, ...] = ()
    parameters: Mapping[str, NumberParameter | ChoiceParameter] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class QuantityCapability:
    """One quantity: the unit in which it is reported, and the words ("low") for which it has a threshold."""

    unit: str
    levels: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Capabilities:
    """What a robot can do and measure, by name. The order of the mappings is the order of the schema."""

    actions: Mapping[str, ActionCapability]
    quantities: Mapping[str, QuantityCapability]
