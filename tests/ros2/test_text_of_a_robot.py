"""Text of a robot's messages over DDS: whatever it holds, a person sees it whole, on one line and short."""

from __future__ import annotations

import csv
import dataclasses
import io
import json
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.evaluation.report.writing import write_report
from fieldhand.exchange.mcap import McapLog
from fieldhand.execution.robot_text import MOST
from fieldhand.hidden_characters import find_hidden, find_hidden_within
from fieldhand.places.selectors import TreeIs
from fieldhand.task.event_lines import to_json
from fieldhand.task.plan import Act, GoTo
from fieldhand.task.results import Acted, Event, Faulted
from fieldhand.wording.events import EventText
from ros2.robot_in_process import Meeting, RobotInProcess
from ros2.scripted_robot import SITE
from support.examples import examples
from support.missions.rig import task_for

pytest.importorskip("cyclonedds")

PLAIN = Act(id="", action="read_ambient_temperature")
DRIVE = GoTo(id="", place=TreeIs(tree="5"))
HIDDEN = "\x1b\x07\x08\x9b\x7f\x85\xad\u200b\u200f\u202e\u2066\u2028\ufeff\ue000\u3164\U000e0041"
#: Words with sequences that terminals, pages and spreadsheets obey.
WORST = (
    "\x1b[2J",
    "\x1b]0;title\x07",
    "<script>alert(1)</script>",
    "=HYPERLINK(1)",
    "\u202eevil",
    "\r\nmission completed",
)
words = st.lists(
    st.one_of(st.sampled_from(WORST), st.text(HIDDEN, min_size=1, max_size=3), st.text(max_size=8)),
    min_size=1,
    max_size=6,
).map(lambda parts: "".join(parts).replace("\0", "").encode("utf-8", "ignore").decode())


@pytest.fixture(scope="module")
def meeting() -> Iterator[Meeting]:
    robot = RobotInProcess()
    try:
        made = Meeting(robot)
        yield made
        made.node.close()
    finally:
        robot.kill()


def shown(text: str) -> None:
    """Hold a text against the gate."""
    hidden = find_hidden(text, lines=True)
    assert hidden is None, hidden


def outputs(events: tuple[Event, ...], meeting: Meeting, task: Any, folder: Path) -> None:
    """Hold everything that is written and printed of a mission against the gate."""
    texts = EventText(meeting.profile)
    for event in events:
        line = to_json(event)
        shown(line)
        assert find_hidden_within(dataclasses.asdict(event)) is None
        assert len(line) < 20 * MOST
        shown(texts.line(event) or "")
        assert "\n" not in (texts.line(event) or "")
    files = write_report(
        folder,
        task=task,
        site=SITE,
        robot=meeting.profile,
        events=events,
        outcomes=(),
        authorization=None,
        estimate=None,
    )
    page = files.page.read_text()
    shown(page)
    assert "<script" not in page
    table = files.csv.read_text()
    shown(table)
    assert not any(cell[:1] in "=+@" for row in csv.reader(io.StringIO(table)) for cell in row if cell[:1])
    shown(files.geojson.read_text())
    with McapLog(folder / "log.mcap", tell=texts.line) as log:
        for event in events:
            log(event)
    raw = (folder / "log.mcap").read_bytes()
    assert b"\x1b[2J" not in raw


@settings(max_examples=examples(8, thorough=60), deadline=None)
@given(text=words)
def test_the_reason_of_a_failed_capture(meeting: Meeting, text: str) -> None:
    meeting.robot.tell("change", thermometer={"ok": False, "words": text})
    task = task_for(PLAIN)
    driver = meeting.connect()
    result = meeting.fly(task, driver)
    driver.close()
    failed = [event for event in result.events if isinstance(event, Acted)]
    assert failed
    assert all("did not succeed" in event.what for event in failed)
    with tempfile.TemporaryDirectory() as folder:
        outputs(result.events, meeting, task, Path(folder))


@settings(max_examples=examples(4, thorough=30), deadline=None)
@given(text=words)
def test_the_reason_of_a_failed_drive(meeting: Meeting, text: str) -> None:
    meeting.robot.tell("change", ends="aborted", result={"error_code": 100, "error_msg": text})
    task = task_for(DRIVE)
    driver = meeting.connect()
    result = meeting.fly(task, driver)
    driver.close()
    assert any(isinstance(event, Faulted) for event in result.events)
    with tempfile.TemporaryDirectory() as folder:
        outputs(result.events, meeting, task, Path(folder))


def test_a_long_text_is_cut(meeting: Meeting) -> None:
    meeting.robot.tell("change", thermometer={"ok": False, "words": "no " * 100_000})
    driver = meeting.connect()
    result = meeting.fly(PLAIN, driver)
    driver.close()
    failed = next(event for event in result.events if isinstance(event, Acted))
    assert MOST <= len(failed.what) < 2 * MOST
    assert len(json.dumps([to_json(event) for event in result.events])) < 60_000
