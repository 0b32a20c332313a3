"""A site is the built-in one or the data itself; its map holds what the site holds, where it is."""

from __future__ import annotations

import base64
import hashlib
import json
import zipfile
from pathlib import Path
from typing import Any

import pytest
import shapely

from fieldhand.site.loader import demo_path, load_demo, parse_site
from fieldhand.site.random_orchards import random_orchard
from support.processes.browser import browser


def point(lon: float, lat: float, **properties: object) -> dict[str, Any]:
    return {"type": "Feature", "geometry": {"type": "Point", "coordinates": [lon, lat]}, "properties": properties}


ORCHARD = {
    "type": "FeatureCollection",
    "features": [point(-120.0 + i * 1e-4, 37.0, variety="Kerman") for i in range(4)],
}


def test_the_map_holds_every_tree_marker_and_zone_where_it_is() -> None:
    site = load_demo()
    features = browser().post("/api/site", {"site": "demo"}).json()["map"]["features"]
    places = {
        f["properties"]["id"]: f["geometry"]["coordinates"] for f in features if f["properties"]["role"] == "tree"
    }
    assert places.keys() == site.by_id.keys()
    for name, (lon, lat) in places.items():
        place = site.by_id[name].place
        assert (lon, lat) == pytest.approx((place.lon, place.lat), abs=1e-7)
    assert {f["properties"]["name"] for f in features if f["properties"]["role"] == "marker"} == set(site.markers)
    zones = [f for f in features if f["properties"]["role"] == "zone"]
    assert [z["properties"]["kind"] for z in zones] == [z.kind for z in site.zones]
    for feature, zone in zip(zones, site.zones, strict=True):
        lon, lat = feature["geometry"]["coordinates"][0][0]
        assert site.projection.metres(lat, lon)[0] == pytest.approx(zone.polygon.exterior.coords[0], abs=0.02)


def test_each_block_has_an_outline_around_its_trees() -> None:
    data = random_orchard(3, trees=200, blocks=2, named="rows and blocks").to_bytes()
    given = {"name": "made.geojson", "text": data.decode()}
    features = browser().post("/api/site", {"site": given}).json()["map"]["features"]
    site = parse_site(data, name="made")
    blocks = [f for f in features if f["properties"]["role"] == "block"]
    assert len(blocks) == len(site.planting.blocks) == 2
    for feature, block in zip(blocks, site.planting.blocks, strict=True):
        outline = shapely.Polygon(feature["geometry"]["coordinates"][0])
        trees = [site.trees[int(k)].place for row in block.rows for k in row.trees]
        assert all(outline.covers(shapely.Point(place.lon, place.lat)) for place in trees)
        assert block.name in feature["properties"]["name"]


def test_a_file_sent_as_text_keeps_its_hash() -> None:
    data = demo_path().read_bytes()
    sent = browser().post("/api/site", {"site": {"name": "my field.geojson", "text": data.decode()}}).json()
    assert sent["sha256"] == hashlib.sha256(data).hexdigest()


def test_a_site_sent_as_an_object_is_read() -> None:
    known = browser().post("/api/site", {"site": ORCHARD}).json()
    assert (known["trees"], known["attributes"]) == (4, ["variety"])


def test_a_path_is_no_site_even_where_the_file_is_good(tmp_path: Path) -> None:
    path = tmp_path / "site.geojson"
    path.write_text(json.dumps(ORCHARD))
    for given in (str(path), f"file://{path}", str(demo_path()), "./demo", ""):
        answer = browser().post("/api/site", {"site": given})
        assert answer.status_code == 422
        assert answer.json()["where"] == "site"
        assert "never the name of a file" in answer.json()["what"]


@pytest.mark.parametrize(
    ("site", "word"),
    [
        ({"trees": 3}, "FeatureCollection"),
        ({"type": "FeatureCollection", "features": []}, "tree"),
        ({"type": "FeatureCollection", "features": [point(37.0, -120.0), point(37.0, -120.1)]}, "swapped"),
        ({"text": "{not json"}, "JSON"),
        ({"text": ""}, "empty"),
        ({"text": 7}, "FeatureCollection"),
        ({"name": "a" * 1000, "text": "{}"}, "FeatureCollection"),
    ],
)
def test_what_is_no_site_is_said_in_words(site: dict[str, Any], word: str) -> None:
    answer = browser().post("/api/site", {"site": site})
    assert answer.status_code == 400
    assert word in answer.json()["what"] + answer.json()["advice"]


