"""Plan a case, approve it, simulate it in each of its worlds, and judge the event logs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from itertools import islice
from pathlib import Path
from typing import Literal

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.compatibility import UTC
from fieldhand.errors import ModelError, NotApprovedError
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.llm.chat import Chat, ChatMessage, Reply
from fieldhand.planning.llm.planner import LlmPlanner
from fieldhand.planning.llm.settings import LlmSettings
from fieldhand.planning.planner import Clarify, Outcome, Planned, Planner, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import load_site
from fieldhand.site.model import Site
from fieldhand.task.event_lines import to_json
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk
from fieldhand.timetable.runs import Calendar
from fieldhand_bench.missions.case_site import CaseSite, load_case_site
from fieldhand_bench.missions.cases import Case, CaseWorld
from fieldhand_bench.missions.judge import judge
from fieldhand_bench.missions.log import read_log

#: Result of planning a request: ``planned`` a mission, ``asked`` a question, ``refused``; ``failed`` without a usable
#: answer of the model; ``not approved`` because a check forbids the Task.
TrialAnswer = Literal["planned", "asked", "refused", "failed", "not approved"]

_APPROVED_AT = datetime(2026, 1, 1, tzinfo=UTC)
#: Tolerance of the times of the sun.
_SAME_TIME = timedelta(minutes=3)
_FIRST = "go to the first tree"


class Metered:
    """A language model that counts its answers and tokens.

    Attributes:
        tries: Number of answers requested.
        tokens: Tokens of prompts and answers together, as counted by the endpoint.
    """

    def __init__(self, chat: Chat) -> None:
        self._chat = chat
        self.tries = 0
        self.tokens = 0

    def ask(self, messages: Sequence[ChatMessage]) -> Reply:
        self.tries += 1
        reply = self._chat.ask(messages)
        self.tokens += sum(reply.tokens)
        return reply


@dataclass(frozen=True)
class _Given:
    """A model that answers with a given document."""

    document: str

    def ask(self, messages: Sequence[ChatMessage]) -> Reply:
        del messages  # it answers whatever it is asked
        return Reply(text=self.document)


@dataclass(frozen=True, kw_only=True)
class CaseTrial:
    """The result of a case.

    Attributes:
        id, request, source: As in the case; the id of a trial of its Task ends in ``/task``.
        answer: Result of planning.
        as_asked: True if the case was fulfilled in every world, or a question or refusal was right.
        why: Question, reasons of a refusal, or other reason why the mission was not simulated; empty if it was.
        wrong: Deviations in each world, one sentence each; a world with none was as asked.
        worlds: Number of worlds of the case.
        tasks: Number of actions in the plan.
        conditionals: Number of conditions in the plan.
        plan_s: Time of planning, seconds.
        tokens, tries: Tokens used by and answers requested from a language model for this case; 0 without a model.
    """

    id: str
    request: str
    source: str
    answer: TrialAnswer
    as_asked: bool
    why: str = ""
    wrong: tuple[tuple[str, ...], ...] = ()
    worlds: int = 0
    tasks: int = 0
    conditionals: int = 0
    plan_s: float = 0.0
    tokens: int = 0
    tries: int = 0

    @property
    def worlds_right(self) -> int:
        """Number of worlds in which the outcome was as asked."""
        return sum(not wrong for wrong in self.wrong)


@dataclass(kw_only=True)
class TrialSetup:
    """The setup in which cases are tried: the planner, and sites that are loaded once.

    Attributes:
        planner: Planner of the requests.
        model: Language model of the planner, for its counts; None if it uses none.
        seed: Random seed of the simulated missions.
        clock: Function that returns the current time in seconds.
        keep: Function called with the case, the index of its world and the lines of the event log; None for none.
    """

    planner: Planner
    model: Metered | None
    seed: int
    clock: Callable[[], float]
    keep: Callable[[Case, int, Sequence[str]], None] | None = None
    _case_sites: dict[Path, CaseSite] = field(default_factory=dict)
    _sites: dict[Path, Site] = field(default_factory=dict)

    def case_site(self, path: Path) -> CaseSite:
        """Return a site as read by the judge."""
        if path not in self._case_sites:
            self._case_sites[path] = load_case_site(path)
        return self._case_sites[path]

    def site(self, path: Path) -> Site:
        """Return a site as used by missions, with its rows computed so that no measured time includes them."""
        if path not in self._sites:
            self._sites[path] = load_site(path)
            _ = self._sites[path].planting
        return self._sites[path]


def try_all(cases: Sequence[Case], setup: TrialSetup) -> Iterator[CaseTrial]:
    """Plan, simulate and judge each case; yield its trial.

    Raises:
        SiteError: A site cannot be loaded.
        WorldError: A world refers to something that the site or the robot does not have.
    """
    robots = {name: load_robot(name) for name in dict.fromkeys(case.robot for case in cases)}
    for case in cases:
        for world in case.worlds:
            mission.check_world(world.world, setup.site(case.site), robots[case.robot])
    for case in cases[:1]:  # the first request loads grammar and lexicon, which must not be timed
        EnglishPlanner().plan(_FIRST, setup.site(case.site), robots[case.robot])
    for case in cases:
        yield _try(case, robots[case.robot], setup)
        if case.task:
            yield _try_task(case, robots[case.robot], setup)


def _try_task(case: Case, robot: RobotProfile, setup: TrialSetup) -> CaseTrial:
    """Return the trial of a case whose plan is given, checked as a model's answer is."""
    settings = LlmSettings(provider="openai-compatible", model="the case", repairs=0)
    given = replace(setup, planner=LlmPlanner(settings, chat=_Given(case.task)), model=None)
    return _try(replace(case, id=f"{case.id}/task"), robot, given)


