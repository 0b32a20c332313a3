"""Whether what was read makes a mission: places with nothing to do, the same twice, an end before the end.

Each of these can be said in English, and each is far oftener a sentence that was read wrongly.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english import draft as d
from fieldhand.planning.english.faults import PLAINLY, Question, Unclear
from fieldhand.planning.planner import Reason
from fieldhand.planning.selections import may_be_near, names_here
from fieldhand.task.conditions import readings
from fieldhand.task.plan import Span

#: What is taken twice in a row is said to be.
_AGAIN = re.compile(
    r"\b(again|another|second|more|twice|times|repeat\w*|confirm\w*|double|further|additional|extra|other|both|third"
    r"|fourth|next)\b"
)
#: How words begin that only say of what.
_OF = re.compile(r"(?:of|in|from|at|on|along)?")
#: Where the robot sets out from is a place to be, with nothing to do there.
_BEGINS = re.compile(r"\b(from|start\w*|begin\w*|set\w* (?:off|out)|leav\w*|via)\b")


def check_sense(root: d.DraftBlock, request: str) -> None:
    """Refuse what nobody means.

    Raises:
        Question: A place is driven to, and nothing is done there.
        Unclear: The same is done twice and nothing says so, the place in hand is mixed with others, or the mission
            ends before it is over.
    """
    if _is_announced(root):
        what = message("is it explained by what follows, or is it a task of its own?")
        raise _unclear(_said(root.steps[0]), request, what, message("leave it out, or say at which trees"))
    captures = any(isinstance(step, d.DraftCapture) for step, _ in d.walk(root))
    for block in _blocks(root):
        for step, after in zip(block.steps, [*block.steps[1:], None], strict=False):
            if isinstance(step, d.Halt) and after is not None:
                raise _unclear(step.said, request, message("the mission would end there, before all is done"))
            idle = captures and _leads_nowhere(step) and _is_elsewhere(after)
            if idle and not _BEGINS.search(_text(_said(step), request).lower()):
                raise Question(
                    message("'{said}': what is to be done there?", context="question", said=_text(_said(step), request))
                )
            if _is_of_all(step, after) and _OF.fullmatch(_between(step, after, request)):
                what = message("as many of all trees, or of these?")
                raise _unclear(_said(after), request, what, message("say 'as many vines of row 3 as you can'"))
            if _is_mixed(step):
                raise _unclear(
                    _said(step), request, message("it is not clear which places are meant"), message("name them all")
                )
            if _is_far_for_nothing(step, after):
                raise _unclear(
                    _said(after),
                    request,
                    message("is that tree the one that is far away?"),
                    message("say 'at that tree'"),
                )
            if _is_tested_twice(step, after):
                raise _unclear(
                    _said(after),
                    request,
                    message("the same is tested twice"),
                    message("say which reading it refers to"),
                )
            if _is_twice(step, after) and not _says_again(step, after, request):
                raise _unclear(
                    _said(after),
                    request,
                    message("that has been asked for already"),
                    message("say 'again' if it is meant"),
                )


def _blocks(root: d.DraftBlock) -> Iterator[d.DraftBlock]:
    yield root
    for step, _ in d.walk(root):
        yield from d.blocks_of(step)


def _leads_nowhere(step: d.Step) -> bool:
    """Whether a step drives to a place, and does nothing there."""
    if isinstance(step, d.Go):
        return not step.place.named_marker and not may_be_near(step.place)
    return isinstance(step, d.Loop) and not step.body.steps


def _is_elsewhere(step: d.Step | None) -> bool:
    """Whether a step has a place of its own that does not depend on where the robot is."""
    if isinstance(step, d.Loop) and step.optional:
        return False
    place = step.place if isinstance(step, d.Go) else step.select if isinstance(step, d.Loop) else None
    place = step.at if isinstance(step, d.DraftCapture) else place
    return place is not None and not place.named_marker and not may_be_near(place)


def _is_of_all(step: d.Step, after: d.Step | None) -> bool:
    """Return True for as many as fit of all trees, followed by the same at a place ("... as you can | of row 3")."""
    if not isinstance(step, d.Loop) or not step.optional or step.select != s.Trees():
        return False
    taken = {inner.action for inner in step.body.steps if isinstance(inner, d.DraftCapture)}
    if isinstance(after, d.Loop):
        return any(isinstance(inner, d.DraftCapture) and inner.action in taken for inner in after.body.steps)
    return isinstance(after, d.DraftCapture) and after.action in taken


def _between(step: d.Step, after: d.Step | None, request: str) -> str:
    """Return what stands between the words of two steps."""
    end, begin = max(e for _, e in _said(step)), min((b for b, _ in _said(after)), default=0)
    return request[end:begin].strip().lower()


def _is_mixed(step: d.Step) -> bool:
    return isinstance(step, d.Loop) and names_here(step.select) and bool(step.body.steps)


def _is_far_for_nothing(step: d.Step, after: d.Step | None) -> bool:
    """ "Move as far away as possible for a picture of another tree": that tree is meant to be far away."""
    far = isinstance(step, d.Go) and isinstance(step.place, s.Farthest)
    at = after.at if isinstance(after, d.DraftCapture) else None
    return far and at is not None and isinstance(at.any_of, s.NotVisited)


def _is_tested_twice(step: d.Step, after: d.Step | None) -> bool:
    if not isinstance(step, d.Choice) or not isinstance(after, d.Choice):
        return False
    return step.condition == after.condition and bool(readings(step.condition))


def _is_announced(root: d.DraftBlock) -> bool:
    """ "Two trees get a picture": nothing says which trees, and what is said behind it takes pictures too."""
    first = root.steps[0] if root.steps else None
    if not isinstance(first, d.Loop) or first.select.any_of != s.Trees():
        return False
    taken = {step.action for step in first.body.steps if isinstance(step, d.DraftCapture)}
    later = [step for step, _ in d.walk(root) if isinstance(step, d.DraftCapture) and step not in first.body.steps]
    return bool(later) and any(step.action in taken for step in later)


def _is_twice(step: d.Step, after: d.Step | None) -> bool:
    if not isinstance(step, d.DraftCapture) or not isinstance(after, d.DraftCapture):
        return False
    return step.action == after.action and after.at is None and step.command != after.command


def _says_again(step: d.Step, after: d.Step | None, request: str) -> bool:
    begin = max((end for _, end in _said(step)), default=0)
    end = max((end for _, end in _said(after)), default=len(request))
    begin = min([begin, *(start for start, _ in _said(after))])
    return _AGAIN.search(request[begin:end].lower()) is not None


def _said(step: d.Step | None) -> tuple[Span, ...]:
    return () if step is None else step.said


def _text(said: tuple[Span, ...], request: str) -> str:
    return " ".join(request[start:end] for start, end in said)


def _unclear(said: tuple[Span, ...], request: str, what: str, advice: str = PLAINLY) -> Unclear:
    quoted = message("'{said}': {what}", said=_text(said, request), what=what)
    return Unclear(Reason(what=quoted, said=said, advice=advice, final=advice != PLAINLY))
