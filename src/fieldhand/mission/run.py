"""A mission that was carried out: its events, its observations and the outcome of each goal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.mission.approve import ApprovedMission
from fieldhand.mission.records import Records
from fieldhand.robot.model import RobotProfile
from fieldhand.short_repr import short_repr
from fieldhand.site.model import Site
from fieldhand.task.authorization import AuthorizedTask
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.evaluation.report.observations import ObservationRow
    from fieldhand.evaluation.report.writing import ReportFiles
    from fieldhand.execution.mission_runner import Result
    from fieldhand.forecast.estimate import Estimate
    from fieldhand.task.exceeded import Exceeded
    from fieldhand.task.results import Event, GoalOutcome, MissionStatus


@dataclass(frozen=True, kw_only=True)
class Assessment:
    """The assessment of a finished mission.

    Attributes:
        outcomes: Outcome of each goal.
        exceeded: Limits that were exceeded.
        status: Final status; None if the log is incomplete. Logs of earlier versions call a mission that exceeded a
            limit ``completed``; here it is not.
        reason: Reason, in words, if it did not complete.
    """

    outcomes: tuple[GoalOutcome, ...]
    exceeded: tuple[Exceeded, ...] = ()
    status: MissionStatus | None = None
    reason: str = ""

    @property
    def goals_met(self) -> bool:
        """Return True if every goal was met."""
        return all(o.outcome == "success" for o in self.outcomes)

    @property
    def success(self) -> bool:
        """Return True if the mission completed, met every goal and exceeded no limit: exit status 0."""
        return self.status == "completed" and self.goals_met and not self.exceeded


@dataclass(frozen=True, kw_only=True, repr=False)
class Run:
    """A mission that was carried out.

    Attributes:
        mission: The approved mission.
        result: How it ended, what it took, and its events.
        images: Folder with the images of its captures; None if none were saved.
    """

    mission: ApprovedMission
    result: Result
    images: Path | None = None

    __repr__ = short_repr

    @cached_property
    def events(self) -> Records[Event]:
        """Every event, in order; the first is ``Started``, the last ``Ended``."""
        return Records(self.result.events)

    @cached_property
    def observations(self) -> Records[ObservationRow]:
        """Every capture, a row per reading."""
        from fieldhand.evaluation.report.observations import observation_rows

        return Records(observation_rows(self.result.events))

    @cached_property
    def assessment(self) -> Assessment:
        """Outcome of each goal and of the mission."""
        return assess(self.mission.task, self.result.events, self.mission.robot)

    @property
    def outcomes(self) -> tuple[GoalOutcome, ...]:
        """Outcome of each goal: success, failure or indeterminate."""
        return self.assessment.outcomes

    @property
    def status(self) -> MissionStatus:
        """Final status of the mission."""
        return self.result.status

    @property
    def reason(self) -> str:
        """Reason, in words, if the mission did not complete; empty if it did."""
        return self.result.reason

    @property
    def success(self) -> bool:
        """Return True if the mission completed, met every goal and exceeded no limit."""
        return self.assessment.success

    def report(self, folder: str | Path) -> ReportFiles:
        """Write the report: one page with maps, and the observations as CSV and GeoJSON.

        Args:
            folder: Folder for the files; made if it does not exist.

        Raises:
            OutputError: The folder cannot be written.
        """
        mission = self.mission
        return report(
            Path(folder),
            mission.authorized,
            mission.site,
            mission.robot,
            self.result.events,
            self.assessment,
            mission.estimate,
            images=self.images,
        )

    def _repr_html_(self) -> str:
        """Return map, outcomes and figures for a notebook."""
        from fieldhand.mission.notebook import html_of_run

        return html_of_run(self)


def assess(task: Task, events: Sequence[Event], robot: RobotProfile | None = None) -> Assessment:
    """Judge each goal and each limit by the event log.

    Args:
        task: The Task that was carried out.
        events: The log from its beginning; it may be cut off anywhere.
        robot: Robot whose reserve counts where neither Task nor log states one, as in logs of earlier versions.
    """
    from fieldhand.evaluation.outcome import judge, judge_end

    reserve = None if robot is None else robot.energy.reserve_percent
    status, reason, found = judge_end(task, events, reserve)
    return Assessment(outcomes=judge(task, events), exceeded=found, status=status, reason=reason)


def report(
    folder: Path,
    authorized: AuthorizedTask,
    site: Site,
    robot: RobotProfile,
    events: Sequence[Event],
    assessment: Assessment,
    forecast: Estimate | None,
    *,
    signed: str = "",
    hashes: Sequence[tuple[str, str]] = (),
    images: Path | None = None,
) -> ReportFiles:
    """Write the report of a mission: one page, and the observations as CSV and GeoJSON.

    Args:
        folder: Folder for the files.
        authorized, site, robot: The mission.
        events: Its event log.
        assessment: Outcome of its goals.
        forecast: The forecast that was approved.
        signed: Name of the signer, in words; empty for an unsigned one.
        hashes: SHA-256 of further files that the mission rests on, each with a name.
        images: Folder of the mission with its images; None if it is unknown.

    Raises:
        OutputError: The folder cannot be written.
    """
    from fieldhand.evaluation.report.writing import write_report

    return write_report(
        folder,
        task=authorized.task,
        site=site,
        robot=robot,
        events=events,
        outcomes=assessment.outcomes,
        authorization=authorized.authorization,
        estimate=forecast,
        signed=signed,
        hashes=hashes,
        images=images,
    )
