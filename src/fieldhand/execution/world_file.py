"""The edge of a world file: pydantic models of its YAML, and its mistakes in words."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from datetime import datetime
from typing import Annotated, Any, get_args

from pydantic import (
    AfterValidator,
    AwareDatetime,
    BaseModel,
    Field,
    FiniteFloat,
    StrictBool,
    StrictInt,
    ValidationError,
)
from pydantic_core import ErrorDetails

from fieldhand.errors import WorldError
from fieldhand.execution.world import Truth, World
from fieldhand.execution.world_faults import AnyFault, FaultModel, SpotModel, Strict

GUIDE = "see docs/formats.md, 'World file'"

_KINDS: dict[type, str] = {dict: "a mapping", list: "a list", type(None): "empty"}

#: A sensor's value: a number, or yes or no.
SensorValue = StrictBool | FiniteFloat


class TreeValueModel(SpotModel):
    """A tree with what a sensor reads there."""

    value: SensorValue


class TruthModel(Strict):
    """A value for everywhere, and values at trees."""

    default: SensorValue | None = None
    trees: tuple[TreeValueModel, ...] = ()

    def truth(self) -> Truth:
        """As execution uses it."""
        default = None if self.default is None else float(self.default)
        return Truth(default=default, trees=tuple((t.spot(), float(t.value)) for t in self.trees))


_KINDS_OF_FAULT: dict[str, type[BaseModel]] = {
    get_args(model.model_fields["fault"].annotation)[0]: model for model in get_args(AnyFault)
}


def _of_our_time(begins: datetime) -> datetime:
    """Any zone tells the time then, and at the end of any mission; the first and the last year end in some zones."""
    if not 2000 <= begins.year <= 2999:
        raise ValueError(f"the year {begins.year} is not one from 2000 to 2999")
    return begins


class WorldModel(Strict):
    """The whole file."""

    readings: Mapping[str, SensorValue | TruthModel] = Field(default_factory=dict)
    faults: tuple[FaultModel, ...] = ()
    seed: Annotated[StrictInt, Field(ge=0)] = 0
    charge_percent: Annotated[float, Field(gt=0, le=100, allow_inf_nan=False)] = 100.0
    begins: Annotated[AwareDatetime, AfterValidator(_of_our_time)] | None = None


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
        begins=model.begins,
        source=source,
    )


def _explained(error: ValidationError, source: str) -> WorldError:
    """The mistake that says most, as one line: the file, the key's path, what is wrong, what to do."""
    problems = error.errors(include_url=False, include_context=True)
    # A reading may be a value or a mapping; pydantic blames it for being neither. The deepest blame is the one meant.
    first = max(problems, key=lambda p: (p["type"] == "extra_forbidden", len(p["loc"])))
    path = _path(first)
    if first["type"] == "missing" and path[-1].isdigit():
        what, where = f"has {path[-1]} of its entries, and needs more", ": ".join([source, *_dotted(path[:-1])])
        return WorldError(what, where=where, advice=GUIDE)
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
    return ["".join(f"[{p}]" if p.isdigit() else f".{_short(p)}" for p in path).lstrip(".")] if path else []


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
        inner = SpotModel if {"at", "between"} & set(path[2:-1]) else _KINDS_OF_FAULT[str(problem["loc"][2])]
    return list(inner.model_fields)


def _nearest(given: object, known: list[str]) -> str:
    near = difflib.get_close_matches(str(given).lower(), known, n=1)
    return f"did you mean '{near[0]}'?" if near else f"known here: {', '.join(known)}"


def _short(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."
