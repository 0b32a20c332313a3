"""``fieldhand import``: convert a tree of BehaviorTree.CPP to a Task."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.options import JsonOption, LenientOption, RobotOption
from fieldhand.cli.outputs import to_file


def import_tree(
    tree: Annotated[Path, typer.Argument(help="A tree of BehaviorTree.CPP 4 (XML), made of this robot's actions.")],
    output: Annotated[Path, typer.Option("-o", "--output", callback=to_file, help="Where to write the Task (XML).")],
    robot: RobotOption = "husky",
    site: Annotated[str | None, typer.Option("--site", help="Check the Task on this site, too.")] = None,
    request: Annotated[str, typer.Option("--request", help="The request, if the tree does not contain it.")] = "",
    lenient: LenientOption = False,
    json: JsonOption = False,
) -> None:
    """Read a tree as a Task; with --site exit status 1 if anything forbids its approval."""
    from fieldhand import mission
    from fieldhand.cli import show
    from fieldhand.cli.inputs import open_site_and_robot, write_file
    from fieldhand.errors import TaskError
    from fieldhand.exchange.btcpp import read_tree
    from fieldhand.robot.capabilities import capabilities_of
    from fieldhand.robot.loader import load_robot
    from fieldhand.task.codec import encode
    from fieldhand.task.codec_xml import read_xml
    from fieldhand.task.frames import Resource
    from fieldhand.task.references import references
    from fieldhand.task.schema import require_valid

    site_and_robot = None if site is None else open_site_and_robot(site, robot, lenient=lenient)
    profile = load_robot(robot) if site_and_robot is None else site_and_robot.robot
    capabilities = capabilities_of(profile)
    resources = [Resource(kind="robot", name=profile.name, sha256=profile.sha256)]
    if site_and_robot is not None:
        resources.append(Resource(kind="site", name=site_and_robot.site.name, sha256=site_and_robot.site.sha256))
    data = read_xml(tree)
    task = read_tree(data, capabilities, request=request, resources=tuple(resources), source=str(tree))
    document = encode(task)
    require_valid(document, capabilities, source=str(tree))
    problems = references(task, capabilities)
    if problems:
        raise TaskError("; ".join(problems), where=str(tree), advice="correct the tree")
    write_file(output, document)
    review = None if site_and_robot is None else mission.review(task, site_and_robot.site, profile, document=document)
    if json:
        record = {"task": task.id, "file": str(output)}
        show.print_json(record if review is None else record | show.review_record(review))
    else:
        if review is not None:
            show.show_review(review)
        show.out.print(f"Task: {output}")
    if review is not None and review.errors:
        raise SystemExit(1)
