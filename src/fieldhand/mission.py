"""The way of a mission: plan, review, authorize, carry out, assess. The command line, the API and the page call these.

request ──plan──▶ Task ──review──▶ Review ──authorize──▶ AuthorizedTask ──carry_out──▶ events ──assess──▶ Assessment
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.brief import brief_repr
from fieldhand.errors import InputError, RequestError
from fieldhand.files import state_folder
from fieldhand.language import message
from fieldhand.planning.planner import Answer, Outcome, Planner
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.authorization import AuthorizedTask
from fieldhand.task.exceeded import Exceeded
from fieldhand.task.frames import Task
from fieldhand.task.results import Event, GoalOutcome, MissionStatus
from fieldhand.visible import find_hidden

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.approval.checks import Problem
    from fieldhand.approval.keys.trust import TrustStore
    from fieldhand.approval.readback import ReadBack
    from fieldhand.evaluation.report.writing import ReportFiles
    from fieldhand.execution.guard import Guard
    from fieldhand.execution.journal.records import InputLog
    from fieldhand.execution.mission_runner import Result
    from fieldhand.execution.orders import Order
    from fieldhand.execution.vehicle import Vehicle
    from fieldhand.execution.world import World
    from fieldhand.forecast.estimate import Estimate
    from fieldhand.planning.llm.chat import Chat

PLANNERS = ("auto", "english", "llm")


@dataclass(frozen=True, kw_only=True, repr=False)
class Review:
    """What an operator looks at before approving: the problems found, what it will take, and the plan in words."""

    task: Task
    problems: tuple[Problem, ...]
    estimate: Estimate | None
    read_back: ReadBack | None

    __repr__ = brief_repr

    @property
    def errors(self) -> tuple[Problem, ...]:
        """The problems that forbid approval."""
        return tuple(p for p in self.problems if p.severity == "error")

    @property
    def warnings(self) -> tuple[str, ...]:
        """What has to be confirmed, each as a message: :func:`authorize` takes it in the language that was read."""
        return tuple(p.line() for p in self.problems if p.severity == "warning")


@dataclass(frozen=True, kw_only=True)
class Assessment:
    """The assessment of a finished mission.

    Attributes:
        outcomes: Of each goal.
        exceeded: Limits that were exceeded.
        status: How it ended; None where the log was cut off. A log of an earlier version may call a mission that
            exceeded a limit ``completed``; this does not.
        reason: Why it did not complete, in words.
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


def make_planner(
    name: str,
    environ: Mapping[str, str],
    transcript: Path | None = None,
    *,
    watched: Callable[[Chat], Chat] = lambda chat: chat,
) -> Planner:
    """The planner of that name, a language model configured from the environment.

    Args:
        name: ``auto``, ``english`` or ``llm``.
        environ: Where the language model is configured.
        transcript: Where to keep what is said to a language model and its answers; else :func:`transcript_path`.
        watched: Takes the language model and gives one that asks it: to count its answers, say.

    Raises:
        InputError: There is no planner of that name.
        ModelError: ``llm`` was asked for and no model is configured, or one is configured wrongly.
    """
    if name not in PLANNERS:
        raise InputError(
            message("no planner '{name}'", name=name),
            where="--planner",
            advice=message("choose one of {planners}", planners=", ".join(PLANNERS)),
        )
    from fieldhand.planning.auto import AutoPlanner
    from fieldhand.planning.english.planner import EnglishPlanner

    if name == "english":
        return EnglishPlanner()
    from fieldhand.planning.llm.settings import require_settings, settings_from_environment

    settings = require_settings(environ) if name == "llm" else settings_from_environment(environ)
    if settings is None:
        return AutoPlanner(EnglishPlanner(), None)
    from fieldhand.planning.llm.planner import LlmPlanner
    from fieldhand.planning.llm.transport import ModelChat

    model = LlmPlanner(settings, transcript or transcript_path(environ), chat=watched(ModelChat(settings)))
    return model if name == "llm" else AutoPlanner(EnglishPlanner(), model)


