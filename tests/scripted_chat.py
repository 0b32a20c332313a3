"""A language model that says what it is told to say, without a network between."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.planning.llm.chat import Message, Reply
from fieldhand.planning.llm.planner import LlmPlanner
from fieldhand.planning.llm.settings import LlmSettings

SETTINGS = LlmSettings(provider="openai-compatible", model="script", base_url="http://127.0.0.1:9/v1", api_key="none")


class ScriptedChat:
    """Gives its answers in order, the last one again and again, and keeps what it was told."""

    def __init__(self, *answers: str) -> None:
        self.answers = answers
        self.told: list[str] = []

    def ask(self, messages: Sequence[Message]) -> Reply:
        self.told.append(messages[-1].text)
        return Reply(text=self.answers[min(len(self.told), len(self.answers)) - 1])


def planner_of(chat: ScriptedChat, settings: LlmSettings = SETTINGS) -> LlmPlanner:
    """A planner behind which the script stands."""
    return LlmPlanner(settings, chat=chat)


def task_document(plan: str, frames: str = "") -> str:
    """An answer with this plan; ``frames`` may hold exits before ``<!--constraints-->`` and constraints after it."""
    exits, _, constraints = frames.partition("<!--constraints-->")
    return (
        f'<task xmlns="urn:fieldhand:task:1">\n<task-composition>\n<plan>\n{plan}\n</plan>{exits}\n</task-composition>'
        f"{constraints}\n</task>"
    )
