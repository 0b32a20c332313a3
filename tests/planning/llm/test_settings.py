"""Settings: what the environment says about the model, and that its key is never shown."""

from __future__ import annotations

import pytest

from fieldhand.errors import ModelError
from fieldhand.planning.llm.settings import require_settings, settings_from_environment

LOCAL = "http://127.0.0.1:11434/v1"


def test_no_model_is_asked_unless_one_is_named_even_where_a_key_lies_about() -> None:
    assert settings_from_environment({"OPENAI_API_KEY": "sk-lies-about"}) is None


@pytest.mark.parametrize(
    ("named", "variable", "provider", "model"),
    [
        ("openai:gpt-x", "OPENAI_API_KEY", "openai", "gpt-x"),
        ("anthropic:claude-x", "ANTHROPIC_API_KEY", "anthropic", "claude-x"),
        ("google:gemini-x", "GOOGLE_API_KEY", "google", "gemini-x"),
        ("gemini:gemini-x", "GEMINI_API_KEY", "google", "gemini-x"),
    ],
)
def test_each_provider_takes_its_own_key(named: str, variable: str, provider: str, model: str) -> None:
    settings = require_settings({"FIELDHAND_MODEL": named, variable: "the-key"})
    assert (settings.provider, settings.model, settings.api_key) == (provider, model, "the-key")


def test_our_own_key_goes_before_the_providers() -> None:
    environ = {"FIELDHAND_MODEL": "openai:m", "FIELDHAND_API_KEY": "ours", "OPENAI_API_KEY": "theirs"}
    assert require_settings(environ).api_key == "ours"


def test_an_openai_key_is_not_meant_for_another_service_that_speaks_its_protocol() -> None:
    environ = {"FIELDHAND_MODEL": "openai-compatible:m", "FIELDHAND_BASE_URL": LOCAL, "OPENAI_API_KEY": "sk-secret"}
    assert require_settings(environ).api_key == ""


def test_a_model_name_may_hold_colons_as_ollama_writes_them() -> None:
    environ = {"FIELDHAND_MODEL": "openai-compatible:qwen3:8b", "FIELDHAND_BASE_URL": LOCAL + "/"}
    settings = require_settings(environ)
    assert (settings.model, settings.base_url, settings.name) == ("qwen3:8b", LOCAL, "llm:qwen3:8b")


def test_an_option_goes_before_the_environment() -> None:
    settings = require_settings({"FIELDHAND_MODEL": "openai:a"}, model="openai-compatible:b", base_url=LOCAL)
    assert (settings.provider, settings.model, settings.base_url) == ("openai-compatible", "b", LOCAL)


@pytest.mark.parametrize(
    ("environ", "where"),
    [
        ({}, "FIELDHAND_MODEL"),
        ({"FIELDHAND_MODEL": "gpt-x"}, "FIELDHAND_MODEL"),
        ({"FIELDHAND_MODEL": "nobody:gpt-x"}, "FIELDHAND_MODEL"),
        ({"FIELDHAND_MODEL": "openai:"}, "FIELDHAND_MODEL"),
        ({"FIELDHAND_MODEL": "openai-compatible:m"}, "FIELDHAND_BASE_URL"),
        ({"FIELDHAND_MODEL": "openai-compatible:m", "FIELDHAND_BASE_URL": "localhost:11434"}, "FIELDHAND_BASE_URL"),
        ({"FIELDHAND_MODEL": "openai-compatible:m", "FIELDHAND_BASE_URL": "http://h:99999/v1"}, "FIELDHAND_BASE_URL"),
        ({"FIELDHAND_MODEL": "openai:m", "FIELDHAND_MODEL_TIMEOUT": "soon"}, "FIELDHAND_MODEL_TIMEOUT"),
        ({"FIELDHAND_MODEL": "openai:m", "FIELDHAND_MODEL_TIMEOUT": "nan"}, "FIELDHAND_MODEL_TIMEOUT"),
        ({"FIELDHAND_MODEL": "openai:m", "FIELDHAND_MODEL_MAX_TOKENS": "-1"}, "FIELDHAND_MODEL_MAX_TOKENS"),
    ],
)
def test_what_cannot_be_used_names_the_variable_and_what_to_do(environ: dict[str, str], where: str) -> None:
    with pytest.raises(ModelError) as caught:
        require_settings(environ)
    assert caught.value.where == where
    assert caught.value.advice


def test_a_key_is_in_no_representation_and_in_no_endpoint_name() -> None:
    environ = {
        "FIELDHAND_MODEL": "openai-compatible:m",
        "FIELDHAND_BASE_URL": "http://user:hunter2@127.0.0.1:1/v1?token=hunter3",
        "FIELDHAND_API_KEY": "sk-secret",
    }
    settings = require_settings(environ)
    assert "sk-secret" not in repr(settings)
    assert settings.redact("you sent sk-secret to me") == "you sent [key] to me"
    assert settings.endpoint == "http://127.0.0.1:1/v1"
