"""Infer blocks and rows from the positions of the trees alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.rows.evidence import bearing_confidence, log_likelihood_ratio, required_evidence, row_confidence
from fieldhand.site.rows.grouping import TracedRow, group_rows, row_spacing, traced_rows
from fieldhand.site.rows.patches import PATCH, SMALL_PATCH, patches_of
from fieldhand.site.rows.refine import InferredBlock, RowRefinement
from fieldhand.site.rows.regions import (
    Region,
    assign_trees,
    line_regions,
    merge_small_regions,
    regions_of,
    row_direction,
)
from fieldhand.site.rows.roads import rejoin_rows, split_by_roads
from fieldhand.site.rows.tracing import (
    join_across_gaps,
    pooled_slope,
    spacing_along,
    spacing_of,
    split_double_rows,
    trace,
    turned,
)

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_ROUNDS = 6
#: Number of trees in phase with a wave that makes a patch clear; scattered trees rarely reach it.
_CLEAR = 11.0
#: Tolerances for similar blocks: sine of the angle between rows, and relative difference of the tree spacing.
_SAME_WAY, _SAME_SPACING = 0.045, 0.12


def infer_blocks(xy: Floats) -> list[InferredBlock]:
    """Return the blocks and rows that can be inferred from the positions of the trees.

    Unexplained trees are examined again in further rounds, until no more rows are found.
    """
    found: list[InferredBlock] = []
    left = np.arange(len(xy))
    for _ in range(_ROUNDS):
        if len(left) < 3:
            break
        new = _blocks_among(xy, left, PATCH) or _blocks_among(xy, left, SMALL_PATCH)
        if not new:
            break
        found.extend(new)
        taken = np.concatenate([trees for block in new for trees in block.rows])
        left = np.setdiff1d(left, taken, assume_unique=True)
    found = [
        block for alike in _similar_blocks(found) for block in (_trace_together(xy, alike) if len(alike) > 1 else alike)
    ]
    return [_with_confidence(xy, block) for block in RowRefinement(xy, found).refined()]


def _similar_blocks(blocks: list[InferredBlock]) -> list[list[InferredBlock]]:
    """Group blocks with straight rows of the same direction and tree spacing, the largest block of each group first."""
    parts: list[list[InferredBlock]] = []
    for block in sorted(blocks, key=lambda b: -sum(map(len, b.rows))):
        for part in parts:
            first = part[0]
            turn = abs(float(first.way[0] * block.way[1] - first.way[1] * block.way[0]))
            spacing = abs(block.tree_spacing / first.tree_spacing - 1.0)
            if first.straight and block.straight and turn < _SAME_WAY and spacing < _SAME_SPACING:
                part.append(block)
                break
        else:
            parts.append([block])
    return parts


def _trace_together(xy: Floats, blocks: list[InferredBlock]) -> list[InferredBlock]:
    """Trace blocks that were found separately as one, joining rows across them and splitting them at roads."""
    first = blocks[0]
    rows = [trees for block in blocks for trees in block.rows]
    trees = np.concatenate(rows)
    label = np.repeat(np.arange(len(rows)), [len(own) for own in rows])
    local = turned(xy[trees], np.array([first.way[1], -first.way[0]]))
    lean = [float(_slope(block.way, first.way)) for block in blocks]
    slope = np.repeat(lean, [sum(map(len, block.rows)) for block in blocks])
    lines = traced_rows(local, join_across_gaps(local, slope, label, first.tree_spacing))
    return _split_into_blocks(trees, lines, first)


def _slope(way: Floats, mean: Floats) -> float:
    """Return the metres to the right of the mean direction for each metre along it."""
    way = way if way @ mean > 0 else -way
    return float((way[0] * mean[1] - way[1] * mean[0]) / (way @ mean))


def _blocks_among(xy: Floats, trees: Indices, size: int) -> list[InferredBlock]:
    patches = patches_of(xy, trees, size)
    clear = np.clip(_CLEAR / patches.count, 0.36, 0.6)
    regions = [*regions_of(xy, patches, clear), *line_regions(xy, patches, clear)]
    if not regions:
        return []
    owner = merge_small_regions(xy[trees], assign_trees(xy, trees, regions), regions)
    found = [block for k, region in enumerate(regions) for block in _blocks_of(xy, trees[owner == k], region)]
    enough = required_evidence(len(trees))
    return [b for b in found if log_likelihood_ratio(xy, b.rows, b.way, b.tree_spacing) > enough]


def _with_confidence(xy: Floats, block: InferredBlock) -> InferredBlock:
    """Return the block with the confidence of its direction and of its rows."""
    across = np.array([block.way[1], -block.way[0]])
    count = sum(map(len, block.rows))
    squares = sum(float(((xy[trees] @ across - (xy[trees] @ across).mean()) ** 2).sum()) for trees in block.rows)
    off = float(np.sqrt(squares / max(count - len(block.rows), 1)))
    wide = block.row_spacing if len(block.rows) > 1 else float("inf")
    sure = bearing_confidence(
        log_likelihood_ratio(xy, block.rows, block.way, block.tree_spacing),
        required_evidence(len(xy)),
        block.spacing_ratio if len(block.rows) > 1 else float("inf"),
        block.file_order_share,
    )
    rows = [sure * row_confidence(xy, trees, block.way, block.tree_spacing, wide, off) for trees in block.rows]
    return replace(block, confidence=sure, row_confidences=rows)


def _blocks_of(xy: Floats, trees: Indices, region: Region) -> list[InferredBlock]:
    if len(trees) < 3:
        return []
    region, file_order_share = row_direction(xy, trees, region)
    wave = region.wave
    local = turned(xy[trees], wave)
    slope = _slopes(region.wave_at(xy, xy[trees]), wave)
    straight = bool(np.ptp(slope) == 0.0)
    spacing = spacing_along(local, region.spacing)
    label = trace(local, slope, spacing)
    if straight:
        size = np.bincount(label)[label]
        long = size >= 4
        if long.any():
            lean = pooled_slope(local[long], np.unique(label[long], return_inverse=True)[1])
            slope = np.full(len(trees), lean)
    spacing = spacing_of(local, label) or spacing
    label = trace(local, slope, spacing)
    label = join_across_gaps(local, slope, label, spacing)
    if straight:
        local = local - np.column_stack([local[:, 1] * slope, np.zeros(len(local))])
        label = split_double_rows(local, label, spacing)
        spacing = spacing_of(local, label) or spacing
    lines = traced_rows(local, label)
    rows = [line for line in lines if len(line.trees) >= 3]
    if not rows:
        return []
    like = InferredBlock(
        rows=[],
        row_spacing=row_spacing(rows, region.spacing),
        tree_spacing=spacing,
        way=_way(wave, float(np.mean(slope))),
        power=region.power,
        spacing_ratio=region.spacing_ratio,
        file_order_share=file_order_share,
        straight=straight,
    )
    return _split_into_blocks(trees, lines, like)


def _slopes(waves: Floats, mean: Floats) -> Floats:
    turned_waves = turned(waves, mean)
    return np.asarray(-turned_waves[:, 1] / turned_waves[:, 0])


def _way(wave: Floats, slope: float) -> Floats:
    """Return the unit vector along rows with a slope relative to the wave."""
    across = wave / np.hypot(*wave)
    way = np.array([-across[1], across[0]]) + slope * across
    return np.asarray(way / np.hypot(*way))


def _split_into_blocks(trees: Indices, lines: list[TracedRow], like: InferredBlock) -> list[InferredBlock]:
    """Group rows into blocks with the properties of ``like``; a block needs a row of three trees."""
    block_of = group_rows(lines, like.row_spacing)
    return [
        replace(like, rows=[trees[line.trees] for line in rejoin_rows(part, like.tree_spacing)])
        for k in range(int(block_of.max()) + 1)
        for part in split_by_roads(
            [lines[r] for r in np.flatnonzero(block_of == k)], like.tree_spacing, like.row_spacing
        )
        if max(len(line.trees) for line in part) >= 3
    ]
