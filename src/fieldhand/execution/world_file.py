"""The edge of a world file: pydantic models of its YAML, and its mistakes in words."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from typing import Annotated, Any, Literal, get_args

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, StrictBool, StrictInt, ValidationError, model_validator
from pydantic_core import ErrorDetails

from fieldhand.errors import WorldError
from fieldhand.execution.world import (
    ActionFails,
    BatteryDrains,
    Blocked,
    RobotStops,
    SensorAbsurd,
    SensorSilent,
    Spot,
    Truth,
    World,
    WorldFault,
)

GUIDE = "see docs/formats.md, 'World file'"

_KINDS: dict[type, str] = {dict: "a mapping", list: "a list", type(None): "empty"}

#: A sensor's value: a number, or yes or no.
SensorValue = StrictBool | FiniteFloat
Times = Annotated[StrictInt, Field(ge=1)] | None


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class SpotModel(_Model):
    """``{id: "12"}`` or ``{lat: 37.2664, lon: -120.4201}``."""

    id: str | StrictInt | None = None
    lat: Annotated[float, Field(ge=-90, le=90, allow_inf_nan=False)] | None = None
    lon: Annotated[float, Field(ge=-180, le=180, allow_inf_nan=False)] | None = None

    @model_validator(mode="after")
    def _named_once(self) -> SpotModel:
        given = (self.id is not None, self.lat is not None, self.lon is not None)
        if given not in ((True, False, False), (False, True, True)):
            raise ValueError("a tree is named by id, or by lat and lon")
        return self

    def spot(self) -> Spot:
        """As execution uses it."""
        if self.id is not None:
            return Spot(id=str(self.id))
        return Spot(lat=self.lat or 0.0, lon=self.lon or 0.0)


class TreeValueModel(SpotModel):
    """A tree with what a sensor reads there."""

    value: SensorValue


class TruthModel(_Model):
    """A value for everywhere, and values at trees."""

    default: SensorValue | None = None
    trees: tuple[TreeValueModel, ...] = ()

    def truth(self) -> Truth:
        """As execution uses it."""
        default = None if self.default is None else float(self.default)
        return Truth(default=default, trees=tuple((t.spot(), float(t.value)) for t in self.trees))


class _AtModel(_Model):
    times: Times = None
    at: SpotModel | None = None

    @property
    def spot(self) -> Spot | None:
        return None if self.at is None else self.at.spot()


class ActionFailsModel(_AtModel):
    """An action that fails."""

    fault: Literal["action_fails"]
    action: str

    def made(self) -> WorldFault:
        """As execution uses it."""
        return ActionFails(action=self.action, times=self.times, at=self.spot)


class SensorSilentModel(_AtModel):
    """A sensor that gives nothing."""

    fault: Literal["sensor_silent"]
    quantity: str

    def made(self) -> WorldFault:
        """As execution uses it."""
        return SensorSilent(quantity=self.quantity, times=self.times, at=self.spot)


class SensorAbsurdModel(_AtModel):
    """A sensor that gives nonsense."""

    fault: Literal["sensor_absurd"]
    quantity: str
    value: FiniteFloat

    def made(self) -> WorldFault:
        """As execution uses it."""
        return SensorAbsurd(quantity=self.quantity, value=self.value, times=self.times, at=self.spot)


class BlockedModel(_Model):
    """Something in the way."""

    fault: Literal["blocked"]
    at: SpotModel
    within_m: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 1.0
    times: Times = None

    def made(self) -> WorldFault:
        """As execution uses it."""
        return Blocked(at=self.at.spot(), within_m=self.within_m, times=self.times)


class BatteryDrainsModel(_Model):
    """A battery that empties faster than the profile says."""

    fault: Literal["battery_drains"]
    factor: Annotated[float, Field(gt=0, allow_inf_nan=False)]

    def made(self) -> WorldFault:
        """As execution uses it."""
        return BatteryDrains(factor=self.factor)


class RobotStopsModel(_Model):
    """The end of the robot's part."""

    fault: Literal["robot_stops"]
    at_s: Annotated[float, Field(ge=0, allow_inf_nan=False)]
    why: Annotated[str, Field(min_length=1)] = "power cut"

    def made(self) -> WorldFault:
        """As execution uses it."""
        return RobotStops(at_s=self.at_s, why=self.why)


AnyFault = (
    ActionFailsModel | SensorSilentModel | SensorAbsurdModel | BlockedModel | BatteryDrainsModel | RobotStopsModel
)
FaultModel = Annotated[AnyFault, Field(discriminator="fault")]

_KINDS_OF_FAULT: dict[str, type[BaseModel]] = {
    get_args(model.model_fields["fault"].annotation)[0]: model for model in get_args(AnyFault)
}


