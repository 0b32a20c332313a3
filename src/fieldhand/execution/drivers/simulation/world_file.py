"""World files: read from YAML, validated by pydantic models, with their mistakes in words."""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path
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
from fieldhand.execution.drivers.simulation.world import Localisation, Truth, World
from fieldhand.execution.drivers.simulation.world_events import ScriptedEventModel
from fieldhand.execution.drivers.simulation.world_faults import AnyFault, FaultModel, Strict, TreeRefModel
from fieldhand.files import FileFault, read_file
from fieldhand.hidden_characters import find_hidden_within
from fieldhand.language import message, recalled
from fieldhand.strict_yaml import YamlFault, read_yaml

#: A world of a value for each of 3,000 trees is 200 kB; a file beyond this is something else.
MAX_BYTES = 5_000_000

GUIDE = "see docs/formats.md, 'World file'"
_CORRECT = "correct the value"

#: Mistakes that are told one by one.
_MOST_NAMED = 10

_KINDS: dict[type, str] = {dict: "a mapping", list: "a list", type(None): "empty"}

#: A sensor's value: a number, or yes or no.
SensorValue = StrictBool | FiniteFloat


class TreeValueModel(TreeRefModel):
    """A tree and a sensor's value there."""

    value: SensorValue


class TruthModel(Strict):
    """Values of a sensor: a default, and values at trees."""

    default: SensorValue | None = None
    trees: tuple[TreeValueModel, ...] = ()

    def truth(self) -> Truth:
        """Return the readings for execution."""
        default = None if self.default is None else float(self.default)
        return Truth(default=default, trees=tuple((t.reference(), float(t.value)) for t in self.trees))


class LocalisationModel(Strict):
    """Error of the position that the robot knows."""

    drift_m_per_100_m: Annotated[float, Field(ge=0, le=100, allow_inf_nan=False)] = 0.0
    toward_deg: Annotated[float, Field(ge=0, lt=360, allow_inf_nan=False)] | None = None
    noise_m: Annotated[float, Field(ge=0, le=100, allow_inf_nan=False)] = 0.0
    fix_drifts: StrictBool = True

    def localisation(self) -> Localisation:
        """Return the error for execution."""
        return Localisation(**self.model_dump())


_KINDS_OF_FAULT: dict[str, type[BaseModel]] = {
    get_args(model.model_fields["fault"].annotation)[0]: model for model in get_args(AnyFault)
}


def _of_our_time(begins: datetime) -> datetime:
    """Require a year in which every time zone is defined, even at the end of a long mission."""
    if not 2000 <= begins.year <= 2999:
        raise ValueError(f"the year {begins.year} is not in 2000 to 2999")
    return begins


class WorldModel(Strict):
    """A whole world file."""

    readings: Mapping[str, SensorValue | TruthModel] = Field(default_factory=dict)
    faults: tuple[FaultModel, ...] = ()
    events: tuple[ScriptedEventModel, ...] = ()
    seed: Annotated[StrictInt, Field(ge=0)] = 0
    charge_percent: Annotated[float, Field(gt=0, le=100, allow_inf_nan=False)] = 100.0
    meter_step_percent: Annotated[float, Field(ge=0, le=10, allow_inf_nan=False)] = 0.0
    goal_tolerance_m: Annotated[float, Field(ge=0, le=100, allow_inf_nan=False)] = 0.0
    localisation: LocalisationModel | None = None
    begins: Annotated[AwareDatetime, AfterValidator(_of_our_time)] | None = None


def load_world(path: Path) -> World:
    """Return the world of a YAML file (docs/formats.md, "World file").

    Raises:
        WorldError: It cannot be read or used; the error names the key and the remedy.
    """
    try:
        return decode_world(read_file(path, MAX_BYTES), source=str(path))
    except FileFault as fault:
        advice = message("give the path of a YAML file")
        if fault.kind == "too large":
            advice = message("check that it is a world file")
        raise WorldError(recalled(fault.what, "file"), where=str(path), advice=advice) from None


