"""People who may log in: their names, passwords, roles and languages."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, delete, insert, select, update
from sqlalchemy.exc import IntegrityError

from fieldhand.accounts.passwords import Passwords, require_strong
from fieldhand.accounts.random_secrets import new_secret, proof_of
from fieldhand.accounts.roles import Role
from fieldhand.database.connection import Database
from fieldhand.database.tables import ACCOUNTS, SESSIONS
from fieldhand.errors import InputError
from fieldhand.hidden_characters import find_hidden
from fieldhand.language import languages, message

#: Name of the local administrator in sessions, tokens and the audit log; no account can have it.
LOCAL = "local"
_LONGEST_NAME = 100


@dataclass(frozen=True, kw_only=True)
class Account:
    """A person who may log in.

    Attributes:
        id: Number in the database.
        name: Name, as it was given.
        role: Role.
        language: Code of the language of messages.
        created_at: Time of creation.
    """

    id: int
    name: str
    role: Role
    language: str
    created_at: datetime


class People:
    """The accounts in a database.

    Args:
        database: The server's database.
        passwords: Hashes passwords.
        now: Returns the time.
    """

    def __init__(self, database: Database, passwords: Passwords, now: Callable[[], datetime]) -> None:
        self._database, self._passwords, self._now = database, passwords, now

    def add(self, name: str, password: str, role: Role, language: str = "en") -> Account:
        """Add an account.

        Raises:
            InputError: Name, password or language cannot be used, or the name is taken.
        """
        name = _clean_name(name)
        require_strong(password, name)
        _require_language(language)
        values = {
            "name": name,
            "key": key_of(name),
            "password_hash": self._passwords.hashed(password),
            "role": role.value,
            "language": language,
            "created_at": self._now(),
        }
        try:
            with self._database.transaction() as connection:
                connection.execute(insert(ACCOUNTS).values(values))
                return _found(connection, name)
        except IntegrityError:
            raise InputError(
                message("there is already an account of this name"),
                where=name,
                advice=message("choose another name, or change that account"),
            ) from None

    def all(self) -> tuple[Account, ...]:
        """Return all accounts by name."""
        with self._database.transaction(reading=True) as connection:
            return tuple(map(_account, connection.execute(select(ACCOUNTS).order_by(ACCOUNTS.c.key))))

    def find(self, name: str) -> Account:
        """Return the account of a name.

        Raises:
            InputError: There is none.
        """
        with self._database.transaction(reading=True) as connection:
            return _found(connection, name)

    def verify(self, name: str, password: str) -> Account | None:
        """Return the account of a name if the password is right; takes the same time if there is no such account."""
        with self._database.transaction(reading=True) as connection:
            row = connection.execute(select(ACCOUNTS).where(ACCOUNTS.c.key == key_of(name))).first()
        stored = None if row is None else str(row.password_hash)
        if not self._passwords.matches(password, stored) or row is None or stored is None:
            return None
        if self._passwords.outdated(stored):
            self._store_hash(row.id, stored, self._passwords.hashed(password))
        return _account(row)

    def device_proof(self, name: str, nonce: str) -> str:
        """Return the proof that a browser has logged in to an account before.

        It is derived from the hash of the password, so that nothing is stored and another password ends it.

        Args:
            name: Name of the account; without such an account the proof is one that no browser has.
            nonce: Random text of the browser.
        """
        with self._database.transaction(reading=True) as connection:
            stored = connection.execute(select(ACCOUNTS.c.password_hash).where(ACCOUNTS.c.key == key_of(name))).scalar()
        return proof_of(str(stored or new_secret()), nonce)

    def change(self, name: str, *, role: Role | None = None, language: str | None = None) -> Account:
        """Change the role or the language of an account; sessions and tokens have the new role at once.

        Raises:
            InputError: There is no such account or language.
        """
        changed: dict[str, Any] = {}
        if role is not None:
            changed["role"] = role.value
        if language is not None:
            _require_language(language)
            changed["language"] = language
        with self._database.transaction() as connection:
            account = _found(connection, name)
            if changed:
                connection.execute(update(ACCOUNTS).where(ACCOUNTS.c.id == account.id).values(changed))
            return _found(connection, name)

    def set_password(self, name: str, password: str) -> Account:
        """Replace the password of an account and end all its sessions.

        Raises:
            InputError: There is no such account, or the password cannot be used.
        """
        require_strong(password, name)
        stored = self._passwords.hashed(password)
        with self._database.transaction() as connection:
            account = _found(connection, name)
            connection.execute(update(ACCOUNTS).where(ACCOUNTS.c.id == account.id).values(password_hash=stored))
            connection.execute(delete(SESSIONS).where(SESSIONS.c.account == account.id))
            return account

    def remove(self, name: str) -> Account:
        """Remove an account with its sessions and tokens.

        Raises:
            InputError: There is no such account.
        """
        with self._database.transaction() as connection:
            account = _found(connection, name)
            connection.execute(delete(ACCOUNTS).where(ACCOUNTS.c.id == account.id))
            return account

    def _store_hash(self, account: int, stored: str, hashed: str) -> None:
        """Replace the hash of an account, unless its password was changed meanwhile."""
        with self._database.transaction() as connection:
            connection.execute(
                update(ACCOUNTS)
                .where(ACCOUNTS.c.id == account, ACCOUNTS.c.password_hash == stored)
                .values(password_hash=hashed)
            )


def _found(connection: Connection, name: str) -> Account:
    row = connection.execute(select(ACCOUNTS).where(ACCOUNTS.c.key == key_of(name))).first()
    if row is None:
        raise InputError(message("there is no account of this name"), where=name)
    return _account(row)


def _account(row: Row[Any]) -> Account:
    return Account(id=row.id, name=row.name, role=Role(row.role), language=row.language, created_at=row.created_at)


def _clean_name(name: str) -> str:
    """Return a new name in one form (NFC), without surrounding spaces.

    Raises:
        InputError: It cannot be used.
    """
    name = unicodedata.normalize("NFC", name.strip())
    if not 0 < len(name) <= _LONGEST_NAME:
        raise InputError(
            message("a name has 1 to {most} characters", most=_LONGEST_NAME),
            where=message("name"),
            advice=message("shorten it"),
        )
    hidden = find_hidden(name)
    if hidden is not None:
        raise InputError(
            message("the name contains the invisible character {name}", name=hidden.name),
            where=message("name"),
            advice=message("leave it out"),
        )
    if key_of(name) == LOCAL:
        raise InputError(
            message("'{name}' is the name of this machine's administrator", name=name),
            where=message("name"),
            advice=message("choose another name"),
        )
    return name


def key_of(name: str) -> str:
    """Return a name without differences of case and form, by which accounts are found."""
    folded = unicodedata.normalize("NFKC", name[: 2 * _LONGEST_NAME]).casefold()
    whole = unicodedata.normalize("NFKC", folded).encode("utf-8", "replace").decode()
    return whole.replace("\0", "?").strip()[: 2 * _LONGEST_NAME]  # PostgreSQL stores no null characters


def _require_language(code: str) -> None:
    there = languages()
    if code not in there:
        raise InputError(
            message("there is no language '{code}'", code=code),
            where=message("language"),
            advice=message("choose one of {names}", names=", ".join(there)),
        )
