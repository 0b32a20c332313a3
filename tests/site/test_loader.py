"""Test the loader of sites: trees, markers and areas, and a one-line error for every unusable file."""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import SiteError
from fieldhand.site.demo_orchard import demo_orchard, to_text
from fieldhand.site.demo_vineyard import NORTH, SOUTH, demo_vineyard
from fieldhand.site.drives import Drives
from fieldhand.site.loader import built_in_path, demo_path, load_site, open_site, parse_site
from support.sites.points import area, collection, point, read, square

LON, LAT = -120.42, 37.26


@pytest.mark.parametrize(
    "properties",
    [
        {},
        {"marker-symbol": "pistachio-tree"},
        {"kind": "tree"},
        {"Type": "Vine"},
        {"class": "Kerman"},
        {"name": "Old Joe"},
        {"kind": "gate tree"},
    ],
)
def test_a_point_without_another_kind_is_a_tree(properties):
    assert len(read(point(LON, LAT, **properties)).trees) == 1


@pytest.mark.parametrize(
    ("properties", "marker"),
    [
        ({"marker-symbol": "start"}, "start"),
        ({"marker_symbol": "START"}, "start"),
        ({"kind": "Starting Point"}, "start"),
        ({"kind": "home"}, "start"),
        ({"type": "end"}, "end"),
        ({"Symbol": "finish"}, "end"),
        ({"class": "charging-station"}, "charger"),
        ({"kind": "dock"}, "charger"),
        ({"name": "Charger"}, "charger"),
    ],
)
def test_markers_are_recognized_by_any_of_their_words(properties, marker):
    site = read(point(LON, LAT), point(LON, LAT + 1e-4, **properties))
    assert list(site.markers) == [marker]
    assert len(site.trees) == 1


def test_landmarks_are_left_out_with_a_note():
    site = read(point(LON, LAT), point(LON, LAT, kind="Pump"), point(LON, LAT, kind="Water Well"))
    assert len(site.trees) == 1
    assert site.markers == {}
    assert "pump" in site.notes[0]
    assert "water well" in site.notes[0]


def test_lines_are_left_out_with_a_note():
    line = {"type": "Feature", "geometry": {"type": "LineString", "coordinates": [[LON, LAT], [LON, LAT]]}}
    site = read(point(LON, LAT), line)
    assert (len(site.trees), len(site.zones)) == (1, 0)
    assert "1 line" in site.notes[0]


def test_every_point_of_a_multipoint_is_a_tree():
    geometry = {"type": "MultiPoint", "coordinates": [[LON, LAT], [LON + 1e-4, LAT, 55.0]]}
    site = read({"type": "Feature", "properties": {"row": 3}, "geometry": geometry})
    assert [t.place.id for t in site.trees] == ["1", "2"]
    assert {t.row for t in site.trees} == {"3"}


def test_the_files_own_ids_are_used_if_all_trees_have_one_and_all_differ():
    site = read(point(LON, LAT, id=7), point(LON, LAT, kind="start"), point(LON + 1e-4, LAT, id="B 2"))
    assert [t.place.id for t in site.trees] == ["7", "B 2"]


def test_feature_ids_count_as_the_files_own():
    features = [point(LON + k * 1e-4, LAT) | {"id": f"t{k}"} for k in range(3)]
    assert [t.place.id for t in read(*features).trees] == ["t0", "t1", "t2"]


@pytest.mark.parametrize("second", [{"id": 7}, {}, {"id": True}, {"id": "a\nb"}, {"id": [1]}])
def test_trees_without_unique_ids_are_numbered_from_one_in_file_order(second):
    site = read(point(LON, LAT, id=7), point(LON, LAT, kind="start"), point(LON + 1e-4, LAT, **second))
    assert [t.place.id for t in site.trees] == ["1", "2"]
    assert [t.feature for t in site.trees] == [1, 3]
    assert "ids" in site.notes[0]


