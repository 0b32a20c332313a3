"""The forecast of a Task as a table: a row for each branch, the worst first."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.table import Table

from fieldhand.cli import show
from fieldhand.cli.console import Words
from fieldhand.clock import clock_time
from fieldhand.language import ENGLISH, Language, Number, counted, joined, message

if TYPE_CHECKING:
    from fieldhand.forecast.estimate import BranchEstimate, Estimate
    from fieldhand.mission import Review
    from fieldhand.robot.model import RobotProfile

#: Number of branches that are shown beside the worst.
_MOST = 9


def show_forecast(review: Review, robot: RobotProfile, language: Language = ENGLISH) -> None:
    """Print median and 90 % quantile of distance, time and remaining charge for each branch.

    Args:
        review: Review with an estimate; without one, nothing is printed.
        robot: Robot, for the words of conditions.
        language: Language of the table.
    """
    from fieldhand.wording.branches import say_branch

    forecast = review.estimate
    if forecast is None:
        return
    say = language.say
    show.heading(say(message("Forecast")))
    worst = forecast.worst
    others = sorted((b for b in forecast.branches if b is not worst), key=lambda b: (-b.short, -b.seconds.mean))
    shown = (worst, *others[:_MOST], *forecast.faulted)
    table = Table(box=None, pad_edge=False, header_style="dim", show_edge=False)
    for name in ("", message("metres p50"), "p90", message("time p50"), "p90", message("left p50"), "p90"):
        table.add_column(say(name), justify="right", no_wrap=True)
    table.add_column(say(message("short of")), justify="left", no_wrap=True)
    for number, branch in enumerate(shown, start=1):
        table.add_row(f"{number}", *map(say, _figures(branch)))
    show.out.print(table)
    for number, branch in enumerate(shown, start=1):
        words = say_branch(branch, review.task, robot)
        named = message("1, the worst: {branch}", branch=words) if number == 1 else joined(": ", (str(number), words))
        show.out.print(Words(f"  {say(named)}"))
    if len(others) > _MOST:
        more = counted(
            "and {count} more branch; --json has them all",
            "and {count} more branches; --json has them all",
            len(others) - _MOST,
        )
        show.out.print(Words(say(more), style="dim"))
    drawn = message(
        "{branches}; {count} missions drawn along each. Time is in minutes and seconds.",
        branches=_covered(forecast),
        count=Number(f"{worst.chances[-1].draws:,}"),
    )
    show.out.print(Words(say(drawn), style="dim"))
    exits = forecast.exits
    if exits.looked_at:
        ways = message("Ways home after a fault: driven from each of {places} places.", places=exits.places)
        if exits.looked_at != exits.places:
            ways = message(
                "Ways home after a fault: driven from {count} of {places} places.",
                count=exits.looked_at,
                places=exits.places,
            )
        show.out.print(Words(say(ways), style="dim"))


def _covered(forecast: Estimate) -> str:
    """Return the number of branches that were examined, and their selection, in words."""
    count = len(forecast.branches)
    if count == 1:
        return message("1 branch, the only one")
    match forecast.explored.coverage:
        case "enumerated":
            return message("{count} branches, all there are", count=count)
        case "bounded":
            return message(
                "{count} branches: all outcomes of the conditions, but only the extremes of those that decide only"
                " work on the spot",
                count=count,
            )
        case "sampled":
            return message(
                "{count} branches out of more than could be examined: the extremes, and others at random", count=count
            )


def _figures(branch: BranchEstimate) -> tuple[str, ...]:
    metres, seconds = branch.metres, branch.seconds
    shares = [joined(" ", (_NAMES[c.kind], _share(c.chance))) for c in branch.chances]
    return (
        f"{metres.p50:.0f}",
        f"{metres.p90:.0f}",
        clock_time(seconds.p50),
        clock_time(seconds.p90),
        Number(f"{branch.left[0]:.1f} %"),
        Number(f"{branch.left[1]:.1f} %"),
        joined(", ", shares),
    )


_NAMES: dict[str, str] = {
    "distance_m": message("distance"),
    "duration_s": message("time"),
    "energy_percent": message("energy"),
    "reserve": message("reserve"),
}


def _share(chance: float) -> str:
    if chance == 0.0:
        return "0 %"
    return Number(f"{100 * chance:.1f} %" if chance >= 0.001 else "< 0.1 %")
