"""Alembic's entry point: run migrations on the connection of the caller, in the caller's transaction."""

from __future__ import annotations

from alembic import context

from fieldhand.database.tables import METADATA

context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=METADATA,
    compare_type=True,
    transactional_ddl=True,
)
context.run_migrations()
