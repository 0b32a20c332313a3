"""Requests for samples: quotas, shares, paths, grids, random points, gaps; on vines, meadows and numbered beds."""

from __future__ import annotations

import pytest

from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from fieldhand.task.plan import walk
from planning.english.outlines import outline
from support.sites.points import area, point, read

AMIGA = load_robot("amiga")
VINEYARD = open_site("vineyard")
LON, LAT = -2.5, 51.5


def ring(west: float, south: float, east: float, north: float) -> list[list[float]]:
    """A closed ring of a rectangle in metres, in degrees."""
    x, y = 1.0 / 69_300.0, 1.0 / 111_200.0
    corners = [(west, south), (east, south), (east, north), (west, north), (west, south)]
    return [[LON + u * x, LAT + v * y] for u, v in corners]


def meadow() -> Site:
    """A meadow with two parts and a pond, without a plant and without a marker."""
    return read(
        area(ring(0, 0, 200, 120), kind="boundary", name="fence"),
        area(ring(10, 10, 90, 110), name="lower meadow", kind="zone"),
        area(ring(100, 10, 190, 110), name="upper meadow", kind="zone"),
        area(ring(60, 50, 70, 60), kind="keep-out", name="pond"),
    )


def garden(*, planted: bool = False) -> Site:
    """Eight numbered beds, with or without three plants in each."""
    beds = [area(ring(5, 5 + 6 * k, 35, 6.2 + 6 * k), kind="bed", number=k + 1) for k in range(8)]
    x, y = 1.0 / 69_300.0, 1.0 / 111_200.0
    plants = [
        point(LON + (10 + 8 * j) * x, LAT + (5.6 + 6 * k) * y, kind="plant", crop=("leek", "kale")[k % 2])
        for k in range(8)
        for j in range(3)
    ]
    fence = area(ring(0, 0, 40, 60), kind="boundary", name="fence")
    return read(*beds, *(plants if planted else []), fence, point(LON + 2 * x, LAT + 2 * y, kind="start"))


MEADOW, BEDS, PLANTED = meadow(), garden(), garden(planted=True)

