"""Hypothesis strategies for small orchards with known rows, with and without pond, fence and markers."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from fieldhand.site.loader import parse_site
from fieldhand.site.model import Site
from fieldhand.site.random_orchards import BlockShape, GeneratedOrchard, make_orchard

seeds = st.integers(0, 2**32 - 1)


@st.composite
def block_shapes(draw: st.DrawFn, *, most_rows: int = 7, most_along: int = 10, jitter: float = 0.1) -> BlockShape:
    """Draw a block of at least 4 rows whose spacing is at least 1.25 times that of the trees in a row."""
    spacing = draw(st.floats(3.0, 7.0))
    return BlockShape(
        rows=draw(st.integers(4, most_rows)),
        trees_a_row=draw(st.integers(7, most_along)),
        row_spacing_m=spacing * draw(st.floats(1.25, 2.5)),
        tree_spacing_m=spacing,
        bearing_deg=draw(st.floats(0.0, 180.0, exclude_max=True)),
        ends=draw(st.sampled_from(["even", "ragged"])),
        missing=draw(st.sampled_from([0.0, 0.1])),
        jitter=draw(st.sampled_from([0.0, jitter / 2, jitter])),
    )


@st.composite
def made_orchards(
    draw: st.DrawFn, *, most_blocks: int = 2, surrounded: bool = True, named: bool = False
) -> GeneratedOrchard:
    """Draw an orchard of a few blocks together with its true rows.

    Args:
        most_blocks: Maximum number of blocks.
        surrounded: Allow a pond, a fence and markers.
        named: Name rows, blocks and positions in the file.
    """
    rng = np.random.default_rng(draw(seeds))
    return make_orchard(
        rng,
        draw(st.lists(block_shapes(), min_size=1, max_size=most_blocks)),
        road_m=draw(st.floats(20.0, 30.0)),
        named="everything" if named else "none",
        shuffled=draw(st.booleans()),
        pond_m=draw(st.sampled_from([0.0, 3.0, 6.0])) if surrounded else 0.0,
        fenced=surrounded and draw(st.booleans()),
        markers=surrounded and draw(st.booleans()),
    )


@st.composite
def orchard_sites(draw: st.DrawFn, *, most_blocks: int = 2, surrounded: bool = True, named: bool = False) -> Site:
    """Draw the site of one of :func:`made_orchards`."""
    return site_of_made(draw(made_orchards(most_blocks=most_blocks, surrounded=surrounded, named=named)))


def site_of_made(made: GeneratedOrchard) -> Site:
    """Return the site read from the file of a generated orchard."""
    return parse_site(made.to_bytes(), name="made")
