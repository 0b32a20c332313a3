"""Measured missions of each robot, kept in the user's state folder: one SQLite file per profile."""

from __future__ import annotations

import contextlib
import math
import sqlite3
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

from fieldhand.errors import InputError, OutputError
from fieldhand.evaluation.calibration.measured_steps import MeasuredMission, MeasuredStep, predicted
from fieldhand.robot.model import RobotProfile

#: The latest missions and steps that are kept of a robot; older ones make room (some 20 MB).
MOST_MISSIONS, MOST_STEPS = 1_000, 200_000

_WAIT_S = 5.0
_VERSION = 1
_SCHEMA = """
create table if not exists mission(
  id integer primary key, key text unique not null, kept_at text not null, task text not null,
  robot_sha256 text not null, simulated integer not null, steps integer not null);
create table if not exists step(
  mission integer not null references mission(id) on delete cascade, kind text not null, name text not null,
  planned_m real not null, metres real not null, seconds real, moved_m real not null, whole_s real not null,
  percent real not null, sure integer not null, speed_m_s real, done integer not null,
  predicted_s real not null, predicted_percent real not null);
create index if not exists step_of on step(mission);
"""


def history_file(folder: Path, robot: str) -> Path:
    """Return the file of a robot's missions; ``robot`` is the name of its profile."""
    return folder / f"{robot}.sqlite"


def save_mission(folder: Path, robot: RobotProfile, driven: MeasuredMission, at: datetime) -> bool:
    """Save a mission unless it is saved already; return True if it was added.

    Each leg and each capture is kept with what the profile expected of it: metres, seconds and percent of the battery.

    Raises:
        OutputError: The file cannot be written.
    """
    path = history_file(folder, robot.name)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with _open(path) as base, base:
            row = base.execute(
                "insert or ignore into mission(key, kept_at, task, robot_sha256, simulated, steps) values(?,?,?,?,?,?)",
                (driven.key, at.isoformat(), driven.task, robot.sha256, driven.simulated, len(driven.steps)),
            )
            if row.rowcount == 0:
                return False
            base.executemany(
                "insert into step values(?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
                [_row(row.lastrowid, step, robot) for step in driven.steps],
            )
            _make_room(base)
        return True
    except (OSError, sqlite3.Error) as error:
        raise OutputError(
            f"the costs of the mission cannot be stored: {error}",
            where=str(path),
            advice="give --no-history, or delete the file if it is damaged",
        ) from None


def load_missions(folder: Path, robot: str) -> tuple[MeasuredMission, ...]:
    """Return the saved missions of a robot, oldest first; none if there is no file.

    Raises:
        InputError: The file is damaged.
    """
    path = history_file(folder, robot)
    if not path.is_file():
        return ()
    try:
        with _open(path) as base:
            missions = base.execute("select id, key, task, simulated from mission order by id").fetchall()
            return tuple(
                MeasuredMission(key=key, task=task, robot=robot, simulated=bool(simulated), steps=_steps(base, number))
                for number, key, task, simulated in missions
            )
    except (sqlite3.Error, ValueError, TypeError) as error:
        raise InputError(
            f"is not a history of missions: {error}", where=str(path), advice="delete it, or give event logs"
        ) from None


@contextlib.contextmanager
def _open(path: Path) -> Iterator[sqlite3.Connection]:
    base = sqlite3.connect(path, timeout=_WAIT_S)
    try:
        (version,) = base.execute("pragma user_version").fetchone()
        if version > _VERSION:
            raise sqlite3.DatabaseError("a newer Fieldhand wrote it")
        base.execute("pragma foreign_keys = on")
        base.executescript(_SCHEMA)
        base.execute(f"pragma user_version = {_VERSION}")
        yield base
    finally:
        base.close()


def _make_room(base: sqlite3.Connection) -> None:
    """Delete the oldest missions beyond the bounds; the latest always stays."""
    base.execute(
        "delete from mission where id not in (select id from mission order by id desc limit ?)", (MOST_MISSIONS,)
    )
    base.execute(
        "delete from mission where id < (select max(id) from mission) and id in"
        " (select id from (select id, sum(steps) over (order by id desc) as so_far from mission) where so_far > ?)",
        (MOST_STEPS,),
    )


def _row(mission: int | None, step: MeasuredStep, robot: RobotProfile) -> tuple[object, ...]:
    expected = predicted(step, robot)
    return (
        *(mission, step.kind, step.name, step.planned_m, step.metres, _or_none(step.seconds), step.moved_m),
        *(step.whole_s, step.percent, step.sure, _or_none(step.speed_m_s), step.done, *expected),
    )


def _steps(base: sqlite3.Connection, mission: int) -> tuple[MeasuredStep, ...]:
    rows = base.execute(
        "select kind, name, planned_m, metres, seconds, moved_m, whole_s, percent, sure, speed_m_s, done"
        " from step where mission = ? order by rowid",
        (mission,),
    )
    return tuple(
        MeasuredStep(
            kind=kind,
            name=str(name),
            planned_m=float(planned),
            metres=float(metres),
            seconds=math.nan if seconds is None else float(seconds),
            moved_m=float(moved),
            whole_s=float(whole),
            percent=float(percent),
            sure=bool(sure),
            speed_m_s=math.nan if speed is None else float(speed),
            done=bool(done),
        )
        for kind, name, planned, metres, seconds, moved, whole, percent, sure, speed, done in rows
    )


def _or_none(value: float) -> float | None:
    return None if math.isnan(value) else value
