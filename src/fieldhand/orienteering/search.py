"""Fixed routes: build one by insertion, improve it by local search, shake it and improve it again.

A route is an array of vertices from start to end. Every candidate of a move is tried at once (numpy), by what it does
to the three figures that decide: the legs' length, their squared lengths, and what is left for them of each limit.

Sources: insertion and local search for orienteering after Vansteenwegen, Souffriau and Van Oudheusden 2011; ruin and
recreate after Schrimpf et al. 2000. The chance constraint by moment matching is :mod:`fieldhand.orienteering.tail`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fieldhand.errors import ProblemError
from fieldhand.orienteering.order import Floats, Ints, improve, shortest_order
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.route import Route
from fieldhand.orienteering.split import Option
from fieldhand.orienteering.tail import chance_over

_SLACK = 1e-12
_LADDER_UP = 8


@dataclass(frozen=True, kw_only=True)
class Figures:
    """What decides about routes: numbers, or arrays over candidates (``left`` has limits along its first axis)."""

    length: Floats
    squares: Floats
    left: Floats


class Search:
    """Local search on one problem, with a level for each limit that the chance of exceeding it may not pass."""

    def __init__(self, problem: Problem, levels: Floats) -> None:
        if not len(problem.distances) or problem.most is not None:
            raise ProblemError(
                "this search takes a table of distances and any number of visits", advice="use a policy instead"
            )
        self._problem = problem
        self._levels = levels[:, None]
        self._d = problem.distances
        self._budgets = np.array([limit.budget for limit in problem.limits])
        self._service = np.array([np.zeros(problem.size) if x.service is None else x.service for x in problem.limits])
        self._after = np.array(problem.after, dtype=np.float64)
        worth = (problem.rewards > 0.0) & np.isfinite(self._d[problem.start]) & np.isfinite(self._d[:, problem.end])
        worth[[problem.start, problem.end]] = False
        self._worth = worth & self._within_reach()
        self._direct_length = float(self.figures(self.direct).length)
        self._scale = max(self._direct_length, float(self._budgets.max()), 1e-9)

    @property
    def direct(self) -> Ints:
        """The route that visits nothing."""
        return np.array([self._problem.start, self._problem.end], dtype=np.intp)

    def figures(self, route: Ints) -> Figures:
        """Length, squares and what is left for the legs."""
        legs = np.concatenate([self._d[route[:-1], route[1:]], self._after])
        stops = route[1:] if self._problem.start != self._problem.end else route[1:-1]
        left = self._budgets - self._service[:, stops].sum(axis=1)
        return Figures(length=np.asarray(legs.sum()), squares=np.asarray((legs**2).sum()), left=left)

    def chances(self, figures: Figures) -> Floats:
        """For each limit the chance of exceeding it; shape of ``left``."""
        return chance_over(figures.length, figures.squares, figures.left, self._problem.alpha)

    def reward(self, route: Ints) -> float:
        """What the stops between the ends are worth."""
        return float(self._problem.rewards[route[1:-1]].sum())

    def feasible(self, route: Ints) -> bool:
        """Whether no limit is exceeded more often than its level."""
        figures = self.figures(route)
        return bool(self._allowed(_column(figures))[0])

    def describe(self, route: Ints) -> Route:
        """The route with its figures."""
        figures = self.figures(route)
        return Route(
            vertices=tuple(int(v) for v in route),
            reward=self.reward(route),
            length=float(figures.length),
            chances=tuple(float(c) for c in self.chances(figures)),
        )

    def best(self, rng: np.random.Generator, warm: Ints | None, restarts: int, rounds: int) -> Ints:
        """The best route that was found; the safest one where none is feasible.

        Args:
            rng: For the restarts and the shaking.
            warm: A route to begin with, such as what is left of the one that is being driven.
            restarts: Constructions from nothing, each with its own noise.
            rounds: Times that the best route is shaken and improved.
        """
        everything = self._everything()
        if everything is not None:
            return everything
        best = self.safest()
        starts = ([] if warm is None else [self._shrink(warm)]) + [best] * restarts
        for count, start in enumerate(starts):
            best = self._better(best, self._polish(self._calm(start), rng, noise=0.0 if count < 2 else 0.3))
        for _ in range(rounds):
            if self.reward(best) >= self._problem.rewards[self._worth].sum() - _SLACK:
                break
            shaken = self._grow(self._ruin(best, rng), rng, noise=0.5)
            best = self._better(best, self._polish(shaken, rng, noise=0.0))
        return best

    def safest(self) -> Ints:
        """A route of least risk: the direct one with those stops on the way that make a long leg less uncertain."""
        return self._calm(self.direct, through=False)

    def ladder(self, route: Ints) -> list[Ints]:
        """The route, the shorter ones that leave out stop after stop, and longer ones with stop after stop added."""
        rungs, shorter = [route], route
        while len(shorter) > 2:
            shorter = self._without_least(shorter)
            rungs.append(shorter)
        longer = route
        for _ in range(_LADDER_UP):
            vertices, positions, figures = self._insertions(longer)
            if not len(vertices):
                break
            pick = int(self._scores(longer, vertices, figures).argmax())
            longer = np.insert(longer, positions[pick] + 1, vertices[pick])
            rungs.append(longer)
        return rungs

    def option(self, route: Ints) -> Option:
        """The route as a way to go on."""
        figures = self.figures(route)
        return Option(
            length=float(figures.length),
            squares=float(figures.squares),
            service=tuple(float(x) for x in self._budgets - figures.left),
            reward=self.reward(route),
        )

    # --- moves -----------------------------------------------------------------------------------------------------

    def _polish(self, route: Ints, rng: np.random.Generator, noise: float) -> Ints:
        for _ in range(4):
            before = (self.reward(route), float(self.figures(route).length))
            shorter = improve(route, self._d)
            # Shorter is not always safer: fewer metres in longer legs can be more uncertain.
            if self.feasible(shorter) or not self.feasible(route):
                route = shorter
            route = self._exchange(self._grow(route, rng, noise))
            after = (self.reward(route), float(self.figures(route).length))
            if after[0] <= before[0] + _SLACK and after[1] >= before[1] * (1 - 1e-9):
                break
        return route

    def _grow(self, route: Ints, rng: np.random.Generator, noise: float) -> Ints:
        """Insert the vertex with most reward for its cost until none fits."""
        while True:
            vertices, positions, figures = self._insertions(route)
            fits = self._allowed(figures) if len(vertices) else np.zeros(0, dtype=bool)
            if not fits.any():
                return route
            score = self._scores(route, vertices, figures)
            if noise:
                score = score * np.exp(noise * rng.standard_normal(len(score)))
            pick = int(np.where(fits, score, -1.0).argmax())
            route = np.insert(route, positions[pick] + 1, vertices[pick])

    def _calm(self, route: Ints, through: bool = True) -> Ints:
        """Insert stops that lower the risk; ``through`` ends as soon as the route is feasible."""
        risk = self._risk(_column(self.figures(route)))[0]
        while not (through and self.feasible(route)):
            vertices, positions, figures = self._insertions(route)
            if not len(vertices):
                return route
            risks = self._risk(figures)
            pick = int(risks.argmin())
            if risks[pick] >= risk - 1e-6 * abs(risk) - 1e-9:
                return route
            route, risk = np.insert(route, positions[pick] + 1, vertices[pick]), risks[pick]
        return route

    def _shrink(self, route: Ints) -> Ints:
        """Leave out the stops that are worth least for what they take until the route is feasible."""
        while len(route) > 2 and not self.feasible(route):
            route = self._without_least(route)
        return route

    def _without_least(self, route: Ints) -> Ints:
        before, stop, after = route[:-2], route[1:-1], route[2:]
        saved = self._d[before, stop] + self._d[stop, after] - self._d[before, after]
        saved = saved + self._service[:, stop].max(axis=0)
        pick = int((self._problem.rewards[stop] / (np.maximum(saved, 0.0) + 1e-9 * self._scale)).argmin())
        return np.delete(route, pick + 1)

    def _scores(self, route: Ints, vertices: Ints, figures: Figures) -> Floats:
        """Reward of each insertion for what it takes."""
        now = self.figures(route)
        price = np.maximum(figures.length - now.length, 0.0) + (now.left[:, None] - figures.left).max(axis=0)
        return np.asarray(self._problem.rewards[vertices] / (price + 1e-6 * self._scale))

    def _exchange(self, route: Ints) -> Ints:
        """Put a vertex outside the route in the place of a stop where that is worth more and still fits."""
        outside = self._outside(route)
        if len(route) < 3 or not len(outside):
            return route
        before, stop, after = route[:-2], route[1:-1], route[2:]
        old = self._d[before, stop] + self._d[stop, after]
        new = self._d[before][:, outside] + self._d[after][:, outside].copy()
        squares = self._d[before][:, outside] ** 2 + self._d[after][:, outside] ** 2
        squares = squares - (self._d[before, stop] ** 2 + self._d[stop, after] ** 2)[:, None]
        now = self.figures(route)
        gain = self._problem.rewards[outside][None, :] - self._problem.rewards[stop][:, None]
        rows, columns = np.nonzero(gain > _SLACK)
        if not len(rows):
            return route
        left = now.left[:, None] + self._service[:, stop[rows]] - self._service[:, outside[columns]]
        figures = Figures(
            length=now.length + (new - old[:, None])[rows, columns],
            squares=now.squares + squares[rows, columns],
            left=left,
        )
        gains = np.where(self._allowed(figures), gain[rows, columns], 0.0)
        pick = int(gains.argmax())
        if gains[pick] <= 0.0:
            return route
        route = route.copy()
        route[rows[pick] + 1] = outside[columns[pick]]
        return route

    def _ruin(self, route: Ints, rng: np.random.Generator) -> Ints:
        """Leave out a run of neighbouring stops."""
        stops = len(route) - 2
        if stops < 1:
            return route
        size = int(rng.integers(1, max(2, stops // 2 + 1)))
        first = int(rng.integers(1, stops - size + 2))
        return np.delete(route, np.s_[first : first + size])

    def _everything(self) -> Ints | None:
        """All vertices in a short order, where that is feasible: nothing can be worth more."""
        stops = np.flatnonzero(self._worth)
        vertices = np.concatenate([[self._problem.start], stops, [self._problem.end]]).astype(np.intp)
        within = self._d[np.ix_(vertices, vertices)]
        if not np.isfinite(within).all():
            return None
        # Into every vertex leads a leg no shorter than that to its nearest neighbour.
        nearest = np.where(np.eye(len(vertices), dtype=bool), np.inf, within).min(axis=0)[1:-1].sum()
        if nearest > max(float(self._budgets.max()), self._direct_length):
            return None
        # A round trip has its start twice, as two vertices; so the order has two ends in any case.
        route = vertices[list(shortest_order(within, 0, len(vertices) - 1))]
        return route if self.feasible(route) else None

    # --- figures of candidates ---------------------------------------------------------------------------------------

    def _insertions(self, route: Ints) -> tuple[Ints, Ints, Figures]:
        """Every vertex outside the route at its best place: vertices, positions of the edges, figures after it."""
        outside = self._outside(route)
        left, right = route[:-1], route[1:]
        to, back = self._d[left][:, outside], self._d[right][:, outside]
        edge = self._d[left, right]
        added = to + back - edge[:, None]
        if not len(outside):
            return outside, outside, self.figures(route)
        # Among places that cost the same, the one that splits the longest leg: it takes most uncertainty away.
        position = (added - 1e-6 * edge[:, None]).argmin(axis=0)
        column = np.arange(len(outside))
        now = self.figures(route)
        squares = to[position, column] ** 2 + back[position, column] ** 2 - edge[position] ** 2
        return (
            outside,
            position,
            Figures(
                length=now.length + added[position, column],
                squares=now.squares + squares,
                left=now.left[:, None] - self._service[:, outside],
            ),
        )

    def _outside(self, route: Ints) -> Ints:
        free = self._worth.copy()
        free[route] = False
        return np.flatnonzero(free)

    def _within_reach(self) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Vertices to which one can go and still get to the end with what is left, as legs cost on average."""
        there = self._d[self._problem.start] + self._d[:, self._problem.end] + self._after.sum()
        direct = self._d[self._problem.start, self._problem.end] + self._after.sum()
        room = np.maximum(self._budgets[:, None] - self._service, direct * (1 + 1e-9))
        return np.asarray((there <= room).all(axis=0))

    def _allowed(self, figures: Figures) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Chances within the levels, and no more to drive than is left; where even home is too far, no detour."""
        enough = figures.length <= np.maximum(figures.left, self._direct_length) * (1 + 1e-9)
        allowed = np.asarray(enough.all(axis=0))
        if allowed.any():
            some = np.flatnonzero(allowed)
            figures = Figures(length=figures.length[some], squares=figures.squares[some], left=figures.left[:, some])
            allowed[some] = (self.chances(figures) <= self._levels * (1 + 1e-9) + _SLACK).all(axis=0)
        return allowed

    def _risk(self, figures: Figures) -> Floats:
        """The worst chance against its level, for each candidate; equally hopeless routes are ordered by length."""
        chance = (self.chances(figures) / np.maximum(self._levels, 1e-9)).max(axis=0)
        return np.asarray(chance + 1e-3 * figures.length / self._scale)

    def _better(self, old: Ints, new: Ints) -> Ints:
        """The feasible one, then the one worth more, then the shorter one."""
        ok_old, ok_new = self.feasible(old), self.feasible(new)
        if ok_old != ok_new:
            return new if ok_new else old
        gain = self.reward(new) - self.reward(old)
        if abs(gain) > _SLACK:
            return new if gain > 0 else old
        return new if float(self.figures(new).length) < float(self.figures(old).length) else old


def _column(figures: Figures) -> Figures:
    """One route's figures as candidates: a column of one."""
    return Figures(
        length=figures.length.reshape(1), squares=figures.squares.reshape(1), left=figures.left.reshape(-1, 1)
    )
