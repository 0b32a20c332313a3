"""Migrations: bring the tables of a database to those of this program."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from sqlalchemy import Connection, Engine, inspect, text

from fieldhand.errors import DatabaseError
from fieldhand.language import message

if TYPE_CHECKING:
    from alembic.config import Config

#: The last revision in ``migrations/versions``.
HEAD = "0001"
_MIGRATIONS = Path(__file__).with_name("migrations")
#: Number of the lock that keeps two programs from migrating one PostgreSQL database at the same time.
_LOCK = 0x6669656C64


def upgrade(engine: Engine) -> None:
    """Migrate a database to the last revision, in one transaction; do nothing if it is there.

    Raises:
        DatabaseError: A newer version of this program created the database.
    """
    with engine.begin() as connection:
        if engine.dialect.name == "postgresql":
            connection.execute(text("select pg_advisory_xact_lock(:lock)"), {"lock": _LOCK})
        found = _revision(connection)
        if found == HEAD:
            return
        from alembic import command
        from alembic.script import ScriptDirectory

        config = configuration(connection)
        known = {script.revision for script in ScriptDirectory.from_config(config).walk_revisions()}
        if found is not None and found not in known:
            raise DatabaseError(
                message("a newer version of this program has changed the database"),
                where=engine.url.render_as_string(hide_password=True),
                advice=message("update this program, or use another database"),
            )
        command.upgrade(config, "head")


def configuration(connection: Connection) -> Config:
    """Return Alembic's configuration for the migrations of a connection's database."""
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", str(_MIGRATIONS).replace("%", "%%"))
    config.attributes["connection"] = connection
    return config


def _revision(connection: Connection) -> str | None:
    """Return the revision of a database; None for an empty one."""
    if not inspect(connection).has_table("alembic_version"):
        return None
    found = connection.execute(text("select version_num from alembic_version")).scalar()
    return None if found is None else str(found)
