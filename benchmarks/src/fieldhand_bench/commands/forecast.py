"""``fieldhand bench forecast``: simulate one request many times and compare the results with its forecast."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.options import JsonOption, MissionSiteOption, RobotOption, SeedOption

if TYPE_CHECKING:
    from fieldhand_bench.repeated import Compared, Mission


def bench_forecast(
    request: Annotated[str, typer.Argument(help="What the robot should do, in plain words, or a Task (.xml).")],
    site: MissionSiteOption = None,
    made: Annotated[
        str | None, typer.Option("--made", help="Use a generated site instead: straight:2000, curved:5000.")
    ] = None,
    robot: RobotOption = "husky",
    missions: Annotated[int, typer.Option("--missions", min=1, help="Number of missions to simulate.")] = 28,
    seed: SeedOption = 1,
    jobs: Annotated[int, typer.Option("--jobs", help="Number of processes; -1 for one per processor.")] = 1,
    json: JsonOption = False,
) -> None:
    """Plan a request once, simulate it with many seeds, and compare the results with forecast and accepted risk."""
    from dataclasses import asdict

    from fieldhand.cli import show
    from fieldhand.cli.asking import Replies, plan_or_read
    from fieldhand.cli.bundles import require_site
    from fieldhand.cli.inputs import open_site_and_robot
    from fieldhand.errors import InputError
    from fieldhand.mission.documents import SiteAndRobot
    from fieldhand.robot.loader import load_robot
    from fieldhand_bench.commands.machine import machine
    from fieldhand_bench.repeated import compare
    from fieldhand_bench.scenes import made_block

    if made is None:
        site_and_robot = open_site_and_robot(require_site(site), robot)
    else:
        kind, _, trees = made.partition(":")
        if not (trees.isdecimal() and 20 <= int(trees) <= 20_000):
            raise InputError(f"'{made}' is no generated site", where="--made", advice="give straight:2000, for one")
        site_and_robot = SiteAndRobot(site=made_block(kind, int(trees)), robot=load_robot(robot))
    task, _, _ = plan_or_read(request, site_and_robot, "english", None, Replies(given=(), assume=True, ask=False))
    flown: list[Mission] = []

    def tell(one: Mission) -> None:
        flown.append(one)
        if not json:
            over = f", exceeded {', '.join(one.exceeded)}" if one.exceeded else ""
            show.out.print(f"seed {one.seed}: {one.visits} visits, {one.metres:.1f} m, {one.seconds:.0f} s{over}")

    on = machine()
    comparison = compare(
        task, site_and_robot.site, site_and_robot.robot, range(seed, seed + missions), jobs=jobs, tell=tell
    )
    if json:
        each = [asdict(one) for one in flown]
        show.print_json(
            {"machine": on, "kept": comparison.is_kept, "agrees": comparison.agrees}
            | asdict(comparison)
            | {"each": each}
        )
    else:
        _show(comparison)
        where = f"{on['machine']}, {on['cpu']}, {on['cores']} cores, load {on['load']}"
        show.out.print(f"Processor time measured on {where}; {on['software']}.")
    raise SystemExit(0 if comparison.is_kept and comparison.agrees else 1)


def _show(comparison: Compared) -> None:
    from fieldhand.cli import show

    low, high = comparison.interval
    for warning in comparison.warnings:
        show.out.print(f"warning: {warning}")
    show.out.print(
        f"exceeded: {comparison.failures} of {comparison.missions} = {comparison.failures / comparison.missions:.1%}"
        f" ({low:.1%} to {high:.1%}); forecast {comparison.forecast:.1%}, accepted {comparison.accepted:.1%}"
    )
    show.out.print(
        f"visits: {comparison.visits:.1f} on average (standard deviation {comparison.visits_spread:.1f}), forecast"
        f" {comparison.visits_forecast:.1f}; {comparison.kept:.1f} counting those of missions within the limits alone"
    )
    for name, median, high_part in comparison.within:
        show.out.print(f"{name}: {median:.0%} of the missions within the forecast median, {high_part:.0%} within p90")
    show.out.print(f"checks and forecast {comparison.review_s:.1f} s, a mission {comparison.mission_s:.1f} s")
    kept = "kept" if comparison.is_kept else "exceeded more often than accepted"
    agrees = "agrees" if comparison.agrees else "does not agree"
    show.out.print(f"The limits were {kept}; the forecast {agrees} with what happened.")