def test_properties_are_scalars_numbers_are_floats_and_booleans_stay():
    tree = read(point(LON, LAT, age=7, name="x", sick=True, nested={"a": 1}, listed=[1], nothing=None)).trees[0]
    assert dict(tree.properties) == {"age": 7.0, "name": "x", "sick": True}
    assert isinstance(tree.properties["age"], float)
    assert tree.properties["sick"] is True


def test_text_that_cannot_be_printed_or_written_to_xml_is_refused():
    for name in ("a\u0000b", "a\ud800c"):
        with pytest.raises(SiteError, match=r"feature 1: its name contains the invisible character U\+"):
            parse_site(collection(point(LON, LAT, name=name)), name="x")


@pytest.mark.parametrize("key", ["row", "row_id", "Row-Number", "ROW"])
@pytest.mark.parametrize(("value", "row"), [(3, "3"), ("B2", "B2")])
def test_rows_are_read_from_any_of_their_property_names(key, value, row):
    assert read(point(LON, LAT, **{key: value})).trees[0].row == row


@pytest.mark.parametrize(
    ("properties", "kind", "name"),
    [
        ({"kind": "keep-out"}, "keep_out", "keep-out"),
        ({"type": "No_Go Zone", "name": "ditch side"}, "keep_out", "ditch side"),
        ({"kind": "pond"}, "keep_out", "pond"),
        ({"name": "North pond"}, "keep_out", "North pond"),
        ({"obstacle": True, "name": "pile"}, "keep_out", "pile"),
        ({"kind": "boundary"}, "boundary", "boundary"),
        ({"kind": "Field", "name": "Home 40"}, "boundary", "Home 40"),
        ({"name": "fence"}, "boundary", "fence"),
        ({"name": "wet corner"}, "zone", "wet corner"),
        ({"kind": "zone", "name": "wet field"}, "zone", "wet field"),
        ({}, "zone", "zone 1"),
    ],
)
def test_areas_are_boundary_keep_out_or_named_zone(properties, kind, name):
    zone = read(point(LON, LAT), area(square(LON, LAT), **properties)).zones[0]
    assert (zone.kind, zone.name) == (kind, name)


def test_holes_and_the_parts_of_a_multipolygon_are_kept():
    rings = [square(LON, LAT, 0.001), square(LON, LAT, 0.0005)[::-1]]
    geometry = {"type": "MultiPolygon", "coordinates": [rings, [square(LON + 0.01, LAT)]]}
    site = read(point(LON, LAT), {"type": "Feature", "properties": {"name": "a"}, "geometry": geometry})
    assert [len(z.polygon.interiors) for z in site.zones] == [1, 0]


def test_the_projection_is_about_the_middle_of_the_trees():
    site = read(point(LON, LAT), point(LON + 0.001, LAT + 0.001))
    assert site.xy.sum(axis=0) == pytest.approx([0.0, 0.0], abs=0.01)
    assert site.xy[1, 0] > 0
    assert site.xy[1, 1] > 0


def test_a_site_may_lie_across_the_date_line():
    site = read(point(179.9999, -17.0), point(-179.9999, -17.0))
    assert site.spacing_m == pytest.approx(21.3, abs=0.1)


def test_the_name_of_the_collection_takes_precedence_over_the_file_name():
    assert read(point(LON, LAT), name="West block").name == "West block"
    assert read(point(LON, LAT)).name == "field"


def test_the_same_bytes_give_the_same_fingerprint_and_others_another():
    one, other = collection(point(LON, LAT)), collection(point(LON, LAT), name="x")
    assert parse_site(one, name="a").sha256 == parse_site(one, name="b").sha256
    assert parse_site(one, name="a").sha256 != parse_site(other, name="a").sha256


def test_the_built_in_orchard_opens_by_name_and_is_what_the_generator_writes():
    assert demo_path().read_text(encoding="utf-8") == to_text(demo_orchard())
    site = open_site("demo")
    assert site.name == "Demo orchard"
    assert set(site.markers) == {"start", "end", "charger"}
    assert 120 <= len(site.trees) <= 200
    assert [z.name for z in site.zones_of("keep_out")] == ["pond"]


