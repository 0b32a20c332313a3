"""Write the report of a mission: its page, and its observations as CSV and GeoJSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fieldhand.errors import OutputError
from fieldhand.evaluation.report.content import compose
from fieldhand.evaluation.report.images import copy_images
from fieldhand.evaluation.report.log_facts import places_ahead
from fieldhand.evaluation.report.observations import observations_csv, observations_geojson
from fieldhand.files import write_whole
from fieldhand.forecast.estimate import Estimate
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.authorization import Authorization
from fieldhand.task.frames import Task
from fieldhand.task.results import Event, GoalOutcome


@dataclass(frozen=True, kw_only=True)
class ReportFiles:
    """Paths of the files of a report."""

    page: Path
    csv: Path
    geojson: Path

    @classmethod
    def within(cls, folder: Path) -> ReportFiles:
        """Return the paths for a report in a folder."""
        return cls(
            page=folder / "report.html", csv=folder / "observations.csv", geojson=folder / "observations.geojson"
        )

    @property
    def paths(self) -> tuple[Path, ...]:
        """All paths, the page first."""
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
    images: Path | None = None,
) -> ReportFiles:
    """Write the report of a mission into a folder, creating it if needed and replacing files of the same names.

    Args:
        task, site, robot: The mission's Task, site and robot.
        events: The event log, which may be cut off.
        outcomes: The outcome of each goal, from :func:`fieldhand.evaluation.outcome.judge`.
        authorization: The approval, or None if not known.
        estimate: The forecast, or None to leave the comparison out.
        signed: The signer, in words; empty if the mission is not signed.
        hashes: Name and SHA-256 of each input beside those approved.
        images: Folder of the mission, which has its images; they are copied beside the report. None if it is unknown.

    Raises:
        OutputError: The folder or a file in it cannot be written.
    """
    files = ReportFiles.within(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise _cannot_write(folder, fault) from None
    content = compose(
        task=task,
        site=site,
        robot=robot,
        events=events,
        outcomes=outcomes,
        authorization=authorization,
        estimate=estimate,
        signed=signed,
        hashes=hashes,
        images=images,
    )
    try:
        copy_images(events, images, folder)
    except OSError as fault:
        raise _cannot_write(folder, fault) from None
    from fieldhand.evaluation.report.maps import report_maps
    from fieldhand.evaluation.report.page import render_page

    _write(files.csv, observations_csv(events))
    _write(files.geojson, observations_geojson(events))
    _write(files.page, render_page(content, report_maps(site, events, content.summaries, places_ahead(task, events))))
    return files


def _write(path: Path, text: str) -> None:
    try:
        # Bytes, because CSV has line ends of its own.
        write_whole(path, text.encode("utf-8", errors="replace"))
    except OSError as fault:
        raise _cannot_write(path, fault) from None


def _cannot_write(path: Path, fault: OSError) -> OutputError:
    return OutputError(
        f"the report cannot be written ({fault.strerror or fault})",
        where=str(path),
        advice="choose a folder that you may write to",
    )
