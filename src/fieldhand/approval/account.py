"""Warnings about words of the request that have no counterpart in the plan."""

from __future__ import annotations

from fieldhand.approval.problem import PlanProblem
from fieldhand.language import joined, message
from fieldhand.task.frames import Task
from fieldhand.task.request_coverage import has_ranges, request_pieces

#: Maximum number of phrases quoted in one warning.
_MOST_QUOTED = 8


def unaccounted(task: Task) -> tuple[PlanProblem, ...]:
    """Return a warning that quotes the unused words of the request, or an empty tuple if every word was used."""
    lost = [piece.text.strip() for piece in request_pieces(task) if piece.role == "nothing"]
    if not lost:
        return ()
    if not has_ranges(task):
        return (
            PlanProblem(
                where=message("request"),
                what=message("the Task does not record which words of the request became which part of the plan"),
                advice=message("compare the plan with every word of the request"),
                severity="warning",
            ),
        )
    shown = joined(", ", (message("'{words}'", words=text) for text in lost[:_MOST_QUOTED]))
    if len(lost) > _MOST_QUOTED:
        shown = message("{places} and {count} more", places=shown, count=len(lost) - _MOST_QUOTED)
    return (
        PlanProblem(
            where=message("request"),
            what=message("nothing in the plan corresponds to {words}", words=shown),
            advice=message("say it in other words, or approve only if the plan is right without it"),
            severity="warning",
        ),
    )