@pytest.mark.parametrize("site", [7, None, [], True])
def test_what_is_not_even_an_object_is_a_fault_of_shape(site: object) -> None:
    answer = browser().post("/api/site", {"site": site})
    assert answer.status_code == 422
    assert answer.json()["where"] == "site"


def test_numbers_that_are_none_and_texts_that_are_none_are_refused() -> None:
    headers = {"content-type": "application/json"}
    for body in (
        '{"site": {"type": "FeatureCollection", "features": [{"type": "Feature", "geometry":'
        ' {"type": "Point", "coordinates": [NaN, 37]}, "properties": {}}]}}',
        '{"site": {"text": "\\ud800"}}',
        '{"site": ' + "[" * 100_000 + "]" * 100_000 + "}",
        '{"site": {"a": ' + '{"a":' * 900 + "1" + "}" * 902,
        "[1, 2",
        "",
        b"\xff\xfe",
    ):
        answer = browser().call("POST", "/api/site", content=body, headers=headers)
        assert answer.status_code in (400, 422), body[:80]
        assert answer.json()["what"]


def test_the_map_holds_the_rows_with_the_trees_that_stand_in_them() -> None:
    site = load_demo()
    features = browser().post("/api/site", {"site": "demo"}).json()["map"]["features"]
    rows = [f for f in features if f["properties"]["role"] == "row"]
    assert [r["properties"]["name"] for r in rows] == [r.name for r in site.planting.rows]
    for feature, row in zip(rows, site.planting.rows, strict=True):
        first = site.trees[int(row.trees[0])].place
        assert feature["geometry"]["coordinates"][0] == pytest.approx([first.lon, first.lat], abs=1e-7)
        assert len(feature["geometry"]["coordinates"]) == len(row.trees)
    named = {f["properties"]["id"]: f["properties"]["row"] for f in features if f["properties"]["role"] == "tree"}
    assert named == {t.place.id: t.row for t in site.trees}


TABLE = "id,latitude,longitude\n" + "\n".join(f"{k},{48 + 2e-5 * k},8.0" for k in range(6)) + "\n"


def test_a_table_is_a_site_by_the_name_of_its_file() -> None:
    known = browser().post("/api/site", {"site": {"name": "field.csv", "text": TABLE}}).json()
    assert (known["name"], known["trees"]) == ("field", 6)
    assert known["sha256"] == hashlib.sha256(TABLE.encode()).hexdigest()


def test_bytes_are_the_same_site_as_their_text() -> None:
    text = browser().post("/api/site", {"site": {"name": "field.csv", "text": TABLE}}).json()
    packed = base64.b64encode(TABLE.encode()).decode()
    assert browser().post("/api/site", {"site": {"name": "field.csv", "base64": packed}}).json() == text


def test_an_archive_of_a_gis_format_is_read(tmp_path: Path) -> None:
    pytest.importorskip("pyogrio")
    kml = (
        '<kml xmlns="http://www.opengis.net/kml/2.2"><Document>'
        + "".join(
            f"<Placemark><Point><coordinates>8,{48 + k * 2e-5}</coordinates></Point></Placemark>" for k in range(5)
        )
        + "</Document></kml>"
    )
    archive = tmp_path / "field.kmz"
    with zipfile.ZipFile(archive, "w") as packed:
        packed.writestr("doc.kml", kml)
    body = {"name": "field.kmz", "base64": base64.b64encode(archive.read_bytes()).decode()}
    assert browser().post("/api/site", {"site": body}).json()["trees"] == 5


@pytest.mark.parametrize(
    ("site", "status"),
    [
        ({"name": "field.zip", "base64": "not base64!"}, 422),
        ({"name": "field.zip", "base64": base64.b64encode(b"no archive").decode()}, 400),
        ({"name": "field.kmz", "base64": base64.b64encode(b"PK\x03\x04 broken").decode()}, 400),
        ({"name": "field.csv", "base64": ""}, 400),
    ],
)
def test_files_that_are_no_site_are_said_in_words(site: dict[str, Any], status: int) -> None:
    answer = browser().post("/api/site", {"site": site})
    assert answer.status_code == status
    assert answer.json()["what"]


def test_the_path_in_the_name_of_a_file_is_not_followed(tmp_path: Path) -> None:
    secret = tmp_path / "secret.csv"
    secret.write_text(TABLE)
    answer = browser().post("/api/site", {"site": {"name": str(secret), "text": "id,latitude,longitude\n1,48,8\n"}})
    assert answer.json()["trees"] == 1
    assert str(tmp_path) not in answer.text
