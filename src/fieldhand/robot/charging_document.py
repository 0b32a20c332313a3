"""Pydantic model of ``energy.charging`` in a robot profile."""

from __future__ import annotations

import itertools
from typing import Annotated

from pydantic import BeforeValidator, Field, model_validator

from fieldhand.robot.charging import DOCK, UNDOCK, Charging
from fieldhand.robot.fields import Keyed, NotNegative, NumberField, Positive, no_bool
from fieldhand.robot.model import Action

Percent = Annotated[NumberField, Field(ge=0, le=100)]


class ManeuverDocument(Keyed):
    """Connecting to the charger, or leaving it."""

    duration_s: Positive
    energy_j: NotNegative = 0.0
    retries: Annotated[int, BeforeValidator(no_bool), Field(ge=0, le=10)] | None = None
    retry_wait_s: Annotated[NumberField, Field(ge=0, le=3600)] | None = None

    def action(self, name: str) -> Action:
        """Return the action of that name."""
        return Action(
            name=name,
            words=(name,),
            verbs=(),
            measures=(),
            duration_s=self.duration_s,
            energy_j=self.energy_j,
            retries=self.retries,
            retry_wait_s=self.retry_wait_s,
        )


class ChargingDocument(Keyed):
    """Docking, the power at each charge, and the charge up to which the robot charges."""

    dock: ManeuverDocument
    undock: ManeuverDocument | None = None
    power_w: Positive | None = None
    curve: tuple[tuple[Percent, Positive], ...] | None = None
    until_percent: Annotated[NumberField, Field(gt=0, le=100)] = 90.0
    most_percent: Annotated[NumberField, Field(gt=0, le=100)] = 100.0
    stranding_probability: Annotated[NumberField, Field(gt=0, le=1)] = 0.0005

    @model_validator(mode="after")
    def _powered(self) -> ChargingDocument:
        if (self.power_w is None) == (self.curve is None):
            raise ValueError("give either power_w, or a curve of [percent, watts]")
        if self.curve is not None:
            if not self.curve:
                raise ValueError("the curve is empty; give at least one [percent, watts]")
            if any(b[0] <= a[0] for a, b in itertools.pairwise(self.curve)):
                raise ValueError("the percents of the curve do not ascend; sort it, with each percent once")
        if self.most_percent < self.until_percent:
            raise ValueError(
                f"most_percent {self.most_percent:g} is below until_percent {self.until_percent:g}; give at least that"
            )
        return self

    def charging(self) -> Charging:
        """Return the data of the document."""
        return Charging(
            dock=self.dock.action(DOCK),
            undock=None if self.undock is None else self.undock.action(UNDOCK),
            curve=self.curve or ((0.0, self.power_w or 0.0),),
            until_percent=self.until_percent,
            most_percent=self.most_percent,
            stranding_probability=self.stranding_probability,
        )
