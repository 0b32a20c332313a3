"""The summary of a site: right figures, and lines whose number and length do not grow with the site."""

from __future__ import annotations

import math

import pytest

from fieldhand.site.describe import describe, summary_lines
from fieldhand.site.geojson import open_site
from sites import grid, orchard, site_of


def test_the_figures_of_a_rectangular_orchard_are_the_known_ones():
    square = [(-1, -1), (7, -1), (7, 5), (-1, 5)]
    site = orchard(
        markers={"start": (9, -2)},
        zones=[("wet", "zone", square), ("wet", "zone", [(17, 11), (19, 11), (19, 17), (17, 17)])],
        properties=[{"age": float(k), "variety": "Kerman" if k % 2 else "Peters"} for k in range(20)],
        row_names=[str(k // 5) for k in range(20)],
    )
    s = describe(site)
    assert (s.trees, s.first_id, s.last_id, s.rows) == (20, "1", "20", 4)
    assert (s.east_west_m, s.north_south_m, s.area_m2) == (18.0, 16.0, 288.0)
    assert (s.spacing_m, s.turned_deg) == (4.0, 0.0)
    assert s.markers == (("start", 9.0, -2.0),)
    assert [(z.name, z.kind, z.area_m2, z.trees) for z in s.zones] == [("wet", "zone", 60.0, 6)]
    age, variety = s.attributes
    assert (age.minimum, age.maximum, age.distinct) == (0.0, 19.0, 20)
    assert (variety.minimum, variety.values) == (None, ("Kerman", "Peters"))


@pytest.mark.parametrize("turned", [-30, -7, 0, 12, 44])
def test_the_orchards_turn_is_told_clockwise_from_true_north(turned):
    angle = math.radians(turned)
    c, s = math.cos(angle), math.sin(angle)
    site = site_of([(x * c + y * s, y * c - x * s) for x, y in grid(3, 12)])
    assert describe(site).turned_deg == pytest.approx(turned, abs=1e-6)


def test_the_lines_name_what_a_planner_may_ask_for():
    lines = "\n".join(summary_lines(open_site("demo")))
    for word in ("wet corner", "pond", "fence", "leaf_color", "yellow", "Nonpareil", "charger", "ids 1 to", "yield_kg"):
        assert word in lines


def test_a_hostile_site_says_no_more_than_a_small_one():
    names = [
        {f"key {k} {'x' * 500}": "y" * 10_000 + str(n) for k in range(30)} | {"v": f"value {n}"} for n in range(300)
    ]
    zones = [("z" * 300 + str(k), "zone", [(k, 0), (k + 1, 0), (k, 1)]) for k in range(100)]
    lines = summary_lines(site_of(grid(10, 30), properties=names, zones=zones))
    assert len(lines) < 50
    assert max(map(len, lines)) < 600
    assert "And 11 more attributes." in lines
    assert "And 88 more zones." in lines


def test_a_site_of_one_tree_is_described():
    assert summary_lines(site_of([(0.0, 0.0)]))[0].startswith("Site test site: 1 tree,")
