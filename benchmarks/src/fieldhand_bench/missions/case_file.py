"""Read cases from YAML files, and explain mistakes in them."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from fieldhand.errors import CaseError
from fieldhand.execution.drivers.simulation.world_file import parse_world
from fieldhand.files import FileFault, read_file
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import BUILT_IN_SITES, built_in_path
from fieldhand.strict_yaml import YamlFault, read_yaml
from fieldhand_bench.missions.case_form import (
    BookForm,
    CaseForm,
    EndForm,
    ExpectForm,
    OffsetForm,
    PlaceForm,
    StepForm,
    WorldForm,
)
from fieldhand_bench.missions.case_site import CaseSite, load_case_site
from fieldhand_bench.missions.cases import Case, CaseWorld, Expected
from fieldhand_bench.missions.form import Form
from fieldhand_bench.missions.places import Attributes, CasePlace, Positions

BUILTIN = "builtin"
#: A case has about twenty lines; a larger file is not a file of cases.
MAX_BYTES = 5_000_000
GUIDE = "see docs/bench-missions.md"

_SITES = {f"builtin:{name}": built_in_path(name) for name in BUILT_IN_SITES}
#: Forms by the key that contains them.
_FORMS: dict[str, type[Form]] = {
    "cases": CaseForm,
    "worlds": WorldForm,
    "expect": ExpectForm,
    "steps": StepForm,
    "at": PlaceForm,
    "at_all": PlaceForm,
    "end": EndForm,
    "offset": OffsetForm,
}


def load_cases(names: Sequence[str]) -> tuple[Case, ...]:
    """Return the cases of YAML files, in their order.

    Args:
        names: Paths of YAML files; ``builtin`` for the cases on the built-in orchard.

    Raises:
        CaseError: A file cannot be read or used, or a case does not fit its robot or site.
        WorldError: The readings of a world are invalid.
        ProfileError: A robot is unknown or its profile is invalid.
    """
    loaders = _Loaders(case_site=cache(load_case_site), robot=cache(load_robot))
    cases = [case for name in names for path in _files(name) for case in _cases(path, loaders)]
    seen: dict[str, str] = {}
    for case in cases:
        if case.id in seen:
            raise CaseError(
                f"two cases are called '{case.id}'" + (f", the other in {seen[case.id]}" if seen[case.id] else ""),
                where=case.source,
                advice="give each an id of its own",
            )
        seen[case.id] = case.source
    return tuple(cases)


@dataclass(frozen=True, kw_only=True)
class _Loaders:
    """Cached loaders, so that each site and robot is read once for all cases."""

    case_site: Callable[[Path], CaseSite]
    robot: Callable[[str], RobotProfile]


def _files(name: str) -> list[Path]:
    if name != BUILTIN:
        return [Path(name)]
    folder = Path(str(resources.files("fieldhand_bench.missions"))) / BUILTIN
    return sorted(folder.glob("*.yaml"))


def _cases(path: Path, loaders: _Loaders) -> list[Case]:
    content = _content(path)
    try:
        book = BookForm.model_validate(content)
    except ValidationError as error:
        raise _explained(error, path, content) from None
    return [_case(form, book, path, loaders) for form in book.cases]


def _case(form: CaseForm, book: BookForm, path: Path, loaders: _Loaders) -> Case:
    where = f"{path}, case '{form.id}'"
    named, robot_name = form.site or book.site, form.robot or book.robot
    if named is None:
        raise CaseError("has no site", where=where, advice="give 'site' for the case or for the whole file")
    if robot_name is None:
        raise CaseError("has no robot", where=where, advice="give 'robot' for the case or for the whole file")
    site = _site(named, path, where)
    case_site, robot = loaders.case_site(site), loaders.robot(robot_name)
    worlds = []
    for number, world in enumerate(form.worlds or ()):
        at = f"{where}: worlds[{number}]"
        _require_actions(world.expect.actions, robot, at)
        expected = world.expect.expected()
        _fits(expected, case_site, at)
        read = parse_world(world.world(), source=at)
        worlds.append(CaseWorld(world=read, expected=expected))
    return Case(
        id=form.id,
        request=form.request,
        site=site,
        robot=robot_name,
        worlds=tuple(worlds),
        asks=form.ask,
        runs=form.runs,
        source=str(path),
        task=form.task or "",
        earlier=None if form.earlier is None else form.earlier.records(),
    )


def _site(named: str, path: Path, where: str) -> Path:
    if named.startswith("builtin:"):
        if named not in _SITES:
            raise CaseError(
                f"there is no built-in site '{named}'", where=where, advice=f"use {' or '.join(_SITES)}, or a file"
            )
        return _SITES[named]
    site = (path.parent / named).resolve()
    if not site.is_file():
        raise CaseError(
            f"there is no site file '{named}'", where=where, advice=f"name it as seen from {path.parent or Path()}"
        )
    return site


def _require_actions(actions: Iterable[str], robot: RobotProfile, where: str) -> None:
    known = list(robot.action)
    for action in actions:
        if action not in known:
            raise CaseError(
                f"the robot {robot.name} has no action '{action}'", where=where, advice=_hint(action, known)
            )


def _fits(expected: Expected, case_site: CaseSite, where: str) -> None:
    """Raise a CaseError if the site lacks a tree, an attribute, a marker or a zone that is expected."""
    if isinstance(expected.end, str) and expected.end not in case_site.markers:
        raise CaseError(f"the site has no {expected.end} marker", where=where, advice="expect another end")
    near = (*expected.keeps_from, *(one.near for one in expected.slow_near))
    for kept in near:
        if kept.zone and kept.zone not in case_site.zones:
            raise CaseError(f"the site has no zone '{kept.zone}'", where=where, advice="name a polygon of its file")
    ends = (expected.end,) if isinstance(expected.end, CasePlace) else ()
    kept_places = (kept.trees for kept in near)
    for place in (*(step.at for step in expected.steps or ()), expected.at_all, *ends, *kept_places):
        for demand in place.demands:
            match demand:
                case Positions(positions=positions) if max(positions) >= len(case_site.xy):
                    raise CaseError(
                        f"ids: there is no tree {max(positions)}",
                        where=where,
                        advice=f"the site's {len(case_site.xy)} trees are counted from 0",
                    )
                case Attributes(values=values):
                    there = {key for properties in case_site.properties for key in properties}
                    for key in values:
                        if key not in there:
                            raise CaseError(
                                f"no tree has the attribute '{key}'", where=where, advice=_hint(key, sorted(there))
                            )


def _content(path: Path) -> dict[Any, Any]:
    try:
        text = read_file(path, MAX_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise CaseError("is not UTF-8 text", where=str(path), advice="save it as UTF-8") from None
    except FileFault as fault:
        advice = "is it a file of cases?" if fault.kind == "too large" else f"give a YAML file of cases, or '{BUILTIN}'"
        raise CaseError(fault.what, where=str(path), advice=advice) from None
    try:
        content = read_yaml(text, aliases=True)
    except YamlFault as fault:
        where = f"{path}, line {fault.line}" if fault.line else str(path)
        advice = "correct that line" if fault.line else "save it as plain text"
        raise CaseError(f"is not YAML: {fault.what}", where=where, advice=advice) from None
    if not isinstance(content, dict):
        raise CaseError("holds no cases", where=str(path), advice=f"begin with site:, robot: and cases:; {GUIDE}")
    return content


def _explained(error: ValidationError, path: Path, content: dict[Any, Any]) -> CaseError:
    """Return the first mistake as an error, unknown keys before others: file, case, key, problem and advice."""
    problems = error.errors(include_url=False)
    first = min(problems, key=lambda p: p["type"] != "extra_forbidden")
    loc = list(first["loc"])
    if first["type"] in ("missing", "extra_forbidden"):
        *loc, key = loc
        where = _where(path, content, loc)
        if first["type"] == "missing":
            return CaseError(f"the key '{key}' is missing", where=where, advice=GUIDE)
        return CaseError(f"there is no key '{key}' here", where=where, advice=_hint(str(key), _keys(loc)))
    return CaseError(_words(first), where=_where(path, content, loc), advice=GUIDE)


def _where(path: Path, content: dict[Any, Any], loc: list[int | str]) -> str:
    """Return the location of a mistake: the file, the id of the case, and the path of keys and indices in it."""
    text = str(path)
    if len(loc) > 1 and loc[0] == "cases" and isinstance(loc[1], int):
        case = content["cases"][loc[1]]
        named = case.get("id") if isinstance(case, dict) else None
        text += f", case '{named}'" if isinstance(named, str) else f", case {loc[1] + 1} of the list"
        loc = loc[2:]
    inner = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in loc).lstrip(".")
    return f"{text}: {inner}" if inner else text


def _keys(loc: list[int | str]) -> list[str]:
    """Return the keys that are allowed at a location."""
    named = [part for part in loc if isinstance(part, str)]
    return list((_FORMS.get(named[-1], BookForm) if named else BookForm).keys())


def _words(problem: ErrorDetails) -> str:
    given = problem["input"]
    shown = f"'{given}'" if isinstance(given, str | int | float) else "something else"
    match problem["type"]:
        case "value_error":
            return problem["msg"].removeprefix("Value error, ")
        case "model_type" | "dict_type" | "model_attributes_type":
            return f"must be a mapping of keys to values, is {shown}"
        case "tuple_type":
            return f"must be a list, is {shown}"
        case _:
            return f"{problem['msg'].replace('Input should be', 'must be')}, is {shown}"


def _hint(given: str, known: list[str]) -> str:
    near = difflib.get_close_matches(given, known, n=1)
    return f"did you mean '{near[0]}'?" if near else f"known here: {', '.join(known)}"
