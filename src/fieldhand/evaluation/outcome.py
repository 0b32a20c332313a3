"""The outcome of each goal, from the event log alone (IEEE 1872.1, results frame).

* Every goal counts captures: those that succeeded against those wanted on the branch that was taken.
* What had to be done and was not is a failure, whatever the reason; a goal whose branch was not taken, or whose step is
  optional and was shed, is met with none wanted; "as many as you can" is met by one capture if nothing failed.
* Where the mission was cut off before it could be known, the outcome is indeterminate; so it is where all that is
  missing is in doubt.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Literal

from fieldhand.evaluation.capture_counts import CaptureCount
from fieldhand.evaluation.log_replay import replay_log
from fieldhand.language import counted, joined, kept_in_log, message, shaped
from fieldhand.language.words import say_captures
from fieldhand.task.exceeded import Exceeded, exceeded_limits, final_status, reason_with, say_status
from fieldhand.task.frames import Goal, Task
from fieldhand.task.results import Ended, Event, GoalOutcome, MissionStatus

_LONGEST_REASON = 160

OutcomeName = Literal["success", "failure", "indeterminate"]


def judge(
    task: Task, events: Sequence[Event], *, under_way: bool = False, reasons: bool = True
) -> tuple[GoalOutcome, ...]:
    """Return the outcome of each goal of a Task, in the order of its goals.

    Args:
        task: The Task that was carried out.
        events: The event log, from its beginning; it may stop anywhere.
        under_way: True if the mission goes on: goals not reached yet are not explained.
        reasons: False to explain outcomes without the recorded reasons of work that was given up or left out.
    """
    counts = replay_log(task.composition.plan, events)
    ended = next((e for e in reversed(events) if isinstance(e, Ended)), None)
    return tuple(
        _outcome(goal, counts.get(goal.node, CaptureCount(open=True)), ended, under_way=under_way, reasons=reasons)
        for goal in task.command.goals
    )


def judge_end(
    task: Task, events: Sequence[Event], reserve_percent: float | None = None
) -> tuple[MissionStatus | None, str, tuple[Exceeded, ...]]:
    """Return how a mission ended, why, and the limits that it exceeded; None and no reason where the log was cut off.

    Args:
        task: The Task that was carried out.
        events: The event log, from its beginning; it may stop anywhere.
        reserve_percent: Charge that must be left where neither Task nor log says it.
    """
    found = exceeded_limits(task.constraints, events, reserve_percent)
    ended = next((e for e in reversed(events) if isinstance(e, Ended)), None)
    if ended is None:
        return None, "", found
    status = final_status(ended.status, found)
    return status, ended.reason if status == ended.status else reason_with(found, ended.reason), found


def _outcome(goal: Goal, tally: CaptureCount, ended: Ended | None, *, under_way: bool, reasons: bool) -> GoalOutcome:
    verdict = _optional(goal, tally, ended) if goal.optional else _mandatory(tally, ended)
    wanted = None if tally.open else tally.wanted
    because = _because(tally) if reasons else ""
    why = _why(goal, tally, verdict, ended, because, under_way=under_way)
    return GoalOutcome(goal=goal.id, outcome=verdict, done=tally.done, wanted=wanted, why=why)


def _mandatory(tally: CaptureCount, ended: Ended | None) -> OutcomeName:
    if not tally.open and tally.done >= tally.wanted:
        return "success"
    if tally.failed or tally.given_up:
        return "failure"
    if ended is None or (not tally.open and tally.done + tally.in_doubt >= tally.wanted):
        return "indeterminate"
    if ended.status == "aborted" and not tally.reached:
        return "indeterminate"
    if tally.undecided and tally.done >= tally.wanted:
        return "indeterminate"
    return "failure"


def _optional(goal: Goal, tally: CaptureCount, ended: Ended | None) -> OutcomeName:
    if tally.failed or tally.given_up:
        return "failure"
    cut = ended is None or ended.status == "aborted"
    if tally.open:
        unknown = cut or (tally.undecided and ended is not None and ended.status != "faulted")
        return "indeterminate" if unknown else "failure"
    if tally.done < tally.wanted:
        return "indeterminate" if cut or tally.done + tally.in_doubt >= tally.wanted else "failure"
    if tally.done or tally.skipped or tally.stopped or tally.spared:
        return "success"
    return "indeterminate" if goal.conditional or cut else "failure"


def _why(
    goal: Goal, tally: CaptureCount, verdict: OutcomeName, ended: Ended | None, because: str, *, under_way: bool
) -> str:
    """Return the outcome in words: the captures, then what prevented more.

    ``because`` is the reason in brackets of what was given up or left out, or empty.
    """
    parts = [_counted(goal, tally)]
    if tally.done == 0 and tally.wanted == 0 and verdict == "success":
        return _not_called_for(tally, because)
    if tally.in_doubt:
        parts.append(message("{count} in doubt (the power was cut during the capture)", count=tally.in_doubt))
    if tally.failed:
        parts.append(counted("failed for good {count} time", "failed for good {count} times", tally.failed))
    if tally.given_up:
        given_up = counted("{count} place given up", "{count} places given up", tally.given_up)
        parts.append(joined("", (given_up, because)))
    if tally.left_out:
        left_out = counted("{count} place left out", "{count} places left out", tally.left_out)
        parts.append(joined("", (left_out, because)))
    if tally.spared:
        spared = counted("left out {count} time", "left out {count} times", tally.spared)
        parts.append(joined("", (spared, because)))
    if verdict == "success" or under_way:
        return joined("; ", parts)
    if ended is None:
        parts.append(message("the log ends before the mission does"))
    elif not tally.reached and not tally.given_up:
        parts.append(message("never reached: the mission ended before ({why})", why=_say_end(ended)))
    elif tally.open and not tally.given_up and not tally.failed:
        parts.append(message("interrupted ({why})", why=_say_end(ended)))
    if tally.undecided and verdict == "indeterminate":
        parts.append(message("it was never tested whether more was needed"))
    return joined("; ", parts)


def _counted(goal: Goal, tally: CaptureCount) -> str:
    if tally.stretches:
        return _stretches(goal, tally)
    if goal.optional or tally.open:
        return say_captures(goal.action, tally.done)
    if tally.done > tally.wanted:
        return message(
            "{captures}, {count} requested", captures=say_captures(goal.action, tally.done), count=tally.wanted
        )
    return message("{count} of {captures}", count=tally.done, captures=say_captures(goal.action, tally.wanted))


def _stretches(goal: Goal, tally: CaptureCount) -> str:
    """Return how many stretches were worked whole, and how many metres in all."""
    metres = message("{metres} m worked", metres=f"{tally.worked_m:.0f}")
    if goal.optional or tally.open:
        return joined(", ", (counted("{count} stretch", "{count} stretches", tally.done), metres))
    of = counted("{done} of {count} stretch", "{done} of {count} stretches", tally.wanted, done=tally.done)
    return joined(", ", (of, metres))


def _not_called_for(tally: CaptureCount, because: str) -> str:
    if tally.spared:
        return joined(
            ": ",
            (
                joined("", (message("left out", context="goal"), because)),
                message("it was optional, to be done only if the budget allowed"),
            ),
        )
    if tally.skipped:
        reasons = list(dict.fromkeys(reason for reason in tally.skipped if reason))
        if not reasons:
            return message("not needed")
        why = kept_in_log(reasons[0])
        if len(reasons) > 2:
            return message("not needed: {why}, and {count} more times", why=why, count=len(reasons) - 1)
        if len(reasons) == 2:
            return message("not needed: {why} and once more", why=why)
        return message("not needed: {why}", why=why)
    if tally.stopped:
        return message("not needed: the plan ended before it, as planned")
    return message("not needed")


def _because(tally: CaptureCount) -> str:
    """Return the last recorded reason in brackets; empty if there is none."""
    reasons = [reason for reason in tally.reasons if reason]
    if not reasons:
        return ""
    return joined("", (" (", shaped(kept_in_log(" ".join(reasons[-1].split())), _shortened), ")"))


def _shortened(reason: str) -> str:
    return textwrap.shorten(reason, _LONGEST_REASON, placeholder=" …")


def _say_end(ended: Ended) -> str:
    status = say_status(ended.status)
    return joined(": ", (status, kept_in_log(ended.reason))) if ended.reason else status
