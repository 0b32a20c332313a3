"""``fieldhand import``: convert a tree of BehaviorTree.CPP to a Task."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import JsonOption, MissionInputOptions
from fieldhand.cli.outputs import to_file


@dataclass(frozen=True, kw_only=True)
class ImportOptions(MissionInputOptions):
    """Site to check an imported Task on, and its robot."""

    site: Annotated[str | None, typer.Option("--site", help="Check the Task on this site, too.")] = None


@grouped("tree output robot site request lenient json")
def import_tree(
    inputs: ImportOptions,
    tree: Annotated[Path, typer.Argument(help="A tree of BehaviorTree.CPP 4 (XML), made of this robot's actions.")],
    output: Annotated[Path, typer.Option("-o", "--output", callback=to_file, help="Where to write the Task (XML).")],
    request: Annotated[str, typer.Option("--request", help="The request, if the tree does not contain it.")] = "",
    json: JsonOption = False,
) -> None:
    """Read a tree as a Task; with --site exit status 1 if anything forbids its approval."""
    from fieldhand import mission
    from fieldhand.cli import show
    from fieldhand.cli.inputs import note_left_out, write_file
    from fieldhand.robot.loader import load_robot
    from fieldhand.site.loader import open_site
    from fieldhand.task.codec_xml import read_xml

    robot = load_robot(inputs.robot or "husky")
    site = None if inputs.site is None else open_site(inputs.site, lenient=inputs.lenient)
    if site is not None:
        note_left_out(site, lenient=inputs.lenient)
    task, document = mission.import_tree(read_xml(tree), robot, site=site, request=request, source=str(tree))
    write_file(output, document)
    review = None if site is None else mission.review(task, site, robot, document=document)
    if json:
        record = {"task": task.id, "file": str(output)}
        show.print_json(record if review is None else record | show.review_record(review))
    else:
        if review is not None:
            show.show_review(review)
        show.out.print(f"Task: {output}")
    if review is not None and review.errors:
        raise SystemExit(1)