def _try(case: Case, robot: RobotProfile, setup: TrialSetup) -> CaseTrial:
    site = setup.site(case.site)
    tries, tokens = (0, 0) if setup.model is None else (setup.model.tries, setup.model.tokens)
    began = setup.clock()
    outcome = _plan(case, site, robot, setup.planner)
    plan_s = setup.clock() - began
    answer, why = _answer(outcome)
    tasks, conditionals, wrong = 0, 0, []
    if isinstance(outcome, Planned):
        tasks, conditionals = _size(outcome.task)
        why = _other_runs(case, outcome.task, site)
        if not case.asks and not why:
            try:
                approved = _approve(outcome.task, site, robot)
                logs = [_drive(approved, world, setup.seed) for world in case.worlds]
                wrong = _judged(case, logs, setup)
            except NotApprovedError as error:
                answer, why = "not approved", str(error)
    right = answer in ("asked", "refused") if case.asks else bool(wrong) and not any(wrong)
    return CaseTrial(
        id=case.id,
        request=case.request,
        source=case.source,
        answer=answer,
        as_asked=right,
        why=why or ("planned where a question was due" if case.asks and not right else ""),
        wrong=tuple(wrong),
        worlds=len(case.worlds),
        tasks=tasks,
        conditionals=conditionals,
        plan_s=plan_s,
        tokens=0 if setup.model is None else setup.model.tokens - tokens,
        tries=0 if setup.model is None else setup.model.tries - tries,
    )


def _other_runs(case: Case, task: Task, site: Site) -> str:
    """Return how the runs of a plan differ from those of its case; empty if they do not."""
    if task.timing is None:
        return "it has no times" if case.runs else ""
    if not case.runs:
        return "it begins at a time that nobody asked for"
    calendar = Calendar(
        approved=_APPROVED_AT,
        expires=_APPROVED_AT + timedelta(days=90),
        zone=UTC,
        lat=site.start.lat,
        lon=site.start.lon,
    )
    found = list(islice(calendar.runs(task.timing, _APPROVED_AT), len(case.runs) + 1))
    if any(abs(run.due - wanted) > _SAME_TIME for run, wanted in zip(found, case.runs, strict=False)) or len(
        found
    ) < len(case.runs):
        return f"it runs at {', '.join(run.due.isoformat(timespec='minutes') for run in found)}"
    return ""


def _plan(case: Case, site: Site, robot: RobotProfile, planner: Planner) -> Outcome | ModelError:
    """Plan the request of a case; return a ModelError, so that it fails this case and not the others."""
    try:
        return mission.plan(case.request, site, robot, planner, earlier=case.earlier)
    except ModelError as error:
        return error


def _answer(outcome: Outcome | ModelError) -> tuple[TrialAnswer, str]:
    match outcome:
        case Planned():
            return "planned", ""
        case Clarify(question=question):
            return "asked", question
        case Refused(reasons=reasons):
            return "refused", "; ".join(reason.what for reason in reasons)
        case ModelError():
            return "failed", str(outcome)


def _size(task: Task) -> tuple[int, int]:
    """Return the numbers of actions and of conditions in a plan."""
    nodes = list(walk(task.composition.plan))
    return sum(n.act is not None for n in nodes), sum(n.tested is not None for n in nodes)


def _approve(task: Task, site: Site, robot: RobotProfile) -> mission.ApprovedMission:
    """Approve a Task, confirming every warning.

    Raises:
        NotApprovedError: A check fails.
    """
    return mission.authorize(
        mission.review(task, site, robot), by="the experiment", at=_APPROVED_AT, confirmed=EveryWarning()
    )


def _drive(approved: mission.ApprovedMission, world: CaseWorld, seed: int) -> tuple[str, ...]:
    """Return the lines of the mission's event log."""
    return tuple(to_json(event) for event in mission.simulate(approved, world=world.world, seed=seed).events)


def _judged(case: Case, logs: Sequence[Sequence[str]], setup: TrialSetup) -> list[tuple[str, ...]]:
    """Return the deviations in each world, judged from the lines of its event log alone."""
    case_site = setup.case_site(case.site)
    if setup.keep is not None:
        for number, lines in enumerate(logs):
            setup.keep(case, number, lines)
    return [
        judge(case_site, world.expected, read_log(lines, case_site))
        for world, lines in zip(case.worlds, logs, strict=True)
    ]
