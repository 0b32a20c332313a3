"""A person's signing keys: PKCS #8 files in the user's folder, optionally encrypted with a passphrase."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.approval.keys.names import clean_name
from fieldhand.approval.keys.public import PublicKey, parse_public
from fieldhand.approval.keys.rights import make_folder, read_guarded, replace, require_own_folder, write_new
from fieldhand.errors import KeyFileError

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

_MAKE_ONE = "make one with fieldhand keys new, and have the robot trust it"


@dataclass(frozen=True, kw_only=True)
class SigningKey:
    """An opened private key with its public key."""

    public: PublicKey
    _private: Ed25519PrivateKey = field(repr=False)

    def sign(self, message: bytes) -> bytes:
        """Return the signature of a message, 64 bytes; deterministic."""
        return self._private.sign(message)


@dataclass(frozen=True, kw_only=True)
class OwnKey:
    """A key file in the folder, not opened.

    Attributes:
        encrypted: True if the file needs a passphrase.
    """

    file: Path
    public: PublicKey
    encrypted: bool


class SigningKeys:
    """The folder of a person's own keys.

    Args:
        folder: Configuration folder of the user (:func:`fieldhand.files.config_folder`).
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "keys"

    def make(self, name: str, passphrase: str | None = None) -> tuple[SigningKey, Path]:
        """Create and store a key under a name.

        Args:
            name: Name of the owner; a robot shows it unless its owner assigns another.
            passphrase: Passphrase that encrypts the file; None for an unencrypted file.

        Returns:
            The key, and the path of the file with its public key.

        Raises:
            KeyFileError: The name is invalid, or the key exists already.
            OutputError: The folder cannot be written.
        """
        from cryptography.hazmat.primitives import serialization
        from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

        name = clean_name(name)
        private = Ed25519PrivateKey.generate()
        encryption = (
            serialization.BestAvailableEncryption(passphrase.encode()) if passphrase else serialization.NoEncryption()
        )
        pem = private.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, encryption)
        key = _signing(private, name)
        make_folder(self.folder)
        file = self.folder / f"{_file_name(name)}.key"
        shared = file.with_suffix(".pub")
        if shared.exists():
            raise KeyFileError(
                "there is already a key with this name", where=str(shared), advice="choose another --name"
            )
        write_new(file, pem)
        write_new(shared, f"{key.public.line()}\n".encode())
        return key, shared

    def held(self) -> tuple[OwnKey, ...]:
        """Return every key of the folder, sorted by name.

        Raises:
            KeyFileError: A key file is invalid.
        """
        found = []
        try:
            if not self.folder.exists():
                return ()
            require_own_folder(self.folder)
            files = sorted(self.folder.glob("*.key"))
        except OSError as error:
            raise KeyFileError(
                f"cannot be read: {error.strerror}",
                where=str(self.folder),
                advice="check the permissions of the folder",
            ) from None
        for file in files:
            shared = file.with_suffix(".pub")
            public = parse_public(_text(read_guarded(shared, private=False), shared), source=str(shared))
            encrypted = b"BEGIN ENCRYPTED PRIVATE KEY" in read_guarded(file, private=True)
            found.append(OwnKey(file=file, public=public, encrypted=encrypted))
        return tuple(found)

    def choose(self, name: str | None = None) -> OwnKey:
        """Return the key of that name, or the only key if no name is given.

        Raises:
            KeyFileError: There is no such key, or there are several and no name is given.
        """
        keys = self.held()
        if not keys:
            raise KeyFileError("there is no key to sign with", where=str(self.folder), advice=_MAKE_ONE)
        chosen = [key for key in keys if name is None or name in (key.public.name, key.public.fingerprint)]
        names = ", ".join(key.public.name for key in keys)
        if not chosen:
            raise KeyFileError(f"there is no key {name!r}", where="--key", advice=f"choose one of: {names}")
        if len(chosen) > 1:
            raise KeyFileError("there are several keys", where="--key", advice=f"choose one of: {names}")
        return chosen[0]

    def next_number(self, key: OwnKey, at: datetime) -> int:
        """Return the number of the key's next approval: the time in seconds, but higher than every earlier number.

        Raises:
            KeyFileError: The stored last number cannot be read.
            OutputError: The number cannot be stored.
        """
        file = key.file.with_suffix(".number")
        try:
            last = int(read_guarded(file, private=False)) if file.exists() else 0
        except ValueError:
            raise KeyFileError(
                "holds no number", where=str(file), advice="remove it; the current time is then used instead"
            ) from None
        number = max(last + 1, int(at.timestamp()), 1)
        replace(file, f"{number}\n".encode())
        return number

    def open(self, key: OwnKey, passphrase: Callable[[], str | None]) -> SigningKey:
        """Open a key file, asking for its passphrase if needed.

        Args:
            key: Key of this folder.
            passphrase: Called for the passphrase if the key is encrypted.

        Raises:
            KeyFileError: The file is invalid or readable by others, or the passphrase is missing or wrong.
        """
        from cryptography.exceptions import UnsupportedAlgorithm
        from cryptography.hazmat.primitives import serialization
        from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

        data = read_guarded(key.file, private=True)
        at = str(key.file)
        secret = passphrase() if key.encrypted else None
        if key.encrypted and not secret:
            raise KeyFileError(
                "the key needs a passphrase",
                where=at,
                advice="type it when asked, or put it in FIELDHAND_KEY_PASSPHRASE",
            )
        try:
            private = serialization.load_pem_private_key(data, secret.encode() if secret else None)
        except (ValueError, TypeError, UnsupportedAlgorithm):
            if key.encrypted:
                raise KeyFileError("the passphrase is wrong, or the file is damaged", where=at) from None
            raise KeyFileError("is not a private key (PKCS #8, PEM)", where=at, advice=_MAKE_ONE) from None
        if not isinstance(private, Ed25519PrivateKey):
            raise KeyFileError("is a key of another kind, not Ed25519", where=at, advice=_MAKE_ONE)
        opened = _signing(private, key.public.name)
        if opened.public != key.public:
            raise KeyFileError("does not belong to the public key beside it", where=at, advice=_MAKE_ONE)
        return opened


def _signing(private: Ed25519PrivateKey, name: str) -> SigningKey:
    return SigningKey(public=PublicKey(raw=private.public_key().public_bytes_raw(), name=name), _private=private)


def _file_name(name: str) -> str:
    plain = re.sub(r"[^\w.-]+", "-", name.lower()).strip(".-")
    if not plain:
        raise KeyFileError("this cannot be a file name", where="--name", advice="give a name with a letter in it")
    return plain


def _text(data: bytes, path: Path) -> str:
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise KeyFileError("is not UTF-8 text", where=str(path), advice="check the path") from None
