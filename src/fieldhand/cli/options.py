"""Options that several commands share, and the groups in which they are passed."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.outputs import to_file, to_folder, to_named_file, to_picture

if TYPE_CHECKING:
    from fieldhand.language import Language


def _robots() -> list[str]:
    """Return the names that a shell completes a robot with."""
    from fieldhand.robot.loader import robot_names

    return list(robot_names())


def _languages() -> list[str]:
    from fieldhand.language import languages

    return list(languages())


def _planners() -> list[str]:
    from fieldhand.plugins import active

    return list(active("fieldhand.planners"))


SITE_HELP = (
    "File of the site, or a built-in one ('demo', an orchard, or 'vineyard'): GeoJSON or CSV; with the extra"
    " gis also Shapefile, GeoPackage, KML, KMZ."
)
SiteOption = Annotated[str, typer.Option("--site", help=SITE_HELP)]
#: A bundle has its own; what is given beside it must be the same.
MissionSiteOption = Annotated[str | None, typer.Option("--site", help=f"{SITE_HELP} A bundle brings its own.")]
LenientOption = Annotated[
    bool, typer.Option("--lenient", help="Load the valid parts of the site, and list what was left out.")
]
RobotOption = Annotated[
    str,
    typer.Option(
        "--robot", autocompletion=_robots, help="Built-in robot (husky, amiga, tractor) or a profile file (YAML)."
    ),
]
MissionRobotOption = Annotated[
    str | None,
    typer.Option(
        "--robot",
        autocompletion=_robots,
        help="Built-in robot (husky, amiga, tractor) or a profile file; husky if none is given.",
    ),
]
ByOption = Annotated[str | None, typer.Option("--by", help="Name of the operator; else the user who is logged in.")]
YesOption = Annotated[bool, typer.Option("--yes", "-y", help="Approve without asking.")]
ConfirmOption = Annotated[
    bool, typer.Option("--confirm", help="Confirm every warning without asking; --yes alone does not.")
]
PlannerOption = Annotated[
    str,
    typer.Option(
        "--planner",
        autocompletion=_planners,
        help="english (no model), llm (a language model), auto (english, else llm), or a plugin's planner.",
    ),
]
TranscriptOption = Annotated[
    Path | None,
    typer.Option(
        "--transcript",
        callback=to_named_file,
        help="File for the prompts and answers of a language model; else in the user's state folder.",
    ),
]
AnswerOption = Annotated[
    list[str] | None,
    typer.Option("--answer", help="Answer to a question of the planner: a choice or its number; may be repeated."),
]
AssumeOption = Annotated[
    bool, typer.Option("--assume", help="Take the first choice of each question, and note that in the plan.")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON object instead of text.")]
LangOption = Annotated[
    str | None,
    typer.Option(
        "--lang",
        autocompletion=_languages,
        help="Language to read back in: en, es; else the environment's (LANG) if there is one.",
    ),
]
MissionsOption = Annotated[
    Path | None,
    typer.Option("--missions", help="Folder of all missions; else FIELDHAND_MISSIONS, or in the user's state folder."),
]
MissionArgument = Annotated[
    str | None, typer.Argument(help="Name of the mission, or its folder; else the one begun last.")
]
SpeedOption = Annotated[
    str | None,
    typer.Option("--speed", help="Simulated seconds per second (1 is real time), or max."),
]
ProductionOption = Annotated[
    bool, typer.Option("--production", help="Run only missions that a trusted key has signed.")
]
PictureOption = Annotated[
    Path | None, typer.Option("--picture", callback=to_picture, help="Draw a map to this PNG file.")
]
EventsOption = Annotated[
    Path | None, typer.Option("--events", callback=to_file, help="Write the event log (JSON lines) here.")
]
McapOption = Annotated[
    Path | None,
    typer.Option("--mcap", callback=to_file, help="Write the log as MCAP here, for Foxglove and Lichtblick."),
]
LeaveOption = Annotated[
    Path | None, typer.Option("-o", "--out", callback=to_folder, help="Folder for Task, map, events and report.")
]
SeedOption = Annotated[int, typer.Option("--seed", min=0, help="Random seed; the same seed gives the same result.")]
CpuTimeOption = Annotated[
    bool, typer.Option("--cpu-time", help="Measure processor time, for a machine with other load.")
]
RecordedArgument = Annotated[
    str | None,
    typer.Argument(
        metavar="[MISSION|EVENTS]",
        help="Name or folder of a mission, else the one begun last; or an event log (JSON lines or MCAP).",
    ),
]
RecordedSiteOption = Annotated[
    str | None,
    typer.Option("--site", help=f"{SITE_HELP} A signed mission (.mission) brings site and robot."),
]


@dataclass(frozen=True, kw_only=True)
class DisplayOptions:
    """Language of a command's output, and JSON instead of text."""

    lang: LangOption = None
    json: JsonOption = False

    def __post_init__(self) -> None:
        _ = self.language  # an unknown language is refused before the command begins

    @cached_property
    def language(self) -> Language:
        """The language to print in.

        Raises:
            InputError: There is no such language.
        """
        from fieldhand.language import spoken

        return spoken(self.lang, os.environ)

    @property
    def progress(self) -> Language | None:
        """Language of progress messages on a terminal; None for JSON, which has none."""
        return None if self.json else self.language


@dataclass(frozen=True, kw_only=True)
class SiteAndRobotOptions:
    """Site and robot that a command works on."""

    site: SiteOption
    robot: RobotOption = "husky"
    lenient: LenientOption = False


@dataclass(frozen=True, kw_only=True)
class MissionInputOptions:
    """Site and robot of a mission; a signed mission brings its own."""

    site: MissionSiteOption = None
    robot: MissionRobotOption = None
    lenient: LenientOption = False


@dataclass(frozen=True, kw_only=True)
class RecordedOptions:
    """Site and robot of an event log, and the folder of stored missions, which bring their own."""

    site: RecordedSiteOption = None
    robot: Annotated[str | None, typer.Option("--robot", help="Robot of an event log; husky by default.")] = None
    lenient: LenientOption = False
    missions: MissionsOption = None


@dataclass(frozen=True, kw_only=True)
class PlanningOptions:
    """Planner of a request, and the answers to its questions."""

    planner: PlannerOption = "auto"
    answer: AnswerOption = None
    assume: AssumeOption = False
    transcript: TranscriptOption = None


@dataclass(frozen=True, kw_only=True)
class ApprovalOptions:
    """Approval of a plan at the command line."""

    yes: YesOption = False
    confirm: ConfirmOption = False
    by: ByOption = None


@dataclass(frozen=True, kw_only=True)
class OutputOptions:
    """Files that a mission writes."""

    events: EventsOption = None
    mcap: McapOption = None
    output: LeaveOption = None


@dataclass(frozen=True, kw_only=True)
class StoreOptions:
    """Folder in which missions are stored, and the missions that may run from it."""

    missions: MissionsOption = None
    production: ProductionOption = False