def decode_world(data: bytes, *, source: str) -> World:
    """Return the world from the bytes of a YAML file.

    Args:
        data: Bytes of the file.
        source: Its name in messages.

    Raises:
        WorldError: It cannot be used; the error names the key and the remedy.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise WorldError("is not UTF-8 text", where=source, advice="save it as UTF-8") from None
    return replace(parse_world(_content(text, source), source=source), data=data)


def parse_world(content: Mapping[str, Any], *, source: str = "world") -> World:
    """Return the world that the content of a world file describes.

    Args:
        content: Content as parsed from YAML or JSON.
        source: Its name in messages.

    Raises:
        WorldError: A key is unknown or missing, a value is invalid, or text is hidden; the error names key and remedy.
    """
    found = find_hidden_within(content)
    if found is not None:
        place, hidden = found
        what = f"contains the invisible character {hidden.name}"
        raise WorldError(what, where=": ".join(filter(None, (source, place))), advice="take it out")
    try:
        model = WorldModel.model_validate(content)
    except ValidationError as error:
        raise _explained(error, source) from None
    return World(
        readings={
            name: value.truth() if isinstance(value, TruthModel) else Truth(default=float(value))
            for name, value in model.readings.items()
        },
        faults=tuple(f.to_fault() for f in model.faults),
        events=tuple(e.scripted() for e in model.events),
        seed=model.seed,
        charge_percent=model.charge_percent,
        meter_step_percent=model.meter_step_percent,
        goal_tolerance_m=model.goal_tolerance_m,
        localisation=None if model.localisation is None else model.localisation.localisation(),
        begins=model.begins,
        source=source,
    )


def _content(text: str, source: str) -> dict[Any, Any]:
    try:
        content = read_yaml(text)
    except YamlFault as fault:
        where = f"{source}, line {fault.line}" if fault.line else source
        advice = "correct that line" if fault.line else "see docs/formats.md, 'World file'"
        raise WorldError(f"is not YAML: {fault.what}", where=where, advice=advice) from None
    if content is None:
        raise WorldError("is empty", where=source, advice="leave --world out for a world without faults")
    if not isinstance(content, dict):
        raise WorldError(
            "is not a mapping of keys to values", where=source, advice="start with readings:, faults: or seed:"
        )
    return content


def _explained(error: ValidationError, source: str) -> WorldError:
    """Combine all mistakes in one error: the file, and for each the path of its key, the problem, and what to do."""
    mistakes = [_mistake(problem) for problem in _meant(error.errors(include_url=False, include_context=True))]
    if len(mistakes) == 1:
        where, what, advice = mistakes[0]
        return WorldError(what, where=": ".join([source, *where]), advice=advice)
    texts, hints = [], {""}
    for where, what, advice in mistakes[:_MOST_NAMED]:
        hint = _hint(advice)
        texts.append(": ".join([*where, what]) + ("" if hint in hints else hint))
        hints.add(hint)
    more = f"; and {len(mistakes) - _MOST_NAMED} more" if len(mistakes) > _MOST_NAMED else ""
    return WorldError(f"{len(mistakes)} mistakes: {'; '.join(texts)}{more}", where=source, advice=GUIDE)


def _meant(problems: Sequence[ErrorDetails]) -> list[ErrorDetails]:
    """Return the mistakes as a person would count them, those of one reading or fault together, unknown keys first.

    For a value of several allowed types, pydantic reports one error per type; for a misspelt key, it reports an unknown
    key and a missing one.
    """
    strays = [p["loc"] for p in problems if p["type"] == "extra_forbidden"]
    mappings = {p["loc"][1] for p in problems if p["loc"][0] == "readings" and len(p["loc"]) > 3}
    found: dict[tuple[str, ...], ErrorDetails] = {}
    for problem in sorted(problems, key=lambda p: p["type"] != "extra_forbidden"):
        loc = problem["loc"]
        if loc[0] == "readings" and len(loc) == 3 and loc[1] in mappings:
            continue  # a mapping was not meant as a number
        if problem["type"] == "missing" and any(s[:-1] == loc[:-1] and _near(s[-1], [str(loc[-1])]) for s in strays):
            continue
        found.setdefault(tuple(_path(problem)), problem)
    places = list(dict.fromkeys(tuple(map(str, p["loc"][:2])) for p in problems))
    return sorted(found.values(), key=lambda p: places.index(tuple(map(str, p["loc"][:2]))))


def _hint(advice: str) -> str:
    """Return the advice for one of several mistakes; general advice is given once at the end."""
    return "" if advice in (GUIDE, _CORRECT) else f" ({advice})"


def _mistake(problem: ErrorDetails) -> tuple[list[str], str, str]:
    """Return path, problem and advice of a mistake."""
    path = _path(problem)
    if problem["type"] == "missing" and path[-1].isdigit():
        return _dotted(path[:-1]), f"has {path[-1]} of its entries, and needs more", GUIDE
    if problem["type"] == "missing":
        return _dotted(path[:-1]), f"the key '{path[-1]}' is missing", GUIDE
    return _dotted(path), *_words_for(problem, path)


def _path(problem: ErrorDetails) -> list[str]:
    """Return the keys down to a mistake, without the alternatives that pydantic tried.

    A key of the author may have the same name as such an alternative: a top-level key, a reading, an unknown key.
    """
    loc = [str(part) for part in problem["loc"]]
    named = {0, 1} if loc[:1] == ["readings"] else {0}
    if problem["type"] == "extra_forbidden":
        named.add(len(loc) - 1)
    return [part for k, part in enumerate(loc) if k in named or not _is_branch(part)]


def _dotted(path: list[str]) -> list[str]:
    """Return a key's path in notation such as ``faults[0].at``."""
    return ["".join(f"[{p}]" if p.isdigit() else f".{_short(p)}" for p in path).lstrip(".")] if path else []


def _is_branch(part: str) -> bool:
    """Return True if a part of a path is an alternative that pydantic tried."""
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
            return f"must be a mapping of keys to values, is {shown}", GUIDE
        case "string_too_short":
            return "is empty", "give a word or two, or leave the key out"
        case "tuple_type":
            return f"must be a list, is {shown}", "start each entry with a dash"
        case "bool_type" | "float_type" | "float_parsing" if path[:1] == ["readings"]:
            return f"must be a number, true or false, is {shown}", _CORRECT
        case _:
            return f"{problem['msg'].replace('Input should be', 'must be')}, is {shown}", _CORRECT


def _keys_at(problem: ErrorDetails, path: list[str]) -> list[str]:
    """Return the allowed keys at the position of an unknown key."""
    inner: type[BaseModel] = WorldModel
    if path[0] == "readings":
        inner = TruthModel if len(path) == 3 else TreeValueModel
    elif path[0] == "localisation" and len(path) > 1:
        inner = LocalisationModel
    elif path[0] == "events" and len(path) > 2:
        inner = TreeRefModel if "at" in path[2:-1] else ScriptedEventModel
    elif path[0] == "faults":
        inner = TreeRefModel if {"at", "between"} & set(path[2:-1]) else _KINDS_OF_FAULT[str(problem["loc"][2])]
    return list(inner.model_fields)


def _nearest(given: object, known: list[str]) -> str:
    near = _near(given, known)
    return f"did you mean '{near[0]}'?" if near else f"known here: {', '.join(known)}"


def _near(given: object, known: list[str]) -> list[str]:
    return difflib.get_close_matches(str(given).lower(), known, n=1)


def _short(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."
