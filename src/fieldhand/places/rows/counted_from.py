"""The side from which rows or trees are counted, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.places.noun_phrase import NounPhrase, many

if TYPE_CHECKING:
    from fieldhand.terms import CountedFrom


def many_from(said: str, side: CountedFrom) -> NounPhrase:
    """Return trees with the side that they are counted from, where that is not the usual one."""
    if side == "usual":
        return many(said)
    return many(message("{trees}, counted from the {side}", trees=said, side=COMPASS[side]))
