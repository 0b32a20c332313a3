"""The content of a report as plain text, in reading order, with every sentence and heading of the page."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from fieldhand.evaluation.outcome import judge, judge_end
from fieldhand.evaluation.report.images import ReportImages, report_images
from fieldhand.evaluation.report.incidents import FoldedLines, LeftOut, conditions, faults, left_out
from fieldhand.evaluation.report.log_facts import branch_taken, captures, start_of, used
from fieldhand.evaluation.report.place_names import PlaceNames
from fieldhand.evaluation.report.reading_statistics import reading_statistics
from fieldhand.evaluation.report.readings import MOST_ROWS, ReadingRow, ReadingSummary, reading_rows, summaries
from fieldhand.evaluation.report.worked import WorkedRow, worked_rows
from fieldhand.forecast.estimate import Estimate, Figure
from fieldhand.language.words import capitalised, listed, say_action, say_count, say_duration, say_number
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.authorization import Authorization
from fieldhand.task.exceeded import say_status
from fieldhand.task.frames import BudgetKind, Task
from fieldhand.task.request_coverage import ROLE_NAMES, has_ranges, request_pieces
from fieldhand.task.results import Event, GoalOutcome
from fieldhand.wording.watches import say_watch
from fieldhand.wording.ways import say_ways

_MARKS = {"success": "✓ met", "failure": "✗ not met", "indeterminate": "? not known"}

#: Headings of sections and tables, by key of the page.
HEADINGS = {
    "page": "Mission report",
    "asked": "What was asked",
    "words": "How the words were planned",
    "maps": "Map",
    "readings": "Readings",
    "goals": "What was done",
    "worked": "Work along paths",
    "left_out": "What was not done, and why",
    "details": "Each decision",
    "lines": "All of them",
    "faults": "Faults, doubts and interruptions",
    "conditions": "Conditions",
    "took": "What it took, and the forecast",
    "bars": "Dark: used. Dark grey: what half of the missions stay within; light grey: nine in ten."
    " Orange: the average. Red: the budget.",
    "images": "Images",
    "table": "Every reading",
    "warnings": "Warnings that were confirmed",
    "record": "Record",
}
GOAL_HEAD = ("Goal", "Done", "Wanted", "Outcome")
TABLE_HEAD = ("Time", "Place", "Reading", "Compared with its threshold")


@dataclass(frozen=True, kw_only=True)
class GoalRow:
    """A goal, how much of it was done, and why no more."""

    goal: str
    done: str
    wanted: str
    outcome: str
    mark: str
    why: str


@dataclass(frozen=True, kw_only=True)
class Bar:
    """A bar of a resource: what was used beside its forecast and its limit.

    Attributes:
        used, mean, middle, high, limit: Parts of the bar's length, 0 to 1; None if not known.
        words: The same in words.
    """

    name: str
    value: str
    words: tuple[str, ...]
    used: float
    mean: float | None
    middle: float | None
    high: float | None
    limit: float | None


@dataclass(frozen=True, kw_only=True)
class ReportContent:
    """The content of a report, without its maps."""

    title: str
    subtitle: str
    status: str
    verdict: str
    tiles: tuple[tuple[str, str], ...]
    request: str
    words: tuple[tuple[str, str], ...]
    goals: tuple[GoalRow, ...]
    worked: tuple[WorkedRow, ...]
    left_out: tuple[LeftOut, ...]
    faults: FoldedLines
    conditions: FoldedLines
    bars: tuple[Bar, ...]
    summaries: tuple[ReadingSummary, ...]
    rows: tuple[ReadingRow, ...]
    more_rows: str
    warnings: tuple[str, ...]
    record: tuple[tuple[str, str], ...]
    images: ReportImages


def compose(
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
) -> ReportContent:
    """Compose the content of a mission's report.

    Args:
        task, site, robot: The mission's Task, site and robot.
        events: The event log, which may be cut off.
        outcomes: The outcome of each goal.
        authorization: The approval, or None if not known.
        estimate: The forecast, or None to leave the comparison out.
        signed: The signer, in words; empty if the mission is not signed.
        hashes: Name and SHA-256 of each further input.
        images: Folder of the mission, which has its images; None if it is unknown.
    """
    names = PlaceNames(site)
    read = summaries(task, robot, events, reading_statistics(site, events))
    rows = reading_rows({s.quantity: s for s in read}, events, names)
    status, verdict = _verdict(task, robot, events, outcomes)
    return ReportContent(
        title=HEADINGS["page"],
        subtitle=_subtitle(robot, site, authorization),
        status=status,
        verdict=verdict,
        tiles=_tiles(events),
        request=task.command.request or "(no request)",
        words=_words(task),
        goals=tuple(_goal_rows(task, events, outcomes)),
        worked=worked_rows(site, robot, events),
        left_out=left_out(task, events, names),
        faults=faults(robot, events, names),
        conditions=conditions(events, names),
        bars=tuple(_bars(task, events, estimate)),
        summaries=read,
        rows=rows[:MOST_ROWS],
        more_rows=f"More than {MOST_ROWS:,} readings: all are in observations.csv." if len(rows) > MOST_ROWS else "",
        warnings=() if authorization is None else authorization.confirmed,
        record=tuple(_record(task, site, robot, events, authorization, signed, hashes)),
        images=report_images(events, images, names),
    )


def _subtitle(robot: RobotProfile, site: Site, authorization: Authorization | None) -> str:
    day = f", approved {authorization.at[:16].replace('T', ' ')}" if authorization else ""
    return f"{robot.name} on {site.name}{day}"


def _verdict(
    task: Task, robot: RobotProfile, events: Sequence[Event], outcomes: Sequence[GoalOutcome]
) -> tuple[str, str]:
    """Return how the mission ended, in a word, and the outcome in one line."""
    status, reason, found = judge_end(task, events, robot.energy.reserve_percent)
    met = sum(o.outcome == "success" for o in outcomes)
    goals = f"{met} of {say_count(len(outcomes), 'goal')} met" if outcomes else "no goals"
    if status is None:
        text = "".join(f"; {one.why}" for one in found)
        return "cut off", f"Cut off: the log ends before the mission does; {goals} so far{text}."
    if status in ("faulted", "aborted"):
        reason = "; ".join(filter(None, [reason, *(one.why for one in found)]))
    short_of = status == "completed" and met < len(outcomes)
    text = f" ({reason})" if reason else ""
    return "short" if short_of else status, f"{capitalised(say_status(status))}{text}: {goals}."


def _tiles(events: Sequence[Event]) -> tuple[tuple[str, str], ...]:
    metres, seconds, percent = used(events)
    made = sum(e.status == "success" for e in captures(events))
    return (
        (str(made), "capture" if made == 1 else "captures"),
        (f"{metres:,.0f} m", "driven"),
        (say_duration(seconds), "under way"),
        (f"{percent:.1f} %", "of the battery"),
    )


def _words(task: Task) -> tuple[tuple[str, str], ...]:
    """Return what became of each word of the request, or nothing if the Task does not record it."""
    if not has_ranges(task):
        return ()
    pieces = request_pieces(task)
    found = {role: [p.text.strip() for p in pieces if p.role == role] for role in ROLE_NAMES}
    return tuple((capitalised(ROLE_NAMES[role]), "; ".join(texts)) for role, texts in found.items() if texts)


def _goal_rows(task: Task, events: Sequence[Event], outcomes: Sequence[GoalOutcome]) -> Iterable[GoalRow]:
    # The section on work left out contains the reasons at length.
    brief = {outcome.goal: outcome.why for outcome in judge(task, events, reasons=False)}
    goals = {goal.id: goal for goal in task.command.goals}
    for outcome in outcomes:
        goal = goals.get(outcome.goal)
        wanted = "?" if outcome.wanted is None else str(outcome.wanted)
        if goal and goal.optional:
            wanted = "as many as fit" if goal.expected is None else f"{goal.expected}, if the budget allows"
        yield GoalRow(
            goal=capitalised(say_action(goal.action)) if goal else outcome.goal,
            done=str(outcome.done),
            wanted=wanted,
            outcome=outcome.outcome,
            mark=_MARKS[outcome.outcome],
            why=brief.get(outcome.goal, outcome.why),
        )


def _bars(task: Task, events: Sequence[Event], estimate: Estimate | None) -> Iterable[Bar]:
    """Yield distance, time and battery against the forecast of the branch taken and the budget."""
    metres, seconds, percent = used(events)
    branch = branch_taken(events, estimate) if estimate else None
    limits: dict[BudgetKind, float] = {b.kind: b.limit for b in task.constraints.budgets}
    yield _bar("Distance", metres, branch.metres if branch else None, limits.get("distance_m"), "m")
    yield _bar("Time", seconds, branch.seconds if branch else None, limits.get("duration_s"), "s")
    yield _bar("Battery", percent, branch.percent if branch else None, limits.get("energy_percent"), "%")


def _bar(name: str, value: float, figure: Figure | None, limit: float | None, unit: str) -> Bar:
    amounts = [value, *([figure.mean, figure.p50, figure.p90] if figure else []), *([] if limit is None else [limit])]
    whole = max(1.04 * max(amounts), 1e-9)

    def say(amount: float) -> str:
        return say_duration(amount) if unit == "s" else f"{amount:,.{1 if unit == '%' else 0}f} {unit}"

    words = []
    if figure:
        often = f"at most {say(figure.p50)} half of the time, {say(figure.p90)} nine times in ten"
        words.append(f"forecast {say(figure.mean)} on average, {often}")
    if limit is not None:
        words.append(f"budget {say(limit)}")
    return Bar(
        name=name,
        value=say(value),
        words=tuple(words),
        used=value / whole,
        mean=figure.mean / whole if figure else None,
        middle=figure.p50 / whole if figure else None,
        high=figure.p90 / whole if figure else None,
        limit=None if limit is None else limit / whole,
    )


_BUDGETS: dict[BudgetKind, str] = {
    "distance_m": "m of driving",
    "duration_s": "s",
    "energy_percent": "% of the battery",
}


def _record(
    task: Task,
    site: Site,
    robot: RobotProfile,
    events: Sequence[Event],
    authorization: Authorization | None,
    signed: str,
    hashes: Sequence[tuple[str, str]],
) -> Iterable[tuple[str, str]]:
    started = start_of(events)
    yield "Task", task.id
    seed = f", simulated with seed {started.seed}" if started and started.seed is not None else ""
    yield "Robot", f"{robot.name}{seed}"
    yield "Site", site.name
    if authorization is None:
        yield "Approved by", "unknown: the report was made from a log and a Task document"
    else:
        yield "Approved by", f"{authorization.by}, {authorization.at}"
    if signed:
        yield "Signed with", signed
    budgets = [
        f"{say_number(b.limit)} {_BUDGETS[b.kind]}"
        f" ({say_number(100 * b.failure_probability)} % chance of more accepted)"
        for b in task.constraints.budgets
    ]
    if budgets:
        yield "Budget", f"at most {listed(budgets)}"
    for text in say_ways(task.constraints, robot):
        yield "Way", text
    for watch in task.composition.watches:
        yield "Watched", say_watch(watch, robot)
    for text in task.command.assumptions:
        yield "Assumed", text
    if authorization is not None:
        hashes = (
            ("Task", authorization.task_sha256),
            ("site", authorization.site_sha256),
            ("robot", authorization.robot_sha256),
            *hashes,
        )
    for name, value in hashes:
        yield f"SHA-256 of the {name}", value
