""" "Do the same": a passage of the plan, taken out, made ready for another place and put there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english import draft as d
from fieldhand.planning.english.faults import unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.onebyone import swapped
from fieldhand.planning.english.syntax import ClausePart
from fieldhand.planning.selections import as_some, names_here


def last_passage(steps: list[d.Step]) -> d.DraftBlock:
    """What was done at the last place: from the last step that goes somewhere."""
    start = next((k for k in range(len(steps) - 1, -1, -1) if has_place(steps[k])), 0)
    return d.DraftBlock(steps=steps[start:])


def as_many_as(steps: list[d.Step], found: FoundPlace) -> FoundPlace:
    """An area in which something is done again: at as many trees of it as there were of the area before."""
    if not (found.many and found.region) or found.each or found.counted:
        return found
    last = next((s_ for s_ in reversed(steps) if selects(s_) is not None), None)
    before = None if last is None else selects(last)
    if before is not None and names_here(before):
        # "Photograph it and the one beside it": the place was come to before.
        places = [at for step in reversed(steps) if (at := selects(step)) is not None]
        before = next((at for at in places if as_some(at) is not None), before)
    some = None if before is None else as_some(before)
    if some is None:
        return found
    fresh = s.NotVisited(of=found.selector)
    return replace(found, selector=replace(some, of=fresh), many=some.count > 1, counted=some.count)


def selects(step: d.Step) -> s.Selector | None:
    """The place or places that a step names."""
    match step:
        case d.Go(place=place):
            return place
        case d.Loop(select=select):
            return select
        case d.DraftCapture(at=at):
            return at
        case _:
            return None


#: Selectors that say where trees are: rows, and areas of the ground.
_OF_ROWS = (s.Rows, s.RowOf, s.InBlock)
_OF_GROUND = (s.Half, s.Quarter, s.Edge, s.InZone)


def passage_in_area(steps: list[d.Step], area: s.Selector) -> d.DraftBlock:
    """What was done last in one area of the same kind: from its first place on."""
    kind = next((kinds for kinds in (_OF_ROWS, _OF_GROUND) if isinstance(area, kinds)), ())
    begin, known = len(steps), None
    for k in range(len(steps) - 1, -1, -1):
        at = selects(steps[k])
        if at is None:
            continue
        inside = {part for part in at.walk() if isinstance(part, kind)}
        if len(inside) != 1 or (known is not None and inside != known):
            break
        begin, known = k, inside
    return d.DraftBlock(steps=steps[begin:])


def in_area(passage: d.DraftBlock, area: s.Selector) -> bool:
    """Say a passage of another area ("at the first and the last tree of row 6 ... the same in row 8"). Whether it was.

    The one area of the kind that its places are in gives way to the new one; ``passage`` is changed.
    """
    kind = next((kinds for kinds in (_OF_ROWS, _OF_GROUND) if isinstance(area, kinds)), None)
    if kind is None or getattr(area, "of", None) != s.Trees():
        return False
    held = [step for step, _ in d.walk(passage) if isinstance(step, d.Go | d.DraftCapture | d.Loop)]
    inside = {
        part for step in held if (at := selects(step)) is not None for part in at.walk() if isinstance(part, kind)
    }
    if len(inside) != 1 or getattr(old := next(iter(inside)), "of", None) != s.Trees():
        return False
    for step in held:
        match step:
            case d.Go(place=place):
                step.place = swapped(place, old, area)
            case d.Loop(select=select):
                step.select = swapped(select, old, area)
            case d.DraftCapture(at=at) if at is not None:
                step.at = swapped(at, old, area)
    return True


def without_place(passage: d.DraftBlock, part: ClausePart) -> None:
    """Make a copied passage begin at the new place instead of its own."""
    first = passage.steps[0]
    match first:
        case d.Go():
            passage.steps = passage.steps[1:]
            if not passage.steps:
                raise unclear(part.terms, message("there is nothing before it to repeat"))
        case d.DraftCapture():
            first.at = None
        case d.Loop(select=s.Adjacent() as select):
            first.select = replace(select, near=s.Here())
        case d.Loop(select=s.Nearest() as select):
            first.select = replace(select, to=s.Here())
        case d.Loop(select=select) if names_here(select):
            pass  # "it and the one beside it": of the new place now
        case d.Loop(body=body):
            passage.steps = [*body.steps, *passage.steps[1:]]
        case _:
            pass


def continue_with(passage: d.DraftBlock, scope: d.DraftBlock) -> None:
    """Append a copied passage; its first capture may have been asked for again at the new place."""
    first = passage.steps[0]
    last = scope.steps[-1] if scope.steps else None
    if isinstance(first, d.DraftCapture) and isinstance(last, d.DraftCapture) and last.action == first.action:
        if first.reading:
            last.reading = last.reading or first.reading
            for step, _ in d.walk(passage):
                if isinstance(step, d.Choice):
                    step.condition = d.rename(step.condition, {first.reading: last.reading})
        passage.steps = passage.steps[1:]
    append(passage, scope)


def append(passage: d.DraftBlock, scope: d.DraftBlock) -> None:
    """Put the steps of a passage behind those of a block."""
    for step in passage.steps:
        scope.add(step)


def copied(passage: d.DraftBlock, keep: Callable[[d.Step], bool], fresh: Callable[[], str]) -> d.DraftBlock:
    """A copy of a passage with readings of its own."""
    return d.copy_block(passage, keep, {}, fresh)


def has_place(step: d.Step) -> bool:
    """Whether a step goes somewhere."""
    match step:
        case d.Go() | d.Loop():
            return True
        case d.DraftCapture(at=at):
            return at is not None
        case d.Attempt(body=body):
            return bool(body.steps) and has_place(body.steps[0])
        case _:
            return False
