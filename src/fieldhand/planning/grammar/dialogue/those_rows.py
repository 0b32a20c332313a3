"""Rows that were named before: "these rows", "the same rows"."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.faults import NotComposed
from fieldhand.planning.grammar.dialogue.state import DialogueState
from fieldhand.planning.grammar.meaning import THOSE_ROWS
from fieldhand.planning.selections import are_rows, as_rows, parts
from fieldhand.task import plan as p

T = TypeVar("T")


def with_those_rows(state: DialogueState, command: T) -> T:
    """Return a command with the rows that it calls "these rows".

    Raises:
        NotComposed: No rows were named before it.
    """

    def known(value: Any) -> s.Selector | None:
        rows = as_rows(value)
        if rows is None or rows.first != THOSE_ROWS.first:
            return None
        named = _rows_spoken_of(state)
        if named is None or rows.of not in (s.Trees(), *named.walk()):
            raise NotComposed(
                message("it is not clear which rows are meant", context="fault"),
                advice=message("say their numbers"),
            )
        return named

    changed: T = with_known(command, known)
    return changed


def with_known(value: Any, known: Callable[[Any], s.Selector | None]) -> Any:
    """Return a command with what it refers to; ``known`` returns that for a part that refers, None for others."""
    if (found := known(value)) is not None:
        return found
    if isinstance(value, tuple):
        return tuple(with_known(item, known) for item in value)
    if not is_dataclass(value) or isinstance(value, type):
        return value
    inner = {field.name: getattr(value, field.name) for field in fields(value) if field.init}
    changed = {name: new for name, old in inner.items() if (new := with_known(old, known)) != old}
    return replace(value, **changed) if changed else value


def _rows_spoken_of(state: DialogueState) -> s.Selector | None:
    """Return the rows that were named last; None if there were none, or only all of the site."""
    for place in (state.lead, state.area):
        if place is not None and (found := tuple(dict.fromkeys(_rows_in(place.place.selector)))):
            return _joined(found)
    for node in reversed(list(p.walk(state.plan))):
        if node.selector is not None and (found := tuple(dict.fromkeys(_rows_in(node.selector)))):
            return _joined(found)
    return None


def _joined(rows: tuple[s.Selector, ...]) -> s.Selector:
    return rows[0] if len(rows) == 1 else s.UnionOf(parts=rows)


def _rows_in(selector: s.Selector) -> Iterator[s.Selector]:
    """Yield the outermost rows in a selector."""
    if are_rows(selector) and not selector.relative:
        if as_rows(selector) != s.Rows():
            yield selector
        return
    for part in parts(selector):
        yield from _rows_in(part)
