"""The report of a mission: Markdown with a picture of the driven path, observations as CSV and GeoJSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fieldhand.errors import OutputError
from fieldhand.evaluation.report_data import observations_csv, observations_geojson
from fieldhand.evaluation.report_text import report_markdown
from fieldhand.forecast.estimate import Estimate
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.authorization import Authorization
from fieldhand.task.frames import Task
from fieldhand.task.results import Event, GoalOutcome


@dataclass(frozen=True, kw_only=True)
class ReportFiles:
    """Where a report was written."""

    markdown: Path
    picture: Path
    csv: Path
    geojson: Path

    @property
    def paths(self) -> tuple[Path, ...]:
        """All of them, the one to read first first."""
        return (self.markdown, self.picture, self.csv, self.geojson)


def write_report(
    folder: Path,
    *,
    task: Task,
    site: Site,
    robot: RobotProfile,
    events: Sequence[Event],
    outcomes: Sequence[GoalOutcome],
    authorization: Authorization,
    estimate: Estimate | None,
) -> ReportFiles:
    """Write the report of a mission into a folder, which is made if needed; files of the same names are replaced.

    Args:
        folder: Where to.
        task, site, robot: What was carried out, where and with what.
        events: The event log; it may have been cut off.
        outcomes: What came of each goal, from :func:`fieldhand.evaluation.outcome.judge`.
        authorization: Who approved what.
        estimate: What it was expected to take; None leaves the comparison out.

    Raises:
        OutputError: The folder or a file in it cannot be written.
    """
    files = ReportFiles(
        markdown=folder / "report.md",
        picture=folder / "path.png",
        csv=folder / "observations.csv",
        geojson=folder / "observations.geojson",
    )
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise _cannot_write(folder, fault) from None
    text = report_markdown(
        task=task,
        site=site,
        robot=robot,
        events=events,
        outcomes=outcomes,
        authorization=authorization,
        estimate=estimate,
    )
    _write(files.csv, observations_csv(events))
    _write(files.geojson, observations_geojson(events))
    from fieldhand.evaluation.report_picture import save_path_picture

    save_path_picture(site, events, files.picture)
    _write(files.markdown, text)
    return files


def _write(path: Path, text: str) -> None:
    try:
        # No translation of line ends: CSV has its own.
        path.write_bytes(text.encode("utf-8", errors="replace"))
    except OSError as fault:
        raise _cannot_write(path, fault) from None


def _cannot_write(path: Path, fault: OSError) -> OutputError:
    return OutputError(
        f"the report cannot be written ({fault.strerror or fault})",
        where=str(path),
        advice="choose a folder that you may write to",
    )
