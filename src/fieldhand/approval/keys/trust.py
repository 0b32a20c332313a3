"""The keys that a machine trusts: one small file each, which says whose it is, since when, and if it was revoked."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from fieldhand.approval.keys.public import KEY_BYTES, PublicKey, clean_name, parse_fingerprint
from fieldhand.approval.keys.rights import make_folder, read_guarded, replace, require_own
from fieldhand.errors import KeyFileError

State = Literal["trusted", "revoked", "unknown"]


def _moment(text: str) -> str:
    if datetime.fromisoformat(text).tzinfo is None:
        raise ValueError("has no time zone")
    return text


Moment = Annotated[str, AfterValidator(_moment)]


class _Record(BaseModel):
    """The form of the file of a key."""

    model_config = ConfigDict(extra="forbid", strict=True)

    fingerprint: str
    name: str = Field(min_length=1, max_length=200)
    since: Moment
    public_key: str | None = None
    revoked: Moment | None = None


@dataclass(frozen=True, kw_only=True)
class KnownKey:
    """A key that this machine was told of.

    Attributes:
        name: Of whom it is, as the machine's owner says.
        since: When it was trusted, or revoked if it never was; ISO 8601.
        public: None if it was revoked before anyone trusted it.
        revoked: When it was revoked, else None. A revoked key is never trusted again.
    """

    fingerprint: str
    name: str
    since: str
    public: PublicKey | None
    revoked: str | None = None

    @property
    def state(self) -> State:
        """Whether what it signs may run."""
        return "trusted" if self.revoked is None and self.public is not None else "revoked"

    @property
    def in_words(self) -> str:
        """Whose it is, and which."""
        return f"the key of {self.name} ({self.fingerprint})"


class TrustStore:
    """The folder of the keys that are trusted here.

    Args:
        folder: The user's configuration (:func:`fieldhand.files.config_folder`).
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "trusted"

    def known(self) -> Mapping[str, KnownKey]:
        """Every key by its fingerprint, in the order of names.

        Raises:
            KeyFileError: A file cannot be used, or others could have written it.
        """
        try:
            if not self.folder.exists():
                return {}
            for folder in (self.folder.parent, self.folder):
                require_own(folder.stat(), folder, private=False)
            found = [_read(path) for path in sorted(self.folder.glob("*.json"))]
        except OSError as error:
            raise KeyFileError(f"cannot be read: {error.strerror}", where=str(self.folder)) from None
        return {key.fingerprint: key for key in sorted(found, key=lambda k: (k.name, k.fingerprint))}

    def trust(self, public: PublicKey, *, name: str, at: datetime) -> KnownKey:
        """Trust a key from now on; one that is trusted already gets the new name.

        Raises:
            KeyFileError: It was revoked.
            OutputError: The folder cannot be written.
        """
        before = self.known().get(public.fingerprint)
        if before is not None and before.revoked is not None:
            raise KeyFileError(
                f"this key was revoked on {before.revoked}",
                where=public.fingerprint,
                advice="have its owner make a new one; a revoked key is never trusted again",
            )
        since = at.isoformat(timespec="seconds") if before is None else before.since
        return self._write(KnownKey(fingerprint=public.fingerprint, name=clean_name(name), since=since, public=public))

    def revoke(self, fingerprint: str, *, at: datetime) -> KnownKey:
        """Never run again what this key has signed, whenever it did. It need not be known yet.

        Raises:
            KeyFileError: This is no fingerprint.
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
        replace(self.folder / f"{key.fingerprint}.json", f"{record.model_dump_json(indent=2)}\n".encode())
        return key


def _read(path: Path) -> KnownKey:
    data = read_guarded(path, private=False)
    try:
        record = _Record.model_validate_json(data)
        raw = None if record.public_key is None else base64.b64decode(record.public_key, validate=True)
    except (ValidationError, ValueError, RecursionError):
        raise _damaged(path) from None
    public = None if raw is None else PublicKey(raw=raw, name=record.name)
    # The name of the file and what it says must agree: a key under the name of another is nobody's.
    if record.fingerprint != path.stem or (public is None and record.revoked is None):
        raise _damaged(path)
    if public is not None and (len(public.raw) != KEY_BYTES or public.fingerprint != record.fingerprint):
        raise _damaged(path)
    return KnownKey(
        fingerprint=record.fingerprint, name=record.name, since=record.since, public=public, revoked=record.revoked
    )


def _damaged(path: Path) -> KeyFileError:
    return KeyFileError("is damaged", where=str(path), advice="take the file away, and trust or revoke the key again")
