"""Test pictures of sites: they are complete for one tree and for thousands, and names never cover each other."""

from __future__ import annotations

import itertools

import matplotlib.image
import numpy as np
import pytest
from hypothesis import given, settings
from matplotlib.colors import to_rgb

from fieldhand.errors import OutputError
from fieldhand.site.describe import describe_driving
from fieldhand.site.drawing import (
    TREE_COLOUR,
    draw_site,
    name_site,
    save_site_picture,
    site_figure,
    site_picture,
    tree_size,
)
from fieldhand.site.drawing.colours import NO_ROW, ROWS
from fieldhand.site.drives import Drives
from fieldhand.site.loader import open_site, parse_site
from fieldhand.site.random_orchards import random_orchard
from support.sites.points import grid, orchard, site_of, sites

#: Linear RGB as seen with one kind of cone missing (Machado, Oliveira and Fernandes 2009, severity 1).
CONES = {
    "all": np.eye(3),
    "no red": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "no green": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "no blue": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}


def made(trees: int, seed: int = 1, **more):
    return parse_site(random_orchard(seed, trees=trees, **more).to_bytes(), name="made")


def drawn_dots(ax):
    return np.vstack([c.get_offsets() for c in ax.collections if len(c.get_offsets()) and c.get_gid() != "rows"])


def lightness_and_hue(colour: str, seen: np.ndarray) -> np.ndarray:
    """Return the CIE L*a*b* coordinates of a colour as seen with these cones."""
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    to_xyz = np.array([[0.4125, 0.3576, 0.2004], [0.2127, 0.7152, 0.0722], [0.0193, 0.1192, 0.9503]])
    xyz = to_xyz @ np.clip(seen @ linear, 0, 1) / np.array([0.9505, 1.0, 1.0888])
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def boxes_of(figure, gids=("name", "zone", "block", "row", "tree", "gate", "aisle")):
    """Return the area that each name covers on the drawn picture, in pixels."""
    figure.draw_without_rendering()
    renderer = figure.canvas.get_renderer()
    return [(t, t.get_window_extent(renderer)) for t in figure.axes[0].texts if t.get_gid() in gids]


def test_trees_markers_zones_and_scale_are_drawn_at_their_positions():
    site = open_site("demo")
    figure = site_figure(site)
    ax = figure.axes[0]
    draw_site(ax, site)
    figure.draw_without_rendering()
    name_site(ax, site)
    trees, *markers = [c.get_offsets() for c in ax.collections if len(c.get_offsets()) != 1 or c.get_zorder() == 8]
    assert np.allclose(trees, site.xy) or any(np.shape(m) == site.xy.shape and np.allclose(m, site.xy) for m in markers)
    words = {t.get_text() for t in ax.texts}
    assert {"start", "end", "charger", "pond", "wet corner", "N", "20 m"} <= words
    assert "169" not in words
    assert len(ax.patches) == len(site.zones)
    assert ax.get_aspect() == 1.0


def test_the_picture_names_rows_trees_zones_and_markers():
    figure = site_picture(open_site("demo"))
    said = {t.get_gid(): set() for t in figure.axes[0].texts}
    for text in figure.axes[0].texts:
        said[text.get_gid()].add(text.get_text())
    assert said["row"] == {str(k) for k in range(1, 11)}
    assert said["zone"] == {"pond", "wet corner"}
    assert said["name"] == {"start", "end", "charger"}
    assert len(said["tree"]) > 150


@pytest.mark.parametrize("seen", CONES.values(), ids=CONES.keys())
def test_neighbouring_rows_are_distinguishable_with_colour_blindness(seen):
    for one, other in [*itertools.pairwise([*ROWS, ROWS[0]]), *((row, NO_ROW) for row in ROWS)]:
        apart = np.linalg.norm(lightness_and_hue(one, seen) - lightness_and_hue(other, seen))
        assert apart > 20, (one, other)  # 2 is just noticed side by side


