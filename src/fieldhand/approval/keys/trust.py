"""Keys that a machine trusts: one small file each, with owner, date of trust, and date of revocation."""

from __future__ import annotations

import base64
import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Annotated, Literal, Protocol

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from fieldhand.approval.keys.names import clean_name, look_alike
from fieldhand.approval.keys.public import KEY_BYTES, PublicKey, parse_fingerprint, require_sound
from fieldhand.approval.keys.rights import make_folder, read_guarded, replace, require_own_folder
from fieldhand.compatibility import UTC, datetime_from_iso
from fieldhand.errors import KeyFileError
from fieldhand.language import message

#: File with the number of the list, in the folder of the keys.
_LIST = "list.json"
KeyState = Literal["trusted", "revoked", "unknown"]


def _moment(text: str) -> str:
    if datetime_from_iso(text).tzinfo is None:
        raise ValueError("has no time zone")
    return text


Moment = Annotated[str, AfterValidator(_moment)]


class _Record(BaseModel):
    """Schema of a key file."""

    model_config = ConfigDict(extra="forbid", strict=True)

    fingerprint: str
    name: str = Field(min_length=1, max_length=200)
    since: Moment
    public_key: str | None = None
    revoked: Moment | None = None


@dataclass(frozen=True, kw_only=True)
class KnownKey:
    """A key listed on this machine, trusted or revoked.

    Attributes:
        name: Owner of the key, as named by the owner of the machine.
        since: Time at which the key was trusted, or revoked if it never was trusted; ISO 8601.
        public: Public key; None if the key was revoked before it was ever trusted.
        revoked: Time of revocation, or None. A revoked key can never be trusted again.
    """

    fingerprint: str
    name: str
    since: str
    public: PublicKey | None
    revoked: str | None = None

    @property
    def state(self) -> KeyState:
        """Return the trust state, which decides about running what the key signed."""
        return "trusted" if self.revoked is None and self.public is not None else "revoked"

    @property
    def in_words(self) -> str:
        """Return the owner's name and the fingerprint."""
        return message("the key of {name} ({fingerprint})", name=self.name, fingerprint=self.fingerprint)


@dataclass(frozen=True, kw_only=True)
class TrustSeen:
    """Recorded state of the trusted keys, stored apart from them.

    Attributes:
        number: Highest number of the list seen.
        revoked: Time of revocation of each key, by fingerprint.
    """

    number: int = 0
    revoked: Mapping[str, str] = field(default_factory=dict)


class TrustMemory(Protocol):
    """Persistent record of the list of trusted keys (:class:`fieldhand.approval.memory.ApprovalMemory`)."""

    def trust(self) -> TrustSeen:
        """Return the recorded state."""
        ...

    def note_trust(self, number: int, revoked: Mapping[str, str]) -> None:
        """Record the number and revocations of a list."""
        ...

    def time(self, clock: datetime) -> datetime:
        """Return the clock, or the latest time seen if that is later."""
        ...


class _List(BaseModel):
    """Schema of the list file: a number that rises with each change, and an optional expiry date."""

    model_config = ConfigDict(extra="forbid", strict=True)

    number: int = Field(default=0, ge=0)
    until: Moment | None = None


