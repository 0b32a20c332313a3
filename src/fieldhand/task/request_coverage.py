"""Classify each word of the request by the part of the plan that it became, for any planner.

The classification rests only on the character ranges that the Task carries. A word outside every range counts as
missing, unless it is a function word that asks for nothing by itself. A planner may mark words as having no part in the
plan; a word with content (:mod:`fieldhand.task.filler_words`) that occurs nowhere else in the plan's words counts as
missing all the same.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from typing import Literal, get_args

from fieldhand.language import language_of_request, message
from fieldhand.task.filler_words import is_filler, is_function_word
from fieldhand.task.frames import Task
from fieldhand.task.plan import Span, acts, walk, works

#: Roles of words. Where two ranges coincide, the role listed first is shown.
WordRole = Literal["condition", "limit", "time", "end", "action", "place", "order", "no_part", "nothing", "between"]
ROLES: tuple[WordRole, ...] = get_args(WordRole)

#: Display name of each role; ``between`` has none, since it is not shown.
ROLE_NAMES: dict[WordRole, str] = {
    "action": message("action", context="role"),
    "place": message("place", context="role"),
    "condition": message("condition", context="role"),
    "limit": message("limit", context="role"),
    "order": message("order", context="role"),
    "end": message("end", context="role"),
    "time": message("time", context="role"),
    "no_part": message("no part in the plan", context="role"),
    "nothing": message("not in the plan", context="role"),
}
_WORD = re.compile(r"\w+(?:['\u2019.,\-]\w+)*\s?[%\u00b0]?")


@dataclass(frozen=True, kw_only=True)
class Piece:
    """A stretch of the request whose words have one role.

    Attributes:
        role: ``condition``, ``limit``, ``time``, ``end``, ``action``, ``place``, ``order`` (also numbers); ``no_part``
            for words that the planner marked as having no part in the plan; ``nothing`` for words missing from the
            plan; ``between`` for words and punctuation between the others.
        nodes: Plan nodes that these words name, with the nodes that they contain; empty for words of the whole plan.
    """

    text: str
    role: WordRole
    nodes: tuple[str, ...] = ()


def request_pieces(task: Task) -> tuple[Piece, ...]:
    """Return the request as pieces in order; concatenated, they give the request."""
    request = task.command.request
    roles: list[WordRole] = ["between"] * len(request)
    for start, end, role in _words(task):
        roles[start:end] = [role] * (end - start)
    _join_gaps(roles, request)
    pieces: list[Piece] = []
    at = 0
    for role, run in groupby(roles):
        length = len(list(run))
        nodes = () if role == "between" else _nodes_at(task, at, at + length)
        pieces.append(Piece(text=request[at : at + length], role=role, nodes=nodes))
        at += length
    return tuple(pieces)


def _nodes_at(task: Task, start: int, end: int) -> tuple[str, ...]:
    """Return the plan nodes whose own words are in a range of the request, with the nodes that they contain."""
    found: dict[str, None] = {}
    for node in walk(task.composition.plan):
        own = (*node.said, *node.at_said)
        if any(first < end and start < last for first, last in own):
            found.update(dict.fromkeys(inner.id for inner in walk(node)))
    return tuple(found)


def has_ranges(task: Task) -> bool:
    """Return True if the Task carries any range of the request."""
    return any(True for _ in _ranges(task))


def _words(task: Task) -> Iterator[tuple[int, int, WordRole]]:
    """Yield start, end and role of every word with content; the shortest range around a word decides its role."""
    ranges = sorted(_ranges(task), key=lambda found: (found[0][1] - found[0][0], ROLES.index(found[1])))
    found: list[tuple[str, int, int, WordRole]] = []
    language = language_of_request(task.command.request)
    for word in _WORD.finditer(task.command.request):
        start, end = word.start(), word.start() + len(word.group().rstrip())
        text = word.group().strip().lower()
        if not is_function_word(text, language):
            holding = (role for (first, last), role in ranges if first <= start and end <= last)
            found.append((text, start, end, next(holding, "nothing")))
    spoken = {_stem(text) for text, _, _, role in found if role not in ("no_part", "nothing") and text.isalpha()}
    spoken |= {_stem(r.name.lower()) for r in task.resources if r.kind == "robot"}
    plan = task.composition.plan
    actions = [*(act.action for act in acts(plan)), *(work.action for work in works(plan))]
    spoken |= {_stem(word) for action in actions for word in action.split("_")}
    for text, start, end, role in found:
        dropped = role == "no_part" and not is_filler(text, language) and _stem(text) not in spoken
        yield start, end, "nothing" if dropped else role


def _stem(word: str) -> str:
    """Return a noun without its plural, so that "corners" and "corner" are the same."""
    return word.removesuffix("s")


def _ranges(task: Task) -> Iterator[tuple[Span, WordRole]]:
    """Yield every range of a Task with its role."""
    for node in walk(task.composition.plan):
        yield from ((span, node.role) for span in node.said)
        yield from ((span, "place") for span in node.at_said)
    for budget in task.constraints.budgets:
        yield from ((span, "limit") for span in budget.said)
    yield from ((span, "limit") for span in task.constraints.reserve_said)
    for avoid in task.constraints.avoid:
        yield from ((span, "limit") for span in avoid.said)
    for only in task.constraints.only_gates:
        yield from ((span, "limit") for span in only.said)
    for slow in task.constraints.slow:
        yield from ((span, "limit") for span in slow.said)
    for watch in task.composition.watches:
        yield from ((span, "condition") for span in watch.said)
    yield from ((span, "limit") for span in (*task.constraints.reserve_said, *task.constraints.energy_said))
    yield from ((span, "end") for span in task.composition.nominal_said)
    if task.timing is not None:
        yield from ((span, "time") for span in task.timing.said)
    yield from ((span, "no_part") for span in task.command.no_part)


def _join_gaps(roles: list[WordRole], request: str) -> None:
    """Assign text between two words of one role to that role, unless punctuation parts them; changes ``roles``.

    A stroke does not ("l/ha").
    """
    at = 0
    for role, run in groupby(list(roles)):
        start, at = at, at + len(list(run))
        parted = re.search(r"[^\w\s/]", request[start:at])
        if role == "between" and not parted and start > 0 and at < len(roles) and roles[start - 1] == roles[at]:
            roles[start:at] = [roles[at]] * (at - start)
