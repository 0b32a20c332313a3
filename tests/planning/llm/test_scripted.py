"""The scripted endpoint: it gives its answers in order and says what it was asked."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from typing import Any

import pytest

from fieldhand.planning.llm.scripted import ScriptedAnswer, ScriptedEndpoint


def post(url: str, body: bytes = b'{"messages": [{"role": "user", "content": "hello"}]}') -> Any:
    with urllib.request.urlopen(urllib.request.Request(f"{url}/chat/completions", data=body)) as response:
        return json.load(response)


def said(answer: Any) -> str:
    return str(answer["choices"][0]["message"]["content"])


def test_answers_come_in_order_and_what_was_asked_is_kept() -> None:
    with ScriptedEndpoint(["one", ScriptedAnswer(text="two")]) as endpoint:
        assert endpoint.unused == 2
        assert [said(post(endpoint.url)), said(post(endpoint.url))] == ["one", "two"]
        assert endpoint.unused == 0
    assert [r.text for r in endpoint.requests] == ["hello", "hello"]
    assert endpoint.requests[0].path == "/v1/chat/completions"


def test_past_the_end_of_the_script_is_an_error_unless_the_last_repeats() -> None:
    with ScriptedEndpoint(["only"]) as endpoint:
        post(endpoint.url)
        with pytest.raises(urllib.error.HTTPError, match="400"):
            post(endpoint.url)
    with ScriptedEndpoint(["again"], repeat_last=True) as endpoint:
        assert {said(post(endpoint.url)) for _ in range(3)} == {"again"}


def test_an_empty_script_has_nothing_to_repeat() -> None:
    with ScriptedEndpoint([], repeat_last=True) as endpoint, pytest.raises(urllib.error.HTTPError, match="400"):
        post(endpoint.url)


def test_a_body_that_is_no_json_is_answered_too() -> None:
    with ScriptedEndpoint(["yes"]) as endpoint:
        assert said(post(endpoint.url, b"{")) == "yes"


def test_it_listens_on_this_machine_only_and_only_while_open() -> None:
    endpoint = ScriptedEndpoint(["x"])
    with pytest.raises(RuntimeError):
        _ = endpoint.url
    with endpoint:
        assert endpoint.url.startswith("http://127.0.0.1:")
        url = endpoint.url
    with pytest.raises(urllib.error.URLError):
        post(url)
