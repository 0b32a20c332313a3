"""Export of a route as CSV (RFC 4180), with one line per action, per stop without action, and per incident."""

from __future__ import annotations

from fieldhand.exchange.routes.route import ExportedRoute, ExportedWork
from fieldhand.hidden_characters import csv_text

COLUMNS = (
    "stop", "kind", "place", "lat", "lon", "robot_lat", "robot_lon", "leg_m", "travelled_m", "t_s", "certain",
    "node", "action", "captures", "failed", "readings", "event", "said",
)  # fmt: skip


def write_csv(route: ExportedRoute) -> bytes:
    """Return the stops in order, each incident after the stop that precedes it.

    Text that a spreadsheet would interpret as a formula is prefixed with an apostrophe.
    """
    rows: list[tuple[int, tuple[object, ...]]] = []
    for number, stop in enumerate(route.stops, start=1):
        beginning = (number, stop.kind, stop.place, *(round(d, 9) for d in (*stop.at, *stop.stand)))
        way = (round(stop.length_m, 3), round(stop.travelled_m, 3), "" if stop.t is None else round(stop.t, 3))
        for work in stop.work or (ExportedWork(node=stop.node, action="", captures=0),):
            readings = "; ".join(f"{q} {v} {u}".strip() for q, (v, u) in work.readings.items())
            certain = "" if route.driven else "yes" if stop.certain and work.certain else "no"
            what = (work.node, work.action, work.captures or "", work.failed or "", readings)
            rows.append((number, (*beginning, *way, certain, *what, "", "")))
    for behind, one in route.incidents:
        at = ("", "") if one.at is None else tuple(round(d, 9) for d in one.at)
        where = (behind or "", "", one.place, *at, "", "", "", "", round(one.t, 3), "", one.node)
        rows.append((behind, (*where, "", "", "", "", one.event, one.words)))
    return csv_text([COLUMNS, *(row for _, row in sorted(rows, key=lambda numbered: numbered[0]))]).encode()
