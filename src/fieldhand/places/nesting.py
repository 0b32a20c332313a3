"""Of which group a region is one, however the parts of a selector nest (:mod:`fieldhand.places` says why)."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places.selectors import (
    AmongExtreme,
    Edge,
    EveryNth,
    Excluding,
    Half,
    InBlock,
    InRow,
    InZone,
    Ordered,
    Other,
    Quarter,
    Random,
    RowOf,
    Rows,
    Selector,
    Spread,
    Successive,
    Take,
    Top,
    Union,
    Where,
    Within,
)


def bare_ground(selector: Selector, *, picks_too: bool = True) -> Selector:
    """The selector without the parts that leave the geometry as it is.

    Args:
        selector: Any.
        picks_too: Also without what picks trees by an attribute or by their row; else only without what depends on the
            mission so far.
    """
    match selector:
        case Other() | Excluding() | Take() | Random() | Spread() | Ordered():
            return bare_ground(selector.of, picks_too=picks_too)
        case Where() | Top() | Rows() | RowOf() | InRow() | EveryNth() | Successive() if picks_too:
            return bare_ground(selector.of, picks_too=picks_too)
        case Where() | Rows() | RowOf() | InRow() | EveryNth():
            return replace(selector, of=bare_ground(selector.of, picks_too=picks_too))
        case Half() | Quarter() | Edge() | AmongExtreme() | InZone() | InBlock() | Within():
            return replace(selector, of=bare_ground(selector.of, picks_too=picks_too))
        case Union(parts=parts):
            return Union(parts=tuple(bare_ground(p, picks_too=picks_too) for p in parts))
        case _:
            return selector
