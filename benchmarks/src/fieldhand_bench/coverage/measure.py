"""Measure coverage plans of generated blocks, and those of Fields2Cover for the same blocks."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from fieldhand.site.coverage.cover import cover
from fieldhand.site.coverage.headland import headland_width
from fieldhand.site.coverage.measures import fields2cover_objectives
from fieldhand.site.coverage.plan import CoverageParams, CoveragePlan
from fieldhand.site.coverage.row_passes import cover_rows
from fieldhand_bench.coverage import fields2cover
from fieldhand_bench.coverage.blocks import BlockKind, BlockToCover

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class CoverageFigures:
    """Figures of one plan for one block.

    Attributes:
        covered: Covered share of the ground outside the declared headlands, 0 to 1.
        overlap: Overlap of the swaths as a share of that ground, as Fields2Cover defines it.
        swaths: Number of swaths.
        length_m: Metres along all swaths and between them, without passes of the headland.
        headland_m: Metres of the passes of the headland, and of the drives to and between them.
        median_s: Median time to compute the plan, in seconds.
        setup: Decomposition and objective of Fields2Cover; empty for other plans.
    """

    covered: float
    overlap: float
    swaths: int
    length_m: float
    headland_m: float
    median_s: float
    setup: str = ""


@dataclass(frozen=True, kw_only=True)
class BlockResult:
    """The plans for one block.

    Attributes:
        name, kind: As of the block.
        hectares: Its area.
        width_m: Working width.
        ours: Figures of the plan.
        theirs: Figures of the plan of Fields2Cover; None without its module, and for planted blocks, whose rows it
            does not know.
    """

    name: str
    kind: BlockKind
    hectares: float
    width_m: float
    ours: CoverageFigures
    theirs: CoverageFigures | None

    @property
    def ratio(self) -> float | None:
        """Return our distance divided by that of Fields2Cover."""
        return None if self.theirs is None else self.ours.length_m / self.theirs.length_m


def measure_blocks(
    blocks: Sequence[BlockToCover], *, repeats: int, clock: Callable[[], float], compare: bool
) -> Iterator[BlockResult]:
    """Yield the result of each block.

    Args:
        blocks: Blocks.
        repeats: Number of times that each plan is computed, for the median time.
        clock: Clock in seconds.
        compare: Compute the plans of Fields2Cover, too.
    """
    for block in blocks:
        theirs = _theirs(block, repeats, clock) if compare and block.layout is None else None
        yield BlockResult(
            name=block.name,
            kind=block.kind,
            hectares=block.area.area / 1e4,
            width_m=block.width_m,
            ours=_ours(block, repeats, clock),
            theirs=theirs,
        )


def plan_of(block: BlockToCover) -> CoveragePlan:
    """Return the coverage plan of a block: along its rows if it is planted."""
    params = CoverageParams(working_width_m=block.width_m)
    if block.layout is not None:
        return cover_rows(block.layout, block.area, params)
    return cover(block.area, params)


def _ours(block: BlockToCover, repeats: int, clock: Callable[[], float]) -> CoverageFigures:
    plan, seconds = _timed(lambda: plan_of(block), repeats, clock)
    objectives = fields2cover_objectives(plan.inside, [swath.line for swath in plan.swaths], block.width_m)
    first = next(k for k, leg in enumerate(plan.legs) if leg.kind == "swath")
    inner = sum(leg.length_m for leg in plan.legs[first:])
    return CoverageFigures(
        covered=objectives.coverage,
        overlap=objectives.overlap,
        swaths=objectives.swaths,
        length_m=inner,
        headland_m=plan.length_m - inner,
        median_s=seconds,
    )


def _theirs(block: BlockToCover, repeats: int, clock: Callable[[], float]) -> CoverageFigures | None:
    wide = headland_width(CoverageParams(working_width_m=block.width_m))
    plan, seconds = _timed(lambda: fields2cover.best_plan(block.area, block.width_m, wide), repeats, clock)
    if plan is None:
        return None
    objectives = fields2cover_objectives(plan.inside, plan.swaths, block.width_m)
    return CoverageFigures(
        covered=objectives.coverage,
        overlap=objectives.overlap,
        swaths=objectives.swaths,
        length_m=plan.length_m,
        headland_m=0.0,
        median_s=seconds,
        setup=plan.setup,
    )


def _timed(compute: Callable[[], T], repeats: int, clock: Callable[[], float]) -> tuple[T, float]:
    """Return the result of a computation and the median of its durations."""
    seconds = []
    for _ in range(repeats):
        began = clock()
        result = compute()
        seconds.append(clock() - began)
    return result, statistics.median(seconds)
