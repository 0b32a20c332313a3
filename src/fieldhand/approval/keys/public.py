"""A public key (Ed25519, RFC 8032) as one line that can be sent by mail, and its fingerprint, to be read out."""

from __future__ import annotations

import base64
import binascii
import hashlib
import re
from dataclasses import dataclass

from fieldhand.approval.keys.curve import is_sound
from fieldhand.approval.keys.names import clean_name
from fieldhand.errors import KeyFileError

#: What a line with a public key begins with.
MARK = "fieldhand-ed25519"
KEY_BYTES = 32
#: 160 bits: nobody finds a second key with the same fingerprint.
_FINGERPRINT_BYTES = 20
_LINE = re.compile(rf"[>\s]*{MARK} +([A-Za-z0-9+/=]+)(?: +(.*))?")


@dataclass(frozen=True, kw_only=True)
class PublicKey:
    """A key with which signatures are checked.

    Attributes:
        raw: Its 32 bytes.
        name: Of whom it is, as its owner says; empty if nothing is said.
    """

    raw: bytes
    name: str = ""

    @property
    def fingerprint(self) -> str:
        """Eight groups of four letters and digits (base 32, without 0, 1, 8 and 9), of the SHA-256 of the key."""
        text = base64.b32encode(hashlib.sha256(self.raw).digest()[:_FINGERPRINT_BYTES]).decode()
        return grouped(text)

    def line(self) -> str:
        """The key as one line of text; :func:`parse_public` reads it."""
        return " ".join(part for part in (MARK, base64.b64encode(self.raw).decode(), self.name) if part)

    def verifies(self, signature: bytes, message: bytes) -> bool:
        """Return True if the key's owner signed exactly this message; False for a key that nobody can own."""
        from cryptography.exceptions import InvalidSignature
        from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

        if not is_sound(self.raw):
            return False
        try:
            Ed25519PublicKey.from_public_bytes(self.raw).verify(signature, message)
        except (InvalidSignature, ValueError):
            return False
        return True


def parse_public(text: str, *, source: str) -> PublicKey:
    """The public key in a text, such as a mail that holds its line.

    Raises:
        KeyFileError: There is none, or more than one.
    """
    if "PRIVATE KEY" in text:
        raise KeyFileError(
            "this is a private key, which never leaves its machine",
            where=source,
            advice="give the line that fieldhand keys new printed; if the file was sent to anyone, make a new key",
        )
    lines = (_LINE.fullmatch(line.rstrip()) for line in text.split("\n"))
    found = {match.groups() for match in lines if match is not None}
    if len(found) != 1:
        what = "no public key stands here" if not found else f"{len(found)} public keys stand here"
        raise KeyFileError(what, where=source, advice=f"give a file with one line that begins with {MARK}")
    encoded, name = found.pop()
    return PublicKey(raw=_raw(encoded, source), name=clean_name(name or "", source) if name else "")


def parse_fingerprint(text: str) -> str:
    """A fingerprint as it is written here, from how people type it: small letters, other groups or none.

    Raises:
        KeyFileError: It is none.
    """
    plain = re.sub(r"[\s-]", "", text).upper()
    if not re.fullmatch(r"[A-Z2-7]{32}", plain):
        raise KeyFileError(
            "this is no fingerprint",
            where=repr(text[:60]),
            advice="give all eight groups of four, as fieldhand keys list shows them",
        )
    return grouped(plain)


def grouped(text: str) -> str:
    """``ABCDEFGH`` as ``ABCD-EFGH``."""
    return "-".join(text[k : k + 4] for k in range(0, len(text), 4))


def _raw(encoded: str, source: str) -> bytes:
    try:
        raw = base64.b64decode(encoded, validate=True)
    except (binascii.Error, ValueError):
        raw = b""
    if len(raw) != KEY_BYTES or base64.b64encode(raw).decode() != encoded:
        raise KeyFileError("the public key is damaged", where=source, advice="ask its owner to send the line again")
    require_sound(raw, source)
    return raw


def require_sound(raw: bytes, source: str) -> None:
    """Refuse a key with which signatures could be made without a private key.

    Raises:
        KeyFileError: It is one.
    """
    if not is_sound(raw):
        raise KeyFileError(
            "this is no Ed25519 public key that anyone can own: anybody could sign with it",
            where=source,
            advice="do not trust whoever sent it; a key is made with fieldhand keys new",
        )
