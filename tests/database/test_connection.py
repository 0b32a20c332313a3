"""The database is created for its user alone, migrated once, and every failure of it is one error."""

from __future__ import annotations

import stat
import threading
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import inspect, select, text
from sqlalchemy.exc import IntegrityError, SQLAlchemyError

from fieldhand.compatibility import UTC
from fieldhand.database.connection import Database, make_engine, open_database
from fieldhand.database.location import database_url
from fieldhand.database.migrate import HEAD, configuration, upgrade
from fieldhand.database.tables import AUDIT, LOGIN_CODES, METADATA
from fieldhand.errors import DatabaseError, InputError


def code(digest: str, at: datetime) -> dict[str, object]:
    return {"secret_sha256": digest, "created_at": at, "expires_at": at}


def test_migrations_make_the_tables_that_the_program_uses(database: Database) -> None:
    with database.transaction() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, METADATA) == []
        names = set(inspect(connection).get_table_names())
    assert set(METADATA.tables) | {"alembic_version"} == names


def test_the_last_revision_is_the_one_that_the_program_expects(database: Database) -> None:
    with database.transaction() as connection:
        assert ScriptDirectory.from_config(configuration(connection)).get_current_head() == HEAD
        assert connection.execute(text("select version_num from alembic_version")).scalar() == HEAD


def test_migrations_go_back_and_forth(url: str) -> None:
    from alembic import command

    engine = make_engine(database_url({"FIELDHAND_DATABASE": url}))
    upgrade(engine)
    with engine.begin() as connection:
        command.downgrade(configuration(connection), "base")
    with engine.connect() as connection:
        assert set(inspect(connection).get_table_names()) == {"alembic_version"}
    upgrade(engine)
    with engine.connect() as connection:
        assert set(METADATA.tables) < set(inspect(connection).get_table_names())
    engine.dispose()


