"""Readers of Nav2's files for the tests, after its sources and not after ours.

Maps: ``nav2_map_server/src/map_io.cpp``. Speed limits: ``nav2_costmap_2d/plugins/costmap_filters/speed_filter.cpp``.
Graphs: ``nav2_route/src/plugins/graph_file_loaders/geojson_graph_file_loader.cpp``.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import yaml
from pyproj import Geod

from fieldhand.robot.bindings import Datum

UNKNOWN, FREE, OCCUPIED = -1, 0, 100


@dataclass(frozen=True)
class OccupancyGrid:
    """A map as the map server publishes it: the first row of ``data`` has the least y."""

    data: np.ndarray
    resolution: float
    x: float
    y: float

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """Row and column of a point (``nav2_util::worldToMap``)."""
        assert x >= self.x
        assert y >= self.y
        return int((y - self.y) / self.resolution), int((x - self.x) / self.resolution)

    def at(self, x: float, y: float) -> int:
        return int(self.data[self.cell(x, y)])

    def corners(self, row: int, column: int) -> list[tuple[float, float]]:
        """Corners of a cell."""
        left, low = self.x + column * self.resolution, self.y + row * self.resolution
        right, high = left + self.resolution, low + self.resolution
        return [(left, low), (right, low), (right, high), (left, high)]


def read_map(files: Mapping[str, bytes], name: str) -> OccupancyGrid:
    """Read a map by its YAML file."""
    keys = yaml.safe_load(files[name])
    assert {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"} <= set(keys)
    assert "/" not in keys["image"]
    assert keys["origin"][2] == 0.0, "costmaps ignore the rotation of a map"
    image = files[keys["image"]]
    header = re.match(rb"P5\s+(\d+)\s+(\d+)\s+255\s", image)
    assert header is not None
    width, height = int(header[1]), int(header[2])
    grey = np.frombuffer(image[header.end() :], dtype=np.uint8)
    assert len(grey) == width * height
    grey = grey.reshape(height, width)[::-1]
    if keys.get("mode", "trinary") == "raw":
        data = np.where(grey <= OCCUPIED, grey.astype(int), UNKNOWN)
    else:
        share = 1.0 - grey / 255.0
        data = np.where(share >= keys["occupied_thresh"], OCCUPIED, UNKNOWN)
        data = np.where(share <= keys["free_thresh"], FREE, data)
    x, y, _ = keys["origin"]
    return OccupancyGrid(data=data, resolution=keys["resolution"], x=x, y=y)


def speed_limit(value: int, info: Mapping[str, float]) -> float:
    """The limit of a cell of a speed mask; infinite for none."""
    assert 0 <= value <= 100, "an unknown cell is an error of the filter"
    if value == 0:
        return math.inf
    limit = value * info["multiplier"] + info["base"]
    return math.inf if limit <= 0.0 else limit


@dataclass(frozen=True)
class Graph:
    """A route graph: position of each node, and start, end and metadata of each edge, by id."""

    nodes: dict[int, tuple[float, float]]
    places: dict[int, list[str]]
    edges: dict[int, tuple[int, int, dict[str, Any]]]
    frames: frozenset[str]

    def ways(self) -> Iterator[tuple[tuple[float, float], tuple[float, float], dict[str, Any]]]:
        for start, end, metadata in self.edges.values():
            yield self.nodes[start], self.nodes[end], metadata


def read_graph(data: bytes) -> Graph:
    """Read a graph; an edge must name nodes that exist."""
    features = json.loads(data)["features"]
    points = [f for f in features if f["geometry"]["type"] == "Point"]
    lines = [f for f in features if f["geometry"]["type"] in ("MultiLineString", "LineString")]
    assert points
    assert lines
    assert len(points) + len(lines) == len(features)
    nodes = {f["properties"]["id"]: tuple(f["geometry"]["coordinates"][:2]) for f in points}
    edges: dict[int, tuple[int, int, dict[str, Any]]] = {}
    for feature in lines:
        has = feature["properties"]
        assert has["startid"] in nodes
        assert has["endid"] in nodes
        assert isinstance(has["id"], int)
        assert has["id"] not in edges
        ((first, last),) = feature["geometry"]["coordinates"]
        assert (tuple(first), tuple(last)) == (nodes[has["startid"]], nodes[has["endid"]])
        edges[has["id"]] = (has["startid"], has["endid"], has.get("metadata", {}))
    assert len(nodes) == len(points)
    assert not set(nodes) & set(edges)
    assert all(isinstance(n, int) and n >= 0 for n in (*nodes, *edges))
    return Graph(
        nodes=nodes,  # type: ignore[arg-type]
        places={f["properties"]["id"]: f["properties"].get("metadata", {}).get("places", []) for f in points},
        edges=edges,
        frames=frozenset(f["properties"]["frame"] for f in points),
    )


def on_map(datum: Datum, degrees: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Map coordinates of (lat, lon) by the geodesic from the datum."""
    found = []
    for lat, lon in degrees:
        azimuth, _, metres = Geod(ellps="WGS84").inv(datum.lon, datum.lat, lon, lat)
        turn = math.radians(datum.heading_deg - azimuth)
        found.append((metres * math.cos(turn), metres * math.sin(turn)))
    return found


def on_earth(datum: Datum, points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """(lat, lon) of map coordinates, along the geodesic from the datum."""
    found = []
    for x, y in points:
        azimuth = datum.heading_deg - math.degrees(math.atan2(y, x))
        lon, lat, _ = Geod(ellps="WGS84").fwd(datum.lon, datum.lat, azimuth, math.hypot(x, y))
        found.append((lat, lon))
    return found
