"""``fieldhand status``: how a mission stands, asked from any process at any moment."""

from __future__ import annotations

import os
from dataclasses import asdict
from typing import TYPE_CHECKING

from fieldhand.cli.options import JsonOption, MissionArgument, MissionsOption

if TYPE_CHECKING:
    from fieldhand.missions import Status

_UNITS = {"distance_m": "m", "duration_s": "s", "energy_percent": "% of the battery"}


def status(mission: MissionArgument = None, kept: MissionsOption = None, json: JsonOption = False) -> None:
    """Say how a mission stands: running, paused, interrupted or ended; where it is, what is done and what is left."""
    from fieldhand import missions
    from fieldhand.cli import show

    under = kept or missions.missions_folder(os.environ)
    folder = missions.find(under, mission)
    found = missions.status(folder)
    if json:
        show.print_json(
            {"folder": str(folder), **{k: v for k, v in asdict(found).items() if k != "now"}, **asdict(found.now)}
        )
    else:
        _show(found)


def _show(found: Status) -> None:
    from fieldhand.cli import show
    from fieldhand.clock import clock_time

    now = found.now
    print_ = show.out.print
    show.heading(f"Mission {found.mission}: {now.state}{f' ({now.status})' if now.status else ''}")
    print_(f"  asked     {found.request}")
    if now.status:
        print_(f"  reason    {now.reason}" if now.reason else "  reason    all is done")
    else:
        print_(f"  {'before' if now.state == 'interrupted' else 'now':<9} {now.doing}")
    if now.lat is not None and now.lon is not None:
        print_(f"  where     {now.lat:.6f}, {now.lon:.6f}{f', {now.near}' if now.near else ''}")
    for goal in now.goals:
        print_(f"  {goal.goal:<9} {goal.outcome + ': ' if now.status else ''}{goal.why}")
    charge = "" if now.charge_percent is None else f", battery at {now.charge_percent:.0f} %"
    print_(f"  used      {now.travelled_m:.0f} m, {clock_time(now.seconds)}{charge}")
    for kind, limit in now.limits.items():
        print_(f"  allowed   {limit:g} {_UNITS[kind]}")
    for one in now.exceeded:
        print_(f"  exceeded  {one.why}")
    if now.in_doubt:
        print_(f"  in doubt  {now.in_doubt}")
    if found.last_event_at:
        print_(f"  last      event {now.events} at {found.last_event_at}")
    if found.report:
        print_(f"  report    {found.report}")
    if found.order:
        print_(f"  order     {found.order}, not heard yet")
    if now.state == "interrupted":
        print_(f"  next      fieldhand resume {found.mission}")
