"""Load a robot profile: a built-in one by name, or a YAML file by path."""

from __future__ import annotations

import difflib
import hashlib
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from fieldhand.errors import ProfileError
from fieldhand.files import FileFault, read_file
from fieldhand.language import message, recalled
from fieldhand.plugins import Plugin, active
from fieldhand.robot.bindings_loader import ProfileProblem, binding_problems, bindings_of
from fieldhand.robot.camera import Camera
from fieldhand.robot.document import (
    ActionDocument,
    EventDocument,
    ImplementDocument,
    LevelDocument,
    ParameterDocument,
    ProfileDocument,
    QuantityDocument,
)
from fieldhand.robot.events import MonitoredEvent
from fieldhand.robot.implement import Implement
from fieldhand.robot.model import Action, Energy, LegCost, LevelThreshold, Parameter, Patience, Quantity, RobotProfile
from fieldhand.strict_yaml import YamlFault, read_yaml

#: Maximum size of a profile in bytes; a profile is a page or two.
MAX_BYTES = 1_000_000

#: Distance in metres from the trunk to the robot's side if a profile gives no standoff: about a young tree's canopy.
CANOPY_M = 1.0

#: Maximum length of a problem's description in characters; text quoted from the file can be of any length.
_LONGEST = 400
#: Number of problems listed after the first one; the rest are only counted.
_MOST_PROBLEMS = 9

GUIDE = "docs/add-a-robot.md shows a whole profile"


def robot_names() -> tuple[str, ...]:
    """Return the names of the installed robots, those of plugins among them, in alphabetical order."""
    return tuple(active("fieldhand.robots"))


def load_robot(name_or_path: str) -> RobotProfile:
    """Load the profile of a robot.

    Args:
        name_or_path: Built-in name (``husky``), or path of a YAML file. Built-in names take precedence.

    Raises:
        ProfileError: No such robot, or an unusable profile; the message gives the key and advice.
    """
    data, source = profile_bytes(name_or_path)
    return parse_profile(data, source=source)


def load_changed(name_or_path: str, changes: Mapping[str, Any]) -> RobotProfile:
    """Load the profile of a robot with some keys changed.

    Args:
        name_or_path: As for :func:`load_robot`.
        changes: Values by key, mappings within mappings; None removes a key.

    Raises:
        ProfileError: No such robot, or the changed profile is unusable.
    """
    import yaml

    data, source = profile_bytes(name_or_path)
    parse_profile(data, source=source)
    changed = _merged(_content(data, source), changes)
    try:
        text = yaml.safe_dump(changed, sort_keys=False, allow_unicode=True)
    except yaml.YAMLError:
        raise ProfileError(
            message("the changes hold a value that YAML cannot express"),
            where=source,
            advice=message("use numbers, texts, lists and mappings"),
        ) from None
    return parse_profile(text.encode(), source=f"{source}, changed")


def _merged(content: Mapping[Any, Any], changes: Mapping[Any, Any]) -> dict[Any, Any]:
    """Return a mapping with changes applied, mapping by mapping."""
    merged = dict(content)
    for key, value in changes.items():
        if value is None:
            merged.pop(key, None)
        elif isinstance(value, Mapping):
            inner = merged.get(key)
            merged[key] = _merged(inner if isinstance(inner, Mapping) else {}, value)
        else:
            merged[key] = value
    return merged


def parse_profile(data: bytes, *, source: str = "profile") -> RobotProfile:
    """Parse a profile from the bytes of its YAML.

    Args:
        data: Contents of the file; the profile's ``sha256`` is computed from them.
        source: Name of the file in messages.

    Raises:
        ProfileError: The profile is unusable.
    """
    return _parsed(bytes(data), source)


@lru_cache(maxsize=32)
def _parsed(data: bytes, source: str) -> RobotProfile:
    """Return the profile in these bytes; most programs load the same few profiles again and again."""
    content = _content(data, source)
    try:
        document = ProfileDocument.model_validate(content)
    except ValidationError as error:
        raise _refused([_explained(problem) for problem in error.errors(include_url=False)], source) from None
    if found := binding_problems(document):
        raise _refused(found, source)
    return _profile(document, sha256=hashlib.sha256(data).hexdigest(), source=source)


