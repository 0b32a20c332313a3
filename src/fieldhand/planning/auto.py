"""The default planner: the built-in one where it understands every word, else a language model.

The built-in planner comes first because it costs nothing, needs no network and answers the same way every time. It
drops no word in silence, so its plan is about the whole request; a model is asked only where it says that it did not
understand.
"""

from __future__ import annotations

from dataclasses import replace

from fieldhand.errors import ModelError
from fieldhand.language import joined, message
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Planner, PlannerSettings, Refused
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site


class AutoPlanner:
    """The built-in planner if it accounts for every word, else the model if there is one, else what was not understood.

    Args:
        english: Plans without a model.
        llm: Plans with one; None where no model is configured.
    """

    def __init__(self, english: Planner, llm: Planner | None) -> None:
        self._english = english
        self._llm = llm

    def plan(self, request: str, site: Site, robot: RobotProfile, answers: tuple[Answer, ...] = ()) -> Outcome:
        understood = self._english.plan(request, site, robot, answers)
        match understood:
            case Clarify(otherwise=Refused() as refused) if self._llm is not None:
                answered = self._ask_model(self._llm, refused, request, site, robot, answers)
                return understood if isinstance(answered, Refused) else answered
            case Planned() | Clarify():
                return understood
            case Refused():
                if self._llm is None:
                    return _advise(understood)
                return self._ask_model(self._llm, understood, request, site, robot, answers)

    def _ask_model(
        self,
        llm: Planner,
        refused: Refused,
        request: str,
        site: Site,
        robot: RobotProfile,
        answers: tuple[Answer, ...],
    ) -> Outcome:
        why = _summary(refused)
        try:
            answered = llm.plan(request, site, robot, answers)
        except ModelError as error:
            raise ModelError(
                message(
                    "{what} (a language model was asked because the built-in planner did not understand: {why})",
                    what=error.what,
                    why=why,
                ),
                where=error.where,
                advice=error.advice,
            ) from error
        match answered:
            case Planned():
                warning = message(
                    "planned by '{planner}', because the built-in planner did not understand: {why}",
                    planner=answered.planner,
                    why=why,
                )
                return _warn(answered, warning)
            case Clarify():
                return answered
            case Refused():
                return replace(answered, reasons=(*answered.reasons, *refused.reasons))


def _warn(planned: Planned, warning: str) -> Planned:
    command = planned.task.command
    command = replace(command, warnings=(*command.warnings, warning))
    return replace(planned, task=replace(planned.task, command=command))


def _advise(refused: Refused) -> Refused:
    """Return the refusal with the advice to use a language model, if one could help."""
    if any(reason.final for reason in refused.reasons):
        return refused
    *others, last = refused.reasons
    second = message("or set FIELDHAND_MODEL to a language model that may try it (docs/planning-llm.md)")
    advice = joined("; ", (last.advice, second)) if last.advice else second
    return replace(refused, reasons=(*others, replace(last, advice=advice)))


def _summary(refused: Refused) -> str:
    """Return the reasons of the built-in planner's refusal, short enough for one line."""
    reasons = [reason.what for reason in refused.reasons]
    shown = joined("; ", reasons[:3])
    return message("{items}; and {count} more", items=shown, count=len(reasons) - 3) if len(reasons) > 3 else shown


def make_auto_planner(settings: PlannerSettings) -> Planner:
    """Return the default planner; its language model is the one that the environment configures, if any.

    Raises:
        ModelError: A model is configured wrongly.
    """
    from fieldhand.planning.builtin import BuiltinPlanner
    from fieldhand.planning.llm.settings import settings_from_environment

    model = settings_from_environment(settings.environ)
    if model is None:
        return AutoPlanner(BuiltinPlanner(), None)
    from fieldhand.planning.llm.factory import planner_with

    return AutoPlanner(BuiltinPlanner(), planner_with(model, settings))


def make_english_planner(settings: PlannerSettings) -> Planner:  # noqa: ARG001  it needs none
    """Return the planner that needs no model."""
    from fieldhand.planning.builtin import BuiltinPlanner

    return BuiltinPlanner()
