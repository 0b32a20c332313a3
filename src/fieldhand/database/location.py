"""The location of the server's database: a URL in the environment, else a file of the user."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Mapping
from pathlib import Path

from sqlalchemy import URL, make_url
from sqlalchemy.exc import ArgumentError

from fieldhand.errors import DatabaseError, InputError
from fieldhand.files import state_folder
from fieldhand.folders import Unguarded, require_guarded, require_own_file
from fieldhand.language import message

VARIABLE = "FIELDHAND_DATABASE"
#: Drivers by the first word of a URL.
_DRIVERS = {
    "sqlite": "sqlite+pysqlite",
    "postgresql": "postgresql+psycopg",
    "postgres": "postgresql+psycopg",
}


def database_url(environ: Mapping[str, str]) -> URL:
    """Return the URL of the database: ``FIELDHAND_DATABASE``, else a SQLite file in the user's state folder.

    Raises:
        InputError: The variable is no URL of a supported database.
    """
    given = environ.get(VARIABLE)
    if not given:
        return sqlite_url(state_folder(environ) / "server" / "fieldhand.sqlite")
    try:
        url = make_url(given)
    except ArgumentError:
        url = None
    driver = None if url is None else _DRIVERS.get(url.drivername)
    if url is None or driver is None or (driver.startswith("sqlite") and not url.database):
        # The value is not quoted, as it may contain a password.
        raise InputError(
            message("this is not the URL of a database that can be used"),
            where=VARIABLE,
            advice=message("give sqlite:////FOLDER/FILE or postgresql://USER:PASSWORD@HOST/NAME"),
        )
    return url.set(drivername=driver)


def sqlite_url(path: Path) -> URL:
    """Return the URL of a SQLite file."""
    return URL.create(_DRIVERS["sqlite"], database=str(path))


def prepare_file(path: Path) -> None:
    """Create the file of a SQLite database if it is missing, and require that only its user can access it.

    Raises:
        DatabaseError: It cannot be created, or others can access it.
    """
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        require_guarded(path.parent)
        os.close(os.open(path, os.O_RDWR | os.O_CREAT, 0o600))
        status = path.stat()
        require_own_file(path, status)
    except Unguarded as fault:
        raise DatabaseError(fault.what, where=str(fault.path), advice=fault.advice) from None
    except OSError as error:
        raise DatabaseError(
            message("cannot be opened: {reason}", reason=error.strerror or str(error)),
            where=str(path),
            advice=message("set {variable} to the URL of another database", variable=VARIABLE),
        ) from None
    if sys.platform != "win32" and status.st_mode & (stat.S_IRWXG | stat.S_IRWXO):
        raise DatabaseError(message("can be read by others"), where=str(path), advice=f"chmod 600 {path}")