def profile_bytes(name_or_path: str) -> tuple[bytes, str]:
    """Return the YAML of a profile, and its name in messages; see :func:`load_robot`.

    Raises:
        ProfileError: No such robot, or its file cannot be read.
    """
    plugins = active("fieldhand.robots")
    names = tuple(plugins)
    if name_or_path in plugins:
        return _installed_profile(plugins[name_or_path]), name_or_path
    path = Path(name_or_path)
    try:
        return read_file(path, MAX_BYTES, plain=True), str(path)
    except FileFault as fault:
        if fault.kind != "missing":
            advice = {
                "too large": message("give a profile, a short YAML file"),
                "no file": message("give the path of a YAML file"),
            }
            raise ProfileError(
                recalled(fault.what, "file"),
                where=_short(name_or_path),
                advice=advice.get(fault.kind, message("check the path")),
            ) from None
    near = difflib.get_close_matches(name_or_path.lower(), names, n=1)
    hint = message("did you mean '{name}'?", name=near[0]) if near else ""
    raise ProfileError(
        message("no robot or profile file '{name}'", name=_short(name_or_path)),
        advice=message(
            "{hint} The installed robots are {names}; for your own give the path of its YAML file",
            hint=hint,
            names=", ".join(names),
        ),
    )


def _installed_profile(plugin: Plugin) -> bytes:
    """Return the YAML of an installed robot.

    Raises:
        PluginError: The entry point cannot be imported, or is not a readable file.
    """
    file = plugin.load()
    try:
        return bytes(file.read_bytes())  # type: ignore[attr-defined]
    except (AttributeError, TypeError, OSError) as error:
        raise plugin.error(f"is not a readable profile file: {type(error).__name__}: {error}") from error


def _short(text: str) -> str:
    return text if len(text) <= 80 else f"{text[:77]}..."


