"""A case planned, approved, driven in each of its worlds, and judged."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.errors import ModelError, NotApprovedError
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.llm.chat import Chat, ChatMessage, Reply
from fieldhand.planning.planner import Clarify, Outcome, Planned, Planner, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import load_site
from fieldhand.site.model import Site
from fieldhand.task.event_lines import to_json
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk
from fieldhand_bench.missions.cases import Case, CaseWorld
from fieldhand_bench.missions.ground import Ground, load_ground
from fieldhand_bench.missions.judge import judge
from fieldhand_bench.missions.log import read_log

#: What became of a request: a mission; a question; a refusal; no answer of a model that could be used; a Task that a
#: check forbids.
Answer = Literal["planned", "asked", "refused", "failed", "not approved"]

_APPROVED_AT = datetime(2026, 1, 1, tzinfo=UTC)
_FIRST = "go to the first tree"


class Metered:
    """A language model whose answers are counted.

    Attributes:
        tries: Answers that were asked for.
        tokens: Of prompts and answers together, in the endpoint's count.
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


@dataclass(frozen=True, kw_only=True)
class Trial:
    """What came of a case.

    Attributes:
        why: The question, the reasons of a refusal, or what else kept the mission from being driven; else empty.
        wrong: Of each world what was not as asked, one sentence each; a world that was as asked has none.
        worlds: How many the case has.
        tasks: Actions in the plan.
        conditionals: Conditions in the plan.
        plan_s: Seconds that planning took.
        tokens, tries: Of a language model, as long as this case was planned; 0 where none was asked.
    """

    id: str
    request: str
    source: str
    answer: Answer
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
        """Worlds in which what happened was as asked."""
        return sum(not wrong for wrong in self.wrong)


@dataclass(kw_only=True)
class Range:
    """Where cases are tried: the planner, and sites and robots, each opened once.

    Attributes:
        planner: Plans the requests.
        model: Counts what the planner asks a language model; None where it asks none.
        seed: Of every random thing in a simulated mission.
        clock: Seconds, running.
        keep: Takes the lines of each event log, with the case and the number of its world; None keeps none.
    """

    planner: Planner
    model: Metered | None
    seed: int
    clock: Callable[[], float]
    keep: Callable[[Case, int, Sequence[str]], None] | None = None
    _grounds: dict[Path, Ground] = field(default_factory=dict)
    _sites: dict[Path, Site] = field(default_factory=dict)

    def ground(self, path: Path) -> Ground:
        """The judge's view of a site."""
        if path not in self._grounds:
            self._grounds[path] = load_ground(path)
        return self._grounds[path]

    def site(self, path: Path) -> Site:
        """The site as missions know it, with its rows, so that no request is timed with them."""
        if path not in self._sites:
            self._sites[path] = load_site(path)
            _ = self._sites[path].planting
        return self._sites[path]


def try_all(cases: Sequence[Case], on: Range) -> Iterator[Trial]:
    """Each case in turn.

    Raises:
        SiteError: A site cannot be used.
        WorldError: A world speaks of what the site or the robot does not have.
    """
    robots = {name: load_robot(name) for name in dict.fromkeys(case.robot for case in cases)}
    for case in cases:
        for world in case.worlds:
            mission.check_world(world.world, on.site(case.site), robots[case.robot])
    for case in cases[:1]:  # grammar and lexicon are loaded with the first request, which is not to be timed with them
        EnglishPlanner().plan(_FIRST, on.site(case.site), robots[case.robot])
    for case in cases:
        yield _try(case, robots[case.robot], on)


def _try(case: Case, robot: RobotProfile, on: Range) -> Trial:
    site = on.site(case.site)
    tries, tokens = (0, 0) if on.model is None else (on.model.tries, on.model.tokens)
    began = on.clock()
    outcome = _plan(case, site, robot, on.planner)
    plan_s = on.clock() - began
    answer, why = _answer(outcome)
    tasks, conditionals, wrong = 0, 0, []
    if isinstance(outcome, Planned):
        tasks, conditionals = _size(outcome.task)
        if not case.asks:
            try:
                approved = _approve(outcome.task, site, robot)
                logs = [_drive(approved, world, on.seed) for world in case.worlds]
                wrong = _judged(case, logs, on)
            except NotApprovedError as error:
                answer, why = "not approved", str(error)
    right = answer in ("asked", "refused") if case.asks else bool(wrong) and not any(wrong)
    return Trial(
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
        tokens=0 if on.model is None else on.model.tokens - tokens,
        tries=0 if on.model is None else on.model.tries - tries,
    )


def _plan(case: Case, site: Site, robot: RobotProfile, planner: Planner) -> Outcome | ModelError:
    """A model that gives no usable answer fails this case, not the others."""
    try:
        return mission.plan(case.request, site, robot, planner)
    except ModelError as error:
        return error


def _answer(outcome: Outcome | ModelError) -> tuple[Answer, str]:
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
    """Actions and conditions of a plan."""
    nodes = list(walk(task.composition.plan))
    return sum(n.act is not None for n in nodes), sum(n.tested is not None for n in nodes)


def _approve(task: Task, site: Site, robot: RobotProfile) -> mission.ApprovedMission:
    """Approved with every warning, as by a person who accepts them all.

    Raises:
        NotApprovedError: A check forbids it.
    """
    return mission.authorize(
        mission.review(task, site, robot), by="the experiment", at=_APPROVED_AT, confirmed=EveryWarning()
    )


def _drive(approved: mission.ApprovedMission, world: CaseWorld, seed: int) -> tuple[str, ...]:
    """Return the lines of the mission's event log."""
    return tuple(to_json(event) for event in mission.simulate(approved, world=world.world, seed=seed).events)


def _judged(case: Case, logs: Sequence[Sequence[str]], on: Range) -> list[tuple[str, ...]]:
    """What is wrong in each world, seen from the lines of its log alone."""
    ground = on.ground(case.site)
    if on.keep is not None:
        for number, lines in enumerate(logs):
            on.keep(case, number, lines)
    return [
        judge(ground, world.expected, read_log(lines, ground)) for world, lines in zip(case.worlds, logs, strict=True)
    ]
