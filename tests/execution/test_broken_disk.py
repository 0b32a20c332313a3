"""At whichever call the disk fails: what was confirmed stays, nothing is done twice but what is in doubt."""

from __future__ import annotations

from pathlib import Path

import pytest

from execution.journalled import PICTURE, Cut, Field
from fieldhand.errors import FieldhandError
from fieldhand.execution import mission_clock
from fieldhand.execution.drivers.protocol import ActionGoal
from fieldhand.execution.journal.store import Journal
from fieldhand.places.selectors import TreeIs
from fieldhand.task.event_lines import to_json
from fieldhand.task.plan import Act, InOrder
from fieldhand.task.results import InDoubt, Resumed
from support.broken_disk import KINDS, broken
from support.examples import examples
from support.missions.rig import captured, of_type

PLAN = InOrder(
    id="",
    steps=(
        Act(id="", action=PICTURE, at=TreeIs(tree="r0c0"), reading="r"),
        Act(id="", action="read_co2", at=TreeIs(tree="r1c1")),
    ),
)


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mission_clock.time, "sleep", lambda seconds: None)


class Watched(Field):
    """A mission on a robot that counts the captures that it begins."""

    begun = 0
    said: list[str]

    def begin(self) -> None:
        start, self.said = self.driver.start_action, []

        def counted(goal: ActionGoal) -> None:
            self.begun += 1
            start(goal)

        self.driver.start_action = counted  # type: ignore[method-assign]

    def life(self) -> None:
        """Carry the mission out as far as the disk lets it."""
        field = self

        class Telling(Cut):
            def __init__(self, path: Path, mission: str, log: Path, _: object) -> None:
                Journal.__init__(self, path, mission, log, field.said.append)

        self.fly(PLAN, journal=Telling)

    def stopped(self) -> str:
        """Return the error that stopped the mission before its end; empty if nothing did."""
        try:
            self.life()
        except FieldhandError as error:
            return str(error)
        return ""


def calls_of_a_mission(folder: Path) -> list[str]:
    field = Watched(folder / "counted", outlives=True)
    field.begin()
    with broken(field.folder) as disk:
        field.life()
    return disk.calls


@pytest.mark.parametrize("kind", KINDS)
def test_a_mission_on_a_disk_that_fails_at_any_call(tmp_path: Path, kind: str) -> None:
    whole = Field(tmp_path / "whole").fly(PLAN)
    calls = calls_of_a_mission(tmp_path)
    assert {call.split()[0] for call in calls} >= {"open", "write", "sync"}
    assert {call.split()[1] for call in calls} >= {"journal.sqlite-wal", "journal.mark", "log"}
    stopped = 0
    step = examples(3, thorough=1)
    at = range(1 + KINDS.index(kind) % step, len(calls) + 1, step)
    for n in at:
        field = Watched(tmp_path / str(n), outlives=True)
        field.begin()
        with broken(field.folder, kind, n):
            said = field.stopped()
        stopped += bool(said)
        assert not said or str(field.folder) in said, "it says which file"
        assert field.driver.poll().over, "no wheel turns"
        told, field.said = field.said, []
        field.life()
        result = field.fly(PLAN)
        where = f"{kind} at call {n}: {calls[n - 1]}"
        lines = [to_json(event) for event in result.events]
        assert (result.status, field.lines) == ("completed", lines), where
        assert lines[: len(told)] == told, where
        assert told + field.said == lines or field.said == lines[len(lines) - len(field.said) :], where
        assert captured(result.events) == captured(whole.events), where
        doubts = len(of_type(result.events, InDoubt))
        assert doubts <= 1, where
        assert len(of_type(result.events, Resumed)) <= 1, where
        assert field.begun <= len(captured(whole.events)) + doubts, where
    assert stopped > len(at) * 0.7
