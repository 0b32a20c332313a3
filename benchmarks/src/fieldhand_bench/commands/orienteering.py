"""``fieldhand bench orienteering``: repeat the published experiment on stochastic orienteering."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import JsonOption, SeedOption
from fieldhand.cli.outputs import to_picture

if TYPE_CHECKING:
    from rich.table import Table

    from fieldhand_bench.orienteering.certain import RouteResult
    from fieldhand_bench.orienteering.run import SolverResult


def bench_orienteering(
    graphs: Annotated[Path, typer.Option("--graphs", help="Folder of graphs (JSON), or one graph.")],
    budget: Annotated[list[float] | None, typer.Option("--budget", help="Budget (default 2); may be repeated.")] = None,
    pf: Annotated[
        list[float] | None, typer.Option("--pf", help="Accepted failure probability (default 0.1); may be repeated.")
    ] = None,
    trials: Annotated[int, typer.Option("--trials", min=1, help="Missions per graph and solver.")] = 1000,
    solvers: Annotated[
        str,
        typer.Option(
            "--solvers",
            help="Comma-separated list of online, fixed, greedy, mcts, milp, perfect (a bound) and plugin solvers.",
        ),
    ] = "online,fixed,greedy",
    milp_time: Annotated[float, typer.Option("--milp-time", min=0.1, help="Time limit of the MILP in seconds.")] = 60.0,
    daring: Annotated[
        float,
        typer.Option(
            "--daring", min=0.0, max=1.0, help="From 0, best over all missions, to 1, best over successful ones."
        ),
    ] = 0.6,
    learn: Annotated[
        int,
        typer.Option("--learn", min=0, help="Number of missions from which 'online' learns its price of a failure."),
    ] = 400,
    certain: Annotated[
        float,
        typer.Option("--certain", min=0.0, help="Also compare with PyVRP on certain costs, with so many seconds each."),
    ] = 0.0,
    plot: Annotated[
        Path | None, typer.Option("--plot", callback=to_picture, help="Plot reward against failures to this file.")
    ] = None,
    engine: Annotated[str, typer.Option("--engine", help="local, or dask://HOST:PORT of a scheduler.")] = "local",
    jobs: Annotated[int, typer.Option("--jobs", help="Number of processes; -1 for one per processor.")] = -1,
    seed: SeedOption = 0,
    json: JsonOption = False,
) -> None:
    """Simulate missions with every solver on every graph; print rewards, failures and decision times."""
    from dataclasses import asdict

    from fieldhand.cli import show
    from fieldhand.errors import ProblemError
    from fieldhand_bench.commands.machine import machine
    from fieldhand_bench.orienteering.graphs import load_graphs
    from fieldhand_bench.orienteering.run import run
    from fieldhand_bench.orienteering.solvers import Options, solver_names

    names = [name.strip() for name in solvers.split(",") if name.strip()]
    known = (*solver_names(), "perfect")
    unknown = [name for name in names if name not in known]
    if unknown or not names:
        raise ProblemError(f"no solver is called '{', '.join(unknown)}'", advice=f"use some of {', '.join(known)}")
    loaded = load_graphs(graphs)
    options = Options(seed=seed, milp_s=milp_time, daring=daring, missions=learn)
    on = machine()
    rows: list[SolverResult] = []
    compared: list[dict[str, Any]] = []
    for b in budget or [2.0]:
        for p in pf or [0.1]:
            for row in run(
                loaded, budget=b, failure_probability=p, trials=trials, solvers=names, options=options,
                engine=engine, jobs=jobs,
            ):  # fmt: skip
                rows.append(row)
                show.note(f"{row.graph}, budget {b:g}, Pf {p:g}, {row.solver}: done")
        if certain > 0.0:
            compared += _compared(loaded, b, seed, certain)
    if json:
        show.print_json(
            {"machine": on, "seed": seed, "rows": [asdict(r) for r in rows], "published": _published(rows),
             "certain": compared}
        )  # fmt: skip
    else:
        _show(rows, compared, trials, certain, on)
    # Last, so that the figures are printed even if the plot cannot be written.
    if plot is not None:
        from fieldhand_bench.orienteering.plot import plot as draw

        draw(rows, plot)


def _show(
    rows: Sequence[SolverResult], compared: Sequence[dict[str, Any]], trials: int, certain: float, on: dict[str, Any]
) -> None:
    """Print the tables, the meaning of their columns, and the machine they were measured on."""
    from fieldhand.cli import show

    for setting in dict.fromkeys((row.graph, row.budget, row.failure_probability) for row in rows):
        show.out.print(_table([r for r in rows if (r.graph, r.budget, r.failure_probability) == setting]))
    show.out.print_lines(
        "R: mean reward of the missions within budget; R all: of all missions, a failed one counts 0;",
        "ms, p99: median and 99th percentile of a decision; *: published.",
    )
    for line in compared:
        ours, other = line["solvers"]
        show.out.print(
            f"{line['graph']}, budget {line['budget']:g}, no chance: {ours['solver']} {ours['reward']:.3f}, "
            f"{other['solver']} {other['reward']:.3f}, {certain:g} s each"
        )
    show.out.print(f"{trials:,} missions a row, on {on['machine']}, {on['cpu']}, load {on['load']}; {on['software']}.")


def _compared(graphs: Sequence[Any], budget: float, seed: int, seconds: float) -> list[dict[str, Any]]:
    from dataclasses import asdict

    from fieldhand_bench.orienteering.certain import compare

    def one(graph: Any) -> dict[str, Any]:
        found: tuple[RouteResult, RouteResult] = compare(graph.problem(budget, 0.1), seed, seconds)
        return {"graph": graph.name, "budget": budget, "solvers": [asdict(c) for c in found]}

    return [one(graph) for graph in graphs]


def _published(rows: Sequence[SolverResult]) -> list[dict[str, Any]]:
    from dataclasses import asdict

    from fieldhand_bench.orienteering.published import published_for

    settings = dict.fromkeys((row.graph, row.budget, row.failure_probability) for row in rows)
    return [asdict(found) for setting in settings for found in published_for(*setting)]


def _table(rows: Sequence[SolverResult]) -> Table:
    """Return a table of one graph's rows with the published rows below, narrow enough for 80 columns."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    from fieldhand_bench.orienteering.published import published_for

    first = rows[0]
    setting = (first.graph, first.budget, first.failure_probability)
    title = f"{first.graph}, budget {first.budget:g}, failures accepted {first.failure_probability:.0%}"
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for head in ("solver", "R", "R all", "failed %", "ms", "p99", "plan s", "MB"):
        table.add_column(head, justify="left" if head == "solver" else "right", no_wrap=True)
    for row in rows:
        half = (row.reward_interval[1] - row.reward_interval[0]) / 2
        low, high = row.failures_interval
        table.add_row(
            row.solver, f"{row.reward:.3f}±{half:.3f}", f"{row.reward_over_all:.3f}",
            f"{100 * row.failures:.1f} ({100 * low:.0f}-{100 * high:.0f})", f"{row.median_ms:.2f}",
            f"{row.p99_ms:.1f}", f"{row.plan_s:.1f}", f"{row.peak_mb:.0f}",
        )  # fmt: skip
    for other in published_for(*setting):
        table.add_row(f"{other.solver}*", f"{other.reward:.3f}", "", f"{100 * other.failures:.0f}", "", "", "", "")
    return table
