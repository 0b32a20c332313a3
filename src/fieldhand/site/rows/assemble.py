"""Order and number blocks, rows and planting positions, given the row of each tree."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.planting import Block, Indices, Planting, Row, RowSource
from fieldhand.site.rows.labels import groups

Floats = NDArray[np.float64]

#: Trees closer than this fraction of the tree spacing share a planting position: one was entered twice.
_SAME_POSITION = 0.3
#: Fraction of a tree's offset by which the next expected position is corrected.
_FOLLOW = 0.35


@dataclass(frozen=True, eq=False, kw_only=True)
class FoundRows:
    """Rows before they are ordered and numbered.

    Attributes:
        row_of: Row of each tree, -1 for none. Shape (n,).
        block_of: Block of each row. Shape (rows,).
        names: Name of each row, empty if the file gives none.
        known: Source of each row.
        sure: Confidence of each row.
        block_names: Name of each block, empty if the file gives none.
        block_known: Source of each block.
        block_sure: Confidence of each block.
        positions: Position of each tree in its row from the file; nan if it gives none. Shape (n,).
        why: Text for :attr:`Planting.why`.
    """

    row_of: Indices
    block_of: Indices
    names: Sequence[str]
    known: Sequence[RowSource]
    sure: Sequence[float]
    block_names: Sequence[str]
    block_known: Sequence[RowSource]
    block_sure: Sequence[float]
    positions: Floats
    why: str = ""


def assemble(xy: Floats, drawn: FoundRows) -> Planting:
    """Return the planting with rows numbered in order, each tree with its planting position."""
    members = groups(drawn.row_of, len(drawn.block_of))
    blocks = [
        _block(xy, drawn, block, [(k, members[k]) for k in np.flatnonzero(drawn.block_of == block).tolist()])
        for block in range(len(drawn.block_names))
    ]
    ordered = [
        replace(
            block,
            name=block.name or _free_name(place + 1, blocks),
            rows=tuple(replace(row, block=place) for row in block.rows),
        )
        for place, block in enumerate(_in_order(xy, blocks))
    ]
    return Planting(blocks=tuple(ordered), tree_count=len(xy), why=drawn.why)


def bearing(xy: Floats, row_of: Indices) -> float:
    """Return the common direction of rows, in degrees clockwise from north, 0 up to 180.

    It is the main axis of the trees' scatter about the centre of their own row, so long rows weigh more.
    """
    inside = row_of >= 0
    points, labels = xy[inside], row_of[inside]
    if not len(points):
        return 0.0
    count = np.bincount(labels)
    middle = np.column_stack([np.bincount(labels, points[:, k]) for k in (0, 1)]) / np.maximum(count, 1)[:, None]
    off = points - middle[labels]
    if np.abs(off).max() < 1e-9:  # single trees: rows run perpendicular to the line through them
        off = (points - points.mean(axis=0)) @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    xx, yy, xy_ = (off[:, 0] ** 2).sum(), (off[:, 1] ** 2).sum(), (off[:, 0] * off[:, 1]).sum()
    return float(np.degrees(0.5 * np.arctan2(2 * xy_, yy - xx)) % 180.0) % 180.0


def along_of(bearing_deg: float) -> Floats:
    """Return the unit vector along rows, away from their usual end."""
    turn = np.radians(bearing_deg)
    axis = np.array([np.sin(turn), np.cos(turn)])
    if 45.0 < bearing_deg < 135.0:
        return axis if axis[0] > 0 else -axis
    return axis if axis[1] < 0 else -axis


def across_of(bearing_deg: float) -> Floats:
    """Return the unit vector across rows, towards higher numbers."""
    x, y = along_of(bearing_deg)
    # Rows run south (or east) and are numbered towards the east (or south).
    return np.array([y, -x]) if 45.0 < bearing_deg < 135.0 else np.array([-y, x])


def _block(xy: Floats, drawn: FoundRows, block: int, rows: list[tuple[int, Indices]]) -> Block:
    inside = np.concatenate([trees for _, trees in rows])
    turned = bearing(xy[inside], np.repeat(np.arange(len(rows)), [len(trees) for _, trees in rows]))
    along, across = along_of(turned), across_of(turned)
    lines = [(k, trees[np.argsort(xy[trees] @ along, kind="stable")]) for k, trees in rows]
    lines.sort(key=lambda line: float(np.mean(xy[line[1]] @ across)))
    offsets = np.array([float(np.mean(xy[trees] @ across)) for _, trees in lines])
    at = [xy[trees] @ along for _, trees in lines]
    spacing = tree_spacing(at)
    slots = _slots(at, spacing)
    made = tuple(
        Row(
            name=drawn.names[k] or str(number),
            number=number,
            block=block,
            trees=trees,
            slots=_with_own(slots[number - 1], drawn.positions[trees]),
            known=drawn.known[k],
            confidence=float(drawn.sure[k]),
        )
        for number, (k, trees) in enumerate(lines, start=1)
    )
    return Block(
        name=drawn.block_names[block],
        rows=made,
        bearing_deg=turned,
        row_spacing_m=float(np.median(np.diff(offsets))) if len(offsets) > 1 else float("nan"),
        tree_spacing_m=spacing if spacing > 0 else float(np.median(np.diff(offsets))) if len(offsets) > 1 else 0.0,
        known=drawn.block_known[block],
        confidence=float(drawn.block_sure[block]),
    )


def tree_spacing(at: Sequence[Floats]) -> float:
    """Return the tree spacing of several rows with missing trees, from rising coordinates along each; 0 without any
    pair.

    At least half of the steps are single ones, so the median gives a first estimate, which all steps then refine.
    """
    steps = np.concatenate([np.diff(a) for a in at]) if at else np.empty(0)
    steps = steps[steps > 0.02]
    if not steps.size:
        return 0.0
    guess = float(np.median(steps))
    steps = steps[steps > 0.4 * guess]
    for _ in range(4):
        single = steps[steps < 1.5 * guess]
        if not single.size:
            break
        guess = float(single.mean())
    counts = np.maximum(np.rint(steps / guess), 1.0)
    near = counts <= 4
    return float(steps[near].sum() / counts[near].sum()) if near.any() else guess


def _slots(at: Sequence[Floats], spacing: float) -> list[Indices]:
    """Return the planting positions along each row, from 1, computed for all rows at once.

    Each tree corrects the expected position of the next one a little, so that neither a displaced tree nor a spacing
    that changes along the row accumulates an error.
    """
    longest = max(map(len, at))
    padded = np.full((len(at), longest), np.nan)
    for k, a in enumerate(at):
        padded[k, : len(a)] = a
    step = spacing if spacing > 0 else 1.0
    slots = np.ones(padded.shape, dtype=np.intp)
    expected = padded[:, 0].copy()
    for j in range(1, longest):
        here = padded[:, j]
        there = ~np.isnan(here)
        ahead = np.where(there, (here - expected) / step, 1.0)
        apart = np.where(there, here - padded[:, j - 1], step)
        more = np.maximum(np.rint(ahead), np.where(apart < _SAME_POSITION * step, 0, 1)).astype(np.intp)
        slots[:, j] = slots[:, j - 1] + more
        at_slot = expected + more * step
        expected = np.where(there, at_slot + _FOLLOW * (here - at_slot), expected)
    return [slots[k, : len(a)] for k, a in enumerate(at)]


def _with_own(slots: Indices, own: Floats) -> Indices:
    """Return the file's own positions if every tree of the row has one and they are monotonic, else ``slots``."""
    if len(own) == 0 or not np.all(np.isfinite(own)) or np.any(own != np.rint(own)) or np.any(own < 1):
        return slots
    steps = np.diff(own)
    if np.all(steps > 0) or np.all(steps < 0):
        return own.astype(np.intp)
    return slots


