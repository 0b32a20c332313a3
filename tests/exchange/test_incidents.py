"""What goes wrong, is in doubt or is interrupted is in every format, where it happened."""

from __future__ import annotations

import csv
import io
import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from lxml import etree
from mcap.reader import make_reader
from shapely.geometry import Polygon, shape

from fieldhand.exchange.incidents import incidents
from fieldhand.exchange.mcap import McapLog
from fieldhand.exchange.replay import film_of, page_of, save_animation
from fieldhand.exchange.routes.geojson import write_geojson
from fieldhand.exchange.routes.kml import write_kml
from fieldhand.exchange.routes.route import driven
from fieldhand.exchange.routes.table import write_csv
from fieldhand.task.results import (
    Acted,
    Arrived,
    ClockSet,
    Continued,
    Driving,
    Ended,
    Event,
    Faulted,
    InDoubt,
    Obstructed,
    Paused,
    Resumed,
    Started,
    Waited,
)
from fieldhand.testing.small_orchard import at, husky, orchard
from fieldhand.wording.events import EventText

SITE = orchard()
TELL = EventText(husky()).line
#: Corners of the way in degrees: five metres apart, along the headland.
A, B, C, D, E = ((lat, lon) for lon, lat in (at(-1, k) for k in (0, 1, 2, 3, 4)))
WHOLE = {"status": "success", "kind": "tree", "place": "1", "charge_percent": 90.0}
AREA = (B, C, (C[0] + 1e-5, C[1] + 1e-5))


def drive(t: float, *path: tuple[float, float]) -> Driving:
    return Driving(t=t, node="n1", kind="tree", place="1", planned_m=1.0, path=path)


def obstacle(t: float, where: tuple[float, float], *, free: bool = False) -> Obstructed:
    return Obstructed(
        t=t, node="n1", kind="tree", place="1", lat=where[0], lon=where[1], travelled_m=3.0,
        blocked=(AREA,) * (not free),
        unreachable=("2",), free=free, what="a ladder",
    )  # fmt: skip


#: A to E: paused at B, something stands at C, the power is cut at D, once on the way and once in a capture at E.
LOG: tuple[Event, ...] = (
    Started(t=0, task="t", robot="husky", site=SITE.name, lat=A[0], lon=A[1], charge_percent=100.0),
    drive(0, A, C, E),
    Paused(t=10, reason="lunch"),
    Continued(t=40),
    drive(40, B, E),
    obstacle(50, C),
    Waited(t=60, node="n1", wanted="position", seconds=5.0, over=True),
    ClockSet(t=61, by_s=-60.0),
    obstacle(65, C, free=True),
    drive(70, C, E),
    Resumed(t=80, lat=D[0], lon=D[1], charge_percent=95.0),
    drive(80, D, E),
    Arrived(t=90, node="n1", kind="tree", place="1", lat=E[0], lon=E[1], leg_m=9, travelled_m=9.0, charge_percent=94.0),
    InDoubt(t=95, node="n1", action="read_co2", then="repeat", kind="tree", place="1", lat=E[0], lon=E[1]),
    Resumed(t=95, lat=E[0], lon=E[1], charge_percent=91.0),
    Acted(t=99, node="n1", action="read_co2", lat=E[0], lon=E[1], readings={"co2": 400.0}, **WHOLE),  # type: ignore[arg-type]
    Faulted(t=99, node="n1", fault="drive_failed", what="stuck"),
    Ended(t=100, status="faulted", lat=E[0], lon=E[1], travelled_m=9.0, charge_percent=90.0),
)
NAMES = [
    *("paused", "continued", "obstacle", "wait", "clock", "obstacle", "resumed", "in_doubt", "resumed", "fault"),
]
PLACES = [B, B, C, C, C, C, D, E, E, E]


def metres(where: tuple[float, float]) -> tuple[float, float]:
    x, y = SITE.projection.metres(*where)[0]
    return float(x), float(y)


def test_each_has_its_place_and_its_words() -> None:
    found = incidents(LOG, TELL)
    assert [one.event for one in found] == NAMES
    assert [one.at for one in found] == PLACES
    assert "a ladder" in found[2].words
    assert found[2].blocked == (AREA,)
    assert (found[5].blocked, found[2].unreachable) == ((), ("2",))
    assert all(one.words and not one.words[0].isdigit() for one in found)


