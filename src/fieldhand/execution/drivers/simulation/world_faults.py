"""Faults of a world file: a pydantic model for each."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, StrictInt, model_validator

from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    BatteryDrains,
    Blocked,
    ClockJumps,
    DiskFull,
    DriveFails,
    GoalClicked,
    GoalUnexplained,
    LocalisationLost,
    NavigatorDies,
    RobotStops,
    RobotStrays,
    SensorAbsurd,
    SensorSilent,
    TreeRef,
    WorldFault,
)

Second = Annotated[float, Field(ge=0, allow_inf_nan=False)]
#: Larger than any site.
FaultDistance = Annotated[float, Field(gt=0, le=100_000, allow_inf_nan=False)]
#: Metres from a tree to something beside it.
Offset = Annotated[float, Field(ge=-1000, le=1000, allow_inf_nan=False)]
#: Metres that a robot has driven.
Driven = Annotated[float, Field(ge=0, le=1_000_000, allow_inf_nan=False)]
FaultCount = Annotated[StrictInt, Field(ge=1)] | None


class Strict(BaseModel):
    """A part of a world file; undeclared keys are rejected."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class TreeRefModel(Strict):
    """``{id: "12"}`` or ``{lat: 37.2664, lon: -120.4201}``."""

    id: str | StrictInt | None = None
    lat: Annotated[float, Field(ge=-90, le=90, allow_inf_nan=False)] | None = None
    lon: Annotated[float, Field(ge=-180, le=180, allow_inf_nan=False)] | None = None

    @model_validator(mode="after")
    def _named_once(self) -> TreeRefModel:
        given = (self.id is not None, self.lat is not None, self.lon is not None)
        if given not in ((True, False, False), (False, True, True)):
            raise ValueError("a tree is named by id, or by lat and lon")
        return self

    def reference(self) -> TreeRef:
        """Return the reference for execution."""
        if self.id is not None:
            return TreeRef(id=str(self.id))
        return TreeRef(lat=self.lat or 0.0, lon=self.lon or 0.0)


class _AtModel(Strict):
    times: FaultCount = None
    at: TreeRefModel | None = None

    @property
    def reference(self) -> TreeRef | None:
        return None if self.at is None else self.at.reference()


class ActionFailsModel(_AtModel):
    """An action that fails."""

    fault: Literal["action_fails"]
    action: str

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return ActionFails(action=self.action, times=self.times, at=self.reference)


class SensorSilentModel(_AtModel):
    """A sensor without a reading."""

    fault: Literal["sensor_silent"]
    quantity: str

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return SensorSilent(quantity=self.quantity, times=self.times, at=self.reference)


class SensorAbsurdModel(_AtModel):
    """A sensor with an absurd reading."""

    fault: Literal["sensor_absurd"]
    quantity: str
    value: FiniteFloat

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return SensorAbsurd(quantity=self.quantity, value=self.value, times=self.times, at=self.reference)


class DriveFailsModel(_AtModel):
    """A drive that fails."""

    fault: Literal["drive_fails"]

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return DriveFails(times=self.times, at=self.reference)


class RobotStraysModel(_AtModel):
    """A robot that leaves its way."""

    fault: Literal["robot_strays"]
    by_m: Annotated[float, Field(ge=-1_000, le=1_000, allow_inf_nan=False)]

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return RobotStrays(by_m=self.by_m, times=self.times, at=self.reference)


class BlockedModel(Strict):
    """An obstacle."""

    fault: Literal["blocked"]
    at: TreeRefModel | None = None
    between: tuple[TreeRefModel, TreeRefModel] | None = None
    within_m: FaultDistance = 1.0
    times: FaultCount = None
    from_s: Second = 0.0
    until_s: Second | None = None
    recovers: bool = False
    east_m: Offset = 0.0
    north_m: Offset = 0.0

    @model_validator(mode="after")
    def _somewhere(self) -> BlockedModel:
        if (self.at is None) == (self.between is None):
            raise ValueError("give the tree that it is at, or the two trees that it is between")
        if self.until_s is not None and self.until_s <= self.from_s:
            raise ValueError(f"until_s {self.until_s:g} is not after from_s {self.from_s:g}")
        return self

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return Blocked(
            at=None if self.at is None else self.at.reference(),
            between=None if self.between is None else (self.between[0].reference(), self.between[1].reference()),
            within_m=self.within_m,
            times=self.times,
            from_s=self.from_s,
            until_s=self.until_s,
            recovers=self.recovers,
            east_m=self.east_m,
            north_m=self.north_m,
        )


class GoalClickedModel(Strict):
    """A goal of another client."""

    fault: Literal["goal_clicked"]
    at: TreeRefModel
    after_m: Driven = 0.0

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return GoalClicked(at=self.at.reference(), after_m=self.after_m)


class GoalUnexplainedModel(Strict):
    """A goal that ends without a reason."""

    fault: Literal["goal_unexplained"]
    after_m: Driven = 0.0
    times: Annotated[StrictInt, Field(ge=1)] = 1

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return GoalUnexplained(after_m=self.after_m, times=self.times)


class NavigatorDiesModel(Strict):
    """A navigator that dies."""

    fault: Literal["navigator_dies"]
    after_m: Driven = 0.0
    down_s: Second | None = 2.0
    inactive_s: Second | None = 5.0

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return NavigatorDies(after_m=self.after_m, down_s=self.down_s, inactive_s=self.inactive_s)


class LocalisationLostModel(Strict):
    """A lost position."""

    fault: Literal["localisation_lost"]
    at_s: Second | None = None
    at: TreeRefModel | None = None
    within_m: FaultDistance = 5.0
    for_s: Second | None = None
    times: FaultCount = 1

    @model_validator(mode="after")
    def _sometime(self) -> LocalisationLostModel:
        if (self.at_s is None) == (self.at is None):
            raise ValueError("give the time with at_s, in seconds, or the tree with at")
        return self

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        at = None if self.at is None else self.at.reference()
        return LocalisationLost(at_s=self.at_s, at=at, within_m=self.within_m, for_s=self.for_s, times=self.times)


class BatteryDrainsModel(Strict):
    """A battery that empties faster than the profile says."""

    fault: Literal["battery_drains"]
    factor: Annotated[float, Field(gt=0, allow_inf_nan=False)]
    from_s: Second = 0.0

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return BatteryDrains(factor=self.factor, from_s=self.from_s)


class ClockJumpsModel(Strict):
    """A change of the wall clock."""

    fault: Literal["clock_jumps"]
    at_s: Second
    by_s: FiniteFloat

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return ClockJumps(at_s=self.at_s, by_s=self.by_s)


class DiskFullModel(Strict):
    """A full disk."""

    fault: Literal["disk_full"]
    at_s: Second

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return DiskFull(at_s=self.at_s)


class RobotStopsModel(Strict):
    """A robot that stops for good."""

    fault: Literal["robot_stops"]
    at_s: Second
    why: Annotated[str, Field(min_length=1)] = "power cut"

    def to_fault(self) -> WorldFault:
        """Return the fault for execution."""
        return RobotStops(at_s=self.at_s, why=self.why)


AnyFault = (
    ActionFailsModel
    | SensorSilentModel
    | SensorAbsurdModel
    | DriveFailsModel
    | RobotStraysModel
    | BlockedModel
    | GoalClickedModel
    | GoalUnexplainedModel
    | NavigatorDiesModel
    | LocalisationLostModel
    | BatteryDrainsModel
    | ClockJumpsModel
    | DiskFullModel
    | RobotStopsModel
)
FaultModel = Annotated[AnyFault, Field(discriminator="fault")]
