"""The store of the missions that a robot has received: each is complete and verified, or absent.

    depot.sqlite            missions that were received; one process at a time has it open
    bundles/SHA256.mission  signed missions, under names that are computed here
    incoming/               incomplete uploads; removed at every start
    missions/               folders of the missions that were begun

A mission is added to the database after its file is on disk, so that a power cut leaves either all of it or nothing.
"""

from __future__ import annotations

import hashlib
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand import missions
from fieldhand.compatibility import datetime_from_iso
from fieldhand.delivery.bundle_checks import Accept
from fieldhand.delivery.incoming_file import IncomingFile, unwritable
from fieldhand.delivery.received_missions import ReceivedMission, ReceivedMissions, RecordedRun
from fieldhand.errors import BundleError, ExecutionError, StoreError
from fieldhand.files import move_whole
from fieldhand.folders import Unguarded, require_guarded

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle


class MissionStore:
    """The missions of one robot; one process at a time has it open.

    Args:
        folder: Folder of the store; made if it does not exist.
        accept: Opens a signed mission, and raises an error if it may not run here.
        now: Returns the current time, with time zone; recorded only, no decision depends on it.
        admit: Raises an error if the approval has expired or was superseded; called on receipt and at the start.

    Raises:
        StoreError: Another process has the store open, it is damaged, or it cannot be written.
    """

    def __init__(
        self,
        folder: Path,
        *,
        accept: Accept,
        now: Callable[[], datetime],
        admit: Callable[[Bundle], object] = lambda _: None,
    ) -> None:
        self.missions = folder / "missions"
        self._folder, self._accept, self._now, self._admit = folder, accept, now, admit
        self._bundles, self._incoming = folder / "bundles", folder / "incoming"
        self._lock = threading.Lock()
        try:
            for one in (folder, self.missions, self._bundles, self._incoming):
                one.mkdir(mode=0o700, parents=True, exist_ok=True)
            require_guarded(folder)
        except Unguarded as fault:
            raise StoreError(
                fault.what, where=str(fault.path), advice=f"{fault.advice}; or give another folder with --store"
            ) from None
        except OSError as error:
            raise unwritable(folder, error) from None
        self._database = ReceivedMissions(folder / "depot.sqlite")
        self._recover()

    def close(self) -> None:
        """Close the database and release the lock."""
        self._database.close()

    # --- arrive --------------------------------------------------------------------------------------------------

    @contextmanager
    def receiving(self) -> Iterator[IncomingFile]:
        """Open a temporary file for an upload, which is removed at the end unless :meth:`take` stored it.

        Raises:
            StoreError: The disk cannot be written.
        """
        try:
            descriptor, name = tempfile.mkstemp(dir=self._incoming)
        except OSError as error:
            raise unwritable(self._incoming, error) from None
        incoming = IncomingFile(Path(name), descriptor)
        try:
            yield incoming
        finally:
            incoming.drop()

    def take(self, incoming: IncomingFile, expected: str) -> tuple[ReceivedMission, bool]:
        """Verify and store an upload, so that its mission may be begun.

        Args:
            incoming: The complete upload.
            expected: SHA-256 that the sender computed.

        Returns:
            The mission, and True if it was not received before.

        Raises:
            BundleError: The upload has another SHA-256, or is not a mission for this robot.
            NotTrustedError: Its key is not trusted here.
            ExecutionError: The same mission was received with a later approval.
            StoreError: The disk cannot be written.
        """
        sha256 = incoming.settle()
        if sha256 != expected:
            raise BundleError(
                f"what arrived has SHA-256 {sha256}, what was sent {expected}",
                where="upload",
                advice="send it again",
            )
        try:
            data = incoming.path.read_bytes()
        except OSError as error:
            raise unwritable(incoming.path, error) from None
        bundle = self._verified(data, sha256)
        with self._lock:
            known = self.find(sha256)
            if known is None:
                self._require_latest(bundle)
                self._admit(bundle)
            self._put(incoming, sha256)
            if known is None:
                self._note(bundle)
            return self.get(sha256), known is None

    def _verified(self, data: bytes, sha256: str) -> Bundle:
        bundle = self._accept(data, f"mission {sha256[:16]}")
        if bundle.hashes["bundle"] != sha256:
            raise StoreError("the disk returns different bytes from those that were written", where=str(self._folder))
        return bundle

    def _put(self, incoming: IncomingFile, sha256: str) -> None:
        path = self._path(sha256)
        try:
            move_whole(incoming.path, path)
        except OSError as error:
            raise unwritable(path, error) from None

    def _note(self, bundle: Bundle) -> None:
        task = bundle.authorized.task
        self._database.note(
            ReceivedMission(
                sha256=bundle.hashes["bundle"],
                task=task.id,
                request=task.command.request,
                signer=bundle.signer.name,
                approved_at=_seconds(bundle),
                received_at=self._now().isoformat(timespec="seconds"),
                hashes=dict(bundle.hashes),
                begun_at=None,
            )
        )

    def _require_latest(self, bundle: Bundle) -> None:
        later = self._database.later(bundle.authorized.task.id, _seconds(bundle))
        if later is not None:
            raise _superseded(later)

    # --- look ----------------------------------------------------------------------------------------------------

    def find(self, sha256: str) -> ReceivedMission | None:
        """Return the mission of a SHA-256; None if it was not received."""
        return self._database.find(sha256)

    def get(self, sha256: str) -> ReceivedMission:
        """Return the mission of a SHA-256.

        Raises:
            StoreError: It was not received.
        """
        found = self.find(sha256)
        if found is None:
            raise StoreError("no such mission has arrived", where=sha256[:16], advice="send it first")
        return found

    def latest(self, most: int) -> tuple[ReceivedMission, ...]:
        """Return the missions that were received last, in the order in which they arrived."""
        return self._database.latest(most)

    def last_begun(self) -> ReceivedMission | None:
        """Return the mission that was begun last; None if there is none."""
        return self._database.last_begun()

    def kept(self) -> tuple[ReceivedMission, ...]:
        """Return the missions whose timetable is kept."""
        return self._database.kept()

    def pending(self) -> tuple[ReceivedMission, ...]:
        """Return the runs that are due and have neither begun nor been left out, the earliest first."""
        return self._database.pending()

    def runs(self, received: ReceivedMission, most: int) -> tuple[ReceivedMission, ...]:
        """Return the latest runs of a mission with a timetable, in order."""
        return self._database.runs(received.bundle, most)

    def folder_of(self, received: ReceivedMission) -> Path:
        """Return the folder of a mission, which exists once it was begun."""
        return self.missions / received.name

    def verify(self, data: bytes, source: str) -> Bundle:
        """Open a signed mission, and verify that it may run here now.

        Raises:
            BundleError: It is damaged, or for another robot or site.
            NotTrustedError: Its key is not trusted now.
        """
        return self._accept(data, source)

    # --- timetables ----------------------------------------------------------------------------------------------

    def keep(self, received: ReceivedMission, since: datetime) -> None:
        """Record that the timetable of a mission is kept from now on.

        Raises:
            StoreError: The database cannot be written.
        """
        self._database.keep(received.sha256, since.timestamp())

    def end(self, received: ReceivedMission, why: str) -> None:
        """Record that the timetable of a mission is no longer kept."""
        self._database.end(received.sha256, why)

    def add_run(self, received: ReceivedMission, run: RecordedRun) -> ReceivedMission:
        """Record a run of a mission that is due; one that is known already is returned as it stands."""
        made = replace(received.with_run(run), received_at=self._now().isoformat(timespec="seconds"))
        known = self.find(made.sha256)
        if known is None:
            self._database.note(made)
            if run.missed:
                self._database.miss(made.sha256, run.missed)
        return known or self.get(made.sha256)

    def miss(self, received: ReceivedMission, why: str) -> None:
        """Record that a run is left out."""
        self._database.miss(received.sha256, why)

    # --- begin ---------------------------------------------------------------------------------------------------

    def read(self, received: ReceivedMission) -> Bundle:
        """Open a mission that was received, and verify it again.

        Raises:
            BundleError: It is damaged.
            StoreError: Its file was changed.
            NotTrustedError: Its key was revoked meanwhile.
        """
        path = self._path(received.bundle)
        try:
            data = path.read_bytes()
        except OSError as error:
            raise StoreError(
                f"the bundle cannot be read: {error.strerror}", where=str(path), advice="send it again"
            ) from None
        if hashlib.sha256(data).hexdigest() != received.bundle:
            raise StoreError("the bundle differs from what arrived", where=str(path), advice="send it again")
        return self._verified(data, received.bundle)

    def open(self, sha256: str) -> Bundle:
        """Open a mission that may be begun now, and verify it again.

        Raises:
            ExecutionError: It was begun before, or was received with a later approval.
            BundleError: It is damaged.
            StoreError: It was not received, or its file was changed.
            NotTrustedError: Its key was revoked meanwhile.
        """
        received = self.get(sha256)
        if received.begun_at is not None:
            raise ExecutionError(
                f"this mission was started at {received.begun_at}; it does not run twice", where=received.name
            )
        later = self._database.later(received.task, received.approved_at)
        if later is not None:
            raise _superseded(later)
        bundle = self.read(received)
        self._admit(bundle)
        return bundle

    def note_begun(self, sha256: str) -> None:
        """Record that a mission was begun, so that it never begins again, even if its folder is removed.

        Raises:
            StoreError: The database cannot be written.
        """
        self._database.note_begun(sha256, self._now().isoformat(timespec="seconds"))

    def _path(self, sha256: str) -> Path:
        return self._bundles / f"{sha256}.mission"

    def _recover(self) -> None:
        """Remove incomplete uploads, and record each mission as begun that has a folder."""
        known = self._database.all()
        names = {f"{received.bundle}.mission" for received in known}
        for received in known:
            if received.begun_at is None and missions.exists(self.folder_of(received)):
                self.note_begun(received.sha256)
        try:
            for path in (*self._incoming.iterdir(), *self._bundles.iterdir()):
                if path.parent == self._incoming or path.name not in names:
                    path.unlink()
        except OSError as error:
            raise unwritable(self._folder, error) from None


def _superseded(later: ReceivedMission) -> ExecutionError:
    return ExecutionError(
        f"the same mission is here with a later approval ({later.name})",
        where=later.task,
        advice="run that one, or have this one approved again",
    )


def _seconds(bundle: Bundle) -> float:
    """Return the time of the approval in seconds since 1970, which can be compared across time zones."""
    return datetime_from_iso(bundle.manifest.approved.at).timestamp()
