"""Messages and replies exchanged between the planner and a language model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

ChatRole = Literal["system", "user", "assistant"]


@dataclass(frozen=True, kw_only=True)
class ChatMessage:
    """One message of the conversation with the model."""

    role: ChatRole
    text: str


@dataclass(frozen=True, kw_only=True)
class Reply:
    """A reply of the model.

    Attributes:
        finish: Reason for stopping given by the endpoint: ``stop``, ``length`` (cut off), ``content_filter``, or empty.
        tokens: Number of prompt and answer tokens reported by the endpoint; 0 if not reported.
    """

    text: str
    finish: str = "stop"
    tokens: tuple[int, int] = (0, 0)


class Chat(Protocol):
    """A language model that answers conversations."""

    def ask(self, messages: Sequence[ChatMessage]) -> Reply:
        """Send a conversation to the model and return its reply.

        Raises:
            ModelError: The model is unreachable, refuses the request, or returns an invalid response.
        """
        ...
