"""``fieldhand check``: check a Task document, and print each problem and the forecast of each branch."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.earlier import StoredEarlierOptions, add_earlier
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import DisplayOptions, PictureOption, SiteAndRobotOptions


@grouped("task site robot picture lenient charge missions count_simulated recount lang json")
def check(
    task: Annotated[Path, typer.Argument(help="A Task document (XML).")],
    place: SiteAndRobotOptions,
    display: DisplayOptions,
    earlier: StoredEarlierOptions,
    picture: PictureOption = None,
    charge: Annotated[
        float, typer.Option("--charge", min=0.0, max=100.0, metavar="<%>", help="Charge at the start, in percent.")
    ] = 100.0,
) -> None:
    """Check a Task against a site and a robot; exit status 1 if anything forbids approval."""
    from fieldhand import mission
    from fieldhand.cli import show
    from fieldhand.cli.forecast_table import show_forecast
    from fieldhand.cli.inputs import open_site_and_robot

    language = display.language
    site_and_robot = open_site_and_robot(place.site, place.robot, lenient=place.lenient, language=language)
    read, document = mission.read_task(task, site_and_robot.robot)
    completed = add_earlier(read, document, site_and_robot, earlier, earlier.missions, display)
    review = mission.review(
        completed[0], site_and_robot.site, site_and_robot.robot, document=completed[1], charge_percent=charge
    )
    if picture is not None:
        review.save_map(picture, language=language.code)
    if display.json:
        show.print_json(show.review_record(review, language, every=True))
    else:
        show.show_review(review, language)
        show_forecast(review, site_and_robot.robot, language)
        show.out.print()
        show.out.print(language.say(_verdict(len(review.errors), len(review.warnings))))
    if review.errors:
        raise SystemExit(1)


def _verdict(errors: int, warnings: int) -> str:
    from fieldhand.language import counted, message

    if errors:
        return counted("Not ready: {count} error.", "Not ready: {count} errors.", errors)
    if warnings:
        return counted(
            "Ready for approval once the warning is confirmed.",
            "Ready for approval once {count} warnings are confirmed.",
            warnings,
        )
    return message("Ready for approval.")