def _content(data: bytes, source: str) -> dict[Any, Any]:
    """Return the mapping in the YAML."""
    if len(data) > MAX_BYTES:
        raise ProfileError(
            f"is larger than {MAX_BYTES} bytes", where=source, advice="give a profile, a short YAML file"
        )
    try:
        content = read_yaml(data.decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise ProfileError("is not UTF-8 text", where=source, advice="save the profile as UTF-8") from None
    except YamlFault as fault:
        where = f"{source}, line {fault.line}" if fault.line else source
        advice = "correct that line" if fault.line else GUIDE
        raise ProfileError(f"is not YAML: {fault.what}", where=where, advice=advice) from None
    if content is None:
        raise ProfileError("is empty", where=source, advice=GUIDE)
    if not isinstance(content, dict):
        raise ProfileError("is not a mapping of keys to values", where=source, advice=GUIDE)
    return content


def _explained(problem: ErrorDetails) -> ProfileProblem:
    """Return a validation problem of one key in words."""
    path = [str(part) for part in problem["loc"] if part != "[key]"]
    what, advice = _words_for(problem, path)
    return ProfileProblem(path=".".join(path), what=what, advice=advice)


def _refused(problems: Sequence[ProfileProblem], source: str) -> ProfileError:
    """Return one error for all problems: key path and description of each, advice for the first."""
    first, *others = [(_short(problem.path), _quoted(problem.what)) for problem in problems]
    more = "; ".join(f"{key or 'the profile'}: {what}" for key, what in others[:_MOST_PROBLEMS])
    if others:
        some = f", of which {_MOST_PROBLEMS} are" if len(others) > _MOST_PROBLEMS else ""
        more = f" (and {len(others)} more after it{some}: {more})"
    key, what = first
    return ProfileError(f"{what}{more}", where=f"{source}: {key}" if key else source, advice=problems[0].advice)


def _quoted(what: str) -> str:
    return what if len(what) <= _LONGEST else f"{what[: _LONGEST - 3]}..."


def _words_for(problem: ErrorDetails, path: list[str]) -> tuple[str, str]:
    """Return description and advice for a problem. A missing key moves from the path into the description."""
    given = problem["input"]
    shown = _short(str(given)) if isinstance(given, str | int | float) else f"a {type(given).__name__}"
    match problem["type"]:
        case "missing":
            return f"the key {path.pop()!r} is missing", f"add it; {GUIDE}"
        case "value_error":
            what, _, advice = problem["msg"].removeprefix("Value error, ").partition("; ")
            return what, advice or f"correct it; {GUIDE}"
        case "too_short":
            return "is empty", "list at least one"
        case "string_type":
            return f"must be text, is {shown}", 'put it in quotes if it is meant as text ("yes")'
        case "model_type" | "dict_type":
            return f"must be a mapping of keys to values, is {shown}", GUIDE
        case "tuple_type":
            return f"must be a list, is {shown}", "write [one, two], or one item per line after a dash"
        case "float_parsing" | "float_type" | "int_parsing" | "int_type" | "int_from_float":
            return f"must be a {'whole ' if 'int' in problem['type'] else ''}number, is {shown}", "correct the number"
        case "finite_number":
            return f"must be a finite number, is {shown}", "correct the number"
        case _:
            what = problem["msg"].replace("Input should be", "must be")
            return f"{what}, is {shown}", "correct the value"


def _profile(document: ProfileDocument, *, sha256: str, source: str) -> RobotProfile:
    energy = document.energy
    return RobotProfile(
        name=document.name,
        description=document.description,
        actions=tuple(_action(name, a) for name, a in document.actions.items()),
        quantities=tuple(_quantity(name, q) for name, q in document.quantities.items()),
        speed_m_s=document.speed_m_s,
        slow_m_s=document.slow_m_s,
        corridor_m=document.corridor_m,
        turn_deg_s=document.turn_deg_s,
        width_m=document.width_m,
        standoff_m=document.width_m / 2 + CANOPY_M if document.standoff_m is None else document.standoff_m,
        energy=Energy(
            capacity_j=energy.capacity_j,
            drive_j_per_m=energy.drive_j_per_m,
            idle_w=energy.idle_w,
            reserve_percent=energy.reserve_percent,
            warn_percent=energy.warn_percent,
            return_percent=energy.return_percent,
            stop_percent=energy.stop_percent,
            hold_s=energy.hold_s,
            charging=None if energy.charging is None else energy.charging.charging(),
        ),
        leg_cost=LegCost(alpha=document.leg_cost.alpha),
        retries=document.retries,
        patience=Patience(**document.patience.model_dump()),
        ros2=bindings_of(document),
        events=tuple(_event(name, e) for name, e in document.events.items()),
        sha256=sha256,
        source=source,
    )


def _quantity(name: str, document: QuantityDocument) -> Quantity:
    return Quantity(
        name=name,
        unit=document.unit,
        words=document.words,
        levels={word: _level(level) for word, level in document.levels.items()},
        minimum=document.minimum,
        maximum=document.maximum,
        typical=document.typical,
        spread=document.spread,
        labels=document.labels,
    )


def _event(name: str, document: EventDocument) -> MonitoredEvent:
    return MonitoredEvent(name=name, **{**dict(document), "unit": document.unit or ""})


def _level(document: LevelDocument) -> LevelThreshold:
    if document.below is not None:
        return LevelThreshold(direction="below", value=document.below)
    assert document.above is not None  # noqa: S101  LevelDocument has exactly one of the two
    return LevelThreshold(direction="above", value=document.above)


#: Duration in the model of an action that is on while driving, whose time is that of the path.
_SWITCH_S = 1.0


def _action(name: str, document: ActionDocument) -> Action:
    return Action(
        name=name,
        words=document.words,
        verbs=document.verbs,
        measures=document.measures,
        duration_s=_SWITCH_S if document.duration_s is None else document.duration_s,
        energy_j=document.energy_j or 0.0,
        parameters=tuple(_parameter(key, p) for key, p in document.parameters.items()),
        description=document.description,
        labels=document.labels,
        retries=document.retries,
        retry_wait_s=document.retry_wait_s,
        in_doubt=document.in_doubt,
        implement=None if document.implement is None else _implement(document.implement),
        camera=None if document.camera is None else Camera(**document.camera.model_dump()),
    )


def _implement(document: ImplementDocument) -> Implement:
    values = document.model_dump()
    return Implement(**values | {"rate": document.rate or ""})


def _parameter(name: str, document: ParameterDocument) -> Parameter:
    return Parameter(
        name=name,
        kind="choice" if document.choices else "number",
        default=document.default,
        minimum=document.minimum,
        maximum=document.maximum,
        unit=document.unit or "",
        choices=document.choices,
    )
