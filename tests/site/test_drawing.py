"""Pictures of sites: all there is is in them, for one tree as for thousands; bad places to write to are told."""

from __future__ import annotations

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from fieldhand.errors import OutputError
from fieldhand.site.drawing import TREE_COLOUR, draw_site, save_site_picture, site_figure, tree_size
from fieldhand.site.geojson import open_site
from sites import orchard, site_of


def test_trees_markers_zones_and_scale_are_drawn_where_they_are():
    site = open_site("demo")
    figure = site_figure(site)
    ax = figure.axes[0]
    draw_site(ax, site)
    drawn = np.vstack([c.get_offsets() for c in ax.collections])
    assert len(drawn) == len(site.trees) + len(site.markers)
    assert np.allclose(drawn[: len(site.trees)], site.xy)
    words = {t.get_text() for t in ax.texts}
    assert {"start", "end", "charger", "pond", "wet corner", "N", "20 m", "1", "169"} <= words
    assert len(ax.patches) == len(site.zones)
    assert ax.get_aspect() == 1.0


@pytest.mark.parametrize("trees", [1, 2, 20, 5000])
def test_trees_can_be_seen_and_told_apart_however_many_there_are(trees):
    side = int(np.ceil(np.sqrt(trees)))
    site = site_of([(4.0 * (k % side), 4.0 * (k // side)) for k in range(trees)])
    ax = site_figure(site).axes[0]
    draw_site(ax, site)
    assert 1.5 <= tree_size(ax, site) <= 130.0
    assert bool([t for t in ax.texts if t.get_text() == str(trees)]) == (trees < 5000)


def test_the_picture_is_written_and_shows_trees(tmp_path):
    save_site_picture(orchard(markers={"start": (9, -4)}), tmp_path / "site.png")
    pixels = matplotlib.image.imread(tmp_path / "site.png")[:, :, :3]
    assert (np.abs(pixels - to_rgb(TREE_COLOUR)).max(axis=2) < 0.02).sum() > 500


def test_names_with_signs_that_mean_something_to_the_drawing_program_are_drawn(tmp_path):
    site = orchard(zones=[("$x^{ $", "zone", [(0, 0), (9, 0), (9, 9)])])
    save_site_picture(site, tmp_path / "site.svg")
    assert (tmp_path / "site.svg").stat().st_size > 1000


@pytest.mark.parametrize(
    ("name", "says"), [("no/such/folder/site.png", "cannot be written"), ("site.xyz", "no kind of picture")]
)
def test_a_picture_that_cannot_be_written_is_told(tmp_path, name, says):
    with pytest.raises(OutputError, match=says):
        save_site_picture(orchard(), tmp_path / name)