def test_the_built_in_vineyard_opens_by_name_and_is_what_the_generator_writes():
    assert built_in_path("vineyard").read_text(encoding="utf-8") == to_text(demo_vineyard())
    site = open_site("vineyard")
    assert site.name == "Demo vineyard"
    assert dict(site.marker_names) == {"start": "barn", "end": "loading bay"}
    assert "charger" in site.markers
    assert [g.place.id for g in site.gates] == ["meadow gate"]
    assert {z.name for z in site.zones_of("zone")} == {"meadow", "wet corner", "pump"}
    assert [(b.name, len(b.rows)) for b in site.planting.blocks] == [("North", NORTH.rows), ("South", SOUTH.rows)]
    planted = sum(b.rows * b.vines_a_row for b in (NORTH, SOUTH))
    assert 0.95 * planted < len(site.trees) < planted


def test_every_vine_of_the_built_in_vineyard_can_be_reached_by_a_wide_robot():
    site = open_site("vineyard")
    drives = Drives(site, 0.75, 1.8)
    assert drives.problems([t.place for t in site.trees]) == ("",) * len(site.trees)


def test_a_byte_order_mark_is_accepted():
    assert len(parse_site(b"\xef\xbb\xbf" + collection(point(LON, LAT)), name="x").trees) == 1


def fault_of(data: bytes) -> str:
    with pytest.raises(SiteError) as caught:
        parse_site(data, name="field", source="field.geojson")
    message = str(caught.value)
    assert message.startswith("field.geojson")
    assert "\n" not in message
    assert caught.value.advice
    return message


