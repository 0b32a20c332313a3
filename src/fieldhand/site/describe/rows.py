"""Describe blocks and rows in figures and in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fieldhand.hidden_characters import visible
from fieldhand.site.counting import rows_from, trees_from
from fieldhand.site.model import Site
from fieldhand.site.planting import Block, Row, RowSource

_LONGEST = 40
_OPPOSITE = {"north": "south", "south": "north", "west": "east", "east": "west"}


@dataclass(frozen=True, kw_only=True)
class RowSummary:
    """A summary of a row.

    Attributes:
        block: Name of its block.
        name: Name of the row.
        number: Number in counting order within the block, from 1.
        trees: Number of trees.
        missing: Number of empty planting positions between its ends.
        length_m: Distance in metres from its first tree to its last.
        first, last: Ids of its trees at its usual end and at its other end.
        known: Source of the row: the file, or inference from the positions of the trees.
        confidence: Confidence in the row, 0 to 1.
    """

    block: str
    name: str
    number: int
    trees: int
    missing: int
    length_m: float
    first: str
    last: str
    known: RowSource
    confidence: float


@dataclass(frozen=True, kw_only=True)
class BlockSummary:
    """A summary of a block.

    Attributes:
        name: Name of the block.
        rows: Number of rows.
        bearing_deg: Bearing of the rows, clockwise from true north, 0 up to 180.
        row_spacing_m: Distance from row to row; None for a single row.
        tree_spacing_m: Distance from tree to tree along the rows; None if no row has two trees.
        counted_from: Side from which its rows are numbered.
        trees_from: Side from which the trees of a row are counted.
        trees: Number of trees in its rows.
        missing: Number of empty planting positions between the ends of its rows.
        shortest, longest: Its rows with the fewest and the most trees.
        known: Source of its rows: the file, or inference from the positions of the trees.
        confidence: Confidence in the direction of its rows, 0 to 1.
    """

    name: str
    rows: int
    bearing_deg: float
    row_spacing_m: float | None
    tree_spacing_m: float | None
    counted_from: str
    trees_from: str
    trees: int
    missing: int
    shortest: RowSummary
    longest: RowSummary
    known: RowSource
    confidence: float


def row_table(site: Site) -> tuple[RowSummary, ...]:
    """Return every row in counting order, block after block."""
    return tuple(
        _row(site, block, row, number)
        for block in site.planting.blocks
        for number, row in enumerate(rows_from(site, block, "usual")[0], start=1)
    )


def block_summary(site: Site, block: Block) -> BlockSummary:
    """Return the summary of a block."""
    rows, _ = rows_from(site, block, "usual")
    usual, ends = ("north", ("west", "east")) if block.runs_east_west else ("west", ("north", "south"))
    way, _ = trees_from(site, block, "usual")
    lengths = [len(row.trees) for row in rows]
    shortest, longest = int(np.argmin(lengths)), int(np.argmax(lengths))
    spacing, apart = block.row_spacing_m, block.tree_spacing_m
    return BlockSummary(
        name=shortened(block.name),
        rows=len(block.rows),
        bearing_deg=block.bearing_deg,
        row_spacing_m=None if math.isnan(spacing) else spacing,
        tree_spacing_m=apart if max(lengths) > 1 and math.isfinite(apart) else None,
        counted_from=usual if rows[0] is block.rows[0] else _OPPOSITE[usual],
        trees_from=ends[0] if way > 0 else ends[1],
        trees=sum(lengths),
        missing=sum(_missing(row) for row in block.rows),
        shortest=_row(site, block, rows[shortest], shortest + 1),
        longest=_row(site, block, rows[longest], longest + 1),
        known=block.rows[0].known,
        confidence=block.confidence,
    )


def block_words(block: BlockSummary, *, several: bool) -> str:
    """Return a sentence about a block that a grower can check in the field."""
    count = "a single row" if block.rows == 1 else f"{block.rows:,} rows"
    runs = f"{count} running {direction_words(block.bearing_deg)}"
    parts = [runs]
    if block.row_spacing_m is not None:
        parts.append(f"{block.row_spacing_m:.1f} m apart")
    if block.tree_spacing_m is not None:
        parts.append(f"trees {block.tree_spacing_m:.1f} m apart")
    gaps = f", {_positions(block.missing)} empty" if block.missing else ""
    parts.append(f"{block.trees:,} tree{'s' * (block.trees != 1)}{gaps}")
    name = block_name(block.name)
    text = f"{name}: {', '.join(parts)}" if several else _capital(", ".join(parts))
    return f"{text}; {_known_words(block.known, block.confidence)}."


def counting_words(block: BlockSummary) -> str:
    """Return the sides from which rows and the trees in them are counted, in words."""
    rows, trees = (f"{side} to {_OPPOSITE[side]}" for side in (block.counted_from, block.trees_from))
    return f"rows are counted from {rows}, trees in a row from {trees}"


def block_name(name: str) -> str:
    """Return the name of a block, preceded by "Block" if the name is short or a number."""
    return name if len(name) > 3 and not name.isdigit() else f"Block {name}"


def direction_words(bearing_deg: float) -> str:
    """Return the direction of a row in words: "north-south (7 degrees east of north)"."""
    bearing = bearing_deg % 180.0
    axis = round(bearing / 45.0) % 4
    name = ("north-south", "north-east to south-west", "east-west", "north-west to south-east")[axis]
    if axis == 2:
        off = round(bearing - 90.0)
        return name if off == 0 else f"{name} ({_degrees(off)} {'south' if off > 0 else 'north'} of east)"
    off = round(bearing if bearing <= 90.0 else bearing - 180.0)
    return name if off == 0 else f"{name} ({_degrees(off)} {'east' if off > 0 else 'west'} of north)"


def table_lines(rows: Sequence[RowSummary], *, several: bool) -> list[str]:
    """Return rows as a table with a header line."""
    inferred = any(row.known == "inferred" for row in rows)
    head = (
        ["block"] * several + ["row", "trees", "missing", "length", "from tree", "to tree"] + ["confidence"] * inferred
    )
    body = [
        [shortened(row.block, 16)] * several
        + [
            shortened(row.name, 16),
            f"{row.trees:,}",
            f"{row.missing:,}" if row.missing else "-",
            f"{row.length_m:.1f} m",
        ]
        + [shortened(row.first, 16), shortened(row.last, 16)]
        + [f"{row.confidence:.2f}" if row.known == "inferred" else "named"] * inferred
        for row in rows
    ]
    widths = [max(len(line[k]) for line in [head, *body]) for k in range(len(head))]
    return ["  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True)) for line in [head, *body]]


def shortened(text: str, longest: int = _LONGEST) -> str:
    """Return text from a file, printable and cut to a maximum length."""
    text = visible(text[: 4 * longest])
    return text if len(text) <= longest else text[: longest - 3] + "..."


def _row(site: Site, block: Block, row: Row, number: int) -> RowSummary:
    first, last = int(row.trees[0]), int(row.trees[-1])
    return RowSummary(
        block=shortened(block.name),
        name=shortened(row.name),
        number=number,
        trees=len(row.trees),
        missing=_missing(row),
        length_m=float(np.hypot(*(site.xy[last] - site.xy[first]))),
        first=site.trees[first].place.id,
        last=site.trees[last].place.id,
        known=row.known,
        confidence=row.confidence,
    )


def _missing(row: Row) -> int:
    """Return the number of empty planting positions; several trees in one position count once."""
    taken = np.unique(row.slots)
    return int(taken[-1] - taken[0] + 1 - len(taken))


def _known_words(known: RowSource, confidence: float) -> str:
    if known == "file":
        return "named in the file"
    return f"detected from the tree positions, confidence {confidence:.2f}"


def _positions(count: int) -> str:
    return f"{count:,} position{'s' * (count != 1)}"


def _degrees(off: int) -> str:
    return f"{abs(off)} degree{'s' * (abs(off) != 1)}"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
