"""The forecast of a Task in a terminal: a line for each branch, the worst first."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.table import Table

from fieldhand.cli import show
from fieldhand.cli.console import Words
from fieldhand.clock import clock_time

if TYPE_CHECKING:
    from fieldhand.forecast.estimate import BranchEstimate
    from fieldhand.mission import Review
    from fieldhand.robot.model import RobotProfile

#: Branches beside the worst that are shown.
_MOST = 9
_COVERAGE = {
    "enumerated": "{count} branches, all there are",
    "bounded": "{count} branches; of conditions that only decide work on the spot the extremes, of all others each",
    "sampled": "{count} branches of more than could be looked at: the extremes, and others by chance",
}


def show_forecast(review: Review, robot: RobotProfile) -> None:
    """The distributions of every branch, half of the missions below the first figure and nine in ten below the second.

    Args:
        review: With its estimate; nothing is shown without.
        robot: For the words of conditions.
    """
    from fieldhand.approval.paths import say_branch

    forecast = review.estimate
    if forecast is None:
        return
    show.heading("Forecast")
    worst = forecast.worst
    others = sorted((b for b in forecast.branches if b is not worst), key=lambda b: (-b.short, -b.seconds.mean))
    shown = (worst, *others[:_MOST], *forecast.faulted)
    table = Table(box=None, pad_edge=False, header_style="dim", show_edge=False)
    for name in ("", "metres p50", "p90", "time p50", "p90", "left p50", "p90", "short of"):
        table.add_column(name, justify="left" if name == "short of" else "right", no_wrap=True)
    for number, branch in enumerate(shown, start=1):
        table.add_row(f"{number}", *_figures(branch))
    show.out.print(table)
    for number, branch in enumerate(shown, start=1):
        words = say_branch(branch, review.task, robot)
        show.out.print(Words(f"  {number}: {words}" if number > 1 else f"  1, the worst: {words}"))
    if len(others) > _MOST:
        show.out.print(Words(f"and {len(others) - _MOST} more branches; --json has them all", style="dim"))
    count = str(len(forecast.branches))
    said = "1 branch, the only one" if count == "1" else _COVERAGE[forecast.explored.coverage].format(count=count)
    draws = worst.chances[-1].draws
    show.out.print(Words(f"{said}; {draws:,} missions drawn along each. Time is in minutes and seconds.", style="dim"))
    exits = forecast.exits
    if exits.looked_at:
        some = "each" if exits.looked_at == exits.places else f"{exits.looked_at}"
        show.out.print(Words(f"Ways home after a fault: driven from {some} of {exits.places} places.", style="dim"))


def _figures(branch: BranchEstimate) -> tuple[str, ...]:
    metres, seconds = branch.metres, branch.seconds
    shares = [f"{_NAMES[c.kind]} {_share(c.chance)}" for c in branch.chances]
    return (
        f"{metres.p50:.0f}",
        f"{metres.p90:.0f}",
        clock_time(seconds.p50),
        clock_time(seconds.p90),
        f"{branch.left[0]:.1f} %",
        f"{branch.left[1]:.1f} %",
        ", ".join(shares),
    )


_NAMES = {"distance_m": "distance", "duration_s": "time", "energy_percent": "energy", "reserve": "reserve"}


def _share(chance: float) -> str:
    if chance == 0.0:
        return "0 %"
    return f"{100 * chance:.1f} %" if chance >= 0.001 else "< 0.1 %"
