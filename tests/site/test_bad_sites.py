"""Test bad site files: every fault is reported with its feature, and no keep-out or barrier is lost."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyproj
import pytest

from fieldhand.errors import SiteError
from fieldhand.site.loader import load_site, parse_site
from fieldhand.site.model import Site
from support.sites.points import area, collection, point, read, square

LON, LAT = -120.42, 37.26
TREES = [point(LON + k * 1e-4, LAT) for k in range(3)]
BOW = [[LON, LAT], [LON + 1e-3, LAT + 1e-3], [LON + 1e-3, LAT], [LON, LAT + 1e-3], [LON, LAT]]


def refused(*features: Any, lenient: bool = False, **more: Any) -> str:
    with pytest.raises(SiteError) as caught:
        parse_site(collection(*features, **more), name="field", source="field.geojson", lenient=lenient)
    message = str(caught.value)
    assert message.startswith("field.geojson")
    assert "\n" not in message
    assert caught.value.advice
    assert caught.value.exit_status == 2
    return message


def leniently(*features: Any, **more: Any) -> Site:
    return parse_site(collection(*features, **more), name="field", source="field.geojson", lenient=True)


def geometry(shape: str, coordinates: Any, /, **properties: Any) -> dict[str, Any]:
    return {"type": "Feature", "properties": properties, "geometry": {"type": shape, "coordinates": coordinates}}


FAULTS = {
    "NaN": (geometry("Point", [float("nan"), LAT]), "not a finite number"),
    "infinite": (geometry("Point", [LON, float("inf")]), "not a finite number"),
    "missing geometry": ({"type": "Feature", "properties": {}, "geometry": None}, "no geometry"),
    "no feature": (17, "not a GeoJSON Feature"),
    "swapped": (point(LAT, LON), "swapped"),
    "kilometres away": (point(LON + 1, LAT), "88 km from the middle of the trees"),
    "unclosed zone": (area([*square(LON, LAT)[:4], [LON, LAT]], name="a"), "not closed"),
    "self-intersecting zone": (area(BOW, name="a"), "crosses or touches itself"),
    "no numbers": (geometry("Point", []), "its coordinates contain nothing"),
    "one number": (geometry("Point", [-120]), "its coordinates contain only one number"),
    "text for a number": (geometry("Point", ["-120", LAT]), "its longitude is '-120'"),
    "a number that is none": (point(LON, LAT + 1e-4, age=float("nan")), "property 'age' is not a finite number"),
    "a gate of no width": (point(LON, LAT, kind="gate", width_m=0), "its width is '0'"),
    "a fence of one point": (geometry("LineString", [[LON, LAT], [LON, LAT]], name="a"), None),
}


@pytest.mark.parametrize("fault", [name for name, (_, says) in FAULTS.items() if says])
def test_a_fault_is_reported_with_its_feature_and_skipped_only_if_lenient(fault):
    feature, says = FAULTS[fault]
    message = refused(*TREES, feature)
    assert message.startswith("field.geojson, feature 4: ")
    assert says in message
    site = leniently(*TREES, feature)
    assert len(site.trees) == 3
    if fault != "unclosed zone":
        assert site.notes[0].startswith("left out feature 4: ")
        assert says in site.notes[0]
        assert site.zones == ()


def test_a_lenient_reading_closes_an_unclosed_zone():
    site = leniently(*TREES, FAULTS["unclosed zone"][0])
    assert [z.kind for z in site.zones] == ["zone"]
    assert site.notes == ("a polygon that was not closed was closed: feature 4",)


@pytest.mark.parametrize(
    ("feature", "says"),
    [
        (area(BOW, kind="pond"), "crosses"),
        (area(BOW, kind="boundary"), "crosses"),
        (area(square(LON + 1, LAT), kind="pond"), "88 km"),
        (area(square(LAT, LON), name="fence"), "swapped"),
        ({"type": "Feature", "properties": {"kind": "keep-out"}, "geometry": None}, "no geometry"),
        (geometry("LineString", [[LON, LAT]], kind="fence"), "fewer than 2"),
        (geometry("LineString", [[LON + 1, LAT], [LON + 1, LAT + 1e-4]], kind="fence"), "km from the middle"),
    ],
)
def test_features_that_keep_a_robot_out_are_never_skipped(feature, says):
    for lenient in (False, True):
        assert says in refused(*TREES, feature, lenient=lenient)


def test_several_faults_are_reported_together():
    message = refused(
        *TREES,
        {"type": "Feature", "properties": {}},
        point(float("nan"), LAT),
        area(BOW, name="a"),
        {"type": "Feature", "properties": {}},
        point(LON, LAT, kind="start"),
        area(square(LON, LAT), kind="pond"),
    )
    assert "5 features cannot be used" in message
    for said in (
        "features 4 and 7: it has no geometry",
        "feature 5: its longitude",
        "feature 6: its polygon",
        "feature 8",
    ):
        assert said in message
    assert "--lenient" in message


def test_the_report_of_a_thousand_faults_is_short():
    many = [point(LON, LAT + 1e-4, age=float("nan")) for _ in range(500)] + [point(LON, 100.0 + k) for k in range(500)]
    message = refused(*TREES, *many)
    assert "1000 features" in message
    assert "features 4, 5, 6, 7, 8 and 495 more" in message
    assert len(message) < 2500
    site = leniently(*TREES, *many)
    assert len(site.notes) == 11
    assert "left out 491 more features" in site.notes[10]


def test_trees_within_20_centimetres_are_noted_and_the_second_skipped_if_lenient():
    near = point(LON + 1e-6, LAT)  # 9 cm
    apart = point(LON, LAT + 4e-6)  # 44 cm
    features = [*TREES, near, point(LON, LAT), apart]
    site = read(*features)
    assert len(site.trees) == 6
    assert site.notes == ("trees within 0.2 m of one another, probably entered twice: features 1 and 4, 1 and 5",)
    sound = leniently(*features)
    assert [t.feature for t in sound.trees] == [1, 2, 3, 6]
    assert [t.place.id for t in sound.trees] == ["1", "2", "3", "6"]
    assert [t.index for t in sound.trees] == [0, 1, 2, 3]
    assert "left out features 4 and 5: the tree stands within 0.2 m of that of feature 1" in sound.notes[0]


def test_trees_outside_the_boundary_are_rejected_by_number():
    fence = area(square(LON, LAT), kind="boundary")
    features = [fence, point(LON, LAT), point(LON + 2e-4, LAT), point(LON + 3e-4, LAT)]
    assert "features 3 and 4 cannot be used: the tree stands outside the boundary" in refused(*features)
    assert [t.feature for t in leniently(*features).trees] == [2]
    assert "none of its trees" in refused(area(square(LON + 0.01, LAT), kind="boundary"), *TREES, lenient=True)


def test_a_tree_on_the_line_of_the_boundary_is_inside():
    ends = [[LON, LAT], [LON + 0.02, LAT], [LON + 0.02, LAT + 1e-3], [LON, LAT + 1e-3], [LON, LAT]]
    assert len(read(area(ends, kind="boundary"), *(point(LON + k * 0.005, LAT) for k in range(5))).trees) == 5


def test_trees_in_a_keep_out_are_kept_and_noted():
    site = read(*TREES, area(square(LON, LAT, 5e-5), kind="pond", name="pond"))
    assert len(site.trees) == 3
    assert site.notes == ("the tree of feature 1 stands inside the keep-out 'pond' and cannot be visited",)


@pytest.mark.parametrize("kind", ["start", "end", "charger"])
def test_a_marker_on_closed_ground_is_rejected_or_skipped(kind):
    features = [*TREES, point(LON, LAT + 1e-3, kind=kind), area(square(LON, LAT + 1e-3), kind="pond", name="pond")]
    assert f"feature 4: the {kind} marker lies inside the keep-out 'pond'" in refused(*features)
    site = leniently(*features)
    assert site.markers == {}
    assert [z.name for z in site.zones] == ["pond"]


def test_the_first_of_two_start_markers_is_kept():
    features = [*TREES, point(LON, LAT + 1e-4, kind="start"), point(LON, LAT + 2e-4, kind="home")]
    assert "feature 5: it is a second start marker (the first is feature 4)" in refused(*features)
    assert leniently(*features).markers["start"].lat == LAT + 1e-4


def test_a_lenient_reading_ignores_only_a_crs_of_wgs_84():
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}
    assert "RFC 7946" in refused(*TREES, crs=crs)
    assert 'the "crs" member was ignored' in leniently(*TREES, crs=crs).notes[0]
    assert "WGS 84" in refused(*TREES, crs={"properties": {"name": "EPSG:32610"}}, lenient=True)


@pytest.mark.parametrize(("lon", "lat"), [(-120.0, 37.0), (180.0, -17.0), (-180.0, 66.0), (0.0, 0.0)])
def test_a_site_in_two_utm_zones_or_across_the_antimeridian_has_true_distances(lon, lat):
    """The trees lie on both sides of -120 and 0 degrees, which are borders of UTM zones."""
    degrees = [
        ((lon + east * 1e-3 + 180.0) % 360.0 - 180.0, lat + north * 1e-3) for east in (-9, 0, 7) for north in (-3, 4)
    ]
    wall = [degrees[0], degrees[1], degrees[5], degrees[4], degrees[0]]
    site = read(*(point(*d) for d in degrees), area(wall, kind="zone"))
    geodesic = pyproj.Geod(ellps="WGS84")
    for a in range(6):
        for b in range(a):
            true_m = geodesic.inv(*degrees[a], *degrees[b])[2]
            assert float(np.hypot(*(site.xy[a] - site.xy[b]))) == pytest.approx(true_m, abs=0.01)
    assert site.zones[0].polygon.area == pytest.approx(np.ptp(site.xy[:, 0]) * np.ptp(site.xy[:, 1]), rel=0.01)


def test_mixed_heights_are_ignored_and_noted():
    site = read(*TREES[:2], geometry("Point", [LON, LAT + 1e-4, 55.5]), area([[*p, 3.0] for p in square(LON, LAT)]))
    assert len(site.trees) == 3
    assert site.notes == ("heights are not used (2 features have them)",)


def test_a_geometry_collection_counts_as_its_parts():
    parts = [{"type": "Point", "coordinates": [LON, LAT]}, {"type": "MultiPoint", "coordinates": [[LON, LAT + 1e-4]]}]
    feature = {"type": "Feature", "properties": {}, "geometry": {"type": "GeometryCollection", "geometries": parts}}
    assert [t.feature for t in read(feature).trees] == [1, 1]
    inner = {"type": "GeometryCollection", "geometries": [{"type": "GeometryCollection", "geometries": parts}]}
    assert "nested" in refused({"type": "Feature", "properties": {}, "geometry": inner})


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "empty"),
        ("lat,lon\n", "no points"),
        ("37.26,-120.42\n37.27,-120.42\n", "line 1: the first line is not a header"),
        ("a,b\n1,2\n", "line 1: it has no column for latitude or longitude (its columns: 'a', 'b')"),
        ("lat,b\n1,2\n", "no column for longitude"),
        ("lat,lon\n37.26,-120.42\n37.26\n", "line 3: it has 1 columns, the header has 2"),
        ("lat,lon\n37.26,-120.42,7\n", "line 2: it has 3 columns"),
        ("lat,lon,a\n37.26,,7\n", "line 2: its longitude is empty"),
        ("lat,lon,a\n,-120.42,7\n", "line 2: its latitude is empty"),
        ("lat,lon\n37.26,nan\n", "line 2: its longitude is not a finite number"),
        ("lat,lon\n37.26,west\n", "line 2: its longitude is 'west'"),
        ("lat,lon\n-120.42,37.26\n", "line 2: its latitude would be -120.42"),
        ("lat,lon\n4129876,701234\n", "out of range"),
        ("lat;lon\n37°15'36\"N;120°25'12\"W\n", "write decimal degrees: 37.2600000"),
        ("lat,lon\n37.26,120 25.2 W\n", "write decimal degrees: -120.4200000"),
        ('lat,lon,a\n37.26,-120.42,"open\n', "line 2: the table cannot be read from this line on"),
        ("lat,lon,age\n37.26,-120.42,1e999\n", "property 'age' is not a finite number"),
    ],
)
def test_a_bad_table_is_reported_with_its_line(tmp_path, text, says):
    path = tmp_path / "field.csv"
    path.write_text(text)
    with pytest.raises(SiteError) as caught:
        load_site(path)
    assert says in str(caught.value)
    assert caught.value.advice


def test_bad_lines_are_skipped_if_lenient(tmp_path):
    path = tmp_path / "field.csv"
    path.write_text("lat,lon\n37.26,-120.42\n,\n37.26\n37.26,x\n37.2601,-120.42\n")
    with pytest.raises(SiteError, match=r"2 lines cannot be used: line 4: .* line 5: "):
        load_site(path)
    site = load_site(path, lenient=True)
    assert [t.feature for t in site.trees] == [2, 6]
    assert site.notes[0].startswith("left out line 4: it has 1 columns")
