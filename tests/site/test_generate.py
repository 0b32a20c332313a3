"""Test generated orchards: a seed always gives the same one, every one can be read, and the pond obstructs drives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.site.demo_orchard import OrchardShape, Variety, demo_orchard, generate_orchard, to_text
from fieldhand.site.drives import Drives
from fieldhand.site.loader import open_site, parse_site
from fieldhand.site.random_orchards import random_orchard


def test_the_same_seed_gives_the_same_orchard_and_another_seed_another():
    assert to_text(demo_orchard(3)) == to_text(demo_orchard(3))
    assert to_text(demo_orchard(3)) != to_text(demo_orchard(4))


def test_the_pond_obstructs_some_drives_and_cuts_nothing_off():
    site = open_site("demo")
    places = [t.place for t in site.trees] + list(site.markers.values())
    lengths = Drives(site, 0.5).lengths(places)
    xy = np.array([p.xy for p in places])
    straight = np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1))
    assert np.isfinite(lengths).all()
    assert (lengths > straight + 0.5).mean() > 0.05
    assert (lengths - straight).max() > 5.0


@settings(max_examples=15, deadline=None)
@given(
    st.integers(0, 2**32),
    st.integers(2, 12),
    st.integers(2, 12),
    st.floats(-60, 60),
    st.floats(-170, 170),
    st.floats(-90, 90),
)
def test_every_orchard_can_be_read_back_with_its_spacing_and_rows(seed, rows, trees, latitude, longitude, turned):
    far_pond = (500.0, 0.0, 1.0, 1.0)
    shape = OrchardShape(rows=rows, trees_a_row=trees, turned_deg=turned, pond=far_pond, missing=0.0, jitter_m=0.02)
    made = generate_orchard(
        np.random.default_rng(seed),
        name="made",
        tree="vine",
        latitude=latitude,
        longitude=longitude,
        shape=shape,
        varieties=(Variety(name="Muscat", yield_kg=4.0, age_years=5),),
    )
    site = parse_site(to_text(made).encode(), name="made")
    assert len(site.trees) == rows * trees
    assert len({t.row for t in site.trees}) == rows
    assert site.spacing_m == pytest.approx(5.0, abs=0.3)
    assert min(site.attributes["yield_kg"]) > 0.0


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 4), st.floats(4.0, 15.0))
def test_a_random_orchard_records_the_row_of_each_tree(seed, blocks, road_m):
    made = random_orchard(seed, trees=120, blocks=blocks, road_m=road_m, jitter=0.02, named="everything", strays=2)
    assert (
        made.to_bytes()
        == random_orchard(
            seed, trees=120, blocks=blocks, road_m=road_m, jitter=0.02, named="everything", strays=2
        ).to_bytes()
    )
    site = parse_site(made.to_bytes(), name="made")
    assert np.abs(site.xy - (site.xy[0] - made.xy[0]) - made.xy).max() < 0.02
    assert (made.row_of == -1).sum() == (made.block_of == -1).sum() == 2
    for block in range(blocks):
        own = made.xy[made.block_of == block]
        others = made.xy[(made.block_of >= 0) & (made.block_of != block)]
        if len(others):
            assert np.hypot(*(own[:, None] - others[None]).transpose(2, 0, 1)).min() > road_m - 0.01
