"""Settings of the language model and its endpoint, read from the environment.

    FIELDHAND_MODEL        openai:NAME | anthropic:NAME | google:NAME | openai-compatible:NAME
    FIELDHAND_BASE_URL     where an OpenAI-compatible endpoint listens, such as http://127.0.0.1:11434/v1
    FIELDHAND_API_KEY      the key; else OPENAI_API_KEY, ANTHROPIC_API_KEY, GOOGLE_API_KEY or GEMINI_API_KEY
    FIELDHAND_MODEL_TIMEOUT     seconds that one answer may take (120)
    FIELDHAND_MODEL_MAX_TOKENS  most tokens of one answer (the endpoint's own limit)

No model is used unless ``FIELDHAND_MODEL`` names one: a key in the environment that belongs to another program is not
consent to spend money on planning. Keys are read from the environment only, never from an option, which a shell would
keep in its history.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, cast, get_args
from urllib.parse import urlsplit

from fieldhand.errors import ModelError
from fieldhand.language import message

Provider = Literal["openai", "anthropic", "google", "openai-compatible"]

#: Configuration advice for error messages.
HOW_TO_CONFIGURE = message(
    "set FIELDHAND_MODEL to a language model (openai:NAME, anthropic:NAME, google:NAME, or openai-compatible:NAME "
    "with FIELDHAND_BASE_URL), and FIELDHAND_API_KEY to its key"
)

#: Environment variables for each provider's key. An OpenAI key is never sent to another service with its protocol.
KEY_VARIABLES: Mapping[Provider, tuple[str, ...]] = {
    "openai": ("OPENAI_API_KEY",),
    "anthropic": ("ANTHROPIC_API_KEY",),
    "google": ("GOOGLE_API_KEY", "GEMINI_API_KEY"),
    "openai-compatible": (),
}

#: Alternative names of the providers.
ALIASES: Mapping[str, Provider] = {"google-gla": "google", "gemini": "google", "compatible": "openai-compatible"}


@dataclass(frozen=True, kw_only=True)
class LlmSettings:
    """A language model and its request settings.

    Attributes:
        model: Name of the model at its provider.
        base_url: Address of the endpoint; empty for the provider's own.
        api_key: API key, excluded from the representation, errors and transcripts.
        temperature: Sampling temperature, 0 to 2.
        timeout_s: Time limit of one answer in seconds, above 0.
        max_tokens: Maximum number of tokens of one answer; None for the endpoint's limit.
        resends: Number of retries after a transient fault (busy, server error, no connection).
        repairs: Number of attempts that the model gets to repair an unusable answer.
    """

    provider: Provider
    model: str
    base_url: str = ""
    api_key: str = field(default="", repr=False)
    temperature: float = 0.2
    timeout_s: float = 120.0
    max_tokens: int | None = None
    resends: int = 2
    repairs: int = 3

    @property
    def name(self) -> str:
        """Return the planner name used in plans, transcripts and messages: ``llm:<model>``."""
        return f"llm:{self.model}"

    @property
    def endpoint(self) -> str:
        """Return the address of the endpoint for messages, without user, password, query or key."""
        if not self.base_url:
            return self.provider
        parts = urlsplit(self.base_url)
        host = parts.netloc.rpartition("@")[2]
        return f"{parts.scheme}://{host}{parts.path}"

    def redact(self, text: str) -> str:
        """Return the text with the key removed, in case an endpoint repeats it."""
        return text.replace(self.api_key, "[key]") if len(self.api_key) >= 4 else text


def settings_from_environment(environ: Mapping[str, str], *, model: str = "", base_url: str = "") -> LlmSettings | None:
    """Return the language model settings of the environment.

    Args:
        environ: Environment variables.
        model: Override of ``FIELDHAND_MODEL``, for a command line option.
        base_url: Override of ``FIELDHAND_BASE_URL``.

    Returns:
        The settings, or None if no model is named.

    Raises:
        ModelError: A variable is invalid. A missing key raises only when the model is used, so that planning without a
            model keeps working.
    """
    wanted = model.strip() or environ.get("FIELDHAND_MODEL", "").strip()
    if not wanted:
        return None
    provider, name = _provider_and_name(wanted)
    url = _base_url(base_url.strip() or environ.get("FIELDHAND_BASE_URL", "").strip(), provider, environ)
    return LlmSettings(
        provider=provider,
        model=name,
        base_url=url,
        api_key=_key(provider, environ),
        timeout_s=_number(environ, "FIELDHAND_MODEL_TIMEOUT", 120.0),
        max_tokens=int(_number(environ, "FIELDHAND_MODEL_MAX_TOKENS", 0.0)) or None,
    )


def require_settings(environ: Mapping[str, str], *, model: str = "", base_url: str = "") -> LlmSettings:
    """Return the settings as :func:`settings_from_environment` does, but require a model.

    Raises:
        ModelError: No model is configured, or a variable is invalid.
    """
    settings = settings_from_environment(environ, model=model, base_url=base_url)
    if settings is None:
        raise ModelError(message("no language model is configured"), where="FIELDHAND_MODEL", advice=HOW_TO_CONFIGURE)
    return settings


def _provider_and_name(wanted: str) -> tuple[Provider, str]:
    prefix, colon, name = wanted.partition(":")
    provider = ALIASES.get(prefix, prefix)
    if not colon or not name.strip() or provider not in get_args(Provider):
        known = ", ".join(f"{p}:NAME" for p in get_args(Provider))
        raise ModelError(
            message("{wanted} is not the name of a model", wanted=repr(wanted)),
            where="FIELDHAND_MODEL",
            advice=message("write one of {known}", known=known),
        )
    return cast(Provider, provider), name.strip()


def _base_url(given: str, provider: Provider, environ: Mapping[str, str]) -> str:
    url = given or (environ.get("OPENAI_BASE_URL", "").strip() if provider == "openai" else "")
    if not url:
        if provider == "openai-compatible":
            raise ModelError(
                message("an OpenAI-compatible model needs the address of its endpoint"),
                where="FIELDHAND_BASE_URL",
                advice=message("set it, for example to http://127.0.0.1:11434/v1"),
            )
        return ""
    try:
        parts = urlsplit(url)
        usable = parts.scheme in ("http", "https") and bool(parts.hostname) and parts.port != 0
    except ValueError:
        usable = False
    if not usable:
        raise ModelError(
            message("the address of the endpoint is not an http address"),
            where="FIELDHAND_BASE_URL",
            advice=message("write it like http://127.0.0.1:11434/v1"),
        )
    return url.rstrip("/")


def _key(provider: Provider, environ: Mapping[str, str]) -> str:
    for variable in ("FIELDHAND_API_KEY", *KEY_VARIABLES[provider]):
        if key := environ.get(variable, "").strip():
            return key
    return ""


def _number(environ: Mapping[str, str], variable: str, default: float) -> float:
    text = environ.get(variable, "").strip()
    if not text:
        return default
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < 1e7:
        raise ModelError(
            message("{text} is not a number above 0", text=repr(text)),
            where=variable,
            advice=message("give a number, or unset it"),
        )
    return value
