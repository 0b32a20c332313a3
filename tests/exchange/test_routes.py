"""Routes in the formats of other programs: each file obeys its format's own rules, and all say the same."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from lxml import etree
from shapely.geometry import LineString, Point, shape

from fieldhand.exchange.routes.geojson import write_geojson
from fieldhand.exchange.routes.ground_station import write_plan
from fieldhand.exchange.routes.kml import write_kml
from fieldhand.exchange.routes.route import ExportedRoute
from fieldhand.exchange.routes.table import write_csv
from fieldhand.site.loader import load_demo
from fieldhand.task.results import Acted, Arrived
from support.missions.exported import PARTING, driven_route, flight, planned_route

KML = "{http://www.opengis.net/kml/2.2}"
#: Elements of each kind of object in the order of the schema of KML 2.2.
KML_ORDER = {
    "Document": ("name", "description", "Style", "Folder"),
    "Folder": ("name", "description", "Placemark"),
    "Placemark": ("name", "description", "styleUrl", "ExtendedData", "Point", "LineString"),
    "LineString": ("extrude", "tessellate", "altitudeMode", "coordinates"),
    "Point": ("extrude", "altitudeMode", "coordinates"),
    "LineStyle": ("color", "colorMode", "width"),
    "Style": ("LineStyle",),
    "ExtendedData": ("Data",),
    "Data": ("displayName", "value"),
}


@pytest.fixture(params=["planned", "driven"])
def route(request: pytest.FixtureRequest) -> ExportedRoute:
    return planned_route() if request.param == "planned" else driven_route()


def test_a_driven_route_has_the_captures_and_metres_of_its_log() -> None:
    found, events = driven_route(), flight().events
    captures = sum(w.captures for s in found.stops for w in s.work)
    assert captures == sum(e.count for e in events if isinstance(e, Acted) and e.status == "success")
    arrived = [e for e in events if isinstance(e, Arrived)]
    assert [s.travelled_m for s in found.stops] == [e.travelled_m for e in arrived]
    assert found.stops[-1].home
    read = [w.readings["co2"][0] for s in found.stops for w in s.work if "co2" in w.readings]
    assert read == [e.readings["co2"] for e in events if isinstance(e, Acted) and "co2" in e.readings]


def test_what_every_branch_does_is_certain_and_nothing_else() -> None:
    straight = planned_route()
    assert all(stop.certain for stop in straight.stops)
    assert {(w.action, w.certain) for s in straight.stops for w in s.work} == {
        ("take_thermal_picture", True),
        ("read_co2", False),
    }
    assert [stop.certain for stop in planned_route(PARTING).stops] == [True, False, False, False]


def test_geojson_is_rfc_7946(route: ExportedRoute) -> None:
    found = json.loads(write_geojson(route))
    assert found["type"] == "FeatureCollection"
    assert not found.keys() & {"crs", "coordinates", "geometries", "geometry", "properties"}
    for feature in found["features"]:
        assert feature.keys() == {"type", "geometry", "properties"}
        assert feature["type"] == "Feature"
        geometry = shape(feature["geometry"])
        assert geometry.is_valid
        west, south, east, north = geometry.bounds
        assert -121 < west <= east < -120
        assert 37 < south <= north < 38
    points = [f for f in found["features"] if isinstance(shape(f["geometry"]), Point)]
    assert [p["properties"]["number"] for p in points] == list(range(1, len(route.stops) + 1))
    lines = [shape(f["geometry"]) for f in found["features"] if isinstance(shape(f["geometry"]), LineString)]
    for one, two in pairwise(lines):
        assert Point(one.coords[-1]).distance(Point(two.coords[0])) < 1e-7


def test_kml_has_the_elements_and_order_of_its_schema(route: ExportedRoute) -> None:
    root = etree.fromstring(write_kml(route))
    assert root.tag == f"{KML}kml"
    assert [child.tag for child in root] == [f"{KML}Document"]
    ids = {e.get("id") for e in root.iter(f"{KML}Style")}
    for element in root.iter():
        kind = element.tag.removeprefix(KML)
        order = KML_ORDER.get(kind)
        if order is None:
            assert len(element) == 0 or kind == "kml"
            continue
        inside = [order.index(child.tag.removeprefix(KML)) for child in element]
        assert inside == sorted(inside), kind
    for mark in root.iter(f"{KML}Placemark"):
        assert mark.findtext(f"{KML}styleUrl").removeprefix("#") in ids
    for text in root.iter(f"{KML}coordinates"):
        for position in text.text.split():
            lon, lat = map(float, position.split(","))
            assert -180 <= lon <= 180
            assert -90 <= lat <= 90
    points = list(root.iter(f"{KML}Point"))
    assert len(points) == len(route.stops)


def test_kml_says_what_a_gis_program_reads(tmp_path: Path) -> None:
    pyogrio = pytest.importorskip("pyogrio")
    file = tmp_path / "route.kml"
    file.write_bytes(write_kml(planned_route()))
    layers = {str(name) for name, _ in pyogrio.list_layers(file)}
    assert layers == {"Ways", "Stops"}
    info = pyogrio.read_info(file, layer="Stops", force_feature_count=True)
    assert info["features"] == len(planned_route().stops)


def test_csv_has_the_stops_in_order_and_no_formula(route: ExportedRoute) -> None:
    evil = replace(route, stops=(replace(route.stops[0], place="=HYPERLINK(1)"), *route.stops[1:]))
    rows = list(csv.DictReader(io.StringIO(write_csv(evil).decode(), newline="")))
    numbers = [int(row["stop"]) for row in rows]
    assert numbers == sorted(numbers)
    assert set(numbers) == set(range(1, len(route.stops) + 1))
    assert rows[0]["place"] == "'=HYPERLINK(1)"
    assert sum(int(row["captures"] or 0) for row in rows) == sum(w.captures for s in route.stops for w in s.work)


def test_a_ground_station_plan_has_what_its_format_requires() -> None:
    site, found = load_demo(), planned_route()
    made = write_plan(found, site)
    plan = json.loads(made.data)
    assert (plan["fileType"], plan["version"], plan["groundStation"]) == ("Plan", 1, "QGroundControl")
    assert plan["rallyPoints"] == {"version": 2, "points": []}
    fence, mission = plan["geoFence"], plan["mission"]
    assert (fence["version"], mission["version"], mission["vehicleType"]) == (2, 2, 10)
    for polygon in fence["polygons"]:
        assert polygon.keys() == {"version", "inclusion", "polygon"}
        assert len(polygon["polygon"]) >= 3
        assert polygon["polygon"][0] != polygon["polygon"][-1]
    assert [p["inclusion"] for p in fence["polygons"]] == [True, False]
    lat, lon, _ = mission["plannedHomePosition"]
    assert (round(lat), round(lon)) == (37, -120)
    needed = {"firmwareType", "cruiseSpeed", "hoverSpeed", "globalPlanAltitudeMode", "items", "plannedHomePosition"}
    assert needed <= mission.keys()
    boundary = shape({"type": "Polygon", "coordinates": [[(b, a) for a, b in fence["polygons"][0]["polygon"]]]})
    for number, item in enumerate(mission["items"], start=1):
        assert (item["type"], item["command"], item["frame"], item["doJumpId"]) == ("SimpleItem", 16, 3, number)
        assert item["autoContinue"] is True
        assert len(item["params"]) == 7
        assert item["params"][0] >= 0
        assert boundary.contains(Point(item["params"][5], item["params"][4]))
    waits = [item["params"][0] for item in mission["items"] if item["params"][0]]
    assert len(waits) == sum(any(w.certain for w in s.work) for s in found.stops)
    assert (made.stops, made.left_out) == (len(found.stops), 0)


def test_a_ground_station_gets_only_the_straight_part() -> None:
    found = planned_route(PARTING)
    made = write_plan(found, load_demo())
    assert (made.stops, made.left_out) == (1, 3)
    last = json.loads(made.data)["mission"]["items"][-1]["params"]
    assert last[4:6] == [round(d, 9) for d in found.stops[0].stand]
