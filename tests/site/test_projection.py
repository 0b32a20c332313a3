"""Test the projection: distances are geodesic, to a millimetre within five kilometres of the middle."""

from __future__ import annotations

import pyproj
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.site.projection import Projection

GEOD = pyproj.Geod(ellps="WGS84")


@settings(max_examples=40)
@given(st.floats(-70, 70), st.floats(-179, 179), st.floats(0, 360), st.floats(0.01, 5000))
def test_distance_and_bearing_from_the_middle_are_geodesic(lat, lon, bearing, metres):
    there_lon, there_lat, _ = GEOD.fwd(lon, lat, bearing, metres)
    x, y = Projection(lat, lon).metres(there_lat, there_lon)[0]
    assert (x**2 + y**2) ** 0.5 == pytest.approx(metres, abs=1e-3)
    there = Projection(lat, lon).degrees([[x, y]])[0]
    assert there == pytest.approx([there_lat, there_lon], abs=1e-8)


@settings(max_examples=40)
@given(st.floats(-70, 70), *[st.floats(-2000, 2000)] * 4)
def test_distance_between_two_places_is_geodesic(lat, x0, y0, x1, y1):
    (lat0, lon0), (lat1, lon1) = Projection(lat, 10.0).degrees([[x0, y0], [x1, y1]])
    *_, metres = GEOD.inv(lon0, lat0, lon1, lat1)
    assert ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5 == pytest.approx(metres, abs=1e-2)


@given(lat=st.floats(-89, 89), lon=st.floats(-180, 180), north=st.floats(-0.05, 0.05), east=st.floats(-0.05, 0.05))
def test_it_is_what_proj_finds_for_the_registered_system(lat, lon, north, east):
    local = pyproj.CRS.from_proj4(f"+proj=aeqd +lat_0={lat!r} +lon_0={lon!r} +datum=WGS84 +units=m")
    registered = pyproj.Transformer.from_crs("EPSG:4326", local, always_xy=True)
    found = tuple(Projection(lat, lon).metres(lat + north, lon + east)[0])
    assert found == registered.transform(lon + east, lat + north)
