"""``fieldhand status``: show the state of a stored mission, from any process at any time."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import asdict
from typing import TYPE_CHECKING

from fieldhand.cli.options import JsonOption, LangOption, MissionArgument, MissionsOption
from fieldhand.language import Number, joined, message, named

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fieldhand.language import Language
    from fieldhand.missions import Status


#: Smallest width of the column of names.
_LEAST_WIDE = 9
#: Text of each kind of limit.
_ALLOWED: dict[str, Callable[[str], str]] = {
    "distance_m": lambda limit: joined(" ", (limit, "m")),
    "duration_s": lambda limit: joined(" ", (limit, "s")),
    "energy_percent": lambda limit: message("{percent} % of the battery", percent=limit),
}


def status(
    mission: MissionArgument = None,
    lang: LangOption = None,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """Show the state of a mission: running, paused, interrupted or ended; position, done and remaining work."""
    from fieldhand import missions
    from fieldhand.cli import show
    from fieldhand.language import spoken

    language = spoken(lang, os.environ)
    under = kept or missions.missions_folder(os.environ)
    folder = missions.find(under, mission)
    status = missions.status(folder)
    if json:
        show.print_json(
            {"folder": str(folder), **{k: v for k, v in asdict(status).items() if k != "now"}, **asdict(status.now)}
        )
    else:
        _show(status, language)


def _show(status: Status, language: Language) -> None:
    from fieldhand.cli import show

    now = status.now
    state = named(now.state, "state")
    title = message("Mission {id}: {state}", id=status.mission, state=state)
    if now.status:
        how = named(now.status, "ending")
        title = message("Mission {id}: {state} ({how})", id=status.mission, state=state, how=how)
    show.heading(language.say(title))
    lines = tuple(_lines(status))
    wide = max(_LEAST_WIDE, *(len(language.say(name)) for name, _ in lines))
    for name, what in lines:
        show.out.print(f"  {language.say(name):<{wide}} {language.say(what)}")


def _lines(status: Status) -> Iterator[tuple[str, str]]:
    """Yield name and text of each line of the status."""
    from fieldhand.clock import clock_time
    from fieldhand.language import kept_in_log

    now = status.now
    yield message("asked", context="status"), status.request
    if now.status:
        yield (
            message("reason", context="status"),
            kept_in_log(now.reason) if now.reason else message("everything is done"),
        )
    elif now.state == "interrupted":
        yield message("before", context="status"), now.doing
    else:
        yield message("now", context="status"), now.doing
    if now.lat is not None and now.lon is not None:
        at = f"{now.lat:.6f}, {now.lon:.6f}"
        yield message("where", context="status"), joined(", ", (at, now.near)) if now.near else at
    for goal in now.goals:
        outcome = named(goal.outcome, "outcome")
        yield goal.goal, message("{what}: {why}", what=outcome, why=goal.why) if now.status else goal.why
    used = joined(", ", (Number(f"{now.travelled_m:.0f} m"), clock_time(now.seconds)))
    if now.charge_percent is not None:
        used = message("{used}, battery at {charge} %", used=used, charge=f"{now.charge_percent:.0f}")
    yield message("used", context="status"), used
    for kind, limit in now.limits.items():
        yield message("allowed", context="status"), _ALLOWED[kind](Number(f"{limit:g}"))
    for one in now.exceeded:
        yield message("exceeded", context="status"), kept_in_log(one.why)
    if now.in_doubt:
        yield message("in doubt", context="status"), str(now.in_doubt)
    if status.last_event_at:
        last = message("event {count} at {moment}", count=now.events, moment=status.last_event_at)
        yield message("last", context="status"), last
    if status.report:
        yield message("report", context="status"), status.report
    if status.order:
        heard = message("{order}, not received yet", order=named(status.order, "order"))
        yield message("order", context="status"), heard
    if now.state == "interrupted":
        yield message("next", context="status"), f"fieldhand resume {status.mission}"
