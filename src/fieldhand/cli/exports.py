"""``fieldhand export``: the group of commands that write files for other programs."""

from __future__ import annotations

import typer

from fieldhand.cli.default_command import GroupWithDefault
from fieldhand.cli.export import export as export_mission
from fieldhand.cli.export_nav2 import export_site


class _MissionByDefault(GroupWithDefault):
    """``fieldhand export task.xml --to kml`` is ``fieldhand export mission task.xml --to kml``."""

    default = "mission"


export = typer.Typer(
    name="export",
    cls=_MissionByDefault,
    help="Write a Task or an event log for another program (fieldhand export task.xml --to kml), or a site for Nav2.",
    no_args_is_help=True,
)
export.command("mission")(export_mission)
export.command("nav2")(export_site)
