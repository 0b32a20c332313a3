"""Transactions on the server's database."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from sqlalchemy import URL, Connection, Engine, create_engine, event, select
from sqlalchemy.exc import DBAPIError, IntegrityError, SQLAlchemyError

from fieldhand.database.location import VARIABLE, database_url, prepare_file
from fieldhand.database.migrate import upgrade
from fieldhand.errors import DatabaseError, InputError
from fieldhand.language import message

#: Seconds that a transaction waits for another one.
_WAIT_S = 10
#: Execution option of a transaction that only reads.
_READING = "fieldhand_reading"


class Database:
    """An opened database, whose tables are those of this program.

    Args:
        engine: Connections to it.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    @contextmanager
    def transaction(self, *, reading: bool = False) -> Iterator[Connection]:
        """Begin a transaction, which is committed at the end of the context, or rolled back by an exception.

        Args:
            reading: Write nothing, so that it does not wait for other transactions on SQLite.

        Raises:
            DatabaseError: The database cannot be reached, or refuses a statement.
            sqlalchemy.exc.IntegrityError: A row contradicts a constraint.
        """
        try:
            with self._engine.connect() as connection:
                connection.execution_options(**{_READING: reading})
                with connection.begin():
                    yield connection
        except IntegrityError:
            raise
        except SQLAlchemyError as error:
            raise _failure(self._engine.url, error) from error

    def require_reachable(self) -> None:
        """Require that the database responds.

        Raises:
            DatabaseError: It does not.
        """
        with self.transaction(reading=True) as connection:
            connection.execute(select(1))

    def close(self) -> None:
        """Close all connections."""
        self._engine.dispose()


def open_database(environ: Mapping[str, str]) -> Database:
    """Open the database that the environment names, create it if it is missing, and migrate its tables.

    Raises:
        InputError: The environment names no database that can be used.
        DatabaseError: The database cannot be opened, or a newer version of this program created it.
    """
    return open_url(database_url(environ))


def open_url(url: URL) -> Database:
    """Open the database of a URL, as :func:`open_database` does.

    Raises:
        InputError: The driver of the database is not installed.
        DatabaseError: The database cannot be opened, or a newer version of this program created it.
    """
    engine = make_engine(url)
    database = Database(engine)
    try:
        upgrade(engine)
    except SQLAlchemyError as error:
        database.close()
        raise _failure(url, error) from error
    except BaseException:
        database.close()
        raise
    return database


def make_engine(url: URL) -> Engine:
    """Return the engine of a URL; the file of a SQLite database is created for its user only.

    Raises:
        InputError: The driver of the database is not installed.
        DatabaseError: The file of the database cannot be created, or others can access it.
    """
    if url.get_backend_name() == "sqlite":
        prepare_file(Path(url.database or ""))
        engine = create_engine(url, connect_args={"timeout": _WAIT_S})
        event.listen(engine, "connect", _configure_sqlite)
        event.listen(engine, "begin", _begin_sqlite)
        return engine
    try:
        return create_engine(url, pool_pre_ping=True, connect_args={"connect_timeout": _WAIT_S})
    except ModuleNotFoundError:
        raise InputError(
            message("PostgreSQL needs psycopg, which is not installed"),
            where=VARIABLE,
            advice='pip install "fieldhand[postgresql]"',
        ) from None


def _configure_sqlite(connection: Any, _: object) -> None:
    # Python's driver begins transactions by itself, and only before some statements.
    connection.isolation_level = None
    for pragma in ("journal_mode = wal", "foreign_keys = on", "secure_delete = on"):
        connection.execute(f"pragma {pragma}").close()


def _begin_sqlite(connection: Connection) -> None:
    # A transaction that reads first and writes then would fail if another one wrote in between.
    reading = connection.get_execution_options().get(_READING, False)
    connection.exec_driver_sql("begin" if reading else "begin immediate")


def _failure(url: URL, error: SQLAlchemyError) -> DatabaseError:
    """Return the error of a database, without statements and passwords."""
    cause = error.orig if isinstance(error, DBAPIError) and error.orig is not None else error
    reason = str(cause).strip().partition("\n")[0] or type(cause).__name__
    return DatabaseError(
        message("the database cannot be used: {reason}", reason=reason),
        where=url.render_as_string(hide_password=True),
        advice=message("see that it is running and not full, or set {variable}", variable=VARIABLE),
    )
