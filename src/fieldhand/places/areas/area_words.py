"""Wording of halves, quarters and edges, and the compass sides that corners share."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import CORNERS, SIDES, say_zone
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldhand.places.selector import Selector
    from fieldhand.places.wording import SelectorWording
    from fieldhand.terms import AreaPart, CornerName, Side

_SIDES: tuple[Side, ...] = ("north", "east", "south", "west")


def of_reference(of: Selector, wording: SelectorWording) -> str:
    """Return the reference group of a half or edge in words ("of block B"); empty for the whole site."""
    reference = of.reference()
    return "" if reference == Trees() else message("of {trees}", trees=wording.phrase(reference).group())


def in_area(of: Selector, area: str, wording: SelectorWording) -> NounPhrase:
    """Return the phrase for the trees of a group in a region, independent of the nesting with other filters."""
    if of.reference() == of:
        return NounPhrase(after=(area,))
    return wording.phrase(of).keeping(after=area)


def say_area(zone: str, part: AreaPart) -> str:
    """Return ground in words: a zone, the site without one, or a half or a quarter of either."""
    whole = say_zone(zone) if zone else message("the site")
    if part in SIDES:
        return message("the {northern} half of {zone}", northern=SIDES[part], zone=whole)
    if part in CORNERS:
        return message("the {north_west} quarter of {zone}", north_west=CORNERS[part], zone=whole)
    return whole


def sides_of_part(part: AreaPart) -> tuple[Side, ...]:
    """Return the sides of a half or a quarter: north and west for "nw"."""
    return tuple(side for side in _SIDES if side == part or (part in CORNERS and side[0] in part))


def sides_of_corners(corners: Sequence[CornerName]) -> tuple[Side, ...]:
    """Return the sides common to all corners: north for "nw" and "ne"."""
    return tuple(side for side in _SIDES if corners and all(side[0] in corner for corner in corners))
