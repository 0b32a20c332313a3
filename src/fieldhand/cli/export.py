"""``fieldhand export``: a Task or an event log for other programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import JsonOption, LenientOption, RobotOption
from fieldhand.errors import InputError

if TYPE_CHECKING:
    from fieldhand.cli.inputs import Ground
    from fieldhand.exchange.routes.route import Route
    from fieldhand.task.results import Event

#: What each format can hold.
FORMATS = ("btcpp", "geojson", "kml", "csv", "qgc", "mcap", "events")
_OF_TASKS, _OF_LOGS = ("btcpp", "geojson", "kml", "csv", "qgc"), ("geojson", "kml", "csv", "mcap", "events")


def export(
    given: Annotated[
        Path, typer.Argument(metavar="TASK|EVENTS", help="A Task (.xml), or an event log (JSON or MCAP).")
    ],
    to: Annotated[str, typer.Option("--to", help=f"Format: {', '.join(FORMATS)}.")],
    output: Annotated[Path, typer.Option("-o", "--output", help="Where to write.")],
    site: Annotated[str | None, typer.Option("--site", help="Site; needed for the route of a Task.")] = None,
    robot: RobotOption = "husky",
    lenient: LenientOption = False,
    json: JsonOption = False,
) -> None:
    """Write a Task or an event log for another program."""
    from fieldhand.cli import show
    from fieldhand.cli.inputs import write_file

    if to not in FORMATS:
        raise InputError(f"there is no format '{to}'", where="--to", advice=f"choose one of {', '.join(FORMATS)}")
    is_task = given.suffix.lower() == ".xml"
    if to not in (_OF_TASKS if is_task else _OF_LOGS):
        what, fits = ("a Task", _OF_TASKS) if is_task else ("an event log", _OF_LOGS)
        raise InputError(f"{what} cannot be written as {to}", where="--to", advice=f"choose one of {', '.join(fits)}")
    made = _of_task(given, to, site, robot, lenient) if is_task else _of_log(given, to, site, robot, lenient, output)
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


def _of_task(path: Path, to: str, site: str | None, robot: str, lenient: bool) -> _Made:
    from fieldhand import mission
    from fieldhand.cli.inputs import open_ground
    from fieldhand.exchange.btcpp import write_tree
    from fieldhand.exchange.routes.ground_station import write_plan
    from fieldhand.exchange.routes.route import planned
    from fieldhand.robot.capabilities import capabilities_of
    from fieldhand.robot.loader import load_robot

    if to == "btcpp":
        profile = load_robot(robot)
        task, _ = mission.read_task(path, profile)
        return _Made(data=write_tree(task, capabilities_of(profile)), facts={"task": task.id})
    if site is None:
        raise InputError("the route of a Task needs its site", where="--site", advice="give the site's file, or demo")
    ground = open_ground(site, robot, lenient=lenient)
    task, _ = mission.read_task(path, ground.robot)
    route = planned(task, ground.site, ground.robot)
    facts = _facts(route) | {"task": task.id}
    open_ = [stop for stop in route.stops if not stop.certain]
    if to == "qgc":
        made = write_plan(route, ground.site)
        if not made.stops:
            raise InputError(
                "no part of this mission is straight: its first stop hangs on a reading or on the budget",
                where=str(path),
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


def _of_log(path: Path, to: str, site: str | None, robot: str, lenient: bool, output: Path) -> _Made:
    from fieldhand.cli.inputs import open_ground
    from fieldhand.exchange.routes.route import driven
    from fieldhand.past import read_log
    from fieldhand.task.results import to_json

    events = read_log(path)
    facts: dict[str, Any] = {"events": len(events)}
    if to == "events":
        return _Made(data="".join(to_json(event) + "\n" for event in events).encode(), facts=facts)
    if to == "mcap":
        ground = None if site is None else open_ground(site, robot, lenient=lenient)
        _write_mcap(events, output, ground, robot)
        notes = () if site else ("without --site the map shows no trees",)
        return _Made(data=None, facts=facts, notes=notes)
    route = driven(events)
    return _Made(data=_WRITERS[to](route), facts=facts | _facts(route))


def _write_mcap(events: tuple[Event, ...], output: Path, ground: Ground | None, robot: str) -> None:
    from fieldhand.evaluation.telling import Teller
    from fieldhand.exchange.mcap import McapLog
    from fieldhand.robot.loader import load_robot

    teller = Teller(load_robot(robot) if ground is None else ground.robot)
    with McapLog(
        output, began_s=_began_s(events), tell=teller.tell, site=None if ground is None else ground.site
    ) as log:
        for event in events:
            log(event)


def _began_s(events: tuple[Event, ...]) -> float:
    """When the mission of a log began, in seconds since 1970; 0 where the log does not say."""
    from fieldhand.task.results import Started

    started = next((event for event in events if isinstance(event, Started)), None)
    try:
        return 0.0 if started is None else datetime.fromisoformat(started.at).timestamp()
    except (ValueError, OverflowError):
        return 0.0


def _facts(route: Route) -> dict[str, Any]:
    metres = route.stops[-1].travelled_m if route.stops else 0.0
    return {"stops": len(route.stops), "travelled_m": round(metres, 3), "driven": route.driven}


def _geojson(route: Route) -> bytes:
    from fieldhand.exchange.routes.geojson import write_geojson

    return write_geojson(route)


def _kml(route: Route) -> bytes:
    from fieldhand.exchange.routes.kml import write_kml

    return write_kml(route)


def _csv(route: Route) -> bytes:
    from fieldhand.exchange.routes.table import write_csv

    return write_csv(route)


_WRITERS: dict[str, Callable[[Route], bytes]] = {"geojson": _geojson, "kml": _kml, "csv": _csv}
