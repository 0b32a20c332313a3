"""Events from lines: what was written comes back, and a field of another type is named, not met later."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from hypothesis import given, settings

from fieldhand.errors import TaskError
from fieldhand.task.event_lines import from_json, is_same, to_json
from fieldhand.task.results import Event, Shed
from fieldhand.testing.generated.events import events


@given(events)
@settings(deadline=None, max_examples=30)
def test_events_come_back(log: tuple[Event, ...]) -> None:
    assert tuple(from_json(to_json(event)) for event in log) == log


def test_a_line_is_the_same_but_for_defaults_of_fields_that_it_lacked() -> None:
    event = Shed(t=1.0, node="n1", places=("4",), optional=True, reason="far")
    line = to_json(event)
    lacking = json.dumps({key: value for key, value in json.loads(line).items() if key != "names_places"})
    assert is_same(line, line)
    assert is_same(line, lacking)
    assert not is_same(to_json(replace(event, names_places=True)), lacking)
    assert not is_same(to_json(replace(event, reason="near")), lacking)
    assert not is_same(line, json.dumps({"event": "shed"}))
    assert not is_same(line, "garbage")


@pytest.mark.parametrize(
    ("logged", "reason"),
    [
        ("skipped tree 5: 31 % chance", "tree 5: 31 % chance"),
        ("left out tree 5: 9 others cost less to reach", "tree 5: 9 others cost less to reach"),
        ("there is no way to tree 5", "there is no way to tree 5"),
    ],
)
def test_places_named_by_a_reason_of_an_earlier_version_are_not_named_again(logged: str, reason: str) -> None:
    line = {"event": "shed", "t": 1, "node": "n1", "places": ["5"], "optional": True, "reason": logged}
    read = from_json(json.dumps(line))
    assert isinstance(read, Shed)
    assert (read.names_places, read.reason) == (True, reason)
    now = from_json(json.dumps(line | {"names_places": False}))
    assert isinstance(now, Shed)
    assert (now.names_places, now.reason) == (False, logged)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("t", "soon"),
        ("t", True),
        ("t", 10**400),
        ("path", [[1.0], [2.0, 3.0]]),
        ("path", "north"),
        ("path", [[1.0, "x"]]),
        ("place", None),
        ("planned_m", {}),
    ],
)
def test_a_field_of_another_type_is_named(key: str, value: object) -> None:
    line = {"event": "drive", "t": 1, "node": "n1", "kind": "tree", "place": "5", "planned_m": 2, "path": [[1, 2]]}
    assert from_json(json.dumps(line)) is not None
    with pytest.raises(TaskError, match=f"line 3: not an event: {key} cannot be"):
        from_json(json.dumps(line | {key: value}), where="line 3")
