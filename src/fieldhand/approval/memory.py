"""Persistent record of approvals that prevents the replay of superseded files.

As in The Update Framework (TUF), the record contains the highest approval number of each mission and signer, the
latest time seen, the revoked keys, and the highest number of the list of trusted keys. It is stored in two folders
where both are writable: either copy suffices, and the higher of two values applies.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from fieldhand.approval.bundle.manifest import LONGEST_VALID
from fieldhand.approval.keys.rights import make_folder, read_guarded, replace
from fieldhand.approval.keys.trust import TrustSeen, TrustStore
from fieldhand.errors import KeyFileError, NotApprovedError, OutputError
from fieldhand.files import config_folder, state_folder
from fieldhand.language import message

if TYPE_CHECKING:
    from fieldhand.approval.bundle.manifest import Manifest


class _Seen(BaseModel):
    """Highest approval number of a mission, and the time until which an older approval could still be started."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    number: int
    keep_until: float


class _Remembered(BaseModel):
    """Schema of the file.

    Attributes:
        latest: Latest time seen, in seconds since 1970.
        trusted: Highest number of the list of trusted keys.
        revoked: Time of revocation of each key, by fingerprint.
        seen: Highest approval numbers, by signer and Task id.
    """

    model_config = ConfigDict(extra="forbid", strict=True)

    format: int = Field(default=1, ge=1, le=1)
    latest: float = 0.0
    trusted: int = 0
    revoked: dict[str, str] = {}
    seen: dict[str, dict[str, _Seen]] = {}


class ApprovalMemory:
    """The approval record of one machine.

    Args:
        files: Copies of the record. The folder of the first must be writable; the others are optional.
    """

    def __init__(self, *files: Path) -> None:
        self._files = files

    def time(self, clock: datetime) -> datetime:
        """Return the time used to judge approvals: the clock, but never earlier than the latest time seen."""
        latest = self._read().latest
        return datetime.fromtimestamp(max(latest, clock.timestamp()), clock.tzinfo)

    def admit(self, manifest: Manifest, signer: str, *, clock: datetime, source: str) -> None:
        """Record a mission that has arrived or is about to start, and refuse it if it is expired or superseded.

        Args:
            manifest: Manifest of the bundle, with a verified signature.
            signer: Fingerprint of the signing key.
            clock: Current time of this machine.
            source: Name of the bundle in error messages.

        Raises:
            NotApprovedError: The approval has expired, or a later approval of the same mission was recorded.
            KeyFileError, OutputError: The record cannot be read or written.
        """
        with self._changed() as memory:
            now = max(memory.latest, clock.timestamp())
            require_unexpired(manifest, datetime.fromtimestamp(now, clock.tzinfo), clock, source)
            seen = memory.seen.setdefault(signer, {})
            before = seen.get(manifest.task.id)
            if before is not None and manifest.number < before.number:
                raise NotApprovedError(
                    message(
                        "is approval number {number} of this mission, but number {seen} was already seen here",
                        number=manifest.number,
                        seen=before.number,
                    ),
                    where=source,
                    advice=message("run the later one, or have this one approved again"),
                )
            keep_until = (manifest.approved_at + LONGEST_VALID).timestamp()
            if before is None or manifest.number > before.number:
                seen[manifest.task.id] = _Seen(number=manifest.number, keep_until=keep_until)
            memory.latest = now
            for tasks in memory.seen.values():
                for task in [task for task, one in tasks.items() if one.keep_until < now]:
                    del tasks[task]

    def trust(self) -> TrustSeen:
        """Return the recorded state of the list of trusted keys."""
        found = self._read()
        return TrustSeen(number=found.trusted, revoked=found.revoked)

    def note_trust(self, number: int, revoked: Mapping[str, str]) -> None:
        """Record the number of the list of trusted keys and the revoked keys.

        Raises:
            KeyFileError, OutputError: The record cannot be read or written.
        """
        before = self._read()
        if number > before.trusted or not revoked.keys() <= before.revoked.keys():
            with self._changed() as memory:
                memory.trusted = max(memory.trusted, number)
                memory.revoked = dict(revoked) | memory.revoked

    def set_clock(self, clock: datetime) -> None:
        """Reset the latest time seen to the clock, after an operator has checked the clock.

        Raises:
            KeyFileError, OutputError: The record cannot be read or written.
        """
        with self._changed() as memory:
            memory.latest = clock.timestamp()

    @contextmanager
    def _changed(self) -> Iterator[_Remembered]:
        """Yield the record under an exclusive lock and write it back if the block raises no exception."""
        make_folder(self._files[0].parent)
        with _alone(self._files[0].parent):
            memory = self._read()
            before = memory.model_copy(deep=True)
            yield memory
            if memory != before or not self._files[0].exists():
                data = f"{memory.model_dump_json(indent=1)}\n".encode()
                replace(self._files[0], data)
                for file in self._files[1:]:
                    with suppress(OutputError):
                        if file.parent.is_dir():
                            replace(file, data)

    def _read(self) -> _Remembered:
        """Return the merged copies, with the higher of differing values."""
        merged = _Remembered()
        for file in self._files:
            if not file.exists():
                continue
            try:
                found = _Remembered.model_validate_json(read_guarded(file, private=False, most=64_000_000))
            except (ValidationError, ValueError, RecursionError):
                raise KeyFileError(
                    message("the record of approvals seen on this machine is damaged"),
                    where=str(file),
                    advice=message("restore it; if you remove it, check the trusted keys with fieldhand keys confirm"),
                ) from None
            merged.latest = max(merged.latest, found.latest)
            merged.trusted = max(merged.trusted, found.trusted)
            merged.revoked = found.revoked | merged.revoked
            for signer, tasks in found.seen.items():
                own = merged.seen.setdefault(signer, {})
                for task, one in tasks.items():
                    if task not in own or own[task].number < one.number:
                        own[task] = one
        return merged


