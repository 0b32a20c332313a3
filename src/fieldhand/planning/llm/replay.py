"""Record what a model says about a request, and plan again from the record, without the model.

A replay goes the whole way (HTTP, reading, checks, repairs), so it shows that answers which were good once still make
the same plan, whatever has changed in the program since.
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
    """Plan one request and keep the transcript in a file of its own, in place of what stood there.

    Args:
        path: The transcript.
        settings: The model; give it time if a person answers (``timeout_s``).
        note: How the transcript was made, for whoever reads it later.

    Raises:
        ModelError: As :meth:`LlmPlanner.plan`; the transcript up to there is kept.
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
    """An endpoint that gives the recorded answers in their order."""
    return ScriptedEndpoint([ScriptedAnswer(text=e.answer, finish=e.finish or "stop") for e in session.exchanges])


def replay(session: Session, site: Site, robot: RobotProfile) -> Outcome:
    """What comes of the recorded answers today.

    Raises:
        ModelError: The answers do not make a plan any more, or more or fewer of them are needed than were recorded.
    """
    with transcript_endpoint(session) as endpoint:
        model = str(session.about.get("planner", "llm:recorded")).removeprefix("llm:")
        # One answer was given to each question; a question past the record is a failure, not a fault that may pass.
        settings = replace(endpoint.settings(model=model), resends=0, repairs=max(0, len(session.exchanges) - 1))
        answers = tuple(Answer(**given) for given in session.about.get("answers", ()))
        outcome = LlmPlanner(settings).plan(session.request, site, robot, answers)
        if session.request not in endpoint.requests[0].text:
            raise ModelError("the request was not asked word for word", where="replay")
        if endpoint.unused:
            raise ModelError(
                f"{endpoint.unused} of {len(session.exchanges)} recorded answers were not needed",
                where=session.request,
                advice="record the transcript again",
            )
    return outcome
