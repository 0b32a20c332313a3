"""Maps of sites with thousands of trees: each name can be read, and where the work is can be seen."""

from __future__ import annotations

import itertools
from functools import cache

import pytest

from fieldhand.approval.preview import draw_map
from fieldhand.approval.readback import read_back
from fieldhand.approval.stops import DrawnPlan, Leg, MapStop, plan_of
from fieldhand.evaluation.report.maps import draw_map as report_map
from fieldhand.forecast.estimate import estimate
from fieldhand.places.selectors import Corners
from fieldhand.site.drawing.blocks import block_words
from fieldhand.site.drawing.choices import choices_picture
from fieldhand.site.loader import parse_site
from fieldhand.site.random_orchards import random_orchard
from fieldhand.task.plan import ForEach
from fieldhand.task.results import Acted, Arrived, Driving
from fieldhand.testing.small_orchard import husky, orchard, task_for

#: Names of all kinds that stand on maps.
GIDS = ("name", "zone", "block", "row", "tree", "gate", "label", "window label", "value")


@cache
def made(trees, seed, blocks):
    return parse_site(random_orchard(seed, trees=trees, blocks=blocks, named="rows and blocks").to_bytes(), name="made")


@cache
def small():
    """A Task with its words, of a site that nobody looks at here."""
    site = orchard()
    task = task_for(site, ForEach(id="", select=Corners(), body=_picture()))
    forecast = estimate(task, site, husky())
    words = read_back(task, site, husky(), forecast)
    return task, words, plan_of(task, [b.walk for b in forecast.branches], words.lines)


def _picture():
    from fieldhand.task.plan import Act

    return Act(id="", action="take_thermal_picture")


def planned(site, trees):
    """A plan that visits trees one after the other, from the start and back."""
    stops = tuple(
        MapStop(place=t.place, labels=[f"1.{k}"], actions={"take_thermal_picture": "certain"}, certainty="certain")
        for k, t in enumerate(trees, start=1)
    )
    way = [site.start.xy, *(t.place.xy for t in trees), site.start.xy]
    return DrawnPlan(stops=stops, legs=tuple(Leg(points=leg, certainty="certain") for leg in itertools.pairwise(way)))


def drawn(site, trees):
    task, words, _ = small()
    return draw_map(task, site, planned(site, trees), words)


def rows_of(site, block, *numbers):
    rows = [site.planting.blocks[block].rows[k] for k in numbers]
    return [site.trees[t] for row in rows for t in row.trees]


def names_on(ax):
    """Each name that stands on axes, with the box that it covers when it is drawn, in pixels."""
    renderer = ax.get_figure(root=True).canvas.get_renderer()
    return [(t, t.get_window_extent(renderer)) for t in ax.texts if t.get_gid() in GIDS and t.get_text()]


def assert_legible(figure):
    """No name covers another, and none leaves the axes on which it stands."""
    figure.draw_without_rendering()
    for ax in figure.axes:
        frame, names = ax.get_window_extent(), names_on(ax)
        for text, box in names:
            assert frame.x0 - 2 <= box.x0 <= box.x1 <= frame.x1 + 2, text.get_text()
            assert frame.y0 - 2 <= box.y0 <= box.y1 <= frame.y1 + 2, text.get_text()
        straight = [(t, box) for t, box in names if t.get_rotation() % 180 == 0]
        for (one, a), (other, b) in itertools.combinations(straight, 2):
            assert not a.padded(-1.5).overlaps(b.padded(-1.5)), (one.get_text(), other.get_text())


def said(ax, gid):
    return {t.get_text() for t in ax.texts if t.get_gid() == gid}


SITES = [(4000, 3, 2), (4466, 7, 3), (10_000, 5, 4)]