def transcript_path(environ: Mapping[str, str]) -> Path:
    """Where transcripts are kept unless the user says otherwise: in the state folder, added to."""
    return state_folder(environ) / "transcripts.jsonl"


def plan(request: str, site: Site, robot: RobotProfile, planner: Planner, answers: tuple[Answer, ...] = ()) -> Outcome:
    """Turn a request into a Task, a question, or a refusal.

    Args:
        request: What was asked, word for word.
        site, robot: Where and with what.
        planner: Who plans.
        answers: What was answered to earlier questions about this request.

    Raises:
        RequestError: The request is empty or too long, or nobody can see all of it.
        ModelError: A language model was needed and could not be used.
    """
    if not request.strip():
        raise RequestError(
            message("the request is empty"), advice=message("say what the robot should do, and at which trees")
        )
    for what, said in ((message("request"), request), *((message("answer"), answer.answer) for answer in answers)):
        hidden = find_hidden(said, lines=True)
        if hidden is not None:
            where = message("the {what}, character {number}", what=what, number=hidden.at + 1)
            raise RequestError(
                message("nobody can see the character {name}", name=hidden.name),
                where=where,
                advice=message("leave it out"),
            )
    return planner.plan(request, site, robot, answers)


def read_task(path: Path, robot: RobotProfile) -> tuple[Task, bytes]:
    """A Task document from a file, valid against the robot's schema, with its bytes.

    Raises:
        TaskError: The file cannot be read, is not well-formed, or fails the schema (line and element are named).
    """
    from fieldhand.task.codec_xml import read_xml

    document = read_xml(path, advice=message("give a Task document that fieldhand plan wrote"))
    return decode_task(document, robot, source=str(path)), document


def decode_task(document: bytes, robot: RobotProfile, *, source: str = "") -> Task:
    """A Task from its document, valid against the robot's schema.

    Raises:
        TaskError: Not well-formed or not valid; every problem with its line and element.
    """
    from fieldhand.robot.capabilities import capabilities_of
    from fieldhand.task.codec import decode
    from fieldhand.task.schema import require_valid

    require_valid(document, capabilities_of(robot), source=source)
    return decode(document, source=source)


def review(
    task: Task,
    site: Site,
    robot: RobotProfile,
    *,
    seed: int = 0,
    document: bytes | None = None,
    charge_percent: float = 100.0,
) -> Review:
    """Check a Task and say in words what it will do here and what it will take.

    Args:
        task, site, robot: What is to be approved, where, with what.
        seed: Of the forecast.
        document: The bytes that the Task was read from, if there are.
        charge_percent: Charge at the beginning.
    """
    from fieldhand.approval.checks import examine
    from fieldhand.approval.readback import read_back

    found = examine(task, site, robot, document=document, seed=seed, charge_percent=charge_percent)
    words = None if found.estimate is None else read_back(task, site, robot, found.estimate)
    return Review(task=task, problems=found.problems, estimate=found.estimate, read_back=words)


def authorize(
    task: Task,
    site: Site,
    robot: RobotProfile,
    *,
    by: str,
    at: datetime,
    confirmed: Container[str] = (),
    language: str = "en",
) -> AuthorizedTask:
    """Approve a Task for this site and this robot, with the warnings that were shown and accepted.

    Raises:
        NotConfirmedError: It has a warning that is not among the confirmed ones (:attr:`Review.warnings`).
        NotApprovedError: A check fails.
    """
    from fieldhand.approval.authorize import approve

    return approve(
        task, site, robot, by=by, at=at.isoformat(timespec="seconds"), confirmed=confirmed, language=language
    )