BOW = [[LON, LAT], [LON + 1e-3, LAT + 1e-3], [LON + 1e-3, LAT], [LON, LAT + 1e-3], [LON, LAT]]
TREE = point(LON, LAT)


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "empty"),
        (b"  \n", "empty"),
        (b"\xff\xfe{", "not UTF-8"),
        (b'{"type":', "not JSON"),
        (b"{\n oops}", "line 2"),
        (b"[1, 2]", "not GeoJSON"),
        (b'"words"', "not GeoJSON"),
        (b'{"features": []}', "not a FeatureCollection"),
        (b'{"type": "FeatureCollection", "features": 3}', "not a FeatureCollection"),
        (json.dumps(TREE).encode(), "one Feature"),
        (collection(), "no points"),
        (collection(point(LON, LAT, kind="start")), "no trees"),
        (collection(TREE, point(-220.0, 37.0)), "feature 2: its coordinates [-220, 37] are out of range"),
        (collection(TREE, point(LAT, LON)), "feature 2: its latitude would be -120.42: latitude and longitude seem"),
        (collection(TREE, point(701234.0, 4129876.0)), "EPSG:4326"),
        (collection(point(10.0, 50.0), point(10.001, 50.0), point(50.0, 10.0)), "feature 3: it lies"),
        (collection(point(10.0, 50.0), point(10.001, 50.0), point(50.0, 10.0)), "longitude are swapped"),
        (collection(TREE, TREE, point(LON + 1, LAT)), "88 km"),
        (collection(TREE, area(square(LON + 1, LAT), name="far")), "feature 2: it lies"),
        (collection(TREE, point(float("nan"), LAT)), "feature 2: its longitude is not a finite number"),
        (collection(TREE, point(LON, float("inf"))), "feature 2: its latitude is not a finite number"),
        (collection(point(LON, LAT, age=float("nan"))), "property 'age' is not a finite number"),
        (b'{"type":"FeatureCollection","features":[],"x":' + b"9" * 5000 + b"}", "thousands of digits"),
        (collection(TREE).replace(b"37.26", b"1" + b"0" * 400), "not a finite number"),
        (collection(TREE, {"type": "Feature", "properties": {}}), "feature 2: it has no geometry"),
        (collection(TREE, {"type": "Feature", "properties": {}, "geometry": None}), "feature 2: it has no geometry"),
        (collection(TREE, "tree"), "feature 2: it is not a GeoJSON Feature"),
        (collection(TREE, TREE | {"properties": [1]}), "feature 2: its properties are not an object"),
        (collection(TREE | {"geometry": {"type": "GeometryCollection"}}), "GeometryCollection"),
        (collection(TREE | {"geometry": {"type": ["Point"]}}), "cannot be used"),
        (collection(TREE | {"geometry": {"type": "Point"}}), "its coordinates are None"),
        (collection(TREE | {"geometry": {"type": "Point", "coordinates": [1]}}), "[longitude, latitude]"),
        (collection(TREE | {"geometry": {"type": "Point", "coordinates": ["1", 2]}}), "its longitude is '1'"),
        (collection(TREE | {"geometry": {"type": "Point", "coordinates": [True, 2]}}), "its longitude is True"),
        (collection(TREE | {"geometry": {"type": "MultiPoint", "coordinates": []}}), "missing or not a list"),
        (collection(TREE, area(square(LON, LAT)[:3])), "feature 2: its polygon has 3 positions"),
        (collection(TREE, area([*square(LON, LAT)[:4], [LON, LAT]])), "feature 2: its polygon is not closed"),
        (collection(TREE, area(BOW)), "feature 2: its polygon crosses or touches itself"),
        (collection(TREE, area([[LON, LAT]] * 4)), "feature 2: its polygon"),
        (
            collection(TREE, point(LON, LAT, kind="start"), point(LON, LAT, kind="home")),
            "feature 3: it is a second start",
        ),
        (
            collection(TREE, point(LON, LAT, kind="start"), area(square(LON, LAT), kind="pond")),
            "start marker lies inside",
        ),
        (
            collection(TREE, point(LON + 1e-2, LAT, kind="end"), area(square(LON, LAT), kind="fence")),
            "outside the boundary",
        ),
        (collection(TREE, crs={"properties": {"name": "EPSG:32611"}}), "is not WGS 84"),
        (collection(TREE, crs={"properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}), "delete that member"),
        (collection(TREE, crs={"properties": {"name": "EPSG:4326"}}), "RFC 7946"),
        (collection(TREE, crs=None), "RFC 7946"),
        (b'{"type":"FeatureCollection","features":' + b"[" * 200_000, "nested too deeply"),
    ],
)
def test_an_unusable_file_gives_one_line_with_location_and_advice(data, says):
    assert says in fault_of(data)


def test_a_file_of_200_megabytes_is_refused_before_it_is_read(tmp_path, monkeypatch):
    path = tmp_path / "big.geojson"
    path.write_bytes(collection(TREE))
    os.truncate(path, 200_000_000)
    monkeypatch.setattr(Path, "read_bytes", lambda _: pytest.fail("it was read"))
    with pytest.raises(SiteError, match="200 MB, more than 100 MB"):
        load_site(path)
    with pytest.raises(SiteError, match="more than"):
        parse_site(bytes(100_000_001), name="x")


@pytest.mark.parametrize(
    ("path", "says"),
    [
        ("nowhere.geojson", "no such file"),
        (".", "not a file"),
        ("a\0b", "no such file"),
        ("x" * 5000, "cannot be read"),
    ],
)
def test_a_path_without_a_site_is_reported(tmp_path, monkeypatch, path, says):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SiteError, match=says) as caught:
        load_site(Path(path))
    assert caught.value.exit_status == 2


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=10,
)


@settings(max_examples=150)
@given(
    st.lists(
        json_values
        | st.fixed_dictionaries(
            {
                "type": st.just("Feature"),
                "properties": json_values,
                "geometry": st.fixed_dictionaries(
                    {
                        "type": st.sampled_from(["Point", "Polygon", "MultiPoint", "MultiPolygon", "LineString"]),
                        "coordinates": json_values,
                    }
                ),
            }
        ),
        max_size=3,
    )
)
def test_no_json_ends_in_a_traceback(features):
    data = json.dumps({"type": "FeatureCollection", "features": [TREE, *features]}).encode()
    with contextlib.suppress(SiteError):
        assert len(parse_site(data, name="x").trees) >= 1
