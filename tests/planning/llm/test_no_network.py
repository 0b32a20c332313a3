"""The guard of this test suite holds: a model that is not on this machine cannot be asked from a test."""

from __future__ import annotations

import os

import pytest

from fieldhand.planning.llm.chat import ChatMessage
from fieldhand.planning.llm.settings import LlmSettings, Provider
from fieldhand.planning.llm.transport import ModelChat


@pytest.mark.parametrize("provider", ["openai", "anthropic", "google"])
def test_a_real_model_cannot_be_asked(provider: Provider) -> None:
    chat = ModelChat(LlmSettings(provider=provider, model="m", api_key="k" * 20))
    with pytest.raises(pytest.fail.Exception, match="a test tried to"):
        chat.ask([ChatMessage(role="user", text="hello")])


def test_an_address_without_a_name_cannot_be_asked_either() -> None:
    chat = ModelChat(LlmSettings(provider="openai-compatible", model="m", base_url="http://192.0.2.1/v1"))
    with pytest.RaisesGroup(
        pytest.RaisesExc(pytest.fail.Exception, match=r"192\.0\.2\.1"), flatten_subgroups=True, allow_unwrapped=True
    ):
        chat.ask([ChatMessage(role="user", text="hello")])


def test_no_key_of_the_developer_is_in_the_environment() -> None:
    ours = {"FIELDHAND_MISSIONS"}  # where the tests keep their missions
    private = ("FIELDHAND_", "OPENAI_", "ANTHROPIC_", "GOOGLE_")
    assert not [name for name in os.environ if name.startswith(private) and name not in ours]
