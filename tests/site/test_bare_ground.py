"""Sites without plants: a meadow of areas alone, beds that are numbered, and what a file must have at least."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import SiteError
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.places.selectors import Grid, PointsIn, Transect
from fieldhand.site.describe.lines import report_lines, report_record
from fieldhand.site.drawing.picture import save_site_picture
from fieldhand.site.drives import Drives
from fieldhand.site.model import Site
from support.sites.points import area, point, read, square

LON, LAT = -2.5, 51.5


def meadow(*more: object) -> Site:
    """A square meadow of 220 m by 140 m inside a fence."""
    inside = area(square(LON, LAT, half=0.0009), kind="zone", name="meadow")
    return read(area(square(LON, LAT, half=0.001), kind="boundary", name="fence"), inside, *more)


def test_a_meadow_loads_with_a_start_in_its_middle_and_says_so():
    site = meadow()
    assert site.trees == ()
    assert np.hypot(*site.start.xy) < 5.0
    assert "no start marker" in " ".join(site.notes)
    assert np.ptp(site.outline_xy, axis=0) == pytest.approx((139.0, 222.5), abs=2.0)


def test_a_start_marker_is_where_missions_start():
    site = meadow(point(LON + 0.0005, LAT, kind="start"))
    assert site.start.id == "start"
    assert site.start.x == pytest.approx(34.7, abs=0.5)
    assert not any("no start marker" in note for note in site.notes)


def test_zones_alone_are_a_site_and_keep_outs_alone_are_none():
    assert read(area(square(LON, LAT), name="paddock")).start.id == "start"
    for features in ([], [area(square(LON, LAT), kind="pond")], [point(LON, LAT, kind="start")]):
        with pytest.raises(SiteError, match="needs at least one tree, given as a Point, or a boundary or a zone"):
            read(*features)


def test_a_file_whose_trees_are_all_left_out_is_no_meadow():
    fence = area(square(LON, LAT), kind="boundary", name="fence")
    with pytest.raises(SiteError, match="outside the boundary"):
        read(fence, point(LON + 0.01, LAT))


def test_it_is_described_and_drawn(tmp_path: Path):
    site = meadow()
    text = "\n".join(report_lines(site))
    assert "no trees, only areas" in text
    assert "Zone 'meadow'" in text
    assert report_record(site)["trees"] == 0
    save_site_picture(site, tmp_path / "meadow.png")
    assert (tmp_path / "meadow.png").stat().st_size > 5_000


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 30), st.floats(15.0, 80.0))
def test_points_of_every_sampling_plan_can_be_reached(count, every):
    site = meadow(area(square(LON, LAT, half=0.0001), kind="pond", name="pond"))
    drives = Drives(site, 0.75, 1.5)
    for selector in (
        PointsIn(count=count),
        Transect(count=count),
        Grid(every_m=every),
        Grid(every_m=every, zone="meadow"),
    ):
        places = resolve(selector, site, Context(here=site.start))
        assert {p.kind for p in places} == {"point"}
        assert drives.problems((site.start, *places)) == ("",) * (len(places) + 1)


@pytest.mark.parametrize(
    ("properties", "name"),
    [
        ({"kind": "bed", "number": 4}, "bed 4"),
        ({"kind": "bed", "name": "4"}, "bed 4"),
        ({"kind": "bed", "name": "herbs"}, "herbs"),
        ({"kind": "bench", "no": 12}, "bench 12"),
        ({"kind": "bed"}, "bed"),
        ({"name": "7"}, "7"),
    ],
)
def test_an_area_that_is_only_numbered_is_named_by_its_kind_and_number(properties, name):
    site = read(area(square(LON, LAT), **properties), point(LON, LAT, kind="start"))
    assert [zone.name for zone in site.zones] == [name]
