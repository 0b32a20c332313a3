"""``fieldhand bench site``: measure loading, selectors and drives on an orchard of a given size."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.options import CpuTimeOption, JsonOption, RobotOption, SeedOption

if TYPE_CHECKING:
    from rich.table import Table

    from fieldhand_bench.site import SiteBenchmark, Timing

#: Targets for a site of 100,000 trees: load, selector and drive in seconds, peak memory in bytes.
LOAD_S, SELECTOR_S, DRIVE_S, PEAK_BYTES = 5.0, 0.05, 0.01, 10**9
_SLOWEST = 5


def bench_site(
    trees: Annotated[int, typer.Option("--trees", min=20, max=1_000_000, help="Number of trees.")] = 10_000,
    repeats: Annotated[int, typer.Option("--repeats", min=1, max=100, help="Repeats of each measurement.")] = 5,
    robot: RobotOption = "husky",
    seed: SeedOption = 1,
    cpu_time: CpuTimeOption = False,
    json: JsonOption = False,
) -> None:
    """Generate an orchard and measure loading it, rows, drivable graph, every selector, drives and peak memory."""
    import time
    from dataclasses import asdict

    from fieldhand.cli import show
    from fieldhand.robot.loader import load_robot
    from fieldhand_bench.commands.machine import machine
    from fieldhand_bench.site import measure_site

    profile = load_robot(robot)
    on = machine()
    if not json:
        show.note(f"measuring {trees:,} trees, {repeats} times; {on['machine']}, {on['cpu']}, load {on['load']}")
    measured = measure_site(
        trees,
        seed=seed,
        repeats=repeats,
        clearance_m=profile.width_m / 2,
        standoff_m=profile.standoff_m,
        clock=time.process_time if cpu_time else time.perf_counter,
    )
    counted = "processor time" if cpu_time else "wall-clock time"
    if json:
        show.print_json({"machine": on, "robot": profile.name, "time": counted} | asdict(measured))
        return
    show.out.print(_table(measured))
    where = f"{on['machine']}, {on['cpu']}, {on['cores']} cores, load {on['load']}"
    show.out.print(f"{counted.capitalize()} measured on {where}; {on['software']}.")


def _table(measured: SiteBenchmark) -> Table:
    from rich.table import Table

    blocks = f"{measured.blocks} block{'s' * (measured.blocks != 1)}"
    title = f"{measured.trees:,} trees in {measured.rows:,} rows, {blocks}, file {measured.file_bytes / 1e6:.1f} MB"
    table = Table(title=title, title_justify="left")
    for head in ("", "median", "worst", "target"):
        table.add_column(head, justify="left" if head == "" else "right")
    for step in measured.steps:
        target = LOAD_S if step is measured.load else None
        table.add_row(step.name, _seconds(step.median_s), _seconds(step.worst_s), _target(step.median_s, target))
    table.add_section()
    slowest = sorted(measured.selectors, key=lambda t: -t.median_s)
    for selector in slowest[:_SLOWEST]:
        table.add_row(
            f"selector: {selector.name}",
            _seconds(selector.median_s),
            _seconds(_slowest_of(selector)),
            _target(selector.median_s, SELECTOR_S),
        )
    rest = slowest[_SLOWEST:]
    if rest:
        table.add_row(
            f"the other {len(rest)} selectors", f"<= {_seconds(rest[0].median_s)}",
            _seconds(max(map(_slowest_of, rest))), _target(rest[0].median_s, SELECTOR_S),
        )  # fmt: skip
    table.add_section()
    drives = measured.drives
    table.add_row(
        drives.name, _seconds(drives.median_s), _seconds(_slowest_of(drives)), _target(_slowest_of(drives), DRIVE_S)
    )
    if measured.unreachable:
        table.add_row("  of these, pairs with no way", str(measured.unreachable), "", "")
    if measured.peak_bytes is not None:
        table.add_row(
            "peak memory of loading",
            f"{measured.peak_bytes / 1e6:.0f} MB",
            "",
            _target(measured.peak_bytes, PEAK_BYTES),
        )
    return table


def _slowest_of(timing: Timing) -> float:
    """Return the longest duration, the first included, since a user waits for that one, too."""
    return max(timing.worst_s, timing.first_s)


def _seconds(seconds: float) -> str:
    return f"{seconds:.2f} s" if seconds >= 1.0 else f"{seconds * 1000:.1f} ms"


def _target(value: float, most: float | None) -> str:
    """Return the target for 100,000 trees, marked as met or missed; an empty text without a target."""
    if most is None:
        return ""
    text = f"{most / 1e9:.0f} GB" if most is PEAK_BYTES else _seconds(most)
    return f"{text} {'✓' if value <= most else '✗'}"
