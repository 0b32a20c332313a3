"""Test descriptions of driving on a site: aisles, and the unreachable trees with their reasons."""

from __future__ import annotations

import json

import numpy as np
import pytest
import shapely
from shapely.geometry import Polygon

from fieldhand.errors import DriveFault
from fieldhand.site.describe import aisle_table, describe_driving, report_lines, report_record
from fieldhand.site.describe import driving as describe_driving_module
from fieldhand.site.drives import Drives
from fieldhand.site.loader import open_site, parse_site
from fieldhand.site.random_orchards import random_orchard
from support.sites.points import grid, orchard, site_of

NAMED = {"row_names": [str(k // 5 + 1) for k in range(20)]}


def driving_of(site, *, width=0.8, standoff=1.0, **more):
    return describe_driving(site, Drives(site, width / 2, standoff), robot="mule", **more)


def pond(x0, y0, x1, y1, name="pond"):
    return (name, "keep_out", Polygon([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]))


def test_aisles_are_as_wide_as_the_rows_are_apart():
    for across in (3.0, 6.5):
        site = site_of(grid(4, 5, across=across), **NAMED)
        table = aisle_table(site)
        assert [a.between for a in table] == [("1", "2"), ("2", "3"), ("3", "4")]
        for aisle in table:
            assert aisle.width_m == pytest.approx(across)
            assert aisle.narrowest_m == pytest.approx(across)


def test_a_tree_in_the_aisle_narrows_it():
    points = [(x + (2.0 if k == 7 else 0.0), y) for k, (x, y) in enumerate(grid(4, 5))]
    second = aisle_table(site_of(points, **NAMED))[1]
    assert second.width_m == pytest.approx(6.0)
    assert 3.9 < second.narrowest_m <= 4.0


def test_aisles_too_narrow_for_a_robot_are_named():
    points = [(x if x < 10 else x - 5.4, y) for x, y in grid(4, 5)]  # rows 2 and 3 stand 0.6 m apart
    site = site_of(points, **NAMED)
    told = driving_of(site, width=0.8, others={"cart": 0.5, "tractor": 2.0})
    assert told.aisles == 3
    assert told.closed == ("aisle between rows 2 and 3",)
    assert told.too_narrow_for == {"tractor": 1}
    said = "\n".join(report_lines(site, told))
    assert "1 cannot be driven along: between rows 2 and 3" in said
    assert "1 aisle too narrow for the tractor" in said
    assert not driving_of(site, width=0.3).closed


def test_unreachable_trees_are_named_with_the_reason():
    site = orchard(zones=[pond(-2, -2, 2, 9)], **NAMED)  # over trees 1, 2 and 3
    told = driving_of(site)
    assert ("inside the keep-out 'pond'", ("1", "2", "3")) in [(u.why, u.trees) for u in told.unreachable]
    assert any(
        "3 trees cannot be reached: 1, 2, 3 (inside the keep-out 'pond')." in line for line in report_lines(site, told)
    )
    assert not any("Every tree can be reached" in line for line in report_lines(site, told))


def test_on_open_ground_every_tree_can_be_reached():
    told = driving_of(open_site("demo"))
    assert told.unreachable == ()
    assert told.headlands
    assert any("Every tree can be reached" in line for line in report_lines(open_site("demo"), told))


def test_a_site_without_rows_has_no_aisles_but_its_trees_are_checked():
    site = site_of([(0, 0), (40, 3), (11, 29), (33, 41), (7, 60), (64, 13)], zones=[pond(10, 28, 12, 30)])
    told = driving_of(site)
    assert (told.aisles, told.narrowest_m) == (0, None)
    assert [u.trees for u in told.unreachable] == [("3",)]
    assert any("No aisles" in line for line in report_lines(site, told))


def test_trees_behind_a_moat_are_cut_off_from_the_start():
    moat = Polygon([(-4, -4), (22, -4), (22, 20), (-4, 20)], [[(-3.5, -3.5), (21.5, -3.5), (21.5, 19.5), (-3.5, 19.5)]])
    site = orchard(markers={"start": (0, -10)}, zones=[("moat", "keep_out", moat)], **NAMED)
    told = driving_of(site)
    (why,) = {u.why for u in told.unreachable}
    assert "start" in why
    assert sum(len(u.trees) for u in told.unreachable) == 20


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_on_a_large_site_the_same_trees_are_unreachable_as_with_individual_checks(seed, monkeypatch):
    made = parse_site(random_orchard(seed, trees=300, blocks=2).to_bytes(), name="made")
    middle, reach = np.median(made.xy, axis=0), 0.2 * float(np.ptp(made.xy, axis=0).min())
    keep_out = shapely.Point(middle).buffer(reach)
    row_names = [
        made.planting.rows[r].name + f"/{made.planting.rows[r].block}" if r >= 0 else "" for r in made.planting.row_of
    ]
    site = site_of([tuple(p) for p in made.xy.tolist()], zones=[("lake", "keep_out", keep_out)], row_names=row_names)
    each = driving_of(site).unreachable
    assert each
    monkeypatch.setattr(describe_driving_module, "_ASK_ALL", 0)
    assert driving_of(site).unreachable == each


def test_the_summary_agrees_with_the_drives_about_reachable_trees():
    site = orchard(
        5, 6, markers={"start": (-6, -6)}, zones=[pond(3, 5, 8, 13)], row_names=[str(k // 6) for k in range(30)]
    )
    drives = Drives(site, 0.4, 1.0)
    lost = {tree for u in describe_driving(site, drives, robot="mule").unreachable for tree in u.trees}
    for tree in site.trees:
        if tree.place.id in lost:
            with pytest.raises(DriveFault):
                drives.between(site.start, tree.place)
        else:
            assert drives.between(site.start, tree.place).length_m > 0


def test_the_driving_summary_converts_to_json():
    site = orchard(zones=[pond(-2, -2, 2, 9)], **NAMED)
    record = json.loads(json.dumps(report_record(site, driving_of(site)), allow_nan=False))
    assert record["driving"]["robot"] == "mule"
    assert record["driving"]["unreachable"][0]["trees"] == ["1", "2", "3"]
    assert [a["width_m"] for a in record["aisle_table"]] == pytest.approx([6.0, 6.0, 6.0])
