"""``fieldhand export``: convert a Task or an event log to a format of other programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import JsonOption, RecordedOptions
from fieldhand.cli.outputs import to_file
from fieldhand.errors import InputError

if TYPE_CHECKING:
    from fieldhand.exchange.routes.route import ExportedRoute
    from fieldhand.finished_missions import MissionLog
    from fieldhand.mission.documents import SiteAndRobot

#: Names of all formats, of those for Tasks, and of those for event logs.
FORMATS = ("btcpp", "geojson", "kml", "csv", "qgc", "mcap", "events")
_OF_TASKS, _OF_LOGS = ("btcpp", "geojson", "kml", "csv", "qgc"), ("geojson", "kml", "csv", "mcap", "events")


@dataclass(frozen=True, kw_only=True)
class ExportedSourceOptions(RecordedOptions):
    """Site and robot of a Task or an event log."""

    robot: Annotated[str | None, typer.Option("--robot", help="The robot; husky if none is given.")] = None


@grouped("source to output site robot lenient missions json")
def export(
    recorded: ExportedSourceOptions,
    source: Annotated[
        str,
        typer.Argument(
            metavar="TASK|EVENTS|MISSION",
            help="A Task (.xml), signed mission (.mission), event log (JSON or MCAP), or mission (name or folder).",
        ),
    ],
    to: Annotated[str, typer.Option("--to", help=f"Format: {', '.join(FORMATS)}.")],
    output: Annotated[Path, typer.Option("-o", "--output", callback=to_file, help="Where to write.")],
    json: JsonOption = False,
) -> None:
    """Write a Task or an event log for another program."""
    from fieldhand.cli import show
    from fieldhand.cli.inputs import write_file
    from fieldhand.cli.recorded import folder_of, require_nothing_beside

    if to not in FORMATS:
        raise InputError(f"there is no format '{to}'", where="--to", advice=f"choose one of {', '.join(FORMATS)}")
    folder = folder_of(source, recorded.missions)
    if folder is not None:
        require_nothing_beside(folder, site=recorded.site, robot=recorded.robot)
    # A mission's folder contains both; the event log is preferred, as it records what was driven.
    is_task = to not in _OF_LOGS if folder else source.lower().endswith((".xml", ".mission"))
    if to not in (_OF_TASKS if is_task else _OF_LOGS):
        what, fits = ("a Task", _OF_TASKS) if is_task else ("an event log", _OF_LOGS)
        raise InputError(f"{what} cannot be written as {to}", where="--to", advice=f"choose one of {', '.join(fits)}")
    exported = (
        _export_task(source, folder, recorded, to) if is_task else _export_log(source, folder, recorded, to, output)
    )
    if exported.data is not None:
        write_file(output, exported.data)
    if json:
        show.print_json({"format": to, "file": str(output), **exported.facts, "notes": list(exported.notes)})
        return
    for note in exported.notes:
        show.note(note)
    show.out.print(f"{to}: {output}")


@dataclass(frozen=True, kw_only=True)
class _Exported:
    """An exported file.

    Attributes:
        data: Bytes of the file; None if it is written already.
        facts: Fields for ``--json``.
        notes: Parts of the mission that the format cannot represent.
    """

    data: bytes | None
    facts: dict[str, Any]
    notes: tuple[str, ...] = ()


def _export_task(source: str, folder: Path | None, recorded: RecordedOptions, to: str) -> _Exported:
    """Return a Task in a format of other programs; ``folder`` is that of a stored mission, if one is exported."""
    from fieldhand import mission
    from fieldhand.cli.bundles import is_bundle
    from fieldhand.cli.recorded import plan_of_files, plan_of_folder
    from fieldhand.exchange.btcpp import write_tree
    from fieldhand.exchange.routes.ground_station import write_plan
    from fieldhand.exchange.routes.route import planned
    from fieldhand.robot.capabilities import capabilities_of
    from fieldhand.robot.loader import load_robot

    path = Path(source)
    if to == "btcpp" and folder is None and not is_bundle(source):
        profile = load_robot(recorded.robot or "husky")
        task, _ = mission.read_task(path, profile)
        return _Exported(data=write_tree(task, capabilities_of(profile)), facts={"task": task.id})
    if folder is not None:
        plan = plan_of_folder(folder)
    elif recorded.site is None and not is_bundle(source):
        raise InputError("the route of a Task needs its site", where="--site", advice="give the site's file, or demo")
    else:
        plan = plan_of_files(path, recorded.site, recorded.robot, lenient=recorded.lenient)
    task, site_and_robot = plan.task, plan.site_and_robot
    if to == "btcpp":
        return _Exported(data=write_tree(task, capabilities_of(site_and_robot.robot)), facts={"task": task.id})
    route = planned(task, site_and_robot.site, site_and_robot.robot)
    facts = _facts(route) | {"task": task.id}
    open_ = [stop for stop in route.stops if not stop.certain]
    if to == "qgc":
        plan_file = write_plan(route, site_and_robot.site)
        if not plan_file.stops:
            raise InputError(
                "this mission has no fixed route: its first stop depends on a reading or on the budget",
                where=source,
                advice="choose another format",
            )
        left = f"left out: {plan_file.left_out} stops that depend on a reading or on the budget"
        notes = ("the exported plan contains drives and waits, but not what is done at a stop",)
        return _Exported(
            data=plan_file.data,
            facts=facts | {"stops": plan_file.stops, "left_out": plan_file.left_out},
            notes=(*notes, left) if plan_file.left_out else notes,
        )
    note = (
        f"{len(open_)} stops depend on a reading or on the budget; the branch on which every condition is met is shown"
    )
    return _Exported(data=_WRITERS[to](route), facts=facts, notes=(note,) if open_ else ())


def _export_log(source: str, folder: Path | None, recorded: RecordedOptions, to: str, output: Path) -> _Exported:
    """Return an event log in a format of other programs; ``folder`` is that of a stored mission, if one is exported."""
    from fieldhand.cli.recorded import log_of_folder, plan_of_folder, site_and_robot_of
    from fieldhand.exchange.routes.route import driven
    from fieldhand.finished_missions import read_log
    from fieldhand.robot.loader import load_robot
    from fieldhand.task.event_lines import to_json
    from fieldhand.wording.events import EventText

    log = read_log(Path(source)) if folder is None else log_of_folder(folder)
    events = log.events
    facts: dict[str, Any] = {"events": len(events)}
    if to == "events":
        return _Exported(data="".join(to_json(event) + "\n" for event in events).encode(), facts=facts)
    if to == "mcap":
        site_and_robot: SiteAndRobot | None = None
        if folder is not None:
            site_and_robot = plan_of_folder(folder).site_and_robot
        elif recorded.site is not None:
            site_and_robot = site_and_robot_of(recorded.site, recorded.robot, lenient=recorded.lenient)
        _write_mcap(log, output, site_and_robot, recorded.robot or "husky")
        notes = () if site_and_robot else ("without --site the map shows no trees",)
        return _Exported(data=None, facts=facts, notes=notes)
    named = plan_of_folder(folder).site_and_robot.robot if folder is not None else load_robot(recorded.robot or "husky")
    route = driven(events, tell=EventText(named).line)
    return _Exported(data=_WRITERS[to](route), facts=facts | _facts(route))


def _write_mcap(recorded: MissionLog, output: Path, site_and_robot: SiteAndRobot | None, robot: str) -> None:
    from fieldhand.exchange.mcap import McapLog
    from fieldhand.robot.loader import load_robot
    from fieldhand.wording.events import EventText

    event_text = EventText(load_robot(robot) if site_and_robot is None else site_and_robot.robot)
    site = None if site_and_robot is None else site_and_robot.site
    with McapLog(output, tell=event_text.line, site=site, images=recorded.images) as log:
        for event in recorded.events:
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
