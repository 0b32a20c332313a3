"""The store of the missions that a robot has received: each is complete and verified, or absent.

    depot.sqlite            what arrived, and when; one process at a time holds it
    bundles/SHA256.mission  the bundles, under names that are computed here
    incoming/               what is still arriving; emptied at every start
    missions/               the folders of those that were begun

A bundle counts once its line is in the database, and that is written after the bundle is safe on the disk. So a power
cut at any instant leaves a mission that is there or one that is not.
"""

from __future__ import annotations

import hashlib
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand import missions
from fieldhand.delivery.bundle_checks import Accept
from fieldhand.delivery.incoming_file import IncomingFile, unwritable
from fieldhand.delivery.received_missions import ReceivedMission, ReceivedMissions
from fieldhand.errors import BundleError, ExecutionError, StoreError
from fieldhand.files import move_whole
from fieldhand.folders import Unguarded, require_guarded

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle


class MissionStore:
    """The missions of one robot; one process at a time has it open.

    Args:
        folder: It is made if it is not there.
        accept: Reads a bundle, and refuses what may not run here.
        now: With time zone; for the record only, nothing is decided by it.
        admit: Refuses a mission whose approval has run out or was superseded, when it arrives and when it begins.

    Raises:
        StoreError: Another process has it open, it is damaged, or it cannot be written.
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
        self._guard = threading.Lock()
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
        self._ledger = ReceivedMissions(folder / "depot.sqlite")
        self._sweep()

    def close(self) -> None:
        """Close the database and release the lock."""
        self._ledger.close()

    # --- arrive --------------------------------------------------------------------------------------------------

    @contextmanager
    def receiving(self) -> Iterator[IncomingFile]:
        """A place for what arrives. It is gone at the end, unless :meth:`take` has taken it.

        Raises:
            StoreError: Nothing can be written.
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

    def take(self, incoming: IncomingFile, told: str) -> tuple[ReceivedMission, bool]:
        """Verify what has arrived and keep it; from then on it may be begun.

        Args:
            incoming: All that has arrived.
            told: The SHA-256 that the sender gave.

        Returns:
            The mission, and whether it is new here.

        Raises:
            BundleError: It is not what was sent, or no mission for this robot.
            NotTrustedError: Nobody who is trusted here has signed it.
            ExecutionError: The same mission is here with a later approval.
            StoreError: It cannot be written.
        """
        sha256 = incoming.settle()
        if sha256 != told:
            raise BundleError(
                f"what arrived has SHA-256 {sha256}, what was sent {told}",
                where="upload",
                advice="send it again",
            )
        try:
            data = incoming.path.read_bytes()
        except OSError as error:
            raise unwritable(incoming.path, error) from None
        bundle = self._verified(data, sha256)
        with self._guard:
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
            raise StoreError("the disk gives back other bytes than were written", where=str(self._folder))
        return bundle

    def _put(self, incoming: IncomingFile, sha256: str) -> None:
        path = self._path(sha256)
        try:
            move_whole(incoming.path, path)
        except OSError as error:
            raise unwritable(path, error) from None

    def _note(self, bundle: Bundle) -> None:
        task = bundle.authorized.task
        self._ledger.note(
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
        later = self._ledger.later(bundle.authorized.task.id, _seconds(bundle))
        if later is not None:
            raise _superseded(later)

    # --- look ----------------------------------------------------------------------------------------------------

    def find(self, sha256: str) -> ReceivedMission | None:
        """The mission of that bundle, if it has arrived."""
        return self._ledger.find(sha256)

    def get(self, sha256: str) -> ReceivedMission:
        """The mission of that bundle.

        Raises:
            StoreError: It has not arrived.
        """
        found = self.find(sha256)
        if found is None:
            raise StoreError("no such mission has arrived", where=sha256[:16], advice="send it first")
        return found

    def latest(self, most: int) -> tuple[ReceivedMission, ...]:
        """Those that arrived last, in the order in which they came."""
        return self._ledger.latest(most)

    def last_begun(self) -> ReceivedMission | None:
        """The one that was begun last."""
        return self._ledger.last_begun()

    def folder_of(self, received: ReceivedMission) -> Path:
        """Where a mission is kept once it was begun."""
        return self.missions / received.name

    def verify(self, data: bytes, source: str) -> Bundle:
        """A bundle that may run here now, verified.

        Raises:
            BundleError: It is broken, or is of another robot or site.
            NotTrustedError: Nobody who is trusted now has signed it.
        """
        return self._accept(data, source)

    # --- begin ---------------------------------------------------------------------------------------------------

    def open(self, sha256: str) -> Bundle:
        """The bundle of a mission that may be begun now, verified again.

        Raises:
            ExecutionError: It was begun before, or the same mission is here with a later approval.
            BundleError, StoreError: It is not what arrived any more, or has not arrived.
            NotTrustedError: Its key was revoked since.
        """
        received = self.get(sha256)
        if received.begun_at is not None:
            raise ExecutionError(
                f"this mission was begun at {received.begun_at}; it does not run twice", where=received.name
            )
        later = self._ledger.later(received.task, received.approved_at)
        if later is not None:
            raise _superseded(later)
        path = self._path(sha256)
        try:
            data = path.read_bytes()
        except OSError as error:
            raise StoreError(
                f"the bundle cannot be read: {error.strerror}", where=str(path), advice="send it again"
            ) from None
        if hashlib.sha256(data).hexdigest() != sha256:
            raise StoreError("the bundle is not what arrived", where=str(path), advice="send it again")
        bundle = self._verified(data, sha256)
        self._admit(bundle)
        return bundle

    def note_begun(self, sha256: str) -> None:
        """Keep that a mission was begun: it is never begun again, whatever becomes of its folder.

        Raises:
            StoreError: That cannot be written.
        """
        self._ledger.note_begun(sha256, self._now().isoformat(timespec="seconds"))

    def _path(self, sha256: str) -> Path:
        return self._bundles / f"{sha256}.mission"

    def _sweep(self) -> None:
        """Leave nothing of what did not arrive, and know of each mission that was begun that it was."""
        known = self._ledger.all()
        names = {f"{received.sha256}.mission" for received in known}
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
    """When it was approved, in seconds since 1970: the dates of two time zones can be compared."""
    return datetime.fromisoformat(bundle.manifest.approved.at).timestamp()