class WorldModel(_Model):
    """The whole file."""

    readings: dict[str, SensorValue | TruthModel] = {}
    faults: tuple[FaultModel, ...] = ()
    seed: Annotated[StrictInt, Field(ge=0)] = 0
    charge_percent: Annotated[float, Field(gt=0, le=100, allow_inf_nan=False)] = 100.0


def world_of(content: Mapping[str, Any], *, source: str) -> World:
    """The world that a file's YAML says.

    Raises:
        WorldError: A key is unknown, missing, or its value is of no use.
    """
    try:
        model = WorldModel.model_validate(content)
    except ValidationError as error:
        raise _explained(error, source) from None
    return World(
        readings={
            name: value.truth() if isinstance(value, TruthModel) else Truth(default=float(value))
            for name, value in model.readings.items()
        },
        faults=tuple(f.made() for f in model.faults),
        seed=model.seed,
        charge_percent=model.charge_percent,
        source=source,
    )


def _explained(error: ValidationError, source: str) -> WorldError:
    """The mistake that says most, as one line: the file, the key's path, what is wrong, what to do."""
    problems = error.errors(include_url=False, include_context=True)
    # A reading may be a value or a mapping; pydantic blames it for being neither. The deepest blame is the one meant.
    first = max(problems, key=lambda p: (p["type"] == "extra_forbidden", len(p["loc"])))
    path = _path(first)
    if first["type"] == "missing":
        return WorldError(
            f"the key '{path[-1]}' is missing", where=": ".join([source, *_dotted(path[:-1])]), advice=GUIDE
        )
    what, advice = _words_for(first, path)
    return WorldError(what, where=": ".join([source, *_dotted(path)]), advice=advice)


def _path(problem: ErrorDetails) -> list[str]:
    """The keys down to a mistake, without the alternatives that pydantic tried on the way.

    What the author named may be called as such an alternative is: a key of the file itself, a reading, a stray key.
    """
    loc = [str(part) for part in problem["loc"]]
    named = {0, 1} if loc[:1] == ["readings"] else {0}
    if problem["type"] == "extra_forbidden":
        named.add(len(loc) - 1)
    return [part for k, part in enumerate(loc) if k in named or not _is_branch(part)]


def _dotted(path: list[str]) -> list[str]:
    """A key's path as people write it: ``faults[0].at``."""
    return ["".join(f"[{p}]" if p.isdigit() else f".{p}" for p in path).lstrip(".")] if path else []


def _is_branch(part: str) -> bool:
    """Whether pydantic put this part of a path in to say which alternative it tried."""
    return part in {"bool", "float", "int", "str", "TruthModel", *_KINDS_OF_FAULT} or "[" in part


def _words_for(problem: ErrorDetails, path: list[str]) -> tuple[str, str]:
    given = problem["input"]
    shown = _short(str(given)) if isinstance(given, str | int | float) else _KINDS.get(type(given), "something else")
    match problem["type"]:
        case "extra_forbidden":
            return f"there is no key '{_short(path[-1])}' here", _nearest(path[-1], _keys_at(problem, path))
        case "union_tag_invalid":
            tag = str(problem["ctx"]["tag"])
            return f"there is no fault '{_short(tag)}'", _nearest(tag, list(_KINDS_OF_FAULT))
        case "union_tag_not_found":
            return "the key 'fault' is missing", GUIDE
        case "value_error":
            return problem["msg"].removeprefix("Value error, "), GUIDE
        case "model_type" | "dict_type" | "model_attributes_type":
            return f"must hold keys and values, is {shown}", GUIDE
        case "string_too_short":
            return "is empty", "give a word or two, or leave the key out"
        case "tuple_type":
            return f"must be a list, is {shown}", "begin each entry with a dash"
        case "bool_type" | "float_type" | "float_parsing" if path[:1] == ["readings"]:
            return f"must be a number, true or false, is {shown}", "correct the value"
        case _:
            return f"{problem['msg'].replace('Input should be', 'must be')}, is {shown}", "correct the value"


def _keys_at(problem: ErrorDetails, path: list[str]) -> list[str]:
    """The keys that the mapping in which a stray key stands may have."""
    inner: type[BaseModel] = WorldModel
    if path[0] == "readings":
        inner = TruthModel if len(path) == 3 else TreeValueModel
    elif path[0] == "faults":
        inner = SpotModel if "at" in path[2:-1] else _KINDS_OF_FAULT[str(problem["loc"][2])]
    return list(inner.model_fields)


def _nearest(given: object, known: list[str]) -> str:
    near = difflib.get_close_matches(str(given).lower(), known, n=1)
    return f"did you mean '{near[0]}'?" if near else f"known here: {', '.join(known)}"


def _short(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."
