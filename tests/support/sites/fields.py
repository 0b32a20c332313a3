"""Fields without rows for the tests: star-shaped, with bays and holes, at any place and bearing."""

from __future__ import annotations

import numpy as np
import shapely
from hypothesis import strategies as st
from shapely.affinity import rotate, translate
from shapely.geometry import Point, Polygon


@st.composite
def fields(draw: st.DrawFn, *, holes: int = 2) -> Polygon:
    """Fields of 20 to 100 m with up to so many holes, rarely convex."""
    corners = draw(st.integers(3, 10))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    angles = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False) + rng.uniform(-0.5, 0.5, corners) * (3.0 / corners)
    radii = rng.uniform(15.0, 50.0, corners)
    field = Polygon(np.column_stack([radii * np.cos(angles), radii * np.sin(angles)]))
    for _ in range(draw(st.integers(0, holes))):
        east, north = rng.uniform(-15.0, 15.0, 2).tolist()
        hole = Point(east, north).buffer(float(rng.uniform(1.0, 6.0)), quad_segs=int(rng.integers(1, 6)))
        field = field.difference(hole)
    field = max(shapely.get_parts(field), key=lambda part: part.area)
    field = rotate(field, float(rng.uniform(0.0, 360.0)), origin=(0.0, 0.0))
    return translate(field, float(rng.uniform(-200.0, 200.0)), float(rng.uniform(-200.0, 200.0)))
