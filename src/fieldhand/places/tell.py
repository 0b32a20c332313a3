"""What a part of a selector says about how it was resolved: the rule, the candidates, and what was close."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fieldhand.language import counted, joined, message
from fieldhand.language.words import listed
from fieldhand.places.spots import Spots

_FEW = 4


@dataclass(kw_only=True)
class Tell:
    """Notes taken while one part resolves.

    Attributes:
        rule: The rule that was applied, a short clause; empty where the words of the part say it all.
        candidates: How many it chose from; None for a source.
        runners_up: Those that would have come next.
        notes: What a person may not expect, a clause each: ties, ends of rows, stand-ins.
    """

    rule: str = ""
    candidates: int | None = None
    runners_up: tuple[str, ...] = ()
    notes: list[str] = field(default_factory=list)

    def note(self, text: str) -> None:
        """Say something that a person may not expect."""
        self.notes.append(text)


def rank(candidates: Spots, key: NDArray[np.float64], count: int, tell: Tell, what: str) -> Spots:
    """The ``count`` with the smallest key, smallest first; says what tied with the last of them and what came next.

    Args:
        candidates: What to choose from.
        key: Of each, in metres or in the unit of an attribute.
        count: How many.
        tell: Told about ties and runners-up.
        what: What the first of them are: "the northernmost".
    """
    longer = candidates.ranked(np.asarray(key), count + _FEW)
    found = longer.keep(slice(count))
    tell.runners_up = tuple(p.id for p in longer.keep(slice(count, None)).places)
    rounded = np.round(key, 4)
    worst = np.partition(rounded, count - 1)[count - 1]
    tied = np.flatnonzero(rounded == worst)
    before = int((rounded < worst).sum())
    if before + len(tied) > count:
        taken = found.keep(slice(before, None))
        ids, taken_ids = ids_of(candidates.keep(tied[: _FEW + 1]), len(tied)), ids_of(taken, len(taken))
        first = counted("{ids} comes first in the file", "{ids} come first in the file", len(taken), ids=taken_ids)
        tied_for: dict[str, str] = {"northernmost": what, "ids": ids, "first": first}
        if candidates.is_tree.all():
            tell.note(message("{count} trees tie for {northernmost}: {ids}; {first}", count=len(tied), **tied_for))
        else:
            tell.note(message("{count} places tie for {northernmost}: {ids}; {first}", count=len(tied), **tied_for))
    return found


def ids_of(spots: Spots, there_are: int | None = None) -> str:
    """The ids of a few places, and how many more there are."""
    total = len(spots) if there_are is None else there_are
    shown = [p.id for p in spots.keep(slice(_FEW if total > _FEW else total)).places]
    if total > len(shown):
        return message("{places} and {count} more", places=joined(", ", shown), count=total - len(shown))
    return listed(shown)


def tell_passed_over(count: int, tell: Tell) -> None:
    """Say how many stand where no robot may drive."""
    tell.note(
        counted(
            "{count} of them stands in a keep-out: passed over",
            "{count} of them stand in a keep-out: passed over",
            count,
        )
    )
