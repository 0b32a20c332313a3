"""Rows that are named without their block, on a site of several blocks."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.plans import with_selector
from fieldhand.planning.selections import is_in_block, over, rows_of
from fieldhand.site.model import Site
from fieldhand.site.planting import Block
from fieldhand.task import plan as p


def in_each_block(plan: p.Node, site: Site) -> Sequence[p.Node]:
    """Return a plan for each block whose rows may be meant; only the plan itself if its rows are known by their names.

    All rows that are named without a block are of the same one.
    """
    blocks = site.planting.blocks
    if len(blocks) < 2:
        return [plan]
    named = [
        rows
        for node in p.walk(plan)
        if node.selector is not None
        for rows in rows_of(node.selector)
        if rows.first and not is_in_block(rows.of)
    ]
    if not named:
        return [plan]
    fitting = [block for block in blocks if all(_has(block, rows) for rows in named)]
    return [_of_block(plan, block) for block in fitting] if len(fitting) > 1 else [plan]


def _has(block: Block, rows: s.Rows) -> bool:
    """Return True if a block has the rows at the ends of a range."""
    return all(
        not name or any(name.lower() in (row.name.lower(), str(row.number)) for row in block.rows)
        for name in (rows.first, rows.last)
    )


def _of_block(node: p.Node, block: Block) -> p.Node:
    """Return a node whose rows without a block are those of a block."""
    node = node.with_children([_of_block(child, block) for child in node.children])
    if node.selector is None or is_in_block(node.selector) or not rows_of(node.selector):
        return node
    return with_selector(node, over(node.selector, s.InBlock(block=block.name)))
