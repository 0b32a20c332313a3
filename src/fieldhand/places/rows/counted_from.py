"""Wording of the side from which rows or trees are counted."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.places.noun_phrase import NounPhrase, many

if TYPE_CHECKING:
    from fieldhand.terms import CountedFrom


def many_from(phrase: str, side: CountedFrom) -> NounPhrase:
    """Return the phrase for several trees, with the side that they are counted from unless it is the usual one."""
    if side == "usual":
        return many(phrase)
    return many(message("{trees}, counted from the {side}", trees=phrase, side=COMPASS[side]))
