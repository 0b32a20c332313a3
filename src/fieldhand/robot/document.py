"""Pydantic models of a robot profile file: its keys and their value ranges.

:mod:`fieldhand.robot.loader` converts a valid document to the frozen data of :mod:`fieldhand.robot.model`.
docs/formats.md documents the keys.
"""

from __future__ import annotations

import re
from typing import Annotated

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from fieldhand.robot.bindings_document import Ros2Document
from fieldhand.robot.camera import VIEW_DEG, CameraSide
from fieldhand.robot.charging import DOCK, UNDOCK
from fieldhand.robot.charging_document import ChargingDocument
from fieldhand.robot.events import CLEAR_S, Unheard
from fieldhand.robot.fields import (
    IdentifierField,
    Keyed,
    NotNegative,
    NumberField,
    Positive,
    UnitField,
    each_once,
    no_bool,
)
from fieldhand.robot.implement import ImplementSide, rate_unit
from fieldhand.robot.model import HOLD_S, InDoubtPolicy
from fieldhand.task.capabilities import RESERVED_ACTIONS


def _word(value: str) -> str:
    if not re.fullmatch(r"[^\W_]+(?:[ '-][^\W_]+)*", value):
        raise ValueError(f"{value!r} is not a word or words: use letters and digits with single spaces between")
    return value.lower()


def _level_word(value: str) -> str:
    if not re.fullmatch(r"[a-z]+(?:[ -][a-z]+)*", value):
        raise ValueError(f"{value!r} is not a level word: use lower-case letters, such as low or very high")
    return value


def _choice(value: str) -> str:
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", value) or value in {"true", "false"}:
        raise ValueError(f"{value!r} is not a choice: use letters, digits, - and _, beginning with a letter")
    return value


def _code(value: str) -> str:
    if not re.fullmatch(r"[a-z]{2,3}", value):
        raise ValueError(f"{value!r} is not the code of a language: use two or three lower-case letters, such as es")
    return value


def _label(value: str) -> str:
    if not value.strip() or not value.isprintable() or len(value) > 80:
        raise ValueError(f"{value[:80]!r} is not a label: use at most 80 characters on one line")
    return value.strip()


#: Maximum width of a robot and maximum distance from which it works on a tree, in metres.
_WIDEST = 100.0

Breadth = Annotated[Positive, Field(le=_WIDEST)]
#: A drive begins up to 0.5 m from where its way does.
Corridor = Annotated[NumberField, Field(ge=0.6, le=_WIDEST)]
Retries = Annotated[int, BeforeValidator(no_bool), Field(ge=0, le=10)]
Wait = Annotated[NumberField, Field(ge=0, le=3600)]
Synonyms = Annotated[tuple[Annotated[str, AfterValidator(_word)], ...], AfterValidator(each_once)]
Choice = Annotated[str, AfterValidator(_choice)]
LanguageLabels = dict[Annotated[str, AfterValidator(_code)], Annotated[str, AfterValidator(_label)]]


class LevelDocument(Keyed):
    """``{below: 33}`` or ``{above: 38}``."""

    below: NumberField | None = None
    above: NumberField | None = None

    @model_validator(mode="after")
    def _one(self) -> LevelDocument:
        if (self.below is None) == (self.above is None):
            raise ValueError("give either below or above, with a number")
        return self


class QuantityDocument(Keyed):
    """A quantity that the robot measures."""

    unit: UnitField
    words: Synonyms
    levels: dict[Annotated[str, AfterValidator(_level_word)], LevelDocument] = Field(default_factory=dict)
    minimum: NumberField
    maximum: NumberField
    typical: NumberField
    spread: NotNegative
    labels: LanguageLabels = Field(default_factory=dict)

    @model_validator(mode="after")
    def _ranges(self) -> QuantityDocument:
        if not self.minimum < self.maximum:
            raise ValueError(f"minimum {self.minimum:g} is not below maximum {self.maximum:g}")
        if not self.minimum <= self.typical <= self.maximum:
            raise ValueError(f"typical {self.typical:g} is not within {self.minimum:g} and {self.maximum:g}")
        for word, level in self.levels.items():
            value = level.below if level.below is not None else level.above
            if value is not None and not self.minimum <= value <= self.maximum:
                raise ValueError(
                    f"the threshold {value:g} of {word!r} is not within {self.minimum:g} and {self.maximum:g}"
                )
        return self


