"""The report of a mission as Markdown: what was asked, what came of it, what it took, what was read."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from fieldhand.evaluation.report_data import captures
from fieldhand.forecast.estimate import BranchEstimate, Estimate, Figure
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.account import NAMES, account, has_ranges
from fieldhand.task.authorization import Authorization
from fieldhand.task.frames import BudgetKind, Task
from fieldhand.task.results import Decided, Ended, Event, Faulted, GoalOutcome, Shed, Started
from fieldhand.task.words import (
    capitalised,
    listed,
    say_action,
    say_count,
    say_duration,
    say_name,
    say_number,
    say_quantity,
)

_MARKS = {"success": "✓ success", "failure": "✗ failure", "indeterminate": "? indeterminate"}
#: Markup anywhere in a line, and markup at its beginning (heading, list, number of a list).
_MARKDOWN, _AT_BEGINNING = re.compile(r"([\\`*_\[\]|<>&~$])"), re.compile(r"^(#|[-+=]|\d+(?=[.)]))")
#: Longer tables stand in the CSV file alone; places beyond these are counted, not named.
_MOST_ROWS, _NAMED = 200, 12


def report_markdown(
    *,
    task: Task,
    site: Site,
    robot: RobotProfile,
    events: Sequence[Event],
    outcomes: Sequence[GoalOutcome],
    authorization: Authorization,
    estimate: Estimate | None,
) -> str:
    """The whole report; text that came from outside is escaped."""
    blocks = [
        "# Mission report",
        f"> {escape(task.command.request) or '(no request)'}",
        *_words(task),
        verdict(events, outcomes),
        "![The way that was driven, with its captures](path.png)",
        "## Goals",
        _goals(task, outcomes),
        "## What it took",
        _took(events, estimate),
        *_given_up(events),
        *_faults(events),
        *_decisions(events),
        "## Readings",
        _readings(events),
        "## Record",
        _record(task, site, robot, events, authorization),
    ]
    return "\n\n".join(blocks) + "\n"


def _words(task: Task) -> Sequence[str]:
    """What became of the words of the request; nothing where the Task does not say it."""
    if not has_ranges(task):
        return ()
    found = {role: [p.text.strip() for p in account(task) if p.role == role] for role in NAMES}
    lines = [f"- {NAMES[role]}: {escape('; '.join(texts))}" for role, texts in found.items() if texts]
    return ("The words of the request, by what became of them:", "\n".join(lines))


def escape(text: str) -> str:
    """Text in which nothing is markup, on one line."""
    line = _MARKDOWN.sub(r"\\\1", " ".join(text.split()))
    begins = _AT_BEGINNING.match(line)
    if begins is None:
        return line
    # A number is escaped behind its last digit, where its full stop or bracket stands.
    cut = begins.end() if begins[0].isdigit() else 0
    return f"{line[:cut]}\\{line[cut:]}"


def verdict(events: Sequence[Event], outcomes: Sequence[GoalOutcome]) -> str:
    """The outcome in one line."""
    ended = end_of(events)
    met = sum(o.outcome == "success" for o in outcomes)
    goals = f"{met} of {say_count(len(outcomes), 'goal')} met" if outcomes else "no goals"
    if ended is None:
        return f"**Cut off**: the log ends before the mission does; {goals} so far."
    reason = f" ({escape(ended.reason)})" if ended.reason else ""
    return f"**{capitalised(ended.status)}**{reason}: {goals}."


def end_of(events: Sequence[Event]) -> Ended | None:
    """The end of the mission, if the log has it."""
    return next((e for e in reversed(events) if isinstance(e, Ended)), None)


def branch_taken(events: Sequence[Event], estimate: Estimate) -> BranchEstimate:
    """The estimate of the branch that was taken; where it was not looked at, that of the most demanding one."""
    answers = [(e.node, e.holds) for e in events if isinstance(e, Decided)]
    for branch in estimate.branches:
        if [(d.node, d.answer) for d in branch.decisions if d.kind == "holds"] == answers:
            return branch
    return estimate.worst


def _goals(task: Task, outcomes: Sequence[GoalOutcome]) -> str:
    goals = {goal.id: goal for goal in task.command.goals}
    rows = []
    for outcome in outcomes:
        goal = goals.get(outcome.goal)
        name = capitalised(say_action(goal.action)) if goal else outcome.goal
        wanted = "?" if outcome.wanted is None else str(outcome.wanted)
        if goal and goal.optional:
            wanted = "as many as fit" if goal.expected is None else f"{goal.expected}, if the budget allows"
        rows.append((escape(name), str(outcome.done), wanted, _MARKS[outcome.outcome], escape(outcome.why)))
    return _table(("Goal", "Done", "Wanted", "Outcome", "Why"), rows) if rows else "None were asked for."


def _took(events: Sequence[Event], estimate: Estimate | None) -> str:
    """Driven distance, time and battery against the estimate of the branch that was taken."""
    metres, seconds, percent = used(events)
    branch = branch_taken(events, estimate) if estimate else None

    def row(name: str, value: str, figure: Figure | None, unit: str) -> tuple[str, ...]:
        if figure is None:
            return (name, value, "", "")
        said = (say_duration(figure.mean), say_duration(figure.p90)) if unit == "s" else None
        digits = 1 if unit == "%" else 0
        mean, high = said or (f"{figure.mean:.{digits}f} {unit}", f"{figure.p90:.{digits}f} {unit}")
        return (name, value, mean, high)

    rows = [
        row("Distance", f"{metres:.0f} m", branch.metres if branch else None, "m"),
        row("Time", say_duration(seconds), branch.seconds if branch else None, "s"),
        row("Battery", f"{percent:.1f} %", branch.percent if branch else None, "%"),
    ]
    return _table(("", "Used", "Expected", "At most, 9 times in 10"), rows)


def used(events: Sequence[Event]) -> tuple[float, float, float]:
    """Metres, seconds and percent of a full battery that the log shows as used."""
    metres = max((getattr(e, "travelled_m", 0.0) for e in events), default=0.0)
    seconds = max((e.t for e in events), default=0.0)
    started = next((e for e in events if isinstance(e, Started)), None)
    charges = [e.charge_percent for e in events if hasattr(e, "charge_percent")]
    percent = started.charge_percent - charges[-1] if started and charges else 0.0
    return metres, seconds, max(0.0, percent)


def _given_up(events: Sequence[Event]) -> Iterable[str]:
    shed = [e for e in events if isinstance(e, Shed)]
    if not shed:
        return
    yield "## Given up to stay inside the budget"
    yield "\n".join(
        f"- {'optional' if e.optional else '**mandatory**'}: {_places(e.places)}: {escape(e.reason)}" for e in shed
    )


def _places(places: Sequence[str]) -> str:
    if not places:
        return "a place"
    named = [escape(p) for p in places[:_NAMED]]
    if len(places) > _NAMED:
        named.append(f"{len(places) - _NAMED} more")
    return f"{say_count(len(places), 'place')} ({listed(named)})"


def _faults(events: Sequence[Event]) -> Iterable[str]:
    faults = [e for e in events if isinstance(e, Faulted)]
    if not faults:
        return
    yield "## Faults"
    yield "\n".join(
        f"- at {clock_time(e.t)}: {escape(e.what or e.fault)}{' (worked around)' if e.handled else ''}" for e in faults
    )


def _decisions(events: Sequence[Event]) -> Iterable[str]:
    decided = [e for e in events if isinstance(e, Decided)]
    if not decided:
        return
    yield "## Conditions"
    rows = "\n".join(f"- at {clock_time(e.t)}: {escape(e.why)}" for e in decided[:_MOST_ROWS])
    more = len(decided) - _MOST_ROWS
    yield rows + (f"\n- and {more} more in the event log" if more > 0 else "")


def _readings(events: Sequence[Event]) -> str:
    made = [e for e in captures(events) if e.status == "success"]
    if not made:
        return "Nothing was captured."
    rows = []
    for event in made[:_MOST_ROWS]:
        values = [
            f"{say_name(q)} {say_quantity(float(f'{v:.4g}'), event.units.get(q, ''))}"
            for q, v in sorted(event.readings.items())
        ]
        rows.append(
            (
                clock_time(event.t),
                escape(f"{event.kind} {event.place}"),
                escape(say_action(event.action)),
                escape("; ".join(values)),
            )
        )
    table = _table(("Time", "Place", "Action", "Reading"), rows)
    more = len(made) - _MOST_ROWS
    return table + (f"\n\nand {more} more in observations.csv" if more > 0 else "")


def clock_time(seconds: float) -> str:
    """Minutes and seconds since the mission began: "3:07"."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"


