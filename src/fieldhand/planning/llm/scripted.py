"""Scripted language model endpoint for tests, replays, and demonstrations without a key.

A real HTTP server on 127.0.0.1 speaks the three protocols of the planner, so that everything between planner and
model is exercised and nothing leaves the machine::

    with ScriptedEndpoint(["<question>Which corner?</question>"]) as endpoint:
        planner = LlmPlanner(endpoint.settings())
        planner.plan("Take a picture at the corner", site, robot)
        endpoint.requests[0].text       # what the planner asked

A script can also make the endpoint fail: an error status, a body that is not JSON, a truncated answer, a delay.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import TracebackType
from typing import Any

from fieldhand.compatibility import Self
from fieldhand.planning.llm.settings import LlmSettings, Provider


@dataclass(frozen=True, kw_only=True)
class ScriptedAnswer:
    """One answer of the script.

    Attributes:
        text: Text of the answer.
        finish: ``stop``, or ``length`` for a truncated answer.
        status: HTTP status; from 400 on, ``text`` is the error message.
        body: Complete response body, replacing the one made from ``text``.
        content_type: Content type of the body.
        headers: Additional headers, such as ``Retry-After``.
        delay_s: Delay before the answer, in seconds.
        hang_up: Close the connection without an answer.
    """

    text: str = ""
    finish: str = "stop"
    status: int = 200
    body: bytes | None = None
    content_type: str = "application/json"
    headers: Mapping[str, str] = field(default_factory=dict)
    delay_s: float = 0.0
    hang_up: bool = False


@dataclass(frozen=True, kw_only=True)
class ScriptedRequest:
    """A received request: path, headers (lower-case names), JSON body."""

    path: str
    headers: Mapping[str, str]
    body: Mapping[str, Any]

    @property
    def text(self) -> str:
        """Return the text of all messages, in order."""
        return "\n\n".join(_texts(self.body))


class ScriptedEndpoint:
    """Endpoint on 127.0.0.1 that returns its answers in order, one per request.

    Args:
        answers: Script; a bare string is a successful answer with that text.
        repeat_last: Repeat the last answer; otherwise a request beyond the end of the script gets HTTP 400.
        port: Port to listen on; 0 selects a free one.
    """

    def __init__(self, answers: Iterable[ScriptedAnswer | str], *, repeat_last: bool = False, port: int = 0) -> None:
        self._answers = [a if isinstance(a, ScriptedAnswer) else ScriptedAnswer(text=a) for a in answers]
        self._repeat_last = repeat_last
        self._port = port
        self._lock = threading.Lock()
        self._closing = threading.Event()
        self._server: _Server | None = None
        self.requests: list[ScriptedRequest] = []

    def __enter__(self) -> Self:
        self._server = _Server(("127.0.0.1", self._port), self)
        threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True).start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._closing.set()
        if self._server is not None:
            self._server.shutdown()
            self._server.server_close()
            self._server = None

    @property
    def url(self) -> str:
        """Return the base address of the OpenAI-compatible interface.

        Raises:
            RuntimeError: The endpoint is not open (use it in a ``with`` statement).
        """
        if self._server is None:
            raise RuntimeError("the endpoint is open inside its with statement only")
        return f"http://127.0.0.1:{self._server.server_address[1]}/v1"

    def settings(
        self, *, provider: Provider = "openai-compatible", model: str = "scripted", timeout_s: float = 30.0
    ) -> LlmSettings:
        """Return settings with which a planner uses this endpoint."""
        # The clients of Anthropic and Google append the version to the address themselves.
        url = self.url if provider.startswith("openai") else self.url.removesuffix("/v1")
        return LlmSettings(provider=provider, model=model, base_url=url, api_key="scripted-key", timeout_s=timeout_s)

    @property
    def unused(self) -> int:
        """Return the number of answers not yet requested."""
        return max(0, len(self._answers) - len(self.requests))

    def take(self, request: ScriptedRequest) -> ScriptedAnswer:
        """Return the next answer after its delay, or early if the endpoint is closed."""
        with self._lock:
            position = len(self.requests)
            self.requests.append(request)
        if position >= len(self._answers) and not (self._repeat_last and self._answers):
            return ScriptedAnswer(status=400, text="the script has no answer left")
        answer = self._answers[min(position, len(self._answers) - 1)]
        self._closing.wait(answer.delay_s) if answer.delay_s else None
        return answer


class _Server(ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self, address: tuple[str, int], script: ScriptedEndpoint) -> None:
        self.script = script
        super().__init__(address, _Handler)

    def handle_error(self, request: object, client_address: object) -> None:
        """Ignore clients that disconnected, for example after a timeout."""


class _Handler(BaseHTTPRequestHandler):
    server: _Server

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the name is the base class's
        pass

    def do_POST(self) -> None:
        length = int(self.headers.get("Content-Length") or 0)
        try:
            body = json.loads(self.rfile.read(length) or b"{}")
        except ValueError:
            body = {}
        headers = {name.lower(): value for name, value in self.headers.items()}
        answer = self.server.script.take(ScriptedRequest(path=self.path, headers=headers, body=body))
        if answer.hang_up:
            self.close_connection = True
            return
        data = _body(self.path, body, answer) if answer.body is None else answer.body
        self.send_response(answer.status)
        self.send_header("Content-Type", answer.content_type)
        self.send_header("Content-Length", str(len(data)))
        for name, value in answer.headers.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(data)


def _body(path: str, asked: Mapping[str, Any], answer: ScriptedAnswer) -> bytes:
    """Return a response body in the protocol of the path."""
    cut = answer.finish == "length"
    body: dict[str, Any]
    if answer.status >= 400:
        body = {"error": {"message": answer.text, "type": "scripted_error", "code": answer.status}}
    elif path.partition("?")[0].endswith("/messages"):
        body = {
            "id": "msg_scripted",
            "type": "message",
            "role": "assistant",
            "model": asked.get("model", "scripted"),
            "content": [{"type": "text", "text": answer.text}],
            "stop_reason": "max_tokens" if cut else "end_turn",
            "stop_sequence": None,
            "usage": {"input_tokens": 1, "output_tokens": 1},
        }
    elif ":generateContent" in path:
        part = {"role": "model", "parts": [{"text": answer.text}]}
        body = {
            "candidates": [{"content": part, "finishReason": "MAX_TOKENS" if cut else "STOP", "index": 0}],
            "usageMetadata": {"promptTokenCount": 1, "candidatesTokenCount": 1, "totalTokenCount": 2},
            "modelVersion": "scripted",
        }
    else:
        body = {
            "id": "scripted",
            "object": "chat.completion",
            "created": 0,
            "model": asked.get("model", "scripted"),
            "choices": [
                {"index": 0, "message": {"role": "assistant", "content": answer.text}, "finish_reason": answer.finish}
            ],
            "usage": {"prompt_tokens": 1, "completion_tokens": 1, "total_tokens": 2},
        }
    return json.dumps(body).encode()


def _texts(value: object) -> list[str]:
    """Return every text of a request body, in any of the protocols."""
    if isinstance(value, dict):
        found = []
        for key, inner in value.items():
            if key in ("text", "content", "system") and isinstance(inner, str):
                found.append(inner)
            elif isinstance(inner, dict | list):
                found.extend(_texts(inner))
        return found
    if isinstance(value, list):
        return [text for inner in value for text in _texts(inner)]
    return []
