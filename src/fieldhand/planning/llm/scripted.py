"""A language model endpoint that answers from a script: for tests, demonstrations without a key, and replays.

It is a real HTTP server on 127.0.0.1 and speaks the three protocols that the planner speaks, so that everything between
the planner and a model is exercised and nothing leaves the machine::

    with ScriptedEndpoint(["<question>Which corner?</question>"]) as endpoint:
        planner = LlmPlanner(endpoint.settings())
        planner.plan("Take a picture at the corner", site, robot)
        endpoint.requests[0].text       # what the planner asked

A script also says how an endpoint fails: a status, a body that is no JSON, an answer that is cut off, a long silence.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import TracebackType
from typing import Any, Self

from fieldhand.planning.llm.settings import LlmSettings, Provider


@dataclass(frozen=True, kw_only=True)
class ScriptedAnswer:
    """One answer of the script.

    Attributes:
        text: What the model says.
        finish: ``stop``, or ``length`` for an answer that was cut off.
        status: HTTP status; from 400 on, ``text`` is the message of the error.
        body: The whole body as it is sent, in place of one made from ``text``.
        content_type: Of the body.
        headers: Further headers, such as ``Retry-After``.
        delay_s: Silence before the answer, in seconds.
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
    """What the endpoint was asked: path, headers (lower case names), the JSON body."""

    path: str
    headers: Mapping[str, str]
    body: Mapping[str, Any]

    @property
    def text(self) -> str:
        """Everything that the messages say, in their order."""
        return "\n\n".join(_texts(self.body))


class ScriptedEndpoint:
    """An endpoint on 127.0.0.1 that gives its answers in order, one a request.

    Args:
        answers: The script; a bare string is a good answer with that text.
        repeat_last: Give the last answer again and again; else a request past the end of the script gets HTTP 400.
        port: Where to listen; 0 takes a free one.
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
        """The base address of its OpenAI-compatible interface.

        Raises:
            RuntimeError: It is not open (use it in a ``with`` statement).
        """
        if self._server is None:
            raise RuntimeError("the endpoint is open inside its with statement only")
        return f"http://127.0.0.1:{self._server.server_address[1]}/v1"

    def settings(
        self, *, provider: Provider = "openai-compatible", model: str = "scripted", timeout_s: float = 30.0
    ) -> LlmSettings:
        """Settings with which a planner asks this endpoint."""
        # The clients of Anthropic and Google add the version to the address themselves.
        url = self.url if provider.startswith("openai") else self.url.removesuffix("/v1")
        return LlmSettings(provider=provider, model=model, base_url=url, api_key="scripted-key", timeout_s=timeout_s)

    @property
    def unused(self) -> int:
        """How many answers of the script were not asked for."""
        return max(0, len(self._answers) - len(self.requests))

    def take(self, request: ScriptedRequest) -> ScriptedAnswer:
        """The answer to the next request; silent for as long as the script says, or until the endpoint closes."""
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
        """A client that went away (its time was up) is nothing to print about."""


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
    """A response in the protocol of the path."""
    cut = answer.finish == "length"
    body: dict[str, Any]
    if answer.status >= 400:
        body = {"error": {"message": answer.text, "type": "scripted_error", "code": answer.status}}
    elif path.endswith("/messages"):
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
    """Every text of a request body, whichever protocol it is in."""
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