_BUDGETS: dict[BudgetKind, str] = {
    "distance_m": "m of driving",
    "duration_s": "s",
    "energy_percent": "% of the battery",
}


def _record(task: Task, site: Site, robot: RobotProfile, events: Sequence[Event], authorization: Authorization) -> str:
    started = next((e for e in events if isinstance(e, Started)), None)
    seed = f", simulated with seed {started.seed}" if started and started.seed is not None else ""
    lines = [
        f"Task `{task.id}` for {escape(robot.name)} on {escape(site.name)}{seed}.",
        f"Approved by {escape(authorization.by)} at {escape(authorization.at)}.",
        f"SHA-256: Task `{authorization.task_sha256}`, site `{authorization.site_sha256}`, "
        f"robot `{authorization.robot_sha256}`.",
    ]
    lines += [f"Confirmed: {escape(text)}" for text in authorization.confirmed]
    lines += [f"Assumed: {escape(text)}" for text in task.command.assumptions]
    budgets = [f"{say_number(b.limit)} {_BUDGETS[b.kind]}" for b in task.constraints.budgets]
    if budgets:
        lines.append(f"Budget: at most {listed(budgets)}.")
    return "\n\n".join(lines)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; its cells are escaped by the caller."""
    lines = [f"| {' | '.join(cells)} |" for cells in (head, ["---"] * len(head), *rows)]
    return "\n".join(lines)
