"""Hypothesis strategies for event logs, derived from the events' classes: a new field needs no edit."""

from __future__ import annotations

import dataclasses
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from hypothesis import strategies as st

from fieldhand.task.results import Event

_texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
_numbers = st.floats(allow_nan=False, allow_infinity=False)


def _of_hint(hint: Any) -> st.SearchStrategy[Any]:
    origin, inner = get_origin(hint), get_args(hint)
    plain = {str: _texts, float: _numbers, int: st.integers(-(2**31), 2**31), bool: st.booleans()}
    if hint in plain:
        return plain[hint]
    if origin is Literal:
        return st.sampled_from(inner)
    if origin in (Union, UnionType):
        return st.one_of(*(st.none() if one is NoneType else _of_hint(one) for one in inner))
    if dataclasses.is_dataclass(hint):
        kinds = get_type_hints(hint)
        return st.builds(hint, **{f.name: _of_hint(kinds[f.name]) for f in dataclasses.fields(hint)})  # type: ignore[arg-type]
    if origin is tuple and inner[-1] is ...:
        return st.lists(_of_hint(inner[0]), max_size=3).map(tuple)
    if origin is tuple:
        return st.tuples(*map(_of_hint, inner))
    return st.dictionaries(_texts, _of_hint(inner[1]), max_size=2)


def _event(cls: type[Event]) -> st.SearchStrategy[Event]:
    hints = get_type_hints(cls)
    fields = {f.name: _of_hint(hints[f.name]) for f in dataclasses.fields(cls)}
    return st.builds(cls, **(fields | {"t": st.floats(0, 1e6)}))


#: Logs of arbitrary events in arbitrary order.
events: st.SearchStrategy[tuple[Event, ...]] = st.lists(st.one_of(*map(_event, get_args(Event))), max_size=8).map(tuple)
