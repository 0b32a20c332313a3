"""``fieldhand bench planning``: measure the English planner on an orchard of a given size."""

from __future__ import annotations

from typing import Annotated

import typer

from fieldhand.cli.options import CpuTimeOption, JsonOption, SeedOption

#: Target for planning a request, in seconds, and the largest number of trees to which it applies.
PLAN_S, PLAN_TREES = 0.05, 10_000
_SLOWEST = 8
_SHOWN = 44


def bench_planning(
    trees: Annotated[int, typer.Option("--trees", min=20, max=1_000_000, help="Number of trees.")] = 10_000,
    repeats: Annotated[int, typer.Option("--repeats", min=1, max=1000, help="Repeats of each request.")] = 10,
    seed: SeedOption = 1,
    cpu_time: CpuTimeOption = False,
    json: JsonOption = False,
) -> None:
    """Generate an orchard and measure the time to plan English requests of every kind on it."""
    import time
    from dataclasses import asdict

    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    from fieldhand.cli import show
    from fieldhand_bench.commands.machine import machine
    from fieldhand_bench.planning import measure_planning

    on = machine()
    measured = measure_planning(
        trees, seed=seed, repeats=repeats, clock=time.process_time if cpu_time else time.perf_counter
    )
    counted = "processor time" if cpu_time else "wall-clock time"
    if json:
        totals = {"median_s": measured.median_s, "slowest_s": measured.slowest.median_s, "worst_s": measured.worst_s}
        show.print_json({"machine": on, "time": counted} | totals | asdict(measured))
        return
    title = f"{measured.trees:,} trees in {measured.rows:,} rows; {len(measured.requests)} requests"
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for head in ("ms", "first", "median", "worst"):
        table.add_column(head, justify="left" if head == "ms" else "right", no_wrap=True)
    for timing in sorted(measured.requests, key=lambda t: -t.median_s)[:_SLOWEST]:
        words = timing.request if len(timing.request) <= _SHOWN else f"{timing.request[: _SHOWN - 3]}..."
        text = words if timing.answer == "planned" else f"{words} ({timing.answer})"
        table.add_row(text, *(f"{1000 * s:.1f}" for s in (timing.first_s, timing.median_s, timing.worst_s)))
    show.out.print(table)
    planned = sum(timing.answer == "planned" for timing in measured.requests)
    kept = "✓" if measured.slowest.median_s <= PLAN_S else "✗"
    target = f" (at most {1000 * PLAN_S:.0f} ms {kept})" if measured.trees <= PLAN_TREES else ""
    show.out.print(
        f"all {len(measured.requests)} requests ({planned} planned): median {1000 * measured.median_s:.1f} ms, slowest"
        f" {1000 * measured.slowest.median_s:.1f} ms{target}, worst {1000 * measured.worst_s:.0f} ms"
    )
    show.out.print(
        f"before: loading {measured.load_s:.1f} s, the first request of the process {1000 * measured.grammar_s:.0f} ms"
    )
    where = f"{on['machine']}, {on['cpu']}, {on['cores']} cores, load {on['load']}"
    show.out.print(f"{counted.capitalize()}, {repeats} repeats, measured on {where}; {on['software']}.")
