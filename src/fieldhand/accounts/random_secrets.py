"""Random secrets of sessions, tokens and login codes. Only their digests are stored."""

from __future__ import annotations

import hashlib
import hmac
import secrets

#: First characters of an API token, by which people and scanners recognize one.
TOKEN_PREFIX = "fh_"  # noqa: S105  no password
_BYTES = 32
_READABLE = "abcdefghijkmnpqrstuvwxyz23456789"


def new_secret() -> str:
    """Return 256 random bits as text that a URL, a header or a cookie may contain."""
    return secrets.token_urlsafe(_BYTES)


def new_password() -> str:
    """Return a random password of 20 characters (99 bits) that can be read out: no letters that look like digits."""
    groups = ("".join(secrets.choice(_READABLE) for _ in range(4)) for _ in range(5))
    return "-".join(groups)


def digest(secret: str) -> str:
    """Return the SHA-256 by which a secret is found; a random one needs neither salt nor many rounds."""
    return hashlib.sha256(secret.encode("utf-8", "surrogatepass")).hexdigest()


def csrf_of(session: str) -> str:
    """Return the text that requests which change something must repeat, derived from a session's secret."""
    return hmac.new(session.encode("utf-8", "surrogatepass"), b"fieldhand csrf", hashlib.sha256).hexdigest()


def proof_of(key: str, nonce: str) -> str:
    """Return the proof that whoever has this nonce got it from who knows a key."""
    return hmac.new(key.encode(), b"fieldhand device " + nonce.encode("utf-8", "surrogatepass"), "sha256").hexdigest()


def same(given: str, wanted: str) -> bool:
    """Return True for equal texts, in a time that does not depend on where they differ."""
    return hmac.compare_digest(given.encode("utf-8", "surrogatepass"), wanted.encode("utf-8", "surrogatepass"))
