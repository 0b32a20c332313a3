"""Combine the rows and blocks of the file with those inferred from the positions of the trees."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Sequence

import numpy as np
from numpy.typing import NDArray

from fieldhand.language import counted, message
from fieldhand.site.planting import RowSource
from fieldhand.site.rows.assemble import FoundRows, along_of, bearing
from fieldhand.site.rows.grouping import group_rows, row_spacing, traced_rows
from fieldhand.site.rows.labels import groups
from fieldhand.site.rows.named import NamedRows
from fieldhand.site.rows.refine import InferredBlock

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Rows whose directions differ by more than this, in degrees, are in different blocks unless the file names the block.
_OTHER_WAY = 8.0


def combine(xy: Floats, named: NamedRows, seen: Sequence[InferredBlock]) -> FoundRows:
    """Return the rows of the file, extended by unnamed trees, and the inferred rows of the other trees.

    Args:
        xy: Trees in metres.
        named: Rows of the file; they take precedence.
        seen: Inferred blocks.
    """
    seen_row, seen_block, sure = _by_tree(len(xy), seen)
    row_of, names, known, confidence = _rows(named, seen_row, sure)
    members = groups(row_of, len(names))
    block_key = _block_keys(xy, named, members, seen_row, seen_block, list(seen))
    blocks = list(dict.fromkeys(block_key))
    is_named = [isinstance(key, str) for key in blocks]
    return FoundRows(
        row_of=row_of,
        block_of=np.array([blocks.index(key) for key in block_key], dtype=np.intp),
        names=names,
        known=known,
        sure=confidence,
        block_names=[str(key) if own else "" for key, own in zip(blocks, is_named, strict=True)],
        block_known=["file" if own else "inferred" for own in is_named],
        block_sure=_block_sure(blocks, block_key, known, members, seen_row, seen_block, list(seen)),
        positions=named.positions,
        why=_why(row_of),
    )


def _by_tree(count: int, seen: Sequence[InferredBlock]) -> tuple[Indices, list[int], list[float]]:
    """Return the inferred row of each tree, -1 for none, and the block and confidence of each of these rows."""
    row_of = np.full(count, -1, dtype=np.intp)
    block_of: list[int] = []
    sure: list[float] = []
    for k, block in enumerate(seen):
        for trees, confidence in zip(block.rows, block.row_confidences, strict=True):
            row_of[trees] = len(block_of)
            block_of.append(k)
            sure.append(confidence)
    return row_of, block_of, sure


def _rows(
    named: NamedRows, seen_row: Indices, sure: Sequence[float]
) -> tuple[Indices, list[str], list[RowSource], list[float]]:
    """Return the rows of the file, then the inferred rows that contain no tree of these."""
    row_of = named.row_of.copy()
    names: list[str] = list(named.names)
    known: list[RowSource] = ["file"] * len(names)
    confidence = [1.0] * len(names)
    for k, trees in enumerate(groups(seen_row, len(sure))):
        without = trees[named.row_of[trees] < 0]
        if not len(without):
            continue
        own = Counter(named.row_of[trees][named.row_of[trees] >= 0].tolist())
        pieces = [without]
        if own:
            row = own.most_common(1)[0][0]
            row_of[without] = row
            confidence[row] = min(confidence[row], sure[k])
            continue
        pieces = _by_block(trees, named.block_names)
        for piece in pieces:
            row_of[piece] = len(names)
            names.append("")
            known.append("inferred")
            confidence.append(sure[k])
    return row_of, names, known, confidence


def _by_block(trees: Indices, block_names: Sequence[str]) -> list[Indices]:
    """Split an inferred row where the file assigns its consecutive trees to another block."""
    names = [block_names[k] for k in trees]
    changes = [k for k in range(1, len(names)) if names[k] != names[k - 1]]
    if not changes or len(changes) + 1 > len(set(names)):
        return [trees]
    return np.split(trees, changes)


def _block_keys(
    xy: Floats,
    named: NamedRows,
    members: Sequence[Indices],
    seen_row: Indices,
    seen_block: Sequence[int],
    seen: list[InferredBlock],
) -> list[Hashable]:
    """Return for each row the key of its block: the name in the file, else a number."""
    keys: list[Hashable] = [_named_block(named, trees) for trees in members]
    if all(keys):
        return keys
    # Rows without a block name join the block of the rows that they were inferred with ...
    blocks = np.array([*seen_block, -1], dtype=np.intp)[seen_row]
    spoken: dict[int, Counter[str]] = {}
    for key, trees in zip(keys, members, strict=True):
        own = blocks[trees]
        if key and (own >= 0).any():
            spoken.setdefault(int(np.bincount(own[own >= 0]).argmax()), Counter())[str(key)] += len(trees)
    beside: list[int] = []
    for k, trees in enumerate(members):
        own = blocks[trees]
        if keys[k]:
            continue
        if not (own >= 0).any():
            beside.append(k)
            continue
        block = int(np.bincount(own[own >= 0]).argmax())
        keys[k] = spoken[block].most_common(1)[0][0] if block in spoken else block
    # ... or, if the file names the row, that of the rows beside them.
    for k, label in zip(beside, _beside(xy, [members[k] for k in beside]), strict=True):
        keys[k] = len(seen) + label
    return keys


def _named_block(named: NamedRows, trees: Indices) -> str:
    """Return the block that the file names for these trees; empty if it names none or several."""
    names = {named.block_names[k] for k in trees}
    return names.pop() if len(names) == 1 else ""


def _beside(xy: Floats, rows: Sequence[Indices]) -> list[int]:
    """Label rows by their block, from their positions."""
    if not rows:
        return []
    label = np.zeros(len(rows), dtype=np.intp)
    ways = np.array(
        [bearing(xy[trees], np.zeros(len(trees), dtype=np.intp)) if len(trees) > 2 else np.nan for trees in rows]
    )
    first = 0
    for same in _by_direction(ways):
        own = np.full(len(xy), -1, dtype=np.intp)
        for place, k in enumerate(same):
            own[rows[k]] = place
        way = along_of(bearing(xy, own))
        local = np.column_stack([xy @ np.array([way[1], -way[0]]), xy @ way])
        lines = traced_rows(local, own)
        guess = _median_step(np.sort([float(line.across.mean()) for line in lines]))
        label[same] = first + group_rows(lines, row_spacing(lines, guess), trusted=True)
        first = int(label.max()) + 1
    return [int(k) for k in label]


def _median_step(middles: Floats) -> float:
    steps = np.diff(middles)
    steps = steps[steps > 0.2]
    return float(np.median(steps)) if len(steps) else 1.0


def _by_direction(ways: Floats) -> list[Indices]:
    """Group rows by direction; rows too short to have one join the largest group."""
    short = np.flatnonzero(np.isnan(ways))
    long = np.flatnonzero(~np.isnan(ways))
    if not len(long):
        return [short]
    order = long[np.argsort(ways[long], kind="stable")]
    turned = ways[order]
    cuts = np.flatnonzero(np.diff(turned) > _OTHER_WAY) + 1
    parts = list(np.split(order, cuts))
    if len(parts) > 1 and turned[0] + 180.0 - turned[-1] <= _OTHER_WAY:
        parts[0] = np.concatenate([parts.pop(), parts[0]])
    parts.sort(key=len, reverse=True)
    parts[0] = np.concatenate([parts[0], short])
    return parts


def _block_sure(
    blocks: Sequence[Hashable],
    block_key: Sequence[Hashable],
    known: Sequence[RowSource],
    members: Sequence[Indices],
    seen_row: Indices,
    seen_block: Sequence[int],
    seen: list[InferredBlock],
) -> list[float]:
    """Return the confidence of each block: 1 if the file names some of its rows, else that of the inferred blocks."""
    found = []
    for key in blocks:
        rows = [k for k, own in enumerate(block_key) if own == key]
        if any(known[k] == "file" for k in rows):
            found.append(1.0)
            continue
        trees = np.concatenate([members[k] for k in rows])
        inside = {seen_block[r] for r in np.unique(seen_row[trees]).tolist() if r >= 0}
        found.append(min((seen[b].confidence for b in inside), default=1.0))
    return found


def _why(row_of: Indices) -> str:
    lost, count = int((row_of < 0).sum()), len(row_of)
    if not lost:
        return ""
    if lost < count:
        return counted(
            "{count} of the {trees} trees is not in a row",
            "{count} of the {trees} trees are not in a row",
            lost,
            trees=count,
        )
    if count < 3:
        return message("at least three trees are needed to detect a row")
    return message("the {count} trees are scattered: no rows can be detected from their positions", count=count)
