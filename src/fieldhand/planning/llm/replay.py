"""Record a model's answers to a request, and plan again from the record without the model.

A replay runs the complete process (HTTP, parsing, checks, repairs) and so verifies that recorded answers still lead
to the same plan after the program has changed.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from fieldhand.errors import ModelError, OutputError
from fieldhand.planning.llm.planner import LlmPlanner
from fieldhand.planning.llm.scripted import ScriptedAnswer, ScriptedEndpoint
from fieldhand.planning.llm.settings import LlmSettings
from fieldhand.planning.llm.transcript import Session
from fieldhand.planning.planner import Answer, Outcome
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site


def record(
    request: str, site: Site, robot: RobotProfile, path: Path, *, settings: LlmSettings, note: str = ""
) -> Outcome:
    """Plan one request and write the transcript to a file, replacing an existing one.

    Args:
        path: Transcript file.
        settings: Model settings; increase ``timeout_s`` if a person answers.
        note: Origin of the transcript, for later readers.

    Raises:
        ModelError: Raised as by :meth:`LlmPlanner.plan`; the transcript up to the failure is kept.
        OutputError: The file cannot be written.
    """
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(
            f"the transcript cannot be replaced ({error.strerror})", where=str(path), advice="name another file"
        ) from error
    return LlmPlanner(settings, path, note=note).plan(request, site, robot)


def transcript_endpoint(session: Session) -> ScriptedEndpoint:
    """Return an endpoint that gives the recorded answers in order."""
    return ScriptedEndpoint([ScriptedAnswer(text=e.answer, finish=e.finish or "stop") for e in session.exchanges])


def replay(session: Session, site: Site, robot: RobotProfile) -> Outcome:
    """Plan again from the recorded answers.

    Raises:
        ModelError: The answers no longer lead to a plan, or a different number of answers is needed.
    """
    with transcript_endpoint(session) as endpoint:
        model = str(session.about.get("planner", "llm:recorded")).removeprefix("llm:")
        # Each question has one recorded answer; a question beyond the record is a permanent failure.
        settings = replace(endpoint.settings(model=model), resends=0, repairs=max(0, len(session.exchanges) - 1))
        answers = tuple(Answer(**given) for given in session.about.get("answers", ()))
        outcome = LlmPlanner(settings).plan(session.request, site, robot, answers)
        if session.request not in endpoint.requests[0].text:
            raise ModelError("the prompt does not contain the request word for word", where="replay")
        if endpoint.unused:
            raise ModelError(
                f"{endpoint.unused} of {len(session.exchanges)} recorded answers were not needed",
                where=session.request,
                advice="record the transcript again",
            )
    return outcome
