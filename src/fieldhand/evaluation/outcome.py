"""What came of each goal, from the event log alone: success, failure, or indeterminate (IEEE 1872.1, results frame).

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

from fieldhand.evaluation.replay import replay
from fieldhand.evaluation.tally import Tally
from fieldhand.task.frames import Goal, Task
from fieldhand.task.results import Ended, Event, GoalOutcome
from fieldhand.task.words import say_captures, say_count

_LONGEST_REASON = 160

Verdict = Literal["success", "failure", "indeterminate"]


def judge(task: Task, events: Sequence[Event], *, under_way: bool = False) -> tuple[GoalOutcome, ...]:
    """The outcome of each goal of a Task, in the order of its goals.

    Args:
        task: What was carried out.
        events: The event log, from its beginning; it may stop anywhere.
        under_way: More is to come: nothing is said of what the log does not tell yet.
    """
    tallies = replay(task.composition.plan, events)
    ended = next((e for e in reversed(events) if isinstance(e, Ended)), None)
    return tuple(
        _outcome(goal, tallies.get(goal.node, Tally(open=True)), ended, under_way=under_way)
        for goal in task.command.goals
    )


def _outcome(goal: Goal, tally: Tally, ended: Ended | None, *, under_way: bool) -> GoalOutcome:
    verdict = _optional(goal, tally, ended) if goal.optional else _mandatory(tally, ended)
    wanted = None if tally.open else tally.wanted
    why = _why(goal, tally, verdict, ended, under_way=under_way)
    return GoalOutcome(goal=goal.id, outcome=verdict, done=tally.done, wanted=wanted, why=why)


def _mandatory(tally: Tally, ended: Ended | None) -> Verdict:
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


def _optional(goal: Goal, tally: Tally, ended: Ended | None) -> Verdict:
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


def _why(goal: Goal, tally: Tally, verdict: Verdict, ended: Ended | None, *, under_way: bool) -> str:
    """The outcome in words: what there is, then what kept it from being more."""
    parts = [_counted(goal, tally)]
    if tally.done == 0 and tally.wanted == 0 and verdict == "success":
        return _not_called_for(tally)
    if tally.in_doubt:
        parts.append(f"{tally.in_doubt} in doubt (the power was cut while it was made)")
    if tally.failed:
        parts.append(f"failed for good {say_count(tally.failed, 'time')}")
    if tally.given_up:
        parts.append(f"{say_count(tally.given_up, 'place')} given up{_because(tally)}")
    if tally.left_out:
        parts.append(f"{say_count(tally.left_out, 'place')} left out{_because(tally)}")
    if tally.spared:
        parts.append(f"left out {say_count(tally.spared, 'time')}{_because(tally)}")
    if verdict == "success" or under_way:
        return "; ".join(parts)
    if ended is None:
        parts.append("the log ends before the mission does")
    elif not tally.reached and not tally.given_up:
        parts.append(f"never reached, the mission was over before ({_said(ended)})")
    elif tally.open and not tally.given_up and not tally.failed:
        parts.append(f"cut off ({_said(ended)})")
    if tally.undecided and verdict == "indeterminate":
        parts.append("whether more was called for was never tested")
    return "; ".join(parts)


def _counted(goal: Goal, tally: Tally) -> str:
    if goal.optional or tally.open:
        return say_captures(goal.action, tally.done)
    if tally.done > tally.wanted:
        return f"{say_captures(goal.action, tally.done)}, {tally.wanted} wanted"
    return f"{tally.done} of {say_captures(goal.action, tally.wanted)}"


def _not_called_for(tally: Tally) -> str:
    if tally.spared:
        return f"left out{_because(tally)}: it was to be done only if the budget allowed"
    if tally.skipped:
        reasons = list(dict.fromkeys(reason for reason in tally.skipped if reason))
        more = f", and {len(reasons) - 1} more times" if len(reasons) > 2 else " and once more" * (len(reasons) == 2)
        return f"not called for: {reasons[0]}{more}" if reasons else "not called for"
    if tally.stopped:
        return "not called for: the plan ended before it, as it says"
    return "not called for"


def _because(tally: Tally) -> str:
    """The last reason: what was left out earlier was out of reach for the like of it."""
    reasons = [reason for reason in tally.reasons if reason]
    return because(reasons[-1]) if reasons else ""


def because(reason: str) -> str:
    """A reason as it stands in brackets behind what was left out: whoever says it elsewhere finds it by this."""
    return f" ({textwrap.shorten(' '.join(reason.split()), _LONGEST_REASON, placeholder=' …')})"


def _said(ended: Ended) -> str:
    return f"{ended.status}: {ended.reason}" if ended.reason else ended.status
