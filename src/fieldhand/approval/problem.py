"""Problems that the checks report."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Literal

from fieldhand.language import joined, message, shaped
from fieldhand.places.wording import say_selector
from fieldhand.task import plan
from fieldhand.task.frames import Task

#: Maximum number of characters of the request quoted in a problem.
_MOST_QUOTED = 120


@dataclass(frozen=True, kw_only=True)
class PlanProblem:
    """An error of a Task, or a warning that its approver must confirm.

    Attributes:
        what: Description, without a full stop.
        node: Id of the plan node; empty if the problem concerns no single node.
        where: Line and element, zone, or site.
        words: Words of the request from which the node was derived.
        place: Description of the node's place.
        advice: Suggested remedy.
        severity: An ``error`` forbids approval; a ``warning`` forbids it until confirmed.
    """

    what: str
    node: str = ""
    where: str = ""
    words: str = ""
    place: str = ""
    advice: str = ""
    severity: Literal["error", "warning"] = "error"

    def __str__(self) -> str:
        """Return one line: node, words, place, location; description; advice."""
        return str(self.line())

    def line(self) -> str:
        """Return the same line as a translatable message."""
        node = () if self.node and self.node in self.where else (self.node,)
        words = (message("“{text}”", text=self.words),) if self.words else ()
        place = () if self.place and self.place in self.what else (self.place,)
        parts = [part for part in (*node, *words, *place, self.where) if part]
        at = (joined(", ", parts), ": ") if parts else ()
        todo = ("; ", self.advice) if self.advice else ()
        return shaped(joined("", (*at, self.what, *todo)), _one_line)


def _one_line(text: str) -> str:
    return " ".join(text.split())


def node_in(where: str) -> tuple[str, str]:
    """Split a leading node id from the location of an error; return the id (or "") and the rest."""
    found = re.fullmatch(r"(n\d+)(?:, (.*))?", where, re.DOTALL)
    return ("", where) if found is None else (found[1], found[2] or "")


def with_words(problem: PlanProblem, task: Task) -> PlanProblem:
    """Return the problem with the words of the request that its node came from, and the node's place."""
    node = next((n for n in plan.walk(task.composition.plan) if n.id == problem.node), None) if problem.node else None
    if node is None:
        return problem
    selector = node.selector
    return replace(
        problem,
        words=problem.words or _quoted(node, task),
        place=problem.place or ("" if selector is None else say_selector(selector)),
    )


def _quoted(node: plan.Node, task: Task) -> str:
    """Return the words in their order, with an ellipsis for omitted text."""
    text = task.command.read_as or task.command.request
    own = (*node.said, *node.at_said)
    spans = sorted({(start, end) for start, end in own if 0 <= start < end <= len(text)})
    pieces = [text[start:end] for start, end in spans]
    quote = " … ".join(" ".join(piece.split()) for piece in pieces)
    return quote if len(quote) <= _MOST_QUOTED else quote[: _MOST_QUOTED - 1] + "…"