PLANNED = [
    # Quotas.
    (VINEYARD, "take 5 pictures per variety", "for Quota(variety, 5): [picture]"),
    (VINEYARD, "photograph 5 vines per variety", "for Quota(variety, 5): [picture]"),
    (VINEYARD, "take pictures of two vines of each variety", "for Quota(variety, 2): [picture]"),
    (VINEYARD, "for each variety, photograph three vines", "for Quota(variety, 3): [picture]"),
    (
        VINEYARD,
        "take one picture per row in the south block",
        "for Quota(row, 1, of Rows(of InBlock(South))): [picture]",
    ),
    (
        VINEYARD,
        "photograph 10 vines per row in the north block",
        "for Quota(row, 10, of Rows(of InBlock(North))): [picture]",
    ),
    (
        VINEYARD,
        "photograph two vines in each row of the south block",
        "for Quota(row, 2, of Rows(of InBlock(South))): [picture]",
    ),
    (VINEYARD, "three leaf samples in every block", "for Quota(block, 3): [sample_leaf]"),
    (VINEYARD, "photograph three vines in each block", "for Quota(block, 3): [picture]"),
    (VINEYARD, "photograph 2 random vines of each variety", "for Quota(variety, 2, random): [picture]"),
    (VINEYARD, "take 5 leaf samples per variety at random", "for Quota(variety, 5, random): [sample_leaf]"),
    (
        VINEYARD,
        "photograph one random vine per row in the south block",
        "for Quota(row, 1, random, of Rows(of InBlock(South))): [picture]",
    ),
    (
        VINEYARD,
        "take a leaf sample from 3 vines of each variety in each block",
        "for UnionOf(Quota(variety, 3, of InBlock(North))+Quota(variety, 3, of InBlock(South))): [sample_leaf]",
    ),
    # Shares.
    (
        VINEYARD,
        "read the soil moisture at 10% of the Merlot vines",
        "for Quota(10, of Where(variety, eq, Merlot)): [moisture]",
    ),
    (VINEYARD, "photograph 2 percent of the vines", "for Quota(2): [picture]"),
    (VINEYARD, "photograph a tenth of the Syrah vines", "for Quota(10, of Where(variety, eq, Syrah)): [picture]"),
    (
        VINEYARD,
        "photograph a quarter of the vines in row 3 of the north block",
        "for Quota(25, of Rows(3, 3, of InBlock(North))): [picture]",
    ),
    (
        VINEYARD,
        "read the soil moisture of 10 % of the vines of each row in the north block",
        "for Quota(row, 10, of Rows(of InBlock(North))): [moisture]",
    ),
    (
        VINEYARD,
        "photograph a random 5 % of the vines in the south block",
        "for Quota(5, random, of InBlock(South)): [picture]",
    ),
    (VINEYARD, "read soil moisture at 1 out of 50 vines", "for EveryNth(50): [moisture]"),
    (
        VINEYARD,
        "take a picture of every fifth vine in row 3 of the north block, starting with the third",
        "for EveryNth(5, 3, of Rows(3, 3, of InBlock(North))): [picture]",
    ),
    # Paths.
    (
        VINEYARD,
        "walk a W through the north block and take 20 soil moisture readings",
        "for Transect(20, of InBlock(North)): [moisture]",
    ),
    (VINEYARD, "walk the north block in a W and take 20 pictures", "for Transect(20, of InBlock(North)): [picture]"),
    (
        VINEYARD,
        "take 20 pictures in a W pattern across the north block",
        "for Transect(20, of InBlock(North)): [picture]",
    ),
    (
        VINEYARD,
        "take pictures of 20 vines in a W through the north block",
        "for Transect(20, of InBlock(North)): [picture]",
    ),
    (VINEYARD, "take 20 pictures in a W in the north block", "for Transect(20, of InBlock(North)): [picture]"),
    (
        VINEYARD,
        "sample leaves in a zigzag through the south block, 15 vines",
        "for Transect(15, of InBlock(South)): [sample_leaf]",
    ),
    (
        VINEYARD,
        "in a zigzag through the south block, take pictures of 15 vines",
        "for Transect(15, of InBlock(South)): [picture]",
    ),
    (
        VINEYARD,
        "read soil moisture at 15 vines along a zigzag of 5 legs through the south block",
        "for Transect(15, 5, of InBlock(South)): [moisture]",
    ),
    (
        VINEYARD,
        "take 9 leaf samples in a Z-shaped path through the south block",
        "for Transect(9, z, of InBlock(South)): [sample_leaf]",
    ),
    (
        VINEYARD,
        "take 12 leaf samples in an X pattern in the north block",
        "for Transect(12, x, of InBlock(North)): [sample_leaf]",
    ),
    (
        VINEYARD,
        "sample leaves at 10 vines along the diagonals of the north block",
        "for Transect(10, x, of InBlock(North)): [sample_leaf]",
    ),
    (
        VINEYARD,
        "take pictures of 20 vines in a V-shaped line across the north block",
        "for Transect(20, 2, of InBlock(North)): [picture]",
    ),
    (
        VINEYARD,
        "read soil moisture every 10 m along a W through the north block",
        "for Transect(10, of InBlock(North)): [moisture]",
    ),
    (
        VINEYARD,
        "read the soil moisture at 12 points in a W across the meadow",
        "for Transect(12, meadow): [moisture]",
    ),
    # Grids and points.
    (
        VINEYARD,
        "read soil moisture on a 15 m grid across the north block",
        "for Grid(15, of InBlock(North)): [moisture]",
    ),
    (
        VINEYARD,
        "take pictures of the vines on a 12 m grid in the south block",
        "for Grid(12, of InBlock(South)): [picture]",
    ),
    (VINEYARD, "sample leaves on a 10 by 10 m grid", "for Grid(10): [sample_leaf]"),
    (VINEYARD, "read the soil moisture on a 20 m grid over the meadow", "for Grid(20, meadow): [moisture]"),
    (VINEYARD, "read soil moisture at 12 random places in the meadow", "for PointsIn(meadow, 12, True): [moisture]"),
    (
        VINEYARD,
        "take 12 soil moisture readings at random in the meadow",
        "for PointsIn(meadow, 12, True): [moisture]",
    ),
    (VINEYARD, "take 12 soil moisture readings in the meadow", "for PointsIn(meadow, 12): [moisture]"),
    # Gaps.
    (VINEYARD, "take pictures of the missing vines in the south block", "for Missing(of InBlock(South)): [picture]"),
    (
        VINEYARD,
        "take pictures of the gaps in row 5 of the north block",
        "for Missing(of Rows(5, 5, of InBlock(North))): [picture]",
    ),
    (VINEYARD, "take a picture of every gap in the north block", "for Missing(of InBlock(North)): [picture]"),
    (
        VINEYARD,
        "take pictures where vines are missing in the south block",
        "for Missing(of InBlock(South)): [picture]",
    ),
    (VINEYARD, "take a picture at each place where a vine is missing", "for Missing: [picture]"),
    (
        VINEYARD,
        "take pictures of the vines that are missing in row 3 of the north block",
        "for Missing(of Rows(3, 3, of InBlock(North))): [picture]",
    ),
    (VINEYARD, "take pictures of the missing Merlot vines", "for Missing(of Where(variety, eq, Merlot)): [picture]"),
    (
        VINEYARD,
        "take pictures of the 3 missing vines nearest to the pond",
        "for Nearest(InZone(pond), 3, of Missing): [picture]",
    ),
    # Ground without plants.
    (
        MEADOW,
        "read the soil moisture at 12 places spread over the lower meadow",
        "for PointsIn(lower meadow, 12): [moisture]",
    ),
    (MEADOW, "take 10 soil moisture readings spread over the field", "for PointsIn(10): [moisture]"),
    (
        MEADOW,
        "take 15 soil moisture readings in a W across the lower meadow",
        "for Transect(15, lower meadow): [moisture]",
    ),
    (MEADOW, "take 12 soil moisture readings in a zigzag over the whole field", "for Transect(12): [moisture]"),
    (MEADOW, "read soil moisture on a 25 m grid", "for Grid(25): [moisture]"),
    (MEADOW, "take a picture in the middle of the upper meadow", "picture @ PointsIn(upper meadow)"),
    # Beds.
    (BEDS, "take a picture of bed 4", "picture @ PointsIn(bed 4)"),
    (BEDS, "take pictures of beds 2 to 4", "for UnionOf(PointsIn(bed 2)+PointsIn(bed 3)+PointsIn(bed 4)): [picture]"),
    (
        BEDS,
        "take a picture of beds 1, 3 and 8",
        "for UnionOf(PointsIn(bed 1)+PointsIn(bed 3)+PointsIn(bed 8)): [picture]",
    ),
    (
        BEDS,
        "take a picture of every third bed",
        "for UnionOf(PointsIn(bed 1)+PointsIn(bed 4)+PointsIn(bed 7)): [picture]",
    ),
    (
        BEDS,
        "take pictures of every third bed starting with bed 2",
        "for UnionOf(PointsIn(bed 2)+PointsIn(bed 5)+PointsIn(bed 8)): [picture]",
    ),
    (
        BEDS,
        "take three pictures in each of beds 2 to 3",
        "for UnionOf(PointsIn(bed 2, 3)+PointsIn(bed 3, 3)): [picture]",
    ),
    (PLANTED, "take pictures of the plants in bed 4", "for InZone(bed 4): [picture]"),
    (PLANTED, "take pictures of the plants in beds 2 to 3", "for UnionOf(InZone(bed 2)+InZone(bed 3)): [picture]"),
    (
        PLANTED,
        "photograph two plants in every fourth bed",
        "for UnionOf(Take(2, of InZone(bed 1))+Take(2, of InZone(bed 5))): [picture]",
    ),
]  # fmt: skip

