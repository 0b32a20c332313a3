"""A scripted language model without a network, for tests of the llm planner."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.planning.llm.chat import ChatMessage, Reply
from fieldhand.planning.llm.planner import LlmPlanner
from fieldhand.planning.llm.settings import LlmSettings

SETTINGS = LlmSettings(provider="openai-compatible", model="script", base_url="http://127.0.0.1:9/v1", api_key="none")


class ScriptedChat:
    """A model that returns prepared answers in order, and the last one repeatedly.

    Args:
        answers: Answers to return.

    Attributes:
        prompts: Last message of each request to the model, in order.
    """

    def __init__(self, *answers: str) -> None:
        self.answers = answers
        self.prompts: list[str] = []

    def ask(self, messages: Sequence[ChatMessage]) -> Reply:
        self.prompts.append(messages[-1].text)
        return Reply(text=self.answers[min(len(self.prompts), len(self.answers)) - 1])


def planner_of(chat: ScriptedChat, settings: LlmSettings = SETTINGS) -> LlmPlanner:
    """Return an llm planner that uses this model."""
    return LlmPlanner(settings, chat=chat)


def task_document(plan: str, frames: str = "") -> str:
    """Return an answer of a model: a draft document with a plan.

    Args:
        plan: XML of the plan's nodes.
        frames: XML of the exits, followed by ``<!--constraints-->`` and the XML of the constraints.
    """
    exits, _, constraints = frames.partition("<!--constraints-->")
    return (
        f'<task xmlns="urn:fieldhand:task:1">\n<task-composition>\n<plan>\n{plan}\n</plan>{exits}\n</task-composition>'
        f"{constraints}\n</task>"
    )