class TrustStore:
    """The folder of the keys trusted by this machine.

    Args:
        folder: Configuration folder of the user (:func:`fieldhand.files.config_folder`).
        memory: Record of revocations and of the highest list number; None for no record.
        clock: Current time, for a list with an expiry date.
    """

    def __init__(
        self,
        folder: Path,
        memory: TrustMemory | None = None,
        clock: Callable[[], datetime] = lambda: datetime.now(UTC),
    ) -> None:
        self.folder = folder / "trusted"
        self._memory, self._clock = memory, clock

    def known(self) -> Mapping[str, KnownKey]:
        """Return every key by fingerprint, sorted by name.

        Raises:
            KeyFileError: A file is invalid or writable by others, or the list is an older copy or has expired.
        """
        if self._memory is None:
            return self._files()
        listed, seen = self._list(), self._memory.trust()
        found = self._with_revoked(seen)
        if listed.number < seen.number:
            raise KeyFileError(
                f"the list of trusted keys is an older copy: it has number {listed.number},"
                f" but {seen.number} was already seen",
                where=str(self.folder),
                advice="restore the later one, or check the keys and run fieldhand keys confirm",
            )
        if listed.until is not None and self._memory.time(self._clock()) > datetime_from_iso(listed.until):
            raise KeyFileError(
                f"the list of trusted keys expired at {listed.until}",
                where=str(self.folder),
                advice="check the keys and run fieldhand keys confirm",
            )
        return found

    def confirm(self, until: datetime | None = None) -> None:
        """Accept the present list as the latest, valid until a date if one is given; revoked keys remain revoked.

        Raises:
            KeyFileError: A file is invalid.
            OutputError: The folder cannot be written.
        """
        self._advance(None if until is None else until.isoformat(timespec="seconds"))

    def listed(self) -> Mapping[str, KnownKey]:
        """Return every key from its file without checking the list number; recorded revocations apply.

        Raises:
            KeyFileError: A file is invalid or writable by others.
        """
        return self._with_revoked(TrustSeen() if self._memory is None else self._memory.trust())

    def _with_revoked(self, seen: TrustSeen) -> Mapping[str, KnownKey]:
        found = dict(self._files())
        for fingerprint, revoked in seen.revoked.items():
            before = found.get(fingerprint)
            if before is None:
                found[fingerprint] = KnownKey(
                    fingerprint=fingerprint, name="unknown", since=revoked, public=None, revoked=revoked
                )
            elif before.revoked is None:
                found[fingerprint] = dataclasses.replace(before, revoked=revoked)
        return found

    def _list(self) -> _List:
        path = self.folder / _LIST
        if not path.exists():
            return _List()
        try:
            return _List.model_validate_json(read_guarded(path, private=False))
        except (ValidationError, ValueError, RecursionError):
            raise _damaged(path) from None

    def _advance(self, until: str | None) -> None:
        """Increment the number of the list and record it with every revoked key."""
        seen = TrustSeen() if self._memory is None else self._memory.trust()
        number = max(self._list().number, seen.number) + 1
        make_folder(self.folder)
        text = _List(number=number, until=until).model_dump_json(exclude_none=True)
        replace(self.folder / _LIST, f"{text}\n".encode())
        if self._memory is not None:
            revoked = {key.fingerprint: key.revoked for key in self._files().values() if key.revoked is not None}
            self._memory.note_trust(number, revoked)

    def _files(self) -> Mapping[str, KnownKey]:
        try:
            if not self.folder.exists():
                return {}
            require_own_folder(self.folder)
            found = [_read(path) for path in sorted(self.folder.glob("*.json")) if path.name != _LIST]
        except OSError as error:
            raise KeyFileError(f"cannot be read: {error.strerror}", where=str(self.folder)) from None
        return {key.fingerprint: key for key in sorted(found, key=lambda k: (k.name, k.fingerprint))}

    def trust(self, public: PublicKey, *, name: str, at: datetime) -> KnownKey:
        """Trust a key from now on; a key that is trusted already is renamed.

        Raises:
            KeyFileError: The key was revoked or is unsafe, or its name resembles that of another trusted key.
            OutputError: The folder cannot be written.
        """
        require_sound(public.raw, public.fingerprint)
        name, known = clean_name(name), self.known()
        _require_other_name(name, public.fingerprint, known)
        before = known.get(public.fingerprint)
        if before is not None and before.revoked is not None:
            raise KeyFileError(
                f"this key was revoked on {before.revoked}",
                where=public.fingerprint,
                advice="have its owner make a new one; a revoked key is never trusted again",
            )
        since = at.isoformat(timespec="seconds") if before is None else before.since
        return self._write(KnownKey(fingerprint=public.fingerprint, name=name, since=since, public=public))

    def revoke(self, fingerprint: str, *, at: datetime) -> KnownKey:
        """Revoke a key, so that nothing it has ever signed runs again; the key need not be listed.

        Raises:
            KeyFileError: The text is not a fingerprint.
            OutputError: The folder cannot be written.
        """
        fingerprint = parse_fingerprint(fingerprint)
        now = at.isoformat(timespec="seconds")
        before = self.known().get(fingerprint)
        if before is None:
            return self._write(KnownKey(fingerprint=fingerprint, name="unknown", since=now, public=None, revoked=now))
        if before.revoked is not None:
            return before
        return self._write(
            KnownKey(fingerprint=fingerprint, name=before.name, since=before.since, public=before.public, revoked=now)
        )

    def _write(self, key: KnownKey) -> KnownKey:
        record = _Record(
            fingerprint=key.fingerprint,
            name=key.name,
            since=key.since,
            public_key=None if key.public is None else base64.b64encode(key.public.raw).decode(),
            revoked=key.revoked,
        )
        make_folder(self.folder)
        until = self._list().until
        replace(self.folder / f"{key.fingerprint}.json", f"{record.model_dump_json(indent=2)}\n".encode())
        self._advance(until)
        return key


def _read(path: Path) -> KnownKey:
    data = read_guarded(path, private=False)
    try:
        record = _Record.model_validate_json(data)
        raw = None if record.public_key is None else base64.b64decode(record.public_key, validate=True)
    except (ValidationError, ValueError, RecursionError):
        raise _damaged(path) from None
    public = None if raw is None else PublicKey(raw=raw, name=record.name)
    # The file name must match the fingerprint of the key inside, or the file was tampered with.
    if record.fingerprint != path.stem or (public is None and record.revoked is None):
        raise _damaged(path)
    if public is not None and (len(public.raw) != KEY_BYTES or public.fingerprint != record.fingerprint):
        raise _damaged(path)
    if public is not None:
        require_sound(public.raw, str(path))
    return KnownKey(
        fingerprint=record.fingerprint, name=record.name, since=record.since, public=public, revoked=record.revoked
    )


def _damaged(path: Path) -> KeyFileError:
    return KeyFileError("is damaged", where=str(path), advice="move the file away, and trust or revoke the key again")


def _require_other_name(name: str, fingerprint: str, known: Mapping[str, KnownKey]) -> None:
    """Refuse a name that a person may mistake for that of another trusted key.

    Raises:
        KeyFileError: The name resembles that of a trusted key.
    """
    for other in known.values():
        if other.state == "trusted" and other.fingerprint != fingerprint and look_alike(other.name, name):
            raise KeyFileError(
                f"the name '{name}' looks like '{other.name}', whose key {other.fingerprint} is trusted here",
                where="--name",
                advice="give a name that tells them apart, such as --name 'Ada, office'; or revoke the other key first",
            )
