"""Test the GeoJSON export: it reads back as the same immutable site with the same content hash."""

from __future__ import annotations

import dataclasses
import json

import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.site.demo_orchard import to_text
from fieldhand.site.formats.geojson_export import site_document
from fieldhand.site.loader import load_demo, parse_site
from support.sites.gisfiles import degrees, line
from support.sites.points import area, point, read, square

LON, LAT = -120.42, 37.26

DEMO = load_demo()


spots = st.tuples(st.integers(-200, 200), st.integers(-200, 200)).map(lambda p: (p[0] / 4, p[1] / 4))


def ring_about(centre: tuple[float, float], size: float) -> list[list[float]]:
    x, y = centre
    return degrees((x, y), (x + size, y), (x + size, y + size / 2), (x, y + size), (x, y))


orchards = st.builds(
    lambda trees, features, named: [
        *(point(*degrees(xy)[0], **({"row": f"R{xy[0]:g}"} if named else {}), age=k) for k, xy in enumerate(trees)),
        *features,
    ],
    st.lists(spots, min_size=1, max_size=15, unique=True),
    st.lists(
        st.one_of(
            spots.map(lambda p: point(*degrees(p)[0], kind="gate", width_m=3)),
            st.tuples(spots, st.sampled_from(["zone", "wet corner", "old pond area", "meadow"])).map(
                lambda p: area(ring_about(p[0], 5.0), kind=p[1], name=p[1])
            ),
            spots.map(lambda p: line((-300, 300 + p[0]), (300, 310 + p[0]), kind="fence")),
        ),
        max_size=4,
    ),
    st.booleans(),
)


@settings(max_examples=40, deadline=None)
@given(orchards)
def test_an_exported_site_reads_back_as_the_same_site(features):
    site = read(*features)
    again = parse_site(to_text(site_document(site)).encode(), name="again")
    assert [t.place for t in again.trees] == [t.place for t in site.trees]
    added = ("row", "block", "position")
    assert [{k: v for k, v in t.properties.items() if k not in added} for t in again.trees] == [
        {k: v for k, v in t.properties.items() if k not in added} for t in site.trees
    ]
    assert again.markers == site.markers
    assert again.gates == site.gates
    assert [(z.kind, z.name) for z in again.zones] == [(z.kind, z.name) for z in site.zones]
    for one, other in zip(again.zones, site.zones, strict=True):
        assert one.polygon.hausdorff_distance(other.polygon) < 1e-6
    assert [r.trees.tolist() for r in again.planting.rows] == [r.trees.tolist() for r in site.planting.rows]
    once_more = parse_site(to_text(site_document(again)).encode(), name="again")
    assert once_more.content_sha256 == again.content_sha256


def test_the_document_contains_rows_with_confidence_and_conforms_to_the_standard():
    document = json.loads(to_text(site_document(DEMO)))
    assert "crs" not in document
    rows = [f for f in document["features"] if f["properties"].get("kind") == "row"]
    assert len(rows) == len(DEMO.planting.rows)
    assert all(f["geometry"]["type"] == "LineString" and 0 <= f["properties"]["confidence"] <= 1 for f in rows)
    for f in document["features"]:
        if f["geometry"]["type"] == "Polygon":
            outer, *holes = (shapely.LinearRing(r) for r in f["geometry"]["coordinates"])
            assert outer.is_ccw
            assert not any(hole.is_ccw for hole in holes)


def test_the_hash_of_the_content_does_not_depend_on_how_the_file_is_written():
    features = [point(LON, LAT, age=7, row=1), point(LON, LAT + 1e-4, kind="end"), area(square(LON, LAT), name="x")]
    one = read(*features)
    turned = area(square(LON, LAT)[2:] + square(LON, LAT)[1:3], name="x")
    other = read(turned, point(LON, LAT + 1e-4, kind="finish"), point(LON, LAT, row=1, age=7.0), name="another name")
    assert one.sha256 != other.sha256
    assert one.content_sha256 == other.content_sha256


@pytest.mark.parametrize(
    "other",
    [
        [point(LON, LAT, age=7), point(LON, LAT + 1e-4)],
        [point(LON, LAT, age=8), point(LON + 1e-4, LAT)],
        [point(LON, LAT, age="7"), point(LON + 1e-4, LAT)],
        [point(LON, LAT, age=7), point(LON + 1e-4, LAT), point(LON, LAT, kind="start")],
        [point(LON, LAT, age=7), point(LON + 1e-4, LAT), area(square(LON, LAT), name="x")],
        [point(LON, LAT, age=7), point(LON + 1e-4, LAT), point(LON, LAT, kind="gate")],
        [point(LON + 1e-4, LAT), point(LON, LAT, age=7)],
        [point(LON, LAT, age=7, id="a"), point(LON + 1e-4, LAT, id="b")],
    ],
)
def test_the_hash_of_the_content_changes_with_every_part_of_a_site(other):
    assert read(point(LON, LAT, age=7), point(LON + 1e-4, LAT)).content_sha256 != read(*other).content_sha256


def test_a_site_cannot_be_changed():
    site = read(point(LON, LAT, age=7), point(LON, LAT, kind="start"))
    with pytest.raises(TypeError):
        site.trees[0].properties["age"] = 8.0  # type: ignore[index]
    with pytest.raises(TypeError):
        site.markers["end"] = site.markers["start"]  # type: ignore[index]
    with pytest.raises(TypeError):
        site.by_id["1"] = site.trees[0]  # type: ignore[index]
    with pytest.raises(ValueError, match="read-only"):
        site.xy[0, 0] = 1.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        site.trees[0].place.x = 1.0  # type: ignore[misc]
