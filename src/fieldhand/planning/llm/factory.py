"""Create the planner that uses a language model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.planning.planner import Planner, PlannerSettings

if TYPE_CHECKING:
    from fieldhand.planning.llm.settings import LlmSettings


def make_llm_planner(settings: PlannerSettings) -> Planner:
    """Return a planner for the language model configured in the environment.

    Raises:
        ModelError: No model is configured, or its configuration is invalid.
    """
    from fieldhand.planning.llm.settings import require_settings

    return planner_with(require_settings(settings.environ), settings)


def planner_with(model: LlmSettings, settings: PlannerSettings) -> Planner:
    """Return a planner for the given model."""
    from fieldhand.planning.llm.planner import LlmPlanner
    from fieldhand.planning.llm.transport import ModelChat

    return LlmPlanner(model, settings.transcript, chat=settings.watched(ModelChat(model)))
