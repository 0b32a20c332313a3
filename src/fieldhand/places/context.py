"""The mission state that a selector may depend on."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field

from fieldhand.places.reading_series import SeriesByName
from fieldhand.site.model import Place


class VisitedIds(Collection[str]):
    """An immutable ordered set of ids. An extended copy shares its storage with the original.

    The state of every step of a long walk contains one.

    Args:
        ids: Ids, each once.
    """

    def __init__(self, ids: Collection[str] = ()) -> None:
        #: Position of each id; positions beyond the count belong to extended copies.
        self._at = {name: k for k, name in enumerate(ids)}
        self._count = len(self._at)

    def plus(self, name: str) -> VisitedIds:
        """Return the ids with one more, unless it is among them."""
        if name in self:
            return self
        longer = VisitedIds()
        longer._at = self._at if len(self._at) == self._count else {one: k for k, one in enumerate(self)}
        longer._at[name] = self._count
        longer._count = self._count + 1
        return longer

    def __contains__(self, name: object) -> bool:
        return self._at.get(name, self._count) < self._count  # type: ignore[call-overload, no-any-return]

    def __iter__(self) -> Iterator[str]:
        return itertools.islice(self._at, self._count)

    def __len__(self) -> int:
        return self._count

    def __eq__(self, other: object) -> bool:
        return isinstance(other, VisitedIds | tuple) and tuple(self) == tuple(other)

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __repr__(self) -> str:
        return repr(tuple(self))


@dataclass(frozen=True, kw_only=True)
class Context:
    """The mission state that selectors depend on: current place, visited trees and labels.

    Attributes:
        here: Current place; the start before the first drive.
        visited: Ids of the visited trees in order, each once.
        bound: Places by label.
        series: Readings taken so far, by their name, of those that the plan uses as a series.
    """

    here: Place
    visited: Collection[str] = ()
    bound: Mapping[str, tuple[Place, ...]] = field(default_factory=dict)
    series: SeriesByName = field(default_factory=dict)