def _in_order(xy: Floats, blocks: list[Block]) -> list[Block]:
    """Return the blocks from west to east, and from north to south where one lies above another."""
    if len(blocks) < 2:
        return blocks
    spans = []
    for block in blocks:
        points = xy[np.concatenate([row.trees for row in block.rows])]
        spans.append((points.min(axis=0), points.max(axis=0), points.mean(axis=0)))
    by_west = sorted(range(len(blocks)), key=lambda k: float(spans[k][2][0]))
    columns: list[list[int]] = []
    for k in by_west:
        low, high, middle = spans[k]
        if columns:
            first = spans[columns[-1][0]]
            shared = min(high[0], first[1][0]) - max(low[0], first[0][0])
            narrow = min(high[0] - low[0], first[1][0] - first[0][0])
            if shared > 0.5 * narrow and abs(middle[0] - first[2][0]) < 0.5 * max(narrow, 1e-9) + 1e-9:
                columns[-1].append(k)
                continue
        columns.append([k])
    return [blocks[k] for column in columns for k in sorted(column, key=lambda c: -float(spans[c][2][1]))]


def _free_name(number: int, blocks: Sequence[Block]) -> str:
    taken = {block.name for block in blocks}
    while str(number) in taken:
        number += len(blocks)
    return str(number)
