"""``fieldhand export``: a Task or an event log for other programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import JsonOption, LenientOption, MissionsOption, RecordedSiteOption
from fieldhand.cli.outputs import to_file
from fieldhand.errors import InputError

if TYPE_CHECKING:
    from fieldhand.exchange.routes.route import ExportedRoute
    from fieldhand.mission.documents import SiteAndRobot
    from fieldhand.task.results import Event

#: What each format can hold.
FORMATS = ("btcpp", "geojson", "kml", "csv", "qgc", "mcap", "events")
_OF_TASKS, _OF_LOGS = ("btcpp", "geojson", "kml", "csv", "qgc"), ("geojson", "kml", "csv", "mcap", "events")


def export(
    given: Annotated[
        str,
        typer.Argument(
            metavar="TASK|EVENTS|MISSION",
            help="A Task (.xml), signed mission (.mission), event log (JSON or MCAP), or mission (name or folder).",
        ),
    ],
    to: Annotated[str, typer.Option("--to", help=f"Format: {', '.join(FORMATS)}.")],
    output: Annotated[Path, typer.Option("-o", "--output", callback=to_file, help="Where to write.")],
    site: RecordedSiteOption = None,
    robot: Annotated[str | None, typer.Option("--robot", help="The robot; husky if none is given.")] = None,
    lenient: LenientOption = False,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """Write a Task or an event log for another program."""
    from fieldhand.cli import show
    from fieldhand.cli.inputs import write_file
    from fieldhand.cli.recorded import folder_of, require_nothing_beside

    if to not in FORMATS:
        raise InputError(f"there is no format '{to}'", where="--to", advice=f"choose one of {', '.join(FORMATS)}")
    folder = folder_of(given, kept)
    if folder is not None:
        require_nothing_beside(folder, site=site, robot=robot)
    # A mission's folder holds both; what was driven says more than what was planned.
    is_task = to not in _OF_LOGS if folder else given.lower().endswith((".xml", ".mission"))
    if to not in (_OF_TASKS if is_task else _OF_LOGS):
        what, fits = ("a Task", _OF_TASKS) if is_task else ("an event log", _OF_LOGS)
        raise InputError(f"{what} cannot be written as {to}", where="--to", advice=f"choose one of {', '.join(fits)}")
    source = _Source(given=given, folder=folder, site=site, robot=robot, lenient=lenient)
    made = _of_task(source, to) if is_task else _of_log(source, to, output)
    if made.data is not None:
        write_file(output, made.data)
    if json:
        show.print_json({"format": to, "file": str(output), **made.facts, "notes": list(made.notes)})
        return
    for said in made.notes:
        show.note(said)
    show.out.print(f"{to}: {output}")


@dataclass(frozen=True, kw_only=True)
class _Made:
    """What was exported.

    Attributes:
        data: None where it is written already.
        facts: Numbers for ``--json``.
        notes: What the format could not hold.
    """

    data: bytes | None
    facts: dict[str, Any]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class _Source:
    """What is exported; ``folder`` is that of a mission, where one was given."""

    given: str
    folder: Path | None
    site: str | None
    robot: str | None
    lenient: bool


def _of_task(source: _Source, to: str) -> _Made:
    from fieldhand import mission
    from fieldhand.cli.bundles import is_bundle
    from fieldhand.cli.recorded import plan_of_files, plan_of_folder
    from fieldhand.exchange.btcpp import write_tree
    from fieldhand.exchange.routes.ground_station import write_plan
    from fieldhand.exchange.routes.route import planned
    from fieldhand.robot.capabilities import capabilities_of
    from fieldhand.robot.loader import load_robot

    path = Path(source.given)
    if to == "btcpp" and source.folder is None and not is_bundle(source.given):
        profile = load_robot(source.robot or "husky")
        task, _ = mission.read_task(path, profile)
        return _Made(data=write_tree(task, capabilities_of(profile)), facts={"task": task.id})
    if source.folder is not None:
        plan = plan_of_folder(source.folder)
    elif source.site is None and not is_bundle(source.given):
        raise InputError("the route of a Task needs its site", where="--site", advice="give the site's file, or demo")
    else:
        plan = plan_of_files(path, source.site, source.robot, lenient=source.lenient)
    task, ground = plan.task, plan.ground
    if to == "btcpp":
        return _Made(data=write_tree(task, capabilities_of(ground.robot)), facts={"task": task.id})
    route = planned(task, ground.site, ground.robot)
    facts = _facts(route) | {"task": task.id}
    open_ = [stop for stop in route.stops if not stop.certain]
    if to == "qgc":
        made = write_plan(route, ground.site)
        if not made.stops:
            raise InputError(
                "no part of this mission is straight: its first stop hangs on a reading or on the budget",
                where=source.given,
                advice="choose another format",
            )
        left = f"left out: {made.left_out} stops that hang on a reading or on the budget"
        notes = ("a plan holds drives and waits; what is done at a stop is not in it",)
        return _Made(
            data=made.data,
            facts=facts | {"stops": made.stops, "left_out": made.left_out},
            notes=(*notes, left) if made.left_out else notes,
        )
    note = f"{len(open_)} stops hang on a reading or on the budget; shown is the branch on which every condition holds"
    return _Made(data=_WRITERS[to](route), facts=facts, notes=(note,) if open_ else ())


def _of_log(source: _Source, to: str, output: Path) -> _Made:
    from fieldhand.cli.recorded import ground_of, log_of_folder, plan_of_folder
    from fieldhand.evaluation.event_text import EventText
    from fieldhand.exchange.routes.route import driven
    from fieldhand.finished_missions import read_log
    from fieldhand.robot.loader import load_robot
    from fieldhand.task.event_lines import to_json

    folder, site = source.folder, source.site
    events = (read_log(Path(source.given)) if folder is None else log_of_folder(folder)).events
    facts: dict[str, Any] = {"events": len(events)}
    if to == "events":
        return _Made(data="".join(to_json(event) + "\n" for event in events).encode(), facts=facts)
    if to == "mcap":
        ground: SiteAndRobot | None = None
        if folder is not None:
            ground = plan_of_folder(folder).ground
        elif site is not None:
            ground = ground_of(site, source.robot, lenient=source.lenient)
        _write_mcap(events, output, ground, source.robot or "husky")
        notes = () if ground else ("without --site the map shows no trees",)
        return _Made(data=None, facts=facts, notes=notes)
    named = plan_of_folder(folder).ground.robot if folder is not None else load_robot(source.robot or "husky")
    route = driven(events, tell=EventText(named).line)
    return _Made(data=_WRITERS[to](route), facts=facts | _facts(route))


def _write_mcap(events: tuple[Event, ...], output: Path, ground: SiteAndRobot | None, robot: str) -> None:
    from fieldhand.evaluation.event_text import EventText
    from fieldhand.exchange.mcap import McapLog
    from fieldhand.robot.loader import load_robot

    event_text = EventText(load_robot(robot) if ground is None else ground.robot)
    with McapLog(output, tell=event_text.line, site=None if ground is None else ground.site) as log:
        for event in events:
            log(event)


def _facts(route: ExportedRoute) -> dict[str, Any]:
    metres = route.stops[-1].travelled_m if route.stops else 0.0
    return {"stops": len(route.stops), "travelled_m": round(metres, 3), "driven": route.driven}


def _geojson(route: ExportedRoute) -> bytes:
    from fieldhand.exchange.routes.geojson import write_geojson

    return write_geojson(route)


def _kml(route: ExportedRoute) -> bytes:
    from fieldhand.exchange.routes.kml import write_kml

    return write_kml(route)


def _csv(route: ExportedRoute) -> bytes:
    from fieldhand.exchange.routes.table import write_csv

    return write_csv(route)


_WRITERS: dict[str, Callable[[ExportedRoute], bytes]] = {"geojson": _geojson, "kml": _kml, "csv": _csv}
