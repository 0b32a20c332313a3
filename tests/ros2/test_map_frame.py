"""From degrees to a robot's map, against another way to compute it."""

from __future__ import annotations

import math

import pyproj
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.execution.drivers.ros2.map_frame import degrees_to_map
from fieldhand.robot.bindings import Datum
from support.examples import examples

GEOD = pyproj.Geod(ellps="WGS84")


@settings(max_examples=examples(25, thorough=300), deadline=None)
@given(
    lat=st.floats(-65.0, 65.0),
    lon=st.floats(-180.0, 180.0),
    heading=st.floats(-360.0, 360.0),
    bearing=st.floats(0.0, 360.0),
    metres=st.floats(0.0, 5_000.0),
)
def test_a_point_in_the_map_is_where_a_local_cartesian_frame_has_it(
    lat: float, lon: float, heading: float, bearing: float, metres: float
) -> None:
    there_lon, there_lat, _ = GEOD.fwd(lon, lat, bearing, metres)
    local = pyproj.Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart +ellps=WGS84"
        f" +step +proj=topocentric +ellps=WGS84 +lat_0={lat!r} +lon_0={lon!r} +h_0=0"
    )
    east, north, _ = local.transform(there_lon, there_lat, 0.0)
    ((x, y),) = degrees_to_map(Datum(lat=lat, lon=lon, heading_deg=heading), [(there_lat, there_lon)])
    turn = math.radians(90.0 - heading)  # from the map's axes to east and north
    back = (x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn))
    assert math.dist(back, (east, north)) < 0.01
