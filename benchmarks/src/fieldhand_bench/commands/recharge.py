"""``fieldhand bench recharge``: simulate random missions that recharge, and compare them with their forecasts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.options import JsonOption, SeedOption

if TYPE_CHECKING:
    from fieldhand_bench.recharged import RechargedSummary, RechargedTrial


def bench_recharge(
    missions: Annotated[int, typer.Option("--missions", min=1, help="Number of missions to simulate.")] = 500,
    seed: SeedOption = 0,
    jobs: Annotated[int, typer.Option("--jobs", help="Number of processes; -1 for one per processor.")] = -1,
    json: JsonOption = False,
) -> None:
    """Simulate random missions that charge on the way: none may be stranded, and the forecast p90 must hold."""
    from dataclasses import asdict

    from fieldhand.cli import show
    from fieldhand_bench.commands.machine import machine
    from fieldhand_bench.recharged import fly_all_recharged, summarize_recharged

    on = machine()
    trials: list[RechargedTrial] = []
    for trial in fly_all_recharged(range(seed, seed + missions), jobs=jobs):
        trials.append(trial)
        if len(trials) % 50 == 0:
            show.note(f"{len(trials)} of {missions} missions flown")
    summary = summarize_recharged(trials)
    if json:
        show.print_json(
            {"machine": on, "seed": seed, "passed": summary.passed, "summary": asdict(summary)}
            | {"missions": [asdict(trial) for trial in trials]}
        )
    else:
        _show(summary)
        where = f"{on['machine']}, {on['cpu']}, {on['cores']} cores, load {on['load']}"
        show.out.print(f"{missions} missions, seed {seed}; {where}; {on['software']}.")
    raise SystemExit(0 if summary.passed else 1)


def _show(summary: RechargedSummary) -> None:
    from fieldhand.cli import show

    ends = ", ".join(f"{count} {status}" for status, count in summary.statuses.items())
    show.out.print(f"{summary.missions} missions: {ends}")
    show.out.print(f"{summary.charged} charged, {summary.charges} times in all")
    stranded = f": seeds {', '.join(map(str, summary.stranded))}" if summary.stranded else ""
    show.out.print(f"stranded: {len(summary.stranded)}{stranded}")
    for name, share in zip(("time", "distance", "energy"), summary.within, strict=True):
        show.out.print(f"{name}: {share:.1%} of {summary.compared} missions within the forecast p90")
