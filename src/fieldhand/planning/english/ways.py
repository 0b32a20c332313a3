"""Which way the rows of a phrase run, and from which sides they and their trees can be counted."""

from __future__ import annotations

from fieldhand.errors import PlaceError, TaskError
from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.english.bag import Bag
from fieldhand.site.model import Site
from fieldhand.site.planting import Block
from fieldhand.terms import CountedFrom

_UP_DOWN, _ACROSS = ("north", "south"), ("west", "east")


def trees_named(selector: s.Selector, site: Site) -> set[str]:
    """The ids of what a phrase names; empty where only the robot can tell, or there is nothing."""
    if selector.relative:
        return set()
    try:
        return {place.id for place in resolve(selector, site, Context(here=site.start))}
    except (PlaceError, TaskError):
        return set()


def blocks_named(selector: s.Selector, site: Site) -> tuple[Block, ...]:
    """The blocks in which the trees of a phrase stand; all of them where that cannot be told yet."""
    planting = site.planting
    index = [site.by_id[name].index for name in trees_named(selector, site) if name in site.by_id]
    found = {planting.rows[k].block for k in planting.row_of[index].tolist() if k >= 0}
    return tuple(planting.blocks[k] for k in sorted(found)) or planting.blocks


def side_across(bag: Bag, side: CountedFrom, of: s.Selector, site: Site) -> CountedFrom:
    """A side that rows can be counted from: one that lies across them, in one of the phrase's blocks at least.

    Where it fits some of several blocks only, the selection itself says which it does not fit.

    Raises:
        Unclear: It lies along the rows of all of them.
    """
    blocks = blocks_named(of, site)
    if side == "usual" or any(side in (_UP_DOWN if block.runs_east_west else _ACROSS) for block in blocks):
        return side
    runs, ends = _said(blocks, message("north or south"), message("west or east"))
    raise bag.fault(
        message("the rows {runs}: they are not counted from the {side}", runs=runs, side=COMPASS.get(side, side)),
        message("count from {ends}", ends=ends),
    )


def side_along(bag: Bag, side: CountedFrom, of: s.Selector, site: Site) -> CountedFrom:
    """A side that trees along a row can be counted from, in one of the phrase's blocks at least.

    Raises:
        Unclear: It lies across the rows of all of them.
    """
    blocks = blocks_named(of, site)
    if side == "usual" or any(side in (_ACROSS if block.runs_east_west else _UP_DOWN) for block in blocks):
        return side
    runs, ends = _said(blocks, message("west or east"), message("north or south"))
    raise bag.fault(
        message("the rows {runs}: they have no end in the {side}", runs=runs, side=COMPASS.get(side, side)),
        message("say {ends}", ends=ends),
    )


def check_over(bag: Bag, side: str, origin: s.Selector, site: Site, what: str) -> None:
    """A step from row to row goes across the rows of the tree that it starts from.

    Args:
        what: What is not there, if it does not ("no row lies further north").

    Raises:
        Unclear: It would go along them.
    """
    blocks = blocks_named(origin, site)
    if not any(side in (_UP_DOWN if block.runs_east_west else _ACROSS) for block in blocks):
        runs, _ = _said(blocks, "", "")
        raise bag.fault(message("the rows {runs}: {what}", runs=runs, what=what), message("say a side across the rows"))


def _said(blocks: tuple[Block, ...], east_west: str, north_south: str) -> tuple[str, str]:
    """How rows run that all run one way, and what is to be said of them."""
    return (
        (message("run east-west"), east_west) if blocks[0].runs_east_west else (message("run north-south"), north_south)
    )