REFUSED = [
    (VINEYARD, "sample leaves of 5 vines per rootstock", "'per rootstock': the site's file does not say this"),
    (VINEYARD, "take pictures in a W through the north block", "it does not say at how many places along the path"),
    (VINEYARD, "read soil moisture on a grid over the meadow", "it does not say how wide the grid is"),
    (VINEYARD, "take a picture of 3 random points", "random points are drawn in a zone"),
    (VINEYARD, "how many vines are missing?", "asks to count"),
    (VINEYARD, "how many gaps are there in the north block", "asks to count"),
    (VINEYARD, "take pictures of the gaps in row 1 of the north block", "nothing on this site matches the gaps"),
    (VINEYARD, "sample leaves on a 10 by 20 m grid", ""),
    (MEADOW, "take a picture of tree 4", "there is no tree '4'"),
    (MEADOW, "take pictures of all trees", "this site records no plants: every tree"),
    (MEADOW, "photograph row 3", ""),
    (MEADOW, "take a picture of each missing tree", ""),
    (MEADOW, "take 5 pictures per row", ""),
    (BEDS, "take a picture of bed 12", "there is no zone 'bed 12'"),
    (BEDS, "take a picture of beds 7 to 10", "there is no zone 'bed 9'"),
]

ASKED = [
    (VINEYARD, "measure 5 vines per variety"),
    (VINEYARD, "read soil moisture every 20 m in the meadow"),
]


@pytest.mark.parametrize(("site", "request_", "plan"), PLANNED, ids=lambda v: v[:60] if isinstance(v, str) else "")
def test_a_request_for_samples_has_its_plan(site: Site, request_: str, plan: str) -> None:
    outcome = EnglishPlanner().plan(request_, site, AMIGA)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).removesuffix(" | return_to_start") == plan
    for node in walk(outcome.task.composition.plan):
        if node.selector is not None and not node.selector.relative:
            assert resolve(node.selector, site, Context(here=site.start))


@pytest.mark.parametrize(("site", "request_", "why"), REFUSED, ids=lambda v: v[:60] if isinstance(v, str) else "")
def test_what_cannot_be_sampled_is_refused_with_the_reason(site: Site, request_: str, why: str) -> None:
    outcome = EnglishPlanner().plan(request_, site, AMIGA)
    assert isinstance(outcome, Refused), outcome
    assert why in " | ".join(str(reason.what) for reason in outcome.reasons)


@pytest.mark.parametrize(("site", "request_"), ASKED)
def test_what_may_mean_two_samples_is_asked(site: Site, request_: str) -> None:
    outcome = EnglishPlanner().plan(request_, site, AMIGA)
    assert isinstance(outcome, Clarify)
    assert len(outcome.choices) >= 2
