"""Commands count earlier missions for Tasks that depend on them, keep what was counted, and explain bad folders."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from fieldhand.places.selector import Selector
from fieldhand.places.selectors import DoneEarlier, Excluding, Rows, TopEarlier
from fieldhand.robot.loader import load_robot
from fieldhand.site.model import Site
from fieldhand.task.codec import decode, encode
from fieldhand.task.plan import Act, ForEach
from fieldhand.testing.small_orchard import task_for
from support.processes.command import Run, fieldhand

SITE, ROBOT = Site.demo(), load_robot("husky")
REST = Excluding(places=DoneEarlier(action="read_co2"), of=Rows(first="1", last="1"))
HOTTEST = TopEarlier(quantity="co2", count=2)
SIMULATED = ("--count-simulated",)


def write(path: Path, select: Selector) -> Path:
    plan = ForEach(id="", select=select, body=Act(id="", action="take_thermal_picture"))
    path.write_bytes(encode(task_for(SITE, plan, "Skip those done.")))
    return path


@pytest.fixture(scope="module")
def farm(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store with one mission: CO2 at trees 4 and 9."""
    folder = tmp_path_factory.mktemp("farm")
    run = fieldhand("run", "Measure CO2 at trees 4 and 9.", "--site", "demo", "--yes", "--missions", str(folder))
    assert run.status == 0, run.err
    return folder


def given(command: str, task: Path, *more: str, store: Path) -> Run:
    return fieldhand(command, str(task), "--site", "demo", "--missions", str(store), *more, cwd=task.parent)


def test_check_and_run_count_the_missions_of_the_store(farm: Path, tmp_path: Path) -> None:
    task = write(tmp_path / "task.xml", HOTTEST)
    assert given("check", task, store=farm).status == 1
    checked = given("check", task, *SIMULATED, store=farm)
    assert checked.status == 0, checked.out + checked.err
    assert "2 of 169" in checked.out
    run = given("run", task, "--yes", "--confirm", *SIMULATED, "-o", "out", store=farm)
    assert run.status == 0, run.out + run.err
    kept = decode((tmp_path / "out" / "task.xml").read_bytes())
    assert kept.earlier is not None
    assert {one.place for _, one in kept.earlier.captures()} == {"4", "9"}


def test_what_was_counted_stays_until_it_is_counted_anew(farm: Path, tmp_path: Path) -> None:
    task = write(tmp_path / "task.xml", HOTTEST)
    assert given("run", task, "--yes", "--confirm", *SIMULATED, "-o", "out", store=farm).status == 0
    kept = tmp_path / "out" / "task.xml"
    empty = tmp_path / "empty"
    empty.mkdir()
    assert given("check", kept, store=empty).status == 0
    anew = given("check", kept, "--recount", store=empty)
    assert anew.status == 1
    assert "no earlier mission" in anew.out


def test_a_store_without_missions_leaves_nothing_out_after_a_warning(tmp_path: Path) -> None:
    task = write(tmp_path / "task.xml", REST)
    run = given("run", task, "--yes", store=tmp_path / "none")
    assert run.status == 1
    assert "count as not done" in run.out + run.err
    assert "Traceback" not in run.out + run.err


def test_a_broken_mission_in_the_store_is_named_and_counts_as_damaged(farm: Path, tmp_path: Path) -> None:
    broken = farm / "broken\x1b[31m"
    broken.mkdir()
    (broken / "mission.json").write_text("{")
    try:
        checked = given("check", write(tmp_path / "task.xml", REST), *SIMULATED, store=farm)
    finally:
        (broken / "mission.json").unlink()
        broken.rmdir()
    assert checked.status == 0
    assert "cannot be read and does not count" in checked.out
    assert "is left out of the earlier missions" in checked.err
    assert "\x1b" not in checked.out + checked.err


def test_a_store_that_is_a_file_is_an_error_in_words(tmp_path: Path) -> None:
    (tmp_path / "store").write_text("x")
    checked = given("check", write(tmp_path / "task.xml", REST), store=tmp_path / "store")
    assert checked.status not in (0, 70)
    assert "store" in checked.err
    assert "Traceback" not in checked.err


def test_a_signed_mission_contains_what_was_counted(farm: Path, tmp_path: Path) -> None:
    env = dict(os.environ) | {"FIELDHAND_CONFIG": str(tmp_path / "config")}
    task = write(tmp_path / "task.xml", REST)
    new = fieldhand("keys", "new", "--name", "Ada", "--json", cwd=tmp_path, env=env)
    made = json.loads(new.out)
    (tmp_path / "mail.txt").write_text(f"{made['public_key']}\n")
    trusted = fieldhand(
        "keys", "trust", "mail.txt", "--fingerprint", made["fingerprint"], "--name", "Ada", cwd=tmp_path, env=env
    )
    assert trusted.status == 0, trusted.err
    signed = fieldhand(
        "approve", str(task), "--site", "demo", "--missions", str(farm), *SIMULATED, "--yes", "--confirm",
        "--by", "Ada", "-o", "a.mission", cwd=tmp_path, env=env,
    )  # fmt: skip
    assert signed.status == 0, signed.out + signed.err
    store = tmp_path / "robot"
    run = fieldhand("run", "a.mission", "--missions", str(store), "--yes", "-o", "out", cwd=tmp_path, env=env)
    assert run.status == 0, run.out + run.err
    kept = decode((tmp_path / "out" / "task.xml").read_bytes())
    assert kept.earlier is not None
    assert {one.place for _, one in kept.earlier.captures()} == {"4", "9"}
