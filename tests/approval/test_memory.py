"""What expired, was superseded or was revoked does not count again because an old file or clock is brought back."""

from __future__ import annotations

import json
import shutil
from datetime import datetime, timedelta
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.approval.keys.signing import SigningKeys
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.approval.memory import ApprovalMemory
from fieldhand.cli.approve import parse_validity
from fieldhand.errors import InputError, KeyFileError, NotApprovedError
from fieldhand.testing.fixed_clock import FixedClock
from support.examples import examples
from support.missions.signed import KEY, NOW, good, opened, pack_mission, signing_key, undated

DAY = timedelta(days=1)


class Machine:
    """A robot's memory in two folders, and what it admits."""

    def __init__(self, folder: Path) -> None:
        self.config = folder / "config"
        self.config.mkdir(parents=True)
        self.copies = {"state": folder / "state" / "seen.json", "config": self.config / "seen.json"}
        self.memory = ApprovalMemory(*self.copies.values())
        self.store = TrustStore(self.config, memory=self.memory, clock=FixedClock(NOW))

    def admit(self, data: bytes, clock: datetime = NOW) -> None:
        bundle = opened(data, now=clock)
        self.memory.admit(bundle.manifest, bundle.signer.fingerprint, clock=clock, source="m.mission")


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    return Machine(tmp_path)


def approval(day: int, **more: object) -> bytes:
    return pack_mission(at=(NOW + day * DAY - timedelta(hours=1)).isoformat(), **more)  # type: ignore[arg-type]


def test_a_mission_begins_until_its_approval_runs_out(machine: Machine) -> None:
    short = approval(0, valid_for=timedelta(hours=12))
    machine.admit(short, NOW + timedelta(hours=10))
    with pytest.raises(NotApprovedError, match="could be started until"):
        machine.admit(short, NOW + timedelta(hours=12))


def test_a_clock_that_is_set_back_brings_nothing_back(machine: Machine) -> None:
    short = approval(0, valid_for=DAY)
    machine.admit(approval(30), NOW + 30 * DAY)
    with pytest.raises(NotApprovedError, match="this machine has already seen"):
        machine.admit(short, NOW)
    machine.memory.set_clock(NOW)
    with pytest.raises(NotApprovedError, match="was already seen here"):
        machine.admit(short, NOW)


@settings(max_examples=examples(6, thorough=40), deadline=None)
@given(days=st.lists(st.integers(0, 20), min_size=2, max_size=6))
def test_no_approval_of_a_mission_counts_after_a_later_one(
    days: list[int], tmp_path_factory: pytest.TempPathFactory
) -> None:
    machine = Machine(tmp_path_factory.mktemp("robot"))
    highest = -1
    for day in days:
        if day >= highest:
            machine.admit(approval(day), NOW + 21 * DAY)
        else:
            with pytest.raises(NotApprovedError, match="was already seen here"):
                machine.admit(approval(day), NOW + 21 * DAY)
        highest = max(highest, day)


@pytest.mark.parametrize("lost", ["state", "config"])
def test_one_copy_of_the_memory_is_enough(machine: Machine, lost: str) -> None:
    machine.admit(approval(5), NOW + 5 * DAY)
    machine.copies[lost].unlink()
    with pytest.raises(NotApprovedError, match="was already seen here"):
        machine.admit(approval(1), NOW + 5 * DAY)
    machine.admit(approval(6), NOW + 6 * DAY)
    assert all(copy.exists() for copy in machine.copies.values())


def test_a_damaged_memory_is_no_empty_one(machine: Machine) -> None:
    machine.admit(approval(5), NOW + 5 * DAY)
    machine.copies["state"].write_text("[" * 100_000)
    with pytest.raises(KeyFileError, match="damaged"):
        machine.admit(approval(6), NOW + 6 * DAY)


def test_a_mission_of_an_earlier_version_verifies_as_before_and_is_numbered_by_its_date(machine: Machine) -> None:
    old = undated(good())
    manifest = opened(old).manifest
    assert (manifest.format, manifest.approved.until, manifest.approved.number) == (1, None, None)
    assert b"until" not in manifest.document()
    machine.admit(old)
    machine.admit(old)
    with pytest.raises(NotApprovedError, match="could be started until"):
        machine.admit(old, NOW + 367 * DAY)
    machine.memory.set_clock(NOW)
    machine.admit(approval(1), NOW + DAY)
    with pytest.raises(NotApprovedError, match="was already seen here"):
        machine.admit(old, NOW + DAY)


def test_approvals_of_a_key_are_numbered_upwards_whatever_the_clock_says(tmp_path: Path) -> None:
    keys = SigningKeys(tmp_path)
    keys.make("Ada")
    numbers = [keys.next_number(keys.choose(), NOW + k * DAY) for k in (0, 0, -5, -400, 1)]
    assert numbers == sorted(set(numbers))
    assert numbers[0] == int(NOW.timestamp())


def test_a_revoked_key_stays_revoked_whatever_is_brought_back(machine: Machine, tmp_path: Path) -> None:
    machine.store.trust(KEY.public, name="Ada", at=NOW)
    machine.store.trust(signing_key(2).public, name="Bob", at=NOW)
    shutil.copytree(machine.store.folder, tmp_path / "copy")
    machine.store.revoke(KEY.public.fingerprint, at=NOW)
    for brought in ("copy", "nothing"):
        shutil.rmtree(machine.store.folder)
        if brought == "copy":
            shutil.copytree(tmp_path / "copy", machine.store.folder)
        with pytest.raises(KeyFileError, match="older copy"):
            machine.store.known()
        machine.store.confirm()
        assert machine.store.known()[KEY.public.fingerprint].state == "revoked"
        with pytest.raises(KeyFileError, match="was revoked"):
            machine.store.trust(KEY.public, name="Ada", at=NOW)
    # Also where the number of the list was written by hand.
    shutil.rmtree(machine.store.folder)
    shutil.copytree(tmp_path / "copy", machine.store.folder)
    (machine.store.folder / "list.json").write_text(json.dumps({"number": 1000}))
    assert machine.store.known()[KEY.public.fingerprint].state == "revoked"
    assert machine.store.known()[signing_key(2).public.fingerprint].state == "trusted"


def test_a_list_of_keys_may_run_out_and_is_confirmed_by_hand(machine: Machine) -> None:
    machine.store.trust(KEY.public, name="Ada", at=NOW)
    machine.store.confirm(NOW + DAY)
    assert machine.store.known()
    machine.memory.admit(opened(good()).manifest, "x", clock=NOW + 2 * DAY, source="m")
    with pytest.raises(KeyFileError, match="expired"):
        machine.store.known()
    machine.store.confirm()
    assert machine.store.known()[KEY.public.fingerprint].state == "trusted"


def test_keys_that_were_trusted_by_an_earlier_version_are_known(machine: Machine) -> None:
    TrustStore(machine.config).trust(KEY.public, name="Ada", at=NOW)
    (machine.store.folder / "list.json").unlink()
    assert machine.store.known()[KEY.public.fingerprint].state == "trusted"


@pytest.mark.parametrize("text", ["", "0d", "367d", "-1d", "1.5h", "d", "30", "99999999d", "1 d"])
def test_a_time_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="--valid-for"):
        parse_validity(text)


def test_times_are_minutes_hours_and_days() -> None:
    assert [parse_validity(text) for text in ("30m", "12h", "366d")] == [
        timedelta(minutes=30),
        timedelta(hours=12),
        timedelta(days=366),
    ]
