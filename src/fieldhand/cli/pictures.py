"""Pictures of questions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.cli.show import note

if TYPE_CHECKING:
    from fieldhand.mission.documents import SiteAndRobot
    from fieldhand.planning.planner import Clarify


def draw_question(path: Path, asked: Clarify, site_and_robot: SiteAndRobot) -> None:
    """Draw the map of a question, if its choices are places.

    Raises:
        OutputError: The file cannot be written.
    """
    if asked.places:
        from fieldhand.site.drawing import save_choices_picture

        save_choices_picture(site_and_robot.site, asked.question, asked.choices, asked.places, path)
        note(f"the choices are drawn in {path}")
