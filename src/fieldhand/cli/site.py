"""``fieldhand site``: describe a site."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.options import SITE_HELP, JsonOption, LenientOption, PictureOption, RobotOption
from fieldhand.cli.outputs import to_file

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives
    from fieldhand.site.model import Site


def site(
    file: Annotated[str, typer.Argument(help=SITE_HELP)],
    picture: PictureOption = None,
    all_rows: Annotated[bool, typer.Option("--rows", help="List every row, however many there are.")] = False,
    geojson: Annotated[
        Path | None,
        typer.Option(
            "--geojson",
            callback=to_file,
            help="Write the site with rows, aisles and drivable lines to this GeoJSON file.",
        ),
    ] = None,
    robot: RobotOption = "husky",
    lenient: LenientOption = False,
    json: JsonOption = False,
) -> None:
    """Describe a site: blocks, rows, where a robot can drive, markers, zones, attributes."""
    from fieldhand.cli import show
    from fieldhand.robot.loader import load_robot, robot_names
    from fieldhand.site.describe import describe_driving, report_lines, report_record
    from fieldhand.site.describe.figures import MOST_NOTES
    from fieldhand.site.drives import Drives
    from fieldhand.site.loader import open_site

    opened = open_site(file, lenient=lenient)
    profile = load_robot(robot)
    drives = Drives(opened, profile.width_m / 2, profile.standoff_m)
    others = {name: load_robot(name).width_m for name in robot_names()}
    driving = describe_driving(opened, drives, robot=profile.name, others=others)
    if geojson is not None:
        _write_geojson(opened, drives, geojson)
    if picture is not None:
        from fieldhand.site.drawing import save_site_picture

        save_site_picture(opened, picture, drives.network(), driving)
    if json:
        hashes = {"sha256": opened.sha256, "content_sha256": opened.content_sha256}
        show.print_json(report_record(opened, driving) | hashes | {"notes": list(opened.notes)})
        return
    for line in report_lines(opened, driving, all_rows=all_rows):
        show.out.print(line)
    for note in opened.notes[MOST_NOTES:] if lenient else ():
        show.out.print(f"Note: {note}.")  # a lenient reading lists everything that was left out
    if picture is not None:
        show.out.print(f"Map: {picture}")
    if geojson is not None:
        show.out.print(f"GeoJSON: {geojson}")


def _write_geojson(site: Site, drives: Drives, path: Path) -> None:
    from fieldhand.cli.inputs import write_file
    from fieldhand.site.demo_orchard import to_text
    from fieldhand.site.formats.geojson_export import site_document

    write_file(path, to_text(site_document(site, drives.network())).encode())
