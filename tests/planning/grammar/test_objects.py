"""Objects that a site names (a trough, a tap): robots stop beside them, one place each."""

from __future__ import annotations

import json

import pytest

from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from planning.grammar.field_requests import require_plan, require_refusal

EAST_M, NORTH_M = 1 / 70_000, 1 / 111_200


@pytest.fixture(scope="module")
def yard(tmp_path_factory: pytest.TempPathFactory) -> Site:
    """A yard of 60 by 40 m with a trough, a tap and a mast, a pen that is closed, and a gate."""

    def at(east: float, north: float) -> list[float]:
        return [3.65 + east * EAST_M, 51.01 + north * NORTH_M]

    def point(east: float, north: float, **properties: object) -> dict[str, object]:
        return {
            "type": "Feature",
            "properties": properties,
            "geometry": {"type": "Point", "coordinates": at(east, north)},
        }

    def area(west: float, south: float, east: float, north: float, **properties: object) -> dict[str, object]:
        ring = [at(west, south), at(east, south), at(east, north), at(west, north), at(west, south)]
        return {
            "type": "Feature",
            "properties": properties,
            "geometry": {"type": "Polygon", "coordinates": [ring]},
        }

    features = [
        area(0, 0, 60, 40, kind="boundary", name="yard"),
        area(40, 20, 55, 35, kind="keep_out", name="bull pen"),
        point(10, 10, kind="trough", name="trough"),
        point(20, 30, kind="tap", name="tap"),
        point(30, 10, kind="landmark", name="weather mast"),
        point(60, 20, kind="gate", name="lane gate"),
        point(5, 5, kind="start"),
    ]
    path = tmp_path_factory.mktemp("yard") / "yard.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return Site.read(path)


@pytest.mark.parametrize(
    ("request_text", "plan"),
    [
        ("Photograph the trough.", "picture @ Transect(1, edge, trough)"),
        (
            "Take a picture of the trough and the tap.",
            "for UnionOf(Transect(1, edge, trough)+Transect(1, edge, tap)): [picture]",
        ),
        (
            "Moisture at 10 and at 40 cm by the trough, the weather mast and the tap.",
            "for UnionOf(Transect(1, edge, trough)+Transect(1, edge, weather mast)+Transect(1, edge, tap)):"
            " [moisture(depth_cm 10); moisture(depth_cm 40)]",
        ),
        ("Drive round the trough and the tap.", "drive perimeter UnionOf(InZone(trough)+InZone(tap))"),
    ],
)
def test_a_robot_works_beside_each_object(yard: Site, request_text: str, plan: str) -> None:
    require_plan(yard, RobotProfile.load("amiga"), request_text, plan)


def test_larger_ground_that_is_closed_is_refused(yard: Site) -> None:
    require_refusal(yard, RobotProfile.load("amiga"), "Photograph the bull pen.", "keep-out")
