"""Rows that are named without their block, on a site of several blocks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from fieldhand.errors import PlaceError, TaskError
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.grammar.dialogue.plans import with_selector
from fieldhand.planning.grammar.meaning import WayRule
from fieldhand.planning.selections import as_excluding, blocks_of, is_in_block, over, rows_of, swapped
from fieldhand.site.counting import find_row, rows_from
from fieldhand.site.model import Site
from fieldhand.site.planting import Block
from fieldhand.task import plan as p

#: Rules of where the robot drives, each with the spans of the request that say it.
Ways = tuple[tuple[WayRule, tuple[p.Span, ...]], ...]


def in_each_block(plan: p.Node, site: Site) -> Mapping[str, p.Node]:
    """Return a plan for each block whose rows may be meant; only the plan itself if its rows are known by their names.

    All rows that are named without a block are of the same one.
    """
    blocks = site.planting.blocks
    if len(blocks) < 2:
        return {"": plan}
    named = [
        rows
        for node in p.walk(plan)
        if node.selector is not None
        for rows in rows_of(node.selector)
        if rows.first and not is_in_block(rows.of)
    ]
    if not named:
        return {"": plan}
    fitting = [block for block in blocks if all(_has(site, block, rows) for rows in named)]
    return {block.name: _of_block(plan, block) for block in fitting} if len(fitting) > 1 else {"": plan}


def exceptions_leave_out(plan: p.Node, site: Site) -> bool:
    """Return False if an exception of a plan leaves out nothing: "every Merlot vine except those in row 3"."""
    selectors = (node.selector for node in p.walk(plan) if node.selector is not None)
    parts = (as_excluding(part) for selector in selectors for part in selector.walk() if not part.relative)
    return all(_leaves_out_some(part.of, part.places, site) for part in parts if part is not None)


def _leaves_out_some(of: s.Selector, places: s.Selector, site: Site) -> bool:
    """Return True if some places of a selector are left out of another one."""
    here = Context(here=site.start)
    try:
        left_out = {place.id for place in resolve(places, site, here)}
        return any(place.id in left_out for place in resolve(of, site, here))
    except (PlaceError, TaskError):
        return False


def rules_in_each_block(ways: Ways, plan: p.Node, site: Site) -> Sequence[Ways]:
    """Return rules of where to drive for each block whose rows may be meant.

    Rows without a block are those of the only block that the plan names, if it has them.
    """
    blocks = site.planting.blocks
    named = [
        rows
        for rule, _ in ways
        for places in (*(places for places, _ in rule.avoid), *(one.places for one in rule.slow))
        for rows in rows_of(places)
        if rows.first and not is_in_block(rows.of)
    ]
    if len(blocks) < 2 or not named:
        return [ways]
    fitting = [block for block in blocks if all(_has(site, block, rows) for rows in named)]
    selectors = [node.selector for node in p.walk(plan) if node.selector is not None]
    planned = {part.block for selector in selectors for part in blocks_of(selector)}
    if len(planned) == 1:
        fitting = [block for block in fitting if block.name in planned] or fitting
    return [tuple((_rule_of_block(rule, block), said) for rule, said in ways) for block in fitting] or [ways]


def _rule_of_block(rule: WayRule, block: Block) -> WayRule:
    avoid = tuple((_rows_of_block(places, block), metres) for places, metres in rule.avoid)
    slow = tuple(replace(one, places=_rows_of_block(one.places, block)) for one in rule.slow)
    return replace(rule, avoid=avoid, slow=slow)


def leaves_block_open(selector: s.Selector, site: Site) -> bool:
    """Return True for rows counted from a side without their block, where the rows of some block have no such side."""
    if len({block.runs_east_west for block in site.planting.blocks}) < 2:
        return False
    return any(rows.counted_from != "usual" and not is_in_block(rows.of) for rows in rows_of(selector))


def _has(site: Site, block: Block, rows: s.Rows) -> bool:
    """Return True if a block has the rows at the ends of a range."""
    try:
        in_order, _ = rows_from(site, block, rows.counted_from)
    except PlaceError:
        return False
    by_number = rows.counted_from != "usual"
    return all(
        not name or find_row(in_order, name, by_number=by_number) is not None for name in (rows.first, rows.last)
    )


def _of_block(node: p.Node, block: Block) -> p.Node:
    """Return a node whose rows without a block are those of a block."""
    node = node.with_children([_of_block(child, block) for child in node.children])
    if node.selector is None:
        return node
    place = _rows_of_block(node.selector, block)
    return node if place == node.selector else with_selector(node, place)


def _rows_of_block(place: s.Selector, block: Block) -> s.Selector:
    """Return places whose rows without a block are those of a block."""
    for rows in rows_of(place):
        if rows.first and not is_in_block(rows.of):
            place = swapped(place, rows, replace(rows, of=over(rows.of, s.InBlock(block=block.name))))
    return place
