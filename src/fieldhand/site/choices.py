"""Number the places of several alternative sets, so that a picture can show each place once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fieldhand.site.model import Place

#: A set of up to this many places has its number at each of them, a larger one only at its middle place.
_MOST_LABELLED = 12


@dataclass(frozen=True, kw_only=True)
class ChoiceMark:
    """A place that belongs to one or more choices.

    Attributes:
        numbers: Numbers of the choices that contain it, from 1, the choice with the fewest places first.
        labelled: True if its numbers are written at the place.
    """

    place: Place
    numbers: tuple[int, ...]
    labelled: bool


def choice_marks(choices: Sequence[Sequence[Place]]) -> tuple[ChoiceMark, ...]:
    """Return a mark for each place, those of the largest choice first, so that smaller choices are drawn on top."""
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
    """Return the places at which the number of a choice is written.

    In a large choice that is one place, if possible one that no smaller choice contains.
    """
    keys: list[tuple[str, str]] = [(p.kind, p.id) for p in choice]
    if len(choice) <= _MOST_LABELLED:
        return keys
    fewest = min(len(numbers[key]) for key in keys)
    own = [p for p, key in zip(choice, keys, strict=True) if len(numbers[key]) == fewest]
    xy = np.array([p.xy for p in own])
    middle = own[int(np.argmin(((xy - xy.mean(axis=0)) ** 2).sum(axis=1)))]
    return [(middle.kind, middle.id)]
