"""Plans of Fields2Cover (Mier, Valente and de Bruin 2023), through its Python module if that is installed.

Fields2Cover offers parts, not one plan: a decomposition, an objective for the direction of the swaths, a planner of the
route. For each block all of :data:`_SETUPS` are computed, and the best counts. Cells are cut from the ground without
headlands; the tutorial of Fields2Cover leaves headlands between cells, too, which the swaths would not cover.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import Any

import shapely
from shapely.geometry import LineString, MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from fieldhand.site.coverage.measures import fields2cover_objectives

#: Decomposition and objective of each setup. Cells are cut along and across the best direction of the whole block.
_SETUPS = (
    ("", "OBJ_NSwathModified"),
    ("", "OBJ_SwathLength"),
    ("DECOMP_Boustrophedon", "OBJ_NSwathModified"),
    ("DECOMP_TrapezoidalDecomp", "OBJ_NSwathModified"),
)


#: Shares of the ground that differ by less are taken as equal.
_AS_MUCH = 0.005


@dataclass(frozen=True, kw_only=True)
class OtherPlan:
    """A plan of Fields2Cover.

    Attributes:
        setup: Decomposition and objective.
        inside: Its ground without headlands.
        swaths: Centre lines of its swaths.
        coverage: Covered share of the ground, 0 to 1.
        length_m: Metres of the route along all swaths and between them.
    """

    setup: str
    inside: BaseGeometry
    swaths: tuple[LineString, ...]
    coverage: float
    length_m: float


def is_installed() -> bool:
    """Return True if the Python module of Fields2Cover can be imported."""
    return find_spec("fields2cover") is not None


def best_plan(area: Polygon, width_m: float, headland_m: float) -> OtherPlan | None:
    """Return the plan with the shortest route of the setups that cover as much as any other, or 0.5 % less; None if no
    setup gives a plan.

    Args:
        area: Block in metres.
        width_m: Working width.
        headland_m: Width of the headland around the block and its holes. The route runs on its middle line, as in the
            tutorials of Fields2Cover.
    """
    f2c = import_module("fields2cover")
    plans = [
        plan
        for decomposition, objective in _SETUPS
        for plan in _plans(f2c, area, width_m, headland_m, decomposition, objective)
    ]
    most = max((plan.coverage for plan in plans), default=0.0)
    good = [plan for plan in plans if plan.coverage >= most - _AS_MUCH]
    return min(good, key=lambda plan: plan.length_m, default=None)


def _plans(
    f2c: ModuleType, area: Polygon, width_m: float, headland_m: float, decomposition: str, objective: str
) -> Iterator[OtherPlan]:
    """Yield the plans of a decomposition, without those on which Fields2Cover fails."""
    headlands, search, goal = f2c.HG_Const_gen(), f2c.SG_BruteForce(), getattr(f2c, objective)()
    search.setAllowOverlap(True)  # the last swath may overlap; else a strip of up to a width is left out
    cells = _cells(f2c, area)
    middle = headlands.generateHeadlands(cells, headland_m / 2.0)
    inside = headlands.generateHeadlands(cells, headland_m)
    if not decomposition:
        with suppress(RuntimeError):
            swaths = search.generateBestSwaths(goal, width_m, inside)
            yield _plan(f2c, objective, middle, inside, swaths, width_m)
        return
    largest = max((inside.getGeometry(k) for k in range(inside.size())), key=lambda cell: cell.area())
    along = search.computeBestAngle(goal, width_m, largest)
    for angle in (along, along + math.pi / 2.0):
        cutter = getattr(f2c, decomposition)()
        cutter.setSplitAngle(angle)
        with suppress(RuntimeError):
            swaths = search.generateBestSwaths(goal, width_m, cutter.decompose(inside))
            yield _plan(f2c, f"{decomposition}, {objective}", middle, inside, swaths, width_m)


def _plan(f2c: ModuleType, setup: str, middle: Any, inside: Any, swaths: Any, width_m: float) -> OtherPlan:
    route = f2c.RP_RoutePlannerBase().genRoute(middle, swaths)
    flat = swaths.flatten()
    lines = tuple(shapely.from_wkt(flat.at(k).getPath().exportToWkt()) for k in range(flat.size()))
    ground = shapely.from_wkt(inside.exportToWkt())
    return OtherPlan(
        setup=setup.replace("DECOMP_", "").replace("OBJ_", ""),
        inside=ground,
        swaths=lines,
        coverage=fields2cover_objectives(ground, lines, width_m).coverage,
        length_m=float(route.length()),
    )


def _cells(f2c: ModuleType, area: Polygon | MultiPolygon) -> Any:
    cells = f2c.Cells()
    for part in shapely.get_parts(area):
        cell = f2c.Cell()
        for ring in (part.exterior, *part.interiors):
            points = [f2c.Point(x, y) for x, y in shapely.get_coordinates(ring).tolist()]
            cell.addRing(f2c.LinearRing(f2c.VectorPoint(points)))
        cells.addGeometry(cell)
    return cells
