"""Test descriptions of a site: correct figures, bounded length, and the same facts for programs."""

from __future__ import annotations

import json
import math

import pytest

from fieldhand.site.describe import describe, report_lines, report_record, row_table, summary_lines
from fieldhand.site.describe.rows import direction_words
from fieldhand.site.loader import open_site
from support.sites.points import grid, orchard, site_of


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
def test_the_rotation_of_the_orchard_is_clockwise_from_true_north(turned):
    angle = math.radians(turned)
    c, s = math.cos(angle), math.sin(angle)
    site = site_of([(x * c + y * s, y * c - x * s) for x, y in grid(3, 12)])
    assert describe(site).turned_deg == pytest.approx(turned, abs=1e-6)


def test_the_lines_contain_all_names_a_planner_may_use():
    lines = "\n".join(summary_lines(open_site("demo")))
    for word in ("wet corner", "pond", "fence", "leaf_color", "yellow", "Nonpareil", "charger", "ids 1 to", "yield_kg"):
        assert word in lines


def test_the_summary_of_a_hostile_site_is_no_longer_than_that_of_a_small_one():
    names = [
        {f"key {k} {'x' * 500}": "y" * 10_000 + str(n) for k in range(30)} | {"v": f"value {n}"} for n in range(300)
    ]
    zones = [("z" * 300 + str(k), "zone", [(k, 0), (k + 1, 0), (k, 1)]) for k in range(100)]
    lines = summary_lines(site_of(grid(10, 30), properties=names, zones=zones))
    assert len(lines) < 50
    assert max(map(len, lines)) < 600
    assert any(line.startswith("Zones: zzz") for line in lines)
    assert any("30 values, for example" in line or "300 values, for example" in line for line in lines)
    assert any(line.startswith("Further attributes: ") for line in lines)


def test_a_site_of_one_tree_is_described():
    assert summary_lines(site_of([(0.0, 0.0)]))[0].startswith("Site test site: 1 tree,")


def test_blocks_and_rows_are_described_with_direction_and_spacing():
    site = orchard(4, 5, row_names=[f"R{k // 5 + 1}" for k in range(20)])
    (block,) = describe(site).blocks
    assert (block.rows, block.trees, block.missing, block.counted_from) == (4, 20, 0, "west")
    assert block.bearing_deg % 180 == pytest.approx(0.0, abs=1e-6)
    assert (block.row_spacing_m, block.tree_spacing_m) == (pytest.approx(6.0), pytest.approx(4.0))
    said = "\n".join(report_lines(site))
    assert "4 rows running north-south, 6.0 m apart, trees 4.0 m apart, 20 trees; named in the file." in said
    assert "Rows are counted from west to east, trees in a row from north to south." in said


def test_the_table_has_each_row_with_its_ends_and_its_empty_positions():
    gone = {7, 8}  # two next to each other in the second row from the west
    points = [xy for k, xy in enumerate(grid(3, 6)) if k not in gone]
    site = site_of(points, row_names=[str(int(x / 6) + 1) for x, _ in points])
    rows = row_table(site)
    assert [(r.name, r.trees, r.missing) for r in rows] == [("1", 6, 0), ("2", 4, 2), ("3", 6, 0)]
    for row in rows:
        first, last = site.by_id[row.first].place, site.by_id[row.last].place
        assert first.y > last.y
        assert row.length_m == pytest.approx(first.y - last.y)
    listed = [line.split() for line in report_lines(site) if line.split()[:1] == ["2"]]
    assert listed[0][:3] == ["2", "4", "2"]


@pytest.mark.parametrize(
    ("bearing", "words"),
    [
        (0.0, "north-south"),
        (7.0, "north-south (7 degrees east of north)"),
        (179.2, "north-south (1 degree west of north)"),
        (45.0, "north-east to south-west (45 degrees east of north)"),
        (90.0, "east-west"),
        (95.0, "east-west (5 degrees south of east)"),
        (85.0, "east-west (5 degrees north of east)"),
        (135.0, "north-west to south-east (45 degrees west of north)"),
    ],
)
def test_the_direction_of_rows_is_described_by_the_compass(bearing, words):
    assert direction_words(bearing) == words


def test_few_rows_are_listed_and_many_only_on_request():
    few, many = orchard(20, 5), orchard(60, 5)
    assert len([line for line in report_lines(few) if line.startswith("  ")]) == 21
    short, long = report_lines(many), report_lines(many, all_rows=True)
    assert len(short) < 12
    assert any("--rows" in line for line in short)
    assert len([line for line in long if line.startswith("  ")]) == 61


def test_trees_in_no_row_are_named_with_the_reason():
    site = site_of([*grid(4, 8), (70.0, 70.0)], row_names=[str(k // 8) for k in range(32)] + [""])
    s = describe(site)
    assert (s.in_no_row, s.in_no_row_ids) == (1, ("33",))
    (line,) = (line for line in report_lines(site) if "not in a row" in line)
    assert line.endswith(": 33.")
    assert site.planting.why[1:] in line


def test_a_site_without_rows_is_described_with_the_reason():
    site = site_of([(0, 0), (40, 3), (11, 29), (33, 41), (7, 60), (64, 13)])
    assert not describe(site).blocks
    (line,) = (line for line in report_lines(site) if line.startswith("Rows"))
    assert line == f"Rows: none; {site.planting.why}."


def test_the_json_record_has_the_same_facts_and_no_nan():
    site = orchard(2, 5)
    record = json.loads(json.dumps(report_record(site), allow_nan=False))
    assert record["rows"] == len(record["row_table"]) == len(site.planting.rows)
    assert record["trees"] == 10
    lone = site_of([(0.0, 4.0 * k) for k in range(6)], row_names=["only"] * 6)
    assert json.loads(json.dumps(report_record(lone), allow_nan=False))["blocks"][0]["row_spacing_m"] is None
