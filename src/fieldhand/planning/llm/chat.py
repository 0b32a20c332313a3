"""What passes between the planner and a language model: messages out, a reply back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

Role = Literal["system", "user", "assistant"]


@dataclass(frozen=True, kw_only=True)
class Message:
    """One message of the conversation with the model."""

    role: Role
    text: str


@dataclass(frozen=True, kw_only=True)
class Reply:
    """What the model answered.

    Attributes:
        finish: Why it stopped, as the endpoint says: ``stop``, ``length`` (cut off), ``content_filter``, or empty.
        tokens: Prompt and answer in the endpoint's count; 0 where it counts none.
    """

    text: str
    finish: str = "stop"
    tokens: tuple[int, int] = (0, 0)


class Chat(Protocol):
    """A language model that one can talk to."""

    def ask(self, messages: Sequence[Message]) -> Reply:
        """The model's reply to a conversation.

        Raises:
            ModelError: The model cannot be reached, refuses, or answers with what is no answer.
        """
        ...
