"""Several sets of places to choose from, each place once, with the choices that it belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fieldhand.site.model import Place

#: A set of so many places has its number at each of them, a larger one at the place in its middle.
_MOST_LABELLED = 12


@dataclass(frozen=True, kw_only=True)
class ChoiceMark:
    """A place among those to choose from.

    Attributes:
        numbers: The choices that hold it, counted from 1, the one with the fewest places first.
        labelled: Its numbers are to be written there.
    """

    place: Place
    numbers: tuple[int, ...]
    labelled: bool


def choice_marks(choices: Sequence[Sequence[Place]]) -> tuple[ChoiceMark, ...]:
    """A mark for each place of some choices, those of the largest set first, so that a smaller one is drawn on top."""
    by_size = sorted(range(len(choices)), key=lambda k: (len(choices[k]), k))
    places: dict[tuple[str, str], Place] = {}
    numbers: dict[tuple[str, str], tuple[int, ...]] = {}
    for k in by_size:
        for key, place in {(p.kind, p.id): p for p in choices[k]}.items():
            places[key] = place
            numbers[key] = (*numbers.get(key, ()), k + 1)
    labelled = {key for choice in choices for key in _labelled(choice, numbers)}
    marks = [ChoiceMark(place=p, numbers=numbers[key], labelled=key in labelled) for key, p in places.items()]
    return tuple(sorted(marks, key=lambda mark: -by_size.index(mark.numbers[0] - 1)))


def _labelled(choice: Sequence[Place], numbers: dict[tuple[str, str], tuple[int, ...]]) -> list[tuple[str, str]]:
    """Where the number of a choice is written: in a large set at one place that no smaller set has, if there is one."""
    keys: list[tuple[str, str]] = [(p.kind, p.id) for p in choice]
    if len(choice) <= _MOST_LABELLED:
        return keys
    fewest = min(len(numbers[key]) for key in keys)
    own = [p for p, key in zip(choice, keys, strict=True) if len(numbers[key]) == fewest]
    xy = np.array([p.xy for p in own])
    middle = own[int(np.argmin(((xy - xy.mean(axis=0)) ** 2).sum(axis=1)))]
    return [(middle.kind, middle.id)]
