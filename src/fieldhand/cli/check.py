"""``fieldhand check``: every check on a Task document, each problem on its own line."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.options import JsonOption, LenientOption, PictureOption, RobotOption, SiteOption


def check(
    task: Annotated[Path, typer.Argument(help="A Task document (XML).")],
    site: SiteOption,
    robot: RobotOption = "husky",
    picture: PictureOption = None,
    lenient: LenientOption = False,
    json: JsonOption = False,
) -> None:
    """Check a Task against a site and a robot; exit status 1 if anything forbids approval."""
    from fieldhand import mission
    from fieldhand.cli import show
    from fieldhand.cli.inputs import open_ground

    ground = open_ground(site, robot, lenient=lenient)
    read, document = mission.read_task(task, ground.robot)
    review = mission.review(read, ground.site, ground.robot, document=document)
    if picture is not None:
        from fieldhand.cli.pictures import draw_plan

        draw_plan(picture, review, ground)
    if json:
        show.print_json(show.review_record(review))
    else:
        show.show_review(review)
        show.out.print()
        show.out.print(_verdict(len(review.errors), len(review.warnings)))
    if review.errors:
        raise SystemExit(1)


def _verdict(errors: int, warnings: int) -> str:
    if errors:
        return f"Not ready: {errors} error{'s' if errors > 1 else ''}."
    if warnings:
        return f"Ready for approval once {'the warning is' if warnings == 1 else f'{warnings} warnings are'} confirmed."
    return "Ready for approval."
