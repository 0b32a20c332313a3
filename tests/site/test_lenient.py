"""Test lenient reading of sites in every command that takes one."""

from __future__ import annotations

import json
from typing import Any

import pytest

from fieldhand.site.loader import load_site, parse_site
from fieldhand.site.model import Site
from support.processes.command import fieldhand
from support.sites.points import collection, point, read

LON, LAT = -120.42, 37.26
TREES = [point(LON + k * 1e-4, LAT) for k in range(3)]


def leniently(*features: Any, **more: Any) -> Site:
    return parse_site(collection(*features, **more), name="field", source="field.geojson", lenient=True)


def geometry(shape: str, coordinates: Any, /, **properties: Any) -> dict[str, Any]:
    return {"type": "Feature", "properties": properties, "geometry": {"type": shape, "coordinates": coordinates}}


def test_no_json_ends_in_a_traceback_leniently():
    odd = [None, [], {}, "x", {"type": "Feature", "geometry": {"type": "Point", "coordinates": {}}, "properties": []}]
    odd += [
        geometry(kind, c)
        for kind in ("Point", "Polygon", "MultiPolygon", "LineString")
        for c in (None, [], [[]], [[[]]], 7)
    ]
    site = leniently(*TREES, *odd)
    assert len(site.trees) == 3


@pytest.mark.parametrize("command", ["site", "plan", "check", "run"])
def test_every_command_with_a_site_supports_lenient_reading(tmp_path, command):
    path = tmp_path / "field.geojson"
    path.write_bytes(collection(*TREES, point(float("nan"), LAT)))
    sound = tmp_path / "sound.geojson"
    sound.write_bytes(collection(*TREES))
    task = tmp_path / "task.xml"
    assert fieldhand("plan", "Take a picture of the first tree.", "--site", str(sound), "-o", str(task)).status == 0
    words = {
        "site": ["site", str(path)],
        "plan": ["plan", "Take a picture of the first tree.", "--site", str(path)],
        "check": ["check", str(task), "--site", str(path)],
        "run": ["run", "Take a picture of the first tree.", "--site", str(path), "--yes"],
    }[command]
    strict = fieldhand(*words)
    assert strict.status == 2
    assert "feature 4" in strict.err
    loaded = fieldhand(*words, "--lenient")
    assert loaded.status == (1 if command == "check" else 0)  # the task was planned for another file
    assert "left out feature 4: its longitude is not a finite number" in loaded.out + loaded.err


def test_the_command_line_lists_all_skipped_features(tmp_path):
    path = tmp_path / "field.geojson"
    path.write_bytes(collection(*TREES, *(point(LON, 91.0 + k) for k in range(9))))
    shown = fieldhand("site", str(path), "--lenient")
    assert [line for line in shown.out.splitlines() if "left out feature" in line] == [
        f"Note: left out feature {4 + k}: its coordinates [-120.42, {91 + k}] are out of range." for k in range(9)
    ]
    known = json.loads(fieldhand("site", str(path), "--lenient", "--json").out)
    assert len(known["notes"]) == 9
    assert known["content_sha256"] == read(*TREES).content_sha256


def test_the_command_line_writes_the_site_as_geojson(tmp_path):
    out = tmp_path / "out" / "demo.geojson"
    run = fieldhand("site", "demo", "--geojson", str(out))
    assert run.status == 0, run.err
    kinds = {f["properties"].get("kind") for f in json.loads(out.read_text())["features"]}
    assert {"row", "aisle", "headland", "boundary", "keep-out", "start"} <= kinds
    assert len(load_site(out).trees) == len(load_site(out).planting.row_of) > 100
