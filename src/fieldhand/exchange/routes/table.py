"""A route as CSV (RFC 4180): one line an action at a stop, and one for a stop where nothing is done."""

from __future__ import annotations

import csv
import io

from fieldhand.exchange.routes.route import Route, Work

COLUMNS = (
    "stop", "kind", "place", "lat", "lon", "robot_lat", "robot_lon", "leg_m", "travelled_m", "t_s", "certain",
    "node", "action", "captures", "failed", "readings",
)  # fmt: skip
#: What a spreadsheet takes for the beginning of a formula.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n")


def write_csv(route: Route) -> bytes:
    """The stops in their order. Text that a spreadsheet would take for a formula begins with an apostrophe."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\r\n")
    writer.writerow(COLUMNS)
    for number, stop in enumerate(route.stops, start=1):
        beginning = (number, _text(stop.kind), _text(stop.place), *(f"{d:.9f}" for d in (*stop.at, *stop.stand)))
        way = (round(stop.length_m, 3), round(stop.travelled_m, 3), "" if stop.t is None else round(stop.t, 3))
        for work in stop.work or (Work(node=stop.node, action="", captures=0),):
            readings = "; ".join(f"{q} {v} {u}".strip() for q, (v, u) in work.readings.items())
            certain = "" if route.driven else "yes" if stop.certain and work.certain else "no"
            what = (_text(work.node), _text(work.action), work.captures or "", work.failed or "", _text(readings))
            writer.writerow((*beginning, *way, certain, *what))
    return out.getvalue().encode()


def _text(cell: str) -> str:
    return f"'{cell}" if cell.startswith(_FORMULA) else cell
