"""A group of places during resolution: mostly trees, stored as positions in the site's arrays."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fieldhand.site.model import Place, Site

Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False, kw_only=True)
class PlaceGroup:
    """Places in order, each once.

    Attributes:
        index: For each place the index of its tree on the site, or ``-1 - k`` for place ``k`` of ``others``.
        others: Places that are not trees of the site (markers and free points), and sides of trees.
    """

    site: Site
    index: Indices
    others: tuple[Place, ...] = ()

    @staticmethod
    def all_trees(site: Site) -> PlaceGroup:
        """Return every tree, in the order of the file."""
        return PlaceGroup(site=site, index=np.arange(len(site.trees), dtype=np.intp))

    @staticmethod
    def of(site: Site, places: Iterable[Place]) -> PlaceGroup:
        """Return a group of these places, each once, in this order."""
        index: dict[int, None] = {}
        others: dict[Place, int] = {}
        for place in places:
            tree = site.by_id.get(place.id) if place.kind == "tree" and not place.side else None
            index.setdefault(tree.index if tree else -1 - others.setdefault(place, len(others)))
        return PlaceGroup(site=site, index=np.array(list(index), dtype=np.intp), others=tuple(others))

    def __len__(self) -> int:
        return len(self.index)

    @cached_property
    def xy(self) -> NDArray[np.float64]:
        """Metres east and north, shape (n, 2)."""
        if not self.others:
            return np.asarray(self.site.xy[self.index])
        pool = np.vstack([self.site.xy, np.array([p.xy for p in reversed(self.others)])])
        return np.asarray(pool[self.index])

    @property
    def is_tree(self) -> NDArray[np.bool_]:
        """Mask of the places that are trees of the site."""
        return self.index >= 0

    @property
    def file_order(self) -> Indices:
        """A tie-breaking number for each place: trees in file order, then the others."""
        return np.where(self.index >= 0, self.index, len(self.site.trees) - self.index)

    @property
    def places(self) -> tuple[Place, ...]:
        """The places themselves."""
        trees = self.site.trees
        return tuple(trees[k].place if k >= 0 else self.others[-1 - k] for k in self.index.tolist())

    def keep(self, positions: ArrayLike | slice) -> PlaceGroup:
        """Return the places at these positions in this order, or where a boolean mask is true."""
        where = positions if isinstance(positions, slice) else np.asarray(positions)
        if not isinstance(where, slice) and not where.size:
            where = where.astype(np.intp)
        return replace(self, index=self.index[where])

    @property
    def row(self) -> Indices:
        """For each place the position of its row in the site's :attr:`~.Planting.rows`; -1 for what is in no row."""
        planted = self.site.planting.row_of
        if not len(planted):
            return np.full(len(self), -1)
        return np.where(self.is_tree, planted[self.index * self.is_tree], -1)

    @property
    def rank_in_row(self) -> Indices:
        """For each place which tree of its row it is from the row's usual end, from 0; -1 for what is in no row."""
        planted = self.site.planting.rank
        if not len(planted):
            return np.full(len(self), -1)
        return np.where(self.is_tree, planted[self.index * self.is_tree], -1)

    def without(self, excluded: PlaceGroup) -> PlaceGroup:
        """Return the places that are not among ``excluded``."""
        others = set(excluded.places) if excluded.others and self.others else set()
        mask = ~np.isin(self.index, excluded.index[excluded.index >= 0])
        if others:
            mask &= [k >= 0 or self.others[-1 - k] not in others for k in self.index.tolist()]
        return self.keep(mask)

    def once(self, count: int) -> PlaceGroup:
        """Return the places without duplicate trees of the file; all places if fewer than ``count`` would be left."""
        from fieldhand.site.rows import first_entries

        if len(self) <= count or not self.is_tree.any():
            return self
        first = self.site.cache.setdefault("first_entries", None)
        if first is None:
            first = self.site.cache["first_entries"] = first_entries(self.site.xy)
        entries = np.where(self.is_tree, np.asarray(first)[self.index * self.is_tree], self.index)
        _, where = np.unique(entries, return_index=True)
        return self if len(where) in (len(self), *range(count)) else self.keep(np.sort(where))

    def ranked(self, key: NDArray[np.float64], count: int) -> PlaceGroup:
        """Return the ``count`` places with the smallest key, smallest first; keys equal to a tenth of a millimetre are
        ties, broken by file order.
        """
        rounded = np.round(key, 4)
        if 0 < count < len(rounded) // 4:  # sort only the candidates for the first positions
            worst = np.partition(rounded, count - 1)[count - 1]
            few = np.flatnonzero(rounded <= worst)
        else:
            few = np.arange(len(rounded))
        order = np.lexsort((self.file_order[few], rounded[few]))
        return self.keep(few[order[:count]])


def joined(site: Site, groups: Sequence[PlaceGroup]) -> PlaceGroup:
    """All places of the groups in their order, each once."""
    if all(not g.others for g in groups):
        index = np.concatenate([g.index for g in groups])
        _, first = np.unique(index, return_index=True)
        return PlaceGroup(site=site, index=index[np.sort(first)])
    return PlaceGroup.of(site, (place for g in groups for place in g.places))
