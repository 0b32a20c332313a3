"""Pictures of plans and questions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.cli.show import note
from fieldhand.errors import NotApprovedError
from fieldhand.language import ENGLISH, Language
from fieldhand.mission import Review

if TYPE_CHECKING:
    from fieldhand.mission.documents import SiteAndRobot
    from fieldhand.planning.planner import Clarify


def draw_plan(path: Path, review: Review, site_and_robot: SiteAndRobot, language: Language = ENGLISH) -> None:
    """Draw the map of a planned mission.

    Raises:
        NotApprovedError: The mission cannot be forecast; the error names its problems.
        OutputError: The file cannot be written.
    """
    if review.estimate is None:
        problems = "; ".join(language.say(p.line()) for p in review.errors)
        raise NotApprovedError(f"there is no map of a mission that cannot be driven: {problems}", where=str(path))
    from fieldhand.approval.preview import save_map

    save_map(review.task, site_and_robot.site, site_and_robot.robot, review.estimate, path, language)


def draw_question(path: Path, asked: Clarify, site_and_robot: SiteAndRobot) -> None:
    """Draw the map of a question, if its choices are places.

    Raises:
        OutputError: The file cannot be written.
    """
    if asked.places:
        from fieldhand.site.drawing import save_choices_picture

        save_choices_picture(site_and_robot.site, asked.question, asked.choices, asked.places, path)
        note(f"the choices are drawn in {path}")
