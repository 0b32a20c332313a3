"""The command group ``fieldhand bench``. Its commands import the benchmarks only when they run."""

from __future__ import annotations

import typer

from fieldhand_bench.commands.coverage import bench_coverage
from fieldhand_bench.commands.forecast import bench_forecast
from fieldhand_bench.commands.guard import bench_guard
from fieldhand_bench.commands.missions import bench_missions
from fieldhand_bench.commands.orienteering import bench_orienteering
from fieldhand_bench.commands.planning import bench_planning
from fieldhand_bench.commands.recharge import bench_recharge
from fieldhand_bench.commands.site import bench_site

bench = typer.Typer(
    name="bench", help="Measure how fast Fieldhand is on this machine, and how well it does.", no_args_is_help=True
)
bench.command("site")(bench_site)
bench.command("orienteering")(bench_orienteering)
bench.command("guard")(bench_guard)
bench.command("forecast")(bench_forecast)
bench.command("recharge")(bench_recharge)
bench.command("missions")(bench_missions)
bench.command("planning")(bench_planning)
bench.command("coverage")(bench_coverage)
