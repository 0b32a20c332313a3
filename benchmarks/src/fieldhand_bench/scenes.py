"""Random orchards and random robots."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np

from fieldhand.errors import SiteError
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import parse_site
from fieldhand.site.model import Site
from fieldhand.site.random_orchards import BlockShape, GeneratedOrchard, make_orchard, random_shapes

#: Attribute that holds the reward of a tree.
WORTH = "yield_kg"

#: Fractions of sites with only a few trees and of sites without rows; the rest are orchards with rows.
_TINY, _ROWLESS = 0.15, 0.15
_FEWEST = 12

#: Default maximum number of trees of a site.
MOST_TREES = 400

#: For each kind of block: row spacing and tree spacing in metres, bend, and ratio of rows to trees per row.
_MADE = {"straight": (5.0, 4.0, 0.0, 0.8), "curved": (2.6, 1.8, 0.08, 0.8)}


def random_site(rng: np.random.Generator, most_trees: int = MOST_TREES) -> Site:
    """Return a random orchard of 4 to about ``most_trees`` trees: one to three blocks, no rows, or a few trees.

    Rows are not named in the file. Some sites have a pond, a fence or markers; each tree has a yield.
    """
    sort = rng.random()
    if sort < _TINY:
        shapes: tuple[BlockShape, ...] = (_few(rng),)
    elif sort < _TINY + _ROWLESS:
        shapes = (_no_rows(rng, most_trees),)
    else:
        trees = round(math.exp(rng.uniform(math.log(_FEWEST), math.log(max(most_trees, _FEWEST)))))
        shapes = random_shapes(rng, trees=trees, blocks=int(rng.integers(1, 4)) if trees >= 60 else 1)
    pond_m = float(rng.uniform(2.0, 8.0)) if sort >= _TINY and rng.random() < 0.25 else 0.0
    fenced, markers = bool(rng.random() < 0.4), bool(rng.random() < 0.6)
    made = _planted(rng, shapes, pond_m, fenced, markers)
    return parse_site(_with_worth(rng, made), name="random orchard")


def random_robot(rng: np.random.Generator) -> RobotProfile:
    """Return the husky or the amiga, often with a different battery, leg cost or speed."""
    robot = load_robot(str(rng.choice(["husky", "amiga"])))
    alpha = float(rng.choice([0.5, 0.5, rng.uniform(0.3, 0.8)]))
    capacity_j = robot.energy.capacity_j * float(rng.choice([1.0, 1.0, rng.uniform(0.25, 1.5)]))
    speed_m_s = robot.speed_m_s * float(rng.choice([1.0, 1.0, rng.uniform(0.4, 1.5)]))
    return replace(
        robot,
        leg_cost=replace(robot.leg_cost, alpha=round(alpha, 2)),
        energy=replace(robot.energy, capacity_j=round(capacity_j)),
        speed_m_s=round(speed_m_s, 2),
    )


def _few(rng: np.random.Generator) -> BlockShape:
    spacing = float(rng.uniform(3.0, 8.0))
    return BlockShape(
        rows=int(rng.integers(1, 4)),
        trees_a_row=int(rng.integers(4, 7)),
        tree_spacing_m=spacing,
        row_spacing_m=spacing * float(rng.uniform(1.1, 2.0)),
        bearing_deg=float(rng.uniform(0.0, 180.0)),
    )


def _no_rows(rng: np.random.Generator, most_trees: int) -> BlockShape:
    """Return a grid with so much jitter that no rows remain visible."""
    side, spacing = int(rng.integers(4, max(math.isqrt(most_trees) * 2 // 3, 5))), float(rng.uniform(5.0, 12.0))
    return BlockShape(
        rows=side, trees_a_row=side, tree_spacing_m=spacing, row_spacing_m=spacing, missing=0.2, jitter=0.6
    )


def _planted(
    rng: np.random.Generator, shapes: tuple[BlockShape, ...], pond_m: float, fenced: bool, markers: bool
) -> GeneratedOrchard:
    try:
        return make_orchard(rng, shapes, pond_m=pond_m, fenced=fenced, markers=markers)
    except SiteError:
        # The pond covered every tree.
        return make_orchard(rng, shapes, fenced=fenced, markers=markers)


def _with_worth(rng: np.random.Generator, made: GeneratedOrchard) -> bytes:
    features: list[dict[str, Any]] = [
        {**f, "properties": {**f["properties"], WORTH: round(float(rng.gamma(2.0, 4.0)), 1)}}
        if f["properties"].get("kind") == "tree"
        else f
        for f in made.collection["features"]
    ]
    return json.dumps({**made.collection, "features": features}, separators=(",", ":")).encode()


def made_block(kind: str, trees: int, seed: int = 5) -> Site:
    """Return a block of about so many trees with fence, pond, start and end, whose rows are named.

    Args:
        kind: ``straight``: an orchard; ``curved``: a vineyard of narrow curved rows.
        trees: Approximate number of positions, some of which are empty.
        seed: Random seed; the same seed gives the same site.

    Raises:
        SiteError: The kind is unknown, or there are too few trees.
    """
    if kind not in _MADE:
        raise SiteError(f"no block is {kind}", advice=f"ask for {' or '.join(_MADE)}")
    row_m, tree_m, bend, slender = _MADE[kind]
    rows = max(2, round(math.sqrt(trees * slender)))
    shape = BlockShape(
        rows=rows,
        trees_a_row=max(2, trees // rows),
        row_spacing_m=row_m,
        tree_spacing_m=tree_m,
        bearing_deg=12.0,
        bend=bend,
        missing=0.03,
        jitter=0.03,
    )
    made = make_orchard(
        np.random.default_rng(seed), [shape], named="rows and blocks", shuffled=False, pond_m=4.0, fenced=True,
        markers=True,
    )  # fmt: skip
    return parse_site(made.to_bytes(), name=f"{kind} block of {trees} trees")
