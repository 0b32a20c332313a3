"""No mission runs from the command line before its warnings are confirmed, whichever way its Task came there."""

from __future__ import annotations

import io
from contextlib import nullcontext
from pathlib import Path

import pytest

from fieldhand import mission
from fieldhand.cli import approving
from fieldhand.cli.draft import MissionDraft
from fieldhand.cli.inputs import open_site_and_robot
from fieldhand.cli.options import ApprovalOptions, DisplayOptions
from fieldhand.cli.run_mission import RunSettings, run_mission
from fieldhand.errors import NotApprovedError
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.task.codec import encode
from support.processes.command import fieldhand

SITE_AND_ROBOT = open_site_and_robot("demo", "husky")
REQUEST = "Take 2 pictures of tree 4."
LOST = "this may not be what was asked: the request says '3 pictures'"


@pytest.fixture
def task(tmp_path: Path) -> str:
    """A Task for 2 pictures in a file, in which somebody made the request one for 3."""
    outcome = EnglishPlanner().plan(REQUEST, SITE_AND_ROBOT.site, SITE_AND_ROBOT.robot)
    assert isinstance(outcome, Planned)
    path = tmp_path / "task.xml"
    path.write_bytes(encode(outcome.task).replace(REQUEST.encode(), REQUEST.replace("2", "3").encode()))
    return str(path)


def test_a_document_is_warned_of_as_its_plan_is(task: str) -> None:
    check = fieldhand("check", task, "--site", "demo")
    assert check.status == 0
    assert LOST in check.out
    assert "warnings are confirmed" in check.out


@pytest.mark.parametrize("quiet", [(), ("--json",)], ids=["text", "json"])
def test_yes_approves_and_confirms_nothing(task: str, quiet: tuple[str, ...]) -> None:
    run = fieldhand("run", task, "--site", "demo", "--yes", *quiet)
    assert run.status == 1
    assert "not confirmed" in run.err
    assert LOST in run.err
    assert "--confirm" in run.err
    assert "The mission" not in run.out


def test_confirming_is_said_and_stands_in_the_report(task: str, tmp_path: Path) -> None:
    run = fieldhand("run", task, "--site", "demo", "--yes", "--confirm", "-o", "out", cwd=tmp_path)
    assert run.status == 0, run.err
    assert "Warnings that were confirmed" in (tmp_path / "out" / "report.html").read_text()


@pytest.mark.parametrize(("typed", "flown"), [("y\ny\n", True), ("n\n", False), ("y\nn\n", False)])
def test_a_person_is_asked_about_the_warnings_and_then_to_approve(
    task: str, typed: str, flown: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(approving, "may_ask", lambda: True)
    monkeypatch.setattr("sys.stdin", io.StringIO(typed))
    read, document = mission.read_task(Path(task), SITE_AND_ROBOT.robot)
    draft = MissionDraft(site_and_robot=SITE_AND_ROBOT, task=read, document=document, planner="file")
    settings = RunSettings(approval=ApprovalOptions(by="Ada"), display=DisplayOptions(lang="en"), world=World(), seed=0)
    with nullcontext() if flown else pytest.raises(NotApprovedError, match="not approved, nothing was done"):
        assert run_mission(draft, settings) == 0
    out = capsys.readouterr().out
    assert "Is the plan right in spite of the" in out
    assert ("Approve and carry out?" in out) == typed.startswith("y")
    assert ("The mission" in out) == flown
