"""Named points that are no plants become places: robots stop beside objects and drive onto crossings."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

LON, LAT = 3.65, 51.01
NORTH_30_M = 30 / 111_200


def site_of(tmp_path: Path, *points: dict[str, object], trees: int = 3) -> Site:
    """Return a site with a column of trees 5 m apart and further points, 30 m north of each other."""
    placed = [({"id": f"t{k}"}, LAT + k * 5 / 111_200) for k in range(trees)]
    placed += [(dict(p), LAT + (k + 2) * NORTH_30_M) for k, p in enumerate(points)]
    features = [
        {"type": "Feature", "properties": p, "geometry": {"type": "Point", "coordinates": [LON, lat]}}
        for p, lat in placed
    ]
    path = tmp_path / "farm.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return Site.read(path)


@pytest.mark.parametrize("properties", [{"kind": "trough"}, {"role": "marker"}, {"type": "Weather mast"}])
def test_a_robot_stops_beside_a_named_object(tmp_path, properties):
    site = site_of(tmp_path, {**properties, "name": "old trough"})
    (zone,) = site.zones
    assert (zone.name, zone.kind) == ("old trough", "keep_out")
    outcome = EnglishPlanner().plan("Measure CO2 at the old trough.", site, RobotProfile.load("husky"))
    assert isinstance(outcome, Planned)


@pytest.mark.parametrize("word", ["crossing", "waypoint", "bridge"])
def test_robots_drive_over_crossings(tmp_path, word):
    (zone,) = site_of(tmp_path, {"kind": word, "name": "the ford"}).zones
    assert zone.kind == "zone"


def test_an_object_beside_a_tree_does_not_close_its_ground(tmp_path):
    features = [
        {"type": "Feature", "properties": p, "geometry": {"type": "Point", "coordinates": [LON, LAT]}}
        for p in ({"id": "t1"}, {"kind": "sign", "name": "variety sign"})
    ]
    path = tmp_path / "farm.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    site = Site.read(path)
    assert [z.kind for z in site.zones] == ["zone"]
    assert [t.place.id for t in site.trees] == ["t1"]


def test_objects_without_a_name_are_left_out_with_a_note(tmp_path):
    site = site_of(tmp_path, {"kind": "pump"}, {"kind": "tap", "name": "tap"})
    assert [z.name for z in site.zones] == ["tap"]
    assert any("1 x pump" in note for note in site.notes)


def test_a_zone_of_the_file_keeps_its_name(tmp_path):
    site = site_of(tmp_path, {"kind": "barn", "name": "barn"}, {"kind": "barn", "name": "Barn"})
    assert [z.name for z in site.zones] == ["barn", "Barn 2"]
    ring = [[LON + 1e-3, LAT], [LON + 2e-3, LAT], [LON + 2e-3, LAT + 1e-3], [LON + 1e-3, LAT]]
    features = json.loads((tmp_path / "farm.geojson").read_text())
    features["features"].append(
        {"type": "Feature", "properties": {"name": "barn"}, "geometry": {"type": "Polygon", "coordinates": [ring]}}
    )
    path = tmp_path / "with_zone.geojson"
    path.write_text(json.dumps(features))
    assert len([z for z in Site.read(path).zones if z.name.lower().startswith("barn")]) == 1


def test_a_door_is_a_gate(tmp_path):
    site = site_of(tmp_path, {"kind": "door", "name": "north door"})
    assert [gate.place.id for gate in site.gates] == ["north door"]


@given(names=st.lists(st.text("abc ", min_size=1, max_size=3).filter(str.strip), min_size=1, max_size=8))
def test_zones_of_landmarks_have_different_names_and_contain_their_points(tmp_path_factory, names):
    site = site_of(tmp_path_factory.mktemp("site"), *({"kind": "tap", "name": n} for n in names))
    assert len({z.name.lower() for z in site.zones}) == len(site.zones) == len(names)
    for k, zone in enumerate(site.zones):
        (x, y) = site.projection.metres([LAT + (k + 2) * NORTH_30_M], [LON])[0]
        assert shapely.contains_xy(zone.polygon, x, y)