@pytest.mark.parametrize(("trees", "seed", "blocks"), SITES)
def test_a_plan_of_many_visits_is_legible_and_names_blocks_and_rows(trees, seed, blocks):
    site = made(trees, seed, blocks)
    work = rows_of(site, 0, 1, 2)[:117]
    figure = drawn(site, work)
    assert_legible(figure)
    whole = figure.axes[0]
    assert {block_words(b) for b in site.planting.blocks} <= said(whole, "block")
    assert len(said(whole, "row")) > 4
    assert {z.name for z in site.zones if z.kind != "boundary"} <= said(whole, "zone")
    detail = figure.axes[2] if len(figure.axes) > 2 else whole
    assert {"1.1", f"1.{len(work)}"} <= said(detail, "label")


@pytest.mark.parametrize(("trees", "seed", "blocks"), SITES)
def test_where_the_work_is_small_it_is_drawn_larger_and_its_place_is_shown(trees, seed, blocks):
    site = made(trees, seed, blocks)
    (tree,) = work = [rows_of(site, 0, 3)[5]]
    figure = drawn(site, work)
    assert_legible(figure)
    whole, _, detail = figure.axes
    (frame,) = (patch for patch in whole.patches if patch.get_gid() == "window")
    (west, east), (south, north) = detail.get_xlim(), detail.get_ylim()
    assert (west, south) == pytest.approx(frame.get_xy())
    assert (east - west, north - south) == pytest.approx((frame.get_width(), frame.get_height()))
    assert west < tree.place.x < east
    assert south < tree.place.y < north
    assert said(detail, "label") == {f"1.1  tree {tree.place.id}"}
    assert said(whole, "window label") == {"1.1"}


def test_a_small_site_and_work_all_over_a_large_one_need_no_second_drawing():
    task, words, plan = small()
    assert len(draw_map(task, orchard(), plan, words).axes) == 2
    site = made(4000, 3, 2)
    corners = [
        site.trees[int(k)] for b in site.planting.blocks for r in (b.rows[0], b.rows[-1]) for k in r.trees[[0, -1]]
    ]
    figure = drawn(site, corners)
    assert len(figure.axes) == 2
    assert_legible(figure)
    assert len(said(figure.axes[0], "label")) == len(corners)


def test_the_same_plan_is_drawn_the_same():
    site = made(4000, 3, 2)
    figures = [drawn(site, rows_of(site, 1, 0)[:30]) for _ in range(2)]
    one, other = ([(t.get_text(), t.get_position()) for ax in f.axes for t in ax.texts] for f in figures)
    assert one == other


@pytest.mark.parametrize("count", [1, 40, 117])
def test_a_report_of_a_large_site_shows_the_work_and_where_it_lies(count):
    site = made(4466, 7, 3)
    work = rows_of(site, 1, 2, 3)[:count]
    events, at = [], site.start
    for k, tree in enumerate(work):
        place = tree.place
        path = ((at.lat, at.lon), (place.lat, place.lon))
        there = {"kind": "tree", "place": place.id}
        degrees = {"lat": place.lat, "lon": place.lon, "charge_percent": 90.0}
        events += [
            Driving(t=k, node="n1", planned_m=1.0, path=path, **there),
            Arrived(t=k, node="n1", leg_m=1.0, travelled_m=1.0, **there, **degrees),
            Acted(t=k, node="n2", action="take_thermal_picture", status="success", count=1, **there, **degrees),
        ]
        at = place
    figure, _ = report_map(site, events, None)
    assert_legible(figure)
    detail, whole = figure.axes
    (west, east), (south, north) = detail.get_xlim(), detail.get_ylim()
    assert all(west < t.place.x < east and south < t.place.y < north for t in work)
    assert [patch.get_gid() for patch in whole.patches].count("window") == 1
    assert {block_words(b) for b in site.planting.blocks} <= said(whole, "block")
    assert said(detail, "row")


def test_a_question_on_a_large_site_names_blocks_and_rows():
    site = made(4000, 3, 2)
    places = [[t.place for t in rows_of(site, block, 4)] for block in (0, 1)]
    figure = choices_picture(site, "Row 5 of which block?", ["of the one", "of the other"], places)
    assert_legible(figure)
    assert {block_words(b) for b in site.planting.blocks} <= said(figure.axes[0], "block")
    assert len(said(figure.axes[0], "row")) > 4
