"""At whichever call the disk fails: what was said to be kept is kept, and the rest is there whole or not at all."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import closing
from pathlib import Path

import pytest

from fieldhand import missions
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.delivery.bundle_checks import acceptance, sha256_of
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.outbox import Outbox, OutboxEntry
from fieldhand.errors import FieldhandError, StoreError
from fieldhand.robot.loader import load_robot
from support.broken_disk import KINDS, Disk, broken
from support.examples import examples
from support.missions.kept import inputs
from support.missions.signed import KEY, NOW, good

Use = Callable[[], object]


def at_each_call(
    tmp_path: Path, kind: str, use: Callable[[Path], Iterable[Use]], *, every: int = 3
) -> Iterator[tuple[Path, int, str]]:
    """Do something on a disk that fails at its first, second, ... call.

    Args:
        tmp_path: Where.
        kind: How it fails.
        use: The steps that are done on the disk, in a folder of their own, one after the other until one fails.
        every: One call of so many is tried, with each kind others; all of them with the profile ``thorough``.

    Yields:
        The folder, how many steps were done, and where the disk failed.
    """

    def run(folder: Path, at: int) -> tuple[int, Disk]:
        folder.mkdir()
        done = 0
        with broken(folder, kind, at) as disk:
            try:
                for one in use(folder):
                    one()
                    done += 1
            except FieldhandError as error:
                said = str(error)
                assert said
        return done, disk

    calls = run(tmp_path / "counted", 0)[1].calls
    step = examples(every, thorough=1)
    for n in range(1 + KINDS.index(kind) % step, len(calls) + 1, step):
        folder = tmp_path / str(n)
        done, _ = run(folder, n)
        yield folder, done, f"{kind} at call {n} of {len(calls)}: {calls[n - 1]}"


def depot_in(folder: Path) -> MissionStore:
    trusted = TrustStore(folder.parent / "config")
    accept = acceptance(robot=load_robot("husky"), sites=(), trusted=trusted, now=lambda: NOW)
    return MissionStore(folder / "store", accept=accept, now=lambda: NOW)


def deliver(mission_store: MissionStore) -> None:
    with mission_store.receiving() as part:
        part.write(good())
        mission_store.take(part, sha256_of(good()))


@pytest.mark.parametrize("kind", KINDS)
def test_a_store_on_a_disk_that_fails_at_any_call(tmp_path: Path, kind: str) -> None:
    """A mission that was acknowledged is there, one that has begun never begins again, and the store opens."""
    TrustStore(tmp_path / "config").trust(KEY.public, name="Ada", at=NOW)
    sha256 = sha256_of(good())

    def steps(folder: Path) -> Iterator[Use]:
        with closing(depot_in(folder)) as mission_store:
            yield lambda: deliver(mission_store)
            yield lambda: mission_store.note_begun(sha256)

    for folder, done, where in at_each_call(tmp_path, kind, steps, every=9):
        with closing(depot_in(folder)) as mission_store:
            held = mission_store.find(sha256)
            assert held is not None or done < 1, where
            if done < 2 and (held is None or held.begun_at is None):
                deliver(mission_store)
                assert mission_store.open(sha256).data == good(), where
            else:
                with pytest.raises(FieldhandError, match="does not run twice"):
                    mission_store.open(sha256)
            assert not list((folder / "store" / "incoming").iterdir()), where


def entry(**more: object) -> OutboxEntry:
    sha256 = sha256_of(good())
    return OutboxEntry(
        sha256=sha256, url="https://robot", name="m.mission", start=True, queued_at=1.0, next_at=1.0, **more
    )  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", KINDS)
def test_an_outbox_on_a_disk_that_fails_at_any_call(tmp_path: Path, kind: str) -> None:
    """Check that what was put in waits until it was noted as delivered, and has its bundle as long as it waits."""

    def steps(folder: Path) -> list[Use]:
        outbox, put = Outbox(folder / "outbox"), list[OutboxEntry]()
        return [
            lambda: put.append(outbox.put(entry(), good())),
            lambda: outbox.note(OutboxEntry(**{**vars(put[0]), "state": "delivered"})),
        ]

    for folder, done, where in at_each_call(tmp_path, kind, steps):
        outbox = Outbox(folder / "outbox")
        waiting = outbox.waiting()
        assert len(waiting) == 1 or done != 1 or len(outbox.entries()) == 1, where
        assert not (done == 2 and waiting), where
        assert all(outbox.bundle(one) == good() for one in waiting), where
        again = outbox.put(entry(), good())
        assert outbox.bundle(again) == good(), where
        outbox.note(OutboxEntry(**{**vars(again), "state": "delivered"}))
        assert [path.name for path in (folder / "outbox").iterdir() if path.suffix == ".mission"] == [], where


@pytest.mark.parametrize("kind", KINDS)
def test_trusted_keys_on_a_disk_that_fails_at_any_call(tmp_path: Path, kind: str) -> None:
    """A key is trusted or not, revoked or not, as it was said last; the list stays readable."""

    def steps(folder: Path) -> list[Use]:
        store = TrustStore(folder / "config")
        return [
            lambda: store.trust(KEY.public, name="Ada", at=NOW),
            lambda: store.revoke(KEY.public.fingerprint, at=NOW),
        ]

    for folder, done, where in at_each_call(tmp_path, kind, steps):
        known = TrustStore(folder / "config").known().get(KEY.public.fingerprint)
        state = "unknown" if known is None else known.state
        assert state in (("unknown", "trusted"), ("trusted", "revoked"), ("revoked",))[done], where
        revoked = TrustStore(folder / "config").revoke(KEY.public.fingerprint, at=NOW)
        assert revoked.state == "revoked", where


@pytest.mark.parametrize("kind", KINDS)
def test_a_mission_begins_whole_or_not_at_all_on_a_disk_that_fails_at_any_call(tmp_path: Path, kind: str) -> None:
    def steps(folder: Path) -> list[Use]:
        return [lambda: missions.begin(folder / "missions", "m1", inputs())]

    for folder, done, where in at_each_call(tmp_path, kind, steps, every=12):
        there = missions.exists(folder / "missions" / "m1")
        assert there or not done, where
        if not there:
            missions.begin(folder / "missions", "m1", inputs())
        given = missions.open_mission(folder / "missions" / "m1")
        result = missions.carry_out(given, speed=None, emit=lambda _: None)
        assert (result.status, given.sha256 != "") == ("completed", True), where


def test_a_store_that_is_not_there_any_more_takes_nothing(tmp_path: Path) -> None:
    """Of a database that was deleted a second agent could make another, and run the missions of the first again."""
    TrustStore(tmp_path / "config").trust(KEY.public, name="Ada", at=NOW)
    folder = tmp_path / "robot"
    with closing(depot_in(folder)) as mission_store:
        with pytest.raises(StoreError, match="another agent"):
            depot_in(folder)
        (folder / "store" / "depot.sqlite").unlink()
        with pytest.raises(StoreError, match="another agent"):
            depot_in(folder)
        with pytest.raises(StoreError, match="is no longer in its place"):
            deliver(mission_store)