def open_bundle(data: bytes, *, source: str, trusted: TrustStore, now: datetime) -> Bundle:
    """The mission of a bundle, once its signature and every byte were found to be good.

    Args:
        data: The file.
        source: What to call it in messages.
        trusted: The keys that this machine trusts.
        now: With time zone.

    Raises:
        BundleError: It is no bundle, was damaged or changed, or is of another format.
        NotTrustedError: Nobody who is trusted here has signed it.
        KeyFileError: The trusted keys cannot be read.
    """
    from fieldhand.approval.bundle.opening import open_bundle

    return open_bundle(data, source=source, known=trusted.known(), now=now)


def check_world(world: World, site: Site, robot: RobotProfile) -> None:
    """See whether a world speaks of this site and this robot.

    Raises:
        WorldError: It names a tree, a quantity or an action that is not there.
    """
    from fieldhand.execution.drivers.groundtruth import GroundTruth

    GroundTruth(world, site, robot, seed=0)


def carry_out(
    authorized: AuthorizedTask,
    site: Site,
    robot: RobotProfile,
    *,
    vehicle: Vehicle,
    seed: int,
    emit: Callable[[Event], None],
    interrupted: Callable[[], str | None] = lambda: None,
    watched: Callable[[Guard], Guard] = lambda guard: guard,
    orders: Callable[[], Order | None] = lambda: None,
    log: InputLog | None = None,
) -> Result:
    """Carry a mission out. :mod:`fieldhand.missions` keeps it in a folder: then it outlasts a power cut.

    Args:
        authorized: What approval gave, for ``site`` and ``robot``.
        vehicle: The robot, or the simulation (:func:`fieldhand.execution.vehicle.simulation`).
        seed: Of what the budget guard draws.
        emit, interrupted: As for :func:`fieldhand.execution.mission_runner.run`; so are ``orders`` and ``log``.
        watched: Takes the budget guard and gives one that asks it: to time its decisions, say.
    """
    from fieldhand.evaluation.failsafe import BudgetFailsafe
    from fieldhand.evaluation.guard import BudgetGuard
    from fieldhand.execution.mission_runner import run
    from fieldhand.forecast.routes import drives_for

    charge, drives = vehicle.charge_percent, drives_for(site, robot)
    guard = BudgetGuard(authorized.task, site, robot, drives, seed, charge_percent=charge)
    return run(
        authorized,
        site=site,
        robot=robot,
        driver=vehicle.driver,
        guard=watched(guard),
        failsafe=BudgetFailsafe(authorized.task, robot, guard.drain),
        clock=vehicle.clock,
        emit=vehicle.disk(emit),
        interrupted=interrupted,
        wall=vehicle.wall,
        orders=orders,
        log=log,
        simulated=vehicle.simulated,
    )


def simulate(
    authorized: AuthorizedTask,
    site: Site,
    robot: RobotProfile,
    *,
    world: World,
    seed: int,
    speed: float | None,
    emit: Callable[[Event], None],
    interrupted: Callable[[], str | None] = lambda: None,
    watched: Callable[[Guard], Guard] = lambda guard: guard,
) -> Result:
    """As :func:`carry_out`, in the world of a simulation (:func:`fieldhand.execution.vehicle.simulation`)."""
    from fieldhand.execution.vehicle import simulation

    made = simulation(site, robot, world, seed=seed, speed=speed)
    given = authorized, site, robot
    return carry_out(*given, vehicle=made, seed=seed, emit=emit, interrupted=interrupted, watched=watched)


def assess(task: Task, events: Sequence[Event], robot: RobotProfile | None = None) -> Assessment:
    """Judge each goal and each limit by the event log.

    Args:
        task: What was carried out.
        events: The log, from its beginning; it may stop anywhere.
        robot: Whose reserve counts where neither Task nor log says one, as in logs of earlier versions.
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
) -> ReportFiles:
    """Write the report of a mission: one page, and the observations as CSV and GeoJSON.

    Args:
        folder: Where to.
        authorized, site, robot: What was carried out, where and with what.
        events: What happened.
        assessment: What came of it.
        forecast: What it was expected to take.
        signed: Whose signature it has, in words; empty where there is none.
        hashes: SHA-256 of what else it rests on, each with its name.

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
    )
