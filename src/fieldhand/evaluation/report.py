"""The report of a mission: one page that stands alone, and the observations as CSV and GeoJSON beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fieldhand.errors import OutputError
from fieldhand.evaluation.report_data import observations_csv, observations_geojson
from fieldhand.evaluation.report_left_out import not_reached
from fieldhand.evaluation.report_text import tell
from fieldhand.files import write_whole
from fieldhand.forecast.estimate import Estimate
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.authorization import Authorization
from fieldhand.task.frames import Task
from fieldhand.task.results import Event, GoalOutcome


@dataclass(frozen=True, kw_only=True)
class ReportFiles:
    """Where a report was written."""

    page: Path
    csv: Path
    geojson: Path

    @classmethod
    def within(cls, folder: Path) -> ReportFiles:
        """Those of a report in this folder."""
        return cls(
            page=folder / "report.html", csv=folder / "observations.csv", geojson=folder / "observations.geojson"
        )

    @property
    def paths(self) -> tuple[Path, ...]:
        """All of them, the one to read first first."""
        return (self.page, self.csv, self.geojson)


def write_report(
    folder: Path,
    *,
    task: Task,
    site: Site,
    robot: RobotProfile,
    events: Sequence[Event],
    outcomes: Sequence[GoalOutcome],
    authorization: Authorization | None,
    estimate: Estimate | None,
    signed: str = "",
    hashes: Sequence[tuple[str, str]] = (),
) -> ReportFiles:
    """Write the report of a mission into a folder, which is made if needed; files of the same names are replaced.

    Args:
        folder: Where to.
        task, site, robot: What was carried out, where and with what.
        events: The event log; it may have been cut off.
        outcomes: What came of each goal, from :func:`fieldhand.evaluation.outcome.judge`.
        authorization: Who approved what; None where that is not known.
        estimate: What it was expected to take; None leaves the comparison out.
        signed: Whose signature the mission has, in words; empty where there is none.
        hashes: SHA-256 of what the report rests on beside what was approved, each with its name.

    Raises:
        OutputError: The folder or a file in it cannot be written.
    """
    files = ReportFiles.within(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise _cannot_write(folder, fault) from None
    told = tell(
        task=task,
        site=site,
        robot=robot,
        events=events,
        outcomes=outcomes,
        authorization=authorization,
        estimate=estimate,
        signed=signed,
        hashes=hashes,
    )
    from fieldhand.evaluation.report_maps import report_maps
    from fieldhand.evaluation.report_page import page

    _write(files.csv, observations_csv(events))
    _write(files.geojson, observations_geojson(events))
    _write(files.page, page(told, report_maps(site, events, told.summaries, not_reached(task, events))))
    return files


def _write(path: Path, text: str) -> None:
    try:
        # No translation of line ends: CSV has its own.
        write_whole(path, text.encode("utf-8", errors="replace"))
    except OSError as fault:
        raise _cannot_write(path, fault) from None


def _cannot_write(path: Path, fault: OSError) -> OutputError:
    return OutputError(
        f"the report cannot be written ({fault.strerror or fault})",
        where=str(path),
        advice="choose a folder that you may write to",
    )
