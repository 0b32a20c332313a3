"""``fieldhand plan``: a request becomes a Task, in words, on a map and as XML."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.options import (
    AnswerOption,
    AssumeOption,
    JsonOption,
    LangOption,
    LenientOption,
    PictureOption,
    PlannerOption,
    RobotOption,
    SiteOption,
    TranscriptOption,
)
from fieldhand.cli.outputs import to_file


def plan(
    request: Annotated[str, typer.Argument(help="What the robot should do, in plain words.")],
    site: SiteOption,
    robot: RobotOption = "husky",
    planner: PlannerOption = "auto",
    output: Annotated[
        Path | None, typer.Option("-o", "--output", callback=to_file, help="Where to write the Task (XML).")
    ] = None,
    picture: PictureOption = None,
    answer: AnswerOption = None,
    assume: AssumeOption = False,
    transcript: TranscriptOption = None,
    lenient: LenientOption = False,
    lang: LangOption = None,
    json: JsonOption = False,
) -> None:
    """Plan a request: what was understood, where, and what it will take."""
    import os

    from fieldhand import mission
    from fieldhand.cli import show
    from fieldhand.cli.asking import Replies, given_words, plan_and_ask
    from fieldhand.cli.inputs import open_ground, write_file
    from fieldhand.cli.pictures import draw_plan, draw_question
    from fieldhand.language import message, spoken
    from fieldhand.planning.planner import Planned
    from fieldhand.task.codec import encode

    language = spoken(lang, os.environ)
    ground = open_ground(site, robot, lenient=lenient, language=language)
    chosen = mission.make_planner(planner, os.environ, transcript)
    replies = Replies(
        given=tuple(answer or ()), assume=assume, ask=not json, progress=None if json else language, language=language
    )
    if picture is not None:
        replies = replace(replies, draw=lambda asked: draw_question(picture, asked, ground))
    request, outcome = plan_and_ask(given_words(request), ground, chosen, replies)
    if not isinstance(outcome, Planned):
        if json:
            show.print_json(show.outcome_record(outcome))
            raise SystemExit(2)
        show.fail_outcome(request, outcome, language)
    review = mission.review(outcome.task, ground.site, ground.robot)
    document = encode(outcome.task)
    if output is not None:
        write_file(output, document)
    if picture is not None:
        draw_plan(picture, review, ground, language)
    if json:
        record = show.outcome_record(outcome) | show.review_record(review, language) | {"xml": document.decode()}
        show.print_json(record)
    else:
        # Whoever approves is shown every line; here those that are the same in each plan say nothing new.
        show.show_review(review, language, usual=False)
        if output is not None:
            show.out.print(language.say(message("Task: {file}", file=str(output))))
        if picture is not None:
            show.out.print(language.say(message("Map: {file}", file=str(picture))))
    if review.errors:
        raise SystemExit(1)
