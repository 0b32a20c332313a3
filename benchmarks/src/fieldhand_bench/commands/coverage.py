"""``fieldhand bench coverage``: plan the coverage of generated blocks, and compare with Fields2Cover."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import CpuTimeOption, JsonOption, SeedOption
from fieldhand.cli.outputs import to_picture

if TYPE_CHECKING:
    from rich.table import Table

    from fieldhand_bench.coverage.measure import BlockResult


def bench_coverage(
    blocks: Annotated[int, typer.Option("--blocks", min=1, max=1000, help="Number of generated blocks.")] = 30,
    repeats: Annotated[int, typer.Option("--repeats", min=1, max=100, help="Repeats of each plan.")] = 3,
    alone: Annotated[bool, typer.Option("--alone", help="Do not compare with Fields2Cover.")] = False,
    plot: Annotated[
        Path | None, typer.Option("--plot", callback=to_picture, help="Plot the first 12 plans to this file.")
    ] = None,
    seed: SeedOption = 1,
    cpu_time: CpuTimeOption = False,
    json: JsonOption = False,
) -> None:
    """Print what the plan of each block covers and how far it drives, beside Fields2Cover if it is installed."""
    import time
    from dataclasses import asdict

    from fieldhand.cli import show
    from fieldhand_bench.commands.machine import machine
    from fieldhand_bench.coverage import fields2cover
    from fieldhand_bench.coverage.blocks import make_blocks
    from fieldhand_bench.coverage.measure import measure_blocks

    on = machine()
    compare = fields2cover.is_installed() and not alone
    results: list[BlockResult] = []
    counted = "processor time" if cpu_time else "wall-clock time"
    clock = time.process_time if cpu_time else time.perf_counter
    generated = make_blocks(blocks, seed)
    for result in measure_blocks(generated, repeats=repeats, clock=clock, compare=compare):
        results.append(result)
        if not json:
            show.note(f"block {result.name}: done")
    summary = _summary(results)
    if json:
        show.print_json({"machine": on, "seed": seed, "blocks": [asdict(r) for r in results], "summary": summary})
    else:
        _show(results, summary, compare, f"Median {counted} of {repeats} runs", on)
    # Last, so that the figures are printed even if the plot cannot be written.
    if plot is not None:
        from fieldhand_bench.coverage.plot import plot_plans

        plot_plans(generated, plot)


def _show(
    results: Sequence[BlockResult], summary: dict[str, Any], compare: bool, timed: str, on: dict[str, str]
) -> None:
    """Print the table, the meaning of its columns, the summary, and the machine it was measured on."""
    from fieldhand.cli import show

    show.out.print(_table(results))
    show.out.print_lines(*_lines(summary, compare))
    show.out.print(
        f"{timed} on {on['machine']}, {on['cpu']}, {on['cores']} cores, load {on['load']}; {on['software']}."
    )


def _summary(results: Sequence[BlockResult]) -> dict[str, Any]:
    from statistics import median

    ratios = [r.ratio for r in results if r.ratio is not None]
    least = min(r.ours.covered for r in results)
    found: dict[str, Any] = {"least_covered": least, "median_s": median(r.ours.median_s for r in results)}
    if ratios:
        compared = [(r.ours, r.theirs) for r in results if r.theirs is not None]
        found |= {
            "compared": len(ratios),
            "mean_ratio": sum(ratios) / len(ratios),
            "median_ratio": median(ratios),
            "worst_ratio": max(ratios),
            "within_2_percent": sum(ratio <= 1.02 for ratio in ratios),
            "distance_ratio": sum(a.length_m for a, _ in compared) / sum(b.length_m for _, b in compared),
            "least_covered_fields2cover": min(b.covered for _, b in compared),
            "mean_covered_fields2cover": sum(b.covered for _, b in compared) / len(compared),
            "median_s_fields2cover": median(b.median_s for _, b in compared),
        }
    return found


def _lines(summary: dict[str, Any], compare: bool) -> list[str]:
    """Return what the columns mean, and the summary."""
    lines = [
        "w: working width in m; covered: % of the ground outside the headland; overlap: of the swaths, % of it;",
        "n: swaths; m: along all swaths and between them, without the headland; s: to plan; F: Fields2Cover.",
        f"Least covered: {_share(summary['least_covered'])} %; median {summary['median_s']:.2f} s a plan.",
    ]
    if "compared" in summary:
        lines += [
            f"Distance against Fields2Cover in {summary['compared']} blocks: mean {summary['mean_ratio']:.3f}, worst "
            f"{summary['worst_ratio']:.3f}, at most 1.02 in {summary['within_2_percent']}; all blocks together "
            f"{summary['distance_ratio']:.3f}.",
            f"Fields2Cover covers {_share(summary['mean_covered_fields2cover'])} % on average, at least "
            f"{_share(summary['least_covered_fields2cover'])} %, in {summary['median_s_fields2cover']:.2f} s.",
        ]
    elif not compare:
        lines.append("Fields2Cover is not compared: its Python module is not installed, or --alone was given.")
    return lines


def _table(results: Sequence[BlockResult]) -> Table:
    """Return a table of all blocks, narrow enough for 80 columns."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    heads = ["block", "ha", "w", "covered", "overlap", "n", "m", "s"]
    compared = any(r.theirs is not None for r in results)
    for head in [*heads, *(["F covered", "F n", "F m", "m / F m"] if compared else [])]:
        table.add_column(head, justify="left" if head == "block" else "right", no_wrap=True)
    for r in results:
        row = [
            r.name, f"{r.hectares:.1f}", f"{r.width_m:g}", _share(r.ours.covered), f"{100 * r.ours.overlap:.1f}",
            str(r.ours.swaths), f"{r.ours.length_m:.0f}", f"{r.ours.median_s:.2f}",
        ]  # fmt: skip
        if r.theirs is not None and r.ratio is not None:
            row += [_share(r.theirs.covered), str(r.theirs.swaths), f"{r.theirs.length_m:.0f}", f"{r.ratio:.3f}"]
        table.add_row(*row)
    return table


def _share(share: float) -> str:
    """Return a share in percent that is not rounded up to 100."""
    return "100" if share >= 1.0 - 1e-6 else f"{min(100 * share, 99.99):.2f}"
