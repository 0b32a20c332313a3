"""Plan a request: choose a planner, and turn words into a Task, a question or a refusal."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.errors import InputError, RequestError
from fieldhand.files import state_folder
from fieldhand.hidden_characters import find_hidden
from fieldhand.language import message
from fieldhand.planning.planner import Answer, Clarify, Planned, Planner, PlannerSettings, Refused
from fieldhand.plugins import active
from fieldhand.robot.model import RobotProfile
from fieldhand.short_repr import short_repr
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.site.model import Site
from fieldhand.task.earlier import uses_records, with_earlier

if TYPE_CHECKING:
    from fieldhand.planning.llm.chat import Chat


@dataclass(frozen=True, kw_only=True, repr=False)
class Plan(Planned):
    """A planned request, with the site and the robot it was planned for.

    Attributes:
        task: The Task: what is to be done, at which places, within which limits.
        planner: Name of the planner that understood the request.
        site, robot: Site and robot of the request.
    """

    site: Site
    robot: RobotProfile

    __repr__ = short_repr

    def _repr_html_(self) -> str:
        """Return map and read-back for a notebook."""
        from fieldhand.mission.notebook import html_of_review
        from fieldhand.mission.review_task import review

        return html_of_review(review(self.task, self.site, self.robot))


def make_planner(
    name: str,
    environ: Mapping[str, str],
    transcript: Path | None = None,
    *,
    watched: Callable[[Chat], Chat] = lambda chat: chat,
) -> Planner:
    """Return the planner of a name; a language model is configured from the environment.

    Args:
        name: ``auto``, ``english``, ``llm``, or the name of a plugin's planner.
        environ: Environment variables that configure the language model.
        transcript: File to which prompts and answers of the model are appended; else :func:`transcript_path`.
        watched: Wraps the connection to the model, for example to count its answers.

    Raises:
        InputError: There is no planner of that name.
        ModelError: ``llm`` was asked for and no model is configured, or one is configured wrongly.
        PluginError: The plugin that provides it cannot be imported.
    """
    plugins = active("fieldhand.planners")
    if name not in plugins:
        raise InputError(
            message("no planner '{name}'", name=name),
            where="--planner",
            advice=message("choose one of {planners}", planners=", ".join(plugins)),
        )
    factory = plugins[name].load()
    if not callable(factory):
        raise plugins[name].error("is not callable")
    settings = PlannerSettings(environ=environ, transcript=transcript or transcript_path(environ), watched=watched)
    made: Planner = factory(settings)
    return made


def transcript_path(environ: Mapping[str, str]) -> Path:
    """Return the default file of transcripts, in the user's state folder."""
    return state_folder(environ) / "transcripts.jsonl"


def plan(
    request: str,
    site: Site,
    robot: RobotProfile,
    planner: Planner | str = "auto",
    answers: Sequence[Answer] = (),
    *,
    earlier: EarlierMissions | Callable[[], EarlierMissions] | None = None,
) -> Plan | Clarify | Refused:
    """Turn a request into a Task, a question, or a refusal.

    Args:
        request: The request in plain words.
        site: Site that it is for.
        robot: Robot that it is for.
        planner: A planner, or the name of one; a language model is configured from the process's environment.
        answers: Answers to earlier questions about this request, in their order.
        earlier: What earlier missions did on the site (:func:`fh.earlier_missions
            <fieldhand.missions.earlier_missions.earlier_missions>`), or a function that returns it, which is called
            only if the plan depends on it. The Task then contains what it depends on.

    Raises:
        RequestError: The request is empty or too long, or contains an invisible character.
        InputError: There is no planner of that name.
        ModelError: A language model was needed and could not be used.
        TaskError: The plan depends on more earlier captures than a Task can contain.
    """
    _require_visible_words(request, answers)
    chosen = make_planner(planner, os.environ) if isinstance(planner, str) else planner
    # A planner that resolves places to check them then finds those of the records.
    known = site.with_earlier(earlier) if isinstance(earlier, EarlierMissions) else site
    outcome = chosen.plan(request, known, robot, tuple(answers))
    if isinstance(outcome, Planned):
        task = outcome.task
        if earlier is not None and uses_records(task):
            task = with_earlier(task, earlier() if callable(earlier) else earlier)
        return Plan(task=task, planner=outcome.planner, site=site, robot=robot)
    return outcome


def _require_visible_words(request: str, answers: Sequence[Answer]) -> None:
    if not request.strip():
        raise RequestError(
            message("the request is empty"), advice=message("say what the robot should do, and at which trees")
        )
    for what, text in ((message("request"), request), *((message("answer"), answer.answer) for answer in answers)):
        hidden = find_hidden(text, lines=True)
        if hidden is not None:
            where = message("the {what}, character {number}", what=what, number=hidden.at + 1)
            raise RequestError(
                message("the character {name} is invisible", name=hidden.name),
                where=where,
                advice=message("leave it out"),
            )
