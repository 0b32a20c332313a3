"""A PostgreSQL server of the tests' own, where Debian's package is installed."""

from __future__ import annotations

import itertools
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path

from support.processes.patience import LONG_S


def why_none() -> str:
    """Return why there is no server here; empty if there can be one."""
    if find_spec("psycopg") is None:
        return "psycopg is not installed"
    if _programs() is None:
        return "PostgreSQL is not installed (Debian: postgresql)"
    if os.geteuid() == 0 and _user() is None:
        return "PostgreSQL does not run as root, and there is no user postgres"
    return ""


@contextmanager
def server() -> Iterator[Iterator[str]]:
    """A server on a socket in a folder of its own; yields the URLs of new databases, one after the other."""
    programs, user = _programs(), _user()
    assert programs is not None
    folder = Path(tempfile.mkdtemp(prefix="fh-pg-"))
    data = folder / "data"
    more = {}
    if user is not None:
        shutil.chown(folder, user)
        more = {"user": user, "group": user, "extra_groups": []}

    def run(program: str, *words: str) -> None:
        subprocess.run(
            [programs / program, *words],
            check=True,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=LONG_S,
            cwd=folder,
            **more,
        )

    try:
        run("initdb", "-D", str(data), "-A", "trust", "-U", "tests", "-E", "UTF8", "--locale", "C", "--no-sync")
        settings = f"-c listen_addresses='' -k {folder} -c fsync=off -c max_connections=40"
        run("pg_ctl", "-D", str(data), "-l", str(folder / "log"), "-o", settings, "-w", "start")
        yield _new_databases(folder)
    finally:
        with suppress(subprocess.SubprocessError):
            run("pg_ctl", "-D", str(data), "-m", "immediate", "stop")
        shutil.rmtree(folder, ignore_errors=True)


def _new_databases(folder: Path) -> Iterator[str]:
    import psycopg

    for number in itertools.count():
        with psycopg.connect(host=str(folder), user="tests", dbname="postgres", autocommit=True) as connection:
            connection.execute(f"create database tests_{number}")
        yield f"postgresql://tests@/tests_{number}?host={folder}"


def _programs() -> Path | None:
    """Return the folder of the newest server's programs; None if there is none."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda file: int(file.parts[4]))
    named = shutil.which("initdb")
    return found[-1].parent if found else None if named is None else Path(named).resolve().parent


def _user() -> str | None:
    """Return the user that runs the server in place of root; None for the present one."""
    if os.geteuid() != 0:
        return None
    import pwd

    return "postgres" if any(user.pw_name == "postgres" for user in pwd.getpwall()) else None