class ParameterDocument(Keyed):
    """A parameter of an action: a number within bounds, or a choice."""

    default: Annotated[float | str, BeforeValidator(no_bool)]
    minimum: NumberField | None = None
    maximum: NumberField | None = None
    unit: UnitField | None = None
    choices: Annotated[tuple[Choice, ...], AfterValidator(each_once)] = ()

    @model_validator(mode="after")
    def _kind(self) -> ParameterDocument:
        if self.choices:
            if (self.minimum, self.maximum, self.unit) != (None, None, None):
                raise ValueError("a parameter has choices, or a minimum, maximum and unit, not both")
            if self.default not in self.choices:
                raise ValueError(f"default {self.default!r} is not one of {', '.join(self.choices)}")
            return self
        if isinstance(self.default, str):
            raise ValueError(f"default {self.default!r} is not a number; list the choices if it is a word")
        low = float("-inf") if self.minimum is None else self.minimum
        high = float("inf") if self.maximum is None else self.maximum
        if not low < high:
            raise ValueError(f"minimum {low:g} is not below maximum {high:g}")
        if not low <= self.default <= high or self.default in (float("inf"), float("-inf")):
            raise ValueError(f"default {self.default:g} is not within {low:g} and {high:g}")
        return self


class ImplementDocument(Keyed):
    """Properties of an action that is on while the robot drives."""

    speed_m_s: Positive
    power_w: NotNegative = 0.0
    width_m: Breadth | None = None
    side: ImplementSide = "both"
    rate: IdentifierField | None = None
    tank: Positive | None = None
    on_delay_s: Annotated[NumberField, Field(ge=0, le=60)] = 0.0
    off_delay_s: Annotated[NumberField, Field(ge=0, le=60)] = 0.0

    @model_validator(mode="after")
    def _amounts(self) -> ImplementDocument:
        if self.tank is not None and self.rate is None:
            raise ValueError("tank is given without rate; name the parameter with the rate, such as rate: rate_l_ha")
        return self


class CameraDocument(Keyed):
    """The camera of an action that takes pictures of a plant."""

    side: CameraSide
    view_deg: Annotated[NumberField, Field(ge=1, le=180)] = VIEW_DEG


class ActionDocument(Keyed):
    """An action that the robot performs at a place, or with ``implement`` while it drives."""

    labels: LanguageLabels = Field(default_factory=dict)
    description: str = ""
    words: Annotated[Synonyms, Field(min_length=1)]
    verbs: Synonyms = ()
    measures: Annotated[tuple[str, ...], AfterValidator(each_once)] = ()
    parameters: dict[IdentifierField, ParameterDocument] = Field(default_factory=dict)
    duration_s: Positive | None = None
    energy_j: NotNegative | None = None
    retries: Retries | None = None
    retry_wait_s: Wait | None = None
    in_doubt: InDoubtPolicy = "repeat"
    implement: ImplementDocument | None = None
    camera: CameraDocument | None = None

    @model_validator(mode="after")
    def _at_a_place_or_along_a_path(self) -> ActionDocument:
        implement = self.implement
        if implement is None:
            for key, value in (("duration_s", self.duration_s), ("energy_j", self.energy_j)):
                if value is None:
                    raise ValueError(f"the key {key!r} is missing; add it, or implement if it is on while driving")
            return self
        if self.duration_s is not None or self.energy_j is not None:
            raise ValueError(
                "duration_s and energy_j belong to an action at a place; leave them out, implement has speed_m_s and"
                " power_w"
            )
        if self.camera is not None:
            raise ValueError("camera belongs to an action at a place; leave it out, implement has side")
        if self.measures:
            raise ValueError(
                "an implement measures nothing; leave measures out, and add an action that reads at a place"
            )
        if implement.rate is not None:
            parameter = self.parameters.get(implement.rate)
            if parameter is None:
                raise ValueError(f"rate names {implement.rate!r}, which is not a parameter of the action; add it")
            unit = rate_unit(parameter.unit or "")
            if unit is None:
                raise ValueError(
                    f"the unit {parameter.unit!r} of {implement.rate!r} is not that of a rate; write an amount per ha,"
                    " m2, m or km, such as l/ha"
                )
            if unit.area_m2 and implement.width_m is None:
                raise ValueError("the rate is per area, so width_m is needed; add the working width in metres")
        return self


class EventDocument(Keyed):
    """An event that the robot detects all the time: true or false, or with ``unit`` a measured value."""

    description: Annotated[str, AfterValidator(_label)]
    words: Annotated[Synonyms, Field(min_length=1)]
    verbs: Synonyms = ()
    states: Synonyms = ()
    unit: UnitField | None = None
    above: NumberField | None = None
    below: NumberField | None = None
    typical: NumberField = 0.0
    clear_s: Annotated[NumberField, Field(ge=0, le=3600)] = CLEAR_S
    unless_heard: Unheard = "holds"
    labels: LanguageLabels = Field(default_factory=dict)

    @model_validator(mode="after")
    def _measured(self) -> EventDocument:
        if self.unit is None and (self.above, self.below, self.typical) != (None, None, 0.0):
            raise ValueError("above, below and typical need a unit; an event without one is true or false")
        if self.above is not None and self.below is not None:
            raise ValueError("give either above or below, not both")
        return self