def approval_memory(environ: Mapping[str, str]) -> ApprovalMemory:
    """Return the approval record of this configuration, stored in the state folder and beside the keys.

    Raises:
        InputError: The environment names a file instead of a folder, or the user has no home folder.
    """
    config = config_folder(environ)
    # A user may have several configurations; each has its own trusted keys and its own record.
    name = hashlib.sha256(os.fsencode(config.absolute())).hexdigest()[:16]
    return ApprovalMemory(state_folder(environ) / f"approvals-{name}.json", config / "approvals.json")


def trust_store(environ: Mapping[str, str]) -> TrustStore:
    """Return the user's trusted keys, checked against the approval record.

    Raises:
        InputError: The environment names a file instead of a folder, or the user has no home folder.
    """
    return TrustStore(config_folder(environ), memory=approval_memory(environ))


def require_unexpired(manifest: Manifest, now: datetime, clock: datetime, source: str) -> None:
    """Refuse a mission whose approval has expired.

    Args:
        manifest: Manifest of the bundle.
        now: The later of the clock and the latest time seen.
        clock: Current time of this machine.
        source: Name of the bundle in error messages.

    Raises:
        NotApprovedError: The approval has expired.
    """
    if now > manifest.until:
        until, clock_time = manifest.until.isoformat(timespec="seconds"), now.isoformat(timespec="seconds")
        behind = clock < now
        raise NotApprovedError(
            message(
                "could be started until {until}, but this machine has already seen the time {now}",
                until=until,
                now=clock_time,
            )
            if behind
            else message("could be started until {until}, but it is {now}", until=until, now=clock_time),
            where=source,
            advice=message(
                "have it approved again; if that time was wrong, set the clock and run fieldhand keys confirm"
            )
            if behind
            else message("have it approved again"),
        )


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    try:
        import fcntl
    except ImportError:  # a system without such locks
        yield
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)
