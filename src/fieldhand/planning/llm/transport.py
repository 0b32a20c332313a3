"""Network access to language models of any provider, with every failure raised as one exception class.

pydantic-ai implements the protocols; this module adds time limits, retries, and error messages for the operator.
Retries are disabled in the underlying clients, because the two would multiply.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, NoReturn

from fieldhand.errors import ModelError
from fieldhand.planning.llm.chat import ChatMessage, Reply
from fieldhand.planning.llm.settings import KEY_VARIABLES, LlmSettings

if TYPE_CHECKING:
    from pydantic_ai.messages import ModelMessage, ModelResponse
    from pydantic_ai.models import Model

#: HTTP statuses of transient faults, after which the same request may succeed.
MAY_PASS = frozenset({408, 409, 425, 429, 500, 502, 503, 504, 529})
#: Maximum delay before a retry in seconds, even if the endpoint asks for more.
LONGEST_WAIT_S = 30.0
#: Maximum number of characters quoted from an endpoint's error.
QUOTED = 300


class ModelChat:
    """Language model behind an HTTP endpoint.

    Args:
        settings: Model and request settings.
        sleep: Called with the seconds to wait before a retry.
    """

    def __init__(self, settings: LlmSettings, *, sleep: Callable[[float], None] = time.sleep) -> None:
        self._settings = settings
        self._sleep = sleep

    def ask(self, messages: Sequence[ChatMessage]) -> Reply:
        require_extra()
        require_key(self._settings)
        for attempt in range(self._settings.resends + 1):
            try:
                return _reply(_run(_request(self._settings, messages)))
            except Exception as error:  # noqa: BLE001 - the clients below raise what they like; explain() sorts it
                wait = _wait_s(error, attempt)
                if wait is None or attempt == self._settings.resends:
                    explain(error, self._settings, attempts=attempt + 1)
                self._sleep(wait)
        raise AssertionError("the loop returns or raises")


def require_extra() -> None:
    """Require the optional packages.

    Raises:
        ModelError: A package is not installed.
    """
    try:
        import pydantic_ai  # noqa: F401
    except ImportError as error:
        raise ModelError(
            f"planning with a language model needs a package that is not installed ({error.name})",
            advice='install it with: pip install "fieldhand[llm]"',
        ) from error


def require_key(settings: LlmSettings) -> None:
    """Require a key if the provider needs one.

    Raises:
        ModelError: The key is missing.
    """
    if not settings.api_key and settings.provider != "openai-compatible":
        names = " or ".join(("FIELDHAND_API_KEY", *KEY_VARIABLES[settings.provider]))
        raise ModelError(f"no key for {settings.provider}:{settings.model}", where="environment", advice=f"set {names}")


def build_model(settings: LlmSettings) -> Model[Any]:
    """Return the pydantic-ai model, whose client sends each request once.

    Only the packages of its provider are imported.
    """
    url, key = settings.base_url or None, settings.api_key
    match settings.provider:
        case "anthropic":
            from pydantic_ai.models.anthropic import AnthropicModel
            from pydantic_ai.providers.anthropic import AnthropicProvider

            anthropic = AnthropicProvider(api_key=key, base_url=url)
            # Set on the client, because releases of pydantic-ai for Python 3.10 have no such setting.
            anthropic.client.max_retries = 0
            return AnthropicModel(settings.model, provider=anthropic)
        case "google":
            from pydantic_ai.models.google import GoogleModel
            from pydantic_ai.providers.google import GoogleProvider

            # Google's client repeats requests only if it is told to.
            return GoogleModel(settings.model, provider=GoogleProvider(api_key=key, base_url=url))
        case "openai" | "openai-compatible":
            from pydantic_ai.models.openai import OpenAIChatModel
            from pydantic_ai.providers.openai import OpenAIProvider

            # The header is required even by endpoints without keys: without a value the client would send
            # OPENAI_API_KEY from the environment.
            openai = OpenAIProvider(base_url=url, api_key=key or "no-key")
            openai.client.max_retries = 0
            return OpenAIChatModel(settings.model, provider=openai)


async def _request(settings: LlmSettings, messages: Sequence[ChatMessage]) -> ModelResponse:
    import anyio
    from pydantic_ai.direct import model_request
    from pydantic_ai.settings import ModelSettings

    wanted = ModelSettings(temperature=settings.temperature, timeout=settings.timeout_s)
    if settings.max_tokens is not None:
        wanted["max_tokens"] = settings.max_tokens
    # The client's own timeout restarts with every byte, so a slowly trickling endpoint would never reach it.
    async with build_model(settings) as model:
        with anyio.fail_after(settings.timeout_s):
            return await model_request(model, _as_messages(messages), model_settings=wanted)


def _as_messages(messages: Sequence[ChatMessage]) -> list[ModelMessage]:
    from pydantic_ai.messages import ModelRequest, ModelResponse, SystemPromptPart, TextPart, UserPromptPart

    converted: list[ModelMessage] = []
    for message in messages:
        match message.role:
            case "assistant":
                converted.append(ModelResponse(parts=[TextPart(content=message.text)]))
            case "system":
                converted.append(ModelRequest(parts=[SystemPromptPart(content=message.text)]))
            case "user":
                converted.append(ModelRequest(parts=[UserPromptPart(content=message.text)]))
    return converted


def _reply(response: ModelResponse) -> Reply:
    from pydantic_ai.messages import TextPart

    text = "".join(part.content for part in response.parts if isinstance(part, TextPart))
    return Reply(
        text=text,
        finish=response.finish_reason or "",
        tokens=(response.usage.input_tokens, response.usage.output_tokens),
    )


def _run(request: Coroutine[Any, Any, ModelResponse]) -> ModelResponse:
    """Run a coroutine to completion, even inside a running event loop (a web server, a notebook)."""
    inside = True
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        inside = False
    if not inside:
        return asyncio.run(request)
    with ThreadPoolExecutor(max_workers=1) as pool:
        return pool.submit(asyncio.run, request).result()


def _wait_s(error: Exception, attempt: int) -> float | None:
    """Return the seconds to wait before a retry, or None if a retry is pointless."""
    from pydantic_ai.exceptions import ModelHTTPError

    backoff = 0.5 * 2.0**attempt
    if isinstance(error, ModelHTTPError):
        if error.status_code not in MAY_PASS:
            return None
        return min(LONGEST_WAIT_S, max(backoff, getattr(error, "retry_after", None) or 0.0))
    return backoff if not _timed_out(error) and _unconnected(error) else None


def explain(error: Exception, settings: LlmSettings, *, attempts: int) -> NoReturn:
    """Raise a ModelError that describes the failure, its location, and the remedy.

    Raises:
        ModelError: Always.
    """
    from pydantic_ai.exceptions import ModelHTTPError

    def fail(what: str, advice: str) -> NoReturn:
        times = f" (tried {attempts} times)" if attempts > 1 else ""
        raise ModelError(settings.redact(what) + times, where=settings.endpoint, advice=advice) from error

    if isinstance(error, ModelError):
        raise error
    if _timed_out(error):
        fail(
            f"no answer within {settings.timeout_s:g} s",
            "ask again, set FIELDHAND_MODEL_TIMEOUT higher, or use a faster model",
        )
    if isinstance(error, ModelHTTPError):
        fail(*_about_status(error.status_code, _body_text(error.body), settings))
    if isinstance(error, ImportError):
        fail(f"a package for {settings.provider} is not installed", 'install it with: pip install "fieldhand[llm]"')
    if _unconnected(error):
        why = next((str(e) for e in reversed(_causes(error)) if str(e)), "no reason given")
        fail(
            f"the endpoint cannot be reached ({_cut(why)})",
            "check that it runs, its address in FIELDHAND_BASE_URL, and the network",
        )
    # The remaining case is an invalid response body, which makes some clients raise TypeError or AttributeError.
    fail(
        f"the endpoint's answer is not a chat completion ({type(error).__name__}: {_cut(str(error))})",
        "check that FIELDHAND_BASE_URL is the address of a chat endpoint; it usually ends in /v1",
    )


def _about_status(status: int, body: str, settings: LlmSettings) -> tuple[str, str]:
    """Return the meaning of an HTTP status and the advice."""
    detail = f": {body}" if body else ""
    key = " or ".join(("FIELDHAND_API_KEY", *KEY_VARIABLES[settings.provider]))
    match status:
        case 401 | 403:
            return f"the endpoint refused the key (HTTP {status}){detail}", f"check {key}"
        case 404:
            return (
                f"there is no model {settings.model!r} or no chat endpoint at this address (HTTP 404){detail}",
                "check the name in FIELDHAND_MODEL and FIELDHAND_BASE_URL, which usually ends in /v1",
            )
        case 402 | 429:
            return (
                f"too many requests, or the account has no credit left (HTTP {status}){detail}",
                "wait, or use another",
            )
        case 400 | 413 | 422:
            return (
                f"the endpoint rejected the request (HTTP {status}){detail}",
                "check that the model's context holds 8,000 tokens and that it is a chat model",
            )
        case _ if status >= 500:
            return f"the endpoint failed (HTTP {status}){detail}", "try again later, or look into its log"
        case _:
            return f"the endpoint answered with HTTP {status}{detail}", "check FIELDHAND_BASE_URL"


def _causes(error: BaseException) -> list[BaseException]:
    found: list[BaseException] = []
    current: BaseException | None = error
    while current is not None and current not in found:
        found.append(current)
        current = current.__cause__ or current.__context__
    return found


def _timed_out(error: BaseException) -> bool:
    names = {type(e).__name__ for e in _causes(error)}
    if "ConnectTimeout" in names:  # nobody is there, which is another failure than a slow answer
        return False
    return any("timeout" in name.lower() for name in names)


def _unconnected(error: BaseException) -> bool:
    """Return True if the connection failed or broke.

    Judged by class names, as clients share no base class, and pydantic-ai does not wrap the errors of all of them.
    """
    names = {type(e).__name__ for e in _causes(error)}
    signs = (
        "ConnectError",
        "ConnectTimeout",
        "ConnectionError",
        "ConnectionRefusedError",
        "ReadError",
        "RemoteProtocolError",
        "gaierror",
    )
    return bool(names & {*signs, "APIConnectionError", "ModelConnectionError", "ConnectionResetError"})


def _body_text(body: object) -> str:
    """Return the endpoint's own error message on one line."""
    if isinstance(body, dict):
        inner = body.get("error", body)
        body = inner.get("message", inner) if isinstance(inner, dict) else inner
    return _cut(str(body)) if body else ""


def _cut(text: str) -> str:
    """Return the text on one line, cut to a maximum length."""
    text = " ".join(text.split())
    return text if len(text) <= QUOTED else text[:QUOTED] + "..."
