"""``fieldhand missions``: list stored missions, and remove old ones."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import JsonOption, MissionsOption

if TYPE_CHECKING:
    from fieldhand.missions.listing import ListedMission

_LONGEST = 60


def missions(
    prune: Annotated[
        float | None,
        typer.Option("--prune", min=0, metavar="DAYS", help="Remove missions that ended longer ago than this."),
    ] = None,
    keep: Annotated[
        int | None, typer.Option("--keep", min=0, metavar="N", help="Remove missions that have ended but the last N.")
    ] = None,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """List all missions, the newest last; --prune and --keep remove old ones that have ended, never others."""
    from datetime import datetime

    from fieldhand.cli import show
    from fieldhand.compatibility import UTC
    from fieldhand.missions import missions_folder
    from fieldhand.missions.listing import list_missions, older_than, removable, remove

    under = kept or missions_folder(os.environ)
    entries = list_missions(under)
    gone: tuple[ListedMission, ...] = ()
    if prune is not None or keep is not None:
        before = None if prune is None else older_than(datetime.now(UTC), prune)
        gone = removable(entries, ended_before=before, keep=keep)
        for entry in gone:
            remove(entry)
    left = tuple(entry for entry in entries if entry not in gone)
    if json:
        show.print_json({"folder": str(under), "missions": [_record(e) for e in left], "removed": [e.id for e in gone]})
        return
    _show(left, under)
    if prune is not None or keep is not None:
        show.out.print(f"removed: {', '.join(e.id for e in gone) or 'none'}")


def _record(entry: ListedMission) -> dict[str, Any]:
    return {
        "id": entry.id,
        "begun": entry.begun.isoformat(timespec="seconds"),
        "last": entry.last.isoformat(timespec="seconds"),
        "state": entry.state,
        "status": entry.status,
        "signed": entry.signed,
        "request": entry.request,
    }


def _show(entries: tuple[ListedMission, ...], under: Path) -> None:
    from fieldhand.cli import show

    if not entries:
        show.out.print(f"no missions in {under}")
    wide = max((len(entry.id) for entry in entries), default=0)
    for entry in entries:
        request = " ".join(entry.request.split())
        short = request if len(request) <= _LONGEST else f"{request[: _LONGEST - 1]}…"
        state = entry.status if entry.state == "ended" else entry.state
        why = entry.status if entry.state == "unreadable" else short
        begun = entry.begun.astimezone().strftime("%Y-%m-%d %H:%M")
        show.out.print(f"{entry.id:<{wide}}  {begun}  {state:<11}  {'signed' if entry.signed else '':<6}  {why}")