def test_a_replay_shows_the_robot_where_it_stood_and_what_happened(tmp_path: Path) -> None:
    film = film_of(LOG, SITE, tell=TELL)
    for t, where in ((10, B), (25, B), (40, B), (50, C), (70, C), (80, D), (90, E), (100, E)):
        assert film.at(t) == pytest.approx(metres(where), abs=1e-3), t
    assert film.charge_at(95) == pytest.approx(91.0)
    assert "".join(sign.mark for sign in film.signs) == "P!WC!R?RF"
    assert [len(film.blocked_at(t)) for t in (49, 50, 64, 65)] == [0, 1, 1, 0]
    assert len({(s.x, s.y, s.beside) for s in film.signs if s.mark in "!WC"}) == 3
    page = page_of(film, SITE).decode()
    for meaning in ("way blocked", "capture in doubt", "went on after a power cut", "paused"):
        assert meaning in page
    save_animation(film, SITE, tmp_path / "m.gif", seconds=0.5)


def test_mcap_shows_them_to_the_panels(tmp_path: Path) -> None:
    with McapLog(tmp_path / "m.mcap", tell=TELL) as log:
        for event in LOG:
            log(event)
    found: dict[str, list[dict[str, object]]] = {}
    with (tmp_path / "m.mcap").open("rb") as stream:
        for _, channel, message in make_reader(stream).iter_messages():
            found.setdefault(channel.topic, []).append(json.loads(message.data) | {"at": message.log_time / 1e9})
    fixes = {(f["at"], f["latitude"], f["longitude"]) for f in found["/location"]}
    assert {(50, *C), (80, *D), (95, *E)} <= fixes
    before = [metres((f["latitude"], f["longitude"])) for f in found["/location"] if f["at"] < 50]  # type: ignore[arg-type, operator]
    assert len(before) >= 10
    assert max(math.dist(xy, metres(A)) for xy in before) <= math.dist(metres(A), metres(C)), "no farther than it came"
    closed = [json.loads(str(m["geojson"]))["features"] for m in found["/blocked"]]
    assert [[f["geometry"]["type"] for f in one] for one in closed] == [["Polygon", "Point"], ["Point"]]
    assert shape(closed[0][0]["geometry"]).is_valid
    tried = json.loads(str(found["/captures"][-1]["geojson"]))["features"]
    assert [f["properties"]["status"] for f in tried] == ["in_doubt", "success"]
    assert sum(line["level"] == 3 for line in found["/log"]) == 7


@pytest.mark.parametrize(("at", "second"), [("2026-05-01T08:00:00+00:00", 1777622400), ("", 0), ("soon", 0)])
def test_an_mcap_begins_when_its_log_says(tmp_path: Path, at: str, second: int) -> None:
    with McapLog(tmp_path / "m.mcap") as log:
        for event in (replace(LOG[0], at=at), *LOG[1:]):
            log(event)
    with (tmp_path / "m.mcap").open("rb") as stream:
        times = [message.log_time / 1e9 for _, _, message in make_reader(stream).iter_messages()]
    assert (min(times), max(times)) == (second, second + 100)


def test_routes_carry_them() -> None:
    route = driven(LOG, tell=TELL)
    assert [behind for behind, _ in route.incidents] == [0] * 7 + [1] * 3
    features = json.loads(write_geojson(route))["features"]
    named = [f["properties"]["what"] for f in features]
    assert [name for name in named if name in NAMES] == NAMES
    assert "blocked" not in named, "what was free at the end is not drawn"
    (still,) = [
        f
        for f in json.loads(write_geojson(driven(LOG[:7], tell=TELL)))["features"]
        if f["properties"]["what"] == "blocked"
    ]
    assert isinstance(shape(still["geometry"]), Polygon)
    rows = list(csv.DictReader(io.StringIO(write_csv(route).decode(), newline="")))
    assert [row["event"] for row in rows] == [*NAMES[:7], "", *NAMES[7:]]
    assert "no way is left to tree 2" in rows[2]["said"]
    marks = etree.fromstring(write_kml(route)).findall(".//{*}Folder[3]/{*}Placemark")
    assert [mark.findtext("{*}name").replace(" ", "_") for mark in marks] == NAMES