def test_trees_of_a_row_have_its_colour_and_trees_in_no_row_are_grey():
    site = site_of([*grid(4, 8), (70.0, 70.0)], row_names=[str(k // 8) for k in range(32)] + [""])
    ax = site_picture(site).axes[0]
    dots = next(c for c in ax.collections if len(c.get_offsets()) == len(site.trees))
    shown = dots.get_facecolors()[:, :3]
    of_row = [{tuple(shown[t].round(6)) for t in row.trees} for row in site.planting.rows]
    assert all(len(colours) == 1 for colours in of_row)
    assert all(one != other for one, other in itertools.pairwise(of_row))
    assert np.allclose(shown[32], to_rgb(NO_ROW))


@pytest.mark.parametrize(("trees", "blocks", "seed"), [(20, 1, 1), (60, 3, 2), (400, 3, 5), (1500, 2, 3), (5000, 3, 4)])
def test_no_name_covers_another_or_leaves_the_picture(trees, blocks, seed):
    figure = site_picture(made(trees, seed, blocks=blocks, named="rows and blocks"))
    boxes = boxes_of(figure)
    frame = figure.axes[0].get_window_extent()
    assert any(t.get_gid() == "row" for t, _ in boxes)
    for _, box in boxes:
        assert frame.x0 - 2 <= box.x0
        assert box.x1 <= frame.x1 + 2
    straight = [(t, b) for t, b in boxes if t.get_rotation() % 180 == 0]
    for (one, a), (other, b) in itertools.combinations(straight, 2):
        assert not a.padded(-1.5).overlaps(b.padded(-1.5)), (one.get_text(), other.get_text())


def test_zones_with_names_keep_them_apart_from_rows_and_markers():
    square = [(5, 5), (15, 5), (15, 13), (5, 13)]
    site = orchard(6, 9, markers={"start": (10, 9), "end": (11, 9)}, zones=[("wet meadow", "zone", square)])
    boxes = boxes_of(site_picture(site))
    assert {"wet meadow", "start", "end"} <= {t.get_text() for t, _ in boxes}
    for (one, a), (other, b) in itertools.combinations(boxes, 2):
        assert not a.padded(-1.5).overlaps(b.padded(-1.5)), (one.get_text(), other.get_text())


def test_among_many_rows_those_with_round_numbers_are_named():
    site = site_of(grid(400, 90), row_names=[str(k // 90 + 1) for k in range(400 * 90)])
    texts = site_picture(site).axes[0].texts
    named = {int(t.get_text()) for t in texts if t.get_gid() == "row"}
    assert 10 < len(named) < 100
    assert {1, 400} <= named
    between = sorted(named - {1, 400})
    assert len({b - a for a, b in itertools.pairwise(between)}) == 1
    assert between[0] % (between[1] - between[0]) == 0
    assert not [t for t in texts if t.get_gid() == "tree"]


def test_long_row_names_run_along_their_rows():
    site = site_of(grid(30, 40), row_names=[f"Kerman {k // 40:02d}" for k in range(1200)])
    turned = [t for t in site_picture(site).axes[0].texts if t.get_gid() == "row"]
    assert len(turned) >= 20
    assert all(abs(t.get_rotation() - 90) < 1 or abs(t.get_rotation() - 270) < 1 for t in turned)


@pytest.mark.parametrize("trees", [1, 2, 20, 5000])
def test_trees_are_visible_and_separate_at_any_number(trees):
    side = int(np.ceil(np.sqrt(trees)))
    site = site_of([(4.0 * (k % side), 4.0 * (k // side)) for k in range(trees)])
    ax = site_picture(site).axes[0]
    assert 1.5 <= tree_size(ax, site) <= 130.0
    assert bool([t for t in ax.texts if t.get_text() == str(trees) and t.get_gid() == "tree"]) == (trees < 5000)


def test_the_picture_is_written_and_shows_rows(tmp_path):
    save_site_picture(orchard(markers={"start": (9, -4)}), tmp_path / "site.png")
    pixels = matplotlib.image.imread(tmp_path / "site.png")[:, :, :3]
    for colour in ROWS[:2]:
        assert (np.abs(pixels - to_rgb(colour)).max(axis=2) < 0.02).sum() > 500


def test_the_base_map_has_muted_colours():
    site = orchard()
    ax = site_figure(site).axes[0]
    draw_site(ax, site)
    dots = next(c for c in ax.collections if len(c.get_offsets()) == len(site.trees))
    assert np.allclose(dots.get_facecolors()[0, :3], to_rgb(TREE_COLOUR))


@settings(max_examples=12, deadline=None)
@given(sites(max_size=25))
def test_any_site_can_be_drawn_with_each_tree_once(site):
    drives = Drives(site, 0.3, 1.0)
    figure = site_picture(site, drives.network(), describe_driving(site, drives, robot="mule"))
    figure.draw_without_rendering()
    dots = [c for c in figure.axes[0].collections if c.get_zorder() == 5]
    assert sum(len(c.get_offsets()) for c in dots) == len(site.trees)


def test_names_with_special_characters_of_matplotlib_are_drawn(tmp_path):
    site = orchard(
        zones=[("$x^{ $", "zone", [(0, 0), (9, 0), (9, 9)])], row_names=[f"$r_{k // 5}$ %" for k in range(20)]
    )
    save_site_picture(site, tmp_path / "site.svg")
    assert (tmp_path / "site.svg").stat().st_size > 1000


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("file/site.png", "cannot be written"),
        ("site.xyz", "not a supported picture format"),
        ("site", "without extension"),
    ],
)
def test_a_site_picture_that_cannot_be_written_is_reported(tmp_path, name, says):
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match=says):
        save_site_picture(orchard(), tmp_path / name)


def test_aisles_headlands_and_unreachable_trees_are_drawn():
    points = [(x if x < 10 else x - 5.4, y) for x, y in grid(4, 5)]  # rows 2 and 3 stand 0.6 m apart
    pond = [(-2, -2), (2, -2), (2, 9), (-2, 9)]
    site = site_of(points, zones=[("pond", "keep_out", pond)], row_names=[str(k // 5) for k in range(20)])
    drives = Drives(site, 0.4, 1.0)
    figure = site_picture(site, drives.network(), describe_driving(site, drives, robot="mule"))
    ax = figure.axes[0]
    drawn = {c.get_gid(): c for c in ax.collections}
    assert len(drawn["aisle"].get_paths()) == len(drives.network().of("aisle"))
    assert len(drawn["closed"].get_paths()) == 1
    assert np.allclose(drawn["closed"].get_paths()[0].vertices[:, 0], 6.3)
    (crosses,) = [line for line in ax.lines if line.get_gid() == "unreachable"]
    assert np.allclose(crosses.get_xydata(), site.xy[:3])
    legend = {t.get_text() for t in figure.legends[0].get_texts()}
    assert {"row of trees", "aisle", "closed to the mule", "cannot be reached"} <= legend


def test_the_legend_contains_only_symbols_on_the_picture():
    texts = site_picture(orchard(row_names=[str(k // 5) for k in range(20)])).legends[0].get_texts()
    assert [t.get_text() for t in texts] == ["row of trees"]
