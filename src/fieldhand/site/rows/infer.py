"""Rows from bare points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.rows.evidence import for_rows, needed, sure_of_row, sure_of_way
from fieldhand.site.rows.grouping import Line, lines_of, parted, row_spacing, together
from fieldhand.site.rows.patches import PATCH, SMALL_PATCH, patches_of
from fieldhand.site.rows.regions import Region, assign, line_regions, regions_of, rows_run
from fieldhand.site.rows.settle import SeenBlock, Settling
from fieldhand.site.rows.tracing import bridge, part_twins, pooled_slope, spacing_along, spacing_of, trace, turned

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_ROUNDS = 6
#: Trees in step that make a patch clear; as many of scattered ones rarely are.
_CLEAR = 11.0


def seen_blocks(xy: Floats) -> list[SeenBlock]:
    """Blocks and their rows, as they can be seen in how the trees stand.

    In rounds: what is not explained yet is looked at again, until nothing is found in it.
    """
    found: list[SeenBlock] = []
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
    return [_judged(xy, block) for block in Settling(xy, found).settled()]


def _blocks_among(xy: Floats, trees: Indices, size: int) -> list[SeenBlock]:
    patches = patches_of(xy, trees, size)
    clear = np.clip(_CLEAR / patches.count, 0.36, 0.6)
    regions = [*regions_of(xy, patches, clear), *line_regions(xy, patches, clear)]
    if not regions:
        return []
    owner = assign(xy, trees, regions)
    found = [block for k, region in enumerate(regions) for block in _blocks_of(xy, trees[owner == k], region)]
    enough = needed(len(trees))
    return [b for b in found if for_rows(xy, b.rows, b.way, b.tree_spacing) > enough]


def _judged(xy: Floats, block: SeenBlock) -> SeenBlock:
    """The block with how sure it and its rows are."""
    across = np.array([block.way[1], -block.way[0]])
    count = sum(map(len, block.rows))
    squares = sum(float(((xy[trees] @ across - (xy[trees] @ across).mean()) ** 2).sum()) for trees in block.rows)
    off = float(np.sqrt(squares / max(count - len(block.rows), 1)))
    wide = block.row_spacing if len(block.rows) > 1 else float("inf")
    sure = sure_of_way(
        for_rows(xy, block.rows, block.way, block.tree_spacing),
        needed(len(xy)),
        block.wider if len(block.rows) > 1 else float("inf"),
        block.walked,
    )
    rows = [sure * sure_of_row(xy, trees, block.way, block.tree_spacing, wide, off) for trees in block.rows]
    return replace(block, sure=sure, rows_sure=rows)


def _blocks_of(xy: Floats, trees: Indices, region: Region) -> list[SeenBlock]:
    if len(trees) < 3:
        return []
    region, walked = rows_run(xy, trees, region)
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
    label = bridge(local, slope, label, spacing)
    if straight:
        local = local - np.column_stack([local[:, 1] * slope, np.zeros(len(local))])
        label = part_twins(local, label, spacing)
        spacing = spacing_of(local, label) or spacing
    lines = lines_of(local, label)
    return _grouped(trees, lines, region, walked, spacing, _way(wave, float(np.mean(slope))))


def _slopes(waves: Floats, mean: Floats) -> Floats:
    turned_waves = turned(waves, mean)
    return np.asarray(-turned_waves[:, 1] / turned_waves[:, 0])


def _way(wave: Floats, slope: float) -> Floats:
    """The unit vector along rows that lean against the wave by that slope."""
    across = wave / np.hypot(*wave)
    way = np.array([-across[1], across[0]]) + slope * across
    return np.asarray(way / np.hypot(*way))


def _grouped(
    trees: Indices, lines: list[Line], region: Region, walked: float, spacing: float, way: Floats
) -> list[SeenBlock]:
    long = [line for line in lines if len(line.trees) >= 3]
    if not long:
        return []
    wide = row_spacing(long, region.spacing)
    block_of = together(lines, wide)
    blocks = []
    for k in range(int(block_of.max()) + 1):
        for part in parted([lines[r] for r in np.flatnonzero(block_of == k)], spacing):
            if max(len(line.trees) for line in part) < 3:
                continue
            blocks.append(
                SeenBlock(
                    rows=[trees[line.trees] for line in part],
                    row_spacing=wide,
                    tree_spacing=spacing,
                    way=way,
                    power=region.power,
                    wider=region.wider,
                    walked=walked,
                )
            )
    return blocks