def test_programs_that_start_at_once_migrate_once(url: str) -> None:
    failures: list[Exception] = []

    def start() -> None:
        try:
            open_database({"FIELDHAND_DATABASE": url}).close()
        except (DatabaseError, SQLAlchemyError) as error:
            failures.append(error)

    threads = [threading.Thread(target=start) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failures == []


def test_a_database_of_a_newer_program_is_left_alone(url: str) -> None:
    database = open_database({"FIELDHAND_DATABASE": url})
    with database.transaction() as connection:
        connection.execute(text("update alembic_version set version_num = '9999'"))
    database.close()
    with pytest.raises(DatabaseError, match="a newer version"):
        open_database({"FIELDHAND_DATABASE": url})


def test_instants_come_back_in_utc(database: Database) -> None:
    there = datetime(2026, 7, 1, 9, 30, 5, 123456, tzinfo=timezone(timedelta(hours=2)))
    with database.transaction() as connection:
        connection.execute(LOGIN_CODES.insert().values(code("a", there)))
    with database.transaction(reading=True) as connection:
        found = connection.execute(select(LOGIN_CODES.c.created_at)).scalar_one()
    assert found == there
    assert found.tzinfo is UTC
    assert found.hour == 7


def test_an_instant_without_time_zone_is_refused(database: Database) -> None:
    with pytest.raises(DatabaseError, match="time zone"), database.transaction() as connection:
        connection.execute(LOGIN_CODES.insert().values(code("a", datetime(2026, 7, 1))))


def test_a_transaction_that_fails_leaves_nothing(database: Database) -> None:
    at = datetime(2026, 7, 1, tzinfo=UTC)

    def write(*digests: str, fault: Exception | None = None) -> None:
        with database.transaction() as connection:
            for one in digests:
                connection.execute(LOGIN_CODES.insert().values(code(one, at)))
            if fault is not None:
                raise fault

    with pytest.raises(ZeroDivisionError):
        write("a", fault=ZeroDivisionError())
    with pytest.raises(IntegrityError):
        write("b", "b")
    with database.transaction(reading=True) as connection:
        assert connection.execute(select(LOGIN_CODES.c.id)).all() == []


def test_many_writers_lose_nothing(database: Database) -> None:
    def write(who: int) -> None:
        for k in range(10):
            with database.transaction() as connection:
                at = datetime(2026, 7, 1, tzinfo=UTC)
                row = {"at": at, "who": str(who), "what": "w", "about": str(k), "address": "", "details": {"k": k}}
                connection.execute(AUDIT.insert().values(row))

    threads = [threading.Thread(target=write, args=(who,)) for who in range(5)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    with database.transaction(reading=True) as connection:
        rows = connection.execute(select(AUDIT.c.who, AUDIT.c.about, AUDIT.c.details)).all()
    assert sorted((int(who), int(about)) for who, about, _ in rows) == [(w, k) for w in range(5) for k in range(10)]
    assert all(details == {"k": int(about)} for _, about, details in rows)


def test_only_its_user_can_read_the_file(tmp_path: Path) -> None:
    file = tmp_path / "server" / "x.sqlite"
    database = open_database({"FIELDHAND_DATABASE": f"sqlite:///{file}"})
    with database.transaction() as connection:
        connection.execute(LOGIN_CODES.insert().values(code("a", datetime(2026, 7, 1, tzinfo=UTC))))
    for path in file.parent.iterdir():
        assert stat.S_IMODE(path.stat().st_mode) & 0o077 == 0, path
    assert stat.S_IMODE(file.parent.stat().st_mode) == 0o700
    database.close()
    file.chmod(0o640)
    with pytest.raises(DatabaseError, match="can be read by others"):
        open_database({"FIELDHAND_DATABASE": f"sqlite:///{file}"})
    file.chmod(0o600)
    file.parent.chmod(0o777)
    with pytest.raises(DatabaseError, match="can be written by others"):
        open_database({"FIELDHAND_DATABASE": f"sqlite:///{file}"})


def test_by_default_it_is_in_the_users_state_folder(tmp_path: Path) -> None:
    url = database_url({"XDG_STATE_HOME": str(tmp_path)})
    assert url.database == str(tmp_path / "fieldhand" / "server" / "fieldhand.sqlite")


@pytest.mark.parametrize(
    "given",
    ["mysql://u:secret@h/d", "sqlite://", "sqlite:///", "nonsense", "postgresql:/", "://", "sqlite+x:///a:secret"],
)
def test_a_url_that_cannot_be_used_is_refused_without_its_password(given: str) -> None:
    with pytest.raises(InputError) as error:
        database_url({"FIELDHAND_DATABASE": given})
    assert "FIELDHAND_DATABASE" in str(error.value)
    assert "secret" not in str(error.value)


def test_a_file_that_is_no_database_is_one_error(tmp_path: Path) -> None:
    tmp_path.chmod(0o700)
    file = tmp_path / "x.sqlite"
    file.write_bytes(b"this is a text, and no database at all " * 100)
    file.chmod(0o600)
    with pytest.raises(DatabaseError, match="not a database"):
        open_database({"FIELDHAND_DATABASE": f"sqlite:///{file}"})
    with pytest.raises(DatabaseError, match="cannot be opened"):
        open_database({"FIELDHAND_DATABASE": f"sqlite:///{tmp_path}"})


def test_a_server_that_does_not_respond_is_one_error_without_password(tmp_path: Path) -> None:
    pytest.importorskip("psycopg")
    url = f"postgresql://me:secret@/none?host={tmp_path}"
    with pytest.raises(DatabaseError, match="the database cannot be used") as error:
        open_database({"FIELDHAND_DATABASE": url})
    assert "secret" not in str(error.value)


def test_an_opened_database_that_breaks_is_one_error(url: str) -> None:
    database = open_database({"FIELDHAND_DATABASE": url})
    with database.transaction() as connection:
        connection.execute(text("drop table login_codes"))
    with pytest.raises(DatabaseError, match="the database cannot be used"), database.transaction() as connection:
        connection.execute(select(LOGIN_CODES))
    database.close()
