"""``fieldhand plan``: turn a request into a Task, and show it in words, on a map and as XML."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.earlier import StoredEarlierOptions
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import DisplayOptions, PictureOption, PlanningOptions, SiteAndRobotOptions
from fieldhand.cli.outputs import to_file


@grouped(
    "request site robot planner output picture answer assume transcript lenient"
    " missions count_simulated recount lang json"
)
def plan(
    request: Annotated[str, typer.Argument(help="What the robot should do, in plain words.")],
    place: SiteAndRobotOptions,
    planning: PlanningOptions,
    display: DisplayOptions,
    earlier: StoredEarlierOptions,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", callback=to_file, help="Where to write the Task (XML).")
    ] = None,
    picture: PictureOption = None,
) -> None:
    """Plan a request: what was understood, where, and what it will take."""
    import os

    from fieldhand import mission
    from fieldhand.cli import show
    from fieldhand.cli.asking import Replies, given_words, plan_and_ask
    from fieldhand.cli.earlier import add_earlier
    from fieldhand.cli.inputs import open_site_and_robot, write_file
    from fieldhand.cli.pictures import draw_question
    from fieldhand.language import message
    from fieldhand.planning.planner import Clarify, Planned
    from fieldhand.task.codec import encode

    language = display.language
    site_and_robot = open_site_and_robot(place.site, place.robot, lenient=place.lenient, language=language)
    planner = mission.make_planner(planning.planner, os.environ, planning.transcript)

    def draw(question: Clarify) -> None:
        if picture is not None:
            draw_question(picture, question, site_and_robot)

    replies = Replies.of(planning, display, draw)
    request, outcome = plan_and_ask(given_words(request), site_and_robot, planner, replies)
    if not isinstance(outcome, Planned):
        if display.json:
            show.print_json(show.outcome_record(outcome))
            raise SystemExit(2)
        show.fail_outcome(request, outcome, language)
    task, _ = add_earlier(outcome.task, None, site_and_robot, earlier, earlier.missions, display)
    review = mission.review(task, site_and_robot.site, site_and_robot.robot)
    document = encode(task)
    if output is not None:
        write_file(output, document)
    if picture is not None:
        review.save_map(picture, language=language.code)
    if display.json:
        record = show.outcome_record(outcome) | show.review_record(review, language) | {"xml": document.decode()}
        show.print_json(record)
    else:
        # Lines that are the same for every plan are only printed for approval.
        show.show_review(review, language, usual=False)
        if output is not None:
            show.out.print(language.say(message("Task: {file}", file=str(output))))
        if picture is not None:
            show.out.print(language.say(message("Map: {file}", file=str(picture))))
    if review.errors:
        raise SystemExit(1)
