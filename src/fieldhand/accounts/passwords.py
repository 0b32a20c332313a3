"""Passwords: requirements, and their hashes with Argon2id (RFC 9106)."""

from __future__ import annotations

import unicodedata
from functools import cached_property

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError

from fieldhand.errors import InputError
from fieldhand.language import message

#: Smallest and largest number of characters of a password.
SHORTEST, LONGEST = 10, 256
#: Smallest number of different characters in a password.
_VARIED = 5


class Passwords:
    """Hashes and verifies passwords.

    Args:
        hasher: Argon2 with its costs; by default those that RFC 9106 gives for little memory (64 MiB, 3 passes).
    """

    def __init__(self, hasher: PasswordHasher | None = None) -> None:
        self._hasher = hasher or PasswordHasher()

    def hashed(self, password: str) -> str:
        """Return the hash of a password, with its salt and costs."""
        return self._hasher.hash(_normalized(password))

    def matches(self, password: str, stored: str | None) -> bool:
        """Return True if a password has this hash; without a hash the same time passes, and it does not.

        Args:
            password: Password as it was typed.
            stored: Hash of the account; None if there is no such account.
        """
        if len(password) > LONGEST:
            return False
        try:
            return self._hasher.verify(stored or self._nobodys, _normalized(password)) and stored is not None
        except (VerificationError, InvalidHashError):
            return False

    def outdated(self, stored: str) -> bool:
        """Return True for a hash with other costs than today's."""
        return self._hasher.check_needs_rehash(stored)

    @cached_property
    def _nobodys(self) -> str:
        return self._hasher.hash("nobody has this password")


def require_strong(password: str, name: str) -> None:
    """Require that a new password is long enough, and is not the name of its owner.

    Raises:
        InputError: It is not.
    """
    if not SHORTEST <= len(password) <= LONGEST:
        raise InputError(
            message(
                "a password has {least} to {most} characters, this one has {count}",
                least=SHORTEST,
                most=LONGEST,
                count=len(password),
            ),
            where=message("password"),
            advice=message("take several words"),
        )
    folded = password.casefold()
    if len(set(folded)) < _VARIED or not folded.replace(name.casefold(), ""):
        raise InputError(
            message("this password is too easy to guess"),
            where=message("password"),
            advice=message("take several words"),
        )


def _normalized(password: str) -> bytes:
    """Return the bytes of a password in one form (NFKC), as keyboards write an accent in different ones."""
    return unicodedata.normalize("NFKC", password).encode("utf-8", "surrogatepass")