class PatienceDocument(Keyed):
    """Waiting times before a fault is given up on."""

    retry_wait_s: Wait = 0.0
    blocked_wait_s: Wait = 60.0
    lost_wait_s: Wait = 60.0
    navigation_wait_s: Wait = 60.0
    taken_wait_s: Wait = 300.0
    event_wait_s: Annotated[NumberField, Field(ge=1, le=86_400)] = 3600.0


class EnergyDocument(Keyed):
    """Battery capacity, consumption and charge levels."""

    capacity_j: Positive
    drive_j_per_m: Positive
    idle_w: NotNegative
    reserve_percent: Annotated[NumberField, Field(ge=0, lt=100)]
    warn_percent: Annotated[NumberField, Field(ge=0, le=100)] | None = None
    return_percent: Annotated[NumberField, Field(ge=0, le=100)] | None = None
    stop_percent: Annotated[NumberField, Field(ge=0, lt=100)] | None = None
    hold_s: Annotated[NumberField, Field(ge=0, le=60)] = HOLD_S
    charging: ChargingDocument | None = None

    @model_validator(mode="after")
    def _levels(self) -> EnergyDocument:
        reserve, warn, home, stop = self.reserve_percent, self.warn_percent, self.return_percent, self.stop_percent
        if home is not None and home < reserve:
            raise ValueError(
                f"return_percent {home:g} is below reserve_percent {reserve:g}; a robot that returns only then would"
                " use up its reserve: give at least as much, or leave the key out"
            )
        if warn is not None and warn < max(reserve, home or 0.0):
            raise ValueError(
                f"warn_percent {warn:g} is below the charge at which the robot turns home"
                f" ({max(reserve, home or 0.0):g}); give at least as much, or leave the key out"
            )
        if stop is not None and stop > 0.0 and stop >= reserve:
            raise ValueError(
                f"stop_percent {stop:g} is not below reserve_percent {reserve:g}; the robot would stop before it"
                " reaches the reserve: give less, or leave the key out"
            )
        if self.charging is not None and self.charging.until_percent <= max(reserve, home or 0.0):
            raise ValueError(
                f"charging.until_percent {self.charging.until_percent:g} is not above the charge at which the robot"
                f" turns home ({max(reserve, home or 0.0):g}); charge further"
            )
        return self


class LegCostDocument(Keyed):
    """Random cost of a leg."""

    alpha: Annotated[NumberField, Field(ge=0, le=1)]


class ProfileDocument(Keyed):
    """A complete robot profile."""

    name: IdentifierField
    description: str = ""
    speed_m_s: Positive
    width_m: Breadth
    standoff_m: Breadth | None = None
    slow_m_s: Positive | None = None
    corridor_m: Corridor | None = None
    turn_deg_s: Annotated[NumberField, Field(ge=1, le=720)] | None = None
    retries: Retries = 1
    patience: PatienceDocument = PatienceDocument()
    energy: EnergyDocument
    leg_cost: LegCostDocument
    quantities: dict[IdentifierField, QuantityDocument] = Field(default_factory=dict)
    actions: Annotated[dict[IdentifierField, ActionDocument], Field(min_length=1)]
    events: dict[IdentifierField, EventDocument] = Field(default_factory=dict)
    ros2: Ros2Document | None = None

    @model_validator(mode="after")
    def _stands_beside_the_tree(self) -> ProfileDocument:
        if self.slow_m_s is not None and self.slow_m_s > self.speed_m_s:
            raise ValueError(f"slow_m_s {self.slow_m_s:g} is more than speed_m_s ({self.speed_m_s:g})")
        if self.standoff_m is not None and self.standoff_m < self.width_m / 2:
            raise ValueError(
                f"standoff_m {self.standoff_m:g} is less than half of width_m ({self.width_m / 2:g}): the robot would"
                " stand in the tree"
            )
        return self

    @property
    def doable(self) -> dict[str, ActionDocument]:
        """Return the actions, and those of docking, which are bound to ROS 2 in the same way."""
        charging = self.energy.charging
        docking = {} if charging is None else {DOCK: charging.dock, UNDOCK: charging.undock}
        return self.actions | {
            name: ActionDocument(words=(name,), duration_s=one.duration_s, energy_j=one.energy_j)
            for name, one in docking.items()
            if one is not None
        }

    @model_validator(mode="after")
    def _docks(self) -> ProfileDocument:
        if self.energy.charging is not None and (taken := sorted({DOCK, UNDOCK}.intersection(self.actions))):
            raise ValueError(
                f"the action {taken[0]!r} has the name of a step of charging; describe it in energy.charging, or give"
                " it another name"
            )
        return self

    @model_validator(mode="after")
    def _measured(self) -> ProfileDocument:
        for name, action in self.actions.items():
            if name in RESERVED_ACTIONS:
                raise ValueError(f"an action cannot be called {name!r}: the word is reserved in Task documents")
            for quantity in action.measures:
                if quantity not in self.quantities:
                    known = ", ".join(self.quantities) or "none"
                    raise ValueError(f"action {name!r} measures {quantity!r}; the quantities here are {known}")
        return self
