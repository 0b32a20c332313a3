"""``fieldhand runs``: the next and the last runs of a standing mission on a robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.cli.links import LinkOptions, MissionOfRobot, UrlArgument
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import JsonOption
from fieldhand.compatibility import datetime_from_iso

if TYPE_CHECKING:
    from fieldhand.delivery.json_models import MissionSummary, Runs


@grouped("url mission token_file ca pin insecure json")
def runs(url: UrlArgument, link: LinkOptions, mission: MissionOfRobot = None, json: JsonOption = False) -> None:
    """List the next runs of a mission with a timetable, and the last ones with what became of them.

    Without a mission: of each one whose timetable the robot keeps.
    """
    from contextlib import closing

    from fieldhand.cli import show
    from fieldhand.cli.links import find_mission

    with closing(link.open(url)) as client:
        if mission is None:
            named = [one for one in client.robot().missions if one.state == "scheduled"]
        else:
            named = [find_mission(client, mission)]
        found = [client.runs(one.bundle) for one in named]
    if json:
        show.print_json([one.model_dump() for one in found])
        return
    if not found:
        show.out.print("The robot keeps no timetable.")
    for one in found:
        show.out.print_lines(*run_lines(one))


def run_lines(found: Runs) -> list[str]:
    """Return the runs of a mission as lines; times are those of this machine's clock."""
    mission = found.mission
    ended = f" ({mission.reason})" if mission.state == "ended" and mission.reason else ""
    return [
        f"mission {mission.mission} {mission.state}{ended}: {mission.request}",
        *(f"  next  {run.due}  {_local(run.due)}, at {_local(run.latest)} at the latest" for run in found.next),
        *(f"  last  {run.due}  {_local(run.due)}, {_outcome(run)}" for run in found.last),
    ]


def _outcome(run: MissionSummary) -> str:
    what = run.status or run.state
    return f"{what}{f' ({run.reason})' if run.reason else ''}; mission {run.mission}"


def _local(text: str) -> str:

    return datetime_from_iso(text).astimezone().strftime("%a %d %b %H:%M")
