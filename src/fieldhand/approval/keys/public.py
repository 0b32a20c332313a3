"""Ed25519 public keys (RFC 8032): a one-line text form for sending and a fingerprint for reading aloud."""

from __future__ import annotations

import base64
import binascii
import hashlib
import re
from dataclasses import dataclass

from fieldhand.approval.keys.curve import is_sound
from fieldhand.approval.keys.names import clean_name
from fieldhand.errors import KeyFileError

#: First word of a line with a public key.
MARK = "fieldhand-ed25519"
KEY_BYTES = 32
#: A length of 160 bits makes a second key with the same fingerprint infeasible.
_FINGERPRINT_BYTES = 20
_LINE = re.compile(rf"[>\s]*{MARK} +([A-Za-z0-9+/=]+)(?: +(.*))?")


@dataclass(frozen=True, kw_only=True)
class PublicKey:
    """A public key for verifying signatures.

    Attributes:
        raw: Key as 32 bytes.
        name: Owner's name as stated by the owner; may be empty.
    """

    raw: bytes
    name: str = ""

    @property
    def fingerprint(self) -> str:
        """Return eight groups of four characters (base 32, without 0, 1, 8 and 9) from the SHA-256 of the key."""
        text = base64.b32encode(hashlib.sha256(self.raw).digest()[:_FINGERPRINT_BYTES]).decode()
        return grouped(text)

    def line(self) -> str:
        """Return the key as one line of text, readable by :func:`parse_public`."""
        return " ".join(part for part in (MARK, base64.b64encode(self.raw).decode(), self.name) if part)

    def verifies(self, signature: bytes, message: bytes) -> bool:
        """Return True if the signature over this message is valid; always False for an unsafe key."""
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
    """Parse the single public key in a text, such as a mail that contains its line.

    Raises:
        KeyFileError: The text contains no key, or several.
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
        what = "there is no public key here" if not found else f"{len(found)} public keys are here"
        raise KeyFileError(what, where=source, advice=f"give a file with one line that begins with {MARK}")
    encoded, name = found.pop()
    return PublicKey(raw=_raw(encoded, source), name=clean_name(name or "", source) if name else "")


def parse_fingerprint(text: str) -> str:
    """Normalize a typed fingerprint: lower case and other groupings are accepted.

    Raises:
        KeyFileError: The text is not a fingerprint.
    """
    plain = re.sub(r"[\s-]", "", text).upper()
    if not re.fullmatch(r"[A-Z2-7]{32}", plain):
        raise KeyFileError(
            "this is not a fingerprint",
            where=repr(text[:60]),
            advice="give all eight groups of four, as fieldhand keys list shows them",
        )
    return grouped(plain)


def grouped(text: str) -> str:
    """Return ``ABCDEFGH`` as ``ABCD-EFGH``."""
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
    """Refuse a key for which signatures can be forged without a private key.

    Raises:
        KeyFileError: The key is unsafe.
    """
    if not is_sound(raw):
        raise KeyFileError(
            "this Ed25519 public key is invalid: anybody could sign with it",
            where=source,
            advice="do not trust whoever sent it; a key is made with fieldhand keys new",
        )
