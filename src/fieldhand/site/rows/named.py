"""Read rows, blocks and positions from the properties of the trees, and check them against their coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.feature_kinds import BLOCK_KEYS, COLUMN_KEYS, POSITION_KEYS, text_of
from fieldhand.site.point_index import PointIndex
from fieldhand.site.rows.labels import groups, linked
from fieldhand.terms import Value

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Greatest root-mean-square distance of trees from the line of their row, as a fraction of the spacing.
_ON_LINE = 0.35
#: Fraction of the named trees that must lie on lines for the names to be accepted as rows.
_MOST = 0.8


@dataclass(frozen=True, eq=False, kw_only=True)
class NamedRows:
    """Rows and blocks that the file names.

    Attributes:
        row_of: Row of each tree, from 0; -1 without a name. Shape (n,).
        names: Names of the rows.
        block_names: Block of each tree, empty without a name.
        positions: Position of each tree in its row; nan without one. Shape (n,).
    """

    row_of: Indices
    names: tuple[str, ...]
    block_names: tuple[str, ...]
    positions: Floats


def named_rows(rows: Sequence[str], properties: Sequence[Mapping[str, Value]], xy: Floats) -> NamedRows:
    """Return the consistent rows, blocks and positions of the file.

    A name is a row's if the trees that share it lie on a line. Trees with the same name on several lines are several
    rows, in different blocks.
    """
    count = len(xy)
    blocks = [text_of(tree_properties, BLOCK_KEYS) for tree_properties in properties]
    columns = [text_of(tree_properties, COLUMN_KEYS) for tree_properties in properties]
    positions = np.array(
        [_number(text_of(tree_properties, POSITION_KEYS)) for tree_properties in properties], dtype=np.float64
    )
    for names, along in ((rows, columns), (columns, rows)):
        if not any(names):
            continue
        for within in (blocks, [""] * count):
            row_of, kept = _lines(xy, names, within)
            if kept is not None:
                own = positions if np.isfinite(positions).any() else _numbers(along)
                if not _restarts(own, row_of):
                    own = np.full(count, np.nan)
                return NamedRows(row_of=row_of, names=kept, block_names=tuple(within), positions=own)
    none = np.full(count, -1, dtype=np.intp)
    return NamedRows(row_of=none, names=(), block_names=tuple(blocks), positions=np.full(count, np.nan))


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float("nan")


def _numbers(texts: Sequence[str]) -> Floats:
    return np.array([_number(text) if text else np.nan for text in texts], dtype=np.float64)


def _restarts(own: Floats, row_of: Indices) -> bool:
    """Return True if numbers restart in each row, like positions and unlike tree numbers of the whole file."""
    inside = np.isfinite(own) & (row_of >= 0)
    if not inside.any():
        return False
    values, rows = own[inside], row_of[inside]
    if len(np.unique(rows)) == 1:
        return bool(values.min() <= 3)
    return bool(len(np.unique(values)) <= 0.6 * len(values))


def _lines(xy: Floats, names: Sequence[str], within: Sequence[str]) -> tuple[Indices, tuple[str, ...] | None]:
    """Return the row of each tree by name, and the names; None instead of the names if most rows are not lines."""
    number: dict[tuple[str, str], int] = {}
    label = np.array(
        [number.setdefault(key, len(number)) if key[1] else -1 for key in zip(within, names, strict=True)],
        dtype=np.intp,
    )  # fmt: skip
    members = groups(label, len(number))
    named = int((label >= 0).sum())
    if len(number) > max(0.6 * named, 1) and named > 2:
        return label, None  # nearly every tree has its own name
    spacing = _nearest(xy)
    row_of, kept = np.full(len(xy), -1, dtype=np.intp), list[str]()
    lines = 0
    for (_, name), own in zip(number, members, strict=True):
        for piece in [own] if is_line(xy[own], spacing) else _pieces(xy, own, spacing):
            if is_line(xy[piece], spacing):
                row_of[piece] = len(kept)
                kept.append(name)
                lines += len(piece) if len(piece) > 2 or len(own) <= 2 else 0
    if lines < _MOST * named:
        return label, None
    return row_of, tuple(kept)


def _nearest(xy: Floats) -> float:
    """Return the median distance to the nearest tree; 1 without neighbours."""
    if len(xy) < 2:
        return 1.0
    apart = PointIndex(xy).nearest_few(xy, 2)[0][:, 1]
    apart = apart[apart > 0.01]
    return float(np.median(apart)) if len(apart) else 1.0


def is_line(points: Floats, spacing: float) -> bool:
    """Return True if points lie on a straight or gently curved line, given their spacing."""
    if len(points) <= 2:
        return True
    off = points - points.mean(axis=0)
    values, vectors = np.linalg.eigh(off.T @ off)
    along, aside = off @ vectors[:, 1], off @ vectors[:, 0]
    if np.sqrt(values[0] / len(points)) < _ON_LINE * spacing:
        return True
    if len(points) < 5 or values[0] > 0.05 * values[1]:
        return False
    steps = np.diff(np.sort(along))
    if steps.max() > 6 * spacing:  # rows of two blocks look like one bend
        return False
    bend = np.polynomial.polynomial.polyfit(along, aside, 2 if len(points) < 12 else 3)
    left = aside - np.polynomial.polynomial.polyval(along, bend)
    return bool(np.sqrt(np.mean(left**2)) < _ON_LINE * spacing)


def _pieces(xy: Floats, own: Indices, spacing: float) -> list[Indices]:
    """Split the trees of one name into groups connected by steps of a few spacings."""
    points = xy[own]
    index = PointIndex(points)
    step = max(float(np.median(index.nearest_few(points, 2)[0][:, 1])), spacing)
    pairs = index.pairs(3.0 * step)
    label = linked(len(own), pairs[:, 0], pairs[:, 1])
    return [own[trees] for trees in groups(label, int(label.max()) + 1)]
