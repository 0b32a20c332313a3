"""``fieldhand export nav2``: write a site as maps, masks and a route graph for Nav2."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import JsonOption, RecordedOptions
from fieldhand.cli.outputs import refuse_standard_output, require_folder
from fieldhand.errors import InputError
from fieldhand.language import message

if TYPE_CHECKING:
    from fieldhand.mission.documents import SiteAndRobot
    from fieldhand.robot.bindings import Datum
    from fieldhand.task.frames import Task


def _to_folder(param: typer.CallbackParam, path: Path) -> Path:
    """Check that files can be written to a folder.

    Raises:
        OutputError: They cannot.
    """
    option = max(param.opts, key=len)
    refuse_standard_output(path, option)
    require_folder(path, f"{option} {path}")
    return path


@dataclass(frozen=True, kw_only=True)
class MappedSiteOptions(RecordedOptions):
    """Site and robot of an export."""

    robot: Annotated[str | None, typer.Option("--robot", help="The robot; husky if none is given.")] = None


@grouped("site robot lenient task missions datum resolution trunk corners_only output json")
def export_site(
    recorded: MappedSiteOptions,
    output: Annotated[
        Path, typer.Option("-o", "--output", callback=_to_folder, help="Folder to write to; files are replaced.")
    ],
    task: Annotated[
        str | None,
        typer.Option(
            "--task",
            metavar="TASK|MISSION",
            help="A Task, signed mission, or mission: its limits of where to drive, and its path, are written, too.",
        ),
    ] = None,
    datum: Annotated[
        str | None,
        typer.Option(
            "--datum",
            metavar="LAT,LON[,HEADING]",
            help="Origin of the map frame, and where its x axis leads (90: east); that of the profile by default.",
        ),
    ] = None,
    resolution: Annotated[
        float, typer.Option("--resolution", min=0.01, max=1.0, help="Side of a cell of the maps in metres.")
    ] = 0.05,
    trunk: Annotated[
        float, typer.Option("--trunk", min=0.0, max=2.0, help="Radius of the trunks in metres, which widens the rows.")
    ] = 0.0,
    corners_only: Annotated[
        bool, typer.Option("--corners-only", help="Give the route graph no node beside each tree.")
    ] = False,
    json: JsonOption = False,
) -> None:
    """Write a site for Nav2: occupancy map, keep-out and speed masks, route graph, and their parameters."""
    from fieldhand.cli import show
    from fieldhand.cli.inputs import write_file
    from fieldhand.exchange.nav2 import MapOptions, export_nav2

    site_and_robot, read = _inputs(recorded, task)
    options = MapOptions(
        datum=None if datum is None else datum_of(datum),
        resolution_m=resolution,
        trunk_m=trunk,
        at_trees=not corners_only,
    )
    found = export_nav2(site_and_robot.site, site_and_robot.robot, read, options)
    for name, data in found.files.items():
        write_file(output / name, data)
    if json:
        show.print_json(
            {
                "folder": str(output),
                "files": list(found.files),
                "datum": {"lat": found.datum.lat, "lon": found.datum.lon, "heading_deg": found.datum.heading_deg},
                "resolution_m": resolution,
                "columns": found.columns,
                "rows": found.rows,
                "nodes": found.nodes,
                "edges": found.edges,
                "clear_m": round(found.clear_m, 3),
                "notes": list(found.notes),
            }
        )
        return
    for note in found.notes:
        show.note(note)
    show.out.print(f"Maps: {found.columns} x {found.rows} cells of {resolution:g} m")
    show.out.print(f"Route graph: {found.nodes} nodes, {found.edges} edges")
    show.out.print(f"All drives are clear of the map for an inscribed radius of up to {found.clear_m:.2f} m.")
    show.out.print(f"Folder: {output}")


def _inputs(recorded: RecordedOptions, source: str | None) -> tuple[SiteAndRobot, Task | None]:
    """Return site and robot, and the Task if one is given; a mission brings all of them.

    Raises:
        InputError: The site is not given, or given twice.
    """
    from fieldhand.cli.bundles import is_bundle
    from fieldhand.cli.recorded import (
        folder_of,
        plan_of_files,
        plan_of_folder,
        require_nothing_beside,
        site_and_robot_of,
    )

    if source is not None:
        folder = folder_of(source, recorded.missions)
        if folder is not None:
            require_nothing_beside(folder, site=recorded.site, robot=recorded.robot)
            plan = plan_of_folder(folder)
            return plan.site_and_robot, plan.task
        if recorded.site is not None or is_bundle(source):
            plan = plan_of_files(Path(source), recorded.site, recorded.robot, lenient=recorded.lenient)
            return plan.site_and_robot, plan.task
    if recorded.site is None:
        raise InputError(message("no site is given"), where="--site", advice=message("give the site's file, or demo"))
    return site_and_robot_of(recorded.site, recorded.robot, lenient=recorded.lenient), None


def datum_of(text: str) -> Datum:
    """Return the datum that an option states: latitude, longitude, and the heading of the x axis if it is not east.

    Raises:
        InputError: It cannot be read, or is out of range.
    """
    from fieldhand.robot.bindings import Datum

    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    heading = numbers[2] if len(numbers) == 3 else 90.0
    if len(numbers) not in (2, 3) or not (
        abs(numbers[0]) < 90.0 and abs(numbers[1]) <= 180.0 and abs(heading) <= 360.0
    ):
        raise InputError(
            message("{text} is no position in degrees", text=text),
            where="--datum",
            advice=message(
                "give latitude and longitude, as in 37.0711,-120.2583, or with a heading: 37.0711,-120.2583,90"
            ),
        )
    return Datum(lat=numbers[0], lon=numbers[1], heading_deg=heading)
