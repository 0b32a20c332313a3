"""A warning where words of the request became nothing: a person has to confirm that they may be left out."""

from __future__ import annotations

from fieldhand.approval.problem import Problem
from fieldhand.task.account import account, has_ranges
from fieldhand.task.frames import Task

#: So many stretches of words are quoted in one warning.
_MOST_QUOTED = 8


def unaccounted(task: Task) -> tuple[Problem, ...]:
    """A warning that names the words of the request that became nothing; none if there are none."""
    lost = [piece.text.strip() for piece in account(task) if piece.role == "nothing"]
    if not lost:
        return ()
    if not has_ranges(task):
        return (
            Problem(
                where="request",
                what="the Task does not say which of its words became what",
                advice="compare the plan with every word of the request",
                severity="warning",
            ),
        )
    shown = ", ".join(f"'{text}'" for text in lost[:_MOST_QUOTED])
    more = f" and {len(lost) - _MOST_QUOTED} more" if len(lost) > _MOST_QUOTED else ""
    return (
        Problem(
            where="request",
            what=f"nothing in the plan comes from {shown}{more}",
            advice="say it in other words, or approve only if the plan is right without it",
            severity="warning",
        ),
    )
