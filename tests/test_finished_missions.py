"""A mission is reported from its log as it was; a log that cannot be is refused in one line."""

from __future__ import annotations

import json
from datetime import datetime

import pytest

from fieldhand import finished_missions, mission
from fieldhand.compatibility import UTC
from fieldhand.errors import InputError
from fieldhand.evaluation.report.log_facts import end_of
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.places.selectors import Corners
from fieldhand.task.codec import encode
from fieldhand.task.event_lines import to_json
from fieldhand.task.plan import Act, ForEach
from fieldhand.testing.small_orchard import husky, orchard, task_for

SITE, ROBOT = orchard(), husky()
TASK = task_for(SITE, ForEach(id="", select=Corners(), body=Act(id="", action="take_thermal_picture")), "corners")


@pytest.fixture(scope="module")
def log():
    """The event log of a mission that was flown, as text."""
    review = mission.review(TASK, SITE, ROBOT)
    approved = mission.authorize(review, by="a", at=datetime(2026, 1, 1, tzinfo=UTC), confirmed=review.warnings)
    lines: list[str] = []
    mission.simulate(approved, world=World(), seed=1, speed=None, emit=lambda e: lines.append(to_json(e) + "\n"))
    return "".join(lines)


def reported(folder, text):
    (folder / "log").write_text(text)
    log = finished_missions.read_log(folder / "log")
    return *finished_missions.report_log(folder / "out", log, TASK, encode(TASK), SITE, ROBOT), log.events


def test_a_log_is_judged_and_reported(log, tmp_path):
    files, assessment, events = reported(tmp_path, log)
    assert assessment.success
    assert end_of(events).status == "completed"
    page = files.page.read_text()
    assert "unknown: the report was made from a log" in page
    assert SITE.sha256 in page
    assert ROBOT.sha256 in page


@pytest.mark.parametrize("cut", [0.3, 0.55, 0.999])
def test_a_log_that_was_cut_off_in_mid_write_is_reported(log, tmp_path, cut):
    files, assessment, events = reported(tmp_path, log[: int(cut * len(log))])
    assert end_of(events) is None
    assert "Cut off" in files.page.read_text()
    assert not assessment.success or cut > 0.9


def changed(log, event, fields):
    """The log with other fields in the first event of a kind."""
    lines = log.splitlines()
    k = next(k for k, line in enumerate(lines) if json.loads(line)["event"] == event)
    lines[k] = json.dumps(json.loads(lines[k]) | fields)
    return "\n".join(lines) + "\n"


BAD = [
    ("started", {"robot": "other"}, "was recorded with the robot 'other', not 'husky'"),
    ("started", {"site": "\u001b[31m"}, "was recorded with the site"),
    ("started", {"task": "<b>"}, "was recorded with the Task"),
    ("started", {"event": "unheard of"}, "has no line that identifies its mission"),
    ("arrive", {"leg_m": float("nan")}, "leg_m cannot be nan"),
    ("arrive", {"t": float("inf")}, "t cannot be inf"),
    ("arrive", {"travelled_m": 1e300}, "travelled_m of event"),
    ("arrive", {"leg_m": "far"}, "not an event"),
    ("drive", {"path": [["north", 1]]}, "not an event"),
    ("drive", {"path": 7}, "not an event"),
    ("action", {"readings": [1]}, "not an event"),
    ("action", {"status": "splendid"}, "not an event"),
    ("mission", {"status": 3}, "not an event"),
    ("mission", {"event": ["mission"]}, "not an event"),
]


@pytest.mark.parametrize(("event", "fields", "said"), BAD)
def test_a_log_that_cannot_be_reported_is_one_clear_line(log, tmp_path, event, fields, said):
    with pytest.raises(InputError, match=said) as caught:
        reported(tmp_path, changed(log, event, fields))
    assert len(str(caught.value).splitlines()) == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("text", ["", "\x00\x01\n", "[" * 100_000 + "\n", "{}\n", "null\n"])
def test_what_is_no_log_at_all_is_one_clear_line(tmp_path, text):
    with pytest.raises(InputError, match=r"not an event|has no line|contains no events"):
        reported(tmp_path, text)
